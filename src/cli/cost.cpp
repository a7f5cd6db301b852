// `intaglio cost`: what a variant costs before it is run, each number with its maker.
#include "src/measure/cost.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "src/cli/commands.h"
#include "src/measure/variant_json.h"

namespace intaglio::cli {
namespace {

using nlohmann::ordered_json;

// The numbers of a chip under the names that people know, in the order that they are shown.
struct Row {
    const char* name;
    const char* key;
    std::optional<double> measure::ChipCost::*value;
};
constexpr Row chip_rows[] = {
    {"instructions", "instructions", &measure::ChipCost::instructions},
    {"vector registers", "vector_registers", &measure::ChipCost::vector_registers},
    {"scalar registers", "scalar_registers", &measure::ChipCost::scalar_registers},
    {"spilled registers", "spilled", &measure::ChipCost::spilled},
    {"latency, cycles", "latency", &measure::ChipCost::latency},
    {"inverse throughput, cycles", "inverse_throughput", &measure::ChipCost::inverse_throughput},
    {"code, bytes", "code_bytes", &measure::ChipCost::code_bytes},
};

constexpr const char* slots_maker = "slots as Direct3D's validator charges them";
constexpr const char* spirv_maker = "SPIR-V after SPIRV-Tools' optimiser";

std::string line(const char* name, const std::string& value) {
    return fmt::format("  {:<28} {:>12}\n", name, value);
}

std::string slots_text(const char* stage, const d3d9::Resources& used) {
    return fmt::format("\n{} stage: {}\n", stage, slots_maker) +
           line("arithmetic", fmt::format("{}", used.arithmetic)) +
           line("texture", fmt::format("{}", used.texture)) +
           line("temporary registers", fmt::format("{}", used.temps)) +
           line("constants", fmt::format("{}", used.constants)) +
           line("samplers", fmt::format("{}", used.samplers)) +
           line("dependent level", fmt::format("{}", used.dependent_level));
}

std::string spirv_text(const check::SpirvCost& cost) {
    return fmt::format("\npixel stage: {}\n", spirv_maker) +
           line("arithmetic", fmt::format("{}", cost.alu)) +
           line("texture", fmt::format("{}", cost.texture)) +
           line("branch", fmt::format("{}", cost.branch)) +
           line("memory", fmt::format("{}", cost.memory)) +
           line("shortest path", fmt::format("{}", cost.shortest_path)) +
           line("longest path", fmt::format("{}", cost.longest_path));
}

std::string chip_text(const measure::Chip& chip) {
    std::string text;
    for (const auto& [stage, cost] : {std::pair{"vertex", &chip.vertex}, {"pixel", &chip.pixel}}) {
        if (!*cost) continue;
        text += fmt::format("\n{} stage: {}, compiled by {}\n", stage, chip.chip, chip.driver);
        for (const Row& row : chip_rows)
            if (const auto& value = (**cost).*row.value)
                text += line(row.name, fmt::format("{:g}", *value));
    }
    return text;
}

ordered_json slots_json(const d3d9::Resources& used) {
    ordered_json json = {{"made_by", slots_maker}};
    json.update(measure::json_of(used));
    return json;
}

ordered_json chip_json(const std::optional<measure::ChipCost>& cost) {
    if (!cost) return nullptr;
    ordered_json json = ordered_json::object();
    for (const Row& row : chip_rows)
        json[row.key] = (*cost).*row.value ? ordered_json(*((*cost).*row.value)) : ordered_json();
    return json;
}

ordered_json json_of(const measure::StaticCost& cost) {
    ordered_json json = ordered_json::object();
    if (cost.vertex_slots) json["vertex_slots"] = slots_json(*cost.vertex_slots);
    if (cost.pixel_slots) json["pixel_slots"] = slots_json(*cost.pixel_slots);
    if (cost.pixel)
        json["pixel_spirv"] = {{"made_by", spirv_maker},
                               {"arithmetic", cost.pixel->alu},
                               {"texture", cost.pixel->texture},
                               {"branch", cost.pixel->branch},
                               {"memory", cost.pixel->memory},
                               {"shortest_path", cost.pixel->shortest_path},
                               {"longest_path", cost.pixel->longest_path}};
    json["chips"] = ordered_json::array();
    for (const measure::Chip& chip : cost.chips)
        json["chips"].push_back({{"chip", chip.chip},
                                 {"made_by", chip.driver},
                                 {"vertex", chip_json(chip.vertex)},
                                 {"pixel", chip_json(chip.pixel)}});
    return json;
}

}  // namespace

Status cost(const dsl::Catalogue& catalogue, const CostOptions& options) {
    const auto request = request_of(options.variant);
    if (!request) return request.error();
    const auto compilers = measure::ChipCompilers::create(options.chips);
    if (!compilers) return compilers.error();
    const auto variant = make_variant(catalogue, *request);
    if (!variant) return variant.error();
    const auto cost = measure::cost_of(*variant, *compilers);
    if (!cost) return cost.error();
    if (options.json) {
        ordered_json json = {{"surface", request->surface}, {"target", request->target}};
        json.update(json_of(*cost));
        return write_product("-", json.dump(2) + "\n", false);
    }
    std::string text = fmt::format("{} on {}\n", request->surface, request->target);
    if (cost->vertex_slots) text += slots_text("vertex", *cost->vertex_slots);
    if (cost->pixel_slots) text += slots_text("pixel", *cost->pixel_slots);
    if (cost->pixel) text += spirv_text(*cost->pixel);
    for (const measure::Chip& chip : cost->chips) text += chip_text(chip);
    if (!cost->pixel_slots && !cost->vertex_slots && !cost->pixel)
        text += "no witness counts this language: it cannot become SPIR-V\n";
    return write_product("-", text, false);
}

}  // namespace intaglio::cli
