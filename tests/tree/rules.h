// The order of dependency of design section 2, as one table: who may include whom.  A row is a
// folder with all below it, or one file; the longest row that holds a file is the file's row.  A
// folder without a row is a fault.
#pragma once

#include <string_view>
#include <vector>

namespace intaglio::tree {

struct Row {
    std::string_view path;               // the folder or file that includes
    std::vector<std::string_view> sees;  // rows it may include from, besides itself
};

struct Rules {
    std::vector<Row> rows;
    // Folders that are a pure function: beyond `sees` only the C++ library without these headers,
    // and `libraries`.
    std::vector<std::string_view> pure;
    std::vector<std::string_view> pure_libraries;  // prefixes of header names
    std::vector<std::string_view> impure_headers;
    int longest_file = 500;                // lines
    std::vector<std::string_view> tables;  // files that may be longer, because they are tables
};

inline const Rules& rules() {
    static const Rules all = {
        .rows =
            {
                // The compiler's two arms: base < ir < passes < target, and base < ir < dsl <
                // templates.
                {"generator/base", {}},
                {"generator/ir", {"generator/base"}},
                {"generator/passes", {"generator/base", "generator/ir"}},
                {"generator/target", {"generator/base", "generator/ir", "generator/passes"}},
                {"generator/dsl", {"generator/base", "generator/ir"}},
                {"generator/intaglio.h", {"generator/dsl"}},
                {"templates",
                 {"generator/base", "generator/ir", "generator/dsl", "generator/intaglio.h"}},

                // No target sees another.  The printer they share knows none of them; the list
                // knows all.
                {"generator/target/clike",
                 {"generator/base", "generator/ir", "generator/passes", "generator/target"}},
                {"generator/target/glsl",
                 {"generator/base", "generator/ir", "generator/passes", "generator/target",
                  "generator/target/clike"}},
                {"generator/target/hlsl",
                 {"generator/base", "generator/ir", "generator/passes", "generator/target",
                  "generator/target/clike"}},
                {"generator/target/none",
                 {"generator/base", "generator/ir", "generator/passes", "generator/target",
                  "generator/target/clike"}},
                {"generator/target/d3d9/rows",
                 {"generator/base", "generator/ir", "generator/passes", "generator/target",
                  "generator/target/clike"}},
                {"generator/target/all_targets.cpp",
                 {"generator/base", "generator/target", "generator/target/d3d9/rows",
                  "generator/target/glsl", "generator/target/hlsl", "generator/target/none"}},

                // What touches the world.  The reference shares nothing with what it judges.
                {"src/reference", {}},
                {"src/maps", {"generator/base"}},
                {"src/check", {"generator/base"}},
                {"src/variant",
                 {"generator/base", "generator/ir", "generator/passes", "generator/target",
                  "generator/dsl", "generator/intaglio.h", "templates", "src/check"}},
                {"src/vulkan", {"generator/base", "src/check"}},
                {"src/measure",
                 {"generator/base", "generator/ir", "generator/passes", "generator/target",
                  "generator/dsl", "src/reference", "src/maps", "src/check", "src/variant",
                  "src/vulkan"}},
                {"src/scene",
                 {"generator/base", "generator/ir", "generator/passes", "generator/target",
                  "generator/dsl", "src/reference", "src/maps", "src/check", "src/variant",
                  "src/vulkan", "src/measure"}},
                {"src/plan",
                 {"generator/base", "generator/ir", "generator/passes", "generator/target",
                  "generator/dsl", "src/reference", "src/maps", "src/check", "src/variant",
                  "src/vulkan", "src/measure", "src/scene"}},
                {"src/build",
                 {"generator/base", "generator/ir", "generator/passes", "generator/target",
                  "generator/dsl", "src/reference", "src/maps", "src/check", "src/variant",
                  "src/vulkan", "src/measure", "src/scene", "src/plan"}},
                {"src/report",
                 {"generator/base", "generator/ir", "generator/passes", "generator/target",
                  "generator/dsl", "src/reference", "src/maps", "src/check", "src/variant",
                  "src/vulkan", "src/measure"}},
                {"src/budget",
                 {"generator/base", "generator/ir", "generator/passes", "generator/target",
                  "generator/dsl", "src/reference", "src/maps", "src/check", "src/variant",
                  "src/vulkan", "src/measure", "src/scene", "src/plan", "src/report"}},
                {"src/cli",
                 {"generator/base", "generator/ir", "generator/passes", "generator/target",
                  "generator/dsl", "generator/intaglio.h", "templates", "src/reference", "src/maps",
                  "src/check", "src/variant", "src/vulkan", "src/measure", "src/scene", "src/plan",
                  "src/build", "src/report", "src/budget"}},
            },
        .pure = {"generator", "templates", "src/reference"},
        .pure_libraries = {"fmt/"},
        .impure_headers = {"chrono", "condition_variable", "ctime", "filesystem", "fstream",
                           "future", "iostream", "locale", "mutex", "random", "thread"},
        .tables = {},
    };
    return all;
}

}  // namespace intaglio::tree
