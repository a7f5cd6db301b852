// Everything that the command line can emit for Direct3D 9, before Direct3D's own tools: each
// technique with each knob at its default on every profile, and at both ends on one of them.  What
// our own rules accept, its validator accepts; its assembler makes our bytes of our text, and of
// its own disassembly of our bytes. HLSL of the old models goes through its compiler.
#include <gmock/gmock.h>

#include <array>
#include <atomic>
#include <optional>
#include <thread>

#include <fmt/format.h>

#include "generator/target/d3d9/bytecode.h"
#include "generator/target/d3d9/ops.h"
#include "src/variant/settings.h"
#include "templates/all_techniques.h"
#include "tests/judge/judge.h"

namespace intaglio::judge {
namespace {

struct Wanted {
    Setting setting;
    std::string target;
    std::optional<Result<Variant>> variant = {};

    std::string name() const {
        return fmt::format("{} {}={} on {}", setting.surface, setting.knob.first,
                           setting.knob.second, target);
    }
};

// The variants of all settings that `is_wanted`, made on all cores.
// Defaults on every target, each end of a knob on one of them in turn: another value of
// a knob is the same instructions, a constant or their count apart.
template <typename Filter>
std::vector<Wanted> variants_of(const std::vector<std::string>& targets, const Filter& is_wanted) {
    const dsl::Catalogue catalogue = templates::all_techniques();
    std::vector<Wanted> all;
    std::size_t turn = 0;
    for (const Setting& setting : all_settings(catalogue)) {
        const bool by_default = setting.knob.first.empty();
        const std::string& its_own = targets[turn % targets.size()];
        for (const std::string& target : targets)
            if ((by_default || target == its_own) && is_wanted(setting, target))
                all.push_back({setting, target});
        turn += !by_default;
    }
    std::atomic<std::size_t> next = 0;
    std::vector<std::jthread> threads;
    for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i)
        threads.emplace_back([&] {
            for (std::size_t at = next++; at < all.size(); at = next++) {
                VariantRequest request;
                request.surface = all[at].setting.surface;
                request.target = all[at].target;
                request.knobs = all[at].setting.knobs();
                all[at].variant = make_variant(catalogue, request);
            }
        });
    threads.clear();
    return all;
}

// Long searches take the generator seconds each, in model 2 mostly to be refused, which says
// nothing to a judge: of those, the default on ps_3_0, which keeps loops, and the fewest steps
// everywhere. All refusals are in the table of docs/targets.
bool is_short(const Setting& setting, const std::string& target) {
    if (setting.work != Setting::Work::Same) return setting.work == Setting::Work::Less;
    for (const char* part : {"exact", "cone", "distance", "max_mip", "relief_secant",
                             "search=relief", "contact", "steep", "march", "fur"})
        if (setting.title.find(part) != std::string::npos)
            return target == "ps_3_0" && setting.knob.first.empty();
    return true;
}

std::vector<std::uint32_t> words_of(const std::string& bytes) {
    std::vector<std::uint32_t> words(bytes.size() / 4);
    for (std::size_t i = 0; i < 4 * words.size(); ++i)
        words[i / 4] |= std::uint32_t{static_cast<unsigned char>(bytes[i])} << (8 * (i % 4));
    return words;
}

// The disassembler cannot print breakp so that it can be read again.
bool is_printed_readably(const Variant& variant, ir::Stage stage) {
    const Result<d3d9::Shader> shader = decode_stage(variant, stage);
    return shader && std::none_of(shader->instructions.begin(), shader->instructions.end(),
                                  [](const d3d9::Instruction& instruction) {
                                      return instruction.op == d3d9::Opcode::BreakP;
                                  });
}

TEST(VariantsJudge, AcceptsEveryTextAndEveryByteStream) {
    const std::vector<Wanted> all = variants_of({"ps_2_0", "ps_2_a", "ps_2_b", "ps_3_0"}, is_short);
    struct Question {
        std::string name;
        std::vector<std::uint32_t> words;
        std::size_t assembled, disassembled;
        bool readable;
    };
    Batch batch;
    std::vector<Question> questions;
    int refused = 0;
    for (const Wanted& wanted : all) {
        if (!*wanted.variant) {
            EXPECT_TRUE(is_refusal(wanted.variant->error()))
                << wanted.name() << ": " << to_string(wanted.variant->error());
            ++refused;
            continue;
        }
        for (ir::Stage stage : {ir::Stage::Vertex, ir::Stage::Pixel}) {
            const Artifact& artifact =
                stage == ir::Stage::Vertex ? (*wanted.variant)->vertex : (*wanted.variant)->pixel;
            Question question{wanted.name(), words_of(artifact.bytecode.bytes), 0, 0, true};
            question.assembled = batch.assemble(artifact.text);
            question.disassembled = batch.disassemble(question.words);
            question.readable = is_printed_readably(**wanted.variant, stage);
            questions.push_back(std::move(question));
        }
    }
    ASSERT_GE(questions.size(), 250u);
    const auto answers = batch.run(*find());
    ASSERT_TRUE(answers.ok()) << to_string(answers.error());
    Batch again;
    std::vector<std::pair<std::size_t, const Question*>> round_trips;
    for (const Question& question : questions) {
        const Answer& text = answers->at(question.assembled);
        const Answer& bytes = answers->at(question.disassembled);
        EXPECT_TRUE(text.accepted) << question.name << "\n" << text.text;
        EXPECT_TRUE(bytes.accepted) << question.name << "\n" << bytes.text;
        if (text.accepted) {
            EXPECT_EQ(d3d9::without_comments(text.words), d3d9::without_comments(question.words))
                << question.name;
        }
        if (bytes.accepted && question.readable)
            round_trips.emplace_back(again.assemble(bytes.text), &question);
    }
    const auto second = again.run(*find());
    ASSERT_TRUE(second.ok()) << to_string(second.error());
    for (const auto& [index, question] : round_trips) {
        EXPECT_TRUE(second->at(index).accepted) << question->name << "\n" << second->at(index).text;
        EXPECT_EQ(d3d9::without_comments(second->at(index).words),
                  d3d9::without_comments(question->words))
            << question->name;
    }
    fmt::print("{} stages accepted, {} variants refused by our own rules\n", questions.size(),
               refused);
}

// Too many slots, registers or interpolants, reads that depend on each other too deeply: what no
// text can help.
const std::vector<std::string> counts = {"X5608", "X5607", "X5609", "X5426",
                                         "X4505", "X4018", "X4506", "X5774"};

TEST(VariantsJudge, TheCompilerRefusesHlslForItsSizeOnly) {
    // Of model 2 the compiler takes minutes for what is too long for it by far.
    const std::vector<Wanted> all =
        variants_of({"hlsl_2_0", "hlsl_2_b", "hlsl_3_0"},
                    [](const Setting& setting, const std::string& target) {
                        return setting.knob.first.empty() &&
                               is_short(setting, target == "hlsl_3_0" ? "ps_3_0" : target);
                    });
    Batch batch;
    std::vector<std::pair<const Wanted*, std::array<std::size_t, 2>>> questions;
    for (const Wanted& wanted : all) {
        if (!*wanted.variant) {
            EXPECT_TRUE(is_refusal(wanted.variant->error()))
                << wanted.name() << ": " << to_string(wanted.variant->error());
            continue;
        }
        const std::string model = wanted.target.substr(5);
        const Variant& variant = **wanted.variant;
        questions.push_back(
            {&wanted,
             {batch.compile(variant.vertex.text, variant.vertex.entry,
                            model == "3_0" ? "vs_3_0" : "vs_2_0"),
              batch.compile(variant.pixel.text, variant.pixel.entry, "ps_" + model)}});
    }
    ASSERT_GE(questions.size(), 80u);
    const auto answers = batch.run(*find());
    ASSERT_TRUE(answers.ok()) << to_string(answers.error());
    int compiled = 0;
    for (const auto& [wanted, places] : questions) {
        EXPECT_TRUE(answers->at(places[0]).accepted) << wanted->name() << "\n"
                                                     << answers->at(places[0]).text;
        const Answer& pixel = answers->at(places[1]);
        compiled += pixel.accepted;
        if (pixel.accepted) continue;
        EXPECT_NE(wanted->target, "hlsl_3_0") << wanted->name() << "\n" << pixel.text;
        EXPECT_THAT(counts, testing::Contains(error_code(pixel))) << wanted->name() << "\n"
                                                                  << pixel.text.substr(0, 400);
    }
    fmt::print("{} of {} pixel stages compiled, the others are too large\n", compiled,
               questions.size());
}

}  // namespace
}  // namespace intaglio::judge
