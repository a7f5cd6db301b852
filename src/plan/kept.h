// What trials gave, kept by everything that went into them: in memory, and in a folder that
// outlives the process and may be shared.
#pragma once

#include <atomic>
#include <filesystem>
#include <string>

#include "generator/base/result.h"
#include "src/measure/shared.h"
#include "src/plan/trial.h"

namespace intaglio::plan {

// The linker's id of this program: another one may have other techniques.  Empty where it has none,
// and then nothing is kept.
std::string program_id();

class Kept {
  public:
    // `folder` empty: in memory alone.
    explicit Kept(std::filesystem::path folder);

    // Runs it where it is not known yet.
    Result<Trial> run(const Site& site, const VariantRequest& request, const Rays& rays, Ask ask);

    int tried() const { return tried_; }
    int found() const { return found_; }

  private:
    std::filesystem::path folder_;
    std::string program_;
    measure::SharedCache<Result<Trial>> trials_{1 << 16};
    std::atomic<int> tried_ = 0, found_ = 0;
};

}  // namespace intaglio::plan
