// The intermediate representation: typed values in structured regions.  There is no phi and no
// goto: a loop carries values through its region's parameters, an if yields them.
//
// A Loop instruction has operands = initial carried values, results = carried values after the
// loop, and one region whose parameters are the iteration index (int1, from 0) followed by the
// carried values.  Its body ends in Yield with the next carried values.  A BreakIf may stand
// anywhere at the top level of the body; it leaves the loop with carried values of its own.  An If
// instruction has two regions without parameters, each ending in Yield.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "generator/ir/ops.h"

namespace intaglio::ir {

enum class Scalar : std::uint8_t { Bool, Int, Float };

struct Type {
    Scalar scalar = Scalar::Float;
    int width = 1;  // 1 to 4
    friend bool operator==(const Type&, const Type&) = default;
};

constexpr Type bool1{Scalar::Bool, 1}, int1{Scalar::Int, 1};
constexpr Type float1{Scalar::Float, 1}, float2{Scalar::Float, 2}, float3{Scalar::Float, 3},
    float4{Scalar::Float, 4};

// "float3", "int1", "bool1".
std::string to_string(Type type);

// Identity of a value: an index into Module::values.
enum class ValueId : std::uint32_t {};
constexpr std::uint32_t index_of(ValueId id) { return static_cast<std::uint32_t>(id); }

// Where an instruction comes from: a line of C++ and the step of the technique it belongs to.
struct Origin {
    int file = -1;  // index into Module::files; -1: unknown
    int line = 0;
    int step = -1;  // index into Module::steps; -1: none
    friend bool operator==(const Origin&, const Origin&) = default;
};

// What the schedule says of a loop.  Unspecified leaves the choice to the target; the others are
// obeyed or refused.
enum class LoopForm : std::uint8_t { Unspecified, Rolled, Unrolled };

struct LoopInfo {
    std::string name;
    int trip_count = 0;  // the most iterations the loop runs; known while generating
    LoopForm form = LoopForm::Unspecified;
    bool closed_form =
        false;  // consent to rewrite float inductions as start + i * step, which rounds differently
    friend bool operator==(const LoopInfo&, const LoopInfo&) = default;
};

struct Region;

struct Instruction {
    Op op = Op::Constant;
    std::vector<ValueId> results;
    std::vector<ValueId> operands;
    std::array<std::uint32_t, 4> bits{};  // Constant: components as bits of float, int, or 0 / 1
    int slot = 0;                         // Input, Uniform, sample ops: index of the declaration
    int element = 0;                      // Uniform: element of an array
    std::array<std::uint8_t, 4>
        lanes{};                  // Swizzle: source component (0..3) for each result component
    LoopInfo loop;                // Loop
    std::vector<Region> regions;  // Loop: 1, If: 2 (then, else)
    Origin origin;

    ValueId result() const { return results.front(); }
    friend bool operator==(const Instruction&, const Instruction&) = default;
};

struct Region {
    std::vector<ValueId> parameters;
    std::vector<Instruction> body;  // the last one is a terminator
    friend bool operator==(const Region&, const Region&) = default;
};

struct Value {
    Type type;
    std::string name;  // the DSL's name; empty: none was given
    friend bool operator==(const Value&, const Value&) = default;
};

enum class Stage : std::uint8_t { Vertex, Pixel, Function };

// What an input or output is bound to.
enum class Semantic : std::uint8_t {
    Attribute,    // vertex input, bound by name
    Interpolant,  // vertex output and pixel input, bound by name; perspective-correct
    Position,     // vertex output: clip-space position
    Target,       // pixel output: colour target, in order of declaration
    Parameter,    // input of a function
    Result,       // output of a function
    Depth,        // pixel output, one float: written to the depth buffer in place of the polygon's
    Clip,         // pixel output, one float: the pixel is dropped where it is below 0
};

struct Declaration {
    std::string name;
    Type type;
    Semantic semantic = Semantic::Attribute;
    friend bool operator==(const Declaration&, const Declaration&) = default;
};

struct Uniform {
    std::string name;
    Type type;
    int count = 1;        // elements; a matrix is an array of its rows
    std::string comment;  // what it means, units and range: printed beside its declaration
    friend bool operator==(const Uniform&, const Uniform&) = default;
};

// A texture with the way it is read: its declaration, and nothing else, says the filter.  Every
// axis repeats.  Linear: between texels, and between levels where there are several.  Nearest: one
// texel of one level, for maps whose values must not be mixed.
struct Sampler {
    enum class Filter : std::uint8_t { Linear, Nearest };

    std::string name;
    int dimension = 2;  // 2, or 3: a volume
    std::string comment;
    Filter filter = Filter::Linear;
    // Of a baked map: the settings it must be baked with, "shininess=32"; empty: any.
    std::string baked = {};
    friend bool operator==(const Sampler&, const Sampler&) = default;
};

// A named part of the technique's work: emitted as a comment, charged with the cost of its
// instructions.
struct Step {
    std::string name;     // "march"
    std::string comment;  // a sentence a reader of the emitted text sees
    friend bool operator==(const Step&, const Step&) = default;
};

// One shader stage or function.
struct Module {
    std::string name;
    Stage stage = Stage::Pixel;
    std::vector<Declaration> inputs;
    std::vector<Declaration> outputs;
    std::vector<Uniform> uniforms;
    std::vector<Sampler> samplers;
    std::vector<std::string> files;
    std::vector<Step> steps;
    std::vector<Value> values;
    Region body;

    const Value& value(ValueId id) const { return values[index_of(id)]; }
    Type type(ValueId id) const { return value(id).type; }
    ValueId add_value(Type type, std::string value_name = {}) {
        values.push_back({type, std::move(value_name)});
        return static_cast<ValueId>(values.size() - 1);
    }
    friend bool operator==(const Module&, const Module&) = default;
};

// A surface ready to be emitted: both stages, and a title with the knobs for the file header.
struct Program {
    std::string name;         // "parallax_occlusion"
    std::string description;  // one or more sentences with the source; lines without line breaks
    std::vector<std::string> settings;  // "taps = 8", in order of declaration
    Module vertex;
    Module pixel;
    bool per_vertex =
        false;  // consent to move affine functions of interpolants to the vertex stage
};

// Float bits of a constant component, and back.
float constant_float(const Instruction& constant, int component);
std::uint32_t float_bits(float value);

}  // namespace intaglio::ir
