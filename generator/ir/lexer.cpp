// The tokenizer: one pass, one character of lookahead.
#include "generator/ir/lexer.h"

#include <fmt/format.h>

namespace intaglio::ir {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_word(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || is_digit(c);
}

int hex_digit(char c) {
    if (is_digit(c)) return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

class Lexer {
  public:
    Lexer(std::string_view text, std::string_view file_name) : text_(text), file_name_(file_name) {}

    Result<std::vector<Token>> run() {
        std::vector<Token> tokens;
        for (;;) {
            skip_space();
            Token token;
            token.line = line_;
            token.column = column_;
            if (position_ == text_.size()) {
                tokens.push_back(std::move(token));
                return tokens;
            }
            if (!read(token))
                return input_error("ir-parse", error_, std::string(file_name_), line_, column_);
            tokens.push_back(std::move(token));
        }
    }

  private:
    char peek(std::size_t ahead = 0) const {
        return position_ + ahead < text_.size() ? text_[position_ + ahead] : '\0';
    }

    char take() {
        const char c = text_[position_++];
        if (c == '\n') {
            ++line_;
            column_ = 1;
        } else {
            ++column_;
        }
        return c;
    }

    void skip_space() {
        while (position_ < text_.size()) {
            const char c = peek();
            if (c == ' ' || c == '\t' || c == '\r' || c == '\n') {
                take();
            } else if (c == '/' && peek(1) == '/') {
                while (position_ < text_.size() && peek() != '\n') take();
            } else {
                return;
            }
        }
    }

    bool read(Token& token) {
        const char c = peek();
        if (c == '"') return read_string(token);
        if (c == '%') {
            take();
            if (!is_word(peek())) return fail("a value is written as % and a number or a word");
            token.kind = Token::Kind::Value;
            while (is_word(peek())) token.text += take();
            return true;
        }
        if (is_digit(c) || (c == '-' && (is_digit(peek(1)) || peek(1) == 'i'))) {
            read_number(token);
            return true;
        }
        if (is_word(c)) {
            token.kind = Token::Kind::Word;
            while (is_word(peek())) token.text += take();
            return true;
        }
        if (c != '\0' && std::string_view("(){}[],=:@#$.").find(c) != std::string_view::npos) {
            token.kind = Token::Kind::Punctuation;
            token.text = take();
            return true;
        }
        const bool printable = c >= 0x20 && c < 0x7f;
        return fail(printable ? fmt::format("'{}' has no meaning here", c)
                              : fmt::format("the byte 0x{:02x} has no meaning here",
                                            static_cast<unsigned char>(c)));
    }

    // Digits, letters and points ("0x3f800000", "2d", "1.5e-3", "-inf"); the parser decides what
    // the number must be.
    void read_number(Token& token) {
        token.kind = Token::Kind::Number;
        token.text += take();
        for (;;) {
            const char c = peek();
            const bool exponent = (token.text.back() == 'e' || token.text.back() == 'E') &&
                                  token.text.find_first_of("xX") == std::string::npos;
            if (is_word(c) || c == '.' || ((c == '-' || c == '+') && exponent))
                token.text += take();
            else
                return;
        }
    }

    bool read_string(Token& token) {
        token.kind = Token::Kind::String;
        take();
        for (;;) {
            if (position_ == text_.size() || peek() == '\n')
                return fail("a string ends on the line it begins on");
            const char c = take();
            if (c == '"') return true;
            if (c != '\\') {
                token.text += c;
            } else if (!read_escape(token)) {
                return fail(
                    "a backslash in a string is followed by a quote, a backslash, n, or x and two "
                    "hex digits");
            }
        }
    }

    bool read_escape(Token& token) {
        const char c = peek();
        if (c == '"' || c == '\\') {
            token.text += take();
            return true;
        }
        if (c == 'n') {
            take();
            token.text += '\n';
            return true;
        }
        if (c != 'x' || hex_digit(peek(1)) < 0 || hex_digit(peek(2)) < 0) return false;
        token.text += static_cast<char>(hex_digit(peek(1)) * 16 + hex_digit(peek(2)));
        for (int i = 0; i < 3; ++i) take();
        return true;
    }

    bool fail(std::string sentence) {
        error_ = std::move(sentence);
        return false;
    }

    std::string_view text_;
    std::string_view file_name_;
    std::size_t position_ = 0;
    int line_ = 1;
    int column_ = 1;
    std::string error_;
};

}  // namespace

Result<std::vector<Token>> tokenize(std::string_view text, std::string_view file_name) {
    return Lexer(text, file_name).run();
}

}  // namespace intaglio::ir
