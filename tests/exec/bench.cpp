// The shared bench of the exec tests.
#include "tests/exec/bench.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include <fmt/format.h>

namespace intaglio::exec {
namespace {

// Distance in units in the last place, on the line of all floats.
std::int64_t ulps(float a, float b) {
    const auto line = [](float value) {
        const auto bits = std::bit_cast<std::int32_t>(value);
        return bits < 0 ? static_cast<std::int64_t>(INT32_MIN) - bits
                        : static_cast<std::int64_t>(bits);
    };
    return std::abs(line(a) - line(b));
}

// Any message of the validation layer fails the run, whichever test caused it.
class ValidationIsSilent : public testing::Environment {
  public:
    void TearDown() override {
        for (const std::string& message : device().validation_messages()) ADD_FAILURE() << message;
    }
};
const testing::Environment* const environment =
    testing::AddGlobalTestEnvironment(new ValidationIsSilent);

}  // namespace

const vulkan::Device& device() {
    static const vulkan::Device shared = must(vulkan::Device::create({"", true}));
    return shared;
}

measure::MapSet map_named(const std::string& maker, int width, int height) {
    return must(measure::make_map_set(maker, width, height, test_scale));
}

VariantRequest request(const std::string& surface, const std::string& target, const Knobs& knobs) {
    VariantRequest made;
    made.surface = surface;
    made.target = target;
    made.knobs = knobs;
    return made;
}

Drawing::Drawing(const VariantRequest& wanted, const measure::MapSet& set, int size,
                 measure::Filtering filtering)
    : program_([&] {
          const Variant variant = must(make_variant(templates::all_techniques(), wanted));
          const measure::Textures textures(set, filtering);
          return must(measure::prepare_quad(device(), must(link_variant(variant)), textures,
                                            test_scale, size, size));
      }()) {}

std::vector<vulkan::Picture> Drawing::at(measure::Direction view, measure::Direction light) {
    must(measure::aim(program_, view, light));
    return must(program_.draw());
}

std::vector<vulkan::Picture> draw(const VariantRequest& wanted, const measure::MapSet& set,
                                  measure::Direction view, measure::Direction light, int size,
                                  measure::Filtering filtering) {
    return Drawing(wanted, set, size, filtering).at(view, light);
}

testing::AssertionResult same_bits(const vulkan::Picture& expected, const vulkan::Picture& actual) {
    if (expected.pixels.size() != actual.pixels.size())
        return testing::AssertionFailure() << "sizes differ";
    std::int64_t worst = 0;
    std::size_t differing = 0, first = 0;
    for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
        std::int64_t distance = 0;
        for (std::size_t c = 0; c < 4; ++c)
            if (std::bit_cast<std::uint32_t>(expected.pixels[i][c]) !=
                std::bit_cast<std::uint32_t>(actual.pixels[i][c]))
                distance = std::max<std::int64_t>(
                    {distance, 1, ulps(expected.pixels[i][c], actual.pixels[i][c])});
        if (distance > 0 && differing++ == 0) first = i;
        worst = std::max(worst, distance);
    }
    if (differing == 0) return testing::AssertionSuccess();
    const auto& e = expected.pixels[first];
    const auto& a = actual.pixels[first];
    return testing::AssertionFailure() << fmt::format(
               "{} of {} pixels differ, worst by {} ulp; first ({}, {}): expected ({}, {}, {}, "
               "{}), actual ({}, {}, {}, {})",
               differing, expected.pixels.size(), worst,
               first % static_cast<std::size_t>(expected.width),
               first / static_cast<std::size_t>(expected.width), e[0], e[1], e[2], e[3], a[0], a[1],
               a[2], a[3]);
}

int count_invalid(const vulkan::Picture& picture) {
    int count = 0;
    for (const auto& pixel : picture.pixels)
        for (float c : pixel)
            if (!std::isfinite(c)) {
                ++count;
                break;
            }
    return count;
}

const std::vector<measure::Direction>& views() {
    static const std::vector<measure::Direction> all = {{90, 0},  {60, 20},  {45, 0},  {45, 45},
                                                        {30, 90}, {15, 200}, {5, 110}, {0.1, 33}};
    return all;
}

}  // namespace intaglio::exec
