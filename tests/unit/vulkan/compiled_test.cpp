// A GPU's compiler without the GPU: what it says must follow what it was given.
#include "src/vulkan/compiled.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include <fmt/format.h>

#include "tests/unit/vulkan/harness.h"

namespace intaglio::vulkan {
namespace {

using testing::HasSubstr;

// `reads` dependent reads, one after the other.
check::Program chain_of_reads(int reads) {
    std::string text =
        "layout(location = 0) in vec2 uv; layout(location = 0) out vec4 colour;\n"
        "layout(binding = 0) uniform sampler2D map;\n"
        "layout(binding = 1) uniform Block { vec2 scale; };\n"
        "void main() { vec2 at = uv;\n";
    for (int i = 0; i < reads; ++i) text += "at = scale * textureLod(map, at, 0.0).xy;\n";
    return {quad_vertex().spirv, glsl_fragment(text + "colour = at.xyxy; }").spirv};
}

double told(const std::vector<CompiledStage>& stages, const char* name) {
    const Statistic* found = stages.back().find(name);
    EXPECT_NE(found, nullptr) << name;
    return found ? found->value : 0;
}

TEST(Compiled, MoreReadsCostMoreOnAnOldAndANewerChip) {
    for (const char* chip : {"polaris10", "navi21"}) {
        EXPECT_THAT(chips(), testing::Contains(chip));
        const auto device = Device::create({.chip = chip});
        ASSERT_TRUE(device.ok()) << to_string(device.error());
        EXPECT_THAT(device->name(), HasSubstr("RADV"));
        double latency = 0, instructions = 0, size = 0;
        for (int reads : {1, 2, 4, 8}) {
            const auto stages = compile(*device, chain_of_reads(reads));
            ASSERT_TRUE(stages.ok()) << to_string(stages.error());
            ASSERT_EQ(stages->size(), 2u);
            EXPECT_FALSE(stages->front().pixel);
            EXPECT_TRUE(stages->back().pixel);
            // A read that waits for the one before costs its whole latency, hundreds of cycles.
            EXPECT_GT(told(*stages, "Latency"), latency + 100);
            EXPECT_GT(told(*stages, "Instructions"), instructions);
            EXPECT_GT(told(*stages, "Code size"), size);
            EXPECT_GT(told(*stages, "VGPRs"), 0);
            EXPECT_GT(told(*stages, "Inverse Throughput"), 0);
            latency = told(*stages, "Latency");
            instructions = told(*stages, "Instructions");
            size = told(*stages, "Code size");
        }
        // The same shader gives the same numbers.
        EXPECT_EQ(*compile(*device, chain_of_reads(3)), *compile(*device, chain_of_reads(3)));
    }
    EXPECT_EQ(std::getenv("RADV_FORCE_FAMILY"), nullptr);
}

TEST(Compiled, AChipThatNoDriverKnowsIsASentence) {
    const auto device = Device::create({.chip = "voodoo5"});
    ASSERT_FALSE(device.ok());
    EXPECT_THAT(to_string(device.error()),
                testing::AllOf(HasSubstr("unknown chip 'voodoo5'"), HasSubstr("polaris10"),
                               HasSubstr("[unknown-chip]")));
}

TEST(Compiled, ADeviceThatDrawsTellsNothing) {
    const auto device = Device::create();
    ASSERT_TRUE(device.ok());
    const auto stages = compile(*device, chain_of_reads(1));
    ASSERT_FALSE(stages.ok());
    EXPECT_THAT(to_string(stages.error()), HasSubstr("[no-statistics]"));
}

}  // namespace
}  // namespace intaglio::vulkan
