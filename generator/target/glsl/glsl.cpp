// The rows of the GLSL family.  Sources: The OpenGL Shading Language 4.60 and 3.30, GLSL ES 3.00,
// GL_KHR_vulkan_glsl, GL_EXT_control_flow_attributes; The OpenGL Shading Language 1.20,
// GL_ARB_shader_texture_lod; GLSL ES 1.00 with its appendix A, GL_EXT_shader_texture_lod,
// GL_OES_standard_derivatives.
#include "generator/target/glsl/glsl.h"

#include <array>

#include "generator/target/glsl/dialect.h"
#include "generator/target/limits.h"
#include "generator/target/replace_int_functions.h"
#include "generator/target/replace_scalar_dots.h"

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
    {Op::Saturate, "clamp(%0, 0.0, 1.0)"},
    {Op::Floor, "floor(%0)"},
    {Op::Frac, "fract(%0)"},
    {Op::Sqrt, "sqrt(%0)"},
    {Op::Rsqrt, "inversesqrt(%0)"},
    {Op::Exp2, "exp2(%0)"},
    {Op::Log2, "log2(%0)"},
    {Op::Pow, "pow(%0, %1)"},
    {Op::Sin, "sin(%0)"},
    {Op::Cos, "cos(%0)"},
    {Op::Lerp, "mix(%0, %1, %2)", Binds::Postfix, "2"},
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
    {Op::Ddx, "dFdx(%0)"},
    {Op::Ddy, "dFdy(%0)"},
});

constexpr std::array reads = std::to_array<clike::OpSpelling>({
    {Op::SampleLevel, "textureLod(%s, %0, %1)"},
    {Op::SampleGrad, "textureGrad(%s, %0, %1, %2)"},
    {Op::SampleImplicit, "texture(%s, %0)"},
});

// The ARB extension brings texture2DLod to the pixel stage by its plain name.
constexpr std::array reads_120 = std::to_array<clike::OpSpelling>({
    {Op::SampleLevel, "texture2DLod(%s, %0, %1)", Binds::Postfix, {}, 2},
    {Op::SampleLevel, "texture3DLod(%s, %0, %1)", Binds::Postfix, {}, 3},
    {Op::SampleGrad, "texture2DGradARB(%s, %0, %1, %2)", Binds::Postfix, {}, 2},
    {Op::SampleGrad, "texture3DGradARB(%s, %0, %1, %2)", Binds::Postfix, {}, 3},
    {Op::SampleImplicit, "texture2D(%s, %0)", Binds::Postfix, {}, 2},
    {Op::SampleImplicit, "texture3D(%s, %0)", Binds::Postfix, {}, 3},
});

constexpr std::array reads_100_es = std::to_array<clike::OpSpelling>({
    {Op::SampleLevel, "texture2DLodEXT(%s, %0, %1)"},
    {Op::SampleGrad, "texture2DGradEXT(%s, %0, %1, %2)"},
    {Op::SampleImplicit, "texture2D(%s, %0)"},
});

constexpr std::array vertex_reads_100_es = std::to_array<clike::OpSpelling>({
    {Op::SampleLevel, "texture2DLod(%s, %0, %1)"},
});

constexpr std::array ops = clike::join(common_ops, reads);
constexpr std::array ops_120 = clike::join(common_ops, reads_120);
constexpr std::array ops_100_es = clike::join(common_ops, reads_100_es);
constexpr std::array vertex_ops_100_es = clike::join(common_ops, vertex_reads_100_es);

constexpr clike::Spelling spelling(std::string_view rolled_loop, std::string_view precise,
                                   std::span<const clike::OpSpelling> rows = ops) {
    return {.ops = rows,
            .types = {{{"bool", "bvec2", "bvec3", "bvec4"},
                       {"int", "ivec2", "ivec3", "ivec4"},
                       {"float", "vec2", "vec3", "vec4"}}},
            .splat = {Op::Swizzle, "%t(%0)"},
            .float_from_bits = "uintBitsToFloat(%0)",
            .rolled_loop = rolled_loop,
            .precise = precise};
}

const glsl::Dialect dialect_450 = {
    .target = glsl_450,
    .spelling = spelling("[[dont_unroll]] ", "precise "),
    .vertex_spelling = spelling("[[dont_unroll]] ", "precise "),
    .function_spelling = spelling("", "precise "),
    .version = "#version 450",
    .rolled_loop_extension = "#extension GL_EXT_control_flow_attributes : require",
    .default_precision = {},
    .volume_precision = {},
    .attribute = "layout(location = {0}) in {1} {2};",
    .vertex_output = "layout(location = {0}) precise out {1} {2};",
    .position = "precise gl_Position;",
    .pixel_input = "layout(location = {0}) in {1} {2};",
    .colour_target = "layout(location = {0}) precise out {1} {2};",
    .sampler = "layout(set = 0, binding = {0}) uniform {1} {2};",
    .uniform_block = "layout(set = 0, binding = {0}, std140) uniform {1} {{",
};

// uintBitsToFloat is GLSL 3.30's and ESSL 3.00's own.  Neither knows `precise` or loop hints.
constexpr glsl::Dialect plain_dialect(const Target& target, std::string_view version,
                                      std::string_view default_precision,
                                      std::string_view volume_precision) {
    return {.target = target,
            .spelling = spelling("", ""),
            .vertex_spelling = spelling("", ""),
            .function_spelling = spelling("", ""),
            .version = version,
            .rolled_loop_extension = {},
            .default_precision = default_precision,
            .volume_precision = volume_precision,
            .attribute = "layout(location = {0}) in {1} {2};",
            .vertex_output = "out {1} {2};",
            .position = {},
            .pixel_input = "in {1} {2};",
            .colour_target = "layout(location = {0}) out {1} {2};",
            .sampler = "uniform {1} {2};",
            .uniform_block = {}};
}

const glsl::Dialect dialect_330 = plain_dialect(glsl_330, "#version 330 core", {}, {});
const glsl::Dialect dialect_300_es =
    plain_dialect(essl_300, "#version 300 es",
                  "precision highp float;\nprecision highp int;\nprecision highp sampler2D;",
                  "precision highp sampler3D;");

// GLSL 1.20 and ES 1.00 have no way to write an infinity.  Appendix A of the latter allows
// `index++` at the end of a loop's head and not `++index`.
constexpr clike::Spelling old_spelling(std::span<const clike::OpSpelling> rows) {
    clike::Spelling made = spelling("", "", rows);
    made.float_from_bits = {};
    made.next_index = "%0++";
    return made;
}

constexpr glsl::Dialect old_dialect(const Target& target, std::string_view version,
                                    std::span<const clike::OpSpelling> rows,
                                    std::span<const clike::OpSpelling> vertex_rows) {
    glsl::Dialect made = plain_dialect(target, version, {}, {});
    made.spelling = made.function_spelling = old_spelling(rows);
    made.vertex_spelling = old_spelling(vertex_rows);
    made.attribute = "attribute {1} {2};";
    made.vertex_output = made.pixel_input = "varying {1} {2};";
    made.colour_target = {};
    return made;
}

const glsl::Dialect dialect_120 = [] {
    glsl::Dialect made = old_dialect(glsl_120, "#version 120", ops_120, ops_120);
    made.explicit_read_extension = "#extension GL_ARB_shader_texture_lod : require";
    return made;
}();
const glsl::Dialect dialect_100_es = [] {
    glsl::Dialect made = old_dialect(essl_100, "#version 100", ops_100_es, vertex_ops_100_es);
    made.default_precision =
        "precision highp float;\nprecision highp int;\nprecision highp sampler2D;";
    made.explicit_read_extension = "#extension GL_EXT_shader_texture_lod : require";
    made.derivative_extension = "#extension GL_OES_standard_derivatives : require";
    made.depth = "gl_FragDepthEXT";
    made.depth_extension = "#extension GL_EXT_frag_depth : require";
    return made;
}();

template <const glsl::Dialect& dialect>
Result<Artifact> print(const ir::Program& program, ir::Stage stage) {
    return glsl::print_stage(dialect, program, stage);
}

template <const glsl::Dialect& dialect>
Result<Artifact> print_function(const ir::Program& program, Binding binding) {
    return glsl::print_function(dialect, program, binding);
}

constexpr LegalizingPass legalizing[] = {check_limits_pass, replace_scalar_dots_pass};
constexpr LegalizingPass old_legalizing[] = {check_limits_pass, replace_scalar_dots_pass,
                                             replace_int_functions_pass};

}  // namespace

const Target glsl_450 = {
    .name = "glsl_450",
    .description = "GLSL 4.50 for Vulkan: uniform blocks, explicit bindings and locations",
    .derived_from = {},
    .capabilities = {.precise = true, .interpolants = {15, 60}},
    .legalize = legalizing,
    .print = print<dialect_450>,
    .print_function = print_function<dialect_450>,
};

const Target glsl_330 = {
    .name = "glsl_330",
    .description = "GLSL 3.30 for desktop OpenGL: loose uniforms, names shared by the stages",
    .derived_from = {},
    .capabilities = {.interpolants = {15, 60}},
    .legalize = legalizing,
    .print = print<dialect_330>,
    .print_function = print_function<dialect_330>,
};

const Target glsl_120 = {
    .name = "glsl_120",
    .description = "GLSL 1.20 for OpenGL 2.1: attribute, varying, gl_FragColor",
    .derived_from = {},
    .capabilities = {.colour_targets = 4, .interpolants = {8, 32}},
    .legalize = old_legalizing,
    .print = print<dialect_120>,
    .print_function = print_function<dialect_120>,
};

const Target essl_300 = {
    .name = "essl_300",
    .description = "GLSL ES 3.00 for WebGL 2 and OpenGL ES 3: high precision throughout",
    .derived_from = {},
    .capabilities = {.colour_targets = 4, .interpolants = {15, 60}},
    .legalize = legalizing,
    .print = print<dialect_300_es>,
    .print_function = print_function<dialect_300_es>,
};

const Target essl_100 = {
    .name = "essl_100",
    .description = "GLSL ES 1.00 for WebGL 1 and OpenGL ES 2: constant loops, one colour",
    .derived_from = {},
    .capabilities = {.volume_textures = false, .colour_targets = 1, .interpolants = {8, 32}},
    .legalize = old_legalizing,
    .print = print<dialect_100_es>,
    .print_function = print_function<dialect_100_es>,
};

}  // namespace intaglio
