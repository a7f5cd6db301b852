// A header of comments above what print() writes.
#include "generator/target/d3d9/rows/listing.h"

#include <algorithm>

#include <fmt/format.h>

#include "generator/target/clike/layout.h"
#include "generator/target/clike/shell.h"
#include "generator/target/d3d9/assembly.h"
#include "generator/target/d3d9/resources.h"

namespace intaglio::d3d9 {
namespace {

// What a uniform or texture means, in the DSL's words.
std::string meaning_of(const ir::Program& recorded, const std::string& name) {
    for (const ir::Module* module : {&recorded.pixel, &recorded.vertex}) {
        for (const ir::Uniform& uniform : module->uniforms)
            if (uniform.name == name) return uniform.comment;
        for (const ir::Sampler& sampler : module->samplers)
            if (sampler.name == name) return sampler.comment;
    }
    return {};
}

std::string registers_of(const Constant& constant) {
    const char letter = set_letters[static_cast<std::size_t>(constant.set)][0];
    std::string text = fmt::format("{}{}", letter, constant.index);
    if (constant.count > 1)
        text += fmt::format(" to {}{}", letter, constant.index + constant.count - 1);
    return text;
}

void put_bindings(TextBuilder& out, const ir::Program& recorded, const Shader& shader) {
    for (const Constant& constant : shader.constants) {
        const std::string meaning = meaning_of(recorded, constant.name);
        clike::put_comment(out, fmt::format("{} {}{}{}", registers_of(constant), constant.name,
                                            meaning.empty() ? "" : ": ", meaning));
    }
}

// One line for each resource in use.
void put_headroom(TextBuilder& out, const Shader& shader) {
    for (const Headroom& row : headroom(shader))
        if (row.used > 0) out.format("// {:>4} of {:<4} {}", row.used, row.limit, row.resource);
}

}  // namespace

std::string listing(const ir::Program& recorded, ir::Stage stage, const Target& target,
                    const Shader& shader, const std::vector<std::string>& interpolants) {
    TextBuilder out;
    clike::put_header(out, recorded, stage, target);
    out.line();
    put_bindings(out, recorded, shader);
    for (const std::string& interpolant : interpolants) clike::put_comment(out, interpolant);
    out.line();
    put_headroom(out, shader);
    out.line();
    return out.take() + print(shader);
}

}  // namespace intaglio::d3d9
