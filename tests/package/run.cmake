# run(EXPECTATION COMMAND...): the command ends well, and what it prints matches the expectation.
# refused(EXPECTATION COMMAND...): it ends with another code than 0, and what it prints or complains of matches.
function(run expectation)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE errors)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${ARGN}\nexit ${result}\n${output}\n${errors}")
  endif()
  if(NOT output MATCHES "${expectation}")
    message(FATAL_ERROR "${ARGN}\nthe output does not hold '${expectation}':\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

function(refused expectation)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE errors)
  # CMake breaks the lines of its messages.
  string(REGEX REPLACE "[ \n]+" " " said "${output} ${errors}")
  if(result EQUAL 0 OR NOT said MATCHES "${expectation}")
    message(FATAL_ERROR "${ARGN}\nexit ${result}, expected a refusal with '${expectation}':\n${output}\n${errors}")
  endif()
endfunction()
