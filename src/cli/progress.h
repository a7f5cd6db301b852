// How far long work is, as one line of stderr that is written over; nothing where stderr is no
// terminal.
#pragma once

#include <chrono>
#include <string>

namespace intaglio::cli {

class ProgressLine {
  public:
    // "measured 3 of 10 views": ProgressLine("measured", "views").
    ProgressLine(std::string verb, std::string noun);
    // Ends a line that the work left unfinished.
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    // Of one call at a time; drawn at most ten times a second, and at the end.
    void operator()(int done, int all);

  private:
    const std::string verb_, noun_;
    const bool terminal_;
    bool drawn_ = false;
    std::chrono::steady_clock::time_point last_{};
};

}  // namespace intaglio::cli
