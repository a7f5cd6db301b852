// Spans to directions.
#include "src/plan/rays.h"

#include <algorithm>
#include <cmath>

namespace intaglio::plan {
namespace {

using measure::Direction;

constexpr double golden = 0.6180339887498949;  // spreads any number of points evenly
constexpr double kind_within = 3;              // degrees from an axis or a diagonal

// The k-th azimuth of a span.
double azimuth_of(const scene::Span& span, int k) {
    if (span.is_one()) return span.least;
    const double share = std::fmod(0.19 + k * golden, 1.0);
    double azimuth = span.least + share * (span.most - span.least);
    const double off = std::remainder(azimuth, 45.0);
    if (std::abs(off) < kind_within) {
        const double moved = azimuth + std::copysign(kind_within, off) - off;
        if (moved >= span.least && moved <= span.most) azimuth = moved;
    }
    return azimuth;
}

std::vector<Direction> directions_of(const scene::Span& elevation, const scene::Span& azimuth) {
    const double middle = (elevation.least + elevation.most) / 2;
    // The lowest twice: there rays are longest.
    std::vector<double> elevations = {elevation.least};
    if (!azimuth.is_one()) elevations.push_back(elevation.least);
    if (!elevation.is_one()) {
        elevations.push_back(middle);
        elevations.push_back(elevation.most);
    }
    std::vector<Direction> directions;
    for (const double each : elevations)
        directions.push_back({each, azimuth_of(azimuth, static_cast<int>(directions.size()))});
    return directions;
}

}  // namespace

bool can_reach(const scene::SurfaceLight& light) { return light.elevation.most > 0; }

Direction lowest_of(const scene::SurfaceLight& light) {
    // At or below the horizon every surface is dark, rightly so: the lowest that it shines.
    return {std::min(std::max(light.elevation.least, 0.5), light.elevation.most),
            azimuth_of(light.azimuth, 0)};
}

measure::Directions directions_of(const scene::SurfaceLight& light) {
    return {std::max(light.elevation.least, 0.05), std::max(light.elevation.most, 0.05),
            light.azimuth.least, light.azimuth.most};
}

Rays views_alone(Rays rays) {
    rays.shots.resize(std::min(rays.shots.size(), rays.views.size()));
    for (Shot& shot : rays.shots) {
        shot.light = rays.shots.front().light;
        shot.towards = rays.shots.front().towards;
    }
    return rays;
}

Rays rays_of(const scene::SceneSurface& surface, const std::vector<std::size_t>& lights, int size) {
    Rays rays;
    rays.size = size;
    rays.views = directions_of(surface.elevation, surface.azimuth);
    struct Lit {
        std::size_t light;
        Direction towards;
    };
    std::vector<Lit> lit;
    for (const std::size_t light : lights) {
        const scene::SurfaceLight& from = surface.lights[light];
        const Direction lowest = lowest_of(from);
        lit.push_back({light, lowest});
        if (lowest.elevation < from.elevation.most)
            lit.push_back({light, {from.elevation.most, azimuth_of(from.azimuth, 1)}});
        else if (!from.azimuth.is_one())
            lit.push_back({light, {lowest.elevation, azimuth_of(from.azimuth, 1)}});
    }
    if (lit.empty()) lit.push_back({0, {90, 0}});
    const std::size_t count = std::max(rays.views.size(), lit.size());
    for (std::size_t i = 0; i < count; ++i) {
        const Lit& from = lit[i % lit.size()];
        rays.shots.push_back({rays.views[i % rays.views.size()], from.light, from.towards});
    }
    return rays;
}

}  // namespace intaglio::plan
