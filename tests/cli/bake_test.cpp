// `intaglio bake`, and its files given to `run`, `measure` and scenes.
#include "tests/cli/command_line.h"

#include "src/maps/provenance.h"

namespace intaglio::cli {
namespace {

class Bake : public CommandLine {
  protected:
    // A picture of a surface that reads baked maps.
    Outcome draw(const std::string& surface, const std::string& picture,
                 const std::vector<std::string>& more = {},
                 const std::string& map = "wall.png") const {
        std::vector<std::string> arguments = {"run",      surface,   "-T",     "glsl_450",
                                              "--height", path(map), "--mesh", "map",
                                              "--size",   "32x32",   "-o",     path(picture)};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(arguments);
    }
    std::string baked(const std::string& kind, const std::string& file) const {
        return kind + "=" + path(file);
    }
};

TEST_F(Bake, WritesEveryKindOfMap) {
    write_map("height.png", "cobbles", 32, 16);
    EXPECT_EQ(
        run({"bake", "normal", path("height.png"), "-o", path("normal.png"), "--keep-height"}).code,
        0);
    const auto normals = maps::read_png(path("normal.png"));
    ASSERT_TRUE(normals.ok());
    EXPECT_EQ(normals->channels, 4);
    for (const char* kind : {"cone", "relaxed-cone", "max-mip", "summit", "patch", "horizon",
                             "distance", "view-dependent"})
        EXPECT_EQ(run({"bake", kind, path("height.png"), "-o", path("baked.png")}).code, 0) << kind;
    EXPECT_EQ(run({"bake", "phong", "--size", "64x64", "-o", path("phong.png")}).code, 0);
    expect_refused({"bake", "horizon", path("height.png"), "-o", path("h.png"), "--azimuths", "7"},
                   "azimuths-range");
    expect_refused({"bake", "normal", path("height.png"), "-o", path("n.png"), "--kernel", "box"},
                   "option-value");
    expect_refused({"bake", "normal", path("missing.png"), "-o", path("n.png")}, "file-missing");
}

TEST_F(Bake, SaysInTheFileWhatItIsOf) {
    write_map("wall.png", "cobbles", 32, 16);
    EXPECT_EQ(run({"bake", "horizon", path("wall.png"), "-o", path("h.png"), "-j", "1"}).code, 0);
    const auto file = maps::read_baked(path("h.png"));
    ASSERT_TRUE(file.ok() && file->from);
    EXPECT_EQ(file->from->kind, "horizon");
    EXPECT_EQ(maps::to_string(file->from->settings), "azimuths=8");
    EXPECT_EQ(file->from->source, "wall.png");
    EXPECT_EQ(file->from->heights, maps::fingerprint(*maps::read_png(path("wall.png"))));
    // The same bytes with any number of threads, from a file or from the maker.
    const std::string bytes = contents(path("h.png"));
    EXPECT_EQ(run({"bake", "horizon", path("wall.png"), "-o", path("h.png"), "-j", "3"}).code, 0);
    EXPECT_EQ(contents(path("h.png")), bytes);
    EXPECT_EQ(
        run({"bake", "cone", "--maker", "cobbles", "--map-size", "32x16", "-o", path("cone.png")})
            .code,
        0);
    EXPECT_EQ(maps::read_baked(path("cone.png"))->from->source, "--maker cobbles --map-size 32x16");
    expect_refused({"bake", "cone", "-o", path("cone.png")}, "no-map");
}

TEST_F(Bake, FilesDrawTheSamePictureAsBakesInMemory) {
    write_map("wall.png", "bricks", 32, 32);
    const std::string surface = "search=cone_relaxed,shadow=horizon,shading=phong_map";
    const std::vector<std::vector<std::string>> bakes = {{"relaxed-cone", "cone.png"},
                                                         {"horizon", "horizon.png"}};
    std::vector<std::string> given = {"-D", "shininess=20"};
    EXPECT_EQ(draw(surface, "memory.png", given).code, 0);
    for (const auto& bake : bakes) {
        EXPECT_EQ(run({"bake", bake[0], path("wall.png"), "-o", path(bake[1])}).code, 0);
        given.insert(given.end(), {"--baked", baked(bake[0], bake[1])});
    }
    EXPECT_EQ(run({"bake", "phong", "--shininess", "20", "-o", path("phong.png")}).code, 0);
    given.insert(given.end(), {"--baked", baked("phong", "phong.png")});
    const Outcome outcome = draw(surface, "files.png", given);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(contents(path("files.png")), contents(path("memory.png")));

    // The knob is what the bake has to be.
    given[1] = "shininess=21";
    EXPECT_THAT(draw(surface, "other.png", given).err,
                testing::AllOf(HasSubstr("[bake-settings]"),
                               HasSubstr("intaglio bake phong --shininess 21 -o")));
    EXPECT_FALSE(fs::exists(path("other.png")));
}

TEST_F(Bake, WrongPairingsAreRefusedAndLeaveNoPicture) {
    write_map("wall.png", "bricks", 32, 32);
    write_map("other.png", "noise", 32, 32);
    EXPECT_EQ(run({"bake", "cone", path("wall.png"), "-o", path("cone.png")}).code, 0);
    const auto refused = [&](const char* surface, const std::string& option, const char* map,
                             const char* code) {
        const Outcome outcome = draw(surface, "picture.png", {"--baked", option}, map);
        EXPECT_EQ(outcome.code, 2);
        EXPECT_THAT(outcome.err, HasSubstr(std::string("[") + code + "]")) << outcome.err;
        EXPECT_FALSE(fs::exists(path("picture.png")));
        return outcome.err;
    };
    EXPECT_THAT(refused("search=cone", baked("cone", "cone.png"), "other.png", "bake-heights"),
                testing::AllOf(HasSubstr("cone.png"), HasSubstr("baked from wall.png"),
                               HasSubstr("intaglio bake cone '" + path("other.png"))));
    refused("search=cone_relaxed", baked("relaxed-cone", "cone.png"), "wall.png", "bake-kind");
    refused("search=relief", baked("cone", "cone.png"), "wall.png", "bake-unread");
    refused("search=cone", baked("cone", "wall.png"), "wall.png", "bake-unknown");
    refused("search=cone", baked("cone", "missing.png"), "wall.png", "file-missing");
    EXPECT_THAT(refused("search=cone", baked("cones", "cone.png"), "wall.png", "unknown-bake"),
                HasSubstr("did you mean 'cone'"));
    refused("search=cone", "cone.png", "wall.png", "baked-syntax");
    expect_refused(
        {"run", "search=cone", "-T", "glsl_450", "--height", path("wall.png"), "--normal",
         path("n.png"), "--baked", baked("normal", "n.png"), "-o", path("picture.png")},
        "option-value");
}

TEST_F(Bake, ScenesAndMeasureTakeFiles) {
    write_map("wall.png", "bricks", 16, 16);
    write_map("other.png", "noise", 16, 16);
    EXPECT_EQ(run({"bake", "cone", path("wall.png"), "-o", path("cone.png")}).code, 0);
    const auto scene = [&](const std::string& map) {
        write("scene.toml", "[run]\nsize = 16\nrounds = 0\n[views]\nelevations = 45\n[[map]]\n" +
                                map +
                                "\n[[variant]]\nsurface = 'search=cone'\ntargets = "
                                "['glsl_450']\n");
        return std::vector<std::string>{"measure", path("scene.toml"), "-o", path("measured")};
    };
    EXPECT_EQ(run(scene("height_map = 'wall.png'\nbaked = { cone = 'cone.png' }")).code, 0);
    EXPECT_THAT(expect_refused(scene("height_map = 'other.png'\nbaked = { cone = 'cone.png' }"),
                               "bake-heights")
                    .err,
                HasSubstr("scene.toml:6:1"));
    EXPECT_THAT(expect_refused(scene("height_map = 'wall.png'\nbaked = { cnoe = 'cone.png' }"),
                               "unknown-bake")
                    .err,
                HasSubstr("scene.toml:8:11"));
    // In place of the scene's maps, with the option.
    std::vector<std::string> own = scene("maker = 'flat1'");
    own.insert(own.end(), {"--height", path("wall.png"), "--baked", baked("cone", "cone.png")});
    EXPECT_EQ(run(own).code, 0);
    own[own.size() - 3] = path("other.png");
    expect_refused(own, "bake-heights");
    own.erase(own.end() - 4, own.end() - 2);
    expect_refused(own, "usage");
}

TEST_F(Bake, AnInterruptedWriteLeavesWhatWasThere) {
    write_map("wall.png", "noise", 64, 64);
    write("kept.png", "what was there before");
    const auto files = [&] {
        int count = 0;
        for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder_)) ++count;
        return count;
    };
    run({"list"});  // for its two outputs
    const int before = files();
    // The system refuses the bytes after the first kilobyte; the signal is ignored, as a full disk
    // sends none.
    const std::string limit = "trap '' XFSZ; ulimit -f 2;";
    for (const char* file : {"kept.png", "new.png"}) {
        const Outcome outcome = run({"bake", "horizon", path("wall.png"), "-o", path(file)}, limit);
        EXPECT_EQ(outcome.code, 2) << outcome.err;
        EXPECT_THAT(outcome.err, HasSubstr("[file-unwritable]"));
    }
    EXPECT_EQ(contents(path("kept.png")), "what was there before");
    EXPECT_EQ(files(), before) << "a temporary file or half a map was left";
}

TEST_F(Bake, ProgressIsForTerminals) {
    // Long enough to be seen: the worst map for relaxed cones.
    write_map("smooth.png", "smooth", 128, 128);
    const std::vector<std::string> bake = {
        "bake", "relaxed-cone", path("smooth.png"), "-o", path("cone.png"), "-j", "1"};
    EXPECT_EQ(run(bake).err, "");
    write("bake.sh", "'" INTAGLIO_TOOL "' bake relaxed-cone smooth.png -o cone.png -j 1");
    const std::string terminal =
        "cd '" + folder_.string() + "' && script -qec 'sh bake.sh' /dev/null >screen </dev/null";
    EXPECT_EQ(std::system(terminal.c_str()), 0);
    EXPECT_THAT(contents(path("screen")), HasSubstr(" of 128 rows"));
}

}  // namespace
}  // namespace intaglio::cli
