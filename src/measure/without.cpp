// A list of requests and of changed programs, and the explanation of each.
#include "src/measure/without.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "generator/ir/print.h"
#include "generator/target/limits.h"
#include "src/measure/guards.h"
#include "src/measure/rows.h"

namespace intaglio::measure {
namespace {

// The least there is of each part.
struct Least {
    const char *part, *technique;
};
constexpr Least least_parts[] = {{"search", "none"},
                                 {"shadow", "none"},
                                 {"normal", "map"},
                                 {"shading", "ambient_only"},
                                 {"output", "colour"}};

// A variant to be explained.
struct Candidate {
    Omission::Kind kind;
    std::string what;
    Recorded recorded;
};

Result<dsl::Surface> surface_of(const dsl::Catalogue& catalogue, const VariantRequest& request) {
    Result<dsl::Surface> surface = dsl::make_surface(catalogue, request.surface);
    if (!surface) return surface;
    for (const auto& [name, value] : request.knobs)
        if (Status status = surface->set_knob(name, value); !status) return status.error();
    return surface;
}

// The request without the knobs, loops and known values of techniques that are no longer there.
VariantRequest trimmed(const dsl::Catalogue& catalogue, VariantRequest request) {
    if (Result<dsl::Surface> surface = dsl::make_surface(catalogue, request.surface))
        std::erase_if(request.knobs, [&](const auto& knob) {
            return !surface->set_knob(knob.first, knob.second);
        });
    const passes::Known known = std::exchange(request.known, {});
    std::erase_if(request.loop_forms, [&](const auto& loop) {
        VariantRequest one = request;
        one.loop_forms = {loop};
        const Result<Recorded> recorded = record_variant(catalogue, one);
        return !recorded && recorded.error().code == "unknown-loop";
    });
    if (const Result<Recorded> recorded = record_variant(catalogue, request))
        request.known = passes::part_of(known, recorded->program);
    return request;
}

// The program without its name, which is the composition as written.
std::string text_of(const Recorded& recorded) {
    ir::Program program = recorded.program;
    program.vertex.name.clear();
    program.pixel.name.clear();
    return ir::print(program.vertex) + ir::print(program.pixel) +
           (program.per_vertex ? "per vertex" : "");
}

class Candidates {
  public:
    Candidates(const dsl::Catalogue& catalogue, const VariantRequest& request,
               const Recorded& whole)
        : catalogue_(catalogue), request_(request), whole_(whole), text_(text_of(whole)) {}

    // A request that cannot be recorded is none: its feature cannot be left out alone.
    void add(Omission::Kind kind, std::string what, VariantRequest request) {
        Result<Recorded> recorded =
            record_variant(catalogue_, trimmed(catalogue_, std::move(request)));
        if (recorded && text_of(*recorded) != text_)
            all_.push_back({kind, std::move(what), std::move(*recorded)});
    }
    void add_part(const Least& least) {
        VariantRequest request = request_;
        request.surface = dsl::with_part(request.surface, least.part, least.technique);
        add(Omission::Kind::Part, fmt::format("{}={}", least.part, least.technique), request);
    }
    void add_knob(const std::string& name, int value) {
        VariantRequest request = request_;
        request.knobs.emplace_back(name, fmt::format("{}", value));
        add(Omission::Kind::Knob, fmt::format("{}={}", name, value), request);
    }
    void add_guard(Guard guard) {
        Recorded without = whole_;
        if (remove_guard(without.program.pixel, guard) +
                remove_guard(without.program.vertex, guard) >
            0)
            all_.push_back(
                {Omission::Kind::Guard, std::string(name_of(guard)), std::move(without)});
    }
    std::vector<Candidate> take() { return std::move(all_); }

  private:
    const dsl::Catalogue& catalogue_;
    const VariantRequest& request_;
    const Recorded& whole_;
    std::string text_;
    std::vector<Candidate> all_;
};

std::vector<Candidate> candidates_of(const dsl::Catalogue& catalogue, const VariantRequest& request,
                                     const Recorded& whole, const dsl::Surface& surface) {
    Candidates candidates(catalogue, request, whole);
    for (const Least& least : least_parts) candidates.add_part(least);
    const int lights = surface.lighting->lights;
    const int shadowing = surface.shadow->depends_on_light() ? surface.lighting->shadowing() : 0;
    for (int count = lights; count-- > 0;) candidates.add_knob("lights", count);
    // None at all is shadow=none.
    for (int count = shadowing; count-- > 1;) candidates.add_knob("shadowed_lights", count);
    for (const char* knob : {"clip_tile", "ray_per_vertex"}) candidates.add_knob(knob, 0);
    if (request.per_vertex) {
        VariantRequest per_pixel = request;
        per_pixel.per_vertex = false;
        candidates.add(Omission::Kind::Flag, "--per-vertex", per_pixel);
    }
    for (const Guard guard : all_guards) candidates.add_guard(guard);
    return candidates.take();
}

bool is_slots(const d3d9::Headroom& row) { return row.resource.find("slots") != std::string::npos; }

std::string limit_of(const ExplainedStage& stage, bool fits) {
    if (!stage.profile) return {};
    const auto in_words = [](const d3d9::Headroom& row) {
        return fmt::format("{} of {} {}", row.used, row.limit, row.resource);
    };
    const d3d9::Headroom* most = nullptr;
    for (const d3d9::Headroom& row : stage.explanation.headroom) {
        if (stage.only_slots && !is_slots(row)) continue;
        if (!fits && row.left() < 0) return in_words(row);
        if (is_slots(row) && (!most || row.used * most->limit > most->used * row.limit))
            most = &row;
    }
    if (!fits) return "registers or dependent reads";
    return most ? in_words(*most) : std::string();
}

Spending spending_of(const ExplainedVariant& variant) {
    Spending spending;
    spending.fits = !variant.refusal;
    // A language that refuses gives no stage.
    if (variant.stages.empty()) return spending;
    const ExplainedStage& stage = variant.stages.front();
    spending.slots = stage.explanation.slots;
    spending.limit = limit_of(stage, spending.fits);
    return spending;
}

}  // namespace

Result<Omissions> leave_out_each(const dsl::Catalogue& catalogue, const VariantRequest& request,
                                 int threads) {
    const Result<Recorded> whole = record_variant(catalogue, request);
    if (!whole) return whole.error();
    const Result<dsl::Surface> surface = surface_of(catalogue, request);
    if (!surface) return surface.error();
    const Result<ExplainedVariant> with = explain_recorded(*whole);
    if (!with) return with.error();
    const std::vector<Candidate> candidates = candidates_of(catalogue, request, *whole, *surface);
    std::vector<std::optional<Result<ExplainedVariant>>> explained(candidates.size());
    for_each_row(static_cast<int>(candidates.size()), threads, [&](int row) {
        const auto at = static_cast<std::size_t>(row);
        explained[at] = explain_recorded(candidates[at].recorded);
    });
    Omissions omissions{spending_of(*with), {}};
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        const Result<ExplainedVariant>& variant = *explained[i];
        if (!variant && !is_refusal(variant.error())) return variant.error();
        omissions.rows.push_back({candidates[i].kind, candidates[i].what,
                                  variant ? spending_of(*variant) : Spending{{}, false, {}}});
    }
    return omissions;
}

}  // namespace intaglio::measure
