// The hard suite as a page: docs/hard-cases.md.
#pragma once

#include <string>

#include "src/measure/hard.h"

namespace intaglio::report {

// Markdown: how to read it, the cases, a line of signs for each technique and case, and by
// technique what is not fine, with its amount.  The same suite gives the same bytes.
std::string hard_page(const measure::HardSuite& suite);
// One technique's part of it, so that a test can compare a part.
std::string hard_section(const measure::HardSuite& suite, std::size_t row);
// "fine", "1.3 texels, 12 % missed", "NaN or Inf in 64 of 64": a cell in words; empty where nothing
// is asked.
std::string hard_words(const measure::HardRow& row, const measure::HardCase& hard_case,
                       const measure::HardCell& cell);

}  // namespace intaglio::report
