// One sentence for each limit.
#include "generator/target/limits.h"

#include <algorithm>

#include <fmt/format.h>

#include "generator/passes/coarser_read.h"

namespace intaglio {
namespace {

Status hinted(Diagnostic error, std::string hint) {
    error.notes.push_back("hint: " + std::move(hint));
    return error;
}

// The targets of the same family, "essl_100" and "essl_300", that can.
std::string those_that_can(const Target& target, bool Capabilities::*ability) {
    const std::string_view family = target.name.substr(0, target.name.find('_') + 1);
    std::string names;
    for (const Target* other : all_targets())
        if (other->name.starts_with(family) && other->capabilities.*ability)
            names += (names.empty() ? "" : ", ") + std::string(other->name);
    return names;
}

Diagnostic level_refusal(const ir::Module& module, const ir::Origin& origin, const Target& target) {
    Diagnostic error = target_limit(
        module, origin,
        fmt::format("{} has no texture reads with a given level other than 0", target.name));
    error.notes.emplace_back(
        "hint: level=0, nyquist=0, max_leaps=0 or shadow_leaps=0, where they are what gives it");
    const std::string others = those_that_can(target, &Capabilities::texture_levels);
    if (!others.empty()) error.notes.push_back(fmt::format("hint: {} can", others));
    return error;
}

// `reads`: how many texture reads were seen so far.
Status check_region(const ir::Module& module, const Target& target, const ir::Region& region,
                    int& reads) {
    const Capabilities& can = target.capabilities;
    for (const ir::Instruction& instruction : region.body) {
        const auto limit = [&](std::string sentence) {
            return target_limit(module, instruction.origin, std::move(sentence));
        };
        const auto refuse = [&](std::string_view what, bool Capabilities::*ability) -> Status {
            Diagnostic error = limit(fmt::format("{} has no {}", target.name, what));
            const std::string others = those_that_can(target, ability);
            if (!others.empty()) error.notes.push_back(fmt::format("hint: {} can", others));
            return error;
        };
        if (instruction.op == ir::Op::Loop && !can.loops)
            return refuse("loops", &Capabilities::loops);
        if (instruction.op == ir::Op::Loop && can.loop_trips > 0 &&
            instruction.loop.trip_count > can.loop_trips)
            return hinted(limit(fmt::format("the loop {} runs up to {} times; {} can repeat one {} "
                                            "times",
                                            instruction.loop.name, instruction.loop.trip_count,
                                            target.name, can.loop_trips)),
                          fmt::format("lower the knob that counts its iterations by {}",
                                      instruction.loop.trip_count - can.loop_trips));
        if (instruction.op == ir::Op::If && !can.branches)
            return refuse("branches", &Capabilities::branches);
        if ((instruction.op == ir::Op::Ddx || instruction.op == ir::Op::Ddy) && !can.derivatives)
            return refuse("screen-space derivatives", &Capabilities::derivatives);
        if (ir::is_sample(instruction.op) && module.stage == ir::Stage::Vertex &&
            !can.vertex_textures)
            return refuse("texture reads in the vertex stage", &Capabilities::vertex_textures);
        if (instruction.op == ir::Op::SampleLevel && !can.texture_levels)
            return level_refusal(module, instruction.origin, target);
        if (instruction.op == ir::Op::SampleGrad && !can.texture_gradients)
            return refuse("texture reads with given gradients", &Capabilities::texture_gradients);
        if (ir::is_sample(instruction.op) && !can.volume_textures &&
            module.samplers[static_cast<std::size_t>(instruction.slot)].dimension == 3)
            return refuse("volume textures", &Capabilities::volume_textures);
        if (ir::is_sample(instruction.op) && ++reads > can.texture_reads && can.texture_reads > 0)
            return hinted(
                limit(fmt::format("{} reads textures more than {} times{}, and {} allows no more",
                                  module.name, can.texture_reads,
                                  can.loops ? "" : " once its loops are unrolled", target.name)),
                "try fewer taps or steps");
        for (const ir::Region& inner : instruction.regions)
            if (Status status = check_region(module, target, inner, reads); !status) return status;
    }
    return Done{};
}

}  // namespace

Diagnostic target_limit(const ir::Module& module, const ir::Origin& origin, std::string message) {
    const bool known =
        origin.file >= 0 && static_cast<std::size_t>(origin.file) < module.files.size();
    return input_error("target-limit", std::move(message),
                       known ? module.files[static_cast<std::size_t>(origin.file)] : std::string(),
                       known ? origin.line : 0);
}

bool is_refusal(const Diagnostic& error) {
    constexpr std::string_view codes[] = {"target-limit", "d3d9-limit",   "d3d9-level", "d3d9-loop",
                                          "d3d9-op",      "d3d9-texture", "d3d9-stage"};
    return std::find(std::begin(codes), std::end(codes), error.code) != std::end(codes);
}

Status check_levels(const ir::Module& module, const Target& target) {
    if (target.capabilities.texture_levels) return Done{};
    const ir::Instruction* read = passes::find_coarser_read(module);
    if (read == nullptr) return Done{};
    return level_refusal(module, read->origin, target);
}

Status check_outputs(const ir::Module& module, const Target& target) {
    const auto refused = [&](const ir::Declaration& output, std::string_view what) {
        return target_limit(module, {},
                            fmt::format("{} {} as '{}'; {} has no way to say so", module.name, what,
                                        output.name, target.name));
    };
    for (const ir::Declaration& output : module.outputs) {
        if (output.semantic == ir::Semantic::Depth && !target.capabilities.depth_output)
            return refused(output, "writes the pixel's depth");
        if (output.semantic == ir::Semantic::Clip && !target.capabilities.discard)
            return refused(output, "drops pixels");
    }
    return Done{};
}

Status check_interpolants(const ir::Module& module, const Target& target) {
    if (module.stage != ir::Stage::Pixel) return Done{};
    const auto count = std::count_if(
        module.inputs.begin(), module.inputs.end(),
        [](const ir::Declaration& input) { return input.semantic == ir::Semantic::Interpolant; });
    if (count <= target.capabilities.interpolants.count) return Done{};
    return hinted(
        target_limit(
            module, {},
            fmt::format("{} takes {} values from the vertex stage; {} can pass {}", module.name,
                        count, target.name, target.capabilities.interpolants.count)),
        "each light is one of them, and so are ray_per_vertex=1 and an output with depth");
}

Status check_limits(ir::Module& module, const Target& target, Notes&) {
    if (Status status = check_outputs(module, target); !status) return status;
    if (Status status = check_interpolants(module, target); !status) return status;
    const auto targets = std::count_if(
        module.outputs.begin(), module.outputs.end(),
        [](const ir::Declaration& output) { return output.semantic == ir::Semantic::Target; });
    if (targets > target.capabilities.colour_targets)
        return target_limit(module, {},
                            fmt::format("{} has {} colour outputs; {} can write {}", module.name,
                                        targets, target.name, target.capabilities.colour_targets));
    for (const auto* declarations : {&module.inputs, &module.outputs})
        for (const ir::Declaration& declaration : *declarations)
            if (declaration.semantic == ir::Semantic::Interpolant &&
                declaration.type.scalar != ir::Scalar::Float)
                return target_limit(
                    module, {},
                    fmt::format("{} is of type {}, and only floats are interpolated",
                                declaration.name, ir::to_string(declaration.type)));
    int reads = 0;
    return check_region(module, target, module.body, reads);
}

}  // namespace intaglio
