// The table.
#include "src/measure/named_metric.h"

#include "generator/target/d3d9/resources.h"

namespace intaglio::measure {
namespace {

using Of = Metric::Of;
constexpr Metric table[] = {
    {"arithmetic", "slots", Of::Direct3D9, false,
     "arithmetic slots of the pixel stage, as Direct3D's validator charges"},
    {"texture", "slots", Of::Direct3D9, false, "texture slots of the pixel stage"},
    {"total", "slots", Of::Direct3D9, false, "all slots of the pixel stage"},
    {"temps", "registers", Of::Direct3D9, false, "temporary registers of the pixel stage"},
    {"constants", "registers", Of::Direct3D9, false, "float constants of the pixel stage"},
    {"samplers", "samplers", Of::Direct3D9, false, "samplers of the pixel stage"},
    {"dependent_level", "levels", Of::Direct3D9, false,
     "how many texture reads wait for each other"},
    {"spirv_alu", "instructions", Of::Spirv, false,
     "arithmetic of the pixel stage after SPIRV-Tools' optimiser"},
    {"spirv_texture", "instructions", Of::Spirv, false,
     "texture instructions of the pixel stage after the optimiser"},
    {"spirv_branch", "instructions", Of::Spirv, false,
     "branches of the pixel stage after the optimiser"},
    {"longest_path", "instructions", Of::Spirv, false,
     "the longest way through the pixel stage, loops at their greatest count"},
    {"reads", "per pixel", Of::Both, false,
     "texture reads of search and shadow, counted on the run: the mean of the dearest case"},
    {"median", "texels", Of::Both, true, "median error of the hit, in the worst case"},
    {"p95", "texels", Of::Both, true, "95th percentile of the error of the hit, in the worst case"},
    {"p99", "texels", Of::Both, true, "99th percentile of the error of the hit, in the worst case"},
    {"height", "of the relief", Of::Both, true, "greatest error of the reported height"},
    {"missed", "% of pixels", Of::Both, true,
     "rays that went through a feature, in the worst case"},
    {"shadow_wrong", "% of pixels", Of::Both, true,
     "visibility judged otherwise than exact, in the worst case"},
    {"invalid", "pixels", Of::Both, true, "pixels with NaN or Inf in hit or colour, of all cases"},
    {"p95_fp24", "texels", Of::Direct3D9, true, "p95 in the 24 bits of R300"},
    {"p95_fp16", "texels", Of::Direct3D9, true, "p95 in 16 bits (_pp everywhere)"},
    {"missed_fp24", "% of pixels", Of::Direct3D9, true, "missed in the 24 bits of R300"},
    {"missed_fp16", "% of pixels", Of::Direct3D9, true, "missed in 16 bits (_pp everywhere)"},
};

}  // namespace

std::span<const Metric> metrics() { return table; }

std::array<std::pair<std::string_view, int>, 7> metrics_of(const d3d9::Resources& used) {
    return {{{"arithmetic", used.arithmetic},
             {"texture", used.texture},
             {"total", used.total},
             {"temps", used.temps},
             {"constants", used.constants},
             {"samplers", used.samplers},
             {"dependent_level", used.dependent_level}}};
}

const Metric* find_metric(std::string_view name) {
    for (const Metric& metric : table)
        if (metric.name == name) return &metric;
    return nullptr;
}

std::vector<std::string> metric_names() {
    std::vector<std::string> names;
    for (const Metric& metric : table) names.emplace_back(metric.name);
    return names;
}

}  // namespace intaglio::measure
