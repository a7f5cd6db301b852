// Indented lines.
#include "generator/base/text.h"

namespace intaglio {

void TextBuilder::line(std::string_view text) {
    if (!text.empty()) {
        text_.append(static_cast<std::size_t>(column()), ' ');
        text_.append(text);
    }
    text_.push_back('\n');
}

}  // namespace intaglio
