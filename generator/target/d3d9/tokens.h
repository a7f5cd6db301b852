// The bits of Direct3D 9 shader tokens, shared by the encoder and the decoder.  Source:
// d3d9types.h.
#pragma once

#include <array>
#include <cstdint>

namespace intaglio::d3d9::tokens {

inline constexpr std::uint32_t end = 0x0000FFFF, comment = 0xFFFE;
inline constexpr std::uint32_t dcl = 31, defb = 47, defi = 48, def = 81;
inline constexpr std::uint32_t versions[] = {0xFFFF0200, 0xFFFF0201, 0xFFFF0201,
                                             0xFFFF0300, 0xFFFE0200, 0xFFFE0300};

// Instruction: opcode 0-15, control 16-23, length 24-27 (comment: 16-30), predicated 28.
inline constexpr std::uint32_t opcode_mask = 0xFFFF, control_shift = 16, control_mask = 0xFF;
inline constexpr std::uint32_t length_shift = 24, length_mask = 0xF, predicated = 1u << 28;
inline constexpr std::uint32_t comment_length_shift = 16, comment_length_mask = 0x7FFF;
inline constexpr std::uint32_t instruction_reserved = 0xE0000000;

// Operand: number 0-10, high bits of the type 11-12, relative 13, low bits of the type 28-30,
// always 31.
inline constexpr std::uint32_t parameter = 1u << 31, number_mask = 0x7FF, relative = 1u << 13;
inline constexpr std::uint32_t parameter_reserved = 0xC000;
constexpr std::uint32_t type_bits(std::uint32_t type) {
    return (type & 7) << 28 | (type & 0x18) << 8;
}
constexpr std::uint32_t type_of(std::uint32_t token) {
    return (token >> 28 & 7) | (token >> 8 & 0x18);
}

// Destination: mask 16-19, modifiers 20-23, shift 24-27 (not in these profiles).
inline constexpr std::uint32_t mask_shift = 16, saturate = 1u << 20, partial_precision = 1u << 21;
inline constexpr std::uint32_t centroid = 1u << 22, destination_reserved = 0x0F800000;

// Source: swizzle 16-23, modifier 24-27, in the order of Modifier.
inline constexpr std::uint32_t swizzle_shift = 16, modifier_shift = 24, modifier_mask = 0xF;
inline constexpr std::array<std::uint32_t, 5> modifiers = {0, 1, 11, 12, 13};

// Declaration: usage 0-4, usage index 16-19, texture kind 27-30 (2D is 2), always 31.
inline constexpr std::uint32_t usage_mask = 0x1F, usage_index_shift = 16, usage_index_mask = 0xF;
inline constexpr std::uint32_t kind_shift = 27, kind_mask = 0xF, declaration_reserved = 0x07F0FFE0;

}  // namespace intaglio::d3d9::tokens
