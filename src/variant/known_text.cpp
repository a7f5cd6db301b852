// Numbers, lists and ranges after a name.
#include "src/variant/known_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace intaglio {
namespace {

// All of the text, or nothing.
std::optional<float> number_in(std::string_view text) {
    float number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(number))
        return {};
    return number;
}

// "name=rest" in two; nothing if either is empty.
std::optional<std::pair<std::string, std::string>> halves_of(const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) return {};
    std::size_t name = equals, rest = equals + 1;
    while (name > 0 && text[name - 1] == ' ') --name;
    while (rest < text.size() && text[rest] == ' ') ++rest;
    if (name == 0 || rest == text.size()) return {};
    return std::pair{text.substr(0, name), text.substr(rest)};
}

std::optional<std::vector<float>> numbers_in(std::string_view text) {
    std::vector<float> numbers;
    for (std::size_t start = 0; start <= text.size();) {
        const std::size_t comma = std::min(text.find(',', start), text.size());
        const std::optional<float> number = number_in(text.substr(start, comma - start));
        if (!number) return {};
        numbers.push_back(*number);
        start = comma + 1;
    }
    return numbers;
}

// "0.25..1", or "0.5" for both ends.
std::optional<passes::Interval> interval_in(std::string_view text) {
    const std::size_t dots = text.find("..");
    const std::optional<float> least = number_in(text.substr(0, dots));
    const std::optional<float> most =
        dots == std::string_view::npos ? least : number_in(text.substr(dots + 2));
    if (!least || !most) return {};
    return passes::Interval{*least, *most};
}

}  // namespace

Result<passes::Known> known_in(const std::vector<std::string>& fixed,
                               const std::vector<std::string>& assumed) {
    passes::Known known;
    const auto twice = [](const std::string& name) {
        return input_error("known-syntax", fmt::format("two values of {} are given", name));
    };
    for (const std::string& text : fixed) {
        const auto halves = halves_of(text);
        const auto numbers = halves ? numbers_in(halves->second) : std::nullopt;
        if (!numbers)
            return input_error(
                "known-syntax",
                fmt::format("'{}' is not of the form scale=0.05 or ambient=0.1,0.1,0.1", text));
        if (!known.uniforms.emplace(halves->first, *numbers).second) return twice(halves->first);
    }
    for (const std::string& text : assumed) {
        const auto halves = halves_of(text);
        const auto interval = halves ? interval_in(halves->second) : std::nullopt;
        if (!interval)
            return input_error("known-syntax",
                               fmt::format("'{}' is not of the form view.z=0.25..1", text));
        if (!known.ranges.emplace(halves->first, *interval).second) return twice(halves->first);
    }
    return known;
}

Result<passes::Known> known_in(const std::vector<std::string>& lines) {
    std::vector<std::string> fixed, assumed;
    for (const std::string& line : lines)
        (line.find("..") == std::string::npos ? fixed : assumed).push_back(line);
    return known_in(fixed, assumed);
}

}  // namespace intaglio
