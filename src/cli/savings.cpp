// `intaglio savings`: what planning a scene saves.
#include "src/cli/savings.h"

#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "src/cli/commands.h"
#include "src/cli/planned.h"
#include "src/cli/progress.h"
#include "src/maps/files.h"
#include "src/plan/savings.h"
#include "src/report/page_block.h"

namespace intaglio::cli {
namespace {

struct SavingsCommand {
    std::string scene, output = "-", markdown;
    int size = 127, rounds = 15;
};

Status savings_command(const dsl::Catalogue& catalogue, const SavingsCommand& command) {
    const Result<PlannedScene> planned = planned_scene(catalogue, command.scene);
    if (!planned) return planned.error();
    // A table that left surfaces out would say that they cost nothing.
    if (Status status = check_satisfied(planned->plan, command.scene); !status) return status;
    plan::SavingOptions options{command.size, command.rounds, {}};
    const auto line = std::make_shared<ProgressLine>("drawn", "variants");
    options.progress = [line](const std::string&, int done, int all) { (*line)(done, all); };
    const Result<plan::Savings> savings =
        plan::measure_savings(catalogue, planned->scene, planned->plan, options);
    if (!savings) return savings.error();
    const std::string table = plan::to_markdown(*savings);
    if (command.markdown.empty()) return write_product(command.output, table, false);
    const auto page = maps::read_file(command.markdown, 1 << 20);
    if (!page) return page.error();
    const Result<std::string> text =
        report::with_block(std::string(page->begin(), page->end()),
                           "savings " + planned->scene.name, table, command.markdown);
    if (!text) return text.error();
    return write_product(command.markdown, *text, false);
}

}  // namespace

void add_savings(CLI::App& app, const dsl::Catalogue& catalogue, std::function<Status()>& chosen) {
    auto options = std::make_shared<SavingsCommand>();
    CLI::App* command = app.add_subcommand(
        "savings", "What a scene's plan saves beside the same surfaces with everything on");
    command->add_option("scene", options->scene, "Scene file, TOML")->required();
    command->add_option("-o,--output", options->output,
                        "The table, in Markdown; stdout if not given");
    command->add_option("--markdown", options->markdown,
                        "A document whose block 'savings NAME' is written anew");
    command->add_option("--size", options->size, "Pixels a side")->check(CLI::Range(8, 2048));
    command->add_option("--rounds", options->rounds, "Of timing; 0: no times")
        ->check(CLI::Range(0, 1000));
    command->callback([&chosen, &catalogue, options] {
        chosen = [&, options] { return savings_command(catalogue, *options); };
    });
}

}  // namespace intaglio::cli
