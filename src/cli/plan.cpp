// `intaglio plan`: which variants a scene needs, and why those.
#include "src/cli/plan.h"

#include <chrono>
#include <memory>
#include <thread>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "src/cli/commands.h"
#include "src/cli/planned.h"
#include "src/plan/plan.h"

namespace intaglio::cli {
namespace {

struct PlanCommand {
    std::string scene, surface, target, output, orders, cache;
    int workers = 0;  // 0: as many as the machine has cores
    bool exhaustive = false, json = false, all = false;
};

Status write_orders(const plan::Plan& plan, const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        return input_error("folder-unwritable",
                           fmt::format("the folder cannot be made: {}", error.message()),
                           folder.string());
    for (const plan::Choice& choice : plan.choices) {
        const std::filesystem::path file = folder / (choice.order->name() + ".order.json");
        if (Status status = write_product(file.string(), plan::to_text(*choice.order), false);
            !status)
            return status;
    }
    return Done{};
}

Status plan_command(const dsl::Catalogue& catalogue, const PlanCommand& command) {
    const Result<scene::Scene> scene = scene::read_scene(command.scene, &catalogue);
    if (!scene) return scene.error();
    plan::PlanOptions options;
    options.workers = command.workers > 0
                          ? command.workers
                          : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    options.cache = command.cache.empty()     ? plan::default_cache()
                    : command.cache == "none" ? std::filesystem::path()
                                              : std::filesystem::path(command.cache);
    options.exhaustive = command.exhaustive;
    options.surface = command.surface;
    options.target = command.target;
    options.progress = planning_line();
    const auto start = std::chrono::steady_clock::now();
    const Result<plan::Plan> plan = plan::plan_scene(catalogue, *scene, options);
    if (!plan) return plan.error();
    const std::string json = plan::to_text(*plan);
    if (!command.output.empty())
        if (Status status = write_product(command.output, json, false); !status) return status;
    const std::string shown = command.json ? json : plan::to_people(*plan, {command.all});
    if (Status status = write_product("-", shown, false); !status) return status;
    fmt::print(stderr, "{} variants tried, {} known from before, {:.1f} s\n", plan->tried,
               plan->kept,
               std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    if (Status status = check_satisfied(*plan, command.scene); !status) return status;
    if (command.orders.empty()) return Done{};
    return write_orders(*plan, command.orders);
}

}  // namespace

void add_plan(CLI::App& app, const dsl::Catalogue& catalogue, std::function<Status()>& chosen) {
    auto options = std::make_shared<PlanCommand>();
    CLI::App* command =
        app.add_subcommand("plan", "What a scene needs on each target, and why that");
    command->add_option("scene", options->scene, "Scene file, TOML")->required();
    command->add_option("-o,--output", options->output, "The plan as JSON, to a file");
    command->add_flag("--json", options->json, "The plan as JSON, on stdout in place of the text");
    command->add_option("--orders", options->orders,
                        "Folder for one order a surface and target; none where any has no choice");
    command->add_option("--surface", options->surface, "One surface of the scene");
    command->add_option("-T,--target", options->target, "One target of the scene");
    command
        ->add_option("-j,--threads", options->workers,
                     "Variants tried at once; as many as there are cores if not given")
        ->check(CLI::Range(1, 256));
    command->add_flag("--exhaustive", options->exhaustive, "Tries what cannot be chosen as well");
    command->add_flag("--all", options->all, "Shows every candidate");
    command->add_option("--cache", options->cache,
                        "Folder of what was measured before; $INTAGLIO_CACHE/measured if not "
                        "given; none: no folder");
    command->callback([&chosen, &catalogue, options] {
        chosen = [&, options] { return plan_command(catalogue, *options); };
    });
}

}  // namespace intaglio::cli
