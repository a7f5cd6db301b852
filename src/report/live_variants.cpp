// Which variants the live part shows, and which map it shows them on.
#include <algorithm>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "src/maps/bake.h"
#include "src/maps/bake_view_dependent.h"
#include "src/measure/baked_maps.h"
#include "src/report/live.h"

namespace intaglio::report {
namespace {

using Knobs = std::vector<std::pair<std::string, std::string>>;

VariantRequest request_of(std::string surface, Knobs knobs = {}) {
    VariantRequest request;
    request.surface = std::move(surface);
    request.target = "essl_300";
    request.knobs = std::move(knobs);
    return request;
}

std::string text_of(double value) { return fmt::format("{:g}", value); }

// The most iterations of a loop with these knobs; 0 where they cannot be had together.
int longest_loop_of(const dsl::Catalogue& catalogue, const std::string& surface,
                    const Knobs& knobs) {
    const Result<Recorded> recorded = record_variant(catalogue, request_of(surface, knobs));
    return recorded ? longest_loop(recorded->program) : 0;
}

// Name and values of a knob.
struct Steps {
    std::string knob;
    std::vector<std::string> values;
    std::string many;  // eight times the default
};

// The first whole knob that makes a loop of `surface` longer; none: no knob, one empty value.
Steps steps_of(const dsl::Catalogue& catalogue, const std::string& surface,
               const std::vector<dsl::KnobBase*>& knobs) {
    const int usual = longest_loop_of(catalogue, surface, {});
    for (const dsl::KnobBase* knob : knobs) {
        const double twice = std::min(2 * knob->initial(), knob->most());
        if (!knob->whole() || twice < 2) continue;
        if (longest_loop_of(catalogue, surface, {{knob->name(), text_of(twice)}}) <= usual)
            continue;
        Steps steps{knob->name(), {}, text_of(std::min(8 * knob->initial(), knob->most()))};
        for (const double factor : {0.5, 1.0, 2.0, 4.0}) {
            const double value = std::clamp(std::floor(knob->initial() * factor),
                                            std::max(knob->least(), 1.0), knob->most());
            if (steps.values.empty() || steps.values.back() != text_of(value))
                steps.values.push_back(text_of(value));
        }
        return steps;
    }
    return {"", {""}, ""};
}

std::string surface_of(const std::string& search, const std::string& shadow) {
    return shadow == "none" ? "search=" + search : "search=" + search + ",shadow=" + shadow;
}

// Search and shadow exact, or the search alone.
LiveVariant reference_for(const dsl::Catalogue& catalogue, const std::string& shadow) {
    LiveVariant variant{"reference", shadow, "", request_of(surface_of("exact", "none"))};
    const auto add_knobs = [&](const std::string& surface, const auto& table) {
        for (const auto& entry : table) {
            if (entry.name != "exact") continue;
            const Steps steps = steps_of(catalogue, surface, entry.make()->knobs());
            if (!steps.knob.empty()) variant.request.knobs.emplace_back(steps.knob, steps.many);
        }
    };
    add_knobs(variant.request.surface, catalogue.searches);
    if (shadow == "none") return variant;
    variant.request.surface = surface_of("exact", "exact");
    add_knobs("search=none,shadow=exact", catalogue.shadows);
    return variant;
}

bool reads_left_out(const ir::Program& program, const LiveOptions& options) {
    return std::any_of(program.pixel.samplers.begin(), program.pixel.samplers.end(),
                       [&](const ir::Sampler& sampler) {
                           return std::find(options.left_out.begin(), options.left_out.end(),
                                            sampler.name) != options.left_out.end();
                       });
}

maps::Image in_8_bits(maps::Image image) {
    image.bits = 8;
    for (float& value : image.texels) value = std::round(std::clamp(value, 0.0f, 1.0f) * 255) / 255;
    return image;
}

// The first level that fits.
maps::Image reduced(const maps::Image& image, int side) {
    if (image.width <= side && image.height <= side) return in_8_bits(image);
    for (const maps::Image& level : maps::mip_chain(image))
        if (level.width <= side && level.height <= side) return in_8_bits(level);
    return in_8_bits(image);
}

// In the place of the one that would be baked; where it cannot be, whoever bakes the other says so.
void add_small_views(measure::MapSet& set) {
    constexpr const char* kind = "view-dependent";
    Result<maps::Volume> volume =
        maps::bake_view_dependent(set.heights, live_view_side, live_view_side);
    const Result<maps::WantedBake> wanted = measure::wanted_bake(kind, "", "");
    if (!volume || !wanted) return;
    set.baked[kind] = {{}, std::move(volume->slices), maps::Provenance{kind, wanted->settings}};
}

}  // namespace

measure::MapSet live_map(const measure::MapSet& set, int side) {
    measure::MapSet map = {set.name, reduced(set.heights, side), reduced(set.normal_height, side),
                           reduced(set.colour, side)};
    add_small_views(map);
    return map;
}

Result<std::vector<LiveVariant>> live_variants(const dsl::Catalogue& catalogue,
                                               const LiveOptions& options) {
    std::vector<LiveVariant> variants;
    for (const dsl::Entry<dsl::Search>& entry : catalogue.searches) {
        const Steps steps =
            steps_of(catalogue, surface_of(entry.name, "none"), entry.make()->knobs());
        for (const std::string& value : steps.values) {
            for (const std::string& shadow : options.shadows) {
                LiveVariant variant{entry.name, shadow, value,
                                    request_of(surface_of(entry.name, shadow))};
                if (!value.empty()) variant.request.knobs.emplace_back(steps.knob, value);
                // What the target refuses is not shown; what nobody knows is an error.
                const Result<Recorded> recorded = record_variant(catalogue, variant.request);
                if (!recorded && recorded.error().code.starts_with("unknown"))
                    return recorded.error();
                if (recorded && !reads_left_out(recorded->program, options))
                    variants.push_back(std::move(variant));
            }
        }
    }
    for (const std::string& shadow : options.shadows)
        variants.push_back(reference_for(catalogue, shadow));
    return variants;
}

}  // namespace intaglio::report
