// Texture instructions: coordinates, projection, levels chosen or computed, precision.
#include <cmath>

#include "tests/unit/interpret/programs.h"

namespace intaglio::d3d9 {
namespace {

// Level l is 64 >> l wide and high; its texels hold (column, row, level, 1) of that level.
ir::Texture numbered(ir::Texture::Filter filter) {
    ir::Texture texture;
    texture.width = texture.height = 64;
    texture.filter = filter;
    for (int level = 0; level < 7; ++level) {
        std::vector<float>& texels = texture.levels.emplace_back();
        const int size = 64 >> level;
        for (int row = 0; row < size; ++row)
            for (int column = 0; column < size; ++column)
                for (const int value : {column, row, level, 1})
                    texels.push_back(static_cast<float>(value));
    }
    return texture;
}

Vector read(const std::string& instruction, const Vector& coordinate,
            Arithmetic arithmetic = Arithmetic::Fp32) {
    const ir::Texture texture = numbered(ir::Texture::Filter::Nearest);
    Environment environment;
    environment.samplers = {nullptr, &texture};
    Inputs inputs;
    inputs.attributes[0] = coordinate;
    const Execution execution =
        ran("ps_3_0\ndef c0, 0.125, 0, 0, 0\ndcl_texcoord0 v0\ndcl_2d s0\ndcl_2d s1\nmov r1, v0\n" +
                instruction + "\nmov oC0, r0\n",
            environment, inputs, arithmetic);
    EXPECT_EQ(execution.texture_reads, 1);
    return execution.colours[0];
}

TEST(Texture, ReadsAtItsCoordinate) {
    EXPECT_THAT(read("texld r0, v0, s1", {10.5f / 64, 20.5f / 64, 0, 0}),
                SameNumbers(Vector{10, 20, 0, 1}));
    EXPECT_THAT(read("texld r0, v0, s1.yxwz", {10.5f / 64, 20.5f / 64, 0, 0}),
                SameNumbers(Vector{20, 10, 1, 0}));
    EXPECT_THAT(read("texld r0, v0.yxzw, s1", {10.5f / 64, 20.5f / 64, 0, 0}),
                SameNumbers(Vector{20, 10, 0, 1}));
    EXPECT_THAT(read("texldp r0, v0, s1", {21.0f / 64, 41.0f / 64, 0, 2}),
                SameNumbers(Vector{10, 20, 0, 1}));
    EXPECT_THAT(read("texldl r0, v0, s1", {0.5f, 0.25f, 0, 3}), SameNumbers(Vector{4, 2, 3, 1}));
    EXPECT_THAT(read("texldb r0, v0, s1", {0.5f, 0.25f, 0, 2}), SameNumbers(Vector{8, 4, 2, 1}))
        << "without derivatives the bias is the level";
    // 1/8 of the texture in x: 8 texels, level 3.
    EXPECT_THAT(read("texldd r0, v0, s1, c0, c0.y", {0.5f, 0.25f, 0, 0}),
                SameNumbers(Vector{4, 2, 3, 1}));
    EXPECT_THAT(read("texld r0, v0, s0", {0.5f, 0.25f, 0, 0}), SameNumbers(Vector{0, 0, 0, 0}))
        << "a sampler that nothing is bound to";
}

TEST(Texture, CoordinatesHaveTheArithmeticsPrecision) {
    // Between 2048 and 4096 numbers of 24 bits lie 2^-5 apart, which is two columns.
    const Vector far = {4000.0f + 33.0f / 64, 0.25f, 0, 0};
    EXPECT_EQ(read("texld r0, v0, s1", far)[0], 33);
    EXPECT_EQ(read("texld r0, v0, s1", far, Arithmetic::Fp24)[0], 32);
    // _pp rounds what is read, not where: halves lie two apart at 4000.
    EXPECT_EQ(read("texld_pp r0, v0, s1", far, Arithmetic::Fp16Partial)[0], 33);
}

TEST(Texture, QuadsChooseTheLevel) {
    const ir::Texture texture = numbered(ir::Texture::Filter::Linear);
    Environment environment;
    environment.samplers = {&texture};
    const Interpreter interpreter = prepared(
        parsed("ps_3_0\ndcl_texcoord0 v0\ndcl_2d s0\ntexld r0, v0, s0\ndsx r1, v0\ndsy r2, "
               "v0\nmov oC0, r0\nmov oC1, r1\nmov oC2, r2\n"));
    for (const int level : {0, 1, 3}) {
        const float step = std::ldexp(1.0f / 64, level);
        std::array<Inputs, 4> inputs;
        for (std::size_t i = 0; i < 4; ++i)
            inputs[i].attributes[0] = {0.25f + step * static_cast<float>(i % 2),
                                       0.5f - 0.5f * step * static_cast<float>(i / 2), 0, 0};
        for (const Execution& pixel : interpreter.run_quad(environment, inputs, Arithmetic::Fp32)) {
            EXPECT_EQ(pixel.colours[0][2], static_cast<float>(level));
            EXPECT_THAT(pixel.colours[1], SameNumbers(Vector{step, 0, 0, 0}));
            EXPECT_THAT(pixel.colours[2], SameNumbers(Vector{0, -0.5f * step, 0, 0}));
        }
    }
}

TEST(Texture, DerivativesWithinTheQuad) {
    const Interpreter interpreter =
        prepared(parsed("ps_3_0\ndcl_texcoord0 v0\ndsx r1, v0\ndsy r2, v0.yxzw\nmov oC0, r1\nmov "
                        "oC1, r2\n"));
    std::array<Inputs, 4> inputs;
    const float values[] = {1, 3, 10, 17};
    for (std::size_t i = 0; i < 4; ++i) inputs[i].attributes[0] = {values[i], -values[i], 0, 0};
    const auto quad = interpreter.run_quad({}, inputs, Arithmetic::Fp32);
    const float across[] = {2, 2, 7, 7}, down[] = {9, 14, 9, 14};
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(quad[i].colours[0][0], across[i]);
        EXPECT_EQ(quad[i].colours[1][0], -down[i]);
        EXPECT_EQ(quad[i].colours[1][1], down[i]);
    }
    EXPECT_EQ(interpreter.run({}, inputs[3], Arithmetic::Fp32).colours[0][0], 0);
}

}  // namespace
}  // namespace intaglio::d3d9
