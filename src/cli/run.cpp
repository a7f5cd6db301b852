// `intaglio run`: one picture.
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "src/cli/commands.h"
#include "src/maps/png.h"
#include "src/measure/shot.h"
#include "src/report/picture.h"

namespace intaglio::cli {
namespace {

Status check_options(const RunOptions& options) {
    if (options.mesh != "map" && options.mesh != "quad" && options.mesh != "sphere" &&
        options.mesh != "torus")
        return input_error(
            "option-value",
            fmt::format("--mesh is map, quad, sphere or torus, not '{}'", options.mesh));
    if (!options.error_map.empty() && options.mesh != "map")
        return input_error("option-value",
                           "--error-map needs --mesh map: the reference knows flat reliefs");
    for (double elevation : {options.elevation, options.light_elevation})
        if (!(elevation >= -90 && elevation <= 90))
            return input_error(
                "option-value",
                fmt::format("an elevation is -90 to 90 degrees; {} is not", elevation));
    if (!(options.distance >= 0) || !std::isfinite(options.distance) || !(options.repeat > 0) ||
        !std::isfinite(options.repeat))
        return input_error("option-value", "--distance and --repeat are positive numbers");
    return Done{};
}

Result<measure::MeshView> mesh_view(const RunOptions& options, Size size) {
    measure::MeshView view;
    vulkan::Point target = {0, 0, 0};
    double distance = 3.4;
    const float repeat = static_cast<float>(options.repeat);
    if (options.mesh == "quad") {
        view.mesh = vulkan::quad();
        for (vulkan::Vertex& vertex : view.mesh.vertices)
            for (float& coordinate : vertex.uv) coordinate *= repeat;
        target = {0.5f, 0.5f, 0};
        distance = 1.7;
    } else if (options.mesh == "sphere") {
        view.mesh = vulkan::sphere(96, 4 * repeat, 2 * repeat);
    } else {
        view.mesh = vulkan::torus(128, 1.0f, 0.45f, 6 * repeat, 2 * repeat);
        distance = 4.2;
    }
    if (options.distance > 0) distance = options.distance;
    const auto exact = [](double elevation, double azimuth) {
        const double e = elevation * std::numbers::pi / 180, a = azimuth * std::numbers::pi / 180;
        return std::array{std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
    };
    const std::array<double, 3> to_eye = exact(options.elevation, options.azimuth);
    vulkan::Point eye{};
    for (std::size_t i = 0; i < 3; ++i)
        eye[i] = target[i] + static_cast<float>(distance * to_eye[i]);
    const std::array<double, 3> to_light = exact(options.light_elevation, options.light_azimuth);
    for (std::size_t i = 0; i < 3; ++i) view.light[i] = static_cast<float>(to_light[i]);
    vulkan::Perspective perspective;
    perspective.aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
    perspective.near_plane = static_cast<float>(distance / 100);
    perspective.far_plane = static_cast<float>(distance * 4);
    Result<vulkan::Camera> camera = vulkan::look_at(eye, target, {0, 0, 1}, perspective);
    if (!camera) return camera.error();
    view.camera = *camera;
    return view;
}

Status check_validation(const vulkan::Device& device) {
    const std::vector<std::string> messages = device.validation_messages();
    if (messages.empty()) return Done{};
    return internal_error("vulkan-validation",
                          "the Vulkan validation layer complains: " + messages.front());
}

measure::Shot shot_of(const RunOptions& options, Size size) {
    return {{options.elevation, options.azimuth},
            {options.light_elevation, options.light_azimuth},
            options.map.scale,
            size.width,
            size.height};
}

Status write_error_map(const std::vector<measure::HitError>& errors, const std::string& path,
                       Size size) {
    const measure::HitStatistics s = measure::summarize(errors, size.width);
    fmt::print(stderr,
               "hit error in texels: median {:.3g}, p95 {:.3g}, p99 {:.3g}, max {:.3g} at pixel "
               "({}, {}); missed {} of {}; NaN {}\n",
               s.median, s.p95, s.p99, s.max, s.worst_x, s.worst_y, s.missed, s.pixels, s.invalid);
    return maps::write_png(path, report::error_map(errors, size.width));
}

Result<vulkan::Picture> draw_mesh(const vulkan::Device& device, const check::Program& shaders,
                                  const measure::Textures& textures, const RunOptions& options,
                                  Size size) {
    const Result<measure::MeshView> view = mesh_view(options, size);
    if (!view) return view.error();
    Result<vulkan::Program> program = measure::prepare_mesh(
        device, shaders, textures, options.map.scale, size.width, size.height, *view);
    if (!program) return program.error();
    Result<std::vector<vulkan::Picture>> pictures = program->draw();
    if (!pictures) return pictures.error();
    return std::move(pictures->front());
}

}  // namespace

Status run(const dsl::Catalogue& catalogue, const RunOptions& options) {
    if (Status status = check_options(options); !status) return status;
    const Result<VariantRequest> request = request_of(options.variant);
    if (!request) return request.error();
    const Result<Size> size = parse_size(options.size);
    if (!size) return size.error();
    const Result<measure::Filtering> filtering = filtering_of(options.map.filtering);
    if (!filtering) return filtering.error();
    const Result<Variant> variant = make_variant(catalogue, *request);
    if (!variant) return variant.error();
    const Result<check::Program> shaders = link_variant(*variant);
    if (!shaders) return shaders.error();
    const Result<measure::MapSet> set = map_set_of(options.map);
    if (!set) return set.error();
    const Result<vulkan::Device> device =
        vulkan::Device::create({options.device, options.validation});
    if (!device) return device.error();

    const measure::Textures textures(*set, *filtering);
    const Result<vulkan::Picture> picture =
        options.mesh == "map"
            ? measure::draw_shot(*device, catalogue, *request, textures, shot_of(options, *size))
            : draw_mesh(*device, *shaders, textures, options, *size);
    if (!picture) return picture.error();
    if (!options.error_map.empty()) {
        const Result<std::vector<measure::HitError>> errors = measure::shot_errors(
            *device, catalogue, *request, *set, textures, shot_of(options, *size));
        if (!errors) return errors.error();
        if (Status status = write_error_map(*errors, options.error_map, *size); !status)
            return status;
    }
    if (Status status = check_validation(*device); !status) return status;
    return maps::write_png(options.output, report::to_image(*picture));
}

}  // namespace intaglio::cli
