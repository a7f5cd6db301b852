// glslang's own reflection: for languages whose uniforms have names and no places.
#include <algorithm>

#include "src/check/frontend.h"
#include "src/check/glslang_unit.h"
#include "src/check/reflect.h"

namespace intaglio::check {
namespace {

// OpenGL's numbers for types, which glslang answers with (glslang/MachineIndependent/gl_types.h).
struct GlType {
    int number;
    int components;
    int dimension;  // of a sampler; 0: a value
};
constexpr GlType gl_types[] = {
    {0x1406, 1, 0}, {0x8B50, 2, 0}, {0x8B51, 3, 0}, {0x8B52, 4, 0},  // float, vec2 ...
    {0x1404, 1, 0}, {0x8B53, 2, 0}, {0x8B54, 3, 0}, {0x8B55, 4, 0},  // int, ivec2 ...
    {0x8B56, 1, 0}, {0x8B57, 2, 0}, {0x8B58, 3, 0}, {0x8B59, 4, 0},  // bool, bvec2 ...
    {0x8B5E, 1, 2}, {0x8B5F, 1, 3},                                  // sampler2D, sampler3D
};

Result<GlType> type_of(const glslang::TObjectReflection& object, const Source& source) {
    for (const GlType& type : gl_types)
        if (type.number == object.glDefineType) return type;
    return input_error("unknown-uniform", "the type of `" + object.name + "` is none that is known",
                       source.name);
}

// "world[0]" -> "world".
std::string plain_name(const std::string& name) { return name.substr(0, name.find('[')); }

Status add_uniform(const glslang::TObjectReflection& object, const Source& source,
                   Reflection& result) {
    const Result<GlType> type = type_of(object, source);
    if (!type) return type.error();
    const int count = std::max(1, object.size);
    if (type->dimension > 0) {
        Reflection::Image image;
        image.name = plain_name(object.name);
        image.set = image.binding = -1;
        image.array_count = count;
        image.dimension = type->dimension;
        result.images.push_back(std::move(image));
        return Done{};
    }
    Reflection::Member member;
    member.name = plain_name(object.name);
    member.offset = -1;
    member.components = type->components;
    member.array_count = count;
    result.blocks.front().members.push_back(std::move(member));
    return Done{};
}

}  // namespace

Result<Reflection> reflect_names(const Source& source) {
    GlslangUnit unit(source, Purpose::Grammar);
    if (Status parsed = unit.parse(); !parsed) return parsed.error();
    glslang::TProgram program;
    program.addShader(&unit.shader());
    if (!program.link(unit.messages()) || !program.buildReflection(EShReflectionBasicArraySuffix))
        return glslang_error(source, program.getInfoLog());
    Reflection result;
    result.blocks.emplace_back();
    result.blocks.front().set = result.blocks.front().binding = -1;
    for (int i = 0; i < program.getNumUniformVariables(); ++i)
        if (Status added = add_uniform(program.getUniform(i), source, result); !added)
            return added.error();
    for (int i = 0; i < program.getNumPipeInputs(); ++i) {
        const glslang::TObjectReflection& input = program.getPipeInput(i);
        if (input.name.rfind("gl_", 0) == 0) continue;
        const Result<GlType> type = type_of(input, source);
        if (!type) return type.error();
        Reflection::Interface value;
        value.name = input.name;
        value.components = type->components;
        result.inputs.push_back(std::move(value));
    }
    if (result.blocks.front().members.empty()) result.blocks.clear();
    // In the order in which the text first reads them, which says little: by name instead.
    const auto by_name = [](const auto& a, const auto& b) { return a.name < b.name; };
    if (!result.blocks.empty())
        std::sort(result.blocks[0].members.begin(), result.blocks[0].members.end(), by_name);
    std::sort(result.images.begin(), result.images.end(), by_name);
    std::sort(result.inputs.begin(), result.inputs.end(), by_name);
    return result;
}

}  // namespace intaglio::check
