// Runs a module on the CPU, in binary32, binary64 or a narrow format.  The semantics are those of
// the ops table, with lavapipe's choice wherever a row leaves one to the device (arithmetic.h says
// how denormals and NaNs go).  In Single, every op that the table calls exact gives exactly the
// bits that it gives on a device; Double is the yardstick for rounding.  Narrow24 and Narrow16 are
// what pixel shader hardware of the Direct3D 9 years computed in (narrow.h): every value is one of
// the format, every division a reciprocal and a product; coordinates reach the texture unit in the
// format, whose own arithmetic stays binary32.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "generator/ir/module.h"
#include "generator/ir/texture.h"

namespace intaglio::ir {

enum class Precision { Single, Double, Narrow24, Narrow16 };

// What a module reads.  Numbers are doubles whatever the type: an int is the nearest int32 (NaN:
// 0), a bool holds unless 0.  Whatever is missing reads as 0.
struct Environment {
    using Vector = std::array<double, 4>;
    std::vector<Vector> inputs{};                 // by slot
    std::vector<std::vector<Vector>> uniforms{};  // by slot, then element
    std::vector<const Texture*> samplers{};       // by slot
    // Inputs of the right and of the lower neighbour pixel, by slot: what derivatives are taken
    // from.  If either is empty, derivatives are 0, and an implicit texture read takes level 0.
    std::vector<Vector> right_inputs{};
    std::vector<Vector> lower_inputs{};
};

struct Evaluation {
    std::vector<std::array<double, 4>>
        outputs;             // components beyond the output's width are 0; bools are 0 or 1
    long texture_reads = 0;  // carried out, of this pixel alone
    long instructions = 0;   // carried out; leaves and terminators do not count
};

// A module made ready to run many times.  Immutable: any number of threads may run one.
class Evaluator {
  public:
    // The module must verify; it is not referred to afterwards.
    explicit Evaluator(const Module& module);

    // One pixel (vertex, call).  Allocates once for its values and once for the outputs, never by
    // instruction.
    Evaluation run(const Environment& environment, Precision precision) const;

    struct Prepared;

  private:
    std::shared_ptr<const Prepared> prepared_;
};

// Components as in Instruction::bits: of a float, an int, or 0 / 1; zero beyond the width.
using ConstantBits = std::array<std::uint32_t, 4>;

// One instruction in Single on constants, bit for bit what Evaluator does; nothing if its result is
// not a function of its operands alone (leaves, texture reads, derivatives, control flow).  The
// types must be what the op takes; the swizzle's width is `result_width`, which other ops ignore.
std::optional<ConstantBits> evaluate_op(const Instruction& instruction,
                                        std::span<const Type> operand_types,
                                        std::span<const ConstantBits> operands,
                                        int result_width = 0);

}  // namespace intaglio::ir
