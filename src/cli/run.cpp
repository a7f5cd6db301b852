// `intaglio run`: one picture.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "src/cli/commands.h"
#include "src/cli/run_case.h"
#include "src/maps/png.h"
#include "src/measure/displaced.h"
#include "src/measure/shells.h"
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
    if (options.geometry != "polygon" && options.geometry != "displaced" &&
        options.geometry != "shells")
        return input_error(
            "option-value",
            fmt::format("--geometry is polygon, displaced or shells, not '{}'", options.geometry));
    if (options.geometry != "polygon" &&
        (!options.error_map.empty() || !options.variant.split.empty()))
        return input_error("option-value",
                           "--error-map and --split are of reliefs on polygons: leave out "
                           "--geometry");
    if (options.fins && (options.geometry != "shells" || options.mesh == "map"))
        return input_error("option-value",
                           "--fins are for the silhouettes of shells: --geometry shells on a quad, "
                           "sphere or torus");
    if (!options.error_map.empty() && options.mesh != "map")
        return input_error("option-value",
                           "--error-map needs --mesh map: the reference knows flat reliefs");
    if (!(options.distance >= 0) || !std::isfinite(options.distance) || !(options.repeat > 0) ||
        !std::isfinite(options.repeat))
        return input_error("option-value", "--distance and --repeat are positive numbers");
    return Done{};
}

// What the relief lies on: how often the map is repeated over it, and the world units that a
// texture unit spans there.
struct Ground {
    float repeat_u, repeat_v;
    double span;
};

constexpr float tube = 0.45f;  // radius of the torus's

Ground ground_of(const RunOptions& options) {
    const float repeat = static_cast<float>(options.repeat);
    if (options.mesh == "map") return {1, 1, 1};
    if (options.mesh == "quad") return {repeat, repeat, 1 / options.repeat};
    if (options.mesh == "sphere")
        return {4 * repeat, 2 * repeat, std::numbers::pi / (2 * options.repeat)};
    return {6 * repeat, 2 * repeat, std::numbers::pi * tube / options.repeat};
}

// How far a parallel view of the map sees beyond its edges.
double margin_of(const RunOptions& options) {
    return measure::reach_of({options.view.elevation, options.view.azimuth}, options.map.scale) +
           0.01;
}

vulkan::Mesh smooth_mesh(const RunOptions& options) {
    const Ground ground = ground_of(options);
    if (options.mesh == "map") {
        const std::vector<double> edges = {-margin_of(options), 1 + margin_of(options)};
        return vulkan::quad({edges, edges});
    }
    if (options.mesh == "quad")
        return vulkan::quad({{0, 1}, {0, 1}}, ground.repeat_u, ground.repeat_v);
    if (options.mesh == "sphere") return vulkan::sphere(96, ground.repeat_u, ground.repeat_v);
    return vulkan::torus(128, 1.0f, tube, ground.repeat_u, ground.repeat_v);
}

Result<vulkan::Mesh> displaced_mesh(const RunOptions& options,
                                    const reference::HeightField& field) {
    if (options.mesh == "map")
        return measure::displaced_map(field, options.map.scale, options.subdivisions,
                                      margin_of(options));
    const Ground ground = ground_of(options);
    const double repeat_u = static_cast<double>(ground.repeat_u);
    const double repeat_v = static_cast<double>(ground.repeat_v);
    const Result<std::vector<double>> u =
        measure::texel_lines(0, 1, field.width, repeat_u, options.subdivisions);
    if (!u) return u.error();
    const Result<std::vector<double>> v =
        measure::texel_lines(0, 1, field.height, repeat_v, options.subdivisions);
    if (!v) return v.error();
    if (Status status = measure::check_mesh_size(u->size() * v->size()); !status)
        return status.error();
    const vulkan::GridLines lines = {*u, *v};
    const auto placed = [&] {
        if (options.mesh == "quad") return vulkan::quad(lines, ground.repeat_u, ground.repeat_v);
        if (options.mesh == "sphere")
            return vulkan::sphere(lines, ground.repeat_u, ground.repeat_v);
        return vulkan::torus(lines, 1.0f, tube, ground.repeat_u, ground.repeat_v);
    };
    return measure::displace(placed(), field, options.map.scale * ground.span);
}

Result<vulkan::Mesh> mesh_of(const RunOptions& options, const measure::MapSet& set) {
    if (options.geometry == "displaced")
        return displaced_mesh(options, set.height_field(reference::FilterWeights::Exact));
    vulkan::Mesh mesh = smooth_mesh(options);
    if (options.geometry == "polygon") return mesh;
    const double depth = options.map.scale * ground_of(options).span;
    Result<vulkan::Mesh> shells = measure::shells_of(mesh, options.layers, depth);
    if (!shells || !options.fins) return shells;
    return measure::add_fins(std::move(*shells), mesh, depth);
}

Result<measure::MeshView> mesh_view(const RunOptions& options, Size size, vulkan::Mesh mesh) {
    measure::MeshView view;
    view.mesh = std::move(mesh);
    vulkan::Point target = {0, 0, 0};
    double distance = 3.4;
    if (options.mesh == "quad") {
        target = {0.5f, 0.5f, 0};
        distance = 1.7;
    } else if (options.mesh == "torus") {
        distance = 4.2;
    }
    if (options.distance > 0) distance = options.distance;
    const auto exact = [](double elevation, double azimuth) {
        const double e = elevation * std::numbers::pi / 180, a = azimuth * std::numbers::pi / 180;
        return std::array{std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
    };
    const std::array<double, 3> to_eye = exact(options.view.elevation, options.view.azimuth);
    vulkan::Point eye{};
    for (std::size_t i = 0; i < 3; ++i)
        eye[i] = target[i] + static_cast<float>(distance * to_eye[i]);
    const std::array<double, 3> to_light =
        exact(options.view.light().elevation, options.view.light().azimuth);
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
    shot.view = {options.view.elevation, options.view.azimuth};
    shot.light = options.view.light();
    shot.look = options.view.look();
    shot.scale = options.map.scale;
    shot.width = size.width;
    shot.height = size.height;
    return shot;
}

// Draws a pass on the mesh; what it refers to must outlive it.
measure::PreparePass prepare_on_mesh(const vulkan::Device& device,
                                     const measure::Textures& textures, const RunOptions& options,
                                     const measure::MeshView& view, Size size) {
    return [&, size](const check::Program& shaders, const measure::PassLink& link) {
        return measure::prepare_mesh(device, shaders, textures, options.map.scale, size.width,
                                     size.height, view, options.view.look(), link);
    };
}

// Geometry below the whole map, in one pass; what it refers to must outlive it.
measure::PreparePass prepare_below_map(const vulkan::Device& device,
                                       const measure::Textures& textures, const measure::Shot& shot,
                                       const vulkan::Mesh& mesh) {
    return [&](const check::Program& shaders, const measure::PassLink& link) {
        return measure::prepare_parallel(device, shaders, textures, shot.scale, shot.width,
                                         shot.height, mesh, shot.view, shot.light, link, shot.look);
    };
}

// The same draws, told that they draw shells.
measure::PreparePass with_shells(measure::PreparePass prepare) {
    return [prepare](const check::Program& shaders,
                     const measure::PassLink&) -> Result<vulkan::Program> {
        Result<vulkan::Program> program = prepare(shaders, measure::shells_link());
        if (!program) return program;
        if (Status status = measure::set_shells(*program); !status) return status.error();
        return program;
    };
}

// The surface as the geometry needs it.
VariantRequest request_on(const RunOptions& options, VariantRequest request) {
    if (options.geometry == "displaced")
        request.surface = dsl::with_part(request.surface, "search", "displaced");
    if (options.geometry != "shells") return request;
    request = measure::shells_request(std::move(request), options.layers);
    return options.fins ? measure::with_fins(std::move(request)) : request;
}

// Fragments that shells cost at the pixels where they are.
Status print_overdraw(const dsl::Catalogue& catalogue, VariantRequest surface, int layers,
                      bool fins, const measure::PreparePass& prepare) {
    const Result<std::vector<check::Program>> shaders =
        measure::link_passes(catalogue, measure::shells_request(std::move(surface), layers, true));
    if (!shaders) return shaders.error();
    Result<vulkan::Program> program = prepare(shaders->front(), {});
    if (!program) return program.error();
    const Result<std::vector<int>> fragments = measure::count_overdraw(*program, layers);
    if (!fragments) return fragments.error();
    std::int64_t sum = 0, covered = 0, most = 0;
    for (const int count : *fragments) {
        sum += count;
        covered += count > 0 ? 1 : 0;
        most = std::max<std::int64_t>(most, count);
    }
    fmt::print(stderr, "{} shells: {:.3g} fragments a pixel, at most {}, over {} of {} pixels{}\n",
               layers,
               static_cast<double>(sum) / static_cast<double>(std::max<std::int64_t>(covered, 1)),
               most, covered, fragments->size(), fins ? ", not counting fins" : "");
    return Done{};
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

Status run(const dsl::Catalogue& techniques, const RunOptions& options) {
    if (Status status = check_options(options); !status) return status;
    Result<VariantRequest> request = request_of(options.variant);
    if (!request) return request.error();
    if (Status status = check_view(options.view, *request); !status) return status;
    if (is_case(options)) return run_case(techniques, options);
    const bool polygon = options.geometry == "polygon";
    const dsl::Catalogue catalogue = polygon ? techniques : measure::with_geometry(techniques);
    request = request_on(options, std::move(*request));
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
        vulkan::Device::create({options.view.device, options.validation});
    if (!device) return device.error();

    const measure::Textures textures(*set, *filtering);
    measure::Shot shot = shot_of(options, *size);
    shot.format = *format;
    const bool flat = options.mesh == "map";
    if (flat && !polygon && !(options.view.elevation > 0))
        return input_error("option-value",
                           "--geometry below a map is seen from above: "
                           "--elevation above 0");
    Result<vulkan::Mesh> mesh = flat && polygon ? vulkan::Mesh{} : mesh_of(options, *set);
    if (!mesh) return mesh.error();
    const Result<measure::MeshView> view = flat ? measure::MeshView{std::move(*mesh), {}, {}}
                                                : mesh_view(options, *size, std::move(*mesh));
    if (!view) return view.error();
    // 76 degrees from straight down, per axis; flatter rays are clamped by the unorm formats.
    constexpr double mesh_slope = 4;
    shot.range = options.passes.range > 0 ? options.passes.range
                 : flat                   ? measure::shot_range(shot)
                                          : mesh_slope * std::max(options.map.scale, 1e-3);
    const measure::OffsetCode code = measure::offset_code(shot.format, shot.range);
    measure::PreparePass prepare = !flat ? prepare_on_mesh(*device, textures, options, *view, *size)
                                   : polygon
                                       ? measure::prepare_shot(*device, textures, shot)
                                       : prepare_below_map(*device, textures, shot, view->mesh);
    if (options.geometry == "shells") prepare = with_shells(prepare);
    const Result<vulkan::Picture> picture = measure::draw_passes(*passes, code, prepare);
    if (!picture) return picture.error();
    if (options.geometry == "shells")
        if (Status status = print_overdraw(catalogue, *request_of(options.variant), options.layers,
                                           options.fins, prepare);
            !status)
            return status;
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
        if (Status status = write_error_map(*errors, options.error_map, size->width); !status)
            return status;
    }
    if (Status status = textures.baked->check_all_read(); !status) return status;
    if (Status status = check_validation(*device); !status) return status;
    return maps::write_png(options.output, report::to_image(*picture));
}

}  // namespace intaglio::cli
