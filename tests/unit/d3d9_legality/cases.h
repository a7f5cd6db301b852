// The shaders of rules.txt and probes.txt, as both test programs read them.
#pragma once

#include <string>
#include <vector>

#include "generator/target/d3d9/legality.h"
#include "generator/target/d3d9/shader.h"

namespace intaglio::d3d9 {

struct RuleCase {
    enum class Kind { Good, Bad, Strict };
    Kind kind = Kind::Good;
    std::string rule;    // of a bad or strict case
    std::string reason;  // of a strict case: why the validator accepts
    std::string text;    // assembly; ps_2_a and ps_2_b as written, see judge_text()
    int line = 0;        // in rules.txt
};
std::vector<RuleCase> rule_cases();

// A shader with the verdict of Direct3D's validator.
struct Probe {
    bool accepted = false;
    std::string text;
    int line = 0;
};
std::vector<Probe> probes();

// As parse() and Direct3D read it: both call ps_2_a and ps_2_b ps_2_x.
std::string judge_text(const std::string& text);
// Parses and fails the test with the text if that fails.
Shader shader_of(const std::string& text);

// "rule: sentence" of each, one a line.
std::string describe(const std::vector<Violation>& violations);

}  // namespace intaglio::d3d9
