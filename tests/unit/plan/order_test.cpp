// Orders survive being written and read, bit by bit; what is no order is refused with its place.
#include "src/plan/order.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <limits>
#include <random>

namespace intaglio::plan {
namespace {

Order some_order() {
    Order order;
    order.surface = "quay";
    order.request.surface = "search=relief,shadow=march";
    order.request.target = "ps_2_b";
    order.request.knobs = {{"max_steps", "12"}, {"lights", "2"}};
    order.request.loop_forms = {{"march", ir::LoopForm::Unrolled},
                                {"refine", ir::LoopForm::Rolled},
                                {"other", ir::LoopForm::Unspecified}};
    order.request.per_vertex = true;
    order.request.count_reads = true;
    order.request.split = {3, true, false};
    order.request.pass = 2;
    order.request.known.uniforms = {{"scale", {0.08f}}, {"ambient", {0.1f, 0.2f, 1.0f / 3}}};
    order.request.known.ranges = {
        {"view.z", {0.25f, 1}},
        {"open", {-std::numeric_limits<float>::infinity(), 3}},
    };
    order.costs = {{"arithmetic", 43, "Direct3D 9's charge"}};
    order.errors = {{"p95", 0.1 + 0.2, "the device"}};
    order.maps = {{"cone_map", "relaxed-cone", "quäy \"1\".relaxed-cone.png"}};
    order.lights = {"sun", "lamp"};
    return order;
}

TEST(Order, IsReadAsItWasWritten) {
    const Order order = some_order();
    const Result<Order> read = read_order(to_text(order), "quay.order");
    ASSERT_TRUE(read.ok()) << to_string(read.error());
    EXPECT_EQ(to_text(*read), to_text(order));
    EXPECT_EQ(read->request.knobs, order.request.knobs);
    EXPECT_EQ(read->request.loop_forms, order.request.loop_forms);
    EXPECT_EQ(read->request.split, order.request.split);
    EXPECT_EQ(read->request.pass, 2);
    EXPECT_TRUE(read->request.per_vertex);
    EXPECT_TRUE(read->request.count_reads);
    EXPECT_EQ(read->request.known, order.request.known);
    EXPECT_EQ(read->maps.front().file, order.maps.front().file);
    EXPECT_EQ(read->errors.front().value, 0.1 + 0.2);
    EXPECT_EQ(read->lights, order.lights);
    EXPECT_EQ(read->name(), "quay.ps_2_b");
}

TEST(Order, KeepsEveryFloat) {
    const std::uint32_t seed = 61;
    std::mt19937 random(seed);
    Order order = some_order();
    std::vector<float>& values = order.request.known.uniforms["scale"];
    values = {0.0f, -0.0f, std::numeric_limits<float>::denorm_min(),
              std::numeric_limits<float>::max()};
    while (values.size() < 2000) {
        const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
        if (value - value == 0) values.push_back(value);
    }
    const Result<Order> read = read_order(to_text(order), "quay.order");
    ASSERT_TRUE(read.ok()) << to_string(read.error());
    const std::vector<float>& there = read->request.known.uniforms.at("scale");
    ASSERT_EQ(there.size(), values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        EXPECT_EQ(std::bit_cast<std::uint32_t>(there[i]), std::bit_cast<std::uint32_t>(values[i]))
            << "seed " << seed << ", number " << i;
}

TEST(Order, SaysWhatIsNoOrder) {
    const Result<Order> broken = read_order("{\"schema\": 1,\n  oops}", "a.order");
    ASSERT_FALSE(broken.ok());
    EXPECT_EQ(broken.error().code, "order-syntax");
    EXPECT_EQ(broken.error().file, "a.order");
    EXPECT_EQ(broken.error().line, 2);
    for (const char* text : {"", "[]", "{}", "{\"schema\": 1}", "{\"schema\": 999}"}) {
        const Result<Order> read = read_order(text, "a.order");
        ASSERT_FALSE(read.ok()) << text;
        EXPECT_EQ(read.error().code, "order-syntax") << text;
    }
}

}  // namespace
}  // namespace intaglio::plan
