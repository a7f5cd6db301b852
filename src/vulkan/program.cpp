// Preparation in order (reflect, match names, upload, compile, record), then draws that only
// submit.
#include "src/vulkan/program.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "src/check/reflect.h"
#include "src/vulkan/bindings.h"
#include "src/vulkan/objects.h"
#include "src/vulkan/pipeline.h"

namespace intaglio::vulkan {

// Members are destroyed from the last to the first: whatever uses an object stands below it.
struct Program::State {
    std::shared_ptr<DeviceState> device;
    std::array<float, 4> clear_colour{};
    std::uint32_t index_count = 0;
    HostBuffer vertices, indices;
    Targets targets;
    Resources resources;
    Pipeline pipeline;
    OwnedQueryPool timestamps;  // two, or none where the device has none
    Commands draw_and_read, draw_timed;
    bool drawn = false;

    void record_pass(VkCommandBuffer commands) const;
    Failure record_draws();
};

namespace {

Failure check_mesh(const Mesh* mesh) {
    if (!mesh || mesh->vertices.empty() || mesh->indices.empty() || mesh->indices.size() % 3 != 0) {
        return input_error(
            "bad-mesh", fmt::format("a draw needs a mesh of whole triangles, and was given {}",
                                    mesh ? fmt::format("{} vertices and {} indices",
                                                       mesh->vertices.size(), mesh->indices.size())
                                         : std::string("none")));
    }
    const std::uint32_t last = *std::max_element(mesh->indices.begin(), mesh->indices.end());
    if (last >= mesh->vertices.size())
        return input_error("bad-mesh", fmt::format("the mesh has {} vertices and an index {}",
                                                   mesh->vertices.size(), last));
    const auto are_numbers = [](const auto& values) {
        return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
    };
    for (std::size_t i = 0; i < mesh->vertices.size(); ++i) {
        const Vertex& vertex = mesh->vertices[i];
        if (!are_numbers(vertex.position) || !are_numbers(vertex.normal) ||
            !are_numbers(vertex.tangent) || !are_numbers(vertex.uv))
            return input_error("bad-mesh",
                               fmt::format("vertex {} of the mesh holds a value that is "
                                           "not a number",
                                           i));
    }
    return {};
}

template <typename T>
Failure make_filled(HostBuffer& into, const DeviceState& device, const std::vector<T>& values,
                    VkBufferUsageFlags usage) {
    const std::size_t size = values.size() * sizeof(T);
    if (auto failure = make_host_buffer(into, device, size, usage)) return failure;
    std::memcpy(into.mapped, values.data(), size);
    return {};
}

Failure make_timestamps(OwnedQueryPool& into, const DeviceState& device) {
    if (device.timestamp_bits == 0) return {};
    VkQueryPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = 2;
    return make(into, device.device, vkCreateQueryPool, info, "create timestamps");
}

void record_copies(const Targets& targets, VkCommandBuffer commands) {
    for (std::size_t i = 0; i < targets.colours.size(); ++i) {
        VkBufferImageCopy copy{};
        copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        copy.imageExtent = {static_cast<std::uint32_t>(targets.width),
                            static_cast<std::uint32_t>(targets.height), 1};
        vkCmdCopyImageToBuffer(commands, targets.colours[i].image.get(),
                               VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                               targets.readback[i].buffer.get(), 1, &copy);
    }
    VkMemoryBarrier to_host{};
    to_host.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
    to_host.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
    to_host.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1,
                         &to_host, 0, nullptr, 0, nullptr);
}

// Nanoseconds between the two timestamps of the last timed draw.
Result<double> read_timestamps(const DeviceState& device, VkQueryPool pool) {
    std::uint64_t stamps[2] = {};
    if (auto failure = check(vkGetQueryPoolResults(
                                 device.device, pool, 0, 2, sizeof stamps, stamps, sizeof stamps[0],
                                 VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
                             "read the timestamps")) {
        return *failure;
    }
    const std::uint64_t valid = device.timestamp_bits >= 64
                                    ? ~std::uint64_t{0}
                                    : (std::uint64_t{1} << device.timestamp_bits) - 1;
    const std::uint64_t steps =
        (stamps[1] - stamps[0]) & valid;  // right also where the counter wrapped around
    return static_cast<double>(steps) *
           static_cast<double>(device.properties.limits.timestampPeriod);
}

}  // namespace

// The render pass with the whole draw in it.
void Program::State::record_pass(VkCommandBuffer commands) const {
    std::vector<VkClearValue> clears(targets.colours.size() + 1);
    for (VkClearValue& clear : clears)
        std::copy(clear_colour.begin(), clear_colour.end(), clear.color.float32);
    clears.back().depthStencil = {1, 0};
    VkRenderPassBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
    begin.renderPass = targets.pass.get();
    begin.framebuffer = targets.framebuffer.get();
    begin.renderArea.extent = {static_cast<std::uint32_t>(targets.width),
                               static_cast<std::uint32_t>(targets.height)};
    begin.clearValueCount = static_cast<std::uint32_t>(clears.size());
    begin.pClearValues = clears.data();
    vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.pipeline.get());
    if (!resources.sets.empty()) {
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.layout.get(), 0,
                                static_cast<std::uint32_t>(resources.sets.size()),
                                resources.sets.data(), 0, nullptr);
    }
    const VkBuffer vertex_buffer = vertices.buffer.get();
    const VkDeviceSize start = 0;
    vkCmdBindVertexBuffers(commands, 0, 1, &vertex_buffer, &start);
    vkCmdBindIndexBuffer(commands, indices.buffer.get(), 0, VK_INDEX_TYPE_UINT32);
    vkCmdDrawIndexed(commands, index_count, 1, 0, 0, 0);
    vkCmdEndRenderPass(commands);
}

Failure Program::State::record_draws() {
    if (auto failure = record(draw_and_read, *device, [&](VkCommandBuffer commands) {
            record_pass(commands);
            record_copies(targets, commands);
        })) {
        return failure;
    }
    return record(draw_timed, *device, [&](VkCommandBuffer commands) {
        const VkQueryPool pool = timestamps.get();
        if (pool) {
            vkCmdResetQueryPool(commands, pool, 0, 2);
            vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, pool, 0);
        }
        record_pass(commands);
        if (pool) vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, pool, 1);
    });
}

Result<Program> Program::prepare(const Device& device, const Draw& draw) {
    const auto vertex = check::reflect(draw.vertex.spirv);
    if (!vertex) return vertex.error();
    const auto fragment = check::reflect(draw.fragment.spirv);
    if (!fragment) return fragment.error();
    if (auto failure = check_mesh(draw.mesh)) return *failure;
    const auto bindings = bind_names(draw, *vertex, *fragment);
    if (!bindings) return bindings.error();

    auto state = std::make_unique<State>();
    state->device = device.state();
    state->clear_colour = draw.clear;
    state->index_count = static_cast<std::uint32_t>(draw.mesh->indices.size());
    const DeviceState& on = *state->device;
    if (auto failure = make_targets(state->targets, on, draw, bindings->targets.size()))
        return *failure;
    if (auto failure = make_filled(state->vertices, on, draw.mesh->vertices,
                                   VK_BUFFER_USAGE_VERTEX_BUFFER_BIT)) {
        return *failure;
    }
    if (auto failure =
            make_filled(state->indices, on, draw.mesh->indices, VK_BUFFER_USAGE_INDEX_BUFFER_BIT)) {
        return *failure;
    }
    if (auto failure = make_resources(state->resources, on, draw, *bindings)) return *failure;
    if (auto failure =
            make_pipeline(state->pipeline, on, draw, *bindings, state->resources, state->targets)) {
        return *failure;
    }
    if (auto failure = make_timestamps(state->timestamps, on)) return *failure;
    if (auto failure = state->record_draws()) return *failure;
    return Program(std::move(state));
}

Status Program::set_uniform(const std::string& name, const std::vector<float>& values) {
    for (UniformBlock& block : state_->resources.blocks) {
        for (const BlockMember& member : block.members) {
            if (member.layout.name != name) continue;
            Status written = write_member(block.bytes, member, values);
            if (!written) return written;
            std::memcpy(block.buffer.mapped, block.bytes.data(), block.bytes.size());
        }
    }
    return Done{};
}

Result<std::vector<Picture>> Program::draw() {
    if (auto failure = submit_and_wait(*state_->device, state_->draw_and_read.get()))
        return *failure;
    state_->drawn = true;
    std::vector<Picture> pictures;
    for (std::size_t i = 0; i < state_->targets.colours.size(); ++i)
        pictures.push_back(read_picture(state_->targets, i));
    return pictures;
}

Result<double> Program::time_draw() {
    const VkCommandBuffer commands = state_->draw_timed.get();
    if (!state_->drawn) {
        if (auto failure = submit_and_wait(*state_->device, commands)) return *failure;
        state_->drawn = true;
    }
    const auto before = std::chrono::steady_clock::now();
    if (auto failure = submit_and_wait(*state_->device, commands)) return *failure;
    const std::chrono::duration<double, std::nano> elapsed =
        std::chrono::steady_clock::now() - before;
    if (!state_->timestamps.get()) return elapsed.count();
    const Result<double> timed = read_timestamps(*state_->device, state_->timestamps.get());
    // A draw within one step of the counter took less than a step, not nothing.
    const double step = static_cast<double>(state_->device->properties.limits.timestampPeriod);
    return timed ? std::max(*timed, step) : timed;
}

Program::Program(std::unique_ptr<State> state) : state_(std::move(state)) {}
Program::Program(Program&&) noexcept = default;
Program& Program::operator=(Program&&) noexcept = default;
Program::~Program() = default;

}  // namespace intaglio::vulkan
