// Compositions of techniques, their knobs, and what is recorded of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "generator/ir/evaluate.h"
#include "generator/ir/parse.h"
#include "generator/ir/print.h"
#include "generator/ir/verify.h"
#include "templates/all_techniques.h"
#include "tests/rounds.h"

namespace intaglio::dsl {
namespace {

using testing::HasSubstr;

const Catalogue& catalogue() {
    static const Catalogue all = templates::all_techniques();
    return all;
}

// Every composition of search, shadow and output there is.
std::vector<std::string> compositions() {
    std::vector<std::string> all;
    for (const auto& search : catalogue().searches)
        for (const auto& shadow : catalogue().shadows)
            for (const auto& output : catalogue().outputs)
                all.push_back("search=" + search.name + ",shadow=" + shadow.name +
                              ",output=" + output.name);
    return all;
}

TEST(Surface, EveryCompositionIsRecordedVerifiedPrintedAndParsedBack) {
    for (const std::string& text : compositions()) {
        const Result<Surface> surface = make_surface(catalogue(), text);
        ASSERT_TRUE(surface.ok()) << to_string(surface.error());
        const Result<ir::Program> program = record_surface(*surface, {"glsl_450", {}, false});
        ASSERT_TRUE(program.ok()) << to_string(program.error());
        for (const ir::Module* module : {&program->vertex, &program->pixel}) {
            const Status verified = ir::verify(*module);
            EXPECT_TRUE(verified.ok()) << text << ": " << to_string(verified.error());
            const Result<ir::Module> parsed = ir::parse(ir::print(*module), text);
            ASSERT_TRUE(parsed.ok()) << to_string(parsed.error());
            EXPECT_TRUE(*parsed == *module) << text;
        }
    }
}

TEST(Surface, RecordingIsDeterministic) {
    const auto record = [] {
        const Result<Surface> surface = make_surface(catalogue(), "steep_parallax,shadow=march");
        return ir::print(record_surface(*surface, {"hlsl_5_0", {}, false})->pixel);
    };
    EXPECT_EQ(record(), record());
}

TEST(Surface, FunctionsTakeTheirArgumentsAsTheConventionsSay) {
    const Result<Surface> surface = make_surface(catalogue(), "steep_parallax,shadow=march");
    for (FunctionPart part : {FunctionPart::Search, FunctionPart::Shadow}) {
        const Result<ir::Program> program =
            record_function(*surface, part, {"glsl_450", {}, false});
        ASSERT_TRUE(program.ok());
        EXPECT_TRUE(ir::verify(program->pixel).ok());
        std::vector<std::string> names;
        for (const ir::Declaration& input : program->pixel.inputs) names.push_back(input.name);
        if (part == FunctionPart::Search)
            EXPECT_THAT(names, testing::ElementsAre("uv", "view"));
        else
            EXPECT_THAT(names, testing::ElementsAre("uv", "height", "light"));
    }
}

TEST(Surface, ASearchFunctionTakesTheReachThatVerticesGive) {
    auto surface = make_surface(templates::all_techniques(), "parallax_occlusion");
    ASSERT_TRUE(surface.ok());
    ASSERT_TRUE(surface->set_knob("ray_per_vertex", "1").ok());
    const auto program = record_function(*surface, FunctionPart::Search, {"glsl_450", {}, false});
    ASSERT_TRUE(program.ok());
    std::vector<std::string> names;
    for (const ir::Declaration& input : program->pixel.inputs) names.push_back(input.name);
    EXPECT_THAT(names, testing::ElementsAre("uv", "view", "reach"));
}

// A surface has one technique of each table, so that only those of one table may share a name:
// `linear_steps` of two searches that begin with the same march.
TEST(Surface, NamesOfKnobsAreUniqueInEverySurface) {
    std::set<std::string> names;
    const auto add = [&](const auto& table) {
        std::set<std::string> of_table;
        for (const auto& row : table) {
            const auto technique = row.make();
            std::set<std::string> of_technique;
            for (const KnobBase* knob : technique->knobs())
                EXPECT_TRUE(of_technique.insert(knob->name()).second) << knob->name();
            of_table.merge(of_technique);
        }
        for (const std::string& name : of_table) EXPECT_TRUE(names.insert(name).second) << name;
    };
    add(catalogue().searches);
    add(catalogue().shadows);
    add(catalogue().normals);
    add(catalogue().shadings);
    add(catalogue().outputs);
    add(catalogue().vertex_works);
    const ReliefKnobs relief;
    const LightKnobs lighting;
    for (const Technique* technique : std::initializer_list<const Technique*>{&relief, &lighting})
        for (const KnobBase* knob : technique->knobs())
            EXPECT_TRUE(names.insert(knob->name()).second) << knob->name();
}

TEST(Surface, EveryKnobWorksAtBothEndsOfItsRange) {
    const std::vector<std::string> all = compositions();
    for (std::size_t at = 0; at < all.size(); at += stride) {
        const std::string& text = all[at];
        const Result<Surface> probe = make_surface(catalogue(), text);
        for (std::size_t i = 0; i < probe->knobs().size(); ++i)
            for (bool most : {false, true}) {
                const Result<Surface> surface = make_surface(catalogue(), text);
                KnobBase* knob = surface->knobs()[i];
                ASSERT_TRUE(knob->set(most ? knob->most() : knob->least()).ok());
                const Result<ir::Program> program =
                    record_surface(*surface, {"glsl_450", {}, false});
                // Two knobs that bound one range may cross: then the technique says so in a
                // sentence.
                if (!program)
                    EXPECT_EQ(program.error().code, "knob-relation") << text << " " << knob->name();
                else
                    EXPECT_TRUE(ir::verify(program->pixel).ok()) << text << " " << knob->name();
            }
    }
}

TEST(Surface, WrongNamesGetTheNearest) {
    const auto error = [](std::string_view text) {
        return make_surface(catalogue(), text).error();
    };
    EXPECT_EQ(error("paralax").code, "unknown-surface");
    EXPECT_THAT(error("steep_paralax").message, HasSubstr("did you mean 'steep_parallax'"));
    EXPECT_EQ(error("search=").code, "unknown-technique");
    EXPECT_EQ(error("").code, "unknown-surface");
    EXPECT_EQ(error("search=none,").code, "surface-syntax");
    EXPECT_EQ(error("search=none,search=none").code, "surface-syntax");
    EXPECT_EQ(error("serach=none").code, "unknown-part");
    Result<Surface> surface = make_surface(catalogue(), "parallax_occlusion");
    EXPECT_THAT(surface->set_knob("tap", "3").error().message, HasSubstr("did you mean 'taps'"));
}

TEST(Surface, UnknownLoopsAreRefused) {
    const Result<Surface> surface = make_surface(catalogue(), "parallax_occlusion");
    const Result<ir::Program> program =
        record_surface(*surface, {"glsl_450", {{"mrach", ir::LoopForm::Unrolled}}, false});
    ASSERT_FALSE(program.ok());
    EXPECT_EQ(program.error().code, "unknown-loop");
    EXPECT_THAT(program.error().message, HasSubstr("did you mean 'march'"));
}

TEST(Surface, TheHighlightIsDefinedWhereTheNormalFacesAway) {
    // N.L > 0 and N.H < 0: without its guard the power of a negative base is NaN.
    const Result<Surface> surface = make_surface(catalogue(), "bump");
    const Result<ir::Program> program = record_surface(*surface, {"glsl_450", {}, false});
    ASSERT_TRUE(program.ok());
    ir::Texture away;
    away.levels = {{0.75f, 0.5f, 0.067f, 1.0f}};
    ir::Environment environment;
    for (const ir::Declaration& input : program->pixel.inputs)
        environment.inputs.push_back(input.name == "to_light"
                                         ? ir::Environment::Vector{1, 0, 0.01, 0}
                                         : ir::Environment::Vector{0, 0, 1, 0});
    environment.uniforms.assign(program->pixel.uniforms.size(), {{1, 1, 1, 1}});
    environment.samplers.assign(program->pixel.samplers.size(), &away);
    const ir::Evaluation pixel =
        ir::Evaluator(program->pixel).run(environment, ir::Precision::Single);
    for (double component : pixel.outputs[0]) EXPECT_TRUE(std::isfinite(component));
}

TEST(Surface, PartsAreReplaced) {
    EXPECT_EQ(with_part("fur", "output", "displaced"), "fur,output=displaced");
    EXPECT_EQ(with_part("fur,output=colour", "output", "displaced"), "fur,output=displaced");
    EXPECT_EQ(with_part("search=none,shadow=march", "shadow", "none"), "search=none,shadow=none");
    const Result<Surface> fur = make_surface(catalogue(), "fur,shadow=march");
    ASSERT_TRUE(fur.ok());
    EXPECT_TRUE(fur->knobs().size() > 3);
}

}  // namespace
}  // namespace intaglio::dsl
