// One pure op on components: a switch over the op, a loop over the components.  Private to the
// evaluator.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "generator/ir/arithmetic.h"
#include "generator/ir/module.h"
#include "generator/ir/narrow.h"

namespace intaglio::ir {

constexpr std::size_t max_operands = 4;

// What compute() needs to know of an instruction.
struct Kernel {
    Op op = Op::Add;
    Scalar scalar = Scalar::Float;  // of the operands that are computed with
    int width = 1;                  // components of those operands; of the result for a swizzle
    int operand_count = 0;
    std::array<std::uint8_t, max_operands> widths{};  // components of each operand
    std::array<std::uint8_t, 4> lanes{};              // Swizzle
};

// True for the ops that compute() carries out: the result is a function of the operands alone.
constexpr bool is_pure(Op op) { return op >= Op::Add && op <= Op::Swizzle; }

// The kernel of a pure instruction over operands of these types.
Kernel make_kernel(const Instruction& instruction, const Type* operand_types, int result_width);

// `A`: Arithmetic of a type, or Narrow of a format.
template <typename A>
class Compute {
  public:
    using T = typename A::Number;
    using Bits = Cell<T>;
    using Operands = std::array<const Bits*, max_operands>;

    // The result must not overlap the operands.
    static void run(const Kernel& kernel, const Operands& operands, Bits* result) {
        switch (kernel.op) {
            case Op::Add: return numeric2<A::add, IntArithmetic::add>(kernel, operands, result);
            case Op::Sub: return numeric2<A::sub, IntArithmetic::sub>(kernel, operands, result);
            case Op::Mul: return numeric2<A::mul, IntArithmetic::mul>(kernel, operands, result);
            case Op::Min: return numeric2<A::min, IntArithmetic::min>(kernel, operands, result);
            case Op::Max: return numeric2<A::max, IntArithmetic::max>(kernel, operands, result);
            case Op::Neg: return numeric1<A::neg, IntArithmetic::neg>(kernel, operands, result);
            case Op::Abs: return numeric1<A::abs, IntArithmetic::abs>(kernel, operands, result);
            case Op::Div: return each2<A::div>(kernel, operands, result);
            case Op::Pow: return each2<A::pow>(kernel, operands, result);
            case Op::Saturate: return each1<A::saturate>(kernel, operands, result);
            case Op::Floor: return each1<A::floor>(kernel, operands, result);
            case Op::Frac: return each1<A::frac>(kernel, operands, result);
            case Op::Sqrt: return each1<A::sqrt>(kernel, operands, result);
            case Op::Rsqrt: return each1<A::rsqrt>(kernel, operands, result);
            case Op::Exp2: return each1<A::exp2>(kernel, operands, result);
            case Op::Log2: return each1<A::log2>(kernel, operands, result);
            case Op::Sin: return each1<A::sin>(kernel, operands, result);
            case Op::Cos: return each1<A::cos>(kernel, operands, result);
            case Op::Lerp: return lerp(kernel, operands, result);
            case Op::Dot: return dot(kernel, operands, result);
            case Op::Cross: return cross(operands, result);
            case Op::Less:
                return compare(kernel, operands, result, [](auto a, auto b) { return a < b; });
            case Op::LessEqual:
                return compare(kernel, operands, result, [](auto a, auto b) { return a <= b; });
            case Op::Greater:
                return compare(kernel, operands, result, [](auto a, auto b) { return a > b; });
            case Op::GreaterEqual:
                return compare(kernel, operands, result, [](auto a, auto b) { return a >= b; });
            case Op::Equal:
                return compare(kernel, operands, result, [](auto a, auto b) { return a == b; });
            case Op::NotEqual:
                return compare(kernel, operands, result, [](auto a, auto b) { return a != b; });
            case Op::And: result[0] = operands[0][0] & operands[1][0]; return;
            case Op::Or: result[0] = operands[0][0] | operands[1][0]; return;
            case Op::Not: result[0] = operands[0][0] ^ 1u; return;
            case Op::Select:
                std::copy_n(operands[operands[0][0] != 0 ? 1 : 2], kernel.width, result);
                return;
            case Op::ToFloat:
                for (int i = 0; i < kernel.width; ++i)
                    result[i] = bits(A::load(integer(operands[0][i])));
                return;
            case Op::Compose: return compose(kernel, operands, result);
            case Op::Swizzle:
                for (std::size_t i = 0; i < static_cast<std::size_t>(kernel.width); ++i)
                    result[i] = operands[0][kernel.lanes[i]];
                return;
            default: return;
        }
    }

    static T number(Bits cell) { return std::bit_cast<T>(cell); }
    static Bits bits(T value) { return std::bit_cast<Bits>(value); }
    static std::int32_t integer(Bits cell) {
        return static_cast<std::int32_t>(static_cast<std::uint32_t>(cell));
    }
    static Bits integer_bits(std::int32_t value) { return static_cast<std::uint32_t>(value); }

  private:
    template <T (*function)(T)>
    static void each1(const Kernel& kernel, const Operands& operands, Bits* result) {
        for (int i = 0; i < kernel.width; ++i) result[i] = bits(function(number(operands[0][i])));
    }
    template <T (*function)(T, T)>
    static void each2(const Kernel& kernel, const Operands& operands, Bits* result) {
        for (int i = 0; i < kernel.width; ++i)
            result[i] = bits(function(number(operands[0][i]), number(operands[1][i])));
    }
    template <T (*function)(T), std::int32_t (*int_function)(std::int32_t)>
    static void numeric1(const Kernel& kernel, const Operands& operands, Bits* result) {
        if (kernel.scalar == Scalar::Float) return each1<function>(kernel, operands, result);
        for (int i = 0; i < kernel.width; ++i)
            result[i] = integer_bits(int_function(integer(operands[0][i])));
    }
    template <T (*function)(T, T), std::int32_t (*int_function)(std::int32_t, std::int32_t)>
    static void numeric2(const Kernel& kernel, const Operands& operands, Bits* result) {
        if (kernel.scalar == Scalar::Float) return each2<function>(kernel, operands, result);
        for (int i = 0; i < kernel.width; ++i)
            result[i] =
                integer_bits(int_function(integer(operands[0][i]), integer(operands[1][i])));
    }

    template <typename Relation>
    static void compare(const Kernel& kernel, const Operands& operands, Bits* result,
                        Relation relation) {
        const bool holds =
            kernel.scalar == Scalar::Float
                ? relation(A::in(number(operands[0][0])), A::in(number(operands[1][0])))
                : relation(integer(operands[0][0]), integer(operands[1][0]));
        result[0] = holds ? 1 : 0;
    }

    static void lerp(const Kernel& kernel, const Operands& operands, Bits* result) {
        for (int i = 0; i < kernel.width; ++i)
            result[i] = bits(
                A::lerp(number(operands[0][i]), number(operands[1][i]), number(operands[2][i])));
    }

    static void dot(const Kernel& kernel, const Operands& operands, Bits* result) {
        T sum = A::mul(number(operands[0][0]), number(operands[1][0]));
        for (int i = 1; i < kernel.width; ++i)
            sum = A::add(sum, A::mul(number(operands[0][i]), number(operands[1][i])));
        result[0] = bits(sum);
    }

    static void cross(const Operands& operands, Bits* result) {
        const auto product = [&](int i, int j) {
            return A::mul(number(operands[0][i]), number(operands[1][j]));
        };
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            result[i] = bits(A::sub(product(j, k), product(k, j)));
        }
    }

    static void compose(const Kernel& kernel, const Operands& operands, Bits* result) {
        for (std::size_t i = 0; i < static_cast<std::size_t>(kernel.operand_count); ++i)
            result = std::copy_n(operands[i], kernel.widths[i], result);
    }
};

}  // namespace intaglio::ir
