// What a build writes, by name, as far as it follows from surfaces and targets alone: Ninja and
// CMake want to know before anything is planned.  Only baked maps are not among it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "generator/target/target.h"

namespace intaglio::build {

// Whether a name may be a surface's here: an identifier of C++, because it becomes a namespace and
// a part of file names.
bool is_surface_name(std::string_view name);

enum class FileKind { Text, Bytecode, Spirv };
// "text", "bytecode", "spirv".
std::string_view name_of(FileKind kind);

struct StageFile {
    ir::Stage stage;
    FileKind kind;
    std::string_view extension;  // ".psh", with the dot
};
// The products of a variant on a target: the vertex stage first, texts before bytes.
std::vector<StageFile> stage_files(const Target& target);

// "quay.ps_2_0.psh", ...
std::vector<std::string> variant_files(const std::string& surface, const Target& target);
std::string order_file(const std::string& variant);   // "quay.ps_2_0.order.json"
std::string header_file(const std::string& surface);  // "quay.h"
std::string map_file(const std::string& surface, const std::string& kind);  // "quay.cone.png"
inline constexpr std::string_view manifest_file = "manifest.json";
// Of the build itself, in the output folder: its lock, what it did last, the pieces of variants.
inline constexpr std::string_view state_folder = ".intaglio";
// There: which maps the edge of the maps writes, for Ninja.
inline constexpr std::string_view map_names_file = "maps.dd";

}  // namespace intaglio::build
