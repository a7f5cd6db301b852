// What a budget can limit: one table of names, units and makers.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace intaglio::d3d9 {
struct Resources;
}

namespace intaglio::measure {

struct Metric {
    std::string_view name;  // as budgets.toml writes it
    std::string_view unit;  // of its numbers, for people
    enum class Of {
        Direct3D9,  // slots and registers of a ps_* target
        Spirv,      // every other target that becomes SPIR-V
        Both,
    } of;
    bool is_error;           // not a cost
    std::string_view about;  // what it counts, and who counts it
};

// Costs first.  In all of them less is better.
std::span<const Metric> metrics();
const Metric* find_metric(std::string_view name);
std::vector<std::string> metric_names();

// What a Direct3D 9 shader uses, by the names of the metrics that it is counted for, in their
// order.
std::array<std::pair<std::string_view, int>, 7> metrics_of(const d3d9::Resources& used);

}  // namespace intaglio::measure
