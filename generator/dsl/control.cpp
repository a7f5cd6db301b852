// Recorded ifs.
#include "generator/dsl/control.h"

namespace intaglio::dsl {

void If(bool1 condition, const std::function<void()>& then_body,
        const std::function<void()>& else_body, Place place) {
    Recorder& recorder = Recorder::current();
    recorder.locate(place);
    recorder.begin_if(condition.id());
    then_body();
    recorder.begin_else();
    if (else_body) else_body();
    recorder.end_if();
    recorder.locate(place);
}

}  // namespace intaglio::dsl
