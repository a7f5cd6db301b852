// Direct3D 9 variants drawn without a device: both stages decoded from the bytes that a device
// would load, run by our interpreter on the quad of prepare_quad, in the arithmetic one asks about.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "generator/target/d3d9/interpret.h"
#include "src/measure/render.h"
#include "src/variant/variant.h"

namespace intaglio::measure {

struct InterpretedPicture {
    vulkan::Picture picture;  // oC0; 0 where the pixel was killed
    double reads_mean = 0;    // textures read, per pixel
    int reads_max = 0;
    double instructions_mean = 0;  // carried out, per pixel
    long instructions_max = 0;
};

// Seen from infinity every attribute of the quad is an affine function of the pixel's place, so the
// vertex shader, which computes affine functions of attributes there, is run at each pixel's centre
// in place of interpolation.  It is run in binary32 always: vertex units were, whatever the
// pixels'. Derivatives are those of two by two pixels.
class InterpretedQuad {
  public:
    // Textures as prepare_quad gives them: baked maps by name, one level or nearest where the
    // variant says so, texels rounded as their format does (RGBA8 filtered by steps
    // of 1/256, where lavapipe also rounds the result to 8 bits).
    // Errors: "not-interpreted" for a target without bytecode of both stages, and those of decode,
    // Interpreter::prepare and the baked maps.
    static Result<InterpretedQuad> prepare(const Variant& variant, const Textures& textures,
                                           double scale, int width, int height,
                                           const Look& look = {});

    // `threads` as in rows.h.  Error "endless-shader": a pixel did not come to its end.
    Result<InterpretedPicture> draw(Direction view, Direction light, d3d9::Arithmetic arithmetic,
                                    int threads = 0) const;

    // The same with all textures filtered so.
    InterpretedQuad with_weights(ir::Texture::Weights weights) const;

    // The same with _pp on every instruction of the pixel stage: what is left where all is done in
    // 16 bits, drawn in d3d9::Arithmetic::Fp16Partial.
    Result<InterpretedQuad> with_partial_precision() const;

    const d3d9::Shader& pixel_shader() const { return pixel_; }

  private:
    // What the vertex stage hands on.
    struct Link {
        d3d9::Usage usage;
        int index;
    };
    InterpretedQuad(d3d9::Shader vertex, d3d9::Shader pixel, d3d9::Interpreter run_vertex,
                    d3d9::Interpreter run_pixel)
        : vertex_(std::move(vertex)),
          pixel_(std::move(pixel)),
          run_vertex_(std::move(run_vertex)),
          run_pixel_(std::move(run_pixel)) {}
    Status add_textures(const Variant& variant, const Textures& textures);
    d3d9::Inputs inputs_of(const d3d9::Environment& environment, int x, int y) const;

    d3d9::Shader vertex_, pixel_;
    d3d9::Interpreter run_vertex_, run_pixel_;
    std::vector<Link> links_;
    std::map<std::string, ir::Texture> textures_;
    Look look_;
    double scale_ = 0;
    int width_ = 0, height_ = 0, map_width_ = 0, map_height_ = 0;
};

}  // namespace intaglio::measure
