// A recorded int is not made from a float.
#include "generator/dsl/control.h"
using namespace intaglio::dsl;

void body([[maybe_unused]] float1 x, [[maybe_unused]] float3 v, [[maybe_unused]] int1 i) {
#ifdef RIGHT
    [[maybe_unused]] const int1 y = i + 1;
#else
    [[maybe_unused]] const int1 y = i + 1.5f;
#endif
}
