// Names to places: what both stages declare, merged, each matched with what the draw gives.  Pure;
// internal to src/vulkan.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <vulkan/vulkan.h>

#include "generator/base/result.h"
#include "src/check/reflect.h"
#include "src/vulkan/program.h"
#include "src/vulkan/uniforms.h"

namespace intaglio::vulkan {

// One descriptor of the pipeline.
struct Binding {
    std::uint32_t set = 0, binding = 0;
    VkDescriptorType type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    VkShaderStageFlags stages = 0;
    std::string name;                  // as the first stage that declares it calls it
    std::size_t size = 0;              // uniform blocks: bytes
    std::vector<BlockMember> members;  // uniform blocks: of both stages
    std::string texture;               // images and samplers: the given texture's name
};

struct Bindings {
    std::vector<Binding> descriptors;                           // by (set, binding), each pair once
    std::vector<VkVertexInputAttributeDescription> attributes;  // offsets into Vertex
    std::vector<VkColorComponentFlags> targets;  // which components the fragment stage writes
};

// Errors: see Program::prepare.
Result<Bindings> bind_names(const Draw& draw, const check::Reflection& vertex,
                            const check::Reflection& fragment);

}  // namespace intaglio::vulkan
