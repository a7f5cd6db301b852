// Several lights: light adds up, shadows are each light's own, and no light leaves the ambient
// part.
#include "tests/unit/shading/pixel.h"

#include <algorithm>

namespace intaglio::templates::testing {
namespace {

const Vector blue{0.25, 0.5, 1.5};

struct Scene {
    Draw first, second, both;  // each light alone, and the two together
};

Scene random_scene(Random& random, const HeightField& field) {
    Scene scene{Draw{field}, Draw{field}, Draw{field}};
    const Vec2 uv{random.real(0, 1), random.real(0, 1)};
    const Vec3 eye = direction(random.real(10, 90), random.real(0, 360));
    const Vec3 lights[] = {direction(random.real(-10, 90), random.real(0, 360)),
                           direction(random.real(-10, 90), random.real(0, 360))};
    for (Draw* draw : {&scene.first, &scene.second, &scene.both})
        draw->uv = uv, draw->to_eye = eye, draw->scale = 0.25;
    scene.first.to_light = scene.both.to_light = lights[0];
    scene.second.to_light = lights[1];
    scene.second.light_colour = blue;
    scene.both.further = {{lights[1], blue}};
    return scene;
}

Knobs lit_by(int lights, Knobs knobs = {}) {
    knobs.emplace_back("lights", std::to_string(lights));
    return knobs;
}

// `both` is first + second - none up to rounding.  What one light gives is computed the same way
// alone and in company; around it stand, per component, at most five sums and products in each of
// the four pictures, of numbers no greater than what the two lights give together.
void expect_sum(const Pixel& both, const Pixel& first, const Pixel& second, const Pixel& none,
                const Scene& scene) {
    const auto sum = both(scene.both), one = first(scene.first), other = second(scene.second),
               ambient = none(scene.both);
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(sum[c], one[c] + other[c] - ambient[c], (one[c] + other[c]) * 20 * 0x1p-24)
            << "component " << c << " at uv " << scene.both.uv.x << " " << scene.both.uv.y
            << ", seed " << reference::witness::seed();
}

TEST(Lights, AddUpInEveryShadingUnderEveryShadow) {
    const HeightField bricks = made_field("bricks", 32, 32);
    const dsl::Catalogue catalogue = all_techniques();
    std::vector<std::string> surfaces;
    for (const auto& row : catalogue.shadings)
        surfaces.push_back("parallax,shadow=soft,shading=" + row.name);
    for (const auto& row : catalogue.shadows) surfaces.push_back("parallax,shadow=" + row.name);
    for (const std::string& surface : surfaces) {
        SCOPED_TRACE(surface);
        Random random(reference::witness::seed());
        const Pixel both(surface, bricks, lit_by(2)), one(surface, bricks),
            none(surface, bricks, lit_by(0));
        for (int i = 0; i < 60; ++i) expect_sum(both, one, one, none, random_scene(random, bricks));
    }
}

TEST(Lights, FourAreFourTimesOneWhereTheyAreTheSame) {
    const HeightField flat = made_field("flat1", 8, 8);
    const Pixel four("search=none,shading=lambert", flat, lit_by(4)),
        one("search=none,shading=lambert", flat), none("search=none", flat, lit_by(0));
    Draw draw{flat};
    draw.to_light = direction(40, 10);
    draw.further.assign(3, {draw.to_light, white});
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(four(draw)[c], 4 * one(draw)[c] - 3 * none(draw)[c], 20 * 0x1p-24);
}

TEST(Lights, ThoseThatCannotShadowAreNotShadowed) {
    const HeightField spikes = made_field("spikes", 32, 32);
    const std::string surface = "parallax_occlusion,shadow=march";
    const Pixel all(surface, spikes, lit_by(2)),
        first_alone(surface, spikes, lit_by(2, {{"shadowed_lights", "1"}})),
        shadowed(surface, spikes), bare("parallax_occlusion", spikes),
        none(surface, spikes, lit_by(0));
    Random random(reference::witness::seed());
    int differ = 0;
    for (int i = 0; i < 200; ++i) {
        const Scene scene = random_scene(random, spikes);
        expect_sum(first_alone, shadowed, bare, none, scene);
        differ += all(scene.both) != first_alone(scene.both);
    }
    EXPECT_GT(differ, 20) << "the second light throws shadows when asked";
}

TEST(Lights, NoneLeaveWhatAmbientOnlyDraws) {
    const HeightField bricks = made_field("bricks", 32, 32);
    const Pixel ambient("parallax,shading=ambient_only", bricks);
    for (const auto& row : all_techniques().shadings) {
        Random random(reference::witness::seed());
        const Pixel none("parallax,shadow=march,shading=" + row.name, bricks, lit_by(0));
        for (int i = 0; i < 20; ++i) {
            const Draw draw = random_scene(random, bricks).both;
            EXPECT_EQ(none(draw), ambient(draw)) << row.name;
        }
    }
}

}  // namespace
}  // namespace intaglio::templates::testing
