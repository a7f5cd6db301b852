// What the live part's script reads: programs, maps and words, as JSON.  Internal to src/report.
#pragma once

#include <string>

#include "src/report/live.h"

namespace intaglio::report {

// {lines, techniques, shadows, programs, reference, maps, uniforms, scale, ramp}: a program is two
// lists of numbers of lines, because 150 shaders have few lines that differ; a texture is a list of
// levels, each a PNG in base64, a volume's slices below each other.  No '<' is in the text.
Result<std::string> live_data(const dsl::Catalogue& catalogue, const LiveOptions& options);

}  // namespace intaglio::report
