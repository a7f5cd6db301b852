// The folder that a build writes: locked while it does, each file replaced whole and only when its
// bytes change, nothing touched before everything is on the disk, the manifest last.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "generator/base/result.h"
#include "src/build/maps.h"

namespace intaglio::build {

class OutputFolder {
  public:
    // Build: alone in the folder.  Step: beside other steps, each with files of its own.
    enum class Use { Build, Step };
    // Makes the folder, and waits until it may be used so.  Error "file-unwritable".
    static Result<OutputFolder> open(const std::filesystem::path& folder, Use use = Use::Build);

    const std::filesystem::path& path() const { return folder_; }
    // A file of the build's own state.
    std::filesystem::path state(const std::string& name) const;

    // After an error: what `open` made goes again, unless something else lies in it by now.
    void withdraw();

    // Replaces what differs.  Files of an earlier build that are no longer made go, if the manifest
    // that lies there says that they were that build's.  An error leaves every old file as it was,
    // unless the system refuses the very last step, a renaming.  The last file is put in place
    // last. `kept`: further names that stay.
    Status replace(const std::vector<OutputFile>& files, const std::set<std::string>& kept = {});
    // The same for the files of one step: nothing goes but what they replace.
    Status write(const std::vector<OutputFile>& files) const;

    // Of the last `replace`.
    int written() const { return written_; }
    int removed() const { return removed_; }

    OutputFolder(OutputFolder&& other) noexcept;
    OutputFolder& operator=(OutputFolder&&) = delete;
    ~OutputFolder();

  private:
    OutputFolder(std::filesystem::path folder, int lock, std::vector<std::filesystem::path> made)
        : folder_(std::move(folder)), lock_(lock), made_(std::move(made)) {}
    using Renames = std::vector<std::pair<std::filesystem::path, std::filesystem::path>>;
    Result<Renames> write_beside(const std::vector<OutputFile>& files) const;
    void remove_abandoned() const;
    void remove_all(const std::set<std::string>& names);
    std::vector<std::string> listed_before() const;

    std::filesystem::path folder_;
    int lock_ = -1;
    std::vector<std::filesystem::path> made_;  // folders, the innermost first
    int written_ = 0, removed_ = 0;
};

}  // namespace intaglio::build
