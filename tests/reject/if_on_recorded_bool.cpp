// A recorded comparison has no truth while generating: an if on it would choose once for all
// pixels.
#include "generator/dsl/control.h"
using namespace intaglio::dsl;

void body([[maybe_unused]] float1 x, [[maybe_unused]] float3 v, [[maybe_unused]] int1 i) {
#ifdef RIGHT
    If(x > 0.0f, [] {});
#else
    if (x > 0.0f) {
    }
#endif
}
