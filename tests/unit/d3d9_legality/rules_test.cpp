// Each rule refuses the shaders that break it, with its own code only, and accepts those at its
// limit.
#include <set>
#include <string>

#include <gmock/gmock.h>

#include "generator/target/d3d9/assembly.h"
#include "tests/unit/d3d9_legality/cases.h"

namespace intaglio::d3d9 {
namespace {

TEST(Rules, RefuseWhatBreaksThemAndNothingElse) {
    for (const RuleCase& one : rule_cases()) {
        const auto violations = check(shader_of(one.text));
        std::set<std::string> rules;
        for (const Violation& violation : violations) rules.insert(violation.rule);
        std::set<std::string> expected;
        if (one.kind != RuleCase::Kind::Good) expected.insert(one.rule);
        EXPECT_EQ(rules, expected) << "rules.txt:" << one.line << "\n"
                                   << one.text << describe(violations);
        EXPECT_EQ(one.reason.empty(), one.kind != RuleCase::Kind::Strict)
            << "rules.txt:" << one.line;
    }
}

// What text cannot say, but a decoded or built shader can.
std::vector<Violation> check_changed(void (*change)(Shader&)) {
    Shader shader = shader_of("ps_3_0\nmov r0, c0\nmov oC0, r0\n");
    change(shader);
    return check(shader);
}

TEST(Rules, HoldForShadersThatNoTextDescribes) {
    const std::pair<const char*, void (*)(Shader&)> changes[] = {
        {"operands", [](Shader& s) { s.instructions[0].sources.clear(); }},
        {"operands", [](Shader& s) { s.instructions[1].sources.push_back({}); }},
        {"operands", [](Shader& s) { s.instructions[1].destination.reset(); }},
        {"operands", [](Shader& s) { s.instructions[1].comparison = Comparison::Less; }},
        {"write-mask", [](Shader& s) { s.instructions[1].destination->mask = 0; }},
        {"register-number", [](Shader& s) { s.instructions[0].sources[0].index = -1; }},
        {"dcl-register",
         [](Shader& s) {
             s.declarations.push_back({{File::Temp, 0}, Usage::Color, 0, SamplerKind::None});
         }},
        {"def-register",
         [](Shader& s) {
             s.definitions.push_back({File::Temp, 0, {}});
         }},
    };
    for (const auto& [rule, change] : changes) {
        const auto violations = check_changed(change);
        bool found = false;
        for (const Violation& violation : violations) found |= violation.rule == rule;
        EXPECT_TRUE(found) << rule << " is missing among\n" << describe(violations);
    }
}

TEST(Rules, EachHasItsShaders) {
    std::set<std::string> tested = {"operands", "write-mask", "dcl-register",
                                    "def-register"};  // by the test above
    for (const RuleCase& one : rule_cases())
        if (one.kind != RuleCase::Kind::Good) tested.insert(one.rule);
    const std::set<std::string> named(std::begin(rule_names), std::end(rule_names));
    EXPECT_EQ(tested, named);
}

// Direct3D's verdicts were recorded; the test labelled `judge` compares them with the installed
// validator.
TEST(Probes, AreJudgedAsDirect3DDoes) {
    int legal = 0, illegal = 0;
    for (const Probe& probe : probes()) {
        const auto shader = parse(probe.text, "probe.asm", Profile::ps_2_a);
        ++(probe.accepted ? legal : illegal);
        if (!shader) {
            EXPECT_FALSE(probe.accepted) << "probes.txt:" << probe.line << "\n"
                                         << probe.text << shader.error().message;
            continue;
        }
        const auto violations = check(*shader, validator_limits(shader->profile));
        EXPECT_EQ(violations.empty(), probe.accepted) << "probes.txt:" << probe.line << "\n"
                                                      << probe.text << describe(violations);
    }
    EXPECT_GT(legal, 200);
    EXPECT_GT(illegal, 200);
}

TEST(Messages, NameLimitAndExcess) {
    std::string text = "ps_2_0\nmov r0, c0\n";
    for (int i = 0; i < 70; ++i) text += "mul r0, r0, r0\n";
    const auto violations = check(shader_of(text + "mov oC0, r0\n"));
    ASSERT_EQ(violations.size(), 1u);
    EXPECT_EQ(violations[0].message, "72 arithmetic slots, ps_2_0 allows 64: 8 too many");
}

}  // namespace
}  // namespace intaglio::d3d9
