// The list one can read aloud, and its repetition until nothing changes.  A pass that found nothing
// to do is left out until another one changed the module: the same module gives the same result.
#include "generator/passes/pipeline.h"

#include <map>
#include <optional>

#include <fmt/format.h>

#include "generator/ir/verify.h"
#include "generator/passes/close_inductions.h"
#include "generator/passes/eliminate_common_subexpressions.h"
#include "generator/passes/flatten_branches.h"
#include "generator/passes/fold_constants.h"
#include "generator/passes/hoist_loop_invariants.h"
#include "generator/passes/remove_dead_code.h"
#include "generator/passes/remove_unused_interpolants.h"
#include "generator/passes/unroll_loops.h"

namespace intaglio::passes {
namespace {

using namespace ir;

// Runs passes by name, tells the listener, and stops at the first failure.  A pass returns whether
// it changed the module; one name stands for one pass with the same options.
class Run {
  public:
    Run(Module& module, const PipelineOptions& options) : module_(module), options_(options) {}

    template <typename Pass>
    void operator()(std::string_view name, Pass&& pass) {
        if (error_) return;
        const auto idle = idle_at_.find(name);
        if (idle != idle_at_.end() && idle->second == changes_) return;
        if (pass(module_))
            ++changes_;
        else
            idle_at_[name] = changes_;
        if (options_.after_each) options_.after_each(name, module_);
        if (options_.verify_each) {
            if (const Status status = verify(module_); !status)
                error_ = internal_error("pass-broke-module",
                                        fmt::format("{}: {}", name, status.error().message));
        }
    }

    const std::optional<Diagnostic>& error() const { return error_; }
    int changes() const { return changes_; }

  private:
    Module& module_;
    const PipelineOptions& options_;
    std::optional<Diagnostic> error_;
    int changes_ = 0;                          // how many passes changed the module so far
    std::map<std::string_view, int> idle_at_;  // after how many changes it last found nothing
};

void run_once(Run& run, const PipelineOptions& options, std::vector<std::string>& notes) {
    const Loops loops = options.unroll_all ? Loops::All : Loops::AsScheduled;
    run("fold_constants", fold_constants);
    run("eliminate_common_subexpressions", eliminate_common_subexpressions);
    run("hoist_loop_invariants", hoist_loop_invariants);
    run("close_inductions", [&](Module& module) {
        std::vector<std::string> closed = close_inductions(module);
        std::move(closed.begin(), closed.end(), std::back_inserter(notes));
        return !closed.empty();
    });
    // Early exits as selects, the form of the papers: branches would nest as deep as the loop is
    // long.
    run("unroll_loops",
        [&](Module& module) { return unroll_loops(module, loops, EarlyExit::Select); });
    run("fold_constants", fold_constants);
    if (options.flatten_all)
        run("flatten_branches", [](Module& module) { return flatten_branches(module); });
    run("fold_constants", fold_constants);
    run("eliminate_common_subexpressions", eliminate_common_subexpressions);
    run("remove_dead_code", remove_dead_code);
}

}  // namespace

Result<std::vector<std::string>> optimize(ir::Module& module, const PipelineOptions& options) {
    std::vector<std::string> notes;
    Run run(module, options);
    // Each round needs the one before it to have found something; real modules settle in two or
    // three.
    for (int round = 0; round < 16; ++round) {
        const int before = run.changes();
        run_once(run, options, notes);
        if (run.error()) return *run.error();
        if (run.changes() == before) break;
    }
    return notes;
}

Result<std::vector<std::string>> optimize_program(ir::Program& program,
                                                  const PipelineOptions& options) {
    auto notes = optimize(program.pixel, options);
    if (!notes) return notes;
    const auto append = [&](const std::vector<std::string>& more) {
        notes->insert(notes->end(), more.begin(), more.end());
    };
    const std::vector<std::string> hoisted = hoist_to_vertex(program, options.interpolants);
    append(hoisted);
    const bool pixel_changed = remove_unused_interpolants(program) || !hoisted.empty();
    auto more = optimize(program.vertex, options);
    if (!more) return more;
    append(*more);
    // Unchanged it is as optimizing left it.
    if (!pixel_changed) return notes;
    more = optimize(program.pixel, options);
    if (!more) return more;
    append(*more);
    return notes;
}

}  // namespace intaglio::passes
