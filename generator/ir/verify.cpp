// Walks the module once in order of execution.  A value is undefined, visible, or gone (its region
// has ended); region contexts say what a terminator and a break_if have to deliver.
#include "generator/ir/verify.h"

#include <algorithm>
#include <optional>
#include <span>

#include <fmt/format.h>

#include "generator/ir/builder.h"
#include "generator/ir/parse.h"
#include "generator/ir/verify_declarations.h"

namespace intaglio::ir {
namespace {

enum class Visibility : std::uint8_t { Undefined, Visible, Gone };
enum class RegionKind : std::uint8_t { Body, Loop, If };

struct Context {
    RegionKind kind = RegionKind::Body;
    std::span<const ValueId>
        delivered;  // values whose types the terminator and break_if must match
    int depth = 0;  // regions around this one
};

class Verifier {
  public:
    explicit Verifier(const Module& module) : module_(module), visibility_(module.values.size()) {}

    Status run() {
        if (auto status = verify_declarations(module_); !status) return status;
        if (!region(module_.body, {})) return *error_;
        return Done{};
    }

  private:
    // --- sentences
    // ----------------------------------------------------------------------------------------------
    std::string name(ValueId id) const {
        const bool known = index_of(id) < module_.values.size() && !module_.value(id).name.empty();
        return known ? fmt::format("%{} \"{}\"", index_of(id), module_.value(id).name)
                     : fmt::format("%{}", index_of(id));
    }

    std::string types(std::span<const ValueId> ids) const {
        if (ids.empty()) return "nothing";
        std::string text;
        for (ValueId id : ids) text += (text.empty() ? "" : ", ") + to_string(module_.type(id));
        return text;
    }

    bool fail(const Instruction& at, const std::string& sentence) {
        const std::string_view op = at.op <= Op::Return ? info(at.op).name : "unknown op";
        std::string subject =
            at.results.empty() ? std::string(op) : fmt::format("{} = {}", name(at.results[0]), op);
        const auto file = static_cast<std::size_t>(at.origin.file);
        const bool located = at.origin.file >= 0 && file < module_.files.size();
        error_ = input_error("ir-verify", subject + ": " + sentence,
                             located ? module_.files[file] : std::string(),
                             located ? at.origin.line : 0);
        return false;
    }

    bool fail_region(const std::string& sentence) {
        error_ = input_error("ir-verify", sentence);
        return false;
    }

    // --- scopes
    // -------------------------------------------------------------------------------------------------
    bool use(const Instruction& at, ValueId id) {
        if (index_of(id) >= visibility_.size())
            return fail(at, fmt::format("{} is not a value of the module", name(id)));
        switch (visibility_[index_of(id)]) {
            case Visibility::Visible: return true;
            case Visibility::Undefined:
                return fail(at, fmt::format("{} is used before it is defined", name(id)));
            case Visibility::Gone:
                return fail(at,
                            fmt::format("{} is used outside the region that defines it", name(id)));
        }
        return false;
    }

    bool define(const Instruction& at, ValueId id, std::vector<ValueId>& scope) {
        if (index_of(id) >= visibility_.size())
            return fail(at, fmt::format("{} is not a value of the module", name(id)));
        if (visibility_[index_of(id)] != Visibility::Undefined)
            return fail(at, fmt::format("{} is defined twice", name(id)));
        visibility_[index_of(id)] = Visibility::Visible;
        scope.push_back(id);
        return true;
    }

    // --- regions
    // ------------------------------------------------------------------------------------------------
    // `owner` is null for the module's body.
    bool region(const Region& region, const Context& context, const Instruction* owner = nullptr) {
        const auto fail_here = [&](const std::string& sentence) {
            return owner != nullptr ? fail(*owner, sentence) : fail_region("the body: " + sentence);
        };
        if (context.depth > max_nesting)
            return fail_here(fmt::format("regions nest deeper than {}", max_nesting));
        if (context.kind != RegionKind::Loop && !region.parameters.empty())
            return fail_here("only the region of a loop has parameters");
        if (region.body.empty() || !is_terminator(region.body.back().op))
            return fail_here(fmt::format("the region does not end in a {}",
                                         owner != nullptr ? "yield" : "return"));
        std::vector<ValueId> scope;
        for (ValueId parameter : region.parameters)
            if (!define(*owner, parameter, scope)) return false;
        for (const Instruction& instruction : region.body) {
            if (is_terminator(instruction.op) && &instruction != &region.body.back())
                return fail(instruction, "instructions follow the terminator");
            if (!check(instruction, context)) return false;
            for (ValueId result : instruction.results)
                if (!define(instruction, result, scope)) return false;
        }
        for (ValueId id : scope) visibility_[index_of(id)] = Visibility::Gone;
        return true;
    }

    // --- instructions
    // -------------------------------------------------------------------------------------------
    bool check(const Instruction& instruction, const Context& context) {
        if (instruction.op > Op::Return) return fail(instruction, "this op does not exist");
        if (!origin(instruction)) return false;
        for (ValueId operand : instruction.operands)
            if (!use(instruction, operand)) return false;
        for (ValueId result : instruction.results)
            if (index_of(result) >= module_.values.size())
                return fail(instruction,
                            fmt::format("{} is not a value of the module", name(result)));
        return stray_fields(instruction) && counts(instruction) && place(instruction, context) &&
               rule(instruction, context);
    }

    bool origin(const Instruction& at) {
        if (at.origin.file < -1 || at.origin.file >= static_cast<int>(module_.files.size()))
            return fail(at, fmt::format("its origin names file {} of {}", at.origin.file,
                                        module_.files.size()));
        if (at.origin.step < -1 || at.origin.step >= static_cast<int>(module_.steps.size()))
            return fail(at, fmt::format("its origin names step {} of {}", at.origin.step,
                                        module_.steps.size()));
        if (at.origin.line < 0) return fail(at, "its origin has a negative line");
        return true;
    }

    // Fields that the op does not use are at their defaults, so that equal instructions compare
    // equal.
    bool stray_fields(const Instruction& at) {
        const bool slotted = at.op == Op::Input || at.op == Op::Uniform || is_sample(at.op);
        if (at.op != Op::Constant && at.bits != Instruction{}.bits)
            return fail(at, "only a constant has bits");
        if (!slotted && at.slot != 0)
            return fail(at, "only an input, a uniform or a texture read has a slot");
        if (at.op != Op::Uniform && at.element != 0)
            return fail(at, "only a uniform has an element");
        if (at.op != Op::Swizzle && at.lanes != Instruction{}.lanes)
            return fail(at, "only a swizzle has lanes");
        if (at.op != Op::Loop && at.loop != LoopInfo{})
            return fail(at, "only a loop has loop information");
        const std::size_t regions = at.op == Op::Loop ? 1 : at.op == Op::If ? 2 : 0;
        if (at.regions.size() != regions)
            return fail(at, fmt::format("it has {} regions, not {}", regions, at.regions.size()));
        return true;
    }

    bool counts(const Instruction& at) {
        const int expected = info(at.op).operand_count;
        if (expected != any_count && at.operands.size() != static_cast<std::size_t>(expected))
            return fail(at,
                        fmt::format("it takes {} operands, not {}", expected, at.operands.size()));
        const bool no_result = at.op == Op::BreakIf || is_terminator(at.op);
        if (no_result && !at.results.empty()) return fail(at, "it defines no value");
        if (!no_result && !has_regions(at.op) && at.results.size() != 1)
            return fail(at, fmt::format("it defines one value, not {}", at.results.size()));
        return true;
    }

    bool place(const Instruction& at, const Context& context) {
        if (needs_derivatives(at.op) && context.depth > 0)
            return fail(at, "an op that needs neighbouring pixels stands outside loops and ifs");
        if (needs_derivatives(at.op) && module_.stage == Stage::Vertex)
            return fail(at, "a vertex stage has no neighbouring pixels");
        if (at.op == Op::BreakIf && context.kind != RegionKind::Loop)
            return fail(at, "it stands at the top level of a loop's body");
        if (at.op == Op::Return && context.kind != RegionKind::Body)
            return fail(at, "a region of a loop or an if ends in a yield");
        if (at.op == Op::Yield && context.kind == RegionKind::Body)
            return fail(at, "the module's body ends in a return");
        return true;
    }

    // --- type rules
    // ---------------------------------------------------------------------------------------------
    bool rule(const Instruction& at, const Context& context) {
        switch (info(at.op).type_rule) {
            case TypeRule::Leaf: return leaf(at);
            case TypeRule::Loop: return loop(at, context);
            case TypeRule::If: return branch(at, context);
            case TypeRule::BreakIf: return break_if(at, context);
            case TypeRule::Terminator: return terminator(at, context);
            default: break;
        }
        if (const std::string expected = operand_mistake(at); !expected.empty())
            return fail(at, fmt::format("it takes {}, not {}", expected, types(at.operands)));
        if (is_sample(at.op) && !sampler(at)) return false;
        if (at.op == Op::Swizzle && !swizzle(at)) return false;
        std::vector<Type> operand_types;
        for (ValueId operand : at.operands) operand_types.push_back(module_.type(operand));
        const Type own = module_.type(at.result());
        return result(at, result_type(at.op, operand_types, own.width));
    }

    bool result(const Instruction& at, Type expected) {
        const Type own = module_.type(at.result());
        if (own == expected) return true;
        return fail(at,
                    fmt::format("its result is {}, not {}", to_string(expected), to_string(own)));
    }

    // What the operands should have been; empty if they are right.
    std::string operand_mistake(const Instruction& at) const {
        const auto type = [&](std::size_t i) { return module_.type(at.operands[i]); };
        const auto is_float = [&](std::size_t i) { return type(i).scalar == Scalar::Float; };
        const bool all_equal = std::all_of(at.operands.begin(), at.operands.end(), [&](ValueId id) {
            return module_.type(id) == module_.type(at.operands[0]);
        });
        switch (info(at.op).type_rule) {
            case TypeRule::SameNumeric:
                return all_equal && type(0).scalar != Scalar::Bool ? ""
                                                                   : "floats or ints of one type";
            case TypeRule::SameFloat: return all_equal && is_float(0) ? "" : "floats of one type";
            case TypeRule::Dot: return all_equal && is_float(0) ? "" : "two floats of one type";
            case TypeRule::Cross: return all_equal && type(0) == float3 ? "" : "two float3";
            case TypeRule::Compare:
                return all_equal && (type(0) == float1 || type(0) == int1)
                           ? ""
                           : "two float1 or two int1";
            case TypeRule::Logic: return all_equal && type(0) == bool1 ? "" : "bool1";
            case TypeRule::Select:
                return type(0) == bool1 && type(1) == type(2)
                           ? ""
                           : "a bool1 and two values of one type";
            case TypeRule::ToFloat: return type(0).scalar == Scalar::Int ? "" : "an int";
            case TypeRule::Compose: return compose_mistake(at);
            default: return "";
        }
    }

    std::string compose_mistake(const Instruction& at) const {
        int width = 0;
        bool one_kind = true;
        for (ValueId id : at.operands) {
            width += module_.type(id).width;
            one_kind = one_kind && module_.type(id).scalar == module_.type(at.operands[0]).scalar;
        }
        const bool right =
            at.operands.size() >= 2 && at.operands.size() <= 4 && one_kind && width <= 4;
        return right ? "" : "2 to 4 operands of one scalar kind with at most 4 components together";
    }

    bool swizzle(const Instruction& at) {
        const int source = module_.type(at.operands[0]).width;
        const int width = module_.type(at.result()).width;
        for (int i = 0; i < 4; ++i) {
            const int lane = at.lanes[static_cast<std::size_t>(i)];
            if (i < width && lane >= source)
                return fail(at, fmt::format("component {} reads lane {} of a {}", i, lane,
                                            to_string(module_.type(at.operands[0]))));
            if (i >= width && lane != 0) return fail(at, "lanes beyond its width are not 0");
        }
        return true;
    }

    bool in_range(const Instruction& at, std::size_t count, std::string_view kind) {
        if (at.slot >= 0 && static_cast<std::size_t>(at.slot) < count) return true;
        return fail(at, fmt::format("there is no {} {}, the module has {}", kind, at.slot, count));
    }

    bool leaf(const Instruction& at) {
        if (at.op == Op::Constant) return constant(at);
        if (at.op == Op::Input)
            return in_range(at, module_.inputs.size(), "input") &&
                   result(at, module_.inputs[static_cast<std::size_t>(at.slot)].type);
        if (!in_range(at, module_.uniforms.size(), "uniform")) return false;
        const Uniform& uniform = module_.uniforms[static_cast<std::size_t>(at.slot)];
        if (at.element < 0 || at.element >= uniform.count)
            return fail(at, fmt::format("there is no element {}, the uniform has {}", at.element,
                                        uniform.count));
        return result(at, uniform.type);
    }

    bool constant(const Instruction& at) {
        const Type type = module_.type(at.result());
        for (int i = 0; i < 4; ++i) {
            const std::uint32_t bits = at.bits[static_cast<std::size_t>(i)];
            if (i >= type.width && bits != 0) return fail(at, "bits beyond its width are not 0");
            if (type.scalar == Scalar::Bool && bits > 1)
                return fail(at, fmt::format("the bits of a bool are 0 or 1, not {}", bits));
        }
        return true;
    }

    bool sampler(const Instruction& at) {
        if (!in_range(at, module_.samplers.size(), "sampler")) return false;
        const Type coordinate{Scalar::Float,
                              module_.samplers[static_cast<std::size_t>(at.slot)].dimension};
        std::vector<Type> expected = {coordinate};
        if (at.op == Op::SampleLevel) expected.push_back(float1);
        if (at.op == Op::SampleGrad) expected.insert(expected.end(), 2, coordinate);
        std::string wanted;
        bool right = true;
        for (std::size_t i = 0; i < expected.size(); ++i) {
            wanted += (i == 0 ? "" : ", ") + to_string(expected[i]);
            right = right && module_.type(at.operands[i]) == expected[i];
        }
        return right || fail(at, fmt::format("it takes {}, not {}", wanted, types(at.operands)));
    }

    // --- control flow
    // -------------------------------------------------------------------------------------------
    bool same_types(std::span<const ValueId> left, std::span<const ValueId> right) const {
        return std::equal(left.begin(), left.end(), right.begin(), right.end(),
                          [&](ValueId a, ValueId b) { return module_.type(a) == module_.type(b); });
    }

    bool loop(const Instruction& at, const Context& context) {
        if (at.loop.trip_count < 0)
            return fail(at, fmt::format("its trip count is {}, below 0", at.loop.trip_count));
        if (at.loop.form > LoopForm::Unrolled) return fail(at, "its form does not exist");
        const Region& body = at.regions[0];
        for (ValueId parameter : body.parameters)
            if (index_of(parameter) >= module_.values.size())
                return fail(at, fmt::format("{} is not a value of the module", name(parameter)));
        if (body.parameters.empty() || module_.type(body.parameters[0]) != int1)
            return fail(at, "the first parameter of its region is the index, an int1");
        if (!same_types(std::span(body.parameters).subspan(1), at.operands))
            return fail(
                at, fmt::format("its region carries {}, not {} as given",
                                types(std::span(body.parameters).subspan(1)), types(at.operands)));
        if (!same_types(at.results, at.operands))
            return fail(at, fmt::format("its results are {}, not {} as carried", types(at.results),
                                        types(at.operands)));
        return region(body, {RegionKind::Loop, at.operands, context.depth + 1}, &at);
    }

    bool branch(const Instruction& at, const Context& context) {
        if (module_.type(at.operands[0]) != bool1)
            return fail(at, fmt::format("it takes bool1, not {}", types(at.operands)));
        const Context inner{RegionKind::If, at.results, context.depth + 1};
        return region(at.regions[0], inner, &at) && region(at.regions[1], inner, &at);
    }

    bool break_if(const Instruction& at, const Context& context) {
        if (at.operands.empty() || module_.type(at.operands[0]) != bool1)
            return fail(at, "its first operand is a bool1");
        const auto carried = std::span(at.operands).subspan(1);
        if (same_types(carried, context.delivered)) return true;
        return fail(at, fmt::format("it leaves the loop with {}, not {}", types(carried),
                                    types(context.delivered)));
    }

    bool terminator(const Instruction& at, const Context& context) {
        if (at.op == Op::Yield) {
            if (same_types(at.operands, context.delivered)) return true;
            return fail(at, fmt::format("it yields {}, not {}", types(at.operands),
                                        types(context.delivered)));
        }
        std::string wanted;
        bool right = at.operands.size() == module_.outputs.size();
        for (std::size_t i = 0; i < module_.outputs.size(); ++i) {
            wanted += (i == 0 ? "" : ", ") + to_string(module_.outputs[i].type);
            right = right && module_.type(at.operands[i]) == module_.outputs[i].type;
        }
        return right ||
               fail(at, fmt::format("it returns {}, but the outputs are {}", types(at.operands),
                                    wanted.empty() ? "nothing" : wanted));
    }

    const Module& module_;
    std::vector<Visibility> visibility_;
    std::optional<Diagnostic> error_;
};

}  // namespace

Status verify(const Module& module) { return Verifier(module).run(); }

}  // namespace intaglio::ir
