// A surface's IR drawn without a device and without a target's text: both stages run by the
// evaluator on the quad of prepare_quad, in the precision and with the filter one asks about.  In
// Double and with exact weights what is left of an error is the technique's own.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "generator/ir/evaluate.h"
#include "src/measure/render.h"
#include "src/variant/variant.h"

namespace intaglio::measure {

struct EvaluatedPicture {
    int width = 0, height = 0;
    std::vector<std::array<double, 4>> pixels;  // the first output, row by row
    double reads_mean = 0;                      // textures read, per pixel
    long reads_max = 0;
    double instructions_mean = 0;  // of the optimised IR carried out, per pixel
    long instructions_max = 0;

    vulkan::Picture picture() const;  // rounded to float
};

// Seen from infinity what the vertex stage hands on is an affine function of the pixel's place, so
// it is run at each pixel's centre in place of interpolation: in Double for Double, else in Single,
// as vertex units of every age did.
class EvaluatedQuad {
  public:
    // The variant's program after the passes that every target runs; loops and branches stay, and
    // none of the forms that Direct3D 9 needs.  Textures as prepare_quad gives them.
    // Errors: those of the passes and of the baked maps; "missing-texture", "missing-uniform".
    static Result<EvaluatedQuad> prepare(const Variant& variant, const Textures& textures,
                                         double scale, int width, int height,
                                         const Look& look = {});

    // Pixels are alone: derivatives, which no search and no shadow takes, are 0.  `threads` as in
    // rows.h.
    EvaluatedPicture draw(Direction view, Direction light, ir::Precision precision,
                          ir::Texture::Weights weights, int threads = 0) const;

    // Whether what is drawn depends on where the light is.
    bool sees_light() const;

  private:
    EvaluatedQuad(ir::Program program);
    Status add_textures(const Variant& variant, const Textures& textures);
    std::vector<ir::Environment::Vector> inputs_at(ir::Environment& vertex, double x, double y,
                                                   ir::Precision precision) const;

    ir::Program program_;
    ir::Evaluator vertex_, pixel_;
    std::map<std::string, std::array<ir::Texture, 2>> textures_;  // by weights
    Look look_;
    double scale_ = 0;
    int width_ = 0, height_ = 0, map_width_ = 0, map_height_ = 0;
};

}  // namespace intaglio::measure
