// Words for cases.
#include "src/measure/command.h"

#include <initializer_list>

#include <fmt/format.h>

namespace intaglio::measure {

std::string_view word_of(ir::LoopForm form) {
    switch (form) {
        case ir::LoopForm::Rolled: return "loop";
        case ir::LoopForm::Unrolled: return "unroll";
        case ir::LoopForm::Unspecified: break;
    }
    return "schedule";
}

ir::LoopForm form_of(std::string_view word) {
    for (const ir::LoopForm form : {ir::LoopForm::Rolled, ir::LoopForm::Unrolled})
        if (word == word_of(form)) return form;
    return ir::LoopForm::Unspecified;
}

namespace {

// Options and what they are given: "--fix", "scale=0.05".
std::vector<std::pair<std::string, std::string>> options_of(const passes::Known& known) {
    std::vector<std::pair<std::string, std::string>> options;
    for (const auto& [name, numbers] : known.uniforms)
        options.emplace_back("--fix", fmt::format("{}={}", name, fmt::join(numbers, ",")));
    for (const auto& [name, range] : known.ranges)
        options.emplace_back("--assume", fmt::format("{}={}..{}", name, range.least, range.most));
    return options;
}

}  // namespace

std::string text_of(const VariantRequest& request) {
    std::vector<std::string> words{request.surface, request.target};
    auto knobs = request.knobs;
    // Stable: of a knob that is given twice the later one counts.
    std::stable_sort(knobs.begin(), knobs.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [knob, value] : knobs) words.push_back(fmt::format("-D {}={}", knob, value));
    for (const auto& [loop, form] : request.loop_forms)
        words.push_back(fmt::format("--loop {}={}", loop, word_of(form)));
    if (request.per_vertex) words.emplace_back("--per-vertex");
    if (request.count_reads) words.emplace_back("--count-reads");
    if (dsl::pass_count(request.split) > 1)
        words.push_back(
            fmt::format("--split {} --pass {}", dsl::to_string(request.split), request.pass));
    for (const auto& [option, value] : options_of(request.known))
        words.push_back(option + " " + value);
    return fmt::format("{}", fmt::join(words, " "));
}

std::vector<std::string> variant_options(const VariantRequest& request) {
    std::vector<std::string> words{request.surface, "-T", request.target};
    const auto add = [&](const std::string& option, const std::string& value) {
        words.insert(words.end(), {option, value});
    };
    for (const auto& [knob, value] : request.knobs) add("-D", knob + "=" + value);
    for (const auto& [loop, form] : request.loop_forms)
        if (form != ir::LoopForm::Unspecified)
            add("--loop", fmt::format("{}={}", loop, word_of(form)));
    if (request.per_vertex) words.emplace_back("--per-vertex");
    for (const auto& [option, value] : options_of(request.known)) add(option, value);
    return words;
}

std::string run_command(const Case& what, const std::vector<std::string>& map_arguments,
                        const std::string& device, const std::vector<std::string>& more) {
    std::vector<std::string> words{"intaglio", "run"};
    const auto add = [&](std::initializer_list<std::string> some) {
        words.insert(words.end(), some);
    };
    for (std::string& word : variant_options(what.request)) words.push_back(std::move(word));
    words.insert(words.end(), map_arguments.begin(), map_arguments.end());
    // Angles are joined to their option, because they may be negative.
    add({"--scale", fmt::format("{}", what.scale), "--mesh", "map",
         fmt::format("--elevation={}", what.view.elevation),
         fmt::format("--azimuth={}", what.view.azimuth),
         fmt::format("--light-elevation={}", what.light.elevation),
         fmt::format("--light-azimuth={}", what.light.azimuth), "--size",
         fmt::format("{0}x{0}", what.size)});
    if (what.filtering == Filtering::Native) add({"--filtering", "native"});
    if (what.arithmetic != Arithmetic::Fp32)
        add({"--arithmetic", std::string(name_of(what.arithmetic))});
    if (!device.empty()) add({"--device", device});
    words.insert(words.end(), more.begin(), more.end());
    for (std::string& word : words) word = shell_quoted(word);
    return fmt::format("{}", fmt::join(words, " "));
}

}  // namespace intaglio::measure
