// The families of rules that check() goes through; each looks at the whole shader and appends what
// it finds.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "generator/target/d3d9/legality.h"

namespace intaglio::d3d9::rules {

struct Check {
    const Shader& shader;
    const Limits& limits;
    std::vector<Violation>& violations;

    void refuse(std::string rule, std::string message, int instruction = -1) const {
        violations.push_back({std::move(rule), std::move(message), instruction});
    }
};

void declarations(const Check& check);  // dcl and def
void operands(const Check& check);      // inside an instruction: registers, ports, swizzles, masks,
                                        // modifiers, macros
void outputs(const Check& check);       // what must be written, and how
void flow(const Check& check);   // blocks, subroutines, depth, gradients where neighbours may part
void lanes(const Check& check);  // reading what was not declared or, on some path, not written
void budgets(const Check& check);  // slots, register numbers, dependent texture reads

// Operands that the instruction has no business with, or lacks: nothing else may look at it.
bool well_formed(const Instruction& instruction, Profile profile);

// The sampler kind declared for the texture instruction's s#; None if it has none.
SamplerKind sampler_kind(const Shader& shader, const Instruction& instruction);

inline bool is_replicate(const Swizzle& s) { return s[0] == s[1] && s[1] == s[2] && s[2] == s[3]; }

}  // namespace intaglio::d3d9::rules
