// The skeleton to copy for a new target: the smallest thing that is one.
#pragma once

#include "generator/target/target.h"

namespace intaglio {

extern const Target none;

}  // namespace intaglio
