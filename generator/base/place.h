// A line of C++, as the default argument of a named call captures it.  std::source_location says
// the same, but clang 14 with libstdc++ 12 does not have it.
#pragma once

namespace intaglio {

struct Place {
    const char* file;
    int line;

    // As a default argument, the place of the outermost call.
    static constexpr Place here(const char* file_name = __builtin_FILE(),
                                int line_number = __builtin_LINE()) {
        return {file_name, line_number};
    }
};

}  // namespace intaglio
