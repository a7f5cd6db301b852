// A pipeline with nothing behind its names: compiled, asked for its statistics, and thrown away.
#include "src/vulkan/compiled.h"

#include <algorithm>
#include <cstring>
#include <map>

#include <fmt/format.h>

#include "src/check/reflect.h"
#include "src/vulkan/bindings.h"
#include "src/vulkan/pipeline.h"

namespace intaglio::vulkan {
namespace {

// A draw of whatever the stages ask for: names only, no values and no texels.
struct Placeholders {
    std::map<int, Texture> textures;  // by dimension
    Mesh mesh = quad();
    Draw draw;

    Placeholders(const check::Program& shaders, const check::Reflection& vertex,
                 const check::Reflection& pixel) {
        draw.vertex.spirv = shaders.vertex;
        draw.fragment.spirv = shaders.pixel;
        draw.mesh = &mesh;
        draw.width = draw.height = 1;
        draw.target_format = Texture::Format::Rgba8Unorm;
        textures[3].depth = 1;
        for (const check::Reflection* stage : {&vertex, &pixel}) {
            for (const auto& block : stage->blocks)
                for (const auto& member : block.members) draw.uniforms[member.name];
            for (const auto& image : stage->images)
                if (image.kind != check::Reflection::ImageKind::Sampler)
                    draw.textures[image.name] = &textures[image.dimension];
        }
    }
    Placeholders(const Placeholders&) = delete;  // the draw points into it
    Placeholders& operator=(const Placeholders&) = delete;
};

double number_of(const VkPipelineExecutableStatisticKHR& statistic) {
    switch (statistic.format) {
        case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_BOOL32_KHR:
            return statistic.value.b32 == VK_TRUE ? 1 : 0;
        case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_INT64_KHR:
            return static_cast<double>(statistic.value.i64);
        case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR:
            return static_cast<double>(statistic.value.u64);
        default: return statistic.value.f64;
    }
}

// vkGet...(device, info, &count, values) in its two calls; `empty` has the structure's type.
template <typename Function, typename Info, typename Value>
Failure get_all(std::vector<Value>& into, Function function, VkDevice device, const Info& info,
                const Value& empty, const char* what) {
    std::uint32_t count = 0;
    if (auto failure = check(function(device, &info, &count, nullptr), what)) return failure;
    into.assign(count, empty);
    return check(function(device, &info, &count, into.data()), what);
}

Failure read_statistics(std::vector<CompiledStage>& into, const DeviceState& device,
                        VkPipeline pipeline) {
    const auto get_executables = reinterpret_cast<PFN_vkGetPipelineExecutablePropertiesKHR>(
        vkGetDeviceProcAddr(device.device, "vkGetPipelineExecutablePropertiesKHR"));
    const auto get_statistics = reinterpret_cast<PFN_vkGetPipelineExecutableStatisticsKHR>(
        vkGetDeviceProcAddr(device.device, "vkGetPipelineExecutableStatisticsKHR"));
    VkPipelineInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR;
    info.pipeline = pipeline;
    VkPipelineExecutablePropertiesKHR no_executable{};
    no_executable.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR;
    std::vector<VkPipelineExecutablePropertiesKHR> executables;
    if (auto failure = get_all(executables, get_executables, device.device, info, no_executable,
                               "list what the driver compiled"))
        return failure;
    for (std::uint32_t i = 0; i < executables.size(); ++i) {
        VkPipelineExecutableInfoKHR executable{};
        executable.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR;
        executable.pipeline = pipeline;
        executable.executableIndex = i;
        VkPipelineExecutableStatisticKHR no_statistic{};
        no_statistic.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR;
        std::vector<VkPipelineExecutableStatisticKHR> statistics;
        if (auto failure = get_all(statistics, get_statistics, device.device, executable,
                                   no_statistic, "read the driver's statistics"))
            return failure;
        CompiledStage stage;
        stage.pixel = (executables[i].stages & VK_SHADER_STAGE_FRAGMENT_BIT) != 0;
        for (const auto& statistic : statistics)
            stage.statistics.push_back({statistic.name, number_of(statistic)});
        into.push_back(std::move(stage));
    }
    return {};
}

}  // namespace

const Statistic* CompiledStage::find(std::string_view name) const {
    const auto found = std::find_if(statistics.begin(), statistics.end(),
                                    [&](const Statistic& row) { return row.name == name; });
    return found == statistics.end() ? nullptr : &*found;
}

Result<std::vector<CompiledStage>> compile(const Device& device, const check::Program& shaders) {
    const DeviceState& on = *device.state();
    if (!on.tells_statistics)
        return input_error("no-statistics",
                           fmt::format("{} does not tell what its compiler made", device.name()));
    const auto vertex = check::reflect(shaders.vertex);
    if (!vertex) return vertex.error();
    const auto pixel = check::reflect(shaders.pixel);
    if (!pixel) return pixel.error();
    const Placeholders placeholders(shaders, *vertex, *pixel);
    const auto bindings = bind_names(placeholders.draw, *vertex, *pixel);
    if (!bindings) return bindings.error();
    Targets targets;
    if (auto failure = make_pass(targets, on, placeholders.draw, bindings->targets.size()))
        return *failure;
    Resources layouts;
    if (auto failure = make_set_layouts(layouts, on, *bindings)) return *failure;
    Pipeline pipeline;
    if (auto failure = make_pipeline(pipeline, on, placeholders.draw, *bindings, layouts, targets))
        return *failure;
    std::vector<CompiledStage> stages;
    if (auto failure = read_statistics(stages, on, pipeline.pipeline.get())) return *failure;
    std::stable_sort(stages.begin(), stages.end(),
                     [](const auto& a, const auto& b) { return !a.pixel && b.pixel; });
    return stages;
}

}  // namespace intaglio::vulkan
