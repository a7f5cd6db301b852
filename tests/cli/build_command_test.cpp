// `intaglio build` as build systems run it: killed, twice at once, on disks that refuse, by Ninja.
#include <fcntl.h>
#include <signal.h>

#include <chrono>
#include <map>
#include <random>
#include <thread>

#include "src/maps/files.h"
#include "tests/cli/command_line.h"

namespace intaglio::cli {
namespace {

using maps::shell_quoted;
using testing::AllOf;

class BuildCommand : public CommandLine {
  protected:
    void SetUp() override {
        CommandLine::SetUp();
        write_scene("quay.png");
        write_map("quay.png", "bricks", 16, 16);
        write_map(wall_map, "smooth", 16, 16);
    }
    static void TearDownTestSuite() { fs::remove_all(shared_cache()); }

    // A name that makefiles trip over.
    static constexpr const char* wall_map = "wall #2: 50% a$b.png";

    // What no test says otherwise of is made once.
    static std::string shared_cache() {
        return (fs::temp_directory_path() / ("intaglio cache " + std::to_string(getpid())))
            .string();
    }

    // A language whose front end starts fast.
    void write_scene(const std::string& quay) const {
        const auto surface = [](const std::string& name, const std::string& map,
                                const std::string& search) {
            return "[[surface]]\nname = '" + name + "'\nheight_map = '" + map + "'\nsearch = '" +
                   search +
                   "'\nshadow = 'none'\nnormal = 'map'\nshading = 'lambert'\noutput = 'colour'\n"
                   "vertex = 'tangent_space'\n";
        };
        write("harbour.toml",
              "name = 'harbour'\ntargets = ['essl_100']\n[tolerance]\np95 = 100\n"
              "[[light]]\nname = 'sun'\nelevation = 45\nazimuth = 20\n" +
                  surface("quay", quay, "parallax") + surface("wall", wall_map, "max_mip"));
    }

    std::vector<std::string> build(const std::string& output,
                                   const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words = {
            "build", path("harbour.toml"), "-o", path(output), "--cache", cache_};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }

    pid_t start(const std::vector<std::string>& arguments) const {
        const pid_t child = fork();
        if (child != 0) return child;
        const int err = open(path("child.err").c_str(), O_WRONLY | O_CREAT | O_APPEND, 0666);
        dup2(err, STDERR_FILENO);
        std::vector<char*> words;
        static char tool[] = INTAGLIO_TOOL;
        words.push_back(tool);
        for (const std::string& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
        words.push_back(nullptr);
        execv(tool, words.data());
        _exit(127);
    }
    static int wait_for(pid_t child) {
        int status = 0;
        waitpid(child, &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    }

    // By name, without the build's own state.
    std::map<std::string, std::string> built(const std::string& output) const {
        std::map<std::string, std::string> files;
        if (!fs::exists(folder_ / output)) return files;
        for (const auto& entry : fs::recursive_directory_iterator(folder_ / output)) {
            const std::string name = entry.path().lexically_relative(folder_ / output).string();
            if (entry.is_regular_file() && name.rfind(".intaglio", 0) != 0)
                files[name] = contents(entry.path());
        }
        return files;
    }
    // Without a cache, in a fresh folder.
    std::map<std::string, std::string> built_alone() const {
        fs::remove_all(folder_ / "alone");
        const Outcome outcome =
            run({"build", path("harbour.toml"), "-o", path("alone"), "--no-cache"});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return built("alone");
    }

    // As it stands with either map, made from nothing, once.
    const std::map<std::string, std::string>& first() const {
        static const auto files = built_from("quay.png");
        return files;
    }
    const std::map<std::string, std::string>& second() const {
        static const auto files = built_from(wall_map);
        return files;
    }
    std::map<std::string, std::string> built_from(const std::string& quay) const {
        write_scene(quay);
        const auto files = built_alone();
        EXPECT_EQ(run(build("warm")).code, 0);
        fs::remove_all(folder_ / "warm");
        write_scene("quay.png");
        return files;
    }

    // Until the child's first new file is there, or the child is gone.
    void wait_for_writing(pid_t child) const {
        const std::string mark = "." + std::to_string(child) + ".";
        siginfo_t gone{};
        while (waitid(P_PID, static_cast<id_t>(child), &gone, WEXITED | WNOHANG | WNOWAIT) == 0 &&
               gone.si_pid == 0) {
            std::error_code none_yet;
            for (fs::directory_iterator it(folder_ / "made/.intaglio", none_yet), end; it != end;
                 it.increment(none_yet))
                if (it->path().filename().string().find(mark) != std::string::npos) return;
        }
    }

    std::string cache_ = shared_cache();

    int shell(const std::string& command) const {
        const int status =
            std::system((command + " >" + shell_quoted(path("log")) + " 2>&1 </dev/null").c_str());
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
};

TEST_F(BuildCommand, SaysWhatItDidAndNothingOnStdout) {
    const Outcome first = run(build("made"));
    EXPECT_EQ(first.code, 0) << first.err;
    EXPECT_EQ(first.out, "");
    EXPECT_THAT(first.err, HasSubstr("2 variants of 2 surfaces"));
    const Outcome again = run(build("made"));
    EXPECT_THAT(again.err, HasSubstr("nothing to do"));
    const Outcome list = run({"build", path("harbour.toml"), "--list-outputs"});
    EXPECT_EQ(list.code, 0);
    std::istringstream lines(list.out);
    for (std::string name; std::getline(lines, name);)
        EXPECT_TRUE(built("made").contains(name)) << name;
    EXPECT_THAT(list.out, AllOf(HasSubstr("quay.h\n"), HasSubstr("wall.essl_100.frag\n"),
                                HasSubstr("manifest.json\n")));
}

TEST_F(BuildCommand, RefusesWithASentence) {
    expect_refused({"build", path("harbour.toml")}, "usage");
    expect_refused({"build", "-o", path("made")}, "usage");
    expect_refused(build("made", {"--targets", "glsl_451"}), "unknown-target");
    expect_refused(build("made", {"--namespace", "1st"}), "namespace-syntax");
    expect_refused({"cache", "prune", "many", "--cache", path("cache")}, "size-syntax");
    expect_refused({"build", "--order", path("harbour.toml"), "-o", path("made")}, "order-syntax");
    EXPECT_FALSE(fs::exists(folder_ / "made"));
}

TEST_F(BuildCommand, TheDepfileIsReadByMakeAndByNinja) {
    ASSERT_EQ(run(build("made", {"-MD", "-MF", path("made.d")})).code, 0);
    const std::string text = contents(folder_ / "made.d");
    for (const char* name :
         {"harbour.toml", "quay.png", "wall\\ \\#2\\:\\ 50%\\ a$$b.png", "intaglio"})
        EXPECT_THAT(text, HasSubstr(name));
    // Make says whether the manifest is up to date with what the depfile lists.
    write("Makefile", "-include made.d\n%manifest.json:\n\t@false\n");
    const std::string make = "make -q -C " + shell_quoted(folder_.string()) + " " +
                             shell_quoted(path("made/manifest.json"));
    EXPECT_EQ(shell(make), 0) << contents(folder_ / "log");
    fs::last_write_time(folder_ / wall_map,
                        fs::file_time_type::clock::now() + std::chrono::hours(1));
    EXPECT_EQ(shell(make), 1) << "a map is newer";

    ASSERT_EQ(run(build("made", {"-MD", "-MF", path("made.d"), "-MT", "made/manifest.json"})).code,
              0);
    write("build.ninja",
          "rule keep\n  command = touch -d '+2 hours' $out\n  depfile = made.d\n"
          "build made/manifest.json: keep\n");
    const std::string ninja = "ninja -d explain -C " + shell_quoted(folder_.string());
    ASSERT_EQ(shell(ninja), 0) << contents(folder_ / "log");
    ASSERT_EQ(shell(ninja), 0);
    EXPECT_THAT(contents(folder_ / "log"), HasSubstr("no work to do"));
    fs::last_write_time(folder_ / wall_map,
                        fs::file_time_type::clock::now() + std::chrono::hours(3));
    ASSERT_EQ(shell(ninja), 0);
    EXPECT_THAT(contents(folder_ / "log"), HasSubstr("most recent input " + path(wall_map)));
}

// The folder is at every moment whole: what is there is of the old build or of the new one.
TEST_F(BuildCommand, KilledAtAnyMomentItLeavesNoHalfWrittenFile) {
    ASSERT_NE(first(), second());
    const auto seed = std::random_device{}();
    std::printf("seed %u\n", seed);
    std::mt19937 random(seed);
    // How long an undisturbed one takes, with the cache as most of the killed ones find it.
    const auto begun = std::chrono::steady_clock::now();
    ASSERT_EQ(run(build("made")).code, 0);
    const std::chrono::duration<double> whole = std::chrono::steady_clock::now() - begun;
    const std::chrono::duration<double> short_while = std::chrono::milliseconds(1);
    std::uniform_real_distribution<double> part(0.0, 1.2);
    int killed = 0;
    for (int i = 0; i < 20; ++i) {
        write_scene(i % 2 == 0 ? wall_map : "quay.png");
        // Some write into a cache as well, and find what others left there.
        cache_ = i % 5 == 4 ? path("cache") : shared_cache();
        const pid_t child = start(build("made"));
        // Every third while it writes, which is a short part of the whole.
        if (i % 3 == 2) wait_for_writing(child);
        std::this_thread::sleep_for((i % 3 == 2 ? short_while : whole) * part(random));
        kill(child, SIGKILL);
        killed += wait_for(child) == -SIGKILL ? 1 : 0;
        for (const auto& [name, bytes] : built("made"))
            EXPECT_TRUE((first().contains(name) && first().at(name) == bytes) ||
                        (second().contains(name) && second().at(name) == bytes))
                << name << " is of neither build";
    }
    EXPECT_GT(killed, 0);
    write_scene(wall_map);
    cache_ = path("cache");
    EXPECT_EQ(run(build("made")).code, 0);
    EXPECT_EQ(built("made"), second());
    std::size_t temporaries = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / "made"))
        temporaries += entry.path().extension() == ".tmp" ? 1 : 0;
    EXPECT_EQ(temporaries, 0u);
}

TEST_F(BuildCommand, TwoAtOnceIntoOneFolderAndOneCache) {
    const auto& alone = first();
    cache_ = path("cache");
    const pid_t a = start(build("made")), b = start(build("made")), c = start(build("other"));
    EXPECT_EQ(wait_for(a), 0);
    EXPECT_EQ(wait_for(b), 0);
    EXPECT_EQ(wait_for(c), 0);
    EXPECT_EQ(built("made"), alone);
    EXPECT_EQ(built("other"), alone);
}

TEST_F(BuildCommand, AFullDiskIsSaidAndTheOldFilesStay) {
    ASSERT_EQ(run(build("made", {"--no-cache"})).code, 2) << "--cache and --no-cache";
    const std::vector<std::string> plain = build("made");
    ASSERT_EQ(run(plain).code, 0);
    const auto before = built("made");
    EXPECT_EQ(before, first());
    second();  // in the cache
    write_scene(wall_map);
    const std::string disk = "ASAN_OPTIONS=verify_asan_link_order=0 LD_PRELOAD='" INTAGLIO_FULL_DISK
                             "' INTAGLIO_DISK_BYTES=";
    for (const char* room : {"0", "100", "20000"}) {
        const Outcome outcome = run(plain, disk + room);
        EXPECT_EQ(outcome.code, 2);
        EXPECT_THAT(outcome.err,
                    AllOf(HasSubstr("the disk is full"), HasSubstr("file-unwritable")));
        EXPECT_EQ(built("made"), before);
    }
    // A limit of the system on files, without any help.
    const Outcome limited = run(plain, "trap '' XFSZ; ulimit -f 1;");
    EXPECT_EQ(limited.code, 2) << limited.err;
    EXPECT_EQ(built("made"), before);
    EXPECT_EQ(run(plain).code, 0);
    EXPECT_EQ(built("made"), second());
}

TEST_F(BuildCommand, AFullOrReadOnlyCacheIsSaidAndTheBuildGoesOn) {
    cache_ = path("cache");
    const auto& alone = first();
    const std::string preload =
        "ASAN_OPTIONS=verify_asan_link_order=0 LD_PRELOAD='" INTAGLIO_FULL_DISK "' ";
    const Outcome outcome =
        run(build("made"), preload + "INTAGLIO_DISK_READ_ONLY=" + shell_quoted(path("cache")));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("note: nothing is kept in the cache"));
    EXPECT_EQ(built("made"), alone);
}

TEST_F(BuildCommand, AReadOnlyFolderIsSaidUnlessNothingIsToDo) {
    const std::string read_only =
        "ASAN_OPTIONS=verify_asan_link_order=0 LD_PRELOAD='" INTAGLIO_FULL_DISK
        "' INTAGLIO_DISK_READ_ONLY=" +
        shell_quoted(path("made"));
    const Outcome refused = run(build("made"), read_only);
    EXPECT_EQ(refused.code, 2) << refused.err;
    EXPECT_THAT(refused.err, HasSubstr("[file-unwritable]"));
    ASSERT_EQ(run(build("made")).code, 0);
    const Outcome nothing = run(build("made"), read_only);
    EXPECT_EQ(nothing.code, 0) << nothing.err;
    EXPECT_THAT(nothing.err, HasSubstr("nothing to do"));
}

TEST_F(BuildCommand, NinjaBuildsTheSameAndThenOnlyWhatChanged) {
    const auto alone = first();
    ASSERT_EQ(run(build("made", {"--ninja", path("build.ninja")})).code, 0);
    EXPECT_FALSE(fs::exists(folder_ / "made/manifest.json"));
    const std::string ninja = "ninja -j2 -v -C " + shell_quoted(folder_.string());
    ASSERT_EQ(shell(ninja), 0) << contents(folder_ / "log");
    EXPECT_EQ(built("made"), alone);
    EXPECT_EQ(shell(ninja), 0);
    EXPECT_THAT(contents(folder_ / "log"), HasSubstr("no work to do"));
    const auto log = [&] { return contents(folder_ / "log"); };
    // A map that is as it was, with another time: no shader and no header is made.
    fs::last_write_time(folder_ / "quay.png", fs::file_time_type::clock::now());
    ASSERT_EQ(shell(ninja), 0) << log();
    EXPECT_THAT(log(), AllOf(HasSubstr("--step orders"), Not(HasSubstr("--order ")),
                             Not(HasSubstr("--surface "))));
    // Another map for one surface: the other one's steps do not run.
    write_map("quay.png", "cobbles", 16, 16);
    ASSERT_EQ(shell(ninja), 0) << log();
    EXPECT_THAT(log(), AllOf(HasSubstr("--surface quay"), Not(HasSubstr("--surface wall")),
                             Not(HasSubstr("wall.essl_100.order.json' -o"))));
    EXPECT_EQ(shell(ninja), 0);
    EXPECT_THAT(log(), HasSubstr("no work to do"));
    // The same of the other one, of whose map a search wants another.
    write_map(wall_map, "noise", 16, 16);
    ASSERT_EQ(shell(ninja), 0) << log();
    EXPECT_THAT(log(), AllOf(HasSubstr("--surface wall"), Not(HasSubstr("--surface quay"))));
    EXPECT_EQ(built("made"), built_alone());
    // A baked map is an output like any other: without it, it is made again, and nothing else.
    const auto whole = built("made");
    ASSERT_TRUE(fs::remove(folder_ / "made/wall.max-mip.png"));
    ASSERT_EQ(shell(ninja), 0) << log();
    EXPECT_THAT(log(), AllOf(HasSubstr("--step maps"), Not(HasSubstr("--order ")),
                             Not(HasSubstr("--surface ")), Not(HasSubstr("--step orders"))));
    EXPECT_EQ(built("made"), whole);
    EXPECT_EQ(shell(ninja), 0);
    EXPECT_THAT(log(), HasSubstr("no work to do"));
}

TEST_F(BuildCommand, TheCacheIsPruned) {
    cache_ = path("cache");
    ASSERT_EQ(run(build("made")).code, 0);
    const Outcome pruned = run({"cache", "prune", "0", "--cache", path("cache")});
    EXPECT_EQ(pruned.code, 0) << pruned.err;
    EXPECT_THAT(pruned.out, HasSubstr("0 kept (0 bytes)"));
    const Outcome again = run(build("made again"));
    EXPECT_THAT(again.err, HasSubstr("0 from the cache"));
}

}  // namespace
}  // namespace intaglio::cli
