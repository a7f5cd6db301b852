// Files of every unhelpful kind, read and written through the public functions.
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "src/maps/files.h"
#include "src/maps/png.h"

namespace intaglio::maps {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// A folder of its own for each test.
class PngFiles : public testing::Test {
  protected:
    void SetUp() override {
        std::string pattern = testing::TempDir() + "intaglio_maps_XXXXXX";
        ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
        folder_ = pattern;
        // Others may enter: the permission tests give up being root.
        fs::permissions(folder_, fs::perms(0755));
    }
    void TearDown() override { fs::remove_all(folder_); }

    fs::path file(const std::string& name, const std::string& content) const {
        std::ofstream(folder_ / name, std::ios::binary) << content;
        return folder_ / name;
    }
    std::size_t files_in_folder() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
    }
    fs::path folder_;
};

// Root may read and write everything, so that a test of permissions must be someone else meanwhile.
class NotRoot {
  public:
    NotRoot() : user_(::geteuid()) {
        if (user_ == 0) changed_ = ::seteuid(65534) == 0;
    }
    NotRoot(const NotRoot&) = delete;
    NotRoot& operator=(const NotRoot&) = delete;
    ~NotRoot() {
        if (changed_ && ::seteuid(user_) != 0) ADD_FAILURE() << "cannot become root again";
    }
    bool ok() const { return user_ != 0 || changed_; }

  private:
    ::uid_t user_;
    bool changed_ = false;
};

Image gradient() {
    Image image = blank_image(5, 4, 1, 8);
    for (std::size_t i = 0; i < image.texels.size(); ++i) {
        image.texels[i] = static_cast<float>(i) / 255.0f;
    }
    return image;
}

void expect_error(const Diagnostic& error, const std::string& code, const fs::path& path) {
    EXPECT_EQ(error.code, code) << to_string(error);
    EXPECT_EQ(error.file, path.string());
    EXPECT_EQ(error.fault, Fault::Input);
    EXPECT_THAT(to_string(error), HasSubstr(path.filename().string()));
    EXPECT_FALSE(error.message.empty());
    EXPECT_NE(error.message.back(), '.');
}

void expect_unreadable(const fs::path& path, const std::string& code) {
    const Result<Image> image = read_png(path);
    ASSERT_FALSE(image.ok()) << path;
    expect_error(image.error(), code, path);
}

TEST_F(PngFiles, RoundTrip) {
    const fs::path path = folder_ / "map.png";
    const Status status = write_png(path, gradient());
    ASSERT_TRUE(status.ok()) << to_string(status.error());
    const Result<Image> image = read_png(path);
    ASSERT_TRUE(image.ok()) << to_string(image.error());
    EXPECT_EQ(*image, gradient());
    EXPECT_EQ(files_in_folder(), 1u);
}

TEST_F(PngFiles, MissingFile) {
    expect_unreadable(folder_ / "missing.png", "file-missing");
    expect_unreadable(folder_ / "no" / "such" / "folder.png", "file-missing");
    expect_unreadable(file("plain", "x") / "below.png", "file-missing");
}

TEST_F(PngFiles, Folder) {
    fs::create_directory(folder_ / "folder.png");
    expect_unreadable(folder_ / "folder.png", "file-is-directory");
}

TEST_F(PngFiles, NoPermissionToRead) {
    const fs::path path = file("secret.png", "x");
    fs::permissions(path, fs::perms::none);
    const NotRoot someone;
    ASSERT_TRUE(someone.ok());
    expect_unreadable(path, "file-unreadable");
}

TEST_F(PngFiles, EmptyFile) { expect_unreadable(file("empty.png", ""), "file-empty"); }

TEST_F(PngFiles, TextNamedPng) {
    const fs::path path = file("notes.png", "Remember to draw the height map.\n");
    expect_unreadable(path, "not-a-png");
    EXPECT_THAT(read_png(path).error().message, HasSubstr("text file"));
}

TEST_F(PngFiles, JpegNamedPng) {
    const fs::path path = file("photo.png", std::string("\xff\xd8\xff\xe0\0\x10JFIF", 10));
    expect_unreadable(path, "not-a-png");
    EXPECT_THAT(read_png(path).error().message, HasSubstr("JPEG"));
}

TEST_F(PngFiles, TruncatedAndCorrupt) {
    const auto bytes = encode_png(gradient());
    ASSERT_TRUE(bytes.ok());
    std::string content(bytes->begin(), bytes->end());
    expect_unreadable(file("half.png", content.substr(0, content.size() / 2)), "png-truncated");
    content[content.find("IDAT") + 4] ^= 1;
    expect_unreadable(file("flipped.png", content), "png-corrupt");
}

TEST_F(PngFiles, AFileLongerThanTheLimitIsRefused) {
    const fs::path path = file("long", std::string(200000, 'x'));
    EXPECT_TRUE(read_file(path, 200000).ok());
    const auto bytes = read_file(path, 199999);
    ASSERT_FALSE(bytes.ok());
    expect_error(bytes.error(), "file-too-large", path);
}

TEST_F(PngFiles, WritingIntoNoFolder) {
    const fs::path path = folder_ / "no" / "such.png";
    const Status status = write_png(path, gradient());
    ASSERT_FALSE(status.ok());
    expect_error(status.error(), "file-unwritable", path);
    EXPECT_THAT(status.error().message, HasSubstr("no folder"));
}

TEST_F(PngFiles, WritingOverAFolder) {
    fs::create_directory(folder_ / "folder.png");
    const Status status = write_png(folder_ / "folder.png", gradient());
    ASSERT_FALSE(status.ok());
    expect_error(status.error(), "file-is-directory", folder_ / "folder.png");
    EXPECT_EQ(files_in_folder(), 1u);
}

TEST_F(PngFiles, WritingWithoutPermissionKeepsWhatWasThere) {
    const fs::path path = file("old.png", "old");
    fs::permissions(folder_, fs::perms(0555));
    {
        const NotRoot someone;
        ASSERT_TRUE(someone.ok());
        const Status status = write_png(path, gradient());
        ASSERT_FALSE(status.ok());
        expect_error(status.error(), "file-unwritable", path);
        EXPECT_THAT(status.error().message, HasSubstr("permission"));
    }
    fs::permissions(folder_, fs::perms(0755));
    EXPECT_EQ(fs::file_size(path), 3u);
    EXPECT_EQ(files_in_folder(), 1u);
}

TEST_F(PngFiles, WritingOntoAFullDevice) {
    const Status status = write_png("/dev/full", gradient());
    ASSERT_FALSE(status.ok());
    expect_error(status.error(), "file-unwritable", "/dev/full");
    EXPECT_TRUE(fs::is_character_file("/dev/full"));  // written to, not replaced
}

TEST_F(PngFiles, AMalformedImageLeavesNoFile) {
    Image image = gradient();
    image.texels.pop_back();
    const Status status = write_png(folder_ / "bad.png", image);
    ASSERT_FALSE(status.ok());
    expect_error(status.error(), "image-malformed", folder_ / "bad.png");
    EXPECT_EQ(files_in_folder(), 0u);
}

TEST_F(PngFiles, AFileIsTouchedOnlyWhenItsBytesChange) {
    const fs::path path = folder_ / "map.png";
    ASSERT_TRUE(write_png(path, gradient()).ok());
    const auto long_ago = fs::file_time_type::clock::now() - std::chrono::hours(24);
    fs::last_write_time(path, long_ago);
    const auto before = fs::last_write_time(path);
    ASSERT_TRUE(write_png(path, gradient()).ok());
    EXPECT_EQ(fs::last_write_time(path), before);

    Image other = gradient();
    other.at(0, 0) = 1.0f;
    ASSERT_TRUE(write_png(path, other).ok());
    EXPECT_NE(fs::last_write_time(path), before);
    EXPECT_EQ(read_png(path)->at(0, 0), 1.0f);
}

}  // namespace
}  // namespace intaglio::maps
