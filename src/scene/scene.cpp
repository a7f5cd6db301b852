// From the tree of a scene file to surfaces: first every word is checked, then the world is turned
// into each surface's tangent space, then the maps are loaded.
#include "src/scene/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "generator/base/nearest.h"
#include "src/scene/keys.h"
#include "src/scene/limits.h"
#include "src/scene/names.h"
#include "src/scene/parts.h"
#include "src/scene/world.h"

namespace intaglio::scene {
namespace {

// What the tables of the whole scene say.
struct Common {
    ViewEntry view;
    std::optional<Camera> camera;
    std::vector<LightEntry> lights;
    std::vector<std::string> targets;
    Limits tolerance, budget;
};

// A surface as far as the file alone says it.
struct Entry {
    SceneSurface surface;
    MapEntry map;
    PlaceEntry place;
    ViewEntry view;
    std::vector<std::size_t> lights;  // of Common
};

std::vector<std::string> read_targets(Reader& reader, const Value& table) {
    const Member* member = table.find("targets");
    std::vector<std::string> targets = reader.texts(table, "targets");
    if (!member) return targets;
    const std::vector<Value>& items = member->value.items;
    for (std::size_t i = 0; i < targets.size(); ++i)
        check_target(reader, i < items.size() ? items[i].position : member->value.position,
                     targets[i]);
    return targets;
}

std::set<Feature> read_features(Reader& reader, const Value& table) {
    constexpr Feature all[] = {Feature::Shadow, Feature::Depth, Feature::Silhouette, Feature::Fur};
    std::vector<std::string> names;
    for (Feature feature : all) names.emplace_back(name_of(feature));
    std::set<Feature> features;
    for (const auto& [name, position] : read_names(reader, table, "features")) {
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end())
            reader.refuse(position, "unknown-feature",
                          unknown_name_sentence("feature", name, names));
        else
            features.insert(all[found - names.begin()]);
    }
    return features;
}

std::vector<std::size_t> read_lit_by(Reader& reader, const Value& table,
                                     const std::vector<LightEntry>& lights) {
    std::vector<std::size_t> lit_by;
    if (!table.find("lights")) {
        for (std::size_t i = 0; i < lights.size(); ++i) lit_by.push_back(i);
        return lit_by;
    }
    std::vector<std::string> names;
    for (const LightEntry& light : lights) names.push_back(light.name);
    for (const auto& [name, position] : read_names(reader, table, "lights")) {
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end())
            reader.refuse(position, "unknown-light",
                          names.empty()
                              ? fmt::format("unknown light '{}': the scene has none", name)
                              : unknown_name_sentence("light", name, names));
        else
            lit_by.push_back(static_cast<std::size_t>(found - names.begin()));
    }
    return lit_by;
}

void read_pinned(Reader& reader, const Value& table, SceneSurface& surface) {
    for (std::string_view part : part_names) {
        const std::string technique = reader.text(table, part, "");
        const Member* member = table.find(part);
        if (member && member->value.kind == Kind::String && technique.empty())
            reader.refuse(member->value.position, "scene-empty",
                          fmt::format("{} names nothing", part));
        if (member) surface.parts[std::string(part)] = technique;
    }
    constexpr double any = std::numeric_limits<double>::max();
    const Value& knobs = reader.table(table, "knobs");
    for (const Member& member : knobs.members)
        surface.knobs.emplace_back(
            member.key, fmt::format("{}", reader.number_of(member.value, member.key, {-any, any})));
    surface.loop_forms = read_loops(reader, table);
    const Value& uniforms = reader.table(table, "uniforms");
    for (const Member& member : uniforms.members) {
        if (member.key == "scale")
            reader.refuse(member.position, "scene-conflict",
                          "scale is a key of the [[surface]] itself");
        std::vector<double> numbers;
        if (member.value.kind == Kind::Array)
            numbers = reader.vector_of(member.value, member.key, 1, 16);
        else
            numbers = {reader.number_of(
                member.value, member.key,
                {-std::numeric_limits<float>::max(), std::numeric_limits<float>::max()})};
        surface.uniforms[member.key] = {numbers.begin(), numbers.end()};
    }
}

void read_name(Reader& reader, const Value& table, bool known, const std::vector<Entry>& others,
               SceneSurface& surface) {
    surface.name = reader.text(table, "name", "");
    const Member* member = table.find("name");
    if (!member) {
        if (known) reader.refuse(table.position, "scene-missing", "a [[surface]] needs name");
        return;
    }
    if (member->value.kind != Kind::String) return;
    if (const std::string wrong = wrong_surface_name(surface.name); !wrong.empty())
        reader.refuse(member->value.position, "scene-name", wrong);
    for (const Entry& other : others)
        if (in_lower_case(other.surface.name) == in_lower_case(surface.name))
            reader.refuse(
                member->value.position, "scene-name",
                other.surface.name == surface.name
                    ? fmt::format("two surfaces are called '{}'", surface.name)
                    : fmt::format("two surfaces are called '{}' and '{}', and some systems take "
                                  "their files for one",
                                  other.surface.name, surface.name));
}

Entry read_surface(Reader& reader, const Value& table, const Common& common,
                   const std::vector<Entry>& others, const std::filesystem::path& folder) {
    const bool known = reader.check_keys(table, "[[surface]]", surface_keys);
    Entry entry;
    SceneSurface& surface = entry.surface;
    surface.line = table.position.line;
    surface.column = table.position.column;
    read_name(reader, table, known, others, surface);
    entry.map = read_map_entry(reader, table, "[[surface]]", known, folder);
    surface.scale = reader.number(table, "scale", surface.scale, {0, 1});
    surface.features = read_features(reader, table);
    entry.lights = read_lit_by(reader, table, common.lights);
    surface.targets = table.find("targets") ? read_targets(reader, table) : common.targets;
    if (surface.targets.empty() && known)
        reader.refuse(table.position, "scene-missing",
                      "a [[surface]] needs targets, its own or the scene's");
    read_pinned(reader, table, surface);
    surface.uniforms["scale"] = {static_cast<float>(surface.scale)};
    entry.place = read_place(reader, table);
    entry.view = read_view(reader, table, "[surface.view]");
    surface.target_tolerance =
        merged(common.tolerance,
               read_limits(reader, table, "tolerance", "[surface.tolerance]", Limited::Error));
    surface.tolerance = surface.target_tolerance.at("*");
    surface.target_tolerance.erase("*");
    surface.budget = merged(
        common.budget, read_limits(reader, table, "budget", "[surface.budget]", Limited::Cost));
    for (const std::string& target : surface.targets)
        if (known && surface.tolerance.empty() && !surface.target_tolerance.contains(target) &&
            !surface.parts.contains("search"))
            reader.refuse(table.position, "scene-missing",
                          fmt::format("nothing says how wrong this surface may be on {}: give a "
                                      "[tolerance], or pin its search",
                                      target));
    return entry;
}

// Of a texel's side in the middle of the picture.
Span pixels_of(const Camera& camera, Span distance, const PlaceEntry& entry,
               const measure::MapSet& map) {
    const double u = entry.place.width / entry.repeat_u / map.heights.width;
    const double v = entry.place.height / entry.repeat_v / map.heights.height;
    const double pixels_a_unit =
        camera.pixels / (2 * std::tan(camera.field_of_view * std::numbers::pi / 360));
    return {std::min(u, v) * pixels_a_unit / distance.most,
            std::max(u, v) * pixels_a_unit / distance.least};
}

SurfaceLight light_over(const LightEntry& light, const Place& place) {
    const Ranges ranges = light.place ? ranges_of_lamp(*light.place, place)
                                      : ranges_of_sun(light.elevation, light.azimuth, place);
    SurfaceLight made{light.name, ranges.elevation, ranges.azimuth, light.shadows, {}};
    const auto world = [](const Point& point, float w) {
        return std::array{static_cast<float>(point[0]), static_cast<float>(point[1]),
                          static_cast<float>(point[2]), w};
    };
    if (light.place)
        made.world = world(*light.place, 1);
    else if (light.elevation.is_one() && light.azimuth.is_one())
        made.world = world(direction_of(light.elevation.least, light.azimuth.least), 0);
    return made;
}

// The scene's view from the surface, with the surface's own above it.
Status add_view(const Common& common, const Entry& entry, const std::string& file,
                std::optional<Span>& distance, SceneSurface& surface) {
    if (common.camera && !common.camera->path.empty()) {
        const std::optional<Ranges> seen = ranges_of_camera(*common.camera, entry.place.place);
        if (seen) {
            surface.elevation = seen->elevation;
            surface.azimuth = seen->azimuth;
            distance = seen->distance;
        } else if (!entry.view.elevation) {
            return input_error("scene-unseen",
                               fmt::format("the camera never sees the front of '{}' from {} "
                                           "degrees or more; turn its normal, or give it a "
                                           "[surface.view]",
                                           surface.name, common.camera->least_elevation),
                               file, surface.line, surface.column);
        }
    }
    for (const ViewEntry* view : {&common.view, &entry.view}) {
        if (view->elevation) surface.elevation = *view->elevation;
        if (view->azimuth) surface.azimuth = *view->azimuth;
        if (view->distance) distance = view->distance;
    }
    return Done{};
}

Status complete(const Common& common, Entry& entry, Scene& scene) {
    SceneSurface& surface = entry.surface;
    const std::string file = scene.file.string();
    std::optional<Span> distance;
    if (Status status = add_view(common, entry, file, distance, surface); !status) return status;
    for (std::size_t light : entry.lights)
        surface.lights.push_back(light_over(common.lights[light], entry.place.place));
    const auto above = std::count_if(surface.lights.begin(), surface.lights.end(),
                                     [](const auto& light) { return light.elevation.most > 0; });
    if (above > dsl::most_lights)
        return input_error("scene-range",
                           fmt::format("{} lights reach '{}', and a shader has at most {}; name "
                                       "those that matter under lights",
                                       above, surface.name, dsl::most_lights),
                           file, surface.line, surface.column);
    Result<measure::CaseMap> map =
        load_case_map(entry.map, surface.scale, scene.file.parent_path());
    if (!map) return placed(map.error(), file, entry.map.position);
    surface.map = std::move(*map);
    if (common.camera && distance)
        surface.pixels_a_texel = pixels_of(*common.camera, *distance, entry.place, surface.map.set);
    add_inputs(entry.map, scene.inputs);
    return Done{};
}

Common read_common(Reader& reader, const Value& document) {
    reader.check_keys(document, "the scene", scene_keys);
    Common common;
    common.view = read_view(reader, document, "[view]");
    common.camera = read_camera(reader, document);
    common.lights = read_lights(reader, document);
    common.targets = read_targets(reader, document);
    common.tolerance = read_limits(reader, document, "tolerance", "[tolerance]", Limited::Error);
    common.budget = read_limits(reader, document, "budget", "[budget]", Limited::Cost);
    return common;
}

void read_head(Reader& reader, const Value& document, Scene& scene) {
    scene.name = reader.text(document, "name", scene.file.stem().string());
    const Member* name = document.find("name");
    if (const std::string wrong = wrong_identifier(scene.name);
        !wrong.empty() && (!name || name->value.kind == Kind::String))
        reader.refuse(name ? name->value.position : Position{1, 1}, "scene-name",
                      name ? wrong : wrong + "; give the scene a name");
    scene.size = static_cast<int>(reader.whole(document, "size", scene.size, {8, 2048}));
    scene.read_weight = reader.number(document, "read_weight", scene.read_weight, {0, 1000});
}

}  // namespace

std::string_view name_of(Feature feature) {
    switch (feature) {
        case Feature::Shadow: return "shadow";
        case Feature::Depth: return "depth";
        case Feature::Silhouette: return "silhouette";
        case Feature::Fur: break;
    }
    return "fur";
}

Tolerance SceneSurface::tolerance_on(const std::string& target) const {
    Limits limits = target_tolerance;
    limits["*"] = tolerance;
    Tolerance on = limits_on(limits, target);
    const bool shadowed = std::any_of(lights.begin(), lights.end(), [](const SurfaceLight& light) {
        return light.shadows && light.elevation.most > 0;
    });
    if (!shadowed || !features.contains(Feature::Shadow)) on.erase("shadow_wrong");
    return on;
}

Budget SceneSurface::budget_on(const std::string& target) const {
    return limits_on(budget, target);
}

Result<Scene> read_scene(const std::filesystem::path& path, const dsl::Catalogue* catalogue) {
    const Result<Value> document = read_document(path);
    if (!document) return document.error();
    const std::string file = path.string();
    Reader reader(file);
    Scene scene;
    scene.file = path;
    read_head(reader, *document, scene);
    const Common common = read_common(reader, *document);
    std::vector<Entry> entries;
    for (const Value* table : reader.tables(*document, "surface")) {
        if (catalogue) check_pinned(reader, *table, *catalogue);
        entries.push_back(read_surface(reader, *table, common, entries, path.parent_path()));
    }
    if (reader.error()) return *reader.error();
    if (entries.empty())
        return input_error("scene-missing", "the scene has no [[surface]]", file, 1, 1);
    scene.inputs.push_back(path);
    for (Entry& entry : entries) {
        if (Status status = complete(common, entry, scene); !status) return status.error();
        scene.surfaces.push_back(std::move(entry.surface));
    }
    return scene;
}

Result<bool> is_scene(const std::filesystem::path& path) {
    const Result<Value> document = read_document(path);
    if (!document) return document.error();
    return document->find("surface") != nullptr;
}

}  // namespace intaglio::scene
