// Headers as an engine meets them: compiled by two compilers in two versions of C++ with every
// warning an error, and run against the files beside them.
#include "src/build/header.h"

#include <gmock/gmock.h>

#include <cstdlib>

#include "src/maps/files.h"
#include "tests/unit/build/folder.h"

namespace intaglio::build {
namespace {

using ::testing::HasSubstr;

// What every target and every form of code has in common.  main() compares the bytes of all codes
// with the files, and each table with the struct that it describes.
constexpr std::string_view program = R"cpp(
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>

#include "quay.h"
#include "wall.h"
#include "wall.h"

    namespace quay = game::shaders::quay;
    static_assert(quay::find("ps_2_0") == &quay::ps_2_0::variant, "by target");
    static_assert(quay::find("quay.glsl_450") == &quay::glsl_450::variant, "by name");
    static_assert(quay::find("ps_9_9") == nullptr, "none");
    static_assert(sizeof(quay::glsl_450::PixelUniforms) ==
                      quay::glsl_450::variant.pixel.uniform_bytes,
                  "");
    static_assert(quay::ps_2_0::variant.pixel.registers * 16 == sizeof(quay::ps_2_0::PixelUniforms),
                  "");

    template <typename Code>
    bool same(const char* folder, const Code& code, bool wanted) {
        if (code.data == nullptr) return !wanted && code.size == 0;
        std::ifstream file(std::string(folder) + "/" + code.file, std::ios::binary);
        const std::string bytes{std::istreambuf_iterator<char>(file), {}};
        const bool equal = bytes.size() == code.size && !bytes.empty() &&
                           std::memcmp(bytes.data(), code.data, code.size) == 0;
        if (!equal) std::printf("%s differs\n", code.file);
        return equal && std::strlen(code.entry) > 0;
    }

    template <typename Stage>
    bool tidy(const Stage& stage) {
        int end = 0;
        for (const auto& uniform : stage.uniforms) {
            if (uniform.offset < end || uniform.components < 1 || uniform.components > 4) return false;
            end = uniform.offset + (uniform.elements > 1 ? uniform.elements * uniform.stride
                                                         : 4 * uniform.components);
        }
        for (const auto& sampler : stage.samplers)
            if (std::strlen(sampler.name) == 0 || std::strlen(sampler.map) == 0) return false;
        return end <= stage.uniform_bytes;
    }

    template <typename Variants>
    bool check(const char* folder, const Variants& variants) {
        bool fine = true;
        for (const auto* variant : variants) {
            const std::string target = variant->target;
            const bool binary = target == "spirv" || target == "glsl_450" || target == "ps_2_0";
            const bool text = target != "spirv";
            for (const auto* stage : {&variant->vertex, &variant->pixel}) {
                fine = same(folder, stage->text, text) && fine;
                fine = same(folder, stage->binary, binary) && fine;
                if (!tidy(*stage)) {
                    std::printf("%s: a table does not fit its struct\n", variant->name);
                    fine = false;
                }
            }
        }
        return fine;
    }

    int main(int count, char** arguments) {
        if (count != 2) return 2;
        quay::glsl_330::PixelUniforms uniforms = {};
        uniforms.ambient[2] = 1.0f;
        float given[3];
        for (const auto& each : quay::glsl_330::variant.pixel.uniforms)
            if (std::string(each.name) == "ambient")
                std::memcpy(given, reinterpret_cast<const char*>(&uniforms) + each.offset,
                            sizeof given);
        const bool fine = check(arguments[1], quay::variants) &&
                          check(arguments[1], game::shaders::wall::variants) && given[2] == 1.0f;
        std::printf("%s\n", fine ? "fine" : "wrong");
        return fine ? 0 : 1;
    }
)cpp";

class Header : public BuildFolder {
  protected:
    // Exit code of the shell, whose words are printed where it fails.
    int shell(const std::string& command) const {
        const std::string log = maps::shell_quoted((folder_ / "log").string());
        const int status = std::system((command + " >" + log + " 2>&1").c_str());
        if (status != 0) std::fputs(contents(folder_ / "log").c_str(), stderr);
        return status;
    }
    std::string quoted(const std::string& name) const {
        return maps::shell_quoted((folder_ / name).string());
    }
};

TEST_F(Header, CompilesEverywhereAndHoldsTheBytesOfTheFiles) {
    write_scene(
        "['ps_2_0', 'hlsl_3_0', 'hlsl_5_0', 'glsl_330', 'essl_100', 'glsl_450', 'spirv', "
        "'msl']",
        {surface("quay", "parallax"), surface("wall", "none")});
    BuildOptions wanted = options();
    wanted.name_space = "game::shaders";
    wanted.jobs = 2;
    const Result<BuildReport> report = build_scene(techniques(), wanted);
    ASSERT_TRUE(report.ok()) << to_string(report.error());
    write("use.cpp", std::string(program));
    for (const std::string compiler : {INTAGLIO_GXX, INTAGLIO_CLANGXX}) {
        const std::string command = maps::shell_quoted(compiler) +
                                    " -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror -I " +
                                    quoted("out") + " " + quoted("use.cpp");
        EXPECT_EQ(shell(command + " -std=c++20 -fsyntax-only"), 0) << compiler;
        ASSERT_EQ(shell(command + " -std=c++17 -O0 -o " + quoted("use")), 0) << compiler;
        EXPECT_EQ(shell(quoted("use") + " " + quoted("out")), 0) << compiler;
        EXPECT_EQ(contents(folder_ / "log"), "fine\n");
    }
}

// Names and texts that C++ would trip over.
TEST(HeaderText, SurvivesWhateverATextHolds) {
    BuiltVariant variant;
    variant.order.surface = "quay";
    variant.order.request.target = "glsl_330";
    BundleFile file;
    file.name = "quay.glsl_330.frag";
    file.stage = ir::Stage::Pixel;
    file.entry = "main";
    file.bytes = "\"quotes\" \\ back ?\?/ tri\001graph \xc3\xa4 */ \r\n no end of line";
    variant.bundle.files = {file};
    Uniform uniform;
    uniform.name = "default";  // a keyword
    uniform.comment = "ends in a backslash \\\n and goes on";
    variant.bundle.interface.pixel.block.uniforms = {uniform};
    variant.bundle.interface.pixel.block.size = 4;
    const std::string text = header_text("quay", {&variant}, {}, "");
    const fs::path folder = fs::temp_directory_path() / ("intaglio h " + std::to_string(getpid()));
    fs::create_directories(folder);
    std::ofstream(folder / "quay.h") << text;
    std::ofstream(folder / "use.cpp") << R"cpp(
#include "quay.h"
        static_assert(quay::glsl_330::variant.pixel.text.size ==
                          sizeof(quay::glsl_330::pixel_text) - 1,
                      "");
        static_assert(quay::glsl_330::pixel_text[0] == '"' && quay::glsl_330::pixel_text[16] == '?', "");
        int main() { return quay::glsl_330::PixelUniforms{}.default_ == 0.0f ? 0 : 1; }
    )cpp";
    const std::string command = maps::shell_quoted(INTAGLIO_GXX) +
                                " -std=c++17 -Wall -Wextra -Wpedantic -Werror -fsyntax-only " +
                                maps::shell_quoted((folder / "use.cpp").string());
    EXPECT_EQ(std::system(command.c_str()), 0) << text;
    fs::remove_all(folder);
}

TEST(HeaderText, KnowsANamespace) {
    for (const char* right : {"", "game", "game::shaders", "a_1::b"})
        EXPECT_TRUE(is_namespace(right));
    for (const char* wrong : {"1a", "a:b", "a::", "::a", "a b", "class", "a::new", "a-b"})
        EXPECT_FALSE(is_namespace(wrong)) << wrong;
}

}  // namespace
}  // namespace intaglio::build
