// dcl and def: what may be declared, how often, with which mask and usage; values of loop counts.
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "generator/target/d3d9/assembly.h"
#include "generator/target/d3d9/legality_rules.h"

namespace intaglio::d3d9::rules {
namespace {

std::string register_name(const Declaration& declaration) {
    return text_of(Destination{declaration.target.file, declaration.target.index});
}

bool declarable(const Limits& limits, File file) {
    if (!limits.pixel())
        return file == File::Input ||
               (limits.model_3() && (file == File::Output || file == File::Sampler));
    if (file == File::Input || file == File::Sampler) return true;
    return limits.model_3() ? file == File::Position || file == File::Face : file == File::Texture;
}

void mask(const Check& check, const Declaration& declaration) {
    const Destination& target = declaration.target;
    const Limits& limits = check.limits;
    const std::string name = register_name(declaration);
    const bool from_x =
        target.mask == 1 || target.mask == 3 || target.mask == 7 || target.mask == 15;
    if (target.mask == 0 || target.mask > full_mask || (target.file == File::Texture && !from_x))
        check.refuse("dcl-mask", fmt::format("{} is declared as .x, .xy, .xyz or whole", name));
    else if (target.file == File::Sampler && target.mask != full_mask)
        check.refuse("dcl-mask", fmt::format("{} is declared without a mask", name));
    else if (target.file == File::Position && (target.mask & 0xC) != 0)
        check.refuse("dcl-mask", "vPos has only x and y");
    else if (target.file == File::Input && limits.profile == Profile::vs_2_0 &&
             target.mask != full_mask)
        check.refuse("dcl-mask", fmt::format("vs_2_0 declares {} whole", name));
    else if (target.file == File::Output && declaration.usage == Usage::PointSize &&
             declaration.usage_index == 0 && target.mask != full_mask)
        check.refuse("dcl-mask",
                     fmt::format("{} is the point size and declared without a mask", name));
    const bool modified = target.centroid || target.partial_precision || target.saturate;
    const bool interpolated =
        target.file == File::Texture || (target.file == File::Input && limits.model_3());
    if (modified && !(limits.pixel() && interpolated && !target.saturate))
        check.refuse("dcl-modifier", fmt::format("the declaration of {} takes no modifier", name));
}

bool usage_allowed(const Limits& limits, const Declaration& declaration) {
    if (declaration.usage_index < 0 || declaration.usage_index > 15) return false;
    const bool first = declaration.usage_index == 0;
    if (limits.pixel()) {
        if (declaration.usage == Usage::Sample) return false;
        return !(first &&
                 (declaration.usage == Usage::Position || declaration.usage == Usage::PositionT ||
                  declaration.usage == Usage::PointSize));
    }
    if (declaration.usage == Usage::PositionT && first) return false;
    return !(declaration.usage == Usage::Sample && declaration.target.file == File::Output);
}

void integers(const Check& check, const Definition& definition) {
    const auto value = [&](std::size_t i) { return static_cast<std::int32_t>(definition.bits[i]); };
    const std::string name = fmt::format("i{}", definition.index);
    if (value(0) < 0 || value(0) > 255)
        check.refuse("repeat-count",
                     fmt::format("{}.x, a count of repetitions, is {}; it goes from 0 to 255", name,
                                 value(0)));
    const bool loops = check.limits.has(info(Opcode::Loop));
    if (loops && (value(1) < 0 || value(1) > 255))
        check.refuse(
            "loop-values",
            fmt::format("{}.y, where a loop starts, is {}; it goes from 0 to 255", name, value(1)));
    if (loops && (value(2) < -128 || value(2) > 127))
        check.refuse("loop-values",
                     fmt::format("{}.z, the step of a loop, is {}; it goes from -128 to 127", name,
                                 value(2)));
    if (value(3) != 0 || (!loops && (value(1) != 0 || value(2) != 0)))
        check.refuse(
            "loop-values",
            fmt::format("{} has values in components without meaning; they must be 0", name));
}

}  // namespace

void declarations(const Check& check) {
    const Limits& limits = check.limits;
    std::map<std::pair<File, int>, unsigned> declared;
    std::set<std::tuple<File, Usage, int>> usages;
    for (const Declaration& declaration : check.shader.declarations) {
        const Destination& target = declaration.target;
        if (!declarable(limits, target.file)) {
            check.refuse("dcl-register", fmt::format("{} does not declare {}", limits.name,
                                                     register_name(declaration)));
            continue;
        }
        mask(check, declaration);
        unsigned& lanes = declared[{target.file, target.index}];
        const bool shared =
            limits.model_3() && (target.file == File::Input || target.file == File::Output);
        const unsigned overlap = shared ? lanes & target.mask : lanes;
        if (overlap != 0)
            check.refuse("dcl-twice",
                         fmt::format("{} is declared twice", register_name(declaration)));
        lanes |= target.mask;
        if (target.file == File::Sampler && declaration.sampler == SamplerKind::None)
            check.refuse("dcl-usage",
                         fmt::format("{} is declared without saying 2d, cube or volume",
                                     register_name(declaration)));
        const bool has_usage = shared || (target.file == File::Input && !limits.pixel());
        if (!has_usage) continue;
        if (!usage_allowed(limits, declaration))
            check.refuse("dcl-usage", fmt::format("{} has a usage that {} does not take there",
                                                  register_name(declaration), limits.name));
        else if (!usages.insert({target.file, declaration.usage, declaration.usage_index}).second)
            check.refuse("dcl-usage",
                         fmt::format("the usage of {} is declared for another register, too",
                                     register_name(declaration)));
    }
    std::set<std::pair<File, int>> defined;
    for (const Definition& definition : check.shader.definitions) {
        if (!defined.insert({definition.file, definition.index}).second)
            check.refuse("def-twice",
                         fmt::format("{} is defined twice",
                                     text_of(Destination{definition.file, definition.index})));
        if (definition.file == File::ConstInt && limits.integers > 0) integers(check, definition);
        if (definition.file != File::Const && definition.file != File::ConstInt &&
            definition.file != File::ConstBool)
            check.refuse("def-register", "only c#, i# and b# are defined");
    }
}

}  // namespace intaglio::d3d9::rules
