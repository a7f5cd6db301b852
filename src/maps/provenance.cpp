// Text chunks out and in, and the questions in the order in which their answers help.
#include "src/maps/provenance.h"

#include <array>
#include <sstream>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <xxhash.h>

#include "src/maps/files.h"
#include "src/maps/png.h"

namespace intaglio::maps {
namespace {

constexpr const char* prefix = "intaglio.";

// Where each field of a provenance is, for writing and reading.
struct Field {
    const char* name;
    std::string Provenance::*text;
};
constexpr std::array fields = std::to_array<Field>({{"format", &Provenance::format},
                                                    {"kind", &Provenance::kind},
                                                    {"filter", &Provenance::filter},
                                                    {"heights", &Provenance::heights},
                                                    {"source", &Provenance::source}});

std::string command(const WantedBake& wanted, const std::filesystem::path& output) {
    std::string text = "intaglio bake " + wanted.kind;
    if (!wanted.source.empty()) text += " " + wanted.source;
    for (const auto& [name, value] : wanted.settings) text += fmt::format(" --{} {}", name, value);
    return fmt::format("{} -o {}", text, shell_quoted(output.string()));
}

}  // namespace

std::string fingerprint(const Image& image) {
    std::vector<unsigned char> bytes;
    bytes.reserve(image.texels.size() * 2);
    for (const float value : image.texels) {
        const unsigned step = stored_step(value, image.bits);
        bytes.push_back(static_cast<unsigned char>(step & 255));
        bytes.push_back(static_cast<unsigned char>(step >> 8));
    }
    const XXH128_hash_t hash = XXH3_128bits_withSeed(bytes.data(), bytes.size(),
                                                     static_cast<XXH64_hash_t>(image.channels));
    return fmt::format("{}x{} {} bits {:016x}{:016x}", image.width, image.height, image.bits,
                       hash.high64, hash.low64);
}

std::string to_string(const BakeSettings& settings) {
    std::string text;
    for (const auto& [name, value] : settings)
        text += fmt::format("{}{}={}", text.empty() ? "" : " ", name, value);
    return text;
}

BakeSettings parse_settings(const std::string& text) {
    BakeSettings settings;
    std::istringstream words(text);
    for (std::string word; words >> word;)
        if (const std::size_t equals = word.find('='); equals != std::string::npos)
            settings[word.substr(0, equals)] = word.substr(equals + 1);
    return settings;
}

namespace {

std::vector<PngText> text_of(const Image& map, const Provenance& from) {
    std::vector<PngText> text;
    // What is empty is not said: libspng writes no empty text.
    const auto say = [&](const char* name, const std::string& what) {
        if (!what.empty()) text.push_back({std::string(prefix) + name, what});
    };
    for (const Field& field : fields) say(field.name, from.*field.text);
    say("settings", to_string(from.settings));
    say("texels", fingerprint(map));
    return text;
}

}  // namespace

Result<std::vector<unsigned char>> encode_baked(const Image& map, const Provenance& from) {
    return encode_png(map, text_of(map, from));
}

Status write_baked(const std::filesystem::path& path, const Image& map, const Provenance& from) {
    return write_png(path, map, text_of(map, from));
}

Result<BakedFile> read_baked(const std::filesystem::path& path) {
    std::vector<PngText> text;
    Result<Image> map = read_png(path, &text);
    if (!map) return map.error();
    std::map<std::string, std::string> said;
    for (const PngText& entry : text)
        if (entry.keyword.rfind(prefix, 0) == 0)
            said.emplace(entry.keyword.substr(std::string(prefix).size()), entry.text);
    BakedFile baked{path, std::move(*map), {}, false};
    if (!said.contains("format") || !said.contains("kind")) return baked;
    baked.from.emplace();
    for (const Field& field : fields) baked.from.value().*field.text = said[field.name];
    baked.from->settings = parse_settings(said["settings"]);
    baked.changed = said["texels"] != fingerprint(baked.map);
    return baked;
}

Status check_pairing(const BakedFile& baked, const WantedBake& wanted) {
    const auto refused = [&](const char* code, const std::string& sentence) {
        return input_error(code, fmt::format("{}; run: {}", sentence, command(wanted, baked.path)),
                           baked.path.string());
    };
    const std::string of = wanted.source.empty() ? "" : " of " + wanted.source;
    if (!baked.from)
        return refused("bake-unknown",
                       fmt::format("this file does not say what it was baked from, so nobody knows "
                                   "whether it is the {} map{}",
                                   wanted.kind, of));
    const Provenance& from = *baked.from;
    const std::string origin = from.source.empty() ? "" : ", baked from " + from.source + ",";
    if (from.format != std::to_string(bake_format))
        return refused("bake-format",
                       fmt::format("this {} map{} has format {}, and format {} is read", from.kind,
                                   origin, from.format, bake_format));
    if (from.kind != wanted.kind)
        return refused("bake-kind", fmt::format("this is a {} map{} where the {} map{} belongs",
                                                from.kind, origin, wanted.kind, of));
    if (from.heights != wanted.heights)
        return refused(
            "bake-heights",
            fmt::format("this {} map was baked from {} ({}), which is not {} ({})", from.kind,
                        from.source, from.heights, wanted.source, wanted.heights));
    for (const auto& [name, value] : wanted.settings) {
        const auto set = from.settings.find(name);
        const std::string is = set == from.settings.end() ? "none" : set->second;
        if (is != value)
            return refused("bake-settings",
                           fmt::format("this {} map{} has {} = {} where {} is needed{}", from.kind,
                                       origin, name, is, value, of));
    }
    if (baked.changed)
        return refused("bake-changed", fmt::format("this {} map{} was changed since it was baked",
                                                   from.kind, origin));
    return Done{};
}

}  // namespace intaglio::maps
