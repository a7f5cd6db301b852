// docs/techniques: every technique has its block and its picture, and what `intaglio pages` writes
// today is what is there: a part of it, written again.
#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "src/maps/png.h"
#include "src/report/exhibit.h"
#include "src/report/page_block.h"
#include "templates/all_techniques.h"

namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using namespace intaglio;

const fs::path docs = INTAGLIO_ROOT "/docs";

std::string contents(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

// Every block of the pages in a folder, by title; a title that stands twice is a failure.
std::map<std::string, std::string> blocks_in(const fs::path& folder) {
    std::map<std::string, std::string> blocks;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        const std::string page = contents(entry.path());
        for (const std::string& title : report::blocks_of(page))
            EXPECT_TRUE(blocks.emplace(title, report::block_text(page, title)).second)
                << title << " stands twice, again in " << entry.path();
    }
    return blocks;
}

fs::path picture_in(const fs::path& folder, const std::string& block) {
    const std::string opening = "](../";
    const std::size_t at = block.find(opening);
    if (at == std::string::npos) return {};
    const std::size_t first = at + opening.size();
    return folder / block.substr(first, block.find(')', first) - first);
}

TEST(Pages, EveryTechniqueHasItsBlockAndItsPicture) {
    std::map<std::string, std::string> blocks = blocks_in(docs / "techniques");
    for (const report::Exhibit& exhibit : report::exhibits_of(templates::all_techniques())) {
        const std::string block = blocks[exhibit.title];
        EXPECT_THAT(block, HasSubstr("| map, ")) << exhibit.title << ": intaglio pages -o docs";
        const fs::path picture = picture_in(docs, block);
        EXPECT_TRUE(fs::is_regular_file(picture)) << exhibit.title << ": " << picture;
        blocks.erase(exhibit.title);
    }
    for (const auto& [title, block] : blocks)
        ADD_FAILURE() << "the block " << title << " is of no technique";
}

class PagesWritten : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("intaglio pages " + std::to_string(getpid()));
        fs::create_directories(folder_);
        fs::copy(docs / "techniques", folder_ / "techniques");
    }
    void TearDown() override { fs::remove_all(folder_); }

    int pages(const std::string& options) const {
        const std::string command = "'" INTAGLIO_TOOL "' pages --maps '" INTAGLIO_ROOT
                                    "/examples/maps' -o '" +
                                    folder_.string() + "' " + options + " 2>/dev/null </dev/null";
        return WEXITSTATUS(std::system(command.c_str()));
    }

    fs::path folder_;
};

// Chosen because they take a second each: one of each kind of error, and no long unrolled loop.
TEST_F(PagesWritten, AreTheCommittedOnes) {
    const std::vector<std::string> sample = {"search=parallax_limited", "shading=lambert",
                                             "output=displaced"};
    std::string options = "-j 2";
    for (const std::string& title : sample) options += " --only " + title;
    ASSERT_EQ(pages(options), 0);
    std::map<std::string, std::string> committed = blocks_in(docs / "techniques"),
                                       written = blocks_in(folder_ / "techniques");
    EXPECT_EQ(committed, written) << "write them again: intaglio pages -o docs";
    for (const std::string& title : sample) {
        const Result<maps::Image> before = maps::read_png(picture_in(docs, committed[title])),
                                  now = maps::read_png(picture_in(folder_, written[title]));
        ASSERT_TRUE(before.ok() && now.ok()) << title;
        ASSERT_EQ(before->width, now->width);
        ASSERT_EQ(before->height, now->height);
        // Another processor may round another way, which moves single pixels by a step of colour.
        std::size_t other = 0;
        for (std::size_t i = 0; i < now->texels.size(); ++i)
            other += std::abs(before->texels[i] - now->texels[i]) > 0.1f ? 1 : 0;
        EXPECT_LE(other, now->texels.size() / 100) << title << ": intaglio pages -o docs";
    }
}

TEST_F(PagesWritten, AnUnknownTitleIsRefusedAndAMissingBlockToo) {
    EXPECT_EQ(pages("--only search=marsh"), 2);
    fs::remove(folder_ / "techniques" / "relief.md");
    EXPECT_EQ(pages("--only search=relief"), 2);
    EXPECT_FALSE(fs::exists(folder_ / "images"));
}

}  // namespace
