// A range of values.
#pragma once

namespace intaglio::scene {

// Inclusive, in the unit of whoever holds it.  One value where least == most.
struct Span {
    double least = 0, most = 0;
    bool is_one() const { return least == most; }
    bool operator==(const Span&) const = default;
};

}  // namespace intaglio::scene
