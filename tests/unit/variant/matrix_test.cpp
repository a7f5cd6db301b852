// The whole matrix of the languages: every technique at both ends of every knob on every target,
// and compositions in which every two techniques meet on every target.  What is emitted passes the
// front end and the validator, what is refused says which limit it meets and what would fit.  The
// Direct3D 9 profiles have their own table (docs/targets/d3d9_variants.md) and their own judge
// (tests/judge).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <functional>
#include <map>
#include <set>
#include <thread>

#include "src/variant/settings.h"
#include "templates/all_techniques.h"

namespace intaglio {
namespace {

const dsl::Catalogue& catalogue() {
    static const dsl::Catalogue all = templates::all_techniques();
    return all;
}

// With a text of their own; spirv and msl are made from that of glsl_450.
const std::vector<std::string> texts = {"glsl_450", "glsl_330", "glsl_120", "essl_300", "essl_100",
                                        "hlsl_5_0", "hlsl_3_0", "hlsl_2_b", "hlsl_2_0"};

// What each may refuse; the others take everything.
const std::string no_levels = "no texture reads with a given level other than 0";
const std::map<std::string, std::vector<std::string>> limits = {
    {"essl_100", {"essl_100 has no volume textures"}},
    {"hlsl_3_0", {"hlsl_3_0 can repeat one 254 times"}},
    {"hlsl_2_b",
     {"reads textures more than 512 times", no_levels, "hlsl_2_b has no screen-space derivatives"}},
    {"hlsl_2_0",
     {"reads textures more than 32 times", no_levels, "hlsl_2_0 has no screen-space derivatives"}}};

struct Cell {
    std::string surface, target;
    std::vector<std::pair<std::string, std::string>> knobs = {};
    bool refused = false;
    std::string wrong = {};  // empty where all is as it should be

    std::string name() const {
        std::string text = surface;
        for (const auto& [knob, value] : knobs) text += " " + knob + "=" + value;
        return text + " on " + target;
    }
};

std::string complaint_about(const Diagnostic& refusal, const std::string& target) {
    const auto allowed = limits.find(target);
    const bool known =
        refusal.code == "target-limit" && allowed != limits.end() &&
        std::any_of(allowed->second.begin(), allowed->second.end(), [&](const auto& sentence) {
            return refusal.message.find(sentence) != std::string::npos;
        });
    if (!known) return to_string(refusal);
    // Every limit here has an equivalent that is cheaper, or a target beside it that can.
    return refusal.notes.empty() ? to_string(refusal) + " (it names nothing that would fit)" : "";
}

// Emits and validates; `thorough` is the whole chain of witnesses.
void look_at(Cell& cell, bool thorough) {
    VariantRequest request;
    request.surface = cell.surface;
    request.target = cell.target;
    request.knobs = cell.knobs;
    const Result<Variant> variant = make_variant(catalogue(), request);
    if (!variant) {
        cell.refused = true;
        cell.wrong = complaint_about(variant.error(), cell.target);
        return;
    }
    Status status = Done{};
    if (thorough) {
        if (const Result<Judged> judged = judge_variant(*variant); !judged) status = judged.error();
    } else if (check::has_spirv(*language_of(*variant->target))) {
        if (const Result<check::Program> linked = link_variant(*variant); !linked)
            status = linked.error();
    } else {
        for (ir::Stage stage : {ir::Stage::Vertex, ir::Stage::Pixel})
            if (status) status = check::parse(source_of(*variant, stage));
    }
    if (!status) cell.wrong = to_string(status.error());
}

// On two threads.
void look_at_all(std::vector<Cell>& cells, const std::function<bool(std::size_t)>& thorough) {
    std::atomic<std::size_t> next = 0;
    std::vector<std::jthread> threads;
    for (int i = 0; i < 2; ++i)
        threads.emplace_back([&] {
            for (std::size_t at = next++; at < cells.size(); at = next++)
                look_at(cells[at], thorough(at));
        });
}

void expect_right(const std::vector<Cell>& cells) {
    for (const Cell& cell : cells) EXPECT_EQ(cell.wrong, "") << cell.name();
}

TEST(Matrix, KnowsEveryLanguage) {
    std::vector<std::string> expected = texts;
    expected.insert(expected.end(), {"spirv", "msl"});
    std::vector<std::string> languages;
    for (const Target* target : all_targets())
        if (language_of(*target)) languages.emplace_back(target->name);
    EXPECT_THAT(languages, testing::UnorderedElementsAreArray(expected));
}

TEST(Matrix, EveryKnobAtBothEndsOnEveryLanguage) {
    const std::vector<Setting> settings = all_settings(catalogue());
    std::vector<Cell> cells;
    for (const std::string& target : texts)
        for (const Setting& setting : settings)
            cells.push_back({setting.surface, target, setting.knobs()});
    look_at_all(cells, [](std::size_t) { return false; });
    expect_right(cells);
    for (const std::string& target : texts) {
        const auto is_accepted = [&](const Cell& cell) {
            return cell.target == target && !cell.refused;
        };
        const auto accepted = std::count_if(cells.begin(), cells.end(), is_accepted);
        EXPECT_GT(accepted, static_cast<long>(settings.size() * 3 / 5)) << target;
    }
}

// A technique of each part, by index.
using Choice = std::array<std::size_t, 5>;

struct Part {
    std::string name;
    std::vector<std::string> techniques;
};

template <typename Table>
Part part_of(const std::string& name, const Table& table) {
    Part part{name, {}};
    for (const auto& row : table) part.techniques.push_back(row.name);
    return part;
}

std::vector<Part> all_parts() {
    return {part_of("search", catalogue().searches), part_of("shadow", catalogue().shadows),
            part_of("normal", catalogue().normals), part_of("shading", catalogue().shadings),
            part_of("output", catalogue().outputs)};
}

// Choices in which every two techniques of different parts meet: for each search under each shadow
// the rest with which the most pairs meet for the first time, `turn` deciding between equals.
std::vector<Choice> choices_of_all_pairs(const std::vector<Part>& parts, std::size_t turn) {
    std::set<std::array<std::size_t, 4>> met;
    const auto pairs_of = [](const Choice& choice) {
        std::vector<std::array<std::size_t, 4>> pairs;
        for (std::size_t i = 0; i < choice.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) pairs.push_back({i, choice[i], j, choice[j]});
        return pairs;
    };
    const auto size = [&](std::size_t part) { return parts[part].techniques.size(); };
    const std::size_t rest = size(2) * size(3) * size(4);
    std::size_t wanted = 0;
    for (std::size_t i = 0; i < parts.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) wanted += size(i) * size(j);
    std::vector<Choice> choices;
    // Once round is enough but for a pair or two.
    for (std::size_t outer = 0; met.size() < wanted || outer < size(0) * size(1); ++outer) {
        Choice best{};
        long most = outer < size(0) * size(1) ? -1 : 0;
        for (std::size_t k = 0; k < rest; ++k) {
            const std::size_t at = (k + turn + outer) % rest;
            const Choice choice = {outer % size(0), outer / size(0) % size(1), at % size(2),
                                   at / size(2) % size(3), at / size(2) / size(3)};
            const auto pairs = pairs_of(choice);
            const long fresh = std::count_if(pairs.begin(), pairs.end(),
                                             [&](const auto& pair) { return !met.count(pair); });
            if (fresh > most) most = fresh, best = choice;
        }
        if (most == 0) continue;
        choices.push_back(best);
        for (const auto& pair : pairs_of(best)) met.insert(pair);
    }
    return choices;
}

// Three steps of whatever is counted: where nothing may loop, enough to hold most.
std::vector<std::pair<std::string, std::string>> short_knobs(const std::string& surface) {
    std::vector<std::pair<std::string, std::string>> knobs;
    const Result<dsl::Surface> made = dsl::make_surface(catalogue(), surface);
    if (made)
        for (const dsl::KnobBase* knob : made->knobs())
            if (knob->whole() && knob->most() >= 16)
                // Leaps read coarser levels, which these languages cannot; without, cells are walked.
                knobs.emplace_back(knob->name(), knob->name().ends_with("leaps") ? "0" : "3");
    return knobs;
}

std::string text_of(const std::vector<Part>& parts, const Choice& choice) {
    std::string text;
    for (std::size_t i = 0; i < parts.size(); ++i)
        text += (i ? "," : "") + parts[i].name + "=" + parts[i].techniques[choice[i]];
    return text;
}

TEST(Matrix, EveryTwoTechniquesMeetOnEveryLanguage) {
    const std::vector<Part> parts = all_parts();
    std::vector<Cell> cells;
    std::vector<Choice> choices;
    for (std::size_t i = 0; i < texts.size(); ++i)
        for (const Choice& choice : choices_of_all_pairs(parts, 7 * i)) {
            const std::string surface = text_of(parts, choice);
            const bool loops = find_target(texts[i])->capabilities.loops;
            cells.push_back({surface, texts[i]});
            if (!loops) cells.back().knobs = short_knobs(surface);
            choices.push_back(choice);
        }
    look_at_all(cells, [](std::size_t) { return false; });
    expect_right(cells);
    // Each technique is accepted somewhere on each target, but for those that it cannot hold.
    const std::map<std::string, std::set<std::string>> impossible = {
        {"essl_100", {"search=distance", "search=view_dependent"}},
        {"hlsl_2_b", {"search=max_mip"}},
        {"hlsl_2_0", {"search=max_mip"}}};
    for (const std::string& target : texts) {
        std::set<std::string> never;
        for (const Part& part : parts)
            for (const std::string& technique : part.techniques)
                never.insert(part.name + "=" + technique);
        for (std::size_t i = 0; i < cells.size(); ++i)
            for (std::size_t part = 0; part < parts.size(); ++part)
                if (cells[i].target == target && !cells[i].refused)
                    never.erase(parts[part].name + "=" + parts[part].techniques[choices[i][part]]);
        const auto known = impossible.find(target);
        EXPECT_EQ(never, known == impossible.end() ? std::set<std::string>() : known->second)
            << target;
    }
}

// Front end, validator, optimiser, SPIRV-Cross to four languages and their front ends again: each
// technique once, on each target in turn.  The pairs' SPIR-V was validated above.
TEST(Matrix, EveryTechniquePassesTheWholeChainOfWitnesses) {
    const std::vector<Part> parts = all_parts();
    std::vector<std::string> targets = texts;
    targets.insert(targets.end(), {"spirv", "msl"});
    std::size_t most = 0;
    for (const Part& part : parts) most = std::max(most, part.techniques.size());
    std::vector<Cell> cells;
    for (const std::string& target : targets)
        for (std::size_t i = 0; i < most; ++i) {
            const bool whole = target == "glsl_450" || target == "hlsl_5_0";
            if (!whole && (i + cells.size()) % 3 != 0) continue;
            Choice choice{};
            for (std::size_t part = 0; part < parts.size(); ++part)
                choice[part] = i % parts[part].techniques.size();
            cells.push_back({text_of(parts, choice), target});
        }
    look_at_all(cells, [](std::size_t) { return true; });
    expect_right(cells);
}

}  // namespace
}  // namespace intaglio
