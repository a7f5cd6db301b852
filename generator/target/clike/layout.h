// Lines of at most 100 columns, and comments.
#pragma once

#include <string>
#include <string_view>

#include "generator/base/text.h"

namespace intaglio::clike {

constexpr int line_width = 100;

// Appends a statement.  One that is too long is broken before an operator or after a comma, at the
// outermost level of parentheses that helps, and continued with a deeper indentation.
void put_statement(TextBuilder& out, std::string_view statement);

// Appends "// words", wrapped at the line width.  Whatever would end the comment early or continue
// it is removed.
void put_comment(TextBuilder& out, std::string_view words);

}  // namespace intaglio::clike
