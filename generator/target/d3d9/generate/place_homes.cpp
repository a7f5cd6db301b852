// Consumers first: the lanes that an operand must have are given to the nodes that compute it.
#include "generator/target/d3d9/generate/place_homes.h"

#include <algorithm>

namespace intaglio::d3d9 {

void Homes::choose(const std::vector<int>& order) {
    for (std::size_t k = 0; k < graph_.outputs.size(); ++k)
        if (graph_.kind_of_output(k) == OutputKind::Colour)
            want({-1, static_cast<int>(k)}, graph_.outputs[k], positions_of_output(k), true);
    for (std::size_t i = order.size(); i-- > 0;) choose_homes(order[i]);
}

bool Homes::settle(int index, const Operand& operand, const Positions& positions, int target) {
    std::array<int, 4> lane{-1, -1, -1, -1};
    Mask taken = lanes(target);
    for (std::size_t k = 0; k < operand.lanes.size(); ++k) {
        if (operand.lanes[k].node != index) continue;
        int& mine = lane[static_cast<std::size_t>(operand.lanes[k].component)];
        if (mine >= 0 || (taken >> positions[k] & 1) != 0) return false;
        mine = positions[k];
        taken = static_cast<Mask>(taken | (1 << positions[k]));
    }
    // Lanes that other components of the operand need are not for the rest.
    Mask needed = taken;
    for (const int position : positions) needed = static_cast<Mask>(needed | (1 << position));
    for (int c = 0; c < node(index).width; ++c) {
        int& mine = lane[static_cast<std::size_t>(c)];
        for (int l = 0; mine < 0 && l < 4; ++l)
            if ((needed >> l & 1) == 0) {
                mine = l;
                needed = static_cast<Mask>(needed | (1 << l));
                taken = static_cast<Mask>(taken | (1 << l));
            }
        if (mine < 0) return false;
    }
    home(index) = {target, lane};
    lanes(target) = taken;
    return true;
}

void Homes::want(std::pair<int, int> user, const Operand& operand, const Positions& positions,
                 bool exact) {
    std::vector<int> sources;
    for (const Lane lane : operand.lanes)
        if (std::find(sources.begin(), sources.end(), lane.node) == sources.end())
            sources.push_back(lane.node);
    if (sources.size() == 1) {
        const int only = sources[0];
        if (!is_homeless(only) || (node(only).width < 2 && !exact)) return;
        const int target = new_register();
        if (!settle(only, operand, positions, target)) return;
        return;
    }
    if (std::all_of(sources.begin(), sources.end(),
                    [&](int index) { return node(index).kind == Node::Kind::Constant; }))
        return;
    const int target = vector_for(operand, positions);
    for (const int index : sources)
        if (is_homeless(index)) settle(index, operand, positions, target);
    for (std::size_t k = 0; k < operand.lanes.size(); ++k) {
        const int position = positions[k];
        if (is_at(operand.lanes[k], target, position) || !free(target, position)) continue;
        occupy(target, position);
        fills_[static_cast<std::size_t>(target)][static_cast<std::size_t>(position)] =
            operand.lanes[k];
    }
    gathers_[user] = target;
}

int Homes::vector_for(const Operand& operand, const Positions& positions) {
    std::map<int, int> fitting;
    for (std::size_t k = 0; k < operand.lanes.size(); ++k) {
        const Lane lane = operand.lanes[k];
        if (node(lane.node).kind != Node::Kind::Op || home(lane.node).target < 0) continue;
        if (is_texture_read(node(lane.node).op)) continue;
        const Home& h = home(lane.node);
        if (h.lane[static_cast<std::size_t>(lane.component)] == positions[k]) ++fitting[h.target];
    }
    int best = -1, most = 0;
    for (const auto& [target, count] : fitting) {
        bool room = true;
        for (std::size_t k = 0; k < operand.lanes.size(); ++k)
            room = room &&
                   (is_at(operand.lanes[k], target, positions[k]) || free(target, positions[k]));
        if (room && count > most) {
            best = target;
            most = count;
        }
    }
    return best >= 0 ? best : new_register();
}

bool Homes::is_at(Lane lane, int target, int position) {
    const auto& fill = fills_[static_cast<std::size_t>(target)][static_cast<std::size_t>(position)];
    if (fill && *fill == lane) return true;
    if (node(lane.node).kind != Node::Kind::Op) return false;
    const Home& h = home(lane.node);
    return h.target == target && h.lane[static_cast<std::size_t>(lane.component)] == position;
}

Positions Homes::positions_of(int index, std::size_t operand) {
    const Node& n = node(index);
    const std::size_t width = n.operands[operand].lanes.size();
    Positions result;
    for (std::size_t k = 0; k < width; ++k)
        result.push_back(is_dot(n.op) || is_texture_read(n.op) ? static_cast<int>(k)
                                                               : home(index).lane[k]);
    return result;
}

Positions Homes::positions_of_output(std::size_t k) const {
    if (graph_.output_places.empty()) return {0, 1, 2, 3};
    const auto& lanes = graph_.output_places[k].lanes;
    return {lanes.begin(), lanes.begin() + graph_.output_places[k].width};
}

void Homes::choose_homes(int index) {
    const Node& n = node(index);
    if (home(index).target < 0) {
        Home& mine = home(index);
        mine.target = new_register();
        for (int k = 0; k < n.width; ++k) {
            mine.lane[static_cast<std::size_t>(k)] = k;
            occupy(mine.target, k);
        }
    }
    if (is_scalar(n.op)) return;
    for (std::size_t k = 0; k < n.operands.size(); ++k)
        want({index, static_cast<int>(k)}, n.operands[k], positions_of(index, k),
             is_texture_read(n.op));
}

}  // namespace intaglio::d3d9
