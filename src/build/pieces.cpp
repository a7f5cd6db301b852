// Nothing here knows in which order the pieces are put together.
#include "src/build/pieces.h"

#include <optional>

#include <fmt/format.h>

#include "src/build/depfile.h"
#include "src/maps/files.h"

namespace intaglio::build {

namespace {

Diagnostic about(const plan::Order& order, Diagnostic error) {
    error.notes.push_back(fmt::format("of the variant {}", order.name()));
    return error;
}

}  // namespace

Result<Bundle> bundle_from(const dsl::Catalogue& catalogue, const plan::Order& order,
                           const BundleOptions& options, Cache& cache) {
    const Result<std::string> key = bundle_key(catalogue, order, options);
    if (!key) return about(order, key.error());
    if (const std::optional<std::string> bytes = cache.get(*key))
        if (Result<Bundle> bundle = bundle_of(*bytes); bundle) return bundle;
    Result<Bundle> bundle = make_bundle(catalogue, order, options);
    if (!bundle) return about(order, bundle.error());
    cache.put(*key, to_bytes(*bundle));
    return bundle;
}

std::vector<const Bundle*> bundles_of(const BuiltSurface& surface) {
    std::vector<const Bundle*> bundles;
    for (const BuiltVariant& variant : surface.variants) bundles.push_back(&variant.bundle);
    return bundles;
}

Status add_maps(const scene::SceneSurface& from, const scene::Scene& scene,
                const BuildOptions& options, Cache& cache, BuiltSurface& surface,
                std::vector<OutputFile>& files) {
    Result<SurfaceMaps> maps =
        make_maps(from, scene.file.parent_path(), bundles_of(surface), cache, options.jobs);
    if (!maps) return maps.error();
    surface.maps = std::move(maps->records);
    for (OutputFile& file : maps->files) files.push_back(std::move(file));
    return Done{};
}

OutputFile add_header(BuiltSurface& surface, const std::string& name_space) {
    std::vector<const BuiltVariant*> variants;
    for (const BuiltVariant& variant : surface.variants) variants.push_back(&variant);
    OutputFile file{header_file(surface.name),
                    header_text(surface.name, variants, surface.maps, name_space)};
    surface.header_hash = hash_of(file.bytes);
    return file;
}

Status write_depfile(const scene::Scene& scene, const BuildOptions& options) {
    if (options.depfile.empty()) return Done{};
    std::vector<std::string> dependencies;
    for (const std::filesystem::path& input : scene.inputs) dependencies.push_back(input.string());
    if (!options.tool.empty()) dependencies.push_back(options.tool.string());
    const std::string target = options.depfile_target.empty()
                                   ? (options.output / manifest_file).string()
                                   : options.depfile_target;
    const Result<std::string> text = depfile_text(target, dependencies);
    if (!text) return text.error();
    return maps::write_file(options.depfile,
                            {reinterpret_cast<const unsigned char*>(text->data()), text->size()});
}

}  // namespace intaglio::build
