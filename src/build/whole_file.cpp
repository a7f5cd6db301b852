// POSIX calls, because they tell in errno what the system refused, and because only they sync.
#include "src/build/whole_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <system_error>

#include <fmt/format.h>

namespace intaglio::build {
namespace {

// Returns 0 or errno.
int write_all(int file, std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t count = ::write(file, bytes.data(), bytes.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return errno;
        bytes.remove_prefix(static_cast<std::size_t>(count));
    }
    return 0;
}

std::string_view host() {
    static const std::array<char, 65> name = [] {
        std::array<char, 65> buffer{};
        ::gethostname(buffer.data(), buffer.size() - 1);
        return buffer;
    }();
    return name.data();
}

}  // namespace

std::filesystem::path temporary_beside(const std::filesystem::path& path) {
    static std::atomic<unsigned> counter{0};
    std::filesystem::path temporary = path;
    temporary.replace_filename(
        fmt::format("{}{}.{}.{}.tmp", temporary_prefix, host(), ::getpid(), counter++));
    return temporary;
}

Diagnostic unwritable(const std::filesystem::path& path, int error) {
    const std::string folder =
        path.has_parent_path() ? path.parent_path().string() : std::string(".");
    std::string why = std::generic_category().message(error);
    if (error == ENOSPC || error == EDQUOT)
        why = "the disk is full";
    else if (error == EFBIG)
        why = "the system allows no file of this size";
    else if (error == EROFS)
        why = "the disk is read-only";
    else if (error == EACCES || error == EPERM)
        why = fmt::format("there is no permission to write in {}", folder);
    return input_error("file-unwritable", fmt::format("this file cannot be written: {}", why),
                       path.string());
}

Status write_new(const std::filesystem::path& path, std::string_view bytes, bool durable) {
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (file < 0) return unwritable(path, errno);
    int failure = write_all(file, bytes);
    if (failure == 0 && durable && ::fsync(file) != 0 && errno != EINVAL) failure = errno;
    // A full disk may show only here.
    if (::close(file) != 0 && failure == 0) failure = errno;
    if (failure == 0) return Done{};
    ::unlink(path.c_str());
    return unwritable(path, failure);
}

bool read_bytes(const std::filesystem::path& path, std::string& bytes) {
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) return false;
    struct stat status {};
    bool fine = ::fstat(file, &status) == 0 && S_ISREG(status.st_mode);
    if (fine) bytes.resize(static_cast<std::size_t>(status.st_size));
    for (std::size_t at = 0; fine && at < bytes.size();) {
        const ssize_t count = ::read(file, bytes.data() + at, bytes.size() - at);
        if (count < 0 && errno == EINTR) continue;
        fine = count > 0;
        if (fine) at += static_cast<std::size_t>(count);
    }
    ::close(file);
    return fine;
}

bool holds(const std::filesystem::path& path, std::string_view bytes) {
    struct stat status {};
    if (::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode) ||
        static_cast<std::size_t>(status.st_size) != bytes.size())
        return false;
    std::string present;
    return read_bytes(path, present) && present == bytes;
}

}  // namespace intaglio::build
