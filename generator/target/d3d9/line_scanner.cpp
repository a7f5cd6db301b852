// Numbers are read as D3DAssemble reads them: to double, then rounded to float, denormals kept.
#include "generator/target/d3d9/line_scanner.h"

#include <bit>
#include <charconv>
#include <system_error>

namespace intaglio::d3d9 {
namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

template <typename Number>
std::optional<Number> whole(std::string_view text) {
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

}  // namespace

void LineScanner::skip_blanks() {
    while (at_ < line_.size() && is_blank(line_[at_])) ++at_;
}

template <typename Accepts>
std::string_view LineScanner::run(Accepts accepts) {
    skip_blanks();
    const std::size_t begin = at_;
    while (at_ < line_.size() && accepts(line_[at_])) ++at_;
    return line_.substr(begin, at_ - begin);
}

bool LineScanner::take(std::string_view text) {
    skip_blanks();
    if (!line_.substr(at_).starts_with(text)) return false;
    at_ += text.size();
    return true;
}

std::string_view LineScanner::letters() { return run(is_letter); }

std::string_view LineScanner::word() {
    return run([](char c) { return is_letter(c) || is_digit(c) || c == '_'; });
}

std::string_view LineScanner::token() {
    return run([](char c) { return !is_blank(c) && c != ',' && c != '[' && c != ']'; });
}

std::optional<int> LineScanner::number(int most) {
    const auto value = whole<int>(run(is_digit));
    return value && *value <= most ? value : std::nullopt;
}

std::optional<std::uint32_t> LineScanner::integer() {
    take("+");
    const auto value = whole<std::int32_t>(token());
    return value ? std::optional(static_cast<std::uint32_t>(*value)) : std::nullopt;
}

std::optional<std::uint32_t> LineScanner::real() {
    const bool negative = take("-");
    if (!negative) take("+");
    const std::uint32_t sign = negative ? 0x80000000u : 0u;
    const std::string_view text = token();
    if (text == "1.#INF") return sign | 0x7F800000u;
    if (text == "1.#QNAN") return sign | 0x7FE00000u;
    if (text == "1.#IND") return sign | 0x7FC00000u;
    if (text.empty() || !(is_digit(text[0]) || text[0] == '.')) return std::nullopt;
    const auto value = whole<double>(text);
    if (!value) return std::nullopt;
    return sign | std::bit_cast<std::uint32_t>(static_cast<float>(*value));
}

}  // namespace intaglio::d3d9
