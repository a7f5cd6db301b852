// docs/scene.md, docs/scene.schema.json and the reader say the same: its example is a scene, both
// have every key and name that the reader has, and no other.
#include <gmock/gmock.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>

#include "generator/target/target.h"
#include "src/maps/makers.h"
#include "src/measure/named_metric.h"
#include "src/scene/keys.h"
#include "src/scene/scene.h"
#include "templates/all_techniques.h"
#include "tests/unit/scene/scene_file.h"

namespace intaglio::scene {
namespace {

using Json = nlohmann::json;
using ::testing::ElementsAreArray;
using ::testing::UnorderedElementsAreArray;

const std::filesystem::path source = INTAGLIO_SOURCE_DIR;

std::string text_of(const std::filesystem::path& file) {
    std::ifstream in(source / file);
    EXPECT_TRUE(in) << file;
    return {std::istreambuf_iterator<char>(in), {}};
}

// What docs/scene.md has between ```toml and ```.
std::string example() {
    const std::string text = text_of("docs/scene.md");
    const std::size_t begin = text.find("```toml\n") + 8;
    return text.substr(begin, text.find("\n```", begin) - begin + 1);
}

TEST(SceneDocument, TheExampleIsAScene) {
    const SceneFile file(example());
    std::filesystem::create_directory_symlink(INTAGLIO_EXAMPLE_MAPS, file.folder() / "maps");
    const dsl::Catalogue catalogue = templates::all_techniques();
    const Result<Scene> scene = read_scene(file.path(), &catalogue);
    ASSERT_TRUE(scene.ok()) << to_string(scene.error());
    ASSERT_EQ(scene->surfaces.size(), 2u);
    const SceneSurface& wall = scene->surfaces[0];
    EXPECT_EQ(wall.tolerance_on("ps_2_0").at("p95"), 2);
    EXPECT_EQ(wall.tolerance_on("ps_2_0").at("shadow_wrong"), 100);
    EXPECT_EQ(wall.lights.size(), 1u);
    EXPECT_EQ(scene->surfaces[1].elevation, (Span{30, 90}));
}

TEST(SceneDocument, TheHarbourIsAScene) {
    const dsl::Catalogue catalogue = templates::all_techniques();
    const Result<Scene> scene = read_scene(source / "examples/harbour/harbour.toml", &catalogue);
    ASSERT_TRUE(scene.ok()) << to_string(scene.error());
    ASSERT_GE(scene->surfaces.size(), 4u);
    for (const SceneSurface& surface : scene->surfaces) {
        EXPECT_THAT(surface.targets,
                    ::testing::ElementsAre("ps_2_0", "ps_2_b", "ps_3_0", "glsl_450"));
        EXPECT_GT(surface.elevation.least, 30) << surface.name;  // seen from above
        EXPECT_TRUE(surface.pixels_a_texel) << surface.name;
        // The sun stands behind the sign, and above all else.
        for (const SurfaceLight& light : surface.lights)
            EXPECT_EQ(light.elevation.most < 0, light.name == "sun" && surface.name == "sign");
    }
}

// The sentence that the page ends with is what the reader says.
TEST(SceneDocument, TheMistakeIsTold) {
    std::string text = example();
    text.replace(text.find("height_map"), 6, "hight");
    const SceneFile file(text);
    const Result<Scene> scene = read_scene(file.path());
    ASSERT_FALSE(scene.ok());
    const std::string told = to_string(scene.error());
    EXPECT_NE(text_of("docs/scene.md").find("yard.toml" + told.substr(told.find(".toml:") + 5)),
              std::string::npos)
        << told;
}

// In the example as a key, and in the tables in backquotes; [view] is commented out.
TEST(SceneDocument, EveryKeyIsThere) {
    const std::string text = text_of("docs/scene.md"), code = example();
    for (const KeyTable& table : key_tables) {
        for (std::string_view key : table.keys) {
            const std::string word(key);
            EXPECT_NE(text.find("`" + word + "`"), std::string::npos)
                << "docs/scene.md does not explain " << table.name << " " << key;
            const bool alternative = word == "baked" || word == "shadow" || word == "normal" ||
                                     word == "output" || word == "vertex";
            if (alternative) continue;  // named in comments
            EXPECT_TRUE(
                std::regex_search(code, std::regex("(^|[\\n{,\\[. ])" + word + "( = |\\]|\\.)")))
                << table.name << " " << key;
        }
    }
}

std::vector<std::string> keys_of(const Json& object) {
    std::vector<std::string> keys;
    for (const auto& [key, value] : object.items()) keys.push_back(key);
    return keys;
}

TEST(SceneSchema, HasTheReadersKeys) {
    const Json schema = Json::parse(text_of("docs/scene.schema.json"));
    const Json& top = schema["properties"];
    const Json& surface = top["surface"]["items"];
    const std::map<std::string_view, const Json*> tables = {
        {"", &top},
        {"view", &schema["$defs"]["view"]["properties"]},
        {"camera", &top["camera"]["properties"]},
        {"light", &top["light"]["items"]["properties"]},
        {"surface", &surface["properties"]},
        {"surface.place", &surface["properties"]["place"]["properties"]}};
    for (const KeyTable& table : key_tables) {
        ASSERT_TRUE(tables.contains(table.name));
        const std::vector<std::string> expected(table.keys.begin(), table.keys.end());
        EXPECT_THAT(keys_of(*tables.at(table.name)), UnorderedElementsAreArray(expected))
            << table.name;
    }
}

template <typename Rows>
std::vector<std::string> names_of(const Rows& rows) {
    std::vector<std::string> names;
    for (const auto& row : rows) names.emplace_back(row.name);
    return names;
}

TEST(SceneSchema, HasTheLibrarysNames) {
    const Json schema = Json::parse(text_of("docs/scene.schema.json"));
    const Json& surface = schema["properties"]["surface"]["items"]["properties"];
    const dsl::Catalogue catalogue = templates::all_techniques();
    EXPECT_THAT(surface["search"]["enum"], ElementsAreArray(names_of(catalogue.searches)));
    EXPECT_THAT(surface["shadow"]["enum"], ElementsAreArray(names_of(catalogue.shadows)));
    EXPECT_THAT(surface["normal"]["enum"], ElementsAreArray(names_of(catalogue.normals)));
    EXPECT_THAT(surface["shading"]["enum"], ElementsAreArray(names_of(catalogue.shadings)));
    EXPECT_THAT(surface["output"]["enum"], ElementsAreArray(names_of(catalogue.outputs)));
    EXPECT_THAT(surface["vertex"]["enum"], ElementsAreArray(names_of(catalogue.vertex_works)));
    EXPECT_THAT(surface["maker"]["enum"], ElementsAreArray(names_of(maps::makers())));

    std::vector<std::string> targets;
    for (const Target* target : all_targets())
        if (target->pixel_stage && target->name != "none") targets.emplace_back(target->name);
    EXPECT_THAT(schema["$defs"]["target"]["enum"], ElementsAreArray(targets));
    for (const auto& [table, of_errors] : {std::pair("tolerance", true), {"budget", false}}) {
        std::vector<std::string> expected = targets;
        for (const measure::Metric& metric : measure::metrics())
            if (metric.is_error == of_errors) expected.emplace_back(metric.name);
        EXPECT_THAT(keys_of(schema["$defs"][table]["properties"]),
                    UnorderedElementsAreArray(expected));
    }
}

// The schema's side of the same cases is schema_test.py.
TEST(SceneSchema, TheReaderJudgesItsCasesAlike) {
    const std::string text = text_of("tests/unit/scene/schema_cases.txt");
    const std::size_t first = text.find("\n=== ");
    const std::string common = text.substr(text.find("\n\n"), first - text.find("\n\n")) + "\n";
    const dsl::Catalogue catalogue = templates::all_techniques();
    int right = 0, wrong = 0;
    for (std::size_t at = first; at != std::string::npos;) {
        const std::size_t end = text.find('\n', at + 1), next = text.find("\n=== ", end);
        const std::string title = text.substr(at + 5, end - at - 5);
        const SceneFile file(common + text.substr(end, next - end));
        const Result<Scene> scene = read_scene(file.path(), &catalogue);
        const bool expected = title.starts_with("right");
        EXPECT_EQ(scene.ok(), expected) << title;
        EXPECT_TRUE(scene.ok() || scene.error().line > 0) << title;
        ++(expected ? right : wrong);
        at = next;
    }
    EXPECT_GE(right, 5);
    EXPECT_GE(wrong, 35);
}

}  // namespace
}  // namespace intaglio::scene
