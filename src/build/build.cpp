// Scene, orders, variants, maps, headers, manifest: then all of it to the disk at once.
#include "src/build/build.h"

#include <mutex>
#include <optional>
#include <set>
#include <sstream>
#include <system_error>

#include <fmt/format.h>

#include "generator/base/nearest.h"
#include "src/build/cache.h"
#include "src/build/output.h"
#include "src/build/parallel.h"
#include "src/build/pieces.h"
#include "src/build/stamp.h"
#include "src/maps/files.h"

namespace intaglio::build {
namespace {

namespace fs = std::filesystem;

// Everything that was asked for, for the stamp.
std::string request_of(const BuildOptions& options) {
    std::string text = fmt::format(
        "{}\nscene {}\nnamespace {}\njudge {}\ndepfile {} {}\nexpect {}\n"
        "targets",
        tool_id(), options.scene.string(), options.name_space, options.judge,
        options.depfile.string(), options.depfile_target, options.expect.string());
    for (const std::string& target : options.targets) text += " " + target;
    return text;
}

Status check_options(const BuildOptions& options) {
    if (!is_namespace(options.name_space))
        return input_error(
            "namespace-syntax",
            fmt::format("'{}' is no namespace of C++, such as game::shaders", options.name_space));
    return Done{};
}

// All variants of all surfaces, in order; the first one that fails is the error, whichever thread
// came first.
Result<std::vector<BuiltSurface>> make_variants(const dsl::Catalogue& catalogue,
                                                const Orders& orders, const BuildOptions& options,
                                                Cache& cache) {
    std::vector<const plan::Order*> all;
    for (const std::vector<plan::Order>& surface : orders)
        for (const plan::Order& order : surface) all.push_back(&order);
    std::vector<std::optional<Result<Bundle>>> bundles(all.size());
    std::mutex telling;
    int done = 0;
    for_each_index(all.size(), options.jobs, [&](std::size_t i) {
        bundles[i] = bundle_from(catalogue, *all[i], {options.judge}, cache);
        const std::lock_guard lock(telling);
        ++done;
        if (options.progress) options.progress(done, static_cast<int>(all.size()));
    });
    std::vector<BuiltSurface> surfaces;
    std::size_t next = 0;
    for (const std::vector<plan::Order>& surface : orders) {
        surfaces.emplace_back();
        for (const plan::Order& order : surface) {
            Result<Bundle>& bundle = *bundles[next++];
            if (!bundle) return bundle.error();
            surfaces.back().name = order.surface;
            surfaces.back().variants.push_back({order, std::move(*bundle)});
        }
    }
    return surfaces;
}

void add_files(const BuiltSurface& surface, std::vector<OutputFile>& files) {
    for (const BuiltVariant& variant : surface.variants) {
        files.push_back({order_file(variant.order.name()), plan::to_text(variant.order)});
        for (const BundleFile& file : variant.bundle.files)
            files.push_back({file.name, file.bytes});
    }
}

// What lies in the folder is remembered as what these inputs give.
Status remember(const OutputFolder& folder, const BuildOptions& options, Stamp stamp,
                const std::vector<OutputFile>& files) {
    std::vector<fs::path> written;
    for (const OutputFile& file : files) written.push_back(folder.path() / file.name);
    if (!options.depfile.empty()) written.push_back(options.depfile);
    stamp.outputs = stamped_outputs(written);
    return write_stamp(folder.state("stamp.json"), stamp);
}

Status check_expected_file(const scene::Scene& scene, const fs::path& file) {
    if (file.empty()) return Done{};
    const Result<std::vector<unsigned char>> bytes = maps::read_file(file, std::size_t{1} << 24);
    if (!bytes) return bytes.error();
    return check_expected(scene, std::string(bytes->begin(), bytes->end()), file.string());
}

Result<BuildReport> build_locked(const dsl::Catalogue& catalogue, const BuildOptions& options,
                                 OutputFolder& folder) {
    const std::int64_t begun = now();
    const Result<scene::Scene> scene = scene_of(catalogue, options);
    if (!scene) return scene.error();
    if (Status expected = check_expected_file(*scene, options.expect); !expected)
        return expected.error();
    std::vector<fs::path> inputs = scene->inputs;
    for (const fs::path& more : {options.tool, options.expect})
        if (!more.empty()) inputs.push_back(more);
    Result<std::vector<StampedFile>> stamped = stamped_inputs(inputs, begun);
    if (!stamped) return stamped.error();

    Cache cache(options.cache);
    const Result<Orders> orders =
        options.planner(catalogue, *scene, {options.cache, options.jobs, options.planning});
    if (!orders) return orders.error();
    Result<std::vector<BuiltSurface>> surfaces = make_variants(catalogue, *orders, options, cache);
    if (!surfaces) return surfaces.error();
    std::vector<OutputFile> files;
    BuildReport report;
    for (std::size_t i = 0; i < surfaces->size(); ++i) {
        BuiltSurface& surface = (*surfaces)[i];
        add_files(surface, files);
        if (Status made = add_maps(scene->surfaces[i], *scene, options, cache, surface, files);
            !made)
            return made.error();
        files.push_back(add_header(surface, options.name_space));
        report.variants += static_cast<int>(surface.variants.size());
    }
    files.push_back({std::string(manifest_file), manifest_text(scene->name, *surfaces)});

    std::error_code ignored;
    fs::remove(folder.state("stamp.json"), ignored);
    if (Status replaced = folder.replace(files); !replaced) return replaced.error();
    if (Status written = write_depfile(*scene, options); !written) return written.error();
    if (Status kept =
            remember(folder, options, {request_of(options), std::move(*stamped), {}}, files);
        !kept)
        return kept.error();
    report.surfaces = static_cast<int>(surfaces->size());
    report.written = folder.written();
    report.removed = folder.removed();
    report.cache_hits = cache.hits();
    report.cache_misses = cache.misses();
    if (const std::string trouble = cache.trouble(); !trouble.empty())
        report.notes.push_back(trouble);
    return report;
}

}  // namespace

Result<scene::Scene> scene_of(const dsl::Catalogue& catalogue, const BuildOptions& options) {
    Result<scene::Scene> scene = scene::read_scene(options.scene, &catalogue);
    if (!scene) return scene;
    std::set<std::string> seen;
    for (const std::string& name : options.targets) {
        const Target* target = find_target(name);
        if (!seen.insert(name).second)
            return input_error("unknown-target", fmt::format("the target {} is named twice", name));
        if (target != nullptr && target->pixel_stage && is_judged(*target)) continue;
        std::vector<std::string> names;
        for (const Target* each : all_targets())
            if (each->pixel_stage && is_judged(*each)) names.emplace_back(each->name);
        return input_error(
            "unknown-target",
            target != nullptr && !target->pixel_stage
                ? fmt::format("{} has no pixel stage; name the pixel shaders' profile", name)
                : unknown_name_sentence("target", name, names));
    }
    if (!options.targets.empty())
        for (scene::SceneSurface& surface : scene->surfaces) surface.targets = options.targets;
    return scene;
}

std::vector<std::string> static_outputs(const scene::Scene& scene) {
    std::vector<std::string> names;
    for (const scene::SceneSurface& surface : scene.surfaces) {
        names.push_back(header_file(surface.name));
        for (const std::string& target : surface.targets) {
            names.push_back(order_file(surface.name + "." + target));
            for (std::string& file : variant_files(surface.name, *find_target(target)))
                names.push_back(std::move(file));
        }
    }
    names.emplace_back(manifest_file);
    return names;
}

Status check_expected(const scene::Scene& scene, const std::string& list, const std::string& file) {
    std::set<std::string> expected;
    std::istringstream lines(list);
    for (std::string line; std::getline(lines, line);)
        if (!line.empty()) expected.insert(line);
    const auto refused = [&](const std::string& name, std::string_view which) {
        return input_error("unexpected-outputs",
                           fmt::format("the file {} is {}; configure again, or name surfaces and "
                                       "targets of the scene as plain strings",
                                       name, which),
                           file);
    };
    for (const std::string& name : static_outputs(scene)) {
        const bool is_order = name.ends_with(".order.json");
        if (expected.erase(name) == 0 && !is_order)
            return refused(name, "made, and nobody expects it");
    }
    if (!expected.empty()) return refused(*expected.begin(), "expected, and not made");
    return Done{};
}

Result<BuildReport> build_scene(const dsl::Catalogue& catalogue, const BuildOptions& options) {
    if (Status fine = check_options(options); !fine) return fine.error();
    const fs::path stamp = options.output / state_folder / "stamp.json";
    const std::string request = request_of(options);
    BuildReport current;
    current.current = true;
    // Before the lock, so that a folder that cannot be written is no trouble where nothing is to
    // do.
    if (!options.force && is_current(stamp, request)) return current;
    // A scene that cannot be read makes no folder either.
    if (const Result<scene::Scene> scene = scene_of(catalogue, options); !scene)
        return scene.error();
    Result<OutputFolder> folder = OutputFolder::open(options.output);
    if (!folder) return folder.error();
    // And after it: another build may just have done the same.
    if (!options.force && is_current(stamp, request)) return current;
    Result<BuildReport> report = build_locked(catalogue, options, *folder);
    if (!report) folder->withdraw();
    return report;
}

}  // namespace intaglio::build
