// Interleaved rounds.
#include "src/report/page_times.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "src/measure/render.h"
#include "src/report/gallery.h"

namespace intaglio::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr int side = 256;  // pixels: some milliseconds each

struct Timed {
    std::size_t variant, map;
    vulkan::Program program;
    std::vector<double> ratios = {};
};

double quantile(const std::vector<double>& sorted, double place) {
    return sorted[static_cast<std::size_t>(place * static_cast<double>(sorted.size() - 1) + 0.5)];
}

// What was measured on a map and not on one before it.
Status prepare(const vulkan::Device& device, const dsl::Catalogue& catalogue, const PageData& page,
               const measure::MapSet& set, std::size_t map, std::vector<Timed>& prepared) {
    const std::optional<measure::Shot> shot = shown_shot(page, map);
    if (!shot || set.heights.texels.empty()) return Done{};
    const measure::Textures textures(
        set, page.native_filtering ? measure::Filtering::Native : measure::Filtering::Float);
    for (std::size_t i : drawn_variants(page, map)) {
        if (std::any_of(prepared.begin(), prepared.end(),
                        [&](const Timed& row) { return row.variant == i; }))
            continue;
        const Result<Variant> variant = make_variant(catalogue, page.variants[i]);
        if (!variant) return variant.error();
        const Result<check::Program> shaders = link_variant(*variant);
        if (!shaders) return shaders.error();
        Result<vulkan::Program> program =
            measure::prepare_quad(device, *shaders, textures, shot->scale, side, side);
        if (!program) return program.error();
        if (Status status = measure::aim(*program, shot->view, shot->light); !status)
            return status.error();
        // The first draw of a program compiles it.
        if (Result<double> first = program->time_draw(); !first) return first.error();
        prepared.push_back({i, map, std::move(*program)});
    }
    return Done{};
}

// Where the rows were drawn: on one map, or each on its own.
std::string places_of(const PageData& page, const std::vector<measure::MapSet>& maps,
                      const std::vector<Timed>& rows) {
    const std::size_t map = rows.front().map;
    if (std::all_of(rows.begin(), rows.end(), [&](const Timed& row) { return row.map == map; }))
        return fmt::format("on {} from elevation {:g}", maps[map].name,
                           shown_shot(page, map)->view.elevation);
    return "each on the first map that it was measured on, from its elevation nearest to 30";
}

}  // namespace

Status add_times(PageData& page, const dsl::Catalogue& catalogue,
                 const std::vector<measure::MapSet>& maps, int rounds) {
    const Json& cases = page.json.at("cases");
    const bool has_times = !cases.empty() && cases[0].contains("time");
    if (rounds == 0 || has_times) return Done{};
    const Result<vulkan::Device> device = vulkan::Device::create({page.device, false});
    if (!device) return device.error();
    std::vector<Timed> rows;
    for (std::size_t map = 0; map < maps.size(); ++map)
        if (Status status = prepare(*device, catalogue, page, maps[map], map, rows); !status)
            return status;
    if (rows.empty()) return Done{};
    for (int round = 0; round < rounds; ++round) {
        double first = 0;
        for (Timed& row : rows) {
            const Result<double> time = row.program.time_draw();
            if (!time) return time.error();
            if (&row == &rows.front()) first = *time;
            row.ratios.push_back(*time / first);
        }
    }
    for (Timed& row : rows) {
        std::sort(row.ratios.begin(), row.ratios.end());
        page.json["variants"][row.variant]["time"] = {{"ratio", quantile(row.ratios, 0.5)},
                                                      {"ratio_low", quantile(row.ratios, 0.25)},
                                                      {"ratio_high", quantile(row.ratios, 0.75)}};
    }
    const bool is_cpu = device->name().find("llvmpipe") != std::string::npos ||
                        device->name().find("SwiftShader") != std::string::npos;
    page.json["made_by"]["time"] = fmt::format(
        "median of {} interleaved rounds on {} ({}{}), as a ratio to {} in the same round; drawn "
        "{}, {} x {} pixels, when the report was made",
        rounds, device->name(), device->driver(),
        is_cpu ? ", a CPU rasteriser: rank GPUs by the other costs" : "",
        page.variants[rows.front().variant].surface, places_of(page, maps, rows), side, side);
    return Done{};
}

}  // namespace intaglio::report
