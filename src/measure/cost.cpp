// The witnesses' counts and the drivers' words, gathered.
#include "src/measure/cost.h"

namespace intaglio::measure {
namespace {

ChipCost chip_cost(const vulkan::CompiledStage& stage) {
    const auto told = [&](std::string_view name) -> std::optional<double> {
        const vulkan::Statistic* found = stage.find(name);
        return found ? std::optional(found->value) : std::nullopt;
    };
    ChipCost cost;
    cost.instructions = told("Instructions");
    cost.vector_registers = told("VGPRs");
    cost.scalar_registers = told("SGPRs");
    const auto spilled_vector = told("Spilled VGPRs"), spilled_scalar = told("Spilled SGPRs");
    if (spilled_vector && spilled_scalar) cost.spilled = *spilled_vector + *spilled_scalar;
    cost.latency = told("Latency");
    cost.inverse_throughput = told("Inverse Throughput");
    cost.code_bytes = told("Code size");
    return cost;
}

}  // namespace

Result<ChipCompilers> ChipCompilers::create(const std::vector<std::string>& chips) {
    ChipCompilers made;
    for (const std::string& chip : chips) {
        auto device = vulkan::Device::create({.chip = chip});
        if (!device) return device.error();
        made.compilers_.push_back({chip, std::move(*device)});
    }
    return made;
}

Result<std::vector<Chip>> ChipCompilers::compile(const check::Program& program) const {
    std::vector<Chip> chips;
    for (const Compiler& compiler : compilers_) {
        const auto stages = vulkan::compile(compiler.device, program);
        if (!stages) return stages.error();
        Chip chip{compiler.chip, compiler.device.driver(), {}, {}};
        for (const vulkan::CompiledStage& stage : *stages)
            (stage.pixel ? chip.pixel : chip.vertex) = chip_cost(stage);
        chips.push_back(std::move(chip));
    }
    return chips;
}

Result<StaticCost> cost_of(const Variant& variant, const ChipCompilers& compilers) {
    const auto judged = judge_variant(variant);
    if (!judged) return judged.error();
    StaticCost cost;
    for (const d3d9::Shader& shader : judged->shaders)
        (is_pixel(shader.profile) ? cost.pixel_slots : cost.vertex_slots) = d3d9::count(shader);
    // A vertex profile alone has no pixel stage to link with.
    if (cost.vertex_slots && !cost.pixel_slots) return cost;
    const auto language = language_of(*variant.target);
    if (language && !check::has_spirv(*language)) return cost;
    if (!profile_of(*variant.target)) cost.pixel = judged->pixel_cost;
    const auto program = link_variant(variant);
    if (!program) return program.error();
    auto chips = compilers.compile(*program);
    if (!chips) return chips.error();
    cost.chips = std::move(*chips);
    return cost;
}

}  // namespace intaglio::measure
