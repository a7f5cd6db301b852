// Comparisons have no result of their own in these profiles: a truth value is a number whose sign
// decides, `cmp` takes it as it is, and the difference of the operands is one addition.  `and` is
// the smaller of two such numbers, `or` the greater.
#include "generator/target/d3d9/generate/lower.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <tuple>

#include <fmt/format.h>

#include "generator/passes/rewrite.h"
#include "generator/target/d3d9/limits.h"

namespace intaglio::d3d9 {
namespace {

// A component and its sign.
struct Ref {
    Lane lane;
    bool negate = false;
    friend bool operator==(const Ref&, const Ref&) = default;
};
using Vec = std::vector<Ref>;

// True where `gap` >= 0, or where it is not if inverted.
struct Truth {
    Ref gap;
    bool inverted = false;
};

class Lowering {
  public:
    Lowering(const ir::Module& module, Profile profile, std::vector<std::string>& notes)
        : module_(module), profile_(profile), notes_(notes) {}

    Result<Graph> run() {
        values_.resize(module_.values.size());
        truths_.resize(module_.values.size());
        for (const ir::Instruction& instruction : module_.body.body) {
            origin_ = instruction.origin;
            if (instruction.op == ir::Op::Return) {
                finish(instruction);
                break;
            }
            if (const Status status = lower(instruction); !status) return status.error();
        }
        return std::move(graph_);
    }

  private:
    const Vec& value(ir::ValueId id) const { return values_[ir::index_of(id)]; }
    const Truth& truth(ir::ValueId id) const { return truths_[ir::index_of(id)]; }

    Ref constant(float number) {
        const auto bits = std::bit_cast<std::uint32_t>(number);
        const auto [found, added] = constants_.try_emplace(bits, 0);
        if (added) {
            Node node;
            node.kind = Node::Kind::Constant;
            node.bits = bits;
            found->second = add(std::move(node));
        }
        return {{found->second, 0}, false};
    }
    std::optional<float> number_of(Ref ref) const {
        const Node& node = graph_.node(ref.lane);
        if (node.kind != Node::Kind::Constant) return std::nullopt;
        const float number = std::bit_cast<float>(node.bits);
        return ref.negate ? -number : number;
    }
    bool is(Ref ref, float number) const { return number_of(ref) == number; }

    int add(Node node) {
        graph_.nodes.push_back(std::move(node));
        return static_cast<int>(graph_.nodes.size()) - 1;
    }

    // One sign for all components: constants take theirs in, others get a mov.
    Operand operand(Vec refs) {
        for (Ref& ref : refs)
            if (ref.negate && number_of(ref)) ref = constant(*number_of(ref));
        const auto signless = [&](const Ref& ref) { return number_of(ref).has_value(); };
        const bool any = std::any_of(refs.begin(), refs.end(), [](Ref r) { return r.negate; });
        const bool mixed = any && std::any_of(refs.begin(), refs.end(),
                                              [&](Ref r) { return !r.negate && !signless(r); });
        Operand result;
        result.negate = any && !mixed;
        for (Ref ref : refs) {
            if (mixed && ref.negate) ref = emit(Opcode::Mov, {{ref}})[0];
            if (result.negate && signless(ref)) ref = constant(-*number_of(ref));
            result.lanes.push_back(ref.lane);
        }
        return result;
    }

    // A componentwise instruction; equal components are computed once, and equal instructions are
    // one.
    Vec emit(Opcode op, const std::vector<Vec>& operands, bool saturate = false) {
        const std::size_t width = operands[0].size();
        std::vector<std::vector<Ref>> columns;
        std::vector<int> column_of;
        for (std::size_t k = 0; k < width; ++k) {
            std::vector<Ref> column;
            for (const Vec& refs : operands) column.push_back(refs[k]);
            const auto found = std::find(columns.begin(), columns.end(), column);
            column_of.push_back(static_cast<int>(found - columns.begin()));
            if (found == columns.end()) columns.push_back(std::move(column));
        }
        Node node;
        node.op = op;
        node.saturate = saturate;
        node.width = static_cast<int>(columns.size());
        for (std::size_t s = 0; s < operands.size(); ++s) {
            Vec refs;
            for (const auto& column : columns) refs.push_back(column[s]);
            node.operands.push_back(operand(std::move(refs)));
        }
        const int index = unique(std::move(node));
        Vec result;
        for (const int column : column_of) result.push_back({{index, column}, false});
        return result;
    }
    Ref emit_one(Opcode op, std::vector<Vec> operands, int width = 1) {
        Node node;
        node.op = op;
        node.width = width;
        for (Vec& refs : operands) node.operands.push_back(operand(std::move(refs)));
        return {{unique(std::move(node)), 0}, false};
    }
    Vec emit_scalars(Opcode op, const Vec& refs) {
        Vec result;
        for (const Ref ref : refs) result.push_back(emit_one(op, {{ref}}));
        return result;
    }

    int unique(Node node) {
        node.origin = origin_;
        const auto key =
            std::make_tuple(node.op, node.saturate, node.slot, node.width, node.operands);
        const auto [found, added] = seen_.try_emplace(key, 0);
        if (added) found->second = add(std::move(node));
        return found->second;
    }

    static Vec negated(Vec refs) {
        for (Ref& ref : refs) ref.negate = !ref.negate;
        return refs;
    }
    bool all(const Vec& refs, float number) const {
        return std::all_of(refs.begin(), refs.end(), [&](Ref ref) { return is(ref, number); });
    }
    Vec sum(const Vec& a, const Vec& b) {
        if (all(a, 0)) return b;
        if (all(b, 0)) return a;
        return emit(Opcode::Add, {a, b});
    }
    Vec product(const Vec& a, const Vec& b) {
        if (all(a, 1)) return b;
        if (all(b, 1)) return a;
        if (all(a, -1)) return negated(b);
        if (all(b, -1)) return negated(a);
        return emit(Opcode::Mul, {a, b});
    }
    Vec repeated(float number, std::size_t width) { return Vec(width, constant(number)); }

    Vec power(const Vec& base, const Vec& exponent) {
        // As many multiplications as log, mul and exp would take, or fewer.
        if (all(exponent, 1)) return base;
        if (all(exponent, 2)) return product(base, base);
        if (all(exponent, 3)) return product(product(base, base), base);
        if (all(exponent, 4) || all(exponent, 8)) {
            Vec square = product(base, base);
            square = product(square, square);
            return all(exponent, 8) ? product(square, square) : square;
        }
        return emit_scalars(Opcode::Exp, product(emit_scalars(Opcode::Log, base), exponent));
    }

    Vec lerp(const Vec& a, const Vec& b, const Vec& c) {
        return sum(product(c, sum_folded(b, negated(a))), a);
    }
    Vec sum_folded(const Vec& a, const Vec& b) {
        Vec result;
        for (std::size_t k = 0; k < a.size(); ++k) {
            const auto x = number_of(a[k]), y = number_of(b[k]);
            if (!x || !y) return sum(a, b);
            result.push_back(constant(*x + *y));
        }
        return result;
    }

    Vec dot(const Vec& a, const Vec& b) {
        if (a.size() == 3) return {emit_one(Opcode::Dp3, {a, b})};
        if (a.size() == 4) return {emit_one(Opcode::Dp4, {a, b})};
        Vec result = product({a[0]}, {b[0]});
        for (std::size_t k = 1; k < a.size(); ++k) result = sum(product({a[k]}, {b[k]}), result);
        return result;
    }
    Vec cross(const Vec& a, const Vec& b) {
        const auto turn = [](const Vec& v, int by) {
            const auto at = [&](int k) { return v[static_cast<std::size_t>((k + by) % 3)]; };
            return Vec{at(0), at(1), at(2)};
        };
        return sum(product(turn(a, 1), turn(b, 2)), negated(product(turn(a, 2), turn(b, 1))));
    }

    Truth compare(ir::Op op, const Vec& a, const Vec& b) {
        const auto difference = [&](const Vec& x, const Vec& y) {
            return sum_folded(x, negated(y))[0];
        };
        switch (op) {
            case ir::Op::GreaterEqual: return {difference(a, b), false};
            case ir::Op::Less: return {difference(a, b), true};
            case ir::Op::LessEqual: return {difference(b, a), false};
            case ir::Op::Greater: return {difference(b, a), true};
            default: break;
        }
        Ref distance = emit(Opcode::Abs, {{difference(a, b)}})[0];
        distance.negate = true;
        return {distance, op == ir::Op::NotEqual};
    }
    // The same truth, with this sense.
    Ref gap(const Truth& t, bool inverted) {
        if (t.inverted == inverted) return t.gap;
        return emit(Opcode::Cmp, {{t.gap}, {constant(-1)}, {constant(1)}})[0];
    }
    Truth both(const Truth& a, const Truth& b, bool smaller) {
        const bool inverted = a.inverted;
        const Opcode op = smaller != inverted ? Opcode::Min : Opcode::Max;
        return {emit(op, {{gap(a, inverted)}, {gap(b, inverted)}})[0], inverted};
    }
    Vec select(const Truth& condition, Vec yes, Vec no) {
        if (const auto number = number_of(condition.gap))
            return (*number >= 0) != condition.inverted ? yes : no;
        if (condition.inverted) std::swap(yes, no);
        return emit(Opcode::Cmp, {Vec(yes.size(), condition.gap), yes, no});
    }

    Status lower(const ir::Instruction& instruction);
    Result<Vec> sample(const ir::Instruction& instruction);
    Result<Vec> lower_arithmetic(const ir::Instruction& instruction);
    Vec leaf(const ir::Instruction& instruction);
    Status lower_truth(const ir::Instruction& instruction);

    void finish(const ir::Instruction& instruction) {
        if (is_pixel(profile_)) graph_.output_kinds = output_kinds_of(module_);
        for (std::size_t k = 0; k < instruction.operands.size(); ++k) {
            Vec refs = value(instruction.operands[k]);
            const bool colour = graph_.kind_of_output(k) == OutputKind::Colour;
            while (is_pixel(profile_) && colour && refs.size() < 4)
                refs.push_back(constant(refs.size() == 3 ? 1.0f : 0.0f));
            graph_.outputs.push_back(operand(refs));
            Operand& output = graph_.outputs.back();
            if (!output.negate || !is_pixel(profile_)) continue;
            Node node;  // none of them takes a sign
            node.width = static_cast<int>(output.lanes.size());
            node.operands = {output};
            const int index = unique(std::move(node));
            for (std::size_t c = 0; c < output.lanes.size(); ++c)
                output.lanes[c] = {index, static_cast<int>(c)};
            output.negate = false;
        }
    }

    Diagnostic refusal(std::string code, const ir::Instruction& instruction,
                       std::string_view what) {
        const std::string place = passes::place_of(module_, instruction.origin);
        return input_error(std::move(code),
                           fmt::format("{}{}{}", place, place.empty() ? "" : ": ", what));
    }

    const ir::Module& module_;
    Profile profile_;
    std::vector<std::string>& notes_;
    Graph graph_;
    ir::Origin origin_;
    std::vector<Vec> values_;
    std::vector<Truth> truths_;
    std::map<std::uint32_t, int> constants_;
    std::map<std::tuple<Opcode, bool, int, int, std::vector<Operand>>, int> seen_;
    std::map<std::tuple<int, int, int>, int> leaves_;
};

Vec Lowering::leaf(const ir::Instruction& instruction) {
    const int width = module_.type(instruction.result()).width;
    Vec refs;
    if (instruction.op == ir::Op::Constant) {
        const ir::Scalar scalar = module_.type(instruction.result()).scalar;
        for (int k = 0; k < width; ++k) {
            const std::uint32_t bits = instruction.bits[static_cast<std::size_t>(k)];
            refs.push_back(constant(scalar == ir::Scalar::Float
                                        ? std::bit_cast<float>(bits)
                                        : static_cast<float>(static_cast<std::int32_t>(bits))));
        }
        return refs;
    }
    const bool input = instruction.op == ir::Op::Input;
    const auto key = std::make_tuple(input ? 0 : 1, instruction.slot, instruction.element);
    const auto [found, added] = leaves_.try_emplace(key, 0);
    if (added) {
        Node node;
        node.kind = input ? Node::Kind::Input : Node::Kind::Uniform;
        node.width = width;
        node.slot = instruction.slot;
        node.element = instruction.element;
        found->second = add(std::move(node));
    }
    for (int k = 0; k < width; ++k) refs.push_back({{found->second, k}, false});
    return refs;
}

Result<Vec> Lowering::sample(const ir::Instruction& instruction) {
    const ir::Sampler& sampler = module_.samplers[static_cast<std::size_t>(instruction.slot)];
    std::vector<Vec> operands = {value(instruction.operands[0])};
    Opcode op = Opcode::Texld;
    if (instruction.op == ir::Op::SampleLevel) {
        const Ref level = value(instruction.operands[1])[0];
        if (limits_of(profile_).model_3()) {
            op = Opcode::Texldl;
            while (operands[0].size() < 3) operands[0].push_back(constant(0));
            operands[0].push_back(level);
        } else if (!is(level, 0)) {
            return refuse_level(module_, instruction, profile_);
        } else {
            notes_.push_back(
                fmt::format("{} is read by texld, at the level of the coordinate's "
                            "derivatives, where the source says level 0: give it one "
                            "level, or set its greatest level to 0.",
                            sampler.name));
        }
    } else if (instruction.op == ir::Op::SampleGrad) {
        op = Opcode::Texldd;
        operands.push_back(value(instruction.operands[1]));
        operands.push_back(value(instruction.operands[2]));
    }
    Node node;
    node.op = op;
    node.width = 4;
    node.slot = instruction.slot;
    for (Vec& refs : operands) node.operands.push_back(operand(std::move(refs)));
    const int index = unique(std::move(node));
    return Vec{{{index, 0}}, {{index, 1}}, {{index, 2}}, {{index, 3}}};
}

Result<Vec> Lowering::lower_arithmetic(const ir::Instruction& instruction) {
    std::vector<Vec> v;
    for (const ir::ValueId id : instruction.operands) v.push_back(value(id));
    using enum ir::Op;
    switch (instruction.op) {
        case Add: return sum(v[0], v[1]);
        case Sub: return sum(v[0], negated(v[1]));
        case Mul: return product(v[0], v[1]);
        case Div: return product(v[0], emit_scalars(Opcode::Rcp, v[1]));
        case Neg: return negated(v[0]);
        case Abs: return emit(Opcode::Abs, {v[0]});
        case Min: return emit(Opcode::Min, {v[0], v[1]});
        case Max: return emit(Opcode::Max, {v[0], v[1]});
        case Saturate: return emit(Opcode::Mov, {v[0]}, true);
        case Floor: return sum(v[0], negated(emit(Opcode::Frc, {v[0]})));
        case Frac: return emit(Opcode::Frc, {v[0]});
        case Rsqrt: return emit_scalars(Opcode::Rsq, v[0]);
        case Sqrt:  // the root of 0 must not pass through rsq(0)
            return product(v[0],
                           emit_scalars(Opcode::Rsq,
                                        emit(Opcode::Max, {v[0], repeated(1e-18f, v[0].size())})));
        case Exp2: return emit_scalars(Opcode::Exp, v[0]);
        case Log2: return emit_scalars(Opcode::Log, v[0]);
        case Pow: return power(v[0], v[1]);
        case Lerp: return lerp(v[0], v[1], v[2]);
        case Dot: return dot(v[0], v[1]);
        case Cross: return cross(v[0], v[1]);
        case ToFloat: return v[0];
        case Ddx:
        case Ddy:
            if (profile_ != Profile::ps_2_a && profile_ != Profile::ps_3_0)
                return refusal(
                    "d3d9-op", instruction,
                    fmt::format("{} has no derivatives; use ps_2_a or ps_3_0", name_of(profile_)));
            {
                // Its operand is placed like a sum of componentwise operands, so the op is one too.
                Node node;
                node.op = instruction.op == Ddx ? Opcode::Dsx : Opcode::Dsy;
                node.width = static_cast<int>(v[0].size());
                node.operands.push_back(operand(v[0]));
                const int index = unique(std::move(node));
                Vec result;
                for (int k = 0; k < static_cast<int>(v[0].size()); ++k)
                    result.push_back({{index, k}});
                return result;
            }
        default:
            return refusal("d3d9-op", instruction,
                           fmt::format("{} has no instructions for {}", name_of(profile_),
                                       ir::info(instruction.op).name));
    }
}

Status Lowering::lower_truth(const ir::Instruction& instruction) {
    const auto t = [&](int k) { return truth(instruction.operands[static_cast<std::size_t>(k)]); };
    Truth& result = truths_[ir::index_of(instruction.result())];
    switch (instruction.op) {
        case ir::Op::Constant:
            result = {constant(instruction.bits[0] != 0 ? 1.0f : -1.0f), false};
            break;
        case ir::Op::And: result = both(t(0), t(1), true); break;
        case ir::Op::Or: result = both(t(0), t(1), false); break;
        case ir::Op::Not: result = {t(0).gap, !t(0).inverted}; break;
        case ir::Op::Select: {
            const bool inverted = t(1).inverted;
            result = {select(t(0), {gap(t(1), inverted)}, {gap(t(2), inverted)})[0], inverted};
            break;
        }
        default: {
            if (ir::info(instruction.op).type_rule != ir::TypeRule::Compare)
                return refusal("d3d9-op", instruction,
                               fmt::format("{} has no truth values from {}", name_of(profile_),
                                           ir::info(instruction.op).name));
            result = compare(instruction.op, value(instruction.operands[0]),
                             value(instruction.operands[1]));
        }
    }
    return Done{};
}

Status Lowering::lower(const ir::Instruction& instruction) {
    if (instruction.results.size() != 1)
        return refusal("d3d9-op", instruction,
                       fmt::format("{} remains after unrolling and flattening",
                                   ir::info(instruction.op).name));
    const ir::ValueId result = instruction.result();
    if (module_.type(result).scalar == ir::Scalar::Bool) return lower_truth(instruction);
    Vec& target = values_[ir::index_of(result)];
    switch (instruction.op) {
        case ir::Op::Constant:
        case ir::Op::Input:
        case ir::Op::Uniform: target = leaf(instruction); return Done{};
        case ir::Op::Compose:
            for (const ir::ValueId id : instruction.operands)
                target.insert(target.end(), value(id).begin(), value(id).end());
            return Done{};
        case ir::Op::Swizzle:
            for (int k = 0; k < module_.type(result).width; ++k)
                target.push_back(
                    value(instruction.operands[0])[instruction.lanes[static_cast<std::size_t>(k)]]);
            return Done{};
        case ir::Op::Select:
            target = select(truth(instruction.operands[0]), value(instruction.operands[1]),
                            value(instruction.operands[2]));
            return Done{};
        default: break;
    }
    Result<Vec> refs =
        ir::is_sample(instruction.op) ? sample(instruction) : lower_arithmetic(instruction);
    if (!refs) return refs.error();
    target = std::move(*refs);
    return Done{};
}

}  // namespace

std::vector<OutputKind> output_kinds_of(const ir::Module& module) {
    std::vector<OutputKind> kinds;
    for (const ir::Declaration& output : module.outputs)
        kinds.push_back(output.semantic == ir::Semantic::Depth  ? OutputKind::Depth
                        : output.semantic == ir::Semantic::Clip ? OutputKind::Kill
                                                                : OutputKind::Colour);
    return kinds;
}

Result<Graph> lower(const ir::Module& module, Profile profile, std::vector<std::string>& notes) {
    auto graph = Lowering(module, profile, notes).run();
    if (!graph) return graph;
    std::sort(notes.begin(), notes.end());
    notes.erase(std::unique(notes.begin(), notes.end()), notes.end());
    if (is_pixel(profile)) graph->inputs = interpolant_places(module, profile);
    simplify(*graph);
    return graph;
}

}  // namespace intaglio::d3d9
