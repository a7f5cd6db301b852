// Volumes and the filter that a sampler's declaration asks for, on the device.
#include <cmath>
#include <random>

#include "tests/unit/vulkan/harness.h"

namespace intaglio::vulkan {
namespace {

class VolumeTest : public OnDevice {};

Texture random_volume(int width, int height, int depth, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> value(0, 1);
    Texture texture;
    texture.width = width;
    texture.height = height;
    texture.depth = depth;
    texture.format = Texture::Format::Rgba32Float;
    texture.levels.emplace_back();
    for (int i = 0; i < 4 * width * height * depth; ++i) texture.levels[0].push_back(value(random));
    return texture;
}

int wrapped(int index, int size) { return ((index % size) + size) % size; }

double red(const Texture& texture, int x, int y, int z) {
    const int row = wrapped(z, texture.depth) * texture.height + wrapped(y, texture.height);
    return texture.levels[0][4 * static_cast<std::size_t>(row * texture.width +
                                                          wrapped(x, texture.width))];
}

double trilinear(const Texture& texture, double u, double v, double w) {
    const double at[] = {u * texture.width - 0.5, v * texture.height - 0.5, w * texture.depth - 0.5};
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        int index[3];
        double weight = 1;
        for (int axis = 0; axis < 3; ++axis) {
            const double below = std::floor(at[axis]), fraction = at[axis] - below;
            const bool upper = (corner >> axis & 1) != 0;
            index[axis] = static_cast<int>(below) + (upper ? 1 : 0);
            weight *= upper ? fraction : 1 - fraction;
        }
        sum += weight * red(texture, index[0], index[1], index[2]);
    }
    return sum;
}

Stage slice_read() {
    return glsl_fragment(R"(
        layout(location = 0) in vec2 uv;
        layout(binding = 1) uniform sampler3D distance_map;
        layout(binding = 2) uniform Reading { float slice; };
        layout(location = 0) out vec4 color;
        void main() { color = textureLod(distance_map, vec3(uv, slice), 0); })");
}

TEST_F(VolumeTest, AreReadTrilinearlyAndRepeat) {
    const Texture texture = random_volume(5, 4, 3, 17);
    Draw draw = quad_draw(slice_read(), 32);
    draw.textures["distance_map"] = &texture;
    draw.uniforms = {{"slice", {0}}};
    auto program = Program::prepare(device(), draw);
    ASSERT_TRUE(program.ok()) << to_string(program.error());
    for (const float slice : {0.0f, 0.1f, 0.5f, 0.77f, 1.25f, -0.4f}) {
        ASSERT_TRUE(program->set_uniform("slice", {slice}).ok());
        const auto pictures = program->draw();
        ASSERT_TRUE(pictures.ok());
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 32; ++x)
                // Coordinates are floats: an ulp of 1 moves the weight by size * 2^-23.
                ASSERT_NEAR((*pictures)[0].at(x, y)[0],
                            trilinear(texture, (x + 0.5) / 32, (y + 0.5) / 32, slice), 2e-6)
                    << x << ", " << y << ", " << slice << " seed 17";
    }
}

TEST_F(VolumeTest, AreReadNearestWhereTheDrawSaysSo) {
    const Texture texture = random_volume(4, 8, 4, 18);
    Draw draw = quad_draw(slice_read(), 32);
    draw.textures["distance_map"] = &texture;
    draw.nearest = {"distance_map"};
    draw.uniforms = {{"slice", {0.6f}}};
    const Picture picture = drawn(device(), draw).at(0);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x)
            ASSERT_EQ(picture.at(x, y)[0], red(texture, x / 8, y / 4, 2)) << x << ", " << y;
}

TEST_F(VolumeTest, NearestHoldsBetweenLevelsToo) {
    Texture texture;
    texture.width = texture.height = 2;
    texture.format = Texture::Format::Rgba32Float;
    texture.levels = {std::vector<float>(16, 1.0f), std::vector<float>(4, 3.0f)};
    Draw draw = quad_draw(glsl_fragment(R"(
        layout(location = 0) in vec2 uv;
        layout(binding = 1) uniform sampler2D max_mip_map;
        layout(location = 0) out vec4 color;
        void main() { color = textureLod(max_mip_map, uv, 0.4); })"),
                          4);
    draw.textures["max_mip_map"] = &texture;
    EXPECT_NEAR(drawn(device(), draw).at(0).at(1, 1)[0], 1.8, 1e-5);
    draw.nearest = {"max_mip_map"};
    EXPECT_EQ(drawn(device(), draw).at(0).at(1, 1)[0], 1);
}

TEST_F(VolumeTest, WrongDimensionsAreSentences) {
    Texture flat = random_volume(4, 4, 1, 19);
    flat.depth = 0;
    Draw draw = quad_draw(slice_read(), 4);
    draw.textures["distance_map"] = &flat;
    draw.uniforms = {{"slice", {0}}};
    EXPECT_EQ(refusal(device(), draw),
              "error: the fragment shader reads 'distance_map' as a volume, and the texture given "
              "is 2D [bad-texture]");
    Texture broken = random_volume(4, 4, 2, 20);
    broken.levels[0].resize(16);
    draw.textures["distance_map"] = &broken;
    EXPECT_EQ(refusal(device(), draw),
              "error: level 0 of texture 'distance_map' is 4 by 4 texels by 2 slices and needs 128 "
              "floats, not 16 [bad-texture]");
    const Texture long_one = random_volume(1, 1, 20000, 21);
    draw.textures["distance_map"] = &long_one;
    EXPECT_THAT(refusal(device(), draw), testing::HasSubstr("[too-large]"));
}

}  // namespace
}  // namespace intaglio::vulkan
