// Values given by name into the bytes of a uniform block.  Pure; internal to src/vulkan.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "generator/base/result.h"
#include "src/check/reflect.h"

namespace intaglio::vulkan {

enum class Scalar { Float, Int, Uint };

struct BlockMember {
    check::Reflection::Member layout;
    Scalar scalar = Scalar::Float;
};

// The members of the block at (set, binding) with their scalar types, which reflection leaves out:
// read from the module's type declarations.
std::vector<BlockMember> typed_members(const check::SpirvWords& module,
                                       const check::Reflection::Block& block);

// How many floats the member takes: components times array elements.
std::size_t value_count(const check::Reflection::Member& member);

// Writes `values` to the member's place in `block`.  Errors: `bad-uniform` (wrong number of values,
// or not a whole number in range for an integer), `unsupported-resource` (matrices and arrays of
// arrays).
Status write_member(std::vector<std::byte>& block, const BlockMember& member,
                    const std::vector<float>& values);

}  // namespace intaglio::vulkan
