// One pixel's registers, and the arithmetic unit that reads operands from them and computes what an
// instruction writes.  Private to the interpreter.
#pragma once

#include <algorithm>

#include "generator/target/d3d9/interpret_prepared.h"
#include "generator/target/d3d9/precision.h"

namespace intaglio::d3d9 {

struct Registers {
    std::array<Vector, temp_count> temps{};
    std::array<Vector, output_slot_count> outputs{};
    std::array<int, 4> address{};
    std::array<bool, 4> predicate{};
    bool killed = false;
    int texture_reads = 0;
    long instructions = 0;
};

inline constexpr Vector everywhere(float value) { return {value, value, value, value}; }

// Reads operands and computes, in arithmetic A, for one pixel.
template <typename A>
class Unit {
  public:
    Unit(const Interpreter::Prepared& prepared, const Environment& environment,
         const Inputs& inputs, const Registers& registers, int loop_counter)
        : prepared_(prepared),
          environment_(environment),
          inputs_(inputs),
          registers_(registers),
          loop_counter_(loop_counter) {}

    // `row`: added to the register's index, for matrices.
    Vector read(const Source& source, int row = 0) const {
        const Vector raw = register_of(source, row);
        Vector value;
        for (std::size_t i = 0; i < 4; ++i) {
            const float component = A::load(raw[source.swizzle[i]]);
            switch (source.modifier) {
                case Modifier::Negate: value[i] = -component; break;
                case Modifier::Abs: value[i] = std::fabs(component); break;
                case Modifier::AbsNegate: value[i] = -std::fabs(component); break;
                default: value[i] = component; break;
            }
        }
        return value;
    }

    // What the instruction would write to a full mask.
    Vector compute(const Instruction& instruction) const {
        std::array<Vector, 4> s{};
        for (std::size_t i = 0; i < instruction.sources.size() && i < 4; ++i)
            s[i] = read(instruction.sources[i]);
        switch (instruction.op) {
            case Opcode::Dp3: return everywhere(dot(s[0], s[1], 3));
            case Opcode::Dp4: return everywhere(dot(s[0], s[1], 4));
            case Opcode::Dp2Add: return everywhere(A::add(dot(s[0], s[1], 2), s[2][0]));
            case Opcode::Rcp: return everywhere(A::rcp(s[0][0]));
            case Opcode::Rsq: return everywhere(A::rsq(s[0][0]));
            case Opcode::Exp: return everywhere(A::exp2(s[0][0]));
            case Opcode::Log: return everywhere(A::log2(s[0][0]));
            case Opcode::Pow: return everywhere(A::pow(s[0][0], s[1][0]));
            case Opcode::SinCos: return {A::cos(s[0][0]), A::sin(s[0][0]), 0, 0};
            case Opcode::Lit: return light(s[0]);
            case Opcode::Dst: return {1, A::mul(s[0][1], s[1][1]), s[0][2], s[1][3]};
            case Opcode::Crs: return cross(s[0], s[1]);
            case Opcode::Nrm: {
                const float scale = A::rsq(dot(s[0], s[0], 3));
                return each([&](std::size_t i) { return A::mul(s[0][i], scale); });
            }
            case Opcode::M4x4: return transform(instruction, s[0], 4, 4);
            case Opcode::M4x3: return transform(instruction, s[0], 4, 3);
            case Opcode::M3x4: return transform(instruction, s[0], 3, 4);
            case Opcode::M3x3: return transform(instruction, s[0], 3, 3);
            case Opcode::M3x2: return transform(instruction, s[0], 3, 2);
            default:
                return each([&](std::size_t i) {
                    return by_component(instruction.op, s[0][i], s[1][i], s[2][i]);
                });
        }
    }

  private:
    template <typename F>
    static Vector each(F component) {
        return {component(0), component(1), component(2), component(3)};
    }

    static float by_component(Opcode op, float a, float b, float c) {
        switch (op) {
            case Opcode::Mov:
            case Opcode::Mova: return a;
            case Opcode::Add: return A::add(a, b);
            case Opcode::Sub: return A::sub(a, b);
            case Opcode::Mul: return A::mul(a, b);
            case Opcode::Mad: return A::add(A::mul(a, b), c);
            case Opcode::Lrp: return A::add(A::mul(a, A::sub(b, c)), c);
            case Opcode::Min: return A::min(a, b);
            case Opcode::Max: return A::max(a, b);
            case Opcode::Slt: return a < b ? 1.0f : 0.0f;
            case Opcode::Sge: return a >= b ? 1.0f : 0.0f;
            case Opcode::Cmp: return a >= 0 ? b : c;
            case Opcode::Frc: return A::frac(a);
            case Opcode::Abs: return std::fabs(a);
            case Opcode::Sgn: return a < 0 ? -1.0f : a > 0 ? 1.0f : 0.0f;
            default: return 0;
        }
    }

    static float dot(const Vector& a, const Vector& b, std::size_t count) {
        float sum = A::mul(a[0], b[0]);
        for (std::size_t i = 1; i < count; ++i) sum = A::add(sum, A::mul(a[i], b[i]));
        return sum;
    }

    static Vector cross(const Vector& a, const Vector& b) {
        const auto component = [&](std::size_t i, std::size_t j) {
            return A::sub(A::mul(a[i], b[j]), A::mul(a[j], b[i]));
        };
        return {component(1, 2), component(2, 0), component(0, 1), 0};
    }

    // x: N.L, y: N.H, w: the power, which the reference keeps within 127.9961.
    static Vector light(const Vector& a) {
        const float power = A::load(std::clamp(a[3], -127.9961f, 127.9961f));
        const bool lit = a[0] > 0;
        return {1, lit ? a[0] : 0.0f, lit && a[1] > 0 ? A::pow(a[1], power) : 0.0f, 1};
    }

    Vector transform(const Instruction& instruction, const Vector& vector, std::size_t columns,
                     int rows) const {
        Vector result{};
        for (int row = 0; row < rows; ++row)
            result[static_cast<std::size_t>(row)] =
                dot(vector, read(instruction.sources[1], row), columns);
        return result;
    }

    Vector register_of(const Source& source, int row) const {
        int index = source.index + row;
        if (source.relative) {
            const auto component = static_cast<std::size_t>(source.relative->component);
            index += source.relative->file == File::LoopCounter ? loop_counter_
                                                                : registers_.address[component];
        }
        if (index < 0 || index >= constant_count) return {};
        const auto at = static_cast<std::size_t>(index);
        switch (source.file) {
            case File::Temp: return at < temp_count ? registers_.temps[at] : Vector{};
            case File::Const:
                if (prepared_.defined[at]) return prepared_.definitions[at];
                return at < environment_.constants.size() ? environment_.constants[at] : Vector{};
            case File::Input:
                return at < inputs_.attributes.size() ? inputs_.attributes[at] : Vector{};
            case File::Texture:
                return at < inputs_.texcoords.size() ? inputs_.texcoords[at] : Vector{};
            case File::Position: return inputs_.position;
            case File::Face: return everywhere(inputs_.face);
            default: return {};
        }
    }

    const Interpreter::Prepared& prepared_;
    const Environment& environment_;
    const Inputs& inputs_;
    const Registers& registers_;
    int loop_counter_;
};

}  // namespace intaglio::d3d9
