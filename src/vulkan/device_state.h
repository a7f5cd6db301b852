// The instance, the device and what all programs on it share.  Internal to src/vulkan.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <vulkan/vulkan.h>

#include "generator/base/result.h"

namespace intaglio::vulkan {

// Nothing, or what went wrong.
using Failure = std::optional<Diagnostic>;

// The sentence for a Vulkan result that is not success; `what` completes "cannot ...", e.g. "create
// a buffer".
Failure check(VkResult result, const char* what);

// What the validation layer said; drivers may call back from any thread.
struct MessageLog {
    std::mutex mutex;
    std::vector<std::string> messages;
};

struct InstanceState {
    // The log outlives the instance, which still reports while it is destroyed.
    std::unique_ptr<MessageLog> log = std::make_unique<MessageLog>();
    VkInstance instance = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;

    InstanceState() = default;
    InstanceState(const InstanceState&) = delete;
    InstanceState& operator=(const InstanceState&) = delete;
    ~InstanceState();
};

struct DeviceState {
    std::unique_ptr<InstanceState> instance;
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkPhysicalDeviceProperties properties{};
    VkPhysicalDeviceMemoryProperties memory{};
    std::string driver;
    bool independent_blend = false;  // may targets differ in the components that are written?
    std::uint32_t queue_family = 0;
    std::uint32_t timestamp_bits = 0;  // 0: no timestamps on the queue
    bool tells_statistics = false;     // VK_KHR_pipeline_executable_properties is on
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    VkCommandPool pool = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;

    DeviceState() = default;
    DeviceState(const DeviceState&) = delete;
    DeviceState& operator=(const DeviceState&) = delete;
    ~DeviceState();
};

}  // namespace intaglio::vulkan
