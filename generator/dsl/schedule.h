// The schedule: how the arithmetic of a technique is carried out on which target.  It changes cost,
// never the result beyond a stated rounding bound.  A directive is obeyed or refused with a
// sentence, never skipped.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "generator/dsl/control.h"

namespace intaglio::dsl {

class Schedule {
  public:
    explicit Schedule(std::string target) : target_(std::move(target)) {}

    // Directives for the targets whose name matches the pattern, in which * stands for any run of
    // characters.  For each loop the first matching directive holds, so that special targets come
    // first and "*" last.
    class Selection {
      public:
        // Written out iteration by iteration, early exits as selects.
        Selection& unroll(const Loop& loop);
        // Stays a loop.
        Selection& loop(const Loop& loop);
        // Float inductions v += c become start + i * c: shorter dependency, other rounding (within
        // trip count ulps).
        Selection& closed_form(const Loop& loop);
        // Affine functions of interpolants move to the vertex stage: the same value but for the
        // rounding of the interpolation (a few ulps of the largest term).
        Selection& per_vertex();

      private:
        friend class Schedule;
        Selection(Schedule& schedule, bool matches) : schedule_(schedule), matches_(matches) {}
        Schedule& schedule_;
        bool matches_;
    };
    Selection on(std::string_view pattern);

    bool moves_to_vertex() const { return per_vertex_; }
    // Hands the loops' directives to the recorder.
    void apply(Recorder& recorder) const;

  private:
    std::string target_;
    std::map<const Loop*, ir::LoopForm> forms_;
    std::map<const Loop*, bool> closed_forms_;
    bool per_vertex_ = false;
};

// Whether a name matches a pattern in which * stands for any run of characters.
bool matches_pattern(std::string_view name, std::string_view pattern);

}  // namespace intaglio::dsl
