// Cameras against what a person sees: the middle is in the middle, up is up, near is 0 and far
// is 1.
#include "src/vulkan/camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace intaglio::vulkan {
namespace {

std::array<float, 3> projected(const Camera& camera, Point p) {
    const auto clip = camera.clip(p);
    return {clip[0] / clip[3], clip[1] / clip[3], clip[2] / clip[3]};
}

TEST(Camera, MapQuadSendsCornersOfTheQuadToCornersOfTheTarget) {
    const Camera camera = map_quad();
    EXPECT_EQ(camera.clip({0, 0, 0}), (std::array<float, 4>{-1, -1, 0, 1}));
    EXPECT_EQ(camera.clip({1, 1, 0}), (std::array<float, 4>{1, 1, 0, 1}));
    EXPECT_EQ(camera.clip({0.25f, 0.5f, 0}), (std::array<float, 4>{-0.5f, 0, 0, 1}));
}

TEST(Camera, LooksAtTheTargetWithUpUpwards) {
    const auto camera = look_at({3, 0, 0}, {0, 0, 0}, {0, 0, 1}, {.vertical_degrees = 90});
    ASSERT_TRUE(camera.ok());
    // Float table: errors of a few ulp of numbers around 3.
    const auto middle = projected(*camera, {0, 0, 0});
    EXPECT_NEAR(middle[0], 0, 1e-6);
    EXPECT_NEAR(middle[1], 0, 1e-6);
    EXPECT_LT(projected(*camera, {0, 0, 1})[1], -0.1f) << "y points down in clip space";
    EXPECT_GT(projected(*camera, {0, 1, 0})[0], 0.1f)
        << "seen from +x with z up, +y is to the right";
    EXPECT_NEAR(projected(*camera, {0, 0, 3})[1], -1, 1e-6)
        << "45 degrees above the axis is the edge";
}

TEST(Camera, DepthRunsFromNearToFarAlongTheView) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> coordinate(-5, 5);
    for (int i = 0; i < 100; ++i) {
        const Point eye{coordinate(random), coordinate(random), coordinate(random)};
        const Point target{coordinate(random), coordinate(random), coordinate(random)};
        const auto camera =
            look_at(eye, target, {0, 0, 1}, {.aspect = 2, .near_plane = 0.5f, .far_plane = 20});
        ASSERT_TRUE(camera.ok());
        float distance = 0;
        for (std::size_t k = 0; k < 3; ++k) distance += (target[k] - eye[k]) * (target[k] - eye[k]);
        distance = std::sqrt(distance);
        const auto at = [&](float along) {
            Point p{};
            for (std::size_t k = 0; k < 3; ++k)
                p[k] = eye[k] + (target[k] - eye[k]) / distance * along;
            return projected(*camera, p);
        };
        // The table's offsets are rounded at magnitude 10, and a depth near 0 is a difference of
        // such numbers.
        EXPECT_NEAR(at(0.5f)[2], 0, 2e-5) << "seed 11, camera " << i;
        EXPECT_NEAR(at(20)[2], 1, 2e-6) << "seed 11, camera " << i;
        EXPECT_LT(at(2)[2], at(3)[2]) << "seed 11, camera " << i;
        EXPECT_NEAR(at(3)[0], 0, 2e-5) << "seed 11, camera " << i;
        EXPECT_NEAR(at(3)[1], 0, 2e-5) << "seed 11, camera " << i;
    }
}

TEST(Camera, LooksStraightDownWithUpAlongTheView) {
    const auto camera = look_at({0, 0, 2}, {0, 0, 0}, {0, 0, 1}, {});
    ASSERT_TRUE(camera.ok());
    EXPECT_GT(projected(*camera, {0.5f, 0, 0})[0], 0.1f);
    EXPECT_LT(projected(*camera, {0, 0.5f, 0})[1], -0.1f) << "+y takes the place of the missing up";
}

TEST(Camera, RefusesWhatIsNoView) {
    const auto nowhere = look_at({1, 2, 3}, {1, 2, 3}, {0, 0, 1}, {});
    ASSERT_FALSE(nowhere.ok());
    EXPECT_EQ(to_string(nowhere.error()),
              "error: a camera at (1, 2, 3) cannot look at (1, 2, 3) [bad-camera]");
    EXPECT_EQ(look_at({1, 0, 0}, {}, {0, 0, 1}, {.vertical_degrees = 180}).error().code,
              "bad-camera");
    EXPECT_EQ(look_at({1, 0, 0}, {}, {0, 0, 1}, {.near_plane = 1, .far_plane = 1}).error().code,
              "bad-camera");
    EXPECT_EQ(look_at({std::nanf(""), 0, 0}, {}, {0, 0, 1}, {}).error().code, "bad-camera");
}

}  // namespace
}  // namespace intaglio::vulkan
