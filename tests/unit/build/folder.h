// A folder of one's own with a scene in it, and looks at what was built.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <unistd.h>

#include "src/build/build.h"
#include "templates/all_techniques.h"

namespace intaglio::build {

namespace fs = std::filesystem;

inline const dsl::Catalogue& techniques() {
    static const dsl::Catalogue all = templates::all_techniques();
    return all;
}

inline std::string contents(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

class BuildFolder : public ::testing::Test {
  protected:
    void SetUp() override {
        // A space, an umlaut and signs that shells and makefiles trip over.
        folder_ =
            fs::temp_directory_path() / ("intaglio b\xc3\xa4u @$# " + std::to_string(::getpid()));
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    void write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name, std::ios::binary | std::ios::trunc) << text;
    }

    // One surface that is pinned: nothing of it is measured.
    static std::string surface(const std::string& name, const std::string& search,
                               const std::string& more = {}) {
        return "[[surface]]\nname = '" + name + "'\nmaker = 'bricks'\nwidth = 16\nheight = 16\n" +
               "search = '" + search + "'\nshadow = 'none'\nnormal = 'map'\nshading = 'lambert'\n" +
               "output = 'colour'\nvertex = 'tangent_space'\n" + more;
    }
    static std::string head(const std::string& targets) {
        return "name = 'harbour'\ntargets = " + targets +
               "\n[tolerance]\np95 = 100\n[[light]]\nname = 'sun'\nelevation = 45\nazimuth = 20\n";
    }
    void write_scene(const std::string& targets, const std::vector<std::string>& surfaces) const {
        std::string text = head(targets);
        for (const std::string& each : surfaces) text += each;
        write("harbour.toml", text);
    }

    BuildOptions options(const std::string& output = "out") const {
        BuildOptions all;
        all.scene = folder_ / "harbour.toml";
        all.output = folder_ / output;
        all.jobs = 1;
        all.planner = pinned_orders;
        return all;
    }

    // Every file below a folder but the build's own state, by name.
    std::map<std::string, std::string> built(const std::string& output = "out") const {
        std::map<std::string, std::string> files;
        for (const auto& entry : fs::recursive_directory_iterator(folder_ / output)) {
            const std::string name = entry.path().lexically_relative(folder_ / output).string();
            if (entry.is_regular_file() && name.rfind(std::string(state_folder), 0) != 0)
                files[name] = contents(entry.path());
        }
        return files;
    }

    fs::path folder_;
};

}  // namespace intaglio::build
