// The tables of a scene file and their keys: what the reader knows, docs/scene.md explains and
// docs/scene.schema.json lists.
#pragma once

#include <span>
#include <string_view>

namespace intaglio::scene {

inline constexpr std::string_view scene_keys[] = {"name",   "targets", "size",  "read_weight",
                                                  "view",   "camera",  "light", "tolerance",
                                                  "budget", "surface"};
inline constexpr std::string_view view_keys[] = {"elevation", "azimuth", "distance"};
inline constexpr std::string_view camera_keys[] = {"path",   "targets", "field_of_view",  "aspect",
                                                   "pixels", "near",    "least_elevation"};
inline constexpr std::string_view light_keys[] = {"name", "elevation", "azimuth", "place",
                                                  "shadows"};
inline constexpr std::string_view surface_keys[] = {
    "name",     "height_map", "normal_map", "colour_map", "baked",  "maker",   "width",
    "height",   "seed",       "scale",      "features",   "lights", "targets", "search",
    "shadow",   "normal",     "shading",    "output",     "vertex", "knobs",   "loops",
    "uniforms", "place",      "view",       "tolerance",  "budget"};
inline constexpr std::string_view place_keys[] = {"position", "normal", "tangent",
                                                  "mirrored", "size",   "repeat"};

struct KeyTable {
    std::string_view name;  // of the table, as in [surface.place]; empty: the whole file
    std::span<const std::string_view> keys;
};
// Metrics (docs/budgets.md) are the keys of [tolerance] and [budget], and are not among these.
inline constexpr KeyTable key_tables[] = {
    {"", scene_keys},      {"view", view_keys},       {"camera", camera_keys},
    {"light", light_keys}, {"surface", surface_keys}, {"surface.place", place_keys},
};

}  // namespace intaglio::scene
