// One function for each way in which uniforms get to a shader.
#include "src/build/interface.h"

#include <algorithm>
#include <cstdlib>

#include <fmt/format.h>

#include "src/check/reflect.h"

namespace intaglio::build {
namespace {

Diagnostic own_failure(const Variant& variant, std::string_view what) {
    return internal_error("interface", fmt::format("{} on {}: {}", variant.request.surface,
                                                   variant.target->name, what));
}

const ir::Module& module_of(const Variant& variant, ir::Stage stage) {
    return stage == ir::Stage::Vertex ? variant.program.vertex : variant.program.pixel;
}

Scalar scalar_of(ir::Scalar scalar) {
    switch (scalar) {
        case ir::Scalar::Bool: return Scalar::Bool;
        case ir::Scalar::Int: return Scalar::Int;
        case ir::Scalar::Float: return Scalar::Float;
    }
    return Scalar::Float;
}

// What only the one who wrote the technique knows of it.
void describe(const ir::Module& module, Uniform& uniform) {
    for (const ir::Uniform& declared : module.uniforms) {
        if (declared.name != uniform.name) continue;
        uniform.comment = declared.comment;
        uniform.scalar = scalar_of(declared.type.scalar);
    }
}

Sampler sampler_named(const Variant& variant, ir::Stage stage, const std::string& name) {
    const TextureReading reading = reading_of(variant);
    Sampler sampler;
    sampler.name = name;
    for (const ir::Sampler& declared : module_of(variant, stage).samplers)
        if (declared.name == name) sampler.comment = declared.comment;
    sampler.nearest = reading.nearest.contains(name);
    sampler.one_level = reading.one_level.contains(name);
    return sampler;
}

Uniform uniform_of(const Variant& variant, ir::Stage stage,
                   const check::Reflection::Member& member) {
    Uniform uniform;
    uniform.name = member.name;
    uniform.components = member.components;
    uniform.elements = member.array_count;
    uniform.offset = member.offset;
    uniform.stride = member.array_stride;
    describe(module_of(variant, stage), uniform);
    return uniform;
}

// "constant PixelUniforms& _45 [[buffer(0)]]", "height_map [[texture(0)]]": SPIRV-Cross numbers
// them as it likes and says so in the text alone.
int metal_index(std::string_view text, std::string_view name, std::string_view kind) {
    const std::string mark = fmt::format("[[{}(", kind);
    for (std::size_t at = text.find(mark); at != std::string_view::npos;
         at = text.find(mark, at + 1)) {
        const std::size_t begin = text.find_last_of(",(", at);
        const std::string_view declared = text.substr(begin + 1, at - begin - 1);
        const std::size_t found = declared.find(name);
        if (found == std::string_view::npos) continue;
        const std::string_view after = declared.substr(found + name.size());
        if (after.empty() || after[0] == ' ' || after[0] == '&')
            return std::atoi(std::string(text.substr(at + mark.size(), 4)).c_str());
    }
    return -1;
}

Status number_for_metal(const Variant& variant, ir::Stage stage, const std::string& block,
                        StageInterface& result) {
    const Result<Product> product = product_of(variant, stage);
    if (!product) return product.error();
    const std::string& text = product->bytes;
    if (result.block.kind == UniformBlock::Kind::Buffer) {
        result.block.set = -1;
        result.block.binding = metal_index(text, block, "buffer");
        if (result.block.binding < 0) return own_failure(variant, "a buffer without an index");
    }
    for (Sampler& sampler : result.samplers) {
        sampler.set = -1;
        sampler.slot = metal_index(text, sampler.name, "texture");
        sampler.sampler_slot = metal_index(text, sampler.name + "Smplr", "sampler");
        if (sampler.slot < 0 || sampler.sampler_slot < 0)
            return own_failure(variant, "a texture without an index");
    }
    return Done{};
}

// HLSL's own rule: nothing straddles a register of 16 bytes, arrays begin at one, and what follows
// an array may share its last register.  glslang knows a part of it, so a difference is a layout
// that it gets wrong.
bool is_packed_as_hlsl(const std::vector<Uniform>& uniforms) {
    int end = 0;
    for (const Uniform& uniform : uniforms) {
        const int size = 4 * uniform.components;
        const bool array = uniform.elements > 1;
        if (array || end / 16 != (end + size - 1) / 16) end = (end + 15) / 16 * 16;
        if (uniform.offset != end) return false;
        end += array ? 16 * (uniform.elements - 1) + size : size;
    }
    return true;
}

void add_image(const Variant& variant, ir::Stage stage, const check::Reflection::Image& image,
               bool hlsl, StageInterface& result) {
    using Kind = check::Reflection::ImageKind;
    if (image.kind == Kind::Sampler) {
        // "height_map_sampler" belongs to "height_map".
        for (Sampler& sampler : result.samplers)
            if (image.name == sampler.name + "_sampler")
                sampler.sampler_slot = image.binding - check::sampler_binding;
        return;
    }
    Sampler sampler = sampler_named(variant, stage, image.name);
    sampler.dimension = image.dimension;
    sampler.set = hlsl ? -1 : image.set;
    sampler.slot = hlsl ? image.binding - check::texture_binding : image.binding;
    result.samplers.push_back(std::move(sampler));
}

// Vulkan, Metal and Direct3D 11: blocks.
Result<StageInterface> from_spirv(const Variant& variant, ir::Stage stage,
                                  const check::Reflection& reflection) {
    const bool hlsl = language_of(*variant.target) == check::Language::Hlsl5;
    StageInterface result;
    if (reflection.blocks.size() > 1) return own_failure(variant, "two blocks in one stage");
    std::string block_name;
    if (!reflection.blocks.empty()) {
        const check::Reflection::Block& block = reflection.blocks.front();
        block_name = block.name;
        result.block.kind = UniformBlock::Kind::Buffer;
        result.block.set = hlsl ? -1 : block.set;
        result.block.binding = block.binding;
        result.block.size = (block.size + 15) / 16 * 16;
        for (const check::Reflection::Member& member : block.members)
            result.block.uniforms.push_back(uniform_of(variant, stage, member));
        if (hlsl && !is_packed_as_hlsl(result.block.uniforms))
            return own_failure(variant, "a layout that HLSL's own compilers would not choose");
    }
    for (const check::Reflection::Image& image : reflection.images)
        add_image(variant, stage, image, hlsl, result);
    if (variant.target->name != "msl") return result;
    if (Status status = number_for_metal(variant, stage, block_name, result); !status)
        return status.error();
    return result;
}

// Values one after the other, each element of an array after the one before.
void lay_out(UniformBlock& block) {
    for (Uniform& uniform : block.uniforms) {
        uniform.offset = block.size;
        uniform.stride = uniform.elements > 1 ? 4 * uniform.components : 0;
        block.size += uniform.size();
    }
}

// OpenGL, and HLSL whose registers its own compiler hands out: names.
StageInterface from_names(const Variant& variant, ir::Stage stage,
                          const check::Reflection& reflection) {
    StageInterface result;
    for (const check::Reflection::Block& block : reflection.blocks)
        for (const check::Reflection::Member& member : block.members)
            result.block.uniforms.push_back(uniform_of(variant, stage, member));
    lay_out(result.block);
    for (const check::Reflection::Image& image : reflection.images) {
        Sampler sampler = sampler_named(variant, stage, image.name);
        sampler.dimension = image.dimension;
        // HLSL says the register of a sampler in its text.
        if (image.binding >= check::texture_binding)
            sampler.slot = image.binding - check::texture_binding;
        result.samplers.push_back(std::move(sampler));
    }
    return result;
}

// Direct3D 9: the constant table.
Result<StageInterface> from_table(const Variant& variant, ir::Stage stage,
                                  const d3d9::Shader& shader) {
    StageInterface result;
    int end = 0;
    for (const d3d9::Constant& constant : shader.constants) {
        if (constant.set == d3d9::Constant::Set::Sampler) {
            Sampler sampler = sampler_named(variant, stage, constant.name);
            sampler.slot = constant.index;
            for (const d3d9::Declaration& declared : shader.declarations)
                if (declared.target.file == d3d9::File::Sampler &&
                    declared.target.index == constant.index &&
                    declared.sampler == d3d9::SamplerKind::Volume)
                    sampler.dimension = 3;
            result.samplers.push_back(std::move(sampler));
            continue;
        }
        if (constant.set != d3d9::Constant::Set::Float4)
            return own_failure(variant, "a uniform in registers other than c#");
        Uniform uniform;
        uniform.name = constant.name;
        uniform.components = constant.columns;
        uniform.elements = constant.count;
        uniform.stride = constant.count > 1 ? 16 : 0;
        uniform.reg = constant.index;
        describe(module_of(variant, stage), uniform);
        end = std::max(end, constant.index + constant.count);
        result.block.uniforms.push_back(std::move(uniform));
    }
    UniformBlock& block = result.block;
    block.kind = UniformBlock::Kind::Registers;
    if (block.uniforms.empty()) return result;
    std::sort(block.uniforms.begin(), block.uniforms.end(),
              [](const Uniform& a, const Uniform& b) { return a.reg < b.reg; });
    block.first_register = block.uniforms.front().reg;
    block.registers = end - block.first_register;
    block.size = 16 * block.registers;
    for (Uniform& uniform : block.uniforms)
        uniform.offset = 16 * (uniform.reg - block.first_register);
    return result;
}

Result<Interface> of_bytecode(const Variant& variant, const Accepted& accepted) {
    Interface result;
    for (const d3d9::Shader& shader : accepted.shaders) {
        const bool pixel = is_pixel(shader.profile);
        Result<StageInterface> stage =
            from_table(variant, pixel ? ir::Stage::Pixel : ir::Stage::Vertex, shader);
        if (!stage) return stage.error();
        (pixel ? result.pixel : result.vertex) = std::move(*stage);
        if (pixel) continue;
        for (const d3d9::Declaration& declared : shader.declarations)
            if (declared.target.file == d3d9::File::Input)
                result.inputs.push_back(
                    {fmt::format("{}{}", name_of(declared.usage), declared.usage_index), 4,
                     declared.target.index});
    }
    return result;
}

}  // namespace

Result<Interface> interface_of(const Variant& variant, const Accepted& accepted) {
    if (profile_of(*variant.target)) return of_bytecode(variant, accepted);
    const check::Language language = *language_of(*variant.target);
    const bool blocks = language == check::Language::Glsl450 || language == check::Language::Hlsl5;
    Interface result;
    for (const ir::Stage stage : {ir::Stage::Vertex, ir::Stage::Pixel}) {
        const bool vertex = stage == ir::Stage::Vertex;
        const check::Reflection& reflection = accepted.reflections[vertex ? 0 : 1];
        Result<StageInterface> made = blocks ? from_spirv(variant, stage, reflection)
                                             : from_names(variant, stage, reflection);
        if (!made) return made.error();
        (vertex ? result.vertex : result.pixel) = std::move(*made);
        if (!vertex) continue;
        for (const check::Reflection::Interface& input : reflection.inputs)
            if (input.built_in.empty())
                result.inputs.push_back({input.name, input.components, input.location});
    }
    return result;
}

}  // namespace intaglio::build
