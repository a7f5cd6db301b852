// The rays that a surface is judged by: a few views and lights out of the spans that its scene
// allows, on a grid over the map.  Both ends of a span of elevations and its middle; azimuths
// spread over theirs, away from the axes and the diagonals of the map, along which rays are kind.
#pragma once

#include <optional>
#include <vector>

#include "src/measure/relief_facts.h"
#include "src/measure/view.h"
#include "src/scene/scene.h"

namespace intaglio::plan {

// One draw: every pixel of the grid has this view and sees the light from there.
struct Shot {
    measure::Direction view;
    std::size_t light = 0;  // of the surface
    measure::Direction towards;
};

struct Rays {
    std::vector<measure::Direction> views;
    std::vector<Shot> shots;  // every view and every light at its lowest and highest, in few draws
    int size = 61;            // pixels a side
};

// Whether a light is above the polygon at all, some of the time.
bool can_reach(const scene::SurfaceLight& light);

// `lights`: those of the surface that shots are wanted of; without any, one from straight above.
Rays rays_of(const scene::SceneSurface& surface, const std::vector<std::size_t>& lights, int size);
// One shot a view, the light where rays_of has it first.
Rays views_alone(Rays rays);
// Where a light stands at its lowest.
measure::Direction lowest_of(const scene::SurfaceLight& light);
// The same spans for bounds.
measure::Directions directions_of(const scene::SurfaceLight& light);

}  // namespace intaglio::plan
