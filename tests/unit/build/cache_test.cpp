// The cache: what was put is got, what was damaged is made again, what cannot be written is said.
#include "src/build/cache.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <thread>

#include <fmt/format.h>

#include "src/build/whole_file.h"

namespace intaglio::build {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class CacheTest : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::path(::testing::TempDir()) /
                  fmt::format("intaglio cache {}",
                              ::testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    std::vector<fs::path> files() const {
        std::vector<fs::path> all;
        for (const auto& entry : fs::recursive_directory_iterator(folder_))
            if (entry.is_regular_file()) all.push_back(entry.path());
        return all;
    }
    static std::string key(int number) { return fmt::format("{:032x}", number); }

    fs::path folder_;
};

TEST_F(CacheTest, GivesBackWhatWasPut) {
    Cache cache(folder_);
    EXPECT_EQ(cache.get(key(1)), std::nullopt);
    const std::string bytes("with\0zero and \n line", 20);
    cache.put(key(1), bytes);
    cache.put(key(2), "");
    EXPECT_EQ(cache.get(key(1)), bytes);
    EXPECT_EQ(cache.get(key(2)), "");
    EXPECT_EQ(Cache(folder_).get(key(1)), bytes) << "another process sees it";
    EXPECT_EQ(cache.hits(), 2);
    EXPECT_EQ(cache.misses(), 1);
    EXPECT_EQ(cache.trouble(), "");
}

TEST_F(CacheTest, WithoutAFolderNothingIsKept) {
    Cache cache({});
    cache.put(key(1), "bytes");
    EXPECT_EQ(cache.get(key(1)), std::nullopt);
}

// Every byte of an entry, one after the other.
TEST_F(CacheTest, ADamagedEntryIsAMissAndIsReplaced) {
    Cache(folder_).put(key(1), "the bytes");
    const fs::path file = files().at(0);
    std::string good;
    ASSERT_TRUE(read_bytes(file, good));
    for (std::size_t i = 0; i <= good.size(); ++i) {
        std::string bad = good;
        if (i < good.size())
            bad[i] = static_cast<char>(bad[i] ^ 1);
        else
            bad.pop_back();
        std::ofstream(file, std::ios::binary | std::ios::trunc) << bad;
        Cache cache(folder_);
        EXPECT_EQ(cache.get(key(1)), std::nullopt) << "byte " << i;
        EXPECT_THAT(cache.trouble(), HasSubstr("damaged"));
        cache.put(key(1), "the bytes");
        EXPECT_EQ(cache.get(key(1)), "the bytes");
    }
}

TEST_F(CacheTest, AFolderThatCannotBeMadeIsSaidOnceAndHurtsNobody) {
    std::ofstream(folder_.string()) << "a file stands where the folder should be";
    Cache cache(folder_);
    cache.put(key(1), "bytes");
    cache.put(key(2), "bytes");
    EXPECT_EQ(cache.get(key(1)), std::nullopt);
    EXPECT_THAT(cache.trouble(), HasSubstr("nothing is kept in the cache"));
}

TEST_F(CacheTest, ManyWritersAndReadersOfOneEntrySeeItWholeOrNotAtAll) {
    std::vector<std::thread> threads;
    std::atomic<int> wrong{0};
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&] {
            Cache cache(folder_);
            for (int i = 0; i < 25; ++i) {
                const std::string bytes(static_cast<std::size_t>(i % 5) * 5000, 'x');
                cache.put(key(i % 5), bytes);
                const std::optional<std::string> got = cache.get(key(i % 5));
                if (!got || *got != bytes) ++wrong;
            }
            if (!cache.trouble().empty()) ++wrong;
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(wrong, 0);
    EXPECT_EQ(files().size(), 5u) << "no temporary is left";
}

TEST_F(CacheTest, PruningKeepsWhatWasUsedLast) {
    Cache cache(folder_);
    const std::string bytes(1000, 'x');
    const auto now = fs::file_time_type::clock::now();
    for (int i = 0; i < 10; ++i) {
        cache.put(key(i), bytes);
        for (const fs::path& file : files())
            if (file.filename() == key(i))
                fs::last_write_time(file, now - std::chrono::hours(20 - i));
    }
    ASSERT_TRUE(cache.get(key(0)).has_value());  // used just now
    const Result<Pruned> pruned = prune_cache(folder_, 3500);
    ASSERT_TRUE(pruned.ok()) << to_string(pruned.error());
    EXPECT_EQ(pruned->kept, 3);
    EXPECT_EQ(pruned->entries, 7);
    EXPECT_LE(pruned->kept_bytes, 3500u);
    for (int i : {0, 8, 9}) EXPECT_TRUE(cache.get(key(i)).has_value()) << i;
    for (int i : {1, 4, 7}) EXPECT_FALSE(cache.get(key(i)).has_value()) << i;
    EXPECT_EQ(prune_cache(folder_, 0)->kept, 0);
    EXPECT_EQ(files().size(), 0u);
    EXPECT_TRUE(prune_cache(folder_ / "none", 0).ok()) << "no cache yet";
}

TEST(CacheSize, IsReadAsPeopleWriteIt) {
    EXPECT_EQ(*parse_bytes("0"), 0u);
    EXPECT_EQ(*parse_bytes("12345"), 12345u);
    EXPECT_EQ(*parse_bytes("1K"), 1024u);
    EXPECT_EQ(*parse_bytes("500M"), 500u << 20);
    EXPECT_EQ(*parse_bytes("2G"), std::uint64_t{2} << 30);
    for (const char* wrong : {"", "G", "1g", "-1", "1.5G", "1 G", "99999999999G"}) {
        const Result<std::uint64_t> size = parse_bytes(wrong);
        ASSERT_FALSE(size.ok()) << wrong;
        EXPECT_EQ(size.error().code, "size-syntax");
    }
}

}  // namespace
}  // namespace intaglio::build
