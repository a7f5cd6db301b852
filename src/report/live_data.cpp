// Programs as lists of lines, maps as PNGs in base64.
#include "src/report/live_data.h"

#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "src/maps/png.h"
#include "src/measure/render.h"
#include "src/report/base64.h"
#include "src/report/command.h"
#include "src/report/picture.h"

namespace intaglio::report {
namespace {

using Json = nlohmann::ordered_json;

// Texts as numbers of lines, each line kept once.
class Lines {
  public:
    Json numbers_of(const std::string& text) {
        Json numbers = Json::array();
        for (std::size_t start = 0; start < text.size();) {
            const std::size_t end = std::min(text.find('\n', start), text.size());
            const std::string line = text.substr(start, end - start);
            const auto [known, is_new] = numbers_.emplace(line, lines_.size());
            if (is_new) lines_.push_back(line);
            numbers.push_back(known->second);
            start = end + 1;
        }
        return numbers;
    }
    const std::vector<std::string>& all() const { return lines_; }

  private:
    std::vector<std::string> lines_;
    std::map<std::string, std::size_t> numbers_;
};

// The samplers that the programs read, and what the page must know of each.
using Samplers = std::map<std::string, ir::Sampler>;

Json command_of(const VariantRequest& request, const char* verb) {
    std::string text =
        fmt::format("intaglio {} {} -T {}", verb, shell_quoted(request.surface), request.target);
    for (const auto& [name, value] : request.knobs) text += fmt::format(" -D {}={}", name, value);
    return text;
}

Result<Json> program_of(const dsl::Catalogue& catalogue, const LiveVariant& wanted, Lines& lines,
                        Samplers& samplers) {
    const Result<Variant> variant = make_variant(catalogue, wanted.request);
    if (!variant) return variant.error();
    for (const ir::Module* module : {&variant->program.vertex, &variant->program.pixel})
        for (const ir::Sampler& sampler : module->samplers) samplers[sampler.name] = sampler;
    return Json{{"vertex", lines.numbers_of(variant->vertex.text)},
                {"pixel", lines.numbers_of(variant->pixel.text)},
                {"emit", command_of(wanted.request, "emit")},
                {"run", command_of(wanted.request, "run")}};
}

// An image with no more channels than it needs.
maps::Image image_of(const vulkan::Texture& texture, std::size_t level) {
    const std::vector<float>& texels = texture.levels[level];
    bool gray = true, opaque = true;
    for (std::size_t i = 0; i < texels.size(); i += 4) {
        gray = gray && texels[i] == texels[i + 1] && texels[i] == texels[i + 2];
        opaque = opaque && texels[i + 3] == 1;
    }
    const int colours = gray ? 1 : 3, channels = colours + (opaque ? 0 : 1);
    const int width = std::max(texture.width >> level, 1);
    maps::Image image =
        maps::blank_image(width, static_cast<int>(texels.size()) / 4 / width, channels, 8);
    for (std::size_t i = 0, out = 0; i < texels.size(); i += 4) {
        for (std::size_t c = 0; c < static_cast<std::size_t>(colours); ++c)
            image.texels[out++] = texels[i + c];
        if (!opaque) image.texels[out++] = texels[i + 3];
    }
    return image;
}

// `levels`: how many are given; what is left out the page makes, from the first one.
Result<Json> texture_json(const vulkan::Texture& texture, std::size_t levels) {
    Json pngs = Json::array();
    for (std::size_t level = 0; level < levels; ++level) {
        const Result<std::vector<unsigned char>> png = maps::encode_png(image_of(texture, level));
        if (!png) return png.error();
        pngs.push_back(base64(*png));
    }
    return Json{{"width", texture.width},
                {"height", texture.height},
                {"depth", texture.depth},
                {"mipmaps", levels < texture.levels.size()},
                {"levels", std::move(pngs)}};
}

Result<Json> map_json(const LiveMap& map, const LiveOptions& options, const Samplers& samplers) {
    const measure::MapSet set = live_map(map.set, options.side);
    measure::BakedMaps baked(set, measure::Filtering::Native);
    Json textures = Json::object();
    for (const auto& [name, sampler] : samplers) {
        Result<Json> texture = Json{};
        if (name == "height_map") {
            texture = texture_json(measure::height_texture(set, measure::Filtering::Native), 1);
        } else if (name == "normal_map") {
            texture = texture_json(measure::normal_texture(set, measure::Filtering::Native), 1);
        } else if (name == "colour_map") {
            texture = texture_json(measure::colour_texture(set), 1);
        } else {
            const Result<const vulkan::Texture*> found = baked.texture(name, sampler.baked);
            if (!found) return found.error();
            if (*found == nullptr)
                return input_error("live-maps",
                                   fmt::format("nobody bakes a map for the sampler {}", name));
            texture = texture_json(**found, (*found)->levels.size());
        }
        if (!texture) return texture.error();
        (*texture)["nearest"] = sampler.filter == ir::Sampler::Filter::Nearest;
        textures[name] = std::move(*texture);
    }
    std::string arguments;
    for (const std::string& argument : map.run_arguments) arguments += " " + shell_quoted(argument);
    return Json{{"name", set.name},
                {"width", set.heights.width},
                {"height", set.heights.height},
                {"run", arguments},
                {"textures", std::move(textures)}};
}

// What the page has otherwise than `intaglio run`.
std::string note_of(const std::string& search) {
    if (search != "view_dependent") return {};
    return fmt::format("; here the volume has {0} x {0} texels, elsewhere 128 x 128",
                       live_view_side);
}

// Name, summary and knob of each search; `absent` where it has no variant.
Json techniques_json(const dsl::Catalogue& catalogue, const std::vector<LiveVariant>& variants) {
    Json techniques = Json::array();
    for (const dsl::Entry<dsl::Search>& entry : catalogue.searches) {
        Json values = Json::array();
        std::string knob, comment;
        double initial = 0;
        for (const LiveVariant& variant : variants) {
            if (variant.search != entry.name) continue;
            if (values.empty() || values.back() != variant.steps) values.push_back(variant.steps);
            if (!variant.request.knobs.empty()) knob = variant.request.knobs.front().first;
        }
        if (values.empty()) {
            techniques.push_back({{"name", entry.name}, {"absent", true}});
            continue;
        }
        const std::unique_ptr<dsl::Search> search = entry.make();
        for (const dsl::KnobBase* candidate : search->knobs())
            if (candidate->name() == knob) {
                comment = candidate->comment();
                initial = candidate->initial();
            }
        techniques.push_back({{"name", entry.name},
                              {"summary", entry.summary + note_of(entry.name)},
                              {"knob", knob},
                              {"comment", comment},
                              {"initial", knob.empty() ? "" : fmt::format("{:g}", initial)},
                              {"values", std::move(values)}});
    }
    return techniques;
}

Json shadows_json(const dsl::Catalogue& catalogue, const LiveOptions& options) {
    Json shadows = Json::array();
    for (const std::string& name : options.shadows)
        for (const dsl::Entry<dsl::Shadow>& entry : catalogue.shadows)
            if (entry.name == name) shadows.push_back({{"name", name}, {"summary", entry.summary}});
    return shadows;
}

// The colours of the error maps from end to end, equally spaced.
Json ramp_json() {
    Json ramp = Json::array();
    constexpr int steps = 16;
    for (int i = 0; i <= steps; ++i) {
        const float place = static_cast<float>(i) / steps;
        ramp.push_back(error_colour(least_error * std::pow(most_error / least_error, place)));
    }
    return ramp;
}

std::string key_of(const LiveVariant& variant) {
    return variant.search + "|" + variant.steps + "|" + variant.shadow;
}

}  // namespace

Result<std::string> live_data(const dsl::Catalogue& catalogue, const LiveOptions& options) {
    if (options.maps.empty())
        return input_error("live-maps", "the live part of a report needs at least one map");
    const Result<std::vector<LiveVariant>> variants = live_variants(catalogue, options);
    if (!variants) return variants.error();
    Lines lines;
    Samplers samplers;
    Json programs = Json::object();
    for (const LiveVariant& variant : *variants) {
        Result<Json> program = program_of(catalogue, variant, lines, samplers);
        if (!program && is_refusal(program.error()) && variant.search != "reference") continue;
        if (!program) return program.error();
        programs[key_of(variant)] = std::move(*program);
    }
    Json maps = Json::array();
    for (const LiveMap& map : options.maps) {
        Result<Json> json = map_json(map, options, samplers);
        if (!json) return json.error();
        maps.push_back(std::move(*json));
    }
    auto values = measure::uniforms_of({}, {}, options.scale, 1, 1, options.look);
    // The page's surfaces have one light.
    for (int number = 1; number < dsl::most_lights; ++number)
        for (const char* name : {"light", "light_colour"})
            values.erase(dsl::name_of_light(name, number));
    Json uniforms = Json::object();
    for (const auto& [name, value] : values) uniforms[name] = value;
    Json all = Json::object();
    all["techniques"] = techniques_json(catalogue, *variants);
    all["shadows"] = shadows_json(catalogue, options);
    all["scale"] = options.scale;
    all["background"] = measure::mesh_background;
    all["uniforms"] = std::move(uniforms);
    all["ramp"] = ramp_json();
    all["lines"] = lines.all();
    all["programs"] = std::move(programs);
    all["maps"] = std::move(maps);
    const std::string text = all.dump();
    // Inside a script element nothing may look like markup.
    std::string safe;
    for (const char c : text) c == '<' ? safe += "\\u003c" : safe += c;
    return safe;
}

}  // namespace intaglio::report
