// The report as one page: everything it needs is inside, so that it works from a file, offline.
#pragma once

#include <string>
#include <string_view>

#include "src/report/page_data.h"

namespace intaglio::report {

// A file of src/report/page, or of the bundled plotting library, by its name; empty: there is none.
std::string_view page_file(std::string_view name);

// The page.  `live`: a fragment of HTML for the section that runs shaders; empty: there is none.
// The same data gives the same bytes.
std::string html(const PageData& page, const std::string& live = {});

}  // namespace intaglio::report
