// docs/targets/d3d9_variants.md is what `intaglio table` writes: a part of it, written again.
#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::string contents(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

// From the first technique on.
std::string sections_of(const std::string& text) {
    const std::size_t first = text.find("\n## ");
    return first == std::string::npos ? "" : text.substr(first + 1);
}

class VariantsTable : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("intaglio table " + std::to_string(getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    std::string table(const std::string& only, const std::string& threads, int code = 0) const {
        const std::string file = (folder_ / ("table" + threads + ".md")).string();
        const std::string command = "'" INTAGLIO_TOOL "' table --only '" + only + "' -j " +
                                    threads + " -o '" + file + "' 2>/dev/null </dev/null";
        const int status = std::system(command.c_str());
        EXPECT_EQ(WEXITSTATUS(status), code) << command;
        return contents(file);
    }

    fs::path folder_;
};

TEST_F(VariantsTable, TheCommittedOneIsToday) {
    const std::string committed = contents(INTAGLIO_ROOT "/docs/targets/d3d9_variants.md");
    ASSERT_NE(committed, "");
    for (const char* only : {"normal=", "shading=", "output="}) {
        const std::string written = sections_of(table(only, "2"));
        ASSERT_NE(written, "");
        EXPECT_THAT(committed, HasSubstr(written))
            << "write it again: intaglio table -j 4 -o docs/targets/d3d9_variants.md";
    }
}

TEST_F(VariantsTable, ThreadsDoNotChangeIt) {
    EXPECT_EQ(table("shading=", "1"), table("shading=", "3"));
}

TEST_F(VariantsTable, AnUnknownTitleIsRefused) { EXPECT_EQ(table("no such", "1", 2), ""); }

}  // namespace
