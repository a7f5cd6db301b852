// Names are handed out in one order for both stages: interpolants first, so that the pixel stage
// keeps the DSL's.
#include "generator/target/clike/shell.h"

#include <algorithm>

#include <fmt/format.h>

#include "generator/target/clike/layout.h"

namespace intaglio::clike {

std::string declare_sampler(NameScope& scope, std::string_view wanted) {
    std::string name = scope.declare(wanted);
    while (scope.visible(name + "_sampler")) name = scope.declare(wanted);
    scope.declare(name + "_sampler");
    return name;
}

void InterfaceNames::declare(Kind kind, const std::string& dsl_name, std::string_view prefix) {
    std::string& name = names_[{kind, dsl_name}];
    if (!name.empty()) return;
    name = kind == Kind::Sampler ? declare_sampler(scope_, dsl_name)
                                 : scope_.declare(fmt::format("{}{}", prefix, dsl_name));
}

InterfaceNames::InterfaceNames(const ir::Program& program, std::string_view attribute_prefix) {
    const ir::Module& vertex = program.vertex;
    const ir::Module& pixel = program.pixel;
    for (const ir::Declaration& output : vertex.outputs)
        if (output.semantic == ir::Semantic::Interpolant) declare(Kind::Interpolant, output.name);
    for (const ir::Module* module : {&pixel, &vertex}) {
        for (const ir::Uniform& uniform : module->uniforms) declare(Kind::Uniform, uniform.name);
        for (const ir::Sampler& sampler : module->samplers) declare(Kind::Sampler, sampler.name);
    }
    for (const ir::Declaration& output : pixel.outputs)
        if (output.semantic == ir::Semantic::Target) declare(Kind::Target, output.name);
    for (const ir::Declaration& input : vertex.inputs)
        if (input.semantic == ir::Semantic::Attribute)
            declare(Kind::Attribute, input.name, attribute_prefix);
}

std::vector<std::string> InterfaceNames::of_uniforms(const ir::Module& module) const {
    std::vector<std::string> names;
    for (const ir::Uniform& uniform : module.uniforms)
        names.push_back(of(Kind::Uniform, uniform.name));
    return names;
}

std::vector<std::string> InterfaceNames::of_samplers(const ir::Module& module) const {
    std::vector<std::string> names;
    for (const ir::Sampler& sampler : module.samplers)
        names.push_back(of(Kind::Sampler, sampler.name));
    return names;
}

NameScope InterfaceNames::scope_of_uniforms(const ir::Module& module) const {
    NameScope scope;
    for (const std::string& name : of_uniforms(module)) scope.take(name);
    for (const std::string& name : of_samplers(module)) {
        scope.take(name);
        scope.take(name + "_sampler");
    }
    return scope;
}

NameScope InterfaceNames::scope_of(const ir::Program& program, ir::Stage stage) const {
    const ir::Module& module = stage_of(program, stage);
    NameScope scope = scope_of_uniforms(module);
    for (const auto* declarations : {&module.inputs, &module.outputs})
        for (const ir::Declaration& declaration : *declarations) {
            if (declaration.semantic == ir::Semantic::Attribute)
                scope.take(of(Kind::Attribute, declaration.name));
            if (declaration.semantic == ir::Semantic::Target)
                scope.take(of(Kind::Target, declaration.name));
            if (declaration.semantic != ir::Semantic::Interpolant) continue;
            const auto name = names_.find({Kind::Interpolant, declaration.name});
            if (name != names_.end()) scope.take(name->second);
        }
    return scope;
}

FunctionNames names_of_function(const ir::Module& function) {
    FunctionNames names;
    names.function = names.scope.declare(function.name, "find");
    for (const ir::Declaration& input : function.inputs)
        names.outer.inputs.push_back(names.scope.declare(input.name));
    for (const ir::Sampler& sampler : function.samplers)
        names.outer.samplers.push_back(declare_sampler(names.scope, sampler.name));
    for (const ir::Uniform& uniform : function.uniforms)
        names.outer.uniforms.push_back(names.scope.declare(uniform.name));
    return names;
}

void put_header(TextBuilder& out, const ir::Program& program, ir::Stage stage,
                const Target& target) {
    const std::string_view what = stage == ir::Stage::Vertex  ? "vertex stage"
                                  : stage == ir::Stage::Pixel ? "pixel stage"
                                                              : "a function";
    put_comment(out, fmt::format("{}: {} for {}", program.name, what, target.name));
    std::string_view description = program.description;
    while (!description.empty()) {
        const std::size_t end = std::min(description.find('\n'), description.size());
        put_comment(out, description.substr(0, end));
        description.remove_prefix(std::min(end + 1, description.size()));
    }
    // A setting stays on one line.
    std::string line = "Settings:";
    for (std::size_t i = 0; i < program.settings.size(); ++i) {
        const std::string setting =
            program.settings[i] + (i + 1 < program.settings.size() ? "," : "");
        if (line.size() + 1 + setting.size() + 3 > line_width) {
            put_comment(out, line);
            line = " ";
        }
        line.append(" ").append(setting);
    }
    if (!program.settings.empty()) put_comment(out, line);
}

void put_declaration(TextBuilder& out, std::string_view declaration, std::string_view comment) {
    if (comment.empty()) return out.line(declaration);
    TextBuilder beside;
    put_comment(beside, comment);
    std::string text = beside.take();
    text.pop_back();
    if (text.find('\n') == std::string::npos &&
        declaration.size() + text.size() + 2 + static_cast<std::size_t>(out.column()) <= line_width)
        return out.format("{}  {}", declaration, text);
    put_comment(out, comment);
    out.line(declaration);
}

Result<int> interpolant_location(const ir::Program& program, const ir::Declaration& pixel_input) {
    int location = 0;
    for (const ir::Declaration& output : program.vertex.outputs) {
        if (output.semantic != ir::Semantic::Interpolant) continue;
        if (output.name == pixel_input.name) {
            if (output.type == pixel_input.type) return location;
            return input_error(
                "stages-disagree",
                fmt::format("the vertex stage gives {} as {}, the pixel stage reads it as {}",
                            output.name, ir::to_string(output.type),
                            ir::to_string(pixel_input.type)));
        }
        ++location;
    }
    return input_error("stages-disagree",
                       fmt::format("the pixel stage reads {}, which the vertex stage does not give",
                                   pixel_input.name));
}

std::string sampler_comment(const ir::Sampler& sampler) {
    std::string comment = sampler.comment;
    const auto add = [&](std::string_view wish) {
        comment += fmt::format("{}{}", comment.empty() ? "" : "; ", wish);
    };
    if (!sampler.baked.empty()) add("baked with " + sampler.baked);
    if (sampler.filter == ir::Sampler::Filter::Nearest)
        add("sample it nearest, in texel and level");
    return comment;
}

int sampler_slot(const ir::Program& program, const std::string& name) {
    int slot = 0;
    for (const ir::Sampler& sampler : program.pixel.samplers) {
        if (sampler.name == name) return slot;
        ++slot;
    }
    for (const ir::Sampler& sampler : program.vertex.samplers) {
        if (sampler.name == name) return slot;
        const bool shared =
            std::any_of(program.pixel.samplers.begin(), program.pixel.samplers.end(),
                        [&](const ir::Sampler& other) { return other.name == sampler.name; });
        if (!shared) ++slot;
    }
    return slot;
}

Status check_shared_uniforms(const ir::Program& program) {
    for (const ir::Uniform& a : program.vertex.uniforms)
        for (const ir::Uniform& b : program.pixel.uniforms)
            if (a.name == b.name && (a.type != b.type || a.count != b.count))
                return input_error("uniform-conflict",
                                   fmt::format("the stages declare the uniform {} differently, "
                                               "and it is one uniform to both",
                                               a.name));
    return Done{};
}

bool has_rolled_loop(const ir::Region& region) {
    return std::any_of(region.body.begin(), region.body.end(),
                       [](const ir::Instruction& instruction) {
                           return (instruction.op == ir::Op::Loop &&
                                   instruction.loop.form == ir::LoopForm::Rolled) ||
                                  std::any_of(instruction.regions.begin(),
                                              instruction.regions.end(), has_rolled_loop);
                       });
}

}  // namespace intaglio::clike
