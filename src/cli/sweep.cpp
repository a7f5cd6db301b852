// `intaglio sweep`: every case of a sweep file, measured once; `intaglio merge`: shards together.
#include "src/cli/sweep.h"

#include <unistd.h>

#include <charconv>
#include <chrono>
#include <memory>
#include <thread>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "src/measure/sweep.h"
#include "src/scene/sweep.h"

namespace intaglio::cli {
namespace {

struct SweepCommand {
    std::string sweep, output, shard = "1/1", device;
    int workers = 0;  // 0: as many as the machine has cores
    bool validation = false;
};

struct MergeCommand {
    std::vector<std::string> folders;
    std::string output;
};

// "2/5".
Status read_shard(const std::string& text, measure::SweepOptions& options) {
    const char* const end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, options.shard);
    const bool slash = first.ec == std::errc() && first.ptr != end && *first.ptr == '/';
    const auto second = slash ? std::from_chars(first.ptr + 1, end, options.shards)
                              : std::from_chars_result{end, std::errc::invalid_argument};
    if (second.ec != std::errc() || second.ptr != end || options.shard < 1 ||
        options.shard > options.shards)
        return input_error(
            "shard-syntax",
            fmt::format("'{}' is not a shard of the form 2/5: which, of how many", text));
    return Done{};
}

std::string duration(double seconds) {
    if (seconds < 90) return fmt::format("{:.0f} s", seconds);
    if (seconds < 5400) return fmt::format("{:.0f} min", seconds / 60);
    return fmt::format("{:.1f} h", seconds / 3600);
}

// On a terminal one line that says how far it is and how long it will still take.
std::function<void(int, int, int)> progress_line() {
    if (!isatty(STDERR_FILENO)) return {};
    const auto start = std::chrono::steady_clock::now();
    return [start](int begun, int done, int all) {
        const double passed =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        const double left = passed / (done - begun) * (all - done);
        fmt::print(stderr, "\r{} of {} cases, {}, about {} left   {}", done, all, duration(passed),
                   duration(left), done == all ? "\n" : "");
    };
}

Status sweep(const dsl::Catalogue& catalogue, const SweepCommand& command) {
    measure::SweepOptions options;
    if (Status status = read_shard(command.shard, options); !status) return status;
    Result<measure::SweepPlan> plan = scene::read_sweep(command.sweep);
    if (!plan) return plan.error();
    if (!command.device.empty()) plan->device = command.device;
    options.folder = command.output;
    options.workers = command.workers > 0
                          ? command.workers
                          : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    options.validation = command.validation;
    options.progress = progress_line();
    const Result<measure::SweepSummary> summary = measure::run_sweep(catalogue, *plan, options);
    if (!summary) return summary.error();
    const std::string shard =
        options.shards == 1 ? ""
                            : fmt::format(" of shard {} ({} in all)", command.shard, summary->all);
    if (summary->dropped > 0)
        fmt::print(stderr, "dropped {} results that the sweep no longer asks for\n",
                   summary->dropped);
    if (summary->measured == 0)
        fmt::print(stderr, "nothing to do: all {} cases{} are in {}\n", summary->mine, shard,
                   command.output);
    else
        fmt::print(stderr, "measured {} of {} cases{}, {} were there; {} refused by their target\n",
                   summary->measured, summary->mine, shard, summary->found, summary->refused);
    return Done{};
}

Status merge(const MergeCommand& command) {
    const Result<measure::MergeSummary> summary =
        measure::merge_sweeps({command.folders.begin(), command.folders.end()}, command.output);
    if (!summary) return summary.error();
    fmt::print(stderr, "{} of {} cases are in {}\n", summary->merged, summary->all, command.output);
    return Done{};
}

}  // namespace

void add_sweep(CLI::App& app, const dsl::Catalogue& catalogue, std::function<Status()>& chosen) {
    auto options = std::make_shared<SweepCommand>();
    CLI::App* command = app.add_subcommand(
        "sweep", "Cost and error of every case of a sweep file, measured once and kept");
    command->add_option("sweep", options->sweep, "Sweep file, TOML")->required();
    command->add_option("-o,--output", options->output, "Folder for results.jsonl and sweep.json")
        ->required();
    command
        ->add_option("-j,--threads", options->workers,
                     "Cases at once; as many as there are cores if not given")
        ->check(CLI::Range(1, 256));
    command->add_option("--shard", options->shard, "A part of the sweep: 2/5 is the second of five")
        ->capture_default_str();
    command->add_option("--device", options->device,
                        "Part of a Vulkan device's name; the sweep's, or lavapipe");
    command->add_flag("--validation", options->validation, "With the Vulkan validation layers");
    command->callback([&chosen, &catalogue, options] {
        chosen = [&, options] { return sweep(catalogue, *options); };
    });

    auto merged = std::make_shared<MergeCommand>();
    command = app.add_subcommand("merge", "The shards of a sweep in one folder");
    command->add_option("folders", merged->folders, "Folders of `intaglio sweep`")->required();
    command->add_option("-o,--output", merged->output, "Folder, which may be one of them")
        ->required();
    command->callback([&chosen, merged] { chosen = [merged] { return merge(*merged); }; });
}

}  // namespace intaglio::cli
