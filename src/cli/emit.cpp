// `intaglio emit` and `intaglio validate`.
#include <cstdio>

#include <fmt/format.h>

#include "generator/base/nearest.h"
#include "generator/ir/print.h"
#include "src/cli/commands.h"

namespace intaglio::cli {
namespace {

Status one_of(std::string_view option, const std::string& value,
              const std::vector<std::string>& choices) {
    for (const std::string& choice : choices)
        if (choice == value) return Done{};
    return input_error("option-value",
                       unknown_name_sentence(fmt::format("value of {}", option), value, choices));
}

Status check_choices(const EmitCommandOptions& options) {
    for (const Status& status : {one_of("--stage", options.stage, {"vertex", "pixel"}),
                                 one_of("--as", options.as, {"shader", "function"}),
                                 one_of("--part", options.part, {"search", "shadow"}),
                                 one_of("--bind", options.bind, {"parameters", "globals"})})
        if (!status) return status;
    return Done{};
}

// Prints what --dump-ir asks for as the passes run.
EmitOptions dump_options(const std::string& wanted, std::string& last) {
    if (wanted.empty()) return {};
    return {[wanted, &last](std::string_view stage_and_pass, const ir::Module& module) {
        const std::string text = fmt::format("// {}\n{}\n", stage_and_pass, ir::print(module));
        const std::string_view pass = stage_and_pass.substr(stage_and_pass.rfind(' ') + 1);
        if (wanted == "all" || wanted == pass) fmt::print(stderr, "{}", text);
        last = text;
    }};
}

}  // namespace

Status emit_variant(const dsl::Catalogue& catalogue, const EmitCommandOptions& options) {
    if (Status status = check_choices(options); !status) return status;
    Result<VariantRequest> request = request_of(options.variant);
    if (!request) return request.error();
    request->count_reads = options.count_reads;
    std::string last_ir;
    const EmitOptions dump = dump_options(options.dump_ir, last_ir);

    Product product;
    if (options.as == "function") {
        const dsl::FunctionPart part =
            options.part == "search" ? dsl::FunctionPart::Search : dsl::FunctionPart::Shadow;
        const Binding binding =
            options.bind == "parameters" ? Binding::Parameters : Binding::Globals;
        Result<Artifact> function = make_function(catalogue, *request, part, binding, dump);
        if (!function) return function.error();
        product = {std::move(function->text), function->extension, false};
    } else {
        const Result<Variant> variant = make_variant(catalogue, *request, dump);
        if (!variant) return variant.error();
        const ir::Stage stage = options.stage == "vertex" ? ir::Stage::Vertex : ir::Stage::Pixel;
        Result<Product> made = product_of(*variant, stage);
        if (!made) return made.error();
        product = std::move(*made);
        const Artifact& artifact = stage == ir::Stage::Vertex ? variant->vertex : variant->pixel;
        for (const std::string& note : artifact.notes) fmt::print(stderr, "note: {}\n", note);
    }
    if (options.dump_ir == "final") fmt::print(stderr, "{}", last_ir);
    return write_product(options.output, product.bytes, product.binary);
}

Status validate(const dsl::Catalogue& catalogue, const ValidateOptions& options) {
    std::vector<std::string> targets = options.targets;
    if (targets.empty())
        for (const Target* target : all_targets())
            if (language_of(*target)) targets.emplace_back(target->name);
    for (const std::string& surface : options.surfaces)
        for (const std::string& target : targets) {
            const Result<VariantRequest> request =
                request_of({surface, target, options.knobs, options.loops, false});
            if (!request) return request.error();
            const Result<Variant> variant = make_variant(catalogue, *request);
            if (!variant && options.targets.empty() && variant.error().code == "target-limit") {
                fmt::print("{:<46} {:<10} refused: {}\n", surface, target, variant.error().message);
                continue;
            }
            if (!variant) return variant.error();
            const Result<Judged> judged = judge_variant(*variant);
            if (!judged) return judged.error();
            const check::SpirvCost& cost = judged->pixel_cost;
            fmt::print("{:<46} {:<10} accepted by {} steps; ", surface, target,
                       judged->steps.size());
            if (check::has_spirv(*language_of(*variant->target)))
                fmt::print(
                    "{} SPIR-V instructions ({} alu, {} texture, {} branch), path {} to {}\n",
                    cost.total, cost.alu, cost.texture, cost.branch, cost.shortest_path,
                    cost.longest_path);
            else
                fmt::print("no SPIR-V of this language to count\n");
            if (options.verbose)
                for (const std::string& step : judged->steps) fmt::print("    {}\n", step);
        }
    return Done{};
}

}  // namespace intaglio::cli
