// What becomes of a pixel stage's loops, and which of several ways is the better one.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "generator/ir/module.h"
#include "generator/passes/lower_first_hit.h"
#include "generator/target/d3d9/shader.h"

namespace intaglio::d3d9 {

struct LoopPlan {
    bool rolled = false;  // loops whose schedule says nothing stay loops
    passes::FirstHitForm form = passes::FirstHitForm::Chain;  // of searches that do not
};

// The plans that are tried.  Profiles without loops unroll all of them, whatever the schedule says
// (a target refuses such a schedule before).  ps_3_0 obeys the schedule: a loop that is to stay one
// does, one that is to be unrolled is, and where the schedule leaves the choice, it is made by
// cost: of the shaders that fit, Candidate's better() takes the fewest slots of the text, of which
// ps_3_0 has 512 for sure.
std::vector<LoopPlan> loop_plans(const ir::Module& pixel, Profile profile);

// Marks the loops that stay and answers their names; the others are as if the schedule said
// nothing, so that searches among them may be lowered.
std::set<std::string> apply(const LoopPlan& plan, ir::Module& pixel, Profile profile);
// Cuts those that do not stay to so many iterations; whether there was one to cut.
bool cut_others(ir::Module& pixel, int most_trips);
// Then: all that do not stay are to be unrolled.
void unroll_others(ir::Module& pixel);

// Whether any loop is left.
bool has_loops(const ir::Module& module);

}  // namespace intaglio::d3d9
