// In the languages with `precise`, every sum, difference and product of the binary must be marked
// NoContraction, also those that only feed a condition or the coordinate of a texture read.
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/unit/ir/random_module.h"
#include "tests/unit/target/programs.h"

namespace intaglio {
namespace {

// The lines of the disassembly that may be contracted; `arithmetic` counts all.
std::vector<std::string> contractible(const std::string& disassembly, int& arithmetic) {
    std::set<std::string> marked;
    std::vector<std::string> lines;
    std::istringstream text(disassembly);
    for (std::string line; std::getline(text, line);) {
        std::istringstream words(line);
        std::string first, second, third;
        words >> first >> second >> third;
        if (first == "OpDecorate" && third == "NoContraction") marked.insert(second);
        const bool counts = third == "OpFAdd" || third == "OpFSub" || third == "OpFMul" ||
                            third == "OpVectorTimesScalar";
        if (!counts) continue;
        ++arithmetic;
        if (!marked.count(first)) lines.push_back(line);
    }
    return lines;
}

void expect_precise(const ir::Program& program) {
    int arithmetic = 0;
    for (const testing::TextTarget& target : testing::text_targets) {
        if (!find_target(target.name)->capabilities.precise) continue;
        for (ir::Stage stage : {ir::Stage::Vertex, ir::Stage::Pixel}) {
            const Artifact artifact = testing::emitted(program, stage, target.name);
            const auto words = check::to_spirv(testing::source_of(artifact, target.language));
            ASSERT_TRUE(words.ok()) << to_string(words.error()) << artifact.text;
            const std::vector<std::string> lines =
                contractible(*check::disassemble(*words), arithmetic);
            ASSERT_TRUE(lines.empty())
                << target.name << ": " << lines.size() << " operations, first" << lines[0] << "\n"
                << artifact.text;
        }
    }
    EXPECT_GT(arithmetic, 0);
}

TEST(Precise, ReachesConditionsAndCoordinates) {
    expect_precise(testing::program_of(testing::parsed(R"(
pixel "march"
input uv float2 interpolant
input view float2 interpolant
output colour float4 target
sampler height 2d
{
    %uv float2 = input uv
    %view float2 = input view
    %zero float1 = const 0.0
    %step float1 = const 0.3
    %x float1 = swizzle %view.x
    %hit_t float1 = loop "march" 4 (%zero) {
    (%i int1, %t float1):
        %tt float2 = swizzle %t.xx
        %offset float2 = mul %view, %tt
        %at float2 = add %uv, %offset
        %texel float4 = sample_level height %at, %zero
        %relief float1 = swizzle %texel.w
        %scaled float1 = mul %relief, %x
        %high float1 = add %scaled, %step
        %hit bool1 = greater_equal %high, %x
        break_if %hit (%t)
        %next float1 = add %t, %step
        yield (%next)
    }
    %square float1 = mul %hit_t, %hit_t
    %limit float1 = sub %square, %x
    %far bool1 = greater %limit, %step
    %tinted float1 = if %far {
        %a float1 = mul %x, %limit
        %b float1 = add %a, %step
        yield (%b)
    } else {
        yield (%zero)
    }
    %last float4 = compose %uv, %tinted, %hit_t
    %doubled float4 = add %last, %last
    %part float2 = swizzle %doubled.zx
    %result float4 = compose %part, %uv
    return (%result)
}
)")));
}

TEST(Precise, ReachesEverythingInRandomModules) {
    for (std::uint64_t seed = 1, done = 0; done < 25; ++seed) {
        ir::testing::RandomModuleOptions options;
        options.odd_text = options.special_constants = options.unused_values = false;
        options.instructions = 60;
        const ir::Module module = ir::testing::random_module(seed, options);
        if (module.stage != ir::Stage::Pixel) continue;
        SCOPED_TRACE("seed " + std::to_string(seed));
        ir::Program program = testing::program_of(module);
        // Something to find even where the passes fold the whole module.
        ir::Module& pixel = program.pixel;
        pixel.outputs.push_back({"sum", ir::float1, ir::Semantic::Target});
        pixel.inputs.push_back({"term", ir::float1, ir::Semantic::Interpolant});
        ir::Instruction back = pixel.body.body.back();
        pixel.body.body.pop_back();
        ir::Builder builder(pixel);
        const ir::ValueId term = builder.input(static_cast<int>(pixel.inputs.size()) - 1);
        back.operands.push_back(builder.emit(ir::Op::Add, {term, term}));
        builder.append(back);
        expect_precise(testing::program_of(pixel));
        if (::testing::Test::HasFailure()) return;
        ++done;
    }
}

}  // namespace
}  // namespace intaglio
