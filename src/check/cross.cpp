// SPIRV-Cross: one settings function per target, exceptions stop here.
#include "src/check/cross.h"

#include <fmt/format.h>

#include <algorithm>
#include <spirv_glsl.hpp>
#include <spirv_hlsl.hpp>
#include <spirv_msl.hpp>
#include <tuple>

#include "src/check/spirv.h"

namespace intaglio::check {
namespace {

std::string vulkan_glsl(const SpirvWords& words) {
    spirv_cross::CompilerGLSL compiler(words);
    spirv_cross::CompilerGLSL::Options options = compiler.get_common_options();
    options.version = 450;
    options.es = false;  // the module may remember that it came from ES
    options.vulkan_semantics = true;
    compiler.set_common_options(options);
    return compiler.compile();
}

std::string plain_glsl(const SpirvWords& words, unsigned version, bool es) {
    spirv_cross::CompilerGLSL compiler(words);
    spirv_cross::CompilerGLSL::Options options = compiler.get_common_options();
    options.version = version;
    options.es = es;
    options.enable_420pack_extension = false;
    // HLSL's packing of a cbuffer has no name in these versions; a plain uniform needs none.
    options.emit_uniform_buffer_as_plain_uniforms = true;
    options.fragment.default_float_precision = spirv_cross::CompilerGLSL::Options::Highp;
    options.vertex.support_nonzero_base_instance = false;
    compiler.set_common_options(options);
    // A fetch from a texture without a sampler needs the dummy, and it must exist before the pairs
    // are built.
    compiler.build_dummy_sampler_for_combined_images();
    compiler.build_combined_image_samplers();
    return compiler.compile();
}

// Registers of one kind count from `first` in order of binding; returns the next free one.
unsigned number_registers(spirv_cross::Compiler& compiler,
                          spirv_cross::SmallVector<spirv_cross::Resource>& resources,
                          unsigned first) {
    const auto place = [&](const spirv_cross::Resource& resource) {
        return std::tuple(compiler.get_decoration(resource.id, spv::DecorationDescriptorSet),
                          compiler.get_decoration(resource.id, spv::DecorationBinding));
    };
    std::stable_sort(resources.begin(), resources.end(),
                     [&](const auto& a, const auto& b) { return place(a) < place(b); });
    for (const spirv_cross::Resource& resource : resources) {
        compiler.set_decoration(resource.id, spv::DecorationDescriptorSet, 0);
        compiler.set_decoration(resource.id, spv::DecorationBinding, first++);
    }
    return first;
}

std::string hlsl_50(const SpirvWords& words) {
    spirv_cross::CompilerHLSL compiler(words);
    spirv_cross::CompilerHLSL::Options options = compiler.get_hlsl_options();
    options.shader_model = 50;
    compiler.set_hlsl_options(options);
    // Bindings from 16 on would become registers that shader model 5 does not have.
    spirv_cross::ShaderResources resources = compiler.get_shader_resources();
    number_registers(compiler, resources.uniform_buffers, 0);
    const unsigned combined = number_registers(compiler, resources.sampled_images, 0);
    number_registers(compiler, resources.separate_images, combined);
    number_registers(compiler, resources.separate_samplers, combined);
    return compiler.compile();
}

std::string metal(const SpirvWords& words) {
    spirv_cross::CompilerMSL compiler(words);
    spirv_cross::CompilerMSL::Options options = compiler.get_msl_options();
    options.set_msl_version(2, 1);
    compiler.set_msl_options(options);
    return compiler.compile();
}

std::string compile(const SpirvWords& words, CrossTarget target) {
    switch (target) {
        case CrossTarget::Glsl450: return vulkan_glsl(words);
        case CrossTarget::Glsl330: return plain_glsl(words, 330, false);
        case CrossTarget::Essl300: return plain_glsl(words, 300, true);
        case CrossTarget::Hlsl50: return hlsl_50(words);
        case CrossTarget::Msl: return metal(words);
    }
    return {};
}

}  // namespace

std::string_view name_of(CrossTarget target) {
    switch (target) {
        case CrossTarget::Glsl450: return "glsl_450";
        case CrossTarget::Glsl330: return "glsl_330";
        case CrossTarget::Essl300: return "essl_300";
        case CrossTarget::Hlsl50: return "hlsl_5_0";
        case CrossTarget::Msl: return "msl";
    }
    return "unknown";
}

Result<std::string> cross_to(const SpirvWords& words, CrossTarget target) {
    // SPIRV-Cross trusts its input.
    if (Status valid = validate_spirv(words); !valid) return valid.error();
    try {
        return compile(words, target);
    } catch (const spirv_cross::CompilerError& error) {
        return input_error("cross-failed",
                           fmt::format("SPIRV-Cross to {}: {}", name_of(target), error.what()));
    }
}

}  // namespace intaglio::check
