// The escapes are those of GCC's mkdeps.cc, which both tools were written against.
#include "src/build/depfile.h"

#include <fmt/format.h>

namespace intaglio::build {
namespace {

std::string shown(const std::string& path) {
    std::string text;
    for (const char c : path) text += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
    return text;
}

Result<std::string> escaped(const std::string& path) {
    if (path.find_first_of("\n\r") != std::string::npos)
        return input_error("depfile-path",
                           fmt::format("the name '{}' holds a line break, which no depfile can "
                                       "say: rename the file, or build without -MD",
                                       shown(path)));
    if (!path.empty() && path.back() == '\\')
        return input_error("depfile-path",
                           fmt::format("the name '{}' ends in a backslash, which no depfile can "
                                       "say: rename the file, or build without -MD",
                                       path));
    std::string text;
    for (const char c : path) {
        if (c == ' ' || c == '\t')
            // Backslashes before a blank are read as escapes of each other.
            for (std::size_t i = text.size(); i > 0 && text[i - 1] == '\\'; --i) text += '\\';
        if (c == ' ' || c == '\t' || c == '#' || c == ':') text += '\\';
        if (c == '$') text += '$';
        text += c;
    }
    return text;
}

}  // namespace

Result<std::string> depfile_text(const std::string& target,
                                 const std::vector<std::string>& dependencies) {
    Result<std::string> text = escaped(target);
    if (!text) return text;
    *text += ":";
    for (const std::string& dependency : dependencies) {
        const Result<std::string> path = escaped(dependency);
        if (!path) return path;
        *text += " \\\n  " + *path;
    }
    *text += "\n";
    return text;
}

}  // namespace intaglio::build
