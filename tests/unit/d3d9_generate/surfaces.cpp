// The list of surfaces.
#include "tests/unit/d3d9_generate/surfaces.h"

#include <gtest/gtest.h>

#include <array>

#include "generator/dsl/catalogue.h"
#include "generator/ir/builder.h"
#include "generator/ir/parse.h"
#include "templates/all_techniques.h"

namespace intaglio::d3d9 {

std::string Case::name() const {
    std::string result = surface;
    for (const auto& [knob, value] : knobs) result += " " + knob + "=" + value;
    return result;
}

std::vector<Case> all_cases() {
    using Knobs = std::vector<std::pair<std::string, std::string>>;
    const auto steps = [](std::string low, std::string high) {
        return Knobs{{"min_steps", std::move(low)}, {"max_steps", std::move(high)}};
    };
    const auto shadow = [](std::string low, std::string high) {
        return Knobs{{"shadow_min_steps", std::move(low)}, {"shadow_max_steps", std::move(high)}};
    };
    std::vector<Case> cases;
    for (const std::string output : {"", ",output=displaced"}) {
        cases.push_back({"bump" + output, {}});
        cases.push_back({"search=none,shadow=march" + output, shadow("4", "4")});
        for (const std::string taps : {"1", "2", "5", "8"})
            cases.push_back({"parallax_occlusion" + output, {{"taps", taps}}});
        for (const std::string taps : {"3", "4", "7", "8", "10"})
            cases.push_back(
                {"parallax_occlusion" + output, {{"taps", taps}, {"ray_per_vertex", "1"}}});
        cases.push_back({"parallax_occlusion,shadow=fur_depth" + output, {{"taps", "4"}}});
        cases.push_back({"parallax_occlusion" + output, {{"taps", "4"}, {"packed", "1"}}});
        Knobs both = shadow("3", "3");
        both.emplace_back("taps", "3");
        cases.push_back({"parallax_occlusion,shadow=march" + output, both});
        cases.push_back({"steep_parallax" + output, steps("4", "4")});
        cases.push_back({"steep_parallax" + output, steps("8", "8")});
        cases.push_back({"steep_parallax" + output, steps("2", "6")});
        cases.push_back({"fur" + output, steps("6", "6")});
    }
    // Counts of terms beside multiples of four, and steps that are no power of two.
    for (const std::string count : {"5", "9", "11", "12", "15", "18", "24"}) {
        Case many{"steep_parallax,output=displaced", steps(count, count)};
        many.knobs.emplace_back("ray_per_vertex", "1");
        cases.push_back(many);
    }
    Case shadowed{"steep_parallax,shadow=march,output=displaced", steps("3", "3")};
    for (const auto& knob : shadow("8", "8")) shadowed.knobs.push_back(knob);
    cases.push_back(shadowed);
    for (const Case& search : std::initializer_list<Case>{
             {"parallax", {{"parallax_scale", "0.5"}, {"parallax_bias", "-0.5"}}},
             {"parallax_limited", {{"normal_weight", "1"}}},
             {"parallax_iterative", {{"iterations", "3"}}},
             {"parallax_occlusion", {{"taps", "3"}, {"attenuation", "1"}}},
             {"parallax_occlusion", {{"taps", "3"}, {"perspective_bias", "0.7"}}},
             {"steep_parallax", {{"stride", "1"}, {"min_steps", "2"}, {"max_steps", "5"}}},
             {"steep_parallax", {{"stride", "2"}, {"min_steps", "3"}, {"max_steps", "3"}}},
             {"steep_parallax", {{"stride", "3"}, {"min_steps", "3"}, {"max_steps", "3"}}},
             {"relief", {{"linear_steps", "4"}, {"binary_steps", "2"}}},
             {"relief_secant", {{"linear_steps", "4"}, {"secant_steps", "1"}}},
             {"contact_refinement", {{"coarse_steps", "4"}, {"fine_steps", "3"}}},
             {"exact", {{"max_cells", "2"}, {"max_leaps", "0"}}}})
        cases.push_back({search.surface + ",output=displaced", search.knobs});
    cases.push_back({"parallax_occlusion", {{"taps", "4"}, {"shininess", "2"}}});
    cases.push_back({"parallax_occlusion", {{"taps", "3"}, {"shininess", "8"}}});
    cases.push_back({"parallax_occlusion", {{"taps", "200"}}});
    Case level{"steep_parallax,output=displaced", steps("4", "4")};
    level.knobs.emplace_back("level", "2");
    cases.push_back(level);
    Case nyquist{"steep_parallax,output=displaced", steps("4", "4")};
    nyquist.knobs.emplace_back("nyquist", "1");
    cases.push_back(nyquist);
    return cases;
}

std::vector<Case> output_cases() {
    return {
        {"search=none,output=depth", {}},
        {"search=none,output=depth", {{"page_depth", "1"}}},
        {"search=none,output=depth", {{"depth_range", "1"}, {"clip_tile", "1"}}},
        {"parallax,output=depth", {{"page_depth", "1"}, {"clip_tile", "1"}}},
        {"bump", {{"clip_tile", "1"}}},
        {"bump,output=displaced", {{"clip_tile", "1"}}},
        {"parallax_occlusion", {{"taps", "2"}, {"clip_tile", "1"}}},
        {"parallax_occlusion,output=displaced", {{"taps", "6"}, {"clip_tile", "1"}}},
        {"parallax_occlusion,output=depth", {{"taps", "3"}, {"clip_tile", "1"}}},
        {"steep_parallax,output=displaced",
         {{"min_steps", "5"}, {"max_steps", "5"}, {"clip_tile", "1"}}},
        {"steep_parallax,output=depth",
         {{"min_steps", "2"}, {"max_steps", "4"}, {"depth_range", "1"}}},
        {"search=none,shadow=march,output=depth",
         {{"shadow_min_steps", "3"}, {"shadow_max_steps", "3"}, {"clip_tile", "1"}}},
        {"search=relief,output=displaced",
         {{"linear_steps", "3"}, {"binary_steps", "2"}, {"clip_tile", "1"}}},
    };
}

std::vector<Profile> pixel_profiles() {
    return {Profile::ps_2_0, Profile::ps_2_a, Profile::ps_2_b, Profile::ps_3_0};
}

Result<ir::Program> record(const Case& a_case, Profile profile) {
    auto surface = dsl::make_surface(templates::all_techniques(), a_case.surface);
    if (!surface) return surface.error();
    for (const auto& [knob, value] : a_case.knobs)
        if (const Status status = surface->set_knob(knob, value); !status) return status.error();
    dsl::RecordOptions options;
    options.target = name_of(profile);
    return dsl::record_surface(*surface, options);
}

ir::Program program_of_pixel(std::string_view text) {
    ir::Program program;
    auto module = ir::parse(text, "pixel.ir");
    EXPECT_TRUE(module) << text << (module ? "" : to_string(module.error()));
    if (module) program.pixel = std::move(*module);
    program.name = program.pixel.name;
    add_vertex(program);
    return program;
}

void add_vertex(ir::Program& program) {
    program.vertex.stage = ir::Stage::Vertex;
    program.vertex.outputs = program.pixel.inputs;
    ir::Builder vertex(program.vertex);
    const std::array corner = {vertex.swizzle(vertex.constant(0.5f), "xx")};
    vertex.finish(corner);
}

}  // namespace intaglio::d3d9
