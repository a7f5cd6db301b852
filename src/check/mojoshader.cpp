// MojoShader's GLSL 1.20 to GLSL 3.30: the preamble goes, built-in varyings become declared ones.
#include "src/check/mojoshader.h"

#include <fmt/format.h>
#include <mojoshader.h>

#include <algorithm>
#include <cctype>
#include <memory>
#include <set>

namespace intaglio::check {
namespace {

struct FreeParse {
    void operator()(const MOJOSHADER_parseData* data) const { MOJOSHADER_freeParseData(data); }
};
using Parsed = std::unique_ptr<const MOJOSHADER_parseData, FreeParse>;

std::string input_name(const MOJOSHADER_attribute& attribute) {
    constexpr std::string_view usages[] = {
        "position", "blendweight", "blendindices", "normal", "pointsize", "texcoord", "tangent",
        "binormal", "tessfactor",  "positiont",    "color",  "fog",       "depth",    "sample"};
    if (attribute.usage == MOJOSHADER_USAGE_TEXCOORD && attribute.index == 0) return "in_uv";
    const auto usage = static_cast<std::size_t>(attribute.usage);
    const std::string_view name = usage < std::size(usages) ? usages[usage] : "unknown";
    return attribute.index == 0 ? fmt::format("in_{}", name)
                                : fmt::format("in_{}{}", name, attribute.index);
}

// Renames identifiers one by one and remembers which declarations the new names need.
class Upgrade {
  public:
    Upgrade(const MOJOSHADER_parseData& data, Stage stage) : stage_(stage) {
        if (stage == Stage::Pixel) return;
        for (int i = 0; i < data.attribute_count; ++i) {
            const MOJOSHADER_attribute& attribute = data.attributes[i];
            if (attribute.name != nullptr) renamed_[attribute.name] = input_name(attribute);
        }
    }

    std::string text(std::string_view old) {
        std::string body;
        while (!old.empty()) {
            const std::size_t end = std::min(old.find('\n'), old.size() - 1) + 1;
            const std::string_view line = old.substr(0, end);
            if (!is_preamble(line)) rename(body, line);
            old.remove_prefix(end);
        }
        return header() + body;
    }

  private:
    // GLSL 1.20's version, and its ways to reach texture functions that 3.30 has.
    static bool is_preamble(std::string_view line) {
        for (const std::string_view start :
             {"#version", "#if", "#elif", "#else", "#endif", "#extension", "#define texture"})
            if (line.substr(0, start.size()) == start) return true;
        return false;
    }

    static bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

    void rename(std::string& into, std::string_view line) {
        for (std::size_t at = 0; at < line.size();) {
            if (!is_word(line[at])) {
                into += line[at++];
                continue;
            }
            std::size_t end = at;
            while (end < line.size() && is_word(line[end])) ++end;
            const std::string word(line.substr(at, end - at));
            at = end;
            if (word == "gl_TexCoord" || word == "gl_FragData") {
                const std::size_t close = std::min(line.find(']', at), line.size() - 1);
                const std::string index(line.substr(at + 1, close - at - 1));
                at = close + 1;
                into += word == "gl_TexCoord" ? varying("mojo_texcoord" + index) : target(index);
            } else {
                into += renamed(word);
            }
        }
    }

    std::string renamed(const std::string& word) {
        if (word == "gl_FragColor") return target("0");
        if (word == "gl_Color" || word == "gl_FrontColor") return varying("mojo_color0");
        if (word == "gl_SecondaryColor" || word == "gl_FrontSecondaryColor")
            return varying("mojo_color1");
        const auto found = renamed_.find(word);
        return found == renamed_.end() ? word : found->second;
    }

    std::string varying(std::string name) {
        varyings_.insert(name);
        return name;
    }

    std::string target(const std::string& index) {
        targets_.insert(index);
        return "mojo_target" + index;
    }

    std::string header() const {
        const bool pixel = stage_ == Stage::Pixel;
        std::string text = fmt::format("#version 330\n#define attribute in\n#define varying {}\n",
                                       pixel ? "in" : "out");
        for (const std::string_view sampler : {"texture2D", "texture3D", "textureCube"})
            for (const std::string_view way : {"", "Proj", "Lod", "Grad", "ProjLod", "ProjGrad"})
                text += fmt::format("#define {}{} texture{}\n", sampler, way, way);
        for (const std::string& name : varyings_) text += fmt::format("varying vec4 {};\n", name);
        for (const std::string& index : targets_)
            text += fmt::format("layout(location = {0}) out vec4 mojo_target{0};\n", index);
        return text;
    }

    Stage stage_;
    std::map<std::string, std::string> renamed_;
    std::set<std::string> varyings_, targets_;
};

// Registers of the arrays that MojoShader packs what is read into, in its order.
void read_uniforms(D3d9Stage& into, const MOJOSHADER_parseData& data) {
    for (int i = 0; i < data.uniform_count; ++i) {
        const MOJOSHADER_uniform& uniform = data.uniforms[i];
        if (uniform.constant) continue;
        std::vector<int>& registers =
            uniform.type == MOJOSHADER_UNIFORM_FLOAT ? into.float_registers
            : uniform.type == MOJOSHADER_UNIFORM_INT ? into.int_registers
                                                     : into.bool_registers;
        for (int k = 0; k < std::max(uniform.array_count, 1); ++k)
            registers.push_back(uniform.index + k);
    }
}

void read_constants(D3d9Stage& into, const MOJOSHADER_parseData& data) {
    for (int i = 0; i < data.symbol_count; ++i) {
        const MOJOSHADER_symbol& symbol = data.symbols[i];
        D3d9Constant& constant = into.constants.emplace_back();
        constant.name = symbol.name != nullptr ? symbol.name : "";
        constant.set = static_cast<D3d9Constant::Set>(symbol.register_set);
        constant.index = static_cast<int>(symbol.register_index);
        constant.count = static_cast<int>(symbol.register_count);
        const bool by_columns = symbol.info.parameter_class == MOJOSHADER_SYMCLASS_MATRIX_COLUMNS;
        constant.components =
            constant.set == D3d9Constant::Set::Bool
                ? 1
                : static_cast<int>(by_columns ? symbol.info.rows : symbol.info.columns);
    }
}

const D3d9Constant* constant_at(const D3d9Stage& stage, D3d9Constant::Set set, int index) {
    for (const D3d9Constant& constant : stage.constants)
        if (constant.set == set && index >= constant.index &&
            index < constant.index + constant.count)
            return &constant;
    return nullptr;
}

void read_textures(D3d9Stage& into, const MOJOSHADER_parseData& data) {
    for (int i = 0; i < data.sampler_count; ++i) {
        const MOJOSHADER_sampler& sampler = data.samplers[i];
        const D3d9Constant* constant = constant_at(into, D3d9Constant::Set::Sampler, sampler.index);
        const std::string name =
            constant != nullptr ? constant->name : fmt::format("s{}", sampler.index);
        into.textures[name] = sampler.name != nullptr ? sampler.name : "";
    }
}

// What is wrong with the frame of the stream, which MojoShader 1314 does not check: it accepts a
// missing end token, and crashes on nothing at all.  From shader model 2 on, a token says how many
// operands (or words of comment) follow it.
const char* broken_frame(D3d9Words words) {
    if (words.empty()) return "it is empty";
    const std::uint32_t kind = words[0] >> 16, model = words[0] >> 8 & 0xFF;
    if ((kind != 0xFFFF && kind != 0xFFFE) || model < 2 || model > 3)
        return "it does not begin with the version of a shader of model 2 or 3";
    for (std::size_t at = 1; at < words.size();) {
        const std::uint32_t token = words[at];
        if (token == 0x0000FFFF)
            return at + 1 == words.size() ? nullptr : "words follow the end token";
        const bool comment = (token & 0xFFFF) == 0xFFFE;
        at += 1 + (comment ? token >> 16 & 0x7FFF : token >> 24 & 0xF);
    }
    return "it has no end token";
}

Diagnostic refusal(const MOJOSHADER_error& error) {
    const std::string message = error.error != nullptr ? error.error : "no reason given";
    if (error.error_position < 0)
        return input_error("d3d9-refused", "MojoShader refuses the bytecode: " + message);
    return input_error("d3d9-refused", fmt::format("MojoShader refuses the bytecode at byte {}: {}",
                                                   error.error_position, message));
}

Result<D3d9Program> finished(const Source& vertex, const Source& pixel,
                             std::vector<D3d9Stage> stages) {
    Result<Program> program = link_to_spirv(vertex, pixel);
    if (!program) return program.error();
    return D3d9Program{std::move(*program), std::move(stages)};
}

// Appends the value of one register.
Status append(std::vector<float>& into, const D3d9Stage& stage, D3d9Constant::Set set, int index,
              const std::map<std::string, std::vector<float>>& values) {
    const int lanes = set == D3d9Constant::Set::Bool ? 1 : 4;
    D3d9Constant constant{fmt::format("{}{}", "bic"[static_cast<int>(set)], index), set, index, 1,
                          lanes};
    if (const D3d9Constant* named = constant_at(stage, set, index)) constant = *named;
    const auto found = values.find(constant.name);
    if (found == values.end()) {
        return input_error("missing-uniform",
                           fmt::format("the {} shader needs the uniform '{}', which was not given",
                                       name_of(stage.source.stage), constant.name));
    }
    const std::vector<float>& given = found->second;
    const auto needed = static_cast<std::size_t>(constant.count * constant.components);
    if (given.size() != needed) {
        return input_error("bad-uniform",
                           fmt::format("the uniform '{}' takes {} values, and {} were given",
                                       constant.name, needed, given.size()));
    }
    for (int i = 0; i < lanes; ++i) {
        const int at = (index - constant.index) * constant.components + i;
        into.push_back(i < constant.components ? given[static_cast<std::size_t>(at)] : 0.0f);
    }
    return Done{};
}

}  // namespace

Result<D3d9Stage> translate_d3d9(D3d9Words bytecode, Stage stage) {
    if (const char* why = broken_frame(bytecode))
        return input_error("d3d9-malformed", fmt::format("this is no shader bytecode: {}", why));
    const auto* bytes = reinterpret_cast<const unsigned char*>(bytecode.data());
    const Parsed parsed(MOJOSHADER_parse(MOJOSHADER_PROFILE_GLSL120, "main", bytes,
                                         static_cast<unsigned>(bytecode.size_bytes()), nullptr, 0,
                                         nullptr, 0, nullptr, nullptr, nullptr));
    if (!parsed) return internal_error("d3d9-refused", "MojoShader gave no answer");
    if (parsed->error_count > 0) return refusal(parsed->errors[0]);
    const bool is_pixel = parsed->shader_type == MOJOSHADER_TYPE_PIXEL;
    if (is_pixel != (stage == Stage::Pixel)) {
        return input_error("stages-disagree",
                           fmt::format("the bytecode is a {} shader, not a {} shader",
                                       is_pixel ? "pixel" : "vertex", name_of(stage)));
    }
    D3d9Stage result;
    result.slots = parsed->instruction_count;
    read_uniforms(result, *parsed);
    read_constants(result, *parsed);
    read_textures(result, *parsed);
    result.source.language = Language::Glsl330;
    result.source.stage = stage;
    const auto length = static_cast<std::size_t>(std::max(parsed->output_len, 0));
    result.source.text = Upgrade(*parsed, stage).text(std::string_view(parsed->output, length));
    return result;
}

Result<D3d9Program> link_d3d9(D3d9Words vertex, D3d9Words pixel) {
    Result<D3d9Stage> first = translate_d3d9(vertex, Stage::Vertex);
    if (!first) return first.error();
    Result<D3d9Stage> second = translate_d3d9(pixel, Stage::Pixel);
    if (!second) return second.error();
    const Source sources[] = {first->source, second->source};
    return finished(sources[0], sources[1], {std::move(*first), std::move(*second)});
}

Result<D3d9Program> link_d3d9(const Source& vertex, D3d9Words pixel) {
    Result<D3d9Stage> stage = translate_d3d9(pixel, Stage::Pixel);
    if (!stage) return stage.error();
    const Source source = stage->source;
    return finished(vertex, source, {std::move(*stage)});
}

Result<std::map<std::string, std::vector<float>>> uniforms_of(
    const D3d9Program& program, const std::map<std::string, std::vector<float>>& values) {
    using Set = D3d9Constant::Set;
    std::map<std::string, std::vector<float>> result;
    for (const D3d9Stage& stage : program.stages) {
        const std::string prefix = stage.source.stage == Stage::Pixel ? "ps" : "vs";
        const auto fill = [&](const char* suffix, Set set, const std::vector<int>& registers) {
            std::vector<float> array;
            for (const int index : registers)
                if (Status done = append(array, stage, set, index, values); !done) return done;
            if (!array.empty()) result[prefix + suffix] = std::move(array);
            return Status(Done{});
        };
        if (Status done = fill("_uniforms_vec4", Set::Float, stage.float_registers); !done)
            return done.error();
        if (Status done = fill("_uniforms_ivec4", Set::Int, stage.int_registers); !done)
            return done.error();
        if (Status done = fill("_uniforms_bool", Set::Bool, stage.bool_registers); !done)
            return done.error();
    }
    // Rows of the picture from the top, as vPos counts them.
    result["vposFlip"] = {1, 0};
    return result;
}

}  // namespace intaglio::check
