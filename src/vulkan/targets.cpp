// Images to draw into, the render pass over them, and their way back to the host.
#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include "src/vulkan/pipeline.h"

namespace intaglio::vulkan {
namespace {

constexpr VkFormat depth_format = VK_FORMAT_D32_SFLOAT;

Failure check_size(const DeviceState& device, const Draw& draw, std::size_t colour_count) {
    if (draw.width < 1 || draw.height < 1) {
        return input_error("bad-target", fmt::format("a picture of {} by {} pixels has no pixel",
                                                     draw.width, draw.height));
    }
    const VkPhysicalDeviceLimits& limits = device.properties.limits;
    const auto widest =
        static_cast<int>(std::min(limits.maxFramebufferWidth, limits.maxViewportDimensions[0]));
    const auto highest =
        static_cast<int>(std::min(limits.maxFramebufferHeight, limits.maxViewportDimensions[1]));
    if (draw.width > widest || draw.height > highest) {
        return input_error(
            "too-large",
            fmt::format("a picture of {} by {} pixels is too large: {} draws at most {} by {}",
                        draw.width, draw.height, device.properties.deviceName, widest, highest));
    }
    if (colour_count > limits.maxColorAttachments) {
        return input_error(
            "bad-target",
            fmt::format("{} colour targets are too many: {} draws at most {}", colour_count,
                        device.properties.deviceName, limits.maxColorAttachments));
    }
    VkFormatProperties format{};
    vkGetPhysicalDeviceFormatProperties(device.physical, format_of(draw.target_format), &format);
    if (!(format.optimalTilingFeatures & VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT)) {
        return input_error("unsupported-format",
                           fmt::format("{} cannot draw into {}", device.properties.deviceName,
                                       name_of(draw.target_format)));
    }
    return {};
}

VkAttachmentDescription attachment(VkFormat format, VkAttachmentStoreOp store,
                                   VkImageLayout final_layout) {
    VkAttachmentDescription description{};
    description.format = format;
    description.samples = VK_SAMPLE_COUNT_1_BIT;
    description.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    description.storeOp = store;
    description.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    description.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    description.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    description.finalLayout = final_layout;
    return description;
}

}  // namespace

Failure make_pass(Targets& into, const DeviceState& device, const Draw& draw,
                  std::size_t colour_count) {
    const VkFormat colour_format = format_of(draw.target_format);
    const bool depth = draw.depth_test;
    std::vector<VkAttachmentDescription> attachments(
        colour_count, attachment(colour_format, VK_ATTACHMENT_STORE_OP_STORE,
                                 VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL));
    std::vector<VkAttachmentReference> colours;
    for (std::uint32_t i = 0; i < colour_count; ++i) {
        colours.push_back({i, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL});
    }
    const VkAttachmentReference depth_reference{static_cast<std::uint32_t>(colour_count),
                                                VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
    if (depth) {
        attachments.push_back(attachment(depth_format, VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                         VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL));
    }
    VkSubpassDescription subpass{};
    subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.colorAttachmentCount = static_cast<std::uint32_t>(colours.size());
    subpass.pColorAttachments = colours.data();
    if (depth) subpass.pDepthStencilAttachment = &depth_reference;

    // Before: the last draw's copy has read the colours and its tests are done.  After: the copy
    // waits for the colours.
    constexpr VkPipelineStageFlags draws = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT |
                                           VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT |
                                           VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
    constexpr VkAccessFlags writes =
        VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
    VkSubpassDependency dependencies[2]{};
    dependencies[0] = {VK_SUBPASS_EXTERNAL,
                       0,
                       draws | VK_PIPELINE_STAGE_TRANSFER_BIT,
                       draws,
                       writes,
                       writes | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT,
                       0};
    dependencies[1] = {0,      VK_SUBPASS_EXTERNAL,         draws, VK_PIPELINE_STAGE_TRANSFER_BIT,
                       writes, VK_ACCESS_TRANSFER_READ_BIT, 0};
    VkRenderPassCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
    info.attachmentCount = static_cast<std::uint32_t>(attachments.size());
    info.pAttachments = attachments.data();
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    info.dependencyCount = 2;
    info.pDependencies = dependencies;
    return make(into.pass, device.device, vkCreateRenderPass, info, "create a render pass");
}

Failure make_targets(Targets& into, const DeviceState& device, const Draw& draw,
                     std::size_t colour_count) {
    if (auto failure = check_size(device, draw, colour_count)) return failure;
    into.width = draw.width;
    into.height = draw.height;
    into.format = draw.target_format;
    const VkFormat colour_format = format_of(draw.target_format);
    std::vector<VkImageView> views;
    for (std::size_t i = 0; i < colour_count; ++i) {
        into.colours.emplace_back();
        if (auto failure =
                make_image(into.colours.back(), device, colour_format, draw.width, draw.height, 1,
                           VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT)) {
            return failure;
        }
        views.push_back(into.colours.back().view.get());
        into.readback.emplace_back();
        const auto pixels =
            static_cast<VkDeviceSize>(draw.width) * static_cast<VkDeviceSize>(draw.height);
        if (auto failure = make_host_buffer(into.readback.back(), device,
                                            pixels * bytes_per_texel(into.format),
                                            VK_BUFFER_USAGE_TRANSFER_DST_BIT)) {
            return failure;
        }
    }
    if (draw.depth_test) {
        if (auto failure = make_image(into.depth, device, depth_format, draw.width, draw.height, 1,
                                      VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT)) {
            return failure;
        }
        views.push_back(into.depth.view.get());
    }
    if (auto failure = make_pass(into, device, draw, colour_count)) return failure;
    VkFramebufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
    info.renderPass = into.pass.get();
    info.attachmentCount = static_cast<std::uint32_t>(views.size());
    info.pAttachments = views.data();
    info.width = static_cast<std::uint32_t>(draw.width);
    info.height = static_cast<std::uint32_t>(draw.height);
    info.layers = 1;
    return make(into.framebuffer, device.device, vkCreateFramebuffer, info, "create a framebuffer");
}

Picture read_picture(const Targets& targets, std::size_t target) {
    Picture picture;
    picture.width = targets.width;
    picture.height = targets.height;
    const std::size_t count =
        static_cast<std::size_t>(targets.width) * static_cast<std::size_t>(targets.height);
    const std::vector<float> numbers = decode(
        {targets.readback[target].mapped, count * bytes_per_texel(targets.format)}, targets.format);
    picture.pixels.resize(count);
    std::memcpy(picture.pixels.data(), numbers.data(), count * sizeof(picture.pixels[0]));
    return picture;
}

}  // namespace intaglio::vulkan
