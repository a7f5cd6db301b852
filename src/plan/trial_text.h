// Trials as the files of the cache hold them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "src/plan/trial.h"

namespace intaglio::plan {

// Part of every key: raised when a member changes its meaning, or what a trial does changes.
inline constexpr int trial_schema = 1;

std::string to_text(const Trial& trial);
// Nothing where it is no trial.
std::optional<Trial> read_trial(std::string_view text);

}  // namespace intaglio::plan
