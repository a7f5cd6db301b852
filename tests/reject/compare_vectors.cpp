// A comparison of vectors has no single answer; compare components.
#include "generator/dsl/control.h"
using namespace intaglio::dsl;

void body([[maybe_unused]] float1 x, [[maybe_unused]] float3 v, [[maybe_unused]] int1 i) {
#ifdef RIGHT
    [[maybe_unused]] const bool1 y = v.x() < v.y();
#else
    [[maybe_unused]] const bool1 y = v < v;
#endif
}
