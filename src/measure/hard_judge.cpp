// Verdicts.
#include "src/measure/hard_judge.h"

#include <algorithm>
#include <cmath>

#include "generator/ir/narrow.h"

namespace intaglio::measure {
namespace {

// Of the rounding of a dozen operations, each by an ulp: more than that is no rounding.
constexpr double roundings = 32;

// Of 255: half a step of an 8-bit read, under light of strength 2, and what is shown of it.
constexpr double colour_steps = 2;

double epsilon(Way way) {
    return way == Way::Narrow16 ? 0x1p-10 : way == Way::Narrow24 ? 0x1p-16 : 0x1p-23;
}

double percentile95(std::vector<double> values) {
    if (values.empty()) return 0;
    const auto at =
        values.begin() +
        static_cast<std::ptrdiff_t>(std::lround(0.95 * static_cast<double>(values.size() - 1)));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

bool finite(const HardOutcome& outcome) {
    return std::all_of(outcome.value.begin(), outcome.value.end(),
                       [](double c) { return std::isfinite(c); }) &&
           std::isfinite(outcome.depth);
}

// Whether a hit lies on the ray between the polygon and the ray's end, and its height in [0, 1], up
// to rounding.
bool on_the_ray(const HardRay& ray, const HardOutcome& outcome, Way way) {
    const double height_slack = roundings * epsilon(way);
    if (outcome.value[2] < -height_slack || outcome.value[2] > 1 + height_slack) return false;
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const double reach = ray.reach[axis], travelled = ray.uv[axis] - outcome.value[axis];
        const double slack =
            std::abs(reach) * roundings * epsilon(way) +
            roundings *
                unit_in_the_last_place(std::max(std::abs(reach), std::abs(ray.uv[axis])), way);
        if (travelled < std::min(reach, 0.0) - slack || travelled > std::max(reach, 0.0) + slack)
            return false;
    }
    return true;
}

struct Judge {
    const HardRow& row;
    const HardCase& hard_case;
    Expect expect;
    Way way;
    const reference::HeightField& field;
    std::span<const HardRay> rays;
    std::span<const HardOutcome> outcomes;

    double texels(std::array<double, 2> a, std::array<double, 2> b) const {
        return std::hypot((a[0] - b[0]) * field.width, (a[1] - b[1]) * field.height);
    }

    bool missed(const HardRay& ray, const HardOutcome& outcome) const {
        const double squared = ray.reach[0] * ray.reach[0] + ray.reach[1] * ray.reach[1];
        if (!ray.exact.found || squared == 0) return false;
        const double t = ((ray.uv[0] - outcome.value[0]) * ray.reach[0] +
                          (ray.uv[1] - outcome.value[1]) * ray.reach[1]) /
                         squared;
        return reference::leaves_relief(field, {ray.uv[0], ray.uv[1]}, ray.view, hard_case.scale,
                                        ray.exact.t, std::min(t, 1.0));
    }

    HardCell search() const {
        HardCell cell;
        std::vector<double> distances;
        double best = 0;  // what the format allows at most
        int went_through = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const HardRay& ray = rays[i];
            const HardOutcome& outcome = outcomes[i];
            if (!finite(outcome)) {
                ++cell.invalid;
                continue;
            }
            if (!on_the_ray(ray, outcome, way)) ++cell.astray;
            const std::array<double, 2> hit = {outcome.value[0], outcome.value[1]};
            std::array<double, 2> wanted = {ray.exact.uv.x, ray.exact.uv.y};
            if (expect == Expect::Undisplaced)
                wanted = {held(ray.uv[0], way), held(ray.uv[1], way)};
            else if (row.yardstick == HardYardstick::OwnFormula)
                wanted = {outcome.own[0], outcome.own[1]};
            if (expect != Expect::OnFlattest) distances.push_back(texels(hit, wanted));
            const bool follows = row.yardstick == HardYardstick::FirstHit &&
                                 expect != Expect::OnFlattest && expect != Expect::Undisplaced;
            went_through += follows && missed(ray, outcome);
            best = std::max(best, unit_in_the_last_place(ray.uv[0], way));
        }
        cell.amount = percentile95(distances);
        cell.missed = static_cast<double>(went_through) / static_cast<double>(rays.size());
        const double sides = std::max(field.width, field.height);
        const double allowed = expect == Expect::Undisplaced                       ? 0.0
                               : expect == Expect::Within16th && row.within <= 0.5 ? 1.0 / 16
                               : expect == Expect::FormatsBest ? row.within + 2 * best * sides
                                                               : row.within;
        const bool all_equal =
            expect != Expect::Undisplaced ||
            std::all_of(distances.begin(), distances.end(), [](double d) { return d == 0; });
        cell.verdict = cell.amount <= allowed && went_through == 0 && all_equal ? Verdict::Fine
                                                                                : Verdict::Degraded;
        return cell;
    }

    HardCell shadow() const {
        HardCell cell;
        std::vector<double> steps;
        int judged = 0, wrong = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const HardOutcome& outcome = outcomes[i];
            const double visibility = outcome.value[3];
            if (!finite(outcome)) {
                ++cell.invalid;
                continue;
            }
            const double slack = roundings * epsilon(way);
            cell.astray += visibility < -slack || visibility > 1 + slack;
            steps.push_back(std::abs(visibility - outcome.own[3]) * 255);
            const std::array<double, 2> hit = {outcome.value[0], outcome.value[1]};
            const bool by_truth = expect == Expect::Shadow;
            if (by_truth && texels(hit, {rays[i].exact.uv.x, rays[i].exact.uv.y}) > 1) continue;
            const bool truth = by_truth ? rays[i].lit : expect == Expect::Lit;
            ++judged;
            wrong += (visibility >= 0.5) != truth;
        }
        if (expect == Expect::OwnFormula || row.yardstick == HardYardstick::OwnFormula) {
            cell.amount = percentile95(steps);
            cell.verdict = cell.amount <= colour_steps ? Verdict::Fine : Verdict::Degraded;
            return cell;
        }
        cell.amount = judged == 0 ? 0 : static_cast<double>(wrong) / judged;
        const double allowed = expect == Expect::Shadow ? 0.05 : 0;
        cell.verdict = cell.amount <= allowed ? Verdict::Fine : Verdict::Degraded;
        return cell;
    }

    HardCell colour() const {
        HardCell cell;
        std::vector<double> steps;
        for (const HardOutcome& outcome : outcomes) {
            if (!finite(outcome)) {
                ++cell.invalid;
                continue;
            }
            double most = 0;
            bool negative = outcome.depth < 0 || outcome.depth > 1;
            for (std::size_t c = 0; c < 3; ++c) {
                negative = negative || outcome.value[c] < 0;
                const auto shown = [](double value) { return std::clamp(value, 0.0, 1.0) * 255; };
                most = std::max(most, std::abs(shown(outcome.value[c]) - shown(outcome.own[c])));
            }
            cell.astray += negative;
            steps.push_back(most);
        }
        cell.amount = percentile95(steps);
        cell.verdict = cell.amount <= colour_steps ? Verdict::Fine : Verdict::Degraded;
        return cell;
    }
};

}  // namespace

double unit_in_the_last_place(double value, Way way) {
    if (value == 0 || !std::isfinite(value)) return 0;
    return std::ldexp(epsilon(way), std::ilogb(value));
}

double held(double value, Way way) {
    if (way == Way::Narrow24) return ir::Format24::round(value);
    if (way == Way::Narrow16) return ir::Format16::round(value);
    return static_cast<float>(value);
}

HardRay from_held_coordinate(const HardRay& ray, const reference::HeightField& field, double scale,
                             Way way) {
    HardRay moved = ray;
    for (double& coordinate : moved.uv) coordinate = held(coordinate, way);
    moved.inputs["uv"] = {moved.uv[0], moved.uv[1], 0, 0};
    moved.exact = reference::first_hit(field, {moved.uv[0], moved.uv[1]}, moved.view, scale);
    return moved;
}

bool has_numbers_for(const HardRay& ray, Way way) {
    return std::all_of(ray.inputs.begin(), ray.inputs.end(), [&](const auto& input) {
        return input.first == "depth_line" ||
               std::all_of(input.second.begin(), input.second.end(),
                           [&](double value) { return std::isfinite(held(value, way)); });
    });
}

HardCell judge(const HardRow& row, const HardCase& hard_case, Expect expect, Way way,
               const reference::HeightField& field, std::span<const HardRay> rays,
               std::span<const HardOutcome> outcomes) {
    const Judge judge{row, hard_case, expect, way, field, rays, outcomes};
    HardCell cell = row.part == HardPart::Search   ? judge.search()
                    : row.part == HardPart::Shadow ? judge.shadow()
                                                   : judge.colour();
    cell.rays = static_cast<int>(rays.size());
    if (cell.invalid > 0 || cell.astray > 0) cell.verdict = Verdict::Broken;
    return cell;
}

std::optional<Expect> expected_of(const HardRow& row, const HardCase& hard_case) {
    for (const auto& [part, expect] : hard_case.expects)
        if (part == row.part) return expect;
    return {};
}

}  // namespace intaglio::measure
