// MojoShader's uniform arrays taken apart: each name of the constant table becomes a uniform, and
// the registers become what the array's elements were: `#define ps_c1 vec4(ambient, 0.0)`.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "src/check/mojoshader.h"

namespace intaglio::check {
namespace {

constexpr std::string_view zeros[] = {"", ", 0.0, 0.0, 0.0", ", 0.0, 0.0", ", 0.0", ""};

// "uniform vec3 ambient;", "uniform vec4 world[3];"
std::string declaration_of(const D3d9Constant& constant) {
    const std::string type =
        constant.components == 1 ? "float" : fmt::format("vec{}", constant.components);
    const std::string count =
        constant.count == 1 ? std::string() : fmt::format("[{}]", constant.count);
    return fmt::format("uniform {} {}{};\n", type, constant.name, count);
}

std::string register_text(const D3d9Constant& constant, int index) {
    std::string value = constant.name;
    if (constant.count > 1) value += fmt::format("[{}]", index - constant.index);
    if (constant.components == 4) return value;
    return fmt::format("vec4({}{})", value, zeros[constant.components]);
}

// Puts `to` in the place of `from`, which stands there once or not at all.
bool replace_once(std::string& text, std::string_view from, std::string_view to) {
    const std::size_t at = text.find(from);
    if (at == std::string::npos) return false;
    text.replace(at, from.size(), to);
    return true;
}

// As a whole word, everywhere.
void rename(std::string& text, std::string_view from, std::string_view to) {
    const auto is_word = [&](std::size_t at) {
        return at < text.size() &&
               (std::isalnum(static_cast<unsigned char>(text[at])) != 0 || text[at] == '_');
    };
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at)) {
        if (is_word(at + from.size()) || (at > 0 && is_word(at - 1))) {
            at += from.size();
            continue;
        }
        text.replace(at, from.size(), to);
        at += to.size();
    }
}

}  // namespace

D3d9Stage with_names(D3d9Stage stage) {
    std::string& text = stage.source.text;
    const std::string prefix = stage.source.stage == Stage::Pixel ? "ps" : "vs";
    const std::string array = prefix + "_uniforms_vec4";
    std::string declarations;
    std::vector<int> unnamed;
    for (std::size_t i = 0; i < stage.float_registers.size(); ++i) {
        const int index = stage.float_registers[i];
        const auto constant = std::find_if(
            stage.constants.begin(), stage.constants.end(), [&](const D3d9Constant& row) {
                return row.set == D3d9Constant::Set::Float && index >= row.index &&
                       index < row.index + row.count;
            });
        const std::string define = fmt::format("#define {}_c{} ", prefix, index);
        if (constant == stage.constants.end() ||
            !replace_once(text, fmt::format("{}{}[{}]\n", define, array, i),
                          fmt::format("{}{}\n", define, register_text(*constant, index)))) {
            unnamed.push_back(index);
            continue;
        }
        const std::string declaration = declaration_of(*constant);
        if (declarations.find(declaration) == std::string::npos) declarations += declaration;
    }
    const std::string declared =
        fmt::format("uniform vec4 {}[{}];\n", array, stage.float_registers.size());
    if (unnamed.empty())
        replace_once(text, declared, declarations);
    else
        replace_once(text, declared, declared + declarations);
    for (auto& [name, in_program] : stage.textures) {
        rename(text, in_program, name);
        in_program = name;
    }
    return stage;
}

Result<Program> link_d3d9_by_name(D3d9Words vertex, D3d9Words pixel) {
    Result<D3d9Stage> first = translate_d3d9(vertex, Stage::Vertex);
    if (!first) return first.error();
    Result<D3d9Stage> second = translate_d3d9(pixel, Stage::Pixel);
    if (!second) return second.error();
    return link_to_spirv(with_names(std::move(*first)).source,
                         with_names(std::move(*second)).source);
}

}  // namespace intaglio::check
