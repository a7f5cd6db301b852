// JSON on disk.  A stamp that cannot be read is none.
#include "src/build/stamp.h"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <chrono>

#include <nlohmann/json.hpp>

#include "src/build/maps.h"
#include "src/build/whole_file.h"
#include "src/maps/files.h"

namespace intaglio::build {
namespace {

using Json = nlohmann::json;

constexpr int stamp_format = 1;

// Two changes within it may leave one time: of some network disks, and of FAT.
constexpr std::int64_t coarse_clock = 2'000'000'000;

bool look(const std::string& path, StampedFile& file) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return false;
    file.path = path;
    file.size = static_cast<std::uint64_t>(status.st_size);
    file.time = std::int64_t{status.st_mtim.tv_sec} * 1'000'000'000 + status.st_mtim.tv_nsec;
    return true;
}

bool is_unchanged(const StampedFile& before, std::int64_t written) {
    StampedFile file;
    if (!look(before.path, file) || file.size != before.size) return false;
    if (before.hash.empty()) return file.time == before.time;
    if (file.time == before.time && file.time + coarse_clock < written) return true;
    std::string bytes;
    return read_bytes(before.path, bytes) && hash_of(bytes) == before.hash;
}

Json json_of(const std::vector<StampedFile>& files) {
    Json json = Json::array();
    for (const StampedFile& file : files)
        json.push_back({file.path, file.size, file.time, file.hash});
    return json;
}

std::vector<StampedFile> files_of(const Json& json) {
    std::vector<StampedFile> files;
    for (const Json& each : json) files.push_back({each.at(0), each.at(1), each.at(2), each.at(3)});
    return files;
}

}  // namespace

std::int64_t now() {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(
               std::chrono::system_clock::now().time_since_epoch())
        .count();
}

Result<std::vector<StampedFile>> stamped_inputs(const std::vector<std::filesystem::path>& files,
                                                std::int64_t begun) {
    std::vector<StampedFile> stamped;
    for (const std::filesystem::path& path : files) {
        StampedFile file;
        std::string bytes;
        if (!look(path.string(), file) || !read_bytes(path, bytes)) {
            // Says why, as for any file that is read.
            const auto refused = maps::read_file(path, 0);
            if (!refused && refused.error().code != "file-too-large") return refused.error();
            return input_error("file-unreadable", "this file cannot be read", path.string());
        }
        file.hash = file.time < begun ? hash_of(bytes) : "changed";
        stamped.push_back(std::move(file));
    }
    return stamped;
}

std::vector<StampedFile> stamped_outputs(const std::vector<std::filesystem::path>& files) {
    std::vector<StampedFile> stamped;
    for (const std::filesystem::path& path : files) {
        StampedFile file;
        if (look(path.string(), file)) stamped.push_back(std::move(file));
    }
    return stamped;
}

bool is_current(const std::filesystem::path& file, const std::string& request) {
    std::string bytes;
    if (!read_bytes(file, bytes)) return false;
    try {
        const Json json = Json::parse(bytes);
        if (json.at("format") != stamp_format || json.at("request") != request) return false;
        const std::int64_t written = json.at("written");
        const auto unchanged = [&](const StampedFile& each) { return is_unchanged(each, written); };
        const std::vector<StampedFile> outputs = files_of(json.at("outputs"));
        const std::vector<StampedFile> inputs = files_of(json.at("inputs"));
        return std::all_of(outputs.begin(), outputs.end(), unchanged) &&
               std::all_of(inputs.begin(), inputs.end(), unchanged);
    } catch (const Json::exception&) {
        return false;
    }
}

Status write_stamp(const std::filesystem::path& file, const Stamp& stamp) {
    const Json json = {{"format", stamp_format},
                       {"request", stamp.request},
                       {"written", now()},
                       {"inputs", json_of(stamp.inputs)},
                       {"outputs", json_of(stamp.outputs)}};
    const std::string text = json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
    return maps::write_file(file,
                            {reinterpret_cast<const unsigned char*>(text.data()), text.size()});
}

}  // namespace intaglio::build
