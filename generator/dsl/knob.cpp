// Setting knobs from text.
#include "generator/dsl/knob.h"

#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace intaglio::dsl {

std::string KnobBase::setting() const {
    return fmt::format("{} = {}", name_, static_cast<float>(number_));
}

Status KnobBase::set(std::string_view text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
        return input_error("knob-value",
                           fmt::format("the value '{}' of knob {} is not a number", text, name_));
    return set(value);
}

Status KnobBase::set(double value) {
    if (!std::isfinite(value) || (whole_ && value != std::floor(value)))
        return input_error("knob-value", fmt::format("knob {} takes a {} number; {} is none", name_,
                                                     whole_ ? "whole" : "finite", value));
    if (value < least_ || value > most_)
        return input_error("knob-range", fmt::format("knob {} takes {} to {}; {} is out of range",
                                                     name_, least_, most_, value));
    number_ = value;
    return Done{};
}

}  // namespace intaglio::dsl
