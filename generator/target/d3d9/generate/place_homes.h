// Which lanes of which virtual register each node's result gets: the half of placement that writes
// no instructions yet.
#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "generator/target/d3d9/generate/code.h"

namespace intaglio::d3d9 {

using Positions = std::vector<int>;  // where each component of an operand must appear

class Homes {
  protected:
    explicit Homes(const Graph& graph) : graph_(graph), homes_(graph.nodes.size()) {}

    struct Home {
        int target = -1;
        std::array<int, 4> lane{};
    };
    const Node& node(int index) const { return graph_.nodes[static_cast<std::size_t>(index)]; }
    Home& home(int index) { return homes_[static_cast<std::size_t>(index)]; }
    Mask& lanes(int target) { return code_.lanes[static_cast<std::size_t>(target)]; }
    int new_register() {
        code_.lanes.push_back(0);
        fills_.emplace_back();
        return static_cast<int>(code_.lanes.size()) - 1;
    }
    bool free(int target, int lane) { return (lanes(target) >> lane & 1) == 0; }
    void occupy(int target, int lane) {
        lanes(target) = static_cast<Mask>(lanes(target) | (1 << lane));
    }

    bool is_homeless(int index) {
        return node(index).kind == Node::Kind::Op && !is_texture_read(node(index).op) &&
               home(index).target < 0;
    }

    // Homes for what colours and other vectors need whole, then for each node from the last on.
    void choose(const std::vector<int>& order);
    // Whether the component lies there, or a mov will bring it.
    bool is_at(Lane lane, int target, int position);
    // Where an operand's components must appear.
    Positions positions_of(int index, std::size_t operand);
    Positions positions_of_output(std::size_t k) const;

    const Graph& graph_;
    Code code_;
    std::map<std::pair<int, int>, int> gathers_;  // by user and operand: the register of a vector

  private:
    // Tries to give the node a home in which its components at these lanes of the operand appear.
    bool settle(int index, const Operand& operand, const Positions& positions, int target);
    // An operand that must be seen at these positions: homes for what has none.
    void want(std::pair<int, int> user, const Operand& operand, const Positions& positions,
              bool exact);
    // The register that has most of the operand in place and room for the rest, or a new one.
    int vector_for(const Operand& operand, const Positions& positions);
    void choose_homes(int index);

    std::vector<Home> homes_;
    std::vector<std::array<std::optional<Lane>, 4>> fills_;  // by register: lanes kept for movs
};

}  // namespace intaglio::d3d9
