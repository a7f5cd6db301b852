// Reflection with SPIRV-Cross's base class, which reads a module and prints nothing.
#include "src/check/reflect.h"

#include <fmt/format.h>

#include <algorithm>
#include <spirv_cross.hpp>
#include <tuple>

#include "src/check/spirv.h"

namespace intaglio::check {
namespace {

using spirv_cross::SPIRType;

// "input.uv" -> "uv": glslang's HLSL front end splits structs into variables.
std::string last_component(const std::string& name) {
    const std::size_t dot = name.rfind('.');
    return dot == std::string::npos ? name : name.substr(dot + 1);
}

int array_count(const SPIRType& type) {
    return type.array.empty() ? 1 : static_cast<int>(type.array.back());
}

class Reader {
  public:
    explicit Reader(const SpirvWords& words) : compiler_(words) {}

    Reflection read() {
        const spirv_cross::ShaderResources resources =
            compiler_.get_shader_resources(compiler_.get_active_interface_variables());
        Reflection result;
        for (const auto& block : resources.uniform_buffers) {
            result.blocks.push_back(read_block(block));
        }
        for (const auto& block : resources.push_constant_buffers) {
            result.push_constants = read_block(block);
        }
        add_images(resources.sampled_images, Reflection::ImageKind::Combined, result);
        add_images(resources.separate_images, Reflection::ImageKind::Texture, result);
        add_images(resources.separate_samplers, Reflection::ImageKind::Sampler, result);
        sort_by_binding(result.blocks);
        sort_by_binding(result.images);
        compiler_.update_active_builtins();
        result.inputs = read_interface(resources.stage_inputs, resources.builtin_inputs,
                                       spv::StorageClassInput);
        result.outputs = read_interface(resources.stage_outputs, resources.builtin_outputs,
                                        spv::StorageClassOutput);
        return result;
    }

  private:
    template <typename Resource>
    static void sort_by_binding(std::vector<Resource>& resources) {
        std::stable_sort(resources.begin(), resources.end(), [](const auto& a, const auto& b) {
            return std::tie(a.set, a.binding) < std::tie(b.set, b.binding);
        });
    }

    int decoration(spirv_cross::ID id, spv::Decoration kind) const {
        return static_cast<int>(compiler_.get_decoration(id, kind));
    }

    Reflection::Block read_block(const spirv_cross::Resource& resource) const {
        const SPIRType& type = compiler_.get_type(resource.base_type_id);
        Reflection::Block block;
        block.name =
            compiler_.get_name(resource.base_type_id);  // a push constant's variable has none
        block.set = decoration(resource.id, spv::DecorationDescriptorSet);
        block.binding = decoration(resource.id, spv::DecorationBinding);
        for (std::uint32_t index = 0; index < type.member_types.size(); ++index) {
            block.members.push_back(read_member(type, index));
            const Reflection::Member& last = block.members.back();
            block.size = std::max(block.size, last.offset + last.size);
        }
        return block;
    }

    Reflection::Member read_member(const SPIRType& type, std::uint32_t index) const {
        const SPIRType& member_type = compiler_.get_type(type.member_types[index]);
        Reflection::Member member;
        member.name = compiler_.get_member_name(type.self, index);
        member.offset = static_cast<int>(compiler_.type_struct_member_offset(type, index));
        member.size = static_cast<int>(compiler_.get_declared_struct_member_size(type, index));
        member.components = static_cast<int>(member_type.vecsize);
        member.columns = static_cast<int>(member_type.columns);
        if (!member_type.array.empty()) {
            member.array_count = array_count(member_type);
            member.array_stride =
                static_cast<int>(compiler_.type_struct_member_array_stride(type, index));
        }
        return member;
    }

    void add_images(const spirv_cross::SmallVector<spirv_cross::Resource>& resources,
                    Reflection::ImageKind kind, Reflection& result) const {
        for (const auto& resource : resources) {
            result.images.push_back(
                {.name = resource.name,
                 .set = decoration(resource.id, spv::DecorationDescriptorSet),
                 .binding = decoration(resource.id, spv::DecorationBinding),
                 .kind = kind,
                 .array_count = array_count(compiler_.get_type(resource.type_id)),
                 .dimension = dimension_of(compiler_.get_type(resource.base_type_id))});
        }
    }

    static int dimension_of(const SPIRType& type) {
        if (type.basetype == SPIRType::Sampler || type.image.dim == spv::Dim2D) return 2;
        return type.image.dim == spv::Dim3D ? 3 : 0;
    }

    std::vector<Reflection::Interface> read_interface(
        const spirv_cross::SmallVector<spirv_cross::Resource>& plain,
        const spirv_cross::SmallVector<spirv_cross::BuiltInResource>& built_in,
        spv::StorageClass storage) const {
        std::vector<Reflection::Interface> result;
        for (const auto& resource : plain) {
            const SPIRType& type = compiler_.get_type(resource.type_id);
            result.push_back({.name = last_component(resource.name),
                              .location = decoration(resource.id, spv::DecorationLocation),
                              .components = static_cast<int>(type.vecsize),
                              .array_count = array_count(type),
                              .built_in = {}});
        }
        std::stable_sort(result.begin(), result.end(),
                         [](const auto& a, const auto& b) { return a.location < b.location; });
        for (const auto& resource : built_in) {
            if (!compiler_.has_active_builtin(resource.builtin, storage)) continue;
            const SPIRType& type = compiler_.get_type(resource.value_type_id);
            result.push_back({.name = last_component(resource.resource.name),
                              .location = -1,
                              .components = static_cast<int>(type.vecsize),
                              .array_count = array_count(type),
                              .built_in = built_in_name(resource.builtin)});
        }
        return result;
    }

    static std::string built_in_name(spv::BuiltIn built_in) {
        switch (built_in) {
            case spv::BuiltInPosition: return "Position";
            case spv::BuiltInPointSize: return "PointSize";
            case spv::BuiltInVertexIndex: return "VertexIndex";
            case spv::BuiltInInstanceIndex: return "InstanceIndex";
            case spv::BuiltInFragCoord: return "FragCoord";
            case spv::BuiltInFrontFacing: return "FrontFacing";
            case spv::BuiltInFragDepth: return "FragDepth";
            default: return fmt::format("BuiltIn {}", static_cast<int>(built_in));
        }
    }

    spirv_cross::Compiler compiler_;
};

}  // namespace

Result<Reflection> reflect(const SpirvWords& words) {
    if (Status valid = validate_spirv(words); !valid) return valid.error();
    return reflect_valid(words);
}

Result<Reflection> reflect_valid(const SpirvWords& words) {
    try {
        return Reader(words).read();
    } catch (const spirv_cross::CompilerError& error) {
        return input_error("spirv-unreadable", fmt::format("SPIRV-Cross: {}", error.what()));
    }
}

std::optional<FoundMember> find_member(const Reflection& reflection, std::string_view name) {
    for (const Reflection::Block& block : reflection.blocks) {
        for (const Reflection::Member& member : block.members) {
            if (member.name == name) return FoundMember{&block, &member};
        }
    }
    return std::nullopt;
}

}  // namespace intaglio::check
