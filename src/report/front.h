// The Pareto front of a page's data in words and plots: for documents, where no script runs.
#pragma once

#include <string>
#include <vector>

#include "src/report/page_data.h"
#include "src/report/plot.h"

namespace intaglio::report {

// One variant on one class of maps from one elevation: texture reads per pixel, mean over its
// cases, and the worst of their errors.
struct FrontPoint {
    std::size_t variant = 0;
    double reads = 0;
    double p95 = 0;         // texels
    double missed = 0;      // % of the pixels
    bool on_front = false;  // nothing else costs as little and errs as little
};

// Errors below this count alike: nobody sees a thousandth of a texel.
inline constexpr double least_seen = 0.001;

// Of the cases in fp32 whose variants have no Direct3D 9 slots, by reads; on the front by p95.
// Straight down and other azimuths and lights of one elevation are one.
std::vector<FrontPoint> front_points(const PageData& page, const std::string& map_class,
                                     double elevation);

// Classes of the maps, in their order, and elevations from the zenith down.
std::vector<std::string> map_classes(const PageData& page);
std::vector<double> elevations(const PageData& page);

struct FrontDocument {
    std::string text;         // Markdown
    std::vector<Plot> plots;  // named after the classes
};
// How much was measured, summary tables (which variant is the cheapest within an error), what
// narrow arithmetics do to those that were measured in them, then for every class its plot,
// found under `pictures` with the plot's name and ".svg", and the points of its fronts.
FrontDocument front_document(const PageData& page, const std::string& pictures);

// Single lines of it, so that a test can compare some.
std::string front_row(const PageData& page, double elevation, const FrontPoint& point);
std::string extent(std::size_t variants, std::size_t maps, std::size_t elevations);

// `text` with what is between the two marks replaced.  Error "no-marks" without both.
inline constexpr const char* front_begin = "<!-- made by intaglio report: begin -->";
inline constexpr const char* front_end = "<!-- made by intaglio report: end -->";
Result<std::string> with_front(const std::string& text, const std::string& made);

}  // namespace intaglio::report
