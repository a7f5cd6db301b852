// Names in scene files.  Inside src/scene only.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "generator/dsl/catalogue.h"
#include "src/scene/reader.h"

namespace intaglio::scene {

// What a surface can pin.
inline constexpr std::string_view part_names[] = {"search",  "shadow", "normal",
                                                  "shading", "output", "vertex"};

// A list of different strings, which may be empty, each with its place.
std::vector<std::pair<std::string, Position>> read_names(Reader& reader, const Value& table,
                                                         std::string_view key);

// Why it is no identifier of C++ that may name files and types; empty where it is one.
std::string wrong_identifier(const std::string& name);
// The same of one that names a header and a namespace as well.
std::string wrong_surface_name(const std::string& name);

// Of ASCII letters, as file systems compare names that ignore case.
std::string in_lower_case(std::string name);

// Refuses pinned techniques that the catalogue does not have, code "unknown-technique", and knobs
// that none of the techniques left to choose from has, code "unknown-knob".
void check_pinned(Reader& reader, const Value& surface, const dsl::Catalogue& catalogue);

}  // namespace intaglio::scene
