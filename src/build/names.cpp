// Extensions are the targets' own; a test compares them with what each target emits.
#include "src/build/names.h"

#include <algorithm>

#include <fmt/format.h>

#include "src/variant/variant.h"

namespace intaglio::build {

bool is_surface_name(std::string_view name) {
    const auto is_letter = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
    };
    return !name.empty() && is_letter(name.front()) &&
           std::all_of(name.begin(), name.end(),
                       [&](char c) { return is_letter(c) || (c >= '0' && c <= '9'); });
}

std::string_view name_of(FileKind kind) {
    switch (kind) {
        case FileKind::Text: return "text";
        case FileKind::Bytecode: return "bytecode";
        case FileKind::Spirv: return "spirv";
    }
    return {};
}

std::vector<StageFile> stage_files(const Target& target) {
    using enum FileKind;
    constexpr ir::Stage vertex = ir::Stage::Vertex, pixel = ir::Stage::Pixel;
    if (target.name == "spirv") return {{vertex, Spirv, ".vert.spv"}, {pixel, Spirv, ".frag.spv"}};
    if (target.name == "msl") return {{vertex, Text, ".vert.metal"}, {pixel, Text, ".frag.metal"}};
    if (target.name == "none") return {{vertex, Text, ".vert.ir"}, {pixel, Text, ".frag.ir"}};
    if (profile_of(target) && !target.pixel_stage)
        return {{vertex, Text, ".vsh"}, {vertex, Bytecode, ".vso"}};
    if (profile_of(target))
        return {{vertex, Text, ".vsh"},
                {pixel, Text, ".psh"},
                {vertex, Bytecode, ".vso"},
                {pixel, Bytecode, ".pso"}};
    if (target.name == "glsl_450")
        return {{vertex, Text, ".vert"},
                {pixel, Text, ".frag"},
                {vertex, Spirv, ".vert.spv"},
                {pixel, Spirv, ".frag.spv"}};
    if (target.name.substr(0, 4) == "hlsl")
        return {{vertex, Text, ".vert.hlsl"}, {pixel, Text, ".frag.hlsl"}};
    return {{vertex, Text, ".vert"}, {pixel, Text, ".frag"}};
}

std::vector<std::string> variant_files(const std::string& surface, const Target& target) {
    std::vector<std::string> names;
    for (const StageFile& file : stage_files(target))
        names.push_back(fmt::format("{}.{}{}", surface, target.name, file.extension));
    return names;
}

std::string order_file(const std::string& variant) { return variant + ".order.json"; }
std::string header_file(const std::string& surface) { return surface + ".h"; }
std::string map_file(const std::string& surface, const std::string& kind) {
    return fmt::format("{}.{}.png", surface, kind);
}

}  // namespace intaglio::build
