// The state of an unfinished command line (which command, whose value is next, which surface was
// named), and the lists that values come from.
#include "src/cli/completion.h"

#include <memory>
#include <optional>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "generator/base/nearest.h"
#include "generator/target/target.h"
#include "src/maps/makers.h"

namespace intaglio::cli {

// src/cli/shells/, embedded (cmake/EmbedFiles.cmake).
std::string_view shell_file(std::string_view name);

namespace {

// Candidates for what begins with `prefix + begun`; each is printed with the prefix.
class Candidates {
  public:
    Candidates(std::string prefix, std::string begun)
        : prefix_(std::move(prefix)), begun_(std::move(begun)) {}

    const std::string& begun() const { return begun_; }

    void add(std::string_view word, std::string_view what) {
        if (!word.starts_with(begun_) || !seen_.insert(std::string(word)).second) return;
        // The text is one line of the shell's list.
        text_ += fmt::format("{}{}\t{}\n", prefix_, word, what);
    }
    void add_files(std::string_view ending) {
        text_ += fmt::format(":files{}{}\t{}\n", ending.empty() ? "" : "=", ending, prefix_);
    }
    void add_folders() { text_ += fmt::format(":folders\t{}\n", prefix_); }
    // What follows the last `separator` is completed by itself.
    void enter(char separator) {
        const std::size_t at = begun_.rfind(separator);
        if (at == std::string::npos) return;
        prefix_ += begun_.substr(0, at + 1);
        begun_.erase(0, at + 1);
        seen_.clear();
    }
    std::string take() { return std::move(text_); }

  private:
    std::string prefix_, begun_, text_;
    std::set<std::string> seen_;
};

template <typename Kind>
void add_rows(Candidates& candidates, const std::vector<dsl::Entry<Kind>>& table) {
    for (const dsl::Entry<Kind>& row : table) candidates.add(row.name, row.summary);
}

void add_part(Candidates& candidates, const dsl::Catalogue& catalogue, std::string_view part) {
    if (part == "search") add_rows(candidates, catalogue.searches);
    if (part == "shadow") add_rows(candidates, catalogue.shadows);
    if (part == "normal") add_rows(candidates, catalogue.normals);
    if (part == "shading") add_rows(candidates, catalogue.shadings);
    if (part == "output") add_rows(candidates, catalogue.outputs);
    if (part == "vertex") add_rows(candidates, catalogue.vertex_works);
}

// "parallax_occlusion,shadow=ma": only the first item may be a name of its own.
void add_surfaces(Candidates& candidates, const dsl::Catalogue& catalogue) {
    const bool first = candidates.begun().find(',') == std::string::npos;
    candidates.enter(',');
    const std::string item = candidates.begun();
    if (const std::size_t equals = item.find('='); equals != std::string::npos) {
        candidates.enter('=');
        add_part(candidates, catalogue, item.substr(0, equals));
        return;
    }
    if (first) {
        for (const dsl::Preset& preset : catalogue.presets)
            candidates.add(preset.name, preset.composition);
        add_rows(candidates, catalogue.searches);
    }
    for (const char* part : {"search=", "shadow=", "normal=", "shading=", "output=", "vertex="})
        candidates.add(part, "");
}

void add_knobs_of(Candidates& candidates, const std::vector<dsl::KnobBase*>& knobs) {
    for (const dsl::KnobBase* knob : knobs)
        candidates.add(knob->name() + "=",
                       fmt::format("{} ({}, {} to {})", knob->comment(), knob->initial(),
                                   knob->least(), knob->most()));
}

template <typename Kind>
void add_table_knobs(Candidates& candidates, const std::vector<dsl::Entry<Kind>>& table) {
    for (const dsl::Entry<Kind>& row : table) add_knobs_of(candidates, row.make()->knobs());
}

// Those of the surface that the line names, or of all techniques.
void add_knobs(Candidates& candidates, const dsl::Catalogue& catalogue,
               const std::string& surface) {
    if (!surface.empty())
        if (const Result<dsl::Surface> made = dsl::make_surface(catalogue, surface)) {
            add_knobs_of(candidates, made->knobs());
            return;
        }
    add_table_knobs(candidates, catalogue.searches);
    add_table_knobs(candidates, catalogue.shadows);
    add_table_knobs(candidates, catalogue.normals);
    add_table_knobs(candidates, catalogue.shadings);
    add_table_knobs(candidates, catalogue.outputs);
    add_table_knobs(candidates, catalogue.vertex_works);
    add_knobs_of(candidates, dsl::ReliefKnobs().knobs());
}

void add_alternatives(Candidates& candidates, std::string_view value) {
    while (!value.empty()) {
        const std::size_t bar = std::min(value.find('|'), value.size());
        std::string_view word = value.substr(0, bar);
        if (const std::size_t equals = word.find('='); equals != std::string_view::npos)
            word = word.substr(0, equals + 1);
        // In capitals: not itself but something in its place.
        if (word.front() < 'A' || word.front() > 'Z') candidates.add(word, "");
        value.remove_prefix(std::min(bar + 1, value.size()));
    }
}

// `program`: its bakes are the kinds of baked maps.
void add_values(Candidates& candidates, const CommandText& program, const dsl::Catalogue& catalogue,
                const std::string& value, const std::string& surface) {
    if (value == "SURFACE") return add_surfaces(candidates, catalogue);
    if (value == "KNOB=NUMBER") return add_knobs(candidates, catalogue, surface);
    if (value == "DIR") return candidates.add_folders();
    if (value.find('|') != std::string::npos) return add_alternatives(candidates, value);
    if (value == "TARGET") {
        for (const Target* target : all_targets())
            candidates.add(target->name, target->description);
    } else if (value == "MAP") {
        for (const maps::Maker& maker : maps::makers()) candidates.add(maker.name, maker.sentence);
    } else if (value == "LOOP=FORM") {
        if (candidates.begun().find('=') == std::string::npos) return;
        candidates.enter('=');
        add_alternatives(candidates, "unroll|loop");
    } else if (value.find("FILE") != std::string::npos) {
        if (value.starts_with("KIND=")) {
            if (candidates.begun().find('=') == std::string::npos) {
                for (const CommandText& command : program.commands)
                    if (command.name == "bake")
                        for (const CommandText& kind : command.commands)
                            candidates.add(kind.name + "=", kind.text);
                return;
            }
            candidates.enter('=');
        }
        const std::size_t dot = value.rfind('.');
        candidates.add_files(dot == std::string::npos ? "" : value.substr(dot + 1));
    }
}

const OptionText* option_named(const CommandText& command, std::string_view name) {
    for (const OptionText& option : command.options)
        for (const std::string& own : option.names)
            if (!option.positional && own == name) return &option;
    return nullptr;
}

// What was read of the line before the word that is completed.
struct Line {
    const CommandText* command;
    const OptionText* waiting = nullptr;  // the option whose value is next
    std::size_t positionals = 0;          // how many were given
    bool only_positionals = false;        // after "--"
    std::string surface = {};

    const OptionText* next_positional() const {
        const OptionText* last = nullptr;
        std::size_t index = 0;
        for (const OptionText& option : command->options) {
            if (!option.positional) continue;
            last = &option;
            if (index++ == positionals) return last;
        }
        return last && last->repeatable ? last : nullptr;
    }

    void read(const std::string& word) {
        if (waiting) {
            waiting = nullptr;
        } else if (word == "--") {
            only_positionals = true;
        } else if (word.size() > 1 && word[0] == '-' && !only_positionals) {
            // "-DKNOB" and "--define=KNOB" hold their value.
            const OptionText* option = option_named(*command, word);
            if (option && !option->value.empty() && !option->optional_value) waiting = option;
        } else {
            for (const CommandText& inner : command->commands)
                if (inner.name == word) {
                    *this = Line{&inner};
                    return;
                }
            const OptionText* positional = next_positional();
            if (positional && positional->value == "SURFACE") surface = word;
            ++positionals;
        }
    }
};

// "--define=KNOB" or "-DKNOB": the option, and how much of the word is its name.
std::pair<const OptionText*, std::size_t> attached_value(const CommandText& command,
                                                         const std::string& word) {
    if (word.starts_with("--")) {
        const std::size_t equals = word.find('=');
        if (equals == std::string::npos) return {nullptr, 0};
        return {option_named(command, word.substr(0, equals)), equals + 1};
    }
    if (word.size() > 2 && word[0] == '-') return {option_named(command, word.substr(0, 2)), 2};
    return {nullptr, 0};
}

}  // namespace

std::string complete_words(const CommandText& program, const dsl::Catalogue& catalogue,
                           const std::vector<std::string>& words) {
    if (words.empty()) return {};
    Line line{&program};
    for (std::size_t i = 0; i + 1 < words.size(); ++i) line.read(words[i]);
    const std::string& word = words.back();
    Candidates candidates("", word);
    if (line.waiting) {
        add_values(candidates, program, catalogue, line.waiting->value, line.surface);
        return candidates.take();
    }
    if (!line.only_positionals && !word.empty() && word[0] == '-') {
        const auto [option, length] = attached_value(*line.command, word);
        if (option && !option->value.empty()) {
            Candidates values(word.substr(0, length), word.substr(length));
            add_values(values, program, catalogue, option->value, line.surface);
            return values.take();
        }
        for (const OptionText& known : line.command->options)
            if (!known.positional)
                for (const std::string& name : known.names) candidates.add(name, known.text);
        return candidates.take();
    }
    for (const CommandText& command : line.command->commands)
        candidates.add(command.name, command.text);
    if (const OptionText* positional = line.next_positional())
        add_values(candidates, program, catalogue, positional->value, line.surface);
    return candidates.take();
}

Result<std::string> completion_script(const std::string& shell, const std::string& program) {
    // A function's name in both shells.
    std::string function = "_";
    for (const char c : program)
        function +=
            (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ? c : '_';
    std::string script(shell_file("completion." + shell));
    if (script.empty())
        return input_error(
            "unknown-shell",
            unknown_name_sentence("shell", shell, std::vector<std::string>{"bash", "zsh"}));
    for (const auto& [mark, by] :
         {std::pair{"@FUNCTION@", function}, std::pair{"@PROGRAM@", program},
          std::pair{"@COMPLETE@", std::string(complete_command)}})
        for (std::size_t at = 0; (at = script.find(mark, at)) != std::string::npos; at += by.size())
            script.replace(at, std::string_view(mark).size(), by);
    return script;
}

}  // namespace intaglio::cli
