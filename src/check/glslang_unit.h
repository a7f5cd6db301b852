// One stage inside glslang, with the settings of its language.  Private to this folder: the only
// header that shows glslang's types, included by frontend.cpp, link.cpp and reflect_names.cpp alone.
#pragma once

#include <glslang/Public/ShaderLang.h>

#include <string>
#include <string_view>

#include "generator/base/result.h"
#include "src/check/source.h"

namespace intaglio::check {

enum class Purpose {
    Grammar,  // the language's own rules
    Spirv,    // on the way to SPIR-V 1.3 and Vulkan 1.1
};

// glslang keeps pointers into its shader's text, so a unit is neither copied nor moved.
class GlslangUnit {
  public:
    GlslangUnit(const Source& source, Purpose purpose);
    GlslangUnit(const GlslangUnit&) = delete;
    GlslangUnit& operator=(const GlslangUnit&) = delete;

    // Once per unit.
    Status parse();

    glslang::TShader& shader() { return shader_; }
    EShMessages messages() const { return messages_; }
    const Source& source() const { return source_; }

  private:
    void configure_spirv();

    const Source& source_;
    Purpose purpose_;
    EShMessages messages_;
    const char* text_;
    glslang::TShader shader_;
};

EShLanguage glslang_stage(Stage stage);
bool is_hlsl(Language language);
// GLSL whose bindings and locations are not in its text.
bool is_auto_mapped_glsl(Language language);

// The first "ERROR:" of a glslang log as a Diagnostic that quotes the line of `source` it names.
Diagnostic glslang_error(const Source& source, std::string_view log);

// Links one or two parsed units and maps what has no binding or location.
Status link_units(glslang::TProgram& program, GlslangUnit& first, GlslangUnit* second);
// Generates one stage of a linked program, and asks spirv-val.
Result<SpirvWords> generate(const glslang::TProgram& program, const Source& source);

}  // namespace intaglio::check
