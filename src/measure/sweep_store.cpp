// Lines on disk.
#include "src/measure/sweep_store.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "src/maps/files.h"
#include "src/measure/case_text.h"

namespace intaglio::measure {
namespace {

constexpr std::size_t largest_results = std::size_t{1} << 32,
                      largest_manifest = std::size_t{1} << 28;

std::filesystem::path results_of(const std::filesystem::path& folder) {
    return folder / "results.jsonl";
}

Result<std::string> text_in(const std::filesystem::path& path, std::size_t limit) {
    const Result<std::vector<unsigned char>> bytes = maps::read_file(path, limit);
    if (!bytes && bytes.error().code == "file-missing") return std::string();
    if (!bytes) return bytes.error();
    return std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size());
}

Status write_text(const std::filesystem::path& path, std::string_view text) {
    return maps::write_file(path,
                            {reinterpret_cast<const unsigned char*>(text.data()), text.size()});
}

Diagnostic unwritable(const std::filesystem::path& path) {
    return input_error("file-unwritable", fmt::format("cannot write: {}", std::strerror(errno)),
                       path.string());
}

Result<Lines> lines_in(std::string_view text, const std::filesystem::path& folder) {
    Lines lines;
    int number = 0;
    for (std::size_t end = 0; (end = text.find('\n')) != std::string_view::npos;
         text.remove_prefix(end + 1)) {
        ++number;
        const std::string_view line = text.substr(0, end);
        const std::optional<std::string> key = key_in(line);
        if (!key)
            return input_error("sweep-broken",
                               "this line is no result of a sweep; delete it, and its case will be "
                               "measured again",
                               results_of(folder).string(), number, 1);
        lines[*key] = line;
    }
    return lines;
}

std::string text_of(const Lines& lines) {
    std::string text;
    for (const auto& [key, line] : lines) text += line + "\n";
    return text;
}

}  // namespace

Result<Lines> read_lines(const std::filesystem::path& folder) {
    const Result<std::string> text = text_in(results_of(folder), largest_results);
    if (!text) return text.error();
    return lines_in(*text, folder);
}

Result<SweepStore> SweepStore::open(const std::filesystem::path& folder) {
    std::error_code failure;
    std::filesystem::create_directories(folder, failure);
    if (failure)
        return input_error("file-unwritable",
                           fmt::format("cannot make this folder: {}", failure.message()),
                           folder.string());
    const std::filesystem::path path = folder / "sweep.lock";
    const int lock = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (lock < 0) return unwritable(path);
    SweepStore store(folder, lock);
    if (flock(lock, LOCK_EX | LOCK_NB) != 0)
        return input_error("sweep-busy", "another sweep is writing to this folder",
                           folder.string());
    Result<std::string> text = text_in(results_of(folder), largest_results);
    if (!text) return text.error();
    Result<Lines> lines = lines_in(*text, folder);
    if (!lines) return lines.error();
    store.lines_ = std::move(*lines);
    store.on_disk_ = std::move(*text);
    // What a kill left of a line goes, and so does a second line of the same key.
    const std::size_t whole = store.on_disk_.rfind('\n') + 1;
    std::size_t bytes = 0;
    for (const auto& [key, line] : store.lines_) bytes += line.size() + 1;
    if (whole != store.on_disk_.size() || bytes != whole)
        if (Status status = store.rewrite(); !status) return status.error();
    return store;
}

Result<int> SweepStore::keep_only(const std::set<std::string>& keys) {
    const std::size_t before = lines_.size();
    std::erase_if(lines_, [&](const auto& entry) { return !keys.contains(entry.first); });
    if (lines_.size() != before)
        if (Status status = rewrite(); !status) return status.error();
    return static_cast<int>(before - lines_.size());
}

Status SweepStore::append(const std::string& key, const std::string& line) {
    if (file_ < 0) {
        file_ =
            ::open(results_of(folder_).c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
        if (file_ < 0) return unwritable(results_of(folder_));
    }
    const std::string text = line + "\n";
    appended_ = true;
    // One call: a kill comes before it or after it, and rarely within.
    for (std::size_t written = 0; written < text.size();) {
        const ssize_t count = ::write(file_, text.data() + written, text.size() - written);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return unwritable(results_of(folder_));
        written += static_cast<std::size_t>(count);
    }
    lines_[key] = line;
    return Done{};
}

Status SweepStore::sort() {
    if (!appended_ && on_disk_ == text_of(lines_)) return Done{};
    return rewrite();
}

Status SweepStore::rewrite() {
    if (file_ >= 0) ::close(file_);
    file_ = -1;
    on_disk_ = text_of(lines_);
    appended_ = false;
    return write_text(results_of(folder_), on_disk_);
}

SweepStore::SweepStore(SweepStore&& other) noexcept
    : folder_(std::move(other.folder_)),
      lock_(std::exchange(other.lock_, -1)),
      file_(std::exchange(other.file_, -1)),
      lines_(std::move(other.lines_)),
      on_disk_(std::move(other.on_disk_)),
      appended_(other.appended_) {}

SweepStore::~SweepStore() {
    for (int file : {file_, lock_})
        if (file >= 0) ::close(file);
}

Status write_manifest(const std::filesystem::path& folder, const Manifest& manifest) {
    const nlohmann::ordered_json json = {{"schema", line_schema},
                                         {"source", manifest.source},
                                         {"device", manifest.device},
                                         {"cases", manifest.keys}};
    return write_text(folder / "sweep.json", json.dump(1) + "\n");
}

Result<Manifest> read_manifest(const std::filesystem::path& folder) {
    const std::filesystem::path path = folder / "sweep.json";
    const Result<std::string> text = text_in(path, largest_manifest);
    if (!text) return text.error();
    const auto json = nlohmann::json::parse(*text, nullptr, false);
    const auto is_text = [](const auto& value) { return value.is_string(); };
    if (!json.is_object() || !json.contains("source") || !is_text(json["source"]) ||
        !json.contains("device") || !is_text(json["device"]) || !json.contains("cases") ||
        !json["cases"].is_array() ||
        !std::all_of(json["cases"].begin(), json["cases"].end(), is_text))
        return input_error("sweep-manifest",
                           "this is no sweep's folder: `intaglio sweep` writes such a file there",
                           path.string());
    return Manifest{json["source"], json["device"], json["cases"]};
}

}  // namespace intaglio::measure
