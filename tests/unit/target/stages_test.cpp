// Whole stages and functions: interfaces, every op in every language, what is refused, and the two
// stages together.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/target/programs.h"

namespace intaglio {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// Every op that the target can say, over run-time operands, so that no pass can fold it away.
ir::Module every_op(const Capabilities& can, std::vector<ir::Op>& covered) {
    ir::Module module;
    module.name = "every_op";
    module.inputs = {{"uv", ir::float2, ir::Semantic::Interpolant},
                     {"where", ir::float3, ir::Semantic::Interpolant},
                     {"other", ir::float3, ir::Semantic::Interpolant}};
    module.outputs = {{"colour", ir::float4, ir::Semantic::Target}};
    module.uniforms = {{"count", ir::int1, 1, ""}, {"rows", ir::float4, 3, ""}};
    module.samplers = {{"flat_map", 2, ""}, {"solid_map", 3, ""}};
    ir::Builder builder(module);
    const ir::ValueId uv = builder.input(0), where = builder.input(1), other = builder.input(2);
    const ir::ValueId level = builder.swizzle(where, "x"), zero = builder.constant(0.0f),
                      count = builder.uniform(0), row = builder.uniform(1, 2);
    ir::ValueId sum = row;
    const auto add = [&](ir::ValueId value) {
        const int width = module.type(value).width;
        const ir::ValueId wide = builder.swizzle(value, width == 1   ? "xxxx"
                                                        : width == 2 ? "xyxy"
                                                                     : "xyzx");
        sum = builder.emit(ir::Op::Add, {sum, width == 4 ? value : wide});
    };
    for (const ir::OpInfo& row_info : ir::all_ops()) {
        const ir::Op op = row_info.op;
        covered.push_back(op);
        if ((op == ir::Op::Ddx || op == ir::Op::Ddy) && !can.derivatives) continue;
        const auto each = static_cast<std::size_t>(std::max(0, row_info.operand_count));
        switch (row_info.type_rule) {
            case ir::TypeRule::SameNumeric:
                add(builder.emit(ir::Op::ToFloat, {builder.emit(op, std::vector(each, count))}));
                [[fallthrough]];
            case ir::TypeRule::SameFloat:
            case ir::TypeRule::Dot:
            case ir::TypeRule::Cross: {
                std::vector<ir::ValueId> operands(each, where);
                operands.back() = other;
                add(builder.emit(op, operands));
                break;
            }
            case ir::TypeRule::Compare: {
                const ir::ValueId y = builder.swizzle(other, "y");
                add(builder.emit(ir::Op::Select, {builder.emit(op, {level, y}), level, y}));
                break;
            }
            case ir::TypeRule::Logic: {
                const ir::ValueId holds =
                    builder.emit(ir::Op::Less, {level, builder.swizzle(other, "z")});
                const ir::ValueId also =
                    builder.emit(ir::Op::Less, {level, builder.swizzle(other, "x")});
                const ir::ValueId logic =
                    op == ir::Op::Not ? builder.emit(op, {holds}) : builder.emit(op, {holds, also});
                add(builder.emit(ir::Op::Select, {logic, where, other}));
                break;
            }
            case ir::TypeRule::Sample:
                for (int sampler : {0, 1}) {
                    if (sampler == 1 && !can.volume_textures) break;
                    const ir::ValueId at = sampler ? where : uv;
                    const ir::ValueId dx = sampler ? other : builder.swizzle(other, "xy");
                    if (op == ir::Op::SampleLevel)
                        add(builder.sample(op, sampler, {at, can.texture_levels ? level : zero}));
                    if (op == ir::Op::SampleGrad) add(builder.sample(op, sampler, {at, dx, at}));
                    if (op == ir::Op::SampleImplicit) add(builder.sample(op, sampler, {at}));
                }
                break;
            default: break;  // leaves, shapes and control flow: used here or tested by themselves
        }
    }
    builder.finish(std::vector{sum});
    return module;
}

TEST(EveryOp, IsAcceptedInEveryLanguageByEveryWitness) {
    for (const testing::TextTarget& target : testing::text_targets) {
        std::vector<ir::Op> covered;
        const ir::Program program =
            testing::program_of(every_op(find_target(target.name)->capabilities, covered));
        EXPECT_EQ(covered.size(), ir::all_ops().size());
        const Artifact artifact = testing::emitted(program, ir::Stage::Pixel, target.name);
        const auto judged = check::judge(testing::source_of(artifact, target.language));
        EXPECT_TRUE(judged.ok()) << target.name << ": " << to_string(judged.error()) << "\n"
                                 << artifact.text;
    }
}

constexpr std::string_view vertex_text = R"(
vertex "surface"
input position float3 attribute
input normal float3 attribute
input uv float2 attribute
output clip float4 position
output uv float2 interpolant
output unused float3 interpolant
output view float3 interpolant
uniform world float4[3] "object to world: three rows"
uniform scale float1
{
    %position float3 = input position
    %normal float3 = input normal
    %uv float2 = input uv
    %scale float1 = uniform scale
    %one float1 = const 1.0
    %p float4 = compose %position, %one
    %r0 float4 = uniform world[0]
    %r1 float4 = uniform world[1]
    %r2 float4 = uniform world[2]
    %x float1 = dot %r0, %p
    %y float1 = dot %r1, %p
    %z float1 = dot %r2, %p
    %clip float4 = compose %x, %y, %z, %one
    %view float3 = compose %z, %y, %x
    %scales float2 = swizzle %scale.xx
    %tiled float2 = mul %uv, %scales
    return (%clip, %tiled, %normal, %view)
}
)";
constexpr std::string_view pixel_text = R"(
pixel "surface"
input view float3 interpolant
input uv float2 interpolant
input unused float3 interpolant
output colour float4 target
output reads float4 target
uniform scale float1 "depth of the relief"
sampler height_map 2d "height in red"
sampler colour_map 2d
{
    %view float3 = input view
    %uv float2 = input uv
    %unused float3 = input unused
    %scale float1 = uniform scale
    %zero float1 = const 0.0
    %height float4 = sample_level height_map %uv, %zero
    %colour float4 = sample colour_map %uv
    %lit float4 = mul %height, %colour
    %rest float4 = compose %view, %scale
    %more float4 = compose %unused, %zero
    %sum float4 = add %rest, %more
    return (%lit, %sum)
}
)";

ir::Program surface() {
    ir::Program program;
    program.name = "surface";
    program.description = "A surface.\nBy somebody.";
    program.settings = {"taps = 8", "scale = 0.05"};
    program.vertex = testing::parsed(vertex_text);
    program.pixel = testing::parsed(pixel_text);
    return program;
}

// With its first colour output only.
ir::Program surface_of_one_colour() {
    ir::Program program = surface();
    program.pixel.outputs.pop_back();
    program.pixel.body.body.back().operands.pop_back();
    return program;
}

TEST(Stages, FitEachOtherInEveryLanguage) {
    for (const testing::TextTarget& target : testing::text_targets) {
        const bool one = find_target(target.name)->capabilities.colour_targets == 1;
        const ir::Program program = one ? surface_of_one_colour() : surface();
        const Artifact vertex = testing::emitted(program, ir::Stage::Vertex, target.name);
        const Artifact pixel = testing::emitted(program, ir::Stage::Pixel, target.name);
        if (!check::has_spirv(target.language)) {
            for (const Artifact* stage : {&vertex, &pixel}) {
                const Status accepted =
                    testing::accepted(testing::source_of(*stage, target.language));
                EXPECT_TRUE(accepted.ok()) << target.name << ": " << to_string(accepted.error());
            }
            continue;
        }
        const auto linked = check::link_to_spirv(testing::source_of(vertex, target.language),
                                                 testing::source_of(pixel, target.language));
        EXPECT_TRUE(linked.ok()) << target.name << ": " << to_string(linked.error()) << vertex.text
                                 << pixel.text;
    }
}

TEST(Stages, SayWhichTexturesAreSampledNearest) {
    ir::Program program = surface();
    program.pixel.samplers[0].filter = ir::Sampler::Filter::Nearest;
    for (const char* target : {"glsl_450", "glsl_120", "essl_100", "hlsl_5_0", "hlsl_2_b"}) {
        const bool one = find_target(target)->capabilities.colour_targets == 1;
        if (one) program.pixel = surface_of_one_colour().pixel;
        program.pixel.samplers[0].filter = ir::Sampler::Filter::Nearest;
        EXPECT_THAT(testing::emitted(program, ir::Stage::Pixel, target).text,
                    HasSubstr("// height in red; sample it nearest, in texel and level\n"))
            << target;
    }
}

TEST(Stages, BindByTheRulesOfTheTargetsPage) {
    const std::string vertex = testing::emitted(surface(), ir::Stage::Vertex, "glsl_450").text;
    EXPECT_THAT(vertex, HasSubstr("layout(set = 0, binding = 0, std140) uniform VertexUniforms {"));
    EXPECT_THAT(vertex, HasSubstr("layout(location = 2) precise out vec3 view;"));
    EXPECT_THAT(vertex, HasSubstr("    vec4 world[3];  // object to world: three rows\n"));
    const std::string pixel = testing::emitted(surface(), ir::Stage::Pixel, "glsl_450").text;
    EXPECT_THAT(pixel, HasSubstr("layout(location = 2) in vec3 view;"));
    EXPECT_THAT(pixel, HasSubstr("layout(set = 0, binding = 1, std140) uniform PixelUniforms {"));
    EXPECT_THAT(
        pixel,
        HasSubstr(
            "layout(set = 0, binding = 2) uniform sampler2D height_map;  // height in red\n"));
    EXPECT_THAT(pixel, HasSubstr("layout(location = 1) precise out vec4 reads;"));
    EXPECT_THAT(pixel,
                HasSubstr("// A surface.\n// By somebody.\n// Settings: taps = 8, scale = 0.05\n"));
    const std::string hlsl = testing::emitted(surface(), ir::Stage::Pixel, "hlsl_5_0").text;
    EXPECT_THAT(hlsl, HasSubstr("cbuffer PixelUniforms : register(b1) {"));
    EXPECT_THAT(hlsl, HasSubstr("SamplerState colour_map_sampler : register(s1);"));
    EXPECT_THAT(hlsl, HasSubstr("    float4 clip_value : SV_Position;\n};"));
    const std::string old = testing::emitted(surface(), ir::Stage::Pixel, "hlsl_3_0").text;
    EXPECT_THAT(old, HasSubstr("sampler2D height_map : register(s0);"));
    EXPECT_THAT(old, Not(HasSubstr("SV_Position")));
}

TEST(Stages, RefuseAnInputThatTheVertexStageDoesNotGive) {
    ir::Program program = surface();
    program.pixel.inputs[0].name = "viewpoint";
    for (const testing::TextTarget& target : testing::text_targets) {
        const auto artifact = find_target(target.name)->print(program, ir::Stage::Pixel);
        ASSERT_FALSE(artifact.ok());
        EXPECT_EQ(artifact.error().message,
                  "the pixel stage reads viewpoint, which the vertex stage does not give");
    }
}

TEST(Stages, RefuseOneUniformOfTwoTypesWhereTheStagesShareIt) {
    ir::Program program = surface();
    program.pixel.uniforms[0].count = 2;
    const auto shared = find_target("glsl_330")->print(program, ir::Stage::Pixel);
    ASSERT_FALSE(shared.ok());
    EXPECT_EQ(shared.error().code, "uniform-conflict");
    EXPECT_TRUE(find_target("glsl_450")->print(program, ir::Stage::Pixel).ok());
}

TEST(Limits, NameTheTargetAndTheLine) {
    const ir::Program program = testing::program_of(testing::parsed(R"(
pixel "p"
input a float1 interpolant
output to float1 target
file "templates/search/mine.cpp"
{
    %a float1 = input a
    %k float1 = const inf @0:12
    %m float1 = min %a, %k @0:13
    return (%m)
})"));
    const auto artifact = emit(program, *find_target("hlsl_3_0"));
    ASSERT_FALSE(artifact.ok());
    EXPECT_EQ(to_string(artifact.error()),
              "templates/search/mine.cpp:12: error: this language has no way to write the "
              "constant infinity [target-limit]");
    EXPECT_TRUE(emit(program, *find_target("hlsl_5_0")).ok());

    ir::Program many = testing::program_of(
        testing::parsed("pixel \"p\"\noutput a float1 target\n{\n    %_0 float1 = const 1.0\n"
                        "    return (%_0)\n}\n"));
    const ir::ValueId value = many.pixel.body.body.back().operands[0];
    for (const char* name : {"b", "c", "d", "e"}) {
        many.pixel.outputs.push_back({name, ir::float1, ir::Semantic::Target});
        many.pixel.body.body.back().operands.push_back(value);
    }
    const auto five = emit(many, *find_target("essl_300"));
    ASSERT_FALSE(five.ok());
    EXPECT_EQ(five.error().message, "p has 5 colour outputs; essl_300 can write 4");
}

TEST(Limits, RefuseALoopThatShaderModel3WouldCutShort) {
    const ir::Program program = testing::program_of(testing::parsed(R"(
pixel "p"
input a float1 interpolant
output to float1 target
{
    %a float1 = input a
    %end float1 = loop "march" 255 rolled (%a) {
    (%i int1, %t float1):
        %_next float1 = mul %t, %t
        yield (%_next)
    }
    return (%end)
})"));
    const auto artifact = emit(program, *find_target("hlsl_3_0"));
    ASSERT_FALSE(artifact.ok());
    EXPECT_EQ(artifact.error().message,
              "the loop march runs up to 255 times; hlsl_3_0 can repeat one 254 times");
    EXPECT_TRUE(emit(program, *find_target("hlsl_5_0")).ok());
}

TEST(Targets, AreFoundByNameAndDerivedOnesSaySo) {
    for (const Target* target : all_targets()) EXPECT_EQ(find_target(target->name), target);
    EXPECT_EQ(find_target("glsl"), nullptr);
    for (std::string_view name : {"spirv", "msl"}) {
        const auto artifact = emit(surface(), *find_target(name));
        ASSERT_FALSE(artifact.ok());
        EXPECT_EQ(artifact.error().code, "target-derived");
        EXPECT_EQ(find_target(name)->derived_from, "glsl_450");
    }
}

TEST(Targets, NonePrintsTheModuleItself) {
    const Artifact artifact = testing::emitted(surface(), ir::Stage::Pixel, "none");
    EXPECT_TRUE(ir::parse(artifact.text, "none").ok());
}

TEST(Emit, TellsOfEveryPass) {
    std::vector<std::string> passes;
    const EmitOptions options{
        [&](std::string_view pass, const ir::Module&) { passes.emplace_back(pass); }};
    ASSERT_TRUE(emit(surface(), *find_target("glsl_450"), options).ok());
    EXPECT_THAT(passes, ::testing::Contains("pixel: remove_dead_code"));
    EXPECT_THAT(passes, ::testing::Contains("vertex: check_limits"));
}

constexpr std::string_view function_text = R"(
function "find"
input uv float2 parameter
input view float3 parameter
output hit float3 result
uniform map_size float2 "texels of height_map"
uniform scale float1 "depth of the relief in texture units"
sampler height_map 2d "height in red"
{
    %uv float2 = input uv
    %view float3 = input view
    %size float2 = uniform map_size
    %scale float1 = uniform scale
    %zero float1 = const 0.0
    %at float2 = div %uv, %size
    %texel float4 = sample_level height_map %at, %zero
    %height float1 = swizzle %texel.x
    %deep float1 = mul %height, %scale
    %depths float3 = swizzle %deep.xxx
    %hit float3 = mul %view, %depths
    return (%hit)
}
)";

// A shader of somebody else's that calls the function, with all it needs in either binding.
std::string host(std::string_view target, Binding binding, const std::string& function) {
    const bool parameters = binding == Binding::Parameters;
    if (target == "hlsl_5_0")
        return (parameters ? "Texture2D tex : register(t0); SamplerState smp : register(s0);\n"
                           : "") +
               function +
               "float4 host_main(float2 at : TEXCOORD0) : SV_Target0 { return float4(find(at, "
               "at.xyx" +
               (parameters ? ", tex, smp, float2(8, 8), 0.1" : "") + "), 1); }\n";
    if (target.starts_with("hlsl"))
        return (parameters ? "sampler2D tex : register(s0);\n" : "") + function +
               "float4 host_main(float2 at : TEXCOORD0) : COLOR0 { return float4(find(at, at.xyx" +
               (parameters ? ", tex, float2(8, 8), 0.1" : "") + "), 1); }\n";
    if (target == "glsl_120" || target == "essl_100") {
        const std::string head =
            target == "glsl_120" ? "#version 120\n#extension GL_ARB_shader_texture_lod : require\n"
                                 : "#version 100\n#extension GL_EXT_shader_texture_lod : require\n"
                                   "precision highp float;\n";
        return head + "varying vec2 at;\n" + (parameters ? "uniform sampler2D tex;\n" : "") +
               function + "void main() { gl_FragColor = vec4(find(at, at.xyx" +
               (parameters ? ", tex, vec2(8.0), 0.1" : "") + "), 1.0); }\n";
    }
    const std::string version =
        target == "glsl_450" ? "#version 450\nlayout(location = 0) in vec2 at;\n"
                               "layout(location = 0) out vec4 o;\n"
        : target == "glsl_330"
            ? "#version 330\nin vec2 at;\nout vec4 o;\n"
            : "#version 300 es\nprecision highp float;\nin vec2 at;\nout vec4 o;\n";
    const std::string sampler = target == "glsl_450"
                                    ? "layout(binding = 0) uniform sampler2D tex;\n"
                                    : "uniform sampler2D tex;\n";
    return version + (parameters ? sampler : "") + function +
           "void main() { o = vec4(find(at, at.xyx" + (parameters ? ", tex, vec2(8.0), 0.1" : "") +
           "), 1.0); }\n";
}

ir::Program as_program(const ir::Module& function) {
    ir::Program program;
    program.name = function.name;
    program.pixel = function;
    return program;
}

TEST(Functions, ArePastedIntoAForeignShader) {
    const ir::Module function = testing::parsed(function_text);
    for (const testing::TextTarget& target : testing::text_targets)
        for (Binding binding : {Binding::Parameters, Binding::Globals}) {
            const auto artifact =
                emit_function(as_program(function), *find_target(target.name), binding);
            ASSERT_TRUE(artifact.ok()) << to_string(artifact.error());
            EXPECT_EQ(artifact->entry, "find");
            const std::string shader = host(target.name, binding, artifact->text);
            const std::string entry =
                shader.find("host_main") != std::string::npos ? "host_main" : "main";
            const Status words =
                testing::accepted({target.language, check::Stage::Pixel, shader, entry, "host"});
            EXPECT_TRUE(words.ok()) << target.name << ": " << to_string(words.error()) << "\n"
                                    << shader;
        }
}

TEST(Functions, NameTheirParametersInOrder) {
    const ir::Module function = testing::parsed(function_text);
    const auto text = [&](std::string_view target, Binding binding) {
        return emit_function(as_program(function), *find_target(target), binding)->text;
    };
    EXPECT_THAT(
        text("glsl_330", Binding::Parameters),
        HasSubstr(
            "vec3 find(vec2 uv, vec3 view, sampler2D height_map, vec2 map_size, float scale) {\n"));
    EXPECT_THAT(text("hlsl_5_0", Binding::Parameters),
                HasSubstr("float3 find(float2 uv, float3 view, Texture2D height_map, SamplerState "
                          "height_map_sampler,\n"
                          "    float2 map_size, float scale) {\n"));
    EXPECT_THAT(text("essl_300", Binding::Globals),
                HasSubstr("uniform sampler2D height_map;  // height in red\n\nvec3 find(vec2 uv, "
                          "vec3 view) {\n"));
}

TEST(Functions, AreRefusedWhereThereIsNoTextToPasteInto) {
    for (std::string_view name : {"spirv", "msl", "none"}) {
        const auto artifact = emit_function(as_program(testing::parsed(function_text)),
                                            *find_target(name), Binding::Globals);
        ASSERT_FALSE(artifact.ok());
        EXPECT_EQ(artifact.error().code, "target-function");
    }
}

}  // namespace
}  // namespace intaglio
