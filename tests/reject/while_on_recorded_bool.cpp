// A C++ while cannot be recorded; a Loop with until can.
#include "generator/dsl/control.h"
using namespace intaglio::dsl;

void body([[maybe_unused]] float1 x, [[maybe_unused]] float3 v, [[maybe_unused]] int1 i) {
#ifdef RIGHT
    [[maybe_unused]] const bool1 go = x > 0.0f;
#else
    while (x > 0.0f) {
    }
#endif
}
