// Runs the hard suite (hard_cases.h): every technique on every case, on the device and in the
// evaluator in three arithmetics, each result judged by what the case expects.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "generator/dsl/catalogue.h"
#include "generator/ir/evaluate.h"
#include "src/measure/hard_cases.h"
#include "src/vulkan/device.h"

namespace intaglio::measure {

// Where a technique runs: glsl_450 on the device, or its IR in one of the evaluator's precisions.
enum class Way { Device, Single, Narrow24, Narrow16 };
inline constexpr std::array all_ways = {Way::Device, Way::Single, Way::Narrow24, Way::Narrow16};
// "device", "fp32", "fp24", "fp16".
std::string_view name_of(Way way);

enum class Verdict {
    Absent,        // the case asks nothing of this technique
    NoSuchNumber,  // an input of the case is beyond the way's format
    Fine,          // as expected
    Degraded,      // defined and finite, and further from the expected than that allows
    Broken,        // NaN, Inf, or a value that means nothing: a point off the ray, a negative light
};

struct HardCell {
    Verdict verdict = Verdict::Absent;
    // The 95th percentile over the rays: texels of searches, 1/255 of colours and, where its own
    // formula is asked of it, of shadows; else the share of points misjudged.
    double amount = 0;
    double missed = 0;  // share of the rays that went through a feature
    int invalid = 0;    // rays with NaN or Inf
    int astray = 0;     // rays whose result is finite and means nothing
    int rays = 0;
};

struct HardSuite {
    std::vector<HardRow> rows;
    std::vector<HardCase> cases;
    // By row, case, way.
    std::vector<std::vector<std::array<HardCell, all_ways.size()>>> cells;
    std::string device;
};

// `progress` is told how many of how many rows are done; it may be empty.  Errors: those of
// make_variant, of the bakes and of drawing.
Result<HardSuite> run_hard_suite(const vulkan::Device& device, const dsl::Catalogue& catalogue,
                                 const std::vector<HardRow>& rows,
                                 const std::vector<HardCase>& cases,
                                 const std::function<void(int done, int all)>& progress = {});

// What is asked of a technique in a case; nothing where its part is not looked at.
std::optional<Expect> expected_of(const HardRow& row, const HardCase& hard_case);

}  // namespace intaglio::measure
