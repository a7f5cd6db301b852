// The drop-in promise: an emitted function, pasted into a shader that is not ours, draws what the
// whole surface draws.
#include "tests/exec/bench.h"

#include <fmt/format.h>

namespace intaglio::exec {
namespace {

constexpr int size = 64;
constexpr measure::Direction view{35, 50}, light{30, 160};

// A shader somebody else wrote, with names of its own: {0} is what is pasted, {1} the expression
// that calls it.
struct Host {
    const char* target;
    const char* text;
};

const Host hosts[] = {
    {"glsl_450", R"(#version 450
layout(location = 0) in vec2 uv_in;
layout(location = 1) in vec3 eye_in;
layout(location = 2) in vec3 light_in;
layout(set = 0, binding = 7, std140) uniform Foreign {{ float depth; vec2 texels; }};
layout(set = 0, binding = 8) uniform sampler2D bumps;
layout(location = 0) out vec4 fragment;
{0}
void main() {{ vec2 s = uv_in; vec3 E = eye_in; vec3 L = light_in; {1} }}
)"},
    {"glsl_330", R"(#version 330
in vec2 uv;
in vec3 to_eye;
in vec3 to_light;
uniform float depth;
uniform vec2 texels;
uniform sampler2D bumps;
out vec4 fragment;
{0}
void main() {{ vec2 s = uv; vec3 E = to_eye; vec3 L = to_light; {1} }}
)"},
    {"essl_300", R"(#version 300 es
precision highp float;
precision highp sampler2D;
in vec2 uv;
in vec3 to_eye;
in vec3 to_light;
uniform float depth;
uniform vec2 texels;
uniform sampler2D bumps;
out vec4 fragment;
{0}
void main() {{ vec2 s = uv; vec3 E = to_eye; vec3 L = to_light; {1} }}
)"},
    {"hlsl_5_0", R"(
cbuffer Foreign : register(b5) {{ float depth; float2 texels; }};
Texture2D bumps : register(t5);
SamplerState bumps_sampler : register(s5);
{0}
struct Varyings {{ float2 uv : TEXCOORD0; float3 to_eye : TEXCOORD1; float3 to_light : TEXCOORD2; float4 position : SV_Position; }};
float4 pixel_main(Varyings v) : SV_Target {{ float4 fragment; float2 s = v.uv; float3 E = v.to_eye; float3 L = v.to_light; {1} return fragment; }}
)"},
    {"hlsl_3_0", R"(
float depth;
float2 texels;
sampler2D bumps : register(s5);
{0}
float4 pixel_main(float2 uv : TEXCOORD0, float3 to_eye : TEXCOORD1, float3 to_light : TEXCOORD2) : COLOR0 {{
    float4 fragment; float2 s = uv; float3 E = to_eye; float3 L = to_light; {1} return fragment; }}
)"},
};

bool is_hlsl(const std::string& target) { return target.substr(0, 4) == "hlsl"; }

// The host's arguments for texture, size and scale.
std::string arguments(const std::string& target) {
    return target == "hlsl_5_0" ? "bumps, bumps_sampler, texels, depth" : "bumps, texels, depth";
}

vulkan::Picture draw_host(const std::string& target, const std::string& host_text,
                          const Variant& whole, const measure::MapSet& set) {
    check::Source host = source_of(whole, ir::Stage::Pixel);
    host.text = host_text;
    host.name = "host." + target;
    const check::Program shaders =
        must(check::link_to_spirv(source_of(whole, ir::Stage::Vertex), host));
    const vulkan::Mesh quad = vulkan::quad();
    const measure::Textures textures(set, measure::Filtering::Float);
    vulkan::Draw draw;
    draw.vertex.spirv = shaders.vertex;
    draw.fragment.spirv = shaders.pixel;
    draw.mesh = &quad;
    draw.uniforms =
        measure::uniforms_of(view, light, test_scale, set.heights.width, set.heights.height);
    draw.uniforms["depth"] = draw.uniforms["scale"];
    draw.uniforms["texels"] = draw.uniforms["map_size"];
    draw.textures = {{"bumps", &textures.height}, {"height_map", &textures.height}};
    draw.width = draw.height = size;
    return must(must(vulkan::Program::prepare(device(), draw)).draw())[0];
}

std::string function_text(const VariantRequest& wanted, dsl::FunctionPart part, Binding binding) {
    return must(make_function(templates::all_techniques(), wanted, part, binding)).text;
}

struct Case {
    std::string surface;
    Knobs knobs;
};

class PastedFunction : public testing::TestWithParam<Host> {};

TEST_P(PastedFunction, DrawsWhatTheWholeSurfaceDraws) {
    const std::string target = GetParam().target;
    const measure::MapSet bricks = map_named("bricks", 128, 64);
    const std::string vec3 = is_hlsl(target) ? "float3" : "vec3",
                      vec4 = is_hlsl(target) ? "float4" : "vec4";
    for (const Case& c :
         {Case{"parallax_occlusion,shadow=march,output=displaced", {{"taps", "12"}}},
          Case{"steep_parallax,shadow=march,output=displaced", {{"nyquist", "1"}}},
          Case{"relief,shadow=march,output=displaced", {}},
          Case{"parallax_iterative,shadow=march,output=displaced", {{"slope", "0"}}},
          Case{"steep_parallax,shadow=march,output=displaced", {{"stride", "2"}}},
          Case{"fur,output=displaced", {}}}) {
        const VariantRequest wanted = request(c.surface, target, c.knobs);
        const Variant whole = must(make_variant(templates::all_techniques(), wanted));
        // Fur's shadow asks for no light, so the whole surface's vertex stage hands none on; the
        // host wants one.
        VariantRequest with_light = request("steep_parallax,shadow=march,output=displaced", target);
        const Variant vertex = must(make_variant(templates::all_techniques(), with_light));
        const vulkan::Picture expected = draw(wanted, bricks, view, light, size)[0];

        const std::string find =
            function_text(wanted, dsl::FunctionPart::Search, Binding::Parameters);
        const std::string visibility =
            function_text(wanted, dsl::FunctionPart::Shadow, Binding::Parameters);
        const std::string call = fmt::format(
            "{} hit = find(s, E, {}); fragment = {}(hit, visibility(hit.xy, hit.z, L, {}));", vec3,
            arguments(target), vec4, arguments(target));
        const std::string host =
            fmt::format(fmt::runtime(GetParam().text), find + visibility, call);
        EXPECT_TRUE(same_bits(expected, draw_host(target, host, vertex, bricks)))
            << c.surface << " with parameters";

        const std::string find_globals =
            function_text(wanted, dsl::FunctionPart::Search, Binding::Globals);
        const std::string mixed = fmt::format(
            "{} hit = find(s, E); fragment = {}(hit, visibility(hit.xy, hit.z, L, {}));", vec3,
            vec4, arguments(target));
        const std::string globals_host =
            fmt::format(fmt::runtime(GetParam().text), find_globals + visibility, mixed);
        EXPECT_TRUE(same_bits(expected, draw_host(target, globals_host, vertex, bricks)))
            << c.surface << " with globals";

        const std::string visibility_globals =
            function_text(wanted, dsl::FunctionPart::Shadow, Binding::Globals);
        const std::string other = fmt::format(
            "{} hit = find(s, E, {}); fragment = {}(hit, visibility(hit.xy, hit.z, L));", vec3,
            arguments(target), vec4);
        const std::string other_host =
            fmt::format(fmt::runtime(GetParam().text), find + visibility_globals, other);
        EXPECT_TRUE(same_bits(expected, draw_host(target, other_host, vertex, bricks)))
            << c.surface << ", shadow with globals";
    }
}

INSTANTIATE_TEST_SUITE_P(EveryTextTarget, PastedFunction, testing::ValuesIn(hosts),
                         [](const testing::TestParamInfo<Host>& host) {
                             return std::string(host.param.target);
                         });

}  // namespace
}  // namespace intaglio::exec
