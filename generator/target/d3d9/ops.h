// The instructions of Direct3D 9 shaders: one table row each, read by the assembler, encoder,
// decoder, interpreter, slot counter and checker.  Slots are what Direct3D's own validator charges
// (lrp 2, nrm 3, sincos 8 ...), not what its disassembler prints.  Source: Direct3D 9 reference,
// "Instructions"; d3d9types.h for the opcode tokens.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "generator/target/d3d9/shader.h"

namespace intaglio::d3d9 {

// What kind of rules an instruction obeys; a row may carry several.
enum class Trait : std::uint16_t {
    Writes = 1 << 0,            // the destination is written
    ReadsDestination = 1 << 1,  // the destination is read instead: texkill
    Texture = 1 << 2,           // takes a texture slot; dependent-read rules apply
    Flow = 1 << 3,              // control flow
    Opens = 1 << 4,             // begins a block: if, else, rep, loop
    Closes = 1 << 5,            // ends a block: else, endif, endrep, endloop
    Compares = 1 << 6,          // carries a Comparison: if_lt, break_ge, setp_eq
    Macro = 1 << 7,             // expands to several slots; has rules of its own about operands
    NeedsGradients = 1 << 8,  // differs between neighbouring pixels, so refused where they may part
};
constexpr std::uint16_t operator|(Trait a, Trait b) {
    return static_cast<std::uint16_t>(static_cast<std::uint16_t>(a) |
                                      static_cast<std::uint16_t>(b));
}
constexpr std::uint16_t operator|(std::uint16_t a, Trait b) {
    return static_cast<std::uint16_t>(a | static_cast<std::uint16_t>(b));
}

// Which lanes of its sources, before the swizzle, an instruction looks at.
enum class Lanes : std::uint8_t {
    Masked,  // those of the write mask
    Dot2,
    Dot3,
    Dot4,
    First,       // scalar: the source's swizzle names one component
    Cross,       // the two others of each written lane
    Normalize,   // x, y, z, and those of the write mask
    Coordinate,  // what the sampler's dimension and the instruction need
    Light,
    Distance,  // lit, dst
    All,
    None,
};

constexpr std::uint8_t bit(Profile profile) {
    return static_cast<std::uint8_t>(1u << static_cast<unsigned>(profile));
}

struct OpInfo {
    Opcode op;
    std::string_view mnemonic;  // without modifiers and comparison: "if" is both If and IfComp
    std::uint16_t token;        // D3DSIO_*
    std::uint8_t control;       // bits 16 to 23 of the instruction token where they tell rows apart
                                // (texldp, texldb)
    std::uint8_t sources;  // operands after the destination; source_count() knows the one exception
    std::uint8_t arithmetic_slots;
    std::uint8_t texture_slots;
    std::uint8_t profiles;  // bit() of each profile that has it
    std::uint16_t traits;
    Lanes lanes;
    Mask scalar_sources;       // bit i: source i needs a swizzle that replicates one component
    std::uint8_t matrix_rows;  // m3x2: 2; the second source is that many registers

    constexpr bool has(Trait trait) const {
        return (traits & static_cast<std::uint16_t>(trait)) != 0;
    }
    constexpr bool has_destination() const {
        return has(Trait::Writes) || has(Trait::ReadsDestination);
    }
    constexpr bool is_in(Profile profile) const { return (profiles & bit(profile)) != 0; }
};

// The row of an instruction.
const OpInfo& info(Opcode op);
// All rows, in the order of the enumeration.
std::span<const OpInfo> all_ops();
// The row of an opcode token and its control bits, or nothing.  The control bits of comparing rows
// are ignored.
const OpInfo* op_of_token(std::uint32_t token, std::uint32_t control);
// The row of a mnemonic; `compares` tells if from if_lt, break from break_lt.
const OpInfo* op_of_mnemonic(std::string_view mnemonic, bool compares);

// Operands after the destination.  sincos takes two constants besides its angle before shader
// model 3.
int source_count(Opcode op, Profile profile);

// What Direct3D's validator charges one instruction: predication costs an arithmetic slot.
struct Slots {
    int arithmetic = 0;
    int texture = 0;
    int total() const { return arithmetic + texture; }
    friend bool operator==(const Slots&, const Slots&) = default;
};
Slots slots_of(const Instruction& instruction);
Slots slots_of(const Shader& shader);

// The register components that source number `source` of the instruction reads, after its swizzle.
// `sampler` is the kind of the sampler a texture instruction names (None: assume four coordinates).
Mask components_read(const Instruction& instruction, int source,
                     SamplerKind sampler = SamplerKind::None);

// "lt"; empty for None.  And back.
std::string_view name_of(Comparison comparison);
std::optional<Comparison> comparison_named(std::string_view name);

}  // namespace intaglio::d3d9
