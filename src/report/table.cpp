// Columns, blocks and the legend.
#include "src/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "src/report/command.h"

namespace intaglio::report {
namespace {

using measure::CaseResult;
using measure::Direction;
using measure::Measurement;
using measure::Plan;

// A grid of cells; the first line is the head.
struct Grid {
    std::vector<std::vector<std::string>> lines;
    std::size_t texts =
        0;  // so many of the first columns are text and stand left; numbers stand right
};

// Columns on a terminal, taking each code point for one.
std::size_t width_of(std::string_view text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned char>(c) & 0xc0) != 0x80;
    }));
}

std::string print(const Grid& grid) {
    std::vector<std::size_t> widths(grid.lines.front().size());
    for (const std::vector<std::string>& line : grid.lines)
        for (std::size_t i = 0; i < line.size(); ++i)
            widths[i] = std::max(widths[i], width_of(line[i]));
    std::string text;
    for (const std::vector<std::string>& line : grid.lines) {
        std::string row;
        for (std::size_t i = 0; i < line.size(); ++i) {
            const std::string fill(widths[i] - width_of(line[i]), ' ');
            row += (i == 0 ? "" : "  ") + (i < grid.texts ? line[i] + fill : fill + line[i]);
        }
        row.erase(row.find_last_not_of(' ') + 1);
        text += row + "\n";
    }
    return text;
}

// At most `width` columns, the end of a longer text being "..".
std::string shortened(const std::string& text, std::size_t width) {
    if (width_of(text) <= width) return text;
    std::string kept;
    for (char c : text) {
        if (width_of(kept + c) > width - 2) break;
        kept += c;
    }
    return kept + "..";
}

// A surface without the part name that may be left out.
std::string technique_of(const VariantRequest& request) {
    constexpr std::string_view first = "search=";
    return request.surface.substr(request.surface.rfind(first, 0) == 0 ? first.size() : 0);
}

// Zero is "0" and nothing else is: what would round to it says that it is less.
std::string number(double value, int digits) {
    if (value == 0) return "0";
    const double least = std::pow(10.0, -digits);
    if (value < least / 2) return fmt::format("<{:.{}f}", least, digits);
    return fmt::format("{:.{}f}", value, digits);
}

std::string texels(double value) { return number(value, value < 100 ? 3 : 1); }

std::string share(std::int64_t part, std::int64_t all) {
    return all == 0 ? "-" : number(100.0 * static_cast<double>(part) / static_cast<double>(all), 2);
}

// Whether any pixel reported a hit at all.
bool has_hits(const CaseResult& result) { return result.hits.pixels > result.hits.invalid; }

const VariantRequest& request_of(const Plan& plan, const CaseResult& result) {
    return plan.rows[static_cast<std::size_t>(result.row)];
}

std::vector<std::string> head() {
    return {"#",      "technique", "knobs", "target", "alu/tex/all", "reads", "time", "ns/px",
            "median", "p95",       "p99",   "max",    "miss%",       "shad%", "NaN"};
}

constexpr std::size_t technique_column = 1, knob_column = 2;

// What the pixel stage costs by the measure of its target.
std::string cost_text(const Measurement& measurement, int row) {
    const auto& slots = measurement.slots[static_cast<std::size_t>(row)];
    if (slots) return fmt::format("{}+{}", slots->arithmetic, slots->texture);
    const check::SpirvCost& cost = measurement.costs[static_cast<std::size_t>(row)];
    return fmt::format("{}/{}/{}", cost.alu, cost.texture, cost.total);
}

std::vector<std::string> cells_of(const Plan& plan, const Measurement& measurement,
                                  const CaseResult& result) {
    const VariantRequest& request = request_of(plan, result);
    const measure::HitStatistics& hits = result.hits;
    std::vector<std::string> cells{fmt::format("{}", result.row + 1),
                                   technique_of(request),
                                   settings_of(request),
                                   request.target,
                                   cost_text(measurement, result.row),
                                   number(result.reads_mean, 2)};
    const bool timed = result.nanoseconds > 0;
    cells.push_back(timed ? number(result.ratio, 2) : "-");
    cells.push_back(timed ? number(result.nanoseconds, 1) : "-");
    for (double value : {hits.median, hits.p95, hits.p99, hits.max})
        cells.push_back(has_hits(result) ? texels(value) : "-");
    cells.push_back(share(hits.missed, hits.pixels));
    cells.push_back(share(hits.shadow_wrong, hits.pixels));
    cells.push_back(fmt::format("{}/{}", hits.invalid, result.invalid_colours));
    return cells;
}

// How many columns technique and knobs may take, so that a line with all else stays in the width.
std::pair<std::size_t, std::size_t> label_widths(const Plan& plan, const Measurement& measurement) {
    std::size_t technique = width_of("technique"), knobs = width_of("knobs");
    for (const VariantRequest& request : plan.rows) {
        technique = std::max(technique, width_of(technique_of(request)));
        knobs = std::max(knobs, width_of(settings_of(request)));
    }
    std::vector<std::size_t> widths;
    for (const std::string& title : head()) widths.push_back(width_of(title));
    for (const CaseResult& result : measurement.cases) {
        const std::vector<std::string> cells = cells_of(plan, measurement, result);
        for (std::size_t i = 0; i < cells.size(); ++i)
            widths[i] = std::max(widths[i], width_of(cells[i]));
    }
    std::size_t others = 2 * (widths.size() - 1);
    for (std::size_t i = 0; i < widths.size(); ++i)
        if (i != technique_column && i != knob_column) others += widths[i];
    // Knobs give way first, down to a column that still shows the first one; then techniques.
    const std::size_t room = table_width - std::min(table_width - 32, others);
    const std::size_t least_knobs = std::min<std::size_t>(knobs, 16);
    if (technique + knobs > room) knobs = std::max(least_knobs, room - std::min(room, technique));
    if (technique + knobs > room) technique = std::max<std::size_t>(16, room - knobs);
    return {technique, knobs};
}

std::string angles(Direction direction) {
    if (direction.elevation == 90) return "straight above";
    return fmt::format("elevation {} azimuth {}", direction.elevation, direction.azimuth);
}

std::string block_title(const Plan& plan, const CaseResult& result) {
    const measure::MapSet& map = plan.maps[static_cast<std::size_t>(result.map)];
    return fmt::format("{} ({} x {}), seen from {}, lit from {}\n", map.name, map.heights.width,
                       map.heights.height, angles(result.view), angles(result.light));
}

bool same_block(const CaseResult& a, const CaseResult& b) {
    return a.map == b.map && a.view == b.view && a.light == b.light;
}

std::string blocks(const Plan& plan, const Measurement& measurement) {
    const auto [technique, knobs] = label_widths(plan, measurement);
    std::string text;
    const std::vector<CaseResult>& cases = measurement.cases;
    for (std::size_t first = 0; first < cases.size();) {
        Grid grid{{head()}, 4};
        std::size_t next = first;
        for (; next < cases.size() && same_block(cases[first], cases[next]); ++next) {
            std::vector<std::string> cells = cells_of(plan, measurement, cases[next]);
            cells[technique_column] = shortened(cells[technique_column], technique);
            cells[knob_column] = shortened(cells[knob_column], knobs);
            grid.lines.push_back(std::move(cells));
        }
        text += block_title(plan, cases[first]) + print(grid) + "\n";
        first = next;
    }
    return text;
}

bool has_direct3d9(const Measurement& measurement) {
    return std::any_of(measurement.slots.begin(), measurement.slots.end(),
                       [](const auto& slots) { return slots.has_value(); });
}

// Of the Direct3D 9 variants of a block: what they use of their profiles, and the error in each
// arithmetic.
std::string direct3d9_blocks(const Plan& plan, const Measurement& measurement) {
    const auto [technique, knobs] = label_widths(plan, measurement);
    std::string text;
    const CaseResult* before = nullptr;
    Grid grid;
    const auto flush = [&] {
        if (before != nullptr)
            text += "Direct3D 9: " + block_title(plan, *before) + print(grid) + "\n";
    };
    for (const CaseResult& result : measurement.cases) {
        const auto& slots = measurement.slots[static_cast<std::size_t>(result.row)];
        if (!slots) continue;
        if (before == nullptr || !same_block(*before, result)) {
            flush();
            grid = {{{"#", "technique", "knobs", "target", "arith", "tex", "temps", "level",
                      "reads", "p95 fp32", "fp24", "fp16", "miss% fp32", "fp24", "fp16"}},
                    4};
            before = &result;
        }
        const VariantRequest& request = request_of(plan, result);
        std::vector<std::string> cells = {fmt::format("{}", result.row + 1),
                                          shortened(technique_of(request), technique),
                                          shortened(settings_of(request), knobs), request.target};
        for (int count : {slots->arithmetic, slots->texture, slots->temps, slots->dependent_level})
            cells.push_back(fmt::format("{}", count));
        cells.push_back(number(result.reads_mean, 2));
        std::vector<const measure::HitStatistics*> all = {&result.hits};
        for (const measure::HitStatistics& hits : result.narrow_hits) all.push_back(&hits);
        for (const measure::HitStatistics* hits : all)
            cells.push_back(hits->pixels > hits->invalid ? texels(hits->p95) : "-");
        for (const measure::HitStatistics* hits : all)
            cells.push_back(share(hits->missed, hits->pixels));
        grid.lines.push_back(std::move(cells));
    }
    flush();
    return text;
}

std::vector<double> elevations_of(const Plan& plan) {
    std::vector<double> elevations;
    for (Direction view : plan.views)
        if (std::find(elevations.begin(), elevations.end(), view.elevation) == elevations.end())
            elevations.push_back(view.elevation);
    return elevations;
}

// The largest p95 of a row on a map at an elevation, over azimuths and lights; nothing where no
// pixel reported a hit in one of them, because then the largest is not known.
std::optional<double> largest_p95(const Measurement& measurement, int map, std::size_t row,
                                  double elevation) {
    std::optional<double> largest;
    for (const CaseResult& result : measurement.cases) {
        if (result.map != map || static_cast<std::size_t>(result.row) != row ||
            result.view.elevation != elevation)
            continue;
        if (!has_hits(result)) return std::nullopt;
        largest = std::max(largest.value_or(0), result.hits.p95);
    }
    return largest;
}

// How many cases share a map, a row and an elevation, at most.
std::size_t most_merged(const Plan& plan) {
    std::size_t most = 0;
    for (double elevation : elevations_of(plan))
        most = std::max(most, static_cast<std::size_t>(std::count_if(
                                  plan.views.begin(), plan.views.end(),
                                  [&](Direction view) { return view.elevation == elevation; })));
    return most * plan.lights.size();
}

// What a table says of a row on a map at an elevation.
using Cell = std::function<std::string(int map, std::size_t row, double elevation)>;

// A table for each map: a line for each row, a column for each elevation.
std::string overview(const Plan& plan, const Measurement& measurement, std::string_view title,
                     const Cell& cell) {
    constexpr std::size_t columns_at_once = 8;
    const std::vector<double> elevations = elevations_of(plan);
    if (elevations.size() < 2 || measurement.cases.empty()) return "";
    const auto [technique, knobs] = label_widths(plan, measurement);
    std::string text;
    for (std::size_t map = 0; map < plan.maps.size(); ++map) {
        text += fmt::format("{}: {} by elevation of the view\n", plan.maps[map].name, title);
        for (std::size_t first = 0; first < elevations.size(); first += columns_at_once) {
            const std::size_t last = std::min(elevations.size(), first + columns_at_once);
            Grid grid{{{"#", "technique", "knobs", "target"}}, 4};
            for (std::size_t i = first; i < last; ++i)
                grid.lines[0].push_back(fmt::format("{}", elevations[i]));
            for (std::size_t row = 0; row < plan.rows.size(); ++row) {
                const VariantRequest& request = plan.rows[row];
                grid.lines.push_back({fmt::format("{}", row + 1),
                                      shortened(technique_of(request), technique),
                                      shortened(settings_of(request), knobs), request.target});
                for (std::size_t i = first; i < last; ++i)
                    grid.lines.back().push_back(cell(static_cast<int>(map), row, elevations[i]));
            }
            text += print(grid) + "\n";
        }
    }
    return text;
}

// The case of a row that took longest beside the first row, with the quartiles of its rounds.
std::string largest_ratio(const Measurement& measurement, int map, std::size_t row,
                          double elevation) {
    const CaseResult* largest = nullptr;
    for (const CaseResult& result : measurement.cases)
        if (result.map == map && static_cast<std::size_t>(result.row) == row &&
            result.view.elevation == elevation && result.nanoseconds > 0 &&
            (largest == nullptr || result.ratio > largest->ratio))
            largest = &result;
    if (largest == nullptr) return "-";
    return fmt::format("{} ({}..{})", number(largest->ratio, 2), number(largest->ratio_low, 2),
                       number(largest->ratio_high, 2));
}

std::string overviews(const Plan& plan, const Measurement& measurement) {
    const bool merged = most_merged(plan) > 1;
    std::string text = overview(
        plan, measurement,
        merged ? "largest p95 over azimuths and lights, in texels," : "p95 hit error in texels",
        [&](int map, std::size_t row, double elevation) -> std::string {
            const auto p95 = largest_p95(measurement, map, row, elevation);
            return p95 ? texels(*p95) : "-";
        });
    if (plan.rounds > 0)
        text += overview(plan, measurement,
                         merged ? "largest time ratio to row 1 (quartiles) over azimuths and lights"
                                : "time ratio to row 1 (quartiles)",
                         [&](int map, std::size_t row, double elevation) {
                             return largest_ratio(measurement, map, row, elevation);
                         });
    return text;
}

std::string shortened_variants(const Plan& plan, const Measurement& measurement) {
    const auto [technique, knobs] = label_widths(plan, measurement);
    std::string text;
    for (std::size_t row = 0; row < plan.rows.size(); ++row) {
        const VariantRequest& request = plan.rows[row];
        if (width_of(technique_of(request)) <= technique && width_of(settings_of(request)) <= knobs)
            continue;
        text += fmt::format("#{}: {} {}\n", row + 1, technique_of(request), settings_of(request));
    }
    return text.empty() ? "" : text + "\n";
}

std::string legend(const Plan& plan, const Measurement& measurement) {
    std::string text =
        "alu/tex/all  SPIR-V instructions of the shaded pixel stage after spirv-opt (SPIRV-Tools), "
        "not of any GPU\n"
        "reads        texture reads executed per pixel by search and shadow, mean, counted on the "
        "run\n";
    if (has_direct3d9(measurement))
        text +=
            "             of ps_*: arithmetic + texture slots by Direct3D's charge, temporary "
            "registers, level of dependent reads;\n"
            "             hits and reads are the bytecode's, interpreted: in fp32, R300's fp24 "
            "(s16e7), and fp16 as if\n"
            "             every instruction said _pp; times are those of MojoShader's "
            "translation\n";
    if (plan.rounds > 0)
        text += fmt::format(
            "time, ns/px  median of {} interleaved rounds, time relative to row 1 of its block; "
            "compare within a block only;\n"
            "             on {}\n",
            plan.rounds, measurement.device);
    else
        text += fmt::format("time, ns/px  not taken; drawn on {}\n", measurement.device);
    text += fmt::format(
        "median..max  distance in texels from the reported hit to the exact first hit (double "
        "precision reference),\n"
        "             over {} x {} pixels without NaN; relief scale {}, {} filtering\n"
        "miss%        pixels whose ray had left the relief again before the reported hit\n"
        "shad%        pixels within a texel of the exact hit whose shadow is not the exact one, of "
        "all pixels\n"
        "NaN          pixels with NaN or Inf in the hit / in the shaded colour\n",
        plan.size, plan.size, plan.scale, name_of(plan.filtering));
    return text;
}

}  // namespace

std::string table(const Plan& plan, const Measurement& measurement) {
    return blocks(plan, measurement) + direct3d9_blocks(plan, measurement) +
           overviews(plan, measurement) + shortened_variants(plan, measurement) +
           legend(plan, measurement);
}

}  // namespace intaglio::report
