// What the gallery shows, drawn again from the data's own variants, maps and views.
#include "src/report/gallery.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "src/maps/png.h"
#include "src/measure/command.h"
#include "src/measure/hits.h"
#include "src/measure/hits_request.h"
#include "src/measure/render.h"
#include "src/measure/shot.h"
#include "src/measure/variant_json.h"
#include "src/report/base64.h"
#include "src/report/picture.h"

namespace intaglio::report {
namespace {

using Json = nlohmann::ordered_json;
using measure::Direction;

constexpr unsigned char missed_byte = 254, invalid_byte = 255, last_byte = 253;

Result<Json> data_url(const maps::Image& image) {
    const Result<std::vector<unsigned char>> png = maps::encode_png(image);
    if (!png) return png.error();
    return Json("data:image/png;base64," + base64(*png));
}

unsigned char error_byte(const measure::HitError& error) {
    if (error.invalid) return invalid_byte;
    if (error.missed) return missed_byte;
    if (!(error.texels > least_error)) return 0;
    const float place = std::log(error.texels / least_error) / std::log(most_error / least_error);
    return static_cast<unsigned char>(std::lround(std::min(place, 1.0f) * last_byte));
}

// One channel of a value in 0 to 255 for each pixel.
template <typename ByteOf>
Result<Json> byte_picture(int size, ByteOf byte_of) {
    maps::Image image = maps::blank_image(size, size, 1, 8);
    for (std::size_t i = 0; i < image.texels.size(); ++i)
        image.texels[i] = static_cast<float>(byte_of(i)) / 255.0f;
    return data_url(image);
}

// The same surface with the exact search, whatever the search was: two surfaces that differ in
// nothing else are one.
std::string exact_surface(const dsl::Catalogue& catalogue, const std::string& surface) {
    std::vector<std::string> items;
    std::string rest = surface;
    for (const dsl::Preset& preset : catalogue.presets)
        if (rest.substr(0, rest.find(',')) == preset.name)
            rest = preset.composition + rest.substr(preset.name.size());
    std::string exact = "search=exact";
    for (std::size_t begin = 0; begin <= rest.size();) {
        const std::size_t end = std::min(rest.find(',', begin), rest.size());
        const std::string item = rest.substr(begin, end - begin);
        if (item.find('=') != std::string::npos && !item.starts_with("search="))
            exact += "," + item;
        begin = end + 1;
    }
    return exact;
}

// How many lights there are, and how many of them throw shadows: those are no choice of the search.
std::vector<std::pair<std::string, std::string>> light_knobs(const VariantRequest& request) {
    std::vector<std::pair<std::string, std::string>> knobs;
    dsl::LightKnobs lights;
    const std::vector<dsl::KnobBase*> known = lights.knobs();
    for (const auto& knob : request.knobs)
        if (std::any_of(known.begin(), known.end(),
                        [&](const dsl::KnobBase* light) { return light->name() == knob.first; }))
            knobs.push_back(knob);
    return knobs;
}

// Draws everything on one map from one view.
class Painter {
  public:
    Painter(const vulkan::Device& device, const dsl::Catalogue& catalogue,
            const measure::MapSet& set, const measure::Shot& shot, measure::Filtering filtering)
        : device_(device),
          catalogue_(catalogue),
          shot_(shot),
          textures_(set, filtering),
          field_(set.height_field(reference::FilterWeights::Exact)),
          exact_(measure::trace_exact(field_, shot.view, shot.light, static_cast<float>(shot.scale),
                                      shot.width, shot.height)) {}

    Result<Json> render(const VariantRequest& request) const {
        const Result<vulkan::Picture> picture =
            measure::draw_shot(device_, catalogue_, request, textures_, shot_);
        if (!picture) return picture.error();
        return data_url(to_image(*picture));
    }

    // The render of the exact search, each surface's once; its place in `exact`.
    Result<std::size_t> exact_render(const VariantRequest& request, Json& exact) {
        VariantRequest wanted;
        wanted.surface = exact_surface(catalogue_, request.surface);
        wanted.knobs = light_knobs(request);
        wanted.knobs.emplace_back("max_cells", "4096");
        const std::string name = measure::text_of(wanted);  // on whatever target
        wanted.target = request.target;
        const auto known = exact_places_.find(name);
        if (known != exact_places_.end()) return known->second;
        const Result<Json> picture = render(wanted);
        if (!picture) return picture.error();
        exact.push_back(*picture);
        return exact_places_[name] = exact.size() - 1;
    }

    // `error`, `reads`, `reads_step` and `reads_max` of an entry.
    Status add_maps(const VariantRequest& request, Json& entry) const {
        VariantRequest instrumented = measure::hits_request(catalogue_, request);
        instrumented.count_reads = true;
        const Result<Variant> variant = make_variant(catalogue_, instrumented);
        if (!variant) return variant.error();
        const Result<check::Program> shaders = link_variant(*variant);
        if (!shaders) return shaders.error();
        Result<vulkan::Program> program = measure::prepare_quad(
            device_, *shaders, textures_, shot_.scale, shot_.width, shot_.height);
        if (!program) return program.error();
        if (Status status = measure::aim(*program, shot_.view, shot_.light); !status) return status;
        const Result<std::vector<vulkan::Picture>> pictures = program->draw();
        if (!pictures) return pictures.error();
        const std::vector<measure::HitError> errors = measure::compare_hits(
            (*pictures)[0], exact_, field_, shot_.view, static_cast<float>(shot_.scale));
        const Result<Json> error =
            byte_picture(shot_.width, [&](std::size_t i) { return error_byte(errors[i]); });
        if (!error) return error.error();
        const vulkan::Picture& reads = (*pictures)[1];
        int most = 0;
        for (const std::array<float, 4>& pixel : reads.pixels)
            most = std::max(most, static_cast<int>(pixel[0]));
        const int step = most / 256 + 1;
        const Result<Json> counts = byte_picture(shot_.width, [&](std::size_t i) {
            return static_cast<int>(reads.pixels[i][0]) / step;
        });
        if (!counts) return counts.error();
        entry["error"] = *error;
        entry["reads"] = *counts;
        entry["reads_step"] = step;
        entry["reads_max"] = most;
        return Done{};
    }

  private:
    const vulkan::Device& device_;
    const dsl::Catalogue& catalogue_;
    measure::Shot shot_;
    measure::Textures textures_;
    reference::HeightField field_;
    measure::ExactPicture exact_;
    std::map<std::string, std::size_t> exact_places_;
};

// The variants with pictures on a map: of those with a case on it, of each technique the one in the
// middle, in the data's order; all that a plan chose, which are one for each target.
std::vector<std::size_t> chosen_variants(const PageData& page, std::size_t map) {
    std::vector<std::string> techniques;
    std::map<std::string, std::vector<std::size_t>> by_technique;
    for (std::size_t i : drawn_variants(page, map)) {
        const bool is_planned = page.json.at("variants")[i].contains("scene_surface");
        const std::string technique =
            is_planned ? page.variants[i].target : page.variants[i].surface;
        if (!by_technique.contains(technique)) techniques.push_back(technique);
        by_technique[technique].push_back(i);
    }
    std::vector<std::size_t> chosen;
    for (const std::string& technique : techniques) {
        const std::vector<std::size_t>& own = by_technique[technique];
        chosen.push_back(own[(own.size() - 1) / 2]);
    }
    return chosen;
}

Direction direction_in(const Json& json) { return {json.at("elevation"), json.at("azimuth")}; }

// The case whose view the gallery has: the one nearest to 30 degrees, the first of its kind.
const Json* case_to_show(const PageData& page, std::size_t map) {
    const Json* best = nullptr;
    const auto distance = [](const Json& item) {
        return std::abs(item.at("view").at("elevation").get<double>() - 30);
    };
    for (const Json& item : page.json.at("cases"))
        if (item.at("map") == map && (best == nullptr || distance(item) < distance(*best)))
            best = &item;
    return best;
}

}  // namespace

std::optional<measure::Shot> shown_shot(const PageData& page, std::size_t map) {
    const Json* item = case_to_show(page, map);
    if (item == nullptr) return {};
    return measure::Shot{direction_in(item->at("view")), direction_in(item->at("light")),
                         item->at("scale"), 192, 192};
}

std::vector<std::size_t> drawn_variants(const PageData& page, std::size_t map) {
    std::set<std::size_t> with_case;
    for (const Json& item : page.json.at("cases"))
        if (item.at("map") == map) with_case.insert(item.at("variant").get<std::size_t>());
    std::vector<std::size_t> drawn;
    for (std::size_t variant : with_case) {
        const Target* target = find_target(page.variants[variant].target);
        if (target != nullptr && !profile_of(*target)) drawn.push_back(variant);
    }
    return drawn;
}

Status add_gallery(PageData& page, const dsl::Catalogue& catalogue,
                   const std::vector<measure::MapSet>& maps, const GalleryOptions& options) {
    const Result<vulkan::Device> device = vulkan::Device::create({page.device, false});
    if (!device) return device.error();
    Json entries = Json::array(), exact = Json::array();
    const measure::Filtering filtering =
        page.native_filtering ? measure::Filtering::Native : measure::Filtering::Float;
    for (std::size_t map = 0; map < maps.size(); ++map) {
        std::optional<measure::Shot> shot = shown_shot(page, map);
        if (!shot || maps[map].heights.texels.empty()) continue;
        shot->width = shot->height = options.size;
        const Json view = json_of(shot->view), light = json_of(shot->light);
        Painter painter(*device, catalogue, maps[map], *shot, filtering);
        for (std::size_t variant : chosen_variants(page, map)) {
            const VariantRequest& request = page.variants[variant];
            Json entry = {{"map", map}, {"variant", variant}, {"view", view}, {"light", light}};
            const Result<Json> render = painter.render(request);
            if (!render) return render.error();
            entry["render"] = *render;
            const Result<std::size_t> place = painter.exact_render(request, exact);
            if (!place) return place.error();
            entry["exact"] = *place;
            if (Status status = painter.add_maps(request, entry); !status) return status;
            entries.push_back(std::move(entry));
        }
    }
    page.json["gallery"] = {{"size", options.size},
                            {"least_error", least_error},
                            {"most_error", most_error},
                            {"entries", std::move(entries)},
                            {"exact", std::move(exact)}};
    return Done{};
}

}  // namespace intaglio::report
