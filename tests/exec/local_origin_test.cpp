// Rays that start in the first tile of a repeated map: what a pixel finds there does not depend on
// how far from the origin its coordinate lies, to the bit, in any format that holds the coordinate;
// and near the origin nothing changes.
#include <cmath>

#include "src/measure/lone_pixel.h"
#include "tests/exec/bench.h"

namespace intaglio::exec {
namespace {

using Vector = measure::LonePixel::Vector;

// What 1000 and more leaves of a coordinate, in 24 bits too.
constexpr double step = 1.0 / 128;

// A surface under an eye 18 degrees above the polygon, its pixels a step apart.
class Pixel {
  public:
    Pixel(const std::string& surface, const char* local_origin)
        : pixel_(must(measure::LonePixel::prepare(
              templates::all_techniques(),
              request(surface, "glsl_450", {{"local_origin", local_origin}}), textures(),
              test_scale))) {}

    Vector at(double u, double v, ir::Precision precision) const {
        return pixel_.at({u, v}, {0.75, 0.5625, 0.3125}, {-0.25, 0.5, 0.5}, step, precision);
    }

  private:
    static const measure::Textures& textures();
    measure::LonePixel pixel_;
};

const measure::Textures& Pixel::textures() {
    static const measure::Textures made(map_named("smooth", 64, 64), measure::Filtering::Float);
    return made;
}

struct Far {
    double tile;
    ir::Precision precision;
};
constexpr Far far_places[] = {{1000, ir::Precision::Single},
                              {100000, ir::Precision::Single},
                              {500, ir::Precision::Narrow24},
                              {-4, ir::Precision::Narrow16}};

// The greatest change of one component when the place moves `far` tiles away.
double change(const Pixel& pixel, const Far& far, std::size_t component) {
    double most = 0;
    for (int i = 1; i < 8; ++i) {
        const double u = 15 * i * step, v = 1 - 13 * i * step;
        const Vector near = pixel.at(u, v, far.precision),
                     moved = pixel.at(u + far.tile, v - far.tile, far.precision);
        most = std::max(most, std::abs(near[component] - moved[component]));
    }
    return most;
}

class LocalOrigin : public testing::TestWithParam<std::string> {};

TEST_P(LocalOrigin, MakesHitAndShadowTheSameInEveryTile) {
    const Pixel pixel("search=" + GetParam() + ",shadow=march,output=displaced", "1");
    for (const Far& far : far_places)
        for (std::size_t component : {2, 3})  // height and visibility
            EXPECT_EQ(change(pixel, far, component), 0) << far.tile;
}

TEST_P(LocalOrigin, MakesColoursTheSameInEveryTile) {
    const Pixel pixel("search=" + GetParam() + ",shadow=march,shading=phong", "2");
    for (const Far& far : far_places)
        for (std::size_t component : {0, 1, 2})
            EXPECT_EQ(change(pixel, far, component), 0) << far.tile;
}

TEST_P(LocalOrigin, ChangesNothingInTheFirstTile) {
    const std::string surface = "search=" + GetParam() + ",shadow=march,shading=phong";
    const Pixel plain(surface, "0");
    for (const char* form : {"1", "2"}) {
        const Pixel local(surface, form);
        for (const ir::Precision precision : {ir::Precision::Single, ir::Precision::Narrow16})
            for (int i = 0; i < 8; ++i) {
                const double u = 0.123 * i, v = 0.977 - 0.1 * i;
                EXPECT_EQ(plain.at(u, v, precision), local.at(u, v, precision)) << u;
            }
    }
}

std::vector<std::string> searches() {
    std::vector<std::string> names;
    for (const auto& search : templates::all_techniques().searches) names.push_back(search.name);
    return names;
}

INSTANTIATE_TEST_SUITE_P(Searches, LocalOrigin, testing::ValuesIn(searches()),
                         [](const auto& one) { return one.param; });

// What it is for.  A place along the ray is off by half a unit in the last place of the coordinate,
// 2^-15 at 1000 and 2^-8 at 100000; over a slope of about 1 that is as much height.
TEST(WithoutLocalOrigin, HeightsAreOffByTheCoordinatesRounding) {
    for (const char* search :
         {"parallax_occlusion", "steep_parallax", "relief_secant", "cone", "parallax_iterative"}) {
        const Pixel pixel(std::string("search=") + search + ",output=displaced", "0");
        EXPECT_GT(change(pixel, far_places[0], 2), 0x1p-19) << search;
        EXPECT_GT(change(pixel, far_places[1], 2), 0x1p-12) << search;
    }
}

// The coordinate that leaves the shader is the ray's own, however far the hit lies.
TEST(LocalOrigin, HandsOnAContinuousCoordinate) {
    const Pixel plain("search=relief,output=displaced", "0");
    const Pixel local("search=relief,output=displaced", "1");
    for (const double tile : {-3.0, 0.0, 7.0, 64.0}) {
        const Vector a = plain.at(tile + 0.01, tile + 0.99, ir::Precision::Double),
                     b = local.at(tile + 0.01, tile + 0.99, ir::Precision::Double);
        for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-12) << tile;
    }
}

TEST(LocalOrigin, DrawsTheSamePixelsOverTheFirstTile) {
    const measure::MapSet map = map_named("text");
    for (const char* target : {"glsl_450", "hlsl_2_b", "ps_3_0"}) {
        const auto picture = [&](const char* form) {
            return draw(request("parallax_occlusion", target, {{"local_origin", form}}), map,
                        {25, 40}, {40, 200}, 64)[0];
        };
        const vulkan::Picture plain = picture("0");
        EXPECT_TRUE(same_bits(plain, picture("1"))) << target;
        EXPECT_TRUE(same_bits(plain, picture("2"))) << target;
    }
}

}  // namespace
}  // namespace intaglio::exec
