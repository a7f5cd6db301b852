// Every rule of a scene file, broken once: the sentence, its code, line and column.
#include <gmock/gmock.h>

#include "tests/unit/scene/mistake.h"

namespace intaglio::scene {
namespace {

// `table` at the top of a scene that is otherwise right.
std::string with(const std::string& table) { return table + "\n" + one_map + one_variant; }

const Mistake mistakes[] = {
    {"NotToml", with("[relief\nscale = 1"), "", "scene-syntax", 1, 8},
    {"KeyTwice", with("[relief]\nscale = 1\nscale = 1"), "scale", "scene-syntax", 3, 9},
    {"UnknownTable", with("[releif]\nscale = 1"),
     "unknown key of the scene 'releif'; did you mean 'relief'?", "scene-unknown-key", 1, 2},
    {"UnknownReliefKey", with("[relief]\nscael = 0.1"),
     "unknown key of [relief] 'scael'; did you mean 'scale'?", "scene-unknown-key", 2, 1},
    {"UnknownViewKey", with("[views]\nelevation = [1]"),
     "unknown key of [views] 'elevation'; did you mean 'elevations'?", "scene-unknown-key", 2, 1},
    {"UnknownLightKey", with("[lights]\nazimut = [1]"),
     "unknown key of [lights] 'azimut'; did you mean 'azimuths'?", "scene-unknown-key", 2, 1},
    {"UnknownRunKey", with("[run]\nround = 1"),
     "unknown key of [run] 'round'; did you mean 'rounds'?", "scene-unknown-key", 2, 1},
    {"UnknownMapKey", "[[map]]\nheight_mpa = 'a.png'\n" + one_variant,
     "unknown key of [[map]] 'height_mpa'; did you mean 'height_map'?", "scene-unknown-key", 2, 1},
    {"UnknownVariantKey", one_map + "[[variant]]\nsurface = 'none'\ntarget = ['spirv']",
     "unknown key of [[variant]] 'target'; did you mean 'targets'?", "scene-unknown-key", 6, 1},
    {"ScaleIsText", with("[relief]\nscale = '0.1'"), "scale must be a number, and is a string",
     "scene-type", 2, 9},
    {"ScaleTooLarge", with("[relief]\nscale = 1.5"), "scale is 1.5, and must be from 0 to 1",
     "scene-range", 2, 9},
    {"ScaleIsNan", with("[relief]\nscale = nan"), "scale is nan", "scene-range", 2, 9},
    {"Filtering", with("[relief]\nfiltering = 'nativ'"), "did you mean 'native'?", "scene-choice",
     2, 13},
    {"ReliefIsNoTable", with("relief = 1"), "relief must be a table, and is a whole number",
     "scene-type", 1, 10},
    {"ElevationTooLow", with("[views]\nelevations = [90, -90]"), "elevations is -90", "scene-range",
     2, 19},
    {"ElevationTooHigh", with("[lights]\nelevations = 91"), "elevations is 91", "scene-range", 2,
     14},
    {"ElevationIsText", with("[views]\nelevations = ['high']"), "elevations must be a number",
     "scene-type", 2, 15},
    {"AzimuthTooLarge", with("[views]\nazimuths = [361]"), "must be from -360 to 360",
     "scene-range", 2, 13},
    {"AzimuthTwice", with("[views]\nazimuths = [20, 20]"), "azimuths has 20 twice",
     "scene-duplicate", 2, 17},
    {"NoElevation", with("[views]\nelevations = []"), "at least one value", "scene-empty", 2, 14},
    {"SizeNoPower", with("[run]\nsize = 100"), "size is 100, and must be a power of two",
     "scene-range", 2, 8},
    {"SizeTooLarge", with("[run]\nsize = 4096"), "size is 4096, and must be from 8 to 2048",
     "scene-range", 2, 8},
    {"SizeIsFraction", with("[run]\nsize = 64.5"), "size must be a whole number", "scene-type", 2,
     8},
    {"RoundsNegative", with("[run]\nrounds = -1"), "rounds is -1", "scene-range", 2, 10},
    {"DeviceIsNumber", with("[run]\ndevice = 1"), "device must be a string", "scene-type", 2, 10},
    {"NoMap", one_variant, "the scene has no [[map]]", "scene-missing", 1, 1},
    {"NoVariant", one_map, "the scene has no [[variant]]", "scene-missing", 1, 1},
    {"Empty", "", "the scene has no [[map]]", "scene-missing", 1, 1},
    {"MapIsOneTable", "[map]\nmaker = 'bricks'\n" + one_variant, "write [[map]]", "scene-type", 1,
     2},
    {"MapsAreNumbers", "map = [1]\n" + one_variant, "each [[map]] must be a table", "scene-type", 1,
     8},
    {"MapOfNothing", "[[map]]\nname = 'x'\n" + one_variant,
     "needs a maker (procedural) or a height_map", "scene-missing", 1, 1},
    {"MapOfBoth", "[[map]]\nmaker = 'bricks'\nheight_map = 'a.png'\n" + one_variant,
     "either a maker or a height_map", "scene-conflict", 3, 1},
    {"FileWithSize", "[[map]]\nheight_map = 'a.png'\nwidth = 4\n" + one_variant,
     "width is for procedural maps", "scene-conflict", 3, 1},
    {"FileWithoutName", "[[map]]\nheight_map = ''\n" + one_variant, "height_map names no file",
     "scene-empty", 2, 14},
    {"UnknownMaker", "[[map]]\nmaker = 'brick'\n" + one_variant,
     "unknown maker 'brick'; did you mean 'bricks'?", "unknown-map", 2, 9},
    {"MapTooWide", "[[map]]\nmaker = 'bricks'\nwidth = 0\n" + one_variant, "width is 0",
     "scene-range", 3, 9},
    {"MapTooLarge", "[[map]]\nmaker = 'bricks'\nwidth = 16384\nheight = 16384\n" + one_variant,
     "16384", "image-size", 1, 1},
    {"SeedNegative", "[[map]]\nmaker = 'bricks'\nseed = -1\n" + one_variant, "seed is -1",
     "scene-range", 3, 8},
    {"NamesTwice", one_map + one_map + one_variant, "two maps are called 'flat1'",
     "scene-duplicate", 4, 1},
    {"NoSurface", one_map + "[[variant]]\ntargets = 'spirv'", "a [[variant]] needs surface",
     "scene-missing", 4, 1},
    {"EmptySurface", one_map + "[[variant]]\nsurface = ''\ntargets = 'spirv'",
     "surface names nothing", "scene-empty", 5, 11},
    {"NoTargets", one_map + "[[variant]]\nsurface = 'none'", "a [[variant]] needs targets",
     "scene-missing", 4, 1},
    {"TargetTwice", one_map + "[[variant]]\nsurface = 'none'\ntargets = ['spirv', 'spirv']",
     "targets has 'spirv' twice", "scene-duplicate", 6, 21},
    {"TargetIsNumber", one_map + "[[variant]]\nsurface = 'none'\ntargets = [450]",
     "targets must be a string", "scene-type", 6, 12},
    {"KnobIsText", one_map + one_variant + "knobs = { taps = 'many' }", "taps must be a number",
     "scene-type", 7, 18},
    {"KnobIsInfinite", one_map + one_variant + "knobs = { taps = inf }", "taps is inf",
     "scene-range", 7, 18},
    {"KnobSweptOverNothing", one_map + one_variant + "knobs = { taps = [] }",
     "taps must have at least one value", "scene-empty", 7, 18},
    {"LoopForm", one_map + one_variant + "loops = { march = 'unrol' }",
     "unknown value of march 'unrol'; did you mean 'unroll'?", "scene-choice", 7, 19},
    {"PerVertex", one_map + one_variant + "per_vertex = 1", "per_vertex must be true or false",
     "scene-type", 7, 14},
};

class SceneMistakes : public ::testing::TestWithParam<Mistake> {};

TEST_P(SceneMistakes, HaveASentenceWithItsPlace) {
    const Mistake& mistake = GetParam();
    const SceneFile file(mistake.text);
    const Result<measure::Plan> plan = read_measurement(file.path());
    ASSERT_FALSE(plan.ok());
    expect_told(plan.error(), mistake, file);
}

INSTANTIATE_TEST_SUITE_P(Rules, SceneMistakes, ::testing::ValuesIn(mistakes), mistake_name);

TEST(SceneErrors, TheFirstMistakeInTheFileIsTold) {
    const SceneFile file("[[map]]\nmaker = 'brick'\n[run]\nsize = 7\n[relief]\nscale = 2\n" +
                         one_variant);
    const Result<measure::Plan> plan = read_measurement(file.path());
    ASSERT_FALSE(plan.ok());
    EXPECT_EQ(plan.error().line, 2) << to_string(plan.error());
}

TEST(SceneErrors, SweepsThatExplodeAreRefusedWithoutBeingBuilt) {
    std::string list = "[0";
    for (int i = 1; i < 2000; ++i) list += ", " + std::to_string(i);
    list += "]";
    const SceneFile file(one_map + one_variant + "knobs = { a = " + list + ", b = " + list +
                         ", c = " + list + ", d = " + list + ", e = " + list + ", f = " + list +
                         " }");
    const Result<measure::Plan> plan = read_measurement(file.path());
    ASSERT_FALSE(plan.ok());
    EXPECT_EQ(plan.error().code, "scene-range");
    EXPECT_THAT(plan.error().message, ::testing::HasSubstr("combinations"));
}

TEST(SceneErrors, AMissingMapNamesItsFileAndTheSceneThatWantsIt) {
    const SceneFile file("[[map]]\nheight_map = 'absent.png'\n" + one_variant);
    const Result<measure::Plan> plan = read_measurement(file.path());
    ASSERT_FALSE(plan.ok());
    EXPECT_EQ(plan.error().code, "file-missing");
    EXPECT_EQ(plan.error().file, (file.folder() / "absent.png").string());
    ASSERT_EQ(plan.error().notes.size(), 1u);
    EXPECT_EQ(plan.error().notes[0], "note: named in " + file.path().string() + ":1:1");
}

TEST(SceneErrors, AMissingSceneIsAMissingFile) {
    const Result<measure::Plan> plan = read_measurement("/nowhere/scene.toml");
    ASSERT_FALSE(plan.ok());
    EXPECT_EQ(plan.error().code, "file-missing");
}

TEST(SceneErrors, BytesThatAreNoTextAreRefused) {
    const SceneFile file(std::string("\xff\xfe\0\x01", 4));
    const Result<measure::Plan> plan = read_measurement(file.path());
    ASSERT_FALSE(plan.ok());
    EXPECT_EQ(plan.error().code, "scene-syntax");
}

}  // namespace
}  // namespace intaglio::scene
