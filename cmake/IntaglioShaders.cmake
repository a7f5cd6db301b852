# intaglio_add_shaders(<target> SCENE <scene.toml>
#                      [TARGETS <target>...] [BUDGET <budgets.toml>] [OUTPUT_DIR <folder>] [HEADERS] [NAMESPACE <name>]
#                      [CACHE <folder>] [TOOL <executable>] [OUT_FILES_VAR <variable>])
#
# Builds the shaders of a scene before <target>, which is made where there is none: anew when the scene, a map, any
# other file that was read or the tool changed, and only then.
#   TARGETS        in place of the scene's
#   BUDGET         `intaglio check` is part of the build, which fails where a limit is exceeded
#   OUTPUT_DIR     where they go, below the current binary folder if relative; shaders/<scene> if not given
#   HEADERS        <target> may include the header of a surface as "<scene>/<surface>.h"
#   NAMESPACE      of the headers
#   CACHE          of made variants, which projects and machines may share
#   TOOL           an executable target in place of intaglio::tool, as one with techniques of one's own
#   OUT_FILES_VAR  set to the shaders and the manifest, to install or to pack them
# See docs/cmake.md.
include_guard(GLOBAL)
cmake_policy(VERSION 3.25)  # of what is defined here, whatever the project that includes this asks for

# What CMake must know before there is a tool to ask is read here: the surfaces of a scene, and the targets of each.
# The tool compares what follows from them with what it makes (--expect), so that this need not be a reader of all TOML.
# Gives `out` a list of "surface|target|target", and `special` whether a text of the scene, as a map's name, has $ or #.
function(intaglio_read_scene scene out special)
  file(READ "${scene}" rest)
  string(REPLACE "\r" "" rest "${rest}")
  # None of ours, and what CMake would end an element of a list at.
  string(REPLACE ";" "," rest "${rest}")
  set(quoted "\"([^\"\\\\\n]|\\\\.)*\"|'[^'\n]*'")
  # Texts of several lines and comments go.
  set(text "")
  set(found FALSE)
  while(rest MATCHES "^([^\"'#]*)(\"\"\"(\"?\"?[^\"\\\\]|\\\\.)*\"\"\"|'''('?'?[^'])*'''|${quoted}|#[^\n]*|.)")
    string(LENGTH "${CMAKE_MATCH_0}" length)
    string(APPEND text "${CMAKE_MATCH_1}")
    set(token "${CMAKE_MATCH_2}")
    if(NOT token MATCHES "^(#|\"\"\"|''')")
      string(APPEND text "${token}")
      if(token MATCHES "[$#]")
        set(found TRUE)
      endif()
    endif()
    string(SUBSTRING "${rest}" ${length} -1 rest)
  endwhile()
  string(APPEND text "${rest}\n")

  set(count 0)
  set(table scene)  # scene, surface, other
  set(targets_0 "")  # of the scene; those of its surfaces from 1
  set(line "")
  while(text MATCHES "^([^\n]*)\n")
    string(LENGTH "${CMAKE_MATCH_0}" length)
    string(APPEND line "${CMAKE_MATCH_1} ")
    string(SUBSTRING "${text}" ${length} -1 text)
    # An array goes on until its brackets are closed.
    string(REGEX REPLACE "${quoted}" "" bare "${line}")
    string(REGEX REPLACE "[^[]" "" opened "${bare}")
    string(REGEX REPLACE "[^]]" "" closed "${bare}")
    string(LENGTH "${opened}" opened)
    string(LENGTH "${closed}" closed)
    if(opened GREATER closed AND NOT text STREQUAL "")
      continue()
    endif()
    if(line MATCHES "^[ \t]*\\[[ \t]*\\[[ \t]*[\"']?surface[\"']?[ \t]*\\][ \t]*\\]")
      set(table surface)
      math(EXPR count "${count} + 1")
      set(name_${count} "")
      set(targets_${count} "${targets_0}")
    elseif(line MATCHES "^[ \t]*\\[")
      set(table other)
    elseif(table STREQUAL "surface" AND
           line MATCHES "^[ \t]*[\"']?name[\"']?[ \t]*=[ \t]*[\"']([A-Za-z_][A-Za-z0-9_]*)[\"']")
      set(name_${count} "${CMAKE_MATCH_1}")
    elseif(NOT table STREQUAL "other" AND line MATCHES "^[ \t]*[\"']?targets[\"']?[ \t]*=(.*)")
      string(REGEX MATCHALL "[A-Za-z0-9_]+" targets_${count} "${CMAKE_MATCH_1}")
    endif()
    set(line "")
  endwhile()
  set(rows "")
  foreach(index RANGE 1 ${count})
    if(name_${index})
      list(JOIN targets_${index} "|" targets)
      list(APPEND rows "${name_${index}}|${targets}")
    endif()
  endforeach()
  set(${out} "${rows}" PARENT_SCOPE)
  set(${special} ${found} PARENT_SCOPE)
endfunction()

# The endings of what a variant is made of, by target.
function(intaglio_endings target out)
  if(target STREQUAL "spirv")
    set(endings .vert.spv .frag.spv)
  elseif(target STREQUAL "msl")
    set(endings .vert.metal .frag.metal)
  elseif(target STREQUAL "none")
    set(endings .vert.ir .frag.ir)
  elseif(target MATCHES "^vs_")
    set(endings .vsh .vso)
  elseif(target MATCHES "^ps_")
    set(endings .vsh .psh .vso .pso)
  elseif(target STREQUAL "glsl_450")
    set(endings .vert .frag .vert.spv .frag.spv)
  elseif(target MATCHES "^hlsl")
    set(endings .vert.hlsl .frag.hlsl)
  else()
    set(endings .vert .frag)
  endif()
  set(${out} "${endings}" PARENT_SCOPE)
endfunction()

# A command of the tool that says what it read (-MD), whose success a stamp remembers.
function(intaglio_command stamp comment special)
  cmake_parse_arguments(PARSE_ARGV 3 arg "" "" "FILES;DEPENDS;COMMAND")
  set(known_as "${stamp}")
  set(depfile "${stamp}.d")
  set(written "${depfile}")
  if(CMAKE_GENERATOR MATCHES "Ninja" AND (special OR "${arg_DEPENDS}" MATCHES "[$#]"))
    # CMake copies the file for Ninja (CMP0116) without the escapes of $ and #, which Ninja then reads as the ends of
    # names.  As it was before that policy, Ninja reads ours, with names as Ninja has them.
    cmake_policy(SET CMP0116 OLD)
    cmake_path(IS_PREFIX CMAKE_BINARY_DIR "${stamp}" below)
    if(below)
      cmake_path(RELATIVE_PATH known_as BASE_DIRECTORY "${CMAKE_BINARY_DIR}")
      cmake_path(RELATIVE_PATH depfile BASE_DIRECTORY "${CMAKE_BINARY_DIR}")
    endif()
    string(REPLACE "$" "$$" depfile "${depfile}")
  endif()
  add_custom_command(OUTPUT "${stamp}" ${arg_FILES}
    COMMAND ${arg_COMMAND} -MD -MF "${written}" -MT "${known_as}"
    COMMAND "${CMAKE_COMMAND}" -E touch "${stamp}"
    DEPENDS ${arg_DEPENDS}
    DEPFILE "${depfile}"
    COMMENT "${comment}" VERBATIM)
endfunction()

function(intaglio_add_shaders target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "HEADERS" "SCENE;BUDGET;OUTPUT_DIR;NAMESPACE;CACHE;TOOL;OUT_FILES_VAR" "TARGETS")
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "intaglio_add_shaders(${target}): unknown argument '${arg_UNPARSED_ARGUMENTS}'")
  endif()
  if(arg_KEYWORDS_MISSING_VALUES)
    message(FATAL_ERROR "intaglio_add_shaders(${target}): ${arg_KEYWORDS_MISSING_VALUES} needs a value")
  endif()
  if(NOT arg_SCENE)
    message(FATAL_ERROR "intaglio_add_shaders(${target}): SCENE is missing")
  endif()
  if(NOT arg_TOOL)
    set(arg_TOOL intaglio::tool)
    if(NOT TARGET intaglio::tool)
      message(FATAL_ERROR "intaglio_add_shaders(${target}): there is no intaglio::tool; where Intaglio is a folder of "
        "this project, set INTAGLIO_BUILD_TOOL to ON before it is added, or name a TOOL")
    endif()
  endif()
  cmake_path(ABSOLUTE_PATH arg_SCENE BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}" NORMALIZE)
  if(NOT EXISTS "${arg_SCENE}")
    message(FATAL_ERROR "intaglio_add_shaders(${target}): there is no scene '${arg_SCENE}'")
  endif()
  cmake_path(GET arg_SCENE STEM LAST_ONLY scene)
  if(NOT arg_OUTPUT_DIR)
    set(arg_OUTPUT_DIR "shaders/${scene}")
  endif()
  cmake_path(ABSOLUTE_PATH arg_OUTPUT_DIR BASE_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}" NORMALIZE)
  string(REGEX REPLACE "/$" "" arg_OUTPUT_DIR "${arg_OUTPUT_DIR}")
  if(arg_OUTPUT_DIR MATCHES "[#<>;]" OR CMAKE_CURRENT_BINARY_DIR MATCHES "[#<>;]")
    message(FATAL_ERROR "intaglio_add_shaders(${target}): CMake has no rules for making files in folders with one of "
      "# < > ; in their names: build elsewhere than in '${arg_OUTPUT_DIR}'")
  endif()
  get_property(folders GLOBAL PROPERTY intaglio_output_folders)
  if(arg_OUTPUT_DIR IN_LIST folders)
    message(FATAL_ERROR "intaglio_add_shaders(${target}): another call already builds into '${arg_OUTPUT_DIR}'; "
      "give this one an OUTPUT_DIR of its own")
  endif()
  set_property(GLOBAL APPEND PROPERTY intaglio_output_folders "${arg_OUTPUT_DIR}")

  # What is made: by name, before anything is.
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${arg_SCENE}")
  intaglio_read_scene("${arg_SCENE}" surfaces special)
  if(NOT surfaces)
    message(FATAL_ERROR "intaglio_add_shaders(${target}): '${arg_SCENE}' has no [[surface]] with a name")
  endif()
  set(names manifest.json)
  foreach(row IN LISTS surfaces)
    string(REPLACE "|" ";" targets "${row}")
    list(POP_FRONT targets surface)
    if(arg_TARGETS)
      set(targets "${arg_TARGETS}")
    endif()
    list(APPEND names "${surface}.h")
    foreach(one IN LISTS targets)
      intaglio_endings("${one}" endings)
      list(TRANSFORM endings PREPEND "${surface}.${one}" OUTPUT_VARIABLE files)
      list(APPEND names ${files})
    endforeach()
  endforeach()
  list(TRANSFORM names PREPEND "${arg_OUTPUT_DIR}/" OUTPUT_VARIABLE files)

  # Files of this call's own, beside the output and not in it, so that the output can be installed as it is.
  string(SHA256 key "${arg_OUTPUT_DIR}")
  string(SUBSTRING "${key}" 0 12 key)
  set(state "${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/intaglio_${key}")
  list(JOIN names "\n" expected)
  file(CONFIGURE OUTPUT "${state}.expected" CONTENT "${expected}\n" @ONLY)

  set(command "${arg_TOOL}" build "${arg_SCENE}" -o "${arg_OUTPUT_DIR}" --quiet)
  if(arg_TARGETS)
    list(JOIN arg_TARGETS "," targets)
    list(APPEND command --targets "${targets}")
  endif()
  foreach(option IN ITEMS NAMESPACE CACHE)
    if(arg_${option})
      if(option STREQUAL "CACHE")
        cmake_path(ABSOLUTE_PATH arg_CACHE BASE_DIRECTORY "${CMAKE_CURRENT_BINARY_DIR}" NORMALIZE)
      endif()
      string(TOLOWER "--${option}" name)
      list(APPEND command "${name}" "${arg_${option}}")
    endif()
  endforeach()
  # The stamp is as young as the last build; files whose bytes did not change keep their time, so that what includes
  # them is not compiled anew.
  intaglio_command("${state}.stamp" "Shaders of ${scene}" "${special}"
    FILES ${files} DEPENDS "${arg_SCENE}" "${state}.expected" "${arg_TOOL}"
    COMMAND ${command} --expect "${state}.expected")
  set(made "${state}.stamp" ${files})
  if(arg_BUDGET)
    cmake_path(ABSOLUTE_PATH arg_BUDGET BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}" NORMALIZE)
    intaglio_command("${state}.checked" "Budgets of ${scene}" "${special}"
      DEPENDS "${arg_BUDGET}" "${arg_TOOL}"
      COMMAND "${arg_TOOL}" check "${arg_BUDGET}" --quiet)
    list(APPEND made "${state}.checked")
  endif()

  if(NOT TARGET ${target})
    add_custom_target(${target} ALL)
  endif()
  add_custom_target(${target}_${key}_shaders DEPENDS ${made})
  add_dependencies(${target} ${target}_${key}_shaders)
  if(arg_HEADERS)
    get_target_property(type ${target} TYPE)
    if(type STREQUAL "UTILITY")
      message(FATAL_ERROR "intaglio_add_shaders(${target}): HEADERS is for a target that compiles something")
    endif()
    set(scope PRIVATE)
    if(type STREQUAL "INTERFACE_LIBRARY")
      set(scope INTERFACE)
    endif()
    # One folder up: a surface named `string` must not hide a header of C.
    cmake_path(GET arg_OUTPUT_DIR PARENT_PATH above)
    target_include_directories(${target} ${scope} "${above}")
  endif()
  if(arg_OUT_FILES_VAR)
    list(FILTER files EXCLUDE REGEX "\\.h$")
    set(${arg_OUT_FILES_VAR} "${files}" PARENT_SCOPE)
  endif()
endfunction()
