// The walk through the cells alone: in order, without a gap, and the path is in each cell while the
// walk says so.
#include "src/reference/walk.h"

#include "tests/unit/reference/witness.h"

namespace intaglio::reference {
namespace {

struct Visit {
    double x, y, t_in, t_out;
};

std::vector<Visit> walked(double x, double y, double step_x, double step_y, double begin,
                          double end) {
    std::vector<Visit> visits;
    walk(Axis(x, step_x, begin), Axis(y, step_y, begin), begin, end,
         [&](const Axis& ax, const Axis& ay, double t_in, double t_out) {
             visits.push_back({ax.cell(), ay.cell(), t_in, t_out});
             return false;
         });
    return visits;
}

TEST(Walk, EachCellFollowsThePreviousOne) {
    witness::Random random(witness::seed());
    for (int i = 0; i < 5000; ++i) {
        double start[2], step[2];
        for (int k = 0; k < 2; ++k) {
            start[k] = random.chance(0.5) ? random.integer(-8, 8) * 0.5 : random.real(-5, 5);
            step[k] = random.chance(0.3) ? random.integer(-9, 9) : random.real(-99, 99);
        }
        double begin = random.chance(0.5) ? 0 : random.real(0, 1);
        if (random.chance(0.3) && step[0] != 0) {  // on an edge, but for rounding
            begin = (std::floor(start[0] + step[0] * begin) - start[0]) / step[0];
            begin = std::clamp(std::nextafter(begin, random.integer(0, 1)), 0.0, 1.0);
        }
        const std::vector<Visit> visits = walked(start[0], start[1], step[0], step[1], begin, 1);
        ASSERT_EQ(visits.front().t_in, begin);
        ASSERT_EQ(visits.back().t_out, 1);
        for (std::size_t n = 0; n < visits.size(); ++n) {
            const Visit& visit = visits[n];
            ASSERT_LE(visit.t_in, visit.t_out);
            const double middle = (visit.t_in + visit.t_out) / 2;
            // 1e-13: coordinates of some 100, rounded a few times.
            ASSERT_NEAR(start[0] + step[0] * middle, visit.x + 0.5, 0.5 + 1e-13);
            ASSERT_NEAR(start[1] + step[1] * middle, visit.y + 0.5, 0.5 + 1e-13);
            if (n == 0) continue;
            ASSERT_EQ(visit.t_in, visits[n - 1].t_out);
            ASSERT_EQ(std::abs(visit.x - visits[n - 1].x) + std::abs(visit.y - visits[n - 1].y), 1);
        }
    }
}

TEST(Walk, APathThatDoesNotMoveStaysInItsCell) {
    const std::vector<Visit> visits = walked(2.5, -1, 0, 0, 0, 1);
    ASSERT_EQ(visits.size(), 1U);
    EXPECT_EQ(visits[0].x, 2);
    EXPECT_EQ(visits[0].y, -1);
    EXPECT_EQ(visits[0].t_out, 1);
}

TEST(Walk, StopsWhereItIsTold) {
    int visits = 0;
    EXPECT_TRUE(walk(Axis(0.5, 10, 0), Axis(0.5, 3, 0), 0, 1,
                     [&](const Axis&, const Axis&, double, double) { return ++visits == 3; }));
    EXPECT_EQ(visits, 3);
}

TEST(Axis, FractionsAreExactAtTheCrossings) {
    for (const double step : {0.1, 1 / 3.0, 7.7, -0.3, -123.4}) {
        Axis axis(0.7, step, 0);
        for (int k = 0; k < 100; ++k) {
            const double crossing = axis.leave();
            EXPECT_EQ(axis.fraction(crossing), step > 0 ? 1 : 0);
            axis.advance();
            EXPECT_EQ(axis.fraction(crossing), step > 0 ? 0 : 1);
        }
    }
}

}  // namespace
}  // namespace intaglio::reference
