# How every library and test of the project is compiled: warnings are errors, floating point is strict, and a
# folder can only include what its link list names (tests/tree reads the includes as well).

# Strict: no contraction of a*b+c, no reassociation, so that results do not depend on compiler or flags.
add_library(intaglio_compile_options INTERFACE)
target_compile_options(intaglio_compile_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Werror -ffp-contract=off)
# GCC 12 sees overlapping or endless copies in `"a" + std::string` where there are none (its bug 105329).
target_compile_options(intaglio_compile_options INTERFACE "$<$<CXX_COMPILER_ID:GNU>:-Wno-restrict;-Wno-stringop-overflow;-Wno-stringop-overread;-Wno-array-bounds>")
target_include_directories(intaglio_compile_options INTERFACE "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>")
if(INTAGLIO_SANITIZE)
  # vptr: glslang is built without typeinfo.
  set(intaglio_sanitizers -fsanitize=address,undefined -fno-sanitize=vptr -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_compile_options(intaglio_compile_options INTERFACE ${intaglio_sanitizers})
  target_link_options(intaglio_compile_options INTERFACE ${intaglio_sanitizers})
endif()

find_program(INTAGLIO_CCACHE ccache)
if(INTAGLIO_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # It knows what a precompiled header stands for only when told that its macros and times do not matter.
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env CCACHE_SLOPPINESS=pch_defines,time_macros "${INTAGLIO_CCACHE}")
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    add_compile_options(-Xclang -fno-pch-timestamp)
  else()
    add_compile_options(-fpch-preprocess)
  endif()
endif()
find_program(INTAGLIO_MOLD mold)
if(INTAGLIO_MOLD)
  add_link_options(-fuse-ld=mold)
endif()

# Headers that most files include, parsed once for all targets that are compiled with the same options.
function(intaglio_precompiled name)
  cmake_parse_arguments(arg "" "" "HEADERS;LINKS;OPTIONS" ${ARGN})
  set(empty "${PROJECT_BINARY_DIR}/${name}.cpp")
  if(NOT EXISTS "${empty}")
    file(WRITE "${empty}" "")
  endif()
  add_library(${name} OBJECT "${empty}")
  target_link_libraries(${name} PRIVATE intaglio_compile_options ${arg_LINKS})
  target_compile_options(${name} PRIVATE ${arg_OPTIONS})
  target_precompile_headers(${name} PRIVATE ${arg_HEADERS})
endfunction()

# What runs once a command and is long to compile: with sanitizers the optimiser takes most of the time.
if(INTAGLIO_SANITIZE)
  set(intaglio_cold_options -O0)
else()
  set(intaglio_cold_options -O1)
endif()

# intaglio_library(NAME SOURCES a.cpp ... [LINKS lib ...] [COLD] [SANITIZED_COLD]): one folder, one static library
# `intaglio_NAME`.
# COLD: its time does not matter beside that of what it calls, so it is compiled quickly.
# SANITIZED_COLD: so in sanitized builds, where the optimiser takes more time than the tests then save.
function(intaglio_library name)
  cmake_parse_arguments(arg "COLD;SANITIZED_COLD" "" "SOURCES;LINKS;PRIVATE_LINKS" ${ARGN})
  if(arg_SANITIZED_COLD AND INTAGLIO_SANITIZE)
    set(arg_COLD ON)
  endif()
  add_library(intaglio_${name} STATIC ${arg_SOURCES})
  set_property(GLOBAL APPEND PROPERTY intaglio_libraries intaglio_${name})
  if(INTAGLIO_SANITIZE)
    set_target_properties(intaglio_${name} PROPERTIES EXCLUDE_FROM_ALL ON)  # what tests need is built for them
  endif()
  target_link_libraries(intaglio_${name} PUBLIC ${arg_LINKS} PRIVATE intaglio_compile_options ${arg_PRIVATE_LINKS})
  target_include_directories(intaglio_${name} PUBLIC "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>")
  set_target_properties(intaglio_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  if(NOT arg_LINKS)
    return()  # src/reference: no fmt, and nothing of anyone's
  endif()
  set(headers intaglio_library_headers)
  if(arg_COLD)
    set(headers intaglio_cold_headers)
    target_compile_options(intaglio_${name} PRIVATE ${intaglio_cold_options})
  endif()
  if(NOT TARGET ${headers})
    intaglio_precompiled(${headers} LINKS fmt::fmt OPTIONS "$<$<BOOL:${arg_COLD}>:${intaglio_cold_options}>" HEADERS
      <algorithm> <array> <cmath> <functional> <map> <optional> <string> <vector> <fmt/format.h>)
    set_target_properties(${headers} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  endif()
  target_precompile_headers(intaglio_${name} REUSE_FROM ${headers})
endfunction()

option(INTAGLIO_SANITIZE_ALL "In a sanitized build also the tests that are marked PLAIN, and all rounds of random ones" OFF)

# Tests compile for minutes and run for seconds; GoogleTest takes longer to read than most of them to compile.
function(intaglio_test_options target)
  if(NOT TARGET intaglio_test_headers)
    intaglio_precompiled(intaglio_test_headers LINKS GTest::gmock OPTIONS ${intaglio_cold_options} HEADERS
      <gmock/gmock.h> <gtest/gtest.h> <algorithm> <functional> <map> <optional> <random> <string> <vector>)
  endif()
  target_compile_options(${target} PRIVATE ${intaglio_cold_options})
  target_precompile_headers(${target} REUSE_FROM intaglio_test_headers)
  if(INTAGLIO_SANITIZE_ALL)
    target_compile_definitions(${target} PRIVATE INTAGLIO_ALL_ROUNDS)  # tests/rounds.h
  endif()
endfunction()

# intaglio_test(NAME SOURCES a.cpp ... LINKS lib ... [LABEL unit] [PLAIN]): one GoogleTest program, one ctest.
# PLAIN: left out of sanitized builds, where it takes minutes, unless INTAGLIO_SANITIZE_ALL is on: most of what it runs
# of our code other tests run there as well.
function(intaglio_test name)
  cmake_parse_arguments(arg "PLAIN" "LABEL;TIMEOUT" "SOURCES;LINKS" ${ARGN})
  add_executable(test_${name} ${arg_SOURCES})
  target_link_libraries(test_${name} PRIVATE intaglio_compile_options ${arg_LINKS} GTest::gmock GTest::gtest_main)
  intaglio_test_options(test_${name})
  if(arg_PLAIN AND INTAGLIO_SANITIZE AND NOT INTAGLIO_SANITIZE_ALL)
    set_target_properties(test_${name} PROPERTIES EXCLUDE_FROM_ALL ON)
    return()
  endif()
  if(NOT arg_LABEL)
    set(arg_LABEL unit)
  endif()
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 300)
  endif()
  # One ctest per program: a process start per case would cost more than the cases (glslang's first parse: 150 ms).
  add_test(NAME ${arg_LABEL}.${name} COMMAND test_${name})
  set_tests_properties(${arg_LABEL}.${name} PROPERTIES LABELS ${arg_LABEL} TIMEOUT ${arg_TIMEOUT})
endfunction()
