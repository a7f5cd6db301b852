# The package of the build tree: another project says -Dintaglio_DIR=<build folder> and links intaglio::generator (the
# DSL, the techniques and the targets) or intaglio::command_line (all of it, as the `intaglio` program has it).
set(intaglio_exported base ir passes d3d9 d3d9_generate target dsl templates reference maps check variant vulkan measure scene report budget cli)

add_library(intaglio_generator INTERFACE)
target_link_libraries(intaglio_generator INTERFACE intaglio_templates intaglio_target)
add_library(intaglio_command_line INTERFACE)
target_link_libraries(intaglio_command_line INTERFACE intaglio_cli intaglio_generator)

set(intaglio_targets intaglio_compile_options intaglio_generator intaglio_command_line)
foreach(folder ${intaglio_exported})
  list(APPEND intaglio_targets intaglio_${folder})
endforeach()
foreach(target ${intaglio_targets})
  string(REGEX REPLACE "^intaglio_" "" name ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
endforeach()
export(TARGETS ${intaglio_targets} NAMESPACE intaglio:: FILE "${PROJECT_BINARY_DIR}/intaglio-targets.cmake")
configure_file(cmake/intaglio-config.cmake.in "${PROJECT_BINARY_DIR}/intaglio-config.cmake" COPYONLY)
