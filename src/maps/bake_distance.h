// Distance maps: around each point of the box above the polygon's floor, how large a ball is
// empty.  Donnelly, "Per-Pixel Displacement Mapping with Distance Functions", GPU Gems 2, 2005.
#pragma once

#include "generator/base/result.h"
#include "src/maps/image.h"
#include "src/maps/work.h"

namespace intaglio::maps {

// A volume as an image: slice k is the rows k * height / depth to (k + 1) * height / depth - 1.
struct Volume {
    int depth = 1;
    Image slices;

    int height() const { return slices.height / depth; }
    float at(int x, int y, int slice, int channel = 0) const {
        return slices.at(x, slice * height() + y, channel);
    }
    float& at(int x, int y, int slice, int channel = 0) {
        return slices.at(x, slice * height() + y, channel);
    }
};

// The height of the relief in the space where distances are measured, in texture units: points are
// (u, v, distance_depth * height).  Any constant is right for any scale of the relief, since what
// is stored is which points are empty, and an ellipsoid says it as well as a ball does; this one
// makes the voxels of 256 x 256 x 32 cubes.
inline constexpr double distance_depth = 1.0 / 8;

// One channel with the precision of `heights`, `columns` x `rows` x `slices` voxels, or the map's
// own size where that is smaller.  Voxel (x, y, k) stands for the texture coordinates
// [x, x + 1] / columns, [y, y + 1] / rows and the heights within half a slice of k / (slices - 1):
// it is read nearest, at w = (height * (slices - 1) + 0.5) / slices.
//
// value * distance_depth is at most the distance from any point of the voxel to the relief, as
// measured above (rounded down).  So from height z above any point, a ray that travels `reach`
// texture units while it descends by 1 may advance by
//     value / sqrt(1 + (length(reach) / distance_depth)^2)   in height
// and touches nothing.  0 where the relief comes into the voxel's column up to its height, or
// next to it.  Two passes of a separable distance transform for each slice: voxels times the
// distance in voxels.
//
// Codes: "image-malformed"; "image-size" where rows times slices is too large; "slices-range"
// unless 2 to 256 slices.
Result<Volume> bake_distance(const Image& heights, int columns = 256, int rows = 256,
                             int slices = 32, const Work& work = {});

}  // namespace intaglio::maps
