// Prints a shader.  Swizzles are the shortest that every profile accepts: none for the identity,
// one letter for a replicate, else four (".xy" is ".xyyy" in shader model 3 and refused before).
#include "generator/target/d3d9/assembly.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>

#include "generator/base/text.h"
#include "generator/target/d3d9/ops.h"

namespace intaglio::d3d9 {
namespace {

constexpr std::string_view letters = "xyzw";
constexpr std::size_t slots_column = 48;

// D3DAssemble reads "-0" and what looks like an integer above 2^31 as integers, so these get a
// point.
std::string float_text(std::uint32_t bits) {
    const float value = std::bit_cast<float>(bits);
    const std::string_view sign = bits >> 31 ? "-" : "";
    if (std::isnan(value)) return fmt::format("{}1.#QNAN", sign);
    if (std::isinf(value)) return fmt::format("{}1.#INF", sign);
    std::string text = fmt::format("{}", value);
    const bool looks_integer = text.find_first_of(".e") == std::string::npos;
    if (looks_integer && (bits == 0x80000000u || std::fabs(value) >= 1e9f)) text += ".0";
    return text;
}

// The assembler wants _abs before the bracket: c3_abs[a0.x].
std::string register_text(File file, int index, const std::optional<Relative>& relative,
                          std::string_view suffix = "") {
    const FileInfo& row = info(file);
    std::string text(row.name);
    if (row.numbered) text += fmt::format("{}", index);
    text += suffix;
    if (!relative) return text;
    if (relative->file == File::LoopCounter) return text + "[aL]";
    const auto component = static_cast<std::size_t>(relative->component);
    return text + fmt::format("[a0.{}]", letters[component]);
}

std::string swizzle_text(const Swizzle& swizzle) {
    if (swizzle == identity_swizzle) return "";
    if (swizzle == replicate(swizzle[0])) return fmt::format(".{}", letters[swizzle[0]]);
    std::string text = ".";
    for (const std::uint8_t component : swizzle) text += letters[component];
    return text;
}

std::string modifiers_text(const Destination& destination) {
    return fmt::format("{}{}{}", destination.saturate ? "_sat" : "",
                       destination.partial_precision ? "_pp" : "",
                       destination.centroid ? "_centroid" : "");
}

std::string declaration_text(const Declaration& declaration, Profile profile) {
    constexpr std::string_view kinds[] = {"", "_2d", "_cube", "_volume"};
    std::string text = "dcl";
    if (declaration.target.file == File::Sampler) {
        text += kinds[static_cast<std::size_t>(declaration.sampler)];
    } else if (has_usage(profile, declaration.target.file)) {
        text += fmt::format("_{}", name_of(declaration.usage));
        if (declaration.usage_index != 0) text += fmt::format("{}", declaration.usage_index);
    }
    return fmt::format("{}{} {}", text, modifiers_text(declaration.target),
                       text_of(declaration.target));
}

std::string definition_text(const Definition& definition) {
    const auto& bits = definition.bits;
    if (definition.file == File::ConstBool)
        return fmt::format("defb b{}, {}", definition.index, bits[0] != 0);
    const bool integers = definition.file == File::ConstInt;
    std::string text = fmt::format("{}{}", integers ? "defi i" : "def c", definition.index);
    for (const std::uint32_t value : bits)
        text += integers ? fmt::format(", {}", static_cast<std::int32_t>(value))
                         : ", " + float_text(value);
    return text;
}

std::string constant_text(const Constant& constant) {
    const auto set = static_cast<std::size_t>(constant.set);
    std::string text = fmt::format("{}{}", uniform_comment, set_type_names[set]);
    if (constant.rows != 1) text += fmt::format("{}x", constant.rows);
    if (constant.columns > 0) text += fmt::format("{}", constant.columns);
    text += fmt::format(" {}", constant.name);
    if (constant.elements != 1) text += fmt::format("[{}]", constant.elements);
    text += fmt::format(" : {}{}", set_letters[set], constant.index);
    return constant.count == 1 ? text : text + fmt::format(", {} registers", constant.count);
}

// Free text for a comment: one line, no backslash (which would join the next line to it).
std::string one_line(std::string text) {
    for (char& c : text) {
        if (static_cast<unsigned char>(c) < ' ') c = ' ';
        if (c == '\\') c = '/';
    }
    return text;
}

// A line of its own, not mistaken for our words.
std::string comment_text(std::string text) {
    const std::string line = "// " + one_line(std::move(text));
    const bool mistakable = line.starts_with(uniform_comment) || line.starts_with(profile_comment);
    return mistakable ? "// : " + line.substr(3) : line;
}

// What instructions are for: the sentence of a step before its first one, and for each one its step
// and line.
class StepComments {
  public:
    StepComments(const Shader& shader, TextBuilder& text)
        : shader_(shader), text_(text), introduced_(shader.steps.size(), false) {}

    void before(const ir::Origin& origin) {
        const auto step = static_cast<std::size_t>(origin.step);
        if (origin.step < 0 || step >= shader_.steps.size() || introduced_[step]) return;
        introduced_[step] = true;
        if (!shader_.steps[step].comment.empty())
            text_.line(comment_text(shader_.steps[step].comment));
    }

    // "march: templates/search/parallax_occlusion.cpp:43"; empty where nothing is known.
    std::string beside(const ir::Origin& origin) const {
        const auto step = static_cast<std::size_t>(origin.step),
                   file = static_cast<std::size_t>(origin.file);
        const bool has_step = origin.step >= 0 && step < shader_.steps.size();
        const bool has_file = origin.file >= 0 && file < shader_.files.size();
        std::string text = has_step ? shader_.steps[step].name : "";
        if (has_file)
            text +=
                fmt::format("{}{}:{}", text.empty() ? "" : ": ", shader_.files[file], origin.line);
        return text.empty() ? text : "  " + one_line(text);
    }

  private:
    const Shader& shader_;
    TextBuilder& text_;
    std::vector<bool> introduced_;
};

void print_instructions(const Shader& shader, const AssemblyOptions& options, TextBuilder& text) {
    StepComments comments(shader, text);
    Slots so_far;
    int depth = 0;  // unbalanced blocks are the checker's matter, and print flush left
    for (const Instruction& instruction : shader.instructions) {
        const OpInfo& row = info(instruction.op);
        if (row.has(Trait::Closes) && depth > 0) text.outdent(), --depth;
        std::string line = text_of(instruction);
        if (options.comments) {
            comments.before(instruction.origin);
            const Slots slots = slots_of(instruction);
            so_far.arithmetic += slots.arithmetic;
            so_far.texture += slots.texture;
            const auto indent = static_cast<std::size_t>(text.column());
            const std::size_t width = slots_column > indent ? slots_column - indent : 0;
            line = fmt::format("{:<{}} ; {:>3} {:>3}{}", line, width, so_far.arithmetic,
                               so_far.texture, comments.beside(instruction.origin));
        }
        text.line(line);
        if (row.has(Trait::Opens)) text.indent(), ++depth;
    }
}

}  // namespace

std::string text_of(const Source& source) {
    const bool negated =
        source.modifier == Modifier::Negate || source.modifier == Modifier::AbsNegate;
    const bool absolute =
        source.modifier == Modifier::Abs || source.modifier == Modifier::AbsNegate;
    const std::string_view sign = negated ? "-" : source.modifier == Modifier::Not ? "!" : "";
    const std::string_view suffix = absolute ? "_abs" : "";
    return fmt::format("{}{}{}", sign,
                       register_text(source.file, source.index, source.relative, suffix),
                       swizzle_text(source.swizzle));
}

std::string text_of(const Destination& destination) {
    std::string text = register_text(destination.file, destination.index, destination.relative);
    if (destination.mask == full_mask) return text;
    text += '.';
    for (std::size_t lane = 0; lane < 4; ++lane)
        if (destination.mask >> lane & 1) text += letters[lane];
    return text;
}

std::string text_of(const Instruction& instruction) {
    const OpInfo& row = info(instruction.op);
    std::string text =
        instruction.predicate ? fmt::format("({}) ", text_of(*instruction.predicate)) : "";
    text += row.mnemonic;
    if (row.has(Trait::Compares)) text += fmt::format("_{}", name_of(instruction.comparison));
    std::string_view separator = " ";
    if (instruction.destination) {
        text += modifiers_text(*instruction.destination) + " " + text_of(*instruction.destination);
        separator = ", ";
    }
    for (const Source& source : instruction.sources) {
        text += fmt::format("{}{}", separator, text_of(source));
        separator = ", ";
    }
    return text;
}

std::string print(const Shader& shader, const AssemblyOptions& options) {
    TextBuilder text;
    text.line(version_of(shader.profile));
    if (version_of(shader.profile) != name_of(shader.profile))
        text.format("{}{}", profile_comment, name_of(shader.profile));
    for (const Constant& constant : shader.constants) text.line(constant_text(constant));
    for (const Definition& definition : shader.definitions) text.line(definition_text(definition));
    for (const Declaration& declaration : shader.declarations)
        text.line(declaration_text(declaration, shader.profile));
    if (options.comments && !shader.instructions.empty())
        text.line(
            "// Beside each instruction: slots so far, arithmetic and texture; its step and line.");
    print_instructions(shader, options, text);
    return text.take();
}

}  // namespace intaglio::d3d9
