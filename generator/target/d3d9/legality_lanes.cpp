// Reading what is not there: components that no declaration names, and those that some path to the
// read did not write. The second walks the structured code with one set of written components: an
// if meets its branches, a loop may not run at all unless its count is defined, a break carries its
// set to the loop's end, a call runs the subroutine in place.
#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "generator/target/d3d9/assembly.h"
#include "generator/target/d3d9/legality_rules.h"
#include "generator/target/d3d9/ops.h"

namespace intaglio::d3d9::rules {
namespace {

constexpr int temp_count = 32;

std::string component_names(unsigned mask) {
    std::string names = ".";
    for (unsigned i = 0; i < 4; ++i)
        if ((mask >> i & 1) != 0) names += "xyzw"[i];
    return names;
}

// What one operand reads of one register.
struct Read {
    File file;
    int index;
    unsigned components;
};

unsigned killing_mask(const Instruction& it, bool model_3) {
    return model_3 ? it.destination->mask : 0x7;  // a texkill of model 2 tests x, y and z
}

// nrm with a whole mask scales w, too; Direct3D's validator does not ask whether there is one.
Instruction only_xyz(Instruction it) {
    it.destination->mask = 0x7;
    return it;
}

std::vector<Read> reads_of(const Check& check, const Instruction& it) {
    std::vector<Read> reads;
    const OpInfo& row = info(it.op);
    if (row.has(Trait::ReadsDestination))
        reads.push_back({it.destination->file, it.destination->index,
                         killing_mask(it, check.limits.model_3())});
    const SamplerKind sampler = sampler_kind(check.shader, it);
    for (std::size_t i = 0; i < it.sources.size(); ++i) {
        const Source& source = it.sources[i];
        if (source.relative) {
            if (source.relative->file == File::Address)
                reads.push_back({File::Address, 0, 1u << (source.relative->component & 3)});
            continue;  // which register it names is known only when it runs
        }
        unsigned components = components_read(it, static_cast<int>(i), sampler);
        if (it.op == Opcode::Nrm && !check.limits.strict)
            components = components_read(only_xyz(it), static_cast<int>(i), sampler);
        // Nor does it look at gradients, nor in ps_2_x at anything that texldd reads.
        if (it.op == Opcode::Texldd && !check.limits.strict && (i >= 2 || !check.limits.model_3()))
            components = 0;
        const int registers = i == 1 && row.matrix_rows > 0 ? row.matrix_rows : 1;
        for (int r = 0; r < registers; ++r)
            reads.push_back({source.file, source.index + r, components});
    }
    if (it.predicate && check.limits.has(info(Opcode::SetP))) {
        reads.push_back({File::Predicate, 0,
                         it.predicate->swizzle == identity_swizzle
                             ? (it.destination ? it.destination->mask : 0xFu)
                             : 1u << it.predicate->swizzle[0]});
    }
    return reads;
}

bool usable(const Check& check, const Instruction& it) {
    return check.limits.has(info(it.op)) && well_formed(it, check.limits.profile);
}

// --- declarations
// -------------------------------------------------------------------------------------------------

bool must_be_declared(File file) {
    return file == File::Input || file == File::Texture || file == File::Position ||
           file == File::Face || file == File::Sampler;
}

void declared_reads(const Check& check) {
    std::map<std::pair<File, int>, unsigned> declared;
    for (const Declaration& d : check.shader.declarations)
        declared[{d.target.file, d.target.index}] |= d.target.mask;
    for (int i = 0; i < static_cast<int>(check.shader.instructions.size()); ++i) {
        const Instruction& it = check.shader.instructions[static_cast<std::size_t>(i)];
        if (!usable(check, it)) continue;
        const bool unseen =
            it.op == Opcode::Texldd && !check.limits.strict && !check.limits.model_3();
        for (const Source& source : it.sources)
            if (source.file == File::Sampler && !unseen &&
                declared.count({source.file, source.index}) == 0)
                check.refuse("undeclared-sampler",
                             fmt::format("{} is not declared",
                                         text_of(Destination{source.file, source.index})),
                             i);
        for (const Read& read : reads_of(check, it)) {
            if (!must_be_declared(read.file) || read.file == File::Sampler) continue;
            const unsigned missing = read.components & ~declared[{read.file, read.index}];
            const std::string name = text_of(Destination{read.file, read.index});
            if (missing == 0) continue;
            if (read.file == File::Face)
                check.refuse("undeclared-input", "vFace is not declared", i);
            else
                check.refuse(
                    "undeclared-input",
                    fmt::format("{}{} is read, but not declared", name, component_names(missing)),
                    i);
        }
        if (!it.destination || it.destination->file != File::Output || it.destination->relative)
            continue;
        const unsigned missing =
            it.destination->mask & ~declared[{File::Output, it.destination->index}];
        if (missing != 0)
            check.refuse("undeclared-output",
                         fmt::format("o{}{} is written, but not declared", it.destination->index,
                                     component_names(missing)),
                         i);
    }
}

// --- initialisation
// -----------------------------------------------------------------------------------------------

// Components that every path has written.  Under a predicate a component counts once it was written
// both where a component of p0 is true and where it is false.
struct Written {
    bool reached = true;
    std::array<std::uint8_t, temp_count> temps{};
    std::array<std::array<std::array<std::uint8_t, temp_count>, 4>, 2>
        under{};  // [inverse][component of p0]
    std::uint8_t address = 0, predicate = 0;

    friend bool operator==(const Written&, const Written&) = default;
};

Written meet(const Written& a, const Written& b) {
    if (!a.reached) return b;
    if (!b.reached) return a;
    Written both = a;
    for (std::size_t r = 0; r < temp_count; ++r) {
        both.temps[r] &= b.temps[r];
        for (std::size_t inverse = 0; inverse < 2; ++inverse)
            for (std::size_t c = 0; c < 4; ++c) {
                // Written outright on the one path counts as written under any predicate.
                const auto of = [&](const Written& w) {
                    return w.under[inverse][c][r] | w.temps[r];
                };
                both.under[inverse][c][r] = static_cast<std::uint8_t>(of(a) & of(b));
            }
    }
    both.address &= b.address;
    both.predicate &= b.predicate;
    return both;
}

class Initialisation {
  public:
    explicit Initialisation(const Check& check) : check_(check), code_(check.shader.instructions) {
        for (int i = 0; i < static_cast<int>(code_.size()); ++i)
            if (at(i).op == Opcode::Label && !at(i).sources.empty())
                labels_.emplace(at(i).sources[0].index, i);
        for (const Definition& definition : check.shader.definitions)
            if (definition.file == File::ConstInt)
                counts_[definition.index] = static_cast<std::int32_t>(definition.bits[0]);
    }

    void run() {
        Written written;
        block(0, written, nullptr, 0);
    }

  private:
    const Instruction& at(int i) const { return code_[static_cast<std::size_t>(i)]; }
    int size() const { return static_cast<int>(code_.size()); }
    static bool is_loop(Opcode op) { return op == Opcode::Rep || op == Opcode::Loop; }

    // Runs from `i` to what closes the block, or ret, or the end; answers where that is.
    int block(int i, Written& written, Written* left, int calls) {
        for (; i < size(); ++i) {
            const Instruction& it = at(i);
            const OpInfo& row = info(it.op);
            if (it.op == Opcode::Ret || row.has(Trait::Closes) || ++steps_ > most_steps) return i;
            if (!usable(check_, it)) continue;
            read(it, i, written);
            if (it.op == Opcode::If || it.op == Opcode::IfComp) {
                i = branches(i, written, left, calls);
            } else if (is_loop(it.op)) {
                i = loop(i, written, calls);
            } else if (it.op == Opcode::Call || it.op == Opcode::CallNz) {
                call(it, written, calls);
            } else if (it.op == Opcode::Break || it.op == Opcode::BreakComp ||
                       it.op == Opcode::BreakP) {
                if (left != nullptr) *left = meet(*left, written);
                if (it.op == Opcode::Break) written.reached = false;
            } else {
                write(it, written);
            }
        }
        return i;
    }

    int branches(int i, Written& written, Written* left, int calls) {
        Written otherwise = written;
        int end = block(i + 1, written, left, calls);
        if (end < size() && at(end).op == Opcode::Else)
            end = block(end + 1, otherwise, left, calls);
        written = meet(written, otherwise);
        return end;
    }

    int loop(int i, Written& written, int calls) {
        const Instruction& it = at(i);
        const auto count = counts_.find(it.sources.back().index);
        const bool runs = count != counts_.end() && count->second > 0;
        Written before = written, left;
        left.reached = false;
        int end = i;
        // A second round only if the first took something away (sincos does).
        for (int round = 0; round < 2; ++round) {
            written = before;
            end = block(i + 1, written, &left, calls);
            const Written entry = meet(before, written);
            if (entry == before) break;
            before = entry;
        }
        written = meet(written, left);
        if (!runs) written = meet(written, before);
        return end;
    }

    void call(const Instruction& it, Written& written, int calls) {
        const auto label = labels_.find(it.sources[0].index);
        if (label == labels_.end() || calls >= check_.limits.call_depth) return;
        const Written before = written;
        block(label->second + 1, written, nullptr, calls + 1);
        if (it.op == Opcode::CallNz) written = meet(written, before);
    }

    void read(const Instruction& it, int i, const Written& written) {
        if (!written.reached) return;
        for (const Read& read : reads_of(check_, it)) {
            unsigned there = 0;
            if (read.file == File::Temp && read.index >= 0 && read.index < temp_count)
                there = written.temps[static_cast<std::size_t>(read.index)];
            else if (read.file == File::Address)
                there = written.address;
            else if (read.file == File::Predicate)
                there = written.predicate;
            else
                continue;
            const unsigned missing = read.components & ~there;
            if (missing == 0 || !blamed_.insert({i, {read.file, read.index}}).second) continue;
            check_.refuse(
                "uninitialised",
                fmt::format("{}{} is read, but not written on every way here",
                            text_of(Destination{read.file, read.index}), component_names(missing)),
                i);
        }
    }

    void write(const Instruction& it, Written& written) const {
        if (!info(it.op).has(Trait::Writes)) return;
        const Destination& d = *it.destination;
        if (d.file == File::Address) written.address |= d.mask;
        if (d.file == File::Predicate) {
            written.predicate |= d.mask;
            written.under = {};
        }
        if (d.file != File::Temp || d.index < 0 || d.index >= temp_count) return;
        const auto r = static_cast<std::size_t>(d.index);
        if (it.predicate)
            write_under(*it.predicate, d.mask, r, written);
        else
            written.temps[r] |= d.mask;
        if (it.op == Opcode::SinCos && !check_.limits.model_3()) {
            // The expansion of model 2 uses what it does not write of x, y and z as scratch.
            const unsigned lost = 0x7u & ~static_cast<unsigned>(d.mask);
            written.temps[r] &= static_cast<std::uint8_t>(~lost);
        }
    }

    static void write_under(const Source& predicate, Mask mask, std::size_t r, Written& written) {
        const std::size_t inverse = predicate.modifier == Modifier::Not ? 1 : 0;
        for (std::size_t lane = 0; lane < 4; ++lane) {
            if ((mask >> lane & 1) == 0) continue;
            const std::size_t component = predicate.swizzle[lane] & 3u;
            const auto bit = static_cast<std::uint8_t>(1u << lane);
            written.under[inverse][component][r] |= bit;
            if ((written.under[1 - inverse][component][r] & bit) != 0) written.temps[r] |= bit;
        }
    }

    static constexpr int most_steps = 1 << 18;

    const Check& check_;
    const std::vector<Instruction>& code_;
    std::map<int, int> labels_;
    std::map<int, int> counts_;  // of i# that are defined in the shader
    std::set<std::pair<int, std::pair<File, int>>> blamed_;
    int steps_ = 0;
};

}  // namespace

SamplerKind sampler_kind(const Shader& shader, const Instruction& instruction) {
    if (instruction.sources.size() < 2 || instruction.sources[1].file != File::Sampler)
        return SamplerKind::None;
    for (const Declaration& declaration : shader.declarations)
        if (declaration.target.file == File::Sampler &&
            declaration.target.index == instruction.sources[1].index)
            return declaration.sampler;
    return SamplerKind::None;
}

void lanes(const Check& check) {
    declared_reads(check);
    // What is not well nested cannot be walked.
    for (const Violation& violation : check.violations)
        for (const char* rule : {"instruction", "operands", "flow-structure", "flow-depth"})
            if (violation.rule == rule) return;
    if (check.limits.initialised_lanes) Initialisation(check).run();
}

}  // namespace intaglio::d3d9::rules
