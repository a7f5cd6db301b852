// What a target's capabilities forbid, as the first legalising pass of every target.
#pragma once

#include "generator/target/target.h"

namespace intaglio {

// Refuses a module that asks for more than the target's language can say, naming the limit and the
// line.
Status check_limits(ir::Module& module, const Target& target, Notes& notes);

// The part of it that is known before loops are unrolled, which may take long: levels of reads.
Status check_levels(const ir::Module& module, const Target& target);

// The part of it that a target's own generator leaves to us: what a pixel may write at all.
Status check_outputs(const ir::Module& module, const Target& target);

inline constexpr LegalizingPass check_limits_pass{"check_limits", check_limits};

}  // namespace intaglio
