// Builds indented text line by line.  Every text the generator emits goes through one of these, so
// that indentation and line ends are decided in one place.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace intaglio {

class TextBuilder {
  public:
    explicit TextBuilder(int spaces_per_level = 4) : spaces_per_level_(spaces_per_level) {}

    // Appends one line at the current indentation; an empty line carries no spaces.
    void line(std::string_view text = {});

    template <typename... Arguments>
    void format(fmt::format_string<Arguments...> pattern, Arguments&&... arguments) {
        line(fmt::format(pattern, std::forward<Arguments>(arguments)...));
    }

    void indent() { ++level_; }
    void outdent() { --level_; }

    // Columns left of the text at the current indentation; a wrapping printer subtracts it from its
    // width.
    int column() const { return level_ * spaces_per_level_; }

    const std::string& text() const { return text_; }
    std::string take() { return std::move(text_); }

  private:
    std::string text_;
    int level_ = 0;
    int spaces_per_level_;
};

}  // namespace intaglio
