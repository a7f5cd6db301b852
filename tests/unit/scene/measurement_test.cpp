// What a scene file means: defaults, directions, sweeps, maps.
#include <gmock/gmock.h>

#include <map>

#include "src/maps/png.h"
#include "tests/unit/scene/scene_file.h"

namespace intaglio::scene {
namespace {

using measure::Direction;
using ::testing::ElementsAre;
using ::testing::Pair;

measure::Plan plan_of(const std::string& text) {
    const SceneFile file(text);
    Result<measure::Plan> plan = read_measurement(file.path());
    if (plan.ok()) return std::move(*plan);
    ADD_FAILURE() << to_string(plan.error());
    return {};
}

// "surface target knob=value ...", the whole of what sweeps change.
std::vector<std::string> rows_of(const measure::Plan& plan) {
    std::vector<std::string> rows;
    for (const VariantRequest& request : plan.rows) {
        std::string row = request.surface + " " + request.target;
        for (const auto& [knob, value] : request.knobs) row += " " + knob + "=" + value;
        rows.push_back(row);
    }
    return rows;
}

TEST(Scene, TheExampleOfSpeedComparesWithRelaxedCones) {
    const auto file = std::filesystem::path(INTAGLIO_EXAMPLE_MAPS) / "../03_speed/scene.toml";
    const Result<measure::Plan> plan = read_measurement(file);
    ASSERT_TRUE(plan.ok()) << to_string(plan.error());
    EXPECT_EQ(plan->maps.size(), 3u);
    const std::vector<std::string> rows = rows_of(*plan);
    EXPECT_EQ(rows.front(), "search=cone_relaxed,output=displaced glsl_450");
    EXPECT_THAT(rows, ::testing::Contains("search=exact,output=displaced glsl_450"));
}

TEST(Scene, WhatIsNotSaidHasTheDefaultsOfThePlan) {
    const measure::Plan plan = plan_of(one_map + one_variant);
    const measure::Plan defaults;
    EXPECT_EQ(plan.scale, defaults.scale);
    EXPECT_EQ(plan.size, defaults.size);
    EXPECT_EQ(plan.rounds, defaults.rounds);
    EXPECT_EQ(plan.filtering, defaults.filtering);
    EXPECT_EQ(plan.device, defaults.device);
    EXPECT_THAT(plan.views, ElementsAre(Direction{90, 20}, Direction{60, 20}, Direction{45, 20},
                                        Direction{30, 20}, Direction{15, 20}));
    EXPECT_THAT(plan.lights, ElementsAre(Direction{45, 135}));
}

TEST(Scene, EverythingSaidArrives) {
    const measure::Plan plan = plan_of(
        "[relief]\nscale = 0.125\nfiltering = 'native'\n[run]\nsize = 64\nrounds = 0\ndevice = "
        "'llvm'\n" +
        one_map + one_variant +
        "per_vertex = true\nloops = { march = 'unroll', shadow = 'loop' }\n");
    EXPECT_EQ(plan.scale, 0.125);
    EXPECT_EQ(plan.filtering, measure::Filtering::Native);
    EXPECT_EQ(plan.size, 64);
    EXPECT_EQ(plan.rounds, 0);
    EXPECT_EQ(plan.device, "llvm");
    ASSERT_EQ(plan.rows.size(), 1u);
    EXPECT_TRUE(plan.rows[0].per_vertex);
    EXPECT_THAT(plan.rows[0].loop_forms, ElementsAre(Pair("march", ir::LoopForm::Unrolled),
                                                     Pair("shadow", ir::LoopForm::Rolled)));
}

TEST(Scene, EveryElevationMeetsEveryAzimuthAndStraightDownHasNone) {
    const measure::Plan plan = plan_of(
        "[views]\nelevations = [30, 90]\nazimuths = [0, 22.5]\n[lights]\nelevations = [-5, 0]\n" +
        one_map + one_variant);
    EXPECT_THAT(plan.views, ElementsAre(Direction{30, 0}, Direction{30, 22.5}, Direction{90, 0}));
    EXPECT_THAT(plan.lights, ElementsAre(Direction{-5, 135}, Direction{0, 135}));
}

TEST(Scene, OneNumberIsAListOfOne) {
    EXPECT_THAT(plan_of("[views]\nelevations = 45\nazimuths = 0\n" + one_map + one_variant).views,
                ElementsAre(Direction{45, 0}));
}

// The order of the file, not of the alphabet: `taps` stands before `bias`.
TEST(Scene, SweepsExpandInTheOrderOfTheFile) {
    const measure::Plan plan =
        plan_of(one_map +
                "[[variant]]\nsurface = 'pom'\ntargets = ['hlsl_5_0', 'glsl_450']\n"
                "knobs = { taps = [32, 8], bias = [0.5, 1e-3, 2] }\n"
                "[[variant]]\nsurface = 'none'\ntargets = 'spirv'\n");
    EXPECT_THAT(
        rows_of(plan),
        ElementsAre("pom hlsl_5_0 taps=32 bias=0.5", "pom glsl_450 taps=32 bias=0.5",
                    "pom hlsl_5_0 taps=32 bias=0.001", "pom glsl_450 taps=32 bias=0.001",
                    "pom hlsl_5_0 taps=32 bias=2", "pom glsl_450 taps=32 bias=2",
                    "pom hlsl_5_0 taps=8 bias=0.5", "pom glsl_450 taps=8 bias=0.5",
                    "pom hlsl_5_0 taps=8 bias=0.001", "pom glsl_450 taps=8 bias=0.001",
                    "pom hlsl_5_0 taps=8 bias=2", "pom glsl_450 taps=8 bias=2", "none spirv"));
}

TEST(Scene, KnobsMayHaveATableOfTheirOwn) {
    const measure::Plan plan =
        plan_of(one_map + one_variant + "[variant.knobs]\nz = 1\na = [2, 3]\n");
    EXPECT_THAT(rows_of(plan), ElementsAre("none glsl_450 z=1 a=2", "none glsl_450 z=1 a=3"));
}

TEST(Scene, ProceduralMapsHaveTheirSizeSeedAndName) {
    const SceneFile file(
        "[[map]]\nmaker = 'bricks'\nwidth = 32\nheight = 16\nseed = 7\n[[map]]\nname = "
        "'other'\nmaker = 'bricks'\n"
        "width = 8\n" +
        one_variant);
    const Result<Measurement> scene = read_measurement_with_sources(file.path());
    ASSERT_TRUE(scene.ok()) << to_string(scene.error());
    ASSERT_EQ(scene->plan.maps.size(), 2u);
    const Result<measure::MapSet> expected =
        measure::make_map_set("bricks", 32, 16, scene->plan.scale, 7);
    EXPECT_EQ(scene->plan.maps[0].name, "bricks");
    EXPECT_EQ(scene->plan.maps[0].heights, expected->heights);
    EXPECT_EQ(scene->plan.maps[0].normal_height, expected->normal_height);
    EXPECT_EQ(scene->plan.maps[1].name, "other");
    EXPECT_EQ(scene->plan.maps[1].heights.height, 8);
    EXPECT_THAT(scene->map_arguments,
                ElementsAre(ElementsAre("--maker", "bricks", "--map-size", "32x16", "--seed", "7"),
                            ElementsAre("--maker", "bricks", "--map-size", "8x8")));
}

TEST(Scene, FilesAreFoundBesideTheScene) {
    const SceneFile file(
        "[[map]]\nname = 'wall'\nheight_map = 'maps/h.png'\nnormal_map = 'maps/n.png'\ncolour_map "
        "= 'maps/c.png'\n" +
        one_variant);
    std::filesystem::create_directories(file.folder() / "maps");
    const measure::MapSet set = std::move(*measure::make_map_set("pyramids", 16, 8, 0.1));
    ASSERT_TRUE(maps::write_png(file.folder() / "maps/h.png", set.heights).ok());
    ASSERT_TRUE(maps::write_png(file.folder() / "maps/n.png", set.normal_height).ok());
    ASSERT_TRUE(maps::write_png(file.folder() / "maps/c.png", set.colour).ok());
    const Result<Measurement> scene = read_measurement_with_sources(file.path());
    ASSERT_TRUE(scene.ok()) << to_string(scene.error());
    ASSERT_EQ(scene->plan.maps.size(), 1u);
    EXPECT_EQ(scene->plan.maps[0].name, "wall");
    EXPECT_EQ(scene->plan.maps[0].heights, set.heights);
    EXPECT_EQ(scene->plan.maps[0].normal_height, *maps::read_png(file.folder() / "maps/n.png"));
    EXPECT_EQ(scene->plan.maps[0].colour, *maps::read_png(file.folder() / "maps/c.png"));
    const std::string folder = (file.folder() / "maps").string();
    EXPECT_THAT(scene->map_arguments,
                ElementsAre(ElementsAre("--height", folder + "/h.png", "--normal",
                                        folder + "/n.png", "--colour", folder + "/c.png")));
    EXPECT_THAT(scene->inputs, ElementsAre(file.path(), folder + "/h.png", folder + "/n.png",
                                           folder + "/c.png"));
}

TEST(Scene, OnesOwnMapTakesThePlaceOfAllAndTheOthersAreNotRead) {
    const SceneFile file("[[map]]\nheight_map = 'absent.png'\n" + one_map + one_variant);
    const std::filesystem::path own =
        std::filesystem::path(INTAGLIO_EXAMPLE_MAPS) / "pipes/normal_height.png";
    const Result<Measurement> scene =
        read_measurement_with_sources(file.path(), measure::MapFiles{own, {}, {}});
    ASSERT_TRUE(scene.ok()) << to_string(scene.error());
    ASSERT_EQ(scene->plan.maps.size(), 1u);
    EXPECT_EQ(scene->plan.maps[0].name, "pipes");
    EXPECT_THAT(scene->map_arguments, ElementsAre(ElementsAre("--height", own.string())));

    const Result<measure::Plan> absent =
        read_measurement(file.path(), measure::MapFiles{"absent.png", {}, {}});
    ASSERT_FALSE(absent.ok());
    EXPECT_EQ(absent.error().file, "absent.png");
}

TEST(Scene, ItsOwnMapNeedsNoMapInTheScene) {
    const SceneFile file(one_variant);
    const std::filesystem::path own =
        std::filesystem::path(INTAGLIO_EXAMPLE_MAPS) / "door/normal_height.png";
    EXPECT_TRUE(read_measurement(file.path(), measure::MapFiles{own, {}, {}}).ok());
}

}  // namespace
}  // namespace intaglio::scene
