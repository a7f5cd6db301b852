// The C++ header of a surface: what an engine includes to draw it.  Complete by itself, C++17, and
// needs no library: the bytes of every variant, a struct for its uniforms whose layout the compiler
// checks, slots, names, and a lookup by target.
#pragma once

#include <string>
#include <vector>

#include "src/build/bundle.h"
#include "src/build/maps.h"

namespace intaglio::build {

// A variant with what planning says of it.
struct BuiltVariant {
    plan::Order order;
    Bundle bundle;
};

// Whether a text is a namespace of C++: "game::shaders", or empty.
bool is_namespace(std::string_view text);

// `name_space`: around the surface's own namespace; may be empty.
std::string header_text(const std::string& surface,
                        const std::vector<const BuiltVariant*>& variants,
                        const std::vector<MapRecord>& maps, const std::string& name_space);

}  // namespace intaglio::build
