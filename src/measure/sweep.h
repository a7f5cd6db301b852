// Many cases at once: in parallel, kept by what went into them, resumed where they were stopped.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "generator/dsl/catalogue.h"
#include "src/measure/case.h"

namespace intaglio::measure {

// A variant, and where it was asked for; an error in it points there.
struct SweepRow {
    VariantRequest request;
    std::string file;
    int line = 0, column = 0;
};

struct SweepCase {
    std::size_t row = 0, map = 0;  // of the plan
    Case what;                     // its request is the row's
};

struct SweepPlan {
    std::vector<SweepRow> rows;
    std::vector<CaseMap> maps;
    std::vector<SweepCase> cases;  // those of a row on a map best one after the other
    std::string device;            // see vulkan::DeviceOptions
};

struct SweepOptions {
    std::filesystem::path folder;
    int workers = 1;
    int shard = 1, shards = 1;  // this run measures every shards-th row on a map, from the shard-th
    bool validation = false;    // Vulkan validation layers
    // Told after each case how many of how many are done, `begun` being those that were done
    // before; from one thread at a time.  May be empty.
    std::function<void(int begun, int done, int all)> progress = {};
};

struct SweepSummary {
    int all = 0;       // cases of the whole sweep
    int mine = 0;      // of this shard
    int found = 0;     // of these, already measured
    int measured = 0;  // now
    int refused = 0;   // of all that are known: variants that their target refuses
    int dropped = 0;   // results of other cases that were in the folder
};

// Measures what the folder does not hold yet: results.jsonl, ordered by key once this run's cases
// are complete, and sweep.json.  Codes: those of record_variant, with the row's place; of
// SweepStore::open, Laboratory::create and Laboratory::measure.  After an error what was measured
// before stays.
Result<SweepSummary> run_sweep(const dsl::Catalogue& catalogue, const SweepPlan& plan,
                               const SweepOptions& options);

struct MergeSummary {
    int all = 0, merged = 0;  // cases of the sweep, and those that the folders have
};
// The results of shards of one sweep in one folder, which may be one of them.  Codes:
// "merge-different" where the folders are not of the same sweep, "merge-conflict" where two have
// different results of a case; those of read_manifest and read_lines.
Result<MergeSummary> merge_sweeps(const std::vector<std::filesystem::path>& folders,
                                  const std::filesystem::path& to);

}  // namespace intaglio::measure
