// Prints a module.  Declarations, files and steps come first, then values that no instruction
// defines, then the body. Names stand where they say as much as an index; where a name is missing,
// doubled or no identifier, the index does.
#include "generator/ir/print.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <string_view>

#include "generator/base/text.h"

namespace intaglio::ir {
namespace {

bool is_identifier(std::string_view name) {
    if (name.empty() || (name[0] >= '0' && name[0] <= '9')) return false;
    for (char c : name)
        if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
              c == '_'))
            return false;
    return true;
}

std::string quoted(std::string_view text) {
    std::string result = "\"";
    for (char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            result += '\\';
            result += c;
        } else if (c == '\n') {
            result += "\\n";
        } else if (byte < 0x20 || byte == 0x7f) {
            result += fmt::format("\\x{:02x}", byte);
        } else {
            result += c;
        }
    }
    return result + '"';
}

std::string bare_or_quoted(std::string_view name) {
    return is_identifier(name) ? std::string(name) : quoted(name);
}

// The name of entry `index` if that name finds it again, else empty.
template <typename Entry>
std::string_view reference(const std::vector<Entry>& entries, int index) {
    if (index < 0 || static_cast<std::size_t>(index) >= entries.size()) return {};
    const std::string& name = entries[static_cast<std::size_t>(index)].name;
    if (!is_identifier(name)) return {};
    for (int i = 0; i < index; ++i)
        if (entries[static_cast<std::size_t>(i)].name == name) return {};
    return name;
}

template <std::size_t N, typename Enumerator>
std::string_view word(const std::string_view (&words)[N], Enumerator enumerator) {
    const auto index = static_cast<std::size_t>(enumerator);
    return index < N ? words[index] : "?";
}

std::string type_word(Type type) { return type.scalar <= Scalar::Float ? to_string(type) : "?"; }

class Printer {
  public:
    explicit Printer(const Module& module) : module_(module) {}

    std::string print() {
        print_declarations();
        print_unused_values();
        text_.line("{");
        print_region(module_.body);
        text_.line("}");
        return text_.take();
    }

  private:
    void print_declarations() {
        text_.format("{} {}", word(stage_words, module_.stage), quoted(module_.name));
        for (const Declaration& input : module_.inputs) print_declaration("input", input);
        for (const Declaration& output : module_.outputs) print_declaration("output", output);
        for (const Uniform& uniform : module_.uniforms) {
            const std::string count = uniform.count == 1 ? "" : fmt::format("[{}]", uniform.count);
            text_.format("uniform {} {}{}{}", bare_or_quoted(uniform.name), type_word(uniform.type),
                         count, optional_string(uniform.comment));
        }
        for (const Sampler& sampler : module_.samplers)
            text_.format("sampler {} {}d{}{}{}", bare_or_quoted(sampler.name), sampler.dimension,
                         sampler.filter == Sampler::Filter::Nearest ? " nearest" : "",
                         sampler.baked.empty() ? "" : " baked " + quoted(sampler.baked),
                         optional_string(sampler.comment));
        for (const std::string& file : module_.files) text_.format("file {}", quoted(file));
        for (const Step& step : module_.steps)
            text_.format("step {}{}", bare_or_quoted(step.name), optional_string(step.comment));
    }

    void print_declaration(std::string_view kind, const Declaration& declaration) {
        text_.format("{} {} {} {}", kind, bare_or_quoted(declaration.name),
                     type_word(declaration.type), word(semantic_words, declaration.semantic));
    }

    static std::string optional_string(std::string_view text) {
        return text.empty() ? "" : fmt::format(" {}", quoted(text));
    }

    void print_unused_values() {
        std::vector<bool> defined(module_.values.size());
        mark_defined(module_.body, defined);
        for (std::size_t i = 0; i < defined.size(); ++i)
            if (!defined[i]) text_.format("value {}", definition(static_cast<ValueId>(i)));
    }

    static void mark_defined(const Region& region, std::vector<bool>& defined) {
        const auto mark = [&](const std::vector<ValueId>& ids) {
            for (ValueId id : ids)
                if (index_of(id) < defined.size()) defined[index_of(id)] = true;
        };
        mark(region.parameters);
        for (const Instruction& instruction : region.body) {
            mark(instruction.results);
            for (const Region& inner : instruction.regions) mark_defined(inner, defined);
        }
    }

    void print_region(const Region& region) {
        text_.indent();
        for (const Instruction& instruction : region.body) print_instruction(instruction);
        text_.outdent();
    }

    void print_instruction(const Instruction& instruction) {
        std::string line;
        for (ValueId result : instruction.results) {
            if (!line.empty()) line += ", ";
            line += definition(result);
        }
        if (!line.empty()) line += " = ";
        line += info(instruction.op).name;
        line += arguments(instruction);
        // The origin of a loop or if stands at the end of its first line.
        if (!has_regions(instruction.op)) {
            text_.line(line + origin(instruction.origin));
            return;
        }
        line += origin(instruction.origin) + " {";
        for (std::size_t i = 0; i < instruction.regions.size(); ++i) {
            text_.line(i == 0 ? line : "} else {");
            const Region& region = instruction.regions[i];
            if (instruction.op == Op::Loop || !region.parameters.empty()) print_parameters(region);
            print_region(region);
        }
        if (instruction.regions.empty()) text_.line(line);
        text_.line("}");
    }

    void print_parameters(const Region& region) {
        std::string line;
        for (ValueId parameter : region.parameters) {
            if (!line.empty()) line += ", ";
            line += definition(parameter);
        }
        text_.format("({}):", line);
    }

    // What follows the op's name.
    std::string arguments(const Instruction& instruction) const {
        switch (instruction.op) {
            case Op::Constant: return fmt::format(" {}", constant(instruction));
            case Op::Input: return fmt::format(" {}", slot(module_.inputs, instruction.slot));
            case Op::Uniform:
                return fmt::format(" {}{}", slot(module_.uniforms, instruction.slot),
                                   element(instruction));
            case Op::Swizzle: return operands(instruction.operands) + "." + lanes(instruction);
            case Op::SampleLevel:
            case Op::SampleGrad:
            case Op::SampleImplicit:
                return fmt::format(" {}{}", slot(module_.samplers, instruction.slot),
                                   operands(instruction.operands));
            case Op::Loop: return loop(instruction.loop) + list(instruction.operands, 0);
            case Op::BreakIf: {
                if (instruction.operands.empty()) return " ()";
                return fmt::format(" {}{}", use(instruction.operands[0]),
                                   list(instruction.operands, 1));
            }
            case Op::Yield:
            case Op::Return: return list(instruction.operands, 0);
            default: return operands(instruction.operands);
        }
    }

    std::string constant(const Instruction& instruction) const {
        if (instruction.results.empty() || index_of(instruction.result()) >= module_.values.size())
            return "()";
        const Type type = module_.type(instruction.result());
        const int width = type.width < 0 ? 0 : type.width > 4 ? 4 : type.width;
        std::string components;
        for (int i = 0; i < width; ++i) {
            if (i > 0) components += ", ";
            components +=
                print_component(type.scalar, instruction.bits[static_cast<std::size_t>(i)]);
        }
        return width == 1 ? components : fmt::format("({})", components);
    }

    template <typename Entry>
    static std::string slot(const std::vector<Entry>& entries, int index) {
        const std::string_view name = reference(entries, index);
        return name.empty() ? fmt::format("${}", index) : std::string(name);
    }

    std::string element(const Instruction& instruction) const {
        const auto index = static_cast<std::size_t>(instruction.slot);
        const bool is_array =
            index >= module_.uniforms.size() || module_.uniforms[index].count != 1;
        return is_array || instruction.element != 0 ? fmt::format("[{}]", instruction.element) : "";
    }

    // As many letters as the result has components.
    std::string lanes(const Instruction& instruction) const {
        if (instruction.results.empty() || index_of(instruction.result()) >= module_.values.size())
            return "?";
        std::string letters;
        const int width = module_.type(instruction.result()).width;
        for (int i = 0; i < width && i < 4; ++i) {
            const std::uint8_t lane = instruction.lanes[static_cast<std::size_t>(i)];
            letters += lane < 4 ? "xyzw"[lane] : '?';
        }
        return letters;
    }

    static std::string loop(const LoopInfo& info) {
        std::string text = fmt::format(" {} {}", quoted(info.name), info.trip_count);
        if (info.form != LoopForm::Unspecified)
            text += fmt::format(" {}", word(loop_form_words, info.form));
        if (info.closed_form) text += " closed_form";
        return text;
    }

    static std::string operands(const std::vector<ValueId>& ids) {
        std::string text;
        for (ValueId id : ids)
            text += fmt::format("{}%{}", text.empty() ? " " : ", ", index_of(id));
        return text;
    }

    static std::string list(const std::vector<ValueId>& ids, std::size_t first) {
        std::string text;
        for (std::size_t i = first; i < ids.size(); ++i)
            text += fmt::format("{}%{}", i > first ? ", " : "", index_of(ids[i]));
        return fmt::format(" ({})", text);
    }

    static std::string use(ValueId id) { return fmt::format("%{}", index_of(id)); }

    std::string definition(ValueId id) const {
        if (index_of(id) >= module_.values.size()) return use(id) + " ?";
        const Value& value = module_.value(id);
        return fmt::format("{}{} {}", use(id), optional_string(value.name), type_word(value.type));
    }

    std::string origin(const Origin& origin) const {
        std::string text;
        if (origin.file != -1 || origin.line != 0)
            text += fmt::format(" @{}:{}", origin.file, origin.line);
        if (origin.step != -1) {
            const std::string_view name = reference(module_.steps, origin.step);
            text += name.empty() ? fmt::format(" #{}", origin.step) : fmt::format(" #{}", name);
        }
        return text;
    }

    const Module& module_;
    TextBuilder text_;
};

std::string print_float(std::uint32_t bits) {
    const float value = std::bit_cast<float>(bits);
    if (std::isnan(value)) return fmt::format("0x{:08x}", bits);
    if (std::isinf(value)) return value < 0 ? "-inf" : "inf";
    std::string text = fmt::format("{}", value);
    if (text.find_first_of(".e") == std::string::npos) text += ".0";
    float again = 0;
    std::from_chars(text.data(), text.data() + text.size(), again);
    return float_bits(again) == bits ? text : fmt::format("0x{:08x}", bits);
}

}  // namespace

std::string print(const Module& module) { return Printer(module).print(); }

std::string print_component(Scalar scalar, std::uint32_t bits) {
    switch (scalar) {
        case Scalar::Float: return print_float(bits);
        case Scalar::Int: return fmt::format("{}", static_cast<std::int32_t>(bits));
        case Scalar::Bool:
            if (bits <= 1) return bits == 1 ? "true" : "false";
            break;
    }
    return fmt::format("0x{:08x}", bits);
}

}  // namespace intaglio::ir
