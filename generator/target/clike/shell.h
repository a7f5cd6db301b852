// What surrounds a body in every C-like language: the header comment, and names that both stages
// agree on.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "generator/base/result.h"
#include "generator/base/text.h"
#include "generator/ir/module.h"
#include "generator/target/clike/expressions.h"
#include "generator/target/clike/names.h"
#include "generator/target/target.h"

namespace intaglio::clike {

enum class Kind { Attribute, Interpolant, Target, Uniform, Sampler };

// The names of everything a program declares outside its bodies, the same whichever stage is
// printed.
class InterfaceNames {
  public:
    // attribute_prefix: before the names of vertex attributes, where they share the scope of
    // interpolants; may be empty.
    InterfaceNames(const ir::Program& program, std::string_view attribute_prefix);

    const std::string& of(Kind kind, const std::string& dsl_name) const {
        return names_.at({kind, dsl_name});
    }
    std::vector<std::string> of_uniforms(const ir::Module& module) const;
    std::vector<std::string> of_samplers(const ir::Module& module) const;
    // What the body of a stage sees: everything that its text declares globally.
    NameScope scope_of(const ir::Program& program, ir::Stage stage) const;
    // The same where inputs and outputs are members of structs.
    NameScope scope_of_uniforms(const ir::Module& module) const;

  private:
    void declare(Kind kind, const std::string& dsl_name, std::string_view prefix = {});

    std::map<std::pair<Kind, std::string>, std::string> names_;
    NameScope scope_;
};

// A name for a texture, with "<name>_sampler" free for the sampler state beside it in languages
// that part the two.
std::string declare_sampler(NameScope& scope, std::string_view wanted);

// The names of a function and of everything it sees outside its body.
struct FunctionNames {
    std::string function;
    NameScope scope;
    OuterNames outer;
};
FunctionNames names_of_function(const ir::Module& function);

// "name: pixel stage for glsl_450", the description, the settings.
void put_header(TextBuilder& out, const ir::Program& program, ir::Stage stage,
                const Target& target);

// Appends a declaration with its comment: beside it if the line is short enough, else above.
void put_declaration(TextBuilder& out, std::string_view declaration, std::string_view comment);

// The place of the vertex stage's interpolant of this name among its interpolants.  Error
// "stages-disagree".
Result<int> interpolant_location(const ir::Program& program, const ir::Declaration& pixel_input);

// What is printed beside a sampler's declaration: its comment, and the filter that its user must
// set where that is not the usual linear one.
std::string sampler_comment(const ir::Sampler& sampler);

// Slots of a draw's samplers: those of the pixel stage in its order, then those that only the
// vertex stage has.
int sampler_slot(const ir::Program& program, const std::string& name);

// Error "uniform-conflict" if both stages declare one name differently, where they share names.
Status check_shared_uniforms(const ir::Program& program);

bool has_rolled_loop(const ir::Region& region);

inline const ir::Module& stage_of(const ir::Program& program, ir::Stage stage) {
    return stage == ir::Stage::Vertex ? program.vertex : program.pixel;
}

}  // namespace intaglio::clike
