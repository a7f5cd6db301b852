// Buffers, images, samplers and command buffers.  Each allocation is an object's own: a program has
// about ten.
#include "src/vulkan/objects.h"

#include <algorithm>
#include <cstring>
#include <string>

#include <fmt/format.h>

namespace intaglio::vulkan {
namespace {

// A memory type among `allowed` with all `required` properties, and the `preferred` ones where
// there is a choice.
std::optional<std::uint32_t> memory_type(const DeviceState& device, std::uint32_t allowed,
                                         VkMemoryPropertyFlags required,
                                         VkMemoryPropertyFlags preferred) {
    for (const VkMemoryPropertyFlags wanted : {required | preferred, required}) {
        for (std::uint32_t i = 0; i < device.memory.memoryTypeCount; ++i) {
            const VkMemoryPropertyFlags has = device.memory.memoryTypes[i].propertyFlags;
            if ((allowed & (1u << i)) && (has & wanted) == wanted) return i;
        }
    }
    return {};
}

Failure allocate(OwnedMemory& into, const DeviceState& device, const VkMemoryRequirements& needs,
                 VkMemoryPropertyFlags required, VkMemoryPropertyFlags preferred) {
    const auto type = memory_type(device, needs.memoryTypeBits, required, preferred);
    if (!type)
        return internal_error("vulkan-error",
                              "the Vulkan device has no memory of the kind that is needed");
    VkMemoryAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    info.allocationSize = needs.size;
    info.memoryTypeIndex = *type;
    return make(into, device.device, vkAllocateMemory, info, "allocate memory");
}

// Whether the device can hold and filter the texture.
Failure check_support(const DeviceState& device, const Texture& texture, const std::string& name) {
    const VkPhysicalDeviceLimits& limits = device.properties.limits;
    const auto limit = static_cast<int>(texture.depth > 0 ? limits.maxImageDimension3D
                                                          : limits.maxImageDimension2D);
    if (texture.width > limit || texture.height > limit || texture.depth > limit) {
        const std::string slices =
            texture.depth > 0 ? fmt::format(" by {}", texture.depth) : std::string();
        return input_error(
            "too-large", fmt::format("texture '{}' is {} by {}{} texels, and {} takes at most {} a "
                                     "side",
                                     name, texture.width, texture.height, slices,
                                     device.properties.deviceName, limit));
    }
    VkFormatProperties properties{};
    vkGetPhysicalDeviceFormatProperties(device.physical, format_of(texture.format), &properties);
    const bool filtered =
        texture.filter == Texture::Filter::Linear || texture.mip_filter == Texture::Filter::Linear;
    VkFormatFeatureFlags wanted =
        VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT | VK_FORMAT_FEATURE_TRANSFER_DST_BIT;
    if (filtered) wanted |= VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
    if ((properties.optimalTilingFeatures & wanted) == wanted) return {};
    return input_error(
        "unsupported-format",
        fmt::format("{} cannot sample texture '{}' as {}{}", device.properties.deviceName, name,
                    name_of(texture.format), filtered ? " with linear filtering" : ""));
}

VkImageMemoryBarrier layout_change(VkImage image, std::uint32_t levels, VkImageLayout from,
                                   VkImageLayout to) {
    VkImageMemoryBarrier barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
    barrier.oldLayout = from;
    barrier.newLayout = to;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, levels, 0, 1};
    return barrier;
}

void record_upload(VkCommandBuffer commands, VkBuffer from, VkImage to,
                   const std::vector<VkBufferImageCopy>& copies) {
    const auto levels = static_cast<std::uint32_t>(copies.size());
    VkImageMemoryBarrier before =
        layout_change(to, levels, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    before.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT,
                         VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0, nullptr, 1, &before);
    vkCmdCopyBufferToImage(commands, from, to, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, levels,
                           copies.data());
    VkImageMemoryBarrier after = layout_change(to, levels, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                               VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    after.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    after.dstAccessMask = VK_ACCESS_SHADER_READ_BIT;
    vkCmdPipelineBarrier(
        commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
        VK_PIPELINE_STAGE_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, 0, 0, nullptr,
        0, nullptr, 1, &after);
}

}  // namespace

VkFormat format_of(Texture::Format format) {
    switch (format) {
        case Texture::Format::Rgba8Unorm: return VK_FORMAT_R8G8B8A8_UNORM;
        case Texture::Format::Rgba16Unorm: return VK_FORMAT_R16G16B16A16_UNORM;
        case Texture::Format::Rgba16Float: return VK_FORMAT_R16G16B16A16_SFLOAT;
        case Texture::Format::Rgba32Float: break;
    }
    return VK_FORMAT_R32G32B32A32_SFLOAT;
}

Failure make_host_buffer(HostBuffer& into, const DeviceState& device, VkDeviceSize size,
                         VkBufferUsageFlags usage) {
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = size;
    info.usage = usage;
    if (auto failure = make(into.buffer, device.device, vkCreateBuffer, info, "create a buffer"))
        return failure;
    VkMemoryRequirements needs{};
    vkGetBufferMemoryRequirements(device.device, into.buffer.get(), &needs);
    // Cached, because pictures are read back pixel by pixel.
    if (auto failure =
            allocate(into.memory, device, needs,
                     VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
                     VK_MEMORY_PROPERTY_HOST_CACHED_BIT)) {
        return failure;
    }
    if (auto failure =
            check(vkBindBufferMemory(device.device, into.buffer.get(), into.memory.get(), 0),
                  "give a buffer its memory")) {
        return failure;
    }
    void* mapped = nullptr;
    auto failure =
        check(vkMapMemory(device.device, into.memory.get(), 0, VK_WHOLE_SIZE, 0, &mapped),
              "map a buffer");
    into.mapped = static_cast<std::byte*>(mapped);
    return failure;
}

Failure make_image(DeviceImage& into, const DeviceState& device, VkFormat format, int width,
                   int height, std::uint32_t levels, VkImageUsageFlags usage, int depth) {
    VkImageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    info.imageType = depth > 0 ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height),
                   static_cast<std::uint32_t>(std::max(1, depth))};
    info.mipLevels = levels;
    info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = usage;
    info.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    if (auto failure = make(into.image, device.device, vkCreateImage, info, "create an image"))
        return failure;
    VkMemoryRequirements needs{};
    vkGetImageMemoryRequirements(device.device, into.image.get(), &needs);
    if (auto failure = allocate(into.memory, device, needs, 0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT))
        return failure;
    if (auto failure =
            check(vkBindImageMemory(device.device, into.image.get(), into.memory.get(), 0),
                  "give an image its memory")) {
        return failure;
    }
    const bool depth_target = (usage & VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT) != 0;
    VkImageViewCreateInfo view{};
    view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    view.image = into.image.get();
    view.viewType = depth > 0 ? VK_IMAGE_VIEW_TYPE_3D : VK_IMAGE_VIEW_TYPE_2D;
    view.format = format;
    view.subresourceRange = {depth_target ? VkImageAspectFlags{VK_IMAGE_ASPECT_DEPTH_BIT}
                                          : VkImageAspectFlags{VK_IMAGE_ASPECT_COLOR_BIT},
                             0, levels, 0, 1};
    return make(into.view, device.device, vkCreateImageView, view, "create an image view");
}

Failure upload_texture(DeviceImage& into, const DeviceState& device, const Texture& texture,
                       const std::string& name) {
    if (auto valid = validate(texture, name); !valid) return valid.error();
    if (auto failure = check_support(device, texture, name)) return failure;
    const auto levels = static_cast<std::uint32_t>(texture.levels.size());
    if (auto failure = make_image(
            into, device, format_of(texture.format), texture.width, texture.height, levels,
            VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, texture.depth)) {
        return failure;
    }
    std::vector<std::byte> bytes;
    std::vector<VkBufferImageCopy> copies;
    for (std::uint32_t l = 0; l < levels; ++l) {
        VkBufferImageCopy copy{};
        copy.bufferOffset = bytes.size();  // a multiple of the texel size, as required
        copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, l, 0, 1};
        copy.imageExtent = {static_cast<std::uint32_t>(std::max(1, texture.width >> l)),
                            static_cast<std::uint32_t>(std::max(1, texture.height >> l)),
                            static_cast<std::uint32_t>(std::max(1, texture.depth >> l))};
        copies.push_back(copy);
        const std::vector<std::byte> level = encode(texture.levels[l], texture.format);
        bytes.insert(bytes.end(), level.begin(), level.end());
    }
    HostBuffer staging;
    if (auto failure =
            make_host_buffer(staging, device, bytes.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT)) {
        return failure;
    }
    std::memcpy(staging.mapped, bytes.data(), bytes.size());
    Commands commands;
    if (auto failure = record(commands, device, [&](VkCommandBuffer buffer) {
            record_upload(buffer, staging.buffer.get(), into.image.get(), copies);
        })) {
        return failure;
    }
    return submit_and_wait(device, commands.get());
}

Failure make_sampler(OwnedSampler& into, const DeviceState& device, const Texture& texture,
                     bool nearest) {
    const auto is_linear = [&](Texture::Filter filter) {
        return filter == Texture::Filter::Linear && !nearest;
    };
    VkSamplerCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
    info.magFilter = info.minFilter =
        is_linear(texture.filter) ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
    info.mipmapMode = is_linear(texture.mip_filter) ? VK_SAMPLER_MIPMAP_MODE_LINEAR
                                                    : VK_SAMPLER_MIPMAP_MODE_NEAREST;
    info.addressModeU = info.addressModeV = info.addressModeW =
        texture.wrap == Texture::Wrap::Repeat ? VK_SAMPLER_ADDRESS_MODE_REPEAT
                                              : VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    info.maxLod = VK_LOD_CLAMP_NONE;
    return make(into, device.device, vkCreateSampler, info, "create a sampler");
}

Failure record(Commands& into, const DeviceState& device,
               const std::function<void(VkCommandBuffer)>& commands) {
    VkCommandBufferAllocateInfo allocate_info{};
    allocate_info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    allocate_info.commandPool = device.pool;
    allocate_info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocate_info.commandBufferCount = 1;
    VkCommandBuffer buffer = VK_NULL_HANDLE;
    if (auto failure = check(vkAllocateCommandBuffers(device.device, &allocate_info, &buffer),
                             "allocate a command buffer")) {
        return failure;
    }
    into = Commands(device, buffer);
    VkCommandBufferBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    if (auto failure = check(vkBeginCommandBuffer(buffer, &begin), "begin a command buffer"))
        return failure;
    commands(buffer);
    return check(vkEndCommandBuffer(buffer), "record a command buffer");
}

Failure submit_and_wait(const DeviceState& device, VkCommandBuffer commands) {
    VkSubmitInfo submit{};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    if (auto failure = check(vkResetFences(device.device, 1, &device.fence), "reset a fence"))
        return failure;
    if (auto failure =
            check(vkQueueSubmit(device.queue, 1, &submit, device.fence), "submit a draw"))
        return failure;
    // Without a limit: a driver ends what runs too long by itself, as a lost device.
    return check(vkWaitForFences(device.device, 1, &device.fence, VK_TRUE, ~std::uint64_t{0}),
                 "finish a draw");
}

}  // namespace intaglio::vulkan
