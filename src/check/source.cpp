// Names of languages and stages, and quoting of source lines.
#include "src/check/source.h"

namespace intaglio::check {

std::string_view name_of(Language language) {
    switch (language) {
        case Language::Glsl450: return "glsl_450";
        case Language::Glsl330: return "glsl_330";
        case Language::Essl300: return "essl_300";
        case Language::Glsl120: return "glsl_120";
        case Language::Essl100: return "essl_100";
        case Language::Hlsl5: return "hlsl_5_0";
        case Language::Hlsl3: return "hlsl_3_0";
    }
    return "unknown";
}

std::string_view name_of(Stage stage) { return stage == Stage::Vertex ? "vertex" : "pixel"; }

bool has_spirv(Language language) {
    return language != Language::Glsl120 && language != Language::Essl100;
}

std::string quote_line(std::string_view text, int line) {
    std::size_t begin = 0;
    for (int current = 1; current < line; ++current) {
        begin = text.find('\n', begin);
        if (begin == std::string_view::npos) return {};
        ++begin;
    }
    std::string_view quoted = text.substr(begin, text.find('\n', begin) - begin);
    constexpr std::string_view blanks = " \t\r";
    const std::size_t first = quoted.find_first_not_of(blanks);
    if (line < 1 || first == std::string_view::npos) return {};
    return std::string(quoted.substr(first, quoted.find_last_not_of(blanks) - first + 1));
}

}  // namespace intaglio::check
