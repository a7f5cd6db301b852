// The first hit is in iteration h, or there is none and h is the number of iterations.  A key is a
// number for each h that falls as h grows and ends at or above +0; a missed gap is below zero, or
// NaN, which max ignores, so that the gap itself can stand for "no key".
#include "generator/passes/lower_first_hit.h"

#include <bit>
#include <cmath>
#include <optional>

#include "generator/passes/any_hit.h"
#include "generator/passes/first_hit_loop.h"
#include "generator/passes/rewrite.h"

namespace intaglio::passes {
namespace {

using namespace ir;

// A value known for each h.
using Table = std::vector<ConstantBits>;
constexpr int most_special_iterations =
    2;  // whose results are not functions of h, from the first on
constexpr std::size_t register_width = 4;

constexpr float free_distance = 0x1p-22f;  // Rounding::Free
float as_float(const ConstantBits& bits) { return std::bit_cast<float>(bits[0]); }

bool is_key(const Table& table) {
    for (std::size_t h = 0; h + 1 < table.size(); ++h)
        if (!(as_float(table[h]) > as_float(table[h + 1]))) return false;
    return std::isfinite(as_float(table.front())) && !std::signbit(as_float(table.back()));
}

class Lowering {
  public:
    // `uses`: how often each value is an operand before the rewriting.
    Lowering(Module& module, const Definitions& definitions, const FirstHitLoop& search,
             const std::vector<int>& uses, Rounding rounding)
        : module_(module),
          definitions_(definitions),
          search_(search),
          uses_(uses),
          rounding_(rounding) {}

    // The code that takes the loop's place and the values of its results (those that are used);
    // false if no key allows it.
    bool run() {
        if (!has_few_special_iterations()) return false;
        for (int i = 0; i < search_.trips(); ++i) conditions_.push_back(at(search_.condition(), i));
        const State conditions_only = state();
        std::optional<std::size_t> best;
        const std::vector<Table> keys = candidate_keys();
        int least = 0;
        for (std::size_t i = 0; i < keys.size(); ++i) {
            restore(conditions_only);
            if (!emit(keys[i])) continue;
            const int cost = lanes_computed();
            if (best && cost >= least) continue;
            best = i;
            least = cost;
        }
        restore(conditions_only);
        return best && emit(keys[*best]);
    }

    // As run(), for a search that is only asked whether it hits; results() are then those after the
    // last iteration, and the truths' values come in order.
    std::vector<ValueId> run_any_hit(const AnyHit& any) {
        std::vector<ValueId> gaps;
        for (int i = 0; i <= search_.trips(); ++i)
            gaps.push_back(op(Op::Sub, {at(any.hit.greater, i), at(any.hit.lesser, i)}));
        if (any.stop && (rounding_ == Rounding::Exact ||
                         !is_above_texels(module_, definitions_, search_, any))) {
            const ValueId no_hit = constant(ConstantBits{float_bits(-1.0f), 0, 0, 0});
            std::vector<ValueId> stops;
            for (int i = 0; i < search_.trips(); ++i) stops.push_back(at(*any.stop, i));
            for (std::size_t i = 0; i < stops.size(); ++i)
                gaps[i + 1] = select(stops[i], no_hit, gaps[i + 1]);
        }
        const ValueId most = greatest(std::move(gaps)), zero = constant(ConstantBits{});
        std::vector<ValueId> truths;
        for (const Truth& truth : any.truths) {
            const Op hit = any.hit.strict ? Op::Greater : Op::GreaterEqual;
            const Op miss = any.hit.strict ? Op::LessEqual : Op::Less;
            truths.push_back(op(truth.of_hit ? hit : miss, {most, zero}));
        }
        for (std::size_t k = 0; k < result_count(); ++k)
            results_.push_back(at(search_.next_value(k), search_.trips() - 1));
        return truths;
    }

    std::vector<Instruction>& code() { return code_; }
    const std::vector<std::optional<ValueId>>& results() const { return results_; }

  private:
    using Place = std::pair<ValueId, int>;
    struct State {
        std::size_t code, values;
        std::map<Place, ValueId> copies;
    };

    State state() const { return {code_.size(), module_.values.size(), copies_}; }
    void restore(const State& state) {
        code_.resize(state.code);
        module_.values.resize(state.values);
        copies_ = state.copies;
        at_hit_.clear();
        results_.clear();
    }

    int lanes_computed() const {
        int lanes = 0;
        for (const Instruction& instruction : code_)
            if (!is_leaf(instruction.op) && instruction.op != Op::Compose &&
                instruction.op != Op::Swizzle)
                lanes += module_.type(instruction.result()).width;
        return lanes;
    }

    bool is_used(std::size_t k) const { return uses_[index_of(search_.loop().results[k])] > 0; }
    std::size_t result_count() const { return search_.loop().results.size(); }
    // The result in iteration h is the carried value there, also after the last.
    bool is_carried(std::size_t k) const { return search_.parameter(search_.exit_value(k)) == k; }

    bool has_few_special_iterations() const {
        for (std::size_t k = 0; k < result_count(); ++k) {
            if (!is_used(k)) continue;
            const int first = search_.valid_from(search_.exit_value(k));
            if (first > most_special_iterations || first > search_.trips()) return false;
        }
        return true;
    }

    // --- keys

    // The tables of the floats that the loop computes, and the number of iterations left.
    std::vector<Table> candidate_keys() const {
        std::vector<Table> keys;
        const auto consider = [&](ValueId value) {
            if (module_.type(value) != float1) return;
            for (int back = 0; back <= most_special_iterations; ++back)
                if (auto table = table_of(value, back)) {
                    if (is_same(as_float(table->back()), 0)) table->back() = {};
                    if (is_key(*table)) keys.push_back(*table);
                }
        };
        for (const Instruction& instruction : search_.body())
            for (ValueId result : instruction.results) consider(result);
        Table left;
        for (int h = 0; h <= search_.trips(); ++h)
            left.push_back({float_bits(static_cast<float>(search_.trips() - h)), 0, 0, 0});
        keys.push_back(left);
        return keys;
    }

    // The value `back` iterations before h, for each h.
    std::optional<Table> table_of(ValueId value, int back) const {
        Table table;
        for (int h = 0; h <= search_.trips(); ++h) {
            const auto bits = search_.constant_at(value, h - back);
            if (!bits) return std::nullopt;
            table.push_back(*bits);
        }
        return table;
    }

    // --- one key: the loop's code and results

    bool emit(const Table& key) {
        key_table_ = key;
        key_ = greatest_key();
        for (std::size_t k = 0; k < result_count(); ++k) {
            std::optional<ValueId> result;
            if (is_used(k)) {
                result = result_at_hit(k);
                if (!result) return false;
            }
            results_.push_back(result);
        }
        return true;
    }

    // The function of h, but for no hit and for the first iterations where these are special.
    std::optional<ValueId> result_at_hit(std::size_t k) {
        const ValueId value = search_.exit_value(k);
        std::optional<ValueId> result = at_hit(value, 0);
        if (!result) return std::nullopt;
        if (!is_carried(k)) {
            const ValueId missed = op(Op::LessEqual, {key_, constant(key_table_.back())});
            result = select(missed, at(search_.next_value(k), search_.trips() - 1), *result);
        }
        for (int i = search_.valid_from(value); i-- > 0;)
            result = select(conditions_[static_cast<std::size_t>(i)], special(value, i), *result);
        return result;
    }

    // The value in an iteration, given that the hit is there.
    ValueId special(ValueId value, int i) {
        const auto k = search_.parameter(value);
        if (rounding_ == Rounding::Exact || i > 0 || !k) return at(value, i);
        return told_by_hit(search_.initial_value(*k)).value_or(at(value, i));
    }
    // A value from before the loop, computed from those that are what they are at a hit in the
    // first iteration; nothing if it has none of them.
    std::optional<ValueId> told_by_hit(ValueId outside) {
        const Definition& definition = definitions_[outside];
        if (!is_arithmetic(definition.op) || definition.op == Op::Constant) return std::nullopt;
        for (std::size_t k = 0; k < result_count(); ++k) {
            const ValueId parameter = search_.loop().regions[0].parameters[k + 1];
            if (search_.initial_value(k) != outside || search_.valid_from(parameter) > 0) continue;
            const auto found = at_hit_.find({parameter, 0});
            if (found != at_hit_.end()) return found->second;
        }
        if (is_leaf(definition.op)) return std::nullopt;
        std::vector<ValueId> operands;
        bool any = false;
        for (const ValueId operand : definition.operand_span()) {
            const auto told = told_by_hit(operand);
            any = any || told;
            operands.push_back(told.value_or(operand));
        }
        if (!any) return std::nullopt;
        Instruction copy = make_instruction(module_, definition.op, module_.type(outside), operands,
                                            search_.exit_origin());
        copy.lanes = definition.lanes;
        return append(std::move(copy));
    }

    ValueId greatest_key() {
        std::vector<ValueId> gaps;
        for (int i = 0; i < search_.trips(); ++i) {
            const auto gap = gap_of(search_.condition(), i);
            gaps.push_back(gap ? *gap : constant(key_table_.back()));
        }
        std::vector<ValueId> keys;
        for (std::size_t i = 0; i < gaps.size(); ++i) keys.push_back(constant(key_table_[i]));
        for (std::size_t i = 0; i < gaps.size(); ++i)
            keys[i] = select(conditions_[i], keys[i], gaps[i]);
        const ValueId most = greatest(std::move(keys));
        if (as_float(key_table_.front()) <= 1.0f && key_table_.back()[0] == 0)
            return op(Op::Saturate, {most});
        return op(Op::Max, {most, constant(key_table_.back())});
    }

    ValueId greatest(std::vector<ValueId> lanes) {
        std::size_t width = std::min(register_width, lanes.size());
        for (std::size_t first = width; first < lanes.size(); first += width)
            for (std::size_t i = first; i < std::min(first + width, lanes.size()); ++i)
                lanes[i - first] = op(Op::Max, {lanes[i - first], lanes[i]});
        for (; width > 1; width = (width + 1) / 2)
            for (std::size_t i = 0; i < width / 2; ++i)
                lanes[i] = op(Op::Max, {lanes[i], lanes[width - 1 - i]});
        return lanes[0];
    }

    // What is at most zero, or NaN, where the condition does not hold in iteration i: a is below b
    // just where a - b is below zero, but for denormals.
    std::optional<ValueId> gap_of(ValueId condition, int i) {
        if (!search_.is_inside(condition) || search_.parameter(condition)) return std::nullopt;
        const Instruction& compare = search_.instruction(condition);
        std::vector<ValueId> sides = compare.operands;
        if (compare.op == Op::Or) {
            const auto gap = gap_of(sides[0], i);  // neither holds, so that one's will do
            return gap ? gap : gap_of(sides[1], i);
        }
        if (compare.op == Op::Less || compare.op == Op::LessEqual)
            std::swap(sides[0], sides[1]);
        else if (compare.op != Op::Greater && compare.op != Op::GreaterEqual)
            return std::nullopt;
        if (module_.type(sides[0]).scalar != Scalar::Float) return std::nullopt;
        const auto zero = search_.constant_at(sides[1], i);
        if (zero && as_float(*zero) == 0.0f) return at(sides[0], i);
        return op(Op::Sub, {at(sides[0], i), at(sides[1], i)});
    }

    // --- values in a known iteration

    ValueId at(ValueId value, int iteration) {
        if (!search_.is_inside(value)) return value;
        const auto found = copies_.find({value, iteration});
        if (found != copies_.end()) return found->second;
        const ValueId copy = copy_at(value, iteration);
        copies_[{value, iteration}] = copy;
        return copy;
    }

    ValueId copy_at(ValueId value, int iteration) {
        if (const auto bits = search_.constant_at(value, iteration))
            return constant(module_.type(value), *bits);
        if (const auto k = search_.parameter(value))
            return iteration == 0 ? search_.initial_value(*k)
                                  : at(search_.next_value(*k), iteration - 1);
        std::vector<ValueId> operands;
        for (ValueId operand : search_.instruction(value).operands)
            operands.push_back(at(operand, iteration));
        return copy_of(search_.instruction(value), std::move(operands));
    }

    // --- values at the hit

    // The value `back` iterations before h, computed from the key.
    std::optional<ValueId> at_hit(ValueId value, int back) {
        if (!search_.is_inside(value)) return value;
        const auto found = at_hit_.find({value, back});
        if (found != at_hit_.end()) return found->second;
        const std::optional<ValueId> made = make_at_hit(value, back);
        if (made) at_hit_[{value, back}] = *made;
        return made;
    }

    std::optional<ValueId> make_at_hit(ValueId value, int back) {
        if (module_.type(value) == float1)
            if (const auto table = table_of(value, back))
                if (const auto found = from_key(*table)) return found;
        if (const auto k = search_.parameter(value))
            return at_hit(search_.next_value(*k), back + 1);
        if (search_.is_index(value)) return std::nullopt;
        const Instruction& computed = search_.instruction(value);
        std::vector<ValueId> operands;
        for (ValueId operand : computed.operands) {
            const auto operand_at_hit = at_hit(operand, back);
            if (!operand_at_hit) return std::nullopt;
            operands.push_back(*operand_at_hit);
        }
        return copy_of(computed, std::move(operands));
    }

    // A constant, the key, or one op on it that gives the table's bits for each h.
    std::optional<ValueId> from_key(const Table& table) {
        const auto equals = [&](auto&& computed) {
            for (std::size_t h = 0; h < table.size(); ++h)
                if (computed(h) != table[h][0] &&
                    !is_same(std::bit_cast<float>(computed(h)), as_float(table[h])))
                    return false;
            return true;
        };
        if (equals([&](std::size_t) { return table[0][0]; })) return constant(table[0]);
        if (equals([&](std::size_t h) { return key_table_[h][0]; })) return key_;
        for (std::size_t h : {std::size_t{0}, table.size() / 2, table.size() - 1}) {
            const ConstantBits &value = table[h], &key = key_table_[h];
            const ConstantBits sum = compute(Op::Add, value, key);
            if (equals([&](std::size_t i) { return compute(Op::Sub, sum, key_table_[i])[0]; }))
                return op(Op::Sub, {constant(sum), key_});
            const ConstantBits shift = compute(Op::Sub, value, key);
            if (equals([&](std::size_t i) { return compute(Op::Add, key_table_[i], shift)[0]; }))
                return op(Op::Add, {key_, constant(shift)});
            const ConstantBits ratio = compute(Op::Div, value, key);
            if (equals([&](std::size_t i) { return compute(Op::Mul, key_table_[i], ratio)[0]; }))
                return op(Op::Mul, {key_, constant(ratio)});
        }
        return std::nullopt;
    }

    // Other numbers that count as the same.
    bool is_same(float a, float b) const {
        return rounding_ == Rounding::Free && std::fabs(a - b) <= free_distance;
    }

    static ConstantBits compute(Op op, const ConstantBits& a, const ConstantBits& b) {
        Instruction instruction;
        instruction.op = op;
        instruction.operands.resize(2);
        return *evaluate_op(instruction, std::array{float1, float1}, std::array{a, b});
    }

    // --- instructions

    ValueId append(Instruction instruction) {
        code_.push_back(std::move(instruction));
        return code_.back().result();
    }
    ValueId constant(Type type, const ConstantBits& bits) {
        return append(make_constant(module_, type, bits, search_.loop().origin));
    }
    ValueId constant(const ConstantBits& bits) { return constant(float1, bits); }
    ValueId op(Op op, std::initializer_list<ValueId> operands) {
        const bool compares = info(op).type_rule == TypeRule::Compare;
        return append(make_instruction(module_, op, compares ? bool1 : float1,
                                       {operands.begin(), operands.size()}, search_.exit_origin()));
    }
    ValueId select(ValueId condition, ValueId a, ValueId b) {
        return append(make_instruction(module_, Op::Select, module_.type(a),
                                       std::array{condition, a, b}, search_.exit_origin()));
    }
    ValueId copy_of(const Instruction& original, std::vector<ValueId> operands) {
        Instruction copy = original;
        const Value value = module_.value(original.result());
        copy.operands = std::move(operands);
        copy.results = {module_.add_value(value.type, value.name)};
        return append(std::move(copy));
    }

    Module& module_;
    const Definitions& definitions_;
    const FirstHitLoop& search_;
    const std::vector<int>& uses_;
    const Rounding rounding_;
    std::vector<Instruction> code_;
    std::vector<std::optional<ValueId>> results_;
    std::vector<ValueId> conditions_;  // by iteration
    std::map<Place, ValueId> copies_;  // by iteration
    std::map<Place, ValueId> at_hit_;  // by iterations before the hit
    Table key_table_;
    ValueId key_{};
};

class Lowerer {
  public:
    Lowerer(Module& module, const ChooseFirstHit& choose, Rounding rounding)
        : module_(module),
          choose_(choose),
          rounding_(rounding),
          substitution_(module),
          uses_(count_uses(module)) {}

    std::vector<FirstHit> run() {
        visit(module_.body);
        compact_values(module_);
        return std::move(found_);
    }

  private:
    void visit(Region& region) {
        for (std::size_t i = 0; i < region.body.size(); ++i)
            if (const auto any = find_any_hit(module_, region, i))
                any_hits_[region.body[i].results.front()] = *any;
        rebuild(region, [&](Instruction instruction, std::vector<Instruction>& body) {
            substitution_.apply(instruction.operands);
            for (Region& inner : instruction.regions) visit(inner);
            if (instruction.op == Op::Loop && lower(instruction, body)) return;
            definitions_.record(instruction);
            body.push_back(std::move(instruction));
        });
    }

    bool lower(const Instruction& loop, std::vector<Instruction>& body) {
        FirstHit hit{loop.loop.name, loop.loop.trip_count, false, FirstHitForm::Chain, {}};
        // An inner loop that was lowered used values in other numbers than counted at the start.
        uses_.resize(module_.values.size(), 1);
        const FirstHitLoop search(module_, definitions_, loop, rounding_ == Rounding::Free);
        hit.refusal = search.refusal();
        const auto any = hit.refusal.empty() ? any_hit_of(search) : std::nullopt;
        hit.only_whether = any.has_value();
        Lowering lowering(module_, definitions_, search, uses_, rounding_);
        if (hit.refusal.empty()) hit.form = choose_(hit);
        if (hit.form == FirstHitForm::AnyHit && any) {
            const std::vector<ValueId> truths = lowering.run_any_hit(*any);
            for (std::size_t i = 0; i < truths.size(); ++i)
                substitution_.replace(any->truths[i].value, truths[i]);
        } else if (hit.form != FirstHitForm::Chain) {
            const bool found = lowering.run();
            hit.form = found ? FirstHitForm::PackedRefetch : FirstHitForm::Chain;
            if (!found) hit.refusal = "what it finds is no function of where it finds it";
        }
        found_.push_back(hit);
        if (hit.form == FirstHitForm::Chain) return false;
        for (Instruction& instruction : lowering.code()) {
            definitions_.record(instruction);
            body.push_back(std::move(instruction));
        }
        for (std::size_t k = 0; k < loop.results.size(); ++k)
            if (const auto result = lowering.results()[k])
                substitution_.replace(loop.results[k], *result);
        return true;
    }

    std::optional<AnyHit> any_hit_of(const FirstHitLoop& search) const {
        if (search.loop().results.empty()) return std::nullopt;
        const auto found = any_hits_.find(search.loop().results.front());
        if (found == any_hits_.end()) return std::nullopt;
        AnyHit any = found->second;
        any.hit.greater = substitution_(any.hit.greater);
        any.hit.lesser = substitution_(any.hit.lesser);
        if (any.stop) any.stop = substitution_(*any.stop);
        if (any.stop && !stays(module_, definitions_, search, *any.stop)) return std::nullopt;
        return any;
    }

    Module& module_;
    const ChooseFirstHit& choose_;
    const Rounding rounding_;
    Substitution substitution_;
    Definitions definitions_;
    std::vector<int> uses_;
    std::map<ValueId, AnyHit> any_hits_;  // by the loop's first result
    std::vector<FirstHit> found_;
};

}  // namespace

std::vector<FirstHit> lower_first_hit(ir::Module& module, const ChooseFirstHit& choose,
                                      Rounding rounding) {
    return Lowerer(module, choose, rounding).run();
}

std::vector<FirstHit> lower_first_hit(ir::Module& module, FirstHitForm form) {
    return lower_first_hit(module, [&](const FirstHit&) { return form; });
}

}  // namespace intaglio::passes
