// What a variant costs and how wrong it is, as numbers under the metrics' names; and files of them,
// one line a variant, in order, so that merges are plain.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "generator/dsl/catalogue.h"
#include "src/scene/measurement.h"

namespace intaglio::budget {

struct Observation {
    std::string surface, target, settings;  // as the scene asks for it
    // By metric's name, to six digits, the worst of all cases.  A metric that could not be had (no
    // pixel reported a hit) is absent.
    std::map<std::string, double> values;
    // Of an error: which command shows its worst case; may be empty.
    std::map<std::string, std::string> commands;
    // Slots or operations of the pixel stage (variant/explain.h) by "step at file:line".
    std::map<std::string, double> lines;
    std::string refusal;  // of a variant that its target does not hold; then nothing else is known
    // Asked for by a scene, which is not served by a refusal that was there before as well.
    bool wanted = false;

    // "parallax_occlusion taps=8 on ps_2_0"
    std::string name() const;
};

// By surface, target and settings.
bool operator<(const Observation& a, const Observation& b);

// Emits and measures every variant of the scene; in order.  Errors: those of measure::measure.
Result<std::vector<Observation>> observe(
    const dsl::Catalogue& catalogue, const scene::Measurement& scene,
    const std::function<void(int done, int all)>& progress = {});

// JSON lines, sorted, every number as in the observation; without commands.
std::string to_lines(const std::vector<Observation>& observations);
// Codes: those of maps::read_file, "baseline-syntax" with the line, "baseline-duplicate".
Result<std::vector<Observation>> read_lines(const std::filesystem::path& path);

}  // namespace intaglio::budget
