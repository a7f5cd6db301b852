// Guards are found by what they are made of: each is one instruction with a constant that nothing
// else has.
#include "src/measure/guards.h"

#include <algorithm>
#include <bit>
#include <map>

#include "generator/dsl/technique.h"
#include "src/check/spirv.h"
#include "src/measure/hard.h"
#include "src/variant/variant.h"

namespace intaglio::measure {
namespace {

using Definitions = std::map<ir::ValueId, const ir::Instruction*>;

void collect(const ir::Region& region, Definitions& definitions) {
    for (const ir::Instruction& instruction : region.body) {
        for (ir::ValueId result : instruction.results) definitions[result] = &instruction;
        for (const ir::Region& inner : instruction.regions) collect(inner, definitions);
    }
}

const ir::Instruction* definition(const Definitions& definitions, ir::ValueId value, ir::Op op) {
    const auto found = definitions.find(value);
    return found != definitions.end() && found->second->op == op ? found->second : nullptr;
}

bool is_constant(const Definitions& definitions, ir::ValueId value, float number) {
    const ir::Instruction* constant = definition(definitions, value, ir::Op::Constant);
    return constant != nullptr && std::bit_cast<float>(constant->bits[0]) == number;
}

bool is_max_with(const Definitions& definitions, const ir::Instruction& instruction, float number) {
    return instruction.op == ir::Op::Max &&
           is_constant(definitions, instruction.operands[1], number);
}

// z > 0.
bool is_above_horizon(const Definitions& definitions, ir::ValueId value) {
    const ir::Instruction* greater = definition(definitions, value, ir::Op::Greater);
    return greater != nullptr && is_constant(definitions, greater->operands[1], 0);
}

// The values under a reciprocal root: squared lengths.
std::vector<ir::ValueId> under_roots(const Definitions& definitions) {
    std::vector<ir::ValueId> all;
    for (const auto& [value, instruction] : definitions)
        if (instruction->op == ir::Op::Rsqrt) all.push_back(instruction->operands[0]);
    return all;
}

// What the instruction's result is without the guard; nothing if it is no such guard.
std::optional<ir::ValueId> without(const Definitions& definitions,
                                   const std::vector<ir::ValueId>& squares,
                                   const ir::Instruction& instruction, Guard guard) {
    if (instruction.results.size() != 1) return {};
    const auto is_square = [&] {
        return std::find(squares.begin(), squares.end(), instruction.result()) != squares.end();
    };
    switch (guard) {
        case Guard::FlattestRay:
            if (is_max_with(definitions, instruction, dsl::Ray::least_z))
                return instruction.operands[0];
            break;
        case Guard::ZeroVector:
        case Guard::ZeroDivisor:
            if (is_max_with(definitions, instruction, dsl::tiny) &&
                is_square() == (guard == Guard::ZeroVector))
                return instruction.operands[0];
            break;
        case Guard::UnitInterval:
            if (instruction.op == ir::Op::Saturate &&
                definition(definitions, instruction.operands[0], ir::Op::Div))
                return instruction.operands[0];
            break;
        case Guard::DarkLight:
            if (instruction.op == ir::Op::And &&
                is_above_horizon(definitions, instruction.operands[0]))
                return instruction.operands[1];
            break;
    }
    return {};
}

class Remover {
  public:
    Remover(ir::Module& module, Guard guard) : guard_(guard) {
        collect(module.body, definitions_);
        squares_ = under_roots(definitions_);
        // Decided before anything changes: what is looked at is the module as recorded.
        for (const auto& [value, instruction] : definitions_)
            if (const auto instead = without(definitions_, squares_, *instruction, guard_))
                instead_[value] = *instead;
        rewrite(module.body);
    }
    int count() const { return static_cast<int>(instead_.size()); }

  private:
    void rewrite(ir::Region& region) {
        for (ir::Instruction& instruction : region.body) {
            for (ir::ValueId& operand : instruction.operands)
                for (auto found = instead_.find(operand); found != instead_.end();
                     found = instead_.find(operand))
                    operand = found->second;
            for (ir::Region& inner : instruction.regions) rewrite(inner);
        }
    }

    Guard guard_;
    Definitions definitions_;
    std::vector<ir::ValueId> squares_;
    std::map<ir::ValueId, ir::ValueId> instead_;
};

// Of a program on a target; nothing where the target refuses it.
Result<std::optional<int>> cost_of(const VariantRequest& request, const Recorded& recorded,
                                   const ir::Program& program) {
    Result<Emitted> emitted = emit(program, *recorded.target);
    if (!emitted && is_refusal(emitted.error())) return std::optional<int>{};
    if (!emitted) return emitted.error();
    const Variant variant{request, recorded.target, program, std::move(emitted->vertex),
                          std::move(emitted->pixel)};
    if (profile_of(*recorded.target)) {
        const Result<d3d9::Shader> shader = decode_stage(variant, ir::Stage::Pixel);
        if (!shader) return shader.error();
        return std::optional<int>(d3d9::count(*shader).arithmetic);
    }
    const Result<check::Program> linked = link_variant(variant);
    if (!linked) return linked.error();
    const Result<check::SpirvWords> optimized = check::optimize_spirv(linked->pixel);
    if (!optimized) return optimized.error();
    const Result<check::SpirvCost> cost = check::count_spirv(*optimized, longest_loop(program));
    if (!cost) return cost.error();
    return std::optional<int>(cost->total);
}

Status add_costs(const dsl::Catalogue& catalogue, GuardRow& row) {
    for (const char* target : {"ps_2_0", "ps_2_b", "ps_3_0", "glsl_450"}) {
        VariantRequest request;
        request.surface = row.surface;
        request.target = target;
        request.knobs = row.technique.knobs;
        const Result<Recorded> recorded = record_variant(catalogue, request);
        if (!recorded) return recorded.error();
        ir::Program without = recorded->program;
        row.places = remove_guard(without.pixel, row.guard);
        const Result<std::optional<int>> guarded = cost_of(request, *recorded, recorded->program);
        if (!guarded) return guarded.error();
        const Result<std::optional<int>> bare = cost_of(request, *recorded, without);
        if (!bare) return bare.error();
        row.costs.push_back({target, *guarded, *bare});
    }
    return Done{};
}

// The suite with and without the guards, in fp32.
Status add_harm(const vulkan::Device& device, const dsl::Catalogue& catalogue,
                std::vector<GuardRow>& rows) {
    std::vector<HardRow> techniques;
    for (const GuardRow& row : rows) {
        techniques.push_back(row.technique);
        techniques.back().evaluated_only = true;
        techniques.push_back(techniques.back());
        techniques.back().rewrite = [guard = row.guard](ir::Module& module) {
            remove_guard(module, guard);
        };
    }
    const Result<HardSuite> suite = run_hard_suite(device, catalogue, techniques, hard_cases());
    if (!suite) return suite.error();
    const std::size_t fp32 = 1;
    for (std::size_t r = 0; r < rows.size(); ++r)
        for (std::size_t c = 0; c < suite->cases.size(); ++c) {
            const HardCell& with = suite->cells[2 * r][c][fp32];
            const HardCell& bare = suite->cells[2 * r + 1][c][fp32];
            const std::string& name = suite->cases[c].name;
            if (bare.invalid > 0)
                rows[r].invalid.push_back(name);
            else if (bare.astray > 0)
                rows[r].astray.push_back(name);
            else if (with.verdict == Verdict::Fine && bare.verdict == Verdict::Degraded)
                rows[r].worse.push_back(name);
        }
    return Done{};
}

HardRow technique(const std::string& name) {
    const auto& rows = hard_rows();
    return *std::find_if(rows.begin(), rows.end(),
                         [&](const HardRow& row) { return row.name == name; });
}

}  // namespace

std::string_view name_of(Guard guard) {
    switch (guard) {
        case Guard::FlattestRay: return "flattest ray: max(z, 1/1024)";
        case Guard::ZeroVector: return "zero vector: max(dot(v, v), 1e-18)";
        case Guard::ZeroDivisor: return "zero divisor: max(b, 1e-18)";
        case Guard::UnitInterval: return "unit interval: saturate(a / b)";
        case Guard::DarkLight: return "dark light: L.z > 0";
    }
    return {};
}

int remove_guard(ir::Module& module, Guard guard) { return Remover(module, guard).count(); }

std::vector<GuardRow> guard_rows() {
    std::vector<GuardRow> rows;
    const auto add = [&](Guard guard, const std::string& name, const std::string& surface) {
        rows.push_back({guard, technique(name), surface});
    };
    add(Guard::FlattestRay, "parallax", "parallax");
    add(Guard::FlattestRay, "parallax_occlusion", "parallax_occlusion");
    add(Guard::FlattestRay, "shadow march", "search=none,shadow=march");
    add(Guard::ZeroVector, "parallax_occlusion", "parallax_occlusion");
    add(Guard::ZeroVector, "normal map", "search=none");
    add(Guard::ZeroDivisor, "parallax_occlusion", "parallax_occlusion");
    add(Guard::ZeroDivisor, "cone", "cone");
    add(Guard::ZeroDivisor, "exact", "exact");
    add(Guard::ZeroDivisor, "shadow horizon", "search=none,shadow=horizon");
    add(Guard::UnitInterval, "parallax_occlusion", "parallax_occlusion");
    add(Guard::UnitInterval, "relief_secant", "relief_secant");
    add(Guard::DarkLight, "shadow occlusion_profile", "search=none,shadow=occlusion_profile");
    add(Guard::DarkLight, "shadow horizon", "search=none,shadow=horizon");
    return rows;
}

Status measure_guards(const vulkan::Device& device, const dsl::Catalogue& catalogue,
                      std::vector<GuardRow>& rows) {
    for (GuardRow& row : rows)
        if (Status status = add_costs(catalogue, row); !status) return status;
    return add_harm(device, catalogue, rows);
}

}  // namespace intaglio::measure
