// abs a = a < 0 ? -a : a,  min(a, b) = a < b ? a : b,  max(a, b) = a > b ? a : b.
#include "generator/target/replace_int_functions.h"

#include "generator/passes/rewrite.h"

namespace intaglio {
namespace {

using ir::Instruction;
using ir::Op;
using ir::ValueId;

class Rewrite {
  public:
    explicit Rewrite(ir::Module& module) : module_(module) {}

    void run(ir::Region& region) {
        std::vector<Instruction> old = std::move(region.body);
        region.body.clear();
        for (Instruction& instruction : old) {
            for (ir::Region& inner : instruction.regions) run(inner);
            const bool function =
                instruction.op == Op::Abs || instruction.op == Op::Min || instruction.op == Op::Max;
            if (function && module_.type(instruction.result()).scalar == ir::Scalar::Int)
                replace(region, instruction);
            else
                region.body.push_back(std::move(instruction));
        }
    }

  private:
    ValueId append(ir::Region& region, Instruction instruction) {
        region.body.push_back(std::move(instruction));
        return region.body.back().result();
    }

    ValueId append(ir::Region& region, Op op, ir::Type type, std::vector<ValueId> operands,
                   const ir::Origin& origin) {
        return append(region, passes::make_instruction(module_, op, type, operands, origin));
    }

    ValueId lane(ir::Region& region, ValueId vector, int index, const ir::Origin& origin) {
        if (module_.type(vector).width == 1) return vector;
        Instruction swizzle =
            passes::make_instruction(module_, Op::Swizzle, ir::int1, std::vector{vector}, origin);
        swizzle.lanes[0] = static_cast<std::uint8_t>(index);
        return append(region, std::move(swizzle));
    }

    // The instruction's own result comes last, so that nothing after it changes.
    void replace(ir::Region& region, const Instruction& instruction) {
        const ir::Origin& origin = instruction.origin;
        const bool abs = instruction.op == Op::Abs;
        const Op test = instruction.op == Op::Max ? Op::Greater : Op::Less;
        std::vector<ValueId> lanes;
        for (int i = 0; i < module_.type(instruction.result()).width; ++i) {
            const ValueId a = lane(region, instruction.operands[0], i, origin);
            const ValueId b = abs ? append(region, passes::make_int_constant(module_, 0, origin))
                                  : lane(region, instruction.operands[1], i, origin);
            const ValueId holds = append(region, test, ir::bool1, {a, b}, origin);
            const ValueId chosen = abs ? append(region, Op::Neg, ir::int1, {a}, origin) : a;
            lanes.push_back(
                append(region, Op::Select, ir::int1, {holds, chosen, abs ? a : b}, origin));
        }
        if (lanes.size() > 1)
            append(region, Op::Compose, module_.type(instruction.result()), lanes, origin);
        region.body.back().results = instruction.results;
    }

    ir::Module& module_;
};

}  // namespace

Status replace_int_functions(ir::Module& module, const Target&, Notes&) {
    Rewrite(module).run(module.body);
    return Done{};
}

}  // namespace intaglio
