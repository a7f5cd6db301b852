// The adapters: from results.json, and from results.jsonl.
#include "src/report/page_data.h"

#include <algorithm>
#include <map>
#include <tuple>

#include <fmt/format.h>

#include "src/measure/variant_json.h"
#include "src/report/command.h"

namespace intaglio::report {
namespace {

using Json = nlohmann::ordered_json;

// A knob as a number where it is one.
Json number_or_text(const Json& value) {
    if (!value.is_string()) return value;
    const Json number = Json::parse(value.get<std::string>(), nullptr, false);
    return number.is_number() ? number : value;
}

// "intaglio emit" or "intaglio explain" with everything that names the variant.
std::string variant_command(const std::string& command, const VariantRequest& request) {
    std::string text = "intaglio " + command;
    for (const std::string& word : measure::variant_options(request))
        text += " " + shell_quoted(word);
    return text;
}

// What of a command of `intaglio run` stands for the map.
std::vector<std::string> map_arguments_in(const std::string& command) {
    const std::vector<std::string> words = shell_words(command);
    std::vector<std::string> arguments;
    for (std::size_t i = 0; i + 1 < words.size(); ++i)
        for (const char* option :
             {"--height", "--normal", "--colour", "--maker", "--map-size", "--seed"})
            if (words[i] == option) arguments.insert(arguments.end(), {words[i], words[i + 1]});
    return arguments;
}

Status add_variant(PageData& page, const Json& row) {
    Result<VariantRequest> read = measure::request_of(row);
    if (!read) return read.error();
    page.variants.push_back(std::move(*read));
    const VariantRequest& request = page.variants.back();
    Json variant = row;
    variant["technique"] = request.surface;
    for (auto& [knob, value] : variant["knobs"].items()) value = number_or_text(value);
    variant["emit_command"] = variant_command("emit", request);
    variant["explain_command"] = variant_command("explain", request);
    page.json["variants"].push_back(std::move(variant));
    return Done{};
}

int index_of_map(const PageData& page, const std::string& name) {
    const Json& maps = page.json.at("maps");
    for (std::size_t i = 0; i < maps.size(); ++i)
        if (maps[i].at("name") == name) return static_cast<int>(i);
    return -1;
}

Diagnostic not_results(const std::string& sentence, const std::string& file) {
    return input_error("not-results", sentence, file);
}

// What tells one variant of a sweep from another.
Json variant_in(const Json& line) {
    Json variant;
    for (const char* member : {"surface", "target", "knobs", "loops", "per_vertex"})
        variant[member] = line.at(member);
    for (const char* member : {"known", "scene_surface"})
        if (line.contains(member)) variant[member] = line.at(member);
    return variant;
}

std::string variant_key(const Json& line) { return variant_in(line).dump(); }

// A variant's place in the report: the scene's surface, where it is of one; its search's in the
// catalogue, then surface, knobs as numbers, target.
auto variant_order(const Json& line, const dsl::Catalogue& catalogue) {
    const std::string surface = line.at("surface");
    std::string search = surface.substr(0, surface.find(','));
    for (const dsl::Preset& preset : catalogue.presets)
        if (preset.name == search)
            search = preset.composition.substr(0, preset.composition.find(','));
    if (search.starts_with("search=")) search.erase(0, std::string("search=").size());
    std::size_t place = 0;
    while (place < catalogue.searches.size() && catalogue.searches[place].name != search) ++place;
    std::vector<double> knobs;
    for (const auto& [name, value] : line.at("knobs").items()) {
        const Json number = number_or_text(value);
        knobs.push_back(number.is_number() ? number.get<double>() : 0);
    }
    return std::tuple(line.value("scene_surface", ""), place, surface, knobs,
                      line.at("target").get<std::string>(), variant_key(line));
}

// Maps from files first: they are what people have; then by name.
auto map_order(const Json& map) {
    const Json& arguments = map.at("arguments");
    const bool procedural =
        std::find(arguments.begin(), arguments.end(), "--maker") != arguments.end();
    return std::tuple(procedural, map.at("name").get<std::string>(),
                      map.at("hash").get<std::string>());
}

// A line as a case of the page.
Json case_of_line(const Json& line, std::size_t map, std::size_t variant) {
    const Json& cost = line.at("cost");
    return {{"map", map},
            {"variant", variant},
            {"view", line.at("view")},
            {"light", line.at("light")},
            {"scale", line.at("scale")},
            {"arithmetic", line.at("arithmetic")},
            {"reads", {{"mean", cost.at("reads_mean")}, {"max", cost.at("reads_max")}}},
            {"instructions",
             {{"mean", cost.at("instructions_mean")}, {"max", cost.at("instructions_max")}}},
            {"hits", line.at("hits")},
            {"swim", line.at("swim")},
            {"picture", line.at("picture")},
            {"split", line.at("split")},
            {"command", line.at("worst").at("command")}};
}

// What made the numbers of a sweep.
Json makers_of_sweep() {
    return {{"hits",
             "texels from the exact first hit, which a reference in double precision finds cell by "
             "cell; "
             "percentiles are over the pixels without NaN"},
            {"missed", "pixels whose ray had left the relief again before the reported hit"},
            {"reads", "texture reads of search and shadow, counted while they ran"},
            {"instructions",
             "instructions of search and shadow, counted while they ran: of Direct3D 9 by our "
             "interpreter "
             "of the bytecode, else by our evaluator of the optimised intermediate representation"},
            {"spirv",
             "instructions of the shaded pixel stage, made by glslang and optimised by spirv-opt; "
             "the longest path takes every loop as often as its knob allows"},
            {"d3d9", "slots and registers of the shaded pixel stage by Direct3D's charge, exact"},
            {"picture",
             "the shaded picture against the same shading at the exact hits: FLIP (Andersson et "
             "al. 2020) "
             "and PSNR"},
            {"swim",
             "how far the hit moves, beyond the exact one, when the camera moves by 0.1 degrees"},
            {"split",
             "the same rays in double precision with exact filtering (technique), then with 8-bit "
             "filter weights (filter), then in the shader's own precision (arithmetic)"}};
}

// The lines that are results, each whole, in the report's order.
Result<std::vector<Json>> lines_of(const std::string& text, const std::string& file,
                                   const dsl::Catalogue& catalogue) {
    std::vector<Json> lines;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        Json line = Json::parse(text.begin() + static_cast<std::ptrdiff_t>(begin),
                                text.begin() + static_cast<std::ptrdiff_t>(end), nullptr, false);
        if (line.is_discarded() || !line.is_object())
            return input_error(
                "not-json",
                fmt::format("line {} is not a JSON object, or not whole", lines.size() + 1), file);
        lines.push_back(std::move(line));
        begin = end + 1;
    }
    const auto order = [&](const Json& line) {
        const auto angle = [&](const char* direction, const char* name) {
            return line.at(direction).at(name).get<double>();
        };
        return std::tuple(map_order(line.at("map")), variant_order(line, catalogue),
                          -angle("view", "elevation"), angle("view", "azimuth"),
                          -angle("light", "elevation"), angle("light", "azimuth"),
                          line.at("scale").get<double>(), line.at("arithmetic").get<std::string>());
    };
    using Order = decltype(order(lines.front()));
    std::vector<std::pair<Order, Json>> ordered;
    for (Json& line : lines) ordered.emplace_back(order(line), std::move(line));
    std::stable_sort(ordered.begin(), ordered.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    lines.clear();
    for (auto& [key, line] : ordered) lines.push_back(std::move(line));
    return lines;
}

// Every variant once, in the report's order; its index by its key.
Result<std::map<std::string, std::size_t>> add_variants(PageData& page,
                                                        const std::vector<Json>& lines,
                                                        const dsl::Catalogue& catalogue) {
    std::map<std::string, const Json*> by_key;
    for (const Json& line : lines) by_key.emplace(variant_key(line), &line);
    std::vector<const Json*> variants;
    for (const auto& [key, line] : by_key) variants.push_back(line);
    std::sort(variants.begin(), variants.end(), [&](const Json* a, const Json* b) {
        return variant_order(*a, catalogue) < variant_order(*b, catalogue);
    });
    std::map<std::string, std::size_t> indices;
    for (const Json* line : variants) {
        Json row = variant_in(*line);
        const bool refused = !line->at("refused").is_null();
        row["spirv"] = refused ? Json() : line->at("cost").at("spirv");
        row["d3d9"] = refused ? Json() : line->at("cost").at("d3d9");
        indices[variant_key(*line)] = page.variants.size();
        if (refused)
            page.json["refused"].push_back({{"variant", page.variants.size()},
                                            {"sentence", line->at("refused").at("sentence")}});
        if (Status status = add_variant(page, row); !status) return status.error();
    }
    return indices;
}

}  // namespace

std::vector<std::string> shell_words(const std::string& command) {
    std::vector<std::string> words;
    bool inside = false, quoted = false;
    for (std::size_t i = 0; i < command.size(); ++i) {
        const char c = command[i];
        if (!quoted && c == ' ') {
            inside = false;
            continue;
        }
        if (!inside) words.emplace_back();
        inside = true;
        if (c == '\'')
            quoted = !quoted;
        else if (c == '\\' && !quoted && i + 1 < command.size())
            words.back() += command[++i];
        else
            words.back() += c;
    }
    return words;
}

Result<PageData> page_data_of_measurement(const std::string& text, const std::string& file) {
    const Json source = Json::parse(text, nullptr, false);
    if (source.is_discarded())
        return input_error("not-json", "this is not JSON, or not whole", file);
    if (!source.is_object() || source.value("schema", "") != "intaglio.measurement")
        return not_results("this is not what `intaglio measure` writes: its schema is another",
                           file);
    PageData page;
    try {
        const Json& plan = source.at("plan");
        const double scale = plan.at("scale");
        page.native_filtering = plan.at("filtering") == "native";
        page.device = plan.at("device");
        page.json = {{"made_by", source.at("made_by")},
                     {"device", source.at("device")},
                     {"maps", source.at("maps")},
                     {"variants", Json::array()},
                     {"cases", Json::array()}};
        page.maps.resize(page.json["maps"].size(), {{}, scale});
        for (const Json& row : source.at("rows"))
            if (Status status = add_variant(page, row); !status)
                return not_results(status.error().message, file);
        for (Json item : source.at("cases")) {
            const int map = index_of_map(page, item.at("map"));
            const std::size_t variant = item.at("row");
            if (map < 0 || variant >= page.variants.size())
                return not_results("a case names a map or a row that is not there", file);
            item["map"] = map;
            item["variant"] = variant;
            item["scale"] = scale;
            item.erase("row");
            std::vector<std::string>& arguments =
                page.maps[static_cast<std::size_t>(map)].arguments;
            if (arguments.empty() && item.at("command").is_string())
                arguments = map_arguments_in(item.at("command"));
            page.json["cases"].push_back(std::move(item));
        }
    } catch (const Json::exception& error) {
        return not_results(fmt::format("a member is missing or of another kind: {}", error.what()),
                           file);
    }
    return page;
}

Result<PageData> page_data_of_sweep(const std::string& text, const std::string& file,
                                    const dsl::Catalogue& catalogue) {
    PageData page;
    page.json = {{"made_by", makers_of_sweep()}, {"device", ""},
                 {"maps", Json::array()},        {"variants", Json::array()},
                 {"refused", Json::array()},     {"cases", Json::array()}};
    try {
        const Result<std::vector<Json>> lines = lines_of(text, file, catalogue);
        if (!lines) return lines.error();
        const auto variants = add_variants(page, *lines, catalogue);
        if (!variants) return not_results(variants.error().message, file);
        std::map<std::string, std::size_t> maps;
        for (const Json& line : *lines) {
            Json map = line.at("map");
            const auto [place, is_new] = maps.try_emplace(map.dump(), maps.size());
            if (is_new) {
                page.maps.push_back({map.at("arguments"), line.at("scale")});
                page.json["maps"].push_back(std::move(map));
            }
            page.json["device"] = line.at("device");
            page.native_filtering = line.at("filtering") == "native";
            if (line.at("refused").is_null())
                page.json["cases"].push_back(
                    case_of_line(line, place->second, variants->at(variant_key(line))));
        }
    } catch (const Json::exception& error) {
        return not_results(fmt::format("a member is missing or of another kind: {}", error.what()),
                           file);
    }
    return page;
}

}  // namespace intaglio::report
