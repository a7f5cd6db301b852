// Sweeps as people and farms run them: killed, resumed, in shards, changed.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <random>
#include <set>
#include <sstream>
#include <thread>

namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Clock = std::chrono::steady_clock;

class Sweep : public testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("intaglio sweep " + std::to_string(getpid()));
        fs::remove_all(folder_);
        fs::create_directories(folder_);
        write("2");
    }
    void TearDown() override { fs::remove_all(folder_); }

    // Twelve small cases, most without a device's compiler.
    void write(const std::string& iterations, const std::string& more = "") const {
        std::ofstream(folder_ / "sweep.toml")
            << "[views]\nelevations = [60, 30]\n"
               "[run]\nsize = 8\nsplit = 8\n"
               "[[map]]\nmaker = \"bricks\"\nwidth = 16\nclass = \"walls\"\n"
               "[[variant]]\nsurface = \"parallax\"\ntargets = [\"ps_2_0\"]\n"
               "arithmetics = [\"fp32\", \"fp24\", \"fp16\"]\n"
               "[[variant]]\nsurface = \"parallax_iterative\"\n"
               "targets = [\"glsl_450\", \"ps_2_b\"]\nknobs = { iterations = ["
            << iterations << "] }\n"
            << more;
    }
    std::string path(const std::string& name) const { return (folder_ / name).string(); }
    std::string contents(const std::string& name) const {
        std::ifstream file(folder_ / name, std::ios::binary);
        std::stringstream text;
        text << file.rdbuf();
        return text.str();
    }

    pid_t start(const std::vector<std::string>& arguments) const {
        const pid_t child = fork();
        if (child != 0) return child;
        const int err = open(path("err").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
        dup2(err, STDERR_FILENO);
        std::vector<char*> words;
        static char tool[] = INTAGLIO_TOOL;
        words.push_back(tool);
        for (const std::string& argument : arguments)
            words.push_back(const_cast<char*>(argument.c_str()));
        words.push_back(nullptr);
        execv(tool, words.data());
        _exit(127);
    }
    // The exit code; -1: killed.
    int finish(pid_t child) const {
        int status = 0;
        waitpid(child, &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    int run(const std::vector<std::string>& arguments) const { return finish(start(arguments)); }
    std::vector<std::string> sweep(const std::string& output,
                                   const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{"sweep", path("sweep.toml"), "-o", path(output)};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    }
    std::vector<std::string> lines(const std::string& output) const {
        std::vector<std::string> all;
        std::ifstream file(folder_ / output / "results.jsonl");
        for (std::string line; std::getline(file, line);) all.push_back(line);
        std::sort(all.begin(), all.end());
        return all;
    }

    fs::path folder_;
};

TEST_F(Sweep, KilledAtAnyMomentItLosesNothingAndCountsNothingTwice) {
    const auto begun = Clock::now();
    ASSERT_EQ(run(sweep("whole")), 0) << contents("err");
    const auto whole_run = Clock::now() - begun;
    const std::vector<std::string> whole = lines("whole");
    ASSERT_EQ(whole.size(), 10u);
    EXPECT_THAT(contents("err"), HasSubstr("measured 10 of 10 cases"));

    const unsigned seed = std::random_device{}();
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937 dice(seed);
    std::uniform_real_distribution<double> share(0, 1);
    int killed = 0;
    std::size_t before = 0;
    for (int attempt = 0; attempt < 20; ++attempt) {
        const pid_t child = start(sweep("killed"));
        std::this_thread::sleep_for(whole_run * share(dice));
        kill(child, SIGKILL);
        killed += finish(child) == -1 ? 1 : 0;
        // Whatever was there is still there; the last line may be torn.
        const std::size_t now = lines("killed").size();
        EXPECT_GE(now, before);
        before = now;
        if (now < whole.size()) continue;
        EXPECT_EQ(run(sweep("killed")), 0);
        EXPECT_EQ(contents("killed/results.jsonl"), contents("whole/results.jsonl"));
        fs::remove_all(folder_ / "killed");
        before = 0;
    }
    EXPECT_GE(killed, 5) << "most runs were to be killed before their end";
    ASSERT_EQ(run(sweep("killed")), 0) << contents("err");
    EXPECT_EQ(contents("killed/results.jsonl"), contents("whole/results.jsonl"));
    EXPECT_EQ(contents("killed/sweep.json"), contents("whole/sweep.json"));
}

TEST_F(Sweep, TwoShardsMergedAreOneRun) {
    ASSERT_EQ(run(sweep("whole", {"-j", "3"})), 0) << contents("err");
    ASSERT_EQ(run(sweep("first", {"--shard", "1/2"})), 0) << contents("err");
    ASSERT_EQ(run({"merge", path("first"), "-o", path("merged")}), 0) << contents("err");
    EXPECT_LT(lines("merged").size(), lines("whole").size());
    ASSERT_EQ(run(sweep("second", {"--shard", "2/2"})), 0) << contents("err");
    EXPECT_EQ(lines("first").size() + lines("second").size(), lines("whole").size());
    EXPECT_GT(lines("first").size(), 0u);
    ASSERT_EQ(run({"merge", path("first"), path("second"), "-o", path("merged")}), 0)
        << contents("err");
    EXPECT_THAT(contents("err"), HasSubstr("10 of 10 cases"));
    for (const char* file : {"/results.jsonl", "/sweep.json"})
        EXPECT_EQ(contents(std::string("merged") + file), contents(std::string("whole") + file));
    // Shards may also come one after the other in the same folder.
    ASSERT_EQ(run(sweep("first", {"--shard", "2/2"})), 0) << contents("err");
    EXPECT_EQ(contents("first/results.jsonl"), contents("whole/results.jsonl"));

    write("4");
    ASSERT_EQ(run(sweep("second", {"--shard", "2/2"})), 0) << contents("err");
    EXPECT_EQ(run({"merge", path("first"), path("second"), "-o", path("other")}), 2);
    EXPECT_THAT(contents("err"), HasSubstr("[merge-different]"));
    EXPECT_EQ(run({"merge", path("nowhere"), "-o", path("other")}), 2);
    EXPECT_THAT(contents("err"), HasSubstr("[sweep-manifest]"));
}

TEST_F(Sweep, MeasuresWhatChangedAndNothingElse) {
    ASSERT_EQ(run(sweep("out")), 0) << contents("err");
    const std::vector<std::string> first = lines("out");
    const auto written = fs::last_write_time(folder_ / "out/results.jsonl");
    ASSERT_EQ(run(sweep("out")), 0);
    EXPECT_THAT(contents("err"), HasSubstr("nothing to do: all 10 cases are in"));
    EXPECT_EQ(fs::last_write_time(folder_ / "out/results.jsonl"), written);

    write("2, 3");
    ASSERT_EQ(run(sweep("out")), 0);
    EXPECT_THAT(contents("err"), HasSubstr("measured 4 of 14 cases, 10 were there"));
    write("3");
    ASSERT_EQ(run(sweep("out")), 0);
    EXPECT_THAT(contents("err"), HasSubstr("dropped 4 results"));
    EXPECT_THAT(contents("err"), HasSubstr("nothing to do: all 10 cases"));
    write("2");
    ASSERT_EQ(run(sweep("out")), 0);
    EXPECT_EQ(lines("out"), first);
}

TEST_F(Sweep, SaysWhatIsWrong) {
    const auto refused = [&](const std::string& more, const std::string& code) {
        write("2", more);
        EXPECT_EQ(run(sweep("bad")), 2) << code;
        EXPECT_THAT(contents("err"), HasSubstr("[" + code + "]"));
        EXPECT_THAT(contents("err"), HasSubstr("sweep.toml:")) << "with its place";
        EXPECT_FALSE(fs::exists(folder_ / "bad")) << "and nothing is written";
    };
    refused("arithmetics = [\"fp23\"]\n", "unknown-arithmetic");
    refused("[[variant]]\nsurface = \"paralax\"\ntargets = [\"glsl_450\"]\n", "unknown-surface");
    refused("[[variant]]\nsurface = \"relief\"\ntargets = [\"glsl_451\"]\n", "unknown-target");
    refused("[[variant]]\nsurface = \"relief\"\ntargets = [\"glsl_450\"]\nknobs = { steps = 3 }\n",
            "unknown-knob");
    refused("[relief]\nscale = [0.1, 2]\n", "scene-range");
    refused("[view]\n", "scene-unknown-key");
    write("2");
    for (const char* shard : {"0/2", "3/2", "1", "1/2/3", "a/b"}) {
        EXPECT_EQ(run(sweep("bad", {"--shard", shard})), 2) << shard;
        EXPECT_THAT(contents("err"), HasSubstr("[shard-syntax]")) << shard;
    }
}

TEST_F(Sweep, SaysWhichVariantATargetRefuses) {
    write("2", "[[variant]]\nsurface = \"relief\"\ntargets = [\"ps_2_0\"]\n");
    ASSERT_EQ(run(sweep("out")), 0) << contents("err");
    EXPECT_THAT(contents("err"), HasSubstr("2 refused by their target"));
    int refused = 0;
    for (const std::string& line : lines("out"))
        refused += line.find("\"refused\":{\"code\":") != std::string::npos ? 1 : 0;
    EXPECT_EQ(refused, 2);
}

// What stands between two marks.
std::string between(const std::string& text, const std::string& begin, const std::string& end) {
    const std::size_t from = text.find(begin);
    if (from == std::string::npos) return {};
    const std::size_t start = from + begin.size();
    return text.substr(start, text.find(end, start) - start);
}

TEST_F(Sweep, TheWorstPixelsCommandShowsThePixel) {
    write("2",
          "[[variant]]\nsurface = \"parallax\"\ntargets = [\"glsl_450\"]\n"
          "arithmetics = [\"fp16\"]\n");
    ASSERT_EQ(run(sweep("out")), 0) << contents("err");
    std::set<std::string> makers;
    for (const std::string& line : lines("out")) {
        const std::string maker =
            between(line, "\"made_by\":\"", "\"") + between(line, "\"arithmetic\":\"", "\"");
        if (!makers.insert(maker).second) continue;
        const std::string worst = between(line, "\"worst\":", "}");
        const std::string command = between(worst, "\"command\":\"intaglio", "\"");
        const std::string shell = "cd '" + folder_.string() + "' && '" INTAGLIO_TOOL "'" + command +
                                  " 2> said </dev/null";
        EXPECT_EQ(std::system(shell.c_str()), 0) << command << contents("said");
        const double expected = std::strtod(between(worst, "\"texels\":", ",").c_str(), nullptr);
        EXPECT_GT(expected, 0) << line;
        const std::string said = between(contents("said"), "reported (", "texels off");
        EXPECT_EQ(std::strtod(between(said, "): ", " ").c_str(), nullptr), expected) << command;
        const std::string pixel = between(worst, "\"pixel\":[", "]");
        EXPECT_THAT(contents("said"), HasSubstr("pixel (" + between("," + pixel, ",", ",") + ", "));
        EXPECT_TRUE(fs::exists(folder_ / "picture.png"));
        EXPECT_TRUE(fs::exists(folder_ / "errors.png"));
    }
    EXPECT_THAT(makers,
                testing::UnorderedElementsAre("devicefp32", "evaluatorfp16", "interpreterfp32",
                                              "interpreterfp24", "interpreterfp16"));
}

}  // namespace
