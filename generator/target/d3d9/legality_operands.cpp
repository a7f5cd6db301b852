// Rules inside one instruction: which registers it may name, how many of a kind, and with which
// swizzles, masks and modifiers; then the rules of each macro.
#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "generator/target/d3d9/assembly.h"
#include "generator/target/d3d9/legality_rules.h"
#include "generator/target/d3d9/ops.h"

namespace intaglio::d3d9::rules {
namespace {

bool is_texture(const OpInfo& row) { return row.has(Trait::Texture); }
bool is_condition(const OpInfo& row) {
    return row.op == Opcode::If || row.op == Opcode::CallNz || row.op == Opcode::BreakP;
}
bool is_matrix(const OpInfo& row) { return row.matrix_rows > 0; }
bool takes_abs(Modifier modifier) {
    return modifier == Modifier::Abs || modifier == Modifier::AbsNegate;
}
bool same_register(const Source& a, const Source& b) {
    return a.file == b.file && a.index == b.index && a.relative == b.relative;
}
bool same_register(const Destination& a, const Source& b) {
    return a.file == b.file && a.index == b.index;
}

class OneInstruction {
  public:
    OneInstruction(const Check& check, int index)
        : check_(check),
          index_(index),
          it_(check.shader.instructions[static_cast<std::size_t>(index)]),
          row_(info(it_.op)),
          limits_(check.limits) {}

    void run() {
        if (!limits_.has(row_)) {
            refuse("instruction",
                   fmt::format("{} has no instruction {}", limits_.name, row_.mnemonic));
            return;
        }
        if (!well_formed(it_, limits_.profile)) {
            refuse("operands", fmt::format("{} has the wrong number of operands", row_.mnemonic));
            return;
        }
        predicate();
        if (it_.destination) destination(*it_.destination);
        if (!sources()) return;
        if (it_.destination) modifiers_of_result(*it_.destination);
        ports();
        relative();
        if (is_matrix(row_)) matrix();
        macro();
    }

  private:
    void refuse(std::string rule, std::string message) const {
        check_.refuse(std::move(rule), std::move(message), index_);
    }
    bool pixel_2() const { return limits_.pixel() && !limits_.model_3(); }
    bool vertex() const { return !limits_.pixel(); }

    void predicate() const {
        if (!it_.predicate) return;
        if (!limits_.has(info(Opcode::SetP))) {
            refuse("predication", fmt::format("{} has no predication", limits_.name));
            return;
        }
        const Source& p = *it_.predicate;
        const bool readable = p.file == File::Predicate && p.index == 0 &&
                              (is_replicate(p.swizzle) || p.swizzle == identity_swizzle) &&
                              (p.modifier == Modifier::None || p.modifier == Modifier::Not);
        if (!readable)
            refuse("predicate",
                   "an instruction is predicated by p0, whole or one component, or its inverse");
        if (row_.has(Trait::Flow) || !row_.has_destination() || row_.op == Opcode::SetP)
            refuse("predicate", fmt::format("{} cannot be predicated", row_.mnemonic));
    }

    bool writable(File file) const {
        if (row_.op == Opcode::SetP) return file == File::Predicate;
        if (row_.op == Opcode::Mova) return file == File::Address;
        if (row_.op == Opcode::Texkill) {
            // Direct3D's validator lets ps_3_0 read an output here.
            if (file == File::ColourOut) return limits_.model_3() && !limits_.strict;
            return file == File::Temp || file == (limits_.model_3() ? File::Input : File::Texture);
        }
        if (file == File::Temp) return true;
        if (row_.op == Opcode::SinCos) return false;
        if (limits_.pixel()) {
            const bool output = file == File::ColourOut || file == File::DepthOut;
            return output;
        }
        const bool temps_only = row_.op == Opcode::Nrm || row_.op == Opcode::Pow ||
                                row_.op == Opcode::Lrp || row_.op == Opcode::Crs;
        if (temps_only) return false;
        if (limits_.model_3()) return file == File::Output;
        return file == File::PositionOut || file == File::FogOut || file == File::PointSizeOut ||
               file == File::AttributeOut || file == File::TexcoordOut;
    }

    void destination(const Destination& d) const {
        if (!writable(d.file))
            refuse("destination", fmt::format("{} cannot write {} in {}", row_.mnemonic,
                                              text_of(Destination{d.file, d.index}), limits_.name));
        if (d.mask == 0 || d.mask > full_mask)
            refuse("write-mask", fmt::format("{} writes no component", row_.mnemonic));
        if (pixel_2() && is_texture(row_) && d.mask != full_mask && d.file != File::ColourOut)
            refuse("texture-mask",
                   fmt::format("{} takes no write mask in {}", row_.mnemonic, limits_.name));
    }

    void modifiers_of_result(const Destination& d) const {
        const bool never = is_texture(row_) || row_.op == Opcode::Frc ||
                           row_.op == Opcode::SinCos || row_.op == Opcode::SetP ||
                           limits_.profile == Profile::vs_2_0 || row_.op == Opcode::Mova;
        if (d.saturate && never)
            refuse("saturate",
                   fmt::format("{} cannot saturate in {}", row_.mnemonic, limits_.name));
        if (d.partial_precision && vertex())
            refuse("partial-precision", fmt::format("{} has no partial precision", limits_.name));
    }

    // What source `i` may be, in the words of a message; empty if this register is fine.
    std::string_view not_readable(std::size_t i, File file) const {
        const bool arithmetic =
            file == File::Temp || file == File::Const || file == File::Input ||
            (limits_.pixel() && file == (limits_.model_3() ? File::Position : File::Texture));
        if (is_texture(row_)) {
            if (i == 1) return file == File::Sampler ? "" : "a sampler";
            if (i > 1) return arithmetic ? "" : "an arithmetic register";
            if (pixel_2()) return file == File::Temp || file == File::Texture ? "" : "r# or t#";
            return file == File::Temp || file == File::Const || file == File::Input
                       ? ""
                       : "r#, c# or v#";
        }
        const bool condition =
            file == File::ConstBool || (file == File::Predicate && limits_.has(info(Opcode::SetP)));
        switch (row_.op) {
            case Opcode::If: return condition ? "" : "b# or p0";
            case Opcode::BreakP: return file == File::Predicate ? "" : "p0";
            case Opcode::Rep: return file == File::ConstInt ? "" : "i#";
            case Opcode::Loop:
                return file == (i == 0 ? File::LoopCounter : File::ConstInt) ? "" : "aL and i#";
            case Opcode::Call:
            case Opcode::Label: return file == File::Label ? "" : "a label";
            case Opcode::CallNz:
                return i == 0 ? (file == File::Label ? "" : "a label")
                              : (condition ? "" : "b# or p0");
            case Opcode::IfComp:
            case Opcode::BreakComp:
            case Opcode::SetP:
                return arithmetic || file == File::Face ? "" : "an arithmetic register";
            case Opcode::Cmp:
                return arithmetic || (i == 0 && file == File::Face) ? "" : "an arithmetic register";
            default: return arithmetic ? "" : "an arithmetic register";
        }
    }

    bool sources() const {
        bool readable = true;
        for (std::size_t i = 0; i < it_.sources.size(); ++i) {
            const Source& source = it_.sources[i];
            const std::string_view expected = not_readable(i, source.file);
            if (!expected.empty()) {
                readable = false;
                refuse("source",
                       fmt::format("source {} of {} is {} in {}, not {}", i + 1, row_.mnemonic,
                                   expected, limits_.name, text_of(source)));
            }
        }
        if (!readable) return false;
        for (std::size_t i = 0; i < it_.sources.size(); ++i) {
            swizzle(i, it_.sources[i]);
            sign(i, it_.sources[i]);
        }
        return true;
    }

    static bool simple(const Swizzle& s) {
        constexpr Swizzle rotations[] = {
            identity_swizzle, {1, 2, 0, 3}, {2, 0, 1, 3}, {3, 2, 1, 0}};
        return is_replicate(s) ||
               std::find(std::begin(rotations), std::end(rotations), s) != std::end(rotations);
    }

    void swizzle(std::size_t i, const Source& source) const {
        const Swizzle& s = source.swizzle;
        switch (source.file) {
            case File::Label:
            case File::LoopCounter: return;
            case File::Face:
            case File::ConstBool: return;  // one component; the text has no swizzle for it
            case File::Predicate:
                if (!is_replicate(s))
                    refuse("scalar-swizzle",
                           fmt::format("{} needs one component of p0", row_.mnemonic));
                return;
            case File::ConstInt:
                if (s != identity_swizzle)
                    refuse("swizzle",
                           fmt::format("{} takes its i# without swizzle", row_.mnemonic));
                return;
            default: break;
        }
        if (is_texture(row_)) {
            if (pixel_2() && s != identity_swizzle)
                refuse("texture-swizzle",
                       fmt::format("{} takes no swizzles in {}, as in {}", row_.mnemonic,
                                   limits_.name, text_of(source)));
            return;
        }
        if ((row_.scalar_sources >> i & 1) != 0) {
            if (!is_replicate(s))
                refuse("scalar-swizzle",
                       fmt::format("source {} of {} needs one component (.x, .y, .z or .w), not {}",
                                   i + 1, row_.mnemonic, text_of(source)));
        } else if (!limits_.arbitrary_swizzle && !simple(s)) {
            refuse("swizzle",
                   fmt::format(
                       "{} has no swizzle as in {}; it has .xyzw, .x, .y, .z, .w, .yzxw, .zxyw "
                       "and .wzyx",
                       limits_.name, text_of(source)));
        }
    }

    void sign(std::size_t i, const Source& source) const {
        const Modifier m = source.modifier;
        if (m == Modifier::None) return;
        if (m == Modifier::Not) {
            if (!is_condition(row_))
                refuse("source-modifier",
                       fmt::format("{} cannot invert {}", row_.mnemonic, text_of(source)));
            return;
        }
        if (takes_abs(m) && !limits_.model_3()) {
            refuse("abs-modifier",
                   fmt::format("{} has no absolute value of a source; use the instruction abs",
                               limits_.name));
            return;
        }
        const bool number = !is_condition(row_) && row_.op != Opcode::Rep &&
                            row_.op != Opcode::Loop && source.file != File::Label;
        const bool gradient = row_.op == Opcode::Dsx || row_.op == Opcode::Dsy;
        if (!number || is_texture(row_) || (gradient && limits_.model_3()) ||
            (is_matrix(row_) && i == 1) || (source.file == File::Face && takes_abs(m)))
            refuse("source-modifier",
                   fmt::format("{} takes {} without sign or absolute value", row_.mnemonic,
                               text_of(Source{source.file, source.index})));
    }

    // Reads of constants and of inputs: the ports of the register files.
    void ports() const {
        const bool exempt = row_.op == Opcode::SinCos && it_.sources.size() == 3;
        std::vector<const Source*> constants, inputs;
        int constant_operands = 0, plain_abs = 0, with_abs = 0;
        const auto note = [](std::vector<const Source*>& seen, const Source& source) {
            for (const Source* other : seen)
                if (same_register(*other, source)) return;
            seen.push_back(&source);
        };
        for (const Source& source : it_.sources) {
            if (source.file == File::Const) {
                note(constants, source);
                ++constant_operands;
                ++(takes_abs(source.modifier) ? with_abs : plain_abs);
            } else if (source.file == File::Input || source.file == File::Texture) {
                note(inputs, source);
            }
        }
        if (constants.size() > 1 && !exempt)
            refuse("constant-port",
                   fmt::format(
                       "{} reads {} different constants; an instruction reads 1, so {} too many",
                       row_.mnemonic, constants.size(), constants.size() - 1));
        else if (constant_operands > limits_.constant_operands && !exempt)
            refuse("constant-operands",
                   fmt::format("{} names a constant in {} operands; {} allows {}, so {} too many",
                               row_.mnemonic, constant_operands, limits_.name,
                               limits_.constant_operands,
                               constant_operands - limits_.constant_operands));
        else if (with_abs > 0 && plain_abs > 0)
            refuse("abs-modifier",
                   fmt::format("{} takes the absolute value of some but not all of its constants",
                               row_.mnemonic));
        if (inputs.size() > 1)
            refuse(
                "input-port",
                fmt::format("{} reads {} different inputs; an instruction reads 1, so {} too many",
                            row_.mnemonic, inputs.size(), inputs.size() - 1));
    }

    bool relative_allowed(const Source& source) const {
        const File by = source.relative->file;
        if (source.file == File::Const)
            return vertex() && (by == File::Address || by == File::LoopCounter);
        return source.file == File::Input && limits_.model_3() && by == File::LoopCounter;
    }

    void relative() const {
        for (const Source& source : it_.sources)
            if (source.relative && !relative_allowed(source))
                refuse("relative-addressing", fmt::format("{} cannot address {} like that",
                                                          limits_.name, text_of(source)));
        if (!it_.destination || !it_.destination->relative) return;
        const Destination& d = *it_.destination;
        if (limits_.profile != Profile::vs_3_0 || d.file != File::Output ||
            d.relative->file != File::LoopCounter)
            refuse("relative-addressing",
                   fmt::format("{} cannot address {} like that", limits_.name, text_of(d)));
    }

    void matrix() const {
        const Source &vector = it_.sources[0], &first_row = it_.sources[1];
        const Destination& d = *it_.destination;
        const int components = row_.op == Opcode::M3x2                              ? 2
                               : row_.op == Opcode::M3x3 || row_.op == Opcode::M4x3 ? 3
                                                                                    : 4;
        if (d.mask != (1u << components) - 1u)
            refuse("macro-mask",
                   fmt::format("{} writes exactly its {} components", row_.mnemonic, components));
        if (first_row.swizzle != identity_swizzle &&
            (limits_.arbitrary_swizzle || simple(first_row.swizzle)))
            refuse("macro-operands",
                   fmt::format("the matrix of {} takes no swizzle", row_.mnemonic));
        const bool one_port = vector.file == first_row.file &&
                              (vector.file == File::Const || vector.file == File::Input ||
                               vector.file == File::Texture);
        if (one_port && same_register(vector, first_row))
            refuse(vector.file == File::Const ? "constant-port" : "input-port",
                   fmt::format("vector and matrix of {} go through one port", row_.mnemonic));
        const bool overlaps = d.file == first_row.file && d.index >= first_row.index &&
                              d.index < first_row.index + row_.matrix_rows;
        if (same_register(d, vector) || (overlaps && d.index > first_row.index))
            refuse("macro-registers",
                   fmt::format("{} cannot write {}, which it still reads", row_.mnemonic,
                               text_of(Destination{d.file, d.index})));
    }

    void keep_apart(std::initializer_list<std::size_t> sources) const {
        for (const std::size_t i : sources) {
            if (!same_register(*it_.destination, it_.sources[i])) continue;
            refuse("macro-registers",
                   fmt::format("{} cannot write {}, its source {}", row_.mnemonic,
                               text_of(Destination{it_.destination->file, it_.destination->index}),
                               i + 1));
            return;
        }
    }

    void macro() const {
        if (row_.op == Opcode::SinCos) return sine();
        if (row_.op == Opcode::Sgn) return signum();
        if (row_.op == Opcode::Lrp) return keep_apart({0, 2});
        if (row_.op == Opcode::Pow) return keep_apart({1});
        if (row_.op == Opcode::Nrm) {
            if ((it_.destination->mask & 0x7) != 0x7)
                refuse("macro-mask", "nrm writes .xyz or .xyzw");
            return keep_apart({0});
        }
        if (row_.op == Opcode::Crs) {
            if ((it_.destination->mask & 0x8) != 0)
                refuse("macro-mask", "crs writes only x, y and z");
            for (const Source& source : it_.sources)
                if (source.swizzle != identity_swizzle &&
                    (limits_.arbitrary_swizzle || simple(source.swizzle)))
                    refuse("macro-operands",
                           fmt::format("crs takes no swizzle, as in {}", text_of(source)));
            keep_apart({0, 1});
        }
    }

    void sine() const {
        const Mask mask = it_.destination->mask;
        if (mask < 1 || mask > 3) refuse("macro-mask", "sincos writes .x, .y or .xy");
        keep_apart({0});
        if (it_.sources.size() != 3) return;
        const Source &a = it_.sources[1], &b = it_.sources[2];
        const auto plain = [](const Source& source) {
            return source.file == File::Const && source.swizzle == identity_swizzle &&
                   source.modifier == Modifier::None;
        };
        if (!plain(a) || !plain(b) || same_register(a, b))
            refuse("macro-operands",
                   "sincos takes two different c# as they are, without swizzle or sign");
    }

    void signum() const {
        const Source &a = it_.sources[1], &b = it_.sources[2];
        const auto scratch = [](const Source& source) {
            return source.file == File::Temp && source.swizzle == identity_swizzle &&
                   source.modifier == Modifier::None;
        };
        if (!scratch(a) || !scratch(b) || same_register(a, b))
            refuse("macro-operands",
                   "sgn takes two different r# as scratch, without swizzle or sign");
        else if (same_register(it_.sources[0], a) || same_register(it_.sources[0], b))
            refuse("macro-registers", "sgn reads a register that it also uses as scratch");
    }

    const Check& check_;
    int index_;
    const Instruction& it_;
    const OpInfo& row_;
    const Limits& limits_;
};

}  // namespace

bool well_formed(const Instruction& instruction, Profile profile) {
    const OpInfo& row = info(instruction.op);
    return static_cast<int>(instruction.sources.size()) == source_count(instruction.op, profile) &&
           instruction.destination.has_value() == row.has_destination() &&
           (instruction.comparison != Comparison::None) == row.has(Trait::Compares);
}

void operands(const Check& check) {
    for (int i = 0; i < static_cast<int>(check.shader.instructions.size()); ++i)
        OneInstruction(check, i).run();
}

}  // namespace intaglio::d3d9::rules
