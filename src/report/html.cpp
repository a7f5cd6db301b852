// The page's template with its places filled: {{name}} is a file of the page, `data` or `live`.
#include "src/report/html.h"

namespace intaglio::report {
namespace {

// JSON that no reader of HTML takes for the end of its script.
std::string script_json(const nlohmann::ordered_json& json) {
    // File names need not be UTF-8; JSON must be.
    const std::string text =
        json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    std::string safe;
    safe.reserve(text.size());
    for (char c : text) {
        if (c == '<')
            safe += "\\u003c";
        else
            safe += c;
    }
    return safe;
}

}  // namespace

std::string html(const PageData& page, const std::string& live) {
    const std::string_view shell = page_file("report.html");
    std::string text;
    std::size_t at = 0;
    for (std::size_t open = shell.find("{{"); open != shell.npos; open = shell.find("{{", at)) {
        const std::size_t close = shell.find("}}", open);
        const std::string_view name = shell.substr(open + 2, close - open - 2);
        text += shell.substr(at, open - at);
        if (name == "data")
            text += script_json(page.json);
        else if (name == "live")
            text += live;
        else
            text += page_file(name);
        at = close + 2;
    }
    text += shell.substr(at);
    return text;
}

}  // namespace intaglio::report
