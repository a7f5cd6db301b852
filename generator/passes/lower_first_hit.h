// Searches for a first hit to straight code whose cost does not grow with what the loop carries.
//
// A search marches until a sample lies above a ray and leaves with what it carries there: the
// place, the sample, the sample before.  Unrolled, each carried value costs a select for each
// iteration. Instead each iteration's gap keeps one number, its key, where it is a hit; the
// greatest key is that of the first hit, and what the loop carried there is computed from it again,
// texture reads included.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "generator/ir/module.h"

namespace intaglio::passes {

enum class FirstHitForm {
    Chain,          // the loop stays as it is: unroll_loops makes selects of it
    PackedRefetch,  // greatest key, then everything again at the hit
    AnyHit,         // greatest gap, where one only asks whether there is a hit; else PackedRefetch
};

// A loop, and what becomes of it.
struct FirstHit {
    std::string loop;
    int trip_count = 0;
    bool only_whether = false;  // it can be AnyHit: a shadow ray
    FirstHitForm form = FirstHitForm::Chain;
    std::string refusal;  // why it can only be a chain: "it is left from more than one place"
};

// The form that a loop which can have it shall have.
using ChooseFirstHit = std::function<FirstHitForm(const FirstHit&)>;

// Rewrites the loops that are a search and for which `choose` does not say Chain; says of each
// loop, inner ones first, what became of it.  A search has one break_if and no inner branch or
// loop, and what it carries is memoryless: a function of the index and of values from outside, or
// such a value of the iteration before.
//
// Bit-exact, NaN being no hit as in the loop itself, except that a result may be the other zero
// where a device's max takes either of two zeros.  All iterations' conditions are computed; texture
// reads that only results need run once.  Keys are values that the loop computes anyway or count
// down from the number of iterations; every result is recovered from them by ops that were tried on
// all of the loop's iterations, so that its bits are the loop's.
//
// AnyHit is for a search whose results only serve to compare again what its condition compares, and
// whose condition may be `hit or stop` with a stop that stays, such as a rising ray above the
// relief. It needs no texture read but those of the samples compared, and no key.  It compares
// differences to zero, as Direct3D 9 compares anyway: its truth can be another where two infinities
// or denormals are compared, or NaN in the iteration in which the loop ends.
//
// For packing four to a register, what is alike stands together: first all conditions, then the
// selects of four iterations after four, each `select(condition, key, gap)` with the gap whose sign
// decides the condition, so that a machine's compare with zero takes it as it is; then the maxima
// of lane j of one four with lane j of the next; last, within a register, x with w and y with z.
//
// Run it on optimized modules whose loops are not yet unrolled; run optimize afterwards.  Ends with
// values numbered anew.
//
// With Rounding::Free results may differ by what a place that is 2^-22 of the ray away changes,
// which allows more keys: those that end within 2^-22 of zero count as ending there.  Zero times
// what is read or passed is zero.  And a result that differs in the first iteration, where the
// search has nothing behind it, is told by the values at the hit.  A shadow ray above 1 is above
// all texels, which lie in [0, 1] then.
enum class Rounding { Exact, Free };
std::vector<FirstHit> lower_first_hit(ir::Module& module, const ChooseFirstHit& choose,
                                      Rounding rounding = Rounding::Exact);
std::vector<FirstHit> lower_first_hit(ir::Module& module, FirstHitForm form);

}  // namespace intaglio::passes
