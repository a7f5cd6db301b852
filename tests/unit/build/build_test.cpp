// A scene built: what is written, when it is written again, and when nothing is.
#include "src/build/build.h"

#include <gmock/gmock.h>

#include <set>
#include <thread>

#include "src/build/depfile.h"
#include "tests/unit/build/folder.h"

namespace intaglio::build {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Key;
using ::testing::Not;

std::set<std::string> names_of(const std::map<std::string, std::string>& files) {
    std::set<std::string> names;
    for (const auto& [name, bytes] : files) names.insert(name);
    return names;
}

class Build : public BuildFolder {
  protected:
    BuildReport build(const BuildOptions& wanted) const {
        const Result<BuildReport> report = build_scene(techniques(), wanted);
        EXPECT_TRUE(report.ok()) << to_string(report.error());
        return report.ok() ? *report : BuildReport();
    }
    std::string refusal(const BuildOptions& wanted) const {
        const Result<BuildReport> report = build_scene(techniques(), wanted);
        EXPECT_FALSE(report.ok());
        return report.ok() ? std::string() : report.error().code;
    }
    std::set<std::string> promised() const {
        const Result<scene::Scene> scene = scene_of(techniques(), options());
        EXPECT_TRUE(scene.ok());
        const std::vector<std::string> names = static_outputs(*scene);
        return {names.begin(), names.end()};
    }
};

TEST_F(Build, WritesWhatItPromisedTheMapsThatAreReadAndNothingElse) {
    write_scene("['glsl_330', 'hlsl_3_0']",
                {surface("quay", "parallax"), surface("wall", "cone_relaxed")});
    const BuildReport report = build(options());
    EXPECT_EQ(report.variants, 4);
    EXPECT_EQ(report.surfaces, 2);
    std::set<std::string> expected = promised();
    for (const char* map : {"quay.height.png", "quay.normal.png", "quay.colour.png",
                            "wall.relaxed-cone.png", "wall.normal.png", "wall.colour.png"})
        expected.insert(map);
    EXPECT_EQ(names_of(built()), expected);
    const std::string manifest = built().at("manifest.json");
    const Result<std::vector<std::string>> listed = files_listed(manifest, "");
    ASSERT_TRUE(listed.ok());
    std::set<std::string> all(listed->begin(), listed->end());
    all.insert("manifest.json");
    EXPECT_EQ(all, expected);
}

TEST_F(Build, IsTheSameForAnyNumberOfThreadsAndWithACache) {
    write_scene("['glsl_330', 'hlsl_3_0', 'essl_100']",
                {surface("quay", "parallax"), surface("wall", "steep_parallax")});
    build(options("one"));
    BuildOptions four = options("four");
    four.jobs = 4;
    build(four);
    for (const char* output : {"cold", "warm"}) {
        BuildOptions cached = options(output);
        cached.cache = folder_ / "cache";
        cached.jobs = 2;
        const BuildReport report = build(cached);
        EXPECT_EQ(report.cache_misses == 0, std::string(output) == "warm");
    }
    for (const char* output : {"four", "cold", "warm"}) EXPECT_EQ(built(output), built("one"));
}

TEST_F(Build, DoesNothingTwiceAndNoticesEveryChange) {
    write_scene("['glsl_330']", {surface("quay", "parallax")});
    EXPECT_FALSE(build(options()).current);
    EXPECT_TRUE(build(options()).current);
    const auto before = built();

    // Touched, and not changed.
    fs::last_write_time(folder_ / "harbour.toml", fs::file_time_type::clock::now());
    EXPECT_TRUE(build(options()).current);

    BuildOptions other = options();
    other.name_space = "game";
    EXPECT_FALSE(build(other).current);
    EXPECT_FALSE(build(options()).current);
    EXPECT_EQ(built(), before);

    // Something that was built is damaged, or gone.
    write("out/quay.h", "broken");
    EXPECT_FALSE(build(options()).current);
    EXPECT_EQ(built(), before);
    fs::remove(folder_ / "out/quay.glsl_330.frag");
    const BuildReport again = build(options());
    EXPECT_EQ(again.written, 1);
    EXPECT_EQ(built(), before);

    BuildOptions forced = options();
    forced.force = true;
    const BuildReport report = build(forced);
    EXPECT_FALSE(report.current);
    EXPECT_EQ(report.written, 0) << "what does not change is not written";

    write_scene("['glsl_330']", {surface("quay", "parallax", "scale = 0.05\n")});
    EXPECT_FALSE(build(options()).current);
    EXPECT_NE(built(), before);
}

TEST_F(Build, KeepsTheTimeOfFilesThatDoNotChange) {
    write_scene("['glsl_330']", {surface("quay", "parallax"), surface("wall", "parallax")});
    build(options());
    const auto long_ago = fs::file_time_type::clock::now() - std::chrono::hours(1);
    for (const auto& [name, bytes] : built()) fs::last_write_time(folder_ / "out" / name, long_ago);
    write_scene("['glsl_330']", {surface("quay", "parallax"), surface("wall", "steep_parallax")});
    build(options());
    for (const auto& [name, bytes] : built()) {
        const bool old = fs::last_write_time(folder_ / "out" / name) == long_ago;
        if (name.rfind("quay", 0) == 0) {
            EXPECT_TRUE(old) << name;
        } else if (name == "wall.glsl_330.frag" || name == "wall.h" || name == "manifest.json") {
            EXPECT_FALSE(old) << name;
        }
    }
}

TEST_F(Build, RemovesWhatItMadeBeforeAndNobodyElsesFiles) {
    write_scene("['glsl_330', 'essl_100']",
                {surface("quay", "parallax"), surface("wall", "parallax")});
    build(options());
    write("out/wall.txt", "a person's");
    write("out/wall.glsl_120.frag", "a person's");
    write("precious", "beside the folder");
    // Whatever a manifest claims, a build stays in its folder.
    std::string manifest = contents(folder_ / "out/manifest.json");
    const std::size_t at = manifest.find("wall.essl_100.frag");
    manifest.replace(at, std::string("wall.essl_100.frag").size(), "../precious");
    write("out/manifest.json", manifest);
    write_scene("['glsl_330']", {surface("quay", "parallax")});
    const BuildReport report = build(options());
    EXPECT_GT(report.removed, 5);
    std::set<std::string> expected = promised();
    for (const char* name : {"quay.height.png", "quay.normal.png", "quay.colour.png", "wall.txt",
                             "wall.glsl_120.frag", "wall.essl_100.frag"})
        expected.insert(name);
    EXPECT_EQ(names_of(built()), expected);
    EXPECT_TRUE(fs::exists(folder_ / "precious"));
}

TEST_F(Build, MapsThatAFileHoldsAreNamedAndNotWrittenAgain) {
    write_scene("['glsl_330']", {surface("quay", "parallax")});
    build(options("made"));
    for (const char* name : {"height", "normal", "colour"})
        fs::copy(folder_ / "made" / ("quay." + std::string(name) + ".png"),
                 folder_ / (std::string(name) + ".png"));
    std::string with_files = surface("quay", "parallax");
    const std::string maker = "maker = 'bricks'\nwidth = 16\nheight = 16\n";
    with_files.replace(with_files.find(maker), maker.size(),
                       "height_map = 'height.png'\nnormal_map = 'normal.png'\n"
                       "colour_map = 'colour.png'\n");
    write("harbour.toml", head("['glsl_330']") + with_files);
    BuildOptions wanted = options();
    wanted.depfile = folder_ / "out.d";
    build(wanted);
    EXPECT_EQ(names_of(built()), promised());
    EXPECT_THAT(built().at("manifest.json"), HasSubstr("\"source\": \"height.png\""));
    const std::string depfile = contents(folder_ / "out.d");
    for (const char* name : {"harbour.toml", "height.png", "normal.png", "colour.png"})
        EXPECT_THAT(depfile, HasSubstr(name));
    EXPECT_TRUE(build(wanted).current);
    fs::remove(folder_ / "out.d");
    EXPECT_FALSE(build(wanted).current) << "the depfile is an output like any other";
}

TEST_F(Build, RefusesWithACodeAndLeavesTheFolderAsItWas) {
    write_scene("['glsl_330']", {surface("quay", "parallax")});
    build(options());
    const auto before = built();
    BuildOptions wanted = options();
    wanted.targets = {"ps_4_0"};
    EXPECT_EQ(refusal(wanted), "unknown-target");
    // No pixel stage, nobody who judges it, twice.
    for (const std::vector<std::string>& targets :
         {std::vector<std::string>{"vs_2_0"}, {"none"}, {"ps_2_b", "ps_2_b"}}) {
        wanted.targets = targets;
        EXPECT_EQ(refusal(wanted), "unknown-target") << targets[0];
    }
    wanted = options();
    wanted.name_space = "no good";
    EXPECT_EQ(refusal(wanted), "namespace-syntax");
    wanted = options();
    wanted.scene = folder_ / "none.toml";
    EXPECT_EQ(refusal(wanted), "file-missing");
    wanted = options();
    wanted.depfile = folder_ / "no such folder/out.d";
    EXPECT_EQ(refusal(wanted), "file-unwritable");
    wanted = options();
    wanted.output = folder_ / "harbour.toml";  // a file
    EXPECT_EQ(refusal(wanted), "file-unwritable");
    // A target that cannot hold it.
    write_scene("['glsl_330', 'ps_2_0']", {surface("quay", "relief")});
    EXPECT_EQ(refusal(options()).rfind("d3d9", 0), 0u);
    EXPECT_EQ(built(), before);
}

TEST_F(Build, AFailedOneLeavesNoFolderThatItMade) {
    write_scene("['glsl_330']", {surface("quay", "parallax")});
    BuildOptions wanted = options("new/and/deeper");
    wanted.planner = [](const auto&, const auto&, const auto&) -> Result<Orders> {
        return input_error("no-plan", "nothing is right enough");
    };
    EXPECT_EQ(refusal(wanted), "no-plan");
    EXPECT_FALSE(fs::exists(folder_ / "new"));
    fs::create_directories(folder_ / "new/and");
    write("new/and/other", "a person's");
    EXPECT_EQ(refusal(wanted), "no-plan");
    EXPECT_TRUE(fs::exists(folder_ / "new/and/other"));
    EXPECT_FALSE(fs::exists(folder_ / "new/and/deeper"));
}

// What waits for the folder's lock makes the folder again.
TEST_F(Build, OneThatWaitsForAFailedOneIsNotDisturbed) {
    write_scene("['glsl_330']", {surface("quay", "parallax")});
    build(options("alone"));
    std::thread other;
    Result<BuildReport> report = internal_error("not-run", "it did not run");
    BuildOptions wanted = options("shared");
    wanted.planner = [&](const auto&, const auto&, const auto&) -> Result<Orders> {
        other = std::thread([&] { report = build_scene(techniques(), options("shared")); });
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        return input_error("no-plan", "nothing is right enough");
    };
    EXPECT_EQ(refusal(wanted), "no-plan");
    other.join();
    EXPECT_TRUE(report.ok()) << to_string(report.error());
    EXPECT_EQ(built("shared"), built("alone"));
    EXPECT_TRUE(build(options("shared")).current);
}

TEST_F(Build, TargetsCanBeGivenInPlaceOfTheScenes) {
    write_scene("['glsl_330']", {surface("quay", "parallax")});
    BuildOptions wanted = options();
    wanted.targets = {"essl_100", "hlsl_3_0"};
    build(wanted);
    EXPECT_THAT(built(),
                AllOf(Contains(Key("quay.essl_100.frag")), Contains(Key("quay.hlsl_3_0.frag.hlsl")),
                      Not(Contains(Key("quay.glsl_330.frag")))));
}

TEST_F(Build, HoldsItsOutputsAgainstAList) {
    write_scene("['glsl_330']", {surface("quay", "parallax")});
    const Result<scene::Scene> scene = scene_of(techniques(), options());
    ASSERT_TRUE(scene.ok());
    const auto code = [&](const std::string& list) {
        const Status status = check_expected(*scene, list, "list");
        return status ? std::string() : status.error().code;
    };
    const std::string all = "manifest.json\nquay.h\nquay.glsl_330.vert\nquay.glsl_330.frag\n";
    EXPECT_EQ(code(all), "");
    EXPECT_EQ(code(all + "quay.glsl_330.order.json\n"), "");
    EXPECT_EQ(code(all + "quay.essl_100.frag\n"), "unexpected-outputs");
    EXPECT_EQ(code("manifest.json\nquay.h\n"), "unexpected-outputs");
    write("list", all);
    BuildOptions wanted = options();
    wanted.expect = folder_ / "list";
    build(wanted);
    EXPECT_TRUE(build(wanted).current);
    write("list", all + "more\n");
    EXPECT_EQ(refusal(wanted), "unexpected-outputs");
}

TEST_F(Build, ManyAtOnceIntoOneFolderAndOneCacheDoNotDisturbEachOther) {
    write_scene("['glsl_330', 'essl_100']",
                {surface("quay", "parallax"), surface("wall", "steep_parallax")});
    build(options("alone"));
    std::vector<std::thread> threads;
    std::atomic<int> failed{0}, worked{0};
    for (int i = 0; i < 4; ++i)
        threads.emplace_back([&] {
            BuildOptions wanted = options("shared");
            wanted.cache = folder_ / "cache";
            const Result<BuildReport> report = build_scene(techniques(), wanted);
            if (!report) ++failed;
            if (report && !report->current) ++worked;
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(failed, 0);
    EXPECT_EQ(worked, 1) << "the others waited and found it done";
    EXPECT_EQ(built("shared"), built("alone"));
}

TEST(Depfile, EscapesAsMakeAndNinjaRead) {
    const Result<std::string> text =
        depfile_text("out dir/m", {"a b", "c#d", "e$f", "g\\ h", "i:j", "k@\xc3\xa4"});
    ASSERT_TRUE(text.ok());
    EXPECT_EQ(*text,
              "out\\ dir/m: \\\n  a\\ b \\\n  c\\#d \\\n  e$$f \\\n  g\\\\\\ h \\\n  i\\:j \\\n"
              "  k@\xc3\xa4\n");
    for (const char* wrong : {"a\nb", "a\rb", "a\\"}) {
        const Result<std::string> refused = depfile_text("m", {wrong});
        ASSERT_FALSE(refused.ok());
        EXPECT_EQ(refused.error().code, "depfile-path");
        EXPECT_EQ(refused.error().message.find('\n'), std::string::npos);
    }
}

}  // namespace
}  // namespace intaglio::build
