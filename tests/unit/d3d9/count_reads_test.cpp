// The counter in a shader against the interpreter's own count.
#include "generator/target/d3d9/count_reads.h"

#include <gtest/gtest.h>

#include "generator/target/d3d9/assembly.h"
#include "generator/target/d3d9/interpret.h"
#include "generator/target/d3d9/legality.h"

namespace intaglio::d3d9 {
namespace {

Shader shader_of(std::string_view text) {
    Result<Shader> shader = parse(text, "test.asm");
    EXPECT_TRUE(shader) << to_string(shader.error());
    return shader ? std::move(*shader) : Shader{};
}

// The last colour output after reading a texture of one gray texel.
Vector counted(const Shader& shader, const Vector& t0, int output, int& reads, Vector& colour) {
    ir::Texture texture;
    texture.width = texture.height = 1;
    texture.levels = {{0.5f, 0.5f, 0.5f, 0.5f}};
    const auto interpreter = Interpreter::prepare(shader);
    EXPECT_TRUE(interpreter) << to_string(interpreter.error());
    Environment environment;
    environment.samplers = {&texture};
    Inputs inputs;
    inputs.texcoords[0] = inputs.attributes[0] = t0;
    const Execution execution = interpreter->run(environment, inputs, Arithmetic::Fp32);
    reads = execution.texture_reads;
    colour = execution.colours[0];
    return execution.colours[static_cast<std::size_t>(output)];
}

TEST(CountReads, StraightCodePaysOneSlotAndOneConstant) {
    const Shader plain = shader_of(
        "ps_2_0\ndef c0, 1, 2, 3, 4\ndcl t0.xy\ndcl_2d s0\ntexld r0, t0, s0\ntexld r1, r0, s0\n"
        "texkill t0\nadd r0, r0, r1\nmov oC0, r0\n");
    const Shader shader = with_read_counter(plain);
    EXPECT_EQ(slots_of(shader).arithmetic, slots_of(plain).arithmetic + 1);
    EXPECT_EQ(slots_of(shader).texture, slots_of(plain).texture);
    int reads = 0;
    Vector before{}, after{};
    counted(plain, {}, 0, reads, before);
    EXPECT_EQ(counted(shader, {}, 1, reads, after), (Vector{2, 0, 0, 0}));
    EXPECT_EQ(reads, 2);
    EXPECT_EQ(before, after) << "the other outputs keep their values";
}

TEST(CountReads, FlowIsCountedAsItRuns) {
    const Shader shader = with_read_counter(shader_of(
        "ps_3_0\ndef c0, 0, 1, 0.25, 0\ndefi i0, 7, 0, 0, 0\ndcl_texcoord0 v0\ndcl_2d s0\n"
        "mov r0, c0.x\nmov r1, c0.x\nrep i0\nbreak_ge r0.x, v0.x\ntexldl r2, r1, s0\n"
        "add r0.x, r0.x, c0.y\nendrep\nif_lt v0.x, c0.z\ntexldl r1, r1, s0\nendif\nmov oC0, r0\n"));
    EXPECT_TRUE(check(shader).empty()) << check(shader).front().message;
    for (const float trips : {0.0f, 1.0f, 3.0f, 7.0f, 20.0f}) {
        int reads = 0;
        Vector colour{};
        const Vector count = counted(shader, {trips, 0, 0, 0}, 1, reads, colour);
        EXPECT_EQ(count, (Vector{static_cast<float>(reads), 0, 0, 0})) << trips;
        EXPECT_EQ(reads, trips == 0 ? 1 : std::min(static_cast<int>(trips), 7)) << trips;
    }
}

}  // namespace
}  // namespace intaglio::d3d9
