// The measurement: rows are compiled once, prepared per map, drawn per view and light.
#include "src/measure/measure.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "src/measure/compiled.h"

namespace intaglio::measure {
namespace {

// The value that a share of the others lies below: 0.5 is the median.
double quantile(std::vector<double> values, double share) {
    if (values.empty()) return 0;
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(
                                         share * static_cast<double>(values.size()));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

std::int64_t count_invalid(const vulkan::Picture& picture) {
    return std::count_if(picture.pixels.begin(), picture.pixels.end(),
                         [](const std::array<float, 4>& pixel) {
                             return !std::all_of(pixel.begin(), pixel.end(),
                                                 [](float c) { return std::isfinite(c); });
                         });
}

void count_reads(const vulkan::Picture& reads, CaseResult& result) {
    double sum = 0;
    for (const std::array<float, 4>& pixel : reads.pixels) {
        sum += static_cast<double>(pixel[0]);
        result.reads_max = std::max(result.reads_max, static_cast<int>(pixel[0]));
    }
    result.reads_mean = sum / static_cast<double>(reads.pixels.size());
}

// Prepared programs of all rows on one map.
struct PreparedMap {
    reference::HeightField field;
    std::vector<PreparedHits> instrumented;
    std::vector<vulkan::Program> shaded;
};

Result<PreparedMap> prepare_map(const vulkan::Device& device, const Plan& plan,
                                const std::vector<CompiledRow>& rows, const MapSet& set) {
    PreparedMap prepared{set.height_field(reference::FilterWeights::Exact), {}, {}};
    const Textures textures(set, plan.filtering);
    for (const CompiledRow& row : rows) {
        Result<PreparedHits> hits = prepare_hits(device, row, textures, plan.scale, plan.size);
        if (!hits) return hits.error();
        prepared.instrumented.push_back(std::move(*hits));
        Result<vulkan::Program> program =
            prepare_quad(device, row.shaded, textures, plan.scale, plan.size, plan.size);
        if (!program) return program.error();
        prepared.shaded.push_back(std::move(*program));
    }
    if (Status status = textures.baked->check_all_read(); !status) return status.error();
    return prepared;
}

// Times all rows in turn, round after round, so that what else the machine does falls on all alike.
Status time_rows(const Plan& plan, std::vector<vulkan::Program>& programs,
                 std::vector<CaseResult>& results) {
    std::vector<std::vector<double>> times(programs.size()), ratios(programs.size());
    for (int round = 0; round < plan.rounds; ++round) {
        for (std::size_t row = 0; row < programs.size(); ++row) {
            const Result<double> time = programs[row].time_draw();
            if (!time) return time.error();
            times[row].push_back(*time / (static_cast<double>(plan.size) * plan.size));
            ratios[row].push_back(times[row].back() / times[0].back());
        }
    }
    for (std::size_t row = 0; row < programs.size(); ++row) {
        results[row].nanoseconds = quantile(times[row], 0.5);
        results[row].ratio = quantile(ratios[row], 0.5);
        results[row].ratio_low = quantile(ratios[row], 0.25);
        results[row].ratio_high = quantile(ratios[row], 0.75);
    }
    return Done{};
}

// What a case draws and compares with.
struct View {
    const ExactPicture& exact;
    const reference::HeightField& field;
    Direction view, light;
    float scale;
    int size;

    HitStatistics hits_of(const vulkan::Picture& picture) const {
        return summarize(compare_hits(picture, exact, field, view, scale), size);
    }
};

Status measure_program(vulkan::Program& program, const View& view, CaseResult& result) {
    if (Status status = aim(program, view.view, view.light); !status) return status;
    const Result<std::vector<vulkan::Picture>> pictures = program.draw();
    if (!pictures) return pictures.error();
    result.hits = view.hits_of((*pictures)[0]);
    count_reads((*pictures)[1], result);
    return Done{};
}

Status measure_bytecode(const PreparedHits& shader, const View& view, CaseResult& result) {
    const Result<InterpretedPicture> wide =
        shader.bytecode->draw(view.view, view.light, d3d9::Arithmetic::Fp32);
    if (!wide) return wide.error();
    result.hits = view.hits_of(wide->picture);
    result.reads_mean = wide->reads_mean;
    result.reads_max = wide->reads_max;
    for (d3d9::Arithmetic arithmetic : narrow_arithmetics) {
        const Result<InterpretedPicture> narrow =
            shader.quad(arithmetic).draw(view.view, view.light, arithmetic);
        if (!narrow) return narrow.error();
        result.narrow_hits.push_back(view.hits_of(narrow->picture));
    }
    return Done{};
}

Result<std::vector<CaseResult>> measure_view(const Plan& plan, PreparedMap& prepared, int map,
                                             Direction view, Direction light) {
    const float scale = static_cast<float>(plan.scale);
    const ExactPicture exact =
        trace_exact(prepared.field, view, light, scale, plan.size, plan.size);
    const View case_view{exact, prepared.field, view, light, scale, plan.size};
    std::vector<CaseResult> results(plan.rows.size());
    for (std::size_t row = 0; row < plan.rows.size(); ++row) {
        CaseResult& result = results[row];
        result.row = static_cast<int>(row);
        result.map = map;
        result.view = view;
        result.light = light;
        PreparedHits& hits = prepared.instrumented[row];
        Status measured = hits.bytecode ? measure_bytecode(hits, case_view, result)
                                        : measure_program(*hits.program, case_view, result);
        if (!measured) return measured.error();
        if (Status status = aim(prepared.shaded[row], view, light); !status) return status.error();
        const Result<std::vector<vulkan::Picture>> shaded = prepared.shaded[row].draw();
        if (!shaded) return shaded.error();
        result.invalid_colours = count_invalid((*shaded)[0]);
    }
    if (plan.rounds > 0)
        if (Status status = time_rows(plan, prepared.shaded, results); !status)
            return status.error();
    return results;
}

}  // namespace

Result<Measurement> measure(const dsl::Catalogue& catalogue, const Plan& plan,
                            const std::function<void(int done, int all)>& progress) {
    const Result<vulkan::Device> device = vulkan::Device::create({plan.device, plan.validation});
    if (!device) return device.error();
    Measurement measurement;
    measurement.device = fmt::format("{}, {}", device->name(), device->driver());
    std::vector<CompiledRow> rows;
    for (const VariantRequest& request : plan.rows) {
        Result<CompiledRow> row = compile_row(catalogue, request);
        if (!row) return row.error();
        measurement.costs.push_back(row->cost);
        measurement.slots.push_back(row->slots);
        measurement.settings.push_back(row->settings);
        rows.push_back(std::move(*row));
    }
    const int all = static_cast<int>(plan.maps.size() * plan.views.size() * plan.lights.size());
    int done = 0;
    for (std::size_t map = 0; map < plan.maps.size(); ++map) {
        Result<PreparedMap> prepared = prepare_map(*device, plan, rows, plan.maps[map]);
        if (!prepared) return prepared.error();
        for (Direction view : plan.views)
            for (Direction light : plan.lights) {
                Result<std::vector<CaseResult>> results =
                    measure_view(plan, *prepared, static_cast<int>(map), view, light);
                if (!results) return results.error();
                measurement.cases.insert(measurement.cases.end(), results->begin(), results->end());
                if (progress) progress(++done, all);
            }
    }
    if (const std::vector<std::string> messages = device->validation_messages(); !messages.empty())
        return internal_error("vulkan-validation",
                              "the Vulkan validation layer complains: " + messages.front());
    return measurement;
}

}  // namespace intaglio::measure
