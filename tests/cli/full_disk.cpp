// A disk that is full, or read-only, for one program: loaded before the C library, it lets a
// program write so many bytes in all (INTAGLIO_DISK_BYTES) and then answers as such a disk does;
// with INTAGLIO_DISK_READ_ONLY nothing below that folder can be made.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdlib>
#include <cstring>

namespace {

template <typename Function>
Function real(const char* name) {
    return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

std::atomic<long> spent{0};

// -1: without end.
long disk_bytes() {
    static const long bytes = [] {
        const char* text = std::getenv("INTAGLIO_DISK_BYTES");
        return text == nullptr ? -1 : std::atol(text);
    }();
    return bytes;
}

bool refuses(const char* path) {
    const char* folder = std::getenv("INTAGLIO_DISK_READ_ONLY");
    return folder != nullptr && std::strncmp(path, folder, std::strlen(folder)) == 0;
}

bool writes(int flags) { return (flags & (O_WRONLY | O_RDWR | O_CREAT)) != 0; }

}  // namespace

extern "C" {

ssize_t write(int file, const void* bytes, size_t size) {
    struct stat status {};
    if (disk_bytes() >= 0 && file > 2 && fstat(file, &status) == 0 && S_ISREG(status.st_mode)) {
        const long room = disk_bytes() - spent;
        if (room <= 0) {
            errno = ENOSPC;
            return -1;
        }
        if (static_cast<long>(size) > room) size = static_cast<size_t>(room);
        spent += static_cast<long>(size);
    }
    return real<ssize_t (*)(int, const void*, size_t)>("write")(file, bytes, size);
}

int open(const char* path, int flags, ...) {
    va_list more;
    va_start(more, flags);
    const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(more, mode_t) : 0;
    va_end(more);
    if (writes(flags) && refuses(path)) {
        errno = EROFS;
        return -1;
    }
    return real<int (*)(const char*, int, ...)>("open")(path, flags, mode);
}

int mkdir(const char* path, mode_t mode) noexcept {
    if (refuses(path)) {
        errno = EROFS;
        return -1;
    }
    return real<int (*)(const char*, mode_t)>("mkdir")(path, mode);
}

}  // extern "C"
