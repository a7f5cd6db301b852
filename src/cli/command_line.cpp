// Arguments to options, options to commands, errors to exit codes.
#include "src/cli/command_line.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "src/cli/bake.h"
#include "src/cli/build.h"
#include "src/cli/commands.h"
#include "src/cli/completion.h"
#include "src/cli/description.h"
#include "src/cli/hard.h"
#include "src/cli/plan.h"
#include "src/cli/savings.h"
#include "src/cli/sweep.h"
#include "src/plan/plan.h"

namespace intaglio::cli {
namespace {

void add_settings(CLI::App& command, std::vector<std::string>& knobs,
                  std::vector<std::string>& loops, KnownOptions& known) {
    command.add_option("-D,--define", knobs, "Knob: taps=12 (repeatable)")->allow_extra_args(false);
    command.add_option("--loop", loops, "Form of a loop: march=unroll or march=loop (repeatable)")
        ->allow_extra_args(false);
    command
        .add_option("--fix", known.fixed,
                    "Uniform that becomes a constant: scale=0.05, ambient=0.1,0.1,0.1 (repeatable)")
        ->allow_extra_args(false);
    command
        .add_option("--assume", known.assumed,
                    "Range of a value by which guards are left out: view.z=0.25..1 (repeatable)")
        ->allow_extra_args(false);
}

void add_variant(CLI::App& command, VariantOptions& options) {
    command
        .add_option("surface", options.surface,
                    "A preset, a search, or a composition: search=steep_parallax,shadow=march")
        ->required();
    command.add_option("-T,--target", options.target, "Target; see `intaglio list targets`")
        ->required();
    add_settings(command, options.knobs, options.loops, options.known);
    command.add_flag("--per-vertex", options.per_vertex,
                     "Move affine functions of interpolants to the vertex stage");
    command.add_option("--split", options.split,
                       "In several passes: shading, shadow, sections=3, or several by commas");
}

void add_pass(CLI::App& command, VariantOptions& options) {
    command.add_option("--pass", options.pass, "One pass of the split, from 1");
}

CLI::Option* add_baked(CLI::App& command, std::vector<std::string>& baked) {
    return command
        .add_option("--baked", baked,
                    "A map that `intaglio bake` wrote, by its kind: cone=wall_cone.png "
                    "(repeatable); baked in memory if not given")
        ->allow_extra_args(false);
}

void add_view(CLI::App& command, ViewOptions& options) {
    command
        .add_option("--elevation", options.elevation,
                    "Of the eye, degrees above the surface or horizon")
        ->capture_default_str();
    command.add_option("--azimuth", options.azimuth, "Of the eye, degrees")->capture_default_str();
    const auto add_lights = [&](const char* name, std::vector<double>& values) {
        command.add_option(name, values, "Degrees; of several lights 45,30 (or repeatable)")
            ->delimiter(',')
            ->allow_extra_args(false)
            ->capture_default_str();
    };
    add_lights("--light-elevation", options.light_elevation);
    add_lights("--light-azimuth", options.light_azimuth);
    command.add_option("--device", options.device,
                       "Part of a Vulkan device's name; lavapipe if not given");
}

void add_map(CLI::App& command, MapOptions& options) {
    CLI::Option* height =
        command.add_option("--height", options.height,
                           "Height map, PNG; heights in alpha where it varies, else red or gray");
    command
        .add_option("--maker", options.maker,
                    "Procedural map in place of a file; see `intaglio list maps`")
        ->excludes(height);
    command.add_option("--normal", options.normal,
                       "Normal map, PNG; baked from the heights if not given");
    add_baked(command, options.baked);
    command.add_option("--colour,--color", options.colour,
                       "Colour map, PNG; a shade of the heights if not given");
    command.add_option("--map-size", options.map_size, "Size of a procedural map")
        ->capture_default_str();
    command.add_option("--seed", options.seed, "Of a procedural map")->capture_default_str();
    command.add_option("--scale", options.scale, "Depth of the relief in texture units")
        ->capture_default_str();
    command
        .add_option("--filtering", options.filtering,
                    "float (exact) or native (as the file's precision)")
        ->capture_default_str();
}

// One line for what CLI11 throws, in our form; its own text would print the whole help.
int report_usage(const CLI::App& app, const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return app.exit(error);
    std::string sentence = error.what();
    if (!sentence.empty() && sentence.back() == '.') sentence.pop_back();
    fmt::print(stderr, "error: {} [usage]\n", sentence);
    std::string command = app.get_name();
    for (const CLI::App* sub : app.get_subcommands()) command += " " + sub->get_name();
    fmt::print(stderr, "  hint: {} --help\n", command);
    return exit_bad_input;
}

int report(const Status& status) {
    if (status) return exit_fine;
    fmt::print(stderr, "{}\n", to_string(status.error()));
    if (status.error().code == over_budget || status.error().code == plan::unsatisfied)
        return exit_over_budget;
    return status.error().fault == Fault::Internal ? exit_own_failure : exit_bad_input;
}

void add_report(CLI::App& app, const dsl::Catalogue& catalogue, std::function<Status()>& chosen) {
    auto options = std::make_shared<ReportOptions>();
    CLI::App* command = app.add_subcommand(
        "report", "The results in a folder as one page with plots, pictures and shaders");
    command
        ->add_option("folder", options->folder,
                     "Folder with results, of `intaglio sweep` or `intaglio measure`")
        ->required();
    command->add_option("-o,--output", options->output, "HTML file; - is stdout");
    command->add_option(
        "--markdown", options->markdown,
        "A document with marks, whose part between them is made anew: Pareto fronts "
        "by class of map and elevation (plots by gnuplot)");
    command
        ->add_option("--maps", options->maps,
                     "Folder that map files in the results are relative to: the sweep file's")
        ->capture_default_str();
    command->add_option("--budgets", options->budgets,
                        "A budget file: bars show the room below its limits, where it has some, in "
                        "place of the profiles'");
    command->add_option("--chip", options->chips,
                        "Also what this chip's compiler makes of each variant: polaris10, navi21 "
                        "(repeatable; Mesa's RADV, without the chip)");
    command->add_flag("!--no-pictures", options->pictures,
                      "Without the gallery, which draws every technique on every map");
    command->add_option("--rounds", options->rounds, "Of timing; 0: no times of results of a sweep")
        ->capture_default_str()
        ->check(CLI::Range(0, 1000));
    command->add_option("--picture-size", options->picture_size, "Of the gallery, pixels a side")
        ->capture_default_str()
        ->check(CLI::IsMember({64, 128, 192, 256, 512}));
    command->callback([&chosen, &catalogue, options] {
        chosen = [&, options] { return make_report(catalogue, *options); };
    });
}

// The commands with their options; `chosen` is set to the work of the one that was named.
void add_commands(CLI::App& app, const dsl::Catalogue& catalogue, std::function<Status()>& chosen) {
    {
        auto options = std::make_shared<ListOptions>();
        CLI::App* command =
            app.add_subcommand("list", "What there is: techniques, targets, knobs, maps");
        command->add_option("what", options->what, "techniques, targets, knobs or maps")
            ->capture_default_str();
        command->add_flag("--json", options->json, "For programs");
        command->callback([&chosen, &catalogue, options] {
            chosen = [&, options] { return list(catalogue, *options); };
        });
    }
    {
        auto options = std::make_shared<EmitCommandOptions>();
        CLI::App* command = app.add_subcommand("emit", "One variant as text or binary");
        add_variant(*command, options->variant);
        add_pass(*command, options->variant);
        command->add_option("--stage", options->stage,
                            "vertex or pixel; pixel if not given, vertex of a vertex profile");
        command
            ->add_option(
                "--as", options->as,
                "shader, function (a part to paste into a shader of one's own), or bytecode")
            ->capture_default_str();
        command->add_option("--part", options->part, "Of a function: search or shadow")
            ->capture_default_str();
        command
            ->add_option("--bind", options->bind,
                         "Of a function: textures and scale as parameters or globals")
            ->capture_default_str();
        command->add_flag("--count-reads", options->count_reads,
                          "Add a colour target that counts texture reads");
        command
            ->add_option("--dump-ir", options->dump_ir,
                         "IR to stderr: all, final, or after one pass")
            ->expected(0, 1)
            ->default_str("all");
        command->add_option("-o,--output", options->output, "File; - is stdout")
            ->capture_default_str();
        command->callback([&chosen, &catalogue, options] {
            chosen = [&, options] { return emit_variant(catalogue, *options); };
        });
    }
    {
        auto options = std::make_shared<ValidateOptions>();
        CLI::App* command = app.add_subcommand(
            "validate",
            "Variants through every witness: glslang, SPIRV-Tools, SPIRV-Cross, MojoShader");
        command->add_option("surfaces", options->surfaces, "Surfaces")->required();
        command
            ->add_option("-T,--target", options->targets,
                         "Target (repeatable); every target if not given")
            ->allow_extra_args(false);
        add_settings(*command, options->knobs, options->loops, options->known);
        command->add_flag("-v,--verbose", options->verbose, "Every step of every witness");
        command->callback([&chosen, &catalogue, options] {
            chosen = [&, options] { return validate(catalogue, *options); };
        });
    }
    {
        auto options = std::make_shared<ExplainOptions>();
        CLI::App* command = app.add_subcommand(
            "explain", "Who spends the slots or operations of a variant, by step and line");
        add_variant(*command, options->variant);
        add_pass(*command, options->variant);
        command->add_flag("--without", options->without,
                          "Also what each guard and feature costs, by leaving it out");
        command->add_flag("--json", options->json, "For programs");
        command->callback([&chosen, &catalogue, options] {
            chosen = [&, options] { return explain(catalogue, *options); };
        });
    }
    {
        auto options = std::make_shared<CheckOptions>();
        CLI::App* command = app.add_subcommand(
            "check",
            "Limits on cost and error against what is measured; exit code 1 where one is "
            "exceeded");
        command->add_option("budgets", options->budgets, "The budget file (budgets.toml)")
            ->required();
        command->add_option("--baseline", options->baseline,
                            "In place of the baseline that the budgets name");
        CLI::Option* update = command->add_flag("--update", options->update,
                                                "Make what is measured the new baseline");
        command
            ->add_flag("--patch", options->patch,
                       "Print the new baseline as a patch (git apply --unidiff-zero)")
            ->excludes(update);
        command->add_option("--format", options->format, "text, json, junit, github or sarif");
        command->add_option("--today", options->today,
                            "The day that waivers are held against, as 2026-12-31");
        command->add_flag("-q,--quiet", options->quiet, "No report where all is within budget");
        CLI::Option* depfile =
            command->add_option("--depfile-name", options->depfile, "Its name (-MF)");
        command
            ->add_flag("--depfile", options->wants_depfile,
                       "Also a depfile, of what was read (-MD)")
            ->needs(depfile);
        command->add_option("--depfile-target", options->depfile_target,
                            "What it says depends on all that (-MT); the budgets if not given");
        command->add_option("-o,--output", options->output, "The report's file (default: stdout)");
        command->callback([&chosen, &catalogue, options] {
            chosen = [&, options] { return check(catalogue, *options); };
        });
    }
    {
        auto options = std::make_shared<DiffOptions>();
        CLI::App* command =
            app.add_subcommand("diff", "What changed between two files of check --update");
        command->add_option("before", options->before, "A baseline")->required();
        command->add_option("after", options->after, "Another")->required();
        command->add_option("--format", options->format, "text, json, junit, github or sarif");
        command->callback([&chosen, options] { chosen = [options] { return diff(*options); }; });
    }
    {
        auto options = std::make_shared<CostOptions>();
        CLI::App* command = app.add_subcommand(
            "cost", "What a variant costs before it is run, each number with its maker");
        add_variant(*command, options->variant);
        add_pass(*command, options->variant);
        command->add_option("--chip", options->chips,
                            "Also ask the compiler of this chip, which need not be there: "
                            "polaris10, navi21, ...");
        command->add_flag("--json", options->json, "For programs");
        command->callback([&chosen, &catalogue, options] {
            chosen = [&, options] { return cost(catalogue, *options); };
        });
    }
    {
        auto options = std::make_shared<TableOptions>();
        CLI::App* command = app.add_subcommand(
            "table", "What each Direct3D 9 profile makes of every technique and knob, in Markdown");
        command->add_option("--only", options->only,
                            "Techniques whose title contains this: search=relief, shadow, preset");
        command->add_option("-j,--threads", options->threads, "Variants at once")
            ->capture_default_str()
            ->check(CLI::Range(1, 256));
        command->add_option("-o,--output", options->output, "File; - is stdout")
            ->capture_default_str();
        command->callback([&chosen, &catalogue, options] {
            chosen = [&, options] { return table_of_settings(catalogue, *options); };
        });
    }
    {
        auto options = std::make_shared<PagesOptions>();
        CLI::App* command = app.add_subcommand(
            "pages", "Pictures, figures and costs into the pages of the techniques");
        command
            ->add_option("-o,--output", options->output,
                         "Folder with techniques/*.md, whose marked blocks are written anew; "
                         "pictures go to its images/techniques")
            ->capture_default_str();
        command
            ->add_option("--maps", options->maps,
                         "Folder with the maps that figures are measured on")
            ->capture_default_str();
        command
            ->add_option("--only", options->only,
                         "A block's title: search=relief, fur (repeatable); all if not given")
            ->allow_extra_args(false);
        command->add_option("-j,--threads", options->threads, "Techniques at once, of costs")
            ->capture_default_str()
            ->check(CLI::Range(1, 256));
        command->callback([&chosen, &catalogue, options] {
            chosen = [&, options] { return write_pages(catalogue, *options); };
        });
    }
    {
        auto options = std::make_shared<SheetOptions>();
        CLI::App* command = app.add_subcommand(
            "sheet", "Every search on many maps in one picture, each beside its errors");
        command->add_option("-o,--output", options->output, "Folder for searches.60.png, ...")
            ->required();
        command->add_option("--maps", options->maps, "Folder with folders of maps")
            ->capture_default_str();
        command->add_option("--height", options->height, "A height map in place of those");
        command
            ->add_option("--elevation", options->elevations,
                         "Of the eye, degrees above the surface (repeatable)")
            ->allow_extra_args(false)
            ->check(CLI::Range(1.0, 90.0))
            ->capture_default_str();
        command->add_option("--size", options->size, "Pixels of a picture's side")
            ->check(CLI::Range(32, 512))
            ->capture_default_str();
        command->add_option("--device", options->device,
                            "Part of a Vulkan device's name; lavapipe if not given");
        command->callback([&chosen, &catalogue, options] {
            chosen = [&, options] { return write_sheets(catalogue, *options); };
        });
    }
    {
        auto options = std::make_shared<RunOptions>();
        CLI::App* command =
            app.add_subcommand("run", "One picture on a Vulkan device, without a window");
        add_variant(*command, options->variant);
        add_map(*command, options->map);
        command
            ->add_option("--mesh", options->mesh,
                         "map (the whole map from infinity), quad, sphere or torus")
            ->capture_default_str();
        command
            ->add_option("--geometry", options->geometry,
                         "polygon (with the surface's search), displaced (the relief as triangles) "
                         "or shells (as layers)")
            ->capture_default_str();
        command
            ->add_option("--subdivisions", options->subdivisions,
                         "Squares along a texel's side, of displaced geometry")
            ->capture_default_str();
        command->add_option("--layers", options->layers, "How many shells")->capture_default_str();
        command->add_flag("--fins", options->fins,
                          "Strips below the edges of shells, at silhouettes");
        add_view(*command, options->view);
        command
            ->add_option("--distance", options->distance,
                         "Of the eye from the mesh's centre; 0: as suits the mesh")
            ->capture_default_str();
        command->add_option("--repeat", options->repeat, "Repetitions of the map over the mesh")
            ->capture_default_str();
        command->add_option("--size", options->size, "Of the picture")->capture_default_str();
        command->add_flag("--validation", options->validation, "With the Vulkan validation layers");
        command->add_option("--error-map", options->error_map,
                            "Also a picture of the hit errors (with --mesh map)");
        command
            ->add_option("--arithmetic", options->arithmetic,
                         "Of the pixel stage: fp32, or on the CPU fp24 or fp16 (with --mesh map)")
            ->capture_default_str();
        command->add_option("--pixel", options->pixel,
                            "Also the ray of a pixel in words: 12,40 (with --mesh map)");
        command
            ->add_option("--format", options->passes.format,
                         "Of the picture between passes: rgba8, rgba16, rgba16f or rgba32f")
            ->capture_default_str();
        command->add_option("--offset-range", options->passes.range,
                            "Greatest offset that it holds, in texture units; 0: as the map's view "
                            "needs, 4 times the scale on a mesh");
        command->add_option("-o,--output", options->output, "PNG file")->required();
        command->callback([&chosen, &catalogue, options] {
            chosen = [&, options] { return run(catalogue, *options); };
        });
    }
    {
        auto options = std::make_shared<SplitOptions>();
        CLI::App* command = app.add_subcommand(
            "split", "The passes of a split surface, and the error of the format between them");
        add_variant(*command, options->variant);
        add_map(*command, options->map);
        add_view(*command, options->view);
        command->add_option("--size", options->size, "Pixels a side")
            ->capture_default_str()
            ->check(CLI::Range(1, 4096));
        command->callback([&chosen, &catalogue, options] {
            chosen = [&, options] { return split_table(catalogue, *options); };
        });
    }
    {
        auto options = std::make_shared<MeasureOptions>();
        CLI::App* command =
            app.add_subcommand("measure", "Speed against error of a scene's variants");
        command->add_option("scene", options->scene, "Scene file, TOML")->required();
        command
            ->add_option("-o,--output", options->output, "Folder for results.json and results.csv")
            ->required();
        CLI::Option* height = command->add_option("--height", options->height,
                                                  "A height map in place of the scene's maps");
        add_baked(*command, options->baked)->needs(height);
        command->add_option("--size", options->size, "Pixels a side in place of the scene's")
            ->check(CLI::IsMember({8, 16, 32, 64, 128, 256, 512, 1024, 2048}));
        command->add_option("--device", options->device,
                            "Part of a Vulkan device's name; the scene's, or lavapipe");
        command->add_flag("--validation", options->validation, "With the Vulkan validation layers");
        command->callback([&chosen, &catalogue, options] {
            chosen = [&, options] { return measure_scene(catalogue, *options); };
        });
    }
    add_report(app, catalogue, chosen);
    add_plan(app, catalogue, chosen);
    add_savings(app, catalogue, chosen);
    add_sweep(app, catalogue, chosen);
    add_bake(app, chosen);
    add_build(app, catalogue, chosen);
    add_hard(app, catalogue, chosen);
    add_stability(app, catalogue, chosen);
    add_shells(app, chosen);
}

}  // namespace

int run_command_line(int argument_count, const char* const* arguments,
                     const dsl::Catalogue& catalogue) {
    CLI::App app(
        "Shaders for relief surfaces: written once, emitted for every shader model, measured.",
        "intaglio");
    app.require_subcommand(1);
    app.set_version_flag("--version", fmt::format("intaglio {}", version()));
    std::function<Status()> chosen;
    add_commands(app, catalogue, chosen);
    name_values(app);
    // Words that are not finished are not parsed.
    if (argument_count > 1 && arguments[1] == std::string_view(complete_command)) {
        const std::vector<std::string> words(arguments + 2, arguments + argument_count);
        return report(write_product("-", complete_words(describe(app), catalogue, words), false));
    }
    try {
        // The parser takes them from the last to the first, without the program's name.
        std::vector<std::string> words = with_long_names(argument_count, arguments);
        std::reverse(words.begin() + 1, words.end());
        words.erase(words.begin());
        app.parse(std::move(words));
    } catch (const CLI::ParseError& error) {
        return report_usage(app, error);
    }
    return report(chosen());
}

}  // namespace intaglio::cli
