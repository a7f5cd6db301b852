// Values into the bytes of a block: offsets, strides, integers, and what is refused.
#include "src/vulkan/uniforms.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>

#include "tests/unit/vulkan/harness.h"

namespace intaglio::vulkan {
namespace {

BlockMember member(int offset, int components, int array_count, int array_stride,
                   Scalar scalar = Scalar::Float) {
    BlockMember m;
    m.layout.name = std::string("m");  // g++ 12 warns wrongly of a plain "m" (-Wrestrict)
    m.layout.offset = offset;
    m.layout.components = components;
    m.layout.array_count = array_count;
    m.layout.array_stride = array_stride;
    m.layout.size = array_count > 1 ? array_count * array_stride : 4 * components;
    m.scalar = scalar;
    return m;
}

template <typename T>
T at(const std::vector<std::byte>& block, std::size_t offset) {
    T value;
    std::memcpy(&value, &block.at(offset), sizeof value);
    return value;
}

TEST(Uniforms, VectorGoesToItsOffsetAndNowhereElse) {
    std::vector<std::byte> block(32, std::byte{0xab});
    ASSERT_TRUE(write_member(block, member(12, 3, 1, 0), {1.5f, -2, 3}).ok());
    EXPECT_EQ(at<float>(block, 12), 1.5f);
    EXPECT_EQ(at<float>(block, 16), -2.0f);
    EXPECT_EQ(at<float>(block, 20), 3.0f);
    EXPECT_EQ(at<std::uint32_t>(block, 8), 0xabababab);
    EXPECT_EQ(at<std::uint32_t>(block, 24), 0xabababab);
}

TEST(Uniforms, ArrayElementsStandAtTheStride) {
    std::vector<std::byte> block(64);
    ASSERT_TRUE(write_member(block, member(16, 2, 3, 16), {1, 2, 3, 4, 5, 6}).ok());
    EXPECT_EQ(at<float>(block, 16), 1.0f);
    EXPECT_EQ(at<float>(block, 20), 2.0f);
    EXPECT_EQ(at<float>(block, 32), 3.0f);
    EXPECT_EQ(at<float>(block, 52), 6.0f);
    EXPECT_EQ(at<float>(block, 24), 0.0f);
}

TEST(Uniforms, IntegersAreConvertedOrRefused) {
    std::vector<std::byte> block(16);
    ASSERT_TRUE(write_member(block, member(0, 2, 1, 0, Scalar::Int), {-3, 70000}).ok());
    EXPECT_EQ(at<std::int32_t>(block, 0), -3);
    EXPECT_EQ(at<std::int32_t>(block, 4), 70000);
    ASSERT_TRUE(write_member(block, member(8, 1, 1, 0, Scalar::Uint), {4294967040.0f}).ok());
    EXPECT_EQ(at<std::uint32_t>(block, 8), 4294967040u);

    const auto fraction = write_member(block, member(0, 1, 1, 0, Scalar::Int), {1.5f});
    ASSERT_FALSE(fraction.ok());
    EXPECT_EQ(to_string(fraction.error()),
              "error: the uniform 'm' is an integer and cannot be 1.5 [bad-uniform]");
    EXPECT_FALSE(write_member(block, member(0, 1, 1, 0, Scalar::Uint), {-1}).ok());
    EXPECT_FALSE(write_member(block, member(0, 1, 1, 0, Scalar::Int), {2147483648.0f}).ok());
    EXPECT_FALSE(write_member(block, member(0, 1, 1, 0, Scalar::Int), {std::nanf("")}).ok());
    EXPECT_EQ(at<std::int32_t>(block, 0), -3) << "a refused value leaves the block alone";
}

TEST(Uniforms, WrongNumberOfValuesAndMatricesAreRefused) {
    std::vector<std::byte> block(64);
    EXPECT_EQ(to_string(write_member(block, member(0, 3, 1, 0), {1, 2}).error()),
              "error: the uniform 'm' takes 3 values and was given 2 [bad-uniform]");
    BlockMember matrix = member(0, 4, 1, 0);
    matrix.layout.columns = 4;
    matrix.layout.size = 64;
    EXPECT_EQ(write_member(block, matrix, std::vector<float>(16)).error().code,
              "unsupported-resource");
    BlockMember structure = member(0, 1, 1, 0);
    structure.layout.size = 32;
    EXPECT_EQ(write_member(block, structure, {1}).error().code, "unsupported-resource");
}

TEST(Uniforms, ScalarTypesAreReadFromTheModule) {
    const Stage stage = glsl_fragment(R"(
        layout(set = 1, binding = 2) uniform Numbers {
            float f; int i; uint u; vec3 v; ivec2 w; float a[3]; uint b[2]; int last;
        };
        layout(location = 0) out vec4 color;
        void main() {
           color = vec4(f + float(i) + float(u), v.x + float(w.x), a[2] + float(b[1]), float(last));
        })");
    const auto reflection = check::reflect(stage.spirv);
    ASSERT_TRUE(reflection.ok());
    ASSERT_EQ(reflection->blocks.size(), 1u);
    std::vector<Scalar> scalars;
    for (const BlockMember& m : typed_members(stage.spirv, reflection->blocks[0]))
        scalars.push_back(m.scalar);
    EXPECT_THAT(scalars,
                testing::ElementsAre(Scalar::Float, Scalar::Int, Scalar::Uint, Scalar::Float,
                                     Scalar::Int, Scalar::Float, Scalar::Uint, Scalar::Int));
}

}  // namespace
}  // namespace intaglio::vulkan
