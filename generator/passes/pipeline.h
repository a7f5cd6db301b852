// The passes in the order in which they run.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "generator/base/result.h"
#include "generator/ir/module.h"
#include "generator/passes/hoist_to_vertex.h"

namespace intaglio::passes {

struct PipelineOptions {
    bool unroll_all = false;   // every loop, not only those scheduled so: the target has no loops
    bool flatten_all = false;  // every if: the target has no branches
    // After every pass; a broken module is an internal error that names the pass.
    bool verify_each = false;
    InterpolantLimits interpolants = {};
    std::function<void(std::string_view pass, const ir::Module&)> after_each = {};  // may be empty
};

// Makes the module small and quick, and obeys its schedule.  The same module always gives the same
// result, and optimizing that again changes nothing.  Returns what a person should know: one
// sentence for each rewrite that needed consent. to unroll a loop with an early exit into
Result<std::vector<std::string>> optimize(ir::Module& module, const PipelineOptions& options);

// Both stages, and what moves between them.
Result<std::vector<std::string>> optimize_program(ir::Program& program,
                                                  const PipelineOptions& options);

}  // namespace intaglio::passes
