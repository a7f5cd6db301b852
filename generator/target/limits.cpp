// One sentence for each limit.
#include "generator/target/limits.h"

#include <algorithm>

#include <fmt/format.h>

namespace intaglio {
namespace {

Status check_region(const ir::Module& module, const Target& target, const ir::Region& region) {
    const Capabilities& can = target.capabilities;
    for (const ir::Instruction& instruction : region.body) {
        const auto refuse = [&](std::string_view what) {
            return target_limit(module, instruction.origin,
                                fmt::format("{} has no {}", target.name, what));
        };
        if (instruction.op == ir::Op::Loop && !can.loops) return refuse("loops");
        if (instruction.op == ir::Op::Loop && can.loop_trips > 0 &&
            instruction.loop.trip_count > can.loop_trips)
            return target_limit(
                module, instruction.origin,
                fmt::format("the loop {} runs up to {} times; {} can repeat one {} times",
                            instruction.loop.name, instruction.loop.trip_count, target.name,
                            can.loop_trips));
        if (instruction.op == ir::Op::If && !can.branches) return refuse("branches");
        if (ir::needs_derivatives(instruction.op) && !can.derivatives)
            return refuse("screen-space derivatives");
        if (instruction.op == ir::Op::SampleGrad && !can.texture_gradients)
            return refuse("texture reads with given gradients");
        if (ir::is_sample(instruction.op) && !can.volume_textures &&
            module.samplers[static_cast<std::size_t>(instruction.slot)].dimension == 3)
            return refuse("volume textures");
        for (const ir::Region& inner : instruction.regions)
            if (Status status = check_region(module, target, inner); !status) return status;
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

Status check_limits(ir::Module& module, const Target& target) {
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
    return check_region(module, target, module.body);
}

}  // namespace intaglio
