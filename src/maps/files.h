// Files read and written whole, with every refusal of the system as a sentence.  Knows nothing of
// images.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "generator/base/result.h"

namespace intaglio::maps {

// The bytes of a file, at most `limit` of them ("file-too-large" beyond).  Codes: "file-missing",
// "file-is-directory", "file-unreadable" (permission or any other refusal); `file` names the path.
Result<std::vector<unsigned char>> read_file(const std::filesystem::path& path, std::size_t limit);

// Writes a file whole or not at all: into a temporary beside it, which is then renamed over it.  A
// file that already holds exactly these bytes is left untouched, so that its time does not change.
// What is neither a file nor a folder (a pipe, a device) is written directly.  Codes:
// "file-is-directory", "file-unwritable".
Status write_file(const std::filesystem::path& path, std::span<const unsigned char> bytes);

// An argument as a POSIX shell takes it: quoted where it must be.
std::string shell_quoted(const std::string& argument);

}  // namespace intaglio::maps
