// What a shader reads and writes: uniforms, inputs, samplers.  Each is declared by its first use in
// a recording and found again by name.
#pragma once

#include <string_view>

#include "generator/dsl/values.h"

namespace intaglio::dsl {

// A texture with its sampler: 2D, or a volume.  Every axis repeats; the declaration says the
// filter, and whoever draws obeys it.  Reads inside loops and ifs name their level or their
// gradients.
template <int Dimension>
class Sampler {
  public:
    using Filter = ir::Sampler::Filter;
    // Nearest: one texel of one level, whatever the coordinate: exact reads of maps that must not
    // be mixed.  A texel's own value lies at (index + 0.5) / size.
    // `baked`: of a baked map, the settings that it must be baked with, "shininess=32".
    Sampler(std::string_view name, std::string_view comment, Filter filter = Filter::Linear,
            std::string_view baked = {});

    // The mip level is given; 0 is the finest.
    float4 sample_level(Float<Dimension> at, float1 level, Place place = Place::here()) const;
    // The level follows from how the coordinate changes from pixel to pixel.
    float4 sample_grad(Float<Dimension> at, Float<Dimension> ddx_at, Float<Dimension> ddy_at,
                       Place place = Place::here()) const;
    // The level follows from the derivatives of the coordinate itself; outside loops and ifs only.
    float4 sample(Float<Dimension> at, Place place = Place::here()) const;

  private:
    int slot_;
};

using sampler2D = Sampler<2>;
using sampler3D = Sampler<3>;

ir::ValueId record_uniform(std::string_view name, ir::Type type, int count, int element,
                           std::string_view comment);
ir::ValueId record_input(std::string_view name, ir::Type type, ir::Semantic semantic);

// A value that is the same for a whole draw.  `comment`: what it means, with unit and range.
template <int N>
Float<N> uniform(std::string_view name, std::string_view comment) {
    return Float<N>::of(record_uniform(name, {ir::Scalar::Float, N}, 1, 0, comment));
}

// Row `row` of a matrix of `rows` rows; matrices are arrays of their rows, multiplied by dot.
inline float4 uniform_row(std::string_view name, int rows, int row, std::string_view comment) {
    return float4::of(record_uniform(name, ir::float4, rows, row, comment));
}

// A vertex attribute, an interpolant, or a function parameter, by the stage being recorded.
template <int N>
Float<N> input(std::string_view name) {
    const ir::Stage stage = Recorder::current().module().stage;
    const ir::Semantic semantic = stage == ir::Stage::Vertex  ? ir::Semantic::Attribute
                                  : stage == ir::Stage::Pixel ? ir::Semantic::Interpolant
                                                              : ir::Semantic::Parameter;
    return Float<N>::of(record_input(name, {ir::Scalar::Float, N}, semantic));
}

}  // namespace intaglio::dsl
