// Extremes over azimuths are taken at the ends of the range and at the angles inside it where the
// function turns.
#include "src/measure/relief_facts.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace intaglio::measure {
namespace {

using reference::HeightField;

constexpr double slack = 0x1p-16;

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

// Calls visit with both ends of the azimuths and every angle + k * period between them, in radians.
template <typename Visit>
void for_azimuths(const Directions& directions, double angle, double period, Visit&& visit) {
    const double least = radians(directions.least_azimuth), most = radians(directions.most_azimuth);
    visit(least);
    visit(most);
    for (double at = angle + std::ceil((least - angle) / period) * period; at <= most; at += period)
        visit(at);
}

passes::Interval widened(double least, double most) {
    return {static_cast<float>(least - slack), static_cast<float>(most + slack)};
}

// The least and the greatest of what `of` gives over all angles and both ends of the elevations.
template <typename Of>
passes::Interval range_over(const Directions& directions, Of of) {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    std::vector<double> elevations = {radians(directions.least_elevation),
                                      radians(directions.most_elevation)};
    if (directions.least_elevation < 0 && directions.most_elevation > 0) elevations.push_back(0);
    for (double elevation : elevations)
        for_azimuths(directions, 0, std::numbers::pi / 2, [&](double azimuth) {
            const double value = of(elevation, azimuth);
            least = std::min(least, value);
            most = std::max(most, value);
        });
    return widened(least, most);
}

// The four corners of a patch from texel (x, y), which repeats or ends at the map's border.
struct Corners {
    double h00, h10, h01, h11;

    Corners(const HeightField& field, int x, int y) {
        const auto next = [&](int i, int size) {
            if (field.wrap == reference::Wrap::Repeat) return (i + 1) % size;
            return std::min(i + 1, size - 1);
        };
        const int right = next(x, field.width), below = next(y, field.height);
        const auto at = [&](int i, int j) {
            return field
                .heights[static_cast<std::size_t>(j) * static_cast<std::size_t>(field.width) +
                         static_cast<std::size_t>(i)];
        };
        h00 = at(x, y);
        h10 = at(right, y);
        h01 = at(x, below);
        h11 = at(right, below);
    }
};

}  // namespace

std::array<passes::Interval, 3> vector_ranges(const Directions& directions) {
    return {range_over(directions, [](double e, double a) { return std::cos(e) * std::cos(a); }),
            range_over(directions, [](double e, double a) { return std::cos(e) * std::sin(a); }),
            range_over(directions, [](double e, double) { return std::sin(e); })};
}

passes::Interval channel_range(const vulkan::Texture& texture, int channel) {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const std::vector<float>& level : texture.levels) {
        const std::vector<float> stored =
            vulkan::decode(vulkan::encode(level, texture.format), texture.format);
        for (std::size_t i = static_cast<std::size_t>(channel); i < stored.size(); i += 4) {
            least = std::min(least, static_cast<double>(stored[i]));
            most = std::max(most, static_cast<double>(stored[i]));
        }
    }
    return widened(least, most);
}

ReliefFacts relief_facts(const HeightField& field) {
    assert(reference::is_valid(field));
    const auto [least, most] = std::minmax_element(field.heights.begin(), field.heights.end());
    return {field.width, field.height, *least, *most};
}

double steepest_slope(const HeightField& field, double scale, const Directions& directions) {
    assert(reference::is_valid(field));
    double steepest = 0;
    const auto look_at = [&](double u, double v) {
        const double size = std::hypot(u, v);
        if (size <= steepest) return;  // whatever the azimuth
        for_azimuths(directions, std::atan2(v, u), 2 * std::numbers::pi, [&](double azimuth) {
            steepest = std::max(steepest, u * std::cos(azimuth) + v * std::sin(azimuth));
        });
    };
    const double across = field.width * scale, down = field.height * scale;
    for (int y = 0; y < field.height; ++y)
        for (int x = 0; x < field.width; ++x) {
            const Corners h(field, x, y);
            const double top = (h.h10 - h.h00) * across, bottom = (h.h11 - h.h01) * across;
            const double left = (h.h01 - h.h00) * down, right = (h.h11 - h.h10) * down;
            for (double u : {top, bottom})
                for (double v : {left, right}) look_at(u, v);
        }
    return steepest;
}

bool casts_no_shadow(const HeightField& field, double scale, const Directions& directions) {
    if (directions.least_elevation <= 0) return false;
    if (directions.least_elevation >= 90) return true;
    // The margin is for the rounding of the tangent and of the slopes.
    return steepest_slope(field, scale, directions) * (1 + 1e-12) <=
           std::tan(radians(directions.least_elevation));
}

RayReach ray_reach(const ReliefFacts& facts, double scale, const Directions& directions,
                   double from, double to) {
    const double elevation = radians(std::min(directions.least_elevation, 90.0));
    const double flat = directions.least_elevation >= 90 ? 0 : 1 / std::tan(elevation);
    const double reach = flat * scale * std::fabs(from - to);
    const double across = reach * facts.width, down = reach * facts.height;
    RayReach result;
    const auto look_at = [&](double azimuth) {
        const double u = across * std::fabs(std::cos(azimuth)),
                     v = down * std::fabs(std::sin(azimuth));
        result.along_u = std::max(result.along_u, u);
        result.along_v = std::max(result.along_v, v);
        result.longer = std::max({result.longer, u, v});
        result.added = std::max(result.added, u + v);
    };
    // The axes, where one is greatest; the angles at which both together are, in each quadrant.
    for_azimuths(directions, 0, std::numbers::pi / 2, look_at);
    const double both = std::atan2(down, across);
    for_azimuths(directions, both, std::numbers::pi, look_at);
    for_azimuths(directions, -both, std::numbers::pi, look_at);
    return result;
}

int RayReach::cells() const {
    constexpr double most = 1 << 30;
    return static_cast<int>(std::min(std::floor(added), most)) + 5;
}

int RayReach::steps() const {
    constexpr double most = 1 << 30;
    return std::max(1, static_cast<int>(std::min(std::ceil(longer), most)));
}

RayReach view_reach(const ReliefFacts& facts, double scale, const Directions& directions) {
    return ray_reach(facts, scale, directions, 1, facts.least);
}

RayReach view_reach_below_top(const ReliefFacts& facts, double scale,
                              const Directions& directions) {
    return ray_reach(facts, scale, directions, facts.most, facts.least);
}

RayReach light_reach(const ReliefFacts& facts, double scale, const Directions& directions) {
    return ray_reach(facts, scale, directions, facts.least, facts.most);
}

int useful_halvings(const RayReach& reach, int steps, double texels) {
    int halvings = 0;
    for (double left = reach.longer / std::max(steps, 1); left > texels && halvings < 64; left /= 2)
        ++halvings;
    return halvings;
}

}  // namespace intaglio::measure
