// What the runner's tests share: one device with validation, tiny shaders as SPIR-V, and draws of
// the unit quad. Every test of the fixture fails when the validation layer has said anything by its
// end.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "src/check/source.h"
#include "src/vulkan/program.h"

namespace intaglio::vulkan {

class OnDevice : public testing::Test {
  protected:
    void SetUp() override;
    void TearDown() override;
    static const Device& device();
    std::size_t messages_before_ = 0;
};

// SPIR-V of one stage; a test failure and no words when the text does not compile.
Stage compile(check::Language language, check::Stage stage, const std::string& text);
// GLSL without its #version line.
Stage glsl_vertex(const std::string& text);
Stage glsl_fragment(const std::string& text);

// Passes position (scaled from the unit quad to the whole target) and, at location 0, `vec2 uv`.
Stage quad_vertex();
const Mesh& unit_quad();
// The quad on a size by size target with this fragment stage.
Draw quad_draw(const Stage& fragment, int size);

// Prepares and draws; a test failure and no pictures on an error.
std::vector<Picture> drawn(const Device& device, const Draw& draw);
// The sentence with its code, from a preparation that must fail.
std::string refusal(const Device& device, const Draw& draw);

// The same bits in every pixel.
bool same_bits(const Picture& a, const Picture& b);

}  // namespace intaglio::vulkan
