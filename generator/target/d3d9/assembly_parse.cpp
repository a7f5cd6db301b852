// Reads assembly text line by line: a version, then declarations and definitions, then
// instructions.
#include <algorithm>

#include <fmt/format.h>

#include "generator/target/d3d9/assembly.h"
#include "generator/target/d3d9/line_scanner.h"
#include "generator/target/d3d9/ops.h"

namespace intaglio::d3d9 {
namespace {

// A lane's letter, in either alphabet, as its number; 4 for any other character.
std::size_t lane_of(char letter) {
    const std::size_t xyzw = std::string_view("xyzw").find(letter);
    if (xyzw < 4) return xyzw;
    return std::min<std::size_t>(std::string_view("rgba").find(letter), 4);
}

// An instruction's first word, "mad_sat_pp", taken apart.
struct Mnemonic {
    std::string_view base;
    std::vector<std::string_view> suffixes;
};

Mnemonic split(std::string_view word) {
    Mnemonic result;
    const std::size_t end = std::min(word.find('_'), word.size());
    result.base = word.substr(0, end);
    while (result.base.size() < word.size()) {
        const std::size_t begin =
            result.suffixes.empty()
                ? end + 1
                : static_cast<std::size_t>(result.suffixes.back().data() - word.data()) +
                      result.suffixes.back().size() + 1;
        if (begin > word.size()) break;
        result.suffixes.push_back(
            word.substr(begin, std::min(word.find('_', begin), word.size()) - begin));
    }
    return result;
}

class Parser {
  public:
    Parser(std::string_view text, std::string_view file_name, std::optional<Profile> x_profile)
        : text_(text), file_name_(file_name), x_profile_(x_profile) {}

    Result<Shader> parse() {
        while (!text_.empty()) {
            const std::size_t end = std::min(text_.find('\n'), text_.size());
            const std::string_view line = text_.substr(0, end);
            text_.remove_prefix(std::min(end + 1, text_.size()));
            ++line_number_;
            if (auto status = parse_line(line); !status) return status.error();
        }
        if (!has_version_) {
            line_number_ = 1;
            return error(1, "the text has no version, such as ps_2_0, on its first line");
        }
        return std::move(shader_);
    }

  private:
    Diagnostic error(int column, std::string message) const {
        return input_error("d3d9-parse", std::move(message), file_name_, line_number_, column);
    }

    Status parse_line(std::string_view line) {
        const std::size_t slashes = line.find("//"), semicolon = line.find(';');
        const std::size_t end = std::min({slashes, semicolon, line.size()});
        if (slashes == 0 && shader_.instructions.empty())
            if (auto status = parse_comment(line); !status) return status;
        LineScanner scan(line.substr(0, end));
        if (scan.at_end()) return Done{};
        auto status = parse_statement(scan);
        if (status && !scan.at_end())
            return error(scan.column(), "the line goes on after its last operand");
        return status;
    }

    Status parse_comment(std::string_view line) {
        if (line.starts_with(profile_comment)) {
            LineScanner scan(line.substr(profile_comment.size()));
            const auto named = profile_named(scan.word());
            const bool fits = named && version_of(*named) == version_of(shader_.profile);
            if (has_version_ && fits && !x_profile_) shader_.profile = *named;
        }
        return line.starts_with(uniform_comment) ? parse_uniform(line) : Status(Done{});
    }

    Status parse_uniform(std::string_view line) {
        LineScanner scan(line);
        scan.take(uniform_comment);
        Constant constant;
        const std::string_view type = scan.letters();
        const auto* found = std::find(std::begin(set_type_names), std::end(set_type_names), type);
        bool good = found != std::end(set_type_names);
        const auto set = static_cast<std::size_t>(found - std::begin(set_type_names));
        constant.set = static_cast<Constant::Set>(set);
        constant.columns = 0;
        if (good && constant.set != Constant::Set::Sampler) {
            constant.columns = scan.number(4).value_or(0);
            if (scan.peek_adjacent() == 'x' && scan.take("x")) {
                constant.rows = constant.columns;
                constant.columns = scan.number(4).value_or(0);
            }
            good = constant.columns > 0 && constant.rows > 0;
        }
        constant.name = scan.token();
        if (scan.take("[")) {
            constant.elements = scan.number(0xFFFF).value_or(0);
            good = scan.take("]") && constant.elements > 0 && good;
        }
        good = good && scan.take(":") && scan.take(set_letters[set]) && !constant.name.empty();
        const auto index = scan.number(0xFFFF);
        if (scan.take(",")) {
            constant.count = scan.number(0xFFFF).value_or(0);
            good = good && scan.take("registers") && constant.count > 0;
        }
        if (!good || !index || !scan.at_end())
            return error(
                scan.column(),
                "a uniform comment reads like \"// uniform float3 light[2] : c4, 2 registers\"");
        constant.index = *index;
        shader_.constants.push_back(std::move(constant));
        return Done{};
    }

    Status parse_statement(LineScanner& scan) {
        const int column = scan.column();
        if (!has_version_) {
            const std::string_view word = scan.word();
            const auto profile = profile_of_version(word, x_profile_.value_or(Profile::ps_2_a));
            if (!profile)
                return error(
                    column,
                    fmt::format("expected a version (ps_2_0, ps_2_x, ps_3_0, vs_2_0 or vs_3_0) "
                                "instead of \"{}\"",
                                word));
            shader_.profile = *profile;
            has_version_ = true;
            return Done{};
        }
        Instruction instruction;
        if (scan.take("(")) {
            auto predicate = parse_source(scan);
            if (!predicate) return predicate.error();
            if (predicate->file != File::Predicate || !scan.take(")"))
                return error(column, "a predicate reads like (p0.x) or (!p0.x)");
            instruction.predicate = *predicate;
        }
        const int word_column = scan.column();
        const std::string_view word = scan.word();
        const Mnemonic mnemonic = split(word);
        const bool defines = word == "def" || word == "defi" || word == "defb";
        if (mnemonic.base != "dcl" && !defines)
            return parse_instruction(scan, std::move(instruction), mnemonic, word, word_column);
        if (instruction.predicate)
            return error(column, fmt::format("{} cannot be predicated", word));
        if (!shader_.instructions.empty())
            return error(word_column,
                         fmt::format("{} must come before the first instruction", word));
        return defines ? parse_definition(scan, word) : parse_declaration(scan, mnemonic);
    }

    Status parse_definition(LineScanner& scan, std::string_view word) {
        const int column = scan.column();
        auto target = parse_destination(scan);
        if (!target) return target.error();
        Definition definition;
        definition.file = word == "def"    ? File::Const
                          : word == "defi" ? File::ConstInt
                                           : File::ConstBool;
        definition.index = target->index;
        if (target->file != definition.file || target->mask != full_mask || target->relative)
            return error(column, fmt::format("{} defines a whole {} register", word,
                                             info(definition.file).name));
        const int count = definition.file == File::ConstBool ? 1 : 4;
        for (int i = 0; i < count; ++i) {
            if (!scan.take(","))
                return error(scan.column(), fmt::format("{} needs {} values", word, count));
            const int value_column = scan.column();
            std::optional<std::uint32_t> bits;
            if (definition.file == File::ConstBool) {
                const std::string_view truth = scan.word();
                if (truth == "true" || truth == "false") bits = truth == "true";
            } else {
                bits = definition.file == File::ConstInt ? scan.integer() : scan.real();
            }
            if (!bits)
                return error(value_column,
                             fmt::format("this is no value that {} can define", word));
            definition.bits[static_cast<std::size_t>(i)] = *bits;
        }
        shader_.definitions.push_back(definition);
        return Done{};
    }

    Status parse_declaration(LineScanner& scan, const Mnemonic& mnemonic) {
        const int column = scan.column();
        Declaration declaration;
        std::optional<Usage> usage;
        for (const std::string_view suffix : mnemonic.suffixes) {
            const std::size_t digits = suffix.find_last_not_of("0123456789") + 1;
            const auto named = usage_named(suffix.substr(0, digits));
            if (suffix == "2d")
                declaration.sampler = SamplerKind::Texture2D;
            else if (suffix == "cube")
                declaration.sampler = SamplerKind::Cube;
            else if (suffix == "volume")
                declaration.sampler = SamplerKind::Volume;
            else if (named && !usage) {
                usage = declaration.usage = *named;
                LineScanner index(suffix.substr(digits));
                declaration.usage_index = index.at_end() ? 0 : index.number(15).value_or(-1);
                if (declaration.usage_index < 0) return error(column, "a usage index is 0 to 15");
            } else if (!take_modifier(suffix, declaration.target)) {
                return error(column, fmt::format("a declaration has no part \"{}\"", suffix));
            }
        }
        auto target = parse_destination(scan);
        if (!target) return target.error();
        target->saturate = declaration.target.saturate;
        target->partial_precision = declaration.target.partial_precision;
        target->centroid = declaration.target.centroid;
        declaration.target = *target;
        if (!can_declare(target->file) || target->relative)
            return error(column, fmt::format("{} cannot be declared", text_of(*target)));
        if (has_usage(shader_.profile, target->file) != usage.has_value())
            return error(column, fmt::format("the declaration of {} {} usage such as _texcoord0",
                                             text_of(*target), usage ? "takes no" : "needs a"));
        if (declaration.sampler != SamplerKind::None && target->file != File::Sampler)
            return error(column,
                         fmt::format("{} is no sampler, so its declaration names no texture kind",
                                     text_of(*target)));
        shader_.declarations.push_back(declaration);
        return Done{};
    }

    // Whether the suffix was a modifier of destinations, now set.
    static bool take_modifier(std::string_view suffix, Destination& destination) {
        bool* flag = suffix == "sat"        ? &destination.saturate
                     : suffix == "pp"       ? &destination.partial_precision
                     : suffix == "centroid" ? &destination.centroid
                                            : nullptr;
        if (!flag || *flag) return false;
        *flag = true;
        return true;
    }

    Status parse_instruction(LineScanner& scan, Instruction instruction, const Mnemonic& mnemonic,
                             std::string_view word, int column) {
        Destination modifiers;
        for (const std::string_view suffix : mnemonic.suffixes) {
            const auto comparison = comparison_named(suffix);
            if (comparison && instruction.comparison == Comparison::None)
                instruction.comparison = *comparison;
            else if (!take_modifier(suffix, modifiers))
                return error(column,
                             fmt::format("\"{}\" is no modifier of {}", suffix, mnemonic.base));
        }
        const bool compares = instruction.comparison != Comparison::None;
        const OpInfo* row = op_of_mnemonic(mnemonic.base, compares);
        if (!row) {
            const OpInfo* other = op_of_mnemonic(mnemonic.base, !compares);
            return error(column, !other     ? fmt::format("there is no instruction \"{}\"", word)
                                 : compares ? fmt::format("{} takes no comparison", mnemonic.base)
                                            : fmt::format("{} needs a comparison, such as _lt",
                                                          mnemonic.base));
        }
        instruction.op = row->op;
        bool first = true;
        if (row->has_destination()) {
            auto destination = parse_destination(scan);
            if (!destination) return destination.error();
            destination->saturate = modifiers.saturate;
            destination->partial_precision = modifiers.partial_precision;
            destination->centroid = modifiers.centroid;
            instruction.destination = *destination;
            first = false;
        } else if (modifiers != Destination{}) {
            return error(column,
                         fmt::format("{} writes nothing that a modifier could change", word));
        }
        const int count = source_count(row->op, shader_.profile);
        for (int i = 0; i < count; ++i, first = false) {
            if (!first && !scan.take(","))
                return error(scan.column(), fmt::format("{} needs {} operands", word,
                                                        count + (row->has_destination() ? 1 : 0)));
            auto source = parse_source(scan);
            if (!source) return source.error();
            instruction.sources.push_back(*source);
        }
        shader_.instructions.push_back(std::move(instruction));
        return Done{};
    }

    struct Register {
        File file = File::Temp;
        int index = 0;
        std::optional<Relative> relative = {};
        bool absolute = false;
    };

    Result<Register> parse_register(LineScanner& scan) {
        const int column = scan.column();
        const std::string_view name = scan.letters();
        const auto file = file_named(shader_.profile, name);
        if (!file)
            return error(column, name.empty() ? "expected a register"
                                              : fmt::format("{} has no register \"{}\"",
                                                            version_of(shader_.profile), name));
        Register result{.file = *file};
        const bool numbered = info(*file).numbered;
        const char next = scan.peek_adjacent();
        const bool has_number = next >= '0' && next <= '9';
        const auto index = numbered && has_number ? scan.number(last_register) : std::nullopt;
        result.index = index.value_or(0);
        result.absolute = take_abs(scan);
        const bool indexed = numbered && scan.peek_adjacent() == '[';
        if (numbered && !index && (has_number || !indexed))
            return error(column,
                         fmt::format("a register number of {} is 0 to {}", name, last_register));
        if (!indexed) return result;
        auto status = parse_relative(scan, result);
        if (!status) return status.error();
        return result;
    }

    static bool take_abs(LineScanner& scan) {
        return scan.peek_adjacent() == '_' && scan.take("_abs");
    }

    // "[a0.x + 3]" after a register
    Status parse_relative(LineScanner& scan, Register& result) {
        scan.take("[");
        Relative relative;
        if (scan.take("aL")) {
            relative.file = File::LoopCounter;
        } else if (scan.take("a0.") && is_lane(scan.peek_adjacent())) {
            const int lane_column = scan.column();
            const std::string_view lane = scan.letters();
            if (lane.size() != 1) return error(lane_column, "an address has one component");
            relative.component = static_cast<int>(lane_of(lane[0]));
        } else {
            return error(scan.column(), "a relative register reads like c[a0.x + 3] or c3[aL]");
        }
        if (scan.take("+")) {
            const auto offset = scan.number(last_register - result.index);
            if (!offset)
                return error(scan.column(),
                             fmt::format("a register number is at most {}", last_register));
            result.index += *offset;
        }
        if (!scan.take("]")) return error(scan.column(), "expected ]");
        result.relative = relative;
        // The disassembler prints _abs behind the bracket, where the assembler refuses it.
        result.absolute = take_abs(scan) || result.absolute;
        return Done{};
    }

    static bool is_lane(char letter) { return lane_of(letter) < 4; }

    // ".xyz" as up to four lanes; empty if there is none.
    Result<std::vector<std::uint8_t>> parse_lanes(LineScanner& scan) {
        std::vector<std::uint8_t> lanes;
        if (!scan.take(".")) return lanes;
        const int column = scan.column();
        const std::string_view word = scan.letters();
        const bool good =
            !word.empty() && word.size() <= 4 && std::all_of(word.begin(), word.end(), is_lane);
        if (!good) return error(column, "expected one to four of x, y, z, w");
        for (const char letter : word) lanes.push_back(static_cast<std::uint8_t>(lane_of(letter)));
        return lanes;
    }

    Result<Destination> parse_destination(LineScanner& scan) {
        const int register_column = scan.column();
        auto target = parse_register(scan);
        if (!target) return target.error();
        if (target->absolute) return error(register_column, "a destination has no _abs");
        const int column = scan.column();
        auto lanes = parse_lanes(scan);
        if (!lanes) return lanes.error();
        Destination result;
        result.file = target->file;
        result.index = target->index;
        result.relative = target->relative;
        if (lanes->empty()) return result;
        result.mask = 0;
        for (const std::uint8_t lane : *lanes) {
            if (result.mask >> lane != 0)
                return error(column, "a write mask names lanes once, in the order xyzw");
            result.mask = static_cast<Mask>(result.mask | 1u << lane);
        }
        return result;
    }

    Result<Source> parse_source(LineScanner& scan) {
        const int column = scan.column();
        const bool inverted = scan.take("!");
        const bool negated = !inverted && scan.take("-");
        auto target = parse_register(scan);
        if (!target) return target.error();
        Source result;
        result.file = target->file;
        result.index = target->index;
        result.relative = target->relative;
        const bool absolute = target->absolute;
        if (inverted && absolute) return error(column, "! and _abs exclude each other");
        result.modifier = inverted              ? Modifier::Not
                          : negated && absolute ? Modifier::AbsNegate
                          : negated             ? Modifier::Negate
                          : absolute            ? Modifier::Abs
                                                : Modifier::None;
        auto lanes = parse_lanes(scan);
        if (!lanes) return lanes.error();
        for (std::size_t lane = 0; lane < 4 && !lanes->empty(); ++lane)
            result.swizzle[lane] = (*lanes)[std::min(lane, lanes->size() - 1)];
        return result;
    }

    std::string_view text_;
    std::string file_name_;
    std::optional<Profile> x_profile_;
    int line_number_ = 0;
    bool has_version_ = false;
    Shader shader_;
};

}  // namespace

Result<Shader> parse(std::string_view text, std::string_view file_name,
                     std::optional<Profile> x_profile) {
    return Parser(text, file_name, x_profile).parse();
}

}  // namespace intaglio::d3d9
