// A scene built, its outputs listed, its cache pruned.
#include "src/cli/build.h"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "src/build/build.h"
#include "src/build/cache.h"
#include "src/build/steps.h"
#include "src/cli/commands.h"
#include "src/cli/planned.h"
#include "src/cli/progress.h"

namespace intaglio::cli {
namespace {

namespace fs = std::filesystem;

struct Options {
    std::string scene, output, name_space, cache, depfile, depfile_target;
    std::string expect;                // a file with the names that somebody counts on
    std::string ninja;                 // a file for the edges
    std::string step, surface, order;  // what those edges do
    std::vector<std::string> targets;
    int jobs = 0;
    bool no_cache = false, wants_depfile = false, list_outputs = false, force = false,
         judge = false, quiet = false;
};

// The program that runs, by a name that stays when it is called in another way.
fs::path this_program() {
    std::error_code failure;
    fs::path program = fs::read_symlink("/proc/self/exe", failure);
    return failure ? fs::path() : program;
}

fs::path cache_folder(const Options& options) {
    if (options.no_cache) return {};
    return options.cache.empty() ? build::default_cache_folder() : fs::path(options.cache);
}

build::BuildOptions build_options(const Options& options) {
    build::BuildOptions wanted;
    wanted.scene = options.scene;
    wanted.output = options.output;
    wanted.targets = options.targets;
    wanted.name_space = options.name_space;
    wanted.cache = cache_folder(options);
    wanted.depfile = options.depfile;
    if (options.wants_depfile && options.depfile.empty())
        wanted.depfile = fs::path(options.output) / "build.d";
    wanted.depfile_target = options.depfile_target;
    wanted.tool = this_program();
    wanted.jobs = options.jobs;
    wanted.judge = options.judge;
    wanted.force = options.force;
    wanted.expect = options.expect;
    return wanted;
}

Status list_outputs(const dsl::Catalogue& catalogue, const Options& options) {
    const Result<scene::Scene> scene = build::scene_of(catalogue, build_options(options));
    if (!scene) return scene.error();
    for (const std::string& name : build::static_outputs(*scene))
        fmt::print("{}\n",
                   options.output.empty() ? name : (fs::path(options.output) / name).string());
    return Done{};
}

std::string plural(int number, std::string_view noun) {
    return fmt::format("{} {}{}", number, noun, number == 1 ? "" : "s");
}

Status build_files(const dsl::Catalogue& catalogue, const Options& options) {
    const auto begun = std::chrono::steady_clock::now();
    build::BuildOptions wanted = build_options(options);
    const Result<build::BuildReport> report = [&] {
        ProgressLine progress("built", "variants");
        wanted.progress = std::ref(progress);
        wanted.planning = planning_line();
        return build::build_scene(catalogue, wanted);
    }();
    if (!report) return report.error();
    for (const std::string& note : report->notes) fmt::print(stderr, "note: {}\n", note);
    if (options.quiet) return Done{};
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
    if (report->current)
        fmt::print(stderr, "{}: nothing to do ({:.0f} ms)\n", options.output, took.count() * 1000);
    else
        fmt::print(stderr, "{}: {} of {}, {} written, {} from the cache ({:.2f} s)\n",
                   options.output, plural(report->variants, "variant"),
                   plural(report->surfaces, "surface"), plural(report->written, "file"),
                   report->cache_hits, took.count());
    return Done{};
}

Status write_ninja(const dsl::Catalogue& catalogue, const Options& options) {
    const build::BuildOptions wanted = build_options(options);
    const Result<scene::Scene> scene = build::scene_of(catalogue, wanted);
    if (!scene) return scene.error();
    const Result<std::string> text = build::ninja_text(*scene, wanted);
    if (!text) return text.error();
    return write_product(options.ninja, *text, false);
}

Status run_step(const dsl::Catalogue& catalogue, const Options& options) {
    const build::BuildOptions wanted = build_options(options);
    if (!options.order.empty()) return build::build_variant(catalogue, options.order, wanted);
    if (options.step == "orders") return build::build_orders(catalogue, wanted);
    if (options.step == "map-names") return build::build_map_names(catalogue, wanted);
    if (options.step == "maps") return build::build_maps(catalogue, wanted);
    if (options.step == "header") return build::build_header(options.surface, wanted);
    return build::build_manifest(wanted);
}

// What was asked for, once everything that it needs was given.
Status run_build(const dsl::Catalogue& catalogue, const Options& options) {
    const bool reads_scene =
        options.order.empty() && options.step != "header" && options.step != "manifest";
    if (reads_scene && options.scene.empty())
        return input_error("usage", "a scene is needed: intaglio build SCENE.toml -o DIR");
    if (options.list_outputs) return list_outputs(catalogue, options);
    if (options.output.empty())
        return input_error("usage", "a folder for what is built is needed: -o DIR");
    if (!options.ninja.empty()) return write_ninja(catalogue, options);
    if (!options.order.empty() || !options.step.empty()) return run_step(catalogue, options);
    return build_files(catalogue, options);
}

Status prune(const Options& options, const std::string& size) {
    const Result<std::uint64_t> bytes = build::parse_bytes(size);
    if (!bytes) return bytes.error();
    const fs::path folder = cache_folder(options);
    const Result<build::Pruned> pruned = build::prune_cache(folder, *bytes);
    if (!pruned) return pruned.error();
    fmt::print("{}: {} removed ({} bytes), {} kept ({} bytes)\n", folder.string(),
               plural(pruned->entries, "entry"), pruned->bytes, pruned->kept, pruned->kept_bytes);
    return Done{};
}

void add_cache(CLI::App& app, std::function<Status()>& chosen) {
    CLI::App* command = app.add_subcommand("cache", "What builds keep between them");
    command->require_subcommand(1);
    auto options = std::make_shared<Options>();
    auto size = std::make_shared<std::string>();
    CLI::App* remove = command->add_subcommand("prune", "Remove what was used longest ago");
    remove->add_option("size", *size, "How much may stay: 0, 500M, 1G")->required();
    remove->add_option("--cache", options->cache,
                       "Folder; $INTAGLIO_CACHE or ~/.cache/intaglio if not given");
    remove->callback(
        [&chosen, options, size] { chosen = [options, size] { return prune(*options, *size); }; });
    CLI::App* where = command->add_subcommand("folder", "Where it is");
    where->callback([&chosen, options] {
        chosen = [options]() -> Status {
            fmt::print("{}\n", cache_folder(*options).string());
            return Done{};
        };
    });
}

}  // namespace

void add_build(CLI::App& app, const dsl::Catalogue& catalogue, std::function<Status()>& chosen) {
    auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand(
        "build", "What a scene needs: shaders, headers, baked maps and a manifest");
    command->add_option("scene", options->scene, "Scene file, TOML");
    command->add_option("-o,--output", options->output, "Folder for what is built");
    command->add_option("-j,--jobs", options->jobs, "Variants at once; 0: as the machine has cores")
        ->capture_default_str()
        ->check(CLI::Range(0, 256));
    command->add_option("--targets", options->targets, "In place of the scene's: ps_2_0,glsl_450")
        ->delimiter(',')
        ->allow_extra_args(false);
    command->add_option("--namespace", options->name_space, "Around the headers: game::shaders");
    CLI::Option* cache =
        command->add_option("--cache", options->cache,
                            "Folder for what is kept between builds; $INTAGLIO_CACHE or "
                            "~/.cache/intaglio if not given");
    command->add_flag("--no-cache", options->no_cache, "Keep nothing")->excludes(cache);
    command->add_flag("--depfile", options->wants_depfile,
                      "Also a depfile, of what was read (-MD)");
    command->add_option("--depfile-name", options->depfile,
                        "Its name (-MF); build.d in the folder if not given");
    command->add_option("--depfile-target", options->depfile_target,
                        "What it says depends on all that (-MT); the manifest if not given");
    command->add_flag("--list-outputs", options->list_outputs,
                      "Print what would be written, one name a line, and write nothing");
    command->add_option("--expect", options->expect,
                        "A file with names, one a line: refuse the build if it would not write "
                        "just those (orders and baked maps aside)");
    command->add_flag("--judge", options->judge,
                      "Every witness there is, not only those that a shader must pass");
    command->add_flag("--force", options->force, "Even where nothing seems to be to do");
    command->add_flag("-q,--quiet", options->quiet, "No line for what was done");
    command->add_option("--ninja", options->ninja,
                        "Write the edges of the build for Ninja to this file, and nothing else");
    command->add_option("--order", options->order,
                        "Build the variant of this order (NAME.order.json), and nothing else");
    command
        ->add_option("--step", options->step,
                     "One step of the edges for Ninja: orders, map-names, maps, header or manifest")
        ->check(CLI::IsMember({"orders", "map-names", "maps", "header", "manifest"}));
    command->add_option("--surface", options->surface, "Of the step `header`");
    command->callback([&chosen, &catalogue, options] {
        chosen = [&, options] { return run_build(catalogue, *options); };
    });
    add_cache(app, chosen);
}

std::vector<std::string> with_long_names(int count, const char* const* arguments) {
    std::vector<std::string> all(arguments, arguments + count);
    for (std::string& argument : all) {
        if (argument == "-MD" || argument == "-MMD") argument = "--depfile";
        if (argument == "-MF") argument = "--depfile-name";
        if (argument == "-MT") argument = "--depfile-target";
    }
    return all;
}

}  // namespace intaglio::cli
