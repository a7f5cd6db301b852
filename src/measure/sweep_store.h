// The results of a sweep on disk, one JSON line for each case, that survive being killed: lines are
// appended whole, and what a kill left of one is cut off when the folder is opened again.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "generator/base/result.h"

namespace intaglio::measure {

// results.jsonl of a folder, by key.
using Lines = std::map<std::string, std::string>;
// Codes: "sweep-broken" for a line that is no result, with its place; those of maps::read_file.  A
// last line without its end is left out, and so is what a folder does not have.
Result<Lines> read_lines(const std::filesystem::path& folder);

class SweepStore {
  public:
    // Makes the folder where there is none.  Codes: "file-unwritable"; "sweep-busy" where another
    // process has it open; those of read_lines.
    static Result<SweepStore> open(const std::filesystem::path& folder);

    const Lines& lines() const { return lines_; }
    // Forgets every line whose key is not among these; says how many.
    Result<int> keep_only(const std::set<std::string>& keys);
    // One result, at once on disk; `line` without its end.  From one thread at a time.
    Status append(const std::string& key, const std::string& line);
    // Puts the file in the order of the keys, so that it is the same however it came about.
    Status sort();

    SweepStore(SweepStore&& other) noexcept;
    SweepStore& operator=(SweepStore&&) = delete;
    ~SweepStore();

  private:
    SweepStore(std::filesystem::path folder, int lock) : folder_(std::move(folder)), lock_(lock) {}
    Status rewrite();

    std::filesystem::path folder_;
    int lock_ = -1, file_ = -1;
    Lines lines_;
    std::string on_disk_;  // the bytes of the file, as long as nothing was appended
    bool appended_ = false;
};

// What a whole sweep consists of, in order: the file sweep.json beside the results.
struct Manifest {
    std::string source, device;
    std::vector<std::string> keys;
    bool operator==(const Manifest&) const = default;
};
Status write_manifest(const std::filesystem::path& folder, const Manifest& manifest);
// Code "sweep-manifest" where there is none that can be read.
Result<Manifest> read_manifest(const std::filesystem::path& folder);

}  // namespace intaglio::measure
