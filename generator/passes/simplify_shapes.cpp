// A shape instruction is a list of lanes (which component of which value); rewriting looks one
// definition through.
#include "generator/passes/simplify_shapes.h"

#include <optional>

namespace intaglio::passes {
namespace {

using namespace ir;

struct Lane {
    ValueId value;
    std::uint8_t component;
};

bool is_identity(const Instruction& swizzle, int source_width, int width) {
    if (source_width != width) return false;
    for (int i = 0; i < width; ++i)
        if (swizzle.lanes[static_cast<std::size_t>(i)] != i) return false;
    return true;
}

// Component `component` of a composition.
Lane component_of(const Module& module, std::span<const ValueId> parts, int component) {
    for (ValueId part : parts) {
        const int width = module.type(part).width;
        if (component < width) return {part, static_cast<std::uint8_t>(component)};
        component -= width;
    }
    return {parts.back(), 0};
}

// All lanes come from one operand: a swizzle of it.  All are whole scalars: a composition of those.
bool swizzle_of_compose(const Module& module, const Definition& compose, Instruction& swizzle) {
    const int width = module.type(swizzle.result()).width;
    std::vector<Lane> lanes;
    bool one_value = true, scalars = true;
    for (int i = 0; i < width; ++i) {
        lanes.push_back(component_of(module, compose.operand_span(),
                                     swizzle.lanes[static_cast<std::size_t>(i)]));
        one_value = one_value && lanes.back().value == lanes.front().value;
        scalars = scalars && module.type(lanes.back().value).width == 1;
    }
    if (one_value) {
        swizzle.operands = {lanes.front().value};
        swizzle.lanes = {};
        for (std::size_t i = 0; i < lanes.size(); ++i) swizzle.lanes[i] = lanes[i].component;
        return true;
    }
    if (!scalars) return false;
    swizzle.op = Op::Compose;
    swizzle.operands.clear();
    swizzle.lanes = {};
    for (const Lane& lane : lanes) swizzle.operands.push_back(lane.value);
    return true;
}

bool simplify_swizzle(const Module& module, const Definitions& definitions, Instruction& swizzle) {
    const ValueId source = swizzle.operands[0];
    const int width = module.type(swizzle.result()).width;
    if (is_identity(swizzle, module.type(source).width, width)) {
        become_operand(swizzle, source);
        return true;
    }
    const Definition& inner = definitions[source];
    if (inner.op == Op::Compose) return swizzle_of_compose(module, inner, swizzle);
    if (inner.op != Op::Swizzle) return false;
    for (std::size_t i = 0; i < static_cast<std::size_t>(width); ++i)
        swizzle.lanes[i] = inner.lanes[swizzle.lanes[i]];
    swizzle.operands = {inner.operands[0]};
    return true;
}

// compose(compose(a, b), c) = compose(a, b, c), unless the inner one has a name: then it is a value
// that people know, and taking it apart would show it twice.
bool compose_of_compose(const Module& module, const Definitions& definitions,
                        Instruction& compose) {
    std::vector<ValueId> parts;
    for (ValueId operand : compose.operands) {
        const Definition& inner = definitions[operand];
        if (inner.op == Op::Compose && module.value(operand).name.empty())
            parts.insert(parts.end(), inner.operand_span().begin(), inner.operand_span().end());
        else
            parts.push_back(operand);
    }
    if (parts.size() == compose.operands.size()) return false;
    compose.operands = std::move(parts);
    return true;
}

bool simplify_compose(const Module& module, const Definitions& definitions, Instruction& compose) {
    if (compose_of_compose(module, definitions, compose)) return true;
    // The lanes of one vector, each operand being that vector or a swizzle of it.
    std::vector<Lane> lanes;
    for (ValueId operand : compose.operands) {
        const Definition& part = definitions[operand];
        for (int i = 0; i < module.type(operand).width; ++i) {
            const auto lane = static_cast<std::uint8_t>(i);
            if (part.op == Op::Swizzle)
                lanes.push_back({part.operands[0], part.lanes[lane]});
            else
                lanes.push_back({operand, lane});
        }
    }
    for (const Lane& lane : lanes)
        if (lane.value != lanes.front().value) return false;
    compose.op = Op::Swizzle;
    compose.operands = {lanes.front().value};
    for (std::size_t i = 0; i < lanes.size(); ++i) compose.lanes[i] = lanes[i].component;
    return true;
}

}  // namespace

void become_operand(Instruction& instruction, ValueId operand) {
    instruction.op = Op::Yield;
    instruction.operands = {operand};
    instruction.lanes = {};
}

bool simplify_shape(const Module& module, const Definitions& definitions,
                    Instruction& instruction) {
    if (instruction.op == Op::Swizzle) return simplify_swizzle(module, definitions, instruction);
    if (instruction.op == Op::Compose) return simplify_compose(module, definitions, instruction);
    return false;
}

}  // namespace intaglio::passes
