// The recorded pixel stage of a surface, run at single places of a map in any precision: for what
// is asked of one ray, where a picture would be too much.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "generator/ir/evaluate.h"
#include "src/measure/render.h"
#include "src/variant/variant.h"

namespace intaglio::measure {

class LonePixel {
  public:
    using Vector = ir::Environment::Vector;

    // Errors: those of record_variant and of bakes; "missing-texture".
    static Result<LonePixel> prepare(const dsl::Catalogue& catalogue, const VariantRequest& request,
                                     const Textures& textures, double scale);

    // What it writes at a texture coordinate.  `eye` and `light` point from the surface, of any
    // length; its neighbours lie `pixel` texture units further.  Inputs are rounded as the format
    // holds them.
    Vector at(std::array<double, 2> uv, std::array<double, 3> eye, std::array<double, 3> light,
              double pixel, ir::Precision precision) const;

  private:
    struct Stage {
        explicit Stage(ir::Module pixel) : module(std::move(pixel)), run(module) {}
        ir::Module module;
        ir::Evaluator run;
        std::vector<std::vector<Vector>> uniforms;
        std::vector<ir::Texture> maps;
    };
    explicit LonePixel(std::unique_ptr<Stage> stage) : stage_(std::move(stage)) {}

    std::unique_ptr<const Stage> stage_;
};

}  // namespace intaglio::measure
