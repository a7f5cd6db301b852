// The Direct3D judge for tests: Microsoft's assembler, validator, disassembler and HLSL compiler,
// installed by scripts/judge and run as one process for many questions (a start under Wine takes a
// second or two).
//
//   judge::Batch batch;
//   const auto a = batch.assemble("ps_2_0\n...");
//   auto answers = batch.run(*judge::find());
//   answers->at(a).accepted ...
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "generator/base/result.h"

namespace intaglio::judge {

// The installed judge: $INTAGLIO_JUDGE if set, else ~/.cache/intaglio-judge/judge, else
// ~/.cache/d3d-judge/judge. Nothing when there is none; `why` says where it was looked for.
std::optional<std::filesystem::path> find(std::string* why = nullptr);

struct Answer {
    bool accepted = false;
    std::string text;  // disassembly when accepted; messages, X numbers included, when refused
    std::vector<std::uint32_t> words;  // bytecode of what was assembled or compiled
};

// The X number of a refusal's first error, "X5204"; empty if there is none.
std::string error_code(const Answer& answer);

class Batch {
  public:
    using Defines = std::vector<std::pair<std::string, std::string>>;  // neither holds blanks

    // Each answers the index of its Answer.
    std::size_t assemble(std::string text);
    std::size_t disassemble(const std::vector<std::uint32_t>& words);
    // `profile` as fxc's -T: "ps_2_0", "ps_2_a", "ps_2_b", "ps_3_0", "vs_2_0", "vs_3_0".
    std::size_t compile(std::string hlsl, std::string entry, std::string profile,
                        Defines defines = {});
    std::size_t size() const { return questions_.size(); }

    // Asks everything in one process, in a temporary folder that is removed afterwards.  An error
    // is the judge's own failure (it did not start, or did not answer every question), never a
    // refusal.
    Result<std::vector<Answer>> run(const std::filesystem::path& judge) const;

  private:
    struct Question {
        std::string command;    // "asm", "dis" or "hlsl"
        std::string content;    // of the input file
        std::string arguments;  // after the input file
    };
    std::vector<Question> questions_;
};

// What the judge printed for a whole batch, cut into verdict and text of each command ("#### N"
// ends each).
struct Verdict {
    int exit_code = 0;
    std::string text;
};
std::vector<Verdict> cut_verdicts(std::string_view output);

}  // namespace intaglio::judge
