// `intaglio table`: what each Direct3D 9 profile makes of every technique and knob, in Markdown.
#include <algorithm>
#include <functional>

#include <fmt/format.h>

#include "src/cli/commands.h"
#include "src/cli/progress.h"
#include "src/variant/settings.h"

namespace intaglio::cli {
namespace {

const std::vector<std::string> profiles = {"ps_2_0", "ps_2_a", "ps_2_b", "ps_3_0"};

constexpr std::string_view introduction =
    R"(# Every technique and knob on the Direct3D 9 profiles

Written by `intaglio table -o docs/targets/d3d9_variants.md`; a test compares a part of it with what the
generator says today. A knob stands at its default, at its least and at its greatest, the others at their
defaults; settings that come out the same in all profiles share a line, and knobs that a program does not depend on
are left out.

- `41 + 9, r6, d1`: 41 arithmetic and 9 texture slots of the pixel stage by Direct3D's charge, 6 temporary
  registers, texture reads that depend on each other 1 deep.
- *79 of 64 arithmetic slots* (1): refused, the first limit that it exceeds, and the number of the sentence below.
- *as by default*: refused for want of slots by default, and not tried, because this setting needs no fewer, or
  because the default needs over four times what there is and this is no number of steps.

)";

// A section's refusals, each sentence once, numbered from 1.
class Sentences {
  public:
    std::size_t number_of(const std::string& sentence) {
        const auto found = std::find(all_.begin(), all_.end(), sentence);
        if (found != all_.end()) return static_cast<std::size_t>(found - all_.begin()) + 1;
        all_.push_back(sentence);
        return all_.size();
    }
    std::string list() const {
        std::string text = all_.empty() ? "" : "\n";
        for (std::size_t i = 0; i < all_.size(); ++i)
            text += fmt::format("{}. {}\n", i + 1, all_[i]);
        return text;
    }

  private:
    std::vector<std::string> all_;
};

std::string cell_of(const Fit& fit, Sentences& sentences) {
    if (fit.as_default) return "*as by default*";
    if (!fit.refusal)
        return fmt::format("{} + {}, r{}, d{}", fit.pixel.arithmetic, fit.pixel.texture,
                           fit.pixel.temps, fit.pixel.dependent_level);
    std::string sentence = fit.refusal->message;
    if (!fit.refusal->file.empty())
        sentence = fmt::format("{} ({}:{})", sentence, fit.refusal->file, fit.refusal->line);
    return fmt::format("*{}* ({})", fit.limit, sentences.number_of(sentence));
}

std::string label_of(const Setting& setting) {
    if (!setting.knob.first.empty())
        return fmt::format("`{}={}`", setting.knob.first, setting.knob.second);
    return setting.work == Setting::Work::More ? "shaded" : "by default";
}

// One technique: rows with the same cells are one.
std::string section(const std::vector<const FitRow*>& rows) {
    Sentences sentences;
    std::vector<std::pair<std::string, std::string>> lines;  // cells and labels
    for (const FitRow* row : rows) {
        std::string cells;
        for (const Fit& fit : row->fits) cells += fmt::format(" {} |", cell_of(fit, sentences));
        const auto same = std::find_if(lines.begin(), lines.end(),
                                       [&](const auto& line) { return line.first == cells; });
        if (same == lines.end())
            lines.emplace_back(cells, label_of(row->setting));
        else
            same->second += ", " + label_of(row->setting);
    }
    std::string text = fmt::format("## {}\n\n`{}`\n\n|  | {} |\n|---|---|---|---|---|\n",
                                   rows.front()->setting.title, rows.front()->setting.surface,
                                   fmt::join(profiles, " | "));
    for (const auto& [cells, label] : lines) text += fmt::format("| {} |{}\n", label, cells);
    return text + sentences.list() + "\n";
}

std::string markdown(const std::vector<FitRow>& rows) {
    std::size_t emitted = 0, refused = 0, untried = 0;
    for (const FitRow& row : rows)
        for (const Fit& fit : row.fits)
            ++(fit.as_default ? untried : fit.refusal ? refused : emitted);
    std::string text(introduction);
    text += fmt::format("{} variants are emitted, {} refused, {} not tried.\n\n", emitted, refused,
                        untried);
    for (std::size_t first = 0; first < rows.size();) {
        std::vector<const FitRow*> of_section;
        std::size_t next = first;
        for (; next < rows.size() && rows[next].setting.title == rows[first].setting.title; ++next)
            of_section.push_back(&rows[next]);
        text += section(of_section);
        first = next;
    }
    text.pop_back();
    return text;
}

}  // namespace

Status table_of_settings(const dsl::Catalogue& catalogue, const TableOptions& options) {
    const std::vector<FitRow> rows = [&] {
        ProgressLine progress("tried", "variants");
        return fit_settings(catalogue, profiles, options.only, options.threads, std::ref(progress));
    }();
    if (rows.empty())
        return input_error("option-value",
                           fmt::format("--only: no technique's title contains '{}'; they read "
                                       "search=relief, shadow=march, relief, preset fur",
                                       options.only));
    return write_product(options.output, markdown(rows), false);
}

}  // namespace intaglio::cli
