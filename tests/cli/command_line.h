// A folder of one's own, and the program run in it.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "src/maps/makers.h"
#include "src/maps/png.h"

namespace intaglio::cli {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

inline std::string contents(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

struct Outcome {
    int code;
    std::string out, err;
};

class CommandLine : public testing::Test {
  protected:
    void SetUp() override {
        // A space, an umlaut and signs that shells and makefiles trip over.
        folder_ =
            fs::temp_directory_path() / ("intaglio t\xc3\xa4st @$# " + std::to_string(getpid()));
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    void write(const std::string& name, const std::string& bytes) const {
        std::ofstream(folder_ / name, std::ios::binary) << bytes;
    }
    void write_map(const std::string& name, const std::string& maker, int width, int height) const {
        const auto image = maps::make_height_map(maker, width, height, 1);
        ASSERT_TRUE(image.ok());
        ASSERT_TRUE(maps::write_png(folder_ / name, *image).ok());
    }

    // `before`: what the shell does first, "ulimit -f 1;".
    Outcome run(const std::vector<std::string>& arguments, const std::string& before = {}) const {
        std::string command = before + " '" INTAGLIO_TOOL "'";
        for (const std::string& argument : arguments) command += " '" + argument + "'";
        command += " >'" + path("out") + "' 2>'" + path("err") + "' </dev/null";
        const int status = std::system(command.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, contents(path("out")),
                contents(path("err"))};
    }
    // Bad input: exit code 2, one sentence with this code, nothing on stdout.
    Outcome expect_refused(const std::vector<std::string>& arguments,
                           const std::string& code) const {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, 2) << outcome.err;
        EXPECT_THAT(outcome.err, HasSubstr("[" + code + "]"));
        EXPECT_THAT(outcome.err, HasSubstr("error: "));
        EXPECT_EQ(outcome.out, "");
        return outcome;
    }
    std::vector<std::string> picture_of(const std::string& map) const {
        return {
            "run", "parallax_occlusion", "-T", "glsl_450", "--height", path(map), "--size", "32x32",
            "-o",  path("picture.png")};
    }

    fs::path folder_;
};

}  // namespace intaglio::cli
