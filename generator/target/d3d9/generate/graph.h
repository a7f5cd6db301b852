// A shader as a graph of Direct3D instructions before registers: what selection makes of the IR and
// packing works on.  An operand names each of its components by the node and component it comes
// from, so that shapes (compose, swizzle) cost nothing here and two scalar instructions of one kind
// become one instruction by joining their lists.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "generator/ir/module.h"
#include "generator/target/d3d9/generate/interpolants.h"
#include "generator/target/d3d9/shader.h"

namespace intaglio::d3d9 {

struct Lane {
    int node = -1;
    int component = 0;
    friend bool operator==(const Lane&, const Lane&) = default;
    friend auto operator<=>(const Lane&, const Lane&) = default;
};

// One to four components, all with the sign or none.
struct Operand {
    std::vector<Lane> lanes;
    bool negate = false;
    friend bool operator==(const Operand&, const Operand&) = default;
    friend auto operator<=>(const Operand&, const Operand&) = default;
};

struct Node {
    // A variable is a register that other blocks of a shader with loops write.
    enum class Kind : std::uint8_t { Op, Constant, Uniform, Input, Variable };
    Kind kind = Kind::Op;
    Opcode op = Opcode::Mov;
    bool saturate = false;
    int width = 1;           // components of the result; 4 of a texture read
    int slot = 0;            // uniform, input, variable, or the sampler of a texture read
    int element = 0;         // of a uniform array
    std::uint32_t bits = 0;  // of a constant, which is one float
    std::vector<Operand> operands;
    ir::Origin origin;
};

// A pixel shader's output: oC#, of four components; of one, oDepth, and what drops the pixel where
// it is below 0.
enum class OutputKind : std::uint8_t { Colour, Depth, Kill };

struct Graph {
    std::vector<Node> nodes;                 // operands may point anywhere; order() sorts
    std::vector<Operand> outputs;            // in the module's order
    std::vector<OutputKind> output_kinds;    // of a pixel shader; all colours where it is shorter
    std::vector<InterpolantPlace> inputs;    // where each of the module's inputs lies
    int variables = 0;                       // registers that code places first
    std::vector<AttributeUsage> attributes;  // what each of them is, in a vertex shader
    // Of a vertex shader: where each output lies; their widths are those of the operands.
    std::vector<InterpolantPlace> output_places;

    OutputKind kind_of_output(std::size_t k) const {
        return k < output_kinds.size() ? output_kinds[k] : OutputKind::Colour;
    }
    const Node& node(Lane lane) const { return nodes[static_cast<std::size_t>(lane.node)]; }
    Node& node(Lane lane) { return nodes[static_cast<std::size_t>(lane.node)]; }
};

// Rcp, rsq, exp, log: one component in, one out.
bool is_scalar(Opcode op);
bool is_dot(Opcode op);
bool is_texture_read(Opcode op);
// Each component of the result depends on the same component of the operands alone.
bool is_componentwise(Opcode op);

// For each node, the operands (of nodes and outputs) that read it.
std::vector<int> count_users(const Graph& graph);

// In what order instructions are written.
enum class Order : std::uint8_t {
    Depth,         // each just before its first use, operands from left to right
    DepthReverse,  // operands from right to left
    Heavy,         // the operand that needs more registers first
    Source,        // as recorded, where dependence allows
};
inline constexpr Order all_orders[] = {Order::Heavy, Order::Depth, Order::DepthReverse,
                                       Order::Source};

// The live op nodes, each after those it reads; empty if the graph has a cycle.
std::vector<int> order_of(const Graph& graph, Order order);

}  // namespace intaglio::d3d9
