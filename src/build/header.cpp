// Texts are string literals, a line of the text in a line of the header, so that a person finds
// them there; binaries are words.
#include "src/build/header.h"

#include <algorithm>
#include <array>
#include <cstring>

#include <fmt/format.h>

#include "generator/base/text.h"
#include "src/scene/words_of_cpp.h"

namespace intaglio::build {
namespace {

// Compilers need not take longer literals, and clang says so.
constexpr std::size_t longest_literal = 60000;

std::string identifier(const std::string& name) {
    return scene::is_word_of_cpp(name) ? name + "_" : name;
}

// A literal that means the same to every compiler: octal escapes end by themselves, and no two
// question marks meet.
std::string literal(std::string_view text) {
    std::string quoted = "\"";
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '\n')
            quoted += "\\n";
        else if (c == '"' || c == '\\' || c == '?')
            quoted += std::string("\\") + c;
        else if (byte < 0x20 || byte >= 0x7f)
            quoted += fmt::format("\\{:03o}", byte);
        else
            quoted += c;
    }
    return quoted + "\"";
}

// A comment ends with its line, whatever a technique's author wrote.
std::string one_line(std::string text) {
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 0x20) c = ' ';
    while (!text.empty() && (text.back() == '\\' || text.back() == ' ')) text.pop_back();
    return text;
}

void write_numbers(TextBuilder& out, const std::vector<std::string>& numbers, std::size_t a_line) {
    for (std::size_t i = 0; i < numbers.size(); i += a_line) {
        std::string line;
        for (std::size_t k = i; k < std::min(i + a_line, numbers.size()); ++k)
            line += (k == i ? "" : " ") + numbers[k] + ",";
        out.line(line);
    }
}

void write_text(TextBuilder& out, const std::string& name, const std::string& bytes) {
    out.format("inline constexpr char {}[] =", name);
    out.indent();
    std::string_view rest = bytes;
    if (rest.empty()) out.line("\"\";");
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find('\n'), rest.size() - 1) + 1;
        out.line(literal(rest.substr(0, end)) + (end == rest.size() ? ";" : ""));
        rest.remove_prefix(end);
    }
    out.outdent();
}

void write_long_text(TextBuilder& out, const std::string& name, const std::string& bytes) {
    out.format("inline constexpr char {}[] = {{", name);
    std::vector<std::string> numbers;
    for (const char c : bytes) numbers.push_back(fmt::format("{}", static_cast<int>(c)));
    numbers.emplace_back("0");
    out.indent();
    write_numbers(out, numbers, 20);
    out.outdent();
    out.line("};");
}

void write_words(TextBuilder& out, const std::string& name, const std::string& bytes) {
    std::vector<std::string> words;
    for (std::size_t i = 0; i + 4 <= bytes.size(); i += 4) {
        std::array<unsigned char, 4> b{};
        std::memcpy(b.data(), bytes.data() + i, 4);
        words.push_back(fmt::format("0x{:02x}{:02x}{:02x}{:02x}", b[3], b[2], b[1], b[0]));
    }
    out.format("inline constexpr std::uint32_t {}[] = {{", name);
    out.indent();
    write_numbers(out, words, 8);
    out.outdent();
    out.line("};");
}

std::string array_name(const BundleFile& file) {
    return fmt::format("{}_{}", file.stage == ir::Stage::Vertex ? "vertex" : "pixel",
                       name_of(file.kind));
}

void write_bytes(TextBuilder& out, const BundleFile& file) {
    const std::string name = array_name(file);
    if (file.kind != FileKind::Text)
        write_words(out, name, file.bytes);
    else if (file.bytes.size() > longest_literal)
        write_long_text(out, name, file.bytes);
    else
        write_text(out, name, file.bytes);
}

std::string_view cpp_type(Scalar scalar) {
    return scalar == Scalar::Float ? "float" : "std::int32_t";
}

std::string member_of(const Uniform& uniform) {
    std::string text = fmt::format("{} {}", cpp_type(uniform.scalar), identifier(uniform.name));
    if (uniform.elements > 1)
        text += fmt::format("[{}][{}]", uniform.elements, uniform.stride / 4);
    else if (uniform.reg >= 0)
        text += "[4]";  // a register
    else if (uniform.components > 1)
        text += fmt::format("[{}]", uniform.components);
    return text;
}

int bytes_of_member(const Uniform& uniform) {
    return uniform.elements == 1 && uniform.reg >= 0 ? 16 : uniform.size();
}

void write_member(TextBuilder& out, const Uniform& uniform) {
    std::string comment = one_line(uniform.comment);
    if (uniform.reg >= 0) {
        const std::string last =
            uniform.elements > 1 ? fmt::format(" to c{}", uniform.reg + uniform.elements - 1) : "";
        comment = fmt::format("c{}{}: {}", uniform.reg, last, comment);
    }
    out.format("{};{}", member_of(uniform), comment.empty() ? "" : "  // " + comment);
}

void write_block(TextBuilder& out, const std::string& name, const UniformBlock& block) {
    if (block.uniforms.empty()) return;
    switch (block.kind) {
        case UniformBlock::Kind::Buffer:
            out.format("// A buffer of these bytes at {}binding {}.",
                       block.set < 0 ? "" : fmt::format("set {}, ", block.set), block.binding);
            break;
        case UniformBlock::Kind::Registers:
            out.format("// Registers c{} to c{}.", block.first_register,
                       block.first_register + block.registers - 1);
            break;
        case UniformBlock::Kind::Names: out.line("// Set by name, one by one."); break;
    }
    out.format("struct {} {{", name);
    out.indent();
    int end = 0, gap = 0;
    const auto pad_to = [&](int offset) {
        if (offset > end) out.format("float unused_{}[{}];", gap++, (offset - end) / 4);
        end = offset;
    };
    for (const Uniform& uniform : block.uniforms) {
        pad_to(uniform.offset);
        write_member(out, uniform);
        end += bytes_of_member(uniform);
    }
    pad_to(block.size);
    out.outdent();
    out.line("};");
    for (const Uniform& uniform : block.uniforms)
        out.format("static_assert(offsetof({}, {}) == {});", name, identifier(uniform.name),
                   uniform.offset);
    out.format("static_assert(sizeof({}) == {});", name, block.size);
}

std::string file_value(const Bundle& bundle, ir::Stage stage, bool text) {
    for (const BundleFile& file : bundle.files) {
        if (file.stage != stage || (file.kind == FileKind::Text) != text) continue;
        return fmt::format("{{{}, {}, {}, {}}}", literal(file.name), literal(file.entry),
                           array_name(file), file.bytes.size());
    }
    return "{\"\", \"\", nullptr, 0}";
}

void write_uniforms(TextBuilder& out, const std::string& stage, const UniformBlock& block) {
    if (block.uniforms.empty()) return;
    out.format("inline constexpr Uniform {}_uniforms[] = {{", stage);
    out.indent();
    for (const Uniform& each : block.uniforms)
        out.format("{{{}, {}, {}, {}, {}, {}, {}}},", literal(each.name), each.offset,
                   each.components, each.elements, each.stride, each.reg,
                   each.scalar == Scalar::Float ? "false" : "true");
    out.outdent();
    out.line("};");
}

std::string map_of(const std::string& sampler, const std::vector<MapRecord>& maps) {
    for (const MapRecord& map : maps)
        if (std::find(map.samplers.begin(), map.samplers.end(), sampler) != map.samplers.end())
            return map.kind;
    return {};
}

void write_samplers(TextBuilder& out, const std::string& stage,
                    const std::vector<Sampler>& samplers, const std::vector<MapRecord>& maps) {
    if (samplers.empty()) return;
    out.format("inline constexpr Sampler {}_samplers[] = {{", stage);
    out.indent();
    for (const Sampler& each : samplers)
        out.format("{{{}, {}, {}, {}, {}, {}, {}, {}}},  // {}", literal(each.name),
                   literal(map_of(each.name, maps)), each.set, each.slot, each.sampler_slot,
                   each.dimension, each.nearest, each.one_level, one_line(each.comment));
    out.outdent();
    out.line("};");
    for (const Sampler& each : samplers)
        if (each.slot >= 0)
            out.format("inline constexpr int {}_{}_slot = {};", stage, each.name, each.slot);
}

std::string list_value(const std::string& name, std::size_t size) {
    return size == 0 ? "{nullptr, 0}" : fmt::format("{{{}, {}}}", name, size);
}

std::string stage_value(const Bundle& bundle, ir::Stage stage) {
    const bool vertex = stage == ir::Stage::Vertex;
    const std::string name = vertex ? "vertex" : "pixel";
    const StageInterface& interface = vertex ? bundle.interface.vertex : bundle.interface.pixel;
    const UniformBlock& block = interface.block;
    return fmt::format("{{{},\n     {},\n     {}, {}, {}, {}, {}, {}, {}}}",
                       file_value(bundle, stage, true), file_value(bundle, stage, false), block.set,
                       block.binding, block.first_register, block.registers, block.size,
                       list_value(name + "_uniforms", block.uniforms.size()),
                       list_value(name + "_samplers", interface.samplers.size()));
}

void write_variant(TextBuilder& out, const BuiltVariant& variant,
                   const std::vector<MapRecord>& maps) {
    const Bundle& bundle = variant.bundle;
    const std::string& target = variant.order.request.target;
    out.format("namespace {} {{", target);
    out.line();
    write_block(out, "VertexUniforms", bundle.interface.vertex.block);
    write_block(out, "PixelUniforms", bundle.interface.pixel.block);
    write_uniforms(out, "vertex", bundle.interface.vertex.block);
    write_uniforms(out, "pixel", bundle.interface.pixel.block);
    write_samplers(out, "vertex", bundle.interface.vertex.samplers, maps);
    write_samplers(out, "pixel", bundle.interface.pixel.samplers, maps);
    for (const BundleFile& file : bundle.files) write_bytes(out, file);
    out.format("inline constexpr Variant variant = {{");
    out.format("    {}, {}, {},", literal(variant.order.name()), literal(target),
               literal(variant.order.request.surface));
    out.format("    {},", stage_value(bundle, ir::Stage::Vertex));
    out.format("    {}}};", stage_value(bundle, ir::Stage::Pixel));
    out.line();
    out.format("}}  // namespace {}", target);
    out.line();
}

// The types of every header, each in the namespace of its surface, so that headers of two versions
// of the tool can meet in one program.
constexpr std::string_view types =
    R"(// One stage in one form; `data` is null where there is none.  A text ends in a zero that
// `size` does not count; SPIR-V and bytecode are words of the machine, `size` bytes of them.
struct Code {
    const char* file;   // below the folder of the build
    const char* entry;  // the entry point
    const void* data;
    std::size_t size;
};
struct Uniform {
    const char* name;
    int offset;          // bytes, in VertexUniforms or PixelUniforms
    int components;      // 1 to 4
    int elements;        // of an array; 1: none
    int stride;          // bytes from element to element; 0 of one
    int first_register;  // c#; -1: none
    bool is_integer;
};
struct Sampler {
    const char* name;
    const char* map;   // the kind of map that it reads; "": the application's own
    int set, slot;     // -1: by name
    int sampler_slot;  // of the sampler state where it is apart; -1: it is not
    int dimension;     // 2, or 3: a volume
    bool nearest;      // filter; else linear.  Every axis repeats
    bool one_level;    // give it no mipmaps
};
template <typename T>
struct List {
    const T* data;
    std::size_t size;
    constexpr const T* begin() const { return data; }
    constexpr const T* end() const { return data + size; }
};
struct Stage {
    Code text, binary;
    int set, binding;                // of the uniforms' buffer; -1: there is none
    int first_register, registers;   // of the uniforms, c#; -1: there are none
    int uniform_bytes;               // sizeof(VertexUniforms) or of PixelUniforms; 0: no uniforms
    List<Uniform> uniforms;
    List<Sampler> samplers;
};
struct Variant {
    const char* name;
    const char* target;
    const char* composition;
    Stage vertex, pixel;
};
)";

void write_lookup(TextBuilder& out, const std::vector<const BuiltVariant*>& variants) {
    out.line("inline constexpr const Variant* variants[] = {");
    out.indent();
    for (const BuiltVariant* each : variants)
        out.format("&{}::variant,", each->order.request.target);
    out.outdent();
    out.line("};");
    out.line();
    out.line("// By its name or its target; null where there is none.");
    out.line("inline constexpr const Variant* find(std::string_view name) {");
    out.line("    for (const Variant* each : variants)");
    out.line("        if (name == each->name || name == each->target) return each;");
    out.line("    return nullptr;");
    out.line("}");
}

}  // namespace

bool is_namespace(std::string_view text) {
    while (!text.empty()) {
        const std::size_t colons = text.find("::");
        const std::string_view part = text.substr(0, colons);
        if (!is_surface_name(part) || scene::is_word_of_cpp(part)) return false;
        if (colons == std::string_view::npos) return true;
        text.remove_prefix(colons + 2);
        if (text.empty()) return false;
    }
    return true;
}

std::string header_text(const std::string& surface,
                        const std::vector<const BuiltVariant*>& variants,
                        const std::vector<MapRecord>& maps, const std::string& name_space) {
    const std::string outer = (name_space.empty() ? "" : name_space + "::") + identifier(surface);
    TextBuilder out;
    out.format("// The surface {}: its shaders and what they want from an application.", surface);
    out.line("// Made by `intaglio build`; changes are lost.");
    out.line("#pragma once");
    out.line();
    out.line("#include <cstddef>");
    out.line("#include <cstdint>");
    out.line("#include <string_view>");
    out.line();
    out.format("namespace {} {{", outer);
    out.line();
    out.line(types.substr(0, types.size() - 1));
    out.line();
    for (const BuiltVariant* each : variants) write_variant(out, *each, maps);
    write_lookup(out, variants);
    out.line();
    out.format("}}  // namespace {}", outer);
    return out.take();
}

}  // namespace intaglio::build
