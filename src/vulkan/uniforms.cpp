// Offsets and strides come from reflection.  Only the scalar type of a member is read here, from
// the SPIR-V: variable at (set, binding) -> pointer -> block -> member at this offset -> array or
// vector -> int or float.
#include "src/vulkan/uniforms.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <spirv/unified1/spirv.hpp>

namespace intaglio::vulkan {
namespace {

using Operands = std::span<const std::uint32_t>;

// What the search for a member's type needs of a module.
struct Types {
    std::map<std::uint32_t, std::pair<spv::Op, Operands>> types;  // operands after the result id
    std::map<std::uint32_t, std::uint32_t> variables;             // to their pointer type
    std::map<std::uint32_t, std::uint32_t> set, binding;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> offset;  // (struct, member)

    void read(spv::Op op, Operands operands) {
        switch (op) {
            case spv::OpTypeInt:
            case spv::OpTypeFloat:
            case spv::OpTypeVector:
            case spv::OpTypeArray:
            case spv::OpTypeStruct:
            case spv::OpTypePointer:
                if (!operands.empty()) types[operands[0]] = {op, operands.subspan(1)};
                break;
            case spv::OpVariable:
                if (operands.size() >= 2) variables[operands[1]] = operands[0];
                break;
            case spv::OpDecorate:
                if (operands.size() < 3) break;
                if (operands[1] == spv::DecorationDescriptorSet) set[operands[0]] = operands[2];
                if (operands[1] == spv::DecorationBinding) binding[operands[0]] = operands[2];
                break;
            case spv::OpMemberDecorate:
                if (operands.size() >= 4 && operands[2] == spv::DecorationOffset) {
                    offset[{operands[0], operands[1]}] = operands[3];
                }
                break;
            default: break;
        }
    }

    Scalar scalar_at(std::uint32_t type, std::uint32_t at) const {
        // The nesting of types ends, because a type only refers to earlier ones.
        while (types.count(type)) {
            const auto& [op, operands] = types.at(type);
            if (op == spv::OpTypeInt) return operands[1] ? Scalar::Int : Scalar::Uint;
            if (op == spv::OpTypeFloat || operands.empty()) break;
            if (op == spv::OpTypePointer) {
                type = operands[1];
            } else if (op != spv::OpTypeStruct) {
                type = operands[0];
            } else if (const auto member =
                           member_at(type, static_cast<std::uint32_t>(operands.size()), at)) {
                at -= offset.at({type, *member});
                type = operands[*member];
            } else {
                break;
            }
        }
        return Scalar::Float;
    }

  private:
    // The last member that begins at or before `at`.
    std::optional<std::uint32_t> member_at(std::uint32_t type, std::uint32_t count,
                                           std::uint32_t at) const {
        std::optional<std::uint32_t> best;
        for (std::uint32_t i = 0; i < count; ++i) {
            const auto found = offset.find({type, i});
            if (found == offset.end() || found->second > at) continue;
            if (!best || found->second > offset.at({type, *best})) best = i;
        }
        return best;
    }
};

Types read_types(const check::SpirvWords& module) {
    constexpr std::size_t header_words = 5;
    Types types;
    for (std::size_t at = header_words; at < module.size();) {
        const std::size_t count = module[at] >> spv::WordCountShift;
        if (count == 0 || at + count > module.size()) break;
        types.read(static_cast<spv::Op>(module[at] & spv::OpCodeMask),
                   Operands(module).subspan(at + 1, count - 1));
        at += count;
    }
    return types;
}

Result<std::uint32_t> encode(float value, const BlockMember& member) {
    std::uint32_t bits = 0;
    if (member.scalar == Scalar::Float) {
        if (!std::isfinite(value))
            return input_error("bad-uniform", fmt::format("the uniform '{}' is {}, not a number",
                                                          member.layout.name, value));
        std::memcpy(&bits, &value, sizeof bits);
        return bits;
    }
    const bool is_signed = member.scalar == Scalar::Int;
    const double low = is_signed ? -2147483648.0 : 0.0,
                 high = is_signed ? 2147483647.0 : 4294967295.0;
    if (!(value >= low && value <= high) || std::trunc(value) != value) {
        return input_error(
            "bad-uniform",
            fmt::format("the uniform '{}' is {} integer and cannot be {}", member.layout.name,
                        is_signed ? "an" : "an unsigned", value));
    }
    return is_signed ? static_cast<std::uint32_t>(static_cast<std::int32_t>(value))
                     : static_cast<std::uint32_t>(value);
}

}  // namespace

std::vector<BlockMember> typed_members(const check::SpirvWords& module,
                                       const check::Reflection::Block& block) {
    const Types types = read_types(module);
    std::uint32_t pointer = 0;
    for (const auto& [variable, type] : types.variables) {
        const auto set = types.set.find(variable), binding = types.binding.find(variable);
        if (set != types.set.end() && binding != types.binding.end() &&
            static_cast<int>(set->second) == block.set &&
            static_cast<int>(binding->second) == block.binding) {
            pointer = type;
        }
    }
    std::vector<BlockMember> members;
    for (const auto& member : block.members) {
        members.push_back(
            {member, types.scalar_at(pointer, static_cast<std::uint32_t>(member.offset))});
    }
    return members;
}

std::size_t value_count(const check::Reflection::Member& member) {
    return static_cast<std::size_t>(member.components) *
           static_cast<std::size_t>(std::max(1, member.array_count));
}

Status write_member(std::vector<std::byte>& block, const BlockMember& member,
                    const std::vector<float>& values) {
    const auto& layout = member.layout;
    constexpr int widest_element =
        16;  // of a float4; a wider stride holds arrays, matrices or structs
    if (layout.columns > 1 || layout.array_stride > widest_element ||
        (layout.array_stride == 0 && layout.size > 4 * layout.components)) {
        return input_error(
            "unsupported-resource",
            fmt::format("the uniform '{}' is a matrix, a struct or an array of such; declare it as "
                        "an array of float4 rows",
                        layout.name));
    }
    if (values.size() != value_count(layout)) {
        return input_error("bad-uniform",
                           fmt::format("the uniform '{}' takes {} values and was given {}",
                                       layout.name, value_count(layout), values.size()));
    }
    std::vector<std::byte> written = block;  // a refused value leaves the block alone
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::size_t element = i / static_cast<std::size_t>(layout.components);
        const std::size_t component = i % static_cast<std::size_t>(layout.components);
        const std::size_t at = static_cast<std::size_t>(layout.offset) +
                               element * static_cast<std::size_t>(layout.array_stride) +
                               4 * component;
        const Result<std::uint32_t> bits = encode(values[i], member);
        if (!bits) return bits.error();
        if (at + 4 > written.size()) {
            return internal_error("bad-uniform",
                                  fmt::format("the uniform '{}' ends at byte {} of a block of {}",
                                              layout.name, at + 4, block.size()));
        }
        std::memcpy(&written[at], &*bits, sizeof *bits);
    }
    block = std::move(written);
    return Done{};
}

}  // namespace intaglio::vulkan
