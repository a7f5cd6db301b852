// Results on disk: what a kill leaves of a line goes, what is whole stays, and nothing is believed
// that is no result.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "src/measure/sweep_store.h"

namespace intaglio::measure {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Pair;
using testing::UnorderedElementsAre;

class Store : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("intaglio store " + std::to_string(getpid()));
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    void write(const std::string& text) const {
        std::ofstream(folder_ / "results.jsonl", std::ios::binary) << text;
    }
    std::string text() const {
        std::ifstream file(folder_ / "results.jsonl", std::ios::binary);
        std::stringstream all;
        all << file.rdbuf();
        return all.str();
    }

    fs::path folder_;
};

const std::string line_a = R"({"key":"a","x":1})", line_b = R"({"key":"b","x":2})";

TEST_F(Store, KeepsWholeLinesWhateverAKillLeftOfTheLast) {
    for (std::size_t cut = 0; cut <= line_b.size(); ++cut) {
        write(line_a + "\n" + line_b.substr(0, cut));
        const auto store = SweepStore::open(folder_);
        ASSERT_TRUE(store.ok()) << cut;
        EXPECT_THAT(store->lines(), UnorderedElementsAre(Pair("a", line_a))) << cut;
        EXPECT_EQ(text(), line_a + "\n") << "the next line must not be glued to the rest";
    }
}

TEST_F(Store, AppendsAtOnceAndSortsAtTheEnd) {
    auto store = SweepStore::open(folder_ / "made" / "as needed");
    ASSERT_TRUE(store.ok());
    folder_ = folder_ / "made" / "as needed";
    ASSERT_TRUE(store->append("b", line_b).ok());
    EXPECT_EQ(text(), line_b + "\n");
    ASSERT_TRUE(store->append("a", line_a).ok());
    EXPECT_EQ(text(), line_b + "\n" + line_a + "\n");
    ASSERT_TRUE(store->sort().ok());
    EXPECT_EQ(text(), line_a + "\n" + line_b + "\n");
    const auto dropped = store->keep_only({"b", "c"});
    ASSERT_TRUE(dropped.ok());
    EXPECT_EQ(*dropped, 1);
    EXPECT_EQ(text(), line_b + "\n");
    ASSERT_TRUE(store->append("a", line_a).ok()) << "after the file was replaced";
    EXPECT_EQ(text(), line_b + "\n" + line_a + "\n");
}

TEST_F(Store, CountsARepeatedLineOnce) {
    write(line_a + "\n" + line_a + "\n");
    ASSERT_TRUE(SweepStore::open(folder_).ok());
    EXPECT_EQ(text(), line_a + "\n");
}

TEST_F(Store, RefusesALineThatIsNoResult) {
    for (const char* broken : {"{\"key\":", "[]", "{\"x\":1}", "", "{\"key\":3}"}) {
        write(line_a + "\n" + broken + "\n" + line_b + "\n");
        const auto store = SweepStore::open(folder_);
        ASSERT_FALSE(store.ok()) << broken;
        EXPECT_EQ(store.error().code, "sweep-broken");
        EXPECT_EQ(store.error().line, 2);
        EXPECT_THAT(text(), HasSubstr("\"b\"")) << "nothing is deleted by itself";
    }
}

TEST_F(Store, HasOneWriter) {
    const auto first = SweepStore::open(folder_);
    ASSERT_TRUE(first.ok());
    const auto second = SweepStore::open(folder_);
    ASSERT_FALSE(second.ok());
    EXPECT_EQ(second.error().code, "sweep-busy");
}

TEST_F(Store, ReadsItsManifestBack) {
    const Manifest manifest{"id", "a device", {"b", "a"}};
    ASSERT_TRUE(write_manifest(folder_, manifest).ok());
    const auto read = read_manifest(folder_);
    ASSERT_TRUE(read.ok());
    EXPECT_EQ(*read, manifest);
    std::ofstream(folder_ / "sweep.json") << "{}";
    EXPECT_EQ(read_manifest(folder_).error().code, "sweep-manifest");
}

}  // namespace
}  // namespace intaglio::measure
