// Schedules: first match wins.
#include "generator/dsl/schedule.h"

namespace intaglio::dsl {

bool matches_pattern(std::string_view name, std::string_view pattern) {
    if (pattern.empty()) return name.empty();
    if (pattern.front() == '*')
        return matches_pattern(name, pattern.substr(1)) ||
               (!name.empty() && matches_pattern(name.substr(1), pattern));
    return !name.empty() && name.front() == pattern.front() &&
           matches_pattern(name.substr(1), pattern.substr(1));
}

Schedule::Selection Schedule::on(std::string_view pattern) {
    return {*this, matches_pattern(target_, pattern)};
}

Schedule::Selection& Schedule::Selection::unroll(const Loop& loop) {
    if (matches_) schedule_.forms_.try_emplace(&loop, ir::LoopForm::Unrolled);
    return *this;
}

Schedule::Selection& Schedule::Selection::loop(const Loop& loop) {
    if (matches_) schedule_.forms_.try_emplace(&loop, ir::LoopForm::Rolled);
    return *this;
}

Schedule::Selection& Schedule::Selection::closed_form(const Loop& loop) {
    if (matches_) schedule_.closed_forms_.try_emplace(&loop, true);
    return *this;
}

Schedule::Selection& Schedule::Selection::per_vertex() {
    if (matches_) schedule_.per_vertex_ = true;
    return *this;
}

void Schedule::apply(Recorder& recorder) const {
    for (const auto& [loop, form] : forms_)
        recorder.set_loop_form(*loop, form, closed_forms_.contains(loop));
    for (const auto& [loop, closed] : closed_forms_)
        if (!forms_.contains(loop))
            recorder.set_loop_form(*loop, ir::LoopForm::Unspecified, closed);
}

}  // namespace intaglio::dsl
