// Random straight-line shaders against a second evaluator, which carries out each instruction while
// it is drawn, on plain floats.
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <random>

#include "tests/unit/interpret/programs.h"

namespace intaglio::d3d9 {
namespace {

float flushed(float v) { return std::fabs(v) < FLT_MIN ? std::copysign(0.0f, v) : v; }

class RandomShader {
  public:
    explicit RandomShader(std::uint32_t seed) : random_(seed) {
        for (Vector& constant : constants)
            for (float& component : constant)
                component = std::uniform_real_distribution<float>(-2, 2)(random_);
        shader.profile = Profile::ps_3_0;
        for (int i = 0; i < 40; ++i) add();
        // Everything counts: the sum of all temps' components is not enough, so write four of them.
        for (int i = 0; i < 4; ++i) {
            Instruction out;
            out.op = Opcode::Mov;
            out.destination = Destination{};
            out.destination->file = File::ColourOut;
            out.destination->index = i;
            Source source;
            source.index = i;
            out.sources = {source};
            shader.instructions.push_back(out);
        }
    }

    Shader shader;
    std::vector<Vector> constants = std::vector<Vector>(8);
    std::array<Vector, 4> temps{};

  private:
    int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(random_); }

    Source source(Vector& value) {
        Source result;
        result.file = below(3) ? File::Temp : File::Const;
        result.index = below(result.file == File::Temp ? 4 : 8);
        const auto index = static_cast<std::size_t>(result.index);
        const Vector& from = result.file == File::Temp ? temps[index] : constants[index];
        const Modifier modifiers[] = {Modifier::None, Modifier::Negate, Modifier::Abs,
                                      Modifier::AbsNegate};
        result.modifier = modifiers[below(4)];
        for (std::size_t i = 0; i < 4; ++i) {
            result.swizzle[i] = static_cast<std::uint8_t>(below(4));
            float v = from[result.swizzle[i]];
            if (result.modifier == Modifier::Abs || result.modifier == Modifier::AbsNegate)
                v = std::fabs(v);
            if (result.modifier == Modifier::Negate || result.modifier == Modifier::AbsNegate)
                v = -v;
            value[i] = v;
        }
        return result;
    }

    void add() {
        struct Choice {
            Opcode op;
            std::size_t sources;
        };
        const Choice choices[] = {{Opcode::Mov, 1}, {Opcode::Add, 2}, {Opcode::Mul, 2},
                                  {Opcode::Mad, 3}, {Opcode::Dp3, 2}, {Opcode::Dp4, 2},
                                  {Opcode::Min, 2}, {Opcode::Max, 2}, {Opcode::Cmp, 3},
                                  {Opcode::Frc, 1}, {Opcode::Lrp, 3}, {Opcode::Dp2Add, 3}};
        const Choice choice = choices[below(std::size(choices))];
        Instruction instruction;
        instruction.op = choice.op;
        std::array<Vector, 3> s{};
        for (std::size_t i = 0; i < choice.sources; ++i)
            instruction.sources.push_back(source(s[i]));
        Destination destination;
        destination.index = below(4);
        destination.mask = static_cast<Mask>(1 + below(15));
        destination.saturate = below(4) == 0;
        instruction.destination = destination;
        const Vector value = evaluated(choice.op, s);
        Vector& into = temps[static_cast<std::size_t>(destination.index)];
        for (std::size_t i = 0; i < 4; ++i) {
            if (!(destination.mask >> i & 1)) continue;
            const float v = value[i];
            into[i] = !destination.saturate ? v : v > 1 ? 1 : v > 0 ? v : 0;
        }
        shader.instructions.push_back(instruction);
    }

    static Vector evaluated(Opcode op, const std::array<Vector, 3>& s) {
        Vector result{};
        const auto products = [&](std::size_t n) {
            float sum = flushed(s[0][0] * s[1][0]);
            for (std::size_t i = 1; i < n; ++i) sum = flushed(sum + flushed(s[0][i] * s[1][i]));
            return sum;
        };
        for (std::size_t i = 0; i < 4; ++i) {
            const float a = s[0][i], b = s[1][i], c = s[2][i];
            float& r = result[i];
            if (op == Opcode::Mov) r = a;
            if (op == Opcode::Add) r = a + b;
            if (op == Opcode::Mul) r = a * b;
            if (op == Opcode::Mad) r = flushed(a * b) + c;
            if (op == Opcode::Dp3) r = products(3);
            if (op == Opcode::Dp4) r = products(4);
            if (op == Opcode::Dp2Add) r = products(2) + s[2][0];
            if (op == Opcode::Min) r = std::fmin(a, b);
            if (op == Opcode::Max) r = std::fmax(a, b);
            if (op == Opcode::Cmp) r = a >= 0 ? b : c;
            if (op == Opcode::Frc) r = a - std::floor(a);
            if (op == Opcode::Lrp) r = flushed(a * flushed(b - c)) + c;
            r = flushed(r);
        }
        return result;
    }

    std::mt19937 random_;
};

TEST(RandomShaders, AgreeWithASecondEvaluator) {
    int finite = 0;
    for (std::uint32_t seed = 1; seed <= 500; ++seed) {
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        const RandomShader random(seed);
        Environment environment;
        environment.constants = random.constants;
        const Execution execution = prepared(random.shader).run(environment, {}, Arithmetic::Fp32);
        for (std::size_t i = 0; i < 4; ++i) {
            ASSERT_THAT(execution.colours[i], SameNumbers(random.temps[i])) << "r" << i;
            finite += std::isfinite(random.temps[i][0]);
        }
        EXPECT_EQ(execution.instructions, 44);
    }
    EXPECT_GT(finite, 1500) << "most numbers must say something";
}

// Narrow arithmetic changes numbers a little, and only a little, where nothing is amplified.
TEST(RandomShaders, NarrowArithmeticStaysNear) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> number(0, 1);
    for (int i = 0; i < 200; ++i) {
        std::vector<Vector> constants(4);
        for (Vector& v : constants) v = {number(random), number(random), number(random), 1};
        const std::string code =
            "mad_pp r0, r0, r1, r2\ndp3_pp r1, r0, r3\nlrp_pp r2, r0, r1, r3\n"
            "mul_pp r0, r2, r0";
        const Vector exact = r0_after(code, constants);
        const Vector narrow = r0_after(code, constants, Arithmetic::Fp24);
        const Vector half = r0_after(code, constants, Arithmetic::Fp16Partial);
        for (std::size_t lane = 0; lane < 4; ++lane) {
            // About ten roundings of numbers below 12: 10 * 16 * 2^-17, and 2^-11 for halves.
            EXPECT_NEAR(narrow[lane], exact[lane], 160 * 0x1p-17f);
            EXPECT_NEAR(half[lane], exact[lane], 160 * 0x1p-11f);
        }
    }
}

}  // namespace
}  // namespace intaglio::d3d9
