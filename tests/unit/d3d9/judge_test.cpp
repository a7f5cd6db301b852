// Direct3D's own assembler, validator and compiler as witnesses, where they are installed.  Each
// start takes seconds, so whole batches are judged at once.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "generator/target/d3d9/assembly.h"
#include "generator/target/d3d9/bytecode.h"
#include "tests/judge/judge.h"
#include "tests/unit/d3d9/dice.h"
#include "tests/unit/d3d9/random_shader.h"

namespace intaglio::d3d9 {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::uint32_t>;

struct Verdict {
    int code = -1;
    std::string text;
};

std::string read_text(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

// A folder of files that judge commands name; removed at the end.
class Court {
  public:
    Court() : folder_(fs::temp_directory_path() / fmt::format("intaglio_judge_{}", getpid())) {
        fs::create_directories(folder_);
    }
    ~Court() { fs::remove_all(folder_); }
    Court(const Court&) = delete;
    Court& operator=(const Court&) = delete;

    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(path(name), std::ios::binary) << text;
    }
    void write(const std::string& name, const Words& words) const {
        std::ofstream(path(name), std::ios::binary)
            .write(reinterpret_cast<const char*>(words.data()),
                   static_cast<std::streamsize>(words.size() * 4));
    }
    Words read_words(const std::string& name) const {
        const std::string bytes = read_text(path(name));
        Words words(bytes.size() / 4);
        for (std::size_t i = 0; i < words.size() * 4; ++i)
            words[i / 4] |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i]))
                            << (8 * (i % 4));
        return words;
    }

    // One verdict for each command, in order.
    std::vector<Verdict> judge(const std::vector<std::string>& commands) const {
        std::string list;
        for (const std::string& command : commands) list += command + "\n";
        write("list", list);
        const std::string out = path("out");
        const std::string shell = fmt::format("'{}' batch '{}' > '{}' 2>/dev/null",
                                              judge::find()->string(), path("list"), out);
        EXPECT_EQ(std::system(shell.c_str()), 0) << shell;
        std::vector<Verdict> verdicts(1);
        std::istringstream lines(read_text(out));
        for (std::string line; std::getline(lines, line);) {
            if (!line.empty() && line.back() == '\r') line.pop_back();
            if (line.starts_with("#### ")) {
                verdicts.back().code = std::stoi(line.substr(5));
                verdicts.emplace_back();
            } else {
                verdicts.back().text += line + "\n";
            }
        }
        verdicts.pop_back();
        EXPECT_EQ(verdicts.size(), commands.size());
        verdicts.resize(commands.size());
        return verdicts;
    }

  private:
    fs::path folder_;
};

// Where two streams part, in words.
std::string difference(const Words& ours, const Words& theirs) {
    std::size_t at = 0;
    while (at < ours.size() && at < theirs.size() && ours[at] == theirs[at]) ++at;
    const auto word = [&](const Words& words) {
        return at < words.size() ? fmt::format("{:08x}", words[at]) : "nothing";
    };
    return fmt::format("token {} of {}: ours {}, the assembler's {}", at, ours.size(), word(ours),
                       word(theirs));
}

// Shaders through the judge: text to bytes; our bytes to text and back to bytes.
void expect_agreement(const std::vector<Shader>& shaders) {
    const Court court;
    std::vector<std::string> commands;
    for (std::size_t i = 0; i < shaders.size(); ++i) {
        court.write(fmt::format("{}.asm", i), print(shaders[i]));
        court.write(fmt::format("{}.ours", i), encode(shaders[i]));
        commands.push_back(fmt::format("asm {} -o {}", court.path(fmt::format("{}.asm", i)),
                                       court.path(fmt::format("{}.theirs", i))));
        commands.push_back(fmt::format("dis {}", court.path(fmt::format("{}.ours", i))));
    }
    const auto first = court.judge(commands);
    std::vector<std::string> again;
    for (std::size_t i = 0; i < shaders.size(); ++i) {
        court.write(fmt::format("{}.dis", i), first[2 * i + 1].text);
        again.push_back(fmt::format("asm {} -o {}", court.path(fmt::format("{}.dis", i)),
                                    court.path(fmt::format("{}.again", i))));
    }
    const auto second = court.judge(again);
    for (std::size_t i = 0; i < shaders.size(); ++i) {
        const std::string text = print(shaders[i]);
        const Words ours = encode(shaders[i], false);
        ASSERT_EQ(first[2 * i].code, 0) << "shader " << i << "\n" << first[2 * i].text << text;
        const Words theirs = without_comments(court.read_words(fmt::format("{}.theirs", i)));
        ASSERT_EQ(ours, theirs) << "shader " << i << ", " << difference(ours, theirs) << "\n"
                                << text;
        const auto decoded = decode(theirs, shaders[i].profile);
        ASSERT_TRUE(decoded) << to_string(decoded.error());
        ASSERT_EQ(first[2 * i + 1].code, 0) << "shader " << i << "\n" << first[2 * i + 1].text;
        ASSERT_EQ(second[i].code, 0) << "shader " << i << "\n"
                                     << second[i].text << first[2 * i + 1].text;
        const Words round = without_comments(court.read_words(fmt::format("{}.again", i)));
        ASSERT_EQ(ours, round) << "shader " << i << ", " << difference(ours, round) << "\n"
                               << first[2 * i + 1].text;
    }
}

class Judge : public testing::TestWithParam<Profile> {};

TEST_P(Judge, AcceptsTextAndBytesOfRandomLegalShaders) {
    std::vector<Shader> shaders;  // shader i is of seed i
    for (std::uint32_t seed = 0; seed < 200; ++seed)
        shaders.push_back(random_legal_shader(seed, GetParam()));
    expect_agreement(shaders);
}

INSTANTIATE_TEST_SUITE_P(Profiles, Judge, testing::ValuesIn(every_profile),
                         [](const auto& row) { return std::string(name_of(row.param)); });

// The disassembler prints nine digits, from which not every float comes back; so only the text is
// judged.
TEST(JudgeText, ReadsOurFloatsToTheBit) {
    const Court court;
    Dice dice(3);
    Shader shader;
    shader.profile = Profile::vs_3_0;
    std::vector<Shader> shaders;
    std::vector<std::string> commands;
    for (int i = 0; i < 40; ++i) {
        shader.definitions.clear();
        for (int c = 0; c < 256; ++c)
            shader.definitions.push_back({File::Const,
                                          c,
                                          {dice.float_bits(), dice.float_bits(),
                                           dice.bits() & 0x807FFFFF, dice.float_bits()}});
        court.write(fmt::format("{}.asm", i), print(shader));
        commands.push_back(fmt::format("asm {} -o {}", court.path(fmt::format("{}.asm", i)),
                                       court.path(fmt::format("{}.theirs", i))));
        shaders.push_back(shader);
    }
    const auto verdicts = court.judge(commands);
    for (std::size_t i = 0; i < shaders.size(); ++i) {
        ASSERT_EQ(verdicts[i].code, 0) << verdicts[i].text;
        const auto theirs = decode(without_comments(court.read_words(fmt::format("{}.theirs", i))));
        ASSERT_TRUE(theirs) << to_string(theirs.error());
        for (std::size_t c = 0; c < 256; ++c)
            ASSERT_EQ(theirs->definitions[c], shaders[i].definitions[c])
                << "seed 3, shader " << i << ", c" << c;
    }
}

// breakp and _abs with an address are disassembled unreadably, so only their text is judged; and
// shorthands.
TEST(JudgeText, AgreesOnWhatTheDisassemblerCannotPrint) {
    const Court court;
    const std::string texts[] = {
        "vs_3_0\ndcl_position v0\ndcl_position o0\nmova a0, v0\nmov r0, -c3_abs[a0.z].x\nmov o0, "
        "r0\n",
        "ps_3_0\nsetp_gt p0, c0, -c0\nrep i0\nbreakp !p0.y\nbreakp p0.x\nendrep\nmov oC0, c0.xy\n",
        "vs_3_0\ndcl_position v0\ndcl_position o0\ndcl_texcoord o1\ndcl_texcoord1 o2\nmov o0, "
        "v0\nloop aL, i0\n"
        "mov o1[aL], c[aL + 3].rgba\nendloop\nmov o1, v0\nmov o2, v0\n"};
    std::vector<std::string> commands;
    for (const std::string& text : texts) {
        const std::string name = court.path(fmt::format("{}.asm", commands.size()));
        std::ofstream(name) << text;
        commands.push_back(fmt::format("asm {} -o {}.theirs", name, name));
    }
    const auto verdicts = court.judge(commands);
    for (std::size_t i = 0; i < commands.size(); ++i) {
        ASSERT_EQ(verdicts[i].code, 0) << verdicts[i].text << texts[i];
        const auto shader = parse(texts[i], "text.asm");
        ASSERT_TRUE(shader) << to_string(shader.error());
        const Words theirs = without_comments(court.read_words(fmt::format("{}.asm.theirs", i)));
        EXPECT_EQ(encode(*shader, false), theirs) << texts[i];
    }
}

// Bytecode and constant table of Microsoft's compiler, by the same names and registers.
TEST(JudgeCompiler, WritesWhatWeRead) {
    const Court court;
    court.write(
        "all.hlsl",
        std::string("float4x4 world; float3 lights[3]; float4x3 w43[2]; row_major float3x4 rows; "
                    "sampler2D map; samplerCUBE env;\n"
                    "struct S { float3 a; float b; } st; int count; bool flag;\n"
                    "float4 main(float2 uv : TEXCOORD0, float3 n : TEXCOORD1) : COLOR {\n"
                    "  float4 c = tex2D(map, uv) + texCUBE(env, n) + mul(float4(n, 1), world);\n"
                    "  c.xyz += lights[1] * lights[2] + mul(float4(n, 1), w43[1]) + mul(rows, "
                    "float4(n, 1)) + st.a;\n"
                    "  for (int i = 0; i < count; i++) c += c * 0.5;\n"
                    "  if (flag) c.x = st.b;\n"
                    "  return c;\n}\n"));
    const auto verdicts = court.judge(
        {fmt::format("hlsl {} main ps_3_0 -o {}", court.path("all.hlsl"), court.path("bin"))});
    ASSERT_EQ(verdicts[0].code, 0) << verdicts[0].text;
    const Words theirs = court.read_words("bin");
    const auto shader = decode(theirs);
    ASSERT_TRUE(shader) << to_string(shader.error());
    EXPECT_EQ(encode(*shader, false), without_comments(theirs));
    EXPECT_EQ(*decode(encode(*shader)), *shader);
    int floats = 0;
    for (const Constant& constant : shader->constants) {
        const std::string_view prefix = set_letters[static_cast<std::size_t>(constant.set)];
        std::string line = constant.name;
        line.resize(std::max<std::size_t>(line.size(), 12), ' ');
        line += fmt::format(" {:<5} {:>4}", fmt::format("{}{}", prefix, constant.index),
                            constant.count);
        EXPECT_NE(verdicts[0].text.find(line), std::string::npos) << "\"" << line << "\" in\n"
                                                                  << verdicts[0].text;
        floats += constant.set == Constant::Set::Float4;
    }
    EXPECT_GE(floats, 5);
    EXPECT_EQ(verdicts[0].text.find("unknown"), std::string::npos);
}

}  // namespace
}  // namespace intaglio::d3d9
