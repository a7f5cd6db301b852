// `intaglio run`: one picture.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "src/cli/commands.h"
#include "src/maps/png.h"
#include "src/measure/split.h"
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
    measure::Shot shot;
    shot.view = {options.elevation, options.azimuth};
    shot.light = {options.light_elevation, options.light_azimuth};
    shot.scale = options.map.scale;
    shot.width = size.width;
    shot.height = size.height;
    return shot;
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

// Draws a pass on the mesh; what it refers to must outlive it.
measure::PreparePass prepare_on_mesh(const vulkan::Device& device,
                                     const measure::Textures& textures, const RunOptions& options,
                                     const measure::MeshView& view, Size size) {
    return [&, size](const check::Program& shaders, const measure::PassLink& link) {
        return measure::prepare_mesh(device, shaders, textures, options.map.scale, size.width,
                                     size.height, view, {}, link);
    };
}

// What the format of the picture between the passes changed.
Status print_format_error(const dsl::Catalogue& catalogue, const measure::SplitDraw& draw,
                          const measure::OffsetCode& code, const std::string& format) {
    const Result<std::vector<measure::FormatError>> errors =
        measure::compare_formats(catalogue, draw, {code.format});
    if (!errors) return errors.error();
    const measure::FormatError& error = errors->front();
    fmt::print(stderr,
               "{} between {} passes moves hits by median {:.2g}, p99 {:.2g}, max {:.2g} texels "
               "(bound {:.2g}; {} of {} pixels above it); colours by at most {:.2g}, rms {:.2g}\n",
               format, dsl::pass_count(draw.request.split), error.median, error.p99, error.max,
               error.bound, error.beyond, error.pixels, error.colour_max, error.colour_rms);
    return Done{};
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
    const Result<vulkan::Texture::Format> format = measure::format_named(options.passes.format);
    if (!format) return format.error();
    const Result<std::vector<check::Program>> passes = measure::link_passes(catalogue, *request);
    if (!passes) return passes.error();
    const Result<measure::MapSet> set = map_set_of(options.map);
    if (!set) return set.error();
    const Result<vulkan::Device> device =
        vulkan::Device::create({options.device, options.validation});
    if (!device) return device.error();

    const measure::Textures textures(*set, *filtering);
    measure::Shot shot = shot_of(options, *size);
    shot.format = *format;
    const bool flat = options.mesh == "map";
    const Result<measure::MeshView> view = flat ? measure::MeshView{} : mesh_view(options, *size);
    if (!view) return view.error();
    // 76 degrees from straight down, per axis; flatter rays are clamped by the unorm formats.
    constexpr double mesh_slope = 4;
    shot.range = options.passes.range > 0 ? options.passes.range
                 : flat                   ? measure::shot_range(shot)
                                          : mesh_slope * std::max(options.map.scale, 1e-3);
    const measure::OffsetCode code = measure::offset_code(shot.format, shot.range);
    const measure::PreparePass prepare =
        flat ? measure::prepare_shot(*device, textures, shot)
             : prepare_on_mesh(*device, textures, options, *view, *size);
    const Result<vulkan::Picture> picture = measure::draw_passes(*passes, code, prepare);
    if (!picture) return picture.error();
    if (passes->size() > 1) {
        const measure::SplitDraw draw{
            *request,
            code.range,
            textures.height.width,
            textures.height.height,
            prepare,
            flat ? std::nullopt : std::optional(measure::mesh_background)};
        if (Status status = print_format_error(catalogue, draw, code, options.passes.format);
            !status)
            return status;
    }
    if (!options.error_map.empty()) {
        const Result<std::vector<measure::HitError>> errors =
            measure::shot_errors(*device, catalogue, *request, *set, textures, shot);
        if (!errors) return errors.error();
        if (Status status = write_error_map(*errors, options.error_map, *size); !status)
            return status;
    }
    if (Status status = check_validation(*device); !status) return status;
    return maps::write_png(options.output, report::to_image(*picture));
}

}  // namespace intaglio::cli
