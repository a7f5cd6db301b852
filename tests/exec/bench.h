// What the exec tests share: one device with validation layers, maps by name, and drawing a surface
// on a target.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "src/measure/render.h"
#include "src/variant/variant.h"
#include "src/vulkan/program.h"
#include "templates/all_techniques.h"

namespace intaglio::exec {

// The one device of the test program, with validation layers; a failure to make it fails the test
// that asks first.
const vulkan::Device& device();

// The value, or a test failure with the diagnostic and an exit: nothing after it would mean
// anything.
template <typename T>
T must(Result<T> result) {
    if (!result) {
        ADD_FAILURE() << to_string(result.error());
        std::abort();
    }
    return std::move(*result);
}
inline void must(const Status& status) { must<Done>(Result<Done>(status)); }

inline constexpr double test_scale = 0.08;

// A procedural map of 128 x 128 texels.
measure::MapSet map_named(const std::string& maker, int width = 128, int height = 128);

using Knobs = std::vector<std::pair<std::string, std::string>>;

VariantRequest request(const std::string& surface, const std::string& target,
                       const Knobs& knobs = {});

// A surface on a target, compiled and uploaded once: a quad over the whole map, `size` pixels a
// side.
class Drawing {
  public:
    Drawing(const VariantRequest& request, const measure::MapSet& set, int size = 64,
            measure::Filtering filtering = measure::Filtering::Float);
    // Every colour target.
    std::vector<vulkan::Picture> at(measure::Direction view, measure::Direction light);

  private:
    vulkan::Program program_;
};

// The same for one picture.
std::vector<vulkan::Picture> draw(const VariantRequest& request, const measure::MapSet& set,
                                  measure::Direction view, measure::Direction light, int size = 64,
                                  measure::Filtering filtering = measure::Filtering::Float);

// Passes if both pictures have the same bits in every pixel; the failure names the first that
// differs, and how far.
testing::AssertionResult same_bits(const vulkan::Picture& expected, const vulkan::Picture& actual);

// Pixels with NaN or Inf.
int count_invalid(const vulkan::Picture& picture);

// Views that the tests sweep: straight down, oblique on and off the axes, grazing.
const std::vector<measure::Direction>& views();

}  // namespace intaglio::exec
