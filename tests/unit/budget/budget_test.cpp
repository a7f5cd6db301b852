// Budgets: what is over, what is unknown, what is forgiven, and how it is told.  The observations
// are made up; tests/cli runs the command on real ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include "src/budget/formats.h"
#include "src/budget/verdict.h"
#include "src/measure/named_metric.h"

namespace intaglio::budget {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class BudgetFile : public testing::Test {
  protected:
    void SetUp() override {
        std::string pattern = testing::TempDir() + "budget_XXXXXX";
        folder_ = mkdtemp(pattern.data());
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path write(const std::string& text, const char* name = "budgets.toml") {
        std::ofstream(folder_ / name) << text;
        return folder_ / name;
    }
    Budgets read(const std::string& text) {
        const auto budgets = read_budgets(write("scene = \"scene.toml\"\n" + text));
        EXPECT_TRUE(budgets.ok()) << to_string(budgets.error());
        return budgets.ok() ? *budgets : Budgets{};
    }
    std::string refused(const std::string& text) {
        const auto budgets = read_budgets(write(text));
        EXPECT_FALSE(budgets.ok()) << text;
        return budgets.ok() ? "" : to_string(budgets.error());
    }
    std::filesystem::path folder_;
};

Observation observed(const std::string& target, std::map<std::string, double> values) {
    return {"fur", target, "taps=8", std::move(values), {}, {}, {}};
}

const Finding* finding(const Verdict& verdict, const std::string& metric) {
    for (const Finding& found : verdict.findings)
        if (found.metric == metric) return &found;
    return nullptr;
}

TEST_F(BudgetFile, TheMostParticularLimitCounts) {
    const Budgets budgets = read(R"(
[[variant]]
surface = "fur"
settings = "taps=8"
p95 = { max = 1 }
[surface.fur]
p95 = { max = 2 }
[target.ps_2_0]
p95 = { max = 3, max_delta = 0.5 }
[limits]
p95 = { max = 4 }
)");
    EXPECT_EQ(budgets.bound("fur", "ps_2_0", "taps=8", "p95")->max, 1);
    EXPECT_EQ(budgets.bound("fur", "ps_2_0", "taps=9", "p95")->max, 2);
    EXPECT_EQ(budgets.bound("bump", "ps_2_0", "", "p95")->max, 3);
    EXPECT_EQ(budgets.bound("bump", "glsl_450", "", "p95")->max, 4);
    // What the particular one leaves open, the general one says.
    EXPECT_EQ(budgets.bound("fur", "ps_2_0", "taps=8", "p95")->max_delta, 0.5);
    EXPECT_FALSE(budgets.bound("fur", "ps_2_0", "taps=8", "missed"));
}

TEST_F(BudgetFile, MistakesHaveAPlaceAndTheNearestRightWord) {
    const std::string scene = "scene = \"s.toml\"\n";
    const std::pair<std::string, std::string> mistakes[] = {
        {scene + "[limit]\np95 = { max = 1 }\n",
         ":2:2: error: unknown key of the budgets 'limit'; did you mean 'limits'? "
         "[budget-unknown-key]"},
        {scene + "[limits]\np96 = { max = 1 }\n",
         ":3:1: error: unknown metric in [limits] 'p96'; did you mean 'p95'? [budget-unknown-key]"},
        {scene + "[limits]\np95 = { maximum = 1 }\n", "unknown key of p95 'maximum'"},
        {scene + "[limits]\np95 = {}\n", "p95 needs a max or a max_delta [budget-missing]"},
        {scene + "[limits]\np95 = 3\n", "p95 must be a table, and is a whole number [budget-type]"},
        {scene + "[limits]\np95 = { max_delta = -1 }\n", "[budget-range]"},
        {scene + "[target.ps_2_1]\np95 = { max = 1 }\n",
         "unknown target 'ps_2_1'; did you mean 'ps_2_b'? [unknown-target]"},
        {scene + "[target.glsl_450]\narithmetic = { max = 1 }\n",
         ":3:1: error: glsl_450 has no arithmetic: arithmetic slots"},
        {scene + "[limits]\np95 = { max = 1 }\n[[waiver]]\nsurface = \"fur\"\nreason = \"x\"\n",
         ":4:1: error: a [[waiver]] needs until [budget-missing]"},
        {scene + "[limits]\np95 = { max = 1 }\n[[waiver]]\nreason = \"x\"\nuntil = 2026-12-31\n",
         "it would forgive everything [budget-missing]"},
        {scene + "[limits]\np95 = { max = 1 }\n[[waiver]]\nsurface = \"fur\"\nreason = "
                 "\"x\"\nuntil = \"soon\"\n",
         "until must be a date or time, and is a string [budget-type]"},
        {scene, "the budgets limit nothing [budget-missing]"},
        {"[limits]\np95 = { max = 1 }\n", "the budgets name no scene [budget-missing]"},
        {"scene = \n", "[budget-syntax]"},
    };
    for (const auto& [text, sentence] : mistakes)
        EXPECT_THAT(refused(text), HasSubstr(sentence)) << text;
}

TEST_F(BudgetFile, OverIsMoreThanMaxOrGrownByMoreThanMaxDelta) {
    const Budgets budgets = read("[limits]\narithmetic = { max = 64, max_delta = 2 }\n");
    const auto kind = [&](double before, double after) {
        const Verdict verdict = judge(budgets, {observed("ps_2_0", {{"arithmetic", after}})},
                                      {observed("ps_2_0", {{"arithmetic", before}})}, "2026-01-01");
        EXPECT_EQ(verdict.passes(), finding(verdict, "arithmetic")->kind == Finding::Kind::Fine);
        return finding(verdict, "arithmetic")->kind;
    };
    EXPECT_EQ(kind(60, 60), Finding::Kind::Fine);
    EXPECT_EQ(kind(60, 62), Finding::Kind::Fine);
    EXPECT_EQ(kind(60, 63), Finding::Kind::Over);
    EXPECT_EQ(kind(64, 64), Finding::Kind::Fine);
    EXPECT_EQ(kind(64, 65), Finding::Kind::Over);
    EXPECT_EQ(kind(70, 65), Finding::Kind::Over);  // better, and still too much
    EXPECT_EQ(kind(60, 10), Finding::Kind::Fine);
}

TEST_F(BudgetFile, UnknownIsNeverAPass) {
    const Budgets budgets = read("[limits]\narithmetic = { max = 64 }\np95 = { max_delta = 1 }\n");
    const auto verdict = [&](Observation now, std::vector<Observation> before) {
        return judge(budgets, {std::move(now)}, before, "2026-01-01");
    };
    const Observation known = observed("ps_2_0", {{"arithmetic", 10}, {"p95", 1}});
    EXPECT_TRUE(verdict(known, {known}).passes());
    // No number.
    const Verdict no_number = verdict(observed("ps_2_0", {{"p95", 1}}), {known});
    EXPECT_EQ(finding(no_number, "arithmetic")->kind, Finding::Kind::Unknown);
    // Nothing to compare with.
    EXPECT_THAT(finding(verdict(known, {}), "p95")->sentence, HasSubstr("there is no baseline"));
    const Observation other{"bump", "ps_2_0", "", {{"p95", 1}}, {}, {}, {}};
    EXPECT_FALSE(verdict(known, {other}).passes());
    // Refused, and not refused before.
    Observation refused = observed("ps_2_0", {});
    refused.refusal = "ps_2_0 needs more than its 64 slots";
    EXPECT_FALSE(verdict(refused, {known}).passes());
    EXPECT_FALSE(verdict(refused, {}).passes());
    EXPECT_TRUE(verdict(refused, {refused}).passes());
    // In the baseline, and no longer in the scene.
    EXPECT_FALSE(judge(budgets, {known}, {known, other}, "2026-01-01").passes());
    // Slots of a language without slots are not asked for.
    const Observation text = observed("glsl_450", {{"p95", 1}});
    EXPECT_TRUE(verdict(text, {text}).passes());
}

TEST_F(BudgetFile, ALimitOfWhatNobodyMeasuresIsNoPass) {
    const std::vector<Observation> now = {observed("ps_2_0", {{"arithmetic", 10}, {"p95", 1}})};
    const auto judged = [&](const char* table) {
        return judge(read(fmt::format("{}\np95 = {{ max = 2 }}\nmissed = {{ max = 2 }}\n", table)),
                     now, {}, "2026-01-01");
    };
    EXPECT_THAT(
        judged("[surface.furr]").findings,
        testing::Contains(testing::Field(&Finding::sentence, HasSubstr("did you mean 'fur'"))));
    for (const char* table : {"[surface.furr]", "[target.ps_2_b]",
                              "[[variant]]\nsurface = \"fur\"\nsettings = \"taps=9\""})
        EXPECT_FALSE(judged(table).passes()) << table;
}

TEST_F(BudgetFile, AWaiverForgivesUpToItsLastDayAndSaysWhenItForgivesNothing) {
    const Budgets budgets = read(
        "[limits]\narithmetic = { max = 64 }\np95 = { max = 1 }\n"
        "[[waiver]]\nsurface = \"fur\"\nmetric = \"arithmetic\"\n"
        "reason = \"packing lands next week\"\nuntil = 2026-12-31\n");
    const std::vector<Observation> over = {observed("ps_2_0", {{"arithmetic", 70}, {"p95", 0}})};
    const Verdict in_time = judge(budgets, over, {}, "2026-12-31");
    EXPECT_TRUE(in_time.passes());
    EXPECT_THAT(finding(in_time, "arithmetic")->sentence, HasSubstr("packing lands next week"));
    EXPECT_THAT(in_time.notes, IsEmpty());
    const Verdict late = judge(budgets, over, {}, "2027-01-01");
    EXPECT_FALSE(late.passes());
    EXPECT_THAT(late.notes, ElementsAre(HasSubstr("the waiver ended on 2026-12-31")));
    const std::vector<Observation> wrong = {observed("ps_2_0", {{"arithmetic", 7}, {"p95", 2}})};
    const Verdict other = judge(budgets, wrong, {}, "2026-12-31");
    EXPECT_FALSE(other.passes());
    EXPECT_THAT(other.notes, ElementsAre(HasSubstr("the waiver forgives nothing")));
}

TEST_F(BudgetFile, TheLineThatSpendsMoreIsNamed) {
    const Budgets budgets = read("[limits]\narithmetic = { max_delta = 0 }\n");
    Observation before = observed("ps_2_0", {{"arithmetic", 30}}), now = before;
    before.lines = {{"march at a.cpp:5", 20}, {"shadow at b c.cpp:9", 10}};
    now.lines = {{"march at a.cpp:5", 20}, {"shadow at b c.cpp:9", 14}};
    now.values["arithmetic"] = 34;
    const Verdict verdict = judge(budgets, {now}, {before}, "2026-01-01");
    EXPECT_EQ(finding(verdict, "arithmetic")->where, "shadow at b c.cpp:9: 14, before 10");
    EXPECT_THAT(to_text(verdict),
                HasSubstr("over: fur taps=8 on ps_2_0: arithmetic grew from 30 to 34 slots"));
    EXPECT_THAT(to_github(verdict),
                HasSubstr("::error file=b c.cpp,line=9,title=intaglio check::"));
    const auto sarif = nlohmann::json::parse(to_sarif(verdict));
    const auto& place = sarif["runs"][0]["results"][0]["locations"][0]["physicalLocation"];
    EXPECT_EQ(place["artifactLocation"]["uri"], "b%20c.cpp");
    EXPECT_EQ(place["region"]["startLine"], 9);
}

// Worse stands before better, and the forms agree with each other on how much fails.
TEST_F(BudgetFile, EveryFormTellsTheSame) {
    const Budgets budgets =
        read("[limits]\narithmetic = { max = 9 }\np95 = { max = 9 }\nmissed = { max = 9 }\n");
    const unsigned seed = 20261122;
    std::mt19937 random(seed);
    for (int round = 0; round < 50; ++round) {
        std::vector<Observation> before, now;
        for (const char* target : {"ps_2_0", "ps_2_b", "ps_3_0"}) {
            const auto any = [&] { return static_cast<double>(random() % 12); };
            before.push_back(
                observed(target, {{"arithmetic", any()}, {"p95", any()}, {"missed", any()}}));
            now.push_back(
                observed(target, {{"arithmetic", any()}, {"p95", any()}, {"missed", any()}}));
        }
        const Verdict verdict = judge(budgets, now, before, "2026-01-01");
        std::ptrdiff_t over = 0;
        for (const Observation& o : now)
            for (const auto& [metric, value] : o.values) over += value > 9 ? 1 : 0;
        EXPECT_EQ(verdict.passes(), over == 0) << "seed " << seed;
        const auto json = nlohmann::json::parse(to_json(verdict));
        const auto failed = std::count_if(json["findings"].begin(), json["findings"].end(),
                                          [](const auto& f) { return f["kind"] == "over"; });
        EXPECT_EQ(failed, over);
        pugi::xml_document junit;
        ASSERT_TRUE(junit.load_string(to_junit(verdict).c_str()));
        EXPECT_EQ(junit.select_nodes("//testcase/failure").size(), static_cast<std::size_t>(over));
        EXPECT_EQ(junit.select_node("//testsuite").node().attribute("failures").as_int(), over);
        EXPECT_EQ(nlohmann::json::parse(to_sarif(verdict))["runs"][0]["results"].size(),
                  static_cast<std::size_t>(over));
        const std::string text = to_text(verdict);
        const std::size_t worse = text.find("\nworse:"), better = text.find("\nbetter:");
        if (worse != std::string::npos && better != std::string::npos) {
            EXPECT_LT(worse, better);
        }
    }
}

TEST_F(BudgetFile, ABaselineIsOneSortedLineAVariantAndReadsBack) {
    Observation a = observed("ps_2_0", {{"arithmetic", 30}, {"p95", 0.123457}});
    a.lines = {{"march at a.cpp:5", 20}};
    Observation b = observed("glsl_450", {{"p95", 1e-7}});
    Observation c = observed("hlsl_2_0", {});
    c.refusal = "too \"large\"";
    const std::string text = to_lines({a, b, c});
    EXPECT_EQ(text, to_lines({c, a, b}));
    const auto back = read_lines(write(text, "baseline.jsonl"));
    ASSERT_TRUE(back.ok()) << to_string(back.error());
    EXPECT_EQ(to_lines(*back), text);
    EXPECT_EQ(back->size(), 3u);
    EXPECT_THAT(to_string(read_lines(write(text + text, "twice.jsonl")).error()),
                HasSubstr("twice.jsonl:4:1: error: fur taps=8 on glsl_450 stands here twice "
                          "[baseline-duplicate]"));
    EXPECT_THAT(to_string(read_lines(write("{}\n", "bad.jsonl")).error()),
                HasSubstr("bad.jsonl:1:1: error: this line is no variant"));
    EXPECT_THAT(to_text(difference({a, b}, {a, c})), HasSubstr("fur taps=8 on glsl_450: gone"));
    EXPECT_EQ(to_text(difference({a, b, c}, {a, b, c})), "no difference\n");
}

// git is the witness: it applies what we print, and the result is the new file.
TEST_F(BudgetFile, ThePatchAppliesWithGit) {
    const unsigned seed = 7;
    std::mt19937 random(seed);
    for (int round = 0; round < 12; ++round) {
        std::vector<Observation> before, after;
        for (const char* target :
             {"essl_300", "glsl_330", "glsl_450", "ps_2_0", "ps_2_b", "ps_3_0"}) {
            if (random() % 3)
                before.push_back(observed(target, {{"p95", static_cast<double>(random() % 2)}}));
            if (random() % 3)
                after.push_back(observed(target, {{"p95", static_cast<double>(random() % 2)}}));
        }
        if (before.empty()) continue;
        const std::string old_text = to_lines(before), new_text = to_lines(after);
        if (new_text.empty() || old_text == new_text) continue;
        const auto file = write(old_text, "baseline.jsonl");
        write(to_patch("baseline.jsonl", old_text, new_text), "change.patch");
        const std::string command =
            fmt::format("cd '{}' && git apply --unidiff-zero change.patch", folder_.string());
        ASSERT_EQ(std::system(command.c_str()), 0)
            << to_patch("baseline.jsonl", old_text, new_text);
        std::ifstream stream(file);
        EXPECT_EQ(std::string(std::istreambuf_iterator<char>(stream), {}), new_text)
            << "seed " << seed << " round " << round;
    }
}

}  // namespace
}  // namespace intaglio::budget
