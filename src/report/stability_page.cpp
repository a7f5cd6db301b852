// Tables of the errors, with a bar for the eye: one mark for each factor of ten above 1e-8.
#include "src/report/stability_page.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace intaglio::report {
namespace {

constexpr std::string_view introduction = R"(# Stability by construction

Written by `intaglio stability -o docs/stability.md`; a test writes it again and compares. Where a formula as published is
unstable, the templates hold another form of it. Both are recorded in the DSL here and evaluated on the same inputs;
truth is binary64 on the inputs as the format holds them, so that what is left is the arithmetic's own error. Each
number is the greatest of eight inputs around the one named, absolute unless said. fp24 and fp16 have the edge values
of the Direct3D 9 reference, where rcp(0) and rsq(0) are the largest finite number: what is NaN in fp32 is a wrong
finite number there.

)";

constexpr std::string_view guards_introduction = R"(## What guards cost

Arithmetic slots of the pixel stage by Direct3D's charge, and SPIR-V instructions after optimisation, with the guard and
without it: the recorded IR with the guard's instructions left out. "Refused" is a surface that the profile cannot
hold. The last columns are the [hard cases](hard-cases.md) in fp32 without it: those with NaN or Inf, those with a finite
value that means nothing, and those that are fine with the guard and degraded without. No case needs the unit interval
in fp32, and on Direct3D 9 it is a modifier that costs nothing: it bounds a hit where a map or a driver breaks its
promise.

)";

constexpr std::string_view far_introduction = R"(## Every search far from the origin

How far a hit moves along its ray when the coordinate moves by that many whole tiles, in texels of a 1024 map: with rays
that start at the coordinate → with `local_origin=1`, where they start at its place in the first tile of the repeated
map. The eye stands 18 degrees above a smooth map, each number is the greatest of 32 places that the format holds in both
tiles. With the knob hit and shadow are the same to the bit wherever a format holds the coordinate, in every search; a
test says so. What reads the map at the coordinate alone leaves the tile to the texture unit, and loses nothing without.

)";

constexpr std::string_view far_costs_introduction = R"(
The knob is 0 by default, [docs/architecture.md](architecture.md) says why. `local_origin=1` reads colours and normals at
the continuous coordinate, whose jump between tiles would otherwise choose the coarsest level where the target has no
gradients; `local_origin=2` reads them in the first tile too: for targets with gradients, and for maps of one level. Only
repeated maps have tiles: a clamped one wants 0. Arithmetic slots:

| surface | target | 0 | 1 | 2 |
|---|---|---|---|---|
)";

// "3.1e-07" with as many marks as it has decades above 1e-8, nine at most.
std::string cell(double error) {
    if (std::isnan(error)) return "**NaN**";
    if (std::isinf(error)) return "**Inf**";
    if (error == 0) return "0";
    const int decades = std::clamp(static_cast<int>(std::floor(std::log10(error) + 8)), 0, 9);
    return fmt::format("{:.0e} {}", error, std::string(static_cast<std::size_t>(decades), '|'));
}

// A bar holds the sign that ends a cell.
std::string escaped(std::string text) {
    for (std::size_t at = text.find('|'); at != std::string::npos; at = text.find('|', at + 3))
        text.replace(at, 1, "\u25aa");
    return text;
}

std::string curve_section(const measure::StabilityCurve& curve, const std::string& pictures) {
    std::string text = fmt::format(
        "### {}\n\n| | |\n|---|---|\n| published ({}) | `{}` |\n| here | `{}` |\n\n{} Error: "
        "{}.\n\n![{}: error of both forms]({}/{}.svg)\n\n",
        curve.title, curve.source, curve.published, curve.ours, curve.verdict, curve.unit,
        curve.title, pictures, file_name(curve.title));
    text +=
        "| | published fp32 | here fp32 | published fp24 | here fp24 | published fp16 | here "
        "fp16 |\n|---|---|---|---|---|---|---|\n";
    for (const measure::StabilityPoint& point : curve.points) {
        text += fmt::format("| {} |", point.at);
        for (std::size_t i = 0; i < measure::stability_precisions.size(); ++i)
            text += fmt::format(" {} | {} |", escaped(cell(point.published[i])),
                                escaped(cell(point.ours[i])));
        text += "\n";
    }
    return text + "\n";
}

std::string_view name_of(ir::Precision precision) {
    switch (precision) {
        case ir::Precision::Double: return "fp64";
        case ir::Precision::Single: return "fp32";
        case ir::Precision::Narrow24: return "fp24";
        case ir::Precision::Narrow16: return "fp16";
    }
    return {};
}

std::string amount(double texels) { return texels == 0 ? "0" : fmt::format("{:.0e}", texels); }

// Of a plot's error axis: what counts as 0, the last decade, and where NaN and Inf stand.
constexpr double lowest = 1e-9, highest = 1e3, no_number = 3e4;

// Points by their place in the curve.
struct Series {
    std::string numbers, others;
};
Series series_of(const measure::StabilityCurve& curve, std::size_t precision, bool published) {
    Series series;
    for (std::size_t i = 0; i < curve.points.size(); ++i) {
        const measure::StabilityPoint& point = curve.points[i];
        const double error = (published ? point.published : point.ours)[precision];
        if (std::isfinite(error))
            series.numbers += fmt::format("{} {:.3g}\n", i, std::clamp(error, lowest, highest));
        else
            series.others += fmt::format("{} {:g}\n", i, no_number);
    }
    return series;
}

// "'90' 0, '89.9' 1": without what stands in brackets.
std::string tick_labels(const measure::StabilityCurve& curve) {
    std::string labels;
    for (std::size_t i = 0; i < curve.points.size(); ++i)
        labels += fmt::format("{}'{}' {}", i == 0 ? "" : ", ",
                              curve.points[i].at.substr(0, curve.points[i].at.find(" (")), i);
    return labels;
}

// Without what the page says after the first sentence.
std::string plot_unit(const std::string& unit) { return unit.substr(0, unit.find(';')); }

std::string cost_text(const measure::GuardCost& cost) {
    const auto slots = [](const std::optional<int>& count) {
        return count ? std::to_string(*count) : std::string("refused");
    };
    if (cost.with == cost.without) return slots(cost.with);
    return fmt::format("{}, without {}", slots(cost.with), slots(cost.without));
}

std::string list_of(const std::vector<std::string>& names) {
    if (names.size() <= 6) return fmt::format("{}", fmt::join(names, ", "));
    return fmt::format("{} and {} more", fmt::join(names.begin(), names.begin() + 6, ", "),
                       names.size() - 6);
}

}  // namespace

std::string stability_section(const std::vector<measure::StabilityCurve>& curves,
                              const std::string& pictures) {
    std::string text = "## Both forms\n\n";
    for (const measure::StabilityCurve& curve : curves) text += curve_section(curve, pictures);
    return text;
}

std::string far_section(const std::vector<measure::FarRow>& rows,
                        const std::vector<measure::FarCost>& costs) {
    std::string text(far_introduction), line = "|---|";
    text += "| search |";
    for (const measure::FarPlace& place : measure::far_places) {
        text += fmt::format(" {}, {:g} |", name_of(place.precision), place.tiles);
        line += "---|";
    }
    text += "\n" + line + "\n";
    for (const measure::FarRow& row : rows) {
        text += fmt::format("| `{}` |", row.search);
        for (std::size_t i = 0; i < row.without.size(); ++i)
            text += fmt::format(" {} → {} |", amount(row.without[i]), amount(row.with[i]));
        text += "\n";
    }
    text += far_costs_introduction;
    for (const measure::FarCost& cost : costs) {
        text += fmt::format("| `{}` | {} |", cost.surface, cost.target);
        for (const std::optional<int>& slots : cost.slots)
            text += slots ? fmt::format(" {} |", *slots) : std::string(" refused |");
        text += "\n";
    }
    return text + "\n";
}

std::string guards_section(const std::vector<measure::GuardRow>& guards) {
    std::string text(guards_introduction);
    std::string header = "| guard | surface |", line = "|---|---|";
    if (!guards.empty())
        for (const measure::GuardCost& cost : guards.front().costs) {
            header += fmt::format(" {} |", cost.target);
            line += "---|";
        }
    text += header + " NaN or Inf | finite nonsense | degraded |\n" + line + "---|---|---|\n";
    for (const measure::GuardRow& row : guards) text += guard_line(row);
    return text;
}

std::string guard_line(const measure::GuardRow& row) {
    std::string text = fmt::format("| {} | `{}` |", measure::name_of(row.guard), row.surface);
    for (const measure::GuardCost& cost : row.costs) text += fmt::format(" {} |", cost_text(cost));
    return text + fmt::format(" {} | {} | {} |\n", list_of(row.invalid), list_of(row.astray),
                              list_of(row.worse));
}

Plot stability_plot(const measure::StabilityCurve& curve) {
    std::string script = fmt::format(
        "set terminal svg size 1000,340 background rgb 'white' font 'sans-serif,12' noenhanced\n"
        "set multiplot layout 1,3 title \"{}: error, {}\"\n"
        "set logscale y\nset grid ytics lc rgb '#dddddd' lt 1\nset xrange [-0.5:{}.5]\n"
        "set yrange [{:g}:{:g}]\nset ytics ('0' {:g}, '1e-6' 1e-6, '1e-3' 1e-3, '1' 1, "
        "'>= 1e3' {:g}, 'no number' {:g})\nset xtics rotate by 40 right ({})\n"
        "set key at graph 0.97, graph 0.88\n",
        curve.title, plot_unit(curve.unit), curve.points.size() - 1, lowest / 3, no_number * 4,
        lowest, highest, no_number, tick_labels(curve));
    for (std::size_t i = 0; i < measure::stability_precisions.size(); ++i) {
        const Series published = series_of(curve, i, true), ours = series_of(curve, i, false);
        script += fmt::format("set title '{}'\n", name_of(measure::stability_precisions[i])) +
                  "$published << EOD\n" + published.numbers + "EOD\n$none << EOD\n" +
                  published.others + "EOD\n$ours << EOD\n" + ours.numbers +
                  "EOD\n"
                  "plot $published with linespoints dt 2 lw 1.5 pt 4 ps 0.8 lc rgb '#d55e00' title "
                  "'published', ";
        if (!published.others.empty())
            script += "$none with points pt 2 ps 1 lw 2 lc rgb '#d55e00' notitle, ";
        // Of ours every value is a number: a test says so.
        script +=
            "$ours with linespoints lw 1.5 pt 7 ps 0.6 lc rgb '#0072b2' title 'here'\n"
            "set key off\nset format y ''\n";
    }
    return {file_name(curve.title), script + "unset multiplot\n"};
}

StabilityPage stability_page(const std::vector<measure::StabilityCurve>& curves,
                             const std::vector<measure::FarRow>& far,
                             const std::vector<measure::FarCost>& far_costs,
                             const std::vector<measure::GuardRow>& guards,
                             const std::string& pictures) {
    StabilityPage page;
    page.text = std::string(introduction) + stability_section(curves, pictures) +
                far_section(far, far_costs) + guards_section(guards);
    for (const measure::StabilityCurve& curve : curves) page.plots.push_back(stability_plot(curve));
    return page;
}

}  // namespace intaglio::report
