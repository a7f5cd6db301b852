// What a shader must write, and how: oC# and oDepth of model 2, scalar outputs, the position of a
// vertex shader.
#include <array>

#include <fmt/format.h>

#include "generator/target/d3d9/assembly.h"
#include "generator/target/d3d9/legality_rules.h"
#include "generator/target/d3d9/ops.h"

namespace intaglio::d3d9::rules {
namespace {

bool is_colour(const Instruction& it) {
    return it.destination && it.destination->file == File::ColourOut;
}
bool is_depth(const Instruction& it) {
    return it.destination && it.destination->file == File::DepthOut;
}

// Outputs of one component: oDepth, oFog, oPts, and the o# that is declared as the point size.
bool is_scalar(const Shader& shader, const Destination& d) {
    if (d.file == File::DepthOut || d.file == File::FogOut || d.file == File::PointSizeOut)
        return true;
    if (d.file != File::Output) return false;
    for (const Declaration& declaration : shader.declarations)
        if (declaration.target.file == File::Output && declaration.target.index == d.index &&
            declaration.usage == Usage::PointSize && declaration.usage_index == 0)
            return true;
    return false;
}

bool reads_lane_by_lane(const OpInfo& row) { return row.lanes == Lanes::Masked; }

// Instructions whose components differ in kind have none to give to a scalar.
bool never_scalar(const OpInfo& row) {
    return row.op == Opcode::Nrm || row.op == Opcode::Lit || row.op == Opcode::Dst ||
           row.matrix_rows > 0 || row.has(Trait::Texture);
}

void only_by_mov(const Check& check, int index) {
    const Instruction& it = check.shader.instructions[static_cast<std::size_t>(index)];
    const Destination& d = *it.destination;
    const std::string name = text_of(Destination{d.file, d.index});
    if (it.op != Opcode::Mov) {
        check.refuse("output-mov",
                     fmt::format("{} writes {} only by mov, not by {}", check.limits.name, name,
                                 info(it.op).mnemonic),
                     index);
        return;
    }
    if (d.mask != full_mask)
        check.refuse("output-mask",
                     fmt::format("{} writes {} whole, without a mask", check.limits.name, name),
                     index);
    if (d.saturate)
        check.refuse(
            "output-saturate",
            fmt::format("{} cannot saturate what is written to {}", check.limits.name, name),
            index);
    const Source& source = it.sources[0];
    if (source.modifier != Modifier::None || (is_colour(it) && source.swizzle != identity_swizzle))
        check.refuse("output-source",
                     fmt::format("{} moves a register to {} as it is, not {}", check.limits.name,
                                 name, text_of(source)),
                     index);
}

void scalar_output(const Check& check, int index) {
    const Instruction& it = check.shader.instructions[static_cast<std::size_t>(index)];
    const OpInfo& row = info(it.op);
    if (never_scalar(row)) {
        check.refuse("scalar-output",
                     fmt::format("{} is one component, which {} cannot write",
                                 text_of(Destination{it.destination->file, it.destination->index}),
                                 row.mnemonic),
                     index);
        return;
    }
    if (!reads_lane_by_lane(row)) return;
    for (const Source& source : it.sources)
        if (!is_replicate(source.swizzle)) {
            check.refuse(
                "scalar-output",
                fmt::format(
                    "{} is one component, so {} needs sources with .x, .y, .z or .w, not {}",
                    text_of(Destination{it.destination->file, it.destination->index}), row.mnemonic,
                    text_of(source)),
                index);
            return;
        }
}

// ps_2_0 takes the outputs strictly: oC0 and those above it without a gap, each once.
void in_order_and_once(const Check& check) {
    std::array<int, 4> colours{};
    int depths = 0;
    for (int i = 0; i < static_cast<int>(check.shader.instructions.size()); ++i) {
        const Instruction& it = check.shader.instructions[static_cast<std::size_t>(i)];
        int times = 0;
        if (is_depth(it)) times = ++depths;
        if (is_colour(it) && it.destination->index >= 0 && it.destination->index < 4)
            times = ++colours[static_cast<std::size_t>(it.destination->index)];
        if (times == 2)
            check.refuse("output-twice",
                         fmt::format("ps_2_0 writes {} once", text_of(*it.destination)), i);
    }
    if (colours[0] == 0) {
        check.refuse("output-missing", "ps_2_0 must write oC0");
        return;
    }
    for (std::size_t n = 1; n < 4; ++n)
        if (colours[n] > 0 && colours[n - 1] == 0)
            check.refuse("output-gap", fmt::format("ps_2_0 writes oC{} without oC{}", n, n - 1));
}

bool writes_position(const Shader& shader, const Instruction& it) {
    if (!it.destination) return false;
    if (it.destination->file == File::PositionOut) return true;
    if (it.destination->file != File::Output) return false;
    for (const Declaration& declaration : shader.declarations)
        if (declaration.target.file == File::Output &&
            declaration.target.index == it.destination->index &&
            declaration.usage == Usage::Position && declaration.usage_index == 0)
            return true;
    return false;
}

}  // namespace

void outputs(const Check& check) {
    const bool pixel_2 = check.limits.pixel() && !check.limits.model_3();
    bool written = false;
    for (int i = 0; i < static_cast<int>(check.shader.instructions.size()); ++i) {
        const Instruction& it = check.shader.instructions[static_cast<std::size_t>(i)];
        if (!check.limits.has(info(it.op)) || !well_formed(it, check.limits.profile)) continue;
        written |= check.limits.pixel() ? is_colour(it) || is_depth(it)
                                        : writes_position(check.shader, it);
        if (!it.destination) continue;
        if (pixel_2 && (is_colour(it) || is_depth(it))) only_by_mov(check, i);
        if (info(it.op).has(Trait::Writes) && is_scalar(check.shader, *it.destination) &&
            !(pixel_2 && it.op != Opcode::Mov))
            scalar_output(check, i);
    }
    if (check.limits.profile == Profile::ps_2_0)
        in_order_and_once(check);
    else if (check.limits.strict && !written)
        check.refuse("output-missing",
                     fmt::format("the {} shader writes no {}", check.limits.name,
                                 check.limits.pixel() ? "colour or depth" : "position"));
}

}  // namespace intaglio::d3d9::rules
