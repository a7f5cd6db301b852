# Files as data of a program: pages, scripts and libraries stay files that people and their tools read, and the
# program needs none of them when it runs.
#
# As a module:  intaglio_embed(TARGET NAMESPACE FUNCTION FILE...)
#   gives TARGET the function  std::string_view NAMESPACE::FUNCTION(std::string_view name):  the bytes of the file of
#   that name (without its folder), empty where there is none.  Whoever calls it declares it in a header of their own.
#   The target is built anew when a file changes.
# As a script, for the build:  cmake -DOUTPUT=... -DNAMESPACE=... -DFUNCTION=... -DFILES=a|b -P EmbedFiles.cmake

if(CMAKE_SCRIPT_MODE_FILE)
  string(REPLACE "|" ";" files "${FILES}")
  set(arrays "")
  set(rows "")
  set(index 0)
  foreach(file IN LISTS files)
    file(READ "${file}" bytes HEX)
    get_filename_component(name "${file}" NAME)
    string(LENGTH "${bytes}" digits)
    math(EXPR length "${digits} / 2")
    string(REGEX REPLACE "(................................)" "\\1\n" bytes "${bytes}")
    string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
    # An array of no elements is no C++; the length says that the zero is none of the file's.
    string(APPEND arrays "constexpr unsigned char bytes_${index}[] = {${bytes}0};\n")
    string(APPEND rows "    if (name == \"${name}\") return {reinterpret_cast<const char*>(bytes_${index}), ${length}};\n")
    math(EXPR index "${index} + 1")
  endforeach()
  file(WRITE "${OUTPUT}" "// Made by cmake/EmbedFiles.cmake.
#include <string_view>

namespace ${NAMESPACE} {
namespace {
${arrays}}  // namespace

std::string_view ${FUNCTION}(std::string_view name);
std::string_view ${FUNCTION}(std::string_view name) {
${rows}    return {};
}

}  // namespace ${NAMESPACE}
")
  return()
endif()

set(intaglio_embed_script "${CMAKE_CURRENT_LIST_FILE}")

function(intaglio_embed target namespace function)
  set(files "")
  foreach(file IN LISTS ARGN)
    get_filename_component(file "${file}" ABSOLUTE BASE_DIR "${CMAKE_CURRENT_SOURCE_DIR}")
    list(APPEND files "${file}")
  endforeach()
  string(REPLACE ";" "|" joined "${files}")
  set(output "${CMAKE_CURRENT_BINARY_DIR}/${function}.cpp")
  add_custom_command(OUTPUT "${output}"
    COMMAND "${CMAKE_COMMAND}" "-DOUTPUT=${output}" -DNAMESPACE=${namespace} -DFUNCTION=${function} "-DFILES=${joined}"
      -P "${intaglio_embed_script}"
    DEPENDS ${files} "${intaglio_embed_script}"
    COMMENT "Embedding files as ${namespace}::${function}" VERBATIM)
  target_sources(${target} PRIVATE "${output}")
endfunction()
