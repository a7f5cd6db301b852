// A sweep file is a scene file (scene.h) with more lists: every map is measured at every scale,
// with every variant, arithmetic, view and light.  Beyond a scene's it has
//
//     [relief]
//     scale = [0.04, 0.08]              # a number or several
//     [run]
//     size = 128                        # pixels a side; the default of sweeps
//     split = 31                        # rays a side whose error is split by source; 0: none
//     arithmetics = ["fp32"]            # of the pixel stage: fp32, fp24, fp16
//     [[map]]
//     class = "bricks"                  # what the map is an example of; where missing, its name
//     [[variant]]
//     arithmetics = ["fp24"]            # in place of [run]'s
//
// `rounds` of a scene is read and does nothing: times do not belong to a case.
#pragma once

#include <filesystem>

#include "generator/base/result.h"
#include "src/measure/sweep.h"

namespace intaglio::scene {

// Reads a sweep and loads its maps.  Cases come by scale, map, variant (as in scenes), arithmetic,
// view and light.  The commands that results hold take files as the sweep names them, so they are
// for its folder.  Codes as of read_measurement; "unknown-arithmetic".
Result<measure::SweepPlan> read_sweep(const std::filesystem::path& path);

}  // namespace intaglio::scene
