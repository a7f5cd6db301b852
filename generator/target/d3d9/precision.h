// The arithmetic of the Direct3D 9 interpreter, on scalars held in binary32: generator/ir/narrow.h
// says how hardware of those years rounded and what it made of edge values.  Single is binary32,
// denormals flushed: what lavapipe does, from the IR's evaluator.
#pragma once

#include <cmath>
#include <limits>

#include "generator/ir/arithmetic.h"
#include "generator/ir/narrow.h"

namespace intaglio::d3d9 {

struct SingleRounding {
    using Exact = ir::Arithmetic<float>;
    static constexpr float largest = std::numeric_limits<float>::max();
    // Constants, inputs and texels as an instruction sees them.
    static float load(float value) { return Exact::in(value); }
    static float add(float a, float b) { return Exact::add(a, b); }
    static float mul(float a, float b) { return Exact::mul(a, b); }
    static float div(float a, float b) { return Exact::div(a, b); }
    static float inverse_root(float a) { return Exact::rsqrt(a); }
    static float exp2(float a) { return Exact::exp2(a); }
    static float logarithm(float a) { return Exact::log2(a); }
    static float sin(float a) { return Exact::sin(a); }
    static float cos(float a) { return Exact::cos(a); }
};

using ir::Format16;
using ir::Format24;
using Single = ir::Guarded<SingleRounding>;
using Narrow24 = ir::Guarded<ir::NarrowRounding<Format24>>;
using Narrow16 = ir::Guarded<ir::NarrowRounding<Format16>>;

}  // namespace intaglio::d3d9
