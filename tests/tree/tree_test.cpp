// The tree itself: every include of the compiler, the techniques and the tool, and every file's
// length and marks.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "tests/tree/checker.h"

namespace intaglio::tree {
namespace {

namespace fs = std::filesystem;

const fs::path root = INTAGLIO_SOURCE_DIR;

bool is_code(const fs::path& path) {
    constexpr std::array<std::string_view, 7> kinds = {".cpp", ".cc",  ".cxx",  ".h",
                                                       ".hpp", ".inc", ".cmake"};
    const std::string kind = path.extension().string();
    return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

// Paths of the code below `folder`, relative to the root, in order.
std::vector<std::string> code_in(std::string_view folder) {
    std::vector<std::string> paths;
    if (!fs::exists(root / folder)) return paths;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(root / folder))
        if (entry.is_regular_file() && is_code(entry.path()))
            paths.push_back(entry.path().lexically_relative(root).generic_string());
    std::sort(paths.begin(), paths.end());
    return paths;
}

std::string text_of(const std::string& path) {
    std::ifstream file(root / path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::string lines(const std::vector<std::string>& faults) {
    std::string text;
    for (const std::string& fault : faults) text += fault + "\n";
    return text;
}

TEST(Tree, NoIncludeGoesAgainstTheOrder) {
    int includes_read = 0;
    for (std::string_view top : {"generator", "templates", "src"})
        for (const std::string& path : code_in(top)) {
            const std::string text = text_of(path);
            ASSERT_FALSE(text.empty()) << path << " is empty or cannot be read";
            includes_read += text.find("#include") != std::string::npos;
            EXPECT_EQ(lines(check_includes(rules(), path, text)), "");
        }
    EXPECT_GT(includes_read, 100) << "the tree has more files than this: the test looks elsewhere";
}

TEST(Tree, FilesAreShortAndFinished) {
    for (std::string_view top : {"generator", "templates", "src", "tests", "examples", "cmake"})
        for (const std::string& path : code_in(top))
            EXPECT_EQ(lines(check_text(rules(), path, text_of(path))), "");
}

TEST(Tree, TableAgreesWithItselfAndWithTheFolders) {
    EXPECT_EQ(lines(check_rules(rules())), "");
    for (const Row& row : rules().rows)
        EXPECT_TRUE(fs::exists(root / row.path)) << row.path << " has a row, but does not exist";
    for (std::string_view table : rules().tables)
        EXPECT_GT(std::ranges::count(text_of(std::string(table)), '\n'), rules().longest_file)
            << table << " is excused for its length, but is not long";
}

}  // namespace
}  // namespace intaglio::tree
