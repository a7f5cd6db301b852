// Variants to numbers, on the CPU.
#include "src/plan/trial.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include <fmt/format.h>

#include "generator/ir/ops.h"
#include "generator/passes/pipeline.h"
#include "src/check/spirv.h"
#include "src/measure/evaluated.h"
#include "src/measure/hits_request.h"
#include "src/measure/interpreted.h"
#include "src/measure/named_metric.h"

namespace intaglio::plan {
namespace {

using measure::EvaluatedPicture;
using measure::EvaluatedQuad;
using measure::hits_request;
using measure::InterpretedPicture;
using measure::InterpretedQuad;

void worst(std::map<std::string, double>& into, const std::string& metric, double value) {
    const auto [place, is_new] = into.try_emplace(metric, value);
    if (!is_new) place->second = std::max(place->second, value);
}

void add_hits(Trial& trial, const measure::HitStatistics& hits, const std::string& suffix) {
    const auto percent = [&](std::int64_t part) {
        return 100.0 * static_cast<double>(part) / static_cast<double>(hits.pixels);
    };
    if (hits.pixels > hits.invalid) {
        worst(trial.errors, "p95" + suffix, hits.p95);
        worst(trial.errors, "missed" + suffix, percent(hits.missed));
    }
    if (!suffix.empty()) return;
    trial.errors["invalid"] += static_cast<double>(hits.invalid);
    if (hits.pixels <= hits.invalid) return;
    worst(trial.errors, "median", hits.median);
    worst(trial.errors, "p99", hits.p99);
    worst(trial.errors, "height", hits.height_max);
    worst(trial.errors, "shadow_wrong", percent(hits.shadow_wrong));
}

// What one iteration holds counts as often as the loop may run.
struct Size {
    double operations = 0, reads = 0;
};
void add_size(Size& size, const ir::Region& region, double times) {
    for (const ir::Instruction& instruction : region.body) {
        const bool leaf = ir::info(instruction.op).type_rule == ir::TypeRule::Leaf;
        if (ir::is_sample(instruction.op))
            size.reads += times;
        else if (!leaf && !ir::is_terminator(instruction.op))
            size.operations += times;
        const double inside = instruction.op == ir::Op::Loop ? instruction.loop.trip_count : 1;
        for (const ir::Region& inner : instruction.regions) add_size(size, inner, times * inside);
    }
}

void set_loops(ir::Region& region, ir::LoopForm form) {
    for (ir::Instruction& instruction : region.body) {
        if (instruction.op == ir::Op::Loop) instruction.loop.form = form;
        for (ir::Region& inner : instruction.regions) set_loops(inner, form);
    }
}

// The error as a trial if it is the target's refusal.
Result<Trial> refused(const Diagnostic& error) {
    if (!is_refusal(error)) return error;
    Trial trial;
    trial.refusal = error.message;
    trial.refusal_code = error.code;
    return trial;
}

}  // namespace

struct Site::State {
    State(const dsl::Catalogue& all, const scene::SceneSurface& of)
        : catalogue(all),
          surface(of),
          textures(of.map.set, measure::Filtering::Float),
          field(of.map.set.height_field(reference::FilterWeights::Exact)) {}

    const dsl::Catalogue& catalogue;
    const scene::SceneSurface& surface;
    measure::Textures textures;
    reference::HeightField field;
    measure::Look look;
    mutable measure::SharedCache<measure::ExactPicture> exact{64};
    mutable std::mutex mutex;
    mutable std::map<std::string, double> baked;  // texels of a sampler's map, for one of heights

    std::shared_ptr<const measure::ExactPicture> exact_of(const Shot& shot, int side) const {
        const std::string key =
            fmt::format("{} {} {} {} {}", side, shot.view.elevation, shot.view.azimuth,
                        shot.towards.elevation, shot.towards.azimuth);
        return exact.get(key, [&] {
            return measure::trace_exact(field, shot.view, shot.towards,
                                        static_cast<float>(surface.scale), side, side, 1);
        });
    }
    void compare(Trial& trial, const vulkan::Picture& picture, const Shot& shot,
                 const std::string& suffix) const {
        const auto right = exact_of(shot, picture.width);
        const auto errors = measure::compare_hits(picture, *right, field, shot.view,
                                                  static_cast<float>(surface.scale), 1);
        add_hits(trial, measure::summarize(errors, picture.width), suffix);
    }
    bool wants(std::string_view suffix) const {
        const auto ends = [&](const auto& limit) { return limit.first.ends_with(suffix); };
        return std::any_of(surface.targets.begin(), surface.targets.end(),
                           [&](const std::string& target) {
                               const scene::Tolerance there = surface.tolerance_on(target);
                               return std::any_of(there.begin(), there.end(), ends);
                           });
    }

    Result<Trial> errors_of_bytecode(const VariantRequest& request, const Rays& rays) const;
    Result<Trial> errors_of_ir(const VariantRequest& request, const Rays& rays) const;
    Result<Trial> cost_of_ir(const VariantRequest& request, const Rays& rays) const;
    Result<Trial> size_of(const VariantRequest& request) const;
    Result<Trial> fit_of(const VariantRequest& request, const Rays& rays) const;
    void dearest(Trial& trial, double operations, double reads) const;
};

Site::Site(const dsl::Catalogue& catalogue, const scene::SceneSurface& surface)
    : state_(std::make_unique<State>(catalogue, surface)) {}
Site::~Site() = default;

const reference::HeightField& Site::field() const { return state_->field; }

void Site::aim(std::size_t number, measure::Direction towards) {
    state_->look.further.at(number - 1).direction = towards;
}

std::string Site::identity() const {
    std::string text = fmt::format("{} {} {} {}", state_->surface.map.hash, state_->surface.scale,
                                   state_->wants("_fp24"), state_->wants("_fp16"));
    for (const measure::FurtherLight& light : state_->look.further)
        text += fmt::format(" {} {}", light.direction.elevation, light.direction.azimuth);
    return text;
}

Result<Trial> Site::State::errors_of_bytecode(const VariantRequest& request,
                                              const Rays& rays) const {
    const Result<Variant> variant = make_variant(catalogue, hits_request(catalogue, request));
    if (!variant) return refused(variant.error());
    const Result<InterpretedQuad> quad =
        InterpretedQuad::prepare(*variant, textures, surface.scale, rays.size, rays.size, look);
    if (!quad) return quad.error();
    struct Unit {
        std::string suffix;
        d3d9::Arithmetic arithmetic;
        InterpretedQuad quad;
    };
    std::vector<Unit> units = {{"", d3d9::Arithmetic::Fp32, *quad}};
    if (wants("_fp24")) units.push_back({"_fp24", d3d9::Arithmetic::Fp24, *quad});
    if (wants("_fp16")) {
        Result<InterpretedQuad> half = quad->with_partial_precision();
        if (!half) return half.error();
        units.push_back({"_fp16", d3d9::Arithmetic::Fp16Partial, std::move(*half)});
    }
    Trial trial;
    for (const Unit& unit : units)
        for (const Shot& shot : rays.shots) {
            const Result<InterpretedPicture> drawn =
                unit.quad.draw(shot.view, shot.towards, unit.arithmetic, 1);
            if (!drawn) return drawn.error();
            compare(trial, drawn->picture, shot, unit.suffix);
            worst(trial.costs, "reads", drawn->reads_mean);
        }
    return trial;
}

Result<Trial> Site::State::errors_of_ir(const VariantRequest& request, const Rays& rays) const {
    Result<Recorded> recorded = record_variant(catalogue, hits_request(catalogue, request));
    if (!recorded) return refused(recorded.error());
    const Variant variant{request, recorded->target, std::move(recorded->program), {}, {}};
    const Result<EvaluatedQuad> quad =
        EvaluatedQuad::prepare(variant, textures, surface.scale, rays.size, rays.size, look);
    if (!quad) return quad.error();
    Trial trial;
    for (const Shot& shot : rays.shots) {
        const EvaluatedPicture drawn = quad->draw(shot.view, shot.towards, ir::Precision::Single,
                                                  ir::Texture::Weights::Exact, 1);
        compare(trial, drawn.picture(), shot, "");
        worst(trial.costs, "reads", drawn.reads_mean);
        dearest(trial, drawn.instructions_mean - drawn.reads_mean, drawn.reads_mean);
    }
    return trial;
}

void Site::State::dearest(Trial& trial, double operations, double reads) const {
    constexpr double weight = 4;  // of a read, where two views are equally dear or nearly so
    if (operations + weight * reads < trial.cost(weight)) return;
    trial.operations = operations;
    trial.reads = reads;
}

Result<Trial> Site::State::fit_of(const VariantRequest& request, const Rays& rays) const {
    const Result<Variant> variant = make_variant(catalogue, request);
    if (!variant) return refused(variant.error());
    Result<std::map<std::string, double>> costs = static_costs(*variant);
    if (!costs) return costs.error();
    Trial trial;
    trial.costs = std::move(*costs);
    if (!profile_of(*variant->target)) return trial;
    if (!variant->target->capabilities.loops) {
        trial.operations = trial.costs["arithmetic"];
        trial.reads = trial.costs["texture"];
        return trial;
    }
    const Result<InterpretedQuad> quad =
        InterpretedQuad::prepare(*variant, textures, surface.scale, rays.size, rays.size, look);
    if (!quad) return quad.error();
    for (const Shot& shot : rays.shots) {
        const Result<InterpretedPicture> drawn =
            quad->draw(shot.view, shot.towards, d3d9::Arithmetic::Fp32, 1);
        if (!drawn) return drawn.error();
        dearest(trial, drawn->instructions_mean - drawn->reads_mean, drawn->reads_mean);
    }
    return trial;
}

Result<Trial> Site::State::cost_of_ir(const VariantRequest& request, const Rays& rays) const {
    Result<Recorded> recorded = record_variant(catalogue, request);
    if (!recorded) return refused(recorded.error());
    const bool loops = recorded->target->capabilities.loops;
    if (!loops) set_loops(recorded->program.pixel.body, ir::LoopForm::Unrolled);
    const Variant variant{request, recorded->target, std::move(recorded->program), {}, {}};
    const Result<EvaluatedQuad> quad =
        EvaluatedQuad::prepare(variant, textures, surface.scale, rays.size, rays.size, look);
    if (!quad) return quad.error();
    Trial trial;
    for (const Shot& shot : rays.shots) {
        const EvaluatedPicture drawn = quad->draw(shot.view, shot.towards, ir::Precision::Single,
                                                  ir::Texture::Weights::Exact, 1);
        dearest(trial, drawn.instructions_mean - drawn.reads_mean, drawn.reads_mean);
        // Straight code costs the same everywhere.
        if (!loops) break;
    }
    return trial;
}

Result<Trial> Site::State::size_of(const VariantRequest& request) const {
    Result<Recorded> recorded = record_variant(catalogue, request);
    if (!recorded) return refused(recorded.error());
    set_loops(recorded->program.pixel.body, ir::LoopForm::Rolled);
    const auto notes = passes::optimize_program(recorded->program, {});
    if (!notes) return notes.error();
    Size written_out;
    add_size(written_out, recorded->program.pixel.body, 1);
    Trial trial;
    trial.operations = written_out.operations;
    trial.reads = written_out.reads;
    return trial;
}

Result<Trial> Site::run(const VariantRequest& request, const Rays& rays, Ask ask) const {
    const Target* target = find_target(request.target);
    const bool bytecode = target != nullptr && profile_of(*target).has_value();
    switch (ask) {
        case Ask::Errors:
            return bytecode ? state_->errors_of_bytecode(request, rays)
                            : state_->errors_of_ir(request, rays);
        case Ask::Cost:
            // Of bytecode it comes with the emitting.
            return bytecode ? state_->fit_of(request, rays) : state_->cost_of_ir(request, rays);
        case Ask::Fit: return state_->fit_of(request, rays);
        case Ask::Size: break;
    }
    return state_->size_of(request);
}

double Site::baked_texels(const VariantRequest& request) const {
    const Result<Recorded> recorded =
        record_variant(state_->catalogue, hits_request(state_->catalogue, request));
    if (!recorded) return 0;
    double most = 0;
    for (const ir::Sampler& sampler : recorded->program.pixel.samplers) {
        const std::lock_guard lock(state_->mutex);
        const auto [place, is_new] = state_->baked.try_emplace(sampler.name, 0);
        if (is_new) {
            // Of a small map: the share is the same for all.
            constexpr int side = 8;
            const auto small = measure::make_map_set("bricks", side, side, 0.08);
            if (!small) return 0;
            measure::BakedMaps maps(*small, measure::Filtering::Float);
            const auto texture = maps.texture(sampler.name, sampler.baked);
            if (texture && *texture != nullptr)
                for (const std::vector<float>& level : (*texture)->levels)
                    place->second += static_cast<double>(level.size()) / (4 * side * side);
        }
        most = std::max(most, place->second);
    }
    return most;
}

Result<std::map<std::string, double>> static_costs(const Variant& variant) {
    std::map<std::string, double> costs;
    if (profile_of(*variant.target)) {
        const Result<d3d9::Shader> shader = decode_stage(variant, ir::Stage::Pixel);
        if (!shader) return shader.error();
        for (const auto& [metric, value] : measure::metrics_of(d3d9::count(*shader)))
            costs[std::string(metric)] = value;
        return costs;
    }
    const std::optional<check::Language> language = language_of(*variant.target);
    if (!language || !check::has_spirv(*language)) return costs;
    const Result<check::Program> linked = link_variant(variant);
    if (!linked) return linked.error();
    const Result<check::SpirvWords> optimized = check::optimize_spirv(linked->pixel);
    if (!optimized) return optimized.error();
    const Result<check::SpirvCost> cost =
        check::count_spirv(*optimized, longest_loop(variant.program));
    if (!cost) return cost.error();
    costs = {{"spirv_alu", cost->alu},
             {"spirv_texture", cost->texture},
             {"spirv_branch", cost->branch},
             {"longest_path", static_cast<double>(cost->longest_path)}};
    return costs;
}

}  // namespace intaglio::plan
