// The shells of GLSL stages and functions around the shared body printer.
#include <algorithm>

#include <fmt/format.h>

#include "generator/target/clike/layout.h"
#include "generator/target/clike/shell.h"
#include "generator/target/clike/statements.h"
#include "generator/target/glsl/dialect.h"

namespace intaglio::glsl {
namespace {

using clike::Kind;

// Bindings in set 0: the block of each stage's uniforms, then the samplers.
constexpr int vertex_uniforms_binding = 0, pixel_uniforms_binding = 1, first_sampler_binding = 2;

std::string type_of(const Dialect& dialect, ir::Type type) {
    return std::string(
        clike::type_name(dialect.spelling, static_cast<int>(type.scalar), type.width));
}

std::string fill(std::string_view pattern, int number, std::string_view type,
                 std::string_view name) {
    return fmt::format(fmt::runtime(pattern), number, type, name);
}

std::string uniform_declaration(const Dialect& dialect, const ir::Uniform& uniform,
                                const std::string& name) {
    const std::string count = uniform.count > 1 ? fmt::format("[{}]", uniform.count) : "";
    return fmt::format("{} {}{}", type_of(dialect, uniform.type), name, count);
}

std::string_view sampler_type(const ir::Sampler& sampler) {
    return sampler.dimension == 3 ? "sampler3D" : "sampler2D";
}

void put_uniforms(TextBuilder& out, const Dialect& dialect, const ir::Module& module,
                  const std::vector<std::string>& names, int binding, std::string_view block,
                  std::string_view instance = {}) {
    if (module.uniforms.empty()) return;
    const bool loose = dialect.uniform_block.empty();
    if (!loose) {
        out.line(fmt::format(fmt::runtime(dialect.uniform_block), binding, block));
        out.indent();
    }
    for (std::size_t i = 0; i < names.size(); ++i)
        clike::put_declaration(
            out,
            fmt::format("{}{};", loose ? "uniform " : "",
                        uniform_declaration(dialect, module.uniforms[i], names[i])),
            module.uniforms[i].comment);
    if (!loose) {
        out.outdent();
        out.format("}}{}{};", instance.empty() ? "" : " ", instance);
    }
}

// GLSL lets no two blocks of a program have a member of one name, unless one of them is an instance
// with a name.
bool stages_share_a_uniform(const ir::Program& program) {
    const auto& pixel = program.pixel.uniforms;
    return std::any_of(pixel.begin(), pixel.end(), [&](const ir::Uniform& a) {
        const auto& vertex = program.vertex.uniforms;
        return std::any_of(vertex.begin(), vertex.end(),
                           [&](const ir::Uniform& b) { return a.name == b.name; });
    });
}

bool contains(const ir::Region& region, bool (*wanted)(ir::Op)) {
    return std::any_of(
        region.body.begin(), region.body.end(), [&](const ir::Instruction& instruction) {
            return wanted(instruction.op) ||
                   std::any_of(instruction.regions.begin(), instruction.regions.end(),
                               [&](const ir::Region& inner) { return contains(inner, wanted); });
        });
}

// The lines that what the module reads and derives needs before everything else.
std::vector<std::string_view> extensions(const Dialect& dialect, const ir::Module& module) {
    std::vector<std::string_view> lines;
    const bool vertex = module.stage == ir::Stage::Vertex;
    const auto gradient = [](ir::Op op) { return op == ir::Op::SampleGrad; };
    const auto level = [](ir::Op op) { return op == ir::Op::SampleLevel; };
    const auto derivative = [](ir::Op op) { return op == ir::Op::Ddx || op == ir::Op::Ddy; };
    if (!dialect.explicit_read_extension.empty() &&
        (contains(module.body, gradient) || (!vertex && contains(module.body, level))))
        lines.push_back(dialect.explicit_read_extension);
    if (!dialect.derivative_extension.empty() && contains(module.body, derivative))
        lines.push_back(dialect.derivative_extension);
    const bool depth = std::any_of(
        module.outputs.begin(), module.outputs.end(),
        [](const ir::Declaration& output) { return output.semantic == ir::Semantic::Depth; });
    if (depth && !dialect.depth_extension.empty()) lines.push_back(dialect.depth_extension);
    return lines;
}

void put_head(TextBuilder& out, const Dialect& dialect, const ir::Program& program,
              ir::Stage stage) {
    const ir::Module& module = clike::stage_of(program, stage);
    out.line(dialect.version);
    if (!dialect.rolled_loop_extension.empty() && clike::has_rolled_loop(module.body))
        out.line(dialect.rolled_loop_extension);
    for (std::string_view line : extensions(dialect, module)) out.line(line);
    out.line();
    clike::put_header(out, program, stage, dialect.target);
    out.line();
    if (dialect.default_precision.empty()) return;
    out.line(dialect.default_precision);
    for (const ir::Sampler& sampler : module.samplers)
        if (sampler.dimension == 3 && !dialect.volume_precision.empty()) {
            out.line(dialect.volume_precision);
            break;
        }
    out.line();
}

// gl_FragColor and gl_FragData[n] are vec4; a narrower target writes the first components.
std::string built_in_target(const ir::Module& module, int location, ir::Type type) {
    const auto targets = std::count_if(
        module.outputs.begin(), module.outputs.end(),
        [](const ir::Declaration& output) { return output.semantic == ir::Semantic::Target; });
    const std::string name =
        targets == 1 ? "gl_FragColor" : fmt::format("gl_FragData[{}]", location);
    if (type.width == 4) return name;
    return fmt::format("{}.{}", name,
                       std::string_view("xyz").substr(0, static_cast<std::size_t>(type.width)));
}

// Declares inputs; their names as the body reads them.
Result<std::vector<std::string>> put_inputs(TextBuilder& out, const Dialect& dialect,
                                            const ir::Program& program, ir::Stage stage,
                                            const clike::InterfaceNames& interface) {
    std::vector<std::string> names;
    int attribute = 0;
    for (const ir::Declaration& input : clike::stage_of(program, stage).inputs) {
        int location = attribute++;
        const bool pixel = stage == ir::Stage::Pixel;
        if (pixel) {
            const Result<int> found = clike::interpolant_location(program, input);
            if (!found) return found.error();
            location = *found;
        }
        names.push_back(interface.of(pixel ? Kind::Interpolant : Kind::Attribute, input.name));
        out.line(fill(pixel ? dialect.pixel_input : dialect.attribute, location,
                      type_of(dialect, input.type), names.back()));
    }
    if (!names.empty()) out.line();
    return names;
}

std::vector<std::string> put_outputs(TextBuilder& out, const Dialect& dialect,
                                     const ir::Module& module,
                                     const clike::InterfaceNames& interface) {
    std::vector<std::string> names;
    int location = 0;
    bool declared = false;
    for (const ir::Declaration& output : module.outputs) {
        if (output.semantic == ir::Semantic::Position) {
            names.push_back("gl_Position");
            if (dialect.position.empty()) continue;
            out.line(dialect.position);
            declared = true;
            continue;
        }
        if (output.semantic == ir::Semantic::Depth) {
            names.push_back(fmt::format("{} = %0;", dialect.depth));
            continue;
        }
        if (output.semantic == ir::Semantic::Clip) {
            names.emplace_back("if (%0 < 0.0) discard;");
            continue;
        }
        const bool colour = output.semantic == ir::Semantic::Target;
        if (colour && dialect.colour_target.empty()) {
            names.push_back(built_in_target(module, location++, output.type));
            continue;
        }
        names.push_back(interface.of(colour ? Kind::Target : Kind::Interpolant, output.name));
        out.line(fill(colour ? dialect.colour_target : dialect.vertex_output, location++,
                      type_of(dialect, output.type), names.back()));
        declared = true;
    }
    if (declared) out.line();
    return names;
}

void put_samplers(TextBuilder& out, const Dialect& dialect, const ir::Module& module,
                  const std::vector<std::string>& names, const std::vector<int>& slots) {
    for (std::size_t i = 0; i < names.size(); ++i)
        clike::put_declaration(out,
                               fill(dialect.sampler, first_sampler_binding + slots[i],
                                    sampler_type(module.samplers[i]), names[i]),
                               clike::sampler_comment(module.samplers[i]));
}

}  // namespace

Result<Artifact> print_stage(const Dialect& dialect, const ir::Program& program, ir::Stage stage) {
    if (dialect.uniform_block.empty())
        if (Status status = clike::check_shared_uniforms(program); !status) return status.error();
    const bool vertex = stage == ir::Stage::Vertex;
    const ir::Module& module = clike::stage_of(program, stage);
    const clike::InterfaceNames interface(program, "vertex_");
    TextBuilder out;
    put_head(out, dialect, program, stage);

    Result<std::vector<std::string>> inputs = put_inputs(out, dialect, program, stage, interface);
    if (!inputs) return inputs.error();
    clike::OuterNames outer{std::move(*inputs), interface.of_uniforms(module),
                            interface.of_samplers(module)};
    clike::NameScope scope = interface.scope_of(program, stage);
    if (vertex && !dialect.uniform_block.empty() && stages_share_a_uniform(program)) {
        const std::string instance = scope.declare("vertex_uniforms");
        put_uniforms(out, dialect, module, outer.uniforms, vertex_uniforms_binding,
                     "VertexUniforms", instance);
        for (std::string& name : outer.uniforms) name = fmt::format("{}.{}", instance, name);
    } else {
        put_uniforms(out, dialect, module, outer.uniforms,
                     vertex ? vertex_uniforms_binding : pixel_uniforms_binding,
                     vertex ? "VertexUniforms" : "PixelUniforms");
    }
    std::vector<int> slots;
    for (const ir::Sampler& sampler : module.samplers)
        slots.push_back(clike::sampler_slot(program, sampler.name));
    put_samplers(out, dialect, module, outer.samplers, slots);
    if (!module.uniforms.empty() || !module.samplers.empty()) out.line();
    const clike::Ending ending{{}, put_outputs(out, dialect, module, interface), {}, {}};

    out.line("void main() {");
    out.indent();
    scope.open();
    const clike::Spelling& spelling = vertex ? dialect.vertex_spelling : dialect.spelling;
    if (Status status = clike::print_body(out, module, spelling, outer, ending, scope); !status)
        return status.error();
    out.outdent();
    out.line("}");
    return Artifact{out.take(), "main", stage, vertex ? ".vert" : ".frag", {}};
}

Result<Artifact> print_function(const Dialect& dialect, const ir::Program& program,
                                Binding binding) {
    const ir::Module& function = program.pixel;
    auto [name, scope, outer] = clike::names_of_function(function);

    TextBuilder out;
    clike::put_header(out, program, ir::Stage::Function, dialect.target);
    for (std::string_view line : extensions(dialect, function))
        clike::put_comment(out, fmt::format("The shader around it needs: {}", line));
    std::vector<std::string> parameters;
    for (std::size_t i = 0; i < outer.inputs.size(); ++i)
        parameters.push_back(
            fmt::format("{} {}", type_of(dialect, function.inputs[i].type), outer.inputs[i]));
    if (binding == Binding::Globals) {
        put_uniforms(out, dialect, function, outer.uniforms, pixel_uniforms_binding,
                     "PixelUniforms");
        std::vector<int> slots;
        for (std::size_t i = 0; i < outer.samplers.size(); ++i)
            slots.push_back(static_cast<int>(i));
        put_samplers(out, dialect, function, outer.samplers, slots);
        if (!outer.uniforms.empty() || !outer.samplers.empty()) out.line();
    } else {
        for (std::size_t i = 0; i < outer.samplers.size(); ++i) {
            parameters.push_back(
                fmt::format("{} {}", sampler_type(function.samplers[i]), outer.samplers[i]));
            if (const std::string comment = clike::sampler_comment(function.samplers[i]);
                !comment.empty())
                clike::put_comment(out, fmt::format("{}: {}", outer.samplers[i], comment));
        }
        for (std::size_t i = 0; i < outer.uniforms.size(); ++i) {
            parameters.push_back(
                uniform_declaration(dialect, function.uniforms[i], outer.uniforms[i]));
            if (!function.uniforms[i].comment.empty())
                clike::put_comment(
                    out, fmt::format("{}: {}", outer.uniforms[i], function.uniforms[i].comment));
        }
    }

    const std::string type = type_of(dialect, function.outputs[0].type);
    clike::put_statement(out, fmt::format("{} {}({}) {{", type, name, fmt::join(parameters, ", ")));
    out.indent();
    scope.open();
    const clike::Ending ending{{}, {}, function.outputs[0].name, {}};
    if (Status status =
            clike::print_body(out, function, dialect.function_spelling, outer, ending, scope);
        !status)
        return status.error();
    out.outdent();
    out.line("}");
    return Artifact{out.take(), name, ir::Stage::Function, ".glsl", {}};
}

}  // namespace intaglio::glsl
