// A loop is named by its address in schedules: a copy would be another loop.
#include "generator/dsl/control.h"
using namespace intaglio::dsl;

void body([[maybe_unused]] float1 x, [[maybe_unused]] float3 v, [[maybe_unused]] int1 i) {
#ifdef RIGHT
    struct T : KnobOwner {
        Knob<int> n{this, "n", 1, at_least{1}, at_most{2}, ""};
        Loop l{"l", n};
    } t;
    [[maybe_unused]] const Loop& same = t.l;
#else
    struct T : KnobOwner {
        Knob<int> n{this, "n", 1, at_least{1}, at_most{2}, ""};
        Loop l{"l", n};
    } t;
    [[maybe_unused]] const Loop other = t.l;
#endif
}
