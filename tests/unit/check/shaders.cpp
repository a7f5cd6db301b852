// The hand-written shaders of the tests.  GLSL shares one body, so that only what a language says
// differently differs.
#include "tests/unit/check/shaders.h"

#include <fmt/format.h>

namespace intaglio::check {
namespace {

// {0}, {1}: the height at `uv` and at `at`; {2}: the output.
constexpr const char* glsl_body = R"(
void main() {{
    vec2 slide = view.xy / view.z * depth_scale;
    float t = 0.0;
    float height = {0};
    for (int i = 0; i < 16; i++) {{
        if (height >= 1.0 - t) break;
        t += 1.0 / 16.0;
        vec2 at = uv - slide * t;
        height = {1};
    }}
    {2} = vec4(uv - slide * t, dot(light, view), height);
}}
)";

std::string glsl_pixel(const std::string& head, const std::string& fetch,
                       const std::string& output) {
    return head + fmt::format(glsl_body, fmt::format(fmt::runtime(fetch), "uv"),
                              fmt::format(fmt::runtime(fetch), "at"), output);
}

constexpr const char* plain_uniforms = R"(uniform float depth_scale;
uniform vec3 light;
uniform sampler2D height_map;
)";

constexpr const char* glsl_450_pixel = R"(#version 450
layout(set = 0, binding = 0, std140) uniform Globals {
    float depth_scale;
    vec3 light;
};
layout(set = 0, binding = 16) uniform sampler2D height_map;
layout(location = 0) in vec2 uv;
layout(location = 1) in vec3 view;
layout(location = 0) precise out vec4 color;
)";

constexpr const char* hlsl_body = R"(
    float2 slide = input.view.xy / input.view.z * depth_scale;
    float t = 0.0;
    float height = FETCH(input.uv);
    [loop]
    for (int i = 0; i < 16; i++) {
        if (height >= 1.0 - t) break;
        t += 1.0 / 16.0;
        float2 at = input.uv - slide * t;
        height = FETCH(at);
    }
    return float4(input.uv - slide * t, dot(light, input.view), height);
}
)";

constexpr const char* hlsl_5_pixel = R"(cbuffer Globals : register(b0) {
    float depth_scale;
    float3 light;
};
Texture2D height_map : register(t0);
SamplerState height_sampler : register(s0);
#define FETCH(at) height_map.SampleLevel(height_sampler, at, 0.0).r
struct Varyings {
    float4 position : SV_Position;
    float2 uv : TEXCOORD0;
    float3 view : TEXCOORD1;
};
float4 main(Varyings input) : SV_Target {
)";

constexpr const char* hlsl_3_pixel = R"(float depth_scale;
float3 light;
sampler2D height_map : register(s0);
#define FETCH(at) tex2Dlod(height_map, float4(at, 0.0, 0.0)).r
struct Varyings {
    float2 uv : TEXCOORD0;
    float3 view : TEXCOORD1;
};
float4 main(Varyings input) : COLOR0 {
)";

constexpr const char* glsl_vertex_body = R"(
void main() {
    uv = texcoord;
    view = tangent_view;
    gl_Position = vec4(position * zoom, 1.0);
}
)";

constexpr const char* hlsl_vertex = R"(
struct Attributes {
    float3 position : POSITION;
    float2 texcoord : TEXCOORD0;
    float3 tangent_view : TEXCOORD1;
};
struct Varyings {
    float4 position : SV_Position;
    float2 uv : TEXCOORD0;
    float3 view : TEXCOORD1;
};
Varyings main(Attributes input) {
    Varyings output;
    output.position = float4(input.position * zoom, 1.0);
    output.uv = input.texcoord;
    output.view = input.tangent_view;
    return output;
}
)";

std::string pixel_text(Language language) {
    const std::string lod = "textureLod(height_map, {}, 0.0).r";
    const std::string plain = plain_uniforms;
    switch (language) {
        case Language::Glsl450: return glsl_pixel(glsl_450_pixel, lod, "color");
        case Language::Glsl330:
            return glsl_pixel(
                "#version 330\n" + plain + "in vec2 uv;\nin vec3 view;\nout vec4 color;\n", lod,
                "color");
        case Language::Essl300:
            return glsl_pixel("#version 300 es\nprecision highp float;\n" + plain +
                                  "in vec2 uv;\nin vec3 view;\nout vec4 color;\n",
                              lod, "color");
        case Language::Glsl120:
            return glsl_pixel("#version 120\n" + plain + "varying vec2 uv;\nvarying vec3 view;\n",
                              "texture2D(height_map, {}).r", "gl_FragColor");
        case Language::Essl100:
            return glsl_pixel("#version 100\nprecision highp float;\n" + plain +
                                  "varying vec2 uv;\nvarying vec3 view;\n",
                              "texture2D(height_map, {}).r", "gl_FragColor");
        case Language::Hlsl5: return std::string(hlsl_5_pixel) + hlsl_body;
        case Language::Hlsl3: return std::string(hlsl_3_pixel) + hlsl_body;
    }
    return {};
}

std::string vertex_text(Language language) {
    const std::string attributes = "in vec3 position;\nin vec2 texcoord;\nin vec3 tangent_view;\n";
    // The varyings in another order than in the pixel stage: only their names match.
    const std::string varyings = "out vec3 view;\nout vec2 uv;\n";
    switch (language) {
        case Language::Glsl450:
            return std::string(R"(#version 450
layout(set = 0, binding = 1, std140) uniform Camera { float zoom; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec2 texcoord;
layout(location = 2) in vec3 tangent_view;
layout(location = 0) out vec2 uv;
layout(location = 1) out vec3 view;
)") + glsl_vertex_body;
        case Language::Glsl330:
            return "#version 330\nuniform float zoom;\n" + attributes + varyings + glsl_vertex_body;
        case Language::Essl300:
            return "#version 300 es\nuniform float zoom;\n" + attributes + varyings +
                   glsl_vertex_body;
        case Language::Glsl120:
        case Language::Essl100:
            return std::string(language == Language::Glsl120 ? "#version 120\n"
                                                             : "#version 100\n") +
                   "uniform float zoom;\nattribute vec3 position;\nattribute vec2 texcoord;\n"
                   "attribute vec3 tangent_view;\nvarying vec2 uv;\nvarying vec3 view;\n" +
                   glsl_vertex_body;
        case Language::Hlsl5:
            return std::string("cbuffer Camera : register(b1) { float zoom; };\n") + hlsl_vertex;
        case Language::Hlsl3: return std::string("float zoom;\n") + hlsl_vertex;
    }
    return {};
}

}  // namespace

Source parallax_pixel(Language language) {
    return {.language = language,
            .stage = Stage::Pixel,
            .text = pixel_text(language),
            .name = "parallax.pixel"};
}

Source parallax_vertex(Language language) {
    return {.language = language,
            .stage = Stage::Vertex,
            .text = vertex_text(language),
            .name = "parallax.vertex"};
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t place = text.find(from);
    if (place == std::string::npos) return "the test's shader has no `" + from + "`";
    return text.replace(place, from.size(), to);
}

}  // namespace intaglio::check
