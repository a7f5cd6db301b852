// glslang, one stage: settings by language, its log as a Diagnostic, SPIR-V out.
#include "src/check/frontend.h"

#include <fmt/format.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <algorithm>
#include <charconv>
#include <vector>

#include "src/check/glslang_unit.h"
#include "src/check/spirv.h"

namespace intaglio::check {
namespace {

// glslang's process-wide tables, made once and never torn down: other threads may still parse at
// exit.
void ensure_glslang() {
    static const bool initialized = glslang::InitializeProcess();
    static_cast<void>(initialized);
}

// What `#version` must say; empty for HLSL.
std::string_view version_line(Language language) {
    switch (language) {
        case Language::Glsl450: return "450";
        case Language::Glsl330: return "330";
        case Language::Essl300: return "300 es";
        case Language::Glsl120: return "120";
        case Language::Essl100: return "100";
        case Language::Hlsl5:
        case Language::Hlsl3: return {};
    }
    return {};
}

// glslang takes a text without #version for GLSL 1.10, and any #version for what it says: a text in
// the wrong language would be judged by the wrong rules and pass.
Status check_version(const Source& source) {
    const std::string_view expected = version_line(source.language);
    if (expected.empty()) return Done{};
    std::string_view text = source.text;
    for (int line = 1; !text.empty(); ++line) {
        const std::size_t length = std::min(text.find('\n'), text.size());
        const std::string_view current = text.substr(0, length);
        if (current.rfind("#version ", 0) == 0) {
            std::string_view actual = current.substr(9);
            if (actual.size() > 5 && actual.substr(actual.size() - 5) == " core") {
                actual.remove_suffix(5);
            }
            if (actual == expected) return Done{};
            return input_error("version-mismatch",
                               fmt::format("{} is written for `#version {}`, not `{}`",
                                           name_of(source.language), expected, current),
                               source.name, line);
        }
        text.remove_prefix(std::min(length + 1, text.size()));
    }
    return input_error(
        "version-mismatch",
        fmt::format("{} needs a line `#version {}`", name_of(source.language), expected),
        source.name);
}

const TBuiltInResource& resources_for(Language language) {
    // WebGL 1 allows only what GLSL ES 1.00 appendix A guarantees; glslang checks it when asked.
    static const TBuiltInResource strict = [] {
        TBuiltInResource limits = *GetDefaultResources();
        limits.limits = {};
        return limits;
    }();
    return language == Language::Essl100 ? strict : *GetDefaultResources();
}

EShMessages messages_for(Language language, Purpose purpose) {
    unsigned messages = EShMsgDefault;
    if (purpose == Purpose::Spirv) messages |= EShMsgSpvRules | EShMsgVulkanRules;
    if (is_hlsl(language)) messages |= EShMsgReadHlsl | EShMsgHlslOffsets;
    // Without it sampler2D and tex2D are accepted and become SPIR-V that no validator takes.
    if (language == Language::Hlsl3) messages |= EShMsgHlslDX9Compatible;
    return static_cast<EShMessages>(messages);
}

int parse_int(std::string_view digits) {
    int value = 0;
    std::from_chars(digits.data(), digits.data() + digits.size(), value);
    return value;
}

// The linker of glslang says what differs on indented lines below its message.
std::vector<std::string> indented_lines(std::string_view text) {
    std::vector<std::string> lines;
    while (text.rfind("    ", 0) == 0) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, end);
        const std::size_t first = line.find_first_not_of(' ');
        if (first != std::string_view::npos) lines.emplace_back(line.substr(first));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return lines;
}

}  // namespace

EShLanguage glslang_stage(Stage stage) {
    return stage == Stage::Vertex ? EShLangVertex : EShLangFragment;
}

bool is_hlsl(Language language) {
    return language == Language::Hlsl5 || language == Language::Hlsl3;
}

bool is_auto_mapped_glsl(Language language) {
    return language == Language::Glsl330 || language == Language::Essl300;
}

Diagnostic glslang_error(const Source& source, std::string_view log) {
    const std::string code = is_hlsl(source.language) ? "hlsl-refused" : "glsl-refused";
    const std::string witness = fmt::format(
        "glslang refuses this {} {} stage: ", name_of(source.language), name_of(source.stage));
    constexpr std::string_view marker = "ERROR: ";
    const std::size_t begin = log.find(marker);
    if (begin == std::string_view::npos) {
        return input_error(code, witness + "it gives no reason", source.name);
    }
    std::string_view message = log.substr(begin + marker.size());
    const std::size_t end = message.find('\n');
    const std::vector<std::string> details = end == std::string_view::npos
                                                 ? std::vector<std::string>()
                                                 : indented_lines(message.substr(end + 1));
    message = message.substr(0, end);
    // "0:12: 'x' : undeclared identifier ": number of the string, line.  Errors of linking have
    // neither.
    int line = 0;
    const std::size_t first = message.find_first_not_of("0123456789");
    if (first != std::string_view::npos && first > 0 && message[first] == ':') {
        const std::string_view rest = message.substr(first + 1);
        const std::size_t second = rest.find(": ");
        if (second != std::string_view::npos) {
            line = parse_int(rest.substr(0, second));
            message = rest.substr(second + 2);
        }
    }
    while (!message.empty() && (message.back() == ' ' || message.back() == ':'))
        message.remove_suffix(1);
    Diagnostic error = input_error(code, witness + std::string(message), source.name, line);
    const std::string quoted = quote_line(source.text, line);
    if (!quoted.empty()) error.notes.push_back(fmt::format("line {}: {}", line, quoted));
    error.notes.insert(error.notes.end(), details.begin(), details.end());
    return error;
}

GlslangUnit::GlslangUnit(const Source& source, Purpose purpose)
    : source_(source),
      // HLSL is not defined apart from a client here, Glsl450 is by definition Vulkan's.
      purpose_(is_hlsl(source.language) || source.language == Language::Glsl450 ? Purpose::Spirv
                                                                                : purpose),
      messages_(messages_for(source.language, purpose_)),
      text_(source.text.c_str()),
      shader_((ensure_glslang(), glslang_stage(source.stage))) {
    shader_.setStrings(&text_, 1);
    if (purpose_ == Purpose::Spirv) configure_spirv();
}

void GlslangUnit::configure_spirv() {
    const glslang::EShSource family =
        is_hlsl(source_.language) ? glslang::EShSourceHlsl : glslang::EShSourceGlsl;
    shader_.setEnvInput(family, glslang_stage(source_.stage), glslang::EShClientVulkan, 100);
    shader_.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_1);
    shader_.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_3);
    shader_.setEntryPoint("main");
    if (is_hlsl(source_.language)) shader_.setSourceEntryPoint(source_.entry.c_str());
    if (source_.language == Language::Glsl450) return;  // all explicit, and checked to be

    shader_.setAutoMapBindings(true);
    shader_.setAutoMapLocations(true);
    const bool own_block = source_.language == Language::Hlsl3 && source_.stage == Stage::Vertex;
    shader_.setShiftBinding(glslang::EResUbo, own_block ? vertex_uniform_binding : uniform_binding);
    shader_.setShiftBinding(glslang::EResTexture, texture_binding);
    shader_.setShiftBinding(glslang::EResSampler, sampler_binding);
    if (is_hlsl(source_.language)) return;
    shader_.setGlobalUniformSet(0);
    shader_.setGlobalUniformBinding(uniform_binding);
    shader_.setEnvInputVulkanRulesRelaxed();
    // 3.10 is the first ES version with a way to SPIR-V; it contains 3.00.
    if (source_.language == Language::Essl300) shader_.setOverrideVersion(310);
}

Status GlslangUnit::parse() {
    if (Status version = check_version(source_); !version) return version;
    constexpr int hlsl_version = 500;
    const int version = is_hlsl(source_.language) ? hlsl_version : 110;
    if (shader_.parse(&resources_for(source_.language), version, false, messages_)) return Done{};
    return glslang_error(source_, shader_.getInfoLog());
}

Result<SpirvWords> generate(const glslang::TProgram& program, const Source& source) {
    SpirvWords words;
    spv::SpvBuildLogger logger;
    glslang::SpvOptions options;
    glslang::GlslangToSpv(*program.getIntermediate(glslang_stage(source.stage)), words, &logger,
                          &options);
    if (Status valid = validate_spirv(words); !valid) {
        Diagnostic error = valid.error();
        error.file = source.name;
        error.notes.push_back(fmt::format("glslang made it from this {} {} stage without complaint",
                                          name_of(source.language), name_of(source.stage)));
        return error;
    }
    return words;
}

Status parse(const Source& source) {
    GlslangUnit unit(source, Purpose::Grammar);
    return unit.parse();
}

Result<SpirvWords> to_spirv(const Source& source) {
    if (!has_spirv(source.language)) {
        return input_error("no-spirv",
                           fmt::format("there is no SPIR-V of {}", name_of(source.language)),
                           source.name);
    }
    GlslangUnit unit(source, Purpose::Spirv);
    if (Status parsed = unit.parse(); !parsed) return parsed.error();
    glslang::TProgram program;
    if (Status linked = link_units(program, unit, nullptr); !linked) return linked.error();
    return generate(program, source);
}

}  // namespace intaglio::check
