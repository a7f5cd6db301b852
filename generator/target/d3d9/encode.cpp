// Writes the tokens in the order in which Direct3D's assembler does.
#include "generator/target/d3d9/bytecode.h"
#include "generator/target/d3d9/constant_table.h"
#include "generator/target/d3d9/ops.h"
#include "generator/target/d3d9/tokens.h"

namespace intaglio::d3d9 {
namespace {

using Stream = std::vector<std::uint32_t>;

std::uint32_t register_token(File file, int index) {
    const FileInfo& row = info(file);
    const std::uint32_t number = row.numbered ? static_cast<std::uint32_t>(index) : row.index;
    return tokens::parameter | tokens::type_bits(row.type) | number;
}

std::uint32_t swizzle_bits(const Swizzle& swizzle) {
    std::uint32_t bits = 0;
    for (std::uint32_t lane = 0; lane < 4; ++lane)
        bits |= static_cast<std::uint32_t>(swizzle[lane]) << (tokens::swizzle_shift + 2 * lane);
    return bits;
}

// aL has no component; a0's is replicated.
void append_relative(Stream& stream, const std::optional<Relative>& relative) {
    if (!relative) return;
    stream.back() |= tokens::relative;
    const bool address = relative->file == File::Address;
    stream.push_back(register_token(relative->file, 0) |
                     swizzle_bits(address ? replicate(relative->component) : identity_swizzle));
}

void append(Stream& stream, const Destination& destination) {
    stream.push_back(register_token(destination.file, destination.index) |
                     static_cast<std::uint32_t>(destination.mask) << tokens::mask_shift |
                     (destination.saturate ? tokens::saturate : 0) |
                     (destination.partial_precision ? tokens::partial_precision : 0) |
                     (destination.centroid ? tokens::centroid : 0));
    append_relative(stream, destination.relative);
}

void append(Stream& stream, const Source& source) {
    const std::uint32_t modifier = tokens::modifiers[static_cast<std::size_t>(source.modifier)];
    stream.push_back(register_token(source.file, source.index) | swizzle_bits(source.swizzle) |
                     modifier << tokens::modifier_shift);
    append_relative(stream, source.relative);
}

void append(Stream& stream, const Definition& definition) {
    const bool boolean = definition.file == File::ConstBool;
    const std::uint32_t opcode = boolean                             ? tokens::defb
                                 : definition.file == File::ConstInt ? tokens::defi
                                                                     : tokens::def;
    const std::size_t values = boolean ? 1 : 4;
    stream.push_back(opcode | static_cast<std::uint32_t>(values + 1) << tokens::length_shift);
    append(stream, Destination{.file = definition.file, .index = definition.index});
    stream.insert(stream.end(), definition.bits.begin(),
                  definition.bits.begin() + static_cast<std::ptrdiff_t>(values));
}

void append(Stream& stream, const Declaration& declaration, Profile profile) {
    stream.push_back(tokens::dcl | 2u << tokens::length_shift);
    std::uint32_t token = tokens::parameter;
    if (has_usage(profile, declaration.target.file))
        token |= static_cast<std::uint32_t>(declaration.usage) |
                 static_cast<std::uint32_t>(declaration.usage_index) << tokens::usage_index_shift;
    if (declaration.sampler != SamplerKind::None)
        token |= (static_cast<std::uint32_t>(declaration.sampler) + 1) << tokens::kind_shift;
    stream.push_back(token);
    append(stream, declaration.target);
}

void append(Stream& stream, const Instruction& instruction) {
    const OpInfo& row = info(instruction.op);
    const std::size_t begin = stream.size();
    const std::uint32_t control =
        row.has(Trait::Compares) ? static_cast<std::uint32_t>(instruction.comparison) : row.control;
    stream.push_back(row.token | control << tokens::control_shift);
    if (instruction.destination) append(stream, *instruction.destination);
    if (instruction.predicate) {
        stream[begin] |= tokens::predicated;
        append(stream, *instruction.predicate);
    }
    for (const Source& source : instruction.sources) append(stream, source);
    stream[begin] |= static_cast<std::uint32_t>(stream.size() - begin - 1) << tokens::length_shift;
}

}  // namespace

std::uint32_t version_token(Profile profile) {
    return tokens::versions[static_cast<std::size_t>(profile)];
}

std::vector<std::uint32_t> encode(const Shader& shader, bool constant_table) {
    Stream stream = {version_token(shader.profile)};
    if (constant_table) {
        const auto table = build_constant_table(shader, stream[0]);
        stream.push_back(tokens::comment | static_cast<std::uint32_t>(table.size() + 1)
                                               << tokens::comment_length_shift);
        stream.push_back(constant_table_tag);
        stream.insert(stream.end(), table.begin(), table.end());
    }
    for (const Definition& definition : shader.definitions) append(stream, definition);
    for (const Declaration& declaration : shader.declarations)
        append(stream, declaration, shader.profile);
    for (const Instruction& instruction : shader.instructions) append(stream, instruction);
    stream.push_back(tokens::end);
    return stream;
}

}  // namespace intaglio::d3d9
