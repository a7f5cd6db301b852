// What no identifier of C++ may be: checked where scenes name things, avoided where headers name
// the uniforms of shaders.
#pragma once

#include <string_view>

namespace intaglio::scene {

bool is_word_of_cpp(std::string_view name);

}  // namespace intaglio::scene
