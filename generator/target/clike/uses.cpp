// One walk over the module; everything else is a lookup.
#include "generator/target/clike/uses.h"

namespace intaglio::clike {

Uses::Uses(const ir::Module& module) : facts_(module.values.size()) { visit(module.body, nullptr); }

void Uses::visit(const ir::Region& region, const ir::Instruction* owner) {
    owners_[&region] = owner;
    for (ir::ValueId parameter : region.parameters)
        facts_[ir::index_of(parameter)].home = {&region, -1};
    for (std::size_t i = 0; i < region.body.size(); ++i) {
        const ir::Instruction& instruction = region.body[i];
        const Place place{&region, static_cast<int>(i)};
        instructions_.push_back(&instruction);
        places_[&instruction] = place;
        for (std::size_t operand = 0; operand < instruction.operands.size(); ++operand)
            facts_[ir::index_of(instruction.operands[operand])].uses.push_back(
                {&instruction, static_cast<int>(operand)});
        for (ir::ValueId result : instruction.results) {
            Facts& facts = facts_[ir::index_of(result)];
            facts.definition = &instruction;
            facts.home = place;
        }
        for (const ir::Region& inner : instruction.regions) visit(inner, &instruction);
    }
}

int Uses::ancestor_index(Place place, const ir::Region& region) const {
    while (place.region != &region) {
        const ir::Instruction* parent = owner(*place.region);
        if (!parent) return -1;
        place = this->place(*parent);
    }
    return place.index;
}

bool Uses::crosses(const ir::Region& outer, const ir::Region& inner, ir::Op op) const {
    for (const ir::Region* region = &inner; region != &outer;) {
        const ir::Instruction* parent = owner(*region);
        if (!parent) return false;
        if (parent->op == op) return true;
        region = place(*parent).region;
    }
    return false;
}

}  // namespace intaglio::clike
