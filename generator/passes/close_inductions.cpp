// An induction v' = v + c, with c from outside the loop: the parameter v becomes start + i * c at
// the top of the body, and v' becomes start + (i + 1) * c, so that v of one iteration is v' of the
// one before, to the bit.  The carried value itself stays for the loop's result; remove_dead_code
// takes it away where nothing needs it.
#include "generator/passes/close_inductions.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "generator/passes/rewrite.h"

namespace intaglio::passes {
namespace {

using namespace ir;

struct Induction {
    std::size_t k = 0;     // which carried value
    std::size_t next = 0;  // position of v' in the body
    Op op = Op::Add;       // or Sub
    ValueId step{};
};

class Closer {
  public:
    explicit Closer(Module& module) : module_(module), substitution_(module) {}

    std::vector<std::string> run() {
        if (contains_op(module_.body, Op::Loop)) visit(module_.body);
        substitute(module_.body, substitution_);
        compact_values(module_);
        return std::move(sentences_);
    }

  private:
    void visit(Region& region) {
        for (Instruction& instruction : region.body) {
            definitions_.record(instruction);
            for (Region& inner : instruction.regions) visit(inner);
            if (instruction.op != Op::Loop) continue;
            for (std::size_t k = 0; k < instruction.operands.size(); ++k)
                if (const auto induction = find_induction(instruction, k))
                    close(instruction, *induction);
        }
    }

    std::optional<Induction> find_induction(const Instruction& loop, std::size_t k) const {
        const Region& region = loop.regions[0];
        const ValueId parameter = region.parameters[k + 1];
        if (module_.type(parameter).scalar == Scalar::Bool) return std::nullopt;
        if (module_.type(parameter).scalar == Scalar::Float && !loop.loop.closed_form)
            return std::nullopt;
        const ValueId next = region.body.back().operands[k];
        const auto found = std::find_if(
            region.body.begin(), region.body.end(), [&](const Instruction& instruction) {
                return instruction.results.size() == 1 && instruction.result() == next;
            });
        if (found == region.body.end() || (found->op != Op::Add && found->op != Op::Sub))
            return std::nullopt;
        Induction induction{k, static_cast<std::size_t>(found - region.body.begin()), found->op,
                            found->operands[1]};
        if (found->op == Op::Add && found->operands[1] == parameter)
            induction.step = found->operands[0];
        else if (found->operands[0] != parameter)
            return std::nullopt;
        if (is_defined_in(region, induction.step)) return std::nullopt;
        return induction;
    }

    static bool is_defined_in(const Region& region, ValueId value) {
        const auto contains = [&](const std::vector<ValueId>& values) {
            return std::find(values.begin(), values.end(), value) != values.end();
        };
        bool found = contains(region.parameters);
        for_each_instruction(region, [&](const Instruction& instruction) {
            found |= contains(instruction.results);
        });
        return found;
    }

    void close(Instruction& loop, const Induction& induction) {
        Region& region = loop.regions[0];
        const ValueId parameter = region.parameters[induction.k + 1];
        const ValueId start = loop.operands[induction.k];
        report(loop, parameter, induction);

        // v' first: the body's positions shift when v is put before it.
        const Instruction next = region.body[induction.next];
        std::vector<Instruction> code;
        code.push_back(make_int_constant(module_, 1, next.origin));
        const std::array ends = {region.parameters[0], code.back().result()};
        code.push_back(make_instruction(module_, Op::Add, int1, ends, next.origin));
        closed_form(code, code.back().result(), start, induction, next.origin);
        code.back().results = next.results;
        const auto position = region.body.begin() + static_cast<std::ptrdiff_t>(induction.next);
        region.body.insert(region.body.erase(position), code.begin(), code.end());

        code.clear();
        closed_form(code, region.parameters[0], start, induction, next.origin);
        substitution_.replace(parameter, code.back().result());
        region.body.insert(region.body.begin(), code.begin(), code.end());
    }

    // start + index * step
    void closed_form(std::vector<Instruction>& code, ValueId index, ValueId start,
                     const Induction& induction, const Origin& origin) {
        const Type type = module_.type(start);
        ValueId factor = index;
        if (type.scalar == Scalar::Float)
            factor = append(code, Op::ToFloat, float1, {&factor, 1}, origin);
        if (type.width > 1)
            factor = append(code, Op::Swizzle, type, {&factor, 1}, origin);  // lanes 0: .xx
        const std::array factors = {factor, induction.step};
        const ValueId product = append(code, Op::Mul, type, factors, origin);
        if (type.scalar == Scalar::Float && is_zero(start)) {
            if (induction.op == Op::Sub) append(code, Op::Neg, type, {&product, 1}, origin);
            return;
        }
        const std::array terms = {start, product};
        append(code, induction.op, type, terms, origin);
    }

    ValueId append(std::vector<Instruction>& code, Op op, Type type,
                   std::span<const ValueId> operands, const Origin& origin) {
        code.push_back(make_instruction(module_, op, type, operands, origin));
        return code.back().result();
    }

    bool is_zero(ValueId value) const {
        const Definition& definition = definitions_[value];
        if (definition.op != Op::Constant) return false;
        for (int i = 0; i < module_.type(value).width; ++i)
            if ((definition.bits[static_cast<std::size_t>(i)] << 1) != 0) return false;
        return true;
    }

    void report(const Instruction& loop, ValueId parameter, const Induction& induction) {
        const Region& region = loop.regions[0];
        std::string name = module_.value(parameter).name;
        if (name.empty()) name = module_.value(region.body[induction.next].result()).name;
        if (name.empty()) name = fmt::format("carried value {}", induction.k + 1);
        const std::string place = place_of(module_, region.body[induction.next].origin);
        const bool rounds = module_.type(parameter).scalar == Scalar::Float;
        sentences_.push_back(fmt::format(
            "{}{}in loop '{}', {} is computed from the index as start {} i * step{}", place,
            place.empty() ? "" : ": ", loop.loop.name, name, induction.op == Op::Add ? "+" : "-",
            rounds ? ", which rounds differently" : ""));
    }

    Module& module_;
    Substitution substitution_;
    Definitions definitions_;
    std::vector<std::string> sentences_;
};

}  // namespace

std::vector<std::string> close_inductions(ir::Module& module) { return Closer(module).run(); }

}  // namespace intaglio::passes
