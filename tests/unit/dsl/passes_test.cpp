// A surface in passes computes what it computes whole: the evaluator runs every pass after the
// other, each reading the texel that the one before wrote.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <fmt/format.h>

#include "generator/dsl/passes.h"
#include "generator/ir/evaluate.h"
#include "generator/ir/parse.h"
#include "generator/ir/print.h"
#include "generator/ir/verify.h"
#include "templates/all_techniques.h"
#include "tests/rounds.h"

namespace intaglio::dsl {
namespace {

using testing::HasSubstr;
using Knobs = std::vector<std::pair<std::string, std::string>>;
using Vector = ir::Environment::Vector;

constexpr unsigned seed = 20261;

Surface surface_named(const std::string& text, const Knobs& knobs = {}) {
    Result<Surface> surface = make_surface(templates::all_techniques(), text);
    EXPECT_TRUE(surface.ok()) << to_string(surface.error());
    for (const auto& [name, value] : knobs) EXPECT_TRUE(surface->set_knob(name, value).ok());
    return std::move(*surface);
}

std::vector<ir::Program> passes_of(const Surface& surface, const std::string& split) {
    Result<std::vector<ir::Program>> passes =
        record_passes(surface, {"glsl_450", {}, false}, *parse_split(split));
    EXPECT_TRUE(passes.ok()) << surface.name << " " << split << ": " << to_string(passes.error());
    return passes ? std::move(*passes) : std::vector<ir::Program>{};
}

ir::Texture noise(int size, unsigned which, int smooth) {
    std::mt19937 random(seed + which);
    ir::Texture texture;
    texture.width = texture.height = size;
    std::vector<float> texels(static_cast<std::size_t>(4 * size * size));
    std::uniform_real_distribution<float> any(0, 1);
    for (float& texel : texels) texel = any(random);
    // Averages with the texel to the right: hills in place of spikes.
    for (int pass = 0; pass < smooth; ++pass)
        for (std::size_t i = 0; i + 4 < texels.size(); ++i)
            texels[i] = (texels[i] + texels[i + 4]) / 2;
    texture.levels = {texels};
    return texture;
}

// One pixel of a draw.
struct Pixel {
    Vector uv{}, to_eye{}, to_light{};
    double scale = 0.125;
    // Scale and bias into the picture between passes, and back; the picture holds binary32.
    Vector encode{1, 0}, decode{1, 0};
};

struct Maps {
    ir::Texture height = noise(16, 1, 3), normal = noise(16, 2, 1), colour = noise(16, 3, 0);
};

std::array<double, 4> run(const ir::Module& module, const Pixel& pixel, const Maps& maps,
                          const std::array<double, 4>& before) {
    ir::Texture displaced;
    displaced.levels = {{}};
    for (double component : before) displaced.levels[0].push_back(static_cast<float>(component));
    ir::Environment environment;
    for (const ir::Declaration& input : module.inputs)
        environment.inputs.push_back(input.name == "uv"         ? pixel.uv
                                     : input.name == "to_eye"   ? pixel.to_eye
                                     : input.name == "to_light" ? pixel.to_light
                                                                : Vector{0.5, 0.5, 1});
    const std::map<std::string, Vector> uniforms = {
        {"scale", {pixel.scale}},           {"map_size", {16, 16}},
        {"offset_to_colour", pixel.encode}, {"colour_to_offset", pixel.decode},
        {"ambient", {0.25, 0.25, 0.25}},    {"light_colour", {1, 1, 1}},
        {"light_colour_1", {0.5, 0.25, 2}}, {"gloss", {0.5}}};
    for (const ir::Uniform& uniform : module.uniforms)
        environment.uniforms.push_back({uniforms.at(uniform.name)});
    for (const ir::Sampler& sampler : module.samplers)
        environment.samplers.push_back(sampler.name == "height_map"   ? &maps.height
                                       : sampler.name == "normal_map" ? &maps.normal
                                       : sampler.name == "colour_map" ? &maps.colour
                                                                      : &displaced);
    return ir::Evaluator(module).run(environment, ir::Precision::Single).outputs[0];
}

std::array<double, 4> run(const std::vector<ir::Program>& passes, const Pixel& pixel,
                          const Maps& maps) {
    std::array<double, 4> result{};
    for (const ir::Program& pass : passes) result = run(pass.pixel, pixel, maps, result);
    return result;
}

Pixel random_pixel(std::mt19937& random) {
    const auto number = [&](double low, double high) {
        return static_cast<double>(
            static_cast<float>(std::uniform_real_distribution<double>(low, high)(random)));
    };
    Pixel pixel;
    // Above the longest offset: then uv + (hit - uv) is the hit to the bit.
    pixel.uv = {number(1, 3), number(1, 3)};
    pixel.to_eye = {number(-1, 1), number(-1, 1), number(0.3, 1)};
    pixel.to_light = {number(-1, 1), number(-1, 1), number(0.2, 1)};
    return pixel;
}

const std::vector<std::string>& splits() {
    static const std::vector<std::string> all = {"shading",
                                                 "shadow",
                                                 "shadow,shading",
                                                 "sections=2",
                                                 "sections=3,shading",
                                                 "sections=2,shadow,shading"};
    return all;
}

TEST(Split, IsReadAndWritten) {
    for (const std::string& text : splits()) EXPECT_EQ(to_string(*parse_split(text)), text);
    EXPECT_EQ(pass_count(*parse_split("shading,sections=3")), 4);
    EXPECT_EQ(pass_count(*parse_split("sections=1")), 1);
    for (const char* text : {"", "shade", "sections", "sections=", "sections=0", "sections=65",
                             "sections=2x", "sections=99999999999", "shading,", ",shading"})
        EXPECT_EQ(parse_split(text).error().code, "split-syntax") << text;
    EXPECT_THAT(parse_split("shadin").error().message, HasSubstr("did you mean 'shading'"));
    EXPECT_EQ(pass_work(*parse_split("sections=2,shading"), 2),
              "section 2 of 2 of the search, shadow");
    EXPECT_EQ(pass_work(*parse_split("shading"), 2), "shading and output");
}

TEST(Split, EveryPassOfEverySurfaceIsAProgram) {
    const Catalogue catalogue = templates::all_techniques();
    int at = 0;
    for (const auto& search : catalogue.searches)
        for (const auto& shadow : catalogue.shadows)
            for (const std::string& split : splits()) {
                if (at++ % stride != 0) continue;
                const Surface surface =
                    surface_named("search=" + search.name + ",shadow=" + shadow.name);
                const Split cuts = *parse_split(split);
                const auto passes = record_passes(surface, {"glsl_450", {}, false}, cuts);
                if (!passes) {
                    EXPECT_EQ(passes.error().code, "split-search") << to_string(passes.error());
                    EXPECT_GT(cuts.sections, 1);
                    continue;
                }
                EXPECT_EQ(passes->size(), static_cast<std::size_t>(pass_count(cuts)));
                for (const ir::Program& pass : *passes)
                    for (const ir::Module* module : {&pass.vertex, &pass.pixel}) {
                        const Status verified = ir::verify(*module);
                        EXPECT_TRUE(verified.ok())
                            << pass.name << ": " << to_string(verified.error());
                        const Result<ir::Module> parsed = ir::parse(ir::print(*module), pass.name);
                        ASSERT_TRUE(parsed.ok()) << to_string(parsed.error());
                        EXPECT_TRUE(*parsed == *module) << pass.name;
                    }
            }
}

// The picture between the passes holds binary32 here, so cuts change nothing at all.
TEST(Split, CutsBeforeShadowAndShadingKeepEveryBit) {
    const Maps maps;
    const Knobs small = {{"max_steps", "12"}, {"min_steps", "6"}};
    for (const std::string text :
         {"parallax_occlusion", "steep_parallax", "fur", "parallax_occlusion,shadow=march",
          "steep_parallax,shadow=march,output=displaced", "bump"}) {
        const Surface surface =
            surface_named(text, std::string(text).find("steep") == 0 ? small : Knobs{});
        const ir::Program whole = *record_surface(surface, {"glsl_450", {}, false});
        for (const std::string split : {"shading", "shadow", "shadow,shading"}) {
            const std::vector<ir::Program> passes = passes_of(surface, split);
            std::mt19937 random(seed);
            for (int i = 0; i < rounds(200); ++i) {
                const Pixel pixel = random_pixel(random);
                EXPECT_EQ(run({whole}, pixel, maps), run(passes, pixel, maps))
                    << text << " " << split << ", pixel " << i << " of seed " << seed;
            }
        }
    }
}

TEST(Split, SeveralLightsKeepEveryBitOrAreRefused) {
    const Maps maps;
    struct Case {
        std::string surface;
        Knobs knobs;
        std::vector<std::string> splits, refused;
    };
    const Knobs two = {{"lights", "2"}}, one_shadow = {{"lights", "2"}, {"shadowed_lights", "1"}};
    const std::vector<std::string> before_shading = {"shading", "shadow,shading"};
    for (const Case& a_case :
         {Case{"parallax_occlusion,shadow=march", two, {"shadow"}, before_shading},
          Case{"parallax_occlusion,shadow=march", one_shadow, {"shadow", "shading"}, {}},
          Case{"parallax_occlusion,shadow=fur_depth", two, {"shadow", "shading"}, {}},
          Case{"parallax_occlusion", two, before_shading, {}},
          Case{"parallax_occlusion,shadow=march", {{"lights", "0"}}, before_shading, {}}}) {
        const Surface surface = surface_named(a_case.surface, a_case.knobs);
        const ir::Program whole = *record_surface(surface, {"glsl_450", {}, false});
        for (const std::string& split : a_case.splits) {
            const std::vector<ir::Program> passes = passes_of(surface, split);
            std::mt19937 random(seed);
            for (int i = 0; i < rounds(50); ++i) {
                const Pixel pixel = random_pixel(random);
                EXPECT_EQ(run({whole}, pixel, maps), run(passes, pixel, maps))
                    << surface.name << " " << split << ", pixel " << i << " of seed " << seed;
            }
        }
        for (const std::string& split : a_case.refused) {
            const auto passes =
                record_passes(surface, {"glsl_450", {}, false}, *parse_split(split));
            ASSERT_FALSE(passes.ok()) << split;
            EXPECT_EQ(passes.error().code, "split-lights");
            EXPECT_THAT(passes.error().message, HasSubstr("split=shadow"));
        }
    }
}

// Where the offset is longer than the coordinate, hit - uv is rounded: by half a unit in the last
// place of a number below the offset's next power of two.
TEST(Split, ACoordinateNearZeroMovesByOneRounding) {
    const Maps maps;
    const Surface surface = surface_named("parallax_occlusion,output=displaced");
    const ir::Program whole = *record_surface(surface, {"glsl_450", {}, false});
    const std::vector<ir::Program> passes = passes_of(surface, "shading");
    std::mt19937 random(seed);
    for (int i = 0; i < rounds(500); ++i) {
        Pixel pixel = random_pixel(random);
        pixel.uv = {pixel.uv[0] / 64, pixel.uv[1] / 1024};
        const auto expected = run({whole}, pixel, maps), actual = run(passes, pixel, maps);
        for (std::size_t k : {0u, 1u}) {
            // Two roundings, each of half a unit of a number below 0.5, the longest offset here.
            EXPECT_NEAR(actual[k], expected[k], 0x1p-25);
        }
        EXPECT_EQ(actual[2], expected[2]);
    }
}

// n sections of m taps against one march of n m taps.  Coordinates of the taps differ by roundings,
// so heights do by 1e-6, and the intersection with a segment by as much over its slope: a pixel in
// fifty may differ by more than a hundredth of a step, none by more than the step it lies in.
TEST(Split, SectionsOfAMarchAreTheLongerMarch) {
    const Maps maps;
    struct Case {
        std::string surface;
        std::string knob;
    };
    for (const Case& a_case : {Case{"parallax_occlusion", "taps"}, Case{"steep_parallax", "steps"}})
        for (const int sections : {2, 3, 4}) {
            constexpr int taps = 8;
            const auto knobs = [&](int count) {
                const std::string value = std::to_string(count);
                return a_case.knob == "taps" ? Knobs{{"taps", value}}
                                             : Knobs{{"max_steps", value}, {"min_steps", value}};
            };
            const std::string text = a_case.surface + ",output=displaced";
            const Surface one = surface_named(text, knobs(taps * sections));
            const ir::Program whole = *record_surface(one, {"glsl_450", {}, false});
            const std::vector<ir::Program> passes =
                passes_of(surface_named(text, knobs(taps)), fmt::format("sections={}", sections));
            std::mt19937 random(seed);
            int far = 0;
            constexpr int pixels = rounds(1000);
            for (int i = 0; i < pixels; ++i) {
                const Pixel pixel = random_pixel(random);
                const auto expected = run({whole}, pixel, maps), actual = run(passes, pixel, maps);
                const double reach =
                    std::hypot(pixel.to_eye[0], pixel.to_eye[1]) / pixel.to_eye[2] * pixel.scale;
                const double moved =
                    std::hypot(actual[0] - expected[0], actual[1] - expected[1]) / reach;
                const double step = 1.0 / (taps * sections);
                far += moved > step / 100;
                if (a_case.knob == "taps") {
                    EXPECT_LE(moved, step * 1.001) << i;
                }
            }
            EXPECT_LE(far, pixels / 50) << text << " in " << sections << " of seed " << seed;
        }
}

// pixel_place as docs/split.md has it for each interface: clip space of a pixel's centre comes to
// the centre of its texel.
TEST(Split, ThePlaceIsThePixelsOwnTexelInEveryInterface) {
    constexpr double width = 40, height = 24;
    struct Interface {
        const char* name;
        double centre;  // of pixel 0, in pixels
        double up;      // 1 if clip space's y grows upwards and rows downwards
        Vector place;
    };
    const Interface interfaces[] = {
        {"Vulkan", 0.5, -1, {0.5, 0.5, 0.5, 0.5}},
        {"Direct3D 10", 0.5, 1, {0.5, -0.5, 0.5, 0.5}},
        {"Direct3D 9", 0, 1, {0.5, -0.5, 0.5 + 0.5 / width, 0.5 + 0.5 / height}},
    };
    const ir::Program pass = passes_of(surface_named("parallax_occlusion"), "shading")[1];
    const ir::Module& vertex = pass.vertex;
    const auto output = [&](std::string_view name) {
        for (std::size_t i = 0; i < vertex.outputs.size(); ++i)
            if (vertex.outputs[i].name == name) return i;
        ADD_FAILURE() << name;
        return std::size_t{0};
    };
    for (const Interface& interface : interfaces)
        for (const double w : {1.0, 3.5})
            for (const double x : {0.0, 7.0, width - 1})
                for (const double y : {0.0, 11.0, height - 1}) {
                    const double clip_x = (x + interface.centre) / width * 2 - 1;
                    const double clip_y = interface.up * (1 - (y + interface.centre) / height * 2);
                    ir::Environment environment;
                    for (const ir::Declaration& input : vertex.inputs)
                        environment.inputs.push_back(input.name == "normal"    ? Vector{0, 0, 1}
                                                     : input.name == "tangent" ? Vector{1, 0, 0, 1}
                                                                               : Vector{});
                    for (const ir::Uniform& uniform : vertex.uniforms) {
                        std::vector<Vector> rows(static_cast<std::size_t>(uniform.count));
                        if (uniform.name == "view_projection")
                            rows = {{0, 0, 0, clip_x * w}, {0, 0, 0, clip_y * w}, {}, {0, 0, 0, w}};
                        if (uniform.name == "pixel_place") rows = {interface.place};
                        environment.uniforms.push_back(rows);
                    }
                    const auto out =
                        ir::Evaluator(vertex).run(environment, ir::Precision::Single).outputs;
                    const auto& place = out[output("place")];
                    EXPECT_NEAR(place[0] / place[2], (x + 0.5) / width, 1e-6) << interface.name;
                    EXPECT_NEAR(place[1] / place[2], (y + 0.5) / height, 1e-6) << interface.name;
                }
}

TEST(Split, RefusalsSayWhy) {
    const Surface surface = surface_named("parallax_occlusion");
    const Split shading = *parse_split("shading");
    for (const int pass : {-1, 0, 3}) {
        const auto refused = record_pass(surface, {"glsl_450", {}, false}, shading, pass);
        ASSERT_FALSE(refused.ok());
        EXPECT_EQ(refused.error().code, "split-pass");
        EXPECT_THAT(refused.error().message, HasSubstr("1 to 2"));
    }
    // A loop of pass 1 may be named with both passes; one that no pass has may not.
    EXPECT_TRUE(
        record_passes(surface, {"glsl_450", {{"march", ir::LoopForm::Unrolled}}, false}, shading)
            .ok());
    EXPECT_EQ(
        record_passes(surface, {"glsl_450", {{"mrach", ir::LoopForm::Unrolled}}, false}, shading)
            .error()
            .code,
        "unknown-loop");

    struct Table : Search {
        Hit find(const Relief&, const Ray& ray) const override { return {ray.uv, 1.0f}; }
    };
    Surface looked_up = surface_named("parallax_occlusion");
    looked_up.search = std::make_unique<Table>();
    EXPECT_TRUE(record_passes(looked_up, {"glsl_450", {}, false}, shading).ok());
    const auto refused =
        record_passes(looked_up, {"glsl_450", {}, false}, *parse_split("sections=2"));
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().code, "split-search");
}

}  // namespace
}  // namespace intaglio::dsl
