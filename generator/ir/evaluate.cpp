// The evaluator.  Preparing gives every value a range of cells and turns each region into a flat
// block of nodes; constants are cells that are filled beforehand.  Running walks the blocks.
// Derivatives need neighbours: the module's body then runs in lockstep for three lanes (here,
// right, below), which is enough because the verifier keeps derivatives out of loops and ifs, so
// that within those each lane can go its own way.
#include "generator/ir/evaluate.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "generator/ir/kernel.h"
#include "generator/ir/verify.h"

namespace intaglio::ir {
namespace {

// Copies cells as if all at once: through scratch cells where a target is also a source.
struct Transfer {
    std::vector<std::uint32_t> from;
    std::vector<std::uint32_t> to;
    bool overlaps = false;
};

struct Node {
    Op op = Op::Add;
    Scalar scalar = Scalar::Float;  // of the result of a leaf
    std::uint32_t result = 0;       // first cell
    std::array<std::uint32_t, max_operands> operands{};
    Kernel kernel;
    int slot = 0;
    int element = 0;
    int width = 1;  // of a leaf, a derivative, a coordinate
    bool nearest = false;  // how a sampler reads
    int trip_count = 0;
    std::array<std::uint32_t, 2> blocks{};     // Loop: body; If: then, else
    std::uint32_t index_cell = 0;              // Loop
    std::array<std::uint32_t, 2> transfers{};  // Loop: before, after; BreakIf, Yield: the one
};

}  // namespace

struct Evaluator::Prepared {
    std::vector<std::vector<Node>> blocks;  // 0 is the module's body
    std::vector<Transfer> transfers;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> constants;  // cell, bits
    std::vector<std::pair<std::uint32_t, Type>> outputs;             // first cell, type
    std::vector<bool> float_constants;                               // for each of `constants`
    std::uint32_t cell_count = 0;                                    // scratch included
    std::uint32_t scratch = 0;                                       // first scratch cell
    bool needs_neighbours = false;
};

namespace {

class Preparer {
  public:
    Preparer(const Module& module, Evaluator::Prepared& prepared)
        : module_(module), prepared_(prepared) {}

    void run() {
        cells_.reserve(module_.values.size());
        for (const Value& value : module_.values) {
            cells_.push_back(prepared_.cell_count);
            prepared_.cell_count += static_cast<std::uint32_t>(value.type.width);
        }
        prepared_.scratch = prepared_.cell_count;
        block(module_.body, {});
        for (ValueId output : module_.body.body.back().operands)
            prepared_.outputs.emplace_back(cell(output), module_.type(output));
        std::size_t largest = 0;
        for (const Transfer& transfer : prepared_.transfers)
            if (transfer.overlaps) largest = std::max(largest, transfer.from.size());
        prepared_.cell_count += static_cast<std::uint32_t>(largest);
    }

  private:
    // Where the values of a region's terminator and break_ifs go.
    struct Targets {
        std::span<const ValueId> yield;
        std::span<const ValueId> leave;
    };

    std::uint32_t cell(ValueId id) const { return cells_[index_of(id)]; }

    std::uint32_t transfer(std::span<const ValueId> from, std::span<const ValueId> to) {
        Transfer result;
        for (std::size_t i = 0; i < from.size(); ++i)
            for (int component = 0; component < module_.type(from[i]).width; ++component) {
                result.from.push_back(cell(from[i]) + static_cast<std::uint32_t>(component));
                result.to.push_back(cell(to[i]) + static_cast<std::uint32_t>(component));
            }
        for (std::uint32_t target : result.to)
            result.overlaps |=
                std::find(result.from.begin(), result.from.end(), target) != result.from.end();
        prepared_.transfers.push_back(std::move(result));
        return static_cast<std::uint32_t>(prepared_.transfers.size() - 1);
    }

    std::uint32_t block(const Region& region, const Targets& targets) {
        const auto index = prepared_.blocks.size();
        prepared_.blocks.emplace_back();
        std::vector<Node> nodes;
        for (const Instruction& instruction : region.body) {
            if (instruction.op == Op::Constant)
                constant(instruction);
            else if (instruction.op != Op::Return)
                nodes.push_back(node(instruction, targets));
        }
        prepared_.blocks[index] = std::move(nodes);
        return static_cast<std::uint32_t>(index);
    }

    void constant(const Instruction& instruction) {
        const Type type = module_.type(instruction.result());
        for (int i = 0; i < type.width; ++i) {
            prepared_.constants.emplace_back(
                cell(instruction.result()) + static_cast<std::uint32_t>(i),
                instruction.bits[static_cast<std::size_t>(i)]);
            prepared_.float_constants.push_back(type.scalar == Scalar::Float);
        }
    }

    Node node(const Instruction& instruction, const Targets& targets) {
        Node node;
        node.op = instruction.op;
        node.slot = instruction.slot;
        node.element = instruction.element;
        for (std::size_t i = 0; i < std::min(instruction.operands.size(), max_operands); ++i)
            node.operands[i] = cell(instruction.operands[i]);
        if (!instruction.results.empty()) {
            node.result = cell(instruction.result());
            node.scalar = module_.type(instruction.result()).scalar;
            node.width = module_.type(instruction.result()).width;
        }
        prepared_.needs_neighbours |= needs_derivatives(instruction.op);
        if (is_pure(instruction.op)) {
            std::vector<Type> types;
            for (ValueId operand : instruction.operands) types.push_back(module_.type(operand));
            node.kernel = make_kernel(instruction, types.data(), node.width);
        } else if (is_sample(instruction.op)) {
            node.width = module_.type(instruction.operands[0]).width;
            node.nearest = module_.samplers[static_cast<std::size_t>(node.slot)].filter ==
                           Sampler::Filter::Nearest;
        } else if (instruction.op == Op::BreakIf) {
            node.transfers[0] = transfer(std::span(instruction.operands).subspan(1), targets.leave);
        } else if (instruction.op == Op::Yield) {
            node.transfers[0] = transfer(instruction.operands, targets.yield);
        } else if (instruction.op == Op::Loop) {
            loop(instruction, node);
        } else if (instruction.op == Op::If) {
            for (std::size_t i = 0; i < 2; ++i)
                node.blocks[i] = block(instruction.regions[i], {instruction.results, {}});
        }
        return node;
    }

    void loop(const Instruction& instruction, Node& node) {
        const Region& body = instruction.regions[0];
        const auto carried = std::span(body.parameters).subspan(1);
        node.trip_count = instruction.loop.trip_count;
        node.index_cell = cell(body.parameters[0]);
        node.transfers = {transfer(instruction.operands, carried),
                          transfer(carried, instruction.results)};
        node.blocks[0] = block(body, {carried, instruction.results});
    }

    const Module& module_;
    Evaluator::Prepared& prepared_;
    std::vector<std::uint32_t> cells_;  // first cell of each value
};

// Also for ints that a double cannot hold.
std::int32_t nearest_int(double value) {
    if (std::isnan(value)) return 0;
    return static_cast<std::int32_t>(std::clamp(std::round(value), -2147483648.0, 2147483647.0));
}

template <typename A>
class Run {
  public:
    using T = typename A::Number;
    using Bits = Cell<T>;

    Run(const Evaluator::Prepared& prepared, const Environment& environment)
        : prepared_(prepared), environment_(environment) {
        const bool neighbours =
            !environment.right_inputs.empty() && !environment.lower_inputs.empty();
        lane_count_ = prepared.needs_neighbours && neighbours ? 3 : 1;
        cells_.resize(prepared.cell_count * static_cast<std::size_t>(lane_count_));
        for (int i = 0; i < lane_count_; ++i)
            for (std::size_t j = 0; j < prepared.constants.size(); ++j) {
                const auto [cell, bits] = prepared.constants[j];
                lane(i)[cell] = prepared.float_constants[j]
                                    ? Compute<A>::bits(A::load(std::bit_cast<float>(bits)))
                                    : bits;
            }
    }

    Evaluation run() {
        for (const Node& node : prepared_.blocks[0]) {
            if (needs_derivatives(node.op)) {
                derivative(node);
                continue;
            }
            for (int i = 0; i < lane_count_; ++i) {
                lane_ = i;
                step(node, lane(i));
            }
        }
        for (const auto& [cell, type] : prepared_.outputs) {
            std::array<double, 4> output{};
            for (int i = 0; i < type.width; ++i) {
                const Bits bits = cells_[cell + static_cast<std::size_t>(i)];
                output[static_cast<std::size_t>(i)] =
                    type.scalar == Scalar::Float ? static_cast<double>(Compute<A>::number(bits))
                                                 : static_cast<double>(Compute<A>::integer(bits));
            }
            evaluation_.outputs.push_back(output);
        }
        return std::move(evaluation_);
    }

  private:
    Bits* lane(int index) {
        return cells_.data() + prepared_.cell_count * static_cast<std::size_t>(index);
    }

    // Returns true if a break_if leaves the loop around this block.
    bool block(std::uint32_t index, Bits* cells) {
        for (const Node& node : prepared_.blocks[index])
            if (step(node, cells)) return true;
        return false;
    }

    bool step(const Node& node, Bits* cells) {
        if (is_pure(node.op)) {
            count();
            typename Compute<A>::Operands operands{};
            for (std::size_t i = 0; i < max_operands; ++i) operands[i] = cells + node.operands[i];
            Compute<A>::run(node.kernel, operands, cells + node.result);
            return false;
        }
        switch (node.op) {
            case Op::Input: return input(node, cells), false;
            case Op::Uniform: return uniform(node, cells), false;
            case Op::SampleLevel:
            case Op::SampleGrad: return count(), explicit_sample(node, cells), false;
            case Op::Loop: return count(), loop(node, cells), false;
            case Op::If:
                return count(), block(node.blocks[cells[node.operands[0]] != 0 ? 0 : 1], cells),
                       false;
            case Op::Yield: return copy(prepared_.transfers[node.transfers[0]], cells), false;
            case Op::BreakIf:
                count();
                if (cells[node.operands[0]] == 0) return false;
                copy(prepared_.transfers[node.transfers[0]], cells);
                return true;
            default: return false;
        }
    }

    void count() { evaluation_.instructions += lane_ == 0 ? 1 : 0; }

    void copy(const Transfer& transfer, Bits* cells) {
        const std::size_t size = transfer.from.size();
        if (!transfer.overlaps) {
            for (std::size_t i = 0; i < size; ++i) cells[transfer.to[i]] = cells[transfer.from[i]];
            return;
        }
        Bits* scratch = cells + prepared_.scratch;
        for (std::size_t i = 0; i < size; ++i) scratch[i] = cells[transfer.from[i]];
        for (std::size_t i = 0; i < size; ++i) cells[transfer.to[i]] = scratch[i];
    }

    void loop(const Node& node, Bits* cells) {
        copy(prepared_.transfers[node.transfers[0]], cells);
        for (int i = 0; i < node.trip_count; ++i) {
            cells[node.index_cell] = Compute<A>::integer_bits(i);
            if (block(node.blocks[0], cells)) return;  // the break_if has delivered the results
        }
        copy(prepared_.transfers[node.transfers[1]], cells);
    }

    void write(const Node& node, const Environment::Vector& values, Bits* cells) {
        for (int i = 0; i < node.width; ++i) {
            const double value = values[static_cast<std::size_t>(i)];
            Bits& cell = cells[node.result + static_cast<std::uint32_t>(i)];
            switch (node.scalar) {
                case Scalar::Float: cell = Compute<A>::bits(A::load(value)); break;
                case Scalar::Int: cell = Compute<A>::integer_bits(nearest_int(value)); break;
                case Scalar::Bool: cell = value != 0 ? 1 : 0; break;
            }
        }
    }

    void input(const Node& node, Bits* cells) {
        const std::vector<Environment::Vector>* sources[] = {
            &environment_.inputs, &environment_.right_inputs, &environment_.lower_inputs};
        const auto& inputs = *sources[lane_];
        const auto slot = static_cast<std::size_t>(node.slot);
        write(node, slot < inputs.size() ? inputs[slot] : Environment::Vector{}, cells);
    }

    void uniform(const Node& node, Bits* cells) {
        const auto slot = static_cast<std::size_t>(node.slot),
                   element = static_cast<std::size_t>(node.element);
        const bool given =
            slot < environment_.uniforms.size() && element < environment_.uniforms[slot].size();
        write(node, given ? environment_.uniforms[slot][element] : Environment::Vector{}, cells);
    }

    std::array<T, 3> coordinate(const Node& node, std::size_t operand, const Bits* cells) const {
        std::array<T, 3> result{};
        for (std::size_t i = 0; i < static_cast<std::size_t>(node.width); ++i)
            result[i] = Compute<A>::number(cells[node.operands[operand] + i]);
        return result;
    }

    void explicit_sample(const Node& node, Bits* cells) {
        const Texture* texture = texture_of(node);
        if (texture == nullptr) return write_sample(node, {}, cells);
        const T level = node.op == Op::SampleLevel
                            ? Compute<A>::number(cells[node.operands[1]])
                            : level_of_gradients(*texture, coordinate(node, 1, cells),
                                                 coordinate(node, 2, cells));
        write_sample(node, read(node, *texture, level, cells), cells);
    }

    std::array<T, 4> read(const Node& node, const Texture& texture, T level,
                          const Bits* cells) const {
        const std::array<T, 3> at = coordinate(node, 0, cells);
        return node.nearest ? sample_nearest(texture, at, level) : sample_level(texture, at, level);
    }

    const Texture* texture_of(const Node& node) const {
        const auto slot = static_cast<std::size_t>(node.slot);
        return slot < environment_.samplers.size() ? environment_.samplers[slot] : nullptr;
    }

    void write_sample(const Node& node, const std::array<T, 4>& texel, Bits* cells) {
        evaluation_.texture_reads += lane_ == 0 ? 1 : 0;
        for (std::size_t i = 0; i < 4; ++i) cells[node.result + i] = Compute<A>::bits(A::load(texel[i]));
    }

    // Component of a lane's first operand less that of this pixel; 0 without neighbours.
    T difference(const Node& node, int neighbour, std::size_t component) {
        if (lane_count_ == 1) return 0;
        const std::size_t cell = node.operands[0] + component;
        return A::sub(Compute<A>::number(lane(neighbour)[cell]),
                                  Compute<A>::number(lane(0)[cell]));
    }

    // All lanes share one difference, as the pixels of a quad do in Vulkan's coarse derivatives.
    void derivative(const Node& node) {
        lane_ = 0;
        count();
        if (node.op == Op::SampleImplicit) return implicit_sample(node);
        for (std::size_t i = 0; i < static_cast<std::size_t>(node.width); ++i) {
            const Bits bits = Compute<A>::bits(difference(node, node.op == Op::Ddx ? 1 : 2, i));
            for (int j = 0; j < lane_count_; ++j) lane(j)[node.result + i] = bits;
        }
    }

    void implicit_sample(const Node& node) {
        const Texture* texture = texture_of(node);
        std::array<T, 3> dx{}, dy{};
        for (std::size_t i = 0; i < static_cast<std::size_t>(node.width); ++i) {
            dx[i] = difference(node, 1, i);
            dy[i] = difference(node, 2, i);
        }
        for (lane_ = 0; lane_ < lane_count_; ++lane_) {
            std::array<T, 4> texel{};
            if (texture != nullptr)
                texel = read(node, *texture, level_of_gradients(*texture, dx, dy), lane(lane_));
            write_sample(node, texel, lane(lane_));
        }
    }

    const Evaluator::Prepared& prepared_;
    const Environment& environment_;
    std::vector<Bits> cells_;
    int lane_count_ = 1;
    int lane_ = 0;  // the one being run: 0 here, 1 right, 2 below
    Evaluation evaluation_;
};

}  // namespace

Evaluator::Evaluator(const Module& module) {
    assert(verify(module));
    auto prepared = std::make_shared<Prepared>();
    Preparer(module, *prepared).run();
    prepared_ = std::move(prepared);
}

Evaluation Evaluator::run(const Environment& environment, Precision precision) const {
    switch (precision) {
        case Precision::Single: return Run<Arithmetic<float>>(*prepared_, environment).run();
        case Precision::Double: return Run<Arithmetic<double>>(*prepared_, environment).run();
        case Precision::Narrow24: return Run<Narrow<Format24>>(*prepared_, environment).run();
        case Precision::Narrow16: return Run<Narrow<Format16>>(*prepared_, environment).run();
    }
    return {};
}

}  // namespace intaglio::ir
