// A draw, prepared once and drawn many times: two SPIR-V stages, a mesh and everything they read,
// by name.  Names, places and sizes come from the SPIR-V itself (check::reflect), so a caller never
// numbers a binding.
//
// Life: fill a Draw, Program::prepare uploads and compiles it, then draw() returns the pixels and
// time_draw() how long the device took; set_uniform() changes numbers between draws.  Programs on
// one device may be drawn alternately.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "generator/base/result.h"
#include "src/check/source.h"
#include "src/vulkan/device.h"
#include "src/vulkan/mesh.h"
#include "src/vulkan/texture.h"

namespace intaglio::vulkan {

struct Stage {
    check::SpirvWords spirv;
    std::string entry = "main";
};

struct Draw {
    Stage vertex;
    Stage fragment;

    // Vertex inputs called position, normal, tangent and uv get the mesh's; the names may carry one
    // of the prefixes in_, a_, v_, vertex_, in, a and end in 0, and "pos", "texcoord" and
    // "tex_coord" are understood (in any case).
    const Mesh* mesh = nullptr;
    // Members of uniform blocks by member name, array elements one after the other without padding,
    // vectors by component.  Integer members take whole numbers.  One name fills every block that
    // has it.
    std::map<std::string, std::vector<float>> uniforms;
    // Combined and separate images by their name.  A separate sampler takes its state from the
    // given texture whose name is the longest that begins the sampler's: `height_map` serves
    // height_mapSampler and height_map_sampler.
    std::map<std::string, const Texture*> textures;
    // Names of textures that are sampled nearest, in texel and level, whatever they say themselves:
    // what the shader's sampler declarations ask for.
    std::set<std::string> nearest;

    int width = 0, height = 0;  // pixels; powers of two make the quad's varyings exact on lavapipe
    bool depth_test =
        false;  // nearer wins, depth cleared to 1; else later triangles win.  Nothing is culled.
    std::array<float, 4> clear{};  // every target where no triangle is, and components that the
                                   // shader does not write
    int colour_targets = 0;        // 0: as many as the fragment stage's outputs say
    // How the device stores every colour target; what is read back is what was stored.
    Texture::Format target_format = Texture::Format::Rgba32Float;
};

// One target as RGBA float32, row by row, row 0 the top one (y = -1 in Vulkan's clip space).
struct Picture {
    int width = 0, height = 0;
    std::vector<std::array<float, 4>> pixels;
    const std::array<float, 4>& at(int x, int y) const {
        return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x)];
    }
};

class Program {
  public:
    // Reads the draw and everything it points to; nothing of it is kept.
    // Errors name what is missing and list what was given: `missing-uniform`, `missing-texture`,
    // `missing-attribute`, `unmatched-varying`; or say what does not fit: `bad-uniform`,
    // `bad-texture`, `bad-mesh`, `bad-target`, `too-large`, `unsupported-format`,
    // `unsupported-resource`, `binding-conflict`, and what reflection and the device have to say
    // (`spirv-invalid`, `out-of-memory`, ...).
    static Result<Program> prepare(const Device& device, const Draw& draw);

    // Takes effect at the next draw.  Error `bad-uniform`: not the number of values that the shader
    // declares. A name that no block has is fine, as in Draw.
    Status set_uniform(const std::string& name, const std::vector<float>& values);

    // The targets in order of location.
    Result<std::vector<Picture>> draw();

    // Nanoseconds that the device needed for the pass, without reading back; from timestamps, or by
    // the host's clock where the device has none.  Always positive.  The first call draws once more
    // beforehand, because drivers compile at the first draw.  On a CPU device take minima of
    // interleaved draws, and trust ratios only.
    Result<double> time_draw();

    Program(Program&&) noexcept;
    Program& operator=(Program&&) noexcept;
    ~Program();

  private:
    struct State;
    explicit Program(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace intaglio::vulkan
