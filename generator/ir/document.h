// The tables of docs/ir.md, made from the ops table.
#pragma once

#include <string>

namespace intaglio::ir {

// Markdown: one row for each op, in the order of the enumeration: name, operands and result,
// whether every device gives the same bits, and the exact semantics.  Ends in a line break.
std::string ops_table_markdown();

}  // namespace intaglio::ir
