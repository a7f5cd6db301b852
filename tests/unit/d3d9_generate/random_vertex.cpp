// Values are drawn so that a little rounding stays little: divisors, roots and logarithms are of
// 0.5 and more, exponents are within [-1, 1].
#include "tests/unit/d3d9_generate/random_vertex.h"

#include <fmt/format.h>

#include "generator/ir/builder.h"
#include "tests/unit/ir/random.h"

namespace intaglio::d3d9 {
namespace {

using ir::Op;
using ir::Type;
using ir::ValueId;

class RandomVertex {
  public:
    explicit RandomVertex(std::uint64_t seed) : random_(seed), builder_(module_) {}

    ir::Module make(int instructions) {
        module_.name = "random";
        module_.stage = ir::Stage::Vertex;
        for (int i = 0; i < 4; ++i)
            module_.inputs.push_back({i == 0 ? "position" : fmt::format("attribute_{}", i),
                                      {ir::Scalar::Float, random_.between(1, 4)},
                                      ir::Semantic::Attribute});
        module_.uniforms = {{"matrix", ir::float4, 3, ""}, {"vector", ir::float3, 1, ""}};
        for (int i = 0; i < 4; ++i) floats_.push_back(builder_.input(i));
        for (int e = 0; e < 3; ++e) floats_.push_back(builder_.uniform(0, e));
        floats_.push_back(builder_.uniform(1));
        for (int i = 0; i < instructions; ++i) step();
        module_.outputs.push_back({"clip", ir::float4, ir::Semantic::Position});
        std::vector<ValueId> outputs = {pick(4)};
        for (int i = random_.between(1, 4); i > 0; --i) {
            const int width = random_.between(1, 4);
            module_.outputs.push_back(
                {fmt::format("out_{}", i), {ir::Scalar::Float, width}, ir::Semantic::Interpolant});
            outputs.push_back(pick(width));
        }
        builder_.finish(outputs);
        return std::move(module_);
    }

  private:
    int width_of(ValueId value) const { return module_.type(value).width; }
    // Late ones more often.
    ValueId any() {
        const int count = static_cast<int>(floats_.size());
        const int i =
            random_.chance(60) ? std::max(0, count - 1 - random_.below(6)) : random_.below(count);
        return floats_[static_cast<std::size_t>(i)];
    }
    // A value of this width: swizzled or composed, of constants now and then.
    ValueId pick(int width) {
        if (random_.chance(10)) {
            std::vector<ValueId> parts;
            for (int k = 0; k < width; ++k) parts.push_back(builder_.constant(number()));
            return width == 1 ? parts[0] : builder_.compose(parts);
        }
        if (width > 1 && random_.chance(15)) {
            const ValueId a = pick(width - 1), b = pick(1);
            return builder_.compose(random_.chance(50) ? std::vector{a, b} : std::vector{b, a});
        }
        const ValueId value = any();
        if (width_of(value) == width && random_.chance(60)) return value;
        std::string letters;
        for (int k = 0; k < width; ++k) letters += "xyzw"[random_.below(width_of(value))];
        return builder_.swizzle(value, letters);
    }
    float number() { return 4 * random_.unit() - 2; }
    ValueId unary(Op op, ValueId a) { return builder_.emit(op, {a}); }
    ValueId constants(float value, int width) {
        std::vector<ValueId> parts(static_cast<std::size_t>(width), builder_.constant(value));
        return width == 1 ? parts[0] : builder_.compose(parts);
    }
    // At least a half.
    ValueId large(int width) {
        return builder_.emit(Op::Max, {unary(Op::Abs, pick(width)), constants(0.5f, width)});
    }
    // Within [0, 1].
    ValueId small(int width) { return unary(Op::Saturate, pick(width)); }
    ValueId bounded(ValueId a) {
        const int width = width_of(a);
        return builder_.emit(
            Op::Max, {builder_.emit(Op::Min, {a, constants(8, width)}), constants(-8, width)});
    }

    ValueId condition(int depth = 0) {
        constexpr Op compares[] = {Op::Less,         Op::LessEqual, Op::Greater,
                                   Op::GreaterEqual, Op::Equal,     Op::NotEqual};
        if (depth < 2 && random_.chance(30)) {
            if (random_.chance(30)) return unary(Op::Not, condition(depth + 1));
            return builder_.emit(random_.chance(50) ? Op::And : Op::Or,
                                 {condition(depth + 1), condition(depth + 1)});
        }
        return builder_.emit(compares[random_.below(6)], {pick(1), pick(1)});
    }

    void step() {
        const int width = random_.between(1, 4);
        switch (random_.below(24)) {
            case 0:
            case 1: return add(builder_.emit(Op::Add, {pick(width), pick(width)}));
            case 2: return add(builder_.emit(Op::Sub, {pick(width), pick(width)}));
            case 3:
            case 4: return add(bounded(builder_.emit(Op::Mul, {pick(width), pick(width)})));
            case 5: return add(builder_.emit(Op::Div, {pick(width), large(width)}));
            case 6: return add(unary(Op::Neg, pick(width)));
            case 7: return add(unary(Op::Abs, pick(width)));
            case 8: return add(builder_.emit(Op::Min, {pick(width), pick(width)}));
            case 9: return add(builder_.emit(Op::Max, {pick(width), pick(width)}));
            case 10: return add(unary(Op::Saturate, pick(width)));
            case 11: return add(unary(Op::Floor, pick(width)));
            case 12: return add(unary(Op::Frac, pick(width)));
            case 13: return add(unary(Op::Sqrt, large(width)));
            case 14: return add(unary(Op::Rsqrt, large(width)));
            case 15: return add(unary(Op::Exp2, small(width)));
            case 16: return add(unary(Op::Log2, large(width)));
            case 17: return add(builder_.emit(Op::Pow, {large(width), small(width)}));
            case 18: return add(builder_.emit(Op::Lerp, {pick(width), pick(width), small(width)}));
            case 19: return add(bounded(dot()));
            case 20: return add(bounded(builder_.emit(Op::Cross, {pick(3), pick(3)})));
            default: return add(builder_.emit(Op::Select, {condition(), pick(width), pick(width)}));
        }
    }
    ValueId dot() {
        const int width = random_.between(2, 4);
        return builder_.emit(Op::Dot, {pick(width), pick(width)});
    }
    void add(ValueId value) { floats_.push_back(value); }

    ir::testing::Random random_;
    ir::Module module_;
    ir::Builder builder_;
    std::vector<ValueId> floats_;
};

}  // namespace

ir::Program vertex_program(const ir::Module& vertex) {
    ir::Program program;
    program.name = vertex.name;
    program.vertex = vertex;
    program.pixel.name = vertex.name;
    program.pixel.stage = ir::Stage::Pixel;
    program.pixel.outputs = {{"colour", ir::float4, ir::Semantic::Target}};
    ir::Builder builder(program.pixel);
    ValueId sum = builder.constant(0.25f);
    for (const ir::Declaration& output : vertex.outputs) {
        if (output.semantic != ir::Semantic::Interpolant) continue;
        program.pixel.inputs.push_back(output);
        const ValueId input = builder.input(static_cast<int>(program.pixel.inputs.size()) - 1);
        ValueId whole = input;
        if (output.type.width > 1) whole = builder.emit(Op::Dot, {input, input});
        sum = builder.emit(Op::Add, {sum, whole});
    }
    builder.finish(std::vector{builder.swizzle(sum, "xxxx")});
    return program;
}

ir::Program random_vertex_program(std::uint64_t seed, int instructions) {
    return vertex_program(RandomVertex(seed).make(instructions));
}

}  // namespace intaglio::d3d9
