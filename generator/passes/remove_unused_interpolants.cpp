// Dead code across the stages: interpolants are matched by name.
#include "generator/passes/remove_unused_interpolants.h"

#include <algorithm>

#include "generator/passes/remove_dead_code.h"
#include "generator/passes/rewrite.h"

namespace intaglio::passes {

using namespace ir;

bool remove_unused_interpolants(ir::Program& program) {
    const bool changed = remove_unused_declarations(program.pixel);
    const auto is_read = [&](const Declaration& output) {
        const auto& inputs = program.pixel.inputs;
        return output.semantic != Semantic::Interpolant ||
               std::any_of(inputs.begin(), inputs.end(), [&](const Declaration& input) {
                   return input.semantic == Semantic::Interpolant && input.name == output.name;
               });
    };
    Module& vertex = program.vertex;
    std::vector<ValueId>& values = vertex.body.body.back().operands;
    for (std::size_t i = vertex.outputs.size(); i-- > 0;) {
        if (is_read(vertex.outputs[i])) continue;
        vertex.outputs.erase(vertex.outputs.begin() + static_cast<std::ptrdiff_t>(i));
        values.erase(values.begin() + static_cast<std::ptrdiff_t>(i));
    }
    remove_dead_code(vertex);
    return changed;
}

}  // namespace intaglio::passes
