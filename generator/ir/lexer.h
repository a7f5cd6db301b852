// Splits IR text into tokens.  White space and comments ("// to the end of the line") separate
// tokens and mean nothing.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "generator/base/result.h"

namespace intaglio::ir {

struct Token {
    enum class Kind { Word, Number, String, Value, Punctuation, End };
    Kind kind = Kind::End;
    std::string
        text;  // a string without its quotes, escapes resolved, a value without its percent sign
    int line = 1;
    int column = 1;  // in bytes, from 1
};

// The tokens of the text, the last of kind End; or the first malformed one as an error [ir-parse].
Result<std::vector<Token>> tokenize(std::string_view text, std::string_view file_name);

}  // namespace intaglio::ir
