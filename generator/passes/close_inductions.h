// Induction variables to closed form, so that one iteration need not wait for the one before it.
#pragma once

#include <string>
#include <vector>

#include "generator/ir/module.h"

namespace intaglio::passes {

// A carried value that grows by the same step in every iteration is computed from the index
// instead: start + i * step. Exact for ints, which wrap.  For floats it rounds differently (once
// per value instead of once per iteration) and needs the loop's consent, `closed_form`; a start of
// zero then is not added at all.  Ends with values numbered anew. Returns one sentence for each
// value it rewrote.
std::vector<std::string> close_inductions(ir::Module& module);

}  // namespace intaglio::passes
