// Surfaces and knobs that the code generator is tested on, as recorded programs.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "generator/target/d3d9/generate/generate.h"

namespace intaglio::d3d9 {

struct Case {
    std::string surface;
    std::vector<std::pair<std::string, std::string>> knobs;
    std::string name() const;
};

// Every search, shadow and output, small and large.
std::vector<Case> all_cases();
// Those that write the depth or drop pixels.
std::vector<Case> output_cases();
std::vector<Profile> pixel_profiles();

// The program as a target of this profile's name records it.
Result<ir::Program> record(const Case& a_case, Profile profile);

// A program of the pixel module in this text, or a test failure.
ir::Program program_of_pixel(std::string_view text);
// Gives it a vertex stage that hands on the pixel stage's one input, a float2.
void add_vertex(ir::Program& program);

}  // namespace intaglio::d3d9
