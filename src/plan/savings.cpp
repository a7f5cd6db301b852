// Planned and whole, row by row in one measurement, so that times are compared within a round.
#include "src/plan/savings.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "generator/target/target.h"
#include "src/check/spirv.h"
#include "src/measure/measure.h"
#include "src/plan/rays.h"

namespace intaglio::plan {
namespace {

using measure::CaseResult;

int lights_of(const scene::Scene& scene) {
    std::set<std::string> names;
    for (const scene::SceneSurface& surface : scene.surfaces)
        for (const scene::SurfaceLight& light : surface.lights) names.insert(light.name);
    return std::clamp(static_cast<int>(names.size()), 1, 4);
}

// The lowest light that reaches the surface, or one from half-way up.
measure::Direction light_on(const scene::SceneSurface& surface) {
    for (const scene::SurfaceLight& light : surface.lights)
        if (can_reach(light)) return lowest_of(light);
    return {45, 30};
}

Saving::Side side_of(const measure::Measurement& measured, std::size_t row, std::size_t bytes) {
    Saving::Side side;
    const auto& slots = measured.slots[row];
    side.cost = slots ? slots->total : measured.costs[row].total;
    side.bytes = static_cast<double>(bytes);
    for (const CaseResult& result : measured.cases)
        if (result.row == static_cast<int>(row)) {
            side.p95 = std::max(side.p95, result.hits.p95);
            side.missed = std::max(side.missed, 100.0 * static_cast<double>(result.hits.missed) /
                                                    static_cast<double>(result.hits.pixels));
        }
    return side;
}

std::optional<double> ratio_of(const measure::Measurement& measured, int row) {
    double sum = 0;
    int count = 0;
    for (const CaseResult& result : measured.cases)
        if (result.row == row && result.ratio > 0) {
            sum += result.ratio;
            ++count;
        }
    if (count == 0) return {};
    return sum / count;
}

// Of the pixel stage as a device loads it.
Result<std::size_t> bytes_of(const Variant& variant) {
    if (!variant.pixel.bytecode.bytes.empty()) return variant.pixel.bytecode.bytes.size();
    const Result<check::Program> program = link_variant(variant);
    if (!program) return program.error();
    const Result<check::SpirvWords> words = check::optimize_spirv(program->pixel);
    if (!words) return words.error();
    return words->size() * sizeof(check::SpirvWords::value_type);
}

struct Pair {
    const scene::SceneSurface& surface;
    VariantRequest whole, planned;
};

Result<Saving> measure_pair(const dsl::Catalogue& catalogue, const Pair& pair,
                            const SavingOptions& options, std::string& device) {
    Saving saving{pair.surface.name, pair.planned.target, {}, {}, {}, {}};
    measure::Plan plan;
    std::vector<std::size_t> bytes;
    for (const VariantRequest* request : {&pair.whole, &pair.planned}) {
        const Result<Variant> variant = make_variant(catalogue, *request);
        if (!variant && request == &pair.whole && is_refusal(variant.error())) {
            saving.refusal = variant.error().message;
            continue;
        }
        if (!variant) return variant.error();
        const Result<std::size_t> count = bytes_of(*variant);
        if (!count) return count.error();
        plan.rows.push_back(*request);
        bytes.push_back(*count);
    }
    plan.maps = {pair.surface.map.set};
    plan.views = rays_of(pair.surface, {}, options.size).views;
    plan.lights = {light_on(pair.surface)};
    plan.scale = pair.surface.scale;
    plan.size = options.size;
    plan.rounds = plan.rows.size() == 2 ? options.rounds : 0;
    const Result<measure::Measurement> measured = measure::measure(catalogue, plan);
    if (!measured) return measured.error();
    device = measured->device;
    const std::size_t last = plan.rows.size() - 1;
    saving.planned = side_of(*measured, last, bytes[last]);
    if (last == 1) {
        saving.whole = side_of(*measured, 0, bytes[0]);
        saving.time_ratio = ratio_of(*measured, 1);
    }
    return saving;
}

}  // namespace

VariantRequest everything_on(const Order& order, int lights) {
    VariantRequest request = order.request;
    request.known = {};
    request.per_vertex = false;
    request.loop_forms.clear();
    std::erase_if(request.knobs, [](const auto& knob) {
        return knob.first == "ray_per_vertex" || knob.first == "lights" ||
               knob.first == "shadowed_lights";
    });
    request.knobs.emplace_back("lights", fmt::format("{}", lights));
    request.knobs.emplace_back("shadowed_lights", fmt::format("{}", lights));
    const std::string none = "shadow=none";
    if (const auto at = request.surface.find(none); at != std::string::npos)
        request.surface.replace(at, none.size(), "shadow=march");
    return request;
}

Result<Savings> measure_savings(const dsl::Catalogue& catalogue, const scene::Scene& scene,
                                const Plan& plan, const SavingOptions& options) {
    Savings savings;
    for (const Choice& choice : plan.choices) {
        if (!choice.order) continue;
        if (options.progress)
            options.progress(choice.order->name(), static_cast<int>(savings.rows.size()),
                             static_cast<int>(plan.choices.size()));
        const auto surface =
            std::find_if(scene.surfaces.begin(), scene.surfaces.end(),
                         [&](const auto& each) { return each.name == choice.surface; });
        Result<Saving> saving = measure_pair(
            catalogue,
            {*surface, everything_on(*choice.order, lights_of(scene)), choice.order->request},
            options, savings.device);
        if (!saving) return saving.error();
        savings.rows.push_back(std::move(*saving));
    }
    return savings;
}

std::string to_markdown(const Savings& savings) {
    std::string text =
        "| surface | target | cost: everything on | planned | bytes: everything on | planned | "
        "time | p95, texels: everything on | planned |\n"
        "|---|---|--:|--:|--:|--:|--:|--:|--:|\n";
    for (const Saving& row : savings.rows) {
        const auto both = [&](double Saving::Side::*member, int digits) {
            return fmt::format(
                "{} | {:.{}f}",
                row.whole ? fmt::format("{:.{}f}", (*row.whole).*member, digits) : "refused",
                row.planned.*member, digits);
        };
        text += fmt::format("| {} | `{}` | {} | {} | {} | {} |\n", row.surface, row.target,
                            both(&Saving::Side::cost, 0), both(&Saving::Side::bytes, 0),
                            row.time_ratio ? fmt::format("{:.2f}", *row.time_ratio) : "",
                            both(&Saving::Side::p95, 2));
    }
    return text;
}

}  // namespace intaglio::plan
