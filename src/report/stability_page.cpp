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

std::string curve_section(const measure::StabilityCurve& curve) {
    std::string text = fmt::format(
        "### {}\n\n| | |\n|---|---|\n| published ({}) | `{}` |\n| here | `{}` |\n\n{} Error: "
        "{}.\n\n",
        curve.title, curve.source, curve.published, curve.ours, curve.verdict, curve.unit);
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

std::string stability_section(const std::vector<measure::StabilityCurve>& curves) {
    std::string text = "## Both forms\n\n";
    for (const measure::StabilityCurve& curve : curves) text += curve_section(curve);
    return text;
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
    for (const measure::GuardRow& row : guards) {
        text += fmt::format("| {} | `{}` |", measure::name_of(row.guard), row.surface);
        for (const measure::GuardCost& cost : row.costs)
            text += fmt::format(" {} |", cost_text(cost));
        text += fmt::format(" {} | {} | {} |\n", list_of(row.invalid), list_of(row.astray),
                            list_of(row.worse));
    }
    return text;
}

std::string stability_page(const std::vector<measure::StabilityCurve>& curves,
                           const std::vector<measure::GuardRow>& guards) {
    return std::string(introduction) + stability_section(curves) + guards_section(guards);
}

}  // namespace intaglio::report
