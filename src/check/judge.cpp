// The chain of witnesses, each step recorded once it has passed.
#include "src/check/judge.h"

#include <fmt/format.h>

#include "src/check/frontend.h"
#include "src/check/spirv.h"

namespace intaglio::check {
namespace {

struct RoundTrip {
    CrossTarget target;
    Language language;
    bool to_binary;  // else the front end alone
};
constexpr RoundTrip round_trips[] = {
    {CrossTarget::Glsl450, Language::Glsl450, true},
    {CrossTarget::Hlsl50, Language::Hlsl5, true},
    {CrossTarget::Glsl330, Language::Glsl330, false},
    {CrossTarget::Essl300, Language::Essl300, false},
};

Status accept_again(const RoundTrip& trip, const Source& source, const std::string& text) {
    const Source again{
        .language = trip.language,
        .stage = source.stage,
        .text = text,
        .name = fmt::format("{} (SPIRV-Cross to {})", source.name, name_of(trip.target))};
    Status accepted = Done{};
    if (trip.to_binary) {
        if (const Result<SpirvWords> words = to_spirv(again); !words) accepted = words.error();
    } else {
        accepted = parse(again);
    }
    if (accepted) return accepted;
    Diagnostic error = accepted.error();
    error.notes.push_back(fmt::format("the same complaint by its own code: {}", error.code));
    error.code = "round-trip-refused";
    return error;
}

}  // namespace

Result<Witnessed> judge(const Source& source) {
    Witnessed result;
    if (Status parsed = parse(source); !parsed) return parsed.error();
    result.steps.push_back(fmt::format("glslang {}", name_of(source.language)));
    if (!has_spirv(source.language)) return result;

    Result<SpirvWords> words = to_spirv(source);
    if (!words) return words.error();
    result.words = std::move(*words);
    result.steps.insert(result.steps.end(), {"glslang to SPIR-V", "spirv-val"});

    Result<SpirvWords> optimized = optimize_spirv(result.words);
    if (!optimized) return optimized.error();
    result.optimized = std::move(*optimized);
    result.steps.insert(result.steps.end(), {"spirv-opt -O", "spirv-val"});

    for (const RoundTrip& trip : round_trips) {
        Result<std::string> text = cross_to(result.optimized, trip.target);
        if (!text) return text.error();
        result.steps.push_back(fmt::format("SPIRV-Cross to {}", name_of(trip.target)));
        if (Status accepted = accept_again(trip, source, *text); !accepted) return accepted.error();
        result.steps.push_back(fmt::format("glslang {}", name_of(trip.language)));
        if (trip.to_binary) result.steps.push_back("spirv-val");
        result.crossed.push_back({trip.target, std::move(*text)});
    }
    return result;
}

}  // namespace intaglio::check
