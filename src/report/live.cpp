// Puts the files of src/report/page and the data together.
#include "src/report/live.h"

#include <string_view>

#include "src/report/live_data.h"

namespace intaglio::report {

// Made by CMake from src/report/page.
std::string_view live_file(std::string_view name);

Result<std::string> live_section(const dsl::Catalogue& catalogue, const LiveOptions& options) {
    const Result<std::string> data = live_data(catalogue, options);
    if (!data) return data.error();
    std::string html;
    const auto add = [&](std::string_view before, std::string_view text, std::string_view after) {
        html.append(before).append(text).append(after);
    };
    add("<style>\n", live_file("live.css"), "</style>\n");
    add("", live_file("live.html"), "");
    add("<script type=\"application/json\" id=\"live-data\">", *data, "</script>\n");
    add("<script>\n", live_file("live_draw.js"), "</script>\n");
    add("<script>\n", live_file("live.js"), "</script>\n");
    return html;
}

std::string live_page(const std::string& section) {
    std::string page(live_file("live_page.html"));
    const std::string_view place = "<!-- the section -->\n";
    return page.replace(page.find(place), place.size(), section);
}

}  // namespace intaglio::report
