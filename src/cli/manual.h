// The manual page, made from the definitions of the command line.
#pragma once

#include <string>

#include "src/cli/description.h"

namespace intaglio::cli {

// intaglio(1) in the language of man(7), the same bytes for equal definitions.
std::string manual_page(const CommandText& program, const std::string& version);

}  // namespace intaglio::cli
