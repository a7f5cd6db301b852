// Bytecode: tokens that Direct3D's assembler was seen to write, equality after a round trip,
// malformed streams, fuzz.
#include "generator/target/d3d9/bytecode.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "generator/target/d3d9/assembly.h"
#include "generator/target/d3d9/constant_table.h"
#include "generator/target/d3d9/ops.h"
#include "tests/rounds.h"
#include "tests/unit/d3d9/dice.h"
#include "tests/unit/d3d9/random_shader.h"

namespace intaglio::d3d9 {
namespace {

using testing::ElementsAreArray;
using testing::HasSubstr;
using Words = std::vector<std::uint32_t>;

Words bytes_of(std::string_view text) {
    const auto shader = parse(text, "test.asm");
    EXPECT_TRUE(shader) << to_string(shader.error());
    return shader ? encode(*shader, false) : Words{};
}

// The tokens are those of D3DAssemble (d3dcompiler_47) for the same text.
TEST(Bytecode, IsThatOfDirect3DsAssembler) {
    EXPECT_THAT(
        bytes_of(
            "ps_2_x\ndcl_pp_centroid t0.xy\ndcl_centroid t1.xyz\ndcl v0\ndcl_2d s0\ntexld r0, t0, "
            "s0\n"
            "setp_le p0.xy, r0.x, c0.y\n(p0.x) mul r0.x, r0, r0\n(!p0.x) texkill r0\ntexkill t1\n"
            "cmp_sat_pp r0.xy, r0, -c1, r0\ndp2add r0.x, r0, r0, r0.z\nrep i0\nendrep\nif "
            "b0\nelse\n"
            "endif\nnop\ncall l3\nmov oC0, r0\nret\nlabel l3\nret\n"),
        ElementsAreArray(Words{
            0xffff0201, 0x0200001f, 0x80000000, 0xb0630000, 0x0200001f, 0x80000000, 0xb0470001,
            0x0200001f, 0x80000000, 0x900f0000, 0x0200001f, 0x90000000, 0xa00f0800, 0x03000042,
            0x800f0000, 0xb0e40000, 0xa0e40800, 0x0306005e, 0xb0031000, 0x80000000, 0xa0550000,
            0x14000005, 0x80010000, 0xb0001000, 0x80e40000, 0x80e40000, 0x12000041, 0x800f0000,
            0xbd001000, 0x01000041, 0xb00f0001, 0x04000058, 0x80330000, 0x80e40000, 0xa1e40001,
            0x80e40000, 0x0400005a, 0x80010000, 0x80e40000, 0x80e40000, 0x80aa0000, 0x01000026,
            0xf0e40000, 0x00000027, 0x01000028, 0xe0e40800, 0x0000002a, 0x0000002b, 0x00000000,
            0x01000019, 0xa0e41003, 0x02000001, 0x800f0800, 0x80e40000, 0x0000001c, 0x0100001e,
            0xa0e41003, 0x0000001c, 0x0000ffff}));
    EXPECT_THAT(
        bytes_of("vs_2_0\ndef c200, 1, 2, 3, 4\ndcl_position v0\nsincos r0.xy, v0.x, c0, c1\nmov "
                 "oPos, r0\n"
                 "rep i0\nendrep\nloop aL, i1\nmov r1, c[aL+5]\nendloop\nmova a0.xw, v0\nmov r0, "
                 "c4[a0.w]\n"
                 "mov oFog, r0.x\nmov oPts, r0.y\nmov oD1.xy, r0\n"),
        ElementsAreArray(Words{
            0xfffe0200, 0x05000051, 0xa00f00c8, 0x3f800000, 0x40000000, 0x40400000, 0x40800000,
            0x0200001f, 0x80000000, 0x900f0000, 0x04000025, 0x80030000, 0x90000000, 0xa0e40000,
            0xa0e40001, 0x02000001, 0xc00f0000, 0x80e40000, 0x01000026, 0xf0e40000, 0x00000027,
            0x0200001b, 0xf0e40800, 0xf0e40001, 0x03000001, 0x800f0001, 0xa0e42005, 0xf0e40800,
            0x0000001d, 0x0200002e, 0xb0090000, 0x90e40000, 0x03000001, 0x800f0000, 0xa0e42004,
            0xb0ff0000, 0x02000001, 0xc00f0001, 0x80000000, 0x02000001, 0xc00f0002, 0x80550000,
            0x02000001, 0xd0030001, 0x80e40000, 0x0000ffff}));
    EXPECT_THAT(
        bytes_of("ps_3_0\ndcl_texcoord0_centroid v0\ndcl vPos.xy\ndcl vFace\ndcl_volume s2\n"
                 "if_gt vFace, c0.x\nmov r1, -v1_abs\nendif\nmov oDepth, r0.x\n"),
        ElementsAreArray(Words{0xffff0300, 0x0200001f, 0x80000005, 0x904f0000, 0x0200001f,
                               0x80000000, 0x90031000, 0x0200001f, 0x80000000, 0x900f1001,
                               0x0200001f, 0xa0000000, 0xa00f0802, 0x02010029, 0x90e41001,
                               0xa0000000, 0x02000001, 0x800f0001, 0x9ce40001, 0x0000002b,
                               0x02000001, 0x900f0800, 0x80000000, 0x0000ffff}));
}

TEST(Bytecode, RandomShadersDecodeEqual) {
    for (const Profile profile : every_profile)
        for (std::uint32_t seed = 0; seed < rounds(1000u); ++seed) {
            const Shader shader = random_shader(seed, profile);
            const auto again = decode(encode(shader));
            ASSERT_TRUE(again) << name_of(profile) << " seed " << seed << "\n"
                               << to_string(again.error()) << "\n"
                               << print(shader);
            ASSERT_EQ(*again, shader) << name_of(profile) << " seed " << seed << "\n"
                                      << print(shader) << "came back as\n"
                                      << print(*again);
        }
}

TEST(Bytecode, XProfileIsWhatTheCallerOrTheTableSays) {
    Shader shader;
    shader.profile = Profile::ps_2_b;
    EXPECT_EQ(decode(encode(shader))->profile, Profile::ps_2_b);
    EXPECT_EQ(decode(encode(shader), Profile::ps_2_a)->profile, Profile::ps_2_a);
    EXPECT_EQ(decode(encode(shader, false))->profile, Profile::ps_2_a);
    EXPECT_EQ(decode(encode(shader, false), Profile::ps_2_b)->profile, Profile::ps_2_b);
}

TEST(Bytecode, CommentsAreStrippedAndNothingElse) {
    const Shader shader = random_shader(5, Profile::ps_3_0);
    EXPECT_EQ(without_comments(encode(shader)), encode(shader, false));
    EXPECT_EQ(without_comments(encode(shader, false)), encode(shader, false));
}

struct Malformed {
    Words tokens;
    int offset;
    std::string message;
};

class RefusedTokens : public testing::TestWithParam<Malformed> {};

TEST_P(RefusedTokens, WithTheOffsetOfTheToken) {
    const auto result = decode(GetParam().tokens);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, "d3d9-bytecode");
    EXPECT_THAT(result.error().message,
                HasSubstr("at token " + std::to_string(GetParam().offset) + ", "));
    EXPECT_THAT(result.error().message, HasSubstr(GetParam().message));
}

constexpr std::uint32_t ps20 = 0xFFFF0200, vs30 = 0xFFFE0300, ps30 = 0xFFFF0300, stop = 0xFFFF,
                        r0 = 0x800F0000, c0 = 0xA0E40000, mov = 0x02000001;

INSTANTIATE_TEST_SUITE_P(
    Tokens, RefusedTokens,
    testing::Values(
        Malformed{{}, 0, "empty"},
        Malformed{{0xFFFF0104, stop}, 0, "0xffff0104 is not the version"},
        Malformed{{ps20}, 1, "without an end"}, Malformed{{ps20, mov, r0, c0}, 4, "without an end"},
        Malformed{{ps20, stop, stop}, 2, "1 tokens follow the end"},
        Malformed{{ps20, mov, r0}, 1, "the length is 2 but only 1"},
        Malformed{
            {ps20, 0x03000001, r0, c0, c0, stop}, 1, "the length is 3 where the operands take 2"},
        Malformed{{ps20, 0x01000001, r0, c0, stop}, 1, "leaves out an operand"},
        Malformed{{ps20, 0x82000001, r0, c0, stop}, 1, "no instruction of this version"},
        Malformed{{ps20, 0x42000001, r0, c0, stop}, 1, "no instruction of this version"},
        Malformed{{ps20, mov, 0x000F0000, c0, stop}, 2, "its highest bit is clear"},
        Malformed{{ps20, mov, r0, 0x20E40000, stop}, 3, "its highest bit is clear"},
        Malformed{{ps20, mov, r0, 0xA0E44000, stop}, 3, "a bit set that no operand has"},
        Malformed{{ps20, 0x02000040, r0, c0, stop}, 1, "no instruction 64"},
        Malformed{{ps20, 0x03040042, r0, c0, c0, stop}, 1, "no instruction 66 with control bits 4"},
        Malformed{{ps20, mov, r0, 0xA2E40000, stop}, 3, "source modifier"},
        Malformed{{ps20, mov, 0x810F0000, c0, stop}, 2, "result shift"},
        Malformed{{ps20, mov, 0x80000000, c0, stop}, 2, "empty write mask"},
        Malformed{{ps20, mov, 0xC00F0000, c0, stop}, 2, "ps_2_0 has no register of type 4"},
        Malformed{{ps30, mov, r0, 0x90E41002, stop}, 3, "no register of type 17 and number 2"},
        Malformed{{ps30, 0x02000029, c0, c0, stop}, 1, "no comparison 0"},
        Malformed{{ps30, 0x12000001, r0, c0, stop}, 3, "another register than p0"},
        Malformed{{ps30, 0x12000001, r0, 0xB0E41000, stop}, 1, "leaves out an operand"},
        Malformed{{vs30, 0x03000001, r0, 0xA0E42000, 0xB0E40000, stop}, 4, "one component of a0"},
        Malformed{{ps20, 0x0200001F, 0x00000000, 0xB00F0000, stop}, 2, "what is declared"},
        Malformed{{ps20, 0x0200001F, 0x80000000, r0, stop}, 3, "cannot be declared"},
        Malformed{{ps30, 0x0200001F, 0x8000001F, 0x900F0000, stop}, 2, "no usage 31"},
        Malformed{{ps20, 0x0200001F, 0x88000000, 0xA00F0800, stop}, 2, "no texture kind 1"},
        Malformed{{ps20, mov, r0, c0, 0x0200001F, 0x80000000, 0xB00F0000, stop},
                  4,
                  "follows an instruction"},
        Malformed{{ps20, 0x05000051, 0xA0070000, 0, 0, 0, 0, stop}, 2, "whole c register"},
        Malformed{{ps20, 0x04000051, 0xA00F0000, 0, 0, 0, stop}, 1, "leaves out an operand"},
        Malformed{{ps20, 0x0009FFFE, constant_table_tag, stop}, 1, "the length is 9 but only 2"},
        Malformed{{ps20, 0x0002FFFE, constant_table_tag, 28, stop}, 1, "the header is too short"}));

// Every prefix of a valid stream is refused, and every single lost token.
TEST(Bytecode, ATruncatedStreamIsRefused) {
    const Words whole = encode(random_shader(3, Profile::ps_3_0));
    for (std::size_t size = 0; size < whole.size(); ++size)
        EXPECT_FALSE(decode(std::span(whole).first(size)))
            << size << " of " << whole.size() << " tokens";
}

void mutate(Words& tokens, Dice& dice) {
    const auto at = static_cast<std::size_t>(dice.up_to(static_cast<int>(tokens.size()) - 1));
    switch (dice.up_to(5)) {
        case 0: tokens[at] = dice.bits(); break;
        case 1: tokens.erase(tokens.begin() + static_cast<std::ptrdiff_t>(at)); break;
        case 2:
            tokens.insert(tokens.begin() + static_cast<std::ptrdiff_t>(at),
                          tokens[dice.bits() % tokens.size()]);
            break;
        case 3: tokens[at] = tokens[dice.bits() % tokens.size()]; break;
        default: tokens[at] ^= 1u << dice.up_to(31);
    }
    if (tokens.empty()) tokens.push_back(stop);
}

// 200,000 inputs: valid streams with one to three changes, and random words behind a valid version.
TEST(Bytecode, FuzzNeverCrashesAndWhatIsAcceptedIsStable) {
    constexpr std::uint32_t seed = 13;
    Dice dice(seed);
    Words base;
    int accepted = 0;
    for (int i = 0; i < 200000; ++i) {
        if (i % 100 == 0) base = encode(random_shader(dice.bits(), every_profile[i / 100 % 6]));
        Words tokens = base;
        if (i % 10 == 0) {
            tokens.resize(1 + static_cast<std::size_t>(dice.up_to(20)));
            for (std::size_t at = 1; at < tokens.size(); ++at)
                tokens[at] = dice.bits() >> dice.up_to(31);
        } else {
            for (int edits = dice.up_to(2); edits >= 0; --edits) mutate(tokens, dice);
        }
        const auto shader = decode(tokens);
        if (!shader) continue;
        ++accepted;
        const auto again = decode(encode(*shader), shader->profile);
        ASSERT_TRUE(again) << "seed " << seed << ", input " << i << "\n"
                           << to_string(again.error());
        ASSERT_TRUE(*again == *shader || print(*again) == print(*shader))
            << "seed " << seed << ", input " << i;
        ASSERT_TRUE(parse(print(*shader), "")) << "seed " << seed << ", input " << i << "\n"
                                               << print(*shader);
    }
    EXPECT_GT(accepted, 10000) << "the mutations are so coarse that nothing is tested";
    EXPECT_LT(accepted, 150000) << "the mutations are so weak that nothing is tested";
}

TEST(ConstantTable, HasTheLayoutOfD3dx) {
    Shader shader = *parse(
        "ps_2_0\n// uniform float3 zeta : c4\n// uniform sampler map : s1\ndcl_cube s1\n", "");
    const Words table = build_constant_table(shader, version_token(shader.profile));
    EXPECT_EQ(table[0], 28u);
    EXPECT_EQ(table[2], 0xFFFF0200u);
    EXPECT_EQ(table[3], 2u);
    EXPECT_EQ(table[4], 28u);
    EXPECT_EQ(table[8], 3u | 1u << 16)
        << "names are sorted: the sampler \"map\" comes first, in set 3 at register 1";
    EXPECT_EQ(table[9], 1u);
    const std::size_t type = table[10] / 4;
    EXPECT_EQ(table[type], 4u | 14u << 16) << "class object, type samplerCUBE";
    EXPECT_EQ(table[table[15] / 4], 1u | 3u << 16) << "class vector, type float";
    EXPECT_EQ(table[table[15] / 4 + 1], 1u | 3u << 16) << "one row, three columns";
}

TEST(ConstantTable, ReadsWhatItWrites) {
    Shader shader = *parse(
        "ps_3_0\n// uniform float4x4 world : c0, 4 registers\n"
        "// uniform float3 lights[3] : c10, 3 registers\n// uniform int1 count : i0\n"
        "// uniform bool1 flag : b2\n// uniform sampler env : s1\n",
        "");
    const auto table =
        parse_constant_table(build_constant_table(shader, version_token(shader.profile)));
    ASSERT_TRUE(table) << to_string(table.error());
    EXPECT_EQ(table->target, "ps_3_0");
    std::vector<std::string> names;
    for (const Constant& constant : table->constants) names.push_back(constant.name);
    EXPECT_THAT(names, ElementsAreArray({"flag", "count", "world", "lights", "env"}))
        << "by set, then register";
    EXPECT_EQ(table->constants[2], shader.constants[0]);
}

}  // namespace
}  // namespace intaglio::d3d9
