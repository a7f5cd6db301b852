// Affine functions of interpolants, computed per vertex instead of per pixel.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "generator/ir/module.h"

namespace intaglio::passes {

// What the target can pass from the vertex to the pixel stage.
struct InterpolantLimits {
    int count = 8;
    int components = 32;
    // What else a pixel stage's inputs must obey, if not empty.
    std::function<bool(const ir::Module& pixel)> fits = {};
};

// Interpolation keeps affine functions: f(lerp(a, b)) = lerp(f(a), f(b)).  So with the program's
// consent (`per_vertex`), the largest subexpressions of the pixel stage that are affine in
// interpolants (sums, differences, negation, products and quotients with a value that is the same
// for the whole draw, swizzles, compositions) become interpolants of their own, computed from the
// vertex stage's outputs; those that save most instructions first, as long as what the pixel stage
// still reads fits the limits.  Nothing is packed.  An expression of uniforms alone stays where it
// is.
//
// Not bit-exact: the vertices' values are rounded, then interpolated.  Returns one sentence for
// each value that moved, or why nothing could; does nothing without consent.
std::vector<std::string> hoist_to_vertex(ir::Program& program,
                                         const InterpolantLimits& limits = {});

}  // namespace intaglio::passes
