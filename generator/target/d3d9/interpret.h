// Runs a Direct3D 9 shader on the CPU, in the arithmetic of the hardware one asks about: binary32,
// R300's 24 bits, or binary32 with `_pp` instructions in 16 (precision.h says how each rounds).  It
// works on the shader as decoded from bytecode, so that what runs is what was encoded.  Meaning of
// the instructions: Direct3D 9 reference, "Instructions".
//
// Sums and dot products are rounded after each multiplication and each addition, left to right;
// macros (nrm, pow, lrp, crs, m4x4 ...) as the sequence that their slots stand for, lrp as
// a * (b - c) + c.  What sincos destroys in shader model 2 reads as NaN afterwards.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "generator/base/result.h"
#include "generator/ir/texture.h"
#include "generator/target/d3d9/shader.h"

namespace intaglio::d3d9 {

enum class Arithmetic { Fp32, Fp24, Fp16Partial };

using Vector = std::array<float, 4>;

// What differs from pixel to pixel (vertex to vertex).
struct Inputs {
    std::array<Vector, 16> attributes{};  // v#
    std::array<Vector, 8> texcoords{};    // t#
    Vector position{};                    // vPos: x and y of the pixel, whole numbers
    float face = 1;                       // vFace: negative on back faces
};

// What a draw sets once.  Registers beyond the ends read as 0; `def` in the shader hides them.
struct Environment {
    std::vector<Vector> constants{};             // c#
    std::vector<std::array<int, 4>> integers{};  // i#
    std::vector<bool> booleans{};                // b#
    std::vector<const ir::Texture*> samplers{};  // s#
};

struct Execution {
    std::array<Vector, 4> colours{};    // oC#
    float depth = 0;                    // oDepth
    bool killed = false;                // texkill; the instructions after it ran all the same
    Vector position{};                  // oPos (vs_2_0)
    Vector fog{}, point_size{};         // oFog, oPts
    std::array<Vector, 2> diffuse{};    // oD#
    std::array<Vector, 8> texcoords{};  // oT#
    std::array<Vector, 12> outputs{};   // o# (vs_3_0)
    int texture_reads = 0;              // carried out for this pixel
    long instructions = 0;              // carried out for this pixel; label and nop count as well
    // False: stopped after 2^22 instructions of loops within loops, or calls deeper than 8.
    bool complete = true;
};

class Interpreter {
  public:
    // Reads the shader once and keeps nothing of it.  Errors name the instruction, counted from 0:
    // "d3d9-malformed" (a register out of range, operands missing, blocks that do not match, an
    // unknown label), "d3d9-cube-texture" (cube textures cannot be read here).  It is no checker of
    // the profile's rules.
    static Result<Interpreter> prepare(const Shader& shader);

    // One pixel or vertex alone: derivatives are 0 and texld reads level 0.  Any number of threads.
    // `counts`, if given, gets one number per instruction of the shader increased.
    Execution run(const Environment& environment, const Inputs& inputs, Arithmetic arithmetic,
                  std::vector<long>* counts = nullptr) const;

    // Two by two pixels at once, upper left, upper right, lower left, lower right: dsx is the
    // difference within a row, dsy within a column, and texld chooses its level from them.
    std::array<Execution, 4> run_quad(const Environment& environment,
                                      const std::array<Inputs, 4>& inputs, Arithmetic arithmetic,
                                      std::vector<long>* counts = nullptr) const;

    struct Prepared;

  private:
    std::shared_ptr<const Prepared> prepared_;
};

// Values and textures to the registers that the constant table gives their names.  Values lie one
// register after the other, each as many as the constant has columns (booleans: one).  What the
// table does not name is ignored.  Errors: "missing-uniform", "missing-texture", "bad-uniform" (a
// wrong number of values).
Result<Environment> environment_of(const Shader& shader,
                                   const std::map<std::string, std::vector<float>>& uniforms,
                                   const std::map<std::string, const ir::Texture*>& textures);

// Sets the lanes of input registers that carry this usage.  Pixel shaders of model 2 take
// texcoord n in t#n and color n in v#n, the others what their declarations say.
void set_input(const Shader& shader, Inputs& inputs, Usage usage, int index, const Vector& value);

// What a vertex shader wrote for this usage: oPos, oD#, oT# in vs_2_0, declared o# in vs_3_0; 0 in
// lanes that nothing declares.
Vector output_of(const Shader& shader, const Execution& execution, Usage usage, int index);

}  // namespace intaglio::d3d9
