// A scene written to a folder of its own, which goes with the test.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "src/scene/measurement.h"

namespace intaglio::scene {

class SceneFile {
  public:
    explicit SceneFile(const std::string& text) {
        const ::testing::TestInfo& test = *::testing::UnitTest::GetInstance()->current_test_info();
        static int count = 0;
        folder_ = std::filesystem::temp_directory_path() /
                  ("intaglio scene " + std::to_string(getpid()) + " " + test.name() + " " +
                   std::to_string(++count));
        std::filesystem::create_directories(folder_);
        std::ofstream(path()) << text;
    }
    SceneFile(const SceneFile&) = delete;
    SceneFile& operator=(const SceneFile&) = delete;
    ~SceneFile() {
        std::error_code ignored;
        std::filesystem::remove_all(folder_, ignored);
    }

    std::filesystem::path path() const { return folder_ / "scene.toml"; }
    const std::filesystem::path& folder() const { return folder_; }

  private:
    std::filesystem::path folder_;
};

// The smallest parts that a scene needs, one line and three lines long.
inline const std::string one_variant = "[[variant]]\nsurface = 'none'\ntargets = ['glsl_450']\n";
inline const std::string one_map = "[[map]]\nmaker = 'flat1'\nwidth = 4\n";

}  // namespace intaglio::scene
