// `intaglio list`.
#include <cstdio>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "generator/base/nearest.h"
#include "src/cli/commands.h"
#include "src/maps/makers.h"

namespace intaglio::cli {
namespace {

using nlohmann::ordered_json;

ordered_json describe(const dsl::KnobBase& knob) {
    return {{"name", knob.name()}, {"default", knob.initial()}, {"least", knob.least()},
            {"most", knob.most()}, {"whole", knob.whole()},     {"comment", knob.comment()}};
}

template <typename Kind>
void describe_table(ordered_json& list, std::string_view part,
                    const std::vector<dsl::Entry<Kind>>& table) {
    for (const dsl::Entry<Kind>& row : table) {
        ordered_json technique = {{"part", part},
                                  {"name", row.name},
                                  {"summary", row.summary},
                                  {"source", row.source},
                                  {"knobs", ordered_json::array()}};
        const std::unique_ptr<Kind> made = row.make();
        for (const dsl::KnobBase* knob : made->knobs())
            technique["knobs"].push_back(describe(*knob));
        list.push_back(std::move(technique));
    }
}

ordered_json techniques(const dsl::Catalogue& catalogue) {
    ordered_json list = ordered_json::array();
    describe_table(list, "search", catalogue.searches);
    describe_table(list, "shadow", catalogue.shadows);
    describe_table(list, "normal", catalogue.normals);
    describe_table(list, "shading", catalogue.shadings);
    describe_table(list, "output", catalogue.outputs);
    describe_table(list, "vertex", catalogue.vertex_works);
    const auto add_shared = [&](const char* name, const char* summary,
                                const dsl::Technique& technique) {
        ordered_json row = {{"part", name},
                            {"name", name},
                            {"summary", summary},
                            {"source", ""},
                            {"knobs", ordered_json::array()}};
        for (const dsl::KnobBase* knob : technique.knobs()) row["knobs"].push_back(describe(*knob));
        list.push_back(std::move(row));
    };
    add_shared("relief", "How every technique of a surface reads the heights", dsl::ReliefKnobs());
    add_shared("lights", "By what a surface is lit", dsl::LightKnobs());
    return list;
}

std::string number(const ordered_json& value) {
    return fmt::format("{}", static_cast<float>(value.get<double>()));
}

std::string techniques_text(const dsl::Catalogue& catalogue) {
    std::string text;
    for (const ordered_json& row : techniques(catalogue))
        if (row["part"] != "relief" && row["part"] != "lights")
            text += fmt::format(
                "{:<8} {:<20} {}{}\n", row["part"].get<std::string>(),
                row["name"].get<std::string>(), row["summary"].get<std::string>(),
                row["source"] == "" ? "" : fmt::format(" ({})", row["source"].get<std::string>()));
    for (const dsl::Preset& preset : catalogue.presets)
        text += fmt::format("{:<8} {:<20} {}\n", "preset", preset.name, preset.composition);
    return text;
}

std::string knobs_text(const dsl::Catalogue& catalogue) {
    std::string text;
    for (const ordered_json& row : techniques(catalogue))
        for (const ordered_json& knob : row["knobs"])
            text += fmt::format("{:<20} {:<18} {:>5} of {} to {}  {}\n",
                                row["name"].get<std::string>(), knob["name"].get<std::string>(),
                                number(knob["default"]), number(knob["least"]),
                                number(knob["most"]), knob["comment"].get<std::string>());
    return text;
}

}  // namespace

Status list(const dsl::Catalogue& catalogue, const ListOptions& options) {
    ordered_json json = ordered_json::array();
    std::string text;
    if (options.what == "techniques" || options.what == "knobs") {
        json = techniques(catalogue);
        text = options.what == "knobs" ? knobs_text(catalogue) : techniques_text(catalogue);
    } else if (options.what == "targets") {
        for (const Target* target : all_targets()) {
            json.push_back({{"name", target->name},
                            {"description", target->description},
                            {"derived_from", target->derived_from}});
            text += fmt::format("{:<10} {}\n", target->name, target->description);
        }
    } else if (options.what == "maps") {
        for (const maps::Maker& maker : maps::makers()) {
            json.push_back({{"name", maker.name}, {"summary", maker.sentence}});
            text += fmt::format("{:<10} {}\n", maker.name, maker.sentence);
        }
    } else {
        return input_error("unknown-list",
                           unknown_name_sentence(
                               "list", options.what,
                               std::vector<std::string>{"techniques", "targets", "knobs", "maps"}));
    }
    return write_product("-", options.json ? json.dump(2) + "\n" : text, false);
}

}  // namespace intaglio::cli
