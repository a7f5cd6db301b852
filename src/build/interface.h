// What an application has to give a variant, in one shape for all targets: uniforms with their
// places, samplers with their slots, vertex inputs.  Places are those that tools read from the
// product itself: SPIRV-Cross from SPIR-V, our decoder from the constant table of the bytecode,
// glslang from GLSL whose uniforms only have names.
#pragma once

#include <string>
#include <vector>

#include "generator/base/result.h"
#include "src/variant/accept.h"
#include "src/variant/variant.h"

namespace intaglio::build {

enum class Scalar { Float, Int, Bool };

struct Uniform {
    std::string name, comment;
    Scalar scalar = Scalar::Float;
    int components = 1;
    int elements = 1;  // of an array; a matrix is an array of its rows
    int offset = 0;    // bytes from the start of the block; see UniformBlock
    int stride = 0;    // bytes from element to element; 0: there is one
    int reg = -1;      // Direct3D 9: the first register
    bool operator==(const Uniform&) const = default;
    int size() const { return elements > 1 ? elements * stride : 4 * components; }
};

// The uniforms of one stage as one piece of memory.
struct UniformBlock {
    // How it gets to the shader.  Buffer: as it lies, at a set and binding (Vulkan), a register b#
    // (HLSL) or a buffer index (Metal).  Registers: as it lies, from the first register on
    // (Direct3D 9).  Names: uniform by uniform, each by its name; the layout is ours, without gaps.
    enum class Kind { Buffer, Registers, Names };
    Kind kind = Kind::Names;
    int set = -1, binding = -1;              // Buffer
    int first_register = -1, registers = 0;  // Registers
    int size = 0;                            // bytes
    std::vector<Uniform> uniforms;           // by offset
    bool operator==(const UniformBlock&) const = default;
};

struct Sampler {
    std::string name, comment;
    int set = -1;
    int slot = -1;           // binding, register or index; -1: by name
    int sampler_slot = -1;   // of the sampler state, where it is apart from the texture
    int dimension = 2;       // 2, or 3: a volume
    bool nearest = false;    // else linear
    bool one_level = false;  // wants no mipmaps: the target leaves the level to the hardware
    bool operator==(const Sampler&) const = default;
};

struct VertexInput {
    std::string name;  // Direct3D 9: the usage, "texcoord0"
    int components = 4;
    int location = -1;  // -1: by name
    bool operator==(const VertexInput&) const = default;
};

struct StageInterface {
    UniformBlock block;
    std::vector<Sampler> samplers;
    bool operator==(const StageInterface&) const = default;
};

struct Interface {
    StageInterface vertex, pixel;
    std::vector<VertexInput> inputs;
    bool operator==(const Interface&) const = default;
};

// Of a variant that was accepted.  Errors: those of reflection; "interface" (ours) for what no text
// of ours should have.
Result<Interface> interface_of(const Variant& variant, const Accepted& accepted);

}  // namespace intaglio::build
