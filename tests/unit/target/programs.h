// Programs around a module, and the languages that witnesses read: shared by the tests of this
// folder.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "generator/ir/builder.h"
#include "generator/ir/parse.h"
#include "generator/target/target.h"
#include "src/check/frontend.h"
#include "src/check/judge.h"
#include "src/check/spirv.h"

namespace intaglio::testing {

struct TextTarget {
    std::string_view name;
    check::Language language;
};

inline constexpr TextTarget text_targets[] = {
    {"glsl_450", check::Language::Glsl450}, {"glsl_330", check::Language::Glsl330},
    {"glsl_120", check::Language::Glsl120}, {"essl_300", check::Language::Essl300},
    {"essl_100", check::Language::Essl100}, {"hlsl_5_0", check::Language::Hlsl5},
    {"hlsl_3_0", check::Language::Hlsl3},   {"hlsl_2_b", check::Language::Hlsl3},
    {"hlsl_2_0", check::Language::Hlsl3}};

// The front end, and where the language has SPIR-V, the validator.
inline Status accepted(const check::Source& source) {
    if (!check::has_spirv(source.language)) return check::parse(source);
    const auto words = check::to_spirv(source);
    return words.ok() ? Status(Done{}) : Status(words.error());
}

// Reads a module whose values are called by words; one that begins with "_" is to have no name.
inline ir::Module parsed(std::string_view text) {
    Result<ir::Module> module = ir::parse(text, "test");
    EXPECT_TRUE(module.ok()) << (module.ok() ? "" : to_string(module.error())) << "\n" << text;
    if (!module.ok()) return {};
    for (ir::Value& value : module->values)
        if (value.name.starts_with("_")) value.name.clear();
    return std::move(*module);
}

// The pixel stage, and a vertex stage that gives what it reads, all zero.
inline ir::Program program_of(ir::Module pixel) {
    ir::Program program;
    program.name = "test";
    program.vertex.name = pixel.name;
    program.vertex.stage = ir::Stage::Vertex;
    program.vertex.inputs.push_back({"position", ir::float3, ir::Semantic::Attribute});
    program.vertex.outputs.push_back({"clip", ir::float4, ir::Semantic::Position});
    ir::Builder builder(program.vertex);
    const ir::ValueId position = builder.input(0), one = builder.constant(1.0f);
    std::vector<ir::ValueId> outputs = {builder.compose(std::vector{position, one})};
    for (const ir::Declaration& input : pixel.inputs) {
        program.vertex.outputs.push_back(input);
        const ir::ValueId x = builder.swizzle(position, "x");
        outputs.push_back(
            input.type.width == 1
                ? x
                : builder.swizzle(x, std::string(static_cast<std::size_t>(input.type.width), 'x')));
    }
    builder.finish(outputs);
    program.pixel = std::move(pixel);
    return program;
}

inline check::Source source_of(const Artifact& artifact, check::Language language) {
    return {language,
            artifact.stage == ir::Stage::Vertex ? check::Stage::Vertex : check::Stage::Pixel,
            artifact.text, artifact.entry, "test"};
}

inline const Artifact& stage_of(const Emitted& emitted, ir::Stage stage) {
    return stage == ir::Stage::Vertex ? emitted.vertex : emitted.pixel;
}

// The text of a stage, or the failure of the test.
inline Artifact emitted(const ir::Program& program, ir::Stage stage, std::string_view target) {
    const Result<Emitted> both = emit(program, *find_target(target));
    EXPECT_TRUE(both.ok()) << target << ": " << (both.ok() ? "" : to_string(both.error()));
    return both.ok() ? stage_of(*both, stage) : Artifact{};
}

// The lines of main() or of an entry point, without the braces around them and their indentation.
inline std::string body_of(const std::string& text) {
    std::string body;
    std::size_t at =
        text.find('\n', text.rfind(") {\n}") == std::string::npos ? text.find("void main() {") : 0);
    for (++at; at < text.size() && text[at] != '}';) {
        const std::size_t end = text.find('\n', at);
        body += text.substr(std::min(at + 4, end), end - std::min(at + 4, end)) + "\n";
        at = end + 1;
    }
    return body;
}

}  // namespace intaglio::testing
