// Blocks between comments.
#include "src/report/page_block.h"

#include <fmt/format.h>

namespace intaglio::report {
namespace {

constexpr std::string_view opening = "<!-- intaglio pages ", opened = " -->\n",
                           closing = "<!-- end of what intaglio pages wrote -->";

// Where a block's text begins and ends; both npos where there is no such block.
struct Span {
    std::size_t first = std::string_view::npos, last = std::string_view::npos;
    bool whole() const { return last != std::string_view::npos; }
};

Span span_of(std::string_view page, std::string_view title) {
    const std::string head = fmt::format("{}{}{}", opening, title, opened);
    Span span;
    const std::size_t at = page.find(head);
    if (at == std::string_view::npos) return span;
    span.first = at + head.size();
    const std::size_t end = page.find(closing, span.first);
    // The end of another block is not this one's.
    if (page.substr(0, end).find(opening, span.first) == std::string_view::npos) span.last = end;
    return span;
}

}  // namespace

std::vector<std::string> blocks_of(std::string_view page) {
    std::vector<std::string> titles;
    for (std::size_t at = page.find(opening); at != std::string_view::npos;
         at = page.find(opening, at)) {
        at += opening.size();
        const std::size_t end = page.find(opened, at);
        if (end == std::string_view::npos) break;
        titles.emplace_back(page.substr(at, end - at));
    }
    return titles;
}

std::string block_text(std::string_view page, std::string_view title) {
    const Span span = span_of(page, title);
    return span.whole() ? std::string(page.substr(span.first, span.last - span.first)) : "";
}

Result<std::string> with_block(std::string_view page, std::string_view title, std::string_view text,
                               const std::string& file) {
    const Span span = span_of(page, title);
    if (!span.whole())
        return input_error("page-block",
                           fmt::format("the page has no block '{}{} -->' that ends in '{}'",
                                       opening, title, closing),
                           file);
    return fmt::format("{}{}{}", page.substr(0, span.first), text, page.substr(span.last));
}

}  // namespace intaglio::report
