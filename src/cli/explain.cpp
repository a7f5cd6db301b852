// `intaglio explain`: who spends what a variant costs.
#include "src/variant/explain.h"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "src/cli/commands.h"
#include "src/measure/without.h"

namespace intaglio::cli {
namespace {

using nlohmann::ordered_json;

std::string place_of(const std::string& file, int line) {
    return file.empty() ? "unknown line" : fmt::format("{}:{}", file, line);
}

std::string step_name(const std::string& step) { return step.empty() ? "outside steps" : step; }

// A row of the headroom whose numbers are true.
bool is_known(const ExplainedStage& stage, const d3d9::Headroom& row) {
    return !stage.only_slots || row.resource.find("slots") != std::string_view::npos;
}

constexpr std::size_t name_width = 52;

std::string_view stage_word(const ExplainedStage& stage) {
    return stage.stage == ir::Stage::Pixel ? "pixel" : "vertex";
}

// What is counted.
std::string_view unit_of(const ExplainedStage& stage) {
    return stage.profile ? "slots" : "operations";
}

// Whether texture reads have a level that is known.
bool has_levels(const ExplainedStage& stage) { return stage.profile && !stage.only_slots; }

std::string spent_text(const ExplainedStage& stage) {
    const d3d9::Explanation& explanation = stage.explanation;
    std::string text = fmt::format("  {:<{}} arithmetic  texture\n",
                                   fmt::format("{} by step and line", unit_of(stage)), name_width);
    for (const d3d9::Spent& step : explanation.steps) {
        text += fmt::format("  {:<{}} {:>10} {:>8}\n", step_name(step.step), name_width,
                            step.slots.arithmetic, step.slots.texture);
        for (const d3d9::Spent& line : explanation.lines)
            if (line.step == step.step)
                text += fmt::format("    {:<{}} {:>10} {:>8}\n", place_of(line.file, line.line),
                                    name_width - 2, line.slots.arithmetic, line.slots.texture);
    }
    return text;
}

std::string headroom_text(const ExplainedStage& stage) {
    if (!stage.profile) return {};
    std::string text =
        fmt::format("  {:<30} {:>6} {:>6} {:>6}\n", "resource", "used", "limit", "left");
    for (const d3d9::Headroom& row : stage.explanation.headroom)
        if (is_known(stage, row))
            text += fmt::format("  {:<30} {:>6} {:>6} {:>6}{}\n", row.resource, row.used, row.limit,
                                row.left(), row.left() < 0 ? "  over" : "");
    if (stage.only_slots)
        text += "  registers and levels are not known: none were found that fit\n";
    return text;
}

std::string reads_text(const ExplainedStage& stage) {
    if (stage.explanation.reads.empty()) return {};
    std::string text = fmt::format("  {:<7} {:<16} {}\n", has_levels(stage) ? "level" : "",
                                   "texture read", "step and line");
    for (const d3d9::TextureRead& read : stage.explanation.reads)
        text += fmt::format("  {:<7} {:<16} {}, {}\n",
                            has_levels(stage) ? fmt::format("{}", read.level) : std::string(),
                            read.sampler, step_name(read.step), place_of(read.file, read.line));
    return text;
}

std::string text_of(const ExplainedVariant& variant, const std::string& target) {
    std::string text = fmt::format("{} on {}", variant.name, target);
    for (std::size_t i = 0; i < variant.settings.size(); ++i)
        text += fmt::format("{}{}", i == 0 ? "; " : ", ", variant.settings[i]);
    text += "\n";
    for (const std::string& sentence : variant.left_out)
        text += fmt::format("left out: {}\n", sentence);
    if (variant.refusal) text += fmt::format("refused: {}\n", variant.refusal->message);
    for (const ExplainedStage& stage : variant.stages) {
        const d3d9::Slots& slots = stage.explanation.slots;
        text += fmt::format("\n{} stage, {}: {} arithmetic and {} texture {}\n", stage_word(stage),
                            stage.profile ? name_of(*stage.profile) : std::string_view(target),
                            slots.arithmetic, slots.texture, unit_of(stage));
        for (const std::string& part : {spent_text(stage), headroom_text(stage), reads_text(stage)})
            if (!part.empty()) text += "\n" + part;
    }
    return text;
}

std::string_view name_of(measure::Omission::Kind kind) {
    using enum measure::Omission::Kind;
    switch (kind) {
        case Guard: return "guard";
        case Part: return "part";
        case Knob: return "knob";
        case Flag: return "flag";
    }
    return {};
}

// What is worth saying of a limit: that it is kept or broken where the whole is not so, and by how
// much it is broken.
std::string fit_text(const measure::Spending& whole, const measure::Spending& without) {
    if (without.fits && whole.fits) return {};
    const std::string_view word = without.fits ? "fits" : "refused";
    return without.limit.empty() ? fmt::format("  {}", word)
                                 : fmt::format("  {}: {}", word, without.limit);
}

std::string without_text(const measure::Omissions& omissions) {
    const measure::Spending& with = omissions.with;
    std::string text =
        fmt::format("\n  {:<{}} arithmetic  texture       change\n", "without", name_width);
    for (const measure::Omission& row : omissions.rows) {
        const d3d9::Slots& slots = row.without.slots;
        text += fmt::format(
            "  {:<{}} {:>10} {:>8} {:>+6} {:>+5}{}\n",
            row.kind == measure::Omission::Kind::Guard ? "guard, " + row.what : row.what,
            name_width, slots.arithmetic, slots.texture, slots.arithmetic - with.slots.arithmetic,
            slots.texture - with.slots.texture, fit_text(with, row.without));
    }
    return text;
}

ordered_json json_of(const measure::Spending& spending) {
    ordered_json json = {{"arithmetic", spending.slots.arithmetic},
                         {"texture", spending.slots.texture},
                         {"fits", spending.fits}};
    if (!spending.limit.empty()) json["limit"] = spending.limit;
    return json;
}

ordered_json json_of(const measure::Omissions& omissions) {
    ordered_json json = {{"with", json_of(omissions.with)}, {"rows", ordered_json::array()}};
    for (const measure::Omission& row : omissions.rows) {
        json["rows"].push_back({{"kind", name_of(row.kind)}, {"what", row.what}});
        json["rows"].back().update(json_of(row.without));
    }
    return json;
}

ordered_json json_of(const d3d9::Spent& spent) {
    return {{"step", spent.step},
            {"file", spent.file},
            {"line", spent.line},
            {"arithmetic", spent.slots.arithmetic},
            {"texture", spent.slots.texture}};
}

ordered_json json_of(const ExplainedStage& stage) {
    const d3d9::Explanation& explanation = stage.explanation;
    ordered_json json = {
        {"stage", stage_word(stage)},
        {"profile", stage.profile ? ordered_json(name_of(*stage.profile)) : ordered_json()},
        {"counted", unit_of(stage)},
        {"arithmetic", explanation.slots.arithmetic},
        {"texture", explanation.slots.texture},
        {"steps", ordered_json::array()},
        {"lines", ordered_json::array()},
        {"resources", ordered_json::array()},
        {"reads", ordered_json::array()}};
    for (const d3d9::Spent& step : explanation.steps)
        json["steps"].push_back({{"step", step.step},
                                 {"arithmetic", step.slots.arithmetic},
                                 {"texture", step.slots.texture}});
    for (const d3d9::Spent& line : explanation.lines) json["lines"].push_back(json_of(line));
    for (const d3d9::Headroom& row : explanation.headroom)
        if (is_known(stage, row))
            json["resources"].push_back({{"resource", row.resource},
                                         {"used", row.used},
                                         {"limit", row.limit},
                                         {"left", row.left()}});
    for (const d3d9::TextureRead& read : explanation.reads) {
        ordered_json row = {{"sampler", read.sampler}};
        if (has_levels(stage)) row["level"] = read.level;
        row.update({{"step", read.step}, {"file", read.file}, {"line", read.line}});
        json["reads"].push_back(std::move(row));
    }
    return json;
}

ordered_json json_of(const ExplainedVariant& variant, const std::string& target) {
    ordered_json json = {{"surface", variant.name},      {"target", target},
                         {"settings", variant.settings}, {"left_out", variant.left_out},
                         {"fits", !variant.refusal},     {"stages", ordered_json::array()}};
    if (variant.refusal)
        json["refusal"] = {{"code", variant.refusal->code}, {"message", variant.refusal->message}};
    for (const ExplainedStage& stage : variant.stages) json["stages"].push_back(json_of(stage));
    return json;
}

}  // namespace

Status explain(const dsl::Catalogue& catalogue, const ExplainOptions& options) {
    const Result<VariantRequest> request = request_of(options.variant);
    if (!request) return request.error();
    const Result<ExplainedVariant> variant = explain_variant(catalogue, *request);
    if (!variant) return variant.error();
    for (const std::string& note : variant->notes) fmt::print(stderr, "note: {}\n", note);
    const std::string& target = options.variant.target;
    ordered_json json = json_of(*variant, target);
    std::string text = text_of(*variant, target);
    if (options.without) {
        const Result<measure::Omissions> omissions = measure::leave_out_each(catalogue, *request);
        if (!omissions) return omissions.error();
        json["without"] = json_of(*omissions);
        text += without_text(*omissions);
    }
    return write_product("-", options.json ? json.dump(2) + "\n" : text, false);
}

}  // namespace intaglio::cli
