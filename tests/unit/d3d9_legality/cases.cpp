// One shader a line: "; " ends a line of the shader, "12 * nop" stands for twelve.
#include "tests/unit/d3d9_legality/cases.h"

#include <cctype>
#include <cstdlib>
#include <fstream>

#include <gmock/gmock.h>

#include "generator/target/d3d9/assembly.h"

namespace intaglio::d3d9 {
namespace {

std::string trimmed(const std::string& text) {
    const std::size_t begin = text.find_first_not_of(' ');
    return begin == std::string::npos ? ""
                                      : text.substr(begin, text.find_last_not_of(' ') - begin + 1);
}

std::string expanded(const std::string& line) {
    std::string text;
    for (std::size_t begin = 0; begin <= line.size();) {
        const std::size_t end = std::min(line.find(';', begin), line.size());
        std::string statement = trimmed(line.substr(begin, end - begin));
        int times = 1;
        if (!statement.empty() && std::isdigit(static_cast<unsigned char>(statement[0])) != 0) {
            times = std::atoi(statement.c_str());
            statement = trimmed(statement.substr(statement.find('*') + 1));
        }
        for (int i = 0; i < times; ++i) text += statement + '\n';
        begin = end + 1;
    }
    return text;
}

std::string next_word(std::string& line) {
    const std::size_t end = std::min(line.find(' '), line.size());
    std::string word = line.substr(0, end);
    line = trimmed(line.substr(end));
    return word;
}

template <typename Case, typename Read>
std::vector<Case> cases_of(const char* name, Read read) {
    std::ifstream file(std::string(CASES_FOLDER "/") + name);
    std::vector<Case> cases;
    int number = 0;
    for (std::string line; std::getline(file, line);) {
        ++number;
        if (line.empty() || line[0] == '#') continue;
        cases.push_back(read(line));
        cases.back().line = number;
    }
    return cases;
}

}  // namespace

std::vector<RuleCase> rule_cases() {
    return cases_of<RuleCase>("rules.txt", [](std::string line) {
        RuleCase one;
        const std::string kind = next_word(line);
        if (kind != "good") one.rule = next_word(line);
        if (kind != "good") one.kind = kind == "bad" ? RuleCase::Kind::Bad : RuleCase::Kind::Strict;
        const std::size_t bar = line.find(" | ");
        if (bar != std::string::npos) one.reason = line.substr(bar + 3);
        one.text = expanded(line.substr(0, bar));
        return one;
    });
}

std::vector<Probe> probes() {
    return cases_of<Probe>("probes.txt", [](std::string line) {
        Probe probe;
        probe.accepted = next_word(line) == "legal";
        probe.text = expanded(line);
        return probe;
    });
}

std::string judge_text(const std::string& text) {
    for (const char* name : {"ps_2_a", "ps_2_b"})
        if (text.rfind(name, 0) == 0) return "ps_2_x" + text.substr(6);
    return text;
}

Shader shader_of(const std::string& text) {
    const Profile x = text.rfind("ps_2_b", 0) == 0 ? Profile::ps_2_b : Profile::ps_2_a;
    auto shader = parse(judge_text(text), "case.asm", x);
    if (!shader) {
        ADD_FAILURE() << to_string(shader.error()) << "\n" << text;
        return {};
    }
    return *shader;
}

std::string describe(const std::vector<Violation>& violations) {
    std::string lines;
    for (const Violation& violation : violations)
        lines += violation.rule + ": " + violation.message + " (instruction " +
                 std::to_string(violation.instruction) + ")\n";
    return lines;
}

}  // namespace intaglio::d3d9
