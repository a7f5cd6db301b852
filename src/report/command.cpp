// Words for variants.
#include "src/report/command.h"

#include <fmt/format.h>

#include "src/measure/command.h"

namespace intaglio::report {

std::string settings_of(const VariantRequest& request) {
    std::vector<std::string> words;
    for (const auto& [knob, value] : request.knobs) words.push_back(knob + "=" + value);
    for (const auto& [loop, form] : request.loop_forms)
        words.push_back(fmt::format("{}:{}", loop, word_of(form)));
    if (request.per_vertex) words.emplace_back("per_vertex");
    return fmt::format("{}", fmt::join(words, " "));
}

std::string run_command(const measure::Plan& plan, const measure::CaseResult& result,
                        const MapArguments& map_arguments) {
    const std::size_t map = static_cast<std::size_t>(result.map);
    if (map >= map_arguments.size() || map_arguments[map].empty()) return "";
    measure::Case what;
    what.request = plan.rows[static_cast<std::size_t>(result.row)];
    what.view = result.view;
    what.light = result.light;
    what.scale = plan.scale;
    what.size = plan.size;
    what.filtering = plan.filtering;
    return measure::run_command(what, map_arguments[map], plan.device,
                                {"-o", "picture.png", "--error-map", "errors.png"});
}

}  // namespace intaglio::report
