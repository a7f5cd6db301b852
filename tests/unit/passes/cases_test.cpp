// The case files of tests/passes: each shows one idea of one pass as text before and after.
//
// "# ..." says what it shows; "pass: NAME OPTIONS..." what runs; then sections, each opened by "---
// TITLE": `input`, or `vertex` and `pixel` for a pass over both stages; then the same with `
// output`; `notes` if the pass reports sentences. INTAGLIO_UPDATE_GOLDENS=1 writes the outputs and
// notes anew.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>

#include "generator/ir/parse.h"
#include "generator/ir/print.h"
#include "generator/ir/verify.h"
#include "generator/passes/close_inductions.h"
#include "generator/passes/count_texture_reads.h"
#include "generator/passes/eliminate_common_subexpressions.h"
#include "generator/passes/flatten_branches.h"
#include "generator/passes/fold_constants.h"
#include "generator/passes/hoist_loop_invariants.h"
#include "generator/passes/hoist_to_vertex.h"
#include "generator/passes/lower_first_hit.h"
#include "generator/passes/pipeline.h"
#include "generator/passes/remove_dead_code.h"
#include "generator/passes/remove_unused_interpolants.h"
#include "generator/passes/unroll_loops.h"

namespace intaglio::passes {
namespace {

using ir::Module;
using ir::Program;
using Notes = std::vector<std::string>;

// Passes over one module run on the pixel stage.
const std::map<std::string, std::function<Notes(Program&)>>& known_passes() {
    const auto quiet = [](auto pass) {
        return [pass](Program& program) {
            pass(program.pixel);
            return Notes{};
        };
    };
    const auto optimized = [](const PipelineOptions& options) {
        return [options](Program& program) {
            auto notes = optimize(program.pixel, options);
            return notes ? *notes : Notes{to_string(notes.error())};
        };
    };
    const auto first_hit = [](FirstHitForm form) {
        return [form](Program& program) {
            Notes notes;
            for (const FirstHit& hit : lower_first_hit(program.pixel, form))
                notes.push_back(hit.loop + ": " +
                                (!hit.refusal.empty() ? hit.refusal
                                 : hit.form == FirstHitForm::AnyHit
                                     ? "greatest gap"
                                     : "greatest key, then refetch"));
            return notes;
        };
    };
    static const std::map<std::string, std::function<Notes(Program&)>> passes = {
        {"fold_constants", quiet(fold_constants)},
        {"eliminate_common_subexpressions", quiet(eliminate_common_subexpressions)},
        {"remove_dead_code", quiet(remove_dead_code)},
        {"hoist_loop_invariants", quiet(hoist_loop_invariants)},
        {"close_inductions", [](Program& program) { return close_inductions(program.pixel); }},
        {"unroll_loops", quiet([](Module& module) { unroll_loops(module); })},
        {"unroll_loops select", quiet([](Module& module) {
             unroll_loops(module, Loops::AsScheduled, EarlyExit::Select);
         })},
        {"flatten_branches", quiet([](Module& module) { flatten_branches(module); })},
        {"flatten_branches outside_loops",
         quiet([](Module& module) { flatten_branches(module, Branches::OutsideLoops); })},
        {"count_texture_reads", quiet(count_texture_reads)},
        {"hoist_to_vertex", [](Program& program) { return hoist_to_vertex(program); }},
        {"remove_unused_interpolants",
         [](Program& program) {
             remove_unused_interpolants(program);
             return Notes{};
         }},
        {"lower_first_hit", first_hit(FirstHitForm::PackedRefetch)},
        {"lower_first_hit any", first_hit(FirstHitForm::AnyHit)},
        {"optimize", optimized({.verify_each = true})},
        {"optimize unrolled flat",
         optimized({.unroll_all = true, .flatten_all = true, .verify_each = true})},
    };
    return passes;
}

struct Case {
    std::string comment, pass;
    std::map<std::string, std::string> sections;
};

Case read_case(const std::filesystem::path& path) {
    std::ifstream file(path);
    Case read;
    std::string* section = nullptr;
    for (std::string line; std::getline(file, line);) {
        if (line.rfind("--- ", 0) == 0)
            section = &read.sections[line.substr(4)];
        else if (section != nullptr)
            *section += line + "\n";
        else if (line.rfind("pass: ", 0) == 0)
            read.pass = line.substr(6);
        else
            read.comment += line + "\n";
    }
    return read;
}

void write_case(const std::filesystem::path& path, const Case& written) {
    std::ofstream file(path);
    file << written.comment << "pass: " << written.pass << "\n";
    for (const char* title :
         {"input", "output", "vertex", "pixel", "vertex output", "pixel output", "notes"})
        if (const auto section = written.sections.find(title); section != written.sections.end())
            file << "--- " << title << "\n" << section->second;
}

std::filesystem::path folder() {
    return std::filesystem::path(INTAGLIO_SOURCE_DIR) / "tests" / "passes";
}

std::vector<std::string> case_files() {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder()))
        if (entry.path().extension() == ".ir")
            files.push_back(std::filesystem::relative(entry.path(), folder()).string());
    std::sort(files.begin(), files.end());
    return files;
}

class Cases : public ::testing::TestWithParam<std::string> {
  protected:
    void read_module(const std::string& title, Module& module) {
        const auto section = case_.sections.find(title);
        if (section == case_.sections.end()) return;
        const auto parsed = ir::parse(section->second, GetParam() + " " + title);
        ASSERT_TRUE(parsed.ok()) << to_string(parsed.error());
        module = *parsed;
        check(title, module);
    }

    void check(const std::string& title, const Module& module) {
        const Status status = ir::verify(module);
        ASSERT_TRUE(status.ok()) << title << ": " << to_string(status.error()) << "\n"
                                 << ir::print(module);
    }

    Case case_;
};

TEST_P(Cases, BecomeTheirOutput) {
    const std::filesystem::path path = folder() / GetParam();
    case_ = read_case(path);
    const auto pass = known_passes().find(case_.pass);
    ASSERT_NE(pass, known_passes().end()) << "unknown pass '" << case_.pass << "'";
    ASSERT_EQ(path.parent_path().filename().string(), case_.pass.substr(0, case_.pass.find(' ')))
        << "a case lies in the folder of its pass";

    const bool both_stages = case_.sections.count("vertex") > 0;
    Program program;
    program.per_vertex = true;
    read_module("vertex", program.vertex);
    read_module(both_stages ? "pixel" : "input", program.pixel);
    if (HasFatalFailure()) return;
    const Notes notes = pass->second(program);
    check("pixel after the pass", program.pixel);
    if (both_stages) check("vertex after the pass", program.vertex);

    Case actual = case_;
    for (const char* title : {"output", "vertex output", "pixel output", "notes"})
        actual.sections.erase(title);
    actual.sections[both_stages ? "pixel output" : "output"] = ir::print(program.pixel);
    if (both_stages) actual.sections["vertex output"] = ir::print(program.vertex);
    for (const std::string& note : notes) actual.sections["notes"] += note + "\n";
    if (std::getenv("INTAGLIO_UPDATE_GOLDENS") != nullptr) return write_case(path, actual);

    for (const auto& [title, text] : actual.sections)
        EXPECT_EQ(case_.sections[title], text)
            << "section '" << title << "' of " << GetParam()
            << " (left: the file, right: the pass)\n"
            << "accept: INTAGLIO_UPDATE_GOLDENS=1 ctest -R unit.passes";
    EXPECT_EQ(case_.sections.size(), actual.sections.size())
        << "a section that the pass does not produce";
}

std::string test_name(const ::testing::TestParamInfo<std::string>& test) {
    std::string name = test.param.substr(0, test.param.rfind('.'));
    std::replace(name.begin(), name.end(), '/', '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(Passes, Cases, ::testing::ValuesIn(case_files()), test_name);

}  // namespace
}  // namespace intaglio::passes
