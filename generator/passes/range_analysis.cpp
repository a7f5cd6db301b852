// The walk.  `current_` is what a value is in the visit at hand; the facts are the union of all
// visits.  A loop that is too long to be run is entered once with what it carries widened until
// nothing grows any more.
#include "generator/passes/range_analysis.h"

#include <algorithm>
#include <cmath>

#include "generator/passes/rewrite.h"

namespace intaglio::passes {
namespace {

using namespace ir;

// Rounds of a widened loop before what still grows becomes everything.
constexpr int patient_rounds = 3;
// normalize(v): how much longer than 1 a device's roundings may leave it.
constexpr double unit_share = 0x1p-18;

class Analysis {
  public:
    Analysis(const Module& module, const Assumptions& assumptions, long affordable)
        : module_(module),
          assumptions_(assumptions),
          affordable_(affordable),
          current_(module.values.size()) {
        facts_.values.resize(module.values.size());
    }

    RangeFacts run() {
        visit(module_.body, nullptr);
        return std::move(facts_);
    }

  private:
    // Where a loop is left early.
    struct Exits {
        std::vector<Ranges> values;
        bool certain = false;   // in the last iteration that was visited
        bool unchanged = true;  // ... and only with what that iteration began with
    };

    int width(ValueId value) const { return module_.type(value).width; }
    Scalar scalar(ValueId value) const { return module_.type(value).scalar; }
    const Ranges& now(ValueId value) const { return current_[index_of(value)]; }
    const Range& now(ValueId value, int component) const {
        return now(value)[static_cast<std::size_t>(component)];
    }

    const Restriction* restriction(ValueId value) const {
        if (index_of(value) >= assumptions_.values.size()) return nullptr;
        const Restriction& all = assumptions_.values[index_of(value)];
        const bool any = std::any_of(all.begin(), all.end(),
                                     [](const auto& component) { return component.has_value(); });
        return any ? &all : nullptr;
    }

    void assign(ValueId value, Ranges ranges) {
        if (const Restriction* assumed = restriction(value))
            for (std::size_t i = 0; i < static_cast<std::size_t>(width(value)); ++i) {
                ranges[i].nan = false;
                if (!(*assumed)[i]) continue;
                const Range both = meet(ranges[i], *(*assumed)[i]);
                if (both.empty() && depth_ == 0) facts_.impossible = value;
                ranges[i] = both.empty() ? *(*assumed)[i] : both;
            }
        current_[index_of(value)] = ranges;
        Ranges& fact = facts_.values[index_of(value)];
        for (std::size_t i = 0; i < 4; ++i) fact[i] = join(fact[i], ranges[i]);
    }

    // False where a loop is certainly left before the region's end.
    bool visit(const Region& region, Exits* exits) {
        for (const Instruction& instruction : region.body) {
            switch (instruction.op) {
                case Op::Loop: visit_loop(instruction); break;
                case Op::If: visit_if(instruction); break;
                case Op::BreakIf:
                    if (visit_break(instruction, region, *exits)) return false;
                    break;
                case Op::Yield:
                case Op::Return: break;
                default:
                    definitions_.record(instruction);
                    assign(instruction.result(), evaluate(instruction));
            }
        }
        return true;
    }

    // --- control

    static void join_all(std::vector<Ranges>& into, const std::vector<Ranges>& values) {
        if (into.empty()) into.resize(values.size());
        for (std::size_t k = 0; k < values.size(); ++k)
            for (std::size_t i = 0; i < 4; ++i) into[k][i] = join(into[k][i], values[k][i]);
    }

    std::vector<Ranges> values_of(const std::vector<ValueId>& ids, std::size_t from = 0) const {
        std::vector<Ranges> values;
        for (std::size_t k = from; k < ids.size(); ++k) values.push_back(now(ids[k]));
        return values;
    }

    void visit_if(const Instruction& branch) {
        const Range condition = now(branch.operands[0], 0);
        std::vector<Ranges> results(branch.results.size());
        ++depth_;
        for (std::size_t side = 0; side < 2; ++side) {
            if (side == 0 ? condition.is_false() : condition.is_true()) continue;
            visit(branch.regions[side], nullptr);
            join_all(results, values_of(branch.regions[side].body.back().operands));
        }
        --depth_;
        for (std::size_t k = 0; k < results.size(); ++k) assign(branch.results[k], results[k]);
    }

    // True if it is certain.
    bool visit_break(const Instruction& leave, const Region& region, Exits& exits) {
        const Range condition = now(leave.operands[0], 0);
        if (condition.is_false()) return false;
        join_all(exits.values, values_of(leave.operands, 1));
        exits.unchanged &= std::equal(leave.operands.begin() + 1, leave.operands.end(),
                                      region.parameters.begin() + 1);
        exits.certain = condition.is_true();
        return exits.certain;
    }

    long cost(const Region& region) const {
        long sum = 0;
        for (const Instruction& instruction : region.body) {
            ++sum;
            for (const Region& inner : instruction.regions)
                sum += cost(inner) *
                       (instruction.op == Op::Loop ? std::max(instruction.loop.trip_count, 1) : 1);
            sum = std::min(sum, affordable_ + 1);
        }
        return sum;
    }

    // One visit of the body; what it carries on is left in `carried`.  False where it is left.
    bool iterate(const Instruction& loop, const Range& index, std::vector<Ranges>& carried,
                 Exits& exits) {
        const Region& body = loop.regions[0];
        assign(body.parameters[0], {index});
        for (std::size_t k = 0; k < carried.size(); ++k) assign(body.parameters[k + 1], carried[k]);
        exits.unchanged = true;
        if (!visit(body, &exits)) return false;
        carried = values_of(body.body.back().operands);
        return true;
    }

    void visit_loop(const Instruction& loop) {
        const int trips = loop.loop.trip_count;
        std::vector<Ranges> carried = values_of(loop.operands);
        Exits exits;
        int ran = 0;
        ++depth_;
        if (trips * cost(loop.regions[0]) <= affordable_)
            while (ran < trips && iterate(loop, Range::between(ran, ran), carried, exits)) ++ran;
        else
            ran = visit_widened(loop, carried, exits);
        --depth_;
        const int needed = ran + (exits.certain && !exits.unchanged ? 1 : 0);
        int& most = facts_.trips[loop.regions[0].parameters[0]];
        most = std::max(most, needed);
        if (!exits.certain) join_all(exits.values, carried);
        for (std::size_t k = 0; k < loop.results.size(); ++k)
            assign(loop.results[k], exits.values[k]);
    }

    // All iterations at once.  Gives how many run: none after a break in the first, or all.
    int visit_widened(const Instruction& loop, std::vector<Ranges>& carried, Exits& exits) {
        const Range index = Range::between(0, loop.loop.trip_count - 1);
        for (int round = 0;; ++round) {
            std::vector<Ranges> next = carried;
            if (!iterate(loop, index, next, exits)) {
                if (round == 0) return 0;
                exits.certain = false;  // only of what is carried from the first on
                return loop.loop.trip_count;
            }
            const std::vector<Ranges> before = carried;
            join_all(carried, next);
            if (carried == before) return loop.loop.trip_count;
            if (round < patient_rounds) continue;
            for (std::size_t k = 0; k < carried.size(); ++k)
                for (std::size_t i = 0; i < 4; ++i)
                    if (!(carried[k][i] == before[k][i]))
                        carried[k][i] = Range::everything(scalar(loop.operands[k]));
        }
    }

    // --- values

    Ranges evaluate(const Instruction& instruction) {
        const ValueId result = instruction.result();
        Ranges ranges;
        switch (info(instruction.op).type_rule) {
            case TypeRule::Leaf: return leaf(instruction);
            case TypeRule::Sample: return sample(instruction);
            case TypeRule::Compose: return compose(instruction);
            case TypeRule::Dot: return {dot(instruction)};
            case TypeRule::Cross: return cross(instruction);
            case TypeRule::Compare:
                return {ranges::compare(instruction.op, now(instruction.operands[0], 0),
                                        now(instruction.operands[1], 0))};
            case TypeRule::Logic: return {logic(instruction)};
            case TypeRule::Select: return select(instruction);
            case TypeRule::Swizzle:
                for (int i = 0; i < width(result); ++i)
                    ranges[static_cast<std::size_t>(i)] = now(
                        instruction.operands[0], instruction.lanes[static_cast<std::size_t>(i)]);
                return ranges;
            default: break;
        }
        for (int i = 0; i < width(result); ++i)
            ranges[static_cast<std::size_t>(i)] = component(instruction, i);
        if (instruction.op == Op::Mul) shorten_unit_vector(instruction, ranges);
        return ranges;
    }

    Ranges everything(ValueId value) const {
        Ranges ranges;
        std::fill_n(ranges.begin(), width(value), Range::everything(scalar(value)));
        return ranges;
    }

    Ranges leaf(const Instruction& instruction) const {
        const ValueId result = instruction.result();
        if (instruction.op != Op::Constant) return everything(result);
        Ranges ranges;
        for (std::size_t i = 0; i < static_cast<std::size_t>(width(result)); ++i)
            ranges[i] = Range::of(instruction.bits[i], scalar(result));
        return ranges;
    }

    Ranges sample(const Instruction& instruction) const {
        Ranges texel = everything(instruction.result());
        const auto slot = static_cast<std::size_t>(instruction.slot);
        if (slot >= assumptions_.samplers.size()) return texel;
        for (std::size_t i = 0; i < 4; ++i)
            if (assumptions_.samplers[slot][i]) texel[i] = *assumptions_.samplers[slot][i];
        return texel;
    }

    Ranges compose(const Instruction& instruction) const {
        Ranges ranges;
        auto next = ranges.begin();
        for (ValueId operand : instruction.operands)
            next = std::copy_n(now(operand).begin(), width(operand), next);
        return ranges;
    }

    Range dot(const Instruction& instruction) const {
        const auto [a, b] = std::pair{instruction.operands[0], instruction.operands[1]};
        Ranges products;
        for (int i = 0; i < width(a); ++i)
            products[static_cast<std::size_t>(i)] =
                a == b ? ranges::square(now(a, i)) : ranges::mul(now(a, i), now(b, i));
        return ranges::sum_of_products(products.data(), width(a));
    }

    Ranges cross(const Instruction& instruction) const {
        const auto product = [&](int i, int j) {
            return ranges::mul(now(instruction.operands[0], i), now(instruction.operands[1], j));
        };
        Ranges ranges;
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            const std::array terms = {product(j, k), ranges::neg(product(k, j))};
            ranges[static_cast<std::size_t>(i)] = ranges::sum_of_products(terms.data(), 2);
        }
        return ranges;
    }

    Range logic(const Instruction& instruction) const {
        const Range a = now(instruction.operands[0], 0);
        if (instruction.op == Op::Not) return Range::between(1 - a.most, 1 - a.least);
        const Range b = now(instruction.operands[1], 0);
        if (instruction.op == Op::And)
            return Range::between(std::min(a.least, b.least), std::min(a.most, b.most));
        return Range::between(std::max(a.least, b.least), std::max(a.most, b.most));
    }

    Ranges select(const Instruction& instruction) const {
        const Range condition = now(instruction.operands[0], 0);
        if (condition.is_true()) return now(instruction.operands[1]);
        if (condition.is_false()) return now(instruction.operands[2]);
        Ranges ranges = now(instruction.operands[1]);
        for (std::size_t i = 0; i < 4; ++i)
            ranges[i] = join(ranges[i], now(instruction.operands[2])[i]);
        return ranges;
    }

    // Component i of an op that works by component.
    Range component(const Instruction& instruction, int i) const {
        const auto operand = [&](std::size_t k) { return now(instruction.operands[k], i); };
        const Range a = operand(0);
        const Range b = instruction.operands.size() > 1 ? operand(1) : Range{};
        const Scalar kind = scalar(instruction.operands[0]);
        if (instruction.op == Op::ToFloat) {
            const auto nearest = [](double x) {
                return static_cast<double>(static_cast<float>(x));
            };
            return a.empty() ? a : Range::between(nearest(a.least), nearest(a.most));
        }
        if (kind == Scalar::Int) return ranges::whole(instruction.op, a, b);
        switch (instruction.op) {
            case Op::Add: return ranges::add(a, b);
            case Op::Sub: return ranges::sub(a, b);
            case Op::Mul:
                return instruction.operands[0] == instruction.operands[1] ? ranges::square(a)
                                                                          : ranges::mul(a, b);
            case Op::Div: return ranges::div(a, b);
            case Op::Neg: return ranges::neg(a);
            case Op::Abs: return ranges::abs(a);
            case Op::Min: return ranges::min(a, b);
            case Op::Max: return ranges::max(a, b);
            case Op::Saturate: return ranges::saturate(a);
            case Op::Floor: return ranges::floor(a);
            case Op::Frac: return ranges::frac(a);
            case Op::Sqrt: return ranges::sqrt(a);
            case Op::Rsqrt: return ranges::rsqrt(a);
            case Op::Exp2: return ranges::exp2(a);
            case Op::Log2: return ranges::log2(a);
            case Op::Pow: return ranges::pow(a, b);
            case Op::Sin:
            case Op::Cos: return ranges::turn(a);
            case Op::Lerp: return ranges::lerp(a, b, operand(2));
            case Op::Ddx:
            case Op::Ddy: return ranges::sub(a, a);
            default: break;
        }
        return Range::everything(scalar(instruction.result()));
    }

    // --- unit vectors

    // v, if the product is v * rsqrt(max(dot(v, v), tiny)), with or without the max.
    std::optional<ValueId> normalized(const Instruction& product) const {
        for (std::size_t k = 0; k < 2; ++k) {
            const ValueId vector = product.operands[k];
            const Definition* factor = &definitions_[product.operands[1 - k]];
            if (factor->op == Op::Swizzle) factor = &definitions_[factor->operands[0]];
            if (factor->op != Op::Rsqrt || width(vector) < 2) continue;
            const Definition* square = &definitions_[factor->operands[0]];
            if (square->op == Op::Max)
                for (ValueId operand : square->operand_span())
                    if (definitions_[operand].op == Op::Dot) {
                        square = &definitions_[operand];
                        break;
                    }
            if (square->op == Op::Dot && square->operands[0] == vector &&
                square->operands[1] == vector)
                return vector;
        }
        return {};
    }

    // No component of a unit vector is longer than 1, nor than the others leave of it.  A vector
    // that holds NaN has a dot of NaN, which the max turns into tiny: its other components may be
    // anything.  An infinite one comes out NaN.  So the vector must be known to be neither, or the
    // result to be no NaN.
    void shorten_unit_vector(const Instruction& product, Ranges& ranges) const {
        const std::optional<ValueId> vector = normalized(product);
        if (!vector) return;
        const Restriction* assumed = restriction(product.result());
        const auto count = static_cast<std::size_t>(width(*vector));
        for (std::size_t i = 0; i < count && assumed == nullptr; ++i) {
            const Range& range = now(*vector)[i];
            if (range.nan || std::isinf(range.least) || std::isinf(range.most)) return;
        }
        constexpr double longest = 1 + unit_share;
        std::array<double, 4> least{};  // of each component's square
        double sum = 0;
        for (std::size_t i = 0; i < count; ++i) {
            ranges[i].nan = false;
            ranges[i] = meet(ranges[i], Range::between(-longest, longest));
            Range known = ranges[i];
            if (assumed != nullptr && (*assumed)[i]) known = meet(known, *(*assumed)[i]);
            const double size = known.empty() ? 0 : ranges::abs(known).least;
            least[i] = size * size;
            sum += least[i];
        }
        for (std::size_t i = 0; i < count; ++i) {
            const double rest = longest * longest - (sum - least[i]);
            const auto most = static_cast<double>(
                std::nextafter(static_cast<float>(std::sqrt(std::max(rest, 0.0))), 2.0f));
            ranges[i] = meet(ranges[i], Range::between(-most, most));
        }
    }

    const Module& module_;
    const Assumptions& assumptions_;
    const long affordable_;
    std::vector<Ranges> current_;
    Definitions definitions_;
    RangeFacts facts_;
    int depth_ = 0;  // of loops and ifs
};

}  // namespace

RangeFacts analyze_ranges(const ir::Module& module, const Assumptions& assumptions,
                          long affordable) {
    return Analysis(module, assumptions, affordable).run();
}

}  // namespace intaglio::passes
