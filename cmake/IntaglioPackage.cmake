# The package, of the build tree and of the install tree: another project says find_package(intaglio CONFIG) with
# intaglio_DIR or CMAKE_PREFIX_PATH, or adds this one as a folder of its own, and has intaglio::tool (the program),
# intaglio::generator (the DSL, the techniques and the targets), intaglio::command_line (all of the program as a
# library) and intaglio_add_shaders().
# Install components: runtime is the tool with its manual, completions and CMake package; devel is the libraries.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
include(IntaglioShaders)

option(INTAGLIO_INSTALL "Have install rules" ${PROJECT_IS_TOP_LEVEL})

add_library(intaglio_generator INTERFACE)
target_link_libraries(intaglio_generator INTERFACE intaglio_templates intaglio_target)
add_library(intaglio_command_line INTERFACE)
target_link_libraries(intaglio_command_line INTERFACE intaglio_cli intaglio_generator)
add_library(intaglio::generator ALIAS intaglio_generator)
add_library(intaglio::command_line ALIAS intaglio_command_line)
add_executable(intaglio::tool ALIAS intaglio)

# The compiler builds with nothing but fmt, and so its package asks for nothing else.
set(intaglio_generator_targets intaglio_compile_options intaglio_generator)
set(intaglio_command_line_targets intaglio_command_line)
get_property(libraries GLOBAL PROPERTY intaglio_libraries)
foreach(library IN LISTS libraries)
  get_target_property(folder ${library} SOURCE_DIR)
  cmake_path(RELATIVE_PATH folder BASE_DIRECTORY "${PROJECT_SOURCE_DIR}")
  if(folder MATCHES "^(generator|templates)(/|$)")
    list(APPEND intaglio_generator_targets ${library})
  elseif(folder MATCHES "^src/")
    list(APPEND intaglio_command_line_targets ${library})
  endif()
endforeach()
foreach(target IN LISTS intaglio_generator_targets intaglio_command_line_targets)
  string(REGEX REPLACE "^intaglio_" "" name ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
endforeach()
set_target_properties(intaglio PROPERTIES EXPORT_NAME tool)

# The build tree.
export(TARGETS intaglio NAMESPACE intaglio:: FILE "${PROJECT_BINARY_DIR}/intaglio-tool-targets.cmake")
export(TARGETS ${intaglio_generator_targets} NAMESPACE intaglio::
  FILE "${PROJECT_BINARY_DIR}/intaglio-generator-targets.cmake")
export(TARGETS ${intaglio_command_line_targets} NAMESPACE intaglio::
  FILE "${PROJECT_BINARY_DIR}/intaglio-command-line-targets.cmake")
configure_file(cmake/intaglio-config.cmake.in "${PROJECT_BINARY_DIR}/intaglio-config.cmake" @ONLY)
configure_file(cmake/IntaglioShaders.cmake "${PROJECT_BINARY_DIR}/IntaglioShaders.cmake" COPYONLY)
configure_file(cmake/FindMojoShader.cmake "${PROJECT_BINARY_DIR}/FindMojoShader.cmake" COPYONLY)
# A change of the second number may break a project that uses the package, until there is a version 1.
write_basic_package_version_file("${PROJECT_BINARY_DIR}/intaglio-config-version.cmake"
  COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
