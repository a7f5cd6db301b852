// The program as people use it: products on stdout or whole in files, sentences on stderr,
// documented exit codes.
#include "tests/cli/command_line.h"

namespace intaglio::cli {
namespace {

TEST_F(CommandLine, ListsWhatThereIs) {
    EXPECT_THAT(run({"list"}).out, HasSubstr("steep_parallax"));
    EXPECT_THAT(run({"list", "targets"}).out, HasSubstr("hlsl_3_0"));
    EXPECT_THAT(run({"list", "knobs"}).out, HasSubstr("shadow_max_steps"));
    EXPECT_THAT(run({"list", "maps"}).out, HasSubstr("bricks"));
    for (const char* what : {"techniques", "targets", "knobs", "maps"})
        EXPECT_THAT(run({"list", what, "--json"}).out, HasSubstr("\"name\""));
    EXPECT_THAT(expect_refused({"list", "tagrets"}, "unknown-list").err,
                HasSubstr("did you mean 'targets'"));
}

TEST_F(CommandLine, EmitsToStdoutOrToAFile) {
    const Outcome on_stdout = run({"emit", "parallax_occlusion", "-T", "glsl_450"});
    EXPECT_EQ(on_stdout.code, 0);
    EXPECT_EQ(on_stdout.err, "");
    EXPECT_THAT(on_stdout.out,
                HasSubstr("// Intersect the ray with the last segment of the profile."));
    EXPECT_EQ(run({"emit", "parallax_occlusion", "-T", "glsl_450", "-o", path("shader.frag")}).out,
              "");
    EXPECT_EQ(contents(path("shader.frag")), on_stdout.out);
    EXPECT_THAT(run({"emit", "parallax_occlusion", "-T", "hlsl_5_0", "--stage", "vertex"}).out,
                HasSubstr("vertex_main"));
    EXPECT_THAT(run({"emit", "parallax_occlusion", "-T", "glsl_450", "-D", "taps=12"}).out,
                HasSubstr("taps = 12"));
}

TEST_F(CommandLine, EmitsBinariesWholeAndMetalText) {
    EXPECT_EQ(run({"emit", "fur", "-T", "spirv", "-o", path("fur.spv")}).code, 0);
    EXPECT_EQ(contents(path("fur.spv")).substr(0, 4), "\x03\x02\x23\x07")
        << "SPIR-V's magic number";
    EXPECT_THAT(run({"emit", "fur", "-T", "msl"}).out, HasSubstr("metal_stdlib"));
}

TEST_F(CommandLine, EmitsFunctions) {
    EXPECT_THAT(run({"emit", "steep_parallax", "-T", "glsl_330", "--as", "function"}).out,
                HasSubstr("vec3 find(vec2 uv, vec3 view, sampler2D height_map"));
    EXPECT_THAT(run({"emit", "steep_parallax,shadow=march", "-T", "glsl_330", "--as", "function",
                     "--part", "shadow", "--bind", "globals"})
                    .out,
                HasSubstr("float visibility(vec2 uv, float height, vec3 light) {"));
    expect_refused({"emit", "steep_parallax", "-T", "spirv", "--as", "function"},
                   "target-function");
}

TEST_F(CommandLine, EmitsAssemblyAndBytecode) {
    const std::string surface = "parallax_occlusion,output=displaced";
    const Outcome text = run({"emit", surface, "-T", "ps_2_0"});
    EXPECT_EQ(text.code, 0) << text.err;
    EXPECT_THAT(text.out, HasSubstr("\nps_2_0\n// uniform float1 scale : c0\n"));
    EXPECT_THAT(text.out, HasSubstr("of 64   arithmetic slots\n"));
    EXPECT_THAT(text.out,
                HasSubstr("// Walk down the ray until a sample of the height profile rises above"));
    EXPECT_THAT(text.err, HasSubstr("note: height_map is read by texld"));
    const Outcome bytes =
        run({"emit", surface, "-T", "ps_2_0", "--as", "bytecode", "-o", path("p.pso")});
    EXPECT_EQ(bytes.code, 0) << bytes.err;
    EXPECT_EQ(contents(path("p.pso")).substr(0, 4), std::string("\x00\x02\xff\xff", 4));
    EXPECT_THAT(run({"emit", surface, "-T", "ps_3_0", "--stage", "vertex"}).out,
                HasSubstr("\nvs_3_0\n"));
    EXPECT_THAT(run({"emit", surface, "-T", "vs_2_0"}).out, HasSubstr("\nvs_2_0\n"));
}

TEST_F(CommandLine, RefusesWhatAProfileHasNot) {
    const std::pair<std::vector<std::string>, const char*> cases[] = {
        {{"emit", "fur", "-T", "vs_2_0", "--stage", "pixel"},
         "error: vs_2_0 is a profile of vertex shaders; the pixel stage is that of ps_2_0, ps_2_a "
         "or ps_2_b [no-stage]\n"},
        {{"emit", "search=none", "-T", "ps_2_0", "--as", "function"},
         "error: ps_2_0 has no text to paste a function into [target-function]\n"},
        {{"emit", "search=none", "-T", "hlsl_2_0", "--as", "bytecode"},
         "error: hlsl_2_0 is text; bytecode is for the targets ps_*, vs_* and spirv "
         "[no-bytecode]\n"},
        {{"emit", "parallax_occlusion", "-T", "ps_2_0", "--loop", "march=loop"},
         "error: the loop march cannot stay a loop: ps_2_0 has none [target-limit]\n"},
        {{"run", "fur", "-T", "vs_3_0", "--maker", "fur", "-o", path("p.png")},
         "error: vs_3_0 is a vertex stage alone; run the surface on ps_3_0, which comes with it "
         "[not-runnable]\n"},
    };
    for (const auto& [arguments, sentence] : cases) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, 2);
        EXPECT_EQ(outcome.out, "");
        EXPECT_EQ(outcome.err, sentence);
    }
    const Outcome long_one = expect_refused(
        {"emit", "parallax_occlusion", "-T", "ps_2_0", "-D", "taps=16"}, "d3d9-limit");
    EXPECT_THAT(long_one.err, HasSubstr("arithmetic slots"));
    EXPECT_THAT(long_one.err, HasSubstr("more than the 64 it has for parallax_occlusion: the step "
                                        "'march' takes"));
    EXPECT_THAT(long_one.err, HasSubstr("templates/search/parallax_occlusion.cpp:"));
}

TEST_F(CommandLine, EmitsDrawsAndMeasuresPasses) {
    const std::vector<std::string> surface = {
        "parallax_occlusion", "-T", "ps_2_0", "-D", "taps=4", "--split", "shading"};
    const auto with = [&](std::vector<std::string> start, const std::vector<std::string>& end) {
        start.insert(start.end(), surface.begin(), surface.end());
        start.insert(start.end(), end.begin(), end.end());
        return run(start);
    };
    const Outcome unnamed = with({"emit"}, {});
    EXPECT_EQ(unnamed.code, 2);
    EXPECT_THAT(unnamed.err, HasSubstr("2: shading and output"));
    EXPECT_THAT(with({"emit"}, {"--pass", "2"}).out, HasSubstr("displaced_map"));
    EXPECT_EQ(with({"emit"}, {"--pass", "3"}).code, 2);
    EXPECT_EQ(with({"emit"}, {"-o", path("relief.asm")}).code, 0);
    EXPECT_THAT(contents(path("relief.pass1.asm")), HasSubstr("pass 1 of 2: search"));
    EXPECT_THAT(contents(path("relief.pass2.asm")), HasSubstr("pass 2 of 2: shading"));
    EXPECT_EQ(run({"emit", "bump", "-T", "none", "--pass", "1"}).code, 2) << "a pass of what";

    const std::vector<std::string> map = {"--maker", "cobbles", "--map-size", "32x32"};
    std::vector<std::string> drawn = {"--format", "rgba8", "--size", "32x32", "-o", path("p.png")};
    drawn.insert(drawn.end(), map.begin(), map.end());
    const Outcome picture = with({"run"}, drawn);
    EXPECT_EQ(picture.code, 0) << picture.err;
    EXPECT_THAT(picture.err, HasSubstr("rgba8 between 2 passes moves hits by"));
    EXPECT_TRUE(fs::exists(path("p.png")));

    std::vector<std::string> small = {"--size", "16"};
    small.insert(small.end(), map.begin(), map.end());
    const Outcome table = with({"split"}, small);
    EXPECT_EQ(table.code, 0) << table.err;
    for (const char* part : {"pass 1, search, shadow: ", "pass 2, shading and output: ", "ps_2_0: ",
                             "RGBA8 ", "RGBA16F ", "RGBA32F "})
        EXPECT_THAT(table.out, HasSubstr(part));
}

TEST_F(CommandLine, CostNamesTheMakerOfEachNumber) {
    const Outcome text = run({"cost", "fur", "-T", "glsl_450", "--chip", "polaris10"});
    EXPECT_EQ(text.code, 0) << text.err;
    EXPECT_THAT(text.out, HasSubstr("pixel stage: SPIR-V after SPIRV-Tools' optimiser\n"));
    EXPECT_THAT(text.out, HasSubstr("pixel stage: polaris10, compiled by radv Mesa "));
    EXPECT_THAT(run({"cost", "emboss", "-T", "ps_2_b", "--json"}).out,
                HasSubstr("\"pixel_slots\""));
    EXPECT_THAT(run({"cost", "fur", "-T", "essl_100"}).out, HasSubstr("no witness counts"));
    expect_refused({"cost", "fur", "-T", "glsl_450", "--chip", "polaris1"}, "unknown-chip");
}

TEST_F(CommandLine, ExplainsWhoSpendsTheSlots) {
    const Outcome fits = run({"explain", "parallax_occlusion,output=displaced", "-T", "ps_2_0"});
    EXPECT_EQ(fits.code, 0) << fits.err;
    EXPECT_THAT(fits.out, HasSubstr("\npixel stage, ps_2_0: "));
    EXPECT_THAT(fits.out, HasSubstr("\nvertex stage, vs_2_0: "));
    EXPECT_THAT(fits.out, HasSubstr("    templates/search/parallax_occlusion.cpp:"));
    EXPECT_THAT(fits.out, HasSubstr("  temporary registers "));
    EXPECT_THAT(fits.out, Not(HasSubstr("  over\n")));
    const Outcome refused = run({"explain", "parallax_occlusion", "-T", "ps_2_0", "-D", "taps=16"});
    EXPECT_EQ(refused.code, 0) << refused.err;
    EXPECT_THAT(refused.out, HasSubstr("\nrefused: ps_2_0 needs "));
    EXPECT_THAT(refused.out, HasSubstr("  over\n"));
    const Outcome json =
        run({"explain", "parallax_occlusion", "-T", "ps_2_0", "-D", "taps=16", "--json"});
    EXPECT_THAT(json.out, HasSubstr("\"fits\": false"));
    EXPECT_THAT(json.out, HasSubstr("\"step\": \"march\""));
    expect_refused({"explain", "parallax_occlusion", "-T", "ps_2"}, "unknown-target");
}

TEST_F(CommandLine, FoldsWhatIsKnown) {
    const std::vector<std::string> known = {
        "--fix", "scale=0.05", "--fix", "ambient=0.1,0.1,0.1", "--assume", "view.z=0.25..1"};
    const auto with = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), known.begin(), known.end());
        return run(arguments);
    };
    const std::string glsl = with({"emit", "parallax_occlusion", "-T", "glsl_450"}).out;
    EXPECT_THAT(glsl, HasSubstr("scale = 0.05, view.z = 0.25..1"));
    EXPECT_THAT(glsl, HasSubstr("view.xy / view.z * 0.05"));
    EXPECT_THAT(glsl, Not(HasSubstr("float scale")));
    const std::string assembly = with({"emit", "parallax_occlusion", "-T", "ps_2_0"}).out;
    EXPECT_THAT(assembly, Not(HasSubstr("uniform float1 scale")));
    EXPECT_THAT(assembly, Not(HasSubstr("ambient:")));
    EXPECT_THAT(assembly, HasSubstr("0.05"));
    EXPECT_THAT(with({"explain", "parallax_occlusion", "-T", "ps_2_0"}).out,
                HasSubstr("left out: generator/dsl/technique.cpp:"));
    EXPECT_THAT(with({"validate", "parallax_occlusion", "-T", "hlsl_5_0"}).out,
                HasSubstr("accepted"));
    EXPECT_EQ(with({"run", "parallax_occlusion", "-T", "glsl_450", "--maker", "bricks", "--scale",
                    "0.05", "--size", "16x16", "-o", path("pruned.png")})
                  .code,
              0);
}

// The shading has the name; what is left of it is drawn as well.
TEST_F(CommandLine, PartsOfASurfaceTakeWhatTheyHaveNamesFor) {
    const auto emitted = [&](const std::string& surface, std::vector<std::string> more) {
        more.insert(more.begin(), {"emit", surface, "-T", "glsl_450"});
        return run(more);
    };
    const std::string displaced = "parallax_occlusion,output=displaced";
    EXPECT_EQ(emitted(displaced, {"--fix", "ambient=0,0,0"}).code, 0);
    EXPECT_THAT(emitted(displaced, {"--fix", "ambiant=0,0,0"}).err, HasSubstr("unknown-uniform"));
    for (const char* pass : {"1", "2"})
        EXPECT_EQ(emitted("parallax_occlusion", {"--split", "shading", "--pass", pass, "--fix",
                                                 "ambient=0,0,0", "--fix", "scale=0.1"})
                      .code,
                  0);
    EXPECT_THAT(emitted("parallax_occlusion",
                        {"--split", "shading", "--pass", "1", "--fix", "ambiant=0,0,0"})
                    .err,
                HasSubstr("unknown-uniform"));
}

TEST_F(CommandLine, WhatCannotBeKnownGetsASentence) {
    const auto refused = [&](const std::string& option, const std::string& value,
                             const std::string& code) {
        return expect_refused({"emit", "parallax_occlusion", "-T", "glsl_450", option, value}, code)
            .err;
    };
    EXPECT_THAT(refused("--fix", "scal=1", "unknown-uniform"), HasSubstr("did you mean 'scale'"));
    EXPECT_THAT(refused("--fix", "ambient=1", "uniform-components"),
                HasSubstr("the uniform ambient has 3 components; 1 is given"));
    EXPECT_THAT(refused("--fix", "scale=deep", "known-syntax"), HasSubstr("'scale=deep'"));
    EXPECT_THAT(refused("--assume", "view.z=1..", "known-syntax"), HasSubstr("view.z=0.25..1"));
    EXPECT_THAT(refused("--assume", "vew.z=0..1", "unknown-value"),
                HasSubstr("did you mean 'view'"));
    EXPECT_THAT(refused("--assume", "view=0..1", "value-component"), HasSubstr("view.x to view.z"));
    EXPECT_THAT(refused("--assume", "view.z=1..0", "range-empty"), HasSubstr("1..0"));
    EXPECT_THAT(refused("--assume", "view.z=2..3", "range-impossible"), HasSubstr("view"));
}

TEST_F(CommandLine, ExplainsByLeavingOut) {
    const std::vector<std::string> asked = {"explain", "bump", "-T", "ps_2_0", "-D", "lights=4"};
    EXPECT_THAT(run(asked).out, Not(HasSubstr("without")));
    std::vector<std::string> without = asked;
    without.emplace_back("--without");
    const Outcome text = run(without);
    EXPECT_EQ(text.code, 0) << text.err;
    EXPECT_THAT(text.out, HasSubstr("\n  lights=2 "));
    EXPECT_THAT(text.out, HasSubstr("\n  guard, zero vector"));
    EXPECT_THAT(text.out, HasSubstr(" of 64 arithmetic slots"));
    without.emplace_back("--json");
    EXPECT_THAT(run(without).out, HasSubstr("\"what\": \"shading=ambient_only\""));
}

TEST_F(CommandLine, AimsEachLight) {
    const auto lit = [&](const std::string& azimuths, const std::string& picture) {
        return run({"run", "bump", "-T", "glsl_450", "-D", "lights=2", "--maker", "bricks",
                    "--size", "32x32", "--light-elevation", "45,30", "--light-azimuth", azimuths,
                    "-o", path(picture)});
    };
    EXPECT_EQ(lit("20,200", "a.png").code, 0);
    EXPECT_EQ(lit("20,120", "b.png").code, 0);
    EXPECT_NE(maps::read_png(path("a.png"))->texels, maps::read_png(path("b.png"))->texels);
    EXPECT_THAT(lit("20,200,90", "c.png").err,
                HasSubstr("3 lights are aimed and the surface has 2"));
}

TEST_F(CommandLine, DrawsByWayOfBytecode) {
    for (const char* target : {"ps_3_0", "glsl_450"})
        EXPECT_EQ(run({"run", "parallax_occlusion", "-T", target, "--maker", "cobbles", "--size",
                       "32x32", "--validation", "-o", path(std::string(target) + ".png")})
                      .code,
                  0)
            << target;
    const auto mine = maps::read_png(path("ps_3_0.png")),
               theirs = maps::read_png(path("glsl_450.png"));
    ASSERT_TRUE(mine.ok() && theirs.ok());
    // Eight bits hide most of what mad and rcp round otherwise.
    int far = 0;
    for (std::size_t i = 0; i < mine->texels.size(); ++i)
        far += std::abs(mine->texels[i] - theirs->texels[i]) > 1.5f / 255 ? 1 : 0;
    EXPECT_LE(far, static_cast<int>(mine->texels.size() / 100));
}

TEST_F(CommandLine, DumpsEveryStepOfTheIr) {
    const Outcome outcome = run({"emit", "parallax_occlusion", "-T", "glsl_450", "--loop",
                                 "march=unroll", "--dump-ir=all"});
    EXPECT_EQ(outcome.code, 0);
    for (const char* pass :
         {"fold_constants", "eliminate_common_subexpressions", "unroll_loops", "remove_dead_code"})
        EXPECT_THAT(outcome.err, HasSubstr(pass));
    EXPECT_THAT(outcome.err, HasSubstr("sample_level height_map"));
    EXPECT_THAT(outcome.out, HasSubstr("#version 450"));
}

TEST_F(CommandLine, UnknownNamesGetTheNearest) {
    EXPECT_THAT(
        expect_refused({"emit", "paralax_occlusion", "-T", "glsl_450"}, "unknown-surface").err,
        HasSubstr("did you mean 'parallax_occlusion'"));
    EXPECT_THAT(
        expect_refused({"emit", "parallax_occlusion", "-T", "glsl_45"}, "unknown-target").err,
        HasSubstr("did you mean 'glsl_450'"));
    EXPECT_THAT(
        expect_refused({"emit", "search=none,shadow=marsh", "-T", "glsl_450"}, "unknown-technique")
            .err,
        HasSubstr("did you mean 'march'"));
    EXPECT_THAT(
        expect_refused({"emit", "search=none,shadwo=march", "-T", "glsl_450"}, "unknown-part").err,
        HasSubstr("did you mean 'shadow'"));
    EXPECT_THAT(expect_refused({"emit", "parallax_occlusion", "-T", "glsl_450", "-D", "tap=8"},
                               "unknown-knob")
                    .err,
                HasSubstr("did you mean 'taps'"));
    EXPECT_THAT(
        expect_refused({"emit", "parallax_occlusion", "-T", "glsl_450", "--loop", "mrach=unroll"},
                       "unknown-loop")
            .err,
        HasSubstr("did you mean 'march'"));
    EXPECT_THAT(
        expect_refused({"run", "fur", "-T", "glsl_450", "--maker", "brick", "-o", path("p.png")},
                       "unknown-map")
            .err,
        HasSubstr("bricks"));
    expect_refused({"run", "fur", "-T", "glsl_450", "--maker", "bricks", "--device", "no such card",
                    "-o", path("p.png")},
                   "unknown-device");
}

TEST_F(CommandLine, KnobsKeepTheirRange) {
    for (const char* value : {"taps=0", "taps=257", "taps=-1"}) {
        const Outcome outcome = expect_refused(
            {"emit", "parallax_occlusion", "-T", "glsl_450", "-D", value}, "knob-range");
        EXPECT_THAT(outcome.err, HasSubstr("1 to 256"));
    }
    for (const char* value : {"taps=1.5", "taps=many", "taps=", "taps=nan", "taps=1e999"})
        expect_refused({"emit", "parallax_occlusion", "-T", "glsl_450", "-D", value}, "knob-value");
    expect_refused({"emit", "steep_parallax", "-T", "glsl_450", "-D", "min_steps=70"},
                   "knob-relation");
    expect_refused({"emit", "parallax_occlusion", "-T", "glsl_450", "-D", "taps"}, "knob-syntax");
}

TEST_F(CommandLine, UsageErrorsSayTheirReasonInOneLine) {
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{},
          {"emit"},
          {"emit", "fur"},
          {"frobnicate"},
          {"emit", "fur", "-T", "glsl_450", "--what"}}) {
        const Outcome outcome = expect_refused(arguments, "usage");
        EXPECT_THAT(outcome.err, HasSubstr("--help"));
    }
    EXPECT_EQ(run({"--help"}).code, 0);
    EXPECT_EQ(run({"--version"}).code, 0);
}

TEST_F(CommandLine, DrawsARealMap) {
    const Outcome outcome = run({"run", "steep_parallax,shadow=march", "-T", "hlsl_5_0", "--height",
                                 INTAGLIO_ROOT "/examples/maps/stone_bricks/normal_height.png",
                                 "--colour", INTAGLIO_ROOT "/examples/maps/stone_bricks/colour.png",
                                 "--size", "64x64", "--validation", "-o", path("picture.png")});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const auto picture = maps::read_png(path("picture.png"));
    ASSERT_TRUE(picture.ok());
    EXPECT_EQ(picture->width, 64);
}

TEST_F(CommandLine, DrawsOnEveryMesh) {
    for (const char* mesh : {"map", "quad", "sphere", "torus"}) {
        const Outcome outcome =
            run({"run", "parallax_occlusion", "-T", "glsl_450", "--maker", "cobbles", "--mesh",
                 mesh, "--size", "48x32", "--validation", "-o", path("picture.png")});
        EXPECT_EQ(outcome.code, 0) << mesh << outcome.err;
    }
    EXPECT_EQ(
        run({"run", "parallax_occlusion", "-T", "glsl_450", "--maker", "cobbles", "--mesh", "map",
             "--size", "64x64", "--error-map", path("errors.png"), "-o", path("p.png")})
            .code,
        0);
    EXPECT_TRUE(fs::exists(path("errors.png")));
    expect_refused(
        {"run", "fur", "-T", "glsl_450", "--maker", "fur", "--mesh", "teapot", "-o", path("p.png")},
        "option-value");
}

TEST_F(CommandLine, MapsOfAnySizeAreDrawn) {
    write_map("one.png", "flat1", 1, 1);
    write_map("wide.png", "bricks", 100, 3);
    for (const char* map : {"one.png", "wide.png"}) EXPECT_EQ(run(picture_of(map)).code, 0) << map;
}

TEST_F(CommandLine, BrokenMapsGetASentence) {
    write("text.png", "this is no picture");
    write("empty.png", "");
    write_map("whole.png", "bricks", 64, 64);
    const std::string whole = contents(path("whole.png"));
    write("truncated.png", whole.substr(0, whole.size() / 2));
    const std::pair<const char*, const char*> cases[] = {{"missing.png", "file-missing"},
                                                         {"text.png", "not-a-png"},
                                                         {"empty.png", "file-empty"},
                                                         {"truncated.png", "png-truncated"}};
    for (const auto& [map, code] : cases) {
        const Outcome outcome = expect_refused(picture_of(map), code);
        EXPECT_THAT(outcome.err, HasSubstr(map)) << "the sentence names the file";
        EXPECT_FALSE(fs::exists(path("picture.png"))) << "no output from bad input";
    }
    fs::create_directory(path("folder.png"));
    expect_refused(picture_of("folder.png"), "file-is-directory");
    expect_refused({"run", "fur", "-T", "glsl_450", "-o", path("p.png")}, "no-map");
}

TEST_F(CommandLine, OutputsAreWholeOrAbsent) {
    expect_refused({"emit", "fur", "-T", "glsl_450", "-o", path("no/such/folder/shader.frag")},
                   "file-unwritable");
    write("kept.frag", "what was there before");
    expect_refused({"emit", "fur", "-T", "glsl_450", "-D", "max_steps=0", "-o", path("kept.frag")},
                   "knob-range");
    EXPECT_EQ(contents(path("kept.frag")), "what was there before");
    expect_refused({"run", "fur", "-T", "glsl_450", "--maker", "fur", "--size", "16x16", "-o",
                    path("no/such/p.png")},
                   "file-unwritable");
    EXPECT_EQ(run({"emit", "fur", "-T", "glsl_450", "-o", "/dev/full"}).code, 2);
}

TEST_F(CommandLine, UnchangedOutputsKeepTheirTime) {
    const std::vector<std::string> emit = {"emit", "fur", "-T", "glsl_450", "-o", path("fur.frag")};
    run(emit);
    const auto old_time = fs::file_time_type::clock::now() - std::chrono::hours(1);
    fs::last_write_time(path("fur.frag"), old_time);
    run(emit);
    EXPECT_EQ(fs::last_write_time(path("fur.frag")), old_time);
}

TEST_F(CommandLine, ValidatesEveryTarget) {
    const Outcome outcome = run({"validate", "parallax_occlusion"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    for (const char* target : {"glsl_450", "glsl_330", "glsl_120", "essl_300", "essl_100",
                               "hlsl_5_0", "hlsl_3_0", "hlsl_2_b", "hlsl_2_0", "spirv", "msl",
                               "ps_2_0", "ps_2_a", "ps_2_b", "ps_3_0", "vs_2_0", "vs_3_0"})
        EXPECT_THAT(outcome.out, HasSubstr(target));
    EXPECT_THAT(outcome.out, HasSubstr("dependent level"));
    EXPECT_THAT(outcome.out, HasSubstr("no SPIR-V of this language to count"));
    // What a target cannot carry fails the command only where the target was asked for.
    const Outcome steep = run({"validate", "steep_parallax"});
    EXPECT_EQ(steep.code, 0) << steep.err;
    EXPECT_THAT(steep.out, HasSubstr("hlsl_2_0   refused: "));
    expect_refused({"validate", "steep_parallax", "-T", "hlsl_2_0"}, "target-limit");
    EXPECT_THAT(run({"validate", "fur", "-T", "glsl_450", "-v"}).out, HasSubstr("spirv-val"));
    expect_refused({"validate", "fur", "-T", "none"}, "no-witness");
}

TEST_F(CommandLine, MeasuresAScene) {
    write_map("my map.png", "bricks", 64, 32);
    write("scene.toml",
          "[relief]\nscale = 0.1\n[views]\nelevations = [90, 30]\nazimuths = "
          "[20]\n[lights]\nelevations = [40]\nazimuths = [120]\n"
          "[run]\nsize = 32\nrounds = 2\n[[map]]\nname = \"mine\"\nheight_map = \"my map.png\"\n"
          "[[variant]]\nsurface = \"steep_parallax,shadow=march\"\ntargets = [\"glsl_450\", "
          "\"hlsl_5_0\"]\n"
          "[[variant]]\nsurface = \"parallax_occlusion\"\ntargets = [\"glsl_450\"]\nknobs = { taps "
          "= [8, 32] }\n");
    const Outcome outcome =
        run({"measure", path("scene.toml"), "-o", path("results"), "--validation"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("steep_parallax"));
    EXPECT_THAT(outcome.out, HasSubstr("miss%"));
    for (const char* file : {"results/results.json", "results/results.csv"})
        EXPECT_GT(contents(path(file)).size(), 500u) << file;
    write("bad.toml", "[relief]\nsacle = 0.1\n");
    const Outcome bad = run({"measure", path("bad.toml"), "-o", path("results")});
    EXPECT_EQ(bad.code, 2);
    EXPECT_THAT(bad.err, HasSubstr("bad.toml:2:1: error: "));
    EXPECT_THAT(bad.err, HasSubstr("scale"));
}

}  // namespace
}  // namespace intaglio::cli
