// The shared tools of the passes.
#include "generator/passes/rewrite.h"

#include <algorithm>

#include <fmt/format.h>

namespace intaglio::passes {

using namespace ir;

void Substitution::replace(ValueId from, ValueId to, Name taking) {
    to = (*this)(to);
    if (from == to) return;
    for (std::size_t i = replacements_.size(); i <= index_of(from); ++i)
        replacements_.push_back(static_cast<ValueId>(i));
    replacements_[index_of(from)] = to;
    std::string& name = module_.values[index_of(to)].name;
    if (taking == Name::TakeOver && name.empty()) name = module_.value(from).name;
}

ValueId Substitution::operator()(ValueId value) const {
    while (index_of(value) < replacements_.size() && replacements_[index_of(value)] != value)
        value = replacements_[index_of(value)];
    return value;
}

void Substitution::apply(std::vector<ValueId>& operands) const {
    for (ValueId& operand : operands) operand = (*this)(operand);
}

void Cloner::bind(ValueId from, ValueId to) {
    if (map_.size() <= index_of(from))
        map_.resize(std::max<std::size_t>(source_.values.size(), index_of(from) + 1));
    map_[index_of(from)] = index_of(to) + 1;
}

ValueId Cloner::operator()(ValueId value) const {
    if (index_of(value) >= map_.size() || map_[index_of(value)] == 0) return value;
    return static_cast<ValueId>(map_[index_of(value)] - 1);
}

std::vector<ValueId> Cloner::operator()(std::span<const ValueId> values) const {
    std::vector<ValueId> copies;
    copies.reserve(values.size());
    for (ValueId value : values) copies.push_back((*this)(value));
    return copies;
}

ValueId Cloner::fresh(ValueId value) {
    const Value copy = source_.value(value);  // by value: the target may be the source
    const ValueId result = target_.add_value(copy.type, copy.name);
    bind(value, result);
    return result;
}

Instruction Cloner::clone(const Instruction& instruction) {
    Instruction copy;
    copy.op = instruction.op;
    copy.operands = (*this)(instruction.operands);
    copy.bits = instruction.bits;
    copy.slot = instruction.slot;
    copy.element = instruction.element;
    copy.lanes = instruction.lanes;
    copy.loop = instruction.loop;
    copy.origin = instruction.origin;
    for (const Region& region : instruction.regions) {
        Region inner;
        for (ValueId parameter : region.parameters) inner.parameters.push_back(fresh(parameter));
        inner.body.reserve(region.body.size());
        for (const Instruction& child : region.body) inner.body.push_back(clone(child));
        copy.regions.push_back(std::move(inner));
    }
    for (ValueId result : instruction.results) copy.results.push_back(fresh(result));
    return copy;
}

Definition definition_of(const Instruction& instruction) {
    Definition definition;
    definition.op = instruction.op;
    definition.operand_count = static_cast<std::uint8_t>(instruction.operands.size());
    std::copy(instruction.operands.begin(), instruction.operands.end(),
              definition.operands.begin());
    definition.bits = instruction.bits;
    definition.lanes = instruction.lanes;
    definition.slot = instruction.slot;
    definition.element = instruction.element;
    return definition;
}

void Definitions::record(const Instruction& instruction) {
    if (has_regions(instruction.op) || instruction.results.size() != 1 ||
        instruction.operands.size() > 4)
        return;
    const std::size_t index = index_of(instruction.result());
    if (definitions_.size() <= index)
        definitions_.resize(std::max(index + 1, definitions_.size() * 2));
    definitions_[index] = definition_of(instruction);
}

const Definition& Definitions::operator[](ValueId value) const {
    static const Definition unknown;
    return index_of(value) < definitions_.size() ? definitions_[index_of(value)] : unknown;
}

bool is_arithmetic(Op op) {
    return !is_sample(op) && !needs_derivatives(op) && !has_regions(op) && !is_terminator(op) &&
           op != Op::BreakIf;
}

bool contains_op(const Region& region, Op op) {
    return std::any_of(region.body.begin(), region.body.end(), [&](const Instruction& instruction) {
        return instruction.op == op ||
               std::any_of(instruction.regions.begin(), instruction.regions.end(),
                           [&](const Region& inner) { return contains_op(inner, op); });
    });
}

bool reads_textures(const Region& region) {
    bool found = false;
    for_each_instruction(
        region, [&](const Instruction& instruction) { found |= is_sample(instruction.op); });
    return found;
}

bool contains_break(const Region& region) {
    return std::any_of(region.body.begin(), region.body.end(), [](const Instruction& instruction) {
        return instruction.op == Op::BreakIf;
    });
}

Instruction make_instruction(Module& module, Op op, Type type, std::span<const ValueId> operands,
                             const Origin& origin) {
    Instruction instruction;
    instruction.op = op;
    instruction.operands.assign(operands.begin(), operands.end());
    instruction.results = {module.add_value(type)};
    instruction.origin = origin;
    return instruction;
}

Instruction make_constant(Module& module, Type type, std::array<std::uint32_t, 4> bits,
                          const Origin& origin) {
    Instruction instruction = make_instruction(module, Op::Constant, type, {}, origin);
    instruction.bits = bits;
    return instruction;
}

Instruction make_int_constant(Module& module, int value, const Origin& origin) {
    return make_constant(module, int1, {static_cast<std::uint32_t>(value), 0, 0, 0}, origin);
}

void substitute(Region& region, const Substitution& substitution) {
    if (substitution.empty()) return;
    for_each_instruction(
        region, [&](Instruction& instruction) { substitution.apply(instruction.operands); });
}

std::vector<int> count_uses(const Module& module) {
    std::vector<int> uses(module.values.size());
    for_each_instruction(module.body, [&](const Instruction& instruction) {
        for (ValueId operand : instruction.operands) ++uses[index_of(operand)];
    });
    return uses;
}

namespace {

// Whether values are defined in the order of their numbers, from `next` on.
bool is_numbered(const Region& region, std::uint32_t& next) {
    const auto is_next = [&](ValueId value) { return index_of(value) == next++; };
    if (!std::all_of(region.parameters.begin(), region.parameters.end(), is_next)) return false;
    for (const Instruction& instruction : region.body) {
        for (const Region& inner : instruction.regions)
            if (!is_numbered(inner, next)) return false;
        if (!std::all_of(instruction.results.begin(), instruction.results.end(), is_next))
            return false;
    }
    return true;
}

// Renumbers in two walks: definitions in builder order, then operands.
class Numbering {
  public:
    explicit Numbering(Module& module) : module_(module), numbers_(module.values.size()) {
        values_.reserve(module.values.size());
    }

    void run() {
        number(module_.body);
        for_each_instruction(module_.body, [&](Instruction& instruction) {
            for (ValueId& operand : instruction.operands) operand = numbers_[index_of(operand)];
        });
        module_.values = std::move(values_);
    }

  private:
    void define(ValueId& value) {
        const auto number = static_cast<ValueId>(values_.size());
        values_.push_back(std::move(module_.values[index_of(value)]));
        numbers_[index_of(value)] = number;
        value = number;
    }

    void number(Region& region) {
        for (ValueId& parameter : region.parameters) define(parameter);
        for (Instruction& instruction : region.body) {
            for (Region& inner : instruction.regions) number(inner);
            for (ValueId& result : instruction.results) define(result);
        }
    }

    Module& module_;
    std::vector<ValueId> numbers_;
    std::vector<Value> values_;
};

// Keeps the elements whose flag is set; returns the new index of each old one.
template <typename T>
std::vector<int> keep_marked(std::vector<T>& elements, const std::vector<bool>& marked) {
    std::vector<int> numbers(elements.size(), -1);
    std::vector<T> kept;
    for (std::size_t i = 0; i < elements.size(); ++i) {
        if (!marked[i]) continue;
        numbers[i] = static_cast<int>(kept.size());
        kept.push_back(std::move(elements[i]));
    }
    elements = std::move(kept);
    return numbers;
}

void mark(std::vector<bool>& marks, int index) {
    if (index >= 0) marks[static_cast<std::size_t>(index)] = true;
}

void renumber(int& index, const std::vector<int>& numbers) {
    if (index >= 0) index = numbers[static_cast<std::size_t>(index)];
}

}  // namespace

bool compact_values(Module& module) {
    std::uint32_t next = 0;
    if (is_numbered(module.body, next) && next == module.values.size()) return false;
    Numbering(module).run();
    return true;
}

bool remove_unused_declarations(Module& module) {
    std::vector<bool> inputs(module.inputs.size()), uniforms(module.uniforms.size());
    std::vector<bool> samplers(module.samplers.size()), files(module.files.size()),
        steps(module.steps.size());
    // A function keeps its signature, so that one search takes the place of another.
    if (module.stage == Stage::Function) {
        inputs.assign(inputs.size(), true);
        uniforms.assign(uniforms.size(), true);
        samplers.assign(samplers.size(), true);
    }
    for_each_instruction(module.body, [&](const Instruction& instruction) {
        if (instruction.op == Op::Input) mark(inputs, instruction.slot);
        if (instruction.op == Op::Uniform) mark(uniforms, instruction.slot);
        if (is_sample(instruction.op)) mark(samplers, instruction.slot);
        mark(files, instruction.origin.file);
        mark(steps, instruction.origin.step);
    });
    const auto all = [](const std::vector<bool>& marks) {
        return std::find(marks.begin(), marks.end(), false) == marks.end();
    };
    if (all(inputs) && all(uniforms) && all(samplers) && all(files) && all(steps)) return false;
    const std::vector<int> input_numbers = keep_marked(module.inputs, inputs);
    const std::vector<int> uniform_numbers = keep_marked(module.uniforms, uniforms);
    const std::vector<int> sampler_numbers = keep_marked(module.samplers, samplers);
    const std::vector<int> file_numbers = keep_marked(module.files, files);
    const std::vector<int> step_numbers = keep_marked(module.steps, steps);
    for_each_instruction(module.body, [&](Instruction& instruction) {
        if (instruction.op == Op::Input) renumber(instruction.slot, input_numbers);
        if (instruction.op == Op::Uniform) renumber(instruction.slot, uniform_numbers);
        if (is_sample(instruction.op)) renumber(instruction.slot, sampler_numbers);
        renumber(instruction.origin.file, file_numbers);
        renumber(instruction.origin.step, step_numbers);
    });
    return true;
}

std::string place_of(const Module& module, const Origin& origin) {
    if (origin.file < 0) return {};
    return fmt::format("{}:{}", module.files[static_cast<std::size_t>(origin.file)], origin.line);
}

}  // namespace intaglio::passes
