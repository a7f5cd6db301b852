// What a scene with surfaces means: defaults, inheritance, lights and views over each surface.
#include "src/scene/scene.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>
#include <random>

#include "templates/all_techniques.h"
#include "tests/unit/scene/mistake.h"

namespace intaglio::scene {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;
using ::testing::UnorderedElementsAre;

// Four lines, then a surface of four more.
const std::string head = "name = 's'\ntargets = ['glsl_450']\n";
const std::string tolerance = "[tolerance]\np95 = 1\n";
const std::string wall = "[[surface]]\nname = 'wall'\nmaker = 'bricks'\nwidth = 8\n";

Scene scene_of(const std::string& text) {
    const SceneFile file(text);
    const dsl::Catalogue catalogue = templates::all_techniques();
    Result<Scene> scene = read_scene(file.path(), &catalogue);
    if (scene.ok()) return std::move(*scene);
    ADD_FAILURE() << to_string(scene.error());
    return {};
}

SceneSurface surface_of(const std::string& text) {
    Scene scene = scene_of(text);
    if (scene.surfaces.size() == 1) return std::move(scene.surfaces.front());
    ADD_FAILURE() << scene.surfaces.size() << " surfaces";
    return {};
}

TEST(SceneOfSurfaces, WhatIsNotSaidHasItsDefault) {
    const Scene scene = scene_of("targets = 'glsl_450'\n" + tolerance + wall);
    EXPECT_EQ(scene.name, "scene");
    EXPECT_EQ(scene.size, 61);
    EXPECT_EQ(scene.read_weight, 4);
    EXPECT_THAT(scene.inputs, ElementsAre(scene.file));
    ASSERT_EQ(scene.surfaces.size(), 1u);
    const SceneSurface& surface = scene.surfaces[0];
    EXPECT_EQ(surface.line, 4);
    EXPECT_EQ(surface.scale, 0.08);
    EXPECT_EQ(surface.elevation, (Span{15, 90}));
    EXPECT_EQ(surface.azimuth, (Span{0, 360}));
    EXPECT_FALSE(surface.pixels_a_texel);
    EXPECT_TRUE(surface.lights.empty());
    EXPECT_TRUE(surface.features.empty());
    EXPECT_TRUE(surface.parts.empty());
    EXPECT_TRUE(surface.budget_on("glsl_450").empty());
    EXPECT_THAT(surface.targets, ElementsAre("glsl_450"));
    EXPECT_THAT(surface.uniforms, ElementsAre(Pair("scale", ElementsAre(0.08f))));
    EXPECT_THAT(surface.map.arguments, ElementsAre("--maker", "bricks", "--map-size", "8x8"));
    EXPECT_EQ(surface.map.hash, measure::content_hash(surface.map.set));
}

TEST(SceneOfSurfaces, EverythingSaidArrives) {
    const SceneSurface surface = surface_of(
        head + "size = 128\nread_weight = 8\n" + tolerance + wall +
        "scale = 0.25\nfeatures = ['shadow', 'depth', 'silhouette', 'fur']\n"
        "targets = ['ps_2_b', 'spirv']\nsearch = 'relief'\nshadow = 'march'\nnormal = 'blinn'\n"
        "shading = 'lambert'\noutput = 'depth'\nvertex = 'tangent_space'\n"
        "knobs = { binary_steps = 8, level = 0.50 }\nloops = { march = 'unroll' }\n"
        "uniforms = { ambient = [0.5, 0.25, 1], gloss = 2 }\n");
    EXPECT_EQ(surface.scale, 0.25);
    EXPECT_THAT(surface.features,
                ElementsAre(Feature::Shadow, Feature::Depth, Feature::Silhouette, Feature::Fur));
    EXPECT_THAT(surface.targets, ElementsAre("ps_2_b", "spirv"));
    EXPECT_THAT(surface.parts,
                ElementsAre(Pair("normal", "blinn"), Pair("output", "depth"),
                            Pair("search", "relief"), Pair("shading", "lambert"),
                            Pair("shadow", "march"), Pair("vertex", "tangent_space")));
    EXPECT_THAT(surface.knobs, ElementsAre(Pair("binary_steps", "8"), Pair("level", "0.5")));
    EXPECT_THAT(surface.loop_forms, ElementsAre(Pair("march", ir::LoopForm::Unrolled)));
    EXPECT_THAT(surface.uniforms,
                ElementsAre(Pair("ambient", ElementsAre(0.5f, 0.25f, 1.0f)),
                            Pair("gloss", ElementsAre(2.0f)), Pair("scale", ElementsAre(0.25f))));
}

TEST(SceneOfSurfaces, ToleranceAndBudgetComeFromTheMostParticular) {
    const SceneSurface surface = surface_of(
        head +
        "[tolerance]\np95 = 1\nmissed = 2\n[tolerance.ps_2_0]\np95 = 3\nmissed = 4\n"
        "[budget]\nreads = 20\narithmetic = 200\n[budget.ps_2_0]\narithmetic = 64\n" +
        wall + "targets = ['ps_2_0', 'ps_2_b', 'glsl_450']\n" +
        "[surface.tolerance]\nmissed = 5\nmedian = 6\n[surface.tolerance.ps_2_b]\np95 = 7\n"
        "[surface.budget]\nspirv_alu = 100\n");
    EXPECT_THAT(surface.tolerance_on("glsl_450"),
                UnorderedElementsAre(Pair("p95", 1), Pair("missed", 5), Pair("median", 6)));
    EXPECT_THAT(surface.tolerance_on("ps_2_0"),
                UnorderedElementsAre(Pair("p95", 3), Pair("missed", 5), Pair("median", 6)));
    EXPECT_THAT(surface.tolerance_on("ps_2_b"),
                UnorderedElementsAre(Pair("p95", 7), Pair("missed", 5), Pair("median", 6)));
    // Slots are of Direct3D 9, instructions of the others.
    EXPECT_THAT(surface.budget_on("glsl_450"),
                UnorderedElementsAre(Pair("reads", 20), Pair("spirv_alu", 100)));
    EXPECT_THAT(surface.budget_on("ps_2_0"),
                UnorderedElementsAre(Pair("reads", 20), Pair("arithmetic", 64)));
    EXPECT_THAT(surface.budget_on("ps_2_b"),
                UnorderedElementsAre(Pair("reads", 20), Pair("arithmetic", 200)));
}

TEST(SceneOfSurfaces, ShadowsAreJudgedWhereTheyAreWanted) {
    const Scene scene =
        scene_of(head + tolerance + "shadow_wrong = 5\n[[light]]\nname = 'sun'\nelevation = 30\n" +
                 "[[light]]\nname = 'lamp'\nplace = [0, 0, 1]\nshadows = false\n" + wall +
                 "features = 'shadow'\n" +
                 "[[surface]]\nname = 'plain'\nmaker = 'bricks'\nwidth = 8\n"
                 "[[surface]]\nname = 'lit'\nmaker = 'bricks'\nwidth = 8\nfeatures = 'shadow'\n"
                 "lights = 'lamp'\n");
    ASSERT_EQ(scene.surfaces.size(), 3u);
    EXPECT_EQ(scene.surfaces[0].tolerance_on("glsl_450").count("shadow_wrong"), 1u);
    EXPECT_EQ(scene.surfaces[1].tolerance_on("glsl_450").count("shadow_wrong"), 0u);
    EXPECT_EQ(scene.surfaces[2].tolerance_on("glsl_450").count("shadow_wrong"), 0u);
    EXPECT_EQ(scene.surfaces[2].tolerance_on("glsl_450").count("p95"), 1u);
}

TEST(SceneOfSurfaces, LightsAreSeenFromEachSurface) {
    const Scene scene = scene_of(
        head + tolerance +
        "[[light]]\nname = 'sun'\nelevation = [30, 50]\nazimuth = 135\n"
        "[[light]]\nname = 'moon'\nelevation = 20\nazimuth = -90\nshadows = false\n"
        "[[light]]\nname = 'lamp'\nplace = [0, 0, 2]\n"
        "[[surface]]\nname = 'floor'\nmaker = 'bricks'\nwidth = 8\n"
        "[[surface]]\nname = 'wall'\nmaker = 'bricks'\nwidth = 8\nlights = ['lamp', 'moon']\n"
        "place = { normal = [0, -1, 0], position = [0, 5, 0] }\n"
        "[[surface]]\nname = 'dark'\nmaker = 'bricks'\nwidth = 8\nlights = []\n");
    ASSERT_EQ(scene.surfaces.size(), 3u);
    const auto& floor = scene.surfaces[0].lights;
    ASSERT_EQ(floor.size(), 3u);
    EXPECT_EQ(floor[0].elevation, (Span{30, 50}));
    EXPECT_EQ(floor[0].azimuth, (Span{135, 135}));
    EXPECT_TRUE(floor[0].shadows);
    EXPECT_FALSE(floor[0].world);
    EXPECT_FALSE(floor[1].shadows);
    ASSERT_TRUE(floor[1].world);
    EXPECT_NEAR((*floor[1].world)[2], std::sin(20 * std::numbers::pi / 180), 1e-6);
    EXPECT_EQ((*floor[1].world)[3], 0);
    EXPECT_EQ(floor[2].elevation.most, 90);
    EXPECT_EQ(floor[2].world, (std::array<float, 4>{0, 0, 2, 1}));
    const auto& lit = scene.surfaces[1].lights;
    ASSERT_EQ(lit.size(), 2u);
    EXPECT_EQ(lit[0].name, "lamp");
    EXPECT_GT(lit[0].elevation.least, 0);
    EXPECT_EQ(lit[1].name, "moon");
    EXPECT_NEAR(lit[1].elevation.least, 70, 1e-6);
    EXPECT_TRUE(scene.surfaces[2].lights.empty());
}

TEST(SceneOfSurfaces, TheCamerasPathGivesTheViewUnlessTheSurfaceSaysIt) {
    const Scene scene = scene_of(
        head + tolerance + "[camera]\npath = [[0, 0, 2]]\nfield_of_view = 90\npixels = 100\n" +
        wall + "place = { size = [2, 2], repeat = [1, 2] }\n" +
        "[[surface]]\nname = 'other'\nmaker = 'bricks'\nwidth = 8\n"
        "view = { elevation = [20, 30], distance = 4 }\n");
    ASSERT_EQ(scene.surfaces.size(), 2u);
    EXPECT_EQ(scene.surfaces[0].elevation.most, 90);
    EXPECT_NEAR(scene.surfaces[0].elevation.least, 54.7356, 1e-3);
    ASSERT_TRUE(scene.surfaces[0].pixels_a_texel);
    // 50 pixels a unit at distance 1; texels of 1/4 and 1/8; seen from 2 to sqrt(6).
    EXPECT_NEAR(scene.surfaces[0].pixels_a_texel->most, 50.0 / 4 / 2, 1e-4);
    EXPECT_NEAR(scene.surfaces[0].pixels_a_texel->least, 50.0 / 8 / std::sqrt(6), 1e-4);
    EXPECT_EQ(scene.surfaces[1].elevation, (Span{20, 30}));
    EXPECT_NEAR(scene.surfaces[1].pixels_a_texel->most, 50.0 / 8 / 4, 1e-4);
}

TEST(SceneOfSurfaces, RangesOfTheSceneAndOfASurface) {
    const SceneSurface surface =
        surface_of(head + tolerance + "[view]\nelevation = [10, 60]\nazimuth = 20\n" + wall +
                   "[surface.view]\nazimuth = [-30, 30]\n");
    EXPECT_EQ(surface.elevation, (Span{10, 60}));
    EXPECT_EQ(surface.azimuth, (Span{-30, 30}));
}

TEST(SceneOfSurfaces, FilesAreInputsOnceAndArgumentsAreForTheFolder) {
    const std::string maps = INTAGLIO_EXAMPLE_MAPS;
    const std::string files = "height_map = '" + maps +
                              "/pipes/normal_height.png'\ncolour_map = '" + maps +
                              "/pipes/colour.png'\n";
    const Scene scene = scene_of(head + tolerance + "[[surface]]\nname = 'a'\n" + files +
                                 "[[surface]]\nname = 'b'\n" + files);
    ASSERT_EQ(scene.inputs.size(), 3u);
    EXPECT_EQ(scene.inputs[0], scene.file);
    EXPECT_EQ(scene.inputs[1], maps + "/pipes/normal_height.png");
    EXPECT_EQ(scene.inputs[2], maps + "/pipes/colour.png");
    EXPECT_EQ(scene.surfaces[0].map.set.heights.width, 512);
}

TEST(SceneOfSurfaces, ScenesAndMeasurementsAreToldApart) {
    const SceneFile scene(head + tolerance + wall), measurement(one_map + one_variant),
        broken("[[surface]\n");
    EXPECT_TRUE(*is_scene(scene.path()));
    EXPECT_FALSE(*is_scene(measurement.path()));
    EXPECT_FALSE(is_scene(broken.path()).ok());
}

// `line` below the keys of a surface that is otherwise right: line 9.
std::string in_surface(const std::string& line) { return head + tolerance + wall + line; }
// Above: line 3.
std::string in_head(const std::string& line) { return head + line + "\n" + tolerance + wall; }
// Tables of the scene, from line 3.
std::string with(const std::string& tables) { return head + tables + "\n" + tolerance + wall; }

std::string lamp(const std::string& name) {
    return "[[light]]\nname = '" + name + "'\nplace = [0, 0, 1]\n";
}

const Mistake mistakes[] = {
    {"NotToml", "[[surface\n", "", "scene-syntax", 1, 10},
    {"UnknownKey", in_head("target = 'x'"), "did you mean 'targets'?", "scene-unknown-key", 3, 1},
    {"NameIsNoIdentifier", "name = 'har bour'\n", "'har bour' must be letters", "scene-name", 1, 8},
    {"NameIsAWord", "name = 'class'\n", "a word of C++", "scene-name", 1, 8},
    {"SizeTooSmall", in_head("size = 7"), "from 8 to 2048", "scene-range", 3, 8},
    {"ReadWeight", in_head("read_weight = -1"), "from 0 to 1000", "scene-range", 3, 15},
    {"UnknownTarget", "targets = ['ps_2_0', 'ps_2_x']\n", "unknown target 'ps_2_x'; did you mean",
     "unknown-target", 1, 22},
    {"VertexTarget", "targets = 'vs_2_0'\n", "vs_2_0 has no pixel stage", "unknown-target", 1, 11},
    {"ViewKey", with("[view]\nelevations = 4"), "did you mean 'elevation'?", "scene-unknown-key", 4,
     1},
    {"ViewOnEdge", with("[view]\nelevation = [0, 90]"), "elevation is 0", "scene-range", 4, 14},
    {"ViewBackwards", with("[view]\nelevation = [40, 30]"), "write the lesser first", "scene-range",
     4, 13},
    {"ViewOfThree", with("[view]\nelevation = [1, 2, 3]"), "a range of two, and has 3",
     "scene-type", 4, 13},
    {"AzimuthTwiceAround", with("[view]\nazimuth = [-180, 300]"), "more than once around",
     "scene-range", 4, 11},
    {"DistanceZero", with("[view]\ndistance = 0"), "distance is 0", "scene-range", 4, 12},
    {"CameraKey", with("[camera]\nfov = 60"), "unknown key of [camera] 'fov'", "scene-unknown-key",
     4, 1},
    {"PathIsOnePoint", with("[camera]\npath = [0, 0, 1]"), "path is a list of points", "scene-type",
     4, 8},
    {"PointOfTwo", with("[camera]\npath = [[0, 0]]"),
     "a point of path must have 3 numbers, and has 2", "scene-type", 4, 9},
    {"PointOfText", with("[camera]\npath = [[0, 0, 'x']]"), "must be a number", "scene-type", 4,
     16},
    {"PointInfinite", with("[camera]\npath = [[0, 0, inf]]"), "a point of path is inf",
     "scene-range", 4, 16},
    {"TargetsOfOther", with("[camera]\npath = [[0, 0, 1]]\ntargets = [[0, 0, 0], [1, 0, 0]]"),
     "one for each", "scene-conflict", 5, 1},
    {"FieldOfView", with("[camera]\nfield_of_view = 180"), "from 1 to 179", "scene-range", 4, 17},
    {"PathAndView", with("[view]\nelevation = 5\n[camera]\npath = [[0, 0, 1]]"),
     "either a [view] or the path", "scene-conflict", 6, 1},
    {"LightWithoutName", with("[[light]]\nelevation = 4"), "a [[light]] needs name",
     "scene-missing", 3, 1},
    {"LightWithoutDirection", with("[[light]]\nname = 'a'"), "or a place", "scene-missing", 3, 1},
    {"LightOfBoth", with("[[light]]\nname = 'a'\nplace = [0, 0, 1]\nazimuth = 4"),
     "either a place or azimuth", "scene-conflict", 6, 1},
    {"LightTwice",
     with("[[light]]\nname = 'a'\nplace = [0, 0, 1]\n[[light]]\nname = 'a'\nelevation = 4"),
     "two lights are called 'a'", "scene-duplicate", 7, 8},
    {"LightKey", with("[[light]]\nname = 'a'\nelevation = 1\nshadow = true"),
     "did you mean 'shadows'?", "scene-unknown-key", 6, 1},
    {"LightTooHigh", with("[[light]]\nname = 'a'\nelevation = 91"), "from -90 to 90", "scene-range",
     5, 13},
    {"LightIsOneTable", with("[light]\nname = 'a'"), "write [[light]]", "scene-type", 3, 2},
    {"UnknownMetric", with("[tolerance.ps_2_0]\np96 = 1\n[budget]"), "did you mean 'p95'?",
     "unknown-metric", 4, 1},
    {"CostTolerated", with("[tolerance.ps_2_0]\narithmetic = 1"), "belongs into [budget]",
     "unknown-metric", 4, 1},
    {"ErrorBudgeted", with("[budget]\np95 = 1"), "belongs into [tolerance]", "unknown-metric", 4,
     1},
    {"BudgetOfOtherTarget", with("[budget.glsl_450]\narithmetic = 1"), "glsl_450 has no arithmetic",
     "scene-not-applicable", 4, 1},
    {"BudgetTarget", with("[budget.glsl_451]\nreads = 1"), "did you mean 'glsl_450'?",
     "unknown-target", 3, 9},
    {"BudgetNegative", with("[budget]\nreads = -1"), "reads is -1", "scene-range", 4, 9},
    {"BudgetIsText", with("[budget]\nreads = '1'"), "reads must be a number", "scene-type", 4, 9},
    {"NoSurface", head, "the scene has no [[surface]]", "scene-missing", 1, 1},
    {"NoTolerance", head + wall, "nothing says how wrong", "scene-missing", 3, 1},
    {"NoTargets", tolerance + wall, "needs targets", "scene-missing", 3, 1},
    {"SurfaceWithoutName", head + tolerance + "[[surface]]\nmaker = 'bricks'",
     "a [[surface]] needs name", "scene-missing", 5, 1},
    {"SurfaceName", head + tolerance + "[[surface]]\nname = '2nd'\nmaker = 'bricks'",
     "no digit first", "scene-name", 6, 8},
    {"SurfaceIsAHeader", head + tolerance + "[[surface]]\nname = 'String'\nmaker = 'bricks'",
     "String.h or a namespace String would stand", "scene-name", 6, 8},
    {"SurfaceIsKept", head + tolerance + "[[surface]]\nname = 'a__b'\nmaker = 'bricks'",
     "C++ keeps for itself", "scene-name", 6, 8},
    {"SurfaceTwiceButForCase", in_surface("[[surface]]\nname = 'Wall'\nmaker = 'bricks'\n"),
     "'wall' and 'Wall', and some systems", "scene-name", 10, 8},
    {"SurfaceTwice", in_surface(wall), "two surfaces are called 'wall'", "scene-name", 10, 8},
    {"SurfaceKey", in_surface("feature = 'fur'"), "did you mean 'features'?", "scene-unknown-key",
     9, 1},
    {"SurfaceOfNothing", head + tolerance + "[[surface]]\nname = 'a'",
     "a [[surface]] needs a maker (procedural) or a height_map", "scene-missing", 5, 1},
    {"UnknownMaker", head + tolerance + "[[surface]]\nname = 'a'\nmaker = 'brick'",
     "did you mean 'bricks'?", "unknown-map", 7, 9},
    {"Scale", in_surface("scale = 2"), "scale is 2", "scene-range", 9, 9},
    {"Feature", in_surface("features = ['depth', 'shadw']"),
     "unknown feature 'shadw'; did you mean 'shadow'?", "unknown-feature", 9, 22},
    {"FeatureTwice", in_surface("features = ['depth', 'depth']"), "twice", "scene-duplicate", 9,
     22},
    {"LightOfNone", in_surface("lights = ['sun']"), "the scene has none", "unknown-light", 9, 11},
    {"LightUnknown",
     "[[light]]\nname = 'sun'\nelevation = 4\n" + tolerance + wall +
         "targets = 'spirv'\nlights = 'son'",
     "did you mean 'sun'?", "unknown-light", 11, 10},
    {"Search", in_surface("search = 'releif'"), "unknown search 'releif'; did you mean 'relief'?",
     "unknown-technique", 9, 10},
    {"SearchOfNothing", in_surface("search = ''"), "", "unknown-technique", 9, 10},
    {"Shading", in_surface("shading = 'fong'"), "unknown shading", "unknown-technique", 9, 11},
    {"UnknownKnob", in_surface("knobs = { tabs = 1 }"), "did you mean 'taps'?", "unknown-knob", 9,
     11},
    {"KnobOfAnother", in_surface("search = 'relief'\nknobs = { cone_steps = 1 }"),
     "unknown knob 'cone_steps'", "unknown-knob", 10, 11},
    {"KnobIsList", in_surface("knobs = { taps = [1, 2] }"), "taps must be a number", "scene-type",
     9, 18},
    {"Loop", in_surface("loops = { march = 'rolled' }"), "march", "scene-choice", 9, 19},
    {"UniformScale", in_surface("uniforms = { scale = 1 }"), "a key of the [[surface]] itself",
     "scene-conflict", 9, 14},
    {"UniformEmpty", in_surface("uniforms = { ambient = [] }"), "must have 1 to 16 numbers",
     "scene-type", 9, 24},
    {"PlaceKey", in_surface("place = { center = [0, 0, 0] }"), "[surface.place] 'center'",
     "scene-unknown-key", 9, 11},
    {"PlaceFlat", in_surface("place = { normal = [1, 0, 0] }"), "at an angle to each other",
     "scene-conflict", 9, 20},
    {"PlaceSize", in_surface("place = { size = [1, 0] }"), "two numbers above 0", "scene-range", 9,
     18},
    {"SurfaceView", in_surface("view = { elevation = 95 }"), "elevation is 95", "scene-range", 9,
     22},
    {"SurfaceTolerance", in_surface("tolerance = { p96 = 1 }"), "metric of [surface.tolerance]",
     "unknown-metric", 9, 15},
    {"FiveLights", with(lamp("a") + lamp("b") + lamp("c") + lamp("d") + lamp("e")),
     "5 lights reach 'wall', and a shader has at most 4", "scene-range", 21, 1},
    {"Unseen", with("[camera]\npath = [[0, 0, -1]]"), "never sees the front of 'wall'",
     "scene-unseen", 7, 1},
};

class SurfaceMistakes : public ::testing::TestWithParam<Mistake> {};

TEST_P(SurfaceMistakes, HaveASentenceWithItsPlace) {
    const Mistake& mistake = GetParam();
    const SceneFile file(mistake.text);
    const dsl::Catalogue catalogue = templates::all_techniques();
    const Result<Scene> scene = read_scene(file.path(), &catalogue);
    ASSERT_FALSE(scene.ok());
    expect_told(scene.error(), mistake, file);
}

INSTANTIATE_TEST_SUITE_P(Rules, SurfaceMistakes, ::testing::ValuesIn(mistakes), mistake_name);

// Whatever is cut out of a scene, it is read, or refused with a sentence about the file.
TEST(SceneOfSurfaces, AnythingCutOutIsAMistakeAtWorst) {
    const std::string whole =
        head +
        "[camera]\npath = [[0, 0, 2], [1, 0, 2]]\ntargets = [[0, 0, 0], [1, 0, 0]]\n"
        "[[light]]\nname = 'sun'\nelevation = [30, 50]\n" +
        tolerance + "[budget.ps_2_0]\narithmetic = 64\n" + wall +
        "lights = ['sun']\nplace = { normal = [0, 0, 1], size = [2, 1] }\n"
        "knobs = { taps = 8 }\nuniforms = { ambient = [1, 1, 1] }\n";
    const dsl::Catalogue catalogue = templates::all_techniques();
    std::mt19937 random(1);
    int refused = 0;
    for (int i = 0; i < 120; ++i) {
        std::string text = whole;
        const std::size_t at = random() % text.size();
        text.erase(at, 1 + random() % (i % 2 == 0 ? 3 : 40));
        const SceneFile file(text);
        const Result<Scene> scene = read_scene(file.path(), &catalogue);
        if (scene.ok()) continue;
        ++refused;
        EXPECT_EQ(scene.error().fault, Fault::Input) << text;
        EXPECT_FALSE(scene.error().message.empty()) << text;
        EXPECT_GT(scene.error().line, 0) << text << to_string(scene.error());
    }
    EXPECT_GT(refused, 40);
}

}  // namespace
}  // namespace intaglio::scene
