// Where each value of a module is defined and read: what the plan of a text needs to know, gathered
// once.
#pragma once

#include <unordered_map>
#include <vector>

#include "generator/ir/module.h"

namespace intaglio::clike {

struct Place {
    const ir::Region* region = nullptr;
    int index = -1;  // in the region's body; -1: a parameter of the region
};

struct Use {
    const ir::Instruction* user = nullptr;
    int operand = 0;
};

class Uses {
  public:
    explicit Uses(const ir::Module& module);

    // The instruction that gives the value; null for a region's parameter.
    const ir::Instruction* definition(ir::ValueId value) const { return at(value).definition; }
    Place home(ir::ValueId value) const { return at(value).home; }
    const std::vector<Use>& uses(ir::ValueId value) const { return at(value).uses; }
    Place place(const ir::Instruction& instruction) const { return places_.at(&instruction); }
    // The loop or if that the region belongs to; null for the module's body.
    const ir::Instruction* owner(const ir::Region& region) const { return owners_.at(&region); }
    // The instruction of `region` that is or contains `place`; -1 if it does not lie in the region.
    int ancestor_index(Place place, const ir::Region& region) const;
    // Whether the way from `outer` in to `inner` enters a region of this op.
    bool crosses(const ir::Region& outer, const ir::Region& inner, ir::Op op) const;
    // Every instruction, in program order, each before those in its regions.
    const std::vector<const ir::Instruction*>& instructions() const { return instructions_; }

  private:
    struct Facts {
        const ir::Instruction* definition = nullptr;
        Place home;
        std::vector<Use> uses;
    };
    void visit(const ir::Region& region, const ir::Instruction* owner);
    const Facts& at(ir::ValueId value) const { return facts_[ir::index_of(value)]; }

    std::vector<Facts> facts_;
    std::vector<const ir::Instruction*> instructions_;
    std::unordered_map<const ir::Instruction*, Place> places_;
    std::unordered_map<const ir::Region*, const ir::Instruction*> owners_;
};

}  // namespace intaglio::clike
