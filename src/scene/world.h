// The parts of a scene file that say where things are: view, camera, lights, places.  Inside
// src/scene only.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "src/scene/geometry.h"
#include "src/scene/reader.h"

namespace intaglio::scene {

// [view]: what is missing comes from the camera's path, or from the defaults of SceneSurface.
struct ViewEntry {
    std::optional<Span> elevation, azimuth, distance;
};
// `view` in the document or a surface; `title` as in "[view]".
ViewEntry read_view(Reader& reader, const Value& parent, std::string_view title);

// [camera]; its path may be empty.
std::optional<Camera> read_camera(Reader& reader, const Value& document);

struct LightEntry {
    std::string name;
    Span elevation, azimuth{0, 360};
    std::optional<Point> place;
    bool shadows = true;
};
std::vector<LightEntry> read_lights(Reader& reader, const Value& document);

struct PlaceEntry {
    Place place;
    double repeat_u = 1, repeat_v = 1;
};
// [surface.place].
PlaceEntry read_place(Reader& reader, const Value& surface);

}  // namespace intaglio::scene
