// Runs the body of an emitted GLSL main() on the CPU, so that the text itself can be compared with
// the module it was printed from: parentheses, names, scopes, and the order in which variables are
// stored are what it is there to catch. It reads the text by the grammar of GLSL and knows nothing
// of how it was made; arithmetic is that of the evaluator. Texture reads and derivatives are not
// covered.
#pragma once

#include <map>
#include <string>

#include "generator/base/result.h"
#include "generator/ir/evaluate.h"

namespace intaglio::testing {

struct TextValue {
    ir::Type type;
    ir::ConstantBits bits{};
};

// Globals by name ("scale", or "world[2]" for an array's element) to what main() left in them.  An
// error says what is wrong with the text: an unknown or doubly declared name, a type that does not
// fit, a token that does not belong.
Result<std::map<std::string, TextValue>> run_main(const std::string& text,
                                                  std::map<std::string, TextValue> globals);

}  // namespace intaglio::testing
