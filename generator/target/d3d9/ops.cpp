// The rows, in the order of Opcode; their order and completeness are checked while compiling.
#include "generator/target/d3d9/ops.h"

#include <array>

namespace intaglio::d3d9 {
namespace {

constexpr std::uint8_t ps20 = bit(Profile::ps_2_0), ps2a = bit(Profile::ps_2_a),
                       ps2b = bit(Profile::ps_2_b), ps30 = bit(Profile::ps_3_0),
                       vs20 = bit(Profile::vs_2_0), vs30 = bit(Profile::vs_3_0);
constexpr std::uint8_t pixel = ps20 | ps2a | ps2b | ps30, vertex = vs20 | vs30,
                       every = pixel | vertex;
constexpr std::uint8_t flow = ps30 | vertex;   // static flow control
constexpr std::uint8_t dynamic = ps30 | vs30;  // flow control that depends on computed values
constexpr std::uint8_t predicated = ps2a | ps30 | vs30;
constexpr std::uint8_t gradients = ps2a | ps30;

constexpr std::uint16_t none = 0;
constexpr auto w = static_cast<std::uint16_t>(Trait::Writes);
constexpr auto macro = w | Trait::Macro;
constexpr auto fetch = w | Trait::Texture;
constexpr auto fetch_gradients = fetch | Trait::NeedsGradients;
constexpr auto branch = static_cast<std::uint16_t>(Trait::Flow);
constexpr auto opens = branch | Trait::Opens;
constexpr auto closes = branch | Trait::Closes;
constexpr auto compares = Trait::Compares;

constexpr int op_count = static_cast<int>(Opcode::SetP) + 1;

// Opcode, mnemonic, token, control, sources, arithmetic slots, texture slots, profiles, traits,
// lanes, scalar sources, matrix rows.
constexpr std::array<OpInfo, op_count> rows = {{
    {Opcode::Nop, "nop", 0, 0, 0, 1, 0, every, none, Lanes::None, 0, 0},
    {Opcode::Mov, "mov", 1, 0, 1, 1, 0, every, w, Lanes::Masked, 0, 0},
    {Opcode::Add, "add", 2, 0, 2, 1, 0, every, w, Lanes::Masked, 0, 0},
    {Opcode::Sub, "sub", 3, 0, 2, 1, 0, every, w, Lanes::Masked, 0, 0},
    {Opcode::Mad, "mad", 4, 0, 3, 1, 0, every, w, Lanes::Masked, 0, 0},
    {Opcode::Mul, "mul", 5, 0, 2, 1, 0, every, w, Lanes::Masked, 0, 0},
    {Opcode::Rcp, "rcp", 6, 0, 1, 1, 0, every, w, Lanes::First, 1, 0},
    {Opcode::Rsq, "rsq", 7, 0, 1, 1, 0, every, w, Lanes::First, 1, 0},
    {Opcode::Dp3, "dp3", 8, 0, 2, 1, 0, every, w, Lanes::Dot3, 0, 0},
    {Opcode::Dp4, "dp4", 9, 0, 2, 1, 0, every, w, Lanes::Dot4, 0, 0},
    {Opcode::Min, "min", 10, 0, 2, 1, 0, every, w, Lanes::Masked, 0, 0},
    {Opcode::Max, "max", 11, 0, 2, 1, 0, every, w, Lanes::Masked, 0, 0},
    {Opcode::Slt, "slt", 12, 0, 2, 1, 0, vertex, w, Lanes::Masked, 0, 0},
    {Opcode::Sge, "sge", 13, 0, 2, 1, 0, vertex, w, Lanes::Masked, 0, 0},
    {Opcode::Exp, "exp", 14, 0, 1, 1, 0, every, w, Lanes::First, 1, 0},
    {Opcode::Log, "log", 15, 0, 1, 1, 0, every, w, Lanes::First, 1, 0},
    {Opcode::Lit, "lit", 16, 0, 1, 3, 0, vertex, macro, Lanes::Light, 0, 0},
    {Opcode::Dst, "dst", 17, 0, 2, 1, 0, vertex, w, Lanes::Distance, 0, 0},
    {Opcode::Lrp, "lrp", 18, 0, 3, 2, 0, every, macro, Lanes::Masked, 0, 0},
    {Opcode::Frc, "frc", 19, 0, 1, 1, 0, every, w, Lanes::Masked, 0, 0},
    {Opcode::M4x4, "m4x4", 20, 0, 2, 4, 0, every, macro, Lanes::Dot4, 0, 4},
    {Opcode::M4x3, "m4x3", 21, 0, 2, 3, 0, every, macro, Lanes::Dot4, 0, 3},
    {Opcode::M3x4, "m3x4", 22, 0, 2, 4, 0, every, macro, Lanes::Dot3, 0, 4},
    {Opcode::M3x3, "m3x3", 23, 0, 2, 3, 0, every, macro, Lanes::Dot3, 0, 3},
    {Opcode::M3x2, "m3x2", 24, 0, 2, 2, 0, every, macro, Lanes::Dot3, 0, 2},
    {Opcode::Pow, "pow", 32, 0, 2, 3, 0, every, macro, Lanes::First, 3, 0},
    {Opcode::Crs, "crs", 33, 0, 2, 2, 0, every, macro, Lanes::Cross, 0, 0},
    {Opcode::Sgn, "sgn", 34, 0, 3, 3, 0, vertex, macro, Lanes::Masked, 0, 0},
    {Opcode::Abs, "abs", 35, 0, 1, 1, 0, every, w, Lanes::Masked, 0, 0},
    {Opcode::Nrm, "nrm", 36, 0, 1, 3, 0, every, macro, Lanes::Normalize, 0, 0},
    {Opcode::SinCos, "sincos", 37, 0, 3, 8, 0, every, macro, Lanes::First, 1, 0},
    {Opcode::Cmp, "cmp", 88, 0, 3, 1, 0, pixel, w, Lanes::Masked, 0, 0},
    {Opcode::Dp2Add, "dp2add", 90, 0, 3, 2, 0, pixel, macro, Lanes::Dot2, 4, 0},
    {Opcode::Mova, "mova", 46, 0, 1, 1, 0, vertex, w, Lanes::Masked, 0, 0},

    {Opcode::Texld, "texld", 66, 0, 2, 0, 1, pixel, fetch_gradients, Lanes::Coordinate, 0, 0},
    {Opcode::Texldb, "texldb", 66, 2, 2, 0, 1, pixel, fetch_gradients, Lanes::Coordinate, 0, 0},
    {Opcode::Texldp, "texldp", 66, 1, 2, 0, 1, pixel, fetch_gradients, Lanes::Coordinate, 0, 0},
    {Opcode::Texldd, "texldd", 93, 0, 4, 2, 1, gradients, fetch, Lanes::Coordinate, 0, 0},
    {Opcode::Texldl, "texldl", 95, 0, 2, 1, 1, dynamic, fetch, Lanes::Coordinate, 0, 0},
    {Opcode::Texkill, "texkill", 65, 0, 0, 0, 1, pixel, Trait::Texture | Trait::ReadsDestination,
     Lanes::None, 0, 0},
    {Opcode::Dsx, "dsx", 91, 0, 1, 2, 0, gradients, w | Trait::NeedsGradients, Lanes::Masked, 0, 0},
    {Opcode::Dsy, "dsy", 92, 0, 1, 2, 0, gradients, w | Trait::NeedsGradients, Lanes::Masked, 0, 0},

    {Opcode::Call, "call", 25, 0, 1, 2, 0, flow, branch, Lanes::None, 0, 0},
    {Opcode::CallNz, "callnz", 26, 0, 2, 3, 0, flow, branch, Lanes::First, 0, 0},
    {Opcode::Loop, "loop", 27, 0, 2, 3, 0, flow, opens, Lanes::All, 0, 0},
    {Opcode::EndLoop, "endloop", 29, 0, 0, 2, 0, flow, closes, Lanes::None, 0, 0},
    {Opcode::Ret, "ret", 28, 0, 0, 1, 0, flow, branch, Lanes::None, 0, 0},
    {Opcode::Label, "label", 30, 0, 1, 0, 0, flow, branch, Lanes::None, 0, 0},
    {Opcode::Rep, "rep", 38, 0, 1, 3, 0, flow, opens, Lanes::All, 0, 0},
    {Opcode::EndRep, "endrep", 39, 0, 0, 2, 0, flow, closes, Lanes::None, 0, 0},
    {Opcode::If, "if", 40, 0, 1, 3, 0, flow, opens, Lanes::First, 0, 0},
    {Opcode::IfComp, "if", 41, 0, 2, 3, 0, dynamic, opens | compares, Lanes::First, 3, 0},
    {Opcode::Else, "else", 42, 0, 0, 1, 0, flow, opens | Trait::Closes, Lanes::None, 0, 0},
    {Opcode::EndIf, "endif", 43, 0, 0, 1, 0, flow, closes, Lanes::None, 0, 0},
    {Opcode::Break, "break", 44, 0, 0, 1, 0, dynamic, branch, Lanes::None, 0, 0},
    {Opcode::BreakComp, "break", 45, 0, 2, 3, 0, dynamic, branch | compares, Lanes::First, 3, 0},
    {Opcode::BreakP, "breakp", 96, 0, 1, 3, 0, dynamic, branch, Lanes::First, 0, 0},
    {Opcode::SetP, "setp", 94, 0, 2, 1, 0, predicated, w | compares, Lanes::Masked, 0, 0},
}};

constexpr bool in_order() {
    for (int i = 0; i < op_count; ++i)
        if (static_cast<int>(rows[static_cast<std::size_t>(i)].op) != i) return false;
    return true;
}
static_assert(in_order(), "the rows follow the order of Opcode, one each");

constexpr std::array<std::string_view, 7> comparisons = {"", "gt", "eq", "ge", "lt", "ne", "le"};

// The components a swizzle takes for the given lanes.
Mask through(const Swizzle& swizzle, unsigned lanes) {
    unsigned components = 0;
    for (unsigned lane = 0; lane < 4; ++lane)
        if (lanes >> lane & 1) components |= 1u << swizzle[lane];
    return static_cast<Mask>(components);
}

unsigned coordinate_lanes(Opcode op, SamplerKind kind) {
    const unsigned lanes = kind == SamplerKind::Texture2D ? 0x3
                           : kind == SamplerKind::None    ? 0xF
                                                          : 0x7;
    const bool takes_w = op == Opcode::Texldp || op == Opcode::Texldb || op == Opcode::Texldl;
    return takes_w ? lanes | 0x8 : lanes;
}

unsigned cross_lanes(unsigned mask) {
    return (mask & 1 ? 0x6u : 0u) | (mask & 2 ? 0x5u : 0u) | (mask & 4 ? 0x3u : 0u);
}

}  // namespace

const OpInfo& info(Opcode op) { return rows[static_cast<std::size_t>(op)]; }
std::span<const OpInfo> all_ops() { return rows; }

const OpInfo* op_of_token(std::uint32_t token, std::uint32_t control) {
    for (const OpInfo& row : rows)
        if (row.token == token && (row.control == control || row.has(Trait::Compares))) return &row;
    return nullptr;
}

const OpInfo* op_of_mnemonic(std::string_view mnemonic, bool with_comparison) {
    for (const OpInfo& row : rows)
        if (row.mnemonic == mnemonic && row.has(Trait::Compares) == with_comparison) return &row;
    return nullptr;
}

int source_count(Opcode op, Profile profile) {
    const bool model_3 = profile == Profile::ps_3_0 || profile == Profile::vs_3_0;
    return op == Opcode::SinCos && model_3 ? 1 : info(op).sources;
}

Slots slots_of(const Instruction& instruction) {
    const OpInfo& row = info(instruction.op);
    return {row.arithmetic_slots + (instruction.predicate ? 1 : 0), row.texture_slots};
}

Slots slots_of(const Shader& shader) {
    Slots sum;
    for (const Instruction& instruction : shader.instructions) {
        const Slots slots = slots_of(instruction);
        sum.arithmetic += slots.arithmetic;
        sum.texture += slots.texture;
    }
    return sum;
}

Mask components_read(const Instruction& instruction, int source, SamplerKind sampler) {
    const OpInfo& row = info(instruction.op);
    const Source& operand = instruction.sources[static_cast<std::size_t>(source)];
    const unsigned mask = instruction.destination ? instruction.destination->mask : 0xFu;
    const auto read = [&](unsigned lanes) { return through(operand.swizzle, lanes); };
    if (operand.file == File::Sampler || operand.file == File::Label) return 0;
    switch (row.lanes) {
        case Lanes::None: return 0;
        case Lanes::All: return read(0xF);
        case Lanes::First: return read(source == 0 || row.op != Opcode::SinCos ? 0x1 : 0xF);
        case Lanes::Masked: return read(row.op == Opcode::Sgn && source > 0 ? 0 : mask);
        case Lanes::Dot2: return read(source == 2 ? 0x1 : 0x3);
        case Lanes::Dot3: return read(0x7);
        case Lanes::Dot4: return read(0xF);
        case Lanes::Cross: return read(cross_lanes(mask));
        case Lanes::Normalize: return read(mask | 0x7);
        case Lanes::Light: return read(0xB);
        case Lanes::Distance: return read(source == 0 ? 0x6 : 0xA);
        case Lanes::Coordinate:
            if (source >= 2)  // texldd's gradients have the sampler's dimension
                return read(coordinate_lanes(Opcode::Texld, sampler));
            return read(coordinate_lanes(row.op, sampler));
    }
    return 0;
}

std::string_view name_of(Comparison comparison) {
    return comparisons[static_cast<std::size_t>(comparison)];
}

std::optional<Comparison> comparison_named(std::string_view name) {
    for (std::size_t i = 1; i < comparisons.size(); ++i)
        if (comparisons[i] == name) return static_cast<Comparison>(i);
    return std::nullopt;
}

}  // namespace intaglio::d3d9
