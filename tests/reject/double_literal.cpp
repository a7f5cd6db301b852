// A double literal would be rounded silently; shaders compute in float.
#include "generator/dsl/control.h"
using namespace intaglio::dsl;

void body([[maybe_unused]] float1 x, [[maybe_unused]] float3 v, [[maybe_unused]] int1 i) {
#ifdef RIGHT
    [[maybe_unused]] const float1 y = x * 0.1f;
#else
    [[maybe_unused]] const float1 y = x * 0.1;
#endif
}
