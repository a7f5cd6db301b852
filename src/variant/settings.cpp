// The list of settings, and the attempts of the Direct3D 9 generator on each.
#include "src/variant/settings.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <set>
#include <thread>

#include <fmt/format.h>

#include "generator/ir/print.h"
#include "generator/target/d3d9/generate/generate.h"
#include "src/variant/variant.h"

namespace intaglio {
namespace {

// Both stages as recorded for the most capable target; empty where the setting is none, e.g.
// because another knob has to change with it.
std::string recorded_text(const dsl::Catalogue& catalogue, const Setting& setting) {
    VariantRequest request;
    request.surface = setting.surface;
    request.target = "glsl_450";
    request.knobs = setting.knobs();
    const Result<Recorded> recorded = record_variant(catalogue, request);
    if (!recorded) return {};
    return ir::print(recorded->program.vertex) + ir::print(recorded->program.pixel);
}

void add_knobs(const dsl::Catalogue& catalogue, std::vector<Setting>& settings,
               const Setting& by_default, const std::vector<dsl::KnobBase*>& knobs) {
    std::set<std::string> seen = {recorded_text(catalogue, by_default)};
    for (const dsl::KnobBase* knob : knobs)
        for (double value : {knob->least(), knob->most()}) {
            if (value == knob->initial()) continue;
            Setting setting = by_default;
            setting.knob = {knob->name(), fmt::format("{}", value)};
            if (knob->whole() && knob->most() >= 16)
                setting.work = value == knob->most() ? Setting::Work::More : Setting::Work::Less;
            const std::string text = recorded_text(catalogue, setting);
            if (!text.empty() && seen.insert(text).second) settings.push_back(setting);
        }
}

template <typename Kind>
void add_table(const dsl::Catalogue& catalogue, std::vector<Setting>& settings,
               std::string_view part, const std::vector<dsl::Entry<Kind>>& table,
               std::string_view before, std::string_view after) {
    for (const dsl::Entry<Kind>& row : table) {
        const std::string title = fmt::format("{}={}", part, row.name);
        const Setting by_default{title, fmt::format("{}{}{}", before, title, after), {}};
        settings.push_back(by_default);
        add_knobs(catalogue, settings, by_default, row.make()->knobs());
        if (part == "search") settings.push_back({title, title, {}, Setting::Work::More});
    }
}

VariantRequest request_of(const Setting& setting, const std::string& profile) {
    VariantRequest request;
    request.surface = setting.surface;
    request.target = profile;
    request.knobs = setting.knobs();
    return request;
}

bool is_slots(const d3d9::Headroom& row) {
    return row.resource.find("slots") != std::string_view::npos;
}

// The first thing that is over its limit, in few words.
std::string limit_of(const d3d9::Attempt& attempt) {
    for (const d3d9::Headroom& row : d3d9::headroom(attempt.pixel))
        if (row.left() < 0 && (is_slots(row) || !attempt.only_slots))
            return fmt::format("{} of {} {}", row.used, row.limit, row.resource);
    return attempt.refusal->message.find("temporary") != std::string::npos ? "temporary registers"
                                                                           : "dependent reads";
}

double slots_of(const d3d9::Attempt& attempt) {
    double most = 0;
    for (const d3d9::Headroom& row : d3d9::headroom(attempt.pixel))
        if (is_slots(row)) most = std::max(most, static_cast<double>(row.used) / row.limit);
    return most;
}

Fit fit_of(const dsl::Catalogue& catalogue, const VariantRequest& request) {
    Fit fit;
    const auto refused = [&fit](const Diagnostic& error, std::string limit) {
        fit.refusal = error;
        fit.limit = std::move(limit);
        return fit;
    };
    const Result<Recorded> recorded = record_variant(catalogue, request);
    if (!recorded) return refused(recorded.error(), "cannot be said");
    const Result<d3d9::Attempt> attempt =
        d3d9::attempt_program(recorded->program, *profile_of(*recorded->target));
    if (!attempt)
        return refused(attempt.error(),
                       attempt.error().code == "d3d9-level" ? "mip levels" : "cannot be said");
    if (attempt->refusal) {
        fit.slots = slots_of(*attempt);
        return refused(*attempt->refusal, limit_of(*attempt));
    }
    fit.pixel = d3d9::count(attempt->pixel);
    if (attempt->vertex) fit.vertex = d3d9::count(*attempt->vertex);
    return fit;
}

// Whether the default's refusal says enough.
bool is_known(const Setting& setting, const Fit& by_default) {
    if (!by_default.refusal) return false;
    if (setting.work == Setting::Work::More) return by_default.slots > 1;
    return setting.work == Setting::Work::Same && by_default.slots > 4;
}

// Runs `work(i)` for each i below `count`, on so many threads.
template <typename Work>
void for_each_index(std::size_t count, int threads, const Work& work) {
    std::atomic<std::size_t> next = 0;
    std::vector<std::jthread> workers;
    for (int i = 0; i < std::max(1, threads); ++i)
        workers.emplace_back([&] {
            for (std::size_t at = next++; at < count; at = next++) work(at);
        });
}

}  // namespace

std::vector<Setting> all_settings(const dsl::Catalogue& catalogue) {
    std::vector<Setting> settings;
    add_table(catalogue, settings, "search", catalogue.searches, "", ",output=displaced");
    add_table(catalogue, settings, "shadow", catalogue.shadows, "search=none,",
              ",output=displaced");
    add_table(catalogue, settings, "normal", catalogue.normals, "search=none,", "");
    add_table(catalogue, settings, "shading", catalogue.shadings, "search=none,", "");
    add_table(catalogue, settings, "output", catalogue.outputs, "search=parallax,", "");
    add_table(catalogue, settings, "vertex", catalogue.vertex_works, "search=none,", "");
    const Setting relief{"relief", "search=parallax_occlusion,output=displaced", {}};
    settings.push_back(relief);
    add_knobs(catalogue, settings, relief, dsl::ReliefKnobs().knobs());
    const Setting lights{"lights", "search=none,shadow=fur_depth", {}};
    settings.push_back(lights);
    add_knobs(catalogue, settings, lights, dsl::LightKnobs().knobs());
    for (const dsl::Preset& preset : catalogue.presets)
        settings.push_back({"preset " + preset.name, preset.name, {}});
    return settings;
}

std::vector<FitRow> fit_settings(const dsl::Catalogue& catalogue,
                                 const std::vector<std::string>& profiles, std::string_view only,
                                 int threads,
                                 const std::function<void(int done, int all)>& progress) {
    std::vector<FitRow> rows;
    for (Setting& setting : all_settings(catalogue))
        if (setting.title.find(only) != std::string::npos)
            rows.push_back({std::move(setting), std::vector<Fit>(profiles.size())});
    std::mutex mutex;
    int done = 0;
    const int all = static_cast<int>(rows.size() * profiles.size());
    const auto by_default = [&](const FitRow& row) {
        return std::find_if(rows.begin(), rows.end(), [&](const FitRow& other) {
            return other.setting.title == row.setting.title;
        });
    };
    // The defaults first: some other settings need not be tried after them.
    for (bool defaults : {true, false})
        for_each_index(rows.size() * profiles.size(), threads, [&](std::size_t i) {
            FitRow& row = rows[i / profiles.size()];
            const std::size_t profile = i % profiles.size();
            const FitRow& base = *by_default(row);
            if ((&base == &row) != defaults) return;
            Fit& fit = row.fits[profile];
            if (!defaults && is_known(row.setting, base.fits[profile])) {
                fit = base.fits[profile];
                fit.as_default = true;
            } else {
                fit = fit_of(catalogue, request_of(row.setting, profiles[profile]));
            }
            const std::lock_guard lock(mutex);
            if (progress) progress(++done, all);
        });
    return rows;
}

}  // namespace intaglio
