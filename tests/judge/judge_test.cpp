// The installed judge does what its commands promise.
#include "tests/judge/judge.h"

#include <gmock/gmock.h>

namespace intaglio::judge {
namespace {

using testing::HasSubstr;

TEST(Judge, AnswersEachQuestionOfABatch) {
    Batch batch;
    const auto legal =
        batch.assemble("ps_2_0\ndcl t0.xy\ndcl_2d s0\ntexld r0, t0, s0\nmov oC0, r0\n");
    const auto illegal = batch.assemble("ps_2_0\nmov oC0, r0\n");
    const auto code =
        batch.disassemble({0xFFFF0200, 0x02000001, 0x800F0800, 0xA0E40000, 0x0000FFFF});
    const auto hlsl = batch.compile("float4 f(float2 t : TEXCOORD0) : COLOR { return t.xyyy * K; }",
                                    "f", "ps_2_0", {{"K", "3"}});
    const auto wrong = batch.compile("float4 f() : COLOR { return nonsense; }", "f", "ps_3_0");
    const auto answers = batch.run(*find());
    ASSERT_TRUE(answers.ok()) << answers.error().message;

    EXPECT_TRUE(answers->at(legal).accepted);
    EXPECT_THAT(answers->at(legal).text, HasSubstr("texld r0, t0, s0"));
    EXPECT_EQ(answers->at(legal).words.front(), 0xFFFF0200u);
    EXPECT_EQ(answers->at(legal).words.back(), 0x0000FFFFu);
    EXPECT_FALSE(answers->at(illegal).accepted);
    EXPECT_EQ(error_code(answers->at(illegal)), "X5204");
    EXPECT_TRUE(answers->at(code).accepted);
    EXPECT_THAT(answers->at(code).text, HasSubstr("mov oC0, c0"));
    EXPECT_TRUE(answers->at(hlsl).accepted);
    EXPECT_EQ(answers->at(hlsl).words.front(), 0xFFFF0200u);
    EXPECT_FALSE(answers->at(wrong).accepted);
    EXPECT_EQ(error_code(answers->at(wrong)), "X3004");
}

}  // namespace
}  // namespace intaglio::judge
