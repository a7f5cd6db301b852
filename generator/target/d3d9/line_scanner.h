// Walks over one line of assembly text; white space between tokens means nothing.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace intaglio::d3d9 {

class LineScanner {
  public:
    explicit LineScanner(std::string_view line) : line_(line) {}

    // 1-based, of the next token.
    int column() { return skip_blanks(), static_cast<int>(at_) + 1; }
    bool at_end() { return skip_blanks(), at_ == line_.size(); }
    // The next character, not skipped; 0 at the end.
    char peek() { return at_end() ? '\0' : line_[at_]; }
    // The same, without skipping blanks first.
    char peek_adjacent() const { return at_ < line_.size() ? line_[at_] : '\0'; }

    // Skips the text if it comes next.
    bool take(std::string_view text);
    // The longest run of letters that comes next; likewise letters, digits and underscores;
    // likewise all but blanks, commas and brackets.
    std::string_view letters();
    std::string_view word();
    std::string_view token();
    // A run of digits up to `most`; nothing if there is none or it is larger.
    std::optional<int> number(int most);
    // A signed decimal integer of 32 bits.
    std::optional<std::uint32_t> integer();
    // The bits of a float: decimal, or Direct3D's 1.#INF, 1.#QNAN and 1.#IND.
    std::optional<std::uint32_t> real();

  private:
    void skip_blanks();
    template <typename Accepts>
    std::string_view run(Accepts accepts);

    std::string_view line_;
    std::size_t at_ = 0;
};

}  // namespace intaglio::d3d9
