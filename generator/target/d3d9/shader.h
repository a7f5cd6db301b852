// A Direct3D 9 shader in memory: what assembly text and bytecode both say.  The assembler, encoder,
// decoder, checker, interpreter and slot counter all work on this.  Facts: Direct3D 9 reference,
// "Asm Shader Reference"; the limits were probed on Direct3D's own validator.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "generator/ir/module.h"

namespace intaglio::d3d9 {

// ps_2_a and ps_2_b are one in text and bytecode, "ps_2_x" (version token 0xFFFF0201); their limits
// differ.
enum class Profile : std::uint8_t { ps_2_0, ps_2_a, ps_2_b, ps_3_0, vs_2_0, vs_3_0 };
inline bool is_pixel(Profile profile) { return profile <= Profile::ps_3_0; }

// In the order of the ops table (ops.h).
enum class Opcode : std::uint8_t {
    Nop,
    Mov,
    Add,
    Sub,
    Mad,
    Mul,
    Rcp,
    Rsq,
    Dp3,
    Dp4,
    Min,
    Max,
    Slt,
    Sge,
    Exp,
    Log,
    Lit,
    Dst,
    Lrp,
    Frc,
    M4x4,
    M4x3,
    M3x4,
    M3x3,
    M3x2,
    Pow,
    Crs,
    Sgn,
    Abs,
    Nrm,
    SinCos,
    Cmp,
    Dp2Add,
    Mova,
    Texld,
    Texldb,
    Texldp,
    Texldd,
    Texldl,
    Texkill,
    Dsx,
    Dsy,
    Call,
    CallNz,
    Loop,
    EndLoop,
    Ret,
    Label,
    Rep,
    EndRep,
    If,
    IfComp,
    Else,
    EndIf,
    Break,
    BreakComp,
    BreakP,
    SetP,
};

// Register files, with the letters of the text: r c v t s i b a0 aL p0 oC oDepth oPos oFog oPts oD
// oT o vPos vFace l.
enum class File : std::uint8_t {
    Temp,
    Const,
    Input,
    Texture,
    Sampler,
    ConstInt,
    ConstBool,
    Address,
    LoopCounter,
    Predicate,
    ColourOut,
    DepthOut,
    PositionOut,
    FogOut,
    PointSizeOut,
    AttributeOut,
    TexcoordOut,
    Output,
    Position,
    Face,
    Label,
};

enum class Modifier : std::uint8_t { None, Negate, Abs, AbsNegate, Not };

using Swizzle = std::array<std::uint8_t, 4>;  // source component of each lane, 0..3
inline constexpr Swizzle identity_swizzle = {0, 1, 2, 3};
inline constexpr Swizzle replicate(int component) {
    const auto c = static_cast<std::uint8_t>(component);
    return {c, c, c, c};
}

using Mask = std::uint8_t;  // bit 0: x
inline constexpr Mask full_mask = 0xF;

// c[a0.x + n] and the like: the register that is added, and its component (0 for aL).
struct Relative {
    File file = File::Address;
    int component = 0;
    friend bool operator==(const Relative&, const Relative&) = default;
};

struct Source {
    using Relative = d3d9::Relative;
    File file = File::Temp;
    int index = 0;
    Swizzle swizzle = identity_swizzle;
    Modifier modifier = Modifier::None;
    std::optional<Relative> relative = {};
    friend bool operator==(const Source&, const Source&) = default;
};

struct Destination {
    File file = File::Temp;
    int index = 0;
    Mask mask = full_mask;
    bool saturate = false;                  // _sat
    bool partial_precision = false;         // _pp
    bool centroid = false;                  // _centroid, on declarations
    std::optional<Relative> relative = {};  // o[aL + n], vs_3_0 only
    friend bool operator==(const Destination&, const Destination&) = default;
};

enum class Comparison : std::uint8_t {
    None,
    Greater,
    Equal,
    GreaterEqual,
    Less,
    NotEqual,
    LessEqual
};

struct Instruction {
    Opcode op = Opcode::Nop;
    Comparison comparison = Comparison::None;  // IfComp, BreakComp, SetP
    std::optional<Destination> destination = {};
    std::vector<Source> sources;
    std::optional<Source> predicate = {};  // (p0.x) or (!p0)
    ir::Origin origin;                     // where it comes from; not in the bytecode, not compared
    friend bool operator==(const Instruction& a, const Instruction& b) {
        return a.op == b.op && a.comparison == b.comparison && a.destination == b.destination &&
               a.sources == b.sources && a.predicate == b.predicate;
    }
};

enum class Usage : std::uint8_t {
    Position,
    BlendWeight,
    BlendIndices,
    Normal,
    PointSize,
    Texcoord,
    Tangent,
    Binormal,
    TessFactor,
    PositionT,
    Color,
    Fog,
    Depth,
    Sample,
};
enum class SamplerKind : std::uint8_t { None, Texture2D, Cube, Volume };

// dcl_texcoord0 v0.xy, dcl t0.xy, dcl_2d s0
struct Declaration {
    Destination target;
    Usage usage = Usage::Position;  // meaningful for vs inputs, vs_3_0 outputs, ps_3_0 inputs
    int usage_index = 0;
    SamplerKind sampler = SamplerKind::None;
    friend bool operator==(const Declaration&, const Declaration&) = default;
};

// def c0, 1, 0.5, 0, 0   (float bits; int32 for defi; 0 or 1 in [0] for defb)
struct Definition {
    File file = File::Const;
    int index = 0;
    std::array<std::uint32_t, 4> bits{};
    friend bool operator==(const Definition&, const Definition&) = default;
};

// One row of the constant table (CTAB) by which engines bind uniforms and samplers by name.
struct Constant {
    enum class Set : std::uint8_t { Bool, Int4, Float4, Sampler };
    std::string name;
    Set set = Set::Float4;
    int index = 0;     // first register
    int count = 1;     // registers
    int columns = 1;   // of a vector, 1 to 4; 0 for samplers
    int elements = 1;  // of an array
    int rows = 1;      // of a matrix, one column a register; 1 otherwise
    friend bool operator==(const Constant&, const Constant&) = default;
};

struct Shader {
    Profile profile = Profile::ps_2_0;
    std::vector<Declaration> declarations;
    std::vector<Definition> definitions;
    std::vector<Instruction> instructions;
    std::vector<Constant> constants;  // by set, then index
    std::vector<ir::Step> steps;  // what Origin::step points to; not in the bytecode, not compared
    std::vector<std::string> files;  // what Origin::file points to; likewise
    friend bool operator==(const Shader& a, const Shader& b) {
        return a.profile == b.profile && a.declarations == b.declarations &&
               a.definitions == b.definitions && a.instructions == b.instructions &&
               a.constants == b.constants;
    }
};

// "ps_2_b" ...
std::string_view name_of(Profile profile);
std::optional<Profile> profile_named(std::string_view name);
// "ps_2_x" for ps_2_a and ps_2_b: the first word of the text.
std::string_view version_of(Profile profile);
// The profile of a version word; ps_2_x is `x_profile`, which is ps_2_a or ps_2_b.
std::optional<Profile> profile_of_version(std::string_view version, Profile x_profile);
// "texcoord" ...
std::string_view name_of(Usage usage);
std::optional<Usage> usage_named(std::string_view name);

// How a register file is spelled and encoded.  Two files may share a token type; the profile tells
// them apart.
struct FileInfo {
    File file;
    std::string_view name;  // "r", "oC", "vPos"
    bool numbered;          // r3 has a number, vPos and aL have none
    std::uint8_t type;      // D3DSPR_*
    std::uint8_t index;     // of an unnumbered register, in the token
    std::uint8_t profiles;  // bit i: Profile i can name it
};
const FileInfo& info(File file);
// Whether the profile has such a register at all; which numbers it has is the checker's matter.
bool has_file(Profile profile, File file);
// The file that a token's type and register number mean in this profile, if any.
std::optional<File> file_of_type(Profile profile, std::uint32_t type, std::uint32_t index);
// The file of a register's letters in this profile ("oC", "vPos"), if any.
std::optional<File> file_named(Profile profile, std::string_view letters);
// The highest register number that the encoding can say.
inline constexpr int last_register = 2047;
// Whether its declaration carries a usage: vertex inputs, vs_3_0 outputs, ps_3_0 inputs.
bool has_usage(Profile profile, File file);
// Whether dcl may name it: samplers, inputs, vs_3_0 outputs, vPos and vFace.
bool can_declare(File file);

}  // namespace intaglio::d3d9
