// Costs by target.
#include "src/report/cost_table.h"

#include <algorithm>
#include <regex>

#include <fmt/format.h>

#include "src/check/spirv.h"
#include "src/variant/variant.h"

namespace intaglio::report {
namespace {

// Lines of templates move with every edit, and the sentence is true without them.
std::string without_places(const std::string& sentence) {
    static const std::regex place(R"((, \d+ of them)? at templates/[a-z0-9_/]+\.(cpp|h):\d+)");
    return std::regex_replace(sentence, place, "");
}

Result<std::string> cost_text(const Variant& variant) {
    if (profile_of(*variant.target)) {
        const Result<d3d9::Shader> shader = decode_stage(variant, ir::Stage::Pixel);
        if (!shader) return shader.error();
        const d3d9::Resources used = d3d9::count(*shader);
        return fmt::format("{} + {}", used.arithmetic, used.texture);
    }
    const std::optional<check::Language> language = language_of(*variant.target);
    if (!language || !check::has_spirv(*language)) return std::string("emitted");
    const Result<check::SpirvWords> words = check::to_spirv(source_of(variant, ir::Stage::Pixel));
    if (!words) return words.error();
    const Result<check::SpirvWords> optimized = check::optimize_spirv(*words);
    if (!optimized) return optimized.error();
    const Result<check::SpirvCost> cost =
        check::count_spirv(*optimized, longest_loop(variant.program));
    if (!cost) return cost.error();
    return fmt::format("{} + {}, path {}", cost->alu, cost->texture, cost->longest_path);
}

// The targets of `cells` that differ in no column, as lines.
struct Line {
    std::vector<std::string> targets;
    std::string cells;
};

std::size_t number_of(std::vector<std::string>& sentences, const std::string& sentence) {
    const auto found = std::find(sentences.begin(), sentences.end(), sentence);
    const auto at = static_cast<std::size_t>(found - sentences.begin());
    if (found == sentences.end()) sentences.push_back(sentence);
    return at + 1;
}

}  // namespace

Result<std::vector<CostCell>> costs_of(const dsl::Catalogue& catalogue, const std::string& surface,
                                       const std::vector<CostCell>& part) {
    std::vector<CostCell> cells;
    for (const Target* target : all_targets()) {
        if (!is_judged(*target) || !target->pixel_stage) continue;
        CostCell cell{std::string(target->name), {}, {}};
        if (cells.size() < part.size() && part[cells.size()].cost.empty()) {
            cells.push_back(std::move(cell));
            continue;
        }
        if (!target->derived_from.empty()) {
            // Made of another target's text: its instructions are that one's.
            const auto from = std::find_if(cells.begin(), cells.end(), [&](const CostCell& other) {
                return other.target == target->derived_from;
            });
            if (from != cells.end()) {
                cell.cost = from->cost;
                cell.refusal = from->refusal;
                cells.push_back(std::move(cell));
                continue;
            }
        }
        const Result<Variant> variant =
            make_variant(catalogue, {surface, cell.target, {}, {}, false, false, {}, 0});
        if (!variant && !is_refusal(variant.error())) return variant.error();
        if (variant) {
            Result<std::string> cost = cost_text(*variant);
            if (!cost) return cost.error();
            cell.cost = std::move(*cost);
        } else {
            cell.refusal = without_places(variant.error().message);
        }
        cells.push_back(std::move(cell));
    }
    return cells;
}

std::string cost_table(const std::vector<CostColumn>& columns) {
    std::vector<std::string> sentences;
    std::vector<Line> lines;
    for (std::size_t target = 0; target < columns.front().cells.size(); ++target) {
        std::string cells;
        for (const CostColumn& column : columns) {
            const CostCell& cell = column.cells[target];
            if (!cell.cost.empty())
                cells += fmt::format(" {} |", cell.cost);
            else if (cell.refusal.empty())
                cells += " *refused* |";
            else
                cells += fmt::format(" *refused* ({}) |", number_of(sentences, cell.refusal));
        }
        const auto same = std::find_if(lines.begin(), lines.end(),
                                       [&](const Line& line) { return line.cells == cells; });
        const std::string& name = columns.front().cells[target].target;
        if (same == lines.end())
            lines.push_back({{name}, cells});
        else
            same->targets.push_back(name);
    }
    std::string text = "| target |", rule = "|---|";
    for (const CostColumn& column : columns) {
        text += fmt::format(" {} |", column.heading);
        rule += "---|";
    }
    text += "\n" + rule + "\n";
    for (const Line& line : lines)
        text += fmt::format("| {} |{}\n", fmt::join(line.targets, ", "), line.cells);
    if (!sentences.empty()) text += "\n";
    for (std::size_t i = 0; i < sentences.size(); ++i)
        text += fmt::format("{}. {}\n", i + 1, sentences[i]);
    return text;
}

}  // namespace intaglio::report
