// A module as text: complete, so that parse(print(m)) == m for every module that verifies, and
// readable, because it is what --dump-ir shows, what the tests of the passes are written in, and
// what error messages point into. docs/ir.md describes the grammar.
#pragma once

#include <string>
#include <string_view>

#include "generator/ir/module.h"

namespace intaglio::ir {

// The whole module, one declaration or instruction a line, ending in a line break.  Never fails: a
// value id or an index that is out of range is printed as it is, for the verifier's sake.
std::string print(const Module& module);

// One constant component: the shortest decimal that reads back to the same bits ("0.1", "-0.0",
// "1e-40", "inf"), or the bits in hexadecimal ("0x7fc00000", every NaN); an int in decimal; "true"
// and "false".
std::string print_component(Scalar scalar, std::uint32_t bits);

// Words of the text that belong to no op, shared with the parser; indexed by the enumerators.
constexpr std::string_view stage_words[] = {"vertex", "pixel", "function"};
constexpr std::string_view semantic_words[] = {"attribute", "interpolant", "position",
                                               "target",    "parameter",   "result",
                                               "depth",     "clip"};
constexpr std::string_view loop_form_words[] = {"", "rolled", "unrolled"};

}  // namespace intaglio::ir
