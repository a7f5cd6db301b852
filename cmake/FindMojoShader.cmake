# MojoShader::MojoShader: Debian's package has no config file for CMake.
find_path(MOJOSHADER_INCLUDE_DIR mojoshader.h PATH_SUFFIXES mojoshader)
find_library(MOJOSHADER_LIBRARY mojoshader)
mark_as_advanced(MOJOSHADER_INCLUDE_DIR MOJOSHADER_LIBRARY)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(MojoShader REQUIRED_VARS MOJOSHADER_LIBRARY MOJOSHADER_INCLUDE_DIR)
if(MojoShader_FOUND AND NOT TARGET MojoShader::MojoShader)
  add_library(MojoShader::MojoShader UNKNOWN IMPORTED)
  set_target_properties(MojoShader::MojoShader PROPERTIES IMPORTED_LOCATION "${MOJOSHADER_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${MOJOSHADER_INCLUDE_DIR}")
endif()
