// Files that are written whole or not at all, and survive a loss of power: for a cache and for
// outputs that others read while they are replaced.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "generator/base/result.h"

namespace intaglio::build {

// A name beside `path` that no other process or machine uses at the same time; begins with
// `temporary_prefix`.
inline constexpr std::string_view temporary_prefix = ".intaglio.";
std::filesystem::path temporary_beside(const std::filesystem::path& path);

// Writes a new file and sends it to the disk (`durable`).  On an error nothing is left.  Error
// "file-unwritable", with the system's reason: a full disk, a read-only folder.
Status write_new(const std::filesystem::path& path, std::string_view bytes, bool durable);
// The error of write_new for a call that failed with this errno.
Diagnostic unwritable(const std::filesystem::path& path, int error);

// The bytes of a file; nothing where it cannot be read.
bool read_bytes(const std::filesystem::path& path, std::string& bytes);
// Whether the file holds exactly these bytes.
bool holds(const std::filesystem::path& path, std::string_view bytes);

}  // namespace intaglio::build
