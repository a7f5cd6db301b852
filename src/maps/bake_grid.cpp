// The grid's copy of the heights, threads, and rounding.
#include "src/maps/bake_grid.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <thread>

namespace intaglio::maps {
namespace {

double steps(int bits) { return bits == 8 ? 255 : 65535; }

float texel(double step, int bits) {
    return static_cast<float>(std::clamp(step, 0.0, steps(bits)) / steps(bits));
}

}  // namespace

Grid::Grid(const Image& heights) : width_(heights.width), height_(heights.height) {
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x) heights_.push_back(static_cast<double>(heights.at(x, y)));
    top_ = *std::max_element(heights_.begin(), heights_.end());
}

double Grid::height_at(double x, double y) const {
    const double i = std::floor(x), j = std::floor(y);
    const std::array<double, 4> h = corners(static_cast<int>(i), static_cast<int>(j));
    const double fx = x - i, fy = y - j;
    const double upper = h[0] + (h[1] - h[0]) * fx, lower = h[2] + (h[3] - h[2]) * fx;
    return upper + (lower - upper) * fy;
}

void for_each_row(int count, const std::function<void(int)>& row, const Work& work) {
    const int most = work.threads > 0
                         ? work.threads
                         : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    std::atomic<int> next{0};
    std::mutex reporting;
    int done = 0;
    const auto take_rows = [&] {
        for (int i = next++; i < count; i = next++) {
            row(i);
            if (!work.progress) continue;
            const std::lock_guard lock(reporting);
            work.progress(++done, count);
        }
    };
    std::vector<std::thread> others;
    for (int i = 1; i < std::min(most, count); ++i) others.emplace_back(take_rows);
    take_rows();
    for (std::thread& other : others) other.join();
}

float rounded_down(double value, int bits) { return texel(std::floor(value * steps(bits)), bits); }

float rounded(double value, int bits) { return texel(std::round(value * steps(bits)), bits); }

}  // namespace intaglio::maps
