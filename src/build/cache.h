// What was made once, by what went into it: a folder that several builds, and several machines over
// a shared disk, read and write at once without locks.
//
//     DIR/intaglio-cache-1/3f/3f0a...92   one entry: a line with the hash of the rest, then the
//     rest
//
// An entry is written beside its place and moved there whole, so that nobody sees half of one; it
// is trusted only when its hash is right, and thrown away otherwise.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>

#include "generator/base/result.h"

namespace intaglio::build {

class Cache {
  public:
    // An empty path: nothing is kept.  Nothing is made before the first entry.
    explicit Cache(std::filesystem::path folder);

    // The entry of this key (32 hexadecimal digits), if there is one that is whole.
    std::optional<std::string> get(const std::string& key);
    // A failure to write is no error: the build goes on without, and `trouble` says why.
    void put(const std::string& key, const std::string& bytes);

    // The first thing that went wrong, as a sentence; empty: nothing.
    std::string trouble() const;
    int hits() const { return hits_; }
    int misses() const { return misses_; }

  private:
    std::filesystem::path path_of(const std::string& key) const;
    void remember(const std::string& sentence);

    std::filesystem::path folder_;
    std::atomic<int> hits_{0}, misses_{0};
    std::atomic<bool> full_{false};  // or read-only: writing is not tried again
    mutable std::mutex mutex_;
    std::string trouble_;
};

// $INTAGLIO_CACHE, else intaglio below $XDG_CACHE_HOME or ~/.cache; empty where there is no home.
std::filesystem::path default_cache_folder();

struct Pruned {
    int entries = 0, kept = 0;
    std::uint64_t bytes = 0, kept_bytes = 0;
};
// Removes entries, those that were used longest ago first, until at most `bytes` remain, and what
// killed builds left there.  Safe while builds run.  Error "cache-folder": the folder cannot be
// read.
Result<Pruned> prune_cache(const std::filesystem::path& folder, std::uint64_t bytes);

// "500M", "1G", "0", "12345": bytes, powers of 1024.  Error "size-syntax".
Result<std::uint64_t> parse_bytes(const std::string& text);

}  // namespace intaglio::build
