// Signs for the eye, amounts for the rest.
#include "src/report/hard_table.h"

#include <algorithm>

#include <fmt/format.h>

namespace intaglio::report {
namespace {

using measure::Expect;
using measure::HardCase;
using measure::HardCell;
using measure::HardPart;
using measure::HardRow;
using measure::HardSuite;
using measure::Verdict;

constexpr std::string_view introduction = R"(# Hard cases

Written by `intaglio hard -o docs/hard-cases.md`; a test writes parts of it again and compares. Every technique at
its default knobs on every input that relief shaders are known to break on, four ways: as glsl_450 on the device, and
its IR in the evaluator in fp32, in R300's 24 bits and in 16 bits, every value rounded, coordinates and constants too
([generator/ir/narrow.h](../generator/ir/narrow.h)). Device: {}.

Each ray of a case is judged by what the case expects of the technique:

- `.` *fine*: as expected. Of a search, unless the case says otherwise: no first hit missed and 95 % of the hits within
  half a texel of the exact first hit (1.5 where a step is as long as a texel). Techniques that promise no first hit (a single read, a table, columns in place
  of the filtered relief) are measured against what their own formula gives in real numbers. Shadows: at most 5 % of
  the points judged otherwise than exactly. Colours: 95 % within 2/255 of the same shading in real numbers (an 8-bit
  read, under light of strength 2).
- `o` *degraded*: defined, finite and on the ray, and further off than that. The sections below say by how much.
- `X` *broken*: NaN, Inf, a point off the ray or a height outside of the relief.
- `-` *no such number*: the format has no number as large as the case's input (100000 and 1e20 in 16 bits, 1e20 in 24).

The signs stand for device, fp32, fp24 and fp16, in this order. {} rays a case and aim, on maps of 64 x 64 texels, scale
0.08 unless said.

)";

constexpr std::string_view promises = R"(
## NaN and Inf

What is not a number is no input. Uniforms, vertices and float textures that hold NaN or Inf are refused by the runner
with a sentence that names them [bad-uniform, bad-mesh, bad-texture], PNG files have no such texels, and the shaders
spend no slots on them: NaN in is NaN out, at that pixel alone.

)";

std::string amount(double value) {
    return value < 0.01 ? fmt::format("{:.1g}", value)
           : value < 10 ? fmt::format("{:.2f}", value)
                        : fmt::format("{:.0f}", value);
}

char sign(Verdict verdict) {
    switch (verdict) {
        case Verdict::Absent: return ' ';
        case Verdict::NoSuchNumber: return '-';
        case Verdict::Fine: return '.';
        case Verdict::Degraded: return 'o';
        case Verdict::Broken: return 'X';
    }
    return ' ';
}

std::string signs(const std::array<HardCell, measure::all_ways.size()>& cells) {
    std::string text;
    for (const HardCell& cell : cells) text += sign(cell.verdict);
    return cells[0].verdict == Verdict::Absent ? std::string() : "`" + text + "`";
}

std::string_view title_of(HardPart part) {
    switch (part) {
        case HardPart::Search: return "Searches";
        case HardPart::Shadow: return "Shadows";
        case HardPart::Colour: return "Normals, shadings, outputs";
    }
    return {};
}

std::string overview(const HardSuite& suite, HardPart part) {
    std::vector<std::size_t> rows;
    for (std::size_t r = 0; r < suite.rows.size(); ++r)
        if (suite.rows[r].part == part) rows.push_back(r);
    if (rows.empty()) return {};
    std::string text = fmt::format("### {}\n\n| |", title_of(part)), line = "|---|";
    for (std::size_t r : rows) {
        text += fmt::format(" {} |", suite.rows[r].name);
        line += "---|";
    }
    text += "\n" + line + "\n";
    for (std::size_t c = 0; c < suite.cases.size(); ++c) {
        if (!measure::expected_of(suite.rows[rows.front()], suite.cases[c])) continue;
        text += fmt::format("| {} |", suite.cases[c].name);
        for (std::size_t r : rows) text += fmt::format(" {} |", signs(suite.cells[r][c]));
        text += "\n";
    }
    return text + "\n";
}

std::string list_of_cases(const HardSuite& suite) {
    std::string text = "## The cases\n\n| case | expected | because |\n|---|---|---|\n";
    for (const HardCase& hard_case : suite.cases)
        text += fmt::format("| {} | {} | {} |\n", hard_case.name, hard_case.expectation,
                            hard_case.reason);
    return text;
}

}  // namespace

std::string hard_words(const HardRow& row, const HardCase& hard_case, const HardCell& cell) {
    if (cell.verdict == Verdict::Absent) return {};
    if (cell.verdict == Verdict::Fine) return "fine";
    if (cell.verdict == Verdict::NoSuchNumber) return "no such number";
    if (cell.invalid > 0) return fmt::format("**NaN or Inf in {} of {}**", cell.invalid, cell.rays);
    if (cell.astray > 0)
        return fmt::format("**{} of {} {}**", cell.astray, cell.rays,
                           row.part == HardPart::Search ? "off the ray" : "out of range");
    const std::optional<Expect> expect = measure::expected_of(row, hard_case);
    if (row.part == HardPart::Search) {
        std::string text = fmt::format("{} texels", amount(cell.amount));
        if (cell.missed > 0) text += fmt::format(", {:.0f} % missed", 100 * cell.missed);
        return text;
    }
    const bool in_steps = row.part == HardPart::Colour || expect == Expect::OwnFormula ||
                          row.yardstick == measure::HardYardstick::OwnFormula;
    return in_steps ? fmt::format("{}/255", amount(cell.amount))
                    : fmt::format("{:.0f} % wrong", 100 * cell.amount);
}

std::string hard_section(const HardSuite& suite, std::size_t row) {
    std::string text = fmt::format("### {}\n\n`{}`", suite.rows[row].name, suite.rows[row].surface);
    for (const auto& [knob, value] : suite.rows[row].knobs)
        text += fmt::format(" `-D {}={}`", knob, value);
    text += "\n\n";
    std::string lines, fine;
    for (std::size_t c = 0; c < suite.cases.size(); ++c) {
        const auto& cells = suite.cells[row][c];
        if (cells[0].verdict == Verdict::Absent) continue;
        if (std::all_of(cells.begin(), cells.end(),
                        [](const HardCell& cell) { return cell.verdict == Verdict::Fine; })) {
            fine += fmt::format("{}{}", fine.empty() ? "" : ", ", suite.cases[c].name);
            continue;
        }
        lines += fmt::format("| {} |", suite.cases[c].name);
        for (const HardCell& cell : cells)
            lines += fmt::format(" {} |", hard_words(suite.rows[row], suite.cases[c], cell));
        lines += "\n";
    }
    if (!lines.empty())
        text += "| | device | fp32 | fp24 | fp16 |\n|---|---|---|---|---|\n" + lines + "\n";
    if (!fine.empty()) text += fmt::format("Fine in all four: {}.\n\n", fine);
    return text;
}

std::string hard_page(const HardSuite& suite) {
    std::string text =
        fmt::format(introduction, suite.device, measure::patch_pixels * measure::patch_pixels);
    text += list_of_cases(suite) + std::string(promises) + "## At a glance\n\n";
    for (HardPart part : {HardPart::Search, HardPart::Shadow, HardPart::Colour})
        text += overview(suite, part);
    text += "## By technique\n\n";
    for (std::size_t row = 0; row < suite.rows.size(); ++row) text += hard_section(suite, row);
    text.pop_back();
    return text;
}

}  // namespace intaglio::report
