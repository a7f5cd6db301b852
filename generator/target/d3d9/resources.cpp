// One walk over the operands for registers, one over the instructions for the orders of texture
// reads.
#include "generator/target/d3d9/resources.h"

#include <algorithm>
#include <map>

#include "generator/target/d3d9/ops.h"

namespace intaglio::d3d9 {
namespace {

// The counter of a register file; null for files without numbers.
int* counter_of(Resources& used, File file) {
    switch (file) {
        case File::Temp: return &used.temps;
        case File::Const: return &used.constants;
        case File::ConstInt: return &used.integers;
        case File::ConstBool: return &used.booleans;
        case File::Sampler: return &used.samplers;
        case File::Input: return &used.inputs;
        case File::Texture:
        case File::TexcoordOut: return &used.texcoords;
        case File::ColourOut:
        case File::AttributeOut: return &used.colour_outputs;
        case File::Output: return &used.outputs;
        default: return nullptr;
    }
}

void use(Resources& used, File file, int index, int registers = 1) {
    if (int* counter = counter_of(used, file)) *counter = std::max(*counter, index + registers);
}

class Orders {
  public:
    // Answers the order of a texture instruction, -1 of another.
    int step(const Instruction& instruction) {
        const OpInfo& row = info(instruction.op);
        if (row.has(Trait::Texture)) return fetch(instruction, row);
        if (row.has(Trait::Writes) && instruction.destination &&
            is_temp(*instruction.destination)) {
            int order = order_of(instruction.destination->index);
            for (const Source& source : instruction.sources)
                if (source.file == File::Temp) order = std::max(order, order_of(source.index));
            orders_[instruction.destination->index] = order;
        }
        return -1;
    }

  private:
    static bool is_temp(const Destination& destination) { return destination.file == File::Temp; }
    int order_of(int temp) const {
        const auto found = orders_.find(temp);
        return found == orders_.end() ? 0 : found->second;
    }

    int fetch(const Instruction& instruction, const OpInfo& row) {
        if (!instruction.destination) return 0;
        const Destination& destination = *instruction.destination;
        if (row.has(Trait::ReadsDestination)) {
            if (!is_temp(destination)) return 0;
            return orders_[destination.index] = 1 + order_of(destination.index);
        }
        const bool from_temp =
            !instruction.sources.empty() && instruction.sources[0].file == File::Temp;
        const bool again = is_temp(destination) && orders_.count(destination.index) != 0;
        int order = 0;
        if (from_temp || again) {
            order = 1 + std::max(from_temp ? order_of(instruction.sources[0].index) : 0,
                                 is_temp(destination) ? order_of(destination.index) : 0);
        }
        if (is_temp(destination)) orders_[destination.index] = order;
        return order;
    }

    std::map<int, int> orders_;  // of each r# ever written
};

}  // namespace

std::vector<int> dependent_levels(const Shader& shader) {
    std::vector<int> levels;
    Orders orders;
    for (const Instruction& instruction : shader.instructions)
        levels.push_back(orders.step(instruction));
    return levels;
}

Resources count(const Shader& shader) {
    Resources used;
    const Slots slots = slots_of(shader);
    used.arithmetic = slots.arithmetic;
    used.texture = slots.texture;
    used.total = slots.total();
    for (const Declaration& declaration : shader.declarations)
        use(used, declaration.target.file, declaration.target.index);
    for (const Definition& definition : shader.definitions)
        use(used, definition.file, definition.index);
    for (const Instruction& instruction : shader.instructions) {
        if (instruction.destination)
            use(used, instruction.destination->file, instruction.destination->index);
        const int rows = info(instruction.op).matrix_rows;
        for (std::size_t i = 0; i < instruction.sources.size(); ++i) {
            const Source& source = instruction.sources[i];
            use(used, source.file, source.index, i == 1 && rows > 0 ? rows : 1);
        }
    }
    for (const int level : dependent_levels(shader))
        used.dependent_level = std::max(used.dependent_level, level);
    return used;
}

std::vector<Headroom> headroom(const Resources& used, const Limits& limits) {
    const bool pixel = limits.pixel();
    const Headroom all[] = {
        {"arithmetic slots", used.arithmetic, limits.arithmetic_slots},
        {"texture slots", used.texture, limits.texture_slots},
        {"slots in total", used.total, limits.total_slots},
        {"temporary registers", used.temps, limits.temps},
        {"float constants", used.constants, limits.constants},
        {"integer constants", used.integers, limits.integers},
        {"boolean constants", used.booleans, limits.booleans},
        {"samplers", used.samplers, limits.samplers},
        {"input registers", used.inputs, limits.inputs},
        {pixel ? "texture coordinates" : "texture coordinate outputs", used.texcoords,
         limits.texcoords},
        {"colour outputs", used.colour_outputs, limits.colour_outputs},
        {"output registers", used.outputs, limits.outputs},
        {"dependent texture reads", used.dependent_level, limits.dependent_level},
    };
    std::vector<Headroom> rows;
    for (const Headroom& row : all)
        if (row.limit < no_limit && (row.limit > 0 || row.used > 0)) rows.push_back(row);
    return rows;
}

std::vector<Headroom> headroom(const Shader& shader) {
    return headroom(count(shader), limits_of(shader.profile));
}

}  // namespace intaglio::d3d9
