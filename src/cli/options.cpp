// Options that several commands share, and how products are written.
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#include "src/cli/commands.h"
#include "src/maps/files.h"
#include "src/variant/known_text.h"

namespace intaglio::cli {

Result<VariantRequest> request_of(const VariantOptions& options) {
    VariantRequest request;
    request.surface = options.surface;
    request.target = options.target;
    request.per_vertex = options.per_vertex;
    if (!options.split.empty()) {
        const Result<dsl::Split> split = dsl::parse_split(options.split);
        if (!split) return split.error();
        request.split = *split;
    } else if (options.pass != 0) {
        return input_error("option-value", "--pass needs --split: there is one pass without");
    }
    request.pass = options.pass;
    for (const std::string& knob : options.knobs) {
        const std::size_t equals = knob.find('=');
        if (equals == std::string::npos)
            return input_error("knob-syntax",
                               fmt::format("'{}' is not of the form knob=value", knob));
        request.knobs.emplace_back(knob.substr(0, equals), knob.substr(equals + 1));
    }
    for (const std::string& loop : options.loops) {
        const std::size_t equals = loop.find('=');
        const std::string form = equals == std::string::npos ? "" : loop.substr(equals + 1);
        if (form != "unroll" && form != "loop")
            return input_error(
                "loop-syntax",
                fmt::format("'{}' is not of the form name=unroll or name=loop", loop));
        request.loop_forms[loop.substr(0, equals)] =
            form == "unroll" ? ir::LoopForm::Unrolled : ir::LoopForm::Rolled;
    }
    Result<passes::Known> known = known_in(options.known.fixed, options.known.assumed);
    if (!known) return known.error();
    request.known = std::move(*known);
    return request;
}

measure::Look ViewOptions::look() const {
    measure::Look look;
    for (std::size_t i = 0; i < look.further.size(); ++i) {
        measure::Direction& direction = look.further[i].direction;
        if (i + 1 < light_elevation.size()) direction.elevation = light_elevation[i + 1];
        if (i + 1 < light_azimuth.size()) direction.azimuth = light_azimuth[i + 1];
    }
    return look;
}

Status check_view(const ViewOptions& view, const VariantRequest& request) {
    std::vector<double> azimuths = view.light_azimuth, elevations = view.light_elevation;
    const std::size_t given = std::max(azimuths.size(), elevations.size());
    azimuths.push_back(view.azimuth);
    elevations.push_back(view.elevation);
    for (const double azimuth : azimuths)
        if (!std::isfinite(azimuth))
            return input_error(
                "option-value",
                fmt::format("an azimuth is a number of degrees; {} is not", azimuth));
    for (const double elevation : elevations)
        if (!(elevation >= -90 && elevation <= 90))
            return input_error(
                "option-value",
                fmt::format("an elevation is -90 to 90 degrees; {} is not", elevation));
    int lights = 1;
    for (const auto& [name, value] : request.knobs)
        if (name == "lights") std::from_chars(value.data(), value.data() + value.size(), lights);
    if (given > 1 && static_cast<int>(given) > lights)
        return input_error("option-value",
                           fmt::format("{} lights are aimed and the surface has {}: -D lights={}",
                                       given, lights, given));
    return Done{};
}

Result<Size> parse_size(const std::string& text) {
    const auto bad = [&] {
        return input_error(
            "size",
            fmt::format("'{}' is not a size of the form 256x128, each side 1 to 16384", text));
    };
    const std::size_t x = text.find('x');
    if (x == std::string::npos) return bad();
    Size size{};
    for (auto [part, number] :
         {std::pair{text.substr(0, x), &size.width}, std::pair{text.substr(x + 1), &size.height}}) {
        const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), *number);
        if (error != std::errc() || end != part.data() + part.size() || *number < 1 ||
            *number > 16384)
            return bad();
    }
    return size;
}

Result<measure::Filtering> filtering_of(const std::string& name) {
    if (name == "float") return measure::Filtering::Float;
    if (name == "native") return measure::Filtering::Native;
    return input_error("filtering", fmt::format("filtering is float or native, not '{}'", name));
}

Result<std::map<std::string, std::filesystem::path>> baked_files(
    const std::vector<std::string>& options) {
    std::map<std::string, std::filesystem::path> files;
    for (const std::string& option : options) {
        const std::size_t equals = option.find('=');
        if (equals == std::string::npos || equals == 0 || equals + 1 == option.size())
            return input_error("baked-syntax",
                               fmt::format("'{}' is not of the form cone=wall_cone.png", option));
        const std::string kind = option.substr(0, equals);
        if (!files.emplace(kind, option.substr(equals + 1)).second)
            return input_error("baked-syntax", fmt::format("two {} maps are given", kind));
    }
    return files;
}

Result<measure::MapSet> map_set_of(const MapOptions& options) {
    if (!(options.scale >= 0 && options.scale <= 1))
        return input_error(
            "scale-range",
            fmt::format(
                "the scale is the depth of the relief in texture units, 0 to 1; {} is out of range",
                options.scale));
    if (options.maker.empty() && options.height.empty())
        return input_error(
            "no-map",
            "a height map is needed: --height MAP.png, or --maker NAME for a procedural one");
    const Result<std::map<std::string, std::filesystem::path>> baked = baked_files(options.baked);
    if (!baked) return baked.error();
    if (baked->contains("normal") && !options.normal.empty())
        return input_error("option-value",
                           "a normal map is given by --normal or by --baked, not "
                           "by both");
    if (options.maker.empty()) {
        measure::MapFiles files{options.height, {}, {}, *baked};
        if (!options.normal.empty()) files.normal = options.normal;
        if (!options.colour.empty()) files.colour = options.colour;
        return measure::load_map_set(files, options.scale);
    }
    const Result<Size> size = parse_size(options.map_size);
    if (!size) return size.error();
    Result<measure::MapSet> set = measure::make_map_set(options.maker, size->width, size->height,
                                                        options.scale, options.seed);
    if (!set) return set.error();
    if (Status status = measure::add_baked_files(*set, *baked, options.scale); !status)
        return status.error();
    return set;
}

Status write_product(const std::string& output, std::string_view bytes, bool binary) {
    if (output != "-") {
        const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
        return maps::write_file(output, {data, bytes.size()});
    }
    if (binary && isatty(STDOUT_FILENO))
        return input_error("binary-to-terminal",
                           "this target is binary; give a file with -o, or pipe it");
    if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) != bytes.size() ||
        std::fflush(stdout) != 0)
        return input_error("file-unwritable", "cannot write to stdout");
    return Done{};
}

}  // namespace intaglio::cli
