// The legal shaders are a witness only if they use what a profile has.
#include <set>

#include <gtest/gtest.h>

#include "generator/target/d3d9/ops.h"
#include "tests/unit/d3d9/random_shader.h"

namespace intaglio::d3d9 {
namespace {

TEST(RandomLegalShader, UsesEveryInstructionOfTheProfileAndNoOther) {
    // Printed otherwise by the disassembler than written, or valid only in a place the generator
    // has none of.
    const std::set<Opcode> left_out = {Opcode::Sub, Opcode::BreakP, Opcode::Break};
    for (const Profile profile : every_profile) {
        std::set<Opcode> used;
        for (std::uint32_t seed = 0; seed < 400; ++seed)
            for (const Instruction& instruction : random_legal_shader(seed, profile).instructions)
                used.insert(instruction.op);
        for (const OpInfo& row : all_ops())
            EXPECT_EQ(used.contains(row.op), row.is_in(profile) && !left_out.contains(row.op))
                << row.mnemonic << " in " << name_of(profile);
    }
}

}  // namespace
}  // namespace intaglio::d3d9
