// Bundles: files that the targets promise, interfaces that agree with other tools, bytes and back.
#include "src/build/bundle.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <set>

#include "src/check/reflect.h"
#include "tests/unit/build/folder.h"

namespace intaglio::build {
namespace {

using ::testing::Contains;
using ::testing::IsEmpty;
using ::testing::Not;

plan::Order order_of(const std::string& surface, const std::string& target) {
    plan::Order order;
    order.surface = "quay";
    order.request.surface = surface;
    order.request.target = target;
    return order;
}

class EachTarget : public ::testing::TestWithParam<const Target*> {};

TEST_P(EachTarget, FilesAreThoseThatTheTargetPromisesAndWhatEmitGives) {
    const Target& target = *GetParam();
    const plan::Order order = order_of("parallax", std::string(target.name));
    const Result<Bundle> bundle = make_bundle(techniques(), order);
    ASSERT_TRUE(bundle.ok()) << to_string(bundle.error());
    std::vector<std::string> names;
    for (const BundleFile& file : bundle->files) names.push_back(file.name);
    EXPECT_EQ(names, variant_files("quay", target));
    EXPECT_THAT(bundle->witnesses, Not(IsEmpty()));

    const Result<Variant> variant = make_variant(techniques(), order.request);
    ASSERT_TRUE(variant.ok());
    for (const BundleFile& file : bundle->files) {
        EXPECT_FALSE(file.bytes.empty()) << file.name;
        if (file.kind == FileKind::Spirv && target.name != "spirv") continue;
        const Form form = file.kind == FileKind::Bytecode ? Form::Bytecode : Form::Shader;
        const Result<Product> product = product_of(*variant, file.stage, form);
        ASSERT_TRUE(product.ok()) << to_string(product.error());
        EXPECT_EQ(file.bytes, product->bytes) << file.name;
        EXPECT_EQ(file.name, "quay." + std::string(target.name) + product->extension);
    }

    const Result<Bundle> back = bundle_of(to_bytes(*bundle));
    ASSERT_TRUE(back.ok()) << to_string(back.error());
    EXPECT_EQ(back->files, bundle->files);
    EXPECT_EQ(back->interface, bundle->interface);
    EXPECT_EQ(to_bytes(*back), to_bytes(*bundle));
}

// Whatever reads it, a surface wants the same things from its application.
TEST_P(EachTarget, WantsTheSameUniformsAndSamplersAsVulkan) {
    const Target& target = *GetParam();
    if (!target.pixel_stage) return;
    const Result<Bundle> here =
        make_bundle(techniques(), order_of("parallax", std::string(target.name)));
    const Result<Bundle> vulkan = make_bundle(techniques(), order_of("parallax", "glsl_450"));
    ASSERT_TRUE(here.ok() && vulkan.ok());
    const auto wants = [](const StageInterface& stage) {
        std::set<std::string> names;
        for (const Uniform& each : stage.block.uniforms)
            names.insert(each.name + " " + std::to_string(each.components) + " " +
                         std::to_string(each.elements));
        for (const Sampler& each : stage.samplers) names.insert("sampler " + each.name);
        return names;
    };
    EXPECT_EQ(wants(here->interface.vertex), wants(vulkan->interface.vertex));
    EXPECT_EQ(wants(here->interface.pixel), wants(vulkan->interface.pixel));
    for (const StageInterface* stage : {&here->interface.vertex, &here->interface.pixel}) {
        int end = 0;
        for (const Uniform& each : stage->block.uniforms) {
            EXPECT_GE(each.offset, end) << each.name << " overlaps";
            end = each.offset + each.size();
            EXPECT_FALSE(each.comment.empty()) << each.name;
        }
        EXPECT_LE(end, stage->block.size);
        for (const Sampler& each : stage->samplers)
            if (language_of(target) != check::Language::Glsl330 &&
                stage->block.kind != UniformBlock::Kind::Names) {
                EXPECT_GE(each.slot, 0) << each.name;
            }
    }
}

std::vector<const Target*> judged_targets() {
    std::vector<const Target*> targets;
    for (const Target* target : all_targets())
        if (is_judged(*target)) targets.push_back(target);
    return targets;
}

INSTANTIATE_TEST_SUITE_P(Bundle, EachTarget, ::testing::ValuesIn(judged_targets()),
                         [](const auto& target) { return std::string(target.param->name); });

TEST(Bundle, SpirvBesideATextIsWhatTheFrontEndMakesOfIt) {
    const Result<Bundle> bundle = make_bundle(techniques(), order_of("parallax", "glsl_450"));
    ASSERT_TRUE(bundle.ok());
    const std::string& bytes = bundle->files.back().bytes;
    check::SpirvWords words(bytes.size() / 4);
    std::memcpy(words.data(), bytes.data(), bytes.size());
    const Result<check::Reflection> reflection = check::reflect(words);
    ASSERT_TRUE(reflection.ok()) << to_string(reflection.error());
    EXPECT_EQ(reflection->blocks.front().binding, bundle->interface.pixel.block.binding);
}

TEST(Bundle, ASplitIsRefusedWithASentence) {
    plan::Order order = order_of("parallax_occlusion", "ps_2_0");
    order.request.split.shading = true;
    const Result<Bundle> bundle = make_bundle(techniques(), order);
    ASSERT_FALSE(bundle.ok());
    EXPECT_EQ(bundle.error().code, "order-split");
}

TEST(Bundle, TheKeyFollowsWhatShapesTheProductAndNothingElse) {
    const auto key = [](const plan::Order& order, bool judge = false) {
        const Result<std::string> made = bundle_key(techniques(), order, {judge});
        EXPECT_TRUE(made.ok());
        return made.ok() ? *made : std::string();
    };
    const plan::Order order = order_of("steep_parallax", "glsl_450");
    std::set<std::string> keys = {key(order), key(order, true)};
    plan::Order other = order;
    other.request.target = "glsl_330";
    keys.insert(key(other));
    other = order;
    other.request.loop_forms["march"] = ir::LoopForm::Unrolled;
    keys.insert(key(other));
    other = order;
    other.request.known.uniforms["scale"] = {0.05f};
    keys.insert(key(other));
    other = order;
    other.surface = "wall";  // files are named after it
    keys.insert(key(other));
    EXPECT_EQ(keys.size(), 6u);
    other = order;
    other.costs = {{"longest_path", 12, "SPIRV-Tools"}};
    EXPECT_EQ(key(other), key(order)) << "figures shape no product";
}

TEST(Bundle, BrokenBytesAreAnErrorAndNoCrash) {
    const Result<Bundle> bundle = make_bundle(techniques(), order_of("parallax", "glsl_330"));
    ASSERT_TRUE(bundle.ok());
    const std::string bytes = to_bytes(*bundle);
    for (std::size_t length = 0; length < bytes.size(); length += 97) {
        const Result<Bundle> cut = bundle_of(bytes.substr(0, length));
        ASSERT_FALSE(cut.ok());
        EXPECT_EQ(cut.error().code, "bundle-broken");
    }
}

}  // namespace
}  // namespace intaglio::build
