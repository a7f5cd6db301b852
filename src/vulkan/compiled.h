// What a GPU's own compiler makes of a program: its instructions, registers and estimated cycles,
// as the driver tells them (VK_KHR_pipeline_executable_properties).  Nothing is drawn, so it works
// for a chip that is not there: Device::create({.chip = "polaris10"}).
#pragma once

#include <string>
#include <vector>

#include "src/check/frontend.h"
#include "src/vulkan/device.h"

namespace intaglio::vulkan {

// A number in the driver's words: "Instructions", "VGPRs", "Latency" (cycles of one wave),
// "Inverse Throughput" (cycles between waves), "Code size" (bytes), ...
struct Statistic {
    std::string name;
    double value = 0;
    bool operator==(const Statistic&) const = default;
};

// Of one stage, in the driver's order.
struct CompiledStage {
    bool pixel = false;
    std::vector<Statistic> statistics;
    // The statistic of that name; nothing where the driver tells none.
    const Statistic* find(std::string_view name) const;
    bool operator==(const CompiledStage&) const = default;
};

// The stages that the driver made, vertex first.  Errors: `no-statistics` (the device was not
// opened for a chip, or its driver tells nothing), those of Program::prepare that come from the
// shaders, and the driver's.
Result<std::vector<CompiledStage>> compile(const Device& device, const check::Program& shaders);

}  // namespace intaglio::vulkan
