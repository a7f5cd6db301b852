// Alternatives are tried from the IR on: each lowering of the searches, each packing, each order of
// instructions; the first that gets registers, from the cheapest packing on, counts.
#include "generator/target/d3d9/generate/generate.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "generator/passes/lower_first_hit.h"
#include "generator/passes/pipeline.h"
#include "generator/passes/rewrite.h"
#include "generator/target/d3d9/generate/finish.h"
#include "generator/target/d3d9/generate/lower.h"
#include "generator/target/d3d9/generate/pack.h"
#include "generator/target/d3d9/legality.h"
#include "generator/target/d3d9/ops.h"
#include "generator/target/d3d9/resources.h"

namespace intaglio::d3d9 {
namespace {

// How many placements one packing may try: about a second's worth, fewer for long shaders.
int evaluations_for(const Graph& graph) {
    return static_cast<int>(20'000'000 / (graph.nodes.size() * graph.nodes.size() / 8 + 1000));
}

void forget_forms(ir::Region& region) {
    passes::for_each_instruction(region, [](ir::Instruction& instruction) {
        instruction.loop.form = ir::LoopForm::Unspecified;
    });
}

// Both stages optimised, loops and branches gone.
Result<ir::Program> straighten(const ir::Program& program, passes::FirstHitForm form,
                               std::vector<std::string>& notes) {
    ir::Program result = program;
    forget_forms(result.pixel.body);
    passes::PipelineOptions options;
    if (form != passes::FirstHitForm::Chain) {
        if (const auto done = passes::optimize(result.pixel, options); !done) return done.error();
        passes::lower_first_hit(result.pixel, form);
    }
    options.unroll_all = true;
    options.flatten_all = true;
    auto more = passes::optimize_program(result, options);
    if (!more) return more.error();
    notes.insert(notes.end(), more->begin(), more->end());
    return result;
}

struct Candidate {
    Shader shader;
    std::vector<std::string> notes;
    std::vector<Violation> violations;
    std::optional<AllocationFailure> failure;
    int failed_at = -1;
    bool fits() const { return !failure && violations.empty(); }
};

bool better(const Candidate& a, const Candidate& b) {
    if (a.fits() != b.fits()) return a.fits();
    const Slots x = slots_of(a.shader), y = slots_of(b.shader);
    return std::pair(x.arithmetic, x.texture) < std::pair(y.arithmetic, y.texture);
}

Candidate try_orders(const ir::Module& module, const Graph& graph, Profile profile) {
    std::optional<Candidate> best;
    for (const Order order : all_orders) {
        const Finished finished = finish(module, graph, order_of(graph, order), profile);
        Candidate candidate;
        candidate.shader = finished.shader;
        candidate.failure = finished.failure;
        candidate.failed_at = finished.failed_at;
        if (!candidate.failure) candidate.violations = check(candidate.shader);
        if (!best || better(candidate, *best)) best = std::move(candidate);
    }
    return std::move(*best);
}

// How many joins may be given up for registers.
constexpr std::size_t most_given_up = 8;

// Joining lengthens lives: what got no registers may fit with a few joins less.
Candidate cheapest_fitting(const ir::Module& module, const std::vector<Graph>& packings,
                           Profile profile) {
    std::optional<Candidate> best;
    const std::size_t last = packings.size() > most_given_up ? packings.size() - most_given_up : 0;
    for (std::size_t i = packings.size(); i-- > last;) {
        Candidate candidate = try_orders(module, packings[i], profile);
        if (!best || better(candidate, *best)) best = std::move(candidate);
        if (best->fits()) break;
    }
    return std::move(*best);
}

Result<Candidate> attempt(const ir::Program& program, Profile profile, passes::FirstHitForm form) {
    std::vector<std::string> notes;
    auto straight = straighten(program, form, notes);
    if (!straight) return straight.error();
    const ir::Module& module = straight->pixel;
    auto graph = lower(module, profile, notes);
    if (!graph) return graph.error();
    const Limits& limits = limits_of(profile);
    int next = 0;
    const std::vector<int> uniforms = assign_uniforms(module, *graph, next);
    std::optional<Candidate> best;
    const Graph wide = with_wide_output(*graph);
    if (cost_of(wide, limits, uniforms) < cost_of(*graph, limits, uniforms)) *graph = wide;
    for (const std::vector<Graph>& packings :
         pack(*graph, limits, uniforms, evaluations_for(*graph))) {
        Candidate candidate = cheapest_fitting(module, packings, profile);
        if (!best || better(candidate, *best)) best = std::move(candidate);
    }
    best->notes = std::move(notes);
    return std::move(*best);
}

std::string place_of(const Shader& shader, const ir::Origin& origin) {
    if (origin.file < 0 || origin.file >= static_cast<int>(shader.files.size())) return {};
    return fmt::format("{}:{}", shader.files[static_cast<std::size_t>(origin.file)], origin.line);
}

// "march takes 61 of them, most at templates/search/steep_parallax.cpp:43"
std::string spender(const Shader& shader) {
    std::map<int, int> steps;
    for (const Instruction& instruction : shader.instructions)
        steps[instruction.origin.step] += slots_of(instruction).total();
    const auto most =
        std::max_element(steps.begin(), steps.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    if (most == steps.end()) return {};
    std::map<std::string, int> lines;
    for (const Instruction& instruction : shader.instructions)
        if (instruction.origin.step == most->first)
            lines[place_of(shader, instruction.origin)] += slots_of(instruction).total();
    const auto line =
        std::max_element(lines.begin(), lines.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    const bool named = most->first >= 0 && most->first < static_cast<int>(shader.steps.size());
    return fmt::format(
        "{} takes {} of its {} slots, {} of them at {}",
        named ? "the step '" + shader.steps[static_cast<std::size_t>(most->first)].name + "'"
              : "work outside the steps",
        most->second, slots_of(shader).total(), line->second,
        line->first.empty() ? "an unknown line" : line->first);
}

std::string limit_exceeded(const Candidate& candidate) {
    const Limits& limits = limits_of(candidate.shader.profile);
    const Slots slots = slots_of(candidate.shader);
    std::vector<std::string> parts;
    const auto over = [&](std::string_view what, int used, int limit) {
        if (used > limit)
            parts.push_back(fmt::format("needs {} {}, {} more than the {} it has", used, what,
                                        used - limit, limit));
    };
    over("arithmetic slots", slots.arithmetic, limits.arithmetic_slots);
    over("texture slots", slots.texture, limits.texture_slots);
    if (parts.empty()) over("slots", slots.total(), limits.total_slots);
    if (parts.empty() && candidate.failure == AllocationFailure::Temps)
        parts.push_back(fmt::format("needs more than its {} temporary registers", limits.temps));
    if (parts.empty() && candidate.failure == AllocationFailure::DependentReads)
        parts.push_back(
            fmt::format("needs texture reads that depend on each other more than {} deep",
                        limits.dependent_level));
    if (parts.empty() && !candidate.violations.empty())
        return "refuses it: " + candidate.violations[0].message;
    return fmt::format("{}", fmt::join(parts, " and "));
}

Diagnostic refuse(const ir::Program& program, const Candidate& candidate) {
    std::string_view advice = "ps_2_b or ps_2_a";
    if (candidate.shader.profile != Profile::ps_2_0) advice = "ps_3_0";
    if (candidate.shader.profile == Profile::ps_3_0) advice = "a target with loops";
    return input_error("d3d9-limit",
                       fmt::format("{} {} for {}: {}; try fewer taps or steps, {}, or "
                                   "output=displaced and shading in a second pass",
                                   name_of(candidate.shader.profile), limit_exceeded(candidate),
                                   program.name, spender(candidate.shader), advice));
}

}  // namespace

Result<Shader> generate(const ir::Program& program, ir::Stage stage, Profile profile,
                        std::vector<std::string>* notes) {
    if (stage != ir::Stage::Pixel || !is_pixel(profile))
        return input_error("d3d9-stage",
                           fmt::format("{} has no code generator for this stage; pixel "
                                       "stages go to ps_2_0, ps_2_a, ps_2_b, ps_3_0",
                                       name_of(profile)));
    std::optional<Candidate> best;
    for (const passes::FirstHitForm form :
         {passes::FirstHitForm::PackedRefetch, passes::FirstHitForm::Chain}) {
        auto candidate = attempt(program, profile, form);
        if (!candidate) return candidate.error();
        if (!best || better(*candidate, *best)) best = std::move(*candidate);
    }
    if (!best->fits()) return refuse(program, *best);
    if (notes != nullptr) notes->insert(notes->end(), best->notes.begin(), best->notes.end());
    return std::move(best->shader);
}

}  // namespace intaglio::d3d9
