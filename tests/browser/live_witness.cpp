// Writes a live page, and beside it what lavapipe draws of its variants: live.html, cases.json, and
// for each case the names of two files of raw RGB, its search's picture and the exact one.
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <numbers>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "src/measure/render.h"
#include "src/report/live.h"
#include "src/report/picture.h"
#include "templates/all_techniques.h"

namespace intaglio {
namespace {

using report::LiveVariant;

// What of the page's state a case has otherwise than `usual`.
struct Case {
    std::string technique = "parallax_occlusion", steps = "", shadow = "none", map = "bricks",
                shape = "quad";
    double elevation = 35, azimuth = 250, zoom = 0.7, light_elevation = 40, light_azimuth = 20,
           depth = 0.08;
};

nlohmann::json state_of(const Case& c, const std::string& steps) {
    return {{"technique", c.technique},
            {"steps", steps},
            {"shadow", c.shadow},
            {"map", c.map},
            {"shape", c.shape},
            {"elevation", c.elevation},
            {"azimuth", c.azimuth},
            {"zoom", c.zoom},
            {"lightElevation", c.light_elevation},
            {"lightAzimuth", c.light_azimuth},
            {"depth", c.depth}};
}

// Every search as it is by default, and every other control of the page at least twice.
std::vector<Case> cases_of(const std::vector<LiveVariant>& variants) {
    std::vector<Case> cases;
    for (const LiveVariant& variant : variants) {
        if (variant.search == "reference") continue;
        if (cases.empty() || cases.back().technique != variant.search)
            cases.push_back({.technique = variant.search});
    }
    cases.push_back({.technique = "parallax_occlusion", .steps = "32", .depth = 0.2});
    cases.push_back({.technique = "relief", .shadow = "march", .map = "cobbles"});
    cases.push_back({.shadow = "soft", .shape = "torus", .zoom = 1, .light_azimuth = 200});
    cases.push_back({.technique = "cone", .map = "cobbles", .shape = "torus", .elevation = 80});
    cases.push_back({.technique = "max_mip", .shape = "torus", .elevation = 10, .azimuth = 0});
    cases.push_back({.technique = "steep_parallax", .shadow = "march", .elevation = 90});
    return cases;
}

constexpr int size = 128;

// Colours as the page's textures hold them, filtered by lavapipe in float32 as by SwiftShader.
measure::Textures textures_of(const measure::MapSet& set) {
    measure::Textures textures(set, measure::Filtering::Float);
    for (float& value : textures.colour.levels[0]) value = std::round(value * 255) / 255;
    textures.colour.format = vulkan::Texture::Format::Rgba32Float;
    return textures;
}

vulkan::Point toward(double elevation, double azimuth, double length) {
    const double e = elevation * std::numbers::pi / 180, a = azimuth * std::numbers::pi / 180;
    return {static_cast<float>(length * std::cos(e) * std::cos(a)),
            static_cast<float>(length * std::cos(e) * std::sin(a)),
            static_cast<float>(length * std::sin(e))};
}

Result<measure::MeshView> view_of(const Case& c) {
    const bool quad = c.shape == "quad";
    measure::MeshView view;
    view.mesh = quad ? vulkan::quad() : vulkan::torus(128, 1.0f, 0.45f, 6, 2);
    view.light = toward(c.light_elevation, c.light_azimuth, 1);
    const double distance = (quad ? 1.7 : 4.2) * c.zoom;
    const vulkan::Point target = quad ? vulkan::Point{0.5f, 0.5f, 0} : vulkan::Point{0, 0, 0};
    vulkan::Point eye = toward(c.elevation, c.azimuth, distance);
    for (std::size_t i = 0; i < 3; ++i) eye[i] += target[i];
    vulkan::Perspective perspective;
    perspective.near_plane = static_cast<float>(distance / 100);
    perspective.far_plane = static_cast<float>(distance * 4);
    const Result<vulkan::Camera> camera = vulkan::look_at(eye, target, {0, 0, 1}, perspective);
    if (!camera) return camera.error();
    view.camera = *camera;
    return view;
}

const LiveVariant* variant_of(const std::vector<LiveVariant>& variants, const std::string& search,
                              const Case& c) {
    // Without a value, the second of the steps, which is the default; or the only one there is.
    const LiveVariant* found = nullptr;
    std::vector<std::string> seen;
    for (const LiveVariant& variant : variants) {
        if (variant.search != search || variant.shadow != c.shadow) continue;
        seen.push_back(variant.steps);
        if (search == "reference" || c.steps.empty() ? seen.size() <= 2 : variant.steps == c.steps)
            found = &variant;
    }
    return found;
}

class Witness {
  public:
    Witness(vulkan::Device device, std::string folder)
        : device_(std::move(device)), folder_(std::move(folder)) {}

    Status write_page() {
        options_.side = 64;
        options_.left_out.clear();
        for (const auto& [name, side] : {std::pair{"bricks", 64}, std::pair{"cobbles", 128}}) {
            Result<measure::MapSet> set = measure::make_map_set(name, side, side, 0.08);
            if (!set) return set.error();
            textures_.emplace(name, textures_of(report::live_map(*set, options_.side)));
            options_.maps.push_back({std::move(*set), {"--maker", name}});
        }
        Result<std::vector<LiveVariant>> variants = report::live_variants(catalogue_, options_);
        if (!variants) return variants.error();
        variants_ = std::move(*variants);
        const Result<std::string> section = report::live_section(catalogue_, options_);
        if (!section) return section.error();
        std::ofstream(folder_ + "/live.html") << report::live_page(*section);
        return Done{};
    }

    Status write_cases() {
        nlohmann::json json = nlohmann::json::array();
        for (const Case& c : cases_of(variants_)) {
            const LiveVariant* technique = variant_of(variants_, c.technique, c);
            const LiveVariant* exact = variant_of(variants_, "reference", c);
            if (!technique || !exact)
                return internal_error("no-variant", "the page lacks " + c.technique);
            nlohmann::json row = {{"state", state_of(c, technique->steps)}, {"size", size}};
            for (const auto& [name, variant] :
                 {std::pair{"technique", technique}, std::pair{"exact", exact}}) {
                // Cases that differ in the search have one exact picture.
                nlohmann::json same = state_of(c, variant->steps);
                same["technique"] = variant->search;
                const auto [file, is_new] =
                    files_.emplace(same.dump(), fmt::format("{}_{}.rgb", json.size(), name));
                row[name] = file->second;
                if (!is_new) continue;
                if (Status status = draw(c, *variant, file->second); !status) return status;
            }
            json.push_back(std::move(row));
        }
        std::ofstream(folder_ + "/cases.json") << json.dump(1);
        return Done{};
    }

  private:
    Status draw(const Case& c, const LiveVariant& wanted, const std::string& file) {
        const Result<Variant> variant = make_variant(catalogue_, wanted.request);
        if (!variant) return variant.error();
        const Result<check::Program> shaders = link_variant(*variant);
        if (!shaders) return shaders.error();
        const Result<measure::MeshView> view = view_of(c);
        if (!view) return view.error();
        Result<vulkan::Program> program = measure::prepare_mesh(
            device_, *shaders, textures_.at(c.map), c.depth, size, size, *view);
        if (!program) return program.error();
        const Result<std::vector<vulkan::Picture>> pictures = program->draw();
        if (!pictures) return pictures.error();
        std::ofstream out(folder_ + "/" + file, std::ios::binary);
        for (const float value : report::to_image(pictures->front()).texels)
            out.put(static_cast<char>(std::lround(value * 255)));
        return Done{};
    }

    const dsl::Catalogue catalogue_ = templates::all_techniques();
    vulkan::Device device_;
    std::string folder_;
    report::LiveOptions options_;
    std::vector<LiveVariant> variants_;
    std::map<std::string, measure::Textures> textures_;
    std::map<std::string, std::string> files_;  // of pictures, by all that they show
};

Status write_all(const std::string& folder) {
    Result<vulkan::Device> device = vulkan::Device::create();
    if (!device) return device.error();
    Witness witness(std::move(*device), folder);
    if (Status status = witness.write_page(); !status) return status;
    return witness.write_cases();
}

}  // namespace
}  // namespace intaglio

int main(int argc, char** argv) {
    if (argc != 2) {
        fmt::print(stderr, "usage: live_witness FOLDER\n");
        return 2;
    }
    const intaglio::Status status = intaglio::write_all(argv[1]);
    if (!status) fmt::print(stderr, "{}\n", to_string(status.error()));
    return status ? 0 : 3;
}
