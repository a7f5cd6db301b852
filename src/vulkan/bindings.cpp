// Each function below answers one question: which texture, which attribute, which target?
#include "src/vulkan/bindings.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "src/vulkan/device_state.h"

namespace intaglio::vulkan {
namespace {

using check::Reflection;

struct StageView {
    const char* word;
    VkShaderStageFlags flag;
    const check::SpirvWords& spirv;
    const Reflection& reflection;
};

template <typename Value>
std::string list_names(const std::map<std::string, Value>& given) {
    std::string text;
    for (const auto& entry : given) text += (text.empty() ? "" : ", ") + entry.first;
    return text.empty() ? "none" : text;
}

Diagnostic unsupported(const char* stage, const std::string& what) {
    return input_error(
        "unsupported-resource",
        fmt::format("the {} shader declares {}, which the runner does not fill", stage, what));
}

std::optional<std::string> texture_for_sampler(const Draw& draw, const std::string& sampler) {
    std::optional<std::string> best;
    for (const auto& entry : draw.textures) {
        const std::string& name = entry.first;
        if (sampler.compare(0, name.size(), name) == 0 && (!best || name.size() > best->size()))
            best = name;
    }
    return best;
}

Result<Binding> bind_image(const Draw& draw, const StageView& stage,
                           const Reflection::Image& image) {
    if (image.array_count > 1)
        return unsupported(stage.word, fmt::format("the array of images '{}'", image.name));
    Binding binding;
    binding.name = image.name;
    const bool is_sampler = image.kind == Reflection::ImageKind::Sampler;
    if (is_sampler) {
        binding.type = VK_DESCRIPTOR_TYPE_SAMPLER;
        const auto texture = texture_for_sampler(draw, image.name);
        if (texture) binding.texture = *texture;
    } else {
        binding.type = image.kind == Reflection::ImageKind::Combined
                           ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER
                           : VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
        if (draw.textures.count(image.name)) binding.texture = image.name;
    }
    if (binding.texture.empty() || !draw.textures.at(binding.texture)) {
        return input_error(
            "missing-texture",
            fmt::format(
                "the {} shader needs {} '{}', {}; textures given: {}", stage.word,
                is_sampler ? "the sampler" : "the texture", image.name,
                is_sampler ? "and no given texture's name begins so" : "which was not given",
                list_names(draw.textures)));
    }
    const int given = draw.textures.at(binding.texture)->depth > 0 ? 3 : 2;
    if (!is_sampler && image.dimension != given) {
        return input_error(
            "bad-texture",
            fmt::format("the {} shader reads '{}' as {}, and the texture given is {}", stage.word,
                        image.name,
                        image.dimension == 3   ? "a volume"
                        : image.dimension == 2 ? "a 2D texture"
                                               : "something else than 2D texture or volume",
                        given == 3 ? "a volume" : "2D"));
    }
    return binding;
}

Result<Binding> bind_block(const Draw& draw, const StageView& stage,
                           const Reflection::Block& block) {
    Binding binding;
    binding.type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    binding.name = block.name;
    // Reflection ends a block at its last member; a block takes whole registers of 16 bytes.
    binding.size = static_cast<std::size_t>(std::max(block.size, 1) + 15) / 16 * 16;
    binding.members = typed_members(stage.spirv, block);
    for (const BlockMember& member : binding.members) {
        if (draw.uniforms.count(member.layout.name)) continue;
        return input_error(
            "missing-uniform",
            fmt::format(
                "the {} shader needs the uniform '{}', which was not given; uniforms given: {}",
                stage.word, member.layout.name, list_names(draw.uniforms)));
    }
    return binding;
}

// Adds a stage's descriptor; one that the other stage declares at the same place must be of the
// same kind.
Failure merge(std::vector<Binding>& into, Binding added, const StageView& stage, int set,
              int binding) {
    added.set = static_cast<std::uint32_t>(set);
    added.binding = static_cast<std::uint32_t>(binding);
    added.stages = stage.flag;
    const auto same_place = [&](const Binding& b) {
        return b.set == added.set && b.binding == added.binding;
    };
    const auto found = std::find_if(into.begin(), into.end(), same_place);
    if (found == into.end()) {
        into.push_back(std::move(added));
        return {};
    }
    if (found->type != added.type || found->texture != added.texture ||
        (found->stages & stage.flag)) {
        return input_error("binding-conflict",
                           fmt::format("'{}' and '{}' are both at set {}, binding {}", found->name,
                                       added.name, set, binding));
    }
    found->stages |= stage.flag;
    found->size = std::max(found->size, added.size);
    found->members.insert(found->members.end(), added.members.begin(), added.members.end());
    return {};
}

Failure add_stage(std::vector<Binding>& into, const Draw& draw, const StageView& stage) {
    if (stage.reflection.push_constants) return unsupported(stage.word, "push constants");
    for (const Reflection::Block& block : stage.reflection.blocks) {
        Result<Binding> bound = bind_block(draw, stage, block);
        if (!bound) return bound.error();
        if (auto failure = merge(into, std::move(*bound), stage, block.set, block.binding))
            return failure;
    }
    for (const Reflection::Image& image : stage.reflection.images) {
        Result<Binding> bound = bind_image(draw, stage, image);
        if (!bound) return bound.error();
        if (auto failure = merge(into, std::move(*bound), stage, image.set, image.binding))
            return failure;
    }
    return {};
}

struct Attribute {
    std::string_view name;
    VkFormat format;
    std::uint32_t offset;
};
constexpr Attribute attributes[] = {
    {"position", VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, position)},
    {"pos", VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, position)},
    {"normal", VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, normal)},
    {"tangent", VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(Vertex, tangent)},
    {"uv", VK_FORMAT_R32G32_SFLOAT, offsetof(Vertex, uv)},
    {"texcoord", VK_FORMAT_R32G32_SFLOAT, offsetof(Vertex, uv)},
    {"tex_coord", VK_FORMAT_R32G32_SFLOAT, offsetof(Vertex, uv)},
};

const Attribute* find_attribute(std::string_view input) {
    std::string name(input);
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (!name.empty() && name.back() == '0') name.pop_back();
    for (const Attribute& attribute : attributes) {
        for (const std::string_view prefix : {"", "in_", "a_", "v_", "vertex_", "in", "a"}) {
            if (name.size() == prefix.size() + attribute.name.size() &&
                name.compare(0, prefix.size(), prefix) == 0 &&
                name.compare(prefix.size(), attribute.name.size(), attribute.name) == 0) {
                return &attribute;
            }
        }
    }
    return nullptr;
}

Result<std::vector<VkVertexInputAttributeDescription>> bind_attributes(const Reflection& vertex) {
    std::vector<VkVertexInputAttributeDescription> bound;
    for (const Reflection::Interface& input : vertex.inputs) {
        if (input.location < 0) continue;
        const Attribute* attribute = find_attribute(input.name);
        if (!attribute) {
            return input_error(
                "missing-attribute",
                fmt::format(
                    "the vertex shader needs the input '{}', which a mesh does not have; a mesh "
                    "has: position, normal, tangent, uv",
                    input.name));
        }
        bound.push_back(
            {static_cast<std::uint32_t>(input.location), 0, attribute->format, attribute->offset});
    }
    return bound;
}

Failure check_varyings(const Reflection& vertex, const Reflection& fragment) {
    for (const Reflection::Interface& input : fragment.inputs) {
        if (input.location < 0) continue;
        const bool written =
            std::any_of(vertex.outputs.begin(), vertex.outputs.end(), [&](const auto& output) {
                return output.location == input.location && output.components >= input.components;
            });
        if (written) continue;
        return input_error(
            "unmatched-varying",
            fmt::format(
                "the fragment shader reads '{}' ({} components) at location {}, which the vertex "
                "shader does not write",
                input.name, input.components, input.location));
    }
    return {};
}

Result<std::vector<VkColorComponentFlags>> bind_targets(const Draw& draw,
                                                        const Reflection& fragment) {
    std::size_t count = static_cast<std::size_t>(std::max(draw.colour_targets, 1));
    std::vector<VkColorComponentFlags> targets(count);
    for (const Reflection::Interface& output : fragment.outputs) {
        if (output.location < 0) continue;
        const auto end =
            static_cast<std::size_t>(output.location + std::max(1, output.array_count));
        if (draw.colour_targets > 0 && end > count) {
            return input_error(
                "bad-target",
                fmt::format(
                    "the fragment shader writes '{}' to target {} and the draw has {} targets",
                    output.name, end - 1, count));
        }
        if (end > targets.size()) targets.resize(end);
        const VkColorComponentFlags components = (1u << output.components) - 1;
        for (auto i = static_cast<std::size_t>(output.location); i < end; ++i)
            targets[i] |= components;
    }
    return targets;
}

}  // namespace

Result<Bindings> bind_names(const Draw& draw, const Reflection& vertex,
                            const Reflection& fragment) {
    Bindings bindings;
    for (const StageView& stage :
         {StageView{"vertex", VK_SHADER_STAGE_VERTEX_BIT, draw.vertex.spirv, vertex},
          StageView{"fragment", VK_SHADER_STAGE_FRAGMENT_BIT, draw.fragment.spirv, fragment}}) {
        if (auto failure = add_stage(bindings.descriptors, draw, stage)) return *failure;
    }
    std::sort(bindings.descriptors.begin(), bindings.descriptors.end(),
              [](const Binding& a, const Binding& b) {
                  return std::pair(a.set, a.binding) < std::pair(b.set, b.binding);
              });
    auto inputs = bind_attributes(vertex);
    if (!inputs) return inputs.error();
    bindings.attributes = std::move(*inputs);
    if (auto failure = check_varyings(vertex, fragment)) return *failure;
    auto targets = bind_targets(draw, fragment);
    if (!targets) return targets.error();
    bindings.targets = std::move(*targets);
    return bindings;
}

}  // namespace intaglio::vulkan
