// Names to registers: uniforms and textures by the constant table, inputs and outputs by usage.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "generator/target/d3d9/interpret_prepared.h"

namespace intaglio::d3d9 {
namespace {

template <typename T>
T& at(std::vector<T>& registers, int index) {
    const auto place = static_cast<std::size_t>(index);
    if (registers.size() <= place) registers.resize(place + 1);
    return registers[place];
}

int register_limit(Constant::Set set) {
    return set == Constant::Set::Float4 ? constant_count : flow_constant_count;
}

Status fill(Environment& into, const Constant& constant, const std::vector<float>& values) {
    const int columns = constant.set == Constant::Set::Bool ? 1 : constant.columns;
    const auto needed = static_cast<std::size_t>(constant.count * columns);
    if (values.size() != needed) {
        return input_error(
            "bad-uniform",
            fmt::format("the uniform '{}' takes {} values ({} registers of {}), and "
                        "{} were given",
                        constant.name, needed, constant.count, columns, values.size()));
    }
    for (int i = 0; i < constant.count; ++i) {
        const int index = constant.index + i;
        if (constant.set == Constant::Set::Bool) {
            if (into.booleans.size() <= static_cast<std::size_t>(index))
                into.booleans.resize(static_cast<std::size_t>(index) + 1);
            into.booleans[static_cast<std::size_t>(index)] =
                values[static_cast<std::size_t>(i)] != 0;
            continue;
        }
        for (int c = 0; c < columns; ++c) {
            const float value = values[static_cast<std::size_t>(i * columns + c)];
            const auto component = static_cast<std::size_t>(c);
            if (constant.set == Constant::Set::Float4)
                at(into.constants, index)[component] = value;
            else  // flow constants are small; what no int holds counts as 0
                at(into.integers, index)[component] =
                    std::fabs(value) < 1e9f ? static_cast<int>(std::lround(value)) : 0;
        }
    }
    return Done{};
}

bool is_lane_of(const Declaration& declaration, std::size_t lane) {
    return (declaration.target.mask >> lane & 1) != 0;
}

}  // namespace

Result<Environment> environment_of(const Shader& shader,
                                   const std::map<std::string, std::vector<float>>& uniforms,
                                   const std::map<std::string, const ir::Texture*>& textures) {
    Environment environment;
    for (const Constant& constant : shader.constants) {
        if (constant.index < 0 || constant.count < 0 || constant.columns < 0 ||
            constant.columns > 4 || constant.count > register_limit(constant.set) ||
            constant.index > register_limit(constant.set) - constant.count) {
            return input_error(
                "d3d9-malformed",
                fmt::format("the constant table places '{}' outside the registers", constant.name));
        }
        if (constant.set == Constant::Set::Sampler) {
            const auto found = textures.find(constant.name);
            if (found == textures.end() || found->second == nullptr) {
                return input_error("missing-texture",
                                   fmt::format("the shader needs the texture '{}', which was not "
                                               "given",
                                               constant.name));
            }
            at(environment.samplers, constant.index) = found->second;
            continue;
        }
        const auto found = uniforms.find(constant.name);
        if (found == uniforms.end()) {
            return input_error("missing-uniform",
                               fmt::format("the shader needs the uniform '{}', which was not given",
                                           constant.name));
        }
        if (Status filled = fill(environment, constant, found->second); !filled)
            return filled.error();
    }
    return environment;
}

void set_input(const Shader& shader, Inputs& inputs, Usage usage, int index, const Vector& value) {
    const auto place = static_cast<std::size_t>(index);
    if (is_pixel(shader.profile) && shader.profile != Profile::ps_3_0) {
        if (usage == Usage::Texcoord && index >= 0 && index < 8) inputs.texcoords[place] = value;
        if (usage == Usage::Color && index >= 0 && index < 2) inputs.attributes[place] = value;
        return;
    }
    for (const Declaration& declaration : shader.declarations) {
        const int target = declaration.target.index;
        if (declaration.target.file != File::Input || declaration.usage != usage ||
            declaration.usage_index != index || target < 0 || target >= 16) {
            continue;
        }
        for (std::size_t lane = 0; lane < 4; ++lane)
            if (is_lane_of(declaration, lane))
                inputs.attributes[static_cast<std::size_t>(target)][lane] = value[lane];
    }
}

Vector output_of(const Shader& shader, const Execution& execution, Usage usage, int index) {
    if (shader.profile == Profile::vs_2_0) {
        const auto place = static_cast<std::size_t>(index);
        if (usage == Usage::Position && index == 0) return execution.position;
        if (usage == Usage::Texcoord && index >= 0 && index < 8) return execution.texcoords[place];
        if (usage == Usage::Color && index >= 0 && index < 2) return execution.diffuse[place];
        if (usage == Usage::Fog) return execution.fog;
        return usage == Usage::PointSize ? execution.point_size : Vector{};
    }
    Vector value{};
    for (const Declaration& declaration : shader.declarations) {
        const int target = declaration.target.index;
        if (declaration.target.file != File::Output || declaration.usage != usage ||
            declaration.usage_index != index || target < 0 || target >= 12) {
            continue;
        }
        for (std::size_t lane = 0; lane < 4; ++lane)
            if (is_lane_of(declaration, lane))
                value[lane] = execution.outputs[static_cast<std::size_t>(target)][lane];
    }
    return value;
}

}  // namespace intaglio::d3d9
