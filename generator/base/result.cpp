// Formatting of diagnostics.
#include "generator/base/result.h"

#include <fmt/format.h>

namespace intaglio {

std::string to_string(const Diagnostic& diagnostic) {
    std::string text;
    if (!diagnostic.file.empty()) {
        text += diagnostic.file;
        if (diagnostic.line > 0) text += fmt::format(":{}", diagnostic.line);
        if (diagnostic.line > 0 && diagnostic.column > 0)
            text += fmt::format(":{}", diagnostic.column);
        text += ": ";
    }
    text += fmt::format("error: {} [{}]", diagnostic.message, diagnostic.code);
    for (const std::string& note : diagnostic.notes) text += "\n  " + note;
    return text;
}

Diagnostic input_error(std::string code, std::string message) {
    return {.code = std::move(code), .message = std::move(message), .file = {}, .notes = {}};
}

Diagnostic input_error(std::string code, std::string message, std::string file, int line,
                       int column) {
    return {.code = std::move(code),
            .message = std::move(message),
            .file = std::move(file),
            .line = line,
            .column = column,
            .notes = {}};
}

Diagnostic internal_error(std::string code, std::string message) {
    return {.code = std::move(code),
            .message = std::move(message),
            .file = {},
            .notes = {},
            .fault = Fault::Internal};
}

}  // namespace intaglio
