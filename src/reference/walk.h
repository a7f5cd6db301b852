// A walk through the cells of a grid along a straight path, in order, none left out and nothing
// allocated (Amanatides and Woo, "A fast voxel traversal algorithm", 1987).  Each crossing is
// computed from its own cell, never accumulated, so that the thousandth is as exact as the first.
// Inside the reference only.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace intaglio::reference {

// One coordinate of the path, start + step * t, and the unit interval [cell, cell + 1] it is in.
class Axis {
  public:
    Axis(double start, double step, double begin)
        : start_(start), step_(step), cell_(std::floor(start + step * begin)), enter_(begin) {
        leave_ = next_crossing();
    }

    double cell() const { return cell_; }
    double leave() const {
        return leave_;
    }  // the t at which the path leaves the cell; infinite if never

    // Into the next cell.
    void advance() {
        cell_ += step_ > 0 ? 1 : -1;
        enter_ = leave_;
        crossed_ = true;
        leave_ = next_crossing();
    }

    // Where in the cell the path is at `t`, in [0, 1].  Exactly 0 or 1 at the crossings.
    double fraction(double t) const {
        if (t == leave_) return step_ > 0 ? 1 : 0;
        if (crossed_ && t == enter_) return step_ > 0 ? 0 : 1;
        return std::clamp((start_ - cell_) + step_ * t, 0.0, 1.0);
    }

    // The same path on a grid `count` times as fine, whose cells are centred on the fine grid's
    // points.
    Axis refined(double count, double begin) const {
        return Axis(start_ * count + 0.5, step_ * count, begin);
    }

  private:
    double next_crossing() const {
        if (step_ == 0) return std::numeric_limits<double>::infinity();
        const double edge = step_ > 0 ? cell_ + 1 : cell_;
        return std::max((edge - start_) / step_, enter_);
    }

    double start_;
    double step_;
    double cell_;
    double enter_;
    double leave_ = 0;
    bool crossed_ = false;
};

// Calls visit(x, y, t_in, t_out) for each cell on [begin, end] until it returns true; says whether
// one did. Through a corner the walk passes one of the cells beside it, with t_in = t_out.
template <typename Visit>
bool walk(Axis x, Axis y, double begin, double end, Visit&& visit) {
    double t_in = begin;
    for (;;) {
        const double t_out = std::min(std::min(x.leave(), y.leave()), end);
        if (visit(std::as_const(x), std::as_const(y), t_in, t_out)) return true;
        if (t_out >= end) return false;
        if (x.leave() <= y.leave()) {
            x.advance();
        } else {
            y.advance();
        }
        t_in = t_out;
    }
}

}  // namespace intaglio::reference
