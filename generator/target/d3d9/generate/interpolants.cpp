// Two interpolants of two components share a register: then an instruction may read both, since it
// counts the registers, and `.wzyx` shows the second where it is needed.
#include "generator/target/d3d9/generate/interpolants.h"

#include <algorithm>

#include "generator/passes/rewrite.h"

namespace intaglio::d3d9 {
namespace {

// Which inputs a texture is read at as they are: a coordinate takes no swizzle.
std::vector<char> find_coordinates(const ir::Module& pixel) {
    std::vector<char> coordinates(pixel.inputs.size());
    std::vector<int> slots(pixel.values.size(), -1);
    passes::for_each_instruction(pixel.body, [&](const ir::Instruction& instruction) {
        if (instruction.op == ir::Op::Input)
            slots[ir::index_of(instruction.result())] = instruction.slot;
        if (!ir::is_sample(instruction.op)) return;
        const int slot = slots[ir::index_of(instruction.operands[0])];
        if (slot >= 0) coordinates[static_cast<std::size_t>(slot)] = 1;
    });
    return coordinates;
}

}  // namespace

std::vector<InterpolantPlace> interpolant_places(const ir::Module& pixel, Profile) {
    std::vector<InterpolantPlace> places(pixel.inputs.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        places[i].width = pixel.inputs[i].type.width;
        places[i].index = -1;
    }
    const std::vector<char> coordinates = find_coordinates(pixel);
    // The first that is as wide and shares with none is the host.
    std::vector<int> host(places.size(), -1);
    std::vector<char> shares(places.size());
    for (std::size_t i = places.size(); i-- > 0;) {
        if (places[i].width != 2 || coordinates[i] != 0 || shares[i] != 0) continue;
        for (std::size_t j = 0; j < places.size() && host[i] < 0; ++j)
            if (j != i && places[j].width == 2 && shares[j] == 0) host[i] = static_cast<int>(j);
        if (host[i] < 0) continue;
        shares[i] = shares[static_cast<std::size_t>(host[i])] = 1;
        places[i].lanes = {3, 2, 1, 0};
    }
    int next = 0;
    for (std::size_t i = 0; i < places.size(); ++i)
        if (host[i] < 0) places[i].index = next++;
    for (std::size_t i = 0; i < places.size(); ++i)
        if (host[i] >= 0) places[i].index = places[static_cast<std::size_t>(host[i])].index;
    return places;
}

passes::InterpolantLimits interpolant_limits(Profile profile) {
    constexpr int registers = 8, components = 4 * registers;
    return {components, components, [profile](const ir::Module& pixel) {
                const auto places = interpolant_places(pixel, profile);
                return std::all_of(
                    places.begin(), places.end(),
                    [&](const InterpolantPlace& place) { return place.index < registers; });
            }};
}

Mask lanes_of_register(const std::vector<InterpolantPlace>& places, int index) {
    unsigned mask = 0;
    for (const InterpolantPlace& place : places)
        for (int k = 0; place.index == index && k < place.width; ++k)
            mask |= 1u << place.lanes[static_cast<std::size_t>(k)];
    return static_cast<Mask>(mask);
}

}  // namespace intaglio::d3d9
