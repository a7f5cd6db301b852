// One variant tried on a surface's rays, without a device: its IR in the evaluator, its Direct3D 9
// bytecode in the interpreter.  Both give bit for bit what lavapipe draws (docs/conventions.md),
// the evaluator for all languages at once.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "generator/dsl/catalogue.h"
#include "src/measure/case.h"
#include "src/measure/shared.h"
#include "src/plan/rays.h"
#include "src/scene/scene.h"

namespace intaglio::plan {

// What came out, by the names of docs/budgets.md.
struct Trial {
    std::string refusal, refusal_code;     // why its target cannot have it; empty: it can
    std::map<std::string, double> errors;  // the worst of all shots
    std::map<std::string, double> costs;
    // Of the dearest view: operations carried out for a pixel, reads of textures not among them,
    // and those reads.  Where nothing loops, the arithmetic and texture slots.
    double operations = 0, reads = 0;
    double cost(double read_weight) const { return operations + read_weight * reads; }
};

// What is asked of a variant.
enum class Ask {
    Errors,  // of hits, and of the visibility of the lights; costs: reads
    Cost,    // operations and reads of the shaded surface, on the run
    Size,    // the same with every loop written out, run or not: nothing is run
    Fit,     // whether its target has it; costs: its slots or instructions; of bytecode its
             // operations and reads as well
};

// A surface's map with all that trials share.  May be used from several threads at once.
class Site {
  public:
    // All must outlive it.
    Site(const dsl::Catalogue& catalogue, const scene::SceneSurface& surface);
    ~Site();

    // Where light `number` of a variant stands, from 1; the first is the shots'.
    void aim(std::size_t number, measure::Direction towards);

    // A language's variant in the evaluator, a Direct3D 9 target's in the interpreter.  Errors: our
    // own, and those of the maps; a refusal is none.
    Result<Trial> run(const VariantRequest& request, const Rays& rays, Ask ask) const;

    // How many texels a baked map has for each of the height map's, by the largest that the search
    // or shadow reads; 0: it reads none.
    double baked_texels(const VariantRequest& request) const;

    // Whatever of the surface a trial's outcome depends on.
    std::string identity() const;
    const reference::HeightField& field() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

// The slots and instructions that a budget can limit, of the shaded pixel stage.
Result<std::map<std::string, double>> static_costs(const Variant& variant);

}  // namespace intaglio::plan
