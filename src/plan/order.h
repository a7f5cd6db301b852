// An order: everything that one variant of a scene is made from, and nothing else.  Planning ends
// in orders, building begins with them; as text they are the inputs of a build's actions.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "generator/base/result.h"
#include "src/variant/variant.h"

namespace intaglio::plan {

// A number with who made it: {"arithmetic", 43, "Direct3D 9's charge"}.  Names and units are those
// of docs/budgets.md.
struct Figure {
    std::string metric;
    double value = 0;
    std::string maker;
};

// A map that the variant reads, besides those of the surface: the kind as `intaglio bake` has it.
struct MapOrder {
    std::string uniform;  // the sampler's name: "cone_map"
    std::string kind;     // "relaxed-cone"; "height", "normal", "colour" of the surface's own
    std::string file;     // "quay.relaxed-cone.png"
};

struct Order {
    std::string surface;     // of the scene: "quay"
    VariantRequest request;  // composition, target, knobs, loops, what is known
    std::vector<Figure> costs, errors;
    std::vector<MapOrder> maps;
    // The scene's lights that the shader's are, by number: `light` first, then `light_1`.
    std::vector<std::string> lights = {};

    // "quay.ps_2_0": what its files begin with.
    std::string name() const { return surface + "." + request.target; }
};

// JSON, the same bytes for equal orders.
std::string to_text(const Order& order);
// Code "order-syntax"; `file` is what errors name.
Result<Order> read_order(const std::string& text, const std::string& file);

}  // namespace intaglio::plan
