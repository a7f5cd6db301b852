// The pieces of build.cpp, with files between them.
#include "src/build/steps.h"

#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "src/build/cache.h"
#include "src/build/output.h"
#include "src/build/pieces.h"
#include "src/build/whole_file.h"

namespace intaglio::build {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// What surfaces there are, and their targets: all that later steps need of a scene's text.
struct Index {
    std::string name;
    std::vector<std::pair<std::string, std::vector<std::string>>> surfaces;
};

std::string to_text(const Index& index) {
    Json surfaces = Json::array();
    for (const auto& [surface, targets] : index.surfaces)
        surfaces.push_back({{"name", surface}, {"targets", targets}});
    return Json({{"name", index.name}, {"surfaces", surfaces}}).dump(1) + "\n";
}

std::string index_file() { return fmt::format("{}/scene.json", state_folder); }
std::string bundle_file(const std::string& variant) {
    return fmt::format("{}/{}.bundle", state_folder, variant);
}
std::string maps_file(const std::string& surface) {
    return fmt::format("{}/{}.maps.json", state_folder, surface);
}

Result<std::string> bytes_of(const fs::path& path) {
    std::string bytes;
    if (read_bytes(path, bytes)) return bytes;
    return input_error("file-missing", "this file, which an earlier step writes, cannot be read",
                       path.string());
}

Result<Index> read_index(const fs::path& folder) {
    const fs::path path = folder / index_file();
    const Result<std::string> bytes = bytes_of(path);
    if (!bytes) return bytes.error();
    try {
        const Json json = Json::parse(*bytes);
        Index index;
        index.name = json.at("name");
        for (const Json& each : json.at("surfaces"))
            index.surfaces.emplace_back(each.at("name").get<std::string>(),
                                        each.at("targets").get<std::vector<std::string>>());
        return index;
    } catch (const Json::exception&) {
        return input_error("index-syntax", "this is no list of a scene's surfaces", path.string());
    }
}

Result<plan::Order> read_order_file(const fs::path& path) {
    const Result<std::string> text = bytes_of(path);
    if (!text) return text.error();
    return plan::read_order(*text, path.string());
}

Result<BuiltVariant> read_variant(const fs::path& folder, const std::string& name) {
    Result<plan::Order> order = read_order_file(folder / order_file(name));
    if (!order) return order.error();
    const Result<std::string> bytes = bytes_of(folder / bundle_file(name));
    if (!bytes) return bytes.error();
    Result<Bundle> bundle = bundle_of(*bytes);
    if (!bundle) return bundle.error();
    return BuiltVariant{std::move(*order), std::move(*bundle)};
}

Result<BuiltSurface> read_surface(const fs::path& folder, const std::string& name,
                                  const std::vector<std::string>& targets) {
    BuiltSurface surface;
    surface.name = name;
    for (const std::string& target : targets) {
        Result<BuiltVariant> variant = read_variant(folder, name + "." + target);
        if (!variant) return variant.error();
        surface.variants.push_back(std::move(*variant));
    }
    return surface;
}

Status read_maps_of(const fs::path& folder, BuiltSurface& surface) {
    const fs::path path = folder / maps_file(surface.name);
    const Result<std::string> text = bytes_of(path);
    if (!text) return text.error();
    Result<std::vector<MapRecord>> maps = read_maps(*text, path.string());
    if (!maps) return maps.error();
    surface.maps = std::move(*maps);
    return Done{};
}

Status write_all(const fs::path& folder, const std::vector<OutputFile>& files) {
    const Result<OutputFolder> output = OutputFolder::open(folder, OutputFolder::Use::Step);
    if (!output) return output.error();
    return output->write(files);
}

}  // namespace

Status build_orders(const dsl::Catalogue& catalogue, const BuildOptions& options) {
    const Result<scene::Scene> scene = scene_of(catalogue, options);
    if (!scene) return scene.error();
    const Result<Orders> orders =
        options.planner(catalogue, *scene, {options.cache, options.jobs, {}});
    if (!orders) return orders.error();
    std::vector<OutputFile> files;
    Index index{scene->name, {}};
    for (const scene::SceneSurface& surface : scene->surfaces)
        index.surfaces.emplace_back(surface.name, surface.targets);
    files.push_back({index_file(), to_text(index)});
    for (const std::vector<plan::Order>& surface : *orders)
        for (const plan::Order& order : surface)
            files.push_back({order_file(order.name()), plan::to_text(order)});
    if (Status written = write_all(options.output, files); !written) return written;
    return write_depfile(*scene, options);
}

Status build_variant(const dsl::Catalogue& catalogue, const fs::path& order,
                     const BuildOptions& options) {
    const Result<plan::Order> read = read_order_file(order);
    if (!read) return read.error();
    Cache cache(options.cache);
    const Result<Bundle> bundle = bundle_from(catalogue, *read, {options.judge}, cache);
    if (!bundle) return bundle.error();
    std::vector<OutputFile> files;
    for (const BundleFile& file : bundle->files) files.push_back({file.name, file.bytes});
    files.push_back({bundle_file(read->name()), to_bytes(*bundle)});
    return write_all(options.output, files);
}

Status build_map_names(const dsl::Catalogue& catalogue, const BuildOptions& options) {
    const Result<scene::Scene> scene = scene_of(catalogue, options);
    if (!scene) return scene.error();
    std::vector<fs::path> files;
    for (const scene::SceneSurface& each : scene->surfaces) {
        const Result<BuiltSurface> surface = read_surface(options.output, each.name, each.targets);
        if (!surface) return surface.error();
        for (const MapRecord& map :
             wanted_maps(each, scene->file.parent_path(), bundles_of(*surface)))
            if (!map.file.empty()) files.push_back(options.output / map.file);
    }
    const std::string text =
        ninja_outputs_text(options.output / maps_file(scene->surfaces.front().name), files);
    return write_all(options.output, {{fmt::format("{}/{}", state_folder, map_names_file), text}});
}

Status build_maps(const dsl::Catalogue& catalogue, const BuildOptions& options) {
    const Result<scene::Scene> scene = scene_of(catalogue, options);
    if (!scene) return scene.error();
    Cache cache(options.cache);
    std::vector<OutputFile> files;
    for (const scene::SceneSurface& each : scene->surfaces) {
        Result<BuiltSurface> surface = read_surface(options.output, each.name, each.targets);
        if (!surface) return surface.error();
        if (Status made = add_maps(each, *scene, options, cache, *surface, files); !made)
            return made;
        files.push_back({maps_file(each.name), to_text(surface->maps)});
    }
    return write_all(options.output, files);
}

Status build_header(const std::string& surface, const BuildOptions& options) {
    const Result<Index> index = read_index(options.output);
    if (!index) return index.error();
    for (const auto& [name, targets] : index->surfaces) {
        if (name != surface) continue;
        Result<BuiltSurface> built = read_surface(options.output, name, targets);
        if (!built) return built.error();
        if (Status maps = read_maps_of(options.output, *built); !maps) return maps;
        return write_all(options.output, {add_header(*built, options.name_space)});
    }
    return input_error("unknown-surface",
                       fmt::format("the scene {} has no surface {}", index->name, surface));
}

Status build_manifest(const BuildOptions& options) {
    const Result<Index> index = read_index(options.output);
    if (!index) return index.error();
    std::vector<BuiltSurface> surfaces;
    for (const auto& [name, targets] : index->surfaces) {
        Result<BuiltSurface> surface = read_surface(options.output, name, targets);
        if (!surface) return surface.error();
        if (Status maps = read_maps_of(options.output, *surface); !maps) return maps;
        add_header(*surface, options.name_space);
        surfaces.push_back(std::move(*surface));
    }
    const std::string text = manifest_text(index->name, surfaces);
    const Result<std::vector<std::string>> listed = files_listed(text, "");
    if (!listed) return listed.error();
    Result<OutputFolder> output = OutputFolder::open(options.output, OutputFolder::Use::Step);
    if (!output) return output.error();
    return output->replace({{std::string(manifest_file), text}}, {listed->begin(), listed->end()});
}

}  // namespace intaglio::build
