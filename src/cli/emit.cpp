// `intaglio emit` and `intaglio validate`.
#include <cstdio>
#include <filesystem>

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
    const std::string stage = options.stage.empty() ? "pixel" : options.stage;
    for (const Status& status : {one_of("--stage", stage, {"vertex", "pixel"}),
                                 one_of("--as", options.as, {"shader", "function", "bytecode"}),
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

// The product of one pass, or of a surface that is not split; notes and dumps go to stderr.
Result<Product> make_product(const dsl::Catalogue& catalogue, const EmitCommandOptions& options,
                             const VariantRequest& request) {
    std::string last_ir;
    const EmitOptions dump = dump_options(options.dump_ir, last_ir);

    Product product;
    if (options.as == "function") {
        const dsl::FunctionPart part =
            options.part == "search" ? dsl::FunctionPart::Search : dsl::FunctionPart::Shadow;
        const Binding binding =
            options.bind == "parameters" ? Binding::Parameters : Binding::Globals;
        Result<Artifact> function = make_function(catalogue, request, part, binding, dump);
        if (!function) return function.error();
        product = {std::move(function->text), function->extension, false};
    } else {
        const Result<Variant> variant = make_variant(catalogue, request, dump);
        if (!variant) return variant.error();
        const bool vertex =
            options.stage.empty() ? !variant->target->pixel_stage : options.stage == "vertex";
        const ir::Stage stage = vertex ? ir::Stage::Vertex : ir::Stage::Pixel;
        Result<Product> made =
            product_of(*variant, stage, options.as == "bytecode" ? Form::Bytecode : Form::Shader);
        if (!made) return made.error();
        product = std::move(*made);
        const Artifact& artifact = stage == ir::Stage::Vertex ? variant->vertex : variant->pixel;
        for (const std::string& note : artifact.notes) fmt::print(stderr, "note: {}\n", note);
    }
    if (options.dump_ir == "final") fmt::print(stderr, "{}", last_ir);
    return product;
}

// relief.asm to relief.pass2.asm.
std::string file_of_pass(const std::string& output, int pass) {
    const std::filesystem::path path = output;
    std::filesystem::path name = path.stem();
    name += fmt::format(".pass{}", pass);
    name += path.extension();
    return (path.parent_path() / name).string();
}

// Every pass of a split into a file of its own; none where one is refused.
Status emit_passes(const dsl::Catalogue& catalogue, const EmitCommandOptions& options,
                   VariantRequest request) {
    const int passes = dsl::pass_count(request.split);
    if (options.output == "-") {
        std::string works;
        for (int pass = 1; pass <= passes; ++pass)
            works += fmt::format("{}{}: {}", pass == 1 ? "" : "; ", pass,
                                 dsl::pass_work(request.split, pass));
        return input_error("split-pass",
                           fmt::format("this split has {} passes ({}); name one with --pass, or "
                                       "give a file with -o for one file each",
                                       passes, works));
    }
    std::vector<Product> products;
    for (request.pass = 1; request.pass <= passes; ++request.pass) {
        Result<Product> product = make_product(catalogue, options, request);
        if (!product) return product.error();
        products.push_back(std::move(*product));
    }
    for (int pass = 1; pass <= passes; ++pass) {
        const Product& product = products[static_cast<std::size_t>(pass - 1)];
        const std::string file = file_of_pass(options.output, pass);
        if (Status status = write_product(file, product.bytes, product.binary); !status)
            return status;
        fmt::print(stderr, "{}: {}\n", file, dsl::pass_work(request.split, pass));
    }
    return Done{};
}

}  // namespace

Status emit_variant(const dsl::Catalogue& catalogue, const EmitCommandOptions& options) {
    if (Status status = check_choices(options); !status) return status;
    Result<VariantRequest> request = request_of(options.variant);
    if (!request) return request.error();
    request->count_reads = options.count_reads;
    if (dsl::pass_count(request->split) > 1 && options.as == "function")
        return input_error("option-value", "--split is of whole shaders, not of --as function");
    if (dsl::pass_count(request->split) > 1 && request->pass == 0)
        return emit_passes(catalogue, options, *request);
    const Result<Product> product = make_product(catalogue, options, *request);
    if (!product) return product.error();
    return write_product(options.output, product->bytes, product->binary);
}

std::string cost_text(const Target& target, const Judged& judged) {
    if (!judged.shaders.empty()) {
        std::string text;
        for (const d3d9::Shader& shader : judged.shaders) {
            const d3d9::Resources used = d3d9::count(shader);
            text += fmt::format("{}{}: {} arithmetic and {} texture slots, {} temps, {} constants",
                                text.empty() ? "" : "; ", name_of(shader.profile), used.arithmetic,
                                used.texture, used.temps, used.constants);
            if (is_pixel(shader.profile))
                text += fmt::format(", dependent level {}", used.dependent_level);
        }
        return text;
    }
    if (!check::has_spirv(*language_of(target))) return "no SPIR-V of this language to count";
    const check::SpirvCost& cost = judged.pixel_cost;
    return fmt::format("{} SPIR-V instructions ({} alu, {} texture, {} branch), path {} to {}",
                       cost.total, cost.alu, cost.texture, cost.branch, cost.shortest_path,
                       cost.longest_path);
}

namespace {

// One surface on one target.  What a target refuses is a line of the table, unless it was asked
// for.
Status validate_one(const dsl::Catalogue& catalogue, const ValidateOptions& options,
                    const std::string& surface, const std::string& target) {
    VariantOptions one;
    one.surface = surface;
    one.target = target;
    one.knobs = options.knobs;
    one.loops = options.loops;
    one.known = options.known;
    const Result<VariantRequest> request = request_of(one);
    if (!request) return request.error();
    const Result<Variant> variant = make_variant(catalogue, *request);
    if (!variant && options.targets.empty() && is_refusal(variant.error())) {
        fmt::print("{:<46} {:<10} refused: {}\n", surface, target, variant.error().message);
        return Done{};
    }
    if (!variant) return variant.error();
    const Result<Judged> judged = judge_variant(*variant);
    if (!judged) return judged.error();
    fmt::print("{:<46} {:<10} accepted by {} steps; {}\n", surface, target, judged->steps.size(),
               cost_text(*variant->target, *judged));
    if (options.verbose)
        for (const std::string& step : judged->steps) fmt::print("    {}\n", step);
    return Done{};
}

}  // namespace

Status validate(const dsl::Catalogue& catalogue, const ValidateOptions& options) {
    std::vector<std::string> targets = options.targets;
    if (targets.empty())
        for (const Target* target : all_targets())
            if (is_judged(*target)) targets.emplace_back(target->name);
    for (const std::string& surface : options.surfaces)
        for (const std::string& target : targets)
            if (Status status = validate_one(catalogue, options, surface, target); !status)
                return status;
    return Done{};
}

}  // namespace intaglio::cli
