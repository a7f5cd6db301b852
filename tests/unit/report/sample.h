// A measurement without a device: every number follows from its place, so that a test can say what
// must stand where.
#pragma once

#include "src/measure/measure.h"

namespace intaglio::report {

struct Sample {
    measure::Plan plan;
    measure::Measurement measurement;
};

// Two maps, the given views and lights, three rows.  The p95 of a case is
// 1 + row / 10 + (90 - elevation) / 30 + azimuth / 1000.
inline Sample sample(std::vector<measure::Direction> views = {{90, 0}, {30, 20}},
                     std::vector<measure::Direction> lights = {{45, 135}}) {
    Sample made;
    made.plan.views = std::move(views);
    made.plan.lights = std::move(lights);
    made.plan.size = 16;
    made.plan.rows = {
        {"none", "glsl_450", {}, {}, false, false},
        {"search=steep_parallax,shadow=march", "glsl_450", {{"max_steps", "32"}}, {}, true, false},
        {"parallax_occlusion",
         "hlsl_5_0",
         {{"taps", "8"}},
         {{"march", ir::LoopForm::Unrolled}},
         false,
         false}};
    for (const char* name : {"bricks", "smooth"}) {
        measure::MapSet set;
        set.name = name;
        set.heights = maps::blank_image(32, 8, 1, 16);
        made.plan.maps.push_back(set);
    }
    made.measurement.device = "llvmpipe, Mesa";
    for (int row = 0; row < 3; ++row) {
        check::SpirvCost cost;
        cost.alu = 100 + row;
        cost.texture = 10 + row;
        cost.total = 120 + row;
        made.measurement.costs.push_back(cost);
        made.measurement.slots.emplace_back();
        made.measurement.settings.push_back({"taps = " + std::to_string(row), "level = 0"});
    }
    for (int map = 0; map < 2; ++map) {
        for (measure::Direction view : made.plan.views) {
            for (measure::Direction light : made.plan.lights) {
                for (int row = 0; row < 3; ++row) {
                    measure::CaseResult result;
                    result.row = row;
                    result.map = map;
                    result.view = view;
                    result.light = light;
                    result.hits.pixels = 256;
                    result.hits.p95 =
                        1 + row / 10.0 + (90 - view.elevation) / 30 + view.azimuth / 1000;
                    result.hits.median = result.hits.p95 / 3;
                    result.hits.p99 = result.hits.p95 * 1.1;
                    result.hits.max = result.hits.p95 * 100;
                    result.hits.missed = row;
                    result.hits.worst_x = 3;
                    result.hits.worst_y = 5 + row;
                    result.reads_mean = 4.25 + row;
                    result.reads_max = 9;
                    result.nanoseconds = 12.5 * (row + 1);
                    result.ratio = row + 1;
                    result.ratio_low = result.ratio * 0.9;
                    result.ratio_high = result.ratio * 1.25;
                    made.measurement.cases.push_back(result);
                }
            }
        }
    }
    return made;
}

// The same with the second row on ps_2_0: 41 arithmetic and 9 texture slots, errors in fp24 and
// fp16 2 and 300 times those in fp32.
inline Sample direct3d9_sample() {
    Sample made = sample();
    made.plan.rows[1].target = "ps_2_0";
    d3d9::Resources slots;
    slots.arithmetic = 41;
    slots.texture = 9;
    slots.temps = 6;
    slots.dependent_level = 2;
    made.measurement.slots[1] = slots;
    for (measure::CaseResult& result : made.measurement.cases) {
        if (result.row != 1) continue;
        result.narrow_hits = {result.hits, result.hits};
        result.narrow_hits[0].p95 *= 2;
        result.narrow_hits[1].p95 *= 300;
        result.narrow_hits[1].missed = 128;
    }
    return made;
}

}  // namespace intaglio::report
