# Results are kept by what went into them, and all code that a result depends on did: its hash is the id of the source.
#
# intaglio_source_id(HEADER src/measure/case_text.h NAMESPACE intaglio::measure FOLDERS generator templates src/maps ...)
#   source_id.cpp in the binary folder: `const char* NAMESPACE::source_id()`, as HEADER declares it.
include_guard(GLOBAL)

function(intaglio_source_id)
  cmake_parse_arguments(arg "" "HEADER;NAMESPACE" "FOLDERS" ${ARGN})
  set(script "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/source_id.cmake")
  set(sources "")
  foreach(folder IN LISTS arg_FOLDERS)
    file(GLOB_RECURSE some CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/${folder}/*.cpp" "${PROJECT_SOURCE_DIR}/${folder}/*.h")
    list(APPEND sources ${some})
  endforeach()
  set(list_file "${CMAKE_CURRENT_BINARY_DIR}/source_id.txt")
  file(CONFIGURE OUTPUT "${list_file}" CONTENT "${sources}" @ONLY)
  add_custom_command(OUTPUT source_id.cpp
    COMMAND ${CMAKE_COMMAND} -D "LIST=${list_file}" -D "ROOT=${PROJECT_SOURCE_DIR}" -D "HEADER=${arg_HEADER}"
      -D "NAMESPACE=${arg_NAMESPACE}" -D "OUT=${CMAKE_CURRENT_BINARY_DIR}/source_id.cpp" -P "${script}"
    DEPENDS ${sources} "${script}" "${list_file}"
    COMMENT "The id of the source" VERBATIM)
endfunction()
