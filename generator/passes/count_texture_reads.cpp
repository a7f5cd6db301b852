// An int counter runs through the module beside its values: reads of straight code are summed while
// generating and added where control flow parts or joins; loops carry it, break_ifs and yields
// deliver it.
#include "generator/passes/count_texture_reads.h"

#include "generator/passes/rewrite.h"

namespace intaglio::passes {
namespace {

using namespace ir;

class Counter {
  public:
    explicit Counter(Module& module) : module_(module) {}

    void run() {
        Instruction zero = make_int_constant(module_, 0, {});
        const ValueId start = zero.result();
        module_.body.body.insert(module_.body.body.begin(), std::move(zero));
        visit(module_.body, start);
        constexpr Semantic semantics[] = {Semantic::Interpolant, Semantic::Target,
                                          Semantic::Result};
        module_.outputs.push_back(
            {"reads", float4, semantics[static_cast<std::size_t>(module_.stage)]});
    }

  private:
    // `count`: the reads before this region.  Its terminator delivers those after it.
    void visit(Region& region, ValueId count) {
        int pending = 0;  // reads since then
        rebuild(region, [&](Instruction instruction, std::vector<Instruction>& body) {
            if (is_sample(instruction.op)) ++pending;
            const bool joins = instruction.op == Op::BreakIf || is_terminator(instruction.op) ||
                               counts_inside(instruction);
            if (joins && pending > 0) {
                body.push_back(make_int_constant(module_, pending, instruction.origin));
                const std::array terms = {count, body.back().result()};
                body.push_back(make_instruction(module_, Op::Add, int1, terms, instruction.origin));
                count = body.back().result();
                pending = 0;
            }
            if (instruction.op == Op::Return) return finish(std::move(instruction), count, body);
            if (instruction.op == Op::BreakIf || instruction.op == Op::Yield)
                instruction.operands.push_back(count);
            if (counts_inside(instruction)) count = carry(instruction, count);
            body.push_back(std::move(instruction));
        });
    }

    static bool counts_inside(const Instruction& instruction) {
        for (const Region& region : instruction.regions)
            if (reads_textures(region)) return true;
        return false;
    }

    // Gives a loop or if the counter as a further carried value or result; returns the count after
    // it.
    ValueId carry(Instruction& instruction, ValueId count) {
        for (Region& region : instruction.regions) {
            ValueId inside = count;
            if (instruction.op == Op::Loop) {
                inside = module_.add_value(int1);
                region.parameters.push_back(inside);
            }
            visit(region, inside);
        }
        if (instruction.op == Op::Loop) instruction.operands.push_back(count);
        instruction.results.push_back(module_.add_value(int1));
        return instruction.results.back();
    }

    void finish(Instruction instruction, ValueId count, std::vector<Instruction>& body) {
        body.push_back(make_instruction(module_, Op::ToFloat, float1, {&count, 1}, {}));
        const ValueId reads = body.back().result();
        body.push_back(make_constant(module_, float3, {}, {}));
        const std::array parts = {reads, body.back().result()};
        body.push_back(make_instruction(module_, Op::Compose, float4, parts, {}));
        instruction.operands.push_back(body.back().result());
        body.push_back(std::move(instruction));
    }

    Module& module_;
};

}  // namespace

void count_texture_reads(ir::Module& module) {
    Counter(module).run();
    compact_values(module);
}

}  // namespace intaglio::passes
