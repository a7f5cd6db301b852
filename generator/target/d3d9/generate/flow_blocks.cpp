// Blocks keep the numbers of the module's values: a value from another block is an input there, but
// leaves and shapes, which cost nothing, are computed again where they are read.  A truth value
// that crosses is a number that is at least 0 where it is true.
#include "generator/target/d3d9/generate/flow_blocks.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "generator/passes/rewrite.h"

namespace intaglio::d3d9 {
namespace {

using ir::Instruction;
using ir::Op;
using ir::ValueId;

// Values computed from their operands for nothing, in each block anew.
bool is_free(Op op) {
    return op == Op::Constant || op == Op::Input || op == Op::Uniform || op == Op::Swizzle ||
           op == Op::Neg || op == Op::ToFloat || op == Op::Not;
}

std::optional<Comparison> comparison_of(Op op) {
    switch (op) {
        case Op::GreaterEqual: return Comparison::GreaterEqual;
        case Op::Greater: return Comparison::Greater;
        case Op::LessEqual: return Comparison::LessEqual;
        case Op::Less: return Comparison::Less;
        case Op::Equal: return Comparison::Equal;
        case Op::NotEqual: return Comparison::NotEqual;
        default: return std::nullopt;
    }
}

class Cutter {
  public:
    explicit Cutter(const ir::Module& module) : module_(module), values_(module) {
        values_.body = {};
        flow_.inputs = static_cast<int>(module.inputs.size());
        passes::for_each_instruction(module.body, [&](const Instruction& instruction) {
            for (const ValueId result : instruction.results)
                if (!ir::has_regions(instruction.op)) definitions_[result] = &instruction;
        });
    }

    Result<Flow> run() {
        begin_block();
        if (const Status status = walk(module_.body, 0); !status) return status.error();
        finish_blocks();
        return std::move(flow_);
    }

  private:
    struct Block {
        std::vector<Instruction> body;
        std::set<ValueId> known;
        std::vector<std::pair<int, ValueId>> outputs;  // target and value
    };

    Block& current() { return blocks_.back(); }
    void begin_block() {
        if (!blocks_.empty() && current().body.empty() && current().outputs.empty() &&
            flow_.steps.back().kind == FlowStep::Kind::Block)
            return;
        FlowStep step;
        step.block = static_cast<int>(blocks_.size());
        flow_.steps.push_back(step);
        blocks_.emplace_back();
    }
    void step(FlowStep::Kind kind, const ir::Origin& origin) {
        FlowStep step;
        step.kind = kind;
        step.origin = origin;
        flow_.steps.push_back(step);
    }

    int new_variable(ir::Type type) {
        flow_.widths.push_back(type.width);
        variable_types_.push_back(type.scalar == ir::Scalar::Bool ? ir::float1 : type);
        return static_cast<int>(flow_.widths.size()) - 1;
    }
    Instruction leaf(Op op, ValueId result, int slot, const ir::Origin& origin) const {
        Instruction instruction;
        instruction.op = op;
        instruction.results = {result};
        instruction.slot = slot;
        instruction.origin = origin;
        return instruction;
    }
    ValueId append(Block& block, Op op, ir::Type type, std::vector<ValueId> operands) {
        block.body.push_back(passes::make_instruction(values_, op, type, operands, origin_));
        return block.body.back().result();
    }
    ValueId constant(Block& block, float value) {
        block.body.push_back(
            passes::make_constant(values_, ir::float1, {ir::float_bits(value), 0, 0, 0}, origin_));
        return block.body.back().result();
    }

    // Makes the value known in the block.
    void import(std::size_t number, ValueId value) {
        if (!blocks_[number].known.insert(value).second) return;
        const auto found = definitions_.find(value);
        if (found != definitions_.end() && is_free(found->second->op)) {
            for (const ValueId operand : found->second->operands) import(number, operand);
            blocks_[number].body.push_back(*found->second);
            return;
        }
        read_variable(number, value);
    }
    void read_variable(std::size_t number, ValueId value) {
        const auto [found, added] = variables_.try_emplace(value, 0);
        if (added) {
            found->second = new_variable(module_.type(value));
            exports_.emplace_back(found->second, value);
        }
        const int slot = flow_.inputs + found->second;
        Block& block = blocks_[number];
        if (module_.type(value).scalar != ir::Scalar::Bool) {
            block.body.push_back(leaf(Op::Input, value, slot, origin_));
            return;
        }
        const ValueId gap = values_.add_value(ir::float1);
        block.body.push_back(leaf(Op::Input, gap, slot, origin_));
        Instruction truth;
        truth.op = Op::GreaterEqual;
        truth.results = {value};
        truth.operands = {gap, constant(block, 0)};
        truth.origin = origin_;
        block.body.push_back(std::move(truth));
        gaps_[{number, value}] = gap;
    }

    // The number that is at least 0 where the truth value is true.
    ValueId gap_of(std::size_t number, ValueId value) {
        const auto known = gaps_.find({number, value});
        if (known != gaps_.end()) return known->second;
        Block& block = blocks_[number];
        const auto found = definitions_.find(value);
        ValueId gap{};
        if (found != definitions_.end() && found->second->op == Op::GreaterEqual)
            gap = append(block, Op::Sub, ir::float1, found->second->operands);
        else if (found != definitions_.end() && found->second->op == Op::LessEqual)
            gap = append(block, Op::Sub, ir::float1,
                         {found->second->operands[1], found->second->operands[0]});
        else
            gap = append(block, Op::Select, ir::float1,
                         {value, constant(block, 1), constant(block, -1)});
        gaps_[{number, value}] = gap;
        return gap;
    }

    void assign(std::size_t number, int variable, ValueId value) {
        import(number, value);
        const bool truth = module_.values.size() > ir::index_of(value) &&
                           module_.type(value).scalar == ir::Scalar::Bool;
        blocks_[number].outputs.emplace_back(variable, truth ? gap_of(number, value) : value);
    }
    std::size_t here() const { return blocks_.size() - 1; }

    Status walk(const ir::Region& region, int depth) {
        for (const Instruction& instruction : region.body) {
            origin_ = instruction.origin;
            if (instruction.op == Op::Loop) {
                if (const Status status = loop(instruction, depth + 1); !status) return status;
            } else if (instruction.op == Op::Return) {
                for (std::size_t k = 0; k < instruction.operands.size(); ++k)
                    assign(here(), -1 - static_cast<int>(k), instruction.operands[k]);
            } else if (instruction.op != Op::Yield && instruction.op != Op::BreakIf) {
                for (const ValueId operand : instruction.operands) import(here(), operand);
                current().known.insert(instruction.results.begin(), instruction.results.end());
                current().body.push_back(instruction);
            } else {
                return Done{};  // loop() goes on
            }
        }
        return Done{};
    }

    // Where each carried value is kept, and where its result is.
    struct Carried {
        std::vector<int> variables, results;
        int index = -1;
    };

    Status loop(const Instruction& loop, int depth) {
        if (depth > most_nested)
            return input_error("d3d9-loop",
                               fmt::format("{}: the loop '{}' is nested {} deep; ps_3_0 nests {}, "
                                           "so unroll one of them",
                                           passes::place_of(module_, loop.origin), loop.loop.name,
                                           depth, most_nested));
        const ir::Region& region = loop.regions[0];
        Carried carried;
        for (std::size_t k = 0; k < loop.operands.size(); ++k) {
            carried.variables.push_back(new_variable(module_.type(loop.operands[k])));
            variables_[region.parameters[k + 1]] = carried.variables.back();
        }
        for (std::size_t k = 0; k < loop.operands.size(); ++k)
            assign(here(), carried.variables[k], loop.operands[k]);
        if (reads(region.body, 0, region.parameters[0])) {
            carried.index = new_variable(ir::int1);
            variables_[region.parameters[0]] = carried.index;
            blocks_.back().outputs.emplace_back(carried.index, constant(current(), 0));
        }
        for (std::size_t k = 0; k < loop.operands.size(); ++k)
            carried.results.push_back(result_may_share(region, k)
                                          ? carried.variables[k]
                                          : new_variable(module_.type(loop.operands[k])));
        step(FlowStep::Kind::Rep, loop.origin);
        flow_.steps.back().repeats = loop.loop.trip_count;
        begin_block();
        if (const Status status = body(region, carried, depth); !status) return status;
        step(FlowStep::Kind::EndRep, loop.origin);
        for (std::size_t k = 0; k < loop.results.size(); ++k)
            variables_[loop.results[k]] = carried.results[k];
        begin_block();
        return Done{};
    }

    Status body(const ir::Region& region, const Carried& carried, int depth) {
        ir::Region part;
        for (const Instruction& instruction : region.body) {
            part.body.assign(1, instruction);
            origin_ = instruction.origin;
            if (instruction.op == Op::BreakIf) {
                leave(instruction, carried, region);
            } else if (instruction.op == Op::Yield) {
                next_iteration(instruction, carried, region);
            } else if (instruction.op == Op::Loop) {
                if (const Status status = loop(instruction, depth + 1); !status) return status;
            } else if (const Status status = walk(part, depth); !status) {
                return status;
            }
        }
        return Done{};
    }

    void next_iteration(const Instruction& yield, const Carried& carried,
                        const ir::Region& region) {
        for (std::size_t k = 0; k < yield.operands.size(); ++k) {
            if (yield.operands[k] != region.parameters[k + 1])
                assign(here(), carried.variables[k], yield.operands[k]);
            if (carried.results[k] != carried.variables[k])
                assign(here(), carried.results[k], yield.operands[k]);
        }
        if (carried.index < 0) return;
        import(here(), region.parameters[0]);
        current().body.push_back(passes::make_int_constant(values_, 1, origin_));
        const ValueId step = current().body.back().result();
        const ValueId next = append(current(), Op::Add, ir::int1, {region.parameters[0], step});
        current().outputs.emplace_back(carried.index, next);
    }

    void leave(const Instruction& exit, const Carried& carried, const ir::Region& region) {
        for (std::size_t k = 0; k + 1 < exit.operands.size(); ++k)
            if (carried.results[k] != carried.variables[k] ||
                exit.operands[k + 1] != region.parameters[k + 1])
                assign(here(), carried.results[k], exit.operands[k + 1]);
        import(here(), exit.operands[0]);
        const std::size_t number = here();
        test(number, exit.operands[0]);
        begin_block();
    }
    // One break for each side of an or, a comparison as it is, anything else as a number.
    void test(std::size_t number, ValueId condition) {
        const auto found = definitions_.find(condition);
        const Instruction* made = found == definitions_.end() ? nullptr : found->second;
        if (made != nullptr && gaps_.count({number, condition}) == 0) {
            if (made->op == Op::Or) {
                test(number, made->operands[0]);
                test(number, made->operands[1]);
                return;
            }
            if (const auto comparison = comparison_of(made->op)) {
                compare(number, *comparison, made->operands[0], made->operands[1]);
                return;
            }
        }
        const ValueId gap = gap_of(number, condition);
        compare(number, Comparison::GreaterEqual, gap, constant(blocks_[number], 0));
    }
    void compare(std::size_t number, Comparison comparison, ValueId left, ValueId right) {
        for (const ValueId side : {left, right})
            if (ir::index_of(side) < module_.values.size()) import(number, side);
        FlowStep step;
        step.kind = FlowStep::Kind::Break;
        step.origin = origin_;
        step.comparison = comparison;
        step.left = new_variable(ir::float1);
        step.right = new_variable(ir::float1);
        blocks_[number].outputs.emplace_back(step.left, left);
        blocks_[number].outputs.emplace_back(step.right, right);
        flow_.steps.push_back(step);
    }

    // Whether the result of a carried value can be kept where the value is: what an exit leaves it
    // with is there already, or the value is not read after that exit's test.
    bool result_may_share(const ir::Region& region, std::size_t k) const {
        const ValueId parameter = region.parameters[k + 1];
        for (std::size_t i = 0; i < region.body.size(); ++i)
            if (region.body[i].op == Op::BreakIf && region.body[i].operands[k + 1] != parameter &&
                reads(region.body, i + 1, parameter))
                return false;
        return true;
    }
    // Whether instructions from number `first` on read the value, or a shape of it.
    bool reads(const std::vector<Instruction>& body, std::size_t first, ValueId value) const {
        bool found = false;
        const auto look = [&](const Instruction& instruction) {
            for (const ValueId operand : instruction.operands)
                found = found || is_shape_of(operand, value);
        };
        for (std::size_t i = first; i < body.size(); ++i) {
            look(body[i]);
            for (const ir::Region& inner : body[i].regions)
                passes::for_each_instruction(inner, look);
        }
        return found;
    }
    bool is_shape_of(ValueId value, ValueId of) const {
        if (value == of) return true;
        const auto found = definitions_.find(value);
        if (found == definitions_.end() || !is_free(found->second->op)) return false;
        return std::any_of(found->second->operands.begin(), found->second->operands.end(),
                           [&](ValueId operand) { return is_shape_of(operand, of); });
    }

    void finish_blocks() {
        // Importing an operand of what is exported may export that.
        for (std::size_t e = 0; e < exports_.size(); ++e) {
            const auto [variable, value] = exports_[e];
            for (std::size_t b = 0; b < blocks_.size(); ++b)
                if (defines(blocks_[b], value)) assign(b, variable, value);
        }
        for (Block& block : blocks_) {
            FlowBlock result;
            result.module = values_;
            result.module.outputs.clear();
            Instruction end;
            end.op = Op::Return;
            for (const auto& [target, value] : block.outputs) {
                result.targets.push_back(target);
                result.module.outputs.push_back(declaration_of(target));
                end.operands.push_back(value);
            }
            for (std::size_t v = 0; v < variable_types_.size(); ++v)
                result.module.inputs.push_back(
                    {fmt::format("variable{}", v), variable_types_[v], ir::Semantic::Parameter});
            result.module.body.body = std::move(block.body);
            result.module.body.body.push_back(std::move(end));
            flow_.blocks.push_back(std::move(result));
        }
    }
    ir::Declaration declaration_of(int target) const {
        if (target < 0) return module_.outputs[static_cast<std::size_t>(-1 - target)];
        return {fmt::format("variable{}", target),
                variable_types_[static_cast<std::size_t>(target)], ir::Semantic::Target};
    }
    // Where it is computed, not read.
    bool defines(const Block& block, ValueId value) const {
        return std::any_of(block.body.begin(), block.body.end(), [&](const Instruction& it) {
            if (it.results[0] != value) return false;
            const auto made = definitions_.find(value);
            return made != definitions_.end() && it == *made->second;
        });
    }

    const ir::Module& module_;
    ir::Module values_;  // the module's declarations and values, and those of the blocks
    Flow flow_;
    std::vector<Block> blocks_;
    std::map<ValueId, const Instruction*> definitions_;
    std::map<ValueId, int> variables_;
    std::vector<ir::Type> variable_types_;
    std::vector<std::pair<int, ValueId>> exports_;
    std::map<std::pair<std::size_t, ValueId>, ValueId> gaps_;
    ir::Origin origin_;
};

}  // namespace

Result<Flow> cut_into_blocks(const ir::Module& module) { return Cutter(module).run(); }

}  // namespace intaglio::d3d9
