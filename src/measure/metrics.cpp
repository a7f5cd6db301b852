// Swim and the split of errors.
#include "src/measure/metrics.h"

#include <algorithm>
#include <cmath>

namespace intaglio::measure {
namespace {

bool is_finite(const std::array<float, 4>& pixel) {
    return std::all_of(pixel.begin(), pixel.end(), [](float c) { return std::isfinite(c); });
}

double percentile(const std::vector<double>& sorted, double share) {
    if (sorted.empty()) return 0;
    return sorted[static_cast<std::size_t>(
        std::llround(share * static_cast<double>(sorted.size() - 1)))];
}

struct Texels {
    double x, y;
    double length() const { return std::hypot(x, y); }
    double dot(Texels other) const { return x * other.x + y * other.y; }
};
Texels operator-(Texels a, Texels b) { return {a.x - b.x, a.y - b.y}; }

}  // namespace

Direction moved_view(Direction view) {
    view.elevation += view.elevation > 2 * swim_step ? -swim_step : swim_step;
    return view;
}

Swim swim_of(const vulkan::Picture& before, const vulkan::Picture& after,
             const ExactPicture& exact_before, const ExactPicture& exact_after, int map_width,
             int map_height) {
    Swim swim;
    std::vector<double> changes;
    for (std::size_t i = 0; i < before.pixels.size(); ++i) {
        const std::array<float, 4>&a = before.pixels[i], &b = after.pixels[i];
        if (!is_finite(a) || !is_finite(b)) continue;
        const reference::Vec2 from = exact_before.hits[i].uv, to = exact_after.hits[i].uv;
        const double u = (static_cast<double>(b[0]) - static_cast<double>(a[0])) - (to.x - from.x);
        const double v = (static_cast<double>(b[1]) - static_cast<double>(a[1])) - (to.y - from.y);
        const double change = std::hypot(u * map_width, v * map_height);
        if (changes.empty() || change > swim.max) {
            swim.max = change;
            swim.worst_x = static_cast<int>(i) % before.width;
            swim.worst_y = static_cast<int>(i) / before.width;
        }
        changes.push_back(change);
    }
    std::sort(changes.begin(), changes.end());
    swim.pixels = static_cast<std::int64_t>(changes.size());
    swim.median = percentile(changes, 0.5);
    swim.p95 = percentile(changes, 0.95);
    return swim;
}

Hits hits_in(const vulkan::Picture& picture) {
    Hits hits(picture.pixels.size());
    for (std::size_t i = 0; i < hits.size(); ++i)
        std::copy(picture.pixels[i].begin(), picture.pixels[i].end(), hits[i].begin());
    return hits;
}

ErrorSplit split_error(const SplitHits& hits, const ExactPicture& exact, int map_width,
                       int map_height) {
    ErrorSplit split;
    for (std::size_t i = 0; i < exact.hits.size(); ++i) {
        const auto place = [&](const Hits& of) {
            return Texels{of[i][0] * map_width, of[i][1] * map_height};
        };
        const Texels right{exact.hits[i].uv.x * map_width, exact.hits[i].uv.y * map_height};
        const Texels technique = place(hits.technique) - right,
                     filter = place(hits.filter) - place(hits.technique),
                     arithmetic = place(hits.arithmetic) - place(hits.technique),
                     total = place(hits.total) - right;
        const Texels interaction = total - technique - filter - arithmetic;
        const double length = total.length();
        const double lengths = length + technique.length() + filter.length() + arithmetic.length();
        if (!std::isfinite(lengths)) {
            ++split.invalid;
            continue;
        }
        ++split.rays;
        split.technique_alone += technique.length();
        split.filter_alone += filter.length();
        split.arithmetic_alone += arithmetic.length();
        // Where the sum of the parts is nothing they have no direction to be measured along.
        if (length == 0) continue;
        split.total += length;
        split.technique += technique.dot(total) / length;
        const double together = interaction.dot(total) / length;
        split.filter += filter.dot(total) / length + together / 2;
        split.arithmetic += arithmetic.dot(total) / length + together / 2;
        split.interaction += together;
    }
    const double rays = static_cast<double>(std::max<std::int64_t>(1, split.rays));
    for (double* sum :
         {&split.total, &split.technique, &split.filter, &split.arithmetic, &split.interaction,
          &split.technique_alone, &split.filter_alone, &split.arithmetic_alone})
        *sum /= rays;
    return split;
}

}  // namespace intaglio::measure
