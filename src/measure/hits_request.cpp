// A request turned into another.
#include "src/measure/hits_request.h"

#include <utility>

namespace intaglio::measure {

VariantRequest hits_request(const dsl::Catalogue& catalogue, VariantRequest request) {
    request.surface = dsl::with_part(request.surface, "output", "displaced");
    std::erase_if(request.knobs, [](const auto& knob) { return knob.first == "clip_tile"; });
    if (request.known.empty()) return request;
    // What is known of a shading is unknown to it.
    const passes::Known known = std::exchange(request.known, {});
    const Result<Recorded> recorded = record_variant(catalogue, request);
    if (recorded) request.known = passes::part_of(known, recorded->program);
    return request;
}

}  // namespace intaglio::measure
