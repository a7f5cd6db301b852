// What is asked of a scene with surfaces: its plan, the measurement of what was planned, and what
// that saves.
#include <nlohmann/json.hpp>

#include <map>
#include <set>

#include "tests/cli/command_line.h"

namespace intaglio::cli {
namespace {

using Json = nlohmann::json;
using testing::AllOf;

// One wall of eight texels a side, whose search is given.
class SceneCommands : public CommandLine {
  protected:
    static std::string scene(const std::string& targets, const std::string& tolerance,
                             const std::string& search) {
        return "name = 'yard'\nsize = 16\ntargets = [" + targets + "]\n[tolerance]\n" + tolerance +
               "missed = 1\n[view]\nelevation = [40, 50]\nazimuth = [10, 20]\n"
               "[[light]]\nname = 'sun'\nelevation = 45\nazimuth = 20\n"
               "[[surface]]\nname = 'wall'\nmaker = 'bricks'\nwidth = 8\nscale = 0.2\n" +
               search;
    }
    void SetUp() override {
        CommandLine::SetUp();
        write("yard.toml", scene("'glsl_450', 'ps_2_0'", "p95 = 2\n",
                                 "search = 'steep_parallax'\n"
                                 "knobs = { min_steps = 3, max_steps = 3 }\n"));
    }

    // With what is measured kept in the test's own folder.
    Outcome ask(const std::vector<std::string>& arguments) const {
        return run(arguments, "INTAGLIO_CACHE='" + path("cache") + "'");
    }
    std::vector<std::string> names_in(const std::string& folder) const {
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder_ / folder))
            names.push_back(entry.path().filename().string());
        std::sort(names.begin(), names.end());
        return names;
    }
};

TEST_F(SceneCommands, PlanIsTextJsonAndOrders) {
    const Outcome text = ask({"plan", path("yard.toml"), "-o", path("plan.json")});
    EXPECT_EQ(text.code, 0) << text.err;
    for (const char* target : {"glsl_450", "ps_2_0"})
        EXPECT_THAT(text.out,
                    HasSubstr(std::string("wall on ") + target + "\n  chosen: steep_parallax"));
    EXPECT_THAT(text.err, HasSubstr(" variants tried, 0 known from before"));

    const Outcome json = ask({"plan", path("yard.toml"), "--json", "--orders", path("orders")});
    EXPECT_EQ(json.code, 0) << json.err;
    EXPECT_THAT(json.err, HasSubstr("0 variants tried, ")) << "all was kept";
    EXPECT_EQ(json.out, contents(path("plan.json")));
    EXPECT_EQ(names_in("orders"),
              (std::vector<std::string>{"wall.glsl_450.order.json", "wall.ps_2_0.order.json"}));
    const Json plan = Json::parse(json.out);
    EXPECT_EQ(plan["satisfied"], true);
    ASSERT_EQ(plan["choices"].size(), 2u);
    for (const Json& choice : plan["choices"]) {
        const std::string name = "wall." + choice["target"].get<std::string>();
        EXPECT_EQ(choice["order"], Json::parse(contents(path("orders/" + name + ".order.json"))));
    }

    const Outcome one = ask({"plan", path("yard.toml"), "-T", "ps_2_0", "--cache", "none"});
    EXPECT_THAT(one.out, AllOf(HasSubstr("wall on ps_2_0"), Not(HasSubstr("glsl_450"))));
    EXPECT_THAT(text.out, HasSubstr(one.out)) << "the same without what was kept";
}

TEST_F(SceneCommands, PlanNamesTheNearestTwoWhereNothingIsRight) {
    // A march that is right needs 30 slots, the one that fits is 1.7 texels off.
    write("yard.toml", scene("'ps_2_0'", "p95 = 0.3\n",
                             "search = 'steep_parallax'\n"
                             "budget = { arithmetic = 29 }\n"));
    const Outcome outcome = ask({"plan", path("yard.toml"), "--orders", path("orders")});
    EXPECT_EQ(outcome.code, 1);
    EXPECT_THAT(outcome.out,
                AllOf(HasSubstr("  nothing is right enough and fits\n"),
                      HasSubstr("  the best that fits: steep_parallax min_steps=1 max_steps=1\n"),
                      HasSubstr("  the cheapest that is right: steep_parallax min_steps=4"),
                      HasSubstr(" texels, of at most 0.3\n"),
                      HasSubstr("arithmetic is 30, of at most 29\n")));
    EXPECT_THAT(outcome.err, HasSubstr("1 of 1 cannot be right enough within target and budget: "
                                       "wall on ps_2_0 [plan-unsatisfied]\n"));
    EXPECT_FALSE(fs::exists(path("orders")));
    const Outcome built = ask({"build", path("yard.toml"), "-o", path("made/of")});
    EXPECT_EQ(built.code, 1);
    EXPECT_THAT(built.err, AllOf(HasSubstr("the best that fits: "),
                                 HasSubstr("the cheapest that is right: ")));
    EXPECT_FALSE(fs::exists(path("made"))) << "not even the folder";
    // What is left out of a table or a measurement is said.
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"savings", path("yard.toml")},
          std::vector<std::string>{"measure", path("yard.toml"), "-o", path("results")}}) {
        const Outcome left = ask(command);
        EXPECT_EQ(left.code, 1) << command[0];
        EXPECT_THAT(left.err, HasSubstr("[plan-unsatisfied]\n"));
    }
}

TEST_F(SceneCommands, MistakesGetASentence) {
    const std::string yard = path("yard.toml");
    expect_refused({"plan"}, "usage");
    expect_refused({"plan", yard, "-j", "0"}, "usage");
    expect_refused({"plan", path("none.toml")}, "file-missing");
    EXPECT_THAT(expect_refused({"plan", yard, "--surface", "wal"}, "unknown-surface").err,
                HasSubstr("did you mean 'wall'"));
    expect_refused({"plan", yard, "-T", "ps_2_1"}, "unknown-target");
    expect_refused({"measure", yard, "-o", path("made"), "--height", yard}, "usage");
    expect_refused({"savings", path("none.toml")}, "file-missing");
    expect_refused({"savings", yard, "--size", "4"}, "usage");
    write("yard.toml", "name = 'yard'\n");
    expect_refused({"plan", yard}, "scene-missing");
    EXPECT_FALSE(fs::exists(path("made")));
}

TEST_F(SceneCommands, MeasuresWhatThePlanOrders) {
    ASSERT_EQ(ask({"plan", path("yard.toml"), "--orders", path("orders")}).code, 0);
    const Outcome measured =
        ask({"measure", path("yard.toml"), "-o", path("results"), "--size", "8"});
    EXPECT_EQ(measured.code, 0) << measured.err;
    EXPECT_THAT(measured.out, HasSubstr("2 shaders of 1 surfaces on "));
    std::map<std::string, Json> ordered;
    for (const std::string& name : names_in("orders")) {
        const Json request = Json::parse(contents(path("orders/" + name)))["request"];
        Json& variant = ordered[request["target"]];
        for (const char* member : {"surface", "loops", "per_vertex"})
            variant[member] = request[member];
        variant["known"] = request["known"]["uniforms"].size() + request["known"]["ranges"].size();
        for (const Json& knob : request["knobs"]) variant["knobs"][knob[0]] = knob[1];
    }
    std::map<std::string, std::set<std::string>> views;
    std::istringstream lines(contents(path("results/results.jsonl")));
    for (std::string line; std::getline(lines, line);) {
        const Json result = Json::parse(line);
        const std::string target = result["target"];
        ASSERT_TRUE(ordered.contains(target)) << target;
        for (const char* member : {"surface", "knobs", "loops", "per_vertex"})
            EXPECT_EQ(result[member], ordered[target][member]) << line;
        EXPECT_EQ(result["known"].size(), ordered[target]["known"]) << line;
        EXPECT_EQ(result["map"]["name"], "wall");
        EXPECT_EQ(result["scene_surface"], "wall");
        views[target].insert(result["view"].dump() + result["light"].dump());
    }
    EXPECT_EQ(views.size(), 2u);
    EXPECT_GT(views["ps_2_0"].size(), 1u);
    EXPECT_EQ(views["ps_2_0"], views["glsl_450"]);
    const Outcome again = ask({"measure", path("yard.toml"), "-o", path("results"), "--size", "8"});
    EXPECT_THAT(again.out, Not(HasSubstr(", 0 known from before")));
}

TEST_F(SceneCommands, SavingsAreATableWhereARefusalIsSaid) {
    const std::vector<std::string> savings = {"savings", path("yard.toml"), "--size",
                                              "8",       "--rounds",        "0"};
    const Outcome table = ask(savings);
    EXPECT_EQ(table.code, 0) << table.err;
    std::istringstream lines(table.out);
    std::vector<std::string> rows;
    for (std::string line; std::getline(lines, line);) rows.push_back(line);
    ASSERT_EQ(rows.size(), 4u) << table.out;
    EXPECT_THAT(rows[2], AllOf(HasSubstr("| wall | `glsl_450` | "), Not(HasSubstr("refused"))));
    EXPECT_THAT(rows[3], HasSubstr("| wall | `ps_2_0` | refused | "))
        << "three steps fit, a shadow's march beside them does not";

    // Into the block of a document that is theirs, or nowhere.
    write("page.md", "# A page\n");
    std::vector<std::string> into = savings;
    into.insert(into.end(), {"--markdown", path("page.md")});
    EXPECT_EQ(ask(into).code, 2);
    EXPECT_EQ(contents(path("page.md")), "# A page\n");
}

}  // namespace
}  // namespace intaglio::cli
