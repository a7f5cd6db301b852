// What the exact search and the exact shadow have baked, as the evaluator reads it.
#pragma once

#include <vector>

#include "generator/ir/texture.h"
#include "src/maps/bake_summit.h"

namespace intaglio::maps {

struct PatchTextures {
    ir::Texture summits, patches;

    // Heights in rows of `width`, kept as they are.
    PatchTextures(int width, int height, const std::vector<double>& heights) {
        Image image = blank_image(width, height, 1, 16);
        image.texels.assign(heights.begin(), heights.end());
        summits = texture_of(bake_summit(image).value());
        patches = texture_of({bake_patch(image).value()});
    }
    // The map behind a sampler's name; null where it is neither.
    const ir::Texture* named(const std::string& name) const {
        return name == "summit_map" ? &summits : name == "patch_map" ? &patches : nullptr;
    }

  private:
    static ir::Texture texture_of(const std::vector<Image>& levels) {
        ir::Texture texture;
        texture.width = levels.front().width;
        texture.height = levels.front().height;
        for (const Image& level : levels) texture.levels.push_back(level.texels);
        return texture;
    }
};

}  // namespace intaglio::maps
