// Declarations: what each stage may have, and names by which others will find them.
#include "generator/ir/verify_declarations.h"

#include <set>

#include <fmt/format.h>

#include "generator/ir/print.h"

namespace intaglio::ir {
namespace {

Status broken(std::string sentence) { return input_error("ir-verify", std::move(sentence)); }

bool valid(Type type) { return type.scalar <= Scalar::Float && type.width >= 1 && type.width <= 4; }

// A name is given, and given once in its list.
template <typename Entry>
Status verify_names(const std::vector<Entry>& entries, std::string_view kind) {
    std::set<std::string_view> seen;
    for (const Entry& entry : entries) {
        if (entry.name.empty()) return broken(fmt::format("a {} has no name", kind));
        if (!seen.insert(entry.name).second)
            return broken(fmt::format("two {}s are called '{}'", kind, entry.name));
    }
    return Done{};
}

bool fits(Stage stage, bool is_input, Semantic semantic) {
    switch (stage) {
        case Stage::Vertex:
            return is_input ? semantic == Semantic::Attribute
                            : semantic == Semantic::Interpolant || semantic == Semantic::Position;
        case Stage::Pixel:
            return is_input ? semantic == Semantic::Interpolant
                            : semantic == Semantic::Target || semantic == Semantic::Depth ||
                                  semantic == Semantic::Clip;
        case Stage::Function:
            return semantic == (is_input ? Semantic::Parameter : Semantic::Result);
    }
    return false;
}

Status verify_bound(const Module& module, const Declaration& declaration, bool is_input) {
    const std::string what =
        fmt::format("{} '{}'", is_input ? "input" : "output", declaration.name);
    if (!valid(declaration.type))
        return broken(what + ": a type is bool, int or float with 1 to 4 components");
    if (declaration.semantic > Semantic::Clip)
        return broken(what + ": its semantic does not exist");
    const std::string_view semantic =
        semantic_words[static_cast<std::size_t>(declaration.semantic)];
    if (!fits(module.stage, is_input, declaration.semantic))
        return broken(fmt::format("{}: a {} stage has no {} of the semantic {}", what,
                                  stage_words[static_cast<std::size_t>(module.stage)],
                                  is_input ? "input" : "output", semantic));
    const bool any_type = module.stage == Stage::Function;
    if (!any_type && declaration.type.scalar != Scalar::Float)
        return broken(
            fmt::format("{}: {} is a float, not {}", what, semantic, to_string(declaration.type)));
    if (declaration.semantic == Semantic::Position && declaration.type != float4)
        return broken(
            fmt::format("{}: the position is a float4, not {}", what, to_string(declaration.type)));
    const bool one =
        declaration.semantic == Semantic::Depth || declaration.semantic == Semantic::Clip;
    if (one && declaration.type != float1)
        return broken(fmt::format("{}: {} is one float, not {}", what, semantic,
                                  to_string(declaration.type)));
    return Done{};
}

}  // namespace

Status verify_declarations(const Module& module) {
    if (module.stage > Stage::Function) return broken("the stage does not exist");
    for (std::size_t i = 0; i < module.values.size(); ++i)
        if (!valid(module.values[i].type))
            return broken(
                fmt::format("%{}: a type is bool, int or float with 1 to 4 components", i));
    if (auto status = verify_names(module.inputs, "input"); !status) return status;
    if (auto status = verify_names(module.outputs, "output"); !status) return status;
    if (auto status = verify_names(module.uniforms, "uniform"); !status) return status;
    if (auto status = verify_names(module.samplers, "sampler"); !status) return status;
    int positions = 0, depths = 0, clips = 0;
    for (const Declaration& input : module.inputs)
        if (auto status = verify_bound(module, input, true); !status) return status;
    for (const Declaration& output : module.outputs) {
        if (auto status = verify_bound(module, output, false); !status) return status;
        positions += output.semantic == Semantic::Position ? 1 : 0;
        depths += output.semantic == Semantic::Depth ? 1 : 0;
        clips += output.semantic == Semantic::Clip ? 1 : 0;
    }
    if (positions > 1) return broken("two outputs are the position");
    if (depths > 1) return broken("two outputs are the depth");
    if (clips > 1) return broken("two outputs clip; the smaller of both says the same");
    for (const Uniform& uniform : module.uniforms) {
        if (!valid(uniform.type))
            return broken(fmt::format(
                "uniform '{}': a type is bool, int or float with 1 to 4 components", uniform.name));
        if (uniform.count < 1)
            return broken(fmt::format("uniform '{}': it has {} elements, below 1", uniform.name,
                                      uniform.count));
    }
    for (const Sampler& sampler : module.samplers) {
        if (sampler.filter > Sampler::Filter::Nearest)
            return broken(fmt::format("sampler '{}': its filter does not exist", sampler.name));
        if (sampler.dimension != 2 && sampler.dimension != 3)
            return broken(fmt::format("sampler '{}': its dimension is 2 or 3, not {}", sampler.name,
                                      sampler.dimension));
    }
    return Done{};
}

}  // namespace intaglio::ir
