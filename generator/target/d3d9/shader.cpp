// Names and encodings of profiles, usages and register files, each in one table in the order of its
// enumeration. Source: d3d9types.h and Direct3D 9 reference, "Registers".
#include "generator/target/d3d9/shader.h"

namespace intaglio::d3d9 {
namespace {

constexpr std::array<std::string_view, 6> profiles = {"ps_2_0", "ps_2_a", "ps_2_b",
                                                      "ps_3_0", "vs_2_0", "vs_3_0"};
constexpr std::array<std::string_view, 6> versions = {"ps_2_0", "ps_2_x", "ps_2_x",
                                                      "ps_3_0", "vs_2_0", "vs_3_0"};

constexpr std::array<std::string_view, 14> usages = {
    "position", "blendweight", "blendindices", "normal", "psize", "texcoord", "tangent",
    "binormal", "tessfactor",  "positiont",    "color",  "fog",   "depth",    "sample"};

constexpr std::uint8_t pixel = 0x0F, pixel_2 = 0x07, pixel_3 = 0x08, vertex_2 = 0x10,
                       vertex_3 = 0x20;
constexpr std::uint8_t vertex = vertex_2 | vertex_3, every = pixel | vertex;

constexpr std::array<FileInfo, 21> files = {{
    {File::Temp, "r", true, 0, 0, every},
    {File::Const, "c", true, 2, 0, every},
    {File::Input, "v", true, 1, 0, every},
    {File::Texture, "t", true, 3, 0, pixel_2},
    {File::Sampler, "s", true, 10, 0, pixel | vertex_3},
    {File::ConstInt, "i", true, 7, 0, every},
    {File::ConstBool, "b", true, 14, 0, every},
    {File::Address, "a", true, 3, 0, vertex},
    {File::LoopCounter, "aL", false, 15, 0, pixel_3 | vertex},
    {File::Predicate, "p", true, 19, 0, every},
    {File::ColourOut, "oC", true, 8, 0, pixel},
    {File::DepthOut, "oDepth", false, 9, 0, pixel},
    {File::PositionOut, "oPos", false, 4, 0, vertex_2},
    {File::FogOut, "oFog", false, 4, 1, vertex_2},
    {File::PointSizeOut, "oPts", false, 4, 2, vertex_2},
    {File::AttributeOut, "oD", true, 5, 0, vertex_2},
    {File::TexcoordOut, "oT", true, 6, 0, vertex_2},
    {File::Output, "o", true, 6, 0, vertex_3},
    {File::Position, "vPos", false, 17, 0, pixel_3},
    {File::Face, "vFace", false, 17, 1, pixel_3},
    {File::Label, "l", true, 18, 0, every},
}};

constexpr bool in_order() {
    for (std::size_t i = 0; i < files.size(); ++i)
        if (static_cast<std::size_t>(files[i].file) != i) return false;
    return files.size() == static_cast<std::size_t>(File::Label) + 1;
}
static_assert(in_order(), "the rows follow the order of File, one each");

template <typename Enum, std::size_t count>
std::optional<Enum> find(const std::array<std::string_view, count>& names, std::string_view name) {
    for (std::size_t i = 0; i < count; ++i)
        if (names[i] == name) return static_cast<Enum>(i);
    return std::nullopt;
}

}  // namespace

std::string_view name_of(Profile profile) { return profiles[static_cast<std::size_t>(profile)]; }
std::optional<Profile> profile_named(std::string_view name) {
    return find<Profile>(profiles, name);
}
std::string_view version_of(Profile profile) { return versions[static_cast<std::size_t>(profile)]; }

std::optional<Profile> profile_of_version(std::string_view version, Profile x_profile) {
    if (version == "ps_2_x") return x_profile;
    const auto profile = profile_named(version);
    const bool has_own_version = profile && version_of(*profile) == version;
    return has_own_version ? profile : std::nullopt;
}

std::string_view name_of(Usage usage) { return usages[static_cast<std::size_t>(usage)]; }
std::optional<Usage> usage_named(std::string_view name) { return find<Usage>(usages, name); }

const FileInfo& info(File file) { return files[static_cast<std::size_t>(file)]; }

bool has_file(Profile profile, File file) {
    return (info(file).profiles >> static_cast<unsigned>(profile) & 1) != 0;
}

std::optional<File> file_of_type(Profile profile, std::uint32_t type, std::uint32_t index) {
    for (const FileInfo& row : files)
        if (row.type == type && has_file(profile, row.file) && (row.numbered || row.index == index))
            return row.file;
    return std::nullopt;
}

std::optional<File> file_named(Profile profile, std::string_view letters) {
    for (const FileInfo& row : files)
        if (row.name == letters && has_file(profile, row.file)) return row.file;
    return std::nullopt;
}

bool can_declare(File file) {
    return file == File::Sampler || file == File::Input || file == File::Texture ||
           file == File::Output || file == File::Position || file == File::Face;
}

bool has_usage(Profile profile, File file) {
    if (is_pixel(profile)) return profile == Profile::ps_3_0 && file == File::Input;
    return file == File::Input || file == File::Output;
}

}  // namespace intaglio::d3d9
