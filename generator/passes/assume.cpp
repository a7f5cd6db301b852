// Names become values first; then one analysis of each stage, and a rewriting of what it decides in
// the module as recorded, where every name still means what it meant.
#include "generator/passes/assume.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "generator/base/nearest.h"
#include "generator/passes/fold_constants.h"
#include "generator/passes/range_analysis.h"
#include "generator/passes/remove_dead_code.h"
#include "generator/passes/remove_unused_interpolants.h"
#include "generator/passes/rewrite.h"

namespace intaglio::passes {
namespace {

using namespace ir;

using Notes = std::vector<std::string>;

// --- names

// What a name stands for, in the order in which it is looked up.
enum class Meaning { PixelValue, PixelInput, Sampler, Uniform, VertexValue };

struct Named {
    Meaning meaning;
    std::string name;
    int width;
};

void add_values(std::vector<Named>& all, Meaning meaning, const Module& module) {
    for (const Value& value : module.values)
        if (!value.name.empty()) all.push_back({meaning, value.name, value.type.width});
}

std::vector<Named> names_of(const Program& program) {
    std::vector<Named> all;
    add_values(all, Meaning::PixelValue, program.pixel);
    for (const Declaration& input : program.pixel.inputs)
        all.push_back({Meaning::PixelInput, input.name, input.type.width});
    for (const Module* module : {&program.pixel, &program.vertex})
        for (const Sampler& sampler : module->samplers)
            all.push_back({Meaning::Sampler, sampler.name, 4});
    for (const Module* module : {&program.pixel, &program.vertex})
        for (const Uniform& uniform : module->uniforms)
            if (uniform.count == 1)
                all.push_back({Meaning::Uniform, uniform.name, uniform.type.width});
    add_values(all, Meaning::VertexValue, program.vertex);
    return all;
}

struct Component {
    std::string name;
    std::string letter;  // empty: none was given
};

Component component_in(const std::string& text) {
    const std::size_t dot = text.rfind('.');
    if (dot == std::string::npos) return {text, ""};
    return {text.substr(0, dot), text.substr(dot + 1)};
}

std::vector<std::string> only_names(const std::vector<Named>& all) {
    std::vector<std::string> names;
    for (const Named& named : all)
        if (std::find(names.begin(), names.end(), named.name) == names.end())
            names.push_back(named.name);
    return names;
}

struct Restricted {
    Meaning meaning;
    std::string name;
    std::size_t component;
    Range range;
};

Result<Restricted> restricted(const std::vector<Named>& all, const std::string& text,
                              const Interval& interval) {
    if (!(interval.least <= interval.most))
        return input_error("range-empty", fmt::format("nothing lies in {} = {}..{}", text,
                                                      interval.least, interval.most));
    const Component wanted = component_in(text);
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const Named& named) { return named.name == wanted.name; });
    if (found == all.end())
        return input_error("unknown-value",
                           unknown_name_sentence("value", wanted.name, only_names(all)));
    int width = 0;  // of the widest: a name may stand for values of several types
    for (const Named& named : all)
        if (named.name == found->name && named.meaning == found->meaning)
            width = std::max(width, named.width);
    constexpr std::string_view letters = "xyzw";
    const std::size_t component =
        wanted.letter.empty() ? 0
        : wanted.letter.size() == 1
            ? letters.substr(0, static_cast<std::size_t>(width)).find(wanted.letter)
            : std::string_view::npos;
    if (component == std::string_view::npos || (wanted.letter.empty() && width > 1))
        return input_error(
            "value-component",
            width == 1
                ? fmt::format("{} is one number; its range is that of {}", wanted.name, wanted.name)
                : fmt::format("{} has {} components; a range is of one of them, {}.x to "
                              "{}.{}",
                              wanted.name, width, wanted.name, wanted.name,
                              letters[static_cast<std::size_t>(width) - 1]));
    return Restricted{
        found->meaning, found->name, component,
        Range::between(static_cast<double>(interval.least), static_cast<double>(interval.most))};
}

// --- uniforms

std::vector<std::string> uniform_names(const Program& program) {
    std::vector<std::string> names;
    for (const Module* module : {&program.pixel, &program.vertex})
        for (const Uniform& uniform : module->uniforms) names.push_back(uniform.name);
    return names;
}

const Uniform* find_uniform(const Module& module, const std::string& name) {
    const auto found = std::find_if(module.uniforms.begin(), module.uniforms.end(),
                                    [&](const Uniform& uniform) { return uniform.name == name; });
    return found == module.uniforms.end() ? nullptr : &*found;
}

Status check_uniform(const Program& program, const std::string& name, std::size_t given) {
    const Uniform* uniform = find_uniform(program.pixel, name);
    if (uniform == nullptr) uniform = find_uniform(program.vertex, name);
    if (uniform == nullptr)
        return input_error("unknown-uniform",
                           unknown_name_sentence("uniform", name, uniform_names(program)));
    const auto wanted = static_cast<std::size_t>(uniform->count * uniform->type.width);
    if (given == wanted) return Done{};
    const std::string rows =
        uniform->count > 1 ? fmt::format(", {} rows of {}", uniform->count, uniform->type.width)
                           : std::string();
    return input_error("uniform-components",
                       fmt::format("the uniform {} has {} component{}{}; {} {} given", name, wanted,
                                   wanted == 1 ? "" : "s", rows, given, given == 1 ? "is" : "are"));
}

void fix_uniforms(Module& module, const std::map<std::string, std::vector<float>>& uniforms) {
    for_each_instruction(module.body, [&](Instruction& instruction) {
        if (instruction.op != Op::Uniform) return;
        const Uniform& uniform = module.uniforms[static_cast<std::size_t>(instruction.slot)];
        const auto known = uniforms.find(uniform.name);
        if (known == uniforms.end()) return;
        const auto width = static_cast<std::size_t>(uniform.type.width);
        const std::size_t first = static_cast<std::size_t>(instruction.element) * width;
        for (std::size_t i = 0; i < width; ++i) {
            const float value = known->second[first + i];
            instruction.bits[i] =
                uniform.type.scalar == Scalar::Float
                    ? float_bits(value)
                    : static_cast<std::uint32_t>(static_cast<std::int32_t>(value));
        }
        instruction.op = Op::Constant;
        instruction.slot = instruction.element = 0;
    });
    // A function keeps what it does not read, but for these.
    for (std::size_t i = module.uniforms.size(); i-- > 0;) {
        if (!uniforms.contains(module.uniforms[i].name)) continue;
        module.uniforms.erase(module.uniforms.begin() + static_cast<std::ptrdiff_t>(i));
        for_each_instruction(module.body, [&](Instruction& instruction) {
            if (instruction.op == Op::Uniform && instruction.slot > static_cast<int>(i))
                --instruction.slot;
        });
    }
}

// --- ranges

Assumptions assumptions_of(const Module& module, const std::vector<Restricted>& all) {
    Assumptions assumptions;
    assumptions.values.resize(module.values.size());
    assumptions.samplers.resize(module.samplers.size());
    const auto restrict_value = [&](ValueId value, const Restricted& one) {
        if (static_cast<int>(one.component) < module.type(value).width &&
            module.type(value).scalar == Scalar::Float)
            assumptions.values[index_of(value)][one.component] = one.range;
    };
    for (const Restricted& one : all) {
        const Meaning values =
            module.stage == Stage::Vertex ? Meaning::VertexValue : Meaning::PixelValue;
        if (one.meaning == values)
            for (std::size_t i = 0; i < module.values.size(); ++i)
                if (module.values[i].name == one.name) restrict_value(static_cast<ValueId>(i), one);
        if (one.meaning == Meaning::Sampler)
            for (std::size_t i = 0; i < module.samplers.size(); ++i)
                if (module.samplers[i].name == one.name)
                    assumptions.samplers[i][one.component] = one.range;
        for_each_instruction(module.body, [&](const Instruction& instruction) {
            const auto slot = static_cast<std::size_t>(instruction.slot);
            const bool input = instruction.op == Op::Input && module.stage != Stage::Vertex &&
                               one.meaning == Meaning::PixelInput &&
                               module.inputs[slot].name == one.name;
            const bool uniform = instruction.op == Op::Uniform && one.meaning == Meaning::Uniform &&
                                 module.uniforms[slot].name == one.name;
            if (input || uniform) restrict_value(instruction.result(), one);
        });
    }
    return assumptions;
}

// Rewrites what the facts decide, in place; what nothing uses any more is left to others.
class Decider {
  public:
    Decider(Module& module, const RangeFacts& facts, Notes& notes)
        : module_(module), facts_(facts), notes_(notes), substitution_(module) {}

    void run() {
        for_each_instruction(module_.body, [&](Instruction& instruction) { decide(instruction); });
        substitute(module_.body, substitution_);
    }

  private:
    const Ranges& fact(ValueId value) const { return facts_.values[index_of(value)]; }

    void note(const Instruction& instruction, const std::string& what) {
        const std::string place = place_of(module_, instruction.origin);
        std::string sentence = place.empty() ? what : fmt::format("{}: {}", place, what);
        if (std::find(notes_.begin(), notes_.end(), sentence) == notes_.end())
            notes_.push_back(std::move(sentence));
    }

    void decide(Instruction& instruction) {
        if (instruction.op == Op::Loop) return shorten(instruction);
        if (has_regions(instruction.op) || instruction.results.size() != 1 ||
            instruction.op == Op::Constant || becomes_constant(instruction))
            return;
        const std::optional<std::size_t> operand = chosen_operand(instruction);
        if (!operand) return;
        note(instruction, fmt::format("{} is always its {} operand", info(instruction.op).name,
                                      *operand == 0 ? "first" : "second"));
        const ValueId chosen = instruction.operands[*operand];
        substitution_.replace(
            instruction.result(), chosen,
            leaves_.contains(chosen) ? Substitution::Name::Leave : Substitution::Name::TakeOver);
    }

    void shorten(Instruction& loop) {
        const auto trips = facts_.trips.find(loop.regions[0].parameters[0]);
        if (trips == facts_.trips.end() || trips->second >= loop.loop.trip_count) return;
        note(loop, fmt::format("the loop {} needs {} of its {} iterations", loop.loop.name,
                               trips->second, loop.loop.trip_count));
        loop.loop.trip_count = trips->second;
    }

    bool becomes_constant(Instruction& instruction) {
        const ValueId result = instruction.result();
        const Type type = module_.type(result);
        std::array<std::uint32_t, 4> bits{};
        for (std::size_t i = 0; i < static_cast<std::size_t>(type.width); ++i) {
            const std::optional<double> single = fact(result)[i].single();
            if (!single) return false;
            bits[i] = type.scalar == Scalar::Float
                          ? float_bits(static_cast<float>(*single))
                          : static_cast<std::uint32_t>(static_cast<std::int32_t>(*single));
        }
        if (instruction.op >= Op::Less && instruction.op <= Op::NotEqual)
            note(instruction, fmt::format("{} is always {}", info(instruction.op).name,
                                          bits[0] != 0 ? "true" : "false"));
        instruction.op = Op::Constant;
        instruction.operands.clear();
        instruction.bits = bits;
        instruction.slot = instruction.element = 0;
        instruction.lanes = {};
        leaves_.insert(result);
        return true;
    }

    // The operand that the op gives unchanged, in every component.
    std::optional<std::size_t> chosen_operand(const Instruction& instruction) const {
        const auto all = [&](auto holds) {
            const int width = module_.type(instruction.result()).width;
            for (std::size_t i = 0; i < static_cast<std::size_t>(width); ++i)
                if (!holds(i)) return false;
            return true;
        };
        const auto operand = [&](std::size_t k, std::size_t i) {
            return fact(instruction.operands[k])[i];
        };
        switch (instruction.op) {
            case Op::Max:
            case Op::Min:
                for (std::size_t k = 0; k < 2; ++k)
                    if (all([&](std::size_t i) {
                            return instruction.op == Op::Max
                                       ? is_max(operand(k, i), operand(1 - k, i))
                                       : is_max(ranges::neg(operand(k, i)),
                                                ranges::neg(operand(1 - k, i)));
                        }))
                        return k;
                break;
            case Op::Saturate:
                if (all([&](std::size_t i) {
                        const Range a = operand(0, i);
                        return !a.nan && !is_below(a.least, +0.0) && a.most <= 1;
                    }))
                    return 0;
                break;
            case Op::Abs:
                if (all([&](std::size_t i) { return !is_below(operand(0, i).least, +0.0); }))
                    return 0;
                break;
            default: break;
        }
        return {};
    }

    // Whether max(a, b) is a to the bit.  Of two zeros of different signs it may be either.
    static bool is_max(const Range& a, const Range& b) {
        if (a.nan || a.empty()) return false;
        if (b.empty() || a.least > b.most) return true;
        if (a.least < b.most) return false;
        const bool negative = std::signbit(a.least) || !is_below(-0.0, b.least);
        const bool positive = !is_below(a.most, +0.0) || !std::signbit(b.most);
        return a.least != 0 || !(negative && positive);
    }

    Module& module_;
    const RangeFacts& facts_;
    Notes& notes_;
    Substitution substitution_;
    std::set<ValueId> leaves_;  // constants that were made
};

std::string sentence_of(const Module& module, ValueId value) {
    const std::string& name = module.value(value).name;
    return fmt::format("{} cannot be what is assumed of it, whatever the inputs are",
                       name.empty() ? "a value" : name);
}

Status decide_by_ranges(Module& module, const std::vector<Restricted>& ranges, Notes& notes) {
    const RangeFacts facts = analyze_ranges(module, assumptions_of(module, ranges));
    if (facts.impossible)
        return input_error("range-impossible", sentence_of(module, *facts.impossible));
    Decider(module, facts, notes).run();
    return Done{};
}

std::string joined(const std::vector<float>& numbers) {
    std::string text;
    for (float number : numbers) text += fmt::format("{}{}", text.empty() ? "" : ",", number);
    return text;
}

}  // namespace

std::vector<std::string> to_strings(const Known& known) {
    std::vector<std::string> texts;
    for (const auto& [name, numbers] : known.uniforms)
        texts.push_back(fmt::format("{} = {}", name, joined(numbers)));
    for (const auto& [name, range] : known.ranges)
        texts.push_back(fmt::format("{} = {}..{}", name, range.least, range.most));
    return texts;
}

Result<std::vector<std::string>> assume(ir::Program& program, const Known& known) {
    Notes notes;
    if (known.empty()) return notes;
    std::vector<Restricted> ranges;
    const std::vector<Named> names = names_of(program);
    for (const auto& [name, interval] : known.ranges) {
        const Result<Restricted> one = restricted(names, name, interval);
        if (!one) return one.error();
        ranges.push_back(*one);
    }
    for (const auto& [name, numbers] : known.uniforms)
        if (Status status = check_uniform(program, name, numbers.size()); !status)
            return status.error();
    // A function has no vertex stage.
    const bool whole = program.pixel.stage != Stage::Function;
    for (Module* module : {&program.vertex, &program.pixel}) {
        if (module == &program.vertex && !whole) continue;
        fix_uniforms(*module, known.uniforms);
        if (Status status = decide_by_ranges(*module, ranges, notes); !status)
            return status.error();
        fold_constants(*module);
        remove_dead_code(*module);
    }
    if (whole) remove_unused_interpolants(program);
    for (std::string& text : to_strings(known)) program.settings.push_back(std::move(text));
    return notes;
}

Known part_of(const Known& known, const ir::Program& program) {
    Known part;
    const std::vector<std::string> uniforms = uniform_names(program),
                                   values = only_names(names_of(program));
    const auto has = [](const std::vector<std::string>& names, const std::string& name) {
        return std::find(names.begin(), names.end(), name) != names.end();
    };
    for (const auto& one : known.uniforms)
        if (has(uniforms, one.first)) part.uniforms.insert(one);
    for (const auto& one : known.ranges)
        if (has(values, component_in(one.first).name)) part.ranges.insert(one);
    return part;
}

}  // namespace intaglio::passes
