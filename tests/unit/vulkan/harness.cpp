#include "tests/unit/vulkan/harness.h"

#include <cstring>

#include "src/check/frontend.h"

namespace intaglio::vulkan {

const Device& OnDevice::device() {
    static const Result<Device> created = Device::create({.device = "", .validation = true});
    if (!created) throw std::runtime_error(to_string(created.error()));
    return *created;
}

void OnDevice::SetUp() { messages_before_ = device().validation_messages().size(); }

void OnDevice::TearDown() {
    const std::vector<std::string> messages = device().validation_messages();
    EXPECT_EQ(messages.size(), messages_before_) << messages.back();
}

Stage compile(check::Language language, check::Stage stage, const std::string& text) {
    check::Source source;
    source.language = language;
    source.stage = stage;
    source.text = text;
    Result<check::SpirvWords> words = check::to_spirv(source);
    if (!words) {
        ADD_FAILURE() << to_string(words.error()) << "\n" << text;
        return {};
    }
    return {.spirv = std::move(*words)};
}

Stage glsl_vertex(const std::string& text) {
    return compile(check::Language::Glsl450, check::Stage::Vertex, "#version 450\n" + text);
}

Stage glsl_fragment(const std::string& text) {
    return compile(check::Language::Glsl450, check::Stage::Pixel, "#version 450\n" + text);
}

Stage quad_vertex() {
    static const Stage stage = glsl_vertex(R"(
        layout(location = 0) in vec3 position;
        layout(location = 1) in vec2 uv;
        layout(location = 0) out vec2 out_uv;
        void main() { gl_Position = vec4(position.xy * 2.0 - 1.0, 0.0, 1.0); out_uv = uv; })");
    return stage;
}

const Mesh& unit_quad() {
    static const Mesh mesh = quad();
    return mesh;
}

Draw quad_draw(const Stage& fragment, int size) {
    Draw draw;
    draw.vertex = quad_vertex();
    draw.fragment = fragment;
    draw.mesh = &unit_quad();
    draw.width = draw.height = size;
    return draw;
}

std::vector<Picture> drawn(const Device& device, const Draw& draw) {
    Result<Program> program = Program::prepare(device, draw);
    if (!program) {
        ADD_FAILURE() << to_string(program.error());
        return {};
    }
    Result<std::vector<Picture>> pictures = program->draw();
    if (!pictures) {
        ADD_FAILURE() << to_string(pictures.error());
        return {};
    }
    return std::move(*pictures);
}

std::string refusal(const Device& device, const Draw& draw) {
    const Result<Program> program = Program::prepare(device, draw);
    return program ? "prepared without an error" : to_string(program.error());
}

bool same_bits(const Picture& a, const Picture& b) {
    return a.width == b.width && a.height == b.height && !a.pixels.empty() &&
           std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(a.pixels[0])) ==
               0;
}

}  // namespace intaglio::vulkan
