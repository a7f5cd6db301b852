// From a request to artifacts.
#include "src/variant/variant.h"

#include <algorithm>

#include <fmt/format.h>

#include "generator/base/nearest.h"
#include "src/check/derive.h"
#include "src/check/spirv.h"
#include "src/variant/bytecode.h"

namespace intaglio {
namespace {

Result<const Target*> target_of(const VariantRequest& request) {
    if (const Target* target = find_target(request.target)) return target;
    std::vector<std::string> names;
    for (const Target* target : all_targets()) names.emplace_back(target->name);
    return input_error("unknown-target", unknown_name_sentence("target", request.target, names));
}

// The target whose text we print for this one.
const Target& text_target(const Target& target) {
    return target.derived_from.empty() ? target : *find_target(target.derived_from);
}

Result<dsl::Surface> surface_of(const dsl::Catalogue& catalogue, const VariantRequest& request) {
    Result<dsl::Surface> surface = dsl::make_surface(catalogue, request.surface);
    if (!surface) return surface;
    for (const auto& [name, value] : request.knobs)
        if (Status status = surface->set_knob(name, value); !status) return status.error();
    return surface;
}

dsl::RecordOptions record_options(const VariantRequest& request) {
    return {request.target, request.loop_forms, request.per_vertex};
}

Result<ir::Program> record_program(const dsl::Surface& surface, const VariantRequest& request) {
    const int passes = dsl::pass_count(request.split);
    if (passes == 1 && request.pass == 0)
        return dsl::record_surface(surface, record_options(request));
    return dsl::record_pass(surface, record_options(request), request.split, request.pass);
}

// A loop that a person wants kept is kept or refused; a technique's own schedule says what is best
// where there are loops.
Status check_loops(const VariantRequest& request, const Target& target) {
    if (target.capabilities.loops) return Done{};
    for (const auto& [name, form] : request.loop_forms)
        if (form == ir::LoopForm::Rolled)
            return input_error(
                "target-limit",
                fmt::format("the loop {} cannot stay a loop: {} has none", name, target.name));
    return Done{};
}

// Of what is known, what this program has names for; an error where nothing of the surface has.
// Its passes have other names each, and where the shading is left out its names are.
Result<passes::Known> known_here(const dsl::Catalogue& catalogue, const dsl::Surface& surface,
                                 const VariantRequest& request, const ir::Program& program) {
    const passes::Known here = passes::part_of(request.known, program);
    if (here == request.known) return here;
    Result<std::vector<ir::Program>> others = std::vector<ir::Program>{};
    if (dsl::pass_count(request.split) > 1) {
        others = dsl::record_passes(surface, record_options(request), request.split);
        if (!others) return others.error();
    } else if (!surface.output->shaded()) {
        VariantRequest shaded = request;
        shaded.surface = dsl::with_part(request.surface, "output", "colour");
        const Result<dsl::Surface> whole = surface_of(catalogue, shaded);
        if (!whole) return whole.error();
        Result<ir::Program> recorded = record_program(*whole, shaded);
        if (!recorded) return recorded.error();
        others->push_back(std::move(*recorded));
    }
    passes::Known unknown = request.known;
    others->push_back(program);
    for (const ir::Program& other : *others) {
        const passes::Known part = passes::part_of(request.known, other);
        for (const auto& one : part.uniforms) unknown.uniforms.erase(one.first);
        for (const auto& one : part.ranges) unknown.ranges.erase(one.first);
    }
    // The sentence that says so names what this program has.
    return unknown.empty() ? here : request.known;
}

int longest_loop_in(const ir::Region& region) {
    int most = 1;
    for (const ir::Instruction& instruction : region.body) {
        if (instruction.op == ir::Op::Loop) most = std::max(most, instruction.loop.trip_count);
        for (const ir::Region& inner : instruction.regions)
            most = std::max(most, longest_loop_in(inner));
    }
    return most;
}

std::string bytes_of(const check::SpirvWords& words) {
    return {reinterpret_cast<const char*>(words.data()), words.size() * sizeof(words[0])};
}

}  // namespace

Result<Recorded> record_variant(const dsl::Catalogue& catalogue, const VariantRequest& request) {
    const Result<const Target*> target = target_of(request);
    if (!target) return target.error();
    if (Status status = check_loops(request, **target); !status) return status.error();
    const Result<dsl::Surface> surface = surface_of(catalogue, request);
    if (!surface) return surface.error();
    Result<ir::Program> program = record_program(*surface, request);
    if (!program) return program.error();
    const Result<passes::Known> known = known_here(catalogue, *surface, request, *program);
    if (!known) return known.error();
    Result<Notes> left_out = passes::assume(*program, *known);
    if (!left_out) return left_out.error();
    return Recorded{*target, std::move(*program), std::move(*left_out)};
}

Result<Variant> make_variant(const dsl::Catalogue& catalogue, const VariantRequest& request,
                             const EmitOptions& options) {
    Result<Recorded> recorded = record_variant(catalogue, request);
    if (!recorded) return recorded.error();
    EmitOptions emit_options = options;
    emit_options.count_reads = request.count_reads;
    Result<Emitted> emitted = emit(recorded->program, text_target(*recorded->target), emit_options);
    if (!emitted) return emitted.error();
    return Variant{request, recorded->target, std::move(recorded->program),
                   std::move(emitted->vertex), std::move(emitted->pixel)};
}

Result<Product> product_of(const Variant& variant, ir::Stage stage, Form form) {
    const Artifact& artifact = stage == ir::Stage::Vertex ? variant.vertex : variant.pixel;
    const std::string_view target = variant.target->name;
    if (stage == ir::Stage::Pixel && !variant.target->pixel_stage)
        return input_error(
            "no-stage",
            fmt::format("{} is a profile of vertex shaders; the pixel stage is that of {}", target,
                        target == "vs_3_0" ? "ps_3_0" : "ps_2_0, ps_2_a or ps_2_b"));
    if (form == Form::Bytecode && !artifact.bytecode.bytes.empty())
        return Product{artifact.bytecode.bytes, artifact.bytecode.extension, true};
    if (form == Form::Bytecode && target != "spirv")
        return input_error(
            "no-bytecode",
            fmt::format("{} is text; bytecode is for the targets ps_*, vs_* and spirv", target));
    if (variant.target->derived_from.empty())
        return Product{artifact.text, artifact.extension, false};
    const check::Source source = source_of(variant, stage);
    const std::string stage_extension = stage == ir::Stage::Vertex ? ".vert" : ".frag";
    if (variant.target->name == "spirv") {
        const Result<check::SpirvWords> words = check::derive_spirv(source);
        if (!words) return words.error();
        return Product{bytes_of(*words), stage_extension + ".spv", true};
    }
    Result<std::string> text = check::derive_msl(source);
    if (!text) return text.error();
    return Product{std::move(*text), stage_extension + ".metal", false};
}

Result<Artifact> make_function(const dsl::Catalogue& catalogue, const VariantRequest& request,
                               dsl::FunctionPart part, Binding binding,
                               const EmitOptions& options) {
    const Result<const Target*> target = target_of(request);
    if (!target) return target.error();
    if (Status status = check_loops(request, **target); !status) return status.error();
    const Result<dsl::Surface> surface = surface_of(catalogue, request);
    if (!surface) return surface.error();
    Result<ir::Program> program = dsl::record_function(*surface, part, record_options(request));
    if (!program) return program.error();
    const Result<Notes> left_out = passes::assume(*program, request.known);
    if (!left_out) return left_out.error();
    return emit_function(*program, **target, binding, options);
}

std::optional<check::Language> language_of(const Target& target) {
    const std::string_view name = text_target(target).name;
    // What the profiles 2_0 and 2_b can say, 3_0 can say as well.
    if (name == "hlsl_2_0" || name == "hlsl_2_b") return check::Language::Hlsl3;
    for (check::Language language :
         {check::Language::Glsl450, check::Language::Glsl330, check::Language::Glsl120,
          check::Language::Essl300, check::Language::Essl100, check::Language::Hlsl5,
          check::Language::Hlsl3})
        if (check::name_of(language) == name) return language;
    return std::nullopt;
}

check::Source source_of(const Variant& variant, ir::Stage stage) {
    const bool vertex = stage == ir::Stage::Vertex;
    const Artifact& artifact = vertex ? variant.vertex : variant.pixel;
    return {
        language_of(*variant.target).value_or(check::Language::Glsl450),
        vertex ? check::Stage::Vertex : check::Stage::Pixel, artifact.text, artifact.entry,
        fmt::format("{}.{}{}", variant.request.surface, variant.target->name, artifact.extension)};
}

std::optional<d3d9::Profile> profile_of(const Target& target) {
    return d3d9::profile_named(target.name);
}

bool is_judged(const Target& target) {
    return language_of(target).has_value() || profile_of(target).has_value();
}

namespace {

Result<check::Program> link_text(const Variant& variant) {
    const std::optional<check::Language> language = language_of(*variant.target);
    if (!language)
        return input_error("not-runnable",
                           fmt::format("target {} is a listing, not a shader that can be run",
                                       variant.target->name));
    if (!check::has_spirv(*language))
        return input_error(
            "not-runnable",
            fmt::format("target {} cannot be run here: no tool makes SPIR-V of its language",
                        variant.target->name));
    Result<check::Program> program = check::link_to_spirv(source_of(variant, ir::Stage::Vertex),
                                                          source_of(variant, ir::Stage::Pixel));
    if (!program || variant.target->name != "spirv") return program;
    for (check::SpirvWords* words : {&program->vertex, &program->pixel}) {
        Result<check::SpirvWords> optimized = check::optimize_spirv(*words);
        if (!optimized) return optimized.error();
        *words = std::move(*optimized);
    }
    return program;
}

// Textures of which the surface itself says the level.
std::set<std::string> read_by_level(const ir::Module& module, const ir::Region& region) {
    std::set<std::string> names;
    for (const ir::Instruction& instruction : region.body) {
        if (instruction.op == ir::Op::SampleLevel)
            names.insert(module.samplers[static_cast<std::size_t>(instruction.slot)].name);
        for (const ir::Region& inner : instruction.regions)
            names.merge(read_by_level(module, inner));
    }
    return names;
}

}  // namespace

TextureReading reading_of(const Variant& variant) {
    TextureReading reading;
    if (!variant.target->capabilities.texture_levels)
        reading.one_level = read_by_level(variant.program.pixel, variant.program.pixel.body);
    for (const ir::Module* module : {&variant.program.vertex, &variant.program.pixel})
        for (const ir::Sampler& sampler : module->samplers) {
            if (sampler.filter == ir::Sampler::Filter::Nearest)
                reading.nearest.insert(sampler.name);
            if (!sampler.baked.empty()) reading.baked[sampler.name] = sampler.baked;
        }
    return reading;
}

Result<check::Program> link_variant(const Variant& variant) {
    Result<check::Program> program =
        profile_of(*variant.target) ? link_bytecode(variant) : link_text(variant);
    if (!program) return program;
    TextureReading reading = reading_of(variant);
    program->one_level = std::move(reading.one_level);
    program->nearest = std::move(reading.nearest);
    program->baked = std::move(reading.baked);
    return program;
}

Result<Judged> judge_variant(const Variant& variant) {
    if (profile_of(*variant.target)) return judge_bytecode(variant);
    const std::optional<check::Language> language = language_of(*variant.target);
    if (!language)
        return input_error("no-witness",
                           fmt::format("no witness reads target {}", variant.target->name));
    Judged judged;
    for (ir::Stage stage : {ir::Stage::Vertex, ir::Stage::Pixel}) {
        const Result<check::Witnessed> witnessed = check::judge(source_of(variant, stage));
        if (!witnessed) return witnessed.error();
        const std::string_view stage_name = stage == ir::Stage::Vertex ? "vertex" : "pixel";
        for (const std::string& step : witnessed->steps)
            judged.steps.push_back(fmt::format("{}: {}", stage_name, step));
        if (stage == ir::Stage::Pixel && check::has_spirv(*language)) {
            const Result<check::SpirvCost> cost =
                check::count_spirv(witnessed->optimized, longest_loop(variant.program));
            if (!cost) return cost.error();
            judged.pixel_cost = *cost;
        }
        if (!variant.target->derived_from.empty()) {
            const Result<Product> product = product_of(variant, stage);
            if (!product) return product.error();
            judged.steps.push_back(fmt::format("{}: {} derived", stage_name, variant.target->name));
        }
    }
    if (!check::has_spirv(*language)) return judged;
    const Result<check::Program> linked = link_variant(variant);
    if (!linked) return linked.error();
    judged.steps.push_back("both: stages fit each other");
    return judged;
}

int longest_loop(const ir::Program& program) { return longest_loop_in(program.pixel.body); }

}  // namespace intaglio
