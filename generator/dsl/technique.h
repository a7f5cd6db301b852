// The parts of a surface: search, shadow, normal source, shading, output and vertex work.  Each is
// a technique: a class with knobs, a body written in the DSL, and a schedule.
//
// Conventions (docs/conventions.md): tangent space with z along the normal; V and L are unit
// vectors from the surface to the eye and to the light; height 1 is the polygon, 0 the deepest
// point; `scale` is the depth of the relief in texture units.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "generator/dsl/control.h"
#include "generator/dsl/resources.h"
#include "generator/dsl/schedule.h"

namespace intaglio::dsl {

class Technique : public KnobOwner {
  public:
    virtual ~Technique() = default;
    Technique(const Technique&) = delete;
    Technique& operator=(const Technique&) = delete;

    // How its loops are carried out; by default the target decides.
    virtual void schedule(Schedule&) const {}
    // Relations between knobs that single ranges cannot say; a sentence if they do not hold.
    virtual Status check() const { return Done{}; }

  protected:
    Technique() = default;
};

// The height field under the polygon and how it is read.
//
// A search may be run in `sections` passes (passes.h): each sees one slab of the relief as if it
// were a whole one, its own ray running from 1 at the slab's top to 0 at its floor.  Heights are
// then stretched and may lie outside [0, 1]; scale is the slab's depth.  A search that reads
// heights elsewhere than through height() maps them by in_section(); what it has stored per unit of
// height (the ratio of a cone) it divides by `sections`.
struct Relief {
    sampler2D map;
    bool in_alpha;    // heights in the map's alpha channel (a combined normal and height map), else
                      // in red
    float1 scale;     // depth of the relief in texture units
    float2 map_size;  // texels
    float1
        level;  // mip level of every height read: fixed, so that reads in loops need no derivatives
    int section = 0, sections = 1;  // the slab that is searched, 0 the top one, and how many
    float known_level = 0;          // the knob that `level` is

    // Height at a texture coordinate: in [0, 1] where there is one section.
    float1 height(float2 uv, Place place = Place::here()) const {
        return height_at_level(uv, level, place);
    }
    float1 height_at_level(float2 uv, float1 mip_level, Place place = Place::here()) const;
    // Texels of the mip level that is read; between two levels, of the finer one.
    float2 level_size() const;
    // The height in a texel of `map`, of the whole relief.
    float1 height_of(float4 texel) const { return in_alpha ? texel.w() : texel.x(); }
    // A height of the whole relief as the section sees it, and back.
    float1 in_section(float1 whole) const;
    float1 in_whole(float1 in_section) const;
};

struct Hit {
    float2 uv;      // displaced texture coordinate
    float1 height;  // of the relief there, as the relief's section sees it
    // Whether the ray met the relief before it ended.  Empty: the search cannot say (it looks its
    // answer up, it does not follow the ray), and is refused in sections.
    std::optional<bool1> found = {};
    // The relief's height where the ray ends, looked at only where nothing was found; empty: height
    // is that.
    std::optional<float1> exit_height = {};
};

// The view ray through the relief: at t in [0, 1] its height is 1 - t.
struct Ray {
    float2 uv;     // where it enters, at t = 0
    float3 view;   // unit vector to the eye
    float2 reach;  // how far it travels in texture space from top to bottom
    // The relief's height where the ray enters, where an earlier section has read it: a search may
    // spare its own read, or start its profile there.
    std::optional<float1> entry_height = {};
    // The polygon's own coordinate, whose derivatives are the pixel's, where uv starts in the first
    // tile and so jumps between tiles; empty: uv.
    std::optional<float2> polygon_uv = {};

    // Below this V.z the ray is as flat as it gets: 89.94 degrees.  Keeps V.xy / V.z finite.
    static constexpr float least_z = 1.0f / 1024.0f;

    // V.xy / V.z * scale for a unit V, written with one division and no normalize of V.xy, which is
    // 0 / 0 straight down.
    static float2 reach_of(float1 scale, float3 view);
    static Ray through(const Relief& relief, float2 uv, float3 view) {
        return {uv, view, reach_of(relief.scale, view)};
    }
    float2 at(float1 t) const { return uv - reach * t; }
};

// How the coordinate changes from pixel to pixel before displacement: the level of every colour and
// normal read.
struct Footprint {
    float2 ddx_uv, ddy_uv;
};

// The most lights that a surface is lit by in one draw.
inline constexpr int most_lights = 4;
// What belongs to light `number`, from 0: "to_light" of the first, "to_light_2" of the third.
std::string name_of_light(std::string_view name, int number);

// One light at the point that the ray met.
struct Light {
    int number;         // from 0
    float3 direction;   // unit, tangent space, to the light
    float1 visibility;  // 0 in shadow, 1 lit

    float3 colour() const;  // linear rgb
};

// What a shading model sees.  What it does not look at is not computed: a shading without normals
// costs no normal read.
struct Fragment {
    float3 normal, view;  // unit, tangent space
    float3 albedo;
    const Relief& relief;
    const Hit& hit;
    const Footprint& footprint;
};

// Where does the view ray meet the relief first?  find() may be given one section of the relief and
// of the ray, and says by Hit::found whether the next section is still to be searched.
class Search : public Technique {
  public:
    virtual Hit find(const Relief& relief, const Ray& ray) const = 0;
};

// How much of the light reaches a point of the relief?
class Shadow : public Technique {
  public:
    virtual float1 visibility(const Relief& relief, const Hit& hit, float3 light) const = 0;
    // Whether it looks at `light`: else it is asked once, for all lights.
    virtual bool depends_on_light() const { return true; }
};

class NormalSource : public Technique {
  public:
    // Unit normal of the relief in tangent space.
    virtual float3 normal(const Relief& relief, const Hit& hit,
                          const Footprint& footprint) const = 0;
};

// What a point sends to the eye of one light.  Empty: nothing of the kind.
struct Reflected {
    std::optional<float3> diffuse = {};   // the albedo dims it
    std::optional<float3> specular = {};  // it does not
};

// The colour is albedo * (ambient + the sum of diffuse) + the sum of specular, over all lights.
class Shading : public Technique {
  public:
    // Light from everywhere; as a rule uniform `ambient`.
    virtual float3 ambient(const Fragment& fragment) const;
    virtual Reflected reflect(const Fragment& fragment, const Light& light) const = 0;
};

class Output : public Technique {
  public:
    // Name of the colour target.
    virtual std::string name() const = 0;
    // True if the output needs the shaded colour; else only search and shadow are emitted.
    virtual bool shaded() const = 0;
    // The value written; `visibility` is of the first light, `colour` is 0 unless shaded().
    virtual float4 write(const Hit& hit, float1 visibility, float3 colour) const = 0;
    // Depth of the point that the ray met, in [0, 1], for the depth buffer; empty: the polygon's
    // own.  What it is computed from the vertex stage must hand on: Vertex::depth_line.
    virtual bool writes_depth() const { return false; }
    virtual std::optional<float1> depth(const Relief&, const Hit&) const { return {}; }
};

// What the vertex stage hands to the pixel stage, before interpolation.
struct Vertex {
    float4 position;  // clip space
    float2 uv;
    // Tangent space, any length: interpolated, then normalised per pixel.
    float3 to_eye;
    std::vector<float3> to_lights;  // by number
    // z and w of the position in clip space, and how they change from there to the eye (all of
    // to_eye): asked for by outputs that write depth.
    std::optional<float4> depth_line = {};
};

class VertexWork : public Technique {
  public:
    // `lights`: how many, 0 to most_lights.
    virtual Vertex transform(int lights) const = 0;
};

}  // namespace intaglio::dsl
