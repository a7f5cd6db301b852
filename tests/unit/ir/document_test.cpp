// docs/ir.md holds the table that the code makes, and its example is real.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "generator/ir/document.h"
#include "generator/ir/ops.h"
#include "generator/ir/parse.h"
#include "generator/ir/print.h"
#include "generator/ir/verify.h"

namespace intaglio::ir {
namespace {

const std::string path = INTAGLIO_SOURCE_DIR "/docs/ir.md";

std::string read_page() {
    std::ifstream file(path, std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

TEST(Document, HoldsTheOpsTable) {
    const std::string begin =
        "<!-- begin: ops table, made by the test of generator/ir/document.h -->\n";
    std::string page = read_page();
    const std::size_t first = page.find(begin);
    const std::size_t last = page.find("<!-- end: ops table -->");
    ASSERT_TRUE(first != std::string::npos && last != std::string::npos)
        << path << " lacks the markers of the ops table";
    const std::size_t start = first + begin.size();
    ASSERT_LE(start, last);
    if (std::getenv("INTAGLIO_UPDATE_DOCS") != nullptr) {
        page.replace(start, last - start, ops_table_markdown());
        std::ofstream(path, std::ios::binary) << page;
        page = read_page();
    }
    EXPECT_EQ(page.substr(start, page.find("<!-- end: ops table -->") - start),
              ops_table_markdown())
        << "docs/ir.md is stale; refresh it: INTAGLIO_UPDATE_DOCS=1 ctest -R unit.ir";
}

TEST(Document, TableHasARowForEachOp) {
    const std::string table = ops_table_markdown();
    for (const OpInfo& row : all_ops())
        EXPECT_NE(table.find("| `" + std::string(row.name) + "` |"), std::string::npos) << row.name;
    EXPECT_EQ(static_cast<std::size_t>(std::count(table.begin(), table.end(), '\n')),
              all_ops().size() + 2);
}

TEST(Document, ExampleVerifiesAndPrintsAsItStands) {
    const std::string page = read_page();
    const std::size_t first = page.find("pixel \"march\"");
    ASSERT_NE(first, std::string::npos);
    const std::string example = page.substr(first, page.find("```", first) - first);
    const auto module = parse(example, "docs/ir.md");
    ASSERT_TRUE(module) << to_string(module.error());
    const Status status = verify(*module);
    EXPECT_TRUE(status) << to_string(status.error());
    EXPECT_EQ(print(*module), example);
}

}  // namespace
}  // namespace intaglio::ir
