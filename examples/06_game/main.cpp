// What an engine does with the headers that the build makes: it finds the variant for its device,
// and reads what that wants of it.
#include <cstdio>

#include "courtyard/floor_tiles.h"
#include "courtyard/wall.h"

namespace {

template <typename Stage>
void print_stage(const char* name, const Stage& stage) {
    std::printf("  %s: %zu bytes of text, %zu of binary, uniforms of %d bytes\n", name,
                stage.text.size, stage.binary.size, stage.uniform_bytes);
    for (const auto& uniform : stage.uniforms)
        std::printf("    uniform %s at byte %d\n", uniform.name, uniform.offset);
    for (const auto& sampler : stage.samplers)
        std::printf("    sampler %s in slot %d reads %s\n", sampler.name, sampler.slot,
                    sampler.map);
}

template <typename Variant>
int print_variant(const Variant* variant, const char* target) {
    if (!variant) return std::printf("%s: no such variant\n", target), 1;
    std::printf("%s on %s: %s\n", variant->name, variant->target, variant->composition);
    print_stage("vertex", variant->vertex);
    print_stage("pixel", variant->pixel);
    return 0;
}

}  // namespace

int main() {
    int missing = 0;
    for (const char* target : {"glsl_450", "ps_2_b"})
        missing += print_variant(game::shaders::wall::find(target), target);
    missing += print_variant(game::shaders::floor_tiles::find("glsl_450"), "glsl_450");

    // The uniforms of a target have names and types: what a wall's pixels do not read is not there.
    game::shaders::wall::glsl_450::PixelUniforms uniforms{};
    std::printf("%zu bytes to fill\n", sizeof(uniforms));
    return missing;
}
