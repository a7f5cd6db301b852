// What a program draws into, and with what: targets with their render pass, and the pipeline with
// its descriptors. Internal to src/vulkan.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "src/vulkan/bindings.h"
#include "src/vulkan/objects.h"
#include "src/vulkan/program.h"

namespace intaglio::vulkan {

// Colour targets in the draw's format, an optional depth buffer, and host memory to read each
// colour target from.  After the render pass the colour targets are ready to be copied from.
struct Targets {
    int width = 0, height = 0;
    Texture::Format format = Texture::Format::Rgba32Float;
    std::vector<DeviceImage> colours;
    DeviceImage depth;
    OwnedRenderPass pass;
    OwnedFramebuffer framebuffer;
    std::vector<HostBuffer> readback;
};
// Errors: `bad-target` for a size below 1, `too-large`, `unsupported-format`.
Failure make_targets(Targets& into, const DeviceState& device, const Draw& draw,
                     std::size_t colour_count);

// The render pass alone, as make_targets makes it: all that a pipeline wants to know of targets.
Failure make_pass(Targets& into, const DeviceState& device, const Draw& draw,
                  std::size_t colour_count);

// The picture that the last copy into `readback` left.
Picture read_picture(const Targets& targets, std::size_t target);

struct UniformBlock {
    HostBuffer buffer;
    std::vector<std::byte> bytes;  // what the shader sees
    std::vector<BlockMember> members;
};

struct Resources {
    std::map<std::string, DeviceImage> images;  // by the given name, as the samplers
    std::map<std::string, OwnedSampler> samplers;
    std::vector<UniformBlock> blocks;
    std::vector<OwnedSetLayout> set_layouts;
    OwnedDescriptorPool pool;
    std::vector<VkDescriptorSet> sets;  // freed with the pool
};
// The layouts of the sets alone: all that a pipeline wants to know of resources.
Failure make_set_layouts(Resources& into, const DeviceState& device, const Bindings& bindings);
Failure make_resources(Resources& into, const DeviceState& device, const Draw& draw,
                       const Bindings& bindings);

struct Pipeline {
    OwnedPipelineLayout layout;
    OwnedPipeline pipeline;
};
// Compiles.  Where the device tells statistics, they are kept with the pipeline.
Failure make_pipeline(Pipeline& into, const DeviceState& device, const Draw& draw,
                      const Bindings& bindings, const Resources& resources, const Targets& targets);

}  // namespace intaglio::vulkan
