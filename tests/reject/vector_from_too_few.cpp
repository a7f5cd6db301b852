// A float3 is made of three components.
#include "generator/dsl/control.h"
using namespace intaglio::dsl;

void body([[maybe_unused]] float1 x, [[maybe_unused]] float3 v, [[maybe_unused]] int1 i) {
#ifdef RIGHT
    [[maybe_unused]] const float3 y(v.xy(), x);
#else
    [[maybe_unused]] const float3 y(x, x);
#endif
}
