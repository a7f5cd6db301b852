// One surface, many targets and schedules: the same pixels, to the bit (design.md section 10).
#include "tests/exec/bench.h"

#include "generator/target/target.h"

namespace intaglio::exec {
namespace {

const std::vector<std::string> surfaces = {"search=none",
                                           "parallax_occlusion",
                                           "steep_parallax",
                                           "steep_parallax,shadow=march",
                                           "parallax_occlusion,shadow=march",
                                           "fur"};
constexpr measure::Direction light{35, 130};

// The level of every read is the hardware's choice there, so that only textures of one level give
// the same pixels.
const std::vector<std::string> one_level_targets = {"hlsl_2_b", "hlsl_2_0"};

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
    for (const std::string& surface : surfaces) {
        const std::vector<vulkan::Picture> expected =
            draw(request(surface, "glsl_450"), bricks, {40, 25}, light);
        for (const std::string& target : runnable_targets()) {
            SCOPED_TRACE(surface + " on " + target);
            EXPECT_TRUE(
                same_bits(expected[0], draw(request(surface, target), bricks, {40, 25}, light)[0]));
        }
    }
}

TEST(SamePixels, WithoutMipmapsShaderModel2DrawsWhatGlsl450Draws) {
    const measure::MapSet bricks = map_named("bricks");
    const Knobs steep = {{"min_steps", "4"}, {"max_steps", "14"}},
                shadow = {{"shadow_min_steps", "4"}, {"shadow_max_steps", "12"}};
    const std::vector<std::pair<std::string, Knobs>> fitting = {
        {"search=none", {}},
        {"parallax_occlusion", {}},
        {"steep_parallax", steep},
        {"parallax_occlusion,shadow=march", shadow}};
    for (const auto& [surface, knobs] : fitting)
        for (measure::Direction view : {measure::Direction{40, 25}, {12, 200}}) {
            const vulkan::Picture expected =
                draw_one_level(request(surface, "glsl_450", knobs), bricks, view);
            for (const std::string& target : one_level_targets) {
                SCOPED_TRACE(testing::Message()
                             << surface << " on " << target << " at elevation " << view.elevation);
                EXPECT_TRUE(same_bits(
                    expected, draw_one_level(request(surface, target, knobs), bricks, view)));
            }
        }
}

TEST(SamePixels, RolledAndUnrolledAgree) {
    const measure::MapSet text = map_named("text");
    for (const char* surface :
         {"parallax_occlusion,output=displaced", "steep_parallax,shadow=march,output=displaced"})
        for (const char* target : {"glsl_450", "hlsl_5_0"}) {
            VariantRequest rolled = request(surface, target, {});
            VariantRequest unrolled = rolled;
            rolled.loop_forms = {{"march", ir::LoopForm::Rolled}};
            unrolled.loop_forms = {{"march", ir::LoopForm::Unrolled}};
            if (rolled.surface.find("shadow=march") != std::string::npos)
                unrolled.loop_forms["shadow_march"] = ir::LoopForm::Unrolled;
            Drawing with_loop(rolled, text, 32), without(unrolled, text, 32);
            for (measure::Direction view : views()) {
                SCOPED_TRACE(testing::Message()
                             << surface << " on " << target << " at elevation " << view.elevation);
                EXPECT_TRUE(same_bits(with_loop.at(view, light)[0], without.at(view, light)[0]));
            }
        }
}

TEST(SamePixels, ACountedShaderDrawsWhatThePlainOneDraws) {
    const measure::MapSet bricks = map_named("bricks");
    for (const std::string& surface : surfaces) {
        VariantRequest counted = request(surface, "glsl_450");
        counted.count_reads = true;
        EXPECT_TRUE(same_bits(draw(request(surface, "glsl_450"), bricks, {30, 60}, light)[0],
                              draw(counted, bricks, {30, 60}, light)[0]))
            << surface;
    }
}

TEST(SamePixels, NoPixelIsNanOrInfinite) {
    for (const char* maker : {"bricks", "spikes", "flat0", "flat1"}) {
        const measure::MapSet set = map_named(maker);
        for (const std::string& surface : surfaces) {
            Drawing drawing(request(surface, "glsl_450"), set, 16);
            for (measure::Direction view :
                 {measure::Direction{90, 0}, {45, 45}, {0.1, 33}, {0, 0}, {-20, 10}})
                for (measure::Direction l : {light, measure::Direction{90, 0}, {0, 0}, {-30, 50}})
                    EXPECT_EQ(count_invalid(drawing.at(view, l)[0]), 0)
                        << surface << " on " << maker << ", view " << view.elevation << ", light "
                        << l.elevation;
        }
    }
}

}  // namespace
}  // namespace intaglio::exec
