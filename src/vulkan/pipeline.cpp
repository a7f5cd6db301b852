// Descriptors and the graphics pipeline, from the bindings that names resolved to.
#include "src/vulkan/pipeline.h"

#include <algorithm>
#include <cstring>
#include <functional>

#include <fmt/format.h>

namespace intaglio::vulkan {
namespace {

Failure make_block(UniformBlock& into, const DeviceState& device, const Draw& draw,
                   const Binding& binding) {
    into.members = binding.members;
    into.bytes.resize(binding.size);
    for (const BlockMember& member : into.members) {
        const Status written =
            write_member(into.bytes, member, draw.uniforms.at(member.layout.name));
        if (!written) return written.error();
    }
    if (auto failure = make_host_buffer(into.buffer, device, binding.size,
                                        VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT)) {
        return failure;
    }
    std::memcpy(into.buffer.mapped, into.bytes.data(), into.bytes.size());
    return {};
}

std::vector<VkDescriptorSetLayout> raw_layouts(const Resources& resources) {
    std::vector<VkDescriptorSetLayout> raw;
    for (const OwnedSetLayout& layout : resources.set_layouts) raw.push_back(layout.get());
    return raw;
}

Failure allocate_sets(Resources& into, const DeviceState& device, const Bindings& bindings) {
    if (bindings.descriptors.empty()) return {};
    std::vector<VkDescriptorPoolSize> sizes;
    for (const Binding& binding : bindings.descriptors) sizes.push_back({binding.type, 1});
    VkDescriptorPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    info.maxSets = static_cast<std::uint32_t>(into.set_layouts.size());
    info.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
    info.pPoolSizes = sizes.data();
    if (auto failure = make(into.pool, device.device, vkCreateDescriptorPool, info,
                            "create a descriptor pool")) {
        return failure;
    }
    const std::vector<VkDescriptorSetLayout> layouts = raw_layouts(into);
    into.sets.resize(layouts.size());
    VkDescriptorSetAllocateInfo allocation{};
    allocation.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    allocation.descriptorPool = into.pool.get();
    allocation.descriptorSetCount = static_cast<std::uint32_t>(layouts.size());
    allocation.pSetLayouts = layouts.data();
    return check(vkAllocateDescriptorSets(device.device, &allocation, into.sets.data()),
                 "allocate descriptors");
}

void write_descriptor(const DeviceState& device, VkDescriptorSet set, const Binding& binding,
                      const VkDescriptorBufferInfo& buffer, const VkDescriptorImageInfo& image) {
    VkWriteDescriptorSet write{};
    write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    write.dstSet = set;
    write.dstBinding = binding.binding;
    write.descriptorCount = 1;
    write.descriptorType = binding.type;
    write.pBufferInfo = &buffer;  // Vulkan reads the one that the type asks for
    write.pImageInfo = &image;
    vkUpdateDescriptorSets(device.device, 1, &write, 0, nullptr);
}

VkPipelineShaderStageCreateInfo stage_info(VkShaderStageFlagBits stage, VkShaderModule module,
                                           const char* entry) {
    VkPipelineShaderStageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage = stage;
    info.module = module;
    info.pName = entry;
    return info;
}

Failure make_shader(OwnedShader& into, const DeviceState& device, const check::SpirvWords& words) {
    VkShaderModuleCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    info.codeSize = words.size() * sizeof(words[0]);
    info.pCode = words.data();
    return make(into, device.device, vkCreateShaderModule, info, "load a shader");
}

// The fixed part of every pipeline here: triangles, nothing culled, no blending, one sample.
struct FixedState {
    VkPipelineInputAssemblyStateCreateInfo assembly{};
    VkViewport viewport{};
    VkRect2D scissor{};
    VkPipelineViewportStateCreateInfo view{};
    VkPipelineRasterizationStateCreateInfo raster{};
    VkPipelineMultisampleStateCreateInfo samples{};
    VkPipelineDepthStencilStateCreateInfo depth{};

    FixedState(const Draw& draw) {
        assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
        assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
        viewport = {0, 0, static_cast<float>(draw.width), static_cast<float>(draw.height), 0, 1};
        scissor.extent = {static_cast<std::uint32_t>(draw.width),
                          static_cast<std::uint32_t>(draw.height)};
        view.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
        view.viewportCount = view.scissorCount = 1;
        view.pViewports = &viewport;
        view.pScissors = &scissor;
        raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
        raster.polygonMode = VK_POLYGON_MODE_FILL;
        raster.cullMode = VK_CULL_MODE_NONE;
        raster.lineWidth = 1;
        samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
        samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
        depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
        depth.depthTestEnable = depth.depthWriteEnable = draw.depth_test ? VK_TRUE : VK_FALSE;
        depth.depthCompareOp = VK_COMPARE_OP_LESS;
    }
    FixedState(const FixedState&) = delete;  // it points into itself
    FixedState& operator=(const FixedState&) = delete;
};

// Which components each target keeps of what the shader writes.
Failure make_masks(std::vector<VkPipelineColorBlendAttachmentState>& into,
                   const DeviceState& device, const Bindings& bindings) {
    const auto& targets = bindings.targets;
    const bool differ =
        std::adjacent_find(targets.begin(), targets.end(), std::not_equal_to<>()) != targets.end();
    if (differ && !device.independent_blend) {
        return input_error("bad-target",
                           fmt::format("{} cannot write different components to different targets",
                                       device.properties.deviceName));
    }
    for (const VkColorComponentFlags mask : targets) {
        into.emplace_back();
        into.back().colorWriteMask = mask;
    }
    return {};
}

Failure make_layout(OwnedPipelineLayout& into, const DeviceState& device,
                    const Resources& resources) {
    const std::vector<VkDescriptorSetLayout> layouts = raw_layouts(resources);
    VkPipelineLayoutCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    info.setLayoutCount = static_cast<std::uint32_t>(layouts.size());
    info.pSetLayouts = layouts.data();
    return make(into, device.device, vkCreatePipelineLayout, info, "create a pipeline layout");
}

// vkCreateGraphicsPipelines in the shape that make() wants.
VkResult create_one_pipeline(VkDevice device, const VkGraphicsPipelineCreateInfo* info,
                             const VkAllocationCallbacks* allocator, VkPipeline* into) {
    return vkCreateGraphicsPipelines(device, VK_NULL_HANDLE, 1, info, allocator, into);
}

}  // namespace

Failure make_set_layouts(Resources& into, const DeviceState& device, const Bindings& bindings) {
    std::vector<std::vector<VkDescriptorSetLayoutBinding>> sets;
    for (const Binding& binding : bindings.descriptors) {
        if (sets.size() <= binding.set) sets.resize(binding.set + 1);
        sets[binding.set].push_back({binding.binding, binding.type, 1, binding.stages, nullptr});
    }
    for (const auto& set : sets) {
        VkDescriptorSetLayoutCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
        info.bindingCount = static_cast<std::uint32_t>(set.size());
        info.pBindings = set.data();
        into.set_layouts.emplace_back();
        if (auto failure = make(into.set_layouts.back(), device.device, vkCreateDescriptorSetLayout,
                                info, "create a descriptor layout")) {
            return failure;
        }
    }
    return {};
}

Failure make_resources(Resources& into, const DeviceState& device, const Draw& draw,
                       const Bindings& bindings) {
    if (auto failure = make_set_layouts(into, device, bindings)) return failure;
    if (auto failure = allocate_sets(into, device, bindings)) return failure;
    for (const Binding& binding : bindings.descriptors) {
        VkDescriptorBufferInfo buffer{};
        VkDescriptorImageInfo image{};
        if (binding.type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER) {
            into.blocks.emplace_back();
            if (auto failure = make_block(into.blocks.back(), device, draw, binding))
                return failure;
            buffer = {into.blocks.back().buffer.buffer.get(), 0, VK_WHOLE_SIZE};
        } else {
            const Texture& texture = *draw.textures.at(binding.texture);
            if (!into.images.count(binding.texture)) {
                if (auto failure = upload_texture(into.images[binding.texture], device, texture,
                                                  binding.texture)) {
                    return failure;
                }
                if (auto failure = make_sampler(into.samplers[binding.texture], device, texture,
                                                draw.nearest.contains(binding.texture)))
                    return failure;
            }
            image = {into.samplers.at(binding.texture).get(),
                     into.images.at(binding.texture).view.get(),
                     VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        }
        write_descriptor(device, into.sets[binding.set], binding, buffer, image);
    }
    return {};
}

Failure make_pipeline(Pipeline& into, const DeviceState& device, const Draw& draw,
                      const Bindings& bindings, const Resources& resources,
                      const Targets& targets) {
    if (auto failure = make_layout(into.layout, device, resources)) return failure;
    OwnedShader vertex, fragment;
    if (auto failure = make_shader(vertex, device, draw.vertex.spirv)) return failure;
    if (auto failure = make_shader(fragment, device, draw.fragment.spirv)) return failure;
    const VkPipelineShaderStageCreateInfo stages[] = {
        stage_info(VK_SHADER_STAGE_VERTEX_BIT, vertex.get(), draw.vertex.entry.c_str()),
        stage_info(VK_SHADER_STAGE_FRAGMENT_BIT, fragment.get(), draw.fragment.entry.c_str())};

    const VkVertexInputBindingDescription vertices{0, sizeof(Vertex), VK_VERTEX_INPUT_RATE_VERTEX};
    VkPipelineVertexInputStateCreateInfo input{};
    input.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
    input.vertexBindingDescriptionCount = 1;
    input.pVertexBindingDescriptions = &vertices;
    input.vertexAttributeDescriptionCount = static_cast<std::uint32_t>(bindings.attributes.size());
    input.pVertexAttributeDescriptions = bindings.attributes.data();

    std::vector<VkPipelineColorBlendAttachmentState> masks;
    if (auto failure = make_masks(masks, device, bindings)) return failure;
    VkPipelineColorBlendStateCreateInfo blend{};
    blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
    blend.attachmentCount = static_cast<std::uint32_t>(masks.size());
    blend.pAttachments = masks.data();

    const FixedState fixed(draw);
    VkGraphicsPipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
    if (device.tells_statistics) info.flags = VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR;
    info.stageCount = 2;
    info.pStages = stages;
    info.pVertexInputState = &input;
    info.pInputAssemblyState = &fixed.assembly;
    info.pViewportState = &fixed.view;
    info.pRasterizationState = &fixed.raster;
    info.pMultisampleState = &fixed.samples;
    info.pDepthStencilState = &fixed.depth;
    info.pColorBlendState = &blend;
    info.layout = into.layout.get();
    info.renderPass = targets.pass.get();
    return make(into.pipeline, device.device, create_one_pipeline, info, "create a pipeline");
}

}  // namespace intaglio::vulkan
