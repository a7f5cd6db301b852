// Each tool's own word; SPIRV-Cross has none in its C++ interface.
#include "src/check/versions.h"

#include <fmt/format.h>
#include <glslang/Public/ShaderLang.h>
#include <mojoshader.h>
#include <spirv-tools/libspirv.h>

namespace intaglio::check {

std::string witness_versions() {
    const glslang::Version version = glslang::GetVersion();
    return fmt::format("glslang {}.{}.{}, {}, MojoShader {}", version.major, version.minor,
                       version.patch, spvSoftwareVersionDetailsString(), MOJOSHADER_version());
}

}  // namespace intaglio::check
