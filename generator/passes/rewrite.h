// What every pass is made of: walking and rebuilding regions, replacing values, copying
// instructions, and numbering values anew.  A pass rewrites in execution order, so that an
// operand's definition is always seen before its uses.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "generator/ir/module.h"

namespace intaglio::passes {

// Values that were replaced by others.
class Substitution {
  public:
    explicit Substitution(ir::Module& module) : module_(module) {}

    // From now on `from` means `to`.  To keep the DSL's name, an unnamed `to` takes over the name
    // of `from`; a constant or uniform must not, since it may stand for other quantities as well.
    enum class Name { TakeOver, Leave };
    void replace(ir::ValueId from, ir::ValueId to, Name name = Name::TakeOver);
    // What the value is now; itself if nothing replaced it.
    ir::ValueId operator()(ir::ValueId value) const;
    void apply(std::vector<ir::ValueId>& operands) const;
    bool empty() const { return replacements_.empty(); }

  private:
    ir::Module& module_;
    std::vector<ir::ValueId> replacements_;  // by value; beyond the end: itself
};

// Copies instructions with fresh values.  Values that were not bound and not copied stand for
// themselves, so source and target may be one module; between two modules every operand must be
// bound first.
class Cloner {
  public:
    Cloner(const ir::Module& source, ir::Module& target) : source_(source), target_(target) {}

    void bind(ir::ValueId from, ir::ValueId to);
    ir::ValueId operator()(ir::ValueId value) const;
    std::vector<ir::ValueId> operator()(std::span<const ir::ValueId> values) const;
    ir::Instruction clone(const ir::Instruction& instruction);

  private:
    ir::ValueId fresh(ir::ValueId value);

    const ir::Module& source_;
    ir::Module& target_;
    std::vector<std::uint32_t> map_;  // new index + 1 by old index; 0: itself
};

// A value's defining instruction as far as rewriting looks at it.  `op` is Return, which defines
// nothing, for region parameters and for results of loops and ifs.
struct Definition {
    ir::Op op = ir::Op::Return;
    std::uint8_t operand_count = 0;
    std::array<ir::ValueId, 4> operands{};
    std::array<std::uint32_t, 4> bits{};
    std::array<std::uint8_t, 4> lanes{};
    int slot = 0;
    int element = 0;

    std::span<const ir::ValueId> operand_span() const { return {operands.data(), operand_count}; }
    friend bool operator==(const Definition&, const Definition&) = default;
};
// Of an instruction with one result and four operands at most.
Definition definition_of(const ir::Instruction& instruction);

// The definitions seen so far, by value.
class Definitions {
  public:
    void record(const ir::Instruction& instruction);
    const Definition& operator[](ir::ValueId value) const;

  private:
    std::vector<Definition> definitions_;
};

// Neither reads a texture, nor looks at neighbouring pixels, nor controls flow: it may run
// anywhere, any number of times.
bool is_arithmetic(ir::Op op);
// A constant, uniform or input: its value may stand for several quantities, so it takes over no
// name.
inline bool is_leaf(ir::Op op) { return ir::info(op).type_rule == ir::TypeRule::Leaf; }
// True if the region or one inside it has this op.
bool contains_op(const ir::Region& region, ir::Op op);
// True if the region or one inside it reads a texture.
bool reads_textures(const ir::Region& region);
bool contains_break(const ir::Region& region);

// A new instruction with one new result of the given type.
ir::Instruction make_instruction(ir::Module& module, ir::Op op, ir::Type type,
                                 std::span<const ir::ValueId> operands, const ir::Origin& origin);
ir::Instruction make_constant(ir::Module& module, ir::Type type, std::array<std::uint32_t, 4> bits,
                              const ir::Origin& origin);
ir::Instruction make_int_constant(ir::Module& module, int value, const ir::Origin& origin);

// Visits each instruction of the region and of those inside it, in execution order, an outer one
// before its inner ones.
template <typename Visit>
void for_each_instruction(const ir::Region& region, Visit&& visit) {
    for (const ir::Instruction& instruction : region.body) {
        visit(instruction);
        for (const ir::Region& inner : instruction.regions) for_each_instruction(inner, visit);
    }
}
template <typename Visit>
void for_each_instruction(ir::Region& region, Visit&& visit) {
    for (ir::Instruction& instruction : region.body) {
        visit(instruction);
        for (ir::Region& inner : instruction.regions) for_each_instruction(inner, visit);
    }
}

// Rebuilds a body: visit(std::move(instruction), body) appends to the new body what the instruction
// becomes. Inner regions are the visitor's to rebuild.
template <typename Visit>
void rebuild(ir::Region& region, Visit&& visit) {
    std::vector<ir::Instruction> old = std::move(region.body);
    std::vector<ir::Instruction> body;
    body.reserve(old.size());
    for (ir::Instruction& instruction : old) visit(std::move(instruction), body);
    region.body = std::move(body);
}

// Replaces operands everywhere, at once.
void substitute(ir::Region& region, const Substitution& substitution);

// How often each value is an operand.
std::vector<int> count_uses(const ir::Module& module);

// Drops values that nothing defines any more and numbers the others in the order in which a builder
// defines them: a region's parameters, its body, then the results of its instruction.  Returns
// whether it changed anything.
bool compact_values(ir::Module& module);

// Drops inputs, uniforms and samplers that no instruction reads, and files and steps that no
// instruction comes from; the others keep their order and are numbered anew.  Parameters of a
// function stay: they are its signature.  Returns whether it changed anything.
bool remove_unused_declarations(ir::Module& module);

// "templates/search/steep_parallax.cpp:25", or empty where the origin is unknown.
std::string place_of(const ir::Module& module, const ir::Origin& origin);

}  // namespace intaglio::passes
