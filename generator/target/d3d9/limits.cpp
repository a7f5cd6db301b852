// The tables.  Pixel rows: registers and slots as in the Direct3D 9 reference, "Registers - ps_2_0"
// and following.
#include "generator/target/d3d9/limits.h"

#include <array>

namespace intaglio::d3d9 {
namespace {

constexpr int any = no_limit;

// clang-format off
constexpr std::array<Limits, 6> documented = {{
    //                           slots             registers                                   reads     flow depth            swizzle, lanes,
    // name      profile         arith tex  total  r   c    i   b   s   v   t  oC o            level c#  if  dyn loop call all  strict, caps
    {"ps_2_0", Profile::ps_2_0,  64,  32,  96,     12, 32,  0,  0,  16, 2,  8, 4, 0,           3,    2,  0,  0,  0,   0,   0,   false, true, true, false},
    {"ps_2_a", Profile::ps_2_a,  any, any, 512,    22, 32,  16, 16, 16, 2,  8, 4, 0,           any,  2,  0,  0,  0,   0,   0,   true,  true, true, false},
    {"ps_2_b", Profile::ps_2_b,  any, any, 512,    32, 32,  16, 16, 16, 2,  8, 4, 0,           3,    2,  0,  0,  0,   0,   0,   false, true, true, false},
    {"ps_3_0", Profile::ps_3_0,  any, any, 512,    32, 224, 16, 16, 16, 10, 0, 4, 0,           any,  any, 24, 24, 4,  4,   any, true,  true, true, false},
    {"vs_2_0", Profile::vs_2_0,  any, any, 256,    12, 256, 16, 16, 0,  16, 8, 2, 0,           any,  2,  16, 0,  1,   1,   16,  true,  true, true, false},
    {"vs_3_0", Profile::vs_3_0,  any, any, 512,    32, 256, 16, 16, 4,  16, 0, 0, 12,          any,  any, 24, 24, 4,  4,   any, true,  true, true, false},
}};

constexpr Limits all_of_2_x =
    {"ps_2_x", Profile::ps_2_a,  any, any, 512,    32, 32,  16, 16, 16, 2,  8, 4, 0,           any,  2,  24, 24, 4,   4,   any, true,  false, false, true};
constexpr std::array<Limits, 6> enforced = {{
    {"ps_2_0", Profile::ps_2_0,  64,  32,  96,     12, 32,  0,  0,  16, 2,  8, 4, 0,           3,    2,  0,  0,  0,   0,   0,   false, true, false, false},
    all_of_2_x,
    all_of_2_x,
    {"ps_3_0", Profile::ps_3_0,  any, any, any,    32, 224, 16, 16, 16, 10, 0, 4, 0,           any,  any, 24, 24, 4,  4,   any, true,  false, false, false},
    {"vs_2_0", Profile::vs_2_0,  any, any, 256,    12, any, 16, 16, 0,  16, 8, 2, 0,           any,  2,  16, 0,  1,   1,   16,  true,  false, false, false},
    {"vs_3_0", Profile::vs_3_0,  any, any, any,    32, any, 16, 16, 4,  16, 0, 0, 12,          any,  any, 24, 24, 4,  4,   any, true,  false, false, false},
}};
// clang-format on

constexpr bool in_order() {
    for (std::size_t i = 0; i < documented.size(); ++i)
        if (static_cast<std::size_t>(documented[i].profile) != i) return false;
    return true;
}
static_assert(in_order(), "the rows follow the order of Profile");

}  // namespace

bool Limits::has(const OpInfo& op) const {
    if (op.is_in(profile)) return true;
    return all_capabilities && op.has(Trait::Flow) && op.op != Opcode::Loop &&
           op.op != Opcode::EndLoop;
}

const Limits& limits_of(Profile profile) { return documented[static_cast<std::size_t>(profile)]; }
const Limits& validator_limits(Profile profile) {
    return enforced[static_cast<std::size_t>(profile)];
}

}  // namespace intaglio::d3d9
