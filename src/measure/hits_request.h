// The variant that says where it hits: what is held against the exact hits, on a device, in the
// interpreter and in the evaluator alike.
#pragma once

#include "src/variant/variant.h"

namespace intaglio::measure {

// The same search, shadow and knobs with output=displaced, knowing what that shader has names for.
// It drops no pixel at the tile's edge (`clip_tile`): a dropped pixel would say nothing of its ray,
// and whether it is dropped follows from where the ray hits.
VariantRequest hits_request(const dsl::Catalogue& catalogue, VariantRequest request);

}  // namespace intaglio::measure
