// Alternatives are tried from the IR on: each lowering of the searches is packed and ordered, and
// the smallest pixel shader decides what the vertex shader computes for it.
#include "generator/target/d3d9/generate/generate.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "generator/passes/lower_first_hit.h"
#include "generator/passes/pipeline.h"
#include "generator/passes/rewrite.h"
#include "generator/target/d3d9/generate/candidate.h"
#include "generator/target/d3d9/generate/drop_gradients.h"
#include "generator/target/d3d9/generate/flow.h"
#include "generator/target/d3d9/generate/fold_divisions.h"
#include "generator/target/d3d9/generate/interpolants.h"
#include "generator/target/d3d9/generate/least.h"
#include "generator/target/d3d9/generate/loop_plan.h"
#include "generator/target/d3d9/generate/lower.h"
#include "generator/target/d3d9/generate/vertex.h"

namespace intaglio::d3d9 {
namespace {

// Both stages optimised, branches gone, and loops but those that the plan keeps.
Result<ir::Program> straighten(const ir::Program& program, const LoopPlan& plan, Profile profile,
                               std::vector<std::string>& notes) {
    ir::Program result = program;
    const std::set<std::string> rolled = apply(plan, result.pixel, profile);
    fold_divisions(result.pixel);
    passes::PipelineOptions options;
    if (plan.form != passes::FirstHitForm::Chain) {
        if (const auto done = passes::optimize(result.pixel, options); !done) return done.error();
        const auto choose = [&](const passes::FirstHit& hit) {
            if (rolled.count(hit.loop) != 0) return passes::FirstHitForm::Chain;
            return hit.only_whether ? passes::FirstHitForm::AnyHit : plan.form;
        };
        for (const passes::FirstHit& hit :
             passes::lower_first_hit(result.pixel, choose, passes::Rounding::Free))
            if (hit.form == passes::FirstHitForm::AnyHit)
                notes.push_back(fmt::format(
                    "The loop '{}' is only asked whether it hits and may go on where its ray has "
                    "left the relief at the top: heights must lie in [0, 1], as in "
                    "textures of 8 or 16 bits.",
                    hit.loop));
    }
    unroll_others(result.pixel);
    apply(LoopPlan{}, result.vertex, Profile::ps_2_0);
    unroll_others(result.vertex);
    options.flatten_all = true;
    options.interpolants = interpolant_limits(profile);
    auto more = passes::optimize_program(result, options);
    if (!more) return more.error();
    notes.insert(notes.end(), more->begin(), more->end());
    drop_gradients(result, profile, notes);
    return result;
}

// A pixel stage, and the program that it is of: the vertex stage must compute what was hoisted.
struct PixelStage {
    Candidate candidate;
    ir::Program program;
};

// Enough iterations to tell that unrolling more of them is too much.
constexpr int telling_trips[] = {64, 512};

// Refused by the first iterations of its long loops, where these are far too much already.
std::optional<PixelStage> refuse_early(const ir::Program& recorded, Profile profile,
                                       const LoopPlan& plan, int trips) {
    ir::Program cut = recorded;
    apply(plan, cut.pixel, profile);
    if (!cut_others(cut.pixel, trips)) return std::nullopt;
    std::vector<std::string> notes;
    auto program = straighten(cut, plan, profile, notes);
    if (!program || has_loops(program->pixel)) return std::nullopt;
    const auto graph = lower(program->pixel, profile, notes);
    if (!graph) return std::nullopt;
    const Slots least = least_slots({*graph}, profile == Profile::ps_3_0);
    if (!is_far_too_long(least, profile)) return std::nullopt;
    PixelStage result{unpacked(program->pixel, {*graph}, profile, least), std::move(*program)};
    result.candidate.iterations = trips;
    result.candidate.notes = std::move(notes);
    return result;
}

Result<PixelStage> attempt(const ir::Program& recorded, Profile profile, const LoopPlan& plan) {
    for (const int trips : telling_trips)
        if (auto early = refuse_early(recorded, profile, plan, trips)) return std::move(*early);
    std::vector<std::string> notes;
    auto program = straighten(recorded, plan, profile, notes);
    if (!program) return program.error();
    const ir::Module& module = program->pixel;
    std::optional<Candidate> best;
    if (profile == Profile::ps_3_0) {
        auto candidate = generate_flow(module, profile, notes);
        if (!candidate) return candidate.error();
        best = std::move(*candidate);
    }
    if (!has_loops(module) && !(best && best->at_least)) {
        auto graph = lower(module, profile, notes);
        if (!graph) return graph.error();
        const Slots least = least_slots({*graph}, false);
        Candidate candidate = is_far_too_long(least, profile)
                                  ? unpacked(module, {*graph}, profile, least)
                                  : best_of(module, *graph, profile);
        if (!best || better(candidate, *best)) best = std::move(candidate);
    }
    PixelStage result{std::move(*best), std::move(*program)};
    result.candidate.notes = std::move(notes);
    return result;
}

// What both need at least, where both are far too long.
std::optional<Slots> least_of(const Candidate& a, const Candidate& b) {
    if (!a.at_least || !b.at_least) return std::nullopt;
    return Slots{std::min(a.at_least->arithmetic, b.at_least->arithmetic),
                 std::min(a.at_least->texture, b.at_least->texture)};
}

// The smallest, whether it fits or not.
Result<PixelStage> smallest_pixel_stage(const ir::Program& recorded, Profile profile) {
    if (!is_pixel(profile))
        return input_error("d3d9-stage",
                           fmt::format("{} is no profile of pixel shaders; those are ps_2_0, "
                                       "ps_2_a, ps_2_b and ps_3_0",
                                       name_of(profile)));
    if (Status status = check_levels(recorded.pixel, profile); !status) return status.error();
    std::optional<PixelStage> best;
    for (const LoopPlan& plan : loop_plans(recorded.pixel, profile)) {
        auto stage = attempt(recorded, profile, plan);
        if (!stage) return stage.error();
        if (!best) {
            best = std::move(*stage);
            continue;
        }
        const std::optional<Slots> least = least_of(stage->candidate, best->candidate);
        if (better(stage->candidate, best->candidate)) best = std::move(*stage);
        if (least) best->candidate.at_least = least;
    }
    for (const ir::Sampler& sampler : recorded.pixel.samplers) {
        if (sampler.filter == ir::Sampler::Filter::Nearest)
            best->candidate.notes.push_back(
                fmt::format("{} must be sampled nearest: set its three filters to D3DTEXF_POINT.",
                            sampler.name));
        if (!sampler.baked.empty())
            best->candidate.notes.push_back(
                fmt::format("{} must be baked with {}.", sampler.name, sampler.baked));
    }
    return std::move(*best);
}

// The interpolants in registers that the pixel shader declares.
std::vector<Interpolant> read_by(const PixelStage& stage) {
    std::vector<Interpolant> result;
    const std::vector<InterpolantPlace>& places = stage.candidate.inputs;
    for (std::size_t i = 0; i < places.size(); ++i)
        for (const Declaration& declaration : stage.candidate.shader.declarations)
            if (declaration.sampler == SamplerKind::None &&
                declaration.target.index == places[i].index)
                result.push_back({stage.program.pixel.inputs[i].name, places[i]});
    return result;
}

std::vector<std::string> in_words(const std::vector<Interpolant>& interpolants) {
    std::vector<std::string> result;
    for (const Interpolant& interpolant : interpolants) {
        const InterpolantPlace& place = interpolant.place;
        std::string lanes;
        for (int k = 0; k < place.width; ++k)
            lanes += "xyzw"[place.lanes[static_cast<std::size_t>(k)]];
        result.push_back(fmt::format("texcoord{}.{} {}", place.index, lanes, interpolant.name));
    }
    return result;
}

void append(std::vector<std::string>* notes, const std::vector<std::string>& more) {
    if (notes != nullptr) notes->insert(notes->end(), more.begin(), more.end());
}

}  // namespace

Result<Shader> generate_pixel(const ir::Program& recorded, Profile profile,
                              std::vector<std::string>* notes) {
    auto stage = smallest_pixel_stage(recorded, profile);
    if (!stage) return stage.error();
    if (!stage->candidate.fits()) return refuse(recorded.name, stage->candidate);
    append(notes, stage->candidate.notes);
    return std::move(stage->candidate.shader);
}

Result<Attempt> attempt_program(const ir::Program& recorded, Profile profile) {
    auto pixel = smallest_pixel_stage(recorded, profile);
    if (!pixel) return pixel.error();
    Attempt result;
    Candidate& candidate = pixel->candidate;
    const std::vector<Interpolant> interpolants = read_by(*pixel);
    result.interpolants = in_words(interpolants);
    if (candidate.fits()) {
        auto vertex = vertex_stage(pixel->program, recorded.vertex, interpolants,
                                   profile == Profile::ps_3_0 ? Profile::vs_3_0 : Profile::vs_2_0);
        if (!vertex) return vertex.error();
        append(&candidate.notes, vertex->notes);
        result.vertex = std::move(vertex->shader);
    } else {
        result.refusal = refuse(recorded.name, candidate);
        result.only_slots = candidate.failure.has_value();
        if (candidate.at_least)
            candidate.notes.push_back(
                fmt::format("It is so much too long for {} that its slots are shown as they are "
                            "before packing.",
                            name_of(profile)));
    }
    result.pixel = std::move(candidate.shader);
    result.notes = std::move(candidate.notes);
    return result;
}

Result<Stages> generate_program(const ir::Program& recorded, Profile profile) {
    auto attempt = attempt_program(recorded, profile);
    if (!attempt) return attempt.error();
    if (attempt->refusal) return *attempt->refusal;
    return Stages{std::move(*attempt->vertex), std::move(attempt->pixel),
                  std::move(attempt->interpolants), std::move(attempt->notes)};
}

Result<Shader> generate_vertex(const ir::Program& recorded, Profile profile,
                               std::vector<std::string>* notes) {
    if (is_pixel(profile))
        return input_error("d3d9-stage", fmt::format("{} is no profile of vertex shaders; those "
                                                     "are vs_2_0 and vs_3_0",
                                                     name_of(profile)));
    std::vector<std::string> more;
    auto program = straighten(recorded, LoopPlan{}, profile, more);
    if (!program) return program.error();
    const Profile pixel = profile == Profile::vs_3_0 ? Profile::ps_3_0 : Profile::ps_2_0;
    std::vector<Interpolant> all;
    const auto places = interpolant_places(program->pixel, pixel);
    for (std::size_t i = 0; i < places.size(); ++i)
        all.push_back({program->pixel.inputs[i].name, places[i]});
    auto vertex = vertex_stage(*program, recorded.vertex, all, profile);
    if (!vertex) return vertex.error();
    append(notes, more);
    append(notes, vertex->notes);
    return std::move(vertex->shader);
}

}  // namespace intaglio::d3d9
