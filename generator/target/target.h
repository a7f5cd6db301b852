// What a back end is to the rest of the program: one row of a table, found by name.  A target is a
// table of spellings, a list of legalising passes, and the two functions that print a module those
// passes have made legal. A target never sees a technique or another target.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "generator/base/result.h"
#include "generator/ir/module.h"
#include "generator/passes/hoist_to_vertex.h"

namespace intaglio {

// One sentence for each thing that whoever uses a text must know.
using Notes = std::vector<std::string>;

// Text ready to be written to a file, or to be given to a compiler.
struct Artifact {
    std::string text;   // ends in a line break
    std::string entry;  // entry point, or the function's name
    ir::Stage stage = ir::Stage::Pixel;
    std::string extension;  // ".vert", ".frag", ".vert.hlsl", ...; with the dot
    Notes notes;
};

// How a function gets what is uniform: as further parameters after its own, or as globals above it.
enum class Binding { Parameters, Globals };

// What a target's language can say at all; the pages under docs/targets tell more.
struct Capabilities {
    bool loops = true;        // loops with an exit in the middle
    bool branches = true;     // an if that skips work
    bool derivatives = true;  // ddx, ddy
    bool texture_levels = true;
    bool texture_gradients = true;
    bool volume_textures = true;
    bool vertex_textures = true;  // texture reads in the vertex stage
    bool precise = false;         // a keyword forbids contraction and reassociation
    bool functions = true;        // emit_function works
    int colour_targets = 8;
    int loop_trips = 0;     // the most iterations of one loop; 0: any
    int texture_reads = 0;  // the most that the text of one stage may hold; 0: any
    passes::InterpolantLimits interpolants = {};
};

struct Target;

// Rewrites what the target cannot say into what it can, or refuses with a sentence.  What changes
// the result is added to the notes.
struct LegalizingPass {
    std::string_view name;
    Status (*run)(ir::Module& module, const Target& target, Notes& notes);
};

struct Target {
    std::string_view
        name;  // the folder of its page, its golden suffix and its name on the command line
    std::string_view description;  // one line for `intaglio list targets`
    std::string_view
        derived_from;  // src/check makes this artifact from that target's text; empty: we print it
    Capabilities capabilities;
    std::span<const LegalizingPass> legalize;
    Result<Artifact> (*print)(const ir::Program& program, ir::Stage stage) = nullptr;
    Result<Artifact> (*print_function)(const ir::Program& program, Binding binding) = nullptr;
};

// Every target, in the order of the documentation.
std::span<const Target* const> all_targets();
// The target of this name, or null.
const Target* find_target(std::string_view name);

struct EmitOptions {
    // Called with "pixel: unroll_loops" and the module after each pass that ran, optimising and
    // legalising alike.
    std::function<void(std::string_view stage_and_pass, const ir::Module& module)> after_each_pass;
};

// Runs the passes over both stages (some move work between them), legalises the wanted one and
// prints it. Errors: "target-derived" (the artifact is made by src/check from another target's),
// whatever a pass refuses, and "target-limit" with the line of the DSL that asked for too much.
// stage: Vertex or Pixel.
Result<Artifact> emit(const ir::Program& program, ir::Stage stage, const Target& target,
                      const EmitOptions& options = {});

// Prints the pixel module of a program, which is of Stage::Function, as one function to paste into
// a shader: its inputs are the parameters, its one output the return value.  Errors as for emit,
// and "target-function" where the target has no text to paste.
Result<Artifact> emit_function(const ir::Program& program, const Target& target, Binding binding,
                               const EmitOptions& options = {});

// An error about what a target cannot do, pointing at the line that asked for it.
Diagnostic target_limit(const ir::Module& module, const ir::Origin& origin, std::string message);

}  // namespace intaglio
