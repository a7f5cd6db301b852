# What `cmake --install BUILD [--component runtime|devel]` puts where.  Nothing of it knows the prefix: the tree may be
# moved.  The program itself needs none of these files when it runs.
set(intaglio_cmake_folder "${CMAKE_INSTALL_LIBDIR}/cmake/intaglio")
set(intaglio_include_folder "${CMAKE_INSTALL_INCLUDEDIR}/intaglio")

install(TARGETS intaglio EXPORT intaglio-tool RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT runtime)
install(EXPORT intaglio-tool NAMESPACE intaglio:: FILE intaglio-tool-targets.cmake
  DESTINATION "${intaglio_cmake_folder}" COMPONENT runtime)
install(FILES
    "${PROJECT_BINARY_DIR}/intaglio-config.cmake"
    "${PROJECT_BINARY_DIR}/intaglio-config-version.cmake"
    cmake/IntaglioShaders.cmake
  DESTINATION "${intaglio_cmake_folder}" COMPONENT runtime)
install(FILES LICENSE README.md DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT runtime)

foreach(part IN ITEMS generator command_line)
  string(REPLACE "_" "-" set intaglio-${part})
  install(TARGETS ${intaglio_${part}_targets} EXPORT ${set} ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT devel
    INCLUDES DESTINATION "${intaglio_include_folder}")
  install(EXPORT ${set} NAMESPACE intaglio:: FILE ${set}-targets.cmake
    DESTINATION "${intaglio_cmake_folder}" COMPONENT devel)
endforeach()
install(FILES cmake/FindMojoShader.cmake DESTINATION "${intaglio_cmake_folder}" COMPONENT devel)

# Includes are relative to the repository's root, and to include/intaglio of the install tree.
file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE "${PROJECT_SOURCE_DIR}" generator/*.h templates/*.h)
foreach(header IN LISTS headers ITEMS src/cli/command_line.h)
  cmake_path(GET header PARENT_PATH folder)
  install(FILES "${header}" DESTINATION "${intaglio_include_folder}/${folder}" COMPONENT devel)
endforeach()

# For builds without CMake.  A static library comes before those that it needs: the other way round than they are made.
set(libraries ${intaglio_generator_targets})
list(REMOVE_ITEM libraries intaglio_compile_options intaglio_generator)
list(REVERSE libraries)
list(TRANSFORM libraries PREPEND -l)
list(JOIN libraries " " INTAGLIO_PC_LIBRARIES)
cmake_path(RELATIVE_PATH CMAKE_INSTALL_FULL_LIBDIR BASE_DIRECTORY "${CMAKE_INSTALL_PREFIX}" OUTPUT_VARIABLE INTAGLIO_PC_LIBDIR)
cmake_path(SET INTAGLIO_PC_UP NORMALIZE "${INTAGLIO_PC_LIBDIR}/pkgconfig")
string(REGEX REPLACE "[^/]+" ".." INTAGLIO_PC_UP "${INTAGLIO_PC_UP}")
configure_file(cmake/intaglio.pc.in "${PROJECT_BINARY_DIR}/intaglio.pc" @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/intaglio.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig" COMPONENT devel)

# The manual page and the completions are what the program says of itself, so it must run where it was compiled.
if(NOT CMAKE_CROSSCOMPILING AND NOT INTAGLIO_SANITIZE)
  set(pages "${PROJECT_BINARY_DIR}/intaglio.1" "${PROJECT_BINARY_DIR}/intaglio.bash" "${PROJECT_BINARY_DIR}/_intaglio")
  add_custom_command(OUTPUT ${pages}
    COMMAND intaglio manual -o "${PROJECT_BINARY_DIR}/intaglio.1"
    COMMAND intaglio completion bash -o "${PROJECT_BINARY_DIR}/intaglio.bash"
    COMMAND intaglio completion zsh -o "${PROJECT_BINARY_DIR}/_intaglio"
    DEPENDS intaglio COMMENT "The manual page and completions" VERBATIM)
  add_custom_target(intaglio_pages ALL DEPENDS ${pages})
  install(FILES "${PROJECT_BINARY_DIR}/intaglio.1" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" COMPONENT runtime)
  install(FILES "${PROJECT_BINARY_DIR}/intaglio.bash" RENAME intaglio
    DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions" COMPONENT runtime)
  install(FILES "${PROJECT_BINARY_DIR}/_intaglio" DESTINATION "${CMAKE_INSTALL_DATADIR}/zsh/site-functions" COMPONENT runtime)
endif()
