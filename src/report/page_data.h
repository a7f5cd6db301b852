// What the report's page shows, in the page's own form, from whatever form the measurements are in.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "generator/base/result.h"
#include "src/measure/view.h"
#include "src/variant/variant.h"

namespace intaglio::report {

// `json` is what the page's scripts read (page/data.js):
//   made_by   {name of a number: what made it}
//   device    the device's name
//   maps      [{name, width, height, bits}]
//   variants  [{surface, technique, target, knobs: {name: number}, loops: {name: form}, per_vertex,
//             known: ["scale = 0.05"] and scene_surface (of a planned scene), spirv: {...}, d3d9:
//             {...} or null, emit_command, explain_command}]
//   cases     [{map, variant (both counted from 0), view: {elevation, azimuth}, light, scale,
//             reads: {mean, max}, hits, command; of a sweep also arithmetic, instructions, swim,
//             picture, split; of `measure` also time}]: numbers as measured; what is not known is
//             null or absent
//   refused   [{variant, sentence}]: what their target cannot have
// add_sources and add_gallery put the rest in.
struct PageMap {
    std::vector<std::string> arguments;  // of `intaglio run`; none: the data does not say
    double scale = 0.08;                 // of its first case, for which normals are baked
};
struct PageData {
    nlohmann::ordered_json json;
    std::vector<VariantRequest> variants;  // in the order of json["variants"]
    std::vector<PageMap> maps;             // in the order of json["maps"]
    bool native_filtering = false;
    std::string device;  // as asked for
};

// From what `intaglio measure` writes, results.json.  Errors, with `file` in them: "not-json",
// "not-results" where the schema is another or a member is missing.
Result<PageData> page_data_of_measurement(const std::string& text, const std::string& file);

// From what `intaglio sweep` writes, results.jsonl: one line a case, in any order.  Variants come
// in the order of the catalogue's searches, then by their knobs; maps from files come first. Errors
// as above.
Result<PageData> page_data_of_sweep(const std::string& text, const std::string& file,
                                    const dsl::Catalogue& catalogue);

// The emitted text of each variant's pixel stage and who spends what it costs, {text, spent: {unit,
// lines: [{step, place, arithmetic, texture}], reads: [{sampler, level or null, step, place}]}} as
// src/variant/explain.h counts: "slots" or "operations", "" where there is no step or place, lines
// in the order of steps.  For Direct3D 9 also {lines: [[arithmetic, texture] or null], line_units,
// lines_note} of the text, and the limits beside what is used.  json["sources"], variants[i].source
// and variants[i].resources.  A variant that cannot be made any more is an error: then the data is
// older than the program.
Status add_sources(PageData& page, const dsl::Catalogue& catalogue);

// A limit that a project sets itself, on a metric of named_metric.h.
struct PageLimit {
    std::size_t variant = 0;  // of the page
    std::string metric;
    double max = 0;
};
// Puts them, and who says so, in the place of the profile's in variants[i].resources, or beside
// them: {resource, used (null where the data does not say), limit, by}.  After add_sources.
void add_limits(PageData& page, const std::vector<PageLimit>& limits, const std::string& file);

// What the compilers of these chips make of each pixel stage (src/measure/cost.h):
// variants[i].chips = {chip: {instructions, vector_registers, latency, inverse_throughput}}, and
// their makers.  Where there is no such driver made_by says so.  Errors: those of make_variant and
// of the compilers.
Status add_chips(PageData& page, const dsl::Catalogue& catalogue,
                 const std::vector<std::string>& chips);

// The words of a command line, as report::shell_quoted quotes them.
std::vector<std::string> shell_words(const std::string& command);

}  // namespace intaglio::report
