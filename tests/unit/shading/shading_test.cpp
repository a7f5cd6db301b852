// Shading models: what they equal, what they ignore, and that what they ignore costs nothing.
#include <gmock/gmock.h>

#include "tests/unit/shading/pixel.h"

#include "generator/passes/pipeline.h"

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
