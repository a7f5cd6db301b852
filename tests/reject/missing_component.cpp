// A float2 has no z.
#include "generator/dsl/control.h"
using namespace intaglio::dsl;

void body([[maybe_unused]] float1 x, [[maybe_unused]] float3 v, [[maybe_unused]] int1 i) {
#ifdef RIGHT
    [[maybe_unused]] const float1 y = v.xy().y();
#else
    [[maybe_unused]] const float1 y = v.xy().z();
#endif
}
