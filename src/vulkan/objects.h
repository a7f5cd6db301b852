// Vulkan objects that destroy themselves, and the few ways in which the runner makes them. Internal
// to src/vulkan.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include <vulkan/vulkan.h>

#include "generator/base/result.h"
#include "src/vulkan/device_state.h"
#include "src/vulkan/texture.h"

namespace intaglio::vulkan {

// A handle that belongs to a device.  The device must outlive it.
template <typename T, auto destroy>
class Owned {
  public:
    using Raw = T;
    Owned() = default;
    Owned(VkDevice device, T handle) : device_(device), handle_(handle) {}
    Owned(Owned&& other) noexcept
        : device_(other.device_), handle_(std::exchange(other.handle_, VK_NULL_HANDLE)) {}
    Owned& operator=(Owned&& other) noexcept {
        std::swap(device_, other.device_);
        std::swap(handle_, other.handle_);
        return *this;
    }
    ~Owned() {
        if (handle_ != VK_NULL_HANDLE) destroy(device_, handle_, nullptr);
    }
    T get() const { return handle_; }

  private:
    VkDevice device_ = VK_NULL_HANDLE;
    T handle_ = VK_NULL_HANDLE;
};

using OwnedBuffer = Owned<VkBuffer, vkDestroyBuffer>;
using OwnedMemory = Owned<VkDeviceMemory, vkFreeMemory>;
using OwnedImage = Owned<VkImage, vkDestroyImage>;
using OwnedView = Owned<VkImageView, vkDestroyImageView>;
using OwnedSampler = Owned<VkSampler, vkDestroySampler>;
using OwnedFence = Owned<VkFence, vkDestroyFence>;
using OwnedShader = Owned<VkShaderModule, vkDestroyShaderModule>;
using OwnedSetLayout = Owned<VkDescriptorSetLayout, vkDestroyDescriptorSetLayout>;
using OwnedDescriptorPool = Owned<VkDescriptorPool, vkDestroyDescriptorPool>;
using OwnedPipelineLayout = Owned<VkPipelineLayout, vkDestroyPipelineLayout>;
using OwnedPipeline = Owned<VkPipeline, vkDestroyPipeline>;
using OwnedRenderPass = Owned<VkRenderPass, vkDestroyRenderPass>;
using OwnedFramebuffer = Owned<VkFramebuffer, vkDestroyFramebuffer>;
using OwnedQueryPool = Owned<VkQueryPool, vkDestroyQueryPool>;

// vkCreateX(device, &info, ...) into an owner; `what` completes "cannot ...".
template <typename T, auto destroy, typename Create, typename Info>
Failure make(Owned<T, destroy>& into, VkDevice device, Create create, const Info& info,
             const char* what) {
    T raw = VK_NULL_HANDLE;
    if (auto failure = check(create(device, &info, nullptr, &raw), what)) return failure;
    into = Owned<T, destroy>(device, raw);
    return {};
}

// A buffer in memory that the host sees, mapped for life and coherent: writes need no flush.
struct HostBuffer {
    OwnedMemory memory;  // outlives the buffer
    OwnedBuffer buffer;
    std::byte* mapped = nullptr;
};
Failure make_host_buffer(HostBuffer& into, const DeviceState& device, VkDeviceSize size,
                         VkBufferUsageFlags usage);

struct DeviceImage {
    OwnedMemory memory;
    OwnedImage image;
    OwnedView view;
};
// An image with a view of all its levels, in device memory: two-dimensional, or a volume if it has
// a depth.
Failure make_image(DeviceImage& into, const DeviceState& device, VkFormat format, int width,
                   int height, std::uint32_t levels, VkImageUsageFlags usage, int depth = 0);

VkFormat format_of(Texture::Format format);

// The texture on the device, ready for sampling in any shader stage.
Failure upload_texture(DeviceImage& into, const DeviceState& device, const Texture& texture,
                       const std::string& name);
// `nearest`: in texel and level, whatever the texture says.
Failure make_sampler(OwnedSampler& into, const DeviceState& device, const Texture& texture,
                     bool nearest);

// A recorded command buffer, given back to the device's pool at the end.
class Commands {
  public:
    Commands() = default;
    Commands(const DeviceState& device, VkCommandBuffer buffer)
        : device_(&device), buffer_(buffer) {}
    Commands(Commands&& other) noexcept
        : device_(other.device_), buffer_(std::exchange(other.buffer_, VK_NULL_HANDLE)) {}
    Commands& operator=(Commands&& other) noexcept {
        std::swap(device_, other.device_);
        std::swap(buffer_, other.buffer_);
        return *this;
    }
    ~Commands() {
        if (buffer_) vkFreeCommandBuffers(device_->device, device_->pool, 1, &buffer_);
    }
    VkCommandBuffer get() const { return buffer_; }

  private:
    const DeviceState* device_ = nullptr;
    VkCommandBuffer buffer_ = VK_NULL_HANDLE;
};

// Records commands once, for any number of submissions one after the other.
Failure record(Commands& into, const DeviceState& device,
               const std::function<void(VkCommandBuffer)>& commands);
// Submits and waits until the device is done.
Failure submit_and_wait(const DeviceState& device, VkCommandBuffer commands);

}  // namespace intaglio::vulkan
