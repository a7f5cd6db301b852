// docs/speed-against-error.md: it is of the sweep that is in the examples, and a handful of its
// cases, measured again, are the rows that stand there.
#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "src/measure/command.h"
#include "src/report/front.h"
#include "src/scene/sweep.h"
#include "templates/all_techniques.h"

namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using namespace intaglio;

constexpr const char* again =
    "write it again: intaglio sweep examples/04_sweep/sweep.toml -o out/sweep && intaglio report "
    "out/sweep --markdown docs/speed-against-error.md";

std::string contents(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

const std::string& document() {
    static const std::string text = contents(INTAGLIO_ROOT "/docs/speed-against-error.md");
    return text;
}

measure::SweepPlan sweep() {
    const Result<measure::SweepPlan> plan =
        scene::read_sweep(INTAGLIO_ROOT "/examples/04_sweep/sweep.toml");
    if (!plan) ADD_FAILURE() << to_string(plan.error());
    return plan ? *plan : measure::SweepPlan();
}

TEST(SpeedAgainstError, IsOfTheSweepInTheExamples) {
    const measure::SweepPlan plan = sweep();
    std::set<double> elevations;
    std::set<std::string> variants;  // one may be asked for twice, in other arithmetics
    for (const measure::SweepCase& one : plan.cases) {
        elevations.insert(one.what.view.elevation);
        variants.insert(measure::text_of(one.what.request));
    }
    EXPECT_THAT(document(),
                HasSubstr(report::extent(variants.size(), plan.maps.size(), elevations.size())))
        << again;
}

// On the front of its class, on a map that is made and not read, with nothing to bake.
struct Row {
    std::string taps;  // of parallax_occlusion
    double elevation;
};

TEST(SpeedAgainstError, HasTheRowsThatAreMeasuredToday) {
    const std::string map_class = "noise";
    const std::vector<Row> rows = {{"4", 75}, {"8", 60}, {"4", 15}};
    measure::SweepPlan plan = sweep();
    std::erase_if(plan.cases, [&](const measure::SweepCase& one) {
        const VariantRequest& request = one.what.request;
        return plan.maps[one.map].map_class != map_class ||
               std::none_of(rows.begin(), rows.end(), [&](const Row& row) {
                   return request.surface == "parallax_occlusion" && request.target == "glsl_450" &&
                          request.knobs[0].second == row.taps &&
                          one.what.view.elevation == row.elevation;
               });
    });
    ASSERT_EQ(plan.cases.size(), rows.size());
    const fs::path folder =
        fs::temp_directory_path() / ("intaglio front " + std::to_string(getpid()));
    measure::SweepOptions options;
    options.folder = folder;
    const dsl::Catalogue catalogue = templates::all_techniques();
    const Result<measure::SweepSummary> summary = measure::run_sweep(catalogue, plan, options);
    ASSERT_TRUE(summary) << to_string(summary.error());
    const Result<report::PageData> page =
        report::page_data_of_sweep(contents(folder / "results.jsonl"), "results.jsonl", catalogue);
    fs::remove_all(folder);
    ASSERT_TRUE(page) << to_string(page.error());
    const std::string section = document().substr(document().find("### " + map_class + "\n"));
    std::size_t compared = 0;
    for (double elevation : report::elevations(*page))
        for (const report::FrontPoint& point : report::front_points(*page, map_class, elevation)) {
            EXPECT_THAT(section, HasSubstr(report::front_row(*page, elevation, point))) << again;
            ++compared;
        }
    EXPECT_EQ(compared, rows.size());
}

}  // namespace
