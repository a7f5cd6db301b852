// A recursive descent over the tokens, one member function a rule of the grammar in docs/ir.md. The
// first error is kept and every rule returns at once; nothing here decides whether the module makes
// sense: that is verify.h.
#include "generator/ir/parse.h"

#include <charconv>
#include <map>
#include <optional>
#include <unordered_map>

#include <fmt/format.h>

#include "generator/ir/lexer.h"
#include "generator/ir/print.h"

namespace intaglio::ir {
namespace {

using Kind = Token::Kind;

// Reads the whole of `text` as a number.
template <typename Number, typename... Base>
std::optional<Number> number_from(std::string_view text, Base... base) {
    Number value{};
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value, base...);
    return error == std::errc() && stop == end ? std::optional(value) : std::nullopt;
}

std::optional<Type> type_named(std::string_view word) {
    for (Scalar scalar : {Scalar::Bool, Scalar::Int, Scalar::Float})
        for (int width = 1; width <= 4; ++width)
            if (to_string(Type{scalar, width}) == word) return Type{scalar, width};
    return std::nullopt;
}

std::optional<std::uint32_t> component_bits(Scalar scalar, std::string_view text) {
    if (text.substr(0, 2) == "0x") return number_from<std::uint32_t>(text.substr(2), 16);
    switch (scalar) {
        case Scalar::Bool:
            if (text == "true" || text == "false") return text == "true" ? 1u : 0u;
            return std::nullopt;
        case Scalar::Int:
            if (const auto value = number_from<std::int32_t>(text))
                return static_cast<std::uint32_t>(*value);
            return std::nullopt;
        case Scalar::Float:
            // from_chars would also take "nan(...)"; only the quiet NaN has a word.
            if (text == "nan") return 0x7fc00000u;
            if (text == "inf" || text == "-inf") return text == "inf" ? 0x7f800000u : 0xff800000u;
            if (text.find_first_not_of("0123456789.eE+-") != std::string_view::npos)
                return std::nullopt;
            if (const auto value = number_from<float>(text)) return float_bits(*value);
            return std::nullopt;
    }
    return std::nullopt;
}

class Parser {
  public:
    Parser(std::vector<Token> tokens, std::string_view file_name)
        : tokens_(std::move(tokens)), file_name_(file_name) {}

    Result<Module> run() {
        if (!module() || !resolve_values()) return *error_;
        return std::move(module_);
    }

  private:
    // --- tokens
    // -------------------------------------------------------------------------------------------------
    const Token& next() const { return tokens_[position_]; }
    const Token& take() {
        const Token& token = tokens_[position_];
        if (token.kind != Kind::End) ++position_;
        return token;
    }
    bool at(std::string_view punctuation) const {
        return next().kind == Kind::Punctuation && next().text == punctuation;
    }
    bool at_word(std::string_view word) const {
        return next().kind == Kind::Word && next().text == word;
    }
    bool accept(std::string_view punctuation) {
        if (!at(punctuation)) return false;
        take();
        return true;
    }
    bool accept_word(std::string_view word) {
        if (!at_word(word)) return false;
        take();
        return true;
    }
    bool expect(std::string_view punctuation) {
        return accept(punctuation) || wrong(fmt::format("'{}'", punctuation));
    }

    bool fail(const Token& token, std::string sentence) {
        if (!error_)
            error_ = input_error("ir-parse", std::move(sentence), std::string(file_name_),
                                 token.line, token.column);
        return false;
    }
    // "expected X, found Y"
    bool wrong(std::string_view expected) {
        const Token& token = next();
        if (token.kind == Kind::End)
            return fail(token, fmt::format("expected {}, found the end", expected));
        const char* prefix = token.kind == Kind::Value ? "%" : "";
        if (token.kind == Kind::String)
            return fail(token, fmt::format("expected {}, found a string", expected));
        return fail(token, fmt::format("expected {}, found '{}{}'", expected, prefix, token.text));
    }

    bool integer(int& value) {
        const auto number =
            next().kind == Kind::Number ? number_from<int>(next().text) : std::nullopt;
        if (!number) return wrong("an integer");
        take();
        value = *number;
        return true;
    }
    bool string(std::string& value) {
        if (next().kind != Kind::String) return wrong("a string in quotes");
        value = take().text;
        return true;
    }
    bool name(std::string& value) {
        if (next().kind != Kind::Word && next().kind != Kind::String) return wrong("a name");
        value = take().text;
        return true;
    }
    void optional_string(std::string& value) {
        if (next().kind == Kind::String) value = take().text;
    }
    bool type(Type& value) {
        const auto found = next().kind == Kind::Word ? type_named(next().text) : std::nullopt;
        if (!found) return wrong("a type such as float3, int1 or bool1");
        take();
        value = *found;
        return true;
    }
    template <std::size_t N, typename Enumerator>
    bool one_of(const std::string_view (&words)[N], Enumerator& value, std::string_view expected) {
        for (std::size_t i = 0; i < N; ++i)
            if (accept_word(words[i])) {
                value = static_cast<Enumerator>(i);
                return true;
            }
        return wrong(expected);
    }

    // --- declarations
    // -------------------------------------------------------------------------------------------
    bool module() {
        if (!one_of(stage_words, module_.stage, "'vertex', 'pixel' or 'function'") ||
            !string(module_.name))
            return false;
        while (!at("{"))
            if (!declaration()) return false;
        if (!region(module_.body, 0)) return false;
        return next().kind == Kind::End || wrong("the end after the module's body");
    }

    bool declaration() {
        if (accept_word("input")) return bound(module_.inputs.emplace_back());
        if (accept_word("output")) return bound(module_.outputs.emplace_back());
        if (accept_word("uniform")) return uniform(module_.uniforms.emplace_back());
        if (accept_word("sampler")) return sampler(module_.samplers.emplace_back());
        if (accept_word("file")) return string(module_.files.emplace_back());
        if (accept_word("step")) {
            Step& step = module_.steps.emplace_back();
            if (!name(step.name)) return false;
            optional_string(step.comment);
            return true;
        }
        ValueId unused;
        if (accept_word("value")) return definition(unused);
        return wrong("a declaration (input, output, uniform, sampler, file, step, value) or '{'");
    }

    bool bound(Declaration& declaration) {
        return name(declaration.name) && type(declaration.type) &&
               one_of(semantic_words, declaration.semantic,
                      "'attribute', 'interpolant', 'position', 'target', 'parameter', 'result', "
                      "'depth' or 'clip'");
    }

    bool uniform(Uniform& uniform) {
        if (!name(uniform.name) || !type(uniform.type)) return false;
        if (accept("[") && !(integer(uniform.count) && expect("]"))) return false;
        optional_string(uniform.comment);
        return true;
    }

    bool sampler(Sampler& sampler) {
        if (!name(sampler.name)) return false;
        const std::string& word = next().text;
        const bool dimension = next().kind == Kind::Number && word.back() == 'd';
        const auto number =
            dimension ? number_from<int>(std::string_view(word).substr(0, word.size() - 1))
                      : std::nullopt;
        if (!number) return wrong("a dimension, 2d or 3d");
        take();
        sampler.dimension = *number;
        if (accept_word("nearest")) sampler.filter = Sampler::Filter::Nearest;
        if (accept_word("baked")) optional_string(sampler.baked);
        optional_string(sampler.comment);
        return true;
    }

    // --- values
    // -------------------------------------------------------------------------------------------------
    // The id a value token stands for.  Words are numbered in the order in which they appear.
    bool value_id(const Token& token, ValueId& id) {
        const bool numbered = token.text[0] >= '0' && token.text[0] <= '9';
        if (numbered_ && *numbered_ != numbered)
            return fail(token,
                        "values are called by numbers or by words, not by both in one module");
        numbered_ = numbered;
        if (!numbered) {
            const auto index = static_cast<std::uint32_t>(words_.size());
            id = words_.emplace(token.text, static_cast<ValueId>(index)).first->second;
            return true;
        }
        const auto number = number_from<std::uint32_t>(token.text);
        if (!number)
            return fail(token,
                        fmt::format("%{} is not a value: its number is malformed", token.text));
        id = static_cast<ValueId>(*number);
        return true;
    }

    bool use(ValueId& id) {
        if (next().kind != Kind::Value) return wrong("a value such as %0");
        const Token& token = take();
        if (!value_id(token, id)) return false;
        uses_.push_back({id, &token});
        return true;
    }

    bool definition(ValueId& id) {
        if (next().kind != Kind::Value) return wrong("a value such as %0");
        const Token& token = take();
        Value value;
        if (!value_id(token, id)) return false;
        if (!*numbered_) value.name = token.text;
        optional_string(value.name);
        if (!type(value.type)) return false;
        if (!definitions_.emplace(id, Definition{std::move(value), &token}).second)
            return fail(token, fmt::format("%{} is already defined", token.text));
        return true;
    }

    bool uses(std::vector<ValueId>& ids) {
        do {
            if (!use(ids.emplace_back())) return false;
        } while (accept(","));
        return true;
    }

    bool list(std::vector<ValueId>& ids) {
        if (!expect("(")) return false;
        if (accept(")")) return true;
        return uses(ids) && expect(")");
    }

    // Ids are indexes into Module::values, so that they have to be dense and each must have a type.
    bool resolve_values() {
        for (const Use& use : uses_)
            if (definitions_.count(use.id) == 0)
                return fail(*use.token, fmt::format("%{} is never defined", use.token->text));
        std::uint32_t expected = 0;
        for (auto& [id, definition] : definitions_) {
            if (index_of(id) != expected)
                return fail(*definition.token,
                            fmt::format("%{} is defined but %{} is not; numbers have no gaps",
                                        index_of(id), expected));
            module_.values.push_back(std::move(definition.value));
            ++expected;
        }
        return true;
    }

    // --- instructions
    // -------------------------------------------------------------------------------------------
    bool region(Region& region, int depth) {
        if (depth > max_nesting)
            return fail(next(), fmt::format("regions nest deeper than {}", max_nesting));
        if (!expect("{")) return false;
        if (accept("(")) {
            if (!at(")")) {
                do {
                    if (!definition(region.parameters.emplace_back())) return false;
                } while (accept(","));
            }
            if (!expect(")") || !expect(":")) return false;
        }
        while (!accept("}"))
            if (!instruction(region.body.emplace_back(), depth)) return false;
        return true;
    }

    bool instruction(Instruction& instruction, int depth) {
        if (next().kind == Kind::Value) {
            do {
                if (!definition(instruction.results.emplace_back())) return false;
            } while (accept(","));
            if (!expect("=")) return false;
        }
        const auto op = next().kind == Kind::Word ? op_named(next().text) : std::nullopt;
        if (!op) return wrong("an instruction");
        instruction.op = *op;
        const Token& op_token = take();
        if (!arguments(instruction, op_token)) return false;
        if (!origin(instruction.origin)) return false;
        if (!has_regions(*op)) return true;
        if (!region(instruction.regions.emplace_back(), depth + 1)) return false;
        if (*op == Op::Loop) return true;
        return accept_word("else") ? region(instruction.regions.emplace_back(), depth + 1)
                                   : wrong("'else'");
    }

    bool arguments(Instruction& instruction, const Token& op_token) {
        switch (instruction.op) {
            case Op::Constant: return constant(instruction, op_token);
            case Op::Input: return slot(module_.inputs, instruction.slot, "input");
            case Op::Uniform:
                if (!slot(module_.uniforms, instruction.slot, "uniform")) return false;
                return !accept("[") || (integer(instruction.element) && expect("]"));
            case Op::Swizzle:
                return use(instruction.operands.emplace_back()) && swizzle(instruction, op_token);
            case Op::SampleLevel:
            case Op::SampleGrad:
            case Op::SampleImplicit:
                return slot(module_.samplers, instruction.slot, "sampler") &&
                       uses(instruction.operands);
            case Op::Loop: return loop(instruction.loop) && list(instruction.operands);
            case Op::BreakIf:
                return use(instruction.operands.emplace_back()) && list(instruction.operands);
            case Op::Yield:
            case Op::Return: return list(instruction.operands);
            default: return uses(instruction.operands);
        }
    }

    // A constant's and a swizzle's text need the type of the one result.
    bool result_type(const Instruction& instruction, const Token& op_token, Type& type) {
        if (instruction.results.size() != 1)
            return fail(op_token, fmt::format("'{}' defines one value", op_token.text));
        type = definitions_.at(instruction.result()).value.type;
        return true;
    }

    bool constant(Instruction& instruction, const Token& op_token) {
        Type type;
        if (!result_type(instruction, op_token, type)) return false;
        const bool parenthesized = accept("(");
        for (int i = 0; i < type.width; ++i) {
            if (i > 0 && !expect(",")) return false;
            const bool literal = next().kind == Kind::Number || next().kind == Kind::Word;
            const auto bits = literal ? component_bits(type.scalar, next().text) : std::nullopt;
            if (!bits) return wrong(fmt::format("a component of a {}", to_string(type)));
            take();
            instruction.bits[static_cast<std::size_t>(i)] = *bits;
        }
        return !parenthesized || expect(")");
    }

    bool swizzle(Instruction& instruction, const Token& op_token) {
        Type type;
        if (!result_type(instruction, op_token, type) || !expect(".")) return false;
        const std::string& letters = next().text;
        if (next().kind != Kind::Word || letters.size() != static_cast<std::size_t>(type.width) ||
            letters.find_first_not_of("xyzw") != std::string::npos)
            return wrong(fmt::format("{} of the letters xyzw", type.width));
        for (std::size_t i = 0; i < letters.size(); ++i)
            instruction.lanes[i] =
                static_cast<std::uint8_t>(std::string_view("xyzw").find(letters[i]));
        take();
        return true;
    }

    template <typename Entry>
    bool slot(const std::vector<Entry>& entries, int& index, std::string_view kind) {
        if (accept("$")) return integer(index);
        if (next().kind != Kind::Word) return wrong(fmt::format("the name of a declared {}", kind));
        for (std::size_t i = 0; i < entries.size(); ++i)
            if (entries[i].name == next().text) {
                index = static_cast<int>(i);
                take();
                return true;
            }
        return fail(next(), fmt::format("no {} is called '{}'", kind, next().text));
    }

    bool loop(LoopInfo& loop) {
        optional_string(loop.name);
        if (!integer(loop.trip_count)) return false;
        if (accept_word("rolled"))
            loop.form = LoopForm::Rolled;
        else if (accept_word("unrolled"))
            loop.form = LoopForm::Unrolled;
        loop.closed_form = accept_word("closed_form");
        return true;
    }

    bool origin(Origin& origin) {
        if (accept("@") && !(integer(origin.file) && expect(":") && integer(origin.line)))
            return false;
        if (!accept("#")) return true;
        if (next().kind == Kind::Number) return integer(origin.step);
        return slot(module_.steps, origin.step, "step");
    }

    struct Use {
        ValueId id;
        const Token* token;
    };
    struct Definition {
        Value value;
        const Token* token;
    };

    const std::vector<Token> tokens_;
    std::string_view file_name_;
    std::size_t position_ = 0;
    std::optional<Diagnostic> error_;
    Module module_;
    std::optional<bool> numbered_;
    std::unordered_map<std::string, ValueId> words_;
    std::vector<Use> uses_;
    std::map<ValueId, Definition> definitions_;
};

}  // namespace

Result<Module> parse(std::string_view text, std::string_view file_name) {
    auto tokens = tokenize(text, file_name);
    if (!tokens) return tokens.error();
    return Parser(std::move(*tokens), file_name).run();
}

}  // namespace intaglio::ir
