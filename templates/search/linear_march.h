// What the searches with a refinement begin with: equal steps down the ray to the first sample that
// is not below it.  The crossing lies within one step before that sample, if no feature is thinner
// than a step.
#pragma once

#include "generator/dsl/technique.h"

namespace intaglio::templates {

// How far the relief rises above the ray at t; below 0 the ray is still outside.
inline dsl::float1 gap(const dsl::Relief& relief, const dsl::Ray& ray, dsl::float1 t) {
    return relief.height(ray.at(t)) - (1 - t);
}

struct Crossing {
    dsl::float1 t;        // of the sample that ended the march; the ray's end if none did
    dsl::float1 inside;   // the gap there
    dsl::float1 outside;  // the gap one step before
    dsl::bool1 found;     // always on the floor of the relief, which no rounding can miss

    dsl::Hit hit(const dsl::Ray& ray, dsl::float1 at) const {
        // Where nothing was found the last gap is the relief's height: there the ray is at 0.
        return {dsl::let("displaced", ray.at(at)), 1 - at, found, inside};
    }
};

// `march` runs once less often than there are samples, `step` apart: the first one stands before
// it. Like the papers' listings it spends no read on the entry point: the profile before the first
// sample is level with it.
inline Crossing march_linearly(const dsl::Relief& relief, const dsl::Ray& ray,
                               const dsl::Loop& march, float step) {
    using namespace dsl;
    Step marching("march", "Walk down the ray until a sample of the relief rises above it.");
    var<float1> t{"t", step}, inside{"inside", gap(relief, ray, step)};
    var<float1> outside{"outside", ray.entry_height ? *ray.entry_height - 1.0f : inside - step};
    for (int1 i : march) {
        march.until(inside >= 0.0f);
        outside = inside;
        t = (i + 2) * step;  // from i, so that the samples do not depend on each other
        inside = gap(relief, ray, t);
    }
    const bool last_section = relief.section + 1 == relief.sections;
    return {t, inside, outside, last_section ? bool1(true) : inside >= 0.0f};
}

}  // namespace intaglio::templates
