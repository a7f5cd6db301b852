// Runs a vertex module in the IR's evaluator and its bytecode in the interpreter, on the same
// attributes and uniforms.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "generator/ir/evaluate.h"
#include "generator/target/d3d9/generate/generate.h"
#include "generator/target/d3d9/generate/interpolants.h"
#include "generator/target/d3d9/interpret.h"

namespace intaglio::d3d9 {

// Attributes and uniforms by slot.
struct VertexValues {
    std::vector<ir::Environment::Vector> attributes;
    std::vector<std::vector<ir::Environment::Vector>> uniforms;
};

// An output of the module, and where the shader has it.
struct Wired {
    std::size_t output = 0;
    InterpolantPlace place;
};

class VertexDraw {
  public:
    // The shader as decoded from its bytes.
    VertexDraw(const ir::Module& vertex, const Shader& shader);

    // Each component of the wired outputs, as the evaluator and as the shader has it.
    struct Pair {
        double expected = 0, got = 0;
    };
    std::vector<Pair> run(const VertexValues& values, const std::vector<Wired>& wires,
                          ir::Precision precision = ir::Precision::Single) const;
    // What the shader writes; uniforms by name, or those of `values`.
    Execution execute(const VertexValues& values,
                      std::map<std::string, std::vector<float>> uniforms = {}) const;
    const Shader& shader() const { return shader_; }

  private:
    ir::Module module_;
    Shader shader_;
    ir::Evaluator evaluator_;
};

// The position, and each interpolant of the pixel module by its name.
std::vector<Wired> wires_of(const ir::Program& program, Profile pixel);

}  // namespace intaglio::d3d9
