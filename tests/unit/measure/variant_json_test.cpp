// A request through JSON and back: what makes a variant is all there.
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "src/measure/command.h"
#include "src/measure/variant_json.h"

namespace intaglio::measure {
namespace {

using Json = nlohmann::ordered_json;

// Any finite float: huge, tiny, denormal, -0.
float any_float(std::mt19937& random) {
    for (;;) {
        const std::uint32_t bits = static_cast<std::uint32_t>(random());
        float value = 0;
        std::memcpy(&value, &bits, sizeof value);
        if (std::isfinite(value)) return value;
    }
}

VariantRequest any_request(std::mt19937& random) {
    VariantRequest request;
    request.surface = random() % 2 ? "parallax_occlusion" : "search=relief,shadow=none";
    request.target = random() % 2 ? "glsl_450" : "ps_2_b";
    for (const char* knob : {"taps", "lights", "clip_tile"})
        if (random() % 2) request.knobs.emplace_back(knob, fmt::format("{}", random() % 9));
    for (const char* loop : {"march", "shadow_walk"})
        if (random() % 2)
            request.loop_forms[loop] = random() % 2 ? ir::LoopForm::Rolled : ir::LoopForm::Unrolled;
    request.per_vertex = random() % 2;
    for (const char* uniform : {"scale", "ambient"})
        for (std::size_t i = random() % 4; i > 0; --i)
            request.known.uniforms[uniform].push_back(any_float(random));
    for (const char* value : {"view.z", "height_map.x"})
        if (random() % 2) request.known.ranges[value] = {any_float(random), any_float(random)};
    return request;
}

TEST(VariantJson, ARequestComesBackWhole) {
    std::mt19937 random(17);
    for (int round = 0; round < 300; ++round) {
        const VariantRequest request = any_request(random);
        const std::string text = json_of(request).dump();
        const Result<VariantRequest> back = request_of(Json::parse(text));
        ASSERT_TRUE(back.ok()) << to_string(back.error()) << text;
        EXPECT_EQ(back->knobs, request.knobs) << text;
        EXPECT_EQ(back->loop_forms, request.loop_forms) << text;
        EXPECT_EQ(back->known, request.known) << text;
        EXPECT_EQ(text_of(*back), text_of(request));
    }
}

TEST(VariantJson, SaysWhatIsWrong) {
    const auto code_of = [](const char* text) {
        const Result<VariantRequest> request = request_of(Json::parse(text));
        return request ? "fine" : request.error().code;
    };
    EXPECT_EQ(code_of(R"({"surface": "relief", "target": "ps_2_b", "knobs": {"taps": 4}})"),
              "fine");
    EXPECT_EQ(code_of(R"({"surface": "relief", "target": "ps_2_b"})"), "not-results");
    EXPECT_EQ(code_of(R"({"surface": 1, "target": "ps_2_b", "knobs": {}})"), "not-results");
    EXPECT_EQ(
        code_of(R"({"surface": "relief", "target": "ps_2_b", "knobs": {}, "known": ["scale"]})"),
        "known-syntax");
}

}  // namespace
}  // namespace intaglio::measure
