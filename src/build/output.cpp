// New files are written into the state folder, on the same disk, and renamed from there.
#include "src/build/output.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "src/build/manifest.h"
#include "src/build/names.h"
#include "src/build/whole_file.h"

namespace intaglio::build {
namespace {

namespace fs = std::filesystem;

// A manifest that was tampered with must not make a build remove what is not its own.
bool is_plain_name(const std::string& name) {
    return !name.empty() && name != "." && name != ".." && name.find('/') == std::string::npos;
}

// The folder and those that it lies in, as far as they are not there; the innermost first.
std::vector<fs::path> missing_folders(fs::path folder) {
    std::vector<fs::path> missing;
    std::error_code ignored;
    for (; !folder.empty() && !fs::exists(folder, ignored); folder = folder.parent_path())
        missing.push_back(folder);
    return missing;
}

// Whether the open file is the one at this path, which another build may have removed.
bool lies_at(int file, const fs::path& path) {
    struct stat locked = {};
    struct stat named = {};
    return ::fstat(file, &locked) == 0 && ::stat(path.c_str(), &named) == 0 &&
           locked.st_dev == named.st_dev && locked.st_ino == named.st_ino;
}

}  // namespace

Result<OutputFolder> OutputFolder::open(const fs::path& folder, Use use) {
    const fs::path state = folder / state_folder;
    const fs::path path = state / "lock";
    for (;;) {
        std::vector<fs::path> made = missing_folders(state);
        std::error_code failure;
        fs::create_directories(state, failure);
        if (failure) return unwritable(state, failure.value());
        const int lock = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        const int reason = errno;
        if (lock < 0 && !fs::exists(state, failure)) continue;  // withdrawn between the two calls
        if (lock < 0) return unwritable(path, reason);
        OutputFolder output(folder, lock, std::move(made));
        while (::flock(lock, use == Use::Build ? LOCK_EX : LOCK_SH) != 0)
            if (errno != EINTR) return unwritable(path, errno);
        if (!lies_at(lock, path)) continue;  // whoever held it has withdrawn
        if (use == Use::Build) output.remove_abandoned();
        return output;
    }
}

void OutputFolder::withdraw() {
    if (made_.empty()) return;
    std::error_code ignored;
    const fs::path lock = state("lock");
    for (fs::directory_iterator it(folder_ / state_folder, ignored), end; it != end;
         it.increment(ignored))
        if (it->path() != lock) return;
    fs::remove(lock, ignored);
    for (const fs::path& folder : made_)
        if (!fs::remove(folder, ignored)) return;
}

fs::path OutputFolder::state(const std::string& name) const {
    return folder_ / state_folder / name;
}

// Under the lock, so whoever wrote them is dead.
void OutputFolder::remove_abandoned() const {
    std::error_code ignored;
    for (fs::directory_iterator it(folder_ / state_folder, ignored), end; it != end;
         it.increment(ignored))
        if (it->path().filename().string().rfind(temporary_prefix, 0) == 0)
            fs::remove(it->path(), ignored);
}

std::vector<std::string> OutputFolder::listed_before() const {
    std::string text;
    const fs::path manifest = folder_ / manifest_file;
    if (!read_bytes(manifest, text)) return {};
    Result<std::vector<std::string>> names = files_listed(text, manifest.string());
    return names ? std::move(*names) : std::vector<std::string>();
}

namespace {

void drop(const std::vector<std::pair<fs::path, fs::path>>& renames) {
    std::error_code ignored;
    for (const auto& [from, to] : renames) fs::remove(from, ignored);
}

Status move_file(const fs::path& from, const fs::path& to) {
    if (std::rename(from.c_str(), to.c_str()) != 0) return unwritable(to, errno);
    return Done{};
}

}  // namespace

// From where to where.
Result<OutputFolder::Renames> OutputFolder::write_beside(
    const std::vector<OutputFile>& files) const {
    Renames renames;
    for (const OutputFile& file : files) {
        const fs::path place = folder_ / file.name;
        if (holds(place, file.bytes)) continue;
        const fs::path temporary = temporary_beside(state("new"));
        if (Status written = write_new(temporary, file.bytes, false); !written) {
            drop(renames);
            Diagnostic error = written.error();
            error.file = place.string();
            return error;
        }
        renames.emplace_back(temporary, place);
    }
    return renames;
}

Status OutputFolder::write(const std::vector<OutputFile>& files) const {
    const Result<Renames> renames = write_beside(files);
    if (!renames) return renames.error();
    for (const auto& [from, to] : *renames)
        if (Status moved = move_file(from, to); !moved) {
            drop(*renames);
            return moved;
        }
    return Done{};
}

Status OutputFolder::replace(const std::vector<OutputFile>& files,
                             const std::set<std::string>& kept) {
    const Result<Renames> renames = write_beside(files);
    if (!renames) return renames.error();
    std::set<std::string> stale;
    for (const std::string& name : listed_before())
        if (is_plain_name(name) && !kept.contains(name)) stale.insert(name);
    for (const OutputFile& file : files) stale.erase(file.name);
    written_ = removed_ = 0;
    for (const auto& [from, to] : *renames) {
        // Before the manifest that does not list them: after it nobody would know whose they are.
        if (to == folder_ / files.back().name) remove_all(stale);
        if (Status moved = move_file(from, to); !moved) {
            drop(*renames);
            return moved;
        }
        ++written_;
    }
    return Done{};
}

void OutputFolder::remove_all(const std::set<std::string>& names) {
    std::error_code ignored;
    for (const std::string& name : names) removed_ += fs::remove(folder_ / name, ignored) ? 1 : 0;
}

OutputFolder::OutputFolder(OutputFolder&& other) noexcept
    : folder_(std::move(other.folder_)),
      lock_(std::exchange(other.lock_, -1)),
      made_(std::move(other.made_)),
      written_(other.written_),
      removed_(other.removed_) {}

OutputFolder::~OutputFolder() {
    if (lock_ >= 0) ::close(lock_);
}

}  // namespace intaglio::build
