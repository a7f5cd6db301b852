// A walk along a ray through the cells of the height map's grid, one after the other, none skipped.
//
// Both axes are mirrored where the ray runs towards lower coordinates, so that it always moves up:
// after k = (i, j) lines crossed on either axis, the next ones lie at whole numbers k + 1, and a
// ray that does not move on an axis (view along it, or straight down) reaches its next line at no t
// within reach.  All places are computed from k, which is whole and exact, so that errors do not
// add up along the ray; reads are wrapped to the first tile, where float coordinates are finest.
#pragma once

#include "generator/dsl/technique.h"

namespace intaglio::templates {

struct TexelWalk {
    dsl::float2 grid;    // cells of the map on each axis
    dsl::float2 way;     // +1 or -1: the direction of the ray on each axis
    dsl::float2 corner;  // cell of the ray's start, by its corner of least coordinates
    dsl::float2 first;   // grid point where the cell of the ray's start begins, seen along the ray
    dsl::float2 within;  // where in that cell the ray starts, in [0, 1], seen along the ray
    dsl::float2 speed;   // cells per unit of t, not negative
    dsl::float2 pause;   // its reciprocal: t per cell

    // Grid points lie `offset` of a cell from the corners of the texels: 0 walks texels, 0.5 walks
    // the patches between texel centres.
    static TexelWalk along(const dsl::Ray& ray, dsl::float2 grid, float offset);

    // t at the next line of each axis.
    dsl::float2 next(dsl::float2 crossed) const { return (crossed + 1.0f - within) * pause; }
    // Where the ray is in its cell at t: 0 at the lines it came from, 1 at the next ones.
    dsl::float2 inside(dsl::float2 crossed, dsl::float1 t) const {
        return saturate(within + speed * t - crossed);
    }
    // Texture coordinate of the middle of the texel at the cell's near corner; the texels at its
    // other corners lie texel_step() from it.
    dsl::float2 near_texel(dsl::float2 crossed) const;
    dsl::float2 texel_step() const { return way / grid; }
    // Texture coordinate of what a map read nearest has for the cell.
    dsl::float2 cell(dsl::float2 crossed) const {
        return (corner + 0.5f) / grid + way / grid * crossed;
    }
    // The lines crossed once the walk has gone over the nearer of the two next ones.
    static dsl::float2 over_nearer(dsl::float2 crossed, dsl::float2 next);
};

inline TexelWalk TexelWalk::along(const dsl::Ray& ray, dsl::float2 grid, float offset) {
    using namespace dsl;
    const float2 start = let("start", frac(ray.uv) * grid - offset);
    const float2 corner = let("corner", floor(start));
    const float2 path = let("path", -ray.reach * grid);
    const auto forward = [](float1 component) {
        return select(component >= 0.0f, float1(1.0f), -1.0f);
    };
    const float2 way = let("way", float2(forward(path.x()), forward(path.y())));
    const float2 backward = let("backward", saturate(-way));
    const float2 speed = let("speed", abs(path));
    const float2 pause = let("pause", float2(1.0f, 1.0f) / max(speed, float1(tiny)));
    return {grid,
            way,
            corner,
            let("first", corner + (offset > 0 ? backward : float2(0.0f, 0.0f))),
            let("within", backward + way * (start - corner)),
            speed,
            pause};
}

inline dsl::float2 TexelWalk::near_texel(dsl::float2 crossed) const {
    using namespace dsl;
    const float2 texel = let("texel", first + way * crossed);
    const float2 wrapped = let("wrapped", texel - floor((texel + 0.5f) / grid) * grid);
    return (wrapped + 0.5f) / grid;
}

inline dsl::float2 TexelWalk::over_nearer(dsl::float2 crossed, dsl::float2 next) {
    using namespace dsl;
    const bool1 x_first = next.x() <= next.y();
    return crossed +
           float2(select(x_first, float1(1.0f), 0.0f), select(x_first, float1(0.0f), 1.0f));
}

}  // namespace intaglio::templates
