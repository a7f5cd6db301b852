// && of recorded values is recorded; it does not become a C++ bool.
#include "generator/dsl/control.h"
using namespace intaglio::dsl;

void body([[maybe_unused]] float1 x, [[maybe_unused]] float3 v, [[maybe_unused]] int1 i) {
#ifdef RIGHT
    [[maybe_unused]] const bool1 both = x > 0.0f && x < 1.0f;
#else
    [[maybe_unused]] const bool both = x > 0.0f && x < 1.0f;
#endif
}
