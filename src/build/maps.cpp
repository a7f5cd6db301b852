// Bakes are slow (a relaxed cone map takes seconds) and keyed by the heights' own fingerprint.
#include "src/build/maps.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include "src/maps/bake.h"
#include "src/maps/bake_cone.h"
#include "src/maps/bake_distance.h"
#include "src/maps/bake_horizon.h"
#include "src/maps/bake_max_mip.h"
#include "src/maps/bake_phong.h"
#include "src/maps/bake_summit.h"
#include "src/maps/bake_view_dependent.h"
#include "src/maps/png.h"
#include "src/maps/provenance.h"
#include "src/measure/baked_maps.h"
#include "src/measure/hash.h"

namespace intaglio::build {
namespace {

using maps::BakeSettings;
using maps::Image;

// What a map is made from.
struct Source {
    const scene::SceneSurface& surface;
    const std::filesystem::path& folder;  // that its files are relative to
    int threads;
};

// An image and what shaped it.
struct Made {
    Image image;
    BakeSettings settings;
};

Result<Made> plain(Result<Image> image, BakeSettings settings = {}) {
    if (!image) return image.error();
    return Made{std::move(*image), std::move(settings)};
}

Result<Made> below_each_other(const Result<std::vector<Image>>& images,
                              BakeSettings settings = {}) {
    if (!images) return images.error();
    return plain(maps::stacked(*images), std::move(settings));
}

Result<Made> slices(Result<maps::Volume> volume, const std::string& name, int number) {
    if (!volume) return volume.error();
    const std::string size =
        fmt::format("{}x{}", volume->slices.width, volume->slices.height / volume->depth);
    return Made{std::move(volume->slices), {{"size", size}, {name, fmt::format("{}", number)}}};
}

Result<Made> make_phong(const Source&, const BakeSettings& wanted) {
    const auto shininess = wanted.find("shininess");
    const std::string exponent = shininess == wanted.end() ? "32" : shininess->second;
    return plain(maps::bake_phong(std::strtod(exponent.c_str(), nullptr)),
                 {{"shininess", exponent}, {"size", "256x256"}});
}

struct Kind {
    std::string_view name;
    std::string_view filter;
    bool of_heights;
    Result<Made> (*make)(const Source& from, const BakeSettings& wanted);
};

const Image& heights_of(const Source& from) { return from.surface.map.set.heights; }

constexpr int horizon_azimuths = 8, distance_slices = 32, view_dependent_views = 9;

// The settings are those that src/measure draws with, so what is delivered is what was measured.
const Kind kinds[] = {
    {"height", "linear", true,
     [](const Source& from, const BakeSettings&) { return plain(heights_of(from)); }},
    {"normal", "linear", true,
     [](const Source& from, const BakeSettings&) {
         return plain(from.surface.map.set.normal_height,
                      {{"scale", fmt::format("{}", from.surface.scale)}, {"keep-height", "yes"}});
     }},
    {"colour", "linear", false,
     [](const Source& from, const BakeSettings&) { return plain(from.surface.map.set.colour); }},
    {"cone", "linear", true,
     [](const Source& from, const BakeSettings&) {
         return plain(maps::bake_cone(heights_of(from), maps::ConeKind::Empty, {from.threads, {}}));
     }},
    {"relaxed-cone", "linear", true,
     [](const Source& from, const BakeSettings&) {
         return plain(
             maps::bake_cone(heights_of(from), maps::ConeKind::Relaxed, {from.threads, {}}));
     }},
    {"max-mip", "nearest", true,
     [](const Source& from, const BakeSettings&) {
         return below_each_other(maps::bake_max_mip(heights_of(from)));
     }},
    {"summit", "nearest", true,
     [](const Source& from, const BakeSettings&) {
         return below_each_other(maps::bake_summit(heights_of(from)));
     }},
    {"patch", "nearest", true,
     [](const Source& from, const BakeSettings&) {
         return plain(maps::bake_patch(heights_of(from)));
     }},
    {"horizon", "linear", true,
     [](const Source& from, const BakeSettings&) {
         return below_each_other(
             maps::bake_horizon(heights_of(from), horizon_azimuths, {from.threads, {}}),
             {{"azimuths", fmt::format("{}", horizon_azimuths)}});
     }},
    {"distance", "nearest", true,
     [](const Source& from, const BakeSettings&) {
         return slices(
             maps::bake_distance(heights_of(from), 256, 256, distance_slices, {from.threads, {}}),
             "slices", distance_slices);
     }},
    {"view-dependent", "linear", true,
     [](const Source& from, const BakeSettings&) {
         return slices(maps::bake_view_dependent(heights_of(from), 128, 128, view_dependent_views,
                                                 {from.threads, {}}),
                       "views", view_dependent_views);
     }},
    {"phong", "linear", false, make_phong},
};

// What a sampler reads: a kind and what it must be baked with.
struct Wanted {
    std::string kind;
    std::string settings;
    bool operator<(const Wanted& other) const {
        return std::tie(kind, settings) < std::tie(other.kind, other.settings);
    }
};

std::optional<Wanted> wanted_by(const std::string& sampler, const Bundle& bundle) {
    if (sampler == "height_map") return Wanted{"height", {}};
    if (sampler == "normal_map") return Wanted{"normal", {}};
    if (sampler == "colour_map") return Wanted{"colour", {}};
    const auto behind = measure::bake_behind(sampler);
    if (!behind) return std::nullopt;
    Wanted wanted{behind->kind.empty() ? "height" : behind->kind, {}};
    for (const auto& [name, settings] : bundle.baked)
        if (name == sampler) wanted.settings = settings;
    return wanted;
}

std::map<Wanted, std::set<std::string>> all_wanted(const std::vector<const Bundle*>& bundles) {
    std::map<Wanted, std::set<std::string>> all;
    for (const Bundle* bundle : bundles)
        for (const StageInterface* stage : {&bundle->interface.vertex, &bundle->interface.pixel})
            for (const Sampler& sampler : stage->samplers)
                if (const auto wanted = wanted_by(sampler.name, *bundle))
                    all[*wanted].insert(sampler.name);
    return all;
}

// The file of the scene that was given for this kind, by the arguments of `intaglio run`.
std::string given_file(const measure::CaseMap& map, const std::string& kind) {
    const std::vector<std::string>& arguments = map.arguments;
    for (std::size_t i = 0; i + 1 < arguments.size(); ++i) {
        if (arguments[i] == "--" + kind) return arguments[i + 1];
        if (arguments[i] == "--baked" && arguments[i + 1].rfind(kind + "=", 0) == 0)
            return arguments[i + 1].substr(kind.size() + 1);
    }
    return {};
}

// Whether a texture made of one image reads the same as one made of the other.
bool reads_the_same(const Image& a, const Image& b) {
    return a.width == b.width && a.height == b.height && a.bits == b.bits &&
           measure::rgba_of(a) == measure::rgba_of(b);
}

// Empty where nothing that was given is what the variants read.
std::string source_of(const Source& from, const Wanted& wanted) {
    const measure::CaseMap& map = from.surface.map;
    const std::string file = given_file(map, wanted.kind);
    if (file.empty()) return {};
    if (map.set.baked.contains(wanted.kind)) return file;
    const Result<Image> image = maps::read_png(from.folder / file);
    if (!image) return {};
    const Image& read = wanted.kind == "height"   ? map.set.heights
                        : wanted.kind == "normal" ? map.set.normal_height
                                                  : map.set.colour;
    // Of heights only the first channel is read.
    if (wanted.kind == "height") {
        const Result<Image> red = maps::heights_of(*image, maps::HeightSource::Red);
        return red && reads_the_same(*red, read) ? file : std::string();
    }
    return reads_the_same(*image, read) ? file : std::string();
}

Result<std::string> encoded(const Kind& kind, const Source& from, const Wanted& wanted) {
    Result<Made> made = kind.make(from, maps::parse_settings(wanted.settings));
    if (!made) return made.error();
    maps::Provenance provenance{std::string(kind.name), made->settings, std::string(kind.filter)};
    if (kind.of_heights) {
        provenance.heights = maps::fingerprint(heights_of(from));
        provenance.source = from.surface.map.set.name;
    }
    const Result<std::vector<unsigned char>> bytes = maps::encode_baked(made->image, provenance);
    if (!bytes) return bytes.error();
    return std::string(bytes->begin(), bytes->end());
}

std::string key_of(const Source& from, const Wanted& wanted) {
    measure::Hash hash;
    for (const std::string& part :
         {std::string("map 1"), tool_id(), wanted.kind, wanted.settings, from.surface.map.hash,
          fmt::format("{}", from.surface.scale), from.surface.map.set.name})
        hash.add(fmt::format("{}:{}", part.size(), part));
    return hash.hex();
}

// "quay.phong-shininess-32.png".
std::string file_of(const std::string& surface, const Wanted& wanted) {
    std::string kind = wanted.kind;
    if (!wanted.settings.empty()) kind += "-" + wanted.settings;
    for (char& c : kind)
        if (c == '=' || c == ' ') c = '-';
    return map_file(surface, kind);
}

Result<std::string> cached(const Source& from, const Wanted& wanted, Cache& cache) {
    const Kind* kind = std::find_if(std::begin(kinds), std::end(kinds),
                                    [&](const Kind& each) { return each.name == wanted.kind; });
    if (kind == std::end(kinds))
        return internal_error("bake-kind",
                              fmt::format("{} maps are not baked by a build", wanted.kind));
    const std::string key = key_of(from, wanted);
    if (std::optional<std::string> bytes = cache.get(key)) return std::move(*bytes);
    Result<std::string> bytes = encoded(*kind, from, wanted);
    if (bytes) cache.put(key, *bytes);
    return bytes;
}

}  // namespace

std::string hash_of(std::string_view bytes) {
    measure::Hash hash;
    hash.add(bytes);
    return hash.hex();
}

std::vector<MapRecord> wanted_maps(const scene::SceneSurface& surface,
                                   const std::filesystem::path& folder,
                                   const std::vector<const Bundle*>& bundles) {
    const Source from{surface, folder, 1};
    std::vector<MapRecord> records;
    for (const auto& [wanted, samplers] : all_wanted(bundles)) {
        MapRecord record{wanted.kind, wanted.settings, {samplers.begin(), samplers.end()}, {}, {},
                         {}};
        record.source = source_of(from, wanted);
        if (record.source.empty()) record.file = file_of(surface.name, wanted);
        records.push_back(std::move(record));
    }
    return records;
}

Result<SurfaceMaps> make_maps(const scene::SceneSurface& surface,
                              const std::filesystem::path& folder,
                              const std::vector<const Bundle*>& bundles, Cache& cache,
                              int threads) {
    const Source from{surface, folder, threads};
    SurfaceMaps maps;
    maps.records = wanted_maps(surface, folder, bundles);
    for (MapRecord& record : maps.records) {
        if (record.file.empty()) continue;
        Result<std::string> bytes = cached(from, {record.kind, record.settings}, cache);
        if (!bytes) return bytes.error();
        record.hash = hash_of(*bytes);
        maps.files.push_back({record.file, std::move(*bytes)});
    }
    return maps;
}

}  // namespace intaglio::build
