// Each interpolant has a register of its own.
#include "generator/target/d3d9/generate/interpolants.h"

namespace intaglio::d3d9 {

std::vector<InterpolantPlace> interpolant_places(const ir::Module& pixel, Profile) {
    std::vector<InterpolantPlace> places(pixel.inputs.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        places[i].index = static_cast<int>(i);
        places[i].width = pixel.inputs[i].type.width;
    }
    return places;
}

Mask lanes_of_register(const std::vector<InterpolantPlace>& places, int index) {
    unsigned mask = 0;
    for (const InterpolantPlace& place : places)
        for (int k = 0; place.index == index && k < place.width; ++k)
            mask |= 1u << place.lanes[static_cast<std::size_t>(k)];
    return static_cast<Mask>(mask);
}

}  // namespace intaglio::d3d9
