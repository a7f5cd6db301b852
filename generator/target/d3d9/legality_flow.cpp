// Blocks and subroutines: each closed, none too deep, and no gradients where neighbouring pixels
// may part.
#include <algorithm>
#include <map>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "generator/target/d3d9/legality_rules.h"
#include "generator/target/d3d9/ops.h"

namespace intaglio::d3d9::rules {
namespace {

bool is_dynamic_if(const Instruction& it) {
    return it.op == Opcode::IfComp ||
           (it.op == Opcode::If && it.sources[0].file == File::Predicate);
}
bool is_loop(Opcode op) { return op == Opcode::Rep || op == Opcode::Loop; }
bool is_break(Opcode op) {
    return op == Opcode::Break || op == Opcode::BreakComp || op == Opcode::BreakP;
}

// Four levels of calls, each of many: more instructions than any shader runs between loops.
constexpr int most_steps = 1 << 17;

struct Structure {
    std::map<int, int> labels;      // number of the label: its instruction
    std::vector<bool> loop_breaks;  // of each rep or loop: it is left by a break of its own
};

struct Depth {
    int fixed = 0, dynamic = 0, loops = 0, calls = 0;
    bool branched = false;  // inside a branch that neighbouring pixels may not all have taken
    // Inside a loop that they may not all have left.  As Direct3D's validator has it, only the
    // innermost loop counts.
    bool broken = false;
    bool counted = false;  // inside a loop, where aL has a value
};

class Flow {
  public:
    explicit Flow(const Check& check) : check_(check), code_(check.shader.instructions) {}

    void run() {
        if (!blocks()) return;
        if (const int flow = static_flow(); flow > check_.limits.static_flow)
            refuse("flow-count",
                   fmt::format("{} flow instructions; {} allows {}, so {} too many", flow,
                               check_.limits.name, check_.limits.static_flow,
                               flow - check_.limits.static_flow),
                   -1);
        walk(0, Depth{});
    }

  private:
    void refuse(std::string rule, std::string message, int at) const {
        if (std::find(refused_.begin(), refused_.end(), std::pair(rule, at)) != refused_.end())
            return;
        refused_.emplace_back(rule, at);
        check_.refuse(std::move(rule), std::move(message), at);
    }
    bool broken(std::string message, int at) const {
        refuse("flow-structure", std::move(message), at);
        return false;
    }
    const Instruction& at(int i) const { return code_[static_cast<std::size_t>(i)]; }
    int size() const { return static_cast<int>(code_.size()); }

    // Pairs of openers and closers, labels and rets; false: the rest has nothing to stand on.
    bool blocks() {
        std::vector<int> open;
        structure_.loop_breaks.assign(code_.size(), false);
        bool in_subroutine = false, ended = false;
        for (int i = 0; i < size(); ++i) {
            const Instruction& it = at(i);
            if (!check_.limits.has(info(it.op)) || !well_formed(it, check_.limits.profile)) {
                if (info(it.op).has(Trait::Flow)) return false;  // refused elsewhere
                continue;
            }
            if (it.op == Opcode::Label) {
                if (!ended) return broken("a label follows a ret", i);
                if (!structure_.labels.emplace(it.sources[0].index, i).second)
                    return broken(fmt::format("label l{} is defined twice", it.sources[0].index),
                                  i);
                in_subroutine = true;
                ended = false;
                continue;
            }
            if (ended) return broken("after a ret comes a label or the end", i);
            if (it.op == Opcode::Ret) {
                if (!open.empty()) return broken("ret stands outside of all blocks", i);
                ended = true;
            } else if (is_break(it.op)) {
                const auto loop = std::find_if(open.rbegin(), open.rend(),
                                               [&](int o) { return is_loop(at(o).op); });
                if (loop == open.rend()) return broken("break stands inside a rep or loop", i);
                structure_.loop_breaks[static_cast<std::size_t>(*loop)] = true;
            } else if (!open_or_close(open, i)) {
                return false;
            }
        }
        if (!open.empty())
            return broken(fmt::format("{} is never closed", info(at(open.back()).op).mnemonic),
                          open.back());
        if (in_subroutine && !ended) return broken("a subroutine ends with ret", size() - 1);
        return calls();
    }

    bool open_or_close(std::vector<int>& open, int i) const {
        const Opcode op = at(i).op;
        if (!info(op).has(Trait::Closes)) {
            if (info(op).has(Trait::Opens)) open.push_back(i);
            return true;
        }
        const Opcode opener = open.empty() ? Opcode::Nop : at(open.back()).op;
        const bool is_if = opener == Opcode::If || opener == Opcode::IfComp;
        bool fits = false;
        if (op == Opcode::Else) fits = is_if;
        if (op == Opcode::EndIf) fits = is_if || opener == Opcode::Else;
        if (op == Opcode::EndRep) fits = opener == Opcode::Rep;
        if (op == Opcode::EndLoop) fits = opener == Opcode::Loop;
        if (!fits)
            return broken(fmt::format("{} closes nothing that is open", info(op).mnemonic), i);
        open.pop_back();
        if (op == Opcode::Else) open.push_back(i);
        return true;
    }

    // Every call goes to a label further down, and every label is called.
    bool calls() const {
        std::map<int, bool> called;
        for (int i = 0; i < size(); ++i) {
            const Instruction& it = at(i);
            if (it.op != Opcode::Call && it.op != Opcode::CallNz) continue;
            const auto label = structure_.labels.find(it.sources[0].index);
            if (label == structure_.labels.end() || label->second < i)
                return broken(
                    fmt::format("l{} is called, but not defined further down", it.sources[0].index),
                    i);
            called[label->first] = true;
        }
        for (const auto& [number, index] : structure_.labels)
            if (!called[number])
                return broken(fmt::format("label l{} is never called", number), index);
        return true;
    }

    int static_flow() const {
        int flow = 0;
        for (const Instruction& it : code_)
            flow += it.op == Opcode::If || it.op == Opcode::Else || is_loop(it.op) ||
                    it.op == Opcode::Call || it.op == Opcode::CallNz;
        return flow;
    }

    void depth(const char* what, int depth, int limit, int at_index) const {
        if (depth > limit)
            refuse("flow-depth",
                   fmt::format("{} {} deep; {} allows {}, so {} too many", what, depth,
                               check_.limits.name, limit, depth - limit),
                   at_index);
    }

    // Walks code from `begin` to its ret, or the end, going into subroutines: they are entered in
    // order of definition only, so this ends.
    void walk(int begin, const Depth& outside) {
        std::vector<Depth> around = {outside};
        for (int i = begin; i < size(); ++i) {
            const Instruction& it = at(i);
            if (it.op == Opcode::Ret) return;
            if (++steps_ > most_steps) {
                refuse("flow-structure", "subroutines call each other too often to follow", -1);
                return;
            }
            if (!check_.limits.has(info(it.op)) || !well_formed(it, check_.limits.profile))
                continue;
            Depth inside = around.back();
            if (it.op == Opcode::If || it.op == Opcode::IfComp) {
                enter_if(it, i, inside);
                around.push_back(inside);
            } else if (is_loop(it.op)) {
                depth("loops are", ++inside.loops, check_.limits.loop_depth, i);
                inside.broken = structure_.loop_breaks[static_cast<std::size_t>(i)];
                inside.counted |= it.op == Opcode::Loop;
                around.push_back(inside);
            } else if (it.op == Opcode::Else) {
                continue;
            } else if (info(it.op).has(Trait::Closes)) {
                around.pop_back();
            } else if (it.op == Opcode::Call || it.op == Opcode::CallNz) {
                enter_call(it, i, inside);
            } else if (it.op == Opcode::BreakComp || it.op == Opcode::BreakP) {
                depth("conditions are", inside.dynamic + 1, check_.limits.dynamic_depth, i);
            } else {
                body(it, i, around.back());
            }
        }
    }

    void enter_if(const Instruction& it, int i, Depth& inside) const {
        if (!is_dynamic_if(it)) {
            depth("ifs on b# are", ++inside.fixed, check_.limits.static_depth, i);
            return;
        }
        depth("conditions are", ++inside.dynamic, check_.limits.dynamic_depth, i);
        inside.branched = true;
    }

    void enter_call(const Instruction& it, int i, Depth inside) {
        const bool dynamic = it.op == Opcode::CallNz && it.sources[1].file == File::Predicate;
        depth("calls are", ++inside.calls, check_.limits.call_depth, i);
        if (inside.calls > check_.limits.call_depth) return;
        if (dynamic) {
            depth("conditions are", ++inside.dynamic, check_.limits.dynamic_depth, i);
            inside.branched = true;
        }
        walk(structure_.labels.at(it.sources[0].index) + 1, inside);
    }

    void body(const Instruction& it, int i, const Depth& here) const {
        bool counter = it.destination && it.destination->relative &&
                       it.destination->relative->file == File::LoopCounter;
        for (const Source& source : it.sources)
            counter |= source.relative && source.relative->file == File::LoopCounter;
        if (counter && !here.counted)
            refuse("loop-counter", "aL has a value only inside a loop", i);

        if (!info(it.op).has(Trait::NeedsGradients) || !check_.limits.pixel()) return;
        const bool from_temp = it.sources[0].file == File::Temp;
        if (from_temp && (here.branched || here.broken || it.predicate))
            refuse("gradient-in-flow",
                   fmt::format("{} of an r# needs its neighbouring pixels, which may have gone "
                               "another way here; use texldl, "
                               "texldd or an interpolated coordinate",
                               info(it.op).mnemonic),
                   i);
    }

    const Check& check_;
    const std::vector<Instruction>& code_;
    Structure structure_;
    int steps_ = 0;
    mutable std::vector<std::pair<std::string, int>>
        refused_;  // a subroutine called twice is blamed once
};

}  // namespace

void flow(const Check& check) { Flow(check).run(); }

}  // namespace intaglio::d3d9::rules
