# Tests that ask Direct3D's own validator and compiler.  Where no judge is installed (scripts/judge) they are reported
# as not run, with the reason: the program prints it and exits with 77.
include_guard(GLOBAL)

# intaglio_judge_test(NAME SOURCES a.cpp ... LINKS lib ...): one GoogleTest program, labelled `judge`.
function(intaglio_judge_test name)
  cmake_parse_arguments(arg "" "TIMEOUT" "SOURCES;LINKS" ${ARGN})
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 300)
  endif()
  add_executable(test_${name} ${arg_SOURCES} "${PROJECT_SOURCE_DIR}/tests/judge/judge_main.cpp")
  target_link_libraries(test_${name} PRIVATE intaglio_compile_options intaglio_judge ${arg_LINKS} GTest::gmock)
  intaglio_test_options(test_${name})
  # The judge sees text and bytes, which are the same in a sanitized build: there the unit tests make them.
  if(INTAGLIO_SANITIZE)
    set_target_properties(test_${name} PROPERTIES EXCLUDE_FROM_ALL ON)
    return()
  endif()
  add_test(NAME judge.${name} COMMAND test_${name})
  set_tests_properties(judge.${name} PROPERTIES LABELS judge TIMEOUT ${arg_TIMEOUT} SKIP_RETURN_CODE 77)
endfunction()
