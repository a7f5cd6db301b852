// Ranges over a surface against brute force: whatever a random camera or light truly shows lies in
// its range, and without targets the range is no wider than what occurs.
#include "src/scene/geometry.h"
#include "tests/rounds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace intaglio::scene {
namespace {

constexpr double degree = std::numbers::pi / 180;

Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

struct Sample {
    double elevation, azimuth, distance;
};

Sample sample_of(const Point& world, const Place& place) {
    const double u = dot(world, place.tangent), v = dot(world, place.bitangent),
                 n = dot(world, place.normal);
    return {std::atan2(n, std::hypot(u, v)) / degree, std::atan2(v, u) / degree,
            std::sqrt(dot(world, world))};
}

class Dice {
  public:
    explicit Dice(unsigned seed) : random_(seed) {}
    double real(double least, double most) {
        return std::uniform_real_distribution<double>(least, most)(random_);
    }
    bool often(double share) { return real(0, 1) < share; }
    Point point(double reach) {
        return {real(-reach, reach), real(-reach, reach), real(-reach, reach)};
    }
    Place place() {
        for (;;) {
            // Axes as people give them, and any.
            const bool upright = often(0.3);
            const Point normal = upright ? Point{0, 0, 1} : point(1);
            const Point tangent = upright && often(0.5) ? Point{1, 0, 0} : point(1);
            const auto made =
                place_of(point(3), normal, tangent, often(0.3), real(0.1, 5), real(0.1, 5));
            if (made) return *made;
        }
    }

  private:
    std::mt19937 random_;
};

// Where on the place, with edges and corners as often as they matter.
Point point_of(Dice& dice, const Place& place) {
    const auto along = [&] {
        return dice.often(0.4) ? (dice.often(0.5) ? 0.5 : -0.5) : dice.real(-0.5, 0.5);
    };
    const double u = along() * place.width, v = along() * place.height;
    Point point = place.position;
    for (std::size_t i = 0; i < 3; ++i) point[i] += u * place.tangent[i] + v * place.bitangent[i];
    return point;
}

Point on_path(const std::vector<Point>& path, double at) {
    const auto i = std::min(static_cast<std::size_t>(at), path.size() - 1);
    const std::size_t next = std::min(i + 1, path.size() - 1);
    const double t = at - static_cast<double>(i);
    Point point{};
    for (std::size_t axis = 0; axis < 3; ++axis)
        point[axis] = path[i][axis] + (path[next][axis] - path[i][axis]) * t;
    return point;
}

bool holds(const Span& span, double value) {
    return value >= span.least - 1e-9 && value <= span.most + 1e-9;
}

bool holds_azimuth(const Span& span, double azimuth) {
    for (double turn : {-720.0, -360.0, 0.0, 360.0, 720.0})
        if (holds(span, azimuth + turn)) return true;
    return false;
}

void expect_held(const Ranges& ranges, const Sample& sample, unsigned seed) {
    ASSERT_TRUE(holds(ranges.elevation, sample.elevation))
        << "seed " << seed << ": elevation " << sample.elevation << " of " << ranges.elevation.least
        << " to " << ranges.elevation.most;
    // Straight above there is no azimuth.
    if (std::abs(sample.elevation) < 90 - 1e-7) {
        ASSERT_TRUE(holds_azimuth(ranges.azimuth, sample.azimuth))
            << "seed " << seed << ": azimuth " << sample.azimuth << " of " << ranges.azimuth.least
            << " to " << ranges.azimuth.most;
    }
}

TEST(SceneCamera, WhateverTheCameraSeesIsInTheRange) {
    for (unsigned seed = 1; seed <= rounds(300u); ++seed) {
        Dice dice(seed);
        const Place place = dice.place();
        Camera camera;
        camera.least_elevation = 1e-6;
        camera.near = 1e-6;
        const int points = 1 + static_cast<int>(dice.real(0, 4));
        for (int i = 0; i < points; ++i) camera.path.push_back(dice.point(8));
        const auto ranges = ranges_of_camera(camera, place);
        for (int i = 0; i < 300; ++i) {
            const Point eye = on_path(camera.path, dice.real(0, points - 1));
            const Sample sample = sample_of(minus(eye, point_of(dice, place)), place);
            if (sample.elevation < 1e-6) continue;
            ASSERT_TRUE(ranges) << "seed " << seed;
            expect_held(*ranges, sample, seed);
            ASSERT_TRUE(holds(ranges->distance, sample.distance)) << "seed " << seed;
        }
    }
}

// The ends of the ranges occur: a fine grid comes near them.  Its own coarseness is the tolerance.
TEST(SceneCamera, TheRangeIsNoWiderThanWhatIsSeen) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
        Dice dice(seed);
        Place place = dice.place();
        Camera camera;
        camera.least_elevation = 1e-6;
        camera.near = 1e-6;
        for (int i = 0; i < 2; ++i) {
            const double u = dice.real(-6, 6), v = dice.real(-6, 6), n = dice.real(1, 6);
            Point eye = place.position;
            for (std::size_t axis = 0; axis < 3; ++axis)
                eye[axis] +=
                    u * place.tangent[axis] + v * place.bitangent[axis] + n * place.normal[axis];
            camera.path.push_back(eye);
        }
        const auto ranges = ranges_of_camera(camera, place);
        ASSERT_TRUE(ranges);
        Span elevation{90, -90}, distance{1e9, 0};
        std::vector<double> azimuths;
        constexpr int steps = 32;
        for (int t = 0; t <= steps; ++t)
            for (int i = 0; i <= steps; ++i)
                for (int j = 0; j <= steps; ++j) {
                    Point point = place.position;
                    const double u = (i / double{steps} - 0.5) * place.width;
                    const double v = (j / double{steps} - 0.5) * place.height;
                    for (std::size_t axis = 0; axis < 3; ++axis)
                        point[axis] += u * place.tangent[axis] + v * place.bitangent[axis];
                    const Sample sample =
                        sample_of(minus(on_path(camera.path, t / double{steps}), point), place);
                    azimuths.push_back(sample.azimuth);
                    elevation.least = std::min(elevation.least, sample.elevation);
                    elevation.most = std::max(elevation.most, sample.elevation);
                    distance.least = std::min(distance.least, sample.distance);
                    distance.most = std::max(distance.most, sample.distance);
                }
        // A grid point lies within 0.2 of any other of path and place, and the eye 1 away: 13
        // degrees at the very worst, where both turn by it.
        EXPECT_NEAR(ranges->elevation.least, elevation.least, 2) << "seed " << seed;
        EXPECT_NEAR(ranges->elevation.most, elevation.most, 13) << "seed " << seed;
        EXPECT_NEAR(ranges->distance.least, distance.least, 0.2) << "seed " << seed;
        EXPECT_NEAR(ranges->distance.most, distance.most, 0.2) << "seed " << seed;
        std::sort(azimuths.begin(), azimuths.end());
        double gap = azimuths.front() + 360 - azimuths.back();
        for (std::size_t i = 1; i < azimuths.size(); ++i)
            gap = std::max(gap, azimuths[i] - azimuths[i - 1]);
        // Straight below the eye azimuths turn fast; elsewhere the corners are on the grid.
        if (ranges->elevation.most >= 89) continue;
        EXPECT_NEAR(ranges->azimuth.most - ranges->azimuth.least, 360 - gap, 1) << "seed " << seed;
    }
}

TEST(SceneCamera, WhatIsInThePictureIsInTheRangeAndTheRestMayNotBe) {
    int narrower = 0, seen = 0;
    for (unsigned seed = 1; seed <= rounds(100u); ++seed) {
        Dice dice(seed);
        const Place place = dice.place();
        Camera camera;
        camera.least_elevation = 1e-6;
        camera.near = 1e-6;
        camera.field_of_view = dice.real(10, 90);
        const int points = 1 + static_cast<int>(dice.real(0, 3));
        for (int i = 0; i < points; ++i) {
            camera.path.push_back(dice.point(8));
            camera.targets.push_back(dice.point(8));
        }
        const auto ranges = ranges_of_camera(camera, place);
        const double reach = std::tan(camera.field_of_view / 2 * degree);
        const double corner = std::cos(std::atan(reach * std::hypot(1, camera.aspect)));
        for (int i = 0; i < 1000; ++i) {
            const double at = dice.real(0, points - 1);
            const Point eye = on_path(camera.path, at);
            const Point look = minus(on_path(camera.targets, at), eye);
            const Point to_eye = minus(eye, point_of(dice, place));
            const Sample sample = sample_of(to_eye, place);
            const double cosine =
                -dot(look, to_eye) / std::sqrt(dot(look, look) * dot(to_eye, to_eye));
            if (cosine < corner || sample.elevation < 1e-6) continue;
            ++seen;
            ASSERT_TRUE(ranges) << "seed " << seed;
            expect_held(*ranges, sample, seed);
        }
        Camera blind = camera;
        blind.targets.clear();
        const auto all = ranges_of_camera(blind, place);
        if (all && (!ranges || ranges->elevation.least > all->elevation.least + 1 ||
                    ranges->elevation.most < all->elevation.most - 1))
            ++narrower;
    }
    EXPECT_GT(seen, rounds(1000));
    EXPECT_GT(narrower, rounds(20));
}

TEST(SceneCamera, BehindThePolygonNothingIsSeen) {
    Camera camera;
    camera.path = {{0, 0, -1}, {3, 0, -0.01}};
    EXPECT_FALSE(ranges_of_camera(camera, Place{}));
    camera.path.push_back({3, 0, 2});
    const auto ranges = ranges_of_camera(camera, Place{});
    ASSERT_TRUE(ranges);
    EXPECT_EQ(ranges->elevation.least, camera.least_elevation);
}

TEST(SceneCamera, StraightAboveAndFromOneSide) {
    Camera camera;
    camera.path = {{0, 0, 2}};
    Place place;
    place.width = place.height = 2;
    const auto above = ranges_of_camera(camera, place);
    ASSERT_TRUE(above);
    EXPECT_EQ(above->elevation.most, 90);
    EXPECT_NEAR(above->elevation.least, std::atan2(2, std::sqrt(2)) / degree, 2e-6);
    EXPECT_EQ(above->azimuth, (Span{0, 360}));
    EXPECT_NEAR(above->distance.least, 2, 2e-6);

    camera.path = {{4, 0, 3}};
    const auto side = ranges_of_camera(camera, place);
    ASSERT_TRUE(side);
    EXPECT_NEAR(side->elevation.most, 45, 2e-6);
    EXPECT_NEAR(side->azimuth.most, std::atan2(1, 3) / degree, 2e-6);
    EXPECT_NEAR(side->azimuth.least, -std::atan2(1, 3) / degree, 2e-6);
}

TEST(SceneLight, ALampIsInTheRangeFromEveryPoint) {
    for (unsigned seed = 1; seed <= rounds(300u); ++seed) {
        Dice dice(seed);
        const Place place = dice.place();
        const Point lamp = dice.point(5);
        const Ranges ranges = ranges_of_lamp(lamp, place);
        Span elevation{90, -90};
        for (int i = 0; i < 300; ++i) {
            const Sample sample = sample_of(minus(lamp, point_of(dice, place)), place);
            expect_held(ranges, sample, seed);
            elevation.least = std::min(elevation.least, sample.elevation);
            elevation.most = std::max(elevation.most, sample.elevation);
        }
        EXPECT_LE(ranges.elevation.least, elevation.least + 1e-9);
    }
}

TEST(SceneLight, ASunIsInTheRangeAndTheRangeIsTight) {
    for (unsigned seed = 1; seed <= rounds(300u); ++seed) {
        Dice dice(seed);
        const Place place = dice.place();
        const double low = dice.real(-90, 90), from = dice.real(-360, 0);
        const Span elevation{low, dice.often(0.3) ? low : dice.real(low, 90)};
        const Span azimuth{from, dice.often(0.3)   ? from
                                 : dice.often(0.2) ? from + 360
                                                   : from + dice.real(0, 360)};
        const Ranges ranges = ranges_of_sun(elevation, azimuth, place);
        Span seen{90, -90};
        for (int i = 0; i < 1000; ++i) {
            const auto along = [&](Span span) {
                return dice.often(0.3)   ? (dice.often(0.5) ? span.least : span.most)
                       : dice.often(0.1) ? std::clamp(90 - std::acos(place.normal[2]) / degree,
                                                      span.least, span.most)
                                         : dice.real(span.least, span.most);
            };
            const Sample sample = sample_of(direction_of(along(elevation), along(azimuth)), place);
            expect_held(ranges, sample, seed);
            seen.least = std::min(seen.least, sample.elevation);
            seen.most = std::max(seen.most, sample.elevation);
        }
        // A thousand samples of two dimensions lie about 360 / 30 degrees apart.
        EXPECT_NEAR(ranges.elevation.least, seen.least, 12) << "seed " << seed;
        EXPECT_NEAR(ranges.elevation.most, seen.most, 12) << "seed " << seed;
    }
}

TEST(SceneLight, OneDirectionStaysOne) {
    for (unsigned seed = 1; seed <= 100; ++seed) {
        Dice dice(seed);
        const Place place = dice.place();
        const Span elevation{dice.real(-80, 80), 0}, azimuth{dice.real(-180, 180), 0};
        const Span one{elevation.least, elevation.least}, turn{azimuth.least, azimuth.least};
        const Ranges ranges = ranges_of_sun(one, turn, place);
        EXPECT_TRUE(ranges.elevation.is_one()) << "seed " << seed;
        EXPECT_TRUE(ranges.azimuth.is_one()) << "seed " << seed;
        const Sample sample = sample_of(direction_of(one.least, turn.least), place);
        EXPECT_NEAR(ranges.elevation.least, sample.elevation, 1e-8) << "seed " << seed;
        EXPECT_TRUE(holds_azimuth({ranges.azimuth.least - 1e-7, ranges.azimuth.most + 1e-7},
                                  sample.azimuth))
            << "seed " << seed;
    }
}

TEST(SceneLight, AWallTurnsTheSun) {
    // Faces -y; u to the east, v up: mirrored it would run down.
    const auto wall = place_of({0, 0, 0}, {0, -1, 0}, {1, 0, 0}, false, 1, 1);
    ASSERT_TRUE(wall);
    EXPECT_NEAR(wall->bitangent[2], 1, 1e-12);
    const Ranges front = ranges_of_sun({0, 0}, {-90, -90}, *wall);
    EXPECT_NEAR(front.elevation.least, 90, 1e-6);
    const Ranges behind = ranges_of_sun({10, 40}, {60, 120}, *wall);
    EXPECT_LT(behind.elevation.most, 0);
    const Ranges above = ranges_of_sun({60, 60}, {-90, -90}, *wall);
    EXPECT_NEAR(above.elevation.least, 30, 1e-6);
    EXPECT_NEAR(above.azimuth.least, 90, 1e-6);  // from above is towards +v
}

TEST(ScenePlace, WhatIsNoFrameIsRefused) {
    EXPECT_FALSE(place_of({}, {0, 0, 0}, {1, 0, 0}, false, 1, 1));
    EXPECT_FALSE(place_of({}, {0, 0, 1}, {0, 0, 0}, false, 1, 1));
    EXPECT_FALSE(place_of({}, {0, 0, 2}, {0, 0, -3}, false, 1, 1));
    const auto place = place_of({}, {0, 0, 2}, {3, 0, 1}, true, 1, 1);
    ASSERT_TRUE(place);
    EXPECT_EQ(place->tangent, (Point{1, 0, 0}));
    EXPECT_EQ(place->bitangent[1], -1);
}

}  // namespace
}  // namespace intaglio::scene
