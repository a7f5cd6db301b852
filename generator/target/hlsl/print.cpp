// The shells of HLSL stages and functions around the shared body printer.
//
// Both stages declare the same interpolants in the same order, the position last: Direct3D 11 links
// them by register in order of declaration, Direct3D 9 by semantic, and Vulkan (through glslang) by
// location in order of declaration.
#include <map>

#include <fmt/format.h>

#include "generator/target/clike/layout.h"
#include "generator/target/clike/shell.h"
#include "generator/target/clike/statements.h"
#include "generator/target/hlsl/dialect.h"

namespace intaglio::hlsl {
namespace {

std::string type_of(const Dialect& dialect, ir::Type type) {
    return std::string(
        clike::type_name(dialect.spelling, static_cast<int>(type.scalar), type.width));
}

std::string fill(std::string_view pattern, int number, std::string_view name, int dimension = 2) {
    return fmt::format(fmt::runtime(pattern), number, name, dimension);
}

std::string uniform_declaration(const Dialect& dialect, const ir::Uniform& uniform,
                                const std::string& name) {
    const std::string count = uniform.count > 1 ? fmt::format("[{}]", uniform.count) : "";
    return fmt::format("{} {}{}", type_of(dialect, uniform.type), name, count);
}

void put_uniforms(TextBuilder& out, const Dialect& dialect, const ir::Module& module,
                  const std::vector<std::string>& names, int slot, std::string_view block) {
    if (module.uniforms.empty()) return;
    const bool loose = dialect.uniform_block.empty();
    if (!loose) {
        out.line(fill(dialect.uniform_block, slot, block));
        out.indent();
    }
    for (std::size_t i = 0; i < names.size(); ++i)
        clike::put_declaration(out,
                               uniform_declaration(dialect, module.uniforms[i], names[i]) + ";",
                               module.uniforms[i].comment);
    if (!loose) {
        out.outdent();
        out.line("};");
    }
    out.line();
}

void put_samplers(TextBuilder& out, const Dialect& dialect, const ir::Module& module,
                  const std::vector<std::string>& names, const std::vector<int>& slots) {
    for (std::size_t i = 0; i < names.size(); ++i) {
        const ir::Sampler& sampler = module.samplers[i];
        clike::put_declaration(out, fill(dialect.texture, slots[i], names[i], sampler.dimension),
                               clike::sampler_comment(sampler));
        if (!dialect.sampler_state.empty())
            out.line(fill(dialect.sampler_state, slots[i], names[i]));
    }
    if (!names.empty()) out.line();
}

// Vertex attributes by name: what vertex declarations call them, and texture coordinates for all
// others.
class AttributeSemantics {
  public:
    std::string of(const std::string& name) {
        static const std::map<std::string, std::string, std::less<>> known = {
            {"position", "POSITION"},  {"normal", "NORMAL"}, {"tangent", "TANGENT"},
            {"bitangent", "BINORMAL"}, {"color", "COLOR0"},  {"colour", "COLOR0"}};
        const auto found = known.find(name);
        return found == known.end() ? fmt::format("TEXCOORD{}", texture_coordinates_++)
                                    : found->second;
    }

  private:
    int texture_coordinates_ = 0;
};

// "struct Attributes { ... };" and how the body reads its members.
std::vector<std::string> put_attributes(TextBuilder& out, const Dialect& dialect,
                                        const ir::Module& vertex) {
    std::vector<std::string> reads;
    if (vertex.inputs.empty()) return reads;
    clike::NameScope members;
    AttributeSemantics semantics;
    out.line("struct Attributes {");
    out.indent();
    for (const ir::Declaration& input : vertex.inputs) {
        const std::string name = members.declare(input.name);
        out.format("{} {} : {};", type_of(dialect, input.type), name, semantics.of(input.name));
        reads.push_back("vertex." + name);
    }
    out.outdent();
    out.line("};");
    out.line();
    return reads;
}

// The struct that both stages share; member names by the name in the DSL.
std::map<std::string, std::string> put_interpolants(TextBuilder& out, const Dialect& dialect,
                                                    const ir::Program& program, ir::Stage stage) {
    std::map<std::string, std::string> names;
    clike::NameScope members;
    const bool vertex = stage == ir::Stage::Vertex;
    const std::string_view precise = vertex ? dialect.spelling.precise : "";
    TextBuilder body;
    int coordinate = 0;
    const ir::Declaration* position = nullptr;
    for (const ir::Declaration& output : program.vertex.outputs) {
        if (output.semantic == ir::Semantic::Position) position = &output;
        if (output.semantic != ir::Semantic::Interpolant) continue;
        const std::string name = names[output.name] = members.declare(output.name);
        body.format("{}{} {} : TEXCOORD{};", precise, type_of(dialect, output.type), name,
                    coordinate++);
    }
    if (position) {
        const std::string name = members.declare(position->name);
        if (vertex) {
            // Keyed apart from an interpolant of the same name.
            names["position of " + position->name] = name;
            body.format("{}float4 {} : SV_Position;", precise, name);
        } else if (!dialect.pixel_position.empty()) {
            body.line(fill(dialect.pixel_position, 0, name));
        }
    }
    if (body.text().empty()) return names;
    out.line("struct Interpolants {");
    out.indent();
    std::string_view rest = body.text();
    while (!rest.empty()) {
        out.line(rest.substr(0, rest.find('\n')));
        rest.remove_prefix(rest.find('\n') + 1);
    }
    out.outdent();
    out.line("};");
    out.line();
    return names;
}

// One target alone is the return value; else the targets and the depth are a struct.
clike::Ending put_targets(TextBuilder& out, const Dialect& dialect, const ir::Module& pixel,
                          std::string& signature) {
    if (pixel.outputs.size() == 1) {
        signature = fmt::format("{} pixel_main({{}}) : SV_Target0 {{{{",
                                type_of(dialect, pixel.outputs[0].type));
        return {{}, {}, pixel.outputs[0].name, {}};
    }
    clike::NameScope members;
    clike::Ending ending;
    out.line("struct Targets {");
    out.indent();
    int targets = 0;
    for (const ir::Declaration& output : pixel.outputs) {
        if (output.semantic == ir::Semantic::Clip) {
            ending.stores.emplace_back("clip(%0);");
            continue;
        }
        const std::string name = members.declare(output.name);
        out.format("{}{} {} : {};", dialect.spelling.precise, type_of(dialect, output.type), name,
                   output.semantic == ir::Semantic::Depth ? "SV_Depth"
                                                          : fmt::format("SV_Target{}", targets++));
        ending.stores.push_back("result." + name);
    }
    out.outdent();
    out.line("};");
    out.line();
    signature = "Targets pixel_main({}) {{";
    ending.before = "Targets result;";
    ending.after = "return result;";
    return ending;
}

}  // namespace

Result<Artifact> print_stage(const Dialect& dialect, const ir::Program& program, ir::Stage stage) {
    const bool vertex = stage == ir::Stage::Vertex;
    const ir::Module& module = clike::stage_of(program, stage);
    const clike::InterfaceNames interface(program, "vertex_");
    clike::NameScope scope = interface.scope_of_uniforms(module);
    TextBuilder out;
    clike::put_header(out, program, stage, dialect.target);
    out.line();

    clike::OuterNames outer{{}, interface.of_uniforms(module), interface.of_samplers(module)};
    put_uniforms(out, dialect, module, outer.uniforms, vertex ? 0 : 1,
                 vertex ? "VertexUniforms" : "PixelUniforms");
    std::vector<int> slots;
    for (const ir::Sampler& sampler : module.samplers)
        slots.push_back(clike::sampler_slot(program, sampler.name));
    put_samplers(out, dialect, module, outer.samplers, slots);

    if (vertex) outer.inputs = put_attributes(out, dialect, module);
    std::map<std::string, std::string> members = put_interpolants(out, dialect, program, stage);
    clike::Ending ending;
    std::string signature = "Interpolants vertex_main({}) {{";
    if (vertex) {
        for (const ir::Declaration& output : module.outputs)
            ending.stores.push_back(
                "result." +
                members.at((output.semantic == ir::Semantic::Position ? "position of " : "") +
                           output.name));
        ending.before = "Interpolants result;";
        ending.after = "return result;";
    } else {
        for (const ir::Declaration& input : module.inputs) {
            const Result<int> found = clike::interpolant_location(program, input);
            if (!found) return found.error();
            outer.inputs.push_back("pixel." + members.at(input.name));
        }
        ending = put_targets(out, dialect, module, signature);
    }

    const std::string parameter =
        vertex ? (module.inputs.empty() ? "" : "Attributes vertex")
               : (members.empty() && module.inputs.empty() ? "" : "Interpolants pixel");
    out.line(fmt::format(fmt::runtime(signature), parameter));
    out.indent();
    scope.open();
    if (Status status = clike::print_body(out, module, dialect.spelling, outer, ending, scope);
        !status)
        return status.error();
    out.outdent();
    out.line("}");
    return Artifact{out.take(),
                    vertex ? "vertex_main" : "pixel_main",
                    stage,
                    vertex ? ".vert.hlsl" : ".frag.hlsl",
                    {}};
}

Result<Artifact> print_function(const Dialect& dialect, const ir::Program& program,
                                Binding binding) {
    const ir::Module& function = program.pixel;
    auto [name, scope, outer] = clike::names_of_function(function);

    TextBuilder out;
    clike::put_header(out, program, ir::Stage::Function, dialect.target);
    std::vector<std::string> parameters;
    for (std::size_t i = 0; i < outer.inputs.size(); ++i)
        parameters.push_back(
            fmt::format("{} {}", type_of(dialect, function.inputs[i].type), outer.inputs[i]));
    if (binding == Binding::Globals) {
        put_uniforms(out, dialect, function, outer.uniforms, 1, "PixelUniforms");
        std::vector<int> slots;
        for (std::size_t i = 0; i < outer.samplers.size(); ++i)
            slots.push_back(static_cast<int>(i));
        put_samplers(out, dialect, function, outer.samplers, slots);
    } else {
        for (std::size_t i = 0; i < outer.samplers.size(); ++i) {
            const ir::Sampler& sampler = function.samplers[i];
            parameters.push_back(
                fill(dialect.texture_parameter, 0, outer.samplers[i], sampler.dimension));
            if (const std::string comment = clike::sampler_comment(sampler); !comment.empty())
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
    if (Status status = clike::print_body(out, function, dialect.spelling, outer, ending, scope);
        !status)
        return status.error();
    out.outdent();
    out.line("}");
    return Artifact{out.take(), name, ir::Stage::Function, ".hlsl", {}};
}

}  // namespace intaglio::hlsl
