// Devices by name, and what one hears when there is none.
#include "src/vulkan/device.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cctype>
#include <cstdlib>
#include <optional>

#include "tests/unit/vulkan/harness.h"

namespace intaglio::vulkan {
namespace {

using testing::HasSubstr;

TEST(Device, DefaultIsOneThatTheDriversList) {
    const auto device = Device::create();
    ASSERT_TRUE(device.ok()) << to_string(device.error());
    const auto names = Device::list();
    ASSERT_TRUE(names.ok());
    EXPECT_THAT(*names, testing::Contains(device->name()));
    EXPECT_FALSE(device->driver().empty());
    EXPECT_GE(device->timestamp_period(), 0);
    EXPECT_THAT(device->validation_messages(), testing::IsEmpty());
}

TEST(Device, DefaultIsLavapipeWhereItIsInstalled) {
    const auto device = Device::create();
    ASSERT_TRUE(device.ok());
    EXPECT_THAT(device->name(), HasSubstr("llvmpipe"));
    EXPECT_TRUE(device->is_cpu());
}

TEST(Device, IsFoundByPartOfItsNameInAnyCase) {
    const auto first = Device::list();
    ASSERT_TRUE(first.ok());
    std::string part = first->front().substr(0, 6);
    for (char& c : part) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    const auto device = Device::create({.device = part});
    ASSERT_TRUE(device.ok()) << to_string(device.error());
    EXPECT_EQ(device->name().substr(0, 6), first->front().substr(0, 6));
}

TEST(Device, UnknownNameListsWhatThereIs) {
    const auto names = Device::list();
    ASSERT_TRUE(names.ok());
    const auto device = Device::create({.device = "Voodoo 5"});
    ASSERT_FALSE(device.ok());
    EXPECT_THAT(to_string(device.error()),
                testing::AllOf(HasSubstr("no Vulkan device has 'Voodoo 5' in its name; there is: "),
                               HasSubstr(names->front()), HasSubstr("[unknown-device]")));
}

TEST(Device, NoDriverIsASentenceWithAHint) {
    // The loader reads these at each creation of an instance; the older name is for older loaders.
    const std::vector<std::string> names = {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"};
    std::vector<std::optional<std::string>> before;
    for (const std::string& name : names) {
        const char* value = std::getenv(name.c_str());
        before.push_back(value ? std::optional<std::string>(value) : std::nullopt);
        setenv(name.c_str(), "/nonexistent/driver.json", 1);
    }
    const auto device = Device::create();
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (before[i]) {
            setenv(names[i].c_str(), before[i]->c_str(), 1);
        } else {
            unsetenv(names[i].c_str());
        }
    }
    ASSERT_FALSE(device.ok());
    EXPECT_EQ(device.error().code, "no-vulkan-device");
    EXPECT_THAT(to_string(device.error()), HasSubstr("hint: install a Vulkan driver"));
}

TEST(Device, PictureBeyondItsMemoryIsASentence) {
    const auto device = Device::create();
    ASSERT_TRUE(device.ok()) << to_string(device.error());
    // 4 GiB for a target, and lavapipe allocates at most 2 GiB.
    const Draw draw = quad_draw(
        glsl_fragment("layout(location = 0) out vec4 n; void main() { n = vec4(1.0); }"), 16384);
    EXPECT_THAT(refusal(*device, draw), HasSubstr("is out of memory [out-of-memory]"));
}

// The other tests trust an empty list, so it must be able to fill.
TEST(Device, ValidationMessagesAreCollected) {
    for (const bool validation : {true, false}) {
        const auto device = Device::create({.device = "", .validation = validation});
        ASSERT_TRUE(device.ok()) << to_string(device.error());
        // Integers into a float target: legal SPIR-V, a wrong pipeline, and harmless to lavapipe.
        const Draw draw = quad_draw(
            glsl_fragment("layout(location = 0) out ivec4 n; void main() { n = ivec4(1); }"), 1);
        ASSERT_TRUE(Program::prepare(*device, draw).ok());
        if (validation) {
            EXPECT_THAT(device->validation_messages(),
                        testing::Contains(HasSubstr("does not match fragment shader output")));
        } else {
            EXPECT_THAT(device->validation_messages(), testing::IsEmpty());
        }
    }
}

}  // namespace
}  // namespace intaglio::vulkan
