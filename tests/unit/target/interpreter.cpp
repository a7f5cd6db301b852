// A recursive-descent reader that computes as it reads; what does not run is read without effect.
#include "tests/unit/target/interpreter.h"

#include <bit>
#include <cctype>
#include <cstdlib>
#include <set>
#include <vector>

#include <fmt/format.h>

#include "generator/ir/builder.h"

namespace intaglio::testing {
namespace {

using ir::Op;
using ir::Scalar;
using ir::Type;

struct Mistake {
    std::string sentence;
};

std::vector<std::string> tokens_of(const std::string& text) {
    std::vector<std::string> tokens;
    for (std::size_t i = 0; i < text.size();) {
        const char c = text[i];
        const auto word = [](char w) {
            return std::isalnum(static_cast<unsigned char>(w)) || w == '_';
        };
        if (std::isspace(static_cast<unsigned char>(c))) {
            ++i;
        } else if (text.compare(i, 2, "//") == 0) {
            i = text.find('\n', i);
        } else if (std::isdigit(static_cast<unsigned char>(c))) {
            std::size_t end = i;
            while (word(text[end]) || text[end] == '.' ||
                   ((text[end] == '-' || text[end] == '+') && text[end - 1] == 'e' &&
                    text[i + 1] != 'x'))
                ++end;
            tokens.push_back(text.substr(i, end - i));
            i = end;
        } else if (word(c)) {
            std::size_t end = i;
            while (word(text[end])) ++end;
            tokens.push_back(text.substr(i, end - i));
            i = end;
        } else {
            const std::string two = text.substr(i, 2);
            static const std::set<std::string> doubled = {
                "<=", ">=", "==", "!=", "&&", "||", "++", "--"};
            tokens.push_back(doubled.count(two) ? two : text.substr(i, 1));
            i += tokens.back().size();
        }
    }
    tokens.emplace_back("the end");
    return tokens;
}

const std::map<std::string, Type> types = {
    {"bool", {Scalar::Bool, 1}},  {"bvec2", {Scalar::Bool, 2}}, {"bvec3", {Scalar::Bool, 3}},
    {"bvec4", {Scalar::Bool, 4}}, {"int", {Scalar::Int, 1}},    {"ivec2", {Scalar::Int, 2}},
    {"ivec3", {Scalar::Int, 3}},  {"ivec4", {Scalar::Int, 4}},  {"float", {Scalar::Float, 1}},
    {"vec2", {Scalar::Float, 2}}, {"vec3", {Scalar::Float, 3}}, {"vec4", {Scalar::Float, 4}}};

const std::map<std::string, Op> functions = {
    {"abs", Op::Abs},           {"min", Op::Min},   {"max", Op::Max},    {"floor", Op::Floor},
    {"fract", Op::Frac},        {"sqrt", Op::Sqrt}, {"exp2", Op::Exp2},  {"log2", Op::Log2},
    {"inversesqrt", Op::Rsqrt}, {"pow", Op::Pow},   {"sin", Op::Sin},    {"cos", Op::Cos},
    {"mix", Op::Lerp},          {"dot", Op::Dot},   {"cross", Op::Cross}};

struct Binary {
    Op op;
    int level;
};
const std::map<std::string, Binary> binaries = {
    {"||", {Op::Or, 1}},        {"&&", {Op::And, 2}},          {"==", {Op::Equal, 3}},
    {"!=", {Op::NotEqual, 3}},  {"<", {Op::Less, 4}},          {">", {Op::Greater, 4}},
    {"<=", {Op::LessEqual, 4}}, {">=", {Op::GreaterEqual, 4}}, {"+", {Op::Add, 5}},
    {"-", {Op::Sub, 5}},        {"*", {Op::Mul, 6}},           {"/", {Op::Div, 6}}};

class Interpreter {
  public:
    Interpreter(const std::string& text, std::map<std::string, TextValue> globals)
        : tokens_(tokens_of(text)), scopes_{std::move(globals)} {}

    std::map<std::string, TextValue> run() {
        while (token() != "main") next();
        for (const char* expected : {"main", "(", ")"}) expect(expected);
        block(true);
        return scopes_.front();
    }

  private:
    const std::string& token() const { return tokens_[at_]; }
    std::string next() {
        if (at_ + 1 >= tokens_.size()) throw Mistake{"the text ends too early"};
        return tokens_[at_++];
    }
    void expect(const std::string& wanted) {
        const std::string found = next();
        if (found != wanted) throw Mistake{fmt::format("expected {} and found {}", wanted, found)};
    }
    bool accept(const std::string& wanted) {
        if (token() != wanted) return false;
        ++at_;
        return true;
    }

    TextValue& variable(const std::string& name) {
        for (auto scope = scopes_.rbegin(); scope != scopes_.rend(); ++scope)
            if (const auto found = scope->find(name); found != scope->end()) return found->second;
        throw Mistake{fmt::format("{} is not declared here", name)};
    }

    // Each statement says whether a break is under way; nothing runs until the loop's end then.
    bool block(bool runs) {
        expect("{");
        scopes_.emplace_back();
        bool broken = false;
        while (!accept("}")) broken = statement(runs && !broken) || broken;
        scopes_.pop_back();
        return broken;
    }

    bool statement(bool runs) {
        if (token() == "if") return branch(runs);
        if (token() == "for") return loop(runs), false;
        if (accept("break")) return expect(";"), runs;
        if (const auto type = types.find(token()); type != types.end()) {
            next();
            declaration(type->second, runs);
            return false;
        }
        const std::string name = next();
        expect("=");
        const TextValue value = expression(0);
        TextValue& stored = variable(name);
        if (stored.type != value.type)
            throw Mistake{fmt::format("{} gets a value of another type", name)};
        if (runs) stored = value;
        expect(";");
        return false;
    }

    void declaration(Type type, bool runs) {
        const std::string name = next();
        // Garbage until it is stored: a read of it must not go unseen.
        TextValue value{type, {0x12345678, 0x12345678, 0x12345678, 0x12345678}};
        if (accept("=")) {
            value = expression(0);
            if (value.type != type)
                throw Mistake{fmt::format("{} starts with a value of another type", name)};
        }
        if (!scopes_.back().emplace(name, value).second)
            throw Mistake{fmt::format("{} is declared twice", name)};
        static_cast<void>(runs);
        expect(";");
    }

    bool branch(bool runs) {
        expect("if");
        expect("(");
        const TextValue condition = expression(0);
        if (condition.type != ir::bool1) throw Mistake{"a condition is not a bool"};
        expect(")");
        const bool holds = condition.bits[0] != 0;
        bool broken = token() == "{" ? block(runs && holds) : statement(runs && holds);
        if (accept("else")) broken = block(runs && !holds) || broken;
        return broken;
    }

    void loop(bool runs) {
        for (const char* expected : {"for", "(", "int"}) expect(expected);
        const std::string index = next();
        for (const char* expected : {"=", "0", ";"}) expect(expected);
        expect(index);
        expect("<");
        const int count = std::atoi(next().c_str());
        for (const char* expected : {";", "++"}) expect(expected);
        expect(index);
        expect(")");
        const std::size_t body = at_;
        bool broken = !runs || count == 0;
        int i = 0;
        do {
            at_ = body;
            scopes_.push_back({{index, {ir::int1, {static_cast<std::uint32_t>(i)}}}});
            broken = block(!broken) || broken;
            scopes_.pop_back();
        } while (!broken && ++i < count);
    }

    TextValue apply(Op op, std::vector<TextValue> operands, int result_width = 0,
                    const ir::Instruction& extra = {}) {
        // A scalar beside a vector stands for each component.
        if (op != Op::Select && op != Op::Compose && op != Op::Dot) {
            int width = 1;
            for (const TextValue& operand : operands) width = std::max(width, operand.type.width);
            for (TextValue& operand : operands)
                if (operand.type.width == 1 && width > 1) {
                    operand.type.width = width;
                    operand.bits.fill(operand.bits[0]);
                    for (int i = width; i < 4; ++i) operand.bits[static_cast<std::size_t>(i)] = 0;
                }
        }
        std::vector<Type> operand_types;
        std::vector<ir::ConstantBits> bits;
        for (const TextValue& operand : operands) {
            operand_types.push_back(operand.type);
            bits.push_back(operand.bits);
            const bool mixed = op != Op::Select && operand.type.scalar != operands[0].type.scalar;
            if (mixed) throw Mistake{fmt::format("{} mixes types", ir::info(op).name)};
        }
        ir::Instruction instruction = extra;
        instruction.op = op;
        instruction.operands.resize(operands.size());
        const auto computed = ir::evaluate_op(instruction, operand_types, bits, result_width);
        if (!computed) throw Mistake{fmt::format("{} cannot be computed", ir::info(op).name)};
        return {ir::result_type(op, operand_types, result_width), *computed};
    }

    TextValue expression(int level) {
        TextValue left = unary();
        while (true) {
            const auto binary = binaries.find(token());
            if (binary != binaries.end() && binary->second.level > level) {
                next();
                left = apply(binary->second.op, {left, expression(binary->second.level)});
            } else if (level == 0 && accept("?")) {
                const TextValue middle = expression(0);
                expect(":");
                const TextValue last = expression(0);
                left = apply(Op::Select, {left, middle, last});
            } else {
                return left;
            }
        }
    }

    TextValue unary() {
        if (accept("!")) return apply(Op::Not, {unary()});
        if (accept("-")) return apply(Op::Neg, {unary()});
        if (token() == "--" || token() == "++") throw Mistake{"a sign became a decrement"};
        TextValue value = primary();
        while (accept(".")) value = swizzle(value, next());
        return value;
    }

    TextValue swizzle(const TextValue& value, const std::string& letters) {
        if (value.type.width == 1) throw Mistake{"a component of a scalar"};
        ir::Instruction instruction;
        for (std::size_t i = 0; i < letters.size(); ++i) {
            instruction.lanes[i] = static_cast<std::uint8_t>(std::string("xyzw").find(letters[i]));
            if (instruction.lanes[i] >= value.type.width)
                throw Mistake{"a component that the vector does not have"};
        }
        return apply(Op::Swizzle, {value}, static_cast<int>(letters.size()), instruction);
    }

    std::vector<TextValue> arguments() {
        std::vector<TextValue> values;
        expect("(");
        do values.push_back(expression(0));
        while (accept(","));
        expect(")");
        return values;
    }

    static TextValue literal(const std::string& word) {
        if (word.find_first_of(".e") == std::string::npos || word.starts_with("0x"))
            return {ir::int1, {static_cast<std::uint32_t>(std::strtoul(word.c_str(), nullptr, 0))}};
        return {ir::float1, {ir::float_bits(std::strtof(word.c_str(), nullptr))}};
    }

    TextValue primary() {
        if (accept("(")) {
            const TextValue value = expression(0);
            expect(")");
            return value;
        }
        const std::string word = next();
        if (std::isdigit(static_cast<unsigned char>(word[0]))) return literal(word);
        if (word == "true" || word == "false") return {ir::bool1, {word == "true" ? 1u : 0u}};
        if (token() == "(") return call(word);
        if (accept("[")) {
            const std::string element = next();
            expect("]");
            return variable(fmt::format("{}[{}]", word, element));
        }
        return variable(word);
    }

    TextValue call(const std::string& name) {
        const std::vector<TextValue> values = arguments();
        if (name == "uintBitsToFloat") return {ir::float1, {values[0].bits[0]}};
        if (name == "clamp") {
            if (values[1].bits[0] != 0 || values[2].bits[0] != ir::float_bits(1.0f))
                throw Mistake{"an odd clamp"};
            return apply(Op::Saturate, {values[0]});
        }
        if (const auto type = types.find(name); type != types.end())
            return construct(type->second, values);
        const auto function = functions.find(name);
        if (function == functions.end()) throw Mistake{fmt::format("{} is not a function", name)};
        if (static_cast<int>(values.size()) != ir::info(function->second).operand_count)
            throw Mistake{fmt::format("{} gets another number of arguments", name)};
        return apply(function->second, values);
    }

    TextValue construct(Type type, const std::vector<TextValue>& values) {
        if (values.size() == 1 && values[0].type.scalar == Scalar::Int &&
            type.scalar == Scalar::Float && values[0].type.width == type.width)
            return apply(Op::ToFloat, values);
        if (values.size() == 1 && values[0].type == Type{type.scalar, 1}) {
            TextValue repeated{type, {}};
            for (int i = 0; i < type.width; ++i)
                repeated.bits[static_cast<std::size_t>(i)] = values[0].bits[0];
            return repeated;
        }
        const TextValue composed = apply(Op::Compose, values);
        if (composed.type != type) throw Mistake{"a constructor gets another number of components"};
        return composed;
    }

    std::vector<std::string> tokens_;
    std::size_t at_ = 0;
    std::vector<std::map<std::string, TextValue>> scopes_;
};

}  // namespace

Result<std::map<std::string, TextValue>> run_main(const std::string& text,
                                                  std::map<std::string, TextValue> globals) {
    try {
        return Interpreter(text, std::move(globals)).run();
    } catch (const Mistake& mistake) {
        return internal_error("bad-text", mistake.sentence);
    }
}

}  // namespace intaglio::testing
