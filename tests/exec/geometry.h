// What the tests of geometry below a polygon share: one size, one light, and a program from a
// request.
#pragma once

#include <cmath>

#include "tests/exec/bench.h"

#include "src/measure/displaced.h"
#include "src/measure/hits.h"

namespace intaglio::exec {

using measure::Direction;
using reference::HeightField;

inline constexpr int side = 64;  // texels and pixels of the maps and pictures here
inline constexpr Direction light = {45, 130};
inline constexpr float scale = static_cast<float>(test_scale);

inline check::Program compiled(const VariantRequest& wanted) {
    const dsl::Catalogue catalogue = measure::with_geometry(templates::all_techniques());
    return must(link_variant(must(make_variant(catalogue, wanted))));
}

inline VariantRequest displaced_request() {
    return request("search=displaced,output=displaced", "glsl_450");
}

inline HeightField field_of(const measure::MapSet& set) {
    return set.height_field(reference::FilterWeights::Exact);
}

inline double mean_error(const measure::MapSet& set, const vulkan::Picture& picture,
                         Direction view) {
    const HeightField field = field_of(set);
    const measure::ExactPicture exact =
        measure::trace_exact(field, view, light, scale, picture.width, picture.height);
    double sum = 0;
    for (const measure::HitError& error : measure::compare_hits(picture, exact, field, view, scale))
        sum += static_cast<double>(error.texels);
    return sum / static_cast<double>(picture.pixels.size());
}

}  // namespace intaglio::exec
