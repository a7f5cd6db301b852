// What a build was last time: what it was asked, what it read, what it wrote.  Where all of that is
// still so, the next build is done before it begins: nothing but the system's word on files is
// asked.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "generator/base/result.h"

namespace intaglio::build {

struct StampedFile {
    std::string path;
    std::uint64_t size = 0;
    std::int64_t time = 0;  // of its last change, nanoseconds
    std::string hash;       // inputs only
};

struct Stamp {
    std::string request;  // everything that was asked for, as text
    std::vector<StampedFile> inputs, outputs;
};

// Nanoseconds, of the clock that files are dated by.
std::int64_t now();

// The files as they are now.  One that changed after `begun`, when the build may have read it
// already, is never found current.  Errors "file-missing", "file-unreadable".
Result<std::vector<StampedFile>> stamped_inputs(const std::vector<std::filesystem::path>& files,
                                                std::int64_t begun);
std::vector<StampedFile> stamped_outputs(const std::vector<std::filesystem::path>& files);

// Whether nothing happened since `file` was written for this request.  An input that only got a new
// time is read and compared by its hash, and so is one that changed within the clock's grain of the
// build itself.
bool is_current(const std::filesystem::path& file, const std::string& request);

Status write_stamp(const std::filesystem::path& file, const Stamp& stamp);

}  // namespace intaglio::build
