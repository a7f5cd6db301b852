// C streams, because they say through errno what the system refused; C++ streams do not.
#include "src/maps/files.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <new>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace intaglio::maps {
namespace {

namespace fs = std::filesystem;

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

std::string reason(int error) { return std::generic_category().message(error); }

Diagnostic cannot_read(const fs::path& path, int error) {
    if (error == ENOENT || error == ENOTDIR) {
        return input_error("file-missing", "there is no such file", path.string());
    }
    if (error == EISDIR) {
        return input_error("file-is-directory", "this is a folder, not a file", path.string());
    }
    if (error == EACCES || error == EPERM) {
        return input_error("file-unreadable", "there is no permission to read this file",
                           path.string());
    }
    return input_error("file-unreadable",
                       fmt::format("this file cannot be read: {}", reason(error)), path.string());
}

Diagnostic cannot_write(const fs::path& path, int error) {
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    std::error_code ignored;
    if (error == ENOENT && !fs::exists(folder, ignored)) {
        return input_error(
            "file-unwritable",
            fmt::format("this file cannot be written: there is no folder {}", folder.string()),
            path.string());
    }
    if (error == EACCES || error == EPERM) {
        return input_error("file-unwritable", "there is no permission to write this file",
                           path.string());
    }
    return input_error("file-unwritable",
                       fmt::format("this file cannot be written: {}", reason(error)),
                       path.string());
}

// Returns 0 or errno.  The close belongs to the write: a full disk may show only there.
int write_and_close(File file, std::span<const unsigned char> bytes) {
    if (!bytes.empty() && std::fwrite(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) {
        return errno;
    }
    return std::fclose(file.release()) == 0 ? 0 : errno;
}

bool holds_already(const fs::path& path, std::span<const unsigned char> bytes) {
    std::error_code error;
    const auto size = fs::file_size(path, error);
    if (error || size != bytes.size()) return false;
    const auto present = read_file(path, bytes.size());
    return present.ok() && std::equal(present->begin(), present->end(), bytes.begin(), bytes.end());
}

// A name that no other process or thread of this one uses at the same time.
fs::path temporary_beside(const fs::path& path) {
    static std::atomic<unsigned> counter{0};
    fs::path temporary = path;
    temporary.replace_filename(fmt::format(".intaglio.{}.{}.tmp", ::getpid(), counter++));
    return temporary;
}

}  // namespace

Result<std::vector<unsigned char>> read_file(const fs::path& path, std::size_t limit) {
    File file(std::fopen(path.c_str(), "rb"));
    if (!file) return cannot_read(path, errno);
    std::vector<unsigned char> bytes;
    constexpr std::size_t block = std::size_t{1} << 16;
    try {
        while (true) {
            const std::size_t before = bytes.size();
            bytes.resize(before + block);
            const std::size_t got = std::fread(bytes.data() + before, 1, block, file.get());
            const int error = errno;
            bytes.resize(before + got);
            if (bytes.size() > limit) {
                return input_error(
                    "file-too-large",
                    fmt::format("this file is longer than the {} bytes that are read", limit),
                    path.string());
            }
            if (got == block) continue;
            if (std::ferror(file.get())) return cannot_read(path, error);
            return bytes;
        }
    } catch (const std::bad_alloc&) {
        return input_error("file-too-large", "there is not enough memory to read this file",
                           path.string());
    }
}

Status write_file(const fs::path& path, std::span<const unsigned char> bytes) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (fs::is_directory(status)) {
        return input_error("file-is-directory", "this is a folder, so no file can be written here",
                           path.string());
    }
    if (path.filename().empty()) return cannot_write(path, ENOENT);
    if (fs::exists(status) && !fs::is_regular_file(status)) {
        File device(std::fopen(path.c_str(), "wb"));
        if (!device) return cannot_write(path, errno);
        const int failure = write_and_close(std::move(device), bytes);
        if (failure != 0) return cannot_write(path, failure);
        return Done{};
    }
    if (fs::is_regular_file(status) && holds_already(path, bytes)) return Done{};

    const fs::path temporary = temporary_beside(path);
    File file(std::fopen(temporary.c_str(), "wbx"));
    if (!file) return cannot_write(path, errno);
    int failure = write_and_close(std::move(file), bytes);
    if (failure == 0 && std::rename(temporary.c_str(), path.c_str()) != 0) failure = errno;
    if (failure == 0) return Done{};
    std::error_code ignored;
    fs::remove(temporary, ignored);
    return cannot_write(path, failure);
}

std::string shell_quoted(const std::string& argument) {
    const auto plain = [](unsigned char c) {
        return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
               std::string_view("_-+=.,:/@%").find(static_cast<char>(c)) != std::string_view::npos;
    };
    if (!argument.empty() && std::all_of(argument.begin(), argument.end(), plain)) return argument;
    std::string quoted = "'";
    for (char c : argument) {
        if (c == '\'')
            quoted += "'\\''";
        else
            quoted += c;
    }
    return quoted + "'";
}

}  // namespace intaglio::maps
