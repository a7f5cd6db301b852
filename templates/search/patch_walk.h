// Patches of the bilinear surface along a ray: what the exact search and the exact shadow know of
// one patch, and the two baked maps (docs/maps.md) by which they leap over those that do not
// matter.
#pragma once

#include "templates/search/texel_walk.h"

namespace intaglio::templates {

// How far the relief rises above the ray at s from where the ray is: (a s + b) s + c.
struct Profile {
    dsl::float1 a, b, c;

    // Over a patch with this height at its origin, this rise along both axes and this twist, from
    // `place` in it in this direction, in cells per unit of s.  The ray is `ray_height` high there
    // and falls by `fall` per unit of s.
    static Profile of(dsl::float1 height, dsl::float2 rise, dsl::float1 twist, dsl::float2 place,
                      dsl::float2 direction, dsl::float1 ray_height, float fall);

    dsl::float1 at(dsl::float1 s) const { return (a * s + b) * s + c; }
};

// The maps of summits and of corners; read nearest, of the relief's finest level.
struct BakedPatches {
    dsl::sampler2D summits{"summit_map",
                           "highest point of a patch, and of those within 2, 6 and 20 of it",
                           dsl::sampler2D::Filter::Nearest};
    dsl::sampler2D corners{"patch_map", "heights at the corners of each patch",
                           dsl::sampler2D::Filter::Nearest};
    // How many patches the squares behind the channels of summit_map reach beyond the middle one.
    static constexpr float reach[] = {0, 2, 6, 20};

    // The last level of the summits is one texel: the top of the map.
    dsl::float4 top() const {
        constexpr float last_level = 14;
        return summits.sample_level(dsl::float2(0.5f, 0.5f), last_level);
    }
    // Where on the ray the square of that reach ends whose middle is the ray's cell, given the
    // cell's next lines: before its border by as much as no rounding leads beyond.
    static dsl::float1 border(const TexelWalk& cells, dsl::float2 next, int square) {
        constexpr float margin = 1.0f / 16;
        const dsl::float2 lines = next + cells.pause * (reach[square] - margin);
        return min(lines.x(), lines.y());
    }
    // The lines crossed at t, which is the nearer of the two next ones or behind it.
    static dsl::float2 crossed_at(const TexelWalk& cells, dsl::float2 crossed, dsl::float2 next,
                                  dsl::float1 t) {
        return max(TexelWalk::over_nearer(crossed, next), floor(cells.within + cells.speed * t));
    }
    // The ray's cell, entered at t.
    Profile profile(const dsl::Relief& relief, const TexelWalk& cells, dsl::float2 crossed,
                    dsl::float1 t, dsl::float1 ray_height, float fall) const;
};

inline Profile Profile::of(dsl::float1 height, dsl::float2 rise, dsl::float1 twist,
                           dsl::float2 place, dsl::float2 direction, dsl::float1 ray_height,
                           float fall) {
    using namespace dsl;
    const float2 slope = let("slope", rise + place.yx() * twist);
    return {let("a", twist * direction.x() * direction.y()), let("b", dot(slope, direction) + fall),
            let("c", height + dot(rise, place) + twist * place.x() * place.y() - ray_height)};
}

inline Profile BakedPatches::profile(const dsl::Relief& relief, const TexelWalk& cells,
                                     dsl::float2 crossed, dsl::float1 t, dsl::float1 ray_height,
                                     float fall) const {
    using namespace dsl;
    const float4 texel = let("corners", corners.sample_level(cells.cell(crossed), 0.0f));
    const float1 h00 = let("h00", relief.in_section(texel.x()));
    const float1 h10 = let("h10", relief.in_section(texel.y()));
    const float1 h01 = let("h01", relief.in_section(texel.z()));
    const float1 h11 = let("h11", relief.in_section(texel.w()));
    const float2 rise = let("rise", float2(h10 - h00, h01 - h00));
    // The corners are the map's, not seen along the ray.
    const float2 place = let("place", saturate(-cells.way) + cells.way * cells.inside(crossed, t));
    return Profile::of(h00, rise, let("twist", h11 - h10 - rise.y()), place,
                       cells.way * cells.speed, ray_height, fall);
}

}  // namespace intaglio::templates
