// The page's data: the numbers of what was measured, unchanged, from either form; and a page that
// needs nothing else.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "src/measure/variant_json.h"
#include "src/report/base64.h"
#include "src/report/command.h"
#include "src/report/front.h"
#include "src/report/html.h"
#include "src/report/report.h"
#include "templates/all_techniques.h"
#include "tests/unit/report/sample.h"

namespace intaglio::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::ordered_json;

const MapArguments arguments = {{"--height", "a b.png"}, {"--maker", "smooth"}};

TEST(PageData, OfAMeasurementHasItsNumbers) {
    const Sample sample = report::sample();
    const Json source = Json::parse(to_json(sample.plan, sample.measurement, arguments));
    const Result<PageData> page = page_data_of_measurement(source.dump(), "results.json");
    ASSERT_TRUE(page) << to_string(page.error());
    ASSERT_EQ(page->json["cases"].size(), source["cases"].size());
    for (std::size_t i = 0; i < source["cases"].size(); ++i) {
        const Json &shown = page->json["cases"][i], &measured = source["cases"][i];
        for (const char* member : {"hits", "reads", "time", "command", "view", "light"})
            EXPECT_EQ(shown[member], measured[member]) << member;
        EXPECT_EQ(page->json["maps"][shown["map"].get<std::size_t>()]["name"], measured["map"]);
        EXPECT_EQ(shown["variant"], measured["row"]);
    }
    ASSERT_EQ(page->variants.size(), sample.plan.rows.size());
    for (std::size_t i = 0; i < page->variants.size(); ++i) {
        EXPECT_EQ(page->variants[i].surface, sample.plan.rows[i].surface);
        EXPECT_EQ(page->variants[i].knobs, sample.plan.rows[i].knobs);
        EXPECT_EQ(page->variants[i].loop_forms, sample.plan.rows[i].loop_forms);
        EXPECT_EQ(page->variants[i].per_vertex, sample.plan.rows[i].per_vertex);
    }
    EXPECT_EQ(page->maps[0].arguments, arguments[0]);
    EXPECT_EQ(page->maps[1].arguments, arguments[1]);
}

// A project's limit stands where the profile's was; what only the project limits stands beside;
// what was not measured is not known.
TEST(PageData, TakesLimitsOfABudget) {
    const Sample sample = direct3d9_sample();
    Result<PageData> page =
        page_data_of_measurement(to_json(sample.plan, sample.measurement, arguments), "r.json");
    ASSERT_TRUE(page) << to_string(page.error());
    Json& variants = page->json["variants"];
    variants[1]["resources"] = {{{"resource", "arithmetic slots"}, {"used", 41}, {"limit", 64}},
                                {{"resource", "texture slots"}, {"used", 9}, {"limit", 32}}};
    add_limits(*page,
               {{1, "arithmetic", 40},
                {1, "dependent_level", 3},
                {1, "p95", 2.5},
                {1, "p95_fp16", 5},
                {0, "spirv_alu", 90}},
               "budgets.toml");
    double worst = 0;
    for (const measure::CaseResult& result : sample.measurement.cases)
        if (result.row == 1) worst = std::max(worst, result.hits.p95);
    const Json expected = {
        {{"resource", "arithmetic slots"}, {"used", 41}, {"limit", 40.0}, {"by", "budgets.toml"}},
        {{"resource", "texture slots"}, {"used", 9}, {"limit", 32}},
        {{"resource", "dependent texture reads"},
         {"used", 2},
         {"limit", 3.0},
         {"by", "budgets.toml"}},
        {{"resource", "p95, texels"}, {"used", worst}, {"limit", 2.5}, {"by", "budgets.toml"}},
        {{"resource", "p95_fp16, texels"},
         {"used", nullptr},
         {"limit", 5.0},
         {"by", "budgets.toml"}}};
    EXPECT_EQ(variants[1]["resources"], expected);
    EXPECT_EQ(variants[0]["resources"][0]["used"], 100);
    EXPECT_FALSE(variants[2].contains("resources"));
}

TEST(PageData, SaysWhatIsWrongWithAFile) {
    const auto code_of = [](const std::string& text) {
        const Result<PageData> page = page_data_of_measurement(text, "results.json");
        return page ? "fine" : page.error().code + " " + page.error().file;
    };
    EXPECT_EQ(code_of("{\"schema\":"), "not-json results.json");
    EXPECT_EQ(code_of("{}"), "not-results results.json");
    EXPECT_EQ(code_of("[1]"), "not-results results.json");
    EXPECT_EQ(code_of(R"({"schema": "intaglio.measurement"})"), "not-results results.json");
}

// On every kind of target: who spends is the whole cost, by lines that are told apart, and reads
// are what the texture column counts.
TEST(PageData, SaysOfEverySourceWhoSpendsIt) {
    const dsl::Catalogue catalogue = templates::all_techniques();
    PageData page;
    page.json["variants"] = Json::array();
    for (const char* target : {"ps_2_b", "ps_3_0", "glsl_450", "hlsl_5_0", "essl_300"}) {
        page.variants.push_back({"parallax_occlusion", target, {{"taps", "4"}}, {}, false, false});
        page.json["variants"].push_back(Json::object());
    }
    const Status status = add_sources(page, catalogue);
    ASSERT_TRUE(status) << to_string(status.error());
    ASSERT_EQ(page.json["sources"].size(), page.variants.size());
    for (std::size_t i = 0; i < page.variants.size(); ++i) {
        SCOPED_TRACE(page.variants[i].target);
        const Json &source = page.json["sources"][i], &spent = source["spent"];
        const bool is_direct3d9 = source.contains("lines");
        EXPECT_EQ(is_direct3d9, i < 2);
        EXPECT_EQ(spent["unit"], is_direct3d9 ? "slots" : "operations");
        int arithmetic = 0, texture = 0;
        std::set<std::string> steps, lines;
        for (const Json& line : spent["lines"]) {
            arithmetic += line["arithmetic"].get<int>();
            texture += line["texture"].get<int>();
            steps.insert(line["step"]);
            EXPECT_TRUE(lines.insert(line["step"].dump() + line["place"].dump()).second) << line;
        }
        EXPECT_GT(arithmetic, 0);
        EXPECT_GE(steps.size(), 3U);
        EXPECT_EQ(static_cast<std::size_t>(texture), spent["reads"].size());
        for (const Json& read : spent["reads"]) {
            EXPECT_THAT(read["place"], HasSubstr(".cpp:"));
            EXPECT_TRUE(lines.count(read["step"].dump() + read["place"].dump())) << read;
            EXPECT_EQ(read["level"].is_null(), !is_direct3d9);
        }
        if (!is_direct3d9) continue;
        int of_text[2] = {0, 0};
        for (const Json& line : source["lines"])
            for (std::size_t k = 0; k < 2 && !line.is_null(); ++k) of_text[k] += line[k].get<int>();
        EXPECT_EQ(arithmetic, of_text[0]);
        EXPECT_EQ(texture, of_text[1]);
    }
}

// A line of a sweep, with what the adapter reads.
Json sweep_line(const std::string& surface, const std::string& taps, double elevation, double p95) {
    const Json hits = {{"pixels", 64}, {"p95", p95}, {"missed", 3}};
    return {{"schema", 1},
            {"surface", surface},
            {"target", "glsl_450"},
            {"knobs", {{"taps", taps}}},
            {"loops", Json::object()},
            {"per_vertex", false},
            {"arithmetic", "fp32"},
            {"map", {{"name", "bricks"}, {"hash", "1"}, {"arguments", {"--maker", "bricks"}}}},
            {"view", {{"elevation", elevation}, {"azimuth", 20}}},
            {"light", {{"elevation", 45}, {"azimuth", 135}}},
            {"scale", 0.08},
            {"filtering", "float"},
            {"device", "llvmpipe"},
            {"refused", nullptr},
            {"cost",
             {{"d3d9", nullptr},
              {"spirv", {{"alu", 40}}},
              {"reads_mean", 2.5},
              {"reads_max", 7},
              {"instructions_mean", nullptr},
              {"instructions_max", nullptr}}},
            {"hits", hits},
            {"swim", nullptr},
            {"picture", nullptr},
            {"split", nullptr},
            {"worst", {{"command", "intaglio run --maker bricks"}}}};
}

TEST(PageData, OfASweepIsTheSameWhateverTheOrderOfItsLines) {
    std::vector<std::string> lines;
    for (const char* taps : {"16", "4", "8"})
        for (double elevation : {60.0, 15.0})
            lines.push_back(
                sweep_line("parallax_occlusion", taps, elevation, elevation + std::stod(taps))
                    .dump());
    const dsl::Catalogue none;
    std::string before;
    std::mt19937 random(5);
    for (int round = 0; round < 6; ++round) {
        std::shuffle(lines.begin(), lines.end(), random);
        const Result<PageData> page =
            page_data_of_sweep(fmt::format("{}\n", fmt::join(lines, "\n")), "r.jsonl", none);
        ASSERT_TRUE(page) << to_string(page.error());
        const std::string text = page->json.dump();
        if (round > 0) {
            EXPECT_EQ(text, before);
        }
        before = text;
        ASSERT_EQ(page->json["variants"].size(), 3U);
        EXPECT_EQ(page->json["variants"][0]["knobs"]["taps"], 4);
        EXPECT_EQ(page->json["variants"][2]["knobs"]["taps"], 16);
        ASSERT_EQ(page->json["cases"].size(), 6U);
        for (const Json& item : page->json["cases"]) {
            const Json& variant = page->json["variants"][item["variant"].get<std::size_t>()];
            EXPECT_EQ(
                item["hits"]["p95"].get<double>(),
                item["view"]["elevation"].get<double>() + variant["knobs"]["taps"].get<double>());
        }
    }
}

TEST(PageData, OfASweepNamesRefusedVariantsAndBadLines) {
    Json refused = sweep_line("relief", "4", 30, 1);
    refused["refused"] = {{"code", "target-limit"}, {"sentence", "too long"}};
    refused.erase("cost");
    const dsl::Catalogue none;
    const Result<PageData> page = page_data_of_sweep(refused.dump() + "\n", "r.jsonl", none);
    ASSERT_TRUE(page) << to_string(page.error());
    EXPECT_TRUE(page->json["cases"].empty());
    EXPECT_EQ(page->json["refused"][0]["sentence"], "too long");

    const Result<PageData> cut = page_data_of_sweep(refused.dump() + "\n{\"a\"", "r.jsonl", none);
    ASSERT_FALSE(cut);
    EXPECT_THAT(cut.error().message, HasSubstr("line 2"));
}

// Two variants that differ in one thing only, whatever it is, are two; each is what its line says,
// and so are its command and its text.
TEST(PageData, OfASweepKeepsApartWhatDiffersInAnything) {
    const dsl::Catalogue catalogue = templates::all_techniques();
    const Json plain = sweep_line("parallax_occlusion", "4", 30, 1);
    const std::vector<std::pair<Json, std::string>> changes = {
        {{{"knobs", {{"taps", "5"}}}}, "-D taps=5"},
        {{{"target", "hlsl_5_0"}}, "-T hlsl_5_0"},
        {{{"loops", {{"march", "unroll"}}}}, "--loop march=unroll"},
        {{{"per_vertex", true}}, "--per-vertex"},
        {{{"known", {"scale = 0.03"}}}, "--fix scale=0.03"},
        {{{"known", {"view.z = 0.5..0.75"}}}, "--assume view.z=0.5..0.75"},
        {{{"scene_surface", "quay"}}, ""}};
    std::string lines = plain.dump();
    for (const auto& [change, words] : changes) {
        Json line = plain;
        line.update(change);
        lines += "\n" + line.dump() + "\n" + line.dump();  // seen twice, one variant
    }
    Result<PageData> page = page_data_of_sweep(lines + "\n", "r.jsonl", catalogue);
    ASSERT_TRUE(page) << to_string(page.error());
    ASSERT_EQ(page->variants.size(), changes.size() + 1);
    const Status status = add_sources(*page, catalogue);
    ASSERT_TRUE(status) << to_string(status.error());
    for (const auto& change : changes) {
        const std::string& words = change.second;
        Json asked = plain;
        asked.update(change.first);
        const auto& variants = page->json["variants"];
        const auto found = std::find_if(variants.begin(), variants.end(), [&](const Json& variant) {
            return variant["emit_command"].get<std::string>().find(words) != std::string::npos &&
                   variant.contains("scene_surface") == words.empty();
        });
        ASSERT_NE(found, variants.end()) << words;
        const Result<VariantRequest> request = measure::request_of(asked);
        ASSERT_TRUE(request) << to_string(request.error());
        const auto index = static_cast<std::size_t>(found - variants.begin());
        EXPECT_EQ(measure::text_of(page->variants[index]), measure::text_of(*request));
        const Result<Variant> made = make_variant(catalogue, *request);
        ASSERT_TRUE(made) << to_string(made.error());
        const std::string text =
            page->json["sources"][(*found)["source"].get<std::size_t>()]["text"];
        EXPECT_EQ(text, product_of(*made, ir::Stage::Pixel)->bytes) << words;
        EXPECT_EQ(text.find("float scale") == text.npos, words.starts_with("--fix")) << words;
    }
}

// Random costs and errors of one class at one elevation, twice each: two maps.
TEST(Front, HoldsExactlyWhatNothingElseBeats) {
    std::mt19937 random(3);
    for (int round = 0; round < 50; ++round) {
        PageData page;
        page.json = {
            {"maps", {{{"name", "a"}, {"class", "walls"}}, {{"name", "b"}, {"class", "walls"}}}}};
        const std::size_t count = 1 + random() % 12;
        for (std::size_t variant = 0; variant < count; ++variant) {
            page.variants.push_back({"relief", "glsl_450", {}, {}, false, false});
            page.json["variants"].push_back({{"d3d9", nullptr}, {"spirv", nullptr}});
            for (int map = 0; map < 2; ++map)
                page.json["cases"].push_back(
                    {{"map", map},
                     {"variant", variant},
                     {"view", {{"elevation", 30}, {"azimuth", 0}}},
                     {"reads", {{"mean", static_cast<double>(random() % 6)}}},
                     {"hits",
                      {{"p95", static_cast<double>(random() % 5)}, {"missed", 0}, {"pixels", 9}}}});
        }
        const std::vector<FrontPoint> points = front_points(page, "walls", 30);
        ASSERT_EQ(points.size(), count);
        for (const FrontPoint& point : points) {
            const auto& cases = page.json["cases"];
            const Json &first = cases[2 * point.variant], &second = cases[2 * point.variant + 1];
            EXPECT_EQ(
                point.reads,
                (first["reads"]["mean"].get<double>() + second["reads"]["mean"].get<double>()) / 2);
            EXPECT_EQ(point.p95, std::max(first["hits"]["p95"].get<double>(),
                                          second["hits"]["p95"].get<double>()));
            const auto beats = [&](const FrontPoint& other) {
                return other.reads <= point.reads && other.p95 <= point.p95 &&
                       (other.reads < point.reads || other.p95 < point.p95);
            };
            const bool beaten = std::any_of(points.begin(), points.end(), beats);
            // Of equals the front has one.
            EXPECT_FALSE(point.on_front && beaten);
            if (!beaten) {
                EXPECT_TRUE(std::any_of(points.begin(), points.end(), [&](const FrontPoint& other) {
                    return other.on_front && other.reads == point.reads && other.p95 == point.p95;
                }));
            }
        }
    }
}

TEST(Front, ReplacesOnlyWhatItMade) {
    const std::string begin = front_begin, end = front_end;
    const Result<std::string> made = with_front("a\n" + begin + "old" + end + "\nb", "new\n");
    ASSERT_TRUE(made);
    EXPECT_EQ(*made, "a\n" + begin + "\n\nnew\n" + end + "\nb");
    EXPECT_EQ(*with_front(*made, "new\n"), *made);
    EXPECT_EQ(with_front("nothing", "new").error().code, "no-marks");
}

TEST(ShellWords, UndoesQuoting) {
    std::mt19937 random(11);
    const std::string_view letters = "ab '\\$\"*-=.é#@";
    for (int round = 0; round < 500; ++round) {
        std::vector<std::string> words(1 + random() % 4), quoted;
        for (std::string& word : words) {
            for (std::size_t i = random() % 6; i > 0; --i)
                word += letters[random() % letters.size()];
            quoted.push_back(shell_quoted(word));
        }
        EXPECT_EQ(shell_words(fmt::format("{}", fmt::join(quoted, " "))), words);
    }
}

TEST(Html, HoldsEverythingAndAsksForNothing) {
    const Sample sample = report::sample();
    Result<PageData> page =
        page_data_of_measurement(to_json(sample.plan, sample.measurement, arguments), "r");
    ASSERT_TRUE(page);
    page->json["device"] = "</script><b>";
    const std::string text = html(*page, "<section id=\"live\"></section>");
    EXPECT_THAT(text, HasSubstr("<section id=\"live\">"));
    EXPECT_THAT(text, HasSubstr("Permission is hereby granted"));  // the library's licence
    EXPECT_THAT(text, HasSubstr("default-src 'none'"));
    EXPECT_THAT(text, Not(HasSubstr("</script><b>")));
    EXPECT_THAT(text, Not(HasSubstr(" src=\"http")));
    EXPECT_THAT(text, Not(HasSubstr("@import")));
    EXPECT_EQ(text, html(*page, "<section id=\"live\"></section>"));
    // Every place of the template names something.
    const std::string_view shell = page_file("report.html");
    ASSERT_FALSE(shell.empty());
    for (std::size_t open = shell.find("{{"); open != shell.npos;
         open = shell.find("{{", open + 2)) {
        const std::string_view name = shell.substr(open + 2, shell.find("}}", open) - open - 2);
        EXPECT_TRUE(name == "data" || name == "live" || !page_file(name).empty()) << name;
    }
    // The data comes back from the page as it went in.
    const std::string mark = "id=\"data\">";
    const std::size_t begin = text.find(mark) + mark.size();
    EXPECT_EQ(Json::parse(text.substr(begin, text.find("</script>", begin) - begin)), page->json);
}

}  // namespace
}  // namespace intaglio::report
