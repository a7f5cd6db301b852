// One class of options and one function per command.  A command parses nothing: it gets its options
// filled, does the work, and gives an error or nothing.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "generator/base/result.h"
#include "generator/dsl/catalogue.h"
#include "src/measure/map_set.h"
#include "src/measure/view.h"
#include "src/variant/variant.h"

namespace intaglio::cli {

// "0.1.0"
const char* version();

struct ListOptions {
    std::string what = "techniques";  // techniques, targets, knobs, maps
    bool json = false;
};
Status list(const dsl::Catalogue& catalogue, const ListOptions& options);

// What is known of a variant's values before it runs.
struct KnownOptions {
    std::vector<std::string> fixed;    // "scale=0.05", "ambient=0.1,0.1,0.1"
    std::vector<std::string> assumed;  // "view.z=0.25..1"
};

// What names a variant, on every command that takes one.
struct VariantOptions {
    std::string surface;
    std::string target;
    std::vector<std::string> knobs;  // "taps=12"
    std::vector<std::string> loops;  // "march=unroll" or "march=loop"
    bool per_vertex = false;
    std::string split = {};  // "shading", "sections=3,shading"; empty: one pass
    int pass = 0;            // of the split, from 1; 0: all of them, where a command can
    KnownOptions known = {};
};
Result<VariantRequest> request_of(const VariantOptions& options);

struct EmitCommandOptions {
    VariantOptions variant;
    std::string stage;                // vertex, pixel; empty: the pixel stage if there is one
    std::string as = "shader";        // shader, function, bytecode
    std::string part = "search";      // of a function: search, shadow
    std::string bind = "parameters";  // of a function: parameters, globals
    bool count_reads = false;
    std::string dump_ir;  // empty: no; all; final; or the name of a pass
    std::string output = "-";
};
Status emit_variant(const dsl::Catalogue& catalogue, const EmitCommandOptions& options);

// What the witnesses counted, as a line's end.
std::string cost_text(const Target& target, const Judged& judged);

struct ValidateOptions {
    std::vector<std::string> surfaces;
    std::vector<std::string> targets;  // empty: every target
    std::vector<std::string> knobs, loops;
    KnownOptions known = {};
    bool verbose = false;
};
Status validate(const dsl::Catalogue& catalogue, const ValidateOptions& options);

struct ExplainOptions {
    VariantOptions variant;
    bool without = false;  // also what each guard and feature costs, by leaving it out
    bool json = false;
};
// Says who spends the slots; of a refused variant too, which is no error here.
Status explain(const dsl::Catalogue& catalogue, const ExplainOptions& options);

// The code of the error that is no fault: exit code 1.
inline constexpr std::string_view over_budget = "over-budget";

struct CheckOptions {
    std::string budgets;
    std::string baseline;         // in place of the one that the budgets name
    bool update = false;          // the baseline becomes what is measured
    bool patch = false;           // ... as a patch, in place of the report
    std::string format = "text";  // text, json, junit, github, sarif
    std::string today;            // for waivers: "2026-12-31"; empty: the day in UTC
    bool quiet = false;           // no report where all is within budget
    bool wants_depfile = false;   // said; its name says all
    std::string depfile;          // of what was read; empty: none
    std::string depfile_target;   // empty: the budgets
    std::string output = "-";
};
// Error `over_budget` where a limit is exceeded or cannot be judged.
Status check(const dsl::Catalogue& catalogue, const CheckOptions& options);

struct DiffOptions {
    std::string before, after;  // files that check --update writes
    std::string format = "text";
};
Status diff(const DiffOptions& options);

struct CostOptions {
    VariantOptions variant;
    std::vector<std::string> chips;  // see vulkan::chips
    bool json = false;
};
Status cost(const dsl::Catalogue& catalogue, const CostOptions& options);

struct TableOptions {
    std::string only;  // part of a technique's title; empty: all
    int threads = 1;
    std::string output = "-";
};
// What each Direct3D 9 profile makes of every technique and knob, in Markdown.
Status table_of_settings(const dsl::Catalogue& catalogue, const TableOptions& options);

struct PagesOptions {
    std::string output = "docs";         // holds techniques/*.md; pictures go to images/techniques
    std::string maps = "examples/maps";  // with the map that the figures are of
    std::vector<std::string> only;       // titles of blocks; empty: all
    int threads = 2;
};
// Writes what pages of techniques have from the generator and the runner: pictures, figures, costs.
Status write_pages(const dsl::Catalogue& catalogue, const PagesOptions& options);

struct SheetOptions {
    std::string output;                  // folder
    std::string maps = "examples/maps";  // folders with normal_height.png and colour.png
    std::string height;                  // a height map in place of those
    std::vector<double> elevations = {60, 15};
    int size = 128;  // pixels of a picture's side
    std::string device;
};
// For each elevation one picture of all searches on all maps, each beside its errors.
Status write_sheets(const dsl::Catalogue& catalogue, const SheetOptions& options);

// Which maps a surface wears.
struct MapOptions {
    std::string height, normal, colour;  // files; empty: made from the heights
    std::vector<std::string> baked;      // "cone=wall_cone.png"
    std::string maker;                   // a procedural map in place of files
    std::string map_size = "256x256";    // of a procedural map
    std::uint32_t seed = 1;              // of a procedural map
    double scale = 0.08;
    std::string filtering = "float";  // float, native
};
Result<measure::MapSet> map_set_of(const MapOptions& options);
// "cone=wall_cone.png" by kind.  Error "baked-syntax".
Result<std::map<std::string, std::filesystem::path>> baked_files(
    const std::vector<std::string>& options);
Result<measure::Filtering> filtering_of(const std::string& name);

// The picture between the passes of a split surface.
struct PassOptions {
    std::string format = "rgba16f";  // rgba8, rgba16, rgba16f, rgba32f
    double range = 0;                // greatest offset, texture units; 0: as the view needs
};

// From where a surface is seen and lit, in degrees, and what draws it.
struct ViewOptions {
    double elevation = 40, azimuth = 250;
    // By light; of those not said measure::Look decides.
    std::vector<double> light_elevation = {45}, light_azimuth = {20};
    std::string device = {};  // part of a Vulkan device's name; empty: lavapipe

    measure::Direction light() const { return {light_elevation.at(0), light_azimuth.at(0)}; }
    measure::Look look() const;
};
// Elevations from -90 to 90, finite azimuths, and no more lights than the surface has.
Status check_view(const ViewOptions& view, const VariantRequest& request);

struct RunOptions {
    VariantOptions variant;
    MapOptions map;
    ViewOptions view;
    std::string mesh =
        "quad";  // map: the whole map seen from infinity; quad, sphere, torus: in perspective
    // displaced: the relief as triangles, without a search; shells: as layers.
    std::string geometry = "polygon";
    int subdivisions = 2;  // of a texel, displaced
    int layers = 16;       // shells
    bool fins = false;     // of shells
    double distance = 0, repeat = 1;
    std::string size = "512x512";
    bool validation = false;
    std::string error_map;  // a file for the map of hit errors; only with mesh = map
    // As sweeps measure it, with mesh = map: fp24 and fp16 by the interpreter or the evaluator.
    std::string arithmetic = "fp32";
    std::string pixel;  // "12,40": said in words; empty: none
    PassOptions passes;
    std::string output;
};
Status run(const dsl::Catalogue& catalogue, const RunOptions& options);

struct SplitOptions {
    VariantOptions variant;
    MapOptions map;
    ViewOptions view;
    int size = 256;
};
// The passes of a split surface with their cost, and what each format between them costs in error.
Status split_table(const dsl::Catalogue& catalogue, const SplitOptions& options);

struct MeasureOptions {
    std::string scene;
    std::string output;              // folder
    std::string height;              // a map in place of the scene's
    std::vector<std::string> baked;  // "cone=wall_cone.png", of that map
    int size = 0;                    // pixels a side in place of the scene's; 0: the scene's
    std::string device;
    bool validation = false;
};
Status measure_scene(const dsl::Catalogue& catalogue, const MeasureOptions& options);

struct ReportOptions {
    std::string folder;      // with results
    std::string output;      // a page; empty: none
    std::string markdown;    // a document whose made part is written anew; empty: none
    std::string maps = ".";  // folder that the map files of the data are relative to
    std::string budgets;     // a budget file whose limits stand in for the profiles'; empty: none
    // Whose compilers are asked what the variants cost.
    std::vector<std::string> chips;
    bool pictures = true;    // drawn anew, which takes a device and the maps
    int rounds = 9;          // of timing; 0: no times
    int picture_size = 192;  // pixels a side
};
// The results of a folder as one page that works offline.
Status make_report(const dsl::Catalogue& catalogue, const ReportOptions& options);

// Writes a product to stdout ("-") or whole to a file.
Status write_product(const std::string& output, std::string_view bytes, bool binary);

// "256x128" as two numbers from 1 to 16384.
struct Size {
    int width, height;
};
Result<Size> parse_size(const std::string& text);

}  // namespace intaglio::cli
