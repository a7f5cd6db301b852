// A copy of a variable would look like a second variable and be none.
#include "generator/dsl/control.h"
using namespace intaglio::dsl;

void body([[maybe_unused]] float1 x, [[maybe_unused]] float3 v, [[maybe_unused]] int1 i) {
#ifdef RIGHT
    var<float1> a{"a", x};
    [[maybe_unused]] float1 b = a;
#else
    var<float1> a{"a", x};
    [[maybe_unused]] auto b = a;
#endif
}
