// Comparing hits with the reference.
#include "src/measure/hits.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/measure/rows.h"

namespace intaglio::measure {
namespace {

reference::Vec2 pixel_uv(int x, int y, int width, int height) {
    return {(x + 0.5) / width, (y + 0.5) / height};
}

// Where on the ray, 0 at the polygon and 1 at the deepest point, a reported coordinate lies; 0
// where the ray does not move.
double ray_parameter(reference::Vec2 uv, reference::Vec2 reported, reference::Vec3 view,
                     double scale) {
    const double reach_x = view.x / view.z * scale, reach_y = view.y / view.z * scale;
    const double squared = reach_x * reach_x + reach_y * reach_y;
    if (!(squared > 0)) return 0;
    return ((uv.x - reported.x) * reach_x + (uv.y - reported.y) * reach_y) / squared;
}

// The value that a share of the sorted values does not exceed.
double percentile(const std::vector<float>& sorted, double share) {
    if (sorted.empty()) return 0;
    const double index = share * static_cast<double>(sorted.size() - 1);
    return sorted[static_cast<std::size_t>(std::llround(index))];
}

}  // namespace

ExactPicture trace_exact(const reference::HeightField& field, Direction view, Direction light,
                         float scale, int width, int height, int threads) {
    ExactPicture exact{
        width, height, std::vector<reference::Hit>(static_cast<std::size_t>(width * height)), {}};
    std::vector<char> lit(exact.hits.size());
    const reference::Vec3 v = exact_vector(vector_of(view));
    const reference::Vec3 l = exact_vector(vector_of(light));
    for_each_row(height, threads, [&](int y) {
        for (int x = 0; x < width; ++x) {
            const std::size_t pixel = static_cast<std::size_t>(y * width + x);
            const reference::Hit hit =
                reference::first_hit(field, pixel_uv(x, y, width, height), v, scale);
            exact.hits[pixel] = hit;
            lit[pixel] = reference::lit(field, hit.uv, hit.height, l, scale);
        }
    });
    exact.lit.assign(lit.begin(), lit.end());
    return exact;
}

std::vector<HitError> compare_hits(const vulkan::Picture& displaced, const ExactPicture& exact,
                                   const reference::HeightField& field, Direction view, float scale,
                                   int threads) {
    std::vector<HitError> errors(exact.hits.size());
    const reference::Vec3 v = exact_vector(vector_of(view));
    for_each_row(exact.height, threads, [&](int y) {
        for (int x = 0; x < exact.width; ++x) {
            const std::size_t pixel = static_cast<std::size_t>(y * exact.width + x);
            const std::array<float, 4>& reported = displaced.pixels[pixel];
            const reference::Hit& hit = exact.hits[pixel];
            HitError& error = errors[pixel];
            error.invalid = std::any_of(reported.begin(), reported.end(),
                                        [](float c) { return !std::isfinite(c); });
            if (error.invalid) {
                error.texels = std::numeric_limits<float>::infinity();
                continue;
            }
            const double du = (reported[0] - hit.uv.x) * field.width;
            const double dv = (reported[1] - hit.uv.y) * field.height;
            error.texels = static_cast<float>(std::hypot(du, dv));
            error.height = static_cast<float>(std::abs(reported[2] - hit.height));
            const reference::Vec2 uv = pixel_uv(x, y, exact.width, exact.height);
            const double reported_t = ray_parameter(uv, {reported[0], reported[1]}, v, scale);
            error.missed = hit.found && reference::leaves_relief(field, uv, v, scale, hit.t,
                                                                 std::min(reported_t, 1.0));
            error.shadow_wrong = error.texels < 1 && (reported[3] >= 0.5f) != exact.lit[pixel];
        }
    });
    return errors;
}

HitStatistics summarize(const std::vector<HitError>& errors, int width) {
    HitStatistics statistics;
    statistics.pixels = static_cast<std::int64_t>(errors.size());
    std::vector<float> texels, heights;
    for (std::size_t pixel = 0; pixel < errors.size(); ++pixel) {
        const HitError& error = errors[pixel];
        statistics.missed += error.missed;
        statistics.far += error.texels > 2;
        statistics.invalid += error.invalid;
        statistics.shadow_wrong += error.shadow_wrong;
        if (error.invalid) continue;
        if (texels.empty() || error.texels > statistics.max) {
            statistics.max = error.texels;
            statistics.worst_x = static_cast<int>(pixel) % width;
            statistics.worst_y = static_cast<int>(pixel) / width;
        }
        texels.push_back(error.texels);
        heights.push_back(error.height);
    }
    std::sort(texels.begin(), texels.end());
    std::sort(heights.begin(), heights.end());
    statistics.median = percentile(texels, 0.5);
    statistics.p95 = percentile(texels, 0.95);
    statistics.p99 = percentile(texels, 0.99);
    statistics.height_median = percentile(heights, 0.5);
    statistics.height_max = heights.empty() ? 0 : heights.back();
    return statistics;
}

}  // namespace intaglio::measure
