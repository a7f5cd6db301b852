// Sums by origin.
#include "generator/target/d3d9/explain.h"

#include <algorithm>

#include <fmt/format.h>

namespace intaglio::d3d9 {
namespace {

Spent spent_at(const Shader& shader, const ir::Origin& origin) {
    Spent spent;
    if (origin.step >= 0 && origin.step < static_cast<int>(shader.steps.size()))
        spent.step = shader.steps[static_cast<std::size_t>(origin.step)].name;
    if (origin.file >= 0 && origin.file < static_cast<int>(shader.files.size())) {
        spent.file = shader.files[static_cast<std::size_t>(origin.file)];
        spent.line = origin.line;
    }
    return spent;
}

void add(Slots& sum, const Slots& more) {
    sum.arithmetic += more.arithmetic;
    sum.texture += more.texture;
}

bool same_place(const Spent& a, const Spent& b) {
    return a.step == b.step && a.file == b.file && a.line == b.line;
}

void charge(std::vector<Spent>& rows, Spent spent, const Slots& slots) {
    auto row = std::find_if(rows.begin(), rows.end(),
                            [&](const Spent& other) { return same_place(other, spent); });
    if (row == rows.end()) row = rows.insert(rows.end(), std::move(spent));
    add(row->slots, slots);
}

bool more(const Spent& a, const Spent& b) { return a.slots.total() > b.slots.total(); }

std::string sampler_of(const Shader& shader, const Instruction& instruction) {
    for (const Source& source : instruction.sources) {
        if (source.file != File::Sampler) continue;
        for (const Constant& constant : shader.constants)
            if (constant.set == Constant::Set::Sampler && source.index >= constant.index &&
                source.index < constant.index + constant.count)
                return constant.name;
        return fmt::format("s{}", source.index);
    }
    return {};
}

}  // namespace

Explanation sum_up(const std::vector<Spent>& instructions) {
    Explanation result;
    for (const Spent& spent : instructions) {
        add(result.slots, spent.slots);
        charge(result.steps, {spent.step, {}, 0, {}}, spent.slots);
        charge(result.lines, {spent.step, spent.file, spent.line, {}}, spent.slots);
    }
    std::stable_sort(result.steps.begin(), result.steps.end(), more);
    const auto rank = [&](const Spent& row) {
        return std::find_if(result.steps.begin(), result.steps.end(),
                            [&](const Spent& step) { return step.step == row.step; }) -
               result.steps.begin();
    };
    std::stable_sort(result.lines.begin(), result.lines.end(), [&](const Spent& a, const Spent& b) {
        return rank(a) != rank(b) ? rank(a) < rank(b) : more(a, b);
    });
    return result;
}

Explanation explain(const Shader& shader) {
    std::vector<Spent> instructions;
    std::vector<TextureRead> reads;
    const std::vector<int> levels = dependent_levels(shader);
    for (std::size_t i = 0; i < shader.instructions.size(); ++i) {
        const Instruction& instruction = shader.instructions[i];
        Spent spent = spent_at(shader, instruction.origin);
        spent.slots = slots_of(instruction);
        const std::string sampler = sampler_of(shader, instruction);
        if (!sampler.empty())
            reads.push_back({levels[i], sampler, spent.step, spent.file, spent.line});
        instructions.push_back(std::move(spent));
    }
    Explanation result = sum_up(instructions);
    result.reads = std::move(reads);
    result.headroom = headroom(shader);
    return result;
}

}  // namespace intaglio::d3d9
