// Only ps_3_0 has a choice.
#include "generator/target/d3d9/generate/loop_plan.h"

#include "generator/passes/rewrite.h"

namespace intaglio::d3d9 {
namespace {

template <typename Visit>
void for_each_loop(const ir::Module& module, Visit&& visit) {
    passes::for_each_instruction(module.body, [&](const ir::Instruction& instruction) {
        if (instruction.op == ir::Op::Loop) visit(instruction);
    });
}

}  // namespace

std::vector<LoopPlan> loop_plans(const ir::Module& pixel, Profile profile) {
    bool can_stay = false, can_go = false;
    for_each_loop(pixel, [&](const ir::Instruction& loop) {
        can_stay = can_stay || loop.loop.form != ir::LoopForm::Unrolled;
        can_go = can_go || loop.loop.form != ir::LoopForm::Rolled;
    });
    const bool has_rep = profile == Profile::ps_3_0;
    if (!can_stay && !can_go) return {LoopPlan{}};
    std::vector<LoopPlan> plans;
    if (has_rep && can_stay) plans.push_back({true, passes::FirstHitForm::Chain});
    if (!has_rep || can_go) {
        plans.push_back({false, passes::FirstHitForm::PackedRefetch});
        plans.push_back({false, passes::FirstHitForm::Chain});
    }
    return plans;
}

std::set<std::string> apply(const LoopPlan& plan, ir::Module& pixel, Profile profile) {
    std::set<std::string> rolled;
    passes::for_each_instruction(pixel.body, [&](ir::Instruction& instruction) {
        if (instruction.op != ir::Op::Loop) return;
        ir::LoopInfo& loop = instruction.loop;
        const bool stays = loop.form == ir::LoopForm::Rolled ||
                           (loop.form == ir::LoopForm::Unspecified && plan.rolled);
        const bool rolls = stays && profile == Profile::ps_3_0;
        loop.form = rolls ? ir::LoopForm::Rolled : ir::LoopForm::Unspecified;
        if (rolls) rolled.insert(loop.name);
    });
    return rolled;
}

bool cut_others(ir::Module& pixel, int most_trips) {
    bool any = false;
    passes::for_each_instruction(pixel.body, [&](ir::Instruction& instruction) {
        if (instruction.op != ir::Op::Loop || instruction.loop.form == ir::LoopForm::Rolled ||
            instruction.loop.trip_count <= most_trips)
            return;
        instruction.loop.trip_count = most_trips;
        any = true;
    });
    return any;
}

void unroll_others(ir::Module& pixel) {
    passes::for_each_instruction(pixel.body, [&](ir::Instruction& instruction) {
        if (instruction.op == ir::Op::Loop && instruction.loop.form != ir::LoopForm::Rolled)
            instruction.loop.form = ir::LoopForm::Unrolled;
    });
}

bool has_loops(const ir::Module& module) {
    bool found = false;
    for_each_loop(module, [&](const ir::Instruction&) { found = true; });
    return found;
}

}  // namespace intaglio::d3d9
