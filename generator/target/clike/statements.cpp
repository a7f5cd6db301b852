// Follows the plan through the regions; what is stored at the end of a region is stored as if at
// once.
#include "generator/target/clike/statements.h"

#include <algorithm>

#include <fmt/format.h>

#include "generator/target/clike/layout.h"
#include "generator/target/target.h"

namespace intaglio::clike {
namespace {

using ir::Instruction;
using ir::Op;
using ir::Region;
using ir::ValueId;

struct Store {
    int variable;
    ValueId value;
};

class BodyPrinter {
  public:
    BodyPrinter(TextBuilder& out, const ir::Module& module, const Spelling& spelling,
                const OuterNames& outer, const Ending& ending, NameScope& scope)
        : out_(out),
          module_(module),
          spelling_(spelling),
          ending_(ending),
          scope_(scope),
          plan_(module, {.precise = !spelling.precise.empty()}),
          expressions_(module, plan_, spelling, outer),
          declared_(plan_.variables().size()) {}

    Status run() {
        if (!ending_.before.empty()) statement(ending_.before);
        print_region(module_.body);
        if (expressions_.error()) return *expressions_.error();
        if (error_) return *error_;
        return Done{};
    }

  private:
    void statement(std::string_view text) {
        put_statement(out_, text);
        at_start_ = false;
    }

    void open(std::string_view head) {
        statement(head);
        out_.indent();
        scope_.open();
        at_start_ = true;
    }

    void close(std::string_view tail = "}") {
        scope_.close();
        out_.outdent();
        out_.line(tail);
        at_start_ = false;
    }

    void begin_step(const Instruction& instruction) {
        const int step = instruction.origin.step;
        if (step < 0 || step == step_) return;
        step_ = step;
        const ir::Step& info = module_.steps[static_cast<std::size_t>(step)];
        if (!at_start_) out_.line();
        put_comment(out_, info.comment.empty() ? info.name : info.comment);
        at_start_ = false;
    }

    std::string_view type_of(ir::Type type) const {
        return type_name(spelling_, static_cast<int>(type.scalar), type.width);
    }

    // "precise float gap", naming the variable.
    std::string declare(int variable, std::string_view fallback) {
        const Variable& info = plan_.variables()[static_cast<std::size_t>(variable)];
        expressions_.name_variable(variable, scope_.declare(info.name, fallback));
        declared_[static_cast<std::size_t>(variable)] = true;
        return fmt::format("{}{} {}", info.precise ? spelling_.precise : "", type_of(info.type),
                           expressions_.variable_name(variable));
    }

    void print_region(const Region& region) {
        for (std::size_t i = 0; i < region.body.size(); ++i) {
            print_moves(region, static_cast<int>(i));
            print_instruction(region, region.body[i], static_cast<int>(i));
        }
    }

    void print_moves(const Region& region, int index) {
        const Instruction* loop = plan_.uses().owner(region);
        if (!loop || loop->op != Op::Loop) return;
        const RegionPlan& planned = plan_.region_plan(*loop);
        std::vector<Store> stores;
        for (std::size_t k = 0; k < planned.variables.size(); ++k)
            if (planned.moved_before[k] == index)
                stores.push_back({planned.variables[k], region.body.back().operands[k]});
        if (stores.empty()) return;
        begin_step(region.body[static_cast<std::size_t>(index)]);
        print_stores(std::move(stores));
    }

    void print_instruction(const Region& region, const Instruction& instruction, int index) {
        switch (instruction.op) {
            case Op::Loop: return print_loop(instruction);
            case Op::If: return print_if(instruction);
            case Op::BreakIf: return print_break(region, instruction, index);
            case Op::Yield: return print_stores(stores_at_end(region, instruction));
            case Op::Return: return print_return(instruction);
            default: return print_value(instruction);
        }
    }

    void print_value(const Instruction& instruction) {
        const ValueId result = instruction.result();
        const Form form = plan_.form(result);
        if (form == Form::Dead || form == Form::Inline) return;
        begin_step(instruction);
        const std::string text = expressions_.compute(instruction);
        const std::string_view fallback = fallback_name(module_, plan_.uses(), result);
        if (form == Form::Local) {
            const std::string name = scope_.declare(module_.value(result).name, fallback);
            statement(fmt::format("{}{} {} = {};",
                                  plan_.is_precise(result) ? spelling_.precise : "",
                                  type_of(module_.type(result)), name, text));
            expressions_.name_local(result, name);
            return;
        }
        const int variable = plan_.variable(result);
        if (!declared_[static_cast<std::size_t>(variable)]) {
            const std::string head = declare(variable, fallback);
            statement(fmt::format("{} = {};", head, text));
        } else {
            statement(fmt::format("{} = {};", expressions_.variable_name(variable), text));
        }
    }

    void print_loop(const Instruction& loop) {
        if (loop.loop.form == ir::LoopForm::Unrolled) {
            error_ = target_limit(
                module_, loop.origin,
                fmt::format("the loop {} was to be unrolled and was not", loop.loop.name));
            return;
        }
        begin_step(loop);
        const int step = step_;
        const RegionPlan& planned = plan_.region_plan(loop);
        const Region& body = loop.regions[0];
        for (std::size_t k = 0; k < loop.operands.size(); ++k) {
            if (!planned.declared[k]) continue;
            const std::string initial = expressions_.read(loop.operands[k]);
            statement(fmt::format("{} = {};", declare(planned.variables[k], "carried"), initial));
        }
        const int index_variable = plan_.variable(body.parameters[0]);
        const std::string& wanted =
            plan_.variables()[static_cast<std::size_t>(index_variable)].name;
        const bool free_choice = wanted.empty() || (wanted.size() == 1 && scope_.visible(wanted));
        const std::string index =
            scope_.declare_everywhere(free_choice ? next_index_name() : wanted);
        expressions_.name_variable(index_variable, index);
        const bool rolled = loop.loop.form == ir::LoopForm::Rolled;
        std::string next(spelling_.next_index);
        next.replace(next.find("%0"), 2, index);
        open(fmt::format("{}for (int {} = 0; {} < {}; {}) {{", rolled ? spelling_.rolled_loop : "",
                         index, index, loop.loop.trip_count, next));
        print_region(body);
        close();
        step_ = step;
    }

    // i, j, k ... in the order of the text; two loops never share one, since old HLSL compilers let
    // the first leak.
    std::string next_index_name() const {
        for (char letter = 'i'; letter <= 'n'; ++letter)
            if (!scope_.visible(std::string(1, letter))) return std::string(1, letter);
        return "i";
    }

    // Carried values that are not in place yet.  A value that lives in the variable is there by the
    // plan.
    std::vector<Store> stores_at_end(const Region& region, const Instruction& yield) {
        const Instruction& owner = *plan_.uses().owner(region);
        const RegionPlan& planned = plan_.region_plan(owner);
        std::vector<Store> stores;
        for (std::size_t k = 0; k < planned.variables.size(); ++k)
            if (planned.moved_before[k] < 0 && !in_place(yield.operands[k], planned.variables[k]))
                stores.push_back({planned.variables[k], yield.operands[k]});
        return stores;
    }

    bool in_place(ValueId value, int variable) const {
        return plan_.form(value) == Form::Variable && plan_.variable(value) == variable;
    }

    void print_break(const Region& region, const Instruction& instruction, int index) {
        begin_step(instruction);
        const RegionPlan& planned = plan_.region_plan(*plan_.uses().owner(region));
        std::vector<Store> stores;
        for (std::size_t k = 0; k < planned.variables.size(); ++k) {
            const ValueId value = instruction.operands[k + 1];
            const bool moved = planned.moved_before[k] >= 0 && planned.moved_before[k] <= index &&
                               value == region.body.back().operands[k];
            if (!moved && !in_place(value, planned.variables[k]))
                stores.push_back({planned.variables[k], value});
        }
        const std::string condition = expressions_.read(instruction.operands[0]);
        if (stores.empty()) return statement(fmt::format("if ({}) break;", condition));
        open(fmt::format("if ({}) {{", condition));
        print_stores(std::move(stores));
        statement("break;");
        close();
    }

    // Whether printing the region would leave any text.
    bool has_text(const Region& region) {
        for (const Instruction& instruction : region.body) {
            if (ir::has_regions(instruction.op)) return true;
            if (instruction.results.empty()) continue;
            const Form form = plan_.form(instruction.result());
            if (form == Form::Local || form == Form::Variable) return true;
        }
        return !stores_at_end(region, region.body.back()).empty();
    }

    void print_if(const Instruction& branch) {
        const bool then_text = has_text(branch.regions[0]), else_text = has_text(branch.regions[1]);
        if (!then_text && !else_text) return;
        begin_step(branch);
        const int step = step_;
        const RegionPlan& planned = plan_.region_plan(branch);
        for (std::size_t j = 0; j < planned.variables.size(); ++j)
            if (planned.declared[j]) statement(declare(planned.variables[j], "chosen") + ";");
        const ValueId condition = branch.operands[0];
        open(fmt::format("if ({}) {{", then_text ? expressions_.read(condition)
                                                 : expressions_.negated(condition)));
        print_region(branch.regions[then_text ? 0 : 1]);
        if (then_text && else_text) {
            close("} else {");
            out_.indent();
            scope_.open();
            at_start_ = true;
            step_ = step;
            print_region(branch.regions[1]);
        }
        close();
        step_ = step;
    }

    // Stores as if all at once: one whose variable nobody else still reads goes first; where each
    // waits for another, a copy of the old value breaks the circle.
    void print_stores(std::vector<Store> stores) {
        while (!stores.empty()) {
            auto free = std::find_if(stores.begin(), stores.end(), [&](const Store& store) {
                return std::none_of(stores.begin(), stores.end(), [&](const Store& other) {
                    return &other != &store && reads(other.value, store.variable);
                });
            });
            if (free == stores.end()) {
                const int variable = stores.front().variable;
                const std::string current = expressions_.variable_name(variable);
                const std::string copy = scope_.declare("old_" + current);
                const ir::Type type = plan_.variables()[static_cast<std::size_t>(variable)].type;
                statement(fmt::format("{} {} = {};", type_of(type), copy, current));
                const ValueId value = stores.front().value;
                const std::string text = expressions_.read(value);
                statement(fmt::format("{} = {};", current, text));
                stores.erase(stores.begin());
                expressions_.name_variable(variable, copy);
                print_stores(std::move(stores));
                expressions_.name_variable(variable, current);
                return;
            }
            statement(fmt::format("{} = {};", expressions_.variable_name(free->variable),
                                  expressions_.read(free->value)));
            stores.erase(free);
        }
    }

    bool reads(ValueId value, int variable) const {
        const std::vector<int> read = expressions_.variables_read(value);
        return std::find(read.begin(), read.end(), variable) != read.end();
    }

    void print_return(const Instruction& instruction) {
        begin_step(instruction);
        if (ending_.stores.empty()) return print_result(instruction.operands[0]);
        for (std::size_t i = 0; i < instruction.operands.size(); ++i)
            print_output(ending_.stores[i], module_.outputs[i].name, instruction.operands[i]);
        if (!ending_.after.empty()) statement(ending_.after);
    }

    // What goes into a statement gets a name of its own, for `precise` to stand on.
    void print_output(std::string store, const std::string& wanted, ValueId value) {
        const std::string text = expressions_.read(value);
        const std::size_t hole = store.find("%0");
        if (hole == std::string::npos) return statement(fmt::format("{} = {};", store, text));
        const std::string name = scope_.declare(wanted, "value");
        statement(fmt::format("{}{} {} = {};", spelling_.precise, type_of(module_.type(value)),
                              name, text));
        statement(store.replace(hole, 2, name));
    }

    // `precise` needs a variable to stand on.
    void print_result(ValueId value) {
        const std::string text = expressions_.read(value);
        if (spelling_.precise.empty()) return statement(fmt::format("return {};", text));
        const std::string name = scope_.declare(ending_.result_name, "found");
        statement(fmt::format("{}{} {} = {};", spelling_.precise, type_of(module_.type(value)),
                              name, text));
        statement(fmt::format("return {};", name));
    }

    TextBuilder& out_;
    const ir::Module& module_;
    const Spelling& spelling_;
    const Ending& ending_;
    NameScope& scope_;
    Plan plan_;
    Expressions expressions_;
    std::vector<bool> declared_;
    std::optional<Diagnostic> error_;
    int step_ = -1;
    bool at_start_ = true;
};

}  // namespace

Status print_body(TextBuilder& out, const ir::Module& module, const Spelling& spelling,
                  const OuterNames& outer, const Ending& ending, NameScope& scope) {
    return BodyPrinter(out, module, spelling, outer, ending, scope).run();
}

}  // namespace intaglio::clike
