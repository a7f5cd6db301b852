// Each value of the pixel stage is constant over the draw, affine in interpolants, or other.  An
// affine value that something not affine uses is a root; the arithmetic below the roots is what can
// be saved.  One root moves at a time, on a copy of the program, so that the limits are judged
// after dead code is gone.
#include "generator/passes/hoist_to_vertex.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "generator/passes/remove_dead_code.h"
#include "generator/passes/rewrite.h"

namespace intaglio::passes {
namespace {

using namespace ir;

enum class Kind : std::uint8_t { Other, Draw, Affine };

// The pixel stage as far as hoisting looks at it.
class Analysis {
  public:
    explicit Analysis(const Program& program)
        : program_(program),
          kinds_(program.pixel.values.size()),
          definitions_(program.pixel.values.size()) {
        for_each_instruction(program.pixel.body, [&](const Instruction& instruction) {
            if (instruction.results.size() != 1 || has_regions(instruction.op)) return;
            definitions_[index_of(instruction.result())] = &instruction;
            kinds_[index_of(instruction.result())] = classify(instruction);
        });
    }

    struct Root {
        ValueId value;
        int saved = 0;  // instructions
    };

    // Those that save something, the most first, then in program order.
    std::vector<Root> roots() const {
        std::vector<Root> found;
        std::vector<bool> seen(kinds_.size());
        for_each_instruction(program_.pixel.body, [&](const Instruction& user) {
            if (user.results.size() == 1 && kind(user.result()) == Kind::Affine) return;
            for (ValueId value : user.operands) {
                if (kind(value) != Kind::Affine) continue;
                while (definition(value).op == Op::Swizzle) value = definition(value).operands[0];
                if (seen[index_of(value)]) continue;
                seen[index_of(value)] = true;
                const int saved = count_arithmetic(value);
                if (saved > 0) found.push_back({value, saved});
            }
        });
        std::stable_sort(found.begin(), found.end(),
                         [](const Root& a, const Root& b) { return a.saved > b.saved; });
        return found;
    }

    const Instruction& definition(ValueId value) const { return *definitions_[index_of(value)]; }

    // The root and everything it is computed from, operands first.
    std::vector<ValueId> cone(ValueId root) const {
        std::vector<ValueId> order;
        std::vector<bool> seen(kinds_.size());
        add_cone(root, seen, order);
        return order;
    }

  private:
    Kind kind(ValueId value) const { return kinds_[index_of(value)]; }

    Kind classify(const Instruction& instruction) const {
        if (!is_arithmetic(instruction.op)) return Kind::Other;
        if (instruction.op == Op::Input) return classify_input(instruction);
        int affine = 0;
        for (ValueId operand : instruction.operands) {
            if (kind(operand) == Kind::Other) return Kind::Other;
            if (kind(operand) == Kind::Affine) ++affine;
        }
        if (affine == 0) return Kind::Draw;
        const auto is_draw = [&](std::size_t i) {
            return kind(instruction.operands[i]) == Kind::Draw;
        };
        switch (instruction.op) {
            case Op::Add:
            case Op::Sub:
            case Op::Neg:
            case Op::Swizzle:
            case Op::Compose: return Kind::Affine;
            case Op::Mul:
            case Op::Dot:
            case Op::Cross: return affine == 1 ? Kind::Affine : Kind::Other;
            case Op::Div: return is_draw(1) ? Kind::Affine : Kind::Other;
            case Op::Lerp: return is_draw(2) ? Kind::Affine : Kind::Other;
            default: return Kind::Other;
        }
    }

    // Affine if the vertex stage has the value.
    Kind classify_input(const Instruction& instruction) const {
        const Declaration& input =
            program_.pixel.inputs[static_cast<std::size_t>(instruction.slot)];
        const auto& outputs = program_.vertex.outputs;
        const bool known =
            std::any_of(outputs.begin(), outputs.end(), [&](const Declaration& output) {
                return output.semantic == Semantic::Interpolant && output.name == input.name;
            });
        return known && input.semantic == Semantic::Interpolant ? Kind::Affine : Kind::Other;
    }

    int count_arithmetic(ValueId root) const {
        int count = 0;
        for (ValueId value : cone(root)) {
            const Op op = definition(value).op;
            if (kind(value) == Kind::Affine && !is_leaf(op) && op != Op::Swizzle &&
                op != Op::Compose)
                ++count;
        }
        return count;
    }

    void add_cone(ValueId value, std::vector<bool>& seen, std::vector<ValueId>& order) const {
        if (seen[index_of(value)]) return;
        seen[index_of(value)] = true;
        for (ValueId operand : definition(value).operands) add_cone(operand, seen, order);
        order.push_back(value);
    }

    const Program& program_;
    std::vector<Kind> kinds_;
    std::vector<const Instruction*> definitions_;
};

// Index of the equal element, which is appended if there is none.
template <typename T>
int find_or_add(std::vector<T>& elements, const T& element) {
    const auto found = std::find(elements.begin(), elements.end(), element);
    const auto index = found - elements.begin();
    if (found == elements.end()) elements.push_back(element);
    return static_cast<int>(index);
}

// Copies a cone of the pixel stage to the end of the vertex stage.
class Transplant {
  public:
    Transplant(const Module& pixel, Module& vertex)
        : pixel_(pixel), vertex_(vertex), copy_(pixel, vertex) {}

    void add(const Instruction& instruction) {
        if (instruction.op == Op::Input) {
            copy_.bind(
                instruction.result(),
                output_named(pixel_.inputs[static_cast<std::size_t>(instruction.slot)].name));
            return;
        }
        Instruction copied = copy_.clone(instruction);
        if (instruction.op == Op::Uniform)
            copied.slot = find_or_add(vertex_.uniforms,
                                      pixel_.uniforms[static_cast<std::size_t>(instruction.slot)]);
        if (instruction.origin.file >= 0)
            copied.origin.file = find_or_add(
                vertex_.files, pixel_.files[static_cast<std::size_t>(instruction.origin.file)]);
        if (instruction.origin.step >= 0)
            copied.origin.step = find_or_add(
                vertex_.steps, pixel_.steps[static_cast<std::size_t>(instruction.origin.step)]);
        std::vector<Instruction>& body = vertex_.body.body;
        body.insert(body.end() - 1, std::move(copied));
    }

    ValueId operator()(ValueId value) const { return copy_(value); }

  private:
    ValueId output_named(const std::string& name) const {
        std::size_t i = 0;
        while (vertex_.outputs[i].semantic != Semantic::Interpolant ||
               vertex_.outputs[i].name != name)
            ++i;
        return vertex_.body.body.back().operands[i];
    }

    const Module& pixel_;
    Module& vertex_;
    Cloner copy_;
};

bool declares(const Module& module, const std::string& name) {
    const auto named = [&](const auto& declaration) { return declaration.name == name; };
    const auto any = [&](const auto& declarations) {
        return std::any_of(declarations.begin(), declarations.end(), named);
    };
    return any(module.inputs) || any(module.outputs) || any(module.uniforms) ||
           any(module.samplers);
}

std::string unused_name(const Program& program, std::string name) {
    if (name.empty()) name = "per_vertex";
    std::string candidate = name;
    for (int i = 2; declares(program.vertex, candidate) || declares(program.pixel, candidate); ++i)
        candidate = fmt::format("{}_{}", name, i);
    return candidate;
}

// Of two uniforms of one name that differ, both cannot be declared in the vertex stage.
const Uniform* conflicting_uniform(const Program& program) {
    for (const Uniform& pixel : program.pixel.uniforms)
        for (const Uniform& vertex : program.vertex.uniforms)
            if (pixel.name == vertex.name && pixel != vertex) return &pixel;
    return nullptr;
}

bool fits(const Module& pixel, const InterpolantLimits& limits) {
    int count = 0, components = 0;
    for (const Declaration& input : pixel.inputs) {
        if (input.semantic != Semantic::Interpolant) continue;
        ++count;
        components += input.type.width;
    }
    return count <= limits.count && components <= limits.components &&
           (!limits.fits || limits.fits(pixel));
}

// The program with one root moved, or nothing if the limits forbid it.
std::optional<Program> move_root(const Program& program, const Analysis& analysis, ValueId root,
                                 const InterpolantLimits& limits) {
    Program moved = program;
    Transplant transplant(program.pixel, moved.vertex);
    for (ValueId value : analysis.cone(root)) transplant.add(analysis.definition(value));
    const Declaration declaration{unused_name(program, program.pixel.value(root).name),
                                  program.pixel.type(root), Semantic::Interpolant};
    moved.vertex.outputs.push_back(declaration);
    moved.vertex.body.body.back().operands.push_back(transplant(root));
    moved.pixel.inputs.push_back(declaration);
    for_each_instruction(moved.pixel.body, [&](Instruction& instruction) {
        if (instruction.results.size() != 1 || instruction.result() != root) return;
        instruction.op = Op::Input;
        instruction.operands.clear();
        instruction.lanes = {};
        instruction.slot = static_cast<int>(moved.pixel.inputs.size()) - 1;
    });
    compact_values(moved.vertex);
    remove_dead_code(moved.pixel);
    if (!fits(moved.pixel, limits)) return std::nullopt;
    return moved;
}

}  // namespace

std::vector<std::string> hoist_to_vertex(ir::Program& program, const InterpolantLimits& limits) {
    std::vector<std::string> sentences;
    if (!program.per_vertex) return sentences;
    if (const Uniform* conflict = conflicting_uniform(program))
        return {fmt::format(
            "nothing is computed per vertex: the stages declare uniform '{}' differently",
            conflict->name)};
    for (bool any = true; any;) {
        any = false;
        const Analysis analysis(program);
        for (const Analysis::Root& root : analysis.roots()) {
            std::optional<Program> moved = move_root(program, analysis, root.value, limits);
            if (!moved) continue;
            const std::string place =
                place_of(program.pixel, analysis.definition(root.value).origin);
            sentences.push_back(
                fmt::format("{}{}{} is computed per vertex and interpolated, which saves {} pixel "
                            "instruction{} and rounds differently",
                            place, place.empty() ? "" : ": ", moved->vertex.outputs.back().name,
                            root.saved, root.saved == 1 ? "" : "s"));
            program = std::move(*moved);
            any = true;
            break;
        }
    }
    return sentences;
}

}  // namespace intaglio::passes
