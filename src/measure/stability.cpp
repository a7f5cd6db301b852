// Both forms are recorded as functions of up to four numbers.  Truth is computed in binary64 from
// the inputs as the format holds them, so that errors are those of the arithmetic alone.
#include "src/measure/stability.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "generator/dsl/control.h"
#include "generator/dsl/resources.h"
#include "generator/dsl/technique.h"
#include "generator/ir/narrow.h"

namespace intaglio::measure {
namespace {

using namespace dsl;

using Inputs = std::array<double, 4>;
using Truth = std::function<double(const Inputs&)>;
// a, b, c, d: four recorded numbers.
using Form = float1 (*)(float1 a, float1 b, float1 c, float1 d);

ir::Evaluator recorded(Form form) {
    ir::Module module;
    module.stage = ir::Stage::Function;
    module.name = "form";
    Recorder recorder(module);
    const float1 a = input<1>("a"), b = input<1>("b"), c = input<1>("c"), d = input<1>("d");
    const float1 result = form(a, b, c, d);
    module.outputs = {{"result", ir::float1, ir::Semantic::Result}};
    // The forms are ours and verify.
    (void)recorder.finish({result.id()});
    return ir::Evaluator(module);
}

double held(double value, ir::Precision precision) {
    if (precision == ir::Precision::Narrow24) return ir::Format24::round(value);
    if (precision == ir::Precision::Narrow16) return ir::Format16::round(value);
    return static_cast<float>(value);
}

struct Comparison {
    Form published, ours;
    Truth truth;
    // Divides the error; 1 where it is absolute.
    Truth unit = [](const Inputs&) { return 1.0; };
};

// The greatest error over the inputs; NaN and Inf win.
double worst(const ir::Evaluator& form, const Comparison& comparison,
             const std::vector<Inputs>& inputs, ir::Precision precision) {
    double most = 0;
    for (Inputs given : inputs) {
        ir::Environment environment;
        for (double& value : given) {
            value = held(value, precision);
            environment.inputs.push_back({value});
        }
        const double got = form.run(environment, precision).outputs[0][0];
        const double error = std::abs(got - comparison.truth(given)) / comparison.unit(given);
        if (!std::isfinite(got)) return got;
        most = std::max(most, error);
    }
    return most;
}

struct Sample {
    std::string at;
    std::vector<Inputs> inputs;
};

std::vector<StabilityPoint> compare(const Comparison& comparison,
                                    const std::vector<Sample>& samples) {
    const ir::Evaluator published = recorded(comparison.published),
                        ours = recorded(comparison.ours);
    std::vector<StabilityPoint> points;
    for (const Sample& sample : samples) {
        StabilityPoint point{sample.at, {}, {}};
        for (std::size_t i = 0; i < stability_precisions.size(); ++i) {
            const ir::Precision precision = stability_precisions[i];
            point.published[i] = worst(published, comparison, sample.inputs, precision);
            point.ours[i] = worst(ours, comparison, sample.inputs, precision);
        }
        points.push_back(std::move(point));
    }
    return points;
}

// Eight inputs around each value: one alone may round luckily.
std::vector<Inputs> around(const std::function<Inputs(double share)>& at) {
    std::vector<Inputs> all;
    for (int i = 0; i < 8; ++i) all.push_back(at(i / 8.0));
    return all;
}

// A view of 0 azimuth: a = V.x, b = V.z.
StabilityCurve ray() {
    std::vector<Sample> samples = {{"90 (straight down)", {{0, 1, 0, 0}}}};
    for (double degrees : {89.99, 89.9, 89.0, 80.0, 60.0, 30.0, 5.0, 1.0, 0.1})
        samples.push_back({fmt::format("{:g}", degrees), around([&](double share) {
                               const double angle =
                                   degrees * (1 - 0.001 * share) * std::numbers::pi / 180;
                               return Inputs{std::cos(angle), std::sin(angle), 0, 0};
                           })});
    return {"The view ray",
            "Brawley and Tatarchuk 2004, vParallax; DirectX SDK",
            "normalize(V.xy) * sqrt(1 - V.z * V.z) / V.z",
            "V.xy / V.z",
            "of max(offset, 1e-3), by the eye's elevation in degrees",
            "0 / 0 straight down, and near it the root of a difference of nearly equal numbers: at "
            "89.9 degrees the direction of an interpolated, normalised V decides about the "
            "length.  The quotient has one rounding everywhere, and is an instruction shorter.",
            compare({[](float1 x, float1 z, float1, float1) {
                         return x * rsqrt(x * x) * (sqrt(1.0f - z * z) / z);
                     },
                     [](float1 x, float1 z, float1, float1) { return x / max(z, Ray::least_z); },
                     [](const Inputs& v) { return v[0] / std::max(v[1], 1.0 / 1024); },
                     [](const Inputs& v) { return std::max(std::abs(v[0] / v[1]), 1e-3); }},
                    samples)};
}

// The segment between two samples: a, b the ray's heights, c, d the relief's.
StabilityCurve last_intersection() {
    std::vector<Sample> samples;
    for (double slope : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6})
        samples.push_back({fmt::format("{:g}", slope), around([&](double share) {
                               // The ray falls from 0.5 + slope to 0.5 - slope through relief at
                               // about 0.5.
                               const double lift = slope * (share - 0.5);
                               return Inputs{0.5 + slope, 0.5 - slope, 0.5 + lift, 0.5 + lift};
                           })});
    samples.push_back({"0 (both touch)", {{0.5, 0.5, 0.5, 0.5}}});
    return {"The last intersection",
            "Brawley and Tatarchuk 2004, listing; LearnOpenGL",
            "(y0 h1 - y1 h0) / ((y0 - h0) - (y1 - h1)), y the ray's heights and h the relief's",
            "y1 + (y0 - y1) * saturate(g1 / max(g1 - g0, 1e-18)), g = h - y",
            "height, by half the difference of the ray's two heights",
            "Published, products of heights near one half are subtracted and the difference "
            "divided: the error grows as the step shrinks, and a point where ray and relief touch "
            "at both samples is 0 / 0.  Ours stays between the two samples whatever the gaps are.",
            compare({[](float1 y0, float1 y1, float1 h0, float1 h1) {
                         return (y0 * h1 - y1 * h0) / ((y0 - h0) - (y1 - h1));
                     },
                     [](float1 y0, float1 y1, float1 h0, float1 h1) {
                         const float1 g0 = h0 - y0, g1 = h1 - y1;
                         return y1 + (y0 - y1) * ratio(g1, g1 - g0);
                     },
                     [](const Inputs& v) {
                         const double g0 = v[2] - v[0], g1 = v[3] - v[1];
                         return g1 == g0 ? v[1] : v[1] + (v[0] - v[1]) * g1 / (g1 - g0);
                     }},
                    samples)};
}

// The first root of a s^2 + b s + c with c below 0: what a bilinear patch asks.
StabilityCurve patch_root() {
    std::vector<Sample> samples;
    for (double bend : {1.0, 1e-2, 1e-4, 1e-6, 0.0})
        samples.push_back({fmt::format("{:g}", bend), around([&](double share) {
                               return Inputs{bend, 0.7 + 0.2 * share, -0.3 - 0.1 * share, 0};
                           })});
    return {"The root in a patch",
            "the school formula, as in Ramsey, Potter and Hansen 2004",
            "(-b + sqrt(b b - 4 a c)) / 2 a",
            "-2 c / (b + sqrt(b b - 4 a c)) for b >= 0",
            "of the patch, by the patch's bend a",
            "A patch between equal twists is a line, a = 0: published, the root is the difference "
            "of two equal numbers over 0.",
            compare({[](float1 a, float1 b, float1 c, float1) {
                         return (sqrt(b * b - 4.0f * a * c) - b) / (2.0f * a);
                     },
                     [](float1 a, float1 b, float1 c, float1) {
                         return -2.0f * c / max(b + sqrt(max(b * b - 4.0f * a * c, 0.0f)), tiny);
                     },
                     [](const Inputs& v) {
                         return -2 * v[2] / (v[1] + std::sqrt(v[1] * v[1] - 4 * v[0] * v[2]));
                     }},
                    samples)};
}

// A unit vector's x from a vector of length b along (0.6, 0.8): a = share of x.
StabilityCurve unit_vector() {
    std::vector<Sample> samples;
    for (double length : {1e4, 1.0, 1e-3, 1e-6, 1e-8, 1e-12, 1e-20, 0.0})
        samples.push_back(
            {fmt::format("{:g}", length), around([&](double share) {
                 const double angle = 0.3 + share;
                 return Inputs{length * std::cos(angle), length * std::sin(angle), 0, 0};
             })});
    const Truth truth = [](const Inputs& v) {
        const double length = std::hypot(v[0], v[1]);
        return length == 0 ? 0 : v[0] / std::max(length, 1e-9);
    };
    return {"A vector made unit",
            "every listing: normalize(v)",
            "v * rsqrt(dot(v, v))",
            "v * rsqrt(max(dot(v, v), 1e-18))",
            "of 1, by the vector's length; below 1e-9 the guard gives a shorter vector, which is "
            "what is expected here",
            "NaN spreads from a vertex without a tangent over its triangles.  Hardware of the "
            "Direct3D 9 years makes the largest finite number of rsq(0) and so 0 of the product: "
            "with the guard every back end does.  In 16 bits the guard is 0 itself, and the "
            "hardware's rule is what is left; 1e4 squared is no half.",
            compare({[](float1 x, float1 y, float1, float1) {
                         const float2 v(x, y);
                         return x * rsqrt(dot(v, v));
                     },
                     [](float1 x, float1 y, float1, float1) { return normalize(float2(x, y)).x(); },
                     truth},
                    samples)};
}

// One step out of a cone: a = ratio, b = gap, c = the ray's travel.
StabilityCurve cone_step() {
    std::vector<Sample> samples;
    for (double ratio_of : {1.0, 1e-2, 1e-4, 0.0})
        samples.push_back(
            {fmt::format("{:g}", ratio_of), {{ratio_of, 0.4, 0, 0}, {ratio_of, 0.25, 0.1, 0}}});
    return {
        "A step out of a cone",
        "Dummer 2006",
        "ratio * gap / (travel + ratio)",
        "ratio * gap / max(travel + ratio, 1e-18)",
        "height, by the cone's ratio, straight down and at a slant",
        "Straight down over the foot of a cliff travel and ratio are 0: the step is 0 then, and "
        "the march stands still until its steps are over, which the map's rounding keeps away.",
        compare(
            {[](float1 r, float1 gap, float1 travel, float1) { return r * gap / (travel + r); },
             [](float1 r, float1 gap, float1 travel, float1) {
                 return r * gap / max(travel + r, tiny);
             },
             [](const Inputs& v) { return v[0] + v[2] == 0 ? 0 : v[0] * v[1] / (v[0] + v[2]); }},
            samples)};
}

// The last of `count` steps of a / count along u from b.
template <int count>
void add_steps(std::vector<StabilityPoint>& points) {
    const std::vector<StabilityPoint> point = compare(
        {[](float1 reach, float1 u, float1, float1) {
             const float1 step = reach * (1.0f / count);
             float1 at = u;
             for (int i = 0; i < count; ++i) at = at + step;
             return at;
         },
         [](float1 reach, float1 u, float1, float1) {
             return u + reach * (static_cast<float>(count) * (1.0f / count));
         },
         [](const Inputs& v) { return v[1] + v[0]; }, [](const Inputs&) { return 1.0 / 1024; }},
        {{std::to_string(count), around([](double share) {
              return Inputs{0.17 + 0.1 * share, 0.33 + share / 7, 0, 0};
          })}});
    points.push_back(point.front());
}

StabilityCurve places_of_steps() {
    StabilityCurve curve{"Places along a march",
                         "McGuire and McGuire 2005, listing; most marches in use",
                         "uv += step, n times",
                         "uv + reach * (i / n)",
                         "texels of a 1024 map, by the number of steps",
                         "Roundings add up with the steps, and all to one side where the format "
                         "truncates; computed from its index a place has two roundings, and does "
                         "not wait for the place before.",
                         {}};
    add_steps<8>(curve.points);
    add_steps<32>(curve.points);
    add_steps<128>(curve.points);
    add_steps<512>(curve.points);
    return curve;
}

// A place on a ray from b, a t along it; both forms as a coordinate of the first tile.
StabilityCurve far_places() {
    std::vector<Sample> samples;
    for (double whole : {0.0, 1.0, 8.0, 64.0, 1000.0, 10000.0})
        samples.push_back(
            {fmt::format("{:g}", whole), around([&](double share) {
                 // Coordinates that every format holds: what is left is the march.
                 const double fraction = whole < 65 ? 0.25 : 0;
                 return Inputs{0.0713 + 0.05 * share, whole + fraction, 0.37 + 0.4 * share, 0};
             })});
    return {
        "Coordinates far from the origin",
        "every listing: texture(map, uv - reach * t)",
        "frac(uv - reach * t), the texture unit's wrap",
        "frac(frac(uv) - reach * t): the ray starts in the first tile",
        "texels of a 1024 map, by the coordinate's whole part",
        "The whole part takes its bits from the place in the tile.  Moved first, which is "
        "exact, places along the ray keep the precision of the first tile at any distance; "
        "what the coordinate itself has lost before, no form brings back.  exact, "
        "steep_parallax with stride 3 and the exact shadow start so, the other searches with "
        "local_origin = 1.",
        compare({[](float1 reach, float1 u, float1 t, float1) { return frac(u - reach * t); },
                 [](float1 reach, float1 u, float1 t, float1) { return frac(frac(u) - reach * t); },
                 [](const Inputs& v) {
                     const double at = v[1] - v[0] * v[2];
                     return at - std::floor(at);
                 },
                 [](const Inputs&) { return 1.0 / 1024; }},
                samples)};
}

}  // namespace

std::vector<StabilityCurve> stability_curves() {
    return {ray(),       last_intersection(), patch_root(), unit_vector(),
            cone_step(), places_of_steps(),   far_places()};
}

}  // namespace intaglio::measure
