// The plan in three steps: forms (what is inlined), variables (what shares storage), and precise,
// which has a file of its own.
#include "generator/target/clike/plan.h"

#include <algorithm>
#include <cassert>

namespace intaglio::clike {
namespace {

using ir::Instruction;
using ir::Op;
using ir::Region;
using ir::ValueId;

// More operations than this in one expression, and a reader wants a name in between.
constexpr int longest_expression = 12;

bool is_leaf(Op op) { return op == Op::Constant || op == Op::Input || op == Op::Uniform; }

bool is_computed(const Instruction* definition) {
    return definition && !is_leaf(definition->op) && !ir::has_regions(definition->op);
}

// A read whose value is stored under another name at once: the value needs no name of its own.
bool is_store(const Use& use) {
    const Op op = use.user->op;
    return op == Op::Loop || op == Op::Yield || op == Op::Return ||
           (op == Op::BreakIf && use.operand > 0);
}

}  // namespace

bool is_splat(const ir::Module& module, const Instruction& instruction) {
    if (instruction.op == Op::Swizzle) return module.type(instruction.operands[0]).width == 1;
    if (instruction.op != Op::Compose) return false;
    const ValueId first = instruction.operands[0];
    return module.type(first).width == 1 &&
           std::all_of(instruction.operands.begin(), instruction.operands.end(),
                       [&](ValueId operand) { return operand == first; });
}

// Which values are part of the expression that reads them.  Works backwards, so that every reader
// is decided first.
class FormPlanner {
  public:
    explicit FormPlanner(Plan& plan)
        : plan_(plan),
          counts_(plan.module_.values.size()),
          sites_(counts_.size()),
          conditional_(counts_.size()) {}

    void run() {
        const auto& instructions = plan_.uses_.instructions();
        for (auto it = instructions.rbegin(); it != instructions.rend(); ++it) decide(**it);
        shorten_expressions();
    }

  private:
    Form& form(ValueId value) { return plan_.forms_[ir::index_of(value)]; }
    int& count(ValueId value) { return counts_[ir::index_of(value)]; }

    // Reads that lead to printed text.
    std::vector<Use> live_uses(ValueId value) {
        std::vector<Use> live;
        for (const Use& use : plan_.uses_.uses(value)) {
            const auto& results = use.user->results;
            if (ir::has_regions(use.user->op) || results.empty() || form(results[0]) != Form::Dead)
                live.push_back(use);
        }
        return live;
    }

    // Cheap enough to print wherever it is read: a component of something that has a name anyway.
    bool is_transparent(const Instruction& instruction) {
        const ValueId result = instruction.result();
        if (!plan_.module_.value(result).name.empty()) return false;
        if (instruction.op != Op::Swizzle && instruction.op != Op::ToFloat &&
            !is_splat(plan_.module_, instruction))
            return false;
        const ValueId operand = instruction.operands[0];
        if (!is_computed(plan_.uses_.definition(operand))) return true;
        if (instruction.op == Op::ToFloat) return false;
        return !plan_.module_.value(operand).name.empty() || live_uses(operand).size() > 1;
    }

    void decide(const Instruction& instruction) {
        if (ir::has_regions(instruction.op) || instruction.results.empty()) {
            for (ValueId result : instruction.results) form(result) = Form::Variable;
            for (ValueId operand : instruction.operands) ++count(operand);
            return;
        }
        const ValueId result = instruction.result();
        if (count(result) == 0) {
            form(result) = Form::Dead;
            return;
        }
        const bool transparent = is_transparent(instruction);
        form(result) = is_leaf(instruction.op) || transparent || can_inline(instruction)
                           ? Form::Inline
                           : Form::Local;
        for (ValueId operand : instruction.operands)
            count(operand) += transparent ? count(result) : 1;
    }

    bool can_inline(const Instruction& instruction) {
        const ValueId result = instruction.result();
        const std::vector<Use> live = live_uses(result);
        if (count(result) != 1 || live.size() != 1) return false;
        const Use& use = live[0];
        if (!plan_.module_.value(result).name.empty() && !is_store(use)) return false;
        Place site = plan_.uses_.place(*use.user);
        bool conditional =
            use.user->op == Op::And || use.user->op == Op::Or || use.user->op == Op::Select;
        if (use.user->results.size() == 1 && form(use.user->result()) == Form::Inline) {
            site = sites_[ir::index_of(use.user->result())];
            conditional = conditional || conditional_[ir::index_of(use.user->result())];
        }
        const Region& home = *plan_.uses_.home(result).region;
        if (plan_.uses_.crosses(home, *site.region, Op::Loop)) return false;
        // Neighbouring pixels must all take part in these.
        if (ir::needs_derivatives(instruction.op) &&
            (conditional || plan_.uses_.crosses(home, *site.region, Op::If)))
            return false;
        sites_[ir::index_of(result)] = site;
        conditional_[ir::index_of(result)] = conditional;
        return true;
    }

    void shorten_expressions() {
        std::vector<int> sizes(counts_.size());
        for (const Instruction* instruction : plan_.uses_.instructions()) {
            if (!is_computed(instruction) || instruction->results.empty()) continue;
            const ValueId result = instruction->result();
            int size = instruction->op == Op::Swizzle || instruction->op == Op::Compose ? 0 : 1;
            for (ValueId operand : instruction->operands)
                if (form(operand) == Form::Inline) size += sizes[ir::index_of(operand)];
            const bool long_part = size > longest_expression && instruction->op != Op::Compose;
            if (form(result) == Form::Inline && long_part) form(result) = Form::Local;
            sizes[ir::index_of(result)] = size;
        }
    }

    Plan& plan_;
    std::vector<int> counts_;   // how often the value is printed if it is inlined
    std::vector<Place> sites_;  // of an inlined value: the statement that it ends up in
    std::vector<bool>
        conditional_;  // of an inlined value: within an operand that may not be evaluated
};

// Which values live in which variable.  Times within a region count in halves: statement i runs at
// 2 i + 1, and a store that was moved before it at 2 i.
class VariablePlanner {
  public:
    explicit VariablePlanner(Plan& plan) : plan_(plan) {}

    void run(const Region& region) {
        for (const Instruction& instruction : region.body) {
            if (instruction.op == Op::Loop) plan_loop(instruction);
            if (instruction.op == Op::If) plan_if(instruction);
        }
    }

  private:
    struct Read {
        Place place;
        bool moved = false;  // by a store that was moved before the statement at this place
    };

    Form& form(ValueId value) { return plan_.forms_[ir::index_of(value)]; }
    int& variable(ValueId value) { return plan_.variables_of_[ir::index_of(value)]; }

    int new_variable(ir::Type type, std::initializer_list<ValueId> values) {
        Variable fresh{type, {}, false, false};
        for (ValueId value : values)
            if (fresh.name.empty()) fresh.name = plan_.module_.value(value).name;
        plan_.variables_.push_back(std::move(fresh));
        return static_cast<int>(plan_.variables_.size()) - 1;
    }

    void store(ValueId value, int in_variable) {
        form(value) = Form::Variable;
        variable(value) = in_variable;
    }

    const Instruction& terminator(const Region& region) const { return region.body.back(); }

    void collect_reads(ValueId value, std::vector<Read>& reads) {
        for (const Use& use : plan_.uses_.uses(value)) {
            const Instruction& user = *use.user;
            const Place place = plan_.uses_.place(user);
            if (user.results.size() == 1 && !ir::has_regions(user.op)) {
                if (form(user.result()) == Form::Dead) continue;
                if (form(user.result()) == Form::Inline) {
                    collect_reads(user.result(), reads);
                    continue;
                }
            }
            const Instruction* loop = plan_.uses_.owner(*place.region);
            const bool stores_next =
                loop && loop->op == Op::Loop && (user.op == Op::Yield || user.op == Op::BreakIf);
            const int carried = use.operand - (user.op == Op::BreakIf ? 1 : 0);
            if (stores_next && carried >= 0) {
                const auto planned = plan_.regions_.find(loop);
                const int moved =
                    planned == plan_.regions_.end()
                        ? -1
                        : planned->second.moved_before[static_cast<std::size_t>(carried)];
                const ValueId next =
                    terminator(*place.region).operands[static_cast<std::size_t>(carried)];
                if (user.op == Op::Yield && moved >= 0) {
                    reads.push_back({{place.region, moved}, true});
                    continue;
                }
                // A break after the move finds the value stored.
                if (user.op == Op::BreakIf && moved >= 0 && moved <= place.index && value == next)
                    continue;
            }
            reads.push_back({place, false});
        }
    }

    // The last time within the region at which the value is read; -1: never.
    int last_read(ValueId value, const Region& region) {
        std::vector<Read> reads;
        collect_reads(value, reads);
        int last = -1;
        for (const Read& read : reads) {
            const int index = plan_.uses_.ancestor_index(read.place, region);
            if (index < 0) continue;
            const bool here = read.place.region == &region;
            last = std::max(last, 2 * index + (here && read.moved ? 0 : 1));
        }
        return last;
    }

    bool read_inside(ValueId value, const Instruction& loop_or_if) {
        std::vector<Read> reads;
        collect_reads(value, reads);
        const Place place = plan_.uses_.place(loop_or_if);
        return std::any_of(reads.begin(), reads.end(), [&](const Read& read) {
            return read.place.region != place.region &&
                   plan_.uses_.ancestor_index(read.place, *place.region) == place.index;
        });
    }

    // Whether the loop or if may store into the storage of `value`, which it starts from, since
    // nobody reads the old value later.  A value that is computed at the same level becomes the
    // variable's first content.
    bool can_take_over(ValueId value, const Instruction& taker, const std::vector<int>& taken) {
        const Place place = plan_.uses_.place(taker);
        if (plan_.uses_.home(value).region != place.region) return false;
        if (form(value) == Form::Variable) {
            if (variable(value) < 0 ||
                plan_.variables_[static_cast<std::size_t>(variable(value))].index)
                return false;
            if (std::find(taken.begin(), taken.end(), variable(value)) != taken.end()) return false;
        } else if (form(value) != Form::Local) {
            return false;
        }
        if (last_read(value, *place.region) > 2 * place.index + 1) return false;
        return taker.op == Op::If || !read_inside(value, taker);
    }

    int take_over(ValueId value, std::initializer_list<ValueId> named) {
        if (form(value) == Form::Variable) return variable(value);
        const int fresh = new_variable(plan_.module_.type(value), named);
        store(value, fresh);
        return fresh;
    }

    void plan_loop(const Instruction& loop) {
        const Region& body = loop.regions[0];
        RegionPlan planned;
        for (std::size_t k = 0; k < loop.operands.size(); ++k) {
            const ValueId initial = loop.operands[k], parameter = body.parameters[k + 1],
                          result = loop.results[k];
            const ValueId next = terminator(body).operands[k];
            const bool shared = can_take_over(initial, loop, planned.variables);
            const int chosen = shared ? take_over(initial, {parameter, result, initial, next})
                                      : new_variable(plan_.module_.type(initial),
                                                     {parameter, result, initial, next});
            planned.variables.push_back(chosen);
            planned.declared.push_back(!shared);
            planned.moved_before.push_back(-1);
            store(parameter, chosen);
            store(result, chosen);
        }
        form(body.parameters[0]) = Form::Variable;
        variable(body.parameters[0]) = new_variable(ir::int1, {body.parameters[0]});
        plan_.variables_.back().index = true;
        plan_.regions_[&loop] = std::move(planned);
        run(body);
        store_early(loop);
    }

    void plan_if(const Instruction& branch) {
        RegionPlan planned;
        for (std::size_t j = 0; j < branch.results.size(); ++j) {
            const ValueId then_value = terminator(branch.regions[0]).operands[j];
            const ValueId else_value = terminator(branch.regions[1]).operands[j];
            const ValueId result = branch.results[j];
            int chosen = -1;
            for (ValueId old : {else_value, then_value})
                if (chosen < 0 && can_take_over(old, branch, planned.variables))
                    chosen = take_over(old, {result, old, then_value});
            planned.declared.push_back(chosen < 0);
            if (chosen < 0)
                chosen = new_variable(plan_.module_.type(result), {result, then_value, else_value});
            planned.variables.push_back(chosen);
            store(result, chosen);
        }
        planned.moved_before.assign(branch.results.size(), -1);
        plan_.regions_[&branch] = std::move(planned);
        for (const Region& region : branch.regions) run(region);
    }

    // Next values that are computed right into the loop's variables, where no old value is read
    // afterwards.
    struct Early {
        std::size_t carried;
        ValueId next;
        int index;  // of the statement in the body
        bool move;  // the next value is another variable's current one
        Form old_form;
        int old_variable;
    };

    void store_early(const Instruction& loop) {
        RegionPlan& planned = plan_.regions_[&loop];
        std::vector<Early> early = early_candidates(loop);
        for (bool changed = true; changed;) {
            changed = false;
            for (std::size_t i = 0; i < early.size() && !changed; ++i) {
                if (!reads_old_value_later(loop, early[i])) continue;
                const Early removed = early[i];
                early.erase(early.begin() + static_cast<std::ptrdiff_t>(i));
                undo(loop, removed);
                // Moves were to make way for it.
                for (auto it = early.begin(); !removed.move && it != early.end();) {
                    const bool follows = it->move && it->index == removed.index;
                    if (follows) planned.moved_before[it->carried] = -1;
                    it = follows ? early.erase(it) : it + 1;
                }
                changed = true;
            }
        }
    }

    std::vector<Early> early_candidates(const Instruction& loop) {
        const Region& body = loop.regions[0];
        RegionPlan& planned = plan_.regions_[&loop];
        std::vector<Early> early;
        const auto& next_values = terminator(body).operands;
        for (std::size_t k = 0; k < next_values.size(); ++k) {
            const ValueId next = next_values[k];
            const Place home = plan_.uses_.home(next);
            const Instruction* definition = plan_.uses_.definition(next);
            if (home.region != &body || !definition) continue;
            const bool computed = is_computed(definition) &&
                                  (form(next) == Form::Inline || form(next) == Form::Local);
            if (!computed && !owns_fresh_variable(*definition, next, planned.variables[k]))
                continue;
            early.push_back({k, next, home.index, false, form(next), variable(next)});
            rename(*definition, next, planned.variables[k]);
        }
        const std::size_t computed_count = early.size();
        for (std::size_t k = 0; k < next_values.size(); ++k)
            for (std::size_t other = 0; other < computed_count; ++other) {
                if (next_values[k] != body.parameters[early[other].carried + 1] ||
                    early[other].carried == k)
                    continue;
                const int index = early[other].index;
                early.push_back({k, next_values[k], index, true, Form::Variable, -1});
                planned.moved_before[k] = index;
            }
        return early;
    }

    // An if that declares a variable of its own for this result could store into the loop's, unless
    // another of its results took that over.
    bool owns_fresh_variable(const Instruction& definition, ValueId result, int storage) {
        if (definition.op != Op::If) return false;
        const RegionPlan& planned = plan_.regions_[&definition];
        if (std::find(planned.variables.begin(), planned.variables.end(), storage) !=
            planned.variables.end())
            return false;
        const auto j = std::find(definition.results.begin(), definition.results.end(), result);
        return planned.declared[static_cast<std::size_t>(j - definition.results.begin())];
    }

    void rename(const Instruction& definition, ValueId value, int to_variable) {
        store(value, to_variable);
        if (definition.op != Op::If) return;
        RegionPlan& planned = plan_.regions_[&definition];
        for (std::size_t j = 0; j < definition.results.size(); ++j)
            if (definition.results[j] == value) {
                planned.variables[j] = to_variable;
                planned.declared[j] = false;
            }
    }

    void undo(const Instruction& loop, const Early& early) {
        RegionPlan& planned = plan_.regions_[&loop];
        if (early.move) {
            planned.moved_before[early.carried] = -1;
            return;
        }
        form(early.next) = early.old_form;
        variable(early.next) = early.old_variable;
        const Instruction& definition = *plan_.uses_.definition(early.next);
        if (definition.op != Op::If) return;
        RegionPlan& inner = plan_.regions_[&definition];
        for (std::size_t j = 0; j < definition.results.size(); ++j)
            if (definition.results[j] == early.next) {
                inner.variables[j] = early.old_variable;
                inner.declared[j] = true;
            }
    }

    bool reads_old_value_later(const Instruction& loop, const Early& early) {
        const Region& body = loop.regions[0];
        const int storage = plan_.regions_[&loop].variables[early.carried];
        const int stored_at = early.move ? 2 * early.index : 2 * early.index + 1;
        for (std::size_t i = 0; i < plan_.variables_of_.size(); ++i) {
            const auto value = static_cast<ValueId>(i);
            if (plan_.variables_of_[i] != storage || (!early.move && value == early.next)) continue;
            if (plan_.uses_.home(value).region != &body) continue;
            if (last_read(value, body) > stored_at) return true;
        }
        return false;
    }

    Plan& plan_;
};

Plan::Plan(const ir::Module& module, PlanOptions options)
    : module_(module),
      uses_(module),
      forms_(module.values.size(), Form::Dead),
      variables_of_(module.values.size(), -1),
      precise_(module.values.size()) {
    FormPlanner(*this).run();
    VariablePlanner(*this).run(module.body);
    if (options.precise) mark_precise();
}

}  // namespace intaglio::clike
