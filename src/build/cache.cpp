// Reading touches an entry's time, which is what pruning goes by.
#include "src/build/cache.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "src/build/whole_file.h"
#include "src/measure/hash.h"

namespace intaglio::build {
namespace {

namespace fs = std::filesystem;

// Raised when an entry is laid out in another way; what entries hold is in their keys.
constexpr std::string_view layout = "intaglio-cache-1";

std::string hash_of(std::string_view bytes) {
    measure::Hash hash;
    hash.add(bytes);
    return hash.hex();
}

constexpr std::size_t hash_line = 33;  // 32 digits and a line break

std::string environment(const char* name) {
    const char* value = std::getenv(name);
    return value == nullptr ? std::string() : std::string(value);
}

}  // namespace

Cache::Cache(fs::path folder) : folder_(std::move(folder)) {
    if (!folder_.empty()) folder_ /= layout;
}

fs::path Cache::path_of(const std::string& key) const { return folder_ / key.substr(0, 2) / key; }

void Cache::remember(const std::string& sentence) {
    const std::lock_guard lock(mutex_);
    if (trouble_.empty()) trouble_ = sentence;
}

std::string Cache::trouble() const {
    const std::lock_guard lock(mutex_);
    return trouble_;
}

std::optional<std::string> Cache::get(const std::string& key) {
    if (folder_.empty()) return std::nullopt;
    const fs::path path = path_of(key);
    std::string entry;
    if (!read_bytes(path, entry)) {
        ++misses_;
        return std::nullopt;
    }
    const std::string_view rest =
        entry.size() < hash_line ? std::string_view() : std::string_view(entry).substr(hash_line);
    if (entry.size() < hash_line || entry.compare(0, hash_line, hash_of(rest) + "\n") != 0) {
        remember(fmt::format("{} was damaged, and is made again", path.string()));
        std::error_code ignored;
        fs::remove(path, ignored);
        ++misses_;
        return std::nullopt;
    }
    // That it was used.  A cache that cannot be written is fine without.
    ::utimensat(AT_FDCWD, path.c_str(), nullptr, 0);
    ++hits_;
    return std::string(rest);
}

void Cache::put(const std::string& key, const std::string& bytes) {
    if (folder_.empty() || full_) return;
    const fs::path path = path_of(key);
    const auto give_up = [&](const std::string& why) {
        full_ = true;
        remember(fmt::format("nothing is kept in the cache: {}", why));
    };
    std::error_code failure;
    fs::create_directories(path.parent_path(), failure);
    if (failure)
        return give_up(fmt::format("the folder {} cannot be made: {}", path.parent_path().string(),
                                   failure.message()));
    const fs::path temporary = temporary_beside(path);
    const Status written = write_new(temporary, hash_of(bytes) + "\n" + bytes, true);
    if (!written)
        return give_up(fmt::format("{}: {}", written.error().file, written.error().message));
    fs::rename(temporary, path, failure);
    if (!failure) return;
    std::error_code ignored;
    fs::remove(temporary, ignored);
    give_up(fmt::format("{}: {}", path.string(), failure.message()));
}

fs::path default_cache_folder() {
    if (const std::string own = environment("INTAGLIO_CACHE"); !own.empty()) return own;
    if (const std::string all = environment("XDG_CACHE_HOME"); !all.empty())
        return fs::path(all) / "intaglio";
    if (const std::string home = environment("HOME"); !home.empty())
        return fs::path(home) / ".cache" / "intaglio";
    return {};
}

namespace {

struct Entry {
    fs::path path;
    fs::file_time_type time;
    std::uint64_t size = 0;
};

// What a killed build left is as old as nothing that still runs.
constexpr auto abandoned_after = std::chrono::hours(1);

std::vector<Entry> entries_of(const fs::path& folder, std::error_code& failure) {
    std::vector<Entry> entries;
    const auto now = fs::file_time_type::clock::now();
    for (fs::recursive_directory_iterator it(folder, failure), end; !failure && it != end;
         it.increment(failure)) {
        std::error_code gone;  // another prune may be at work
        if (!it->is_regular_file(gone) || gone) continue;
        Entry entry{it->path(), it->last_write_time(gone), it->file_size(gone)};
        if (gone) continue;
        const bool temporary = entry.path.filename().string().rfind(temporary_prefix, 0) == 0;
        if (!temporary)
            entries.push_back(std::move(entry));
        else if (now - entry.time > abandoned_after)
            fs::remove(entry.path, gone);
    }
    return entries;
}

}  // namespace

Result<Pruned> prune_cache(const fs::path& folder, std::uint64_t bytes) {
    Pruned pruned;
    const fs::path root = folder / layout;
    std::error_code failure;
    if (!fs::exists(root, failure) && !failure) return pruned;
    std::vector<Entry> entries = entries_of(root, failure);
    if (failure)
        return input_error("cache-folder",
                           fmt::format("the cache cannot be read: {}", failure.message()),
                           root.string());
    // The last used first; by name where a clock is coarse.
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
        return a.time != b.time ? a.time > b.time : a.path < b.path;
    });
    for (const Entry& entry : entries) {
        if (pruned.kept_bytes + entry.size <= bytes && pruned.entries == 0) {
            ++pruned.kept;
            pruned.kept_bytes += entry.size;
            continue;
        }
        std::error_code refused;
        if (!fs::remove(entry.path, refused) && refused)
            return input_error("cache-folder",
                               fmt::format("this entry cannot be removed: {}", refused.message()),
                               entry.path.string());
        ++pruned.entries;
        pruned.bytes += entry.size;
    }
    return pruned;
}

Result<std::uint64_t> parse_bytes(const std::string& text) {
    const Diagnostic wrong =
        input_error("size-syntax", fmt::format("'{}' is no size; write bytes, or 500M, 1G", text));
    constexpr std::string_view units = "KMGT";
    std::string_view digits = text;
    int shift = 0;
    if (!digits.empty())
        if (const std::size_t unit = units.find(digits.back()); unit != std::string_view::npos) {
            shift = 10 * (static_cast<int>(unit) + 1);
            digits.remove_suffix(1);
        }
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (error != std::errc() || end != digits.data() + digits.size() || digits.empty() ||
        number > (UINT64_MAX >> shift))
        return wrong;
    return number << shift;
}

}  // namespace intaglio::build
