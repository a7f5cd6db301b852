// Texel coordinates and the four texels around a cell.  Inside the reference only.
// In texel coordinates texel centres are the integers: x = u * width - 0.5, and cell i reaches from
// i to i + 1.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "src/reference/height_field.h"

namespace intaglio::reference {

// The texel coordinate of `u` along an axis of `size` texels.  Repeated coordinates are wrapped
// first: the texels are the same and the fraction keeps all its bits.  Clamped ones are cut off so
// far outside that no path of max_travel (trace.cpp) comes back to where heights differ.
inline double texel_coordinate(double u, int size, Wrap wrap) {
    constexpr double far = 1099511627776.0;  // 2^40
    if (wrap == Wrap::Repeat) return (u - std::floor(u)) * size - 0.5;
    return std::clamp(u * size - 0.5, -far, far);
}

// The two texels on either side of a cell along one axis, followed from cell to cell without
// division.
class TexelPair {
  public:
    TexelPair(double cell, int size, Wrap wrap) : cell_(cell), size_(size), wrap_(wrap) {
        if (wrap == Wrap::Repeat) {
            const double turns = std::floor(cell / size);
            set_repeated(static_cast<int>(cell - turns * size));
        } else {
            set_clamped();
        }
    }

    // `cell` is the present cell or one next to it.
    void follow(double cell) {
        if (cell == cell_) return;
        const bool up = cell > cell_;
        cell_ = cell;
        if (wrap_ == Wrap::Clamp) {
            set_clamped();
        } else if (up) {
            set_repeated(high_);
        } else {
            set_repeated(low_ == 0 ? size_ - 1 : low_ - 1);
        }
    }

    int low() const { return low_; }
    int high() const { return high_; }

  private:
    void set_repeated(int low) {
        low_ = low;
        high_ = low + 1 == size_ ? 0 : low + 1;
    }
    void set_clamped() {
        const double last = size_ - 1;
        low_ = static_cast<int>(std::clamp(cell_, 0.0, last));
        high_ = static_cast<int>(std::clamp(cell_ + 1, 0.0, last));
    }

    double cell_;
    int size_;
    Wrap wrap_;
    int low_ = 0;
    int high_ = 0;
};

// Exact at both ends and where they are equal, so that neighbouring cells agree on their common
// edge.
inline double blend(double a, double b, double weight) {
    return weight == 1 ? b : a + (b - a) * weight;
}

// The heights at the corners of a cell; the first digit counts along x.
struct Patch {
    double h00, h10, h01, h11;

    Patch(const HeightField& field, const TexelPair& x, const TexelPair& y) {
        const auto width = static_cast<std::size_t>(field.width);
        const double* low = field.heights.data() + static_cast<std::size_t>(y.low()) * width;
        const double* high = field.heights.data() + static_cast<std::size_t>(y.high()) * width;
        h00 = low[x.low()];
        h10 = low[x.high()];
        h01 = high[x.low()];
        h11 = high[x.high()];
    }

    double at(double fx, double fy) const {
        return blend(blend(h00, h10, fx), blend(h01, h11, fx), fy);
    }

    double top() const { return std::max(std::max(h00, h10), std::max(h01, h11)); }

    // The coefficient of fx * fy.
    double twist() const { return (h11 - h01) - (h10 - h00); }

    // How far 8-bit weights may move the surface: each is off by at most half of 1/256.  A margin
    // far above rounding and far below anything visible is added, because the value serves to skip
    // cells.
    double weight_error() const {
        const double along_x = std::max(std::abs(h10 - h00), std::abs(h11 - h01));
        const double along_y = std::max(std::abs(h01 - h00), std::abs(h11 - h10));
        return (along_x + along_y) / 512 + std::abs(twist()) / (512.0 * 512.0) + 1e-10;
    }
};

}  // namespace intaglio::reference
