// Cases to lines, by workers that each have a device.
#include "src/measure/sweep.h"

#include <atomic>
#include <cstdlib>
#include <mutex>
#include <optional>
#include <set>
#include <thread>

#include <fmt/format.h>

#include "src/measure/case_text.h"
#include "src/measure/laboratory.h"
#include "src/measure/sweep_store.h"

namespace intaglio::measure {
namespace {

// Cases that share a row and a map, in a row: what a worker takes at once.
struct Unit {
    std::vector<std::size_t> cases;
};

std::vector<Unit> units_of(const SweepPlan& plan) {
    std::vector<Unit> units;
    for (std::size_t i = 0; i < plan.cases.size(); ++i) {
        const SweepCase& one = plan.cases[i];
        const SweepCase* last = units.empty() ? nullptr : &plan.cases[units.back().cases.back()];
        if (last == nullptr || last->row != one.row || last->map != one.map ||
            last->what.arithmetic != one.what.arithmetic)
            units.emplace_back();
        units.back().cases.push_back(i);
    }
    return units;
}

Result<std::vector<std::string>> keys_of(const dsl::Catalogue& catalogue, const SweepPlan& plan,
                                         const MeasuredOn& on) {
    std::vector<std::string> recorded;
    for (const SweepRow& row : plan.rows) {
        Result<std::string> hash = recorded_hash(catalogue, row.request);
        if (!hash) {
            Diagnostic error = hash.error();
            error.file = row.file;
            error.line = row.line;
            error.column = row.column;
            return error;
        }
        recorded.push_back(std::move(*hash));
    }
    std::vector<std::string> keys;
    for (const SweepCase& one : plan.cases)
        keys.push_back(key_of(one.what, plan.maps[one.map], recorded[one.row], on));
    return keys;
}

// What the workers share.
struct Run {
    const dsl::Catalogue& catalogue;
    const SweepPlan& plan;
    const SweepOptions& options;
    const std::vector<std::string>& keys;
    MeasuredOn on;
    SweepStore& store;
    SweepSummary& summary;
    std::vector<Unit> units;  // of what is still to be measured
    std::shared_ptr<Shared> shared = std::make_shared<Shared>();
    std::atomic<std::size_t> next = 0;
    std::mutex mutex = {};  // of what follows, and of the store
    std::optional<Diagnostic> error = {};

    void stop(Diagnostic why) {
        const std::lock_guard lock(mutex);
        if (!error) error = std::move(why);
        next = units.size();
    }

    Status measure(Laboratory& laboratory, std::size_t index) {
        const SweepCase& one = plan.cases[index];
        const CaseMap& map = plan.maps[one.map];
        const Result<CaseMetrics> metrics = laboratory.measure(one.what, map);
        if (!metrics) return metrics.error();
        const std::string line = line_of(keys[index], one.what, map, *metrics, on);
        const std::lock_guard lock(mutex);
        if (Status status = store.append(keys[index], line); !status) return status;
        ++summary.measured;
        if (options.progress)
            options.progress(summary.found, summary.found + summary.measured, summary.mine);
        return Done{};
    }

    void work(Laboratory& laboratory) {
        for (std::size_t unit = next++; unit < units.size(); unit = next++)
            for (std::size_t index : units[unit].cases) {
                if (Status status = measure(laboratory, index); !status)
                    return stop(status.error());
                if (next >= units.size() && failed()) return;
            }
    }

    bool failed() {
        const std::lock_guard lock(mutex);
        return error.has_value();
    }
};

Status run_workers(Run& run, Laboratory first) {
    std::vector<std::jthread> workers;
    const int count = std::min(run.options.workers, static_cast<int>(run.units.size()));
    for (int i = 1; i < count; ++i)
        workers.emplace_back([&run] {
            Result<Laboratory> laboratory = Laboratory::create(
                run.catalogue, {run.plan.device, run.options.validation, 1}, run.shared);
            if (!laboratory) return run.stop(laboratory.error());
            run.work(*laboratory);
        });
    run.work(first);
    workers.clear();
    if (run.error) return *run.error;
    return Done{};
}

// This shard's cases that the store does not have, each key once.
std::vector<Unit> missing_units(const SweepPlan& plan, const SweepOptions& options,
                                const std::vector<std::string>& keys, const SweepStore& store,
                                SweepSummary& summary) {
    std::set<std::string> seen;
    std::vector<Unit> missing;
    int number = 0;
    for (const Unit& unit : units_of(plan)) {
        const bool mine = number++ % options.shards == options.shard - 1;
        Unit rest;
        for (std::size_t index : unit.cases) {
            // The first of two cases with one key says whose it is.
            if (!seen.insert(keys[index]).second) continue;
            if (!mine) continue;
            ++summary.mine;
            if (store.lines().contains(keys[index]))
                ++summary.found;
            else
                rest.cases.push_back(index);
        }
        if (!rest.cases.empty()) missing.push_back(std::move(rest));
    }
    summary.all = static_cast<int>(seen.size());
    return missing;
}

// The same cases in pieces, where there are too few units to keep the workers busy to the end.
std::vector<Unit> in_pieces(const std::vector<Unit>& units, int workers) {
    std::size_t cases = 0;
    for (const Unit& unit : units) cases += unit.cases.size();
    const std::size_t most = cases / (4 * static_cast<std::size_t>(workers)) + 1;
    std::vector<Unit> pieces;
    for (const Unit& unit : units)
        for (std::size_t begin = 0; begin < unit.cases.size(); begin += most) {
            const auto from = unit.cases.begin() + static_cast<std::ptrdiff_t>(begin);
            const std::size_t count = std::min(most, unit.cases.size() - begin);
            pieces.push_back({{from, from + static_cast<std::ptrdiff_t>(count)}});
        }
    return pieces;
}

std::vector<std::string> without_repeats(const std::vector<std::string>& keys) {
    std::set<std::string> seen;
    std::vector<std::string> once;
    for (const std::string& key : keys)
        if (seen.insert(key).second) once.push_back(key);
    return once;
}

}  // namespace

Result<SweepSummary> run_sweep(const dsl::Catalogue& catalogue, const SweepPlan& plan,
                               const SweepOptions& options) {
    // Workers are threads enough: lavapipe need not start its own for each of them.
    if (options.workers > 1) ::setenv("LP_NUM_THREADS", "1", 0);
    const auto shared = std::make_shared<Shared>();
    Result<Laboratory> first =
        Laboratory::create(catalogue, {plan.device, options.validation, 1}, shared);
    if (!first) return first.error();
    const MeasuredOn on{first->device(), plan.device};
    const Result<std::vector<std::string>> keys = keys_of(catalogue, plan, on);
    if (!keys) return keys.error();

    Result<SweepStore> store = SweepStore::open(options.folder);
    if (!store) return store.error();
    SweepSummary summary;
    const Result<int> dropped = store->keep_only({keys->begin(), keys->end()});
    if (!dropped) return dropped.error();
    summary.dropped = *dropped;
    if (Status status =
            write_manifest(options.folder, {source_id(), on.device, without_repeats(*keys)});
        !status)
        return status.error();
    Run run{
        catalogue, plan,
        options,   *keys,
        on,        *store,
        summary,   in_pieces(missing_units(plan, options, *keys, *store, summary), options.workers),
        shared};
    if (!run.units.empty())
        if (Status status = run_workers(run, std::move(*first)); !status) return status.error();
    if (Status status = store->sort(); !status) return status.error();
    for (const auto& [key, line] : store->lines()) summary.refused += is_refusal(line) ? 1 : 0;
    return summary;
}

Result<MergeSummary> merge_sweeps(const std::vector<std::filesystem::path>& folders,
                                  const std::filesystem::path& to) {
    std::optional<Manifest> manifest;
    Lines all;
    for (const std::filesystem::path& folder : folders) {
        Result<Manifest> one = read_manifest(folder);
        if (!one) return one.error();
        if (manifest && *manifest != *one)
            return input_error("merge-different",
                               fmt::format("this is not the sweep of {}: other cases, another "
                                           "device or another version of the tool",
                                           folders.front().string()),
                               folder.string());
        manifest = std::move(*one);
        Result<Lines> lines = read_lines(folder);
        if (!lines) return lines.error();
        for (auto& [key, line] : *lines) {
            const auto [place, is_new] = all.try_emplace(key, line);
            if (!is_new && place->second != line)
                return input_error("merge-conflict",
                                   fmt::format("two folders have different results for {}", key),
                                   folder.string());
        }
    }
    const std::set<std::string> wanted(manifest->keys.begin(), manifest->keys.end());
    Result<SweepStore> store = SweepStore::open(to);
    if (!store) return store.error();
    if (const Result<int> dropped = store->keep_only(wanted); !dropped) return dropped.error();
    for (const auto& [key, line] : all)
        if (wanted.contains(key) && !store->lines().contains(key))
            if (Status status = store->append(key, line); !status) return status.error();
    if (Status status = write_manifest(to, *manifest); !status) return status.error();
    if (Status status = store->sort(); !status) return status.error();
    return MergeSummary{static_cast<int>(wanted.size()), static_cast<int>(store->lines().size())};
}

}  // namespace intaglio::measure
