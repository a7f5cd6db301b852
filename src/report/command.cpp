// Words for variants.
#include "src/report/command.h"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <string_view>

namespace intaglio::report {

std::string_view word_of(ir::LoopForm form) {
    switch (form) {
        case ir::LoopForm::Rolled: return "loop";
        case ir::LoopForm::Unrolled: return "unroll";
        case ir::LoopForm::Unspecified: break;
    }
    return "schedule";
}

std::string settings_of(const VariantRequest& request) {
    std::vector<std::string> words;
    for (const auto& [knob, value] : request.knobs) words.push_back(knob + "=" + value);
    for (const auto& [loop, form] : request.loop_forms)
        words.push_back(fmt::format("{}:{}", loop, word_of(form)));
    if (request.per_vertex) words.emplace_back("per_vertex");
    return fmt::format("{}", fmt::join(words, " "));
}

std::string shell_quoted(const std::string& argument) {
    const auto plain = [](unsigned char c) {
        return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
               std::string_view("_-+=.,:/@%").find(static_cast<char>(c)) != std::string_view::npos;
    };
    if (!argument.empty() && std::all_of(argument.begin(), argument.end(), plain)) return argument;
    std::string quoted = "'";
    for (char c : argument) {
        if (c == '\'')
            quoted += "'\\''";
        else
            quoted += c;
    }
    return quoted + "'";
}

std::string run_command(const measure::Plan& plan, const measure::CaseResult& result,
                        const MapArguments& map_arguments) {
    const VariantRequest& request = plan.rows[static_cast<std::size_t>(result.row)];
    const std::size_t map = static_cast<std::size_t>(result.map);
    if (map >= map_arguments.size() || map_arguments[map].empty()) return "";
    std::vector<std::string> words{"intaglio", "run", request.surface, "-T", request.target};
    const auto add = [&](std::initializer_list<std::string> more) {
        words.insert(words.end(), more);
    };
    for (const auto& [knob, value] : request.knobs) add({"-D", knob + "=" + value});
    for (const auto& [loop, form] : request.loop_forms)
        if (form != ir::LoopForm::Unspecified)
            add({"--loop", fmt::format("{}={}", loop, word_of(form))});
    if (request.per_vertex) add({"--per-vertex"});
    words.insert(words.end(), map_arguments[map].begin(), map_arguments[map].end());
    // Angles are joined to their option, because they may be negative.
    add({"--scale", fmt::format("{}", plan.scale), "--mesh", "map",
         fmt::format("--elevation={}", result.view.elevation),
         fmt::format("--azimuth={}", result.view.azimuth),
         fmt::format("--light-elevation={}", result.light.elevation),
         fmt::format("--light-azimuth={}", result.light.azimuth), "--size",
         fmt::format("{0}x{0}", plan.size)});
    if (plan.filtering == measure::Filtering::Native) add({"--filtering", "native"});
    if (!plan.device.empty()) add({"--device", plan.device});
    add({"-o", "picture.png", "--error-map", "errors.png"});
    for (std::string& word : words) word = shell_quoted(word);
    return fmt::format("{}", fmt::join(words, " "));
}

}  // namespace intaglio::report
