// Work that is over before the eye sees a line gets none.
#include "src/cli/progress.h"

#include <unistd.h>

#include <cstdio>
#include <utility>

#include <fmt/format.h>

namespace intaglio::cli {
namespace {

constexpr std::chrono::milliseconds between_drawings{100};

}  // namespace

ProgressLine::ProgressLine(std::string verb, std::string noun)
    : verb_(std::move(verb)),
      noun_(std::move(noun)),
      terminal_(isatty(STDERR_FILENO) == 1),
      last_(std::chrono::steady_clock::now()) {}

ProgressLine::~ProgressLine() {
    if (drawn_) fmt::print(stderr, "\n");
}

void ProgressLine::operator()(int done, int all) {
    if (!terminal_) return;
    const auto now = std::chrono::steady_clock::now();
    const bool last = done == all && drawn_;
    if (!last && now - last_ < between_drawings) return;
    last_ = now;
    fmt::print(stderr, "\r{} {} of {} {}", verb_, done, all, noun_);
    std::fflush(stderr);
    drawn_ = true;
}

}  // namespace intaglio::cli
