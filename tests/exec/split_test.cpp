// Surfaces in passes draw what they draw whole: to the bit where the picture between the passes
// holds binary32, and within half a step of its format where it holds less.
#include <gmock/gmock.h>

#include <cmath>

#include "src/measure/split.h"
#include "src/vulkan/camera.h"
#include "tests/exec/bench.h"

namespace intaglio::exec {
namespace {

using Format = vulkan::Texture::Format;
using measure::Direction;
using measure::FormatError;

constexpr int size = 64;

VariantRequest split_request(const std::string& surface, const std::string& split,
                             const Knobs& knobs = {}, const std::string& target = "glsl_450") {
    VariantRequest made = request(surface, target, knobs);
    made.split = must(dsl::parse_split(split));
    return made;
}

vulkan::Picture draw_split(const VariantRequest& wanted, const measure::Textures& textures,
                           Direction view, Format format) {
    const Direction light{40, 130};
    return must(
        measure::draw_passes(must(measure::link_passes(templates::all_techniques(), wanted)),
                             measure::offset_code(format, measure::offset_range(view, test_scale)),
                             [&](const check::Program& shaders,
                                 const measure::PassLink& link) -> Result<vulkan::Program> {
                                 Result<vulkan::Program> program = measure::prepare_quad(
                                     device(), shaders, textures, test_scale, size, size, {}, link);
                                 if (program) must(measure::aim(*program, view, light));
                                 return program;
                             }));
}

vulkan::Picture draw_whole(const VariantRequest& wanted, const measure::Textures& textures,
                           Direction view) {
    VariantRequest whole = wanted;
    whole.split = {};
    return draw_split(whole, textures, view, Format::Rgba32Float);
}

const Knobs few = {{"max_steps", "20"}, {"min_steps", "10"}, {"shadow_max_steps", "20"}};

// uv + (hit - uv) is the hit to the bit where the offset is not longer than the coordinate;
// elsewhere it is off by less than one rounding of a number below 1.
TEST(Split, InFloatTheHitsAreTheSameBits) {
    const measure::MapSet set = map_named("cobbles");
    const measure::Textures textures(set, measure::Filtering::Float);
    for (const std::string split : {"shading", "shadow,shading"})
        for (const std::string target : {"glsl_450", "hlsl_5_0", "hlsl_3_0"})
            for (const Direction view : views()) {
                const VariantRequest wanted = split_request(
                    "steep_parallax,shadow=march,output=displaced", split, few, target);
                const vulkan::Picture whole = draw_whole(wanted, textures, view);
                const vulkan::Picture parts =
                    draw_split(wanted, textures, view, Format::Rgba32Float);
                int wrong = 0;
                for (int y = 0; y < size; ++y)
                    for (int x = 0; x < size; ++x) {
                        const auto &a = whole.at(x, y), &b = parts.at(x, y);
                        const float u = (static_cast<float>(x) + 0.5f) / size;
                        const float v = (static_cast<float>(y) + 0.5f) / size;
                        if (std::fabs(a[0] - u) > u || std::fabs(a[1] - v) > v)
                            wrong += !(std::fabs(a[0] - b[0]) <= 0x1p-24f &&
                                       std::fabs(a[1] - b[1]) <= 0x1p-24f && a[2] == b[2]);
                        else
                            wrong += a != b;
                    }
                EXPECT_EQ(wrong, 0) << split << " on " << target << " at " << view.elevation;
            }
}

TEST(Split, InFloatTheColoursAreTheSameBitsAwayFromTheEdge) {
    const measure::MapSet set = map_named("bricks");
    const measure::Textures textures(set, measure::Filtering::Float);
    // At 60 degrees no offset is longer than scale / sqrt(3) = 0.047, 3 pixels.
    for (const std::string surface : {"parallax_occlusion", "fur"}) {
        const VariantRequest wanted = split_request(surface, "shading");
        const Direction view{60, 30};
        const vulkan::Picture whole = draw_whole(wanted, textures, view);
        const vulkan::Picture parts = draw_split(wanted, textures, view, Format::Rgba32Float);
        int wrong = 0;
        for (int y = 3; y < size; ++y)
            for (int x = 3; x < size; ++x) wrong += whole.at(x, y) != parts.at(x, y);
        EXPECT_EQ(wrong, 0) << surface;
    }
}

TEST(Split, AFormatCostsAtMostHalfItsStep) {
    const measure::MapSet set = map_named("cobbles");
    const measure::Textures textures(set, measure::Filtering::Float);
    for (const Direction view : {Direction{90, 0}, Direction{60, 30}, Direction{20, 200}}) {
        const measure::Shot shot{view, {40, 130}, test_scale, size, size};
        const std::vector<FormatError> errors = must(measure::shot_formats(
            device(), templates::all_techniques(), split_request("parallax_occlusion", "shading"),
            set, textures, shot, measure::pass_formats()));
        ASSERT_EQ(errors.size(), 4u);
        for (const FormatError& error : errors) {
            SCOPED_TRACE(std::string(vulkan::name_of(error.code.format)) + " at " +
                         std::to_string(view.elevation));
            EXPECT_EQ(error.beyond, 0) << error.max << " of " << error.bound;
            EXPECT_EQ(error.pixels, size * size);
            EXPECT_EQ(error.hits.invalid, 0);
            EXPECT_EQ(error.visibility_changed, 0) << "nothing but the lit";
            const bool eight = error.code.format == Format::Rgba8Unorm;
            EXPECT_LE(error.height_max, eight ? 0.5001 / 255 : 0x1p-11);
            if (view.elevation == 90) {
                EXPECT_LT(error.max, 1e-4) << "an offset of 0 has a step of its own";
            }
            // The bound is none that anything would keep.
            if (view.elevation < 90 && eight) {
                EXPECT_GT(error.max, error.bound / 4);
            }
        }
        EXPECT_LE(errors[1].bound, errors[0].bound / 200 + 1e-3) << "16 bits for 8";
        EXPECT_LE(errors[3].colour_max, errors[0].colour_max);
    }
}

// n sections of m taps against one march of n m taps, as the unit test does with the evaluator.
TEST(Split, SectionsOnTheDeviceAreTheLongerMarch) {
    const measure::MapSet set = map_named("cobbles");
    const measure::Textures textures(set, measure::Filtering::Float);
    const Direction view{25, 30};
    const VariantRequest one =
        request("parallax_occlusion,output=displaced", "glsl_450", {{"taps", "32"}});
    const VariantRequest four =
        split_request("parallax_occlusion,output=displaced", "sections=4", {{"taps", "8"}});
    const vulkan::Picture whole = draw_whole(one, textures, view);
    const double reach = test_scale / std::tan(25 * 3.14159265 / 180);
    for (const Format format : measure::pass_formats()) {
        const vulkan::Picture parts = draw_split(four, textures, view, format);
        const double code_error =
            measure::offset_code(format, measure::offset_range(view, test_scale)).error * 1.5;
        int far = 0;
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                const auto &a = whole.at(x, y), &b = parts.at(x, y);
                const double moved = std::hypot(a[0] - b[0], a[1] - b[1]);
                EXPECT_LE(moved, reach / 32 * 1.001 + code_error) << x << ", " << y;
                // What a section hands on of the profile's height is rounded too, and moves the
                // intersection with the next section's first segment.
                far += moved > reach / 32 / 20 + code_error;
            }
        EXPECT_LE(far, size * size / 50) << vulkan::name_of(format);
    }
}

// Whatever the search: with its own number of steps for each half of the relief, it misses no more
// and is no further off, at the median and the 95th percentile, than with that number for the
// whole.
TEST(Split, SectionsMakeNoSearchWorse) {
    const measure::MapSet set = map_named("cobbles");
    const measure::Textures textures(set, measure::Filtering::Float);
    const measure::Shot shot{{35, 250}, {45, 20}, test_scale, size, size};
    const dsl::Catalogue catalogue = templates::all_techniques();
    int searched = 0;
    for (const auto& search : catalogue.searches) {
        const auto statistics = [&](const VariantRequest& wanted) {
            const auto errors =
                measure::shot_errors(device(), catalogue, wanted, set, textures, shot);
            if (!errors) {
                EXPECT_EQ(errors.error().code, "split-search") << to_string(errors.error());
                return measure::HitStatistics{};
            }
            return measure::summarize(*errors, size);
        };
        const auto halves = statistics(split_request("search=" + search.name, "sections=2"));
        if (halves.pixels == 0) continue;
        ++searched;
        const auto whole = statistics(request("search=" + search.name, "glsl_450"));
        // One in a thousand: a feature thinner than a step is met or missed by where the step
        // falls.
        EXPECT_LE(halves.missed, whole.missed + whole.pixels / 1000) << search.name;
        // 1e-4 texels: rounding, for searches that are exact.
        EXPECT_LE(halves.median, whole.median + 1e-4) << search.name;
        EXPECT_LE(halves.p95, whole.p95 + 1e-4) << search.name;
        EXPECT_EQ(halves.invalid, 0) << search.name;
    }
    EXPECT_GE(searched, 3) << "none, and every march";
}

// In perspective the pixel's own place needs the division by w; a place one pixel off would move
// edges of the relief and shows at once.
TEST(Split, APassFindsItsOwnPixelInPerspective) {
    const measure::MapSet set = map_named("bricks");
    const measure::Textures textures(set, measure::Filtering::Float);
    measure::MeshView view;
    view.mesh = vulkan::torus(48, 1.0f, 0.45f, 6, 2);
    vulkan::Perspective perspective;
    perspective.aspect = 96.0f / 80.0f;
    perspective.near_plane = 0.05f;
    perspective.far_plane = 20;
    view.camera = must(vulkan::look_at({2.6f, 1.1f, 1.7f}, {0, 0, 0}, {0, 0, 1}, perspective));
    view.light = {0.4f, 0.5f, 0.77f};
    const auto draw = [&](const VariantRequest& wanted) {
        return must(measure::draw_passes(
            must(measure::link_passes(templates::all_techniques(), wanted)),
            measure::offset_code(Format::Rgba32Float, 1),
            [&](const check::Program& shaders, const measure::PassLink& link) {
                return measure::prepare_mesh(device(), shaders, textures, test_scale, 96, 80, view,
                                             {}, link);
            }));
    };
    const vulkan::Picture whole = draw(request("parallax_occlusion", "glsl_450"));
    const vulkan::Picture parts = draw(split_request("parallax_occlusion", "shading"));
    int covered = 0, wrong = 0;
    for (std::size_t i = 0; i < whole.pixels.size(); ++i) {
        covered += whole.pixels[i] != whole.pixels[0];
        wrong += whole.pixels[i] != parts.pixels[i];
    }
    EXPECT_GT(covered, 96 * 80 / 5);
    // u and v start at 0 along one seam each: few pixels have a longer offset than coordinate.
    EXPECT_LE(wrong, covered / 20);
}

// The bytes of ps_2_0, by MojoShader's translation, against the text of glsl_450: both passes with
// the picture between them.  The instructions differ, so a ray at the edge of a hit may fall to
// either side of it.
TEST(Split, TheBytesOfPs20DrawWhatTheTextDoes) {
    const measure::MapSet set = map_named("cobbles");
    const measure::Textures textures(set, measure::Filtering::Float);
    const Direction view{35, 30};
    for (const Format format : {Format::Rgba8Unorm, Format::Rgba32Float}) {
        const auto drawn = [&](const std::string& target) {
            return draw_split(split_request("parallax_occlusion,output=displaced",
                                            "sections=2,shading", {{"taps", "6"}}, target),
                              textures, view, format);
        };
        const vulkan::Picture text = drawn("glsl_450"), bytes = drawn("ps_2_0");
        // A coordinate on the boundary of two steps of the format may go to either.
        const auto code = measure::offset_code(format, measure::offset_range(view, test_scale));
        int far = 0;
        for (std::size_t i = 0; i < text.pixels.size(); ++i)
            for (std::size_t k : {0u, 1u})
                far +=
                    !(std::fabs(text.pixels[i][k] - bytes.pixels[i][k]) <= 2 * code.error + 1e-5);
        EXPECT_LE(far, size * size / 100) << vulkan::name_of(format);
    }
}

}  // namespace
}  // namespace intaglio::exec
