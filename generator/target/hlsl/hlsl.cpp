// The rows of the HLSL family.  Sources: Microsoft's HLSL reference; what fxc (d3dcompiler_47)
// accepts was tried: SV_Position and SV_TargetN become position and oCn in vs_3_0 and ps_3_0,
// `precise` is accepted there too.
#include "generator/target/hlsl/hlsl.h"

#include <array>

#include "generator/target/hlsl/dialect.h"
#include "generator/target/limits.h"
#include "generator/target/replace_scalar_dots.h"
#include "generator/target/use_hardware_levels.h"

namespace intaglio {
namespace {

using clike::Binds;
using ir::Op;

constexpr std::array common_ops = std::to_array<clike::OpSpelling>({
    {Op::Add, "%0 + %1", Binds::Sum, "01"},
    {Op::Sub, "%0 - %1", Binds::Sum, "01"},
    {Op::Mul, "%0 * %1", Binds::Product, "01"},
    {Op::Div, "%0 / %1", Binds::Product, "01"},
    {Op::Neg, "-%0", Binds::Prefix},
    {Op::Abs, "abs(%0)"},
    {Op::Min, "min(%0, %1)", Binds::Postfix, "1"},
    {Op::Max, "max(%0, %1)", Binds::Postfix, "1"},
    {Op::Saturate, "saturate(%0)"},
    {Op::Floor, "floor(%0)"},
    {Op::Frac, "frac(%0)"},
    {Op::Sqrt, "sqrt(%0)"},
    {Op::Rsqrt, "rsqrt(%0)"},
    {Op::Exp2, "exp2(%0)"},
    {Op::Log2, "log2(%0)"},
    {Op::Pow, "pow(%0, %1)"},
    {Op::Sin, "sin(%0)"},
    {Op::Cos, "cos(%0)"},
    {Op::Lerp, "lerp(%0, %1, %2)", Binds::Postfix, "2"},
    {Op::Dot, "dot(%0, %1)"},
    {Op::Cross, "cross(%0, %1)"},
    {Op::Less, "%0 < %1", Binds::Relation},
    {Op::LessEqual, "%0 <= %1", Binds::Relation},
    {Op::Greater, "%0 > %1", Binds::Relation},
    {Op::GreaterEqual, "%0 >= %1", Binds::Relation},
    {Op::Equal, "%0 == %1", Binds::Equality},
    {Op::NotEqual, "%0 != %1", Binds::Equality},
    {Op::And, "%0 && %1", Binds::LogicalAnd},
    {Op::Or, "%0 || %1", Binds::LogicalOr},
    {Op::Not, "!%0", Binds::Prefix},
    {Op::Select, "%0 ? %1 : %2", Binds::Ternary},
    {Op::ToFloat, "%t(%0)"},
    {Op::Ddx, "ddx(%0)"},
    {Op::Ddy, "ddy(%0)"},
});

constexpr std::array reads_5_0 = std::to_array<clike::OpSpelling>({
    {Op::SampleLevel, "%s.SampleLevel(%s_sampler, %0, %1)"},
    {Op::SampleGrad, "%s.SampleGrad(%s_sampler, %0, %1, %2)"},
    {Op::SampleImplicit, "%s.Sample(%s_sampler, %0)"},
});

constexpr std::array reads_3_0 = std::to_array<clike::OpSpelling>({
    {Op::SampleLevel, "tex2Dlod(%s, float4(%0, 0.0, %1))", Binds::Postfix, {}, 2},
    {Op::SampleLevel, "tex3Dlod(%s, float4(%0, %1))", Binds::Postfix, {}, 3},
    {Op::SampleGrad, "tex2Dgrad(%s, %0, %1, %2)", Binds::Postfix, {}, 2},
    {Op::SampleGrad, "tex3Dgrad(%s, %0, %1, %2)", Binds::Postfix, {}, 3},
    {Op::SampleImplicit, "tex2D(%s, %0)", Binds::Postfix, {}, 2},
    {Op::SampleImplicit, "tex3D(%s, %0)", Binds::Postfix, {}, 3},
});

// The level is the hardware's choice.
constexpr std::array reads_2_x = std::to_array<clike::OpSpelling>({
    {Op::SampleImplicit, "tex2D(%s, %0)", Binds::Postfix, {}, 2},
    {Op::SampleImplicit, "tex3D(%s, %0)", Binds::Postfix, {}, 3},
});

constexpr std::array ops_5_0 = clike::join(common_ops, reads_5_0);
constexpr std::array ops_3_0 = clike::join(common_ops, reads_3_0);
constexpr std::array ops_2_x = clike::join(common_ops, reads_2_x);

constexpr clike::Spelling spelling(std::span<const clike::OpSpelling> ops,
                                   std::string_view float_from_bits) {
    return {.ops = ops,
            .types = {{{"bool", "bool2", "bool3", "bool4"},
                       {"int", "int2", "int3", "int4"},
                       {"float", "float2", "float3", "float4"}}},
            .splat = {Op::Swizzle, "(%t)%0", Binds::Prefix},
            .float_from_bits = float_from_bits,
            .rolled_loop = "[loop] ",
            .precise = "precise "};
}

const hlsl::Dialect dialect_5_0 = {
    .target = hlsl_5_0,
    .spelling = spelling(ops_5_0, "asfloat(%0)"),
    .texture = "Texture{2}D {1} : register(t{0});",
    .sampler_state = "SamplerState {1}_sampler : register(s{0});",
    .texture_parameter = "Texture{2}D {1}, SamplerState {1}_sampler",
    .uniform_block = "cbuffer {1} : register(b{0}) {{",
    .pixel_position = "float4 {1} : SV_Position;",
};

// In ps_3_0 a position input would be the pixel's own (VPOS), and takes no part in linking the
// stages.
constexpr hlsl::Dialect direct3d_9_dialect(const Target& target,
                                           std::span<const clike::OpSpelling> ops) {
    return {.target = target,
            .spelling = spelling(ops, {}),
            .texture = "sampler{2}D {1} : register(s{0});",
            .sampler_state = {},
            .texture_parameter = "sampler{2}D {1}",
            .uniform_block = {},
            .pixel_position = {}};
}

const hlsl::Dialect dialect_3_0 = direct3d_9_dialect(hlsl_3_0, ops_3_0);

// Slots are scarce here, and fxc pays for `precise` with them: 66 arithmetic instead of 57 for the
// eight taps of parallax occlusion, where ps_2_0 has 64.
constexpr hlsl::Dialect shader_model_2_dialect(const Target& target) {
    hlsl::Dialect made = direct3d_9_dialect(target, ops_2_x);
    made.spelling.precise = {};
    return made;
}

const hlsl::Dialect dialect_2_b = shader_model_2_dialect(hlsl_2_b);
const hlsl::Dialect dialect_2_0 = shader_model_2_dialect(hlsl_2_0);

template <const hlsl::Dialect& dialect>
Result<Artifact> print(const ir::Program& program, ir::Stage stage) {
    return hlsl::print_stage(dialect, program, stage);
}

template <const hlsl::Dialect& dialect>
Result<Artifact> print_function(const ir::Program& program, Binding binding) {
    return hlsl::print_function(dialect, program, binding);
}

// loop_trips of hlsl_3_0: `rep` counts to 255, and fxc silently ends a longer loop with an early
// exit there; one without an exit it refuses from 255 on (X3569).
constexpr LegalizingPass legalizing[] = {check_limits_pass, replace_scalar_dots_pass};
constexpr LegalizingPass legalizing_2_x[] = {use_hardware_levels_pass, check_limits_pass,
                                             replace_scalar_dots_pass};

// What the profiles 2_0 and 2_b cannot say at all; the compiler counts the other slots.
Capabilities shader_model_2(int texture_reads) {
    return {.loops = false,
            .branches = false,
            .derivatives = false,
            .texture_levels = false,
            .texture_gradients = false,
            .vertex_textures = false,
            .colour_targets = 4,
            .texture_reads = texture_reads,
            .interpolants = {8, 32}};
}

}  // namespace

const Target hlsl_5_0 = {
    .name = "hlsl_5_0",
    .description = "HLSL for vs_5_0 and ps_5_0: Texture2D, SamplerState, constant buffers",
    .derived_from = {},
    .capabilities = {.precise = true, .interpolants = {31, 124}},
    .legalize = legalizing,
    .print = print<dialect_5_0>,
    .print_function = print_function<dialect_5_0>,
};

const Target hlsl_3_0 = {
    .name = "hlsl_3_0",
    .description = "HLSL for vs_3_0 and ps_3_0 (Direct3D 9): sampler2D, tex2Dlod, loose uniforms",
    .derived_from = {},
    .capabilities = {.precise = true,
                     .colour_targets = 4,
                     .loop_trips = 254,
                     .interpolants = {10, 40}},
    .legalize = legalizing,
    .print = print<dialect_3_0>,
    .print_function = print_function<dialect_3_0>,
};

const Target hlsl_2_b = {
    .name = "hlsl_2_b",
    .description = "HLSL for vs_2_0 and ps_2_b (Direct3D 9): no loops, no branches, plain tex2D",
    .derived_from = {},
    .capabilities = shader_model_2(512),
    .legalize = legalizing_2_x,
    .print = print<dialect_2_b>,
    .print_function = print_function<dialect_2_b>,
};

const Target hlsl_2_0 = {
    .name = "hlsl_2_0",
    .description = "HLSL for vs_2_0 and ps_2_0 (Direct3D 9): as hlsl_2_b, 32 texture reads",
    .derived_from = {},
    .capabilities = shader_model_2(32),
    .legalize = legalizing_2_x,
    .print = print<dialect_2_0>,
    .print_function = print_function<dialect_2_0>,
};

}  // namespace intaglio
