// Names in the emitted text: the DSL's where they are legal, never a reserved word of any of the
// languages, never one name for two things where both can be seen.
#pragma once

#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

namespace intaglio::clike {

// A word that is a keyword, type, or built-in function of GLSL, ESSL, HLSL or Metal.
bool is_reserved(std::string_view name);

// The nearest identifier that all languages accept: other characters become "_", doubled and outer
// underscores go, a leading digit or "gl_" gets a letter before it, and a reserved word a trailing
// "_value".
std::string legal_name(std::string_view name);

// The names visible at a place of the text.
class NameScope {
  public:
    NameScope() : levels_(1) {}

    // A name not visible here, made from `wanted` (or `fallback` if that is empty), with _2, _3 ...
    // where needed.
    std::string declare(std::string_view wanted, std::string_view fallback = "value");
    // Takes the name for the whole text, even after this level is left.
    std::string declare_everywhere(std::string_view wanted);
    // Makes a name visible here that was made elsewhere.
    void take(const std::string& name) { levels_.back().insert(name); }
    bool visible(const std::string& name) const;

    void open() { levels_.emplace_back(); }
    void close() { levels_.pop_back(); }

  private:
    std::vector<std::unordered_set<std::string>> levels_;
};

}  // namespace intaglio::clike
