// The part of a report that draws itself: the essl_300 variants of a catalogue running in the page
// (WebGL 2) on a quad and a torus, side by side with the exact search and their difference. Nothing
// is fetched: programs, maps and script are in the text.
#pragma once

#include <string>
#include <vector>

#include "generator/base/result.h"
#include "generator/dsl/catalogue.h"
#include "src/measure/map_set.h"
#include "src/measure/view.h"
#include "src/variant/variant.h"

namespace intaglio::report {

// A map to choose in the page, and the arguments of `intaglio run` that stand for it, for instance
// {"--maker", "bricks"}; none: the page shows no such command.
struct LiveMap {
    measure::MapSet set;
    std::vector<std::string> run_arguments = {};
};

struct LiveOptions {
    std::vector<LiveMap> maps;  // at least one; larger ones than `side` are halved until they fit
    int side = 256;             // texels, a power of two
    double scale = 0.08;        // depth of the relief in texture units, where the page begins
    // Shadows to choose from.  Beside one that is not "none" the exact picture has the exact one.
    std::vector<std::string> shadows = {"none", "march", "soft"};
    // Samplers whose baked maps are not to be in the page; the searches that read one cannot be
    // chosen in it, and it says so.
    std::vector<std::string> left_out = {};
    measure::Look look = {};
};

// A whole view_dependent_map, 128 x 128 texels, is 2 MB of a page; one of this side is at most 350
// KB in base64.
inline constexpr int live_view_side = 32;

// The map as the page has it: at most `side` texels wide and high, 8 bits, colours still
// display-ready, with a view_dependent_map of live_view_side.
measure::MapSet live_map(const measure::MapSet& set, int side);

// A variant of the page, by the names that its controls have.  The knob is the first whole one that
// makes a loop of the search longer: "steps" below.
struct LiveVariant {
    std::string search, shadow;
    std::string steps;  // value of the knob; empty where the search has none
    VariantRequest request;
};
// Every search that essl_300 holds x the steps' default times 1/2, 1, 2 and 4 within its range x
// the shadows, without those that read what is left out; and last, with the search "reference", the
// exact pictures beside them: search and shadow exact, with eight times their default steps, so
// that they end only at the hit. Errors: "unknown-technique" for a shadow that the catalogue lacks.
Result<std::vector<LiveVariant>> live_variants(const dsl::Catalogue& catalogue,
                                               const LiveOptions& options);

// A fragment of HTML: style, markup, data and script, in this order.  It has one section with the
// id "live" and takes its width from what it stands in; light or dark as the reader prefers, or as
// a `data-theme` of the root element says.  Errors: "live-maps" without maps, those of the bakes
// and of live_variants.
Result<std::string> live_section(const dsl::Catalogue& catalogue, const LiveOptions& options);

// A page of its own around it.
std::string live_page(const std::string& section);

}  // namespace intaglio::report
