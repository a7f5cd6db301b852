// A double is refused where a value is made, too.
#include "generator/dsl/control.h"
using namespace intaglio::dsl;

void body([[maybe_unused]] float1 x, [[maybe_unused]] float3 v, [[maybe_unused]] int1 i) {
#ifdef RIGHT
    [[maybe_unused]] const float1 y = 0.5f;
#else
    [[maybe_unused]] const float1 y = 0.5;
#endif
}
