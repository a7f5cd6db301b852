// View, camera, lights and places from the tree of a scene file.
#include "src/scene/world.h"

#include <fmt/format.h>

#include <limits>

#include "src/scene/keys.h"

namespace intaglio::scene {
namespace {

// "In (0, 90]": flatter than this is on edge.
constexpr double flattest = 1e-6;
constexpr double farthest = 1e9;  // world units
constexpr double nearest = 1e-6;
constexpr std::size_t most_points = 4096;
constexpr Range turns{-360, 360};

// Azimuths that go round more than once.
Span once_around(Reader& reader, const Value& table, Span azimuth) {
    if (azimuth.most - azimuth.least <= 360) return azimuth;
    reader.refuse(table.find("azimuth")->value.position, "scene-range",
                  fmt::format("azimuth is from {} to {}, more than once around", azimuth.least,
                              azimuth.most));
    return {0, 360};
}

std::optional<Span> optional_span(Reader& reader, const Value& table, std::string_view key,
                                  Range range) {
    if (!table.find(key)) return std::nullopt;
    return reader.span(table, key, {range.most, range.most}, range);
}

Point read_point(Reader& reader, const Value& value, std::string_view what) {
    const std::vector<double> numbers = reader.vector_of(value, what, 3, 3);
    return {numbers[0], numbers[1], numbers[2]};
}

Point read_point(Reader& reader, const Value& table, std::string_view key, Point fallback) {
    const Member* member = table.find(key);
    return member ? read_point(reader, member->value, key) : fallback;
}

std::vector<Point> read_points(Reader& reader, const Value& table, std::string_view key) {
    std::vector<Point> points;
    const Member* member = table.find(key);
    if (!member) return points;
    if (member->value.kind != Kind::Array || member->value.items.empty() ||
        member->value.items.front().kind != Kind::Array) {
        reader.refuse(member->value.position, "scene-type",
                      fmt::format("{} is a list of points: [[0, -3, 1.7], [4, -3, 1.7]]", key));
        return points;
    }
    if (member->value.items.size() > most_points) {
        reader.refuse(member->value.position, "scene-range",
                      fmt::format("{} has {} points, more than {}", key, member->value.items.size(),
                                  most_points));
        return points;
    }
    for (const Value& item : member->value.items)
        points.push_back(read_point(reader, item, fmt::format("a point of {}", key)));
    return points;
}

// Two positive numbers.
std::array<double, 2> read_pair(Reader& reader, const Value& table, std::string_view key) {
    const Member* member = table.find(key);
    if (!member) return {1, 1};
    const std::vector<double> numbers = reader.vector_of(member->value, key, 2, 2);
    for (double number : numbers)
        if (!(number >= nearest && number <= farthest)) {
            reader.refuse(member->value.position, "scene-range",
                          fmt::format("{} has {}, and must have two numbers above 0", key, number));
            return {1, 1};
        }
    return {numbers[0], numbers[1]};
}

}  // namespace

ViewEntry read_view(Reader& reader, const Value& parent, std::string_view title) {
    const Value& table = reader.table(parent, "view");
    reader.check_keys(table, title, view_keys);
    ViewEntry view;
    view.elevation = optional_span(reader, table, "elevation", {flattest, 90});
    view.azimuth = optional_span(reader, table, "azimuth", turns);
    if (view.azimuth) view.azimuth = once_around(reader, table, *view.azimuth);
    view.distance = optional_span(reader, table, "distance", {nearest, farthest});
    return view;
}

std::optional<Camera> read_camera(Reader& reader, const Value& document) {
    if (!document.find("camera")) return std::nullopt;
    const Value& table = reader.table(document, "camera");
    reader.check_keys(table, "[camera]", camera_keys);
    Camera camera;
    camera.path = read_points(reader, table, "path");
    camera.targets = read_points(reader, table, "targets");
    camera.field_of_view = reader.number(table, "field_of_view", camera.field_of_view, {1, 179});
    camera.aspect = reader.number(table, "aspect", camera.aspect, {0.01, 100});
    camera.pixels = static_cast<int>(reader.whole(table, "pixels", camera.pixels, {1, 65536}));
    camera.near = reader.number(table, "near", camera.near, {nearest, farthest});
    camera.least_elevation =
        reader.number(table, "least_elevation", camera.least_elevation, {flattest, 90});
    if (const Member* path = table.find("path"); path && document.find("view"))
        reader.refuse(path->position, "scene-conflict",
                      "a scene has either a [view] or the path of a camera, not both");
    const Member* targets = table.find("targets");
    if (targets && !reader.error() && camera.targets.size() != camera.path.size())
        reader.refuse(targets->position, "scene-conflict",
                      fmt::format("targets has {} and path {} points: one for each",
                                  camera.targets.size(), camera.path.size()));
    return camera;
}

std::vector<LightEntry> read_lights(Reader& reader, const Value& document) {
    std::vector<LightEntry> lights;
    for (const Value* table : reader.tables(document, "light")) {
        const bool known = reader.check_keys(*table, "[[light]]", light_keys);
        LightEntry light;
        light.name = reader.text(*table, "name", "");
        const Member* name = table->find("name");
        const Member* place = table->find("place");
        if (!name && known)
            reader.refuse(table->position, "scene-missing", "a [[light]] needs name");
        if (name && name->value.kind == Kind::String && light.name.empty())
            reader.refuse(name->value.position, "scene-empty", "the light's name is empty");
        if (!place && !table->find("elevation") && known)
            reader.refuse(table->position, "scene-missing",
                          "a [[light]] needs an elevation and azimuth, or a place");
        for (const char* key : {"elevation", "azimuth"})
            if (const Member* member = table->find(key); member && place)
                reader.refuse(member->position, "scene-conflict",
                              fmt::format("a light has either a place or {}, not both", key));
        light.elevation = reader.span(*table, "elevation", {90, 90}, {-90, 90});
        light.azimuth =
            once_around(reader, *table, reader.span(*table, "azimuth", {0, 360}, turns));
        if (place) light.place = read_point(reader, place->value, "place");
        light.shadows = reader.boolean(*table, "shadows", true);
        for (const LightEntry& other : lights)
            if (name && other.name == light.name)
                reader.refuse(name->value.position, "scene-duplicate",
                              fmt::format("two lights are called '{}'", light.name));
        lights.push_back(std::move(light));
    }
    return lights;
}

PlaceEntry read_place(Reader& reader, const Value& surface) {
    const Value& table = reader.table(surface, "place");
    reader.check_keys(table, "[surface.place]", place_keys);
    const Place upright;
    const Point normal = read_point(reader, table, "normal", upright.normal);
    const Point tangent = read_point(reader, table, "tangent", upright.tangent);
    const std::array<double, 2> size = read_pair(reader, table, "size");
    const std::array<double, 2> repeat = read_pair(reader, table, "repeat");
    const auto place =
        place_of(read_point(reader, table, "position", upright.position), normal, tangent,
                 reader.boolean(table, "mirrored", false), size[0], size[1]);
    if (place) return {*place, repeat[0], repeat[1]};
    const char* const wrong = table.find("tangent") ? "tangent" : "normal";
    if (!reader.error())
        reader.refuse(table.find(wrong)->value.position, "scene-conflict",
                      "normal and tangent must be directions at an angle to each other; give both "
                      "where the normal is along x");
    return {};
}

}  // namespace intaglio::scene
