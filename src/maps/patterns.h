// The height patterns behind the makers, and the arithmetic they share.  Everything here is
// integers, + - * / and square root in double, which every compiler and C library computes alike:
// the maps are the same on every machine.
#pragma once

#include <cstdint>

#include "src/maps/image.h"

namespace intaglio::maps {

// Each fills a map of the given size with heights; the sentences in makers.cpp say what they look
// like.
Image bricks(int width, int height, std::uint32_t seed);
Image cobbles(int width, int height, std::uint32_t seed);
Image text(int width, int height, std::uint32_t seed);
Image pyramids(int width, int height, std::uint32_t seed);
Image fur(int width, int height, std::uint32_t seed);
Image spikes(int width, int height, std::uint32_t seed);
Image steps(int width, int height, std::uint32_t seed);
Image noise(int width, int height, std::uint32_t seed);
Image smooth(int width, int height, std::uint32_t seed);
Image flat_0(int width, int height, std::uint32_t seed);
Image flat_1(int width, int height, std::uint32_t seed);
Image ramp(int width, int height, std::uint32_t seed);

// A number in [0, 1) that depends on all four, without visible pattern.
double random_unit(std::uint32_t seed, int x, int y, std::uint32_t purpose);

}  // namespace intaglio::maps
