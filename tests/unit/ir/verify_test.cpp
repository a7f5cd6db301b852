// One broken rule a case: text that parses and must not verify, and modules damaged by hand where
// text cannot say it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include <fmt/format.h>

#include "generator/ir/parse.h"
#include "generator/ir/print.h"
#include "generator/ir/verify.h"
#include "tests/unit/ir/random_module.h"

namespace intaglio::ir {
namespace {

using ::testing::HasSubstr;

constexpr const char* declarations = R"(pixel "t"
input uv float2 interpolant
output colour float4 target
uniform world float4[3]
sampler map 2d
sampler volume 3d
file "t.cpp"
step march
{
%f float1 = const 1.0  %f2 float2 = const (1.0, 2.0)  %f3 float3 = const (1.0, 2.0, 3.0)
%f4 float4 = const (1.0, 2.0, 3.0, 4.0)
%i int1 = const 1  %i3 int3 = const (1, 2, 3)  %b bool1 = const true  %b2 bool2 = const (true, false)
)";

// The verifier's sentence on these instructions after the ones above; empty if they verify.
std::string verdict(const std::string& instructions) {
    const auto module = parse(fmt::format("{}{}\n}}", declarations, instructions), "t.ir");
    if (!module) return to_string(module.error());
    const Status status = verify(*module);
    return status ? "" : to_string(status.error());
}

TEST(Verify, AcceptsTheDeclarationsOfTheOtherTests) { EXPECT_EQ(verdict("return (%f4)"), ""); }

TEST(Verify, NamesTheValueTheOpAndTheLine) {
    EXPECT_EQ(verdict("%r \"sum\" float1 = add %f, %f2 @0:12 #march  return (%f4)"),
              "t.cpp:12: error: %8 \"sum\" = add: it takes floats or ints of one type, not float1, "
              "float2 [ir-verify]");
}

TEST(Verify, RefusesWrongOperandsAndResults) {
    const struct {
        const char* instruction;
        const char* sentence;
    } cases[] = {
        {"%r float1 = add %f", "= add: it takes 2 operands, not 1"},
        {"%r float1 = add %f, %i", "it takes floats or ints of one type, not float1, int1"},
        {"%r bool1 = add %b, %b", "it takes floats or ints of one type, not bool1, bool1"},
        {"%r float2 = add %f, %f", "= add: its result is float1, not float2"},
        {"%r int1 = div %i, %i", "it takes floats of one type, not int1, int1"},
        {"%r int1 = lerp %f, %f, %f2", "it takes floats of one type"},
        {"%r float3 = dot %f3, %f3", "its result is float1, not float3"},
        {"%r float1 = dot %f3, %f2", "it takes two floats of one type, not float3, float2"},
        {"%r float3 = cross %f4, %f4", "it takes two float3, not float4, float4"},
        {"%r bool1 = less %f2, %f2", "it takes two float1 or two int1, not float2, float2"},
        {"%r bool1 = equal %b, %b", "it takes two float1 or two int1, not bool1, bool1"},
        {"%r float1 = less %f, %f", "its result is bool1, not float1"},
        {"%r bool2 = and %b2, %b2", "it takes bool1, not bool2, bool2"},
        {"%r bool1 = not %f", "it takes bool1, not float1"},
        {"%r float1 = select %f, %f, %f",
         "it takes a bool1 and two values of one type, not float1, float1, float1"},
        {"%r float1 = select %b, %f, %f2", "it takes a bool1 and two values of one type"},
        {"%r float1 = select %b, %f2, %f2", "its result is float2, not float1"},
        {"%r float1 = to_float %f", "it takes an int, not float1"},
        {"%r float1 = to_float %i3", "its result is float3, not float1"},
        {"%r float1 = compose %f",
         "it takes 2 to 4 operands of one scalar kind with at most 4 components together"},
        {"%r float4 = compose %f3, %f2", "it takes 2 to 4 operands of one scalar kind"},
        {"%r float2 = compose %f, %i", "it takes 2 to 4 operands of one scalar kind"},
        {"%r float2 = compose %f2, %f", "its result is float3, not float2"},
        {"%r float2 = swizzle %f2.xz", "component 1 reads lane 2 of a float2"},
        {"%r int2 = swizzle %f2.xy", "its result is float2, not int2"},
        {"%r float4 = sample_level map %f3, %f", "it takes float2, float1, not float3, float1"},
        {"%r float4 = sample_level volume %f2, %f", "it takes float3, float1, not float2, float1"},
        {"%r float4 = sample_level map %f2, %f2", "it takes float2, float1, not float2, float2"},
        {"%r float4 = sample_grad map %f2, %f2, %f",
         "it takes float2, float2, float2, not float2, float2, float1"},
        {"%r float4 = sample map %f2, %f", "it takes 1 operands, not 2"},
        {"%r float3 = sample map %f2", "its result is float4, not float3"},
        {"%r float4 = sample_level $2 %f2, %f", "there is no sampler 2, the module has 2"},
        {"%r float4 = sample_level $-1 %f2, %f", "there is no sampler -1"},
        {"%r int1 = ddx %i", "it takes floats of one type, not int1"},
        {"%r float3 = input uv", "its result is float2, not float3"},
        {"%r float2 = input $1", "there is no input 1, the module has 1"},
        {"%r float4 = uniform $1", "there is no uniform 1, the module has 1"},
        {"%r float4 = uniform world[3]", "there is no element 3, the uniform has 3"},
        {"%r float4 = uniform world[-1]", "there is no element -1"},
        {"%r float3 = uniform world", "its result is float4, not float3"},
        {"%r bool1 = const 0x2", "the bits of a bool are 0 or 1, not 2"},
        {"%r float1, %s float1 = add %f, %f", "it defines one value, not 2"},
        {"add %f, %f", "add: it defines one value, not 0"},
        {"%r float1 = neg %late  %late float1 = neg %f", "\"late\" is used before it is defined"},
        {"%r float1 = neg %r", "\"r\" is used before it is defined"},
        {"%r float1 = neg %f @1:3", "its origin names file 1 of 1"},
        {"%r float1 = neg %f @-2:3", "its origin names file -2 of 1"},
        {"%r float1 = neg %f @0:-3", "its origin has a negative line"},
        {"%r float1 = neg %f #1", "its origin names step 1 of 1"},
    };
    for (const auto& [instruction, sentence] : cases) {
        const std::string answer = verdict(fmt::format("{}  return (%f4)", instruction));
        EXPECT_THAT(answer, HasSubstr(sentence)) << instruction;
        EXPECT_THAT(answer, HasSubstr("[ir-verify]"));
    }
}

TEST(Verify, RefusesBrokenRegions) {
    const struct {
        const char* instructions;
        const char* sentence;
    } cases[] = {
        {"", "the body: the region does not end in a return"},
        {"yield ()", "yield: the module's body ends in a return"},
        {"return (%f4) return (%f4)", "return: instructions follow the terminator"},
        {"return (%f3)", "it returns float3, but the outputs are float4"},
        {"return ()", "it returns nothing, but the outputs are float4"},
        {"%r float4 = return (%f4)", "it defines no value"},
        {"loop \"l\" 3 () { (%j int1): } return (%f4)", "loop: the region does not end in a yield"},
        {"loop \"l\" 3 () { (%j int1): return (%f4) } return (%f4)",
         "a region of a loop or an if ends in a yield"},
        {"loop \"l\" -1 () { (%j int1): yield () } return (%f4)", "its trip count is -1, below 0"},
        {"loop \"l\" 3 () { (): yield () } return (%f4)",
         "the first parameter of its region is the index, an int1"},
        {"loop \"l\" 3 () { (%j float1): yield () } return (%f4)", "is the index, an int1"},
        {"loop \"l\" 3 (%f) { (%j int1): yield () } return (%f4)",
         "its region carries nothing, not float1 as given"},
        {"%r float1 = loop \"l\" 3 (%f) { (%j int1, %c float2): yield (%c) } return (%f4)",
         "its region carries float2, not float1 as given"},
        {"loop \"l\" 3 (%f) { (%j int1, %c float1): yield (%c) } return (%f4)",
         "its results are nothing, not float1 as carried"},
        {"%r float1 = loop \"l\" 3 (%f) { (%j int1, %c float1): yield (%f2) } return (%f4)",
         "it yields float2, not float1"},
        {"%r float1 = loop \"l\" 3 (%f) { (%j int1, %c float1): yield () } return (%f4)",
         "it yields nothing"},
        {"%r float1 = loop \"l\" 3 (%f) { (%j int1, %c float1): break_if %b () yield (%c) } return "
         "(%f4)",
         "break_if: it leaves the loop with nothing, not float1"},
        {"loop \"l\" 3 () { (%j int1): break_if %f () yield () } return (%f4)",
         "its first operand is a bool1"},
        {"loop \"l\" 3 () { (%j int1): if %b { break_if %b () yield () } else { yield () } yield "
         "() } return (%f4)",
         "break_if: it stands at the top level of a loop's body"},
        {"break_if %b () return (%f4)", "it stands at the top level of a loop's body"},
        {"loop \"l\" 3 () { (%j int1): %in float1 = neg %f yield () } %r float1 = neg %in return "
         "(%f4)",
         "\"in\" is used outside the region that defines it"},
        {"if %b { %in float1 = neg %f yield () } else { %r float1 = neg %in yield () } return "
         "(%f4)",
         "\"in\" is used outside the region that defines it"},
        {"loop \"l\" 3 () { (%j int1): yield () } %r int1 = neg %j return (%f4)",
         "\"j\" is used outside the region that defines it"},
        {"if %f { yield () } else { yield () } return (%f4)", "if: it takes bool1, not float1"},
        {"%r float1 = if %b { yield (%f) } else { yield (%f2) } return (%f4)",
         "it yields float2, not float1"},
        {"if %b { (%j int1): yield () } else { yield () } return (%f4)",
         "only the region of a loop has parameters"},
        {"if %b { %r float2 = ddx %f2 yield () } else { yield () } return (%f4)",
         "an op that needs neighbouring pixels stands outside loops and ifs"},
        {"loop \"l\" 3 () { (%j int1): %r float4 = sample map %f2 yield () } return (%f4)",
         "an op that needs neighbouring pixels stands outside loops and ifs"},
    };
    for (const auto& [instructions, sentence] : cases)
        EXPECT_THAT(verdict(instructions), HasSubstr(sentence)) << instructions;
}

TEST(Verify, RefusesBrokenDeclarations) {
    const struct {
        const char* text;
        const char* sentence;
    } cases[] = {
        {"pixel \"t\" uniform u float1[0] { return () }",
         "uniform 'u': it has 0 elements, below 1"},
        {"pixel \"t\" sampler s 4d { return () }", "sampler 's': its dimension is 2 or 3, not 4"},
        {"pixel \"t\" sampler s 2d sampler s 2d { return () }", "two samplers are called 's'"},
        {"pixel \"t\" sampler \"\" 2d { return () }", "a sampler has no name"},
        {"pixel \"t\" input a float1 attribute { return () }",
         "input 'a': a pixel stage has no input of the semantic attribute"},
        {"vertex \"t\" input a float1 interpolant { return () }",
         "input 'a': a vertex stage has no input of the semantic interpolant"},
        {"function \"t\" output a float1 target { %0 float1 = const 1.0 return (%0) }",
         "output 'a': a function stage has no output of the semantic target"},
        {"pixel \"t\" input a int1 interpolant { return () }",
         "input 'a': interpolant is a float, not int1"},
        {"vertex \"t\" output p float3 position { %0 float3 = const (1.0, 1.0, 1.0) return (%0) }",
         "output 'p': the position is a float4, not float3"},
        {"vertex \"t\" output p float4 position output q float4 position { return () }",
         "two outputs are the position"},
        {"vertex \"t\" input a float1 attribute { %0 float1 = input a %1 float1 = ddx %0 return () "
         "}",
         "a vertex stage has no neighbouring pixels"},
    };
    for (const auto& [text, sentence] : cases) {
        const auto module = parse(text, "t.ir");
        ASSERT_TRUE(module) << text << "\n" << to_string(module.error());
        const Status status = verify(*module);
        ASSERT_FALSE(status) << text;
        EXPECT_THAT(to_string(status.error()), HasSubstr(sentence));
    }
}

TEST(Verify, RefusesWhatTextCannotSay) {
    constexpr const char* text = R"(function "t" output o float1 result {
        %0 float1 = const 1.0  %1 float1 = add %0, %0  %2 float2 = swizzle %0.xx
        %3 bool1 = const true  if %3 { yield () } else { yield () }  return (%1) })";
    using Edit = std::function<void(Module&)>;
    const struct {
        Edit edit;
        const char* sentence;
    } cases[] = {
        {[](Module& m) { m.body.body[1].results[0] = static_cast<ValueId>(0); },
         "add: %0 is defined twice"},
        {[](Module& m) { m.body.body[1].results[0] = static_cast<ValueId>(77); },
         "%77 is not a value of the module"},
        {[](Module& m) { m.body.body[1].operands[0] = static_cast<ValueId>(77); },
         "%77 is not a value of the module"},
        {[](Module& m) { m.body.body[0].bits[1] = 1; }, "bits beyond its width are not 0"},
        {[](Module& m) { m.body.body[2].lanes[2] = 1; }, "lanes beyond its width are not 0"},
        {[](Module& m) { m.body.body[2].lanes[1] = 9; }, "component 1 reads lane 9 of a float1"},
        {[](Module& m) { m.body.body[1].bits[0] = 1; }, "only a constant has bits"},
        {[](Module& m) { m.body.body[1].slot = 1; },
         "only an input, a uniform or a texture read has a slot"},
        {[](Module& m) { m.body.body[1].element = 1; }, "only a uniform has an element"},
        {[](Module& m) { m.body.body[1].lanes[0] = 1; }, "only a swizzle has lanes"},
        {[](Module& m) { m.body.body[1].loop.trip_count = 1; }, "only a loop has loop information"},
        {[](Module& m) { m.body.body[1].regions.emplace_back(); }, "it has 0 regions, not 1"},
        {[](Module& m) { m.body.body[4].regions.pop_back(); }, "it has 2 regions, not 1"},
        {[](Module& m) { m.body.body[1].op = static_cast<Op>(200); }, "this op does not exist"},
        {[](Module& m) { m.body.parameters.push_back(static_cast<ValueId>(0)); },
         "the body: only the region of a loop has parameters"},
        {[](Module& m) { m.values[1].type.width = 5; },
         "%1: a type is bool, int or float with 1 to 4 components"},
        {[](Module& m) { m.values[1].type.scalar = static_cast<Scalar>(9); },
         "%1: a type is bool, int or float"},
        {[](Module& m) { m.outputs[0].type.width = 0; },
         "output 'o': a type is bool, int or float"},
        {[](Module& m) { m.outputs[0].semantic = static_cast<Semantic>(9); },
         "its semantic does not exist"},
        {[](Module& m) { m.stage = static_cast<Stage>(9); }, "the stage does not exist"},
        {[](Module& m) {
             const Instruction branch = m.body.body[4];
             for (int i = 0; i < 70; ++i) {
                 Instruction outer = branch;
                 outer.regions[0].body.insert(outer.regions[0].body.begin(), m.body.body[4]);
                 m.body.body[4] = std::move(outer);
             }
         },
         "regions nest deeper than 64"},
    };
    ASSERT_TRUE(verify(*parse(text, "t.ir")));
    for (const auto& [edit, sentence] : cases) {
        Module module = *parse(text, "t.ir");
        edit(module);
        const Status status = verify(module);
        ASSERT_FALSE(status) << sentence;
        EXPECT_THAT(to_string(status.error()), HasSubstr(sentence));
    }
}

// Any one field of any one instruction set to any number: an answer, never a crash; and what still
// verifies still reads back to itself.
TEST(Verify, SurvivesDamagedModules) {
    testing::Random random(77);
    std::vector<Module> modules;
    for (std::uint64_t seed = 0; seed < 300; ++seed)
        modules.push_back(testing::random_module(seed));
    int refused = 0, damages = 3000;
    for (int i = 0; i < damages; ++i) {
        Module module = modules[static_cast<std::size_t>(i) % modules.size()];
        std::vector<Region*> regions = {&module.body};
        for (std::size_t r = 0; r < regions.size(); ++r)
            for (Instruction& instruction : regions[r]->body)
                for (Region& inner : instruction.regions) regions.push_back(&inner);
        Region& region =
            *regions[static_cast<std::size_t>(random.below(static_cast<int>(regions.size())))];
        const auto at =
            static_cast<std::size_t>(random.below(static_cast<int>(region.body.size())));
        Instruction& instruction = region.body[at];
        const auto id =
            static_cast<ValueId>(random.below(static_cast<int>(module.values.size()) + 3));
        switch (random.below(12)) {
            case 0: instruction.op = static_cast<Op>(random.below(60)); break;
            case 1: instruction.operands.push_back(id); break;
            case 2:
                if (!instruction.operands.empty()) instruction.operands.back() = id;
                break;
            case 3: instruction.operands.clear(); break;
            case 4: instruction.results.clear(); break;
            case 5: instruction.results.push_back(id); break;
            case 6: instruction.slot = random.between(-2, 4); break;
            case 7: instruction.regions.clear(); break;
            case 8: region.parameters.push_back(id); break;
            case 9: region.body.erase(region.body.begin() + static_cast<std::ptrdiff_t>(at)); break;
            case 10: std::swap(region.body[at], region.body.back()); break;
            case 11:
                module
                    .values[static_cast<std::size_t>(
                        random.below(static_cast<int>(module.values.size())))]
                    .type.width = random.between(-1, 6);
        }
        if (!verify(module))
            ++refused;
        else
            ASSERT_TRUE(*parse(print(module), "t.ir") == module) << "round " << i << "\n"
                                                                 << print(module);
    }
    EXPECT_GT(refused, damages / 2);
}

}  // namespace
}  // namespace intaglio::ir
