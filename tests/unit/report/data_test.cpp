// JSON and CSV: readable by others, complete, and the same numbers.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "src/report/report.h"
#include "tests/unit/report/sample.h"

namespace intaglio::report {
namespace {

using ::testing::ElementsAre;
using Json = nlohmann::json;

const MapArguments arguments = {{"--height", "a b.png"}, {"--maker", "smooth"}};

// Reads RFC 4180 as the RFC's grammar has it.
std::vector<std::vector<std::string>> records_of(const std::string& text) {
    std::vector<std::vector<std::string>> records(1, {""});
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (quoted && c == '"' && i + 1 < text.size() && text[i + 1] == '"') {
            records.back().back() += text[++i];
        } else if (c == '"') {
            quoted = !quoted;
        } else if (!quoted && c == ',') {
            records.back().emplace_back();
        } else if (!quoted && c == '\r' && i + 1 < text.size() && text[i + 1] == '\n') {
            ++i;
            records.push_back({""});
        } else {
            records.back().back() += c;
        }
    }
    EXPECT_FALSE(quoted);
    EXPECT_EQ(records.back(), std::vector<std::string>{""}) << "the last record has no line break";
    records.pop_back();
    return records;
}

std::string cell(const std::vector<std::vector<std::string>>& records, std::size_t record,
                 const std::string& column) {
    const auto found = std::find(records[0].begin(), records[0].end(), column);
    if (found == records[0].end()) return "no column " + column;
    return records[record][static_cast<std::size_t>(found - records[0].begin())];
}

TEST(Data, JsonHasEveryCaseWithItsNumbers) {
    const Sample made = sample();
    const Json json = Json::parse(to_json(made.plan, made.measurement, arguments));
    EXPECT_EQ(json["schema"], "intaglio.measurement");
    EXPECT_EQ(json["version"], schema_version);
    EXPECT_EQ(json["device"], "llvmpipe, Mesa");
    EXPECT_EQ(json["plan"]["size"], 16);
    EXPECT_EQ(json["maps"][1],
              (Json{{"name", "smooth"}, {"width", 32}, {"height", 8}, {"bits", 16}}));
    EXPECT_EQ(json["rows"][2]["loops"], (Json{{"march", "unroll"}}));
    EXPECT_EQ(json["rows"][1]["knobs"], (Json{{"max_steps", "32"}}));
    EXPECT_EQ(json["rows"][1]["per_vertex"], true);
    EXPECT_EQ(json["rows"][1]["settings"], (Json{"taps = 1", "level = 0"}));
    EXPECT_EQ(json["rows"][1]["spirv"]["alu"], 101);
    ASSERT_EQ(json["cases"].size(), made.measurement.cases.size());
    for (std::size_t i = 0; i < json["cases"].size(); ++i) {
        const Json& read = json["cases"][i];
        const measure::CaseResult& result = made.measurement.cases[i];
        EXPECT_EQ(read["map"], made.plan.maps[static_cast<std::size_t>(result.map)].name);
        EXPECT_EQ(read["row"], result.row);
        EXPECT_EQ(read["view"]["elevation"], result.view.elevation);
        EXPECT_EQ(read["hits"]["p95"], result.hits.p95);
        EXPECT_EQ(read["hits"]["missed"], result.hits.missed);
        EXPECT_EQ(read["time"]["nanoseconds_per_pixel"], result.nanoseconds);
        EXPECT_EQ(read["hits"]["worst"]["u"], 3.5 / 16);
        EXPECT_EQ(read["hits"]["worst"]["v"], (5.5 + result.row) / 16);
    }
}

TEST(Data, TheCommandDrawsTheCaseAgain) {
    const Sample made = sample({{-10, 20}});
    EXPECT_EQ(run_command(made.plan, made.measurement.cases[2], arguments),
              "intaglio run parallax_occlusion -T hlsl_5_0 -D taps=8 --loop march=unroll --height "
              "'a b.png' --scale "
              "0.08 --mesh map --elevation=-10 --azimuth=20 --light-elevation=45 "
              "--light-azimuth=135 --size 16x16 -o "
              "picture.png --error-map errors.png");
    EXPECT_THAT(run_command(made.plan, made.measurement.cases[4], arguments),
                ::testing::HasSubstr("--per-vertex --maker smooth"));
}

TEST(Data, WithoutMapArgumentsThereIsNoCommand) {
    const Sample made = sample();
    EXPECT_TRUE(Json::parse(to_json(made.plan, made.measurement))["cases"][0]["command"].is_null());
    EXPECT_EQ(cell(records_of(to_csv(made.plan, made.measurement)), 1, "command"), "");
}

TEST(Data, ShellQuotingIsUndoneByAShell) {
    EXPECT_EQ(shell_quoted("maps/wall-1.png"), "maps/wall-1.png");
    EXPECT_EQ(shell_quoted(""), "''");
    EXPECT_EQ(shell_quoted("it's $HOME"), "'it'\\''s $HOME'");
}

TEST(Data, CsvSaysWhatJsonSays) {
    const Sample made = sample();
    const Json json = Json::parse(to_json(made.plan, made.measurement, arguments));
    const auto records = records_of(to_csv(made.plan, made.measurement, arguments));
    ASSERT_EQ(records.size(), made.measurement.cases.size() + 1);
    for (std::size_t i = 1; i < records.size(); ++i) {
        ASSERT_EQ(records[i].size(), records[0].size());
        const Json& read = json["cases"][i - 1];
        EXPECT_EQ(cell(records, i, "map"), read["map"]);
        EXPECT_EQ(cell(records, i, "surface"),
                  json["rows"][read["row"].get<std::size_t>()]["surface"]);
        EXPECT_EQ(cell(records, i, "command"), read["command"]);
        EXPECT_EQ(std::stod(cell(records, i, "hit_p95")), read["hits"]["p95"]);
        EXPECT_EQ(std::stod(cell(records, i, "hit_max")), read["hits"]["max"]);
        EXPECT_EQ(std::stod(cell(records, i, "worst_v")), read["hits"]["worst"]["v"]);
        EXPECT_EQ(std::stoi(cell(records, i, "reads_max")), read["reads"]["max"]);
        EXPECT_EQ(std::stoi(cell(records, i, "spirv_total")), 120 + read["row"].get<int>());
    }
}

TEST(Data, NumbersReadBackAsTheSameDoubles) {
    const std::uint32_t seed = 20;
    SCOPED_TRACE(fmt::format("seed {}", seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> exponents(-300, 300);
    Sample made = sample();
    for (measure::CaseResult& result : made.measurement.cases)
        result.hits.median = std::pow(10.0, exponents(random));
    made.measurement.cases[0].hits.median = std::numeric_limits<double>::denorm_min();
    made.measurement.cases[1].hits.median = 0.1;
    const Json json = Json::parse(to_json(made.plan, made.measurement));
    const auto records = records_of(to_csv(made.plan, made.measurement));
    for (std::size_t i = 0; i < made.measurement.cases.size(); ++i) {
        const double median = made.measurement.cases[i].hits.median;
        EXPECT_EQ(json["cases"][i]["hits"]["median"].get<double>(), median);
        const std::string text = cell(records, i + 1, "hit_median");
        double read = 0;
        std::from_chars(text.data(), text.data() + text.size(), read);
        EXPECT_EQ(read, median) << text;
    }
    EXPECT_EQ(cell(records, 2, "hit_median"), "0.1");
}

TEST(Data, UnknownIsNullAndEmpty) {
    Sample made = sample();
    made.measurement.cases[0].hits.invalid = made.measurement.cases[0].hits.pixels;
    made.measurement.cases[0].nanoseconds = 0;
    const Json read = Json::parse(to_json(made.plan, made.measurement))["cases"][0];
    EXPECT_TRUE(read["hits"]["p95"].is_null());
    EXPECT_TRUE(read["hits"]["worst"].is_null());
    EXPECT_TRUE(read["time"]["ratio"].is_null());
    EXPECT_EQ(read["hits"]["invalid"], 256);
    const auto records = records_of(to_csv(made.plan, made.measurement));
    EXPECT_EQ(cell(records, 1, "hit_p95"), "");
    EXPECT_EQ(cell(records, 1, "worst_x"), "");
    EXPECT_EQ(cell(records, 1, "time_ratio"), "");
    EXPECT_EQ(cell(records, 2, "time_ratio"), "2");
}

TEST(Data, CsvQuotesWhatItMust) {
    EXPECT_EQ(csv_field("plain text; 1.5"), "plain text; 1.5");
    EXPECT_EQ(csv_field("a,b"), "\"a,b\"");
    EXPECT_EQ(csv_field("say \"no\""), "\"say \"\"no\"\"\"");
    EXPECT_EQ(csv_field("two\nlines"), "\"two\nlines\"");
    Sample made = sample();
    made.plan.maps[0].name = "a \"wall\", old\r\nand red";
    EXPECT_EQ(cell(records_of(to_csv(made.plan, made.measurement)), 1, "map"),
              made.plan.maps[0].name);
}

TEST(Data, NamesThatAreNoUtf8StillGiveJson) {
    Sample made = sample();
    made.plan.maps[0].name =
        "w\xff"
        "ll";
    EXPECT_TRUE(Json::accept(to_json(made.plan, made.measurement)));
}

TEST(Data, TheSameMeasurementGivesTheSameBytes) {
    const Sample a = sample(), b = sample();
    EXPECT_EQ(to_json(a.plan, a.measurement, arguments), to_json(b.plan, b.measurement, arguments));
    EXPECT_EQ(to_csv(a.plan, a.measurement, arguments), to_csv(b.plan, b.measurement, arguments));
}

TEST(Data, Direct3d9RowsHaveSlotsAndThreeArithmetics) {
    const Sample made = direct3d9_sample();
    const Json json = Json::parse(to_json(made.plan, made.measurement, arguments));
    const auto records = records_of(to_csv(made.plan, made.measurement, arguments));
    EXPECT_EQ(json["rows"][1]["d3d9"]["arithmetic"], 41);
    EXPECT_TRUE(json["rows"][0]["d3d9"].is_null());
    for (std::size_t i = 0; i < made.measurement.cases.size(); ++i) {
        const measure::CaseResult& result = made.measurement.cases[i];
        const Json& hits = json["cases"][i]["narrow_hits"];
        EXPECT_EQ(cell(records, i + 1, "d3d9_texture"), result.row == 1 ? "9" : "");
        if (result.row != 1) {
            EXPECT_TRUE(hits.is_null());
            EXPECT_EQ(cell(records, i + 1, "hit_p95_fp24"), "");
            continue;
        }
        EXPECT_EQ(hits["fp24"]["p95"], result.narrow_hits[0].p95);
        EXPECT_EQ(hits["fp16"]["missed"], 128);
        EXPECT_EQ(cell(records, i + 1, "hit_p95_fp24"),
                  fmt::format("{}", result.narrow_hits[0].p95));
        EXPECT_EQ(cell(records, i + 1, "missed_fp16"), "128");
    }
}

}  // namespace
}  // namespace intaglio::report
