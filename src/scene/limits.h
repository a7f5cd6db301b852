// Tolerances and budgets of a scene file: by metric, and by target in a table within.  Inside
// src/scene only.
#pragma once

#include <map>
#include <string>

#include "src/scene/reader.h"

namespace intaglio::scene {

// By target ("*": every one) and metric: the most it may be.
using Limits = std::map<std::string, std::map<std::string, double>>;

enum class Limited { Error, Cost };
// `tolerance` or `budget` in the document or a surface; `title` as in "[tolerance]".
Limits read_limits(Reader& reader, const Value& parent, std::string_view key,
                   std::string_view title, Limited what);
// The scene's, and a surface's above them: on one target the surface's own for it count before the
// surface's for all, these before the scene's for it, and these before the scene's for all.  Has
// "*" and every target that either names.
Limits merged(const Limits& scene, const Limits& surface);
// What holds on one target; metrics that its variants do not have are left out.
std::map<std::string, double> limits_on(const Limits& limits, const std::string& target);

// Refuses a name that is no target with a pixel stage.
void check_target(Reader& reader, Position position, const std::string& name);

}  // namespace intaglio::scene
