// What a back end is to the rest of the program: one row of a table, found by name.  A target is a
// table of spellings, a list of legalising passes, and the two functions that print a module those
// passes have made legal; or one function that does all of it by itself.  A target never sees a
// technique or another target.
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

// What a device loads without another compiler.
struct Bytecode {
    std::string bytes;
    std::string extension;  // ".pso"; with the dot
};

// Text ready to be written to a file, or to be given to a compiler.
struct Artifact {
    std::string text;   // ends in a line break; empty: the target has no such stage
    std::string entry;  // entry point, or the function's name
    ir::Stage stage = ir::Stage::Pixel;
    std::string extension;  // ".vert", ".frag", ".vert.hlsl", ...; with the dot
    Notes notes;
    Bytecode bytecode = {};  // the same in bytes; empty: the text is all there is
};

// Both stages of a draw.
struct Emitted {
    Artifact vertex, pixel;
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
    bool depth_output = true;     // a pixel's own depth
    bool discard = true;          // pixels that are dropped
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

struct EmitOptions {
    // Called with "pixel: unroll_loops" and the module after each pass that ran, optimising and
    // legalising alike.
    std::function<void(std::string_view stage_and_pass, const ir::Module& module)> after_each_pass;
    // Instrumented: a further colour target says how many textures each pixel read.
    bool count_reads = false;
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
    // In place of legalize and print: a back end that chooses its own passes gets the program as
    // recorded.
    Result<Emitted> (*generate)(const ir::Program& recorded, const Target& target,
                                const EmitOptions& options) = nullptr;
    bool pixel_stage = true;  // false: a profile of vertex shaders alone
};

// Every target, in the order of the documentation.
std::span<const Target* const> all_targets();
// The target of this name, or null.
const Target* find_target(std::string_view name);

// Runs the passes over both stages (some move work between them), legalises and prints them, or
// leaves all of it to the target's own generator.  Errors: "target-derived" (the artifact is made
// by src/check from another target's), whatever a pass refuses, and the refusals of is_refusal with
// the line of the DSL that asked for too much.
Result<Emitted> emit(const ir::Program& program, const Target& target,
                     const EmitOptions& options = {});

// Prints the pixel module of a program, which is of Stage::Function, as one function to paste into
// a shader: its inputs are the parameters, its one output the return value.  Errors as for emit,
// and "target-function" where the target has no text to paste.
Result<Artifact> emit_function(const ir::Program& program, const Target& target, Binding binding,
                               const EmitOptions& options = {});

// An error about what a target cannot do, pointing at the line that asked for it.
Diagnostic target_limit(const ir::Module& module, const ir::Origin& origin, std::string message);

// Whether the error says that the target cannot hold the program, which may be fine on another one:
// "target-limit" and the generators' own codes.
bool is_refusal(const Diagnostic& error);

}  // namespace intaglio
