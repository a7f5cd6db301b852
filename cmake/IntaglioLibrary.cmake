# How every library and test of the project is compiled: warnings are errors, floating point is strict, and a
# folder can only include what its link list names (tests/tree reads the includes as well).

# Strict: no contraction of a*b+c, no reassociation, so that results do not depend on compiler or flags.
add_library(intaglio_compile_options INTERFACE)
target_compile_options(intaglio_compile_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Werror -ffp-contract=off)
# GCC 12 sees overlapping copies in `"a" + std::string` where there are none (its bug 105329).
target_compile_options(intaglio_compile_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
target_include_directories(intaglio_compile_options INTERFACE "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>")
if(INTAGLIO_SANITIZE)
  # vptr: glslang is built without typeinfo.
  set(intaglio_sanitizers -fsanitize=address,undefined -fno-sanitize=vptr -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_compile_options(intaglio_compile_options INTERFACE ${intaglio_sanitizers})
  target_link_options(intaglio_compile_options INTERFACE ${intaglio_sanitizers})
endif()

find_program(INTAGLIO_CCACHE ccache)
if(INTAGLIO_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER "${INTAGLIO_CCACHE}")
endif()
find_program(INTAGLIO_MOLD mold)
if(INTAGLIO_MOLD)
  add_link_options(-fuse-ld=mold)
endif()

# intaglio_library(NAME SOURCES a.cpp ... [LINKS lib ...]): one folder, one static library `intaglio_NAME`.
function(intaglio_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINKS;PRIVATE_LINKS" ${ARGN})
  add_library(intaglio_${name} STATIC ${arg_SOURCES})
  target_link_libraries(intaglio_${name} PUBLIC ${arg_LINKS} PRIVATE intaglio_compile_options ${arg_PRIVATE_LINKS})
  target_include_directories(intaglio_${name} PUBLIC "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>")
  set_target_properties(intaglio_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
endfunction()

# intaglio_test(NAME SOURCES a.cpp ... LINKS lib ... [LABEL unit]): one GoogleTest program, each test case a ctest.
function(intaglio_test name)
  cmake_parse_arguments(arg "" "LABEL;TIMEOUT" "SOURCES;LINKS" ${ARGN})
  add_executable(test_${name} ${arg_SOURCES})
  target_link_libraries(test_${name} PRIVATE intaglio_compile_options ${arg_LINKS} GTest::gmock GTest::gtest_main)
  # Tests compile for minutes and run for seconds.
  target_compile_options(test_${name} PRIVATE -O1)
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
