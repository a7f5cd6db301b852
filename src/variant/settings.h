// Every technique of a catalogue alone, with each knob at its default and at both ends of its
// range: what tables and judges walk through.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "generator/target/d3d9/resources.h"
#include "src/variant/variant.h"

namespace intaglio {

struct Setting {
    std::string title;    // what is looked at: "search=relief", "preset fur", "relief"
    std::string surface;  // the composition that shows it
    std::pair<std::string, std::string> knob;  // its name and value; empty: all as by default
    // Against the title's first setting, which is all by default.  More: a number of steps at its
    // greatest, or shading after what was without.  Less: a number of steps at its least.
    enum class Work { Same, More, Less } work = Work::Same;

    std::vector<std::pair<std::string, std::string>> knobs() const {
        if (knob.first.empty()) return {};
        return {knob};
    }
};

// By part, technique and knob in the order of the catalogue.  Searches and shadows come as
// output=displaced, searches once more with their shading; the knobs of the relief with a search
// that they all concern, those of the lights with a shadow.  Not listed: values that are the
// default's, and settings that record the same program as the default, because nothing depends on
// the knob there.
std::vector<Setting> all_settings(const dsl::Catalogue& catalogue);

// What a Direct3D 9 profile makes of a setting.
struct Fit {
    d3d9::Resources pixel, vertex;      // of an emitted variant
    std::optional<Diagnostic> refusal;  // none: emitted
    std::string limit;                  // of a refusal in few words: "79 of 64 arithmetic slots"
    double slots = 0;  // of a refusal: the most that is used of a limit on slots, 1 being all
    // Not tried: refused for want of slots by default, and this needs no fewer; or by so many that
    // no knob but the number of steps changes it.
    bool as_default = false;
};

struct FitRow {
    Setting setting;
    std::vector<Fit> fits;  // by profile
};

// Every setting whose title contains `only`, on each profile, in order, on `threads` threads.
// `progress` is told how many of how many are done, from one thread at a time.
std::vector<FitRow> fit_settings(const dsl::Catalogue& catalogue,
                                 const std::vector<std::string>& profiles, std::string_view only,
                                 int threads,
                                 const std::function<void(int done, int all)>& progress = {});

}  // namespace intaglio
