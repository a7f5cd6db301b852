// One surface, many targets and schedules: the same pixels, to the bit (design.md section 10).
#include "tests/exec/bench.h"

#include <algorithm>
#include <cmath>

#include "generator/target/target.h"

namespace intaglio::exec {
namespace {

struct Case {
    std::string surface;
    Knobs knobs;

    std::string name() const {
        std::string text = surface;
        for (const auto& [knob, value] : knobs) text += " " + knob + "=" + value;
        return text;
    }
};

const std::vector<Case> surfaces = {
    {"search=none", {}},
    {"parallax", {}},
    {"parallax_limited", {}},
    {"parallax_limited", {{"normal_weight", "1"}}},
    {"parallax_iterative", {}},
    {"steep_parallax", {}},
    {"steep_parallax", {{"stride", "1"}}},
    {"steep_parallax", {{"stride", "2"}, {"nyquist", "1"}}},
    {"steep_parallax", {{"stride", "3"}}},
    {"steep_parallax,shadow=march", {}},
    {"parallax_occlusion", {}},
    {"parallax_occlusion", {{"perspective_bias", "0.8"}, {"attenuation", "0.5"}}},
    {"parallax_occlusion", {{"fade_level", "2"}}},
    {"parallax_occlusion,shadow=march", {}},
    {"relief", {}},
    {"relief_secant", {}},
    {"contact_refinement", {}},
    {"exact", {}},
    {"exact", {{"max_leaps", "0"}}},
    {"search=none,shadow=exact", {}},
    {"fur", {}}};
constexpr measure::Direction light{35, 130};

// The level of every read is the hardware's choice there, so that only textures of one level give
// the same pixels.
const std::vector<std::string> one_level_targets = {"hlsl_2_b", "hlsl_2_0"};

// Without `precise` in the language a driver may reorder sums of products; lavapipe does, by a few
// ulp, where the text of these two gives it occasion.  A hit then moves by as much of the ray's
// reach, and at a cliff one pixel in many may stop on its other side.
bool may_be_reordered(const Case& c, const std::string& target) {
    const bool precise = target != "glsl_330" && target != "essl_300" && target != "hlsl_2_b" &&
                         target != "hlsl_2_0";
    const std::string search = c.surface.substr(0, c.surface.find(','));
    return !precise && (search == "exact" || search == "relief_secant");
}

testing::AssertionResult same_pixels(const vulkan::Picture& expected, const vulkan::Picture& actual,
                                     bool reordered) {
    if (!reordered) return same_bits(expected, actual);
    if (expected.pixels.size() != actual.pixels.size())
        return testing::AssertionFailure() << "sizes differ";
    std::size_t far = 0;
    for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
        float worst = 0;
        for (std::size_t c = 0; c < 4; ++c)
            worst = std::max(worst, std::abs(expected.pixels[i][c] - actual.pixels[i][c]));
        far += !(worst <= 1e-4f);
    }
    if (far * 500 <= expected.pixels.size()) return testing::AssertionSuccess();
    return testing::AssertionFailure() << far << " pixels differ by more than 1e-4";
}

// Targets whose artifact runs and says the level of each read: all but the listing `none`, the
// languages without SPIR-V, and msl, which no driver here takes.
std::vector<std::string> runnable_targets() {
    std::vector<std::string> names;
    for (const Target* target : all_targets())
        if (const auto language = language_of(*target);
            language && check::has_spirv(*language) && target->capabilities.texture_levels &&
            target->name != "msl" && target->name != "glsl_450")
            names.emplace_back(target->name);
    return names;
}

// One picture with textures that have no mipmaps.
vulkan::Picture draw_one_level(const VariantRequest& wanted, const measure::MapSet& set,
                               measure::Direction view) {
    const Variant variant = must(make_variant(templates::all_techniques(), wanted));
    measure::Textures textures(set, measure::Filtering::Float);
    for (vulkan::Texture* texture : {&textures.height, &textures.normal, &textures.colour})
        texture->levels.resize(1);
    vulkan::Program program = must(
        measure::prepare_quad(device(), must(link_variant(variant)), textures, test_scale, 64, 64));
    must(measure::aim(program, view, light));
    return must(program.draw())[0];
}

TEST(SamePixels, EveryTargetDrawsWhatGlsl450Draws) {
    const measure::MapSet bricks = map_named("bricks");
    ASSERT_GE(runnable_targets().size(), 5u);
    for (const Case& c : surfaces) {
        const std::vector<vulkan::Picture> expected =
            draw(request(c.surface, "glsl_450", c.knobs), bricks, {40, 25}, light);
        for (const std::string& target : runnable_targets()) {
            SCOPED_TRACE(c.name() + " on " + target);
            EXPECT_TRUE(same_pixels(
                expected[0], draw(request(c.surface, target, c.knobs), bricks, {40, 25}, light)[0],
                may_be_reordered(c, target)));
        }
    }
}

TEST(SamePixels, WithoutMipmapsShaderModel2DrawsWhatGlsl450Draws) {
    const measure::MapSet bricks = map_named("bricks");
    const Knobs steep = {{"min_steps", "4"}, {"max_steps", "14"}},
                shadow = {{"shadow_min_steps", "4"}, {"shadow_max_steps", "12"}};
    const std::vector<Case> fitting = {
        {"search=none", {}},
        {"parallax", {}},
        {"parallax_limited", {}},
        {"parallax_iterative", {}},
        {"relief", {{"linear_steps", "6"}, {"binary_steps", "3"}}},
        {"relief_secant", {{"linear_steps", "5"}, {"secant_steps", "2"}}},
        {"contact_refinement", {{"coarse_steps", "5"}, {"fine_steps", "4"}}},
        {"exact,output=displaced", {{"max_cells", "4"}, {"max_leaps", "0"}}},
        {"parallax_occlusion", {}},
        {"steep_parallax", steep},
        {"parallax_occlusion,shadow=march", shadow}};
    for (const Case& c : fitting)
        for (measure::Direction view : {measure::Direction{40, 25}, {12, 200}}) {
            const vulkan::Picture expected =
                draw_one_level(request(c.surface, "glsl_450", c.knobs), bricks, view);
            for (const std::string& target : one_level_targets) {
                SCOPED_TRACE(testing::Message()
                             << c.name() << " on " << target << " at elevation " << view.elevation);
                EXPECT_TRUE(same_pixels(
                    expected, draw_one_level(request(c.surface, target, c.knobs), bricks, view),
                    may_be_reordered(c, target)));
            }
        }
}

TEST(SamePixels, RolledAndUnrolledAgree) {
    const measure::MapSet text = map_named("text");
    const std::vector<std::pair<Case, std::vector<std::string>>> with_loops = {
        {{"parallax_occlusion", {}}, {"march"}},
        {{"steep_parallax,shadow=march", {}}, {"march", "shadow_march"}},
        {{"steep_parallax", {{"stride", "2"}, {"max_steps", "20"}}}, {"march"}},
        {{"parallax_iterative", {}}, {"approach"}},
        {{"relief", {}}, {"march", "halve"}},
        {{"relief_secant", {}}, {"march", "refine"}},
        {{"contact_refinement", {}}, {"march", "contact"}},
        {{"exact", {{"max_cells", "3"}, {"max_leaps", "6"}}}, {"walk", "leap"}},
        {{"exact", {{"max_cells", "16"}, {"max_leaps", "0"}}}, {"walk"}}};
    for (const auto& [c, loops] : with_loops)
        for (const char* target : {"glsl_450", "hlsl_5_0"}) {
            VariantRequest rolled =
                request(dsl::with_part(c.surface, "output", "displaced"), target, c.knobs);
            VariantRequest unrolled = rolled;
            for (const std::string& loop : loops) {
                rolled.loop_forms[loop] = ir::LoopForm::Rolled;
                unrolled.loop_forms[loop] = ir::LoopForm::Unrolled;
            }
            Drawing with_loop(rolled, text, 32), without(unrolled, text, 32);
            for (measure::Direction view : views()) {
                SCOPED_TRACE(testing::Message()
                             << c.name() << " on " << target << " at elevation " << view.elevation);
                EXPECT_TRUE(same_bits(with_loop.at(view, light)[0], without.at(view, light)[0]));
            }
        }
}

TEST(SamePixels, ACountedShaderDrawsWhatThePlainOneDraws) {
    const measure::MapSet bricks = map_named("bricks");
    for (const Case& c : surfaces) {
        const VariantRequest plain = request(c.surface, "glsl_450", c.knobs);
        VariantRequest counted = plain;
        counted.count_reads = true;
        EXPECT_TRUE(same_bits(draw(plain, bricks, {30, 60}, light)[0],
                              draw(counted, bricks, {30, 60}, light)[0]))
            << c.name();
    }
}

TEST(SamePixels, NoPixelIsNanOrInfinite) {
    for (const char* maker : {"bricks", "spikes", "flat0", "flat1"}) {
        const measure::MapSet set = map_named(maker);
        for (const Case& c : surfaces) {
            Drawing drawing(request(c.surface, "glsl_450", c.knobs), set, 16);
            for (measure::Direction view :
                 {measure::Direction{90, 0}, {45, 45}, {0.1, 33}, {0, 0}, {-20, 10}})
                for (measure::Direction l : {light, measure::Direction{90, 0}, {0, 0}, {-30, 50}})
                    EXPECT_EQ(count_invalid(drawing.at(view, l)[0]), 0)
                        << c.name() << " on " << maker << ", view " << view.elevation << ", light "
                        << l.elevation;
        }
    }
}

}  // namespace
}  // namespace intaglio::exec
