// What a module wants from outside, read from the binary by SPIRV-Cross: the names, places and
// sizes that the text really got, whatever its author claims.  The runner fills uniforms from it,
// by name.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "generator/base/result.h"
#include "src/check/frontend.h"
#include "src/check/source.h"

namespace intaglio::check {

struct Reflection {
    // Names are those of the source.  A member of a struct that HLSL passes as input or output is
    // called by its own name ("uv", where the binary says "input.uv"); an unnamed value of a pixel
    // entry point is "@entryPointOutput".
    struct Member {
        std::string name;
        int offset = 0;        // bytes from the start of the block
        int size = 0;          // bytes, without padding after it; the whole of an array or matrix
        int components = 1;    // of a vector, or of one column of a matrix
        int columns = 1;       // more than 1: matrix
        int array_count = 1;   // more than 1: array (outermost dimension)
        int array_stride = 0;  // bytes; 0 when not an array
        bool operator==(const Member&) const = default;
    };
    struct Block {
        std::string
            name;  // "$Global" (HLSL) and "gl_DefaultUniformBlock" (GLSL) hold loose uniforms
        int set = 0;
        int binding = 0;
        int size = 0;  // bytes up to the end of the last member
        std::vector<Member> members;
        bool operator==(const Block&) const = default;
    };
    enum class ImageKind { Combined, Texture, Sampler };
    struct Image {
        std::string name;
        int set = 0;
        int binding = 0;
        ImageKind kind = ImageKind::Combined;
        int array_count = 1;
        int dimension = 2;  // of a texture: 2, or 3 for a volume; 0: neither (cube, buffer, ...)
        bool operator==(const Image&) const = default;
    };
    struct Interface {
        std::string name;
        int location = -1;  // -1: built-in
        int components = 1;
        int array_count = 1;
        std::string
            built_in;  // "Position", "FragCoord", ... as SPIR-V calls it; empty: a plain varying
        bool operator==(const Interface&) const = default;
    };

    // Each sorted by (set, binding) or by location; built-ins come last, and only those the entry
    // point uses.
    std::vector<Block> blocks;
    std::vector<Image> images;
    std::vector<Interface> inputs;
    std::vector<Interface> outputs;
    std::optional<Block> push_constants;
};

// What the entry point uses; what is only declared needs nothing from outside, and its place may be
// anything.  The module is validated first ("spirv-invalid"). Error "spirv-unreadable": SPIRV-Cross
// gives up.
Result<Reflection> reflect(const SpirvWords& words);
// The same of a module that spirv-val took before, as it took all that frontend.h returns: asking
// it again costs more than the reading.
Result<Reflection> reflect_valid(const SpirvWords& words);

// The same of GLSL whose uniforms have names and no places (Glsl330, Essl300, Glsl120, Essl100), by
// glslang's own reflection of the text: what the stage reads, by name, all places -1, the loose
// uniforms as one block without a name.  Errors: those of parse; "unknown-uniform": a type that no
// text of ours has (matrices, cubes).
Result<Reflection> reflect_names(const Source& source);

// link_to_spirv with what it read of both stages to see whether they fit.
struct Linked {
    Program program;
    Reflection vertex, pixel;
};
Result<Linked> link_and_reflect(const Source& vertex, const Source& pixel);

// The member of that name in any uniform block, with its block; nullopt when there is none.
struct FoundMember {
    const Reflection::Block* block;
    const Reflection::Member* member;
};
std::optional<FoundMember> find_member(const Reflection& reflection, std::string_view name);

}  // namespace intaglio::check
