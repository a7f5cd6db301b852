// A recorded int cannot count a C++ loop.
#include "generator/dsl/control.h"
using namespace intaglio::dsl;

void body([[maybe_unused]] float1 x, [[maybe_unused]] float3 v, [[maybe_unused]] int1 i) {
#ifdef RIGHT
    for (int n = 0; n < 4; ++n) x = x + x;
#else
    for (int n = 0; n < i; ++n) x = x + x;
#endif
}
