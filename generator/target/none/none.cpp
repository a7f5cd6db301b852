// Prints the optimised IR itself.  A target of one's own starts as a copy of this folder: give it a
// name, list in `legalize` the passes that remove what its language cannot say, print what is left,
// and add it to all_targets.cpp.
#include "generator/target/none/none.h"

#include "generator/ir/print.h"
#include "generator/target/limits.h"

namespace intaglio {
namespace {

constexpr LegalizingPass legalizing[] = {check_limits_pass};

Result<Artifact> print_stage(const ir::Program& program, ir::Stage stage) {
    const ir::Module& module = stage == ir::Stage::Vertex ? program.vertex : program.pixel;
    return Artifact{ir::print(module),
                    module.name,
                    stage,
                    stage == ir::Stage::Vertex ? ".vert.ir" : ".frag.ir",
                    {}};
}

}  // namespace

const Target none = {
    .name = "none",
    .description = "the intermediate representation after the passes; the skeleton of a target",
    .derived_from = {},
    .capabilities = {.functions = false},
    .legalize = legalizing,
    .print = print_stage,
};

}  // namespace intaglio
