// One march in every language, as committed text: what a person would notice in a review.  Update
// with INTAGLIO_UPDATE_GOLDENS=1; missing, changed and orphaned files all fail.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/unit/target/programs.h"

namespace intaglio {
namespace {

namespace fs = std::filesystem;

const fs::path folder = fs::path(INTAGLIO_SOURCE_DIR) / "tests/golden/target";

std::string read(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

ir::Program march() {
    ir::Program program = testing::program_of(testing::parsed(read(folder / "march.ir")));
    program.name = "march";
    program.description = "March the view ray down until a sample rises above it.";
    program.settings = {"taps = 8"};
    return program;
}

// Compares the text with the committed one, or commits it; the file's name.
std::string compare(const Artifact& artifact, std::string_view target) {
    const std::string name = "march." + std::string(target) + artifact.extension;
    if (std::getenv("INTAGLIO_UPDATE_GOLDENS") != nullptr)
        std::ofstream(folder / name, std::ios::binary) << artifact.text;
    EXPECT_TRUE(fs::exists(folder / name))
        << name << " is missing; INTAGLIO_UPDATE_GOLDENS=1 writes it";
    EXPECT_EQ(read(folder / name), artifact.text)
        << name << " changed; INTAGLIO_UPDATE_GOLDENS=1 accepts it";
    return name;
}

TEST(Golden, MarchReadsAsCommitted) {
    std::set<std::string> expected = {"march.ir"};
    // Assembly is judged where it is made; here it is only read.
    for (const char* target : {"ps_2_0", "ps_2_b", "ps_3_0"})
        for (ir::Stage stage : {ir::Stage::Vertex, ir::Stage::Pixel})
            expected.insert(compare(testing::emitted(march(), stage, target), target));
    for (const testing::TextTarget& target : testing::text_targets)
        for (ir::Stage stage : {ir::Stage::Vertex, ir::Stage::Pixel}) {
            const Artifact artifact = testing::emitted(march(), stage, target.name);
            const std::string name = compare(artifact, target.name);
            expected.insert(name);
            const auto words = testing::accepted(testing::source_of(artifact, target.language));
            EXPECT_TRUE(words.ok()) << name << ": " << to_string(words.error());
        }
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
        EXPECT_TRUE(expected.count(entry.path().filename().string()))
            << entry.path().filename() << " belongs to no target; delete it";
}

}  // namespace
}  // namespace intaglio
