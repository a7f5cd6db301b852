// Shading models: what they equal, what they ignore, and that what they ignore costs nothing.
#include <gmock/gmock.h>

#include "tests/unit/shading/pixel.h"

#include "generator/passes/pipeline.h"
#include "src/maps/bake_phong.h"

namespace intaglio::templates::testing {
namespace {

std::vector<Draw> some_draws(const HeightField& field, int count) {
    Random random(reference::witness::seed());
    std::vector<Draw> draws;
    for (int i = 0; i < count; ++i) {
        Draw draw{field, {random.real(0, 1), random.real(0, 1)}};
        draw.to_eye = direction(random.real(5, 90), random.real(0, 360));
        draw.to_light = direction(random.real(-20, 90), random.real(0, 360));
        draws.push_back(draw);
    }
    return draws;
}

TEST(Lambert, IsPhongWithoutGloss) {
    const HeightField bricks = made_field("bricks", 32, 32);
    for (const char* rest : {"search=none", "parallax_occlusion,shadow=march"}) {
        const std::string surface = rest;
        const Pixel lambert(surface + ",shading=lambert,normal=blinn", bricks);
        const Pixel phong(surface + ",shading=phong,normal=blinn", bricks);
        int glossy = 0;
        for (Draw& draw : some_draws(bricks, 200)) {
            draw.gloss = 0;
            EXPECT_EQ(lambert(draw), phong(draw));
            draw.gloss = 1;
            glossy += lambert(draw) != phong(draw);
        }
        EXPECT_GT(glossy, 20);
    }
}

TEST(Emboss, UnderALightStraightUpIsFlat) {
    const HeightField spikes = made_field("spikes", 16, 16), flat = made_field("flat1", 16, 16);
    const Pixel rough("search=none,shading=emboss", spikes),
        even("search=none,shading=emboss", flat);
    for (double u : {0.0, 0.2, 0.7})
        EXPECT_EQ(rough(Draw{spikes, {u, 0.3}}), even(Draw{flat, {u, 0.3}})) << u;
}

TEST(Emboss, OnAPlaneIsTheUnnormalisedNormalTimesLight) {
    const double a = 0.3, b = -0.25;
    const HeightField plane =
        field_of(64, 64, [&](double u, double v) { return 0.5 + a * (u - 0.5) + b * (v - 0.5); });
    for (const char* texels : {"0.5", "1", "4"}) {
        const Pixel emboss("search=none,shading=emboss", plane, {{"emboss_distance", texels}});
        for (double azimuth : {0.0, 45.0, 110.0, 270.0})
            for (double elevation : {80.0, 45.0, 10.0}) {
                Draw draw{plane};
                draw.scale = 0.3;
                draw.to_light = direction(elevation, azimuth);
                const Vec3 l = draw.to_light;
                const double expected =
                    std::clamp(l.z - draw.scale * (a * l.x + b * l.y), 0.0, 1.0);
                // albedo.x (ambient.x + light.x diffuse), all as Draw gives them
                EXPECT_NEAR(emboss(draw)[0], 0.5 * (0.25 + expected), 2e-5);
            }
    }
}

TEST(Emboss, IsLambertTimesTheLengthOfTheNormalOnGentleSlopes) {
    // At a scale of 0.004 slopes are below 0.1: 1 / |N'| differs from 1 by less than 0.5 %.
    const HeightField smooth = made_field("smooth", 64, 64);
    const Pixel emboss("search=none,shading=emboss", smooth);
    const Pixel lambert("search=none,shading=lambert,normal=blinn", smooth);
    for (Draw& draw : some_draws(smooth, 200)) {
        if (draw.to_light.z < 0.05) continue;
        draw.scale = 0.004;
        // The difference is taken over a texel towards the light, the normal's about the point.
        EXPECT_NEAR(emboss(draw)[0], lambert(draw)[0], 0.01);
    }
}

TEST(Emboss, ALightAtOrBelowTheHorizonGivesAmbientAlone) {
    const HeightField spikes = made_field("spikes", 16, 16);
    const Pixel emboss("search=none,shading=emboss", spikes),
        ambient("search=none,shading=ambient_only", spikes);
    for (const Vec3 light : {Vec3{1, 0, 0}, Vec3{0.8, 0, -0.6}, Vec3{0, 0, -1}, Vec3{0, 0, 0}}) {
        Draw draw{spikes, {0.3, 0.3}};
        draw.to_light = light;
        EXPECT_EQ(emboss(draw), ambient(draw));
    }
}

TEST(AmbientOnly, HeedsNoLight) {
    const HeightField bricks = made_field("bricks", 32, 32);
    const Pixel ambient("parallax_occlusion,shadow=march,shading=ambient_only", bricks);
    Draw draw{bricks, {0.3, 0.4}, {0.5, 0.2, 0.8}};
    const auto before = ambient(draw);
    EXPECT_NEAR(before[0], 0.5 * 0.25, 1e-6);
    draw.to_light = {0.9, 0.1, 0.2};
    EXPECT_EQ(ambient(draw), before);
}

std::vector<std::string> what_is_read(const std::string& surface) {
    Result<ir::Program> program =
        dsl::record_surface(surface_named(surface), {"glsl_450", {}, false});
    EXPECT_TRUE(program.ok());
    EXPECT_TRUE(passes::optimize_program(*program, {}).ok());
    std::vector<std::string> names;
    for (const ir::Sampler& sampler : program->pixel.samplers) names.push_back(sampler.name);
    for (const ir::Declaration& input : program->pixel.inputs) names.push_back(input.name);
    return names;
}

TEST(Shading, WhatReadsNoNormalCausesNoNormalRead) {
    using ::testing::Contains;
    using ::testing::Not;
    using ::testing::UnorderedElementsAre;
    const std::string base = "search=parallax_occlusion,shadow=march,normal=map,shading=";
    for (const char* shading : {"phong", "lambert"})
        EXPECT_THAT(what_is_read(base + shading), Contains("normal_map")) << shading;
    for (const char* shading : {"emboss", "ambient_only"})
        EXPECT_THAT(what_is_read(base + shading), Not(Contains("normal_map"))) << shading;
    EXPECT_THAT(what_is_read(base + "ambient_only"),
                UnorderedElementsAre("height_map", "colour_map", "uv", "to_eye"))
        << "nor light, nor shadow";
    EXPECT_THAT(what_is_read("search=none,shading=ambient_only"),
                UnorderedElementsAre("colour_map", "uv"));
}

Vec3 unit(Vec3 v) {
    const double length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    return {v.x / length, v.y / length, v.z / length};
}

// "C = byte pointed to by P + B": P the polygon's place in the phong map, B one word of the bump
// map, the high byte along y and the low byte along x.
double pointed_to(const maps::Image& phong, long P, long B) {
    return phong.at(static_cast<int>((P + B) % 256), static_cast<int>((P + B) / 256), 0);
}

struct BumpPixel {
    Draw draw;
    Vec3 normal, halfway;
    long P, B;
};

// A plane that rises by `slopes`, its words by differences, and the polygon's pointer.
BumpPixel bump_pixel(const HeightField& plane, Vec2 slopes, Vec3 light) {
    BumpPixel pixel{Draw{plane}, unit({-slopes.x, -slopes.y, 1}), light, 0, 0};
    pixel.draw.to_eye = pixel.draw.to_light = light;  // the source's light and eye are one
    pixel.draw.scale = 1;
    pixel.draw.gloss = 0;
    const double texels = 256 / (2 * maps::phong_edge);
    const auto place = [&](double lean) { return std::lround(lean * texels + 127.5); };
    pixel.P = place(-light.y) * 256 + place(-light.x);
    pixel.B = std::lround(pixel.normal.y * texels) * 256 + std::lround(pixel.normal.x * texels);
    return pixel;
}

TEST(FastBumpMapping, TheByteAtTheSumIsOurBrightness) {
    const maps::Image phong = *maps::bake_phong();
    ir::Texture map;
    map.width = map.height = 256;
    std::vector<float>& texels = map.levels.emplace_back();
    for (int i = 0; i < 256 * 256; ++i)
        texels.insert(texels.end(), {phong.at(i % 256, i / 256, 0), 0, 0, 0});
    Random random(reference::witness::seed());
    const auto brightness = [&](const HeightField& plane, const BumpPixel& pixel) {
        Draw draw = pixel.draw;
        draw.normal_map = &map;  // the one map beside heights and colour
        // albedo (ambient + brightness)
        return Pixel("search=none,normal=blinn,shading=phong_map", plane)(draw)[0] / 0.5 - 0.25;
    };
    double sum = 0, darkest = 1;
    for (int i = 0; i < 200; ++i) {
        const Vec2 slopes = {random.real(-0.4, 0.4), random.real(-0.4, 0.4)};
        const HeightField plane = field_of(16, 16, [&](double u, double v) {
            return 0.5 + slopes.x * (u - 0.5) + slopes.y * (v - 0.5);
        });
        const Vec3 light = direction(random.real(40, 90), random.real(0, 360));
        const BumpPixel pixel = bump_pixel(plane, slopes, light);
        const double ours = brightness(plane, pixel);
        // Two roundings to whole texels, and ours is filtered: up to one and a half of them off.
        double least = 1, most = 0;
        for (long dy = -2; dy <= 2; ++dy)
            for (long dx = -2; dx <= 2; ++dx) {
                const double C = pointed_to(phong, pixel.P, pixel.B + 256 * dy + dx);
                least = std::min(least, C);
                most = std::max(most, C);
            }
        EXPECT_GE(ours, least - 1e-5);
        EXPECT_LE(ours, most + 1e-5);
        sum += std::abs(ours - pointed_to(phong, pixel.P, pixel.B));
        darkest = std::min(darkest, ours);
    }
    EXPECT_LT(sum / 200, 0.005);
    EXPECT_LT(darkest, 0.5);

    // Bumps that lean over the map's edge: the pointer comes out on the other side, in the next
    // row, ours stays on the dark border.
    const Vec2 away = {-0.9, 0};
    const HeightField plane =
        field_of(16, 16, [&](double u, double) { return 0.5 + away.x * (u - 0.5); });
    const BumpPixel over = bump_pixel(plane, away, direction(6, 180));
    ASSERT_LT(over.normal.x * over.halfway.x + over.normal.z * over.halfway.z, 0);
    EXPECT_GT(pointed_to(phong, over.P, over.B), 0.5);
    EXPECT_EQ(brightness(plane, over), 0);
}

TEST(Shading, IsFiniteWhateverItIsGiven) {
    const HeightField spikes = made_field("spikes", 8, 8);
    for (const auto& shading : all_techniques().shadings)
        for (const auto& normal : all_techniques().normals) {
            const Pixel pixel("search=none,shading=" + shading.name + ",normal=" + normal.name,
                              spikes);
            for (const Vec3 light : {Vec3{0, 0, 0}, Vec3{1e-20, 0, 0}, Vec3{0, 0, -1},
                                     Vec3{1, 0, 0}, Vec3{1e6, 0, 1e6}})
                for (const Vec3 eye : {Vec3{0, 0, 1}, Vec3{0, 0, 0}, Vec3{1, 0, -0.1}})
                    for (double u : {0.0, 0.3, 1e5}) {
                        Draw draw{spikes, {u, u}, eye, light};
                        for (double component : pixel(draw))
                            EXPECT_TRUE(std::isfinite(component))
                                << shading.name << " " << normal.name;
                    }
        }
}

}  // namespace
}  // namespace intaglio::templates::testing
