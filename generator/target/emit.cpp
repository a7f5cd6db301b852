// From a recorded program to artifacts: verify, optimise, legalise, print; or verify and generate.
#include <algorithm>

#include <fmt/format.h>

#include "generator/ir/verify.h"
#include "generator/passes/count_texture_reads.h"
#include "generator/passes/pipeline.h"
#include "generator/target/limits.h"
#include "generator/target/target.h"

namespace intaglio {
namespace {

std::string_view stage_word(ir::Stage stage) {
    constexpr std::string_view words[] = {"vertex", "pixel", "function"};
    return words[static_cast<std::size_t>(stage)];
}

passes::PipelineOptions pipeline_options(const Target& target, const EmitOptions& options) {
    passes::PipelineOptions pipeline;
    pipeline.unroll_all = !target.capabilities.loops;
    pipeline.flatten_all = !target.capabilities.branches;
    pipeline.interpolants = target.capabilities.interpolants;
    if (options.after_each_pass)
        pipeline.after_each = [&options](std::string_view pass, const ir::Module& module) {
            options.after_each_pass(fmt::format("{}: {}", stage_word(module.stage), pass), module);
        };
    return pipeline;
}

Status legalize(ir::Module& module, const Target& target, const EmitOptions& options,
                Notes& notes) {
    for (const LegalizingPass& pass : target.legalize) {
        if (Status status = pass.run(module, target, notes); !status) return status;
        if (options.after_each_pass)
            options.after_each_pass(fmt::format("{}: {}", stage_word(module.stage), pass.name),
                                    module);
    }
    return Done{};
}

// Whether any loop ran longer.
bool shorten_loops(ir::Region& region, int trips) {
    bool any = false;
    for (ir::Instruction& instruction : region.body) {
        if (instruction.op == ir::Op::Loop && instruction.loop.trip_count > trips) {
            instruction.loop.trip_count = trips;
            any = true;
        }
        for (ir::Region& inner : instruction.regions) any |= shorten_loops(inner, trips);
    }
    return any;
}

// Thousands of iterations take many seconds to unroll, only to be refused for what the first few
// already ask for: what is over a limit then stays over it with more of them.
Status refuse_early(const ir::Program& program, const Target& target) {
    const int most_reads = target.capabilities.texture_reads;
    if (target.capabilities.loops || most_reads == 0) return Done{};
    for (int trips : {std::min(64, most_reads + 1), most_reads + 1}) {
        ir::Program few = program;
        if (!shorten_loops(few.pixel.body, trips)) return Done{};
        Result<Notes> notes = passes::optimize_program(few, pipeline_options(target, {}));
        if (!notes) return notes.error();
        if (Status status = legalize(few.pixel, target, {}, *notes); !status) return status;
    }
    return Done{};
}

Diagnostic derived(const Target& target) {
    return input_error("target-derived",
                       fmt::format("{} is not printed but made from the text of {}", target.name,
                                   target.derived_from));
}

}  // namespace

Result<Emitted> emit(const ir::Program& program, const Target& target, const EmitOptions& options) {
    if (!target.derived_from.empty()) return derived(target);
    for (const ir::Module* module : {&program.vertex, &program.pixel})
        if (Status status = ir::verify(*module); !status) return status.error();
    if (target.generate != nullptr) {
        if (target.pixel_stage)
            if (Status status = check_outputs(program.pixel, target); !status)
                return status.error();
        return target.generate(program, target, options);
    }
    if (Status status = check_levels(program.pixel, target); !status) return status.error();
    if (Status status = refuse_early(program, target); !status) return status.error();
    ir::Program legal = program;
    if (options.count_reads) passes::count_texture_reads(legal.pixel);
    Result<Notes> notes = passes::optimize_program(legal, pipeline_options(target, options));
    if (!notes) return notes.error();
    for (ir::Module* module : {&legal.vertex, &legal.pixel})
        if (Status status = legalize(*module, target, options, *notes); !status)
            return status.error();
    Emitted emitted;
    for (auto [artifact, stage] : {std::pair{&emitted.vertex, ir::Stage::Vertex},
                                   std::pair{&emitted.pixel, ir::Stage::Pixel}}) {
        Result<Artifact> printed = target.print(legal, stage);
        if (!printed) return printed.error();
        *artifact = std::move(*printed);
        artifact->notes.insert(artifact->notes.begin(), notes->begin(), notes->end());
    }
    return emitted;
}

Result<Artifact> emit_function(const ir::Program& program, const Target& target, Binding binding,
                               const EmitOptions& options) {
    if (!target.capabilities.functions || !target.print_function)
        return input_error("target-function",
                           fmt::format("{} has no text to paste a function into", target.name));
    const ir::Module& function = program.pixel;
    if (Status status = ir::verify(function); !status) return status.error();
    if (function.stage != ir::Stage::Function || function.outputs.size() != 1)
        return input_error("target-function",
                           fmt::format("{} is not a function with one result", function.name));
    ir::Program legal = program;
    Result<Notes> notes = passes::optimize(legal.pixel, pipeline_options(target, options));
    if (!notes) return notes.error();
    if (Status status = legalize(legal.pixel, target, options, *notes); !status)
        return status.error();
    Result<Artifact> artifact = target.print_function(legal, binding);
    if (artifact) artifact->notes.insert(artifact->notes.begin(), notes->begin(), notes->end());
    return artifact;
}

}  // namespace intaglio
