// A variant: a surface with its knobs and schedule, on one target.  Here the two arms of the
// generator meet: the techniques' DSL gives a program, the target gives its text.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "generator/dsl/catalogue.h"
#include "generator/dsl/passes.h"
#include "generator/passes/assume.h"
#include "generator/target/d3d9/resources.h"
#include "generator/target/target.h"
#include "src/check/cost.h"
#include "src/check/frontend.h"
#include "src/check/judge.h"

namespace intaglio {

struct VariantRequest {
    std::string surface;                                     // see dsl::make_surface
    std::string target;                                      // see all_targets()
    std::vector<std::pair<std::string, std::string>> knobs;  // name and value as written
    std::map<std::string, ir::LoopForm> loop_forms;          // by loop name, above the schedule
    bool per_vertex = false;  // affine functions of interpolants move to the vertex stage
    bool count_reads =
        false;  // instrumented: a second colour target `reads` says how many textures a pixel read
    dsl::Split split = {};     // see dsl::parse_split
    int pass = 0;              // which pass of the split, from 1; 0 only where there is one
    passes::Known known = {};  // what is folded into the program before its target sees it
};

struct Variant {
    VariantRequest request;
    const Target* target;    // the one asked for
    ir::Program program;     // as recorded
    Artifact vertex, pixel;  // text of the target, or of the one it is derived from
};

// What a user gets for one stage: text, or the bytes of a binary.
struct Product {
    std::string bytes;
    std::string extension;
    bool binary = false;
};

// A surface as recorded for a target, what is known of it folded in, before any other pass.
struct Recorded {
    const Target* target;
    ir::Program program;
    Notes left_out = {};  // a sentence for each thing that what is known made needless
};
// Errors: unknown names, knobs out of range; those of passes::assume.  A pass of a split surface,
// and a surface whose output is not shaded, takes of what is known what it has names for.
Result<Recorded> record_variant(const dsl::Catalogue& catalogue, const VariantRequest& request);

// Records, optimises and prints both stages.  Errors: unknown names with the nearest right one,
// knobs out of range, and what the target refuses.
Result<Variant> make_variant(const dsl::Catalogue& catalogue, const VariantRequest& request,
                             const EmitOptions& options = {});
// Which form of a stage: the text (of a binary target its bytes), or the bytecode beside the text.
enum class Form { Shader, Bytecode };
// Errors: "no-stage": a profile of vertex shaders has no pixel stage; "no-bytecode".
Result<Product> product_of(const Variant& variant, ir::Stage stage, Form form = Form::Shader);

// One part of a surface as a function to paste into a shader of one's own.
Result<Artifact> make_function(const dsl::Catalogue& catalogue, const VariantRequest& request,
                               dsl::FunctionPart part, Binding binding,
                               const EmitOptions& options = {});

// The language a witness reads a target's text as; nothing for `none`, which no witness reads, and
// for the Direct3D 9 profiles, whose bytecode is read instead.
std::optional<check::Language> language_of(const Target& target);
// The profile of a Direct3D 9 target.
std::optional<d3d9::Profile> profile_of(const Target& target);
// Whether judge_variant has witnesses for it.
bool is_judged(const Target& target);
check::Source source_of(const Variant& variant, ir::Stage stage);

// How the variant's textures are to be given, by name: see check::Program.
struct TextureReading {
    std::set<std::string> one_level, nearest;
    std::map<std::string, std::string> baked;
};
TextureReading reading_of(const Variant& variant);

// Both stages as SPIR-V that fit each other, ready to run.  For the target `spirv` the optimised
// modules, for Direct3D 9 what MojoShader makes of the bytecode.  Error "not-runnable" for `none`,
// for glsl_120 and essl_100, which end after the front end, and for a vertex profile alone.
Result<check::Program> link_variant(const Variant& variant);

struct Judged {
    std::vector<std::string> steps;  // what each witness accepted, in order
    check::SpirvCost
        pixel_cost;  // of the optimised pixel stage; zero where the language has no SPIR-V
    std::vector<d3d9::Shader>
        shaders;  // Direct3D 9: the stages there are, as decoded from their bytes
};
// A stage of a Direct3D 9 variant as decoded from its bytes: what a device would load.
Result<d3d9::Shader> decode_stage(const Variant& variant, ir::Stage stage);
// Both stages through every witness there is for the target.  Error "no-witness" for a target
// without one.
Result<Judged> judge_variant(const Variant& variant);

// The most iterations of any loop of the pixel stage: the bound for longest paths.
int longest_loop(const ir::Program& program);

}  // namespace intaglio
