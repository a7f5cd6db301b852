// Direct3D 9 variants executed three ways: their bytes by our interpreter; the same bytes as
// MojoShader understands them, on the device; and the surface's glsl_450 text there.  The first two
// share only the bytes, the last two only the driver, so that an error of the encoder, the
// generator or a witness parts one from the others.
#include "tests/exec/bench.h"

#include <atomic>
#include <cmath>
#include <thread>

#include <fmt/format.h>

#include "generator/target/d3d9/bytecode.h"
#include "src/measure/interpreted.h"
#include "tests/rounds.h"

namespace intaglio::exec {
namespace {

constexpr int size = 32;
constexpr measure::Direction view{40, 25}, light{35, 130};

struct Case {
    std::string surface;
    Knobs knobs = {};
    std::string fits = "2_0 2_a 2_b 3_0";  // the profiles that have to hold it

    std::string name() const {
        std::string text = surface;
        for (const auto& [knob, value] : knobs) text += " " + knob + "=" + value;
        return text;
    }
};

// Every technique, so small that ps_2_0 holds it where any setting fits there; what has a loop
// comes for ps_3_0 once more as it is by default.
const std::vector<Case> cases = {
    {"search=none,output=displaced"},
    {"parallax,output=displaced"},
    {"parallax_limited,output=displaced", {{"normal_weight", "1"}}},
    {"parallax_iterative,output=displaced", {{"iterations", "2"}, {"slope", "0"}}},
    {"steep_parallax,output=displaced", {{"min_steps", "6"}, {"max_steps", "6"}}},
    {"parallax_occlusion,output=displaced", {{"taps", "6"}}},
    {"relief,output=displaced", {{"linear_steps", "4"}, {"binary_steps", "2"}}},
    {"relief_secant,output=displaced", {{"linear_steps", "3"}, {"secant_steps", "1"}}},
    {"contact_refinement,output=displaced", {{"coarse_steps", "4"}, {"fine_steps", "3"}}},
    {"distance,output=displaced", {{"ball_steps", "2"}}},
    {"cone,output=displaced", {{"cone_steps", "2"}}},
    {"cone_relaxed,output=displaced", {{"cone_steps", "1"}, {"binary_steps", "1"}}},
    {"view_dependent,output=displaced"},
    {"exact,output=displaced", {{"max_cells", "2"}, {"max_leaps", "0"}}, "2_a 3_0"},
    {"search=none,shadow=march,output=displaced",
     {{"shadow_min_steps", "6"}, {"shadow_max_steps", "6"}}},
    {"parallax,shadow=soft,output=displaced"},
    {"parallax,shadow=occlusion_profile,output=displaced", {{"shadow_taps", "4"}}},
    {"search=none,shadow=horizon,output=displaced"},
    {"search=none,shadow=exact,output=displaced",
     {{"shadow_cells", "2"}, {"shadow_leaps", "0"}},
     "2_a 3_0"},
    {"parallax,shadow=fur_depth,output=displaced"},
    {"search=none"},
    {"search=none,normal=blinn"},
    {"search=none,normal=smoothed"},
    {"search=none,normal=from_hit", {}, "2_a 3_0"},
    {"search=none,shading=lambert"},
    {"search=none,shading=lambert", {{"lights", "2"}}},
    {"search=none,shading=phong_map"},
    {"search=none,shading=emboss"},
    {"parallax,shading=ambient_only"},
    {"max_mip,output=displaced", {{"max_nodes", "12"}}, "3_0"},
    {"steep_parallax,shadow=march", {}, "3_0"},
    {"relief_secant", {}, "3_0"},
    {"cone_relaxed,shadow=soft", {}, "3_0"},
};

struct Wanted {
    const Case* one;
    std::string target;
    std::optional<Result<Variant>> variant = {};
};

// What the cases ask for, generated on all cores: that takes longer than all pictures.
std::vector<Wanted> generated() {
    std::vector<Wanted> all;
    for (const Case& one : cases)
        for (const char* profile : {"2_0", "2_a", "2_b", "3_0"})
            if (one.fits.find(profile) != std::string::npos &&
                // Sanitized, one profile of each model is enough.
                (all_rounds || profile[0] == '3' || profile[2] == '0'))
                all.push_back({&one, fmt::format("ps_{}", profile)});
    const dsl::Catalogue catalogue = templates::all_techniques();
    std::atomic<std::size_t> next = 0;
    std::vector<std::jthread> threads;
    for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i)
        threads.emplace_back([&] {
            for (std::size_t at = next++; at < all.size(); at = next++)
                all[at].variant = make_variant(
                    catalogue, request(all[at].one->surface, all[at].target, all[at].one->knobs));
        });
    threads.clear();
    return all;
}

// Levels are the hardware's choice in model 2, so every map has one; and RGBA8 is filtered in 8
// bits on the device, which is nobody's definition, so all are floats.
const measure::Textures& textures() {
    static const measure::Textures made = [] {
        measure::Textures all(map_named("smooth", 64, 64), measure::Filtering::Float);
        for (vulkan::Texture* texture : {&all.height, &all.normal, &all.colour})
            texture->levels.resize(1);
        all.colour.format = vulkan::Texture::Format::Rgba32Float;
        return all;
    }();
    return made;
}

vulkan::Picture on_device(const Variant& variant) {
    vulkan::Program program = must(measure::prepare_quad(device(), must(link_variant(variant)),
                                                         textures(), test_scale, size, size));
    must(measure::aim(program, view, light));
    return must(program.draw())[0];
}

vulkan::Picture interpreted(const Variant& variant) {
    const measure::InterpretedQuad quad =
        must(measure::InterpretedQuad::prepare(variant, textures(), test_scale, size, size));
    return must(quad.draw(view, light, d3d9::Arithmetic::Fp32)).picture;
}

// How far two pictures are apart.
struct Apart {
    double all_but_few = 0;  // the largest difference, leaving out the share of pixels below
    int beyond = 0;          // pixels that differ by more than the bound
};

// Of values about 1: coordinates, heights, visibilities, colours.  Each of some 100 instructions
// rounds by 6e-8, in an order of each way's own, and powers of 32 magnify that; ten times what
// there is (4e-7).
constexpr double bound = 4e-6;
// Where a height is compared with the ray's, such a difference may stop a march one step sooner or
// later: here none does, and 1 pixel in 200 is what the evaluator is allowed too.
constexpr int beyond_most = size * size / 200;

Apart apart(const vulkan::Picture& a, const vulkan::Picture& b) {
    std::vector<double> distances;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        double most = 0;
        for (std::size_t c = 0; c < 4; ++c) {
            const double distance = std::abs(a.pixels[i][c] - b.pixels[i][c]);
            // A NaN is apart from everything.
            most = distance <= most ? most : std::isnan(distance) ? INFINITY : distance;
        }
        distances.push_back(most);
    }
    Apart result;
    for (double distance : distances) {
        result.beyond += distance > bound;
        if (distance <= bound) result.all_but_few = std::max(result.all_but_few, distance);
    }
    return result;
}

TEST(Direct3d9, TheBytesTheirTranslationAndTheTextDrawTheSame) {
    const std::vector<Wanted> all = generated();
    std::map<std::string, vulkan::Picture> texts;
    double worst = 0;
    int worst_beyond = 0;
    for (const Wanted& wanted : all) {
        SCOPED_TRACE(wanted.one->name() + " on " + wanted.target);
        if (!*wanted.variant) {
            ADD_FAILURE() << wanted.variant->error().message;
            continue;
        }
        const std::string name = wanted.one->name();
        if (!texts.contains(name))
            texts[name] = on_device(
                must(make_variant(templates::all_techniques(),
                                  request(wanted.one->surface, "glsl_450", wanted.one->knobs))));
        const vulkan::Picture bytes = interpreted(**wanted.variant);
        const vulkan::Picture translated = on_device(**wanted.variant);
        EXPECT_EQ(count_invalid(bytes), 0);
        for (const auto& [what, distance] :
             {std::pair{"bytes and translation", apart(bytes, translated)},
              {"bytes and text", apart(bytes, texts[name])},
              {"translation and text", apart(translated, texts[name])}}) {
            EXPECT_LE(distance.beyond, beyond_most) << what;
            worst = std::max(worst, distance.all_but_few);
            worst_beyond = std::max(worst_beyond, distance.beyond);
        }
    }
    RecordProperty("worst", fmt::format("{:.1e}", worst));
    RecordProperty("worst_beyond", worst_beyond);
}

// Every target's list of techniques is that of the catalogue: a new one has to be added above.
TEST(Direct3d9, EveryTechniqueIsThere) {
    const dsl::Catalogue catalogue = templates::all_techniques();
    const auto used = [](std::string_view part, const std::string& name, bool is_first) {
        return is_first || std::any_of(cases.begin(), cases.end(), [&](const Case& one) {
                   return one.surface.find(fmt::format("{}={}", part, name)) != std::string::npos ||
                          (part == "search" && (one.surface + ",").starts_with(name + ","));
               });
    };
    const auto check = [&](std::string_view part, const auto& table) {
        for (const auto& row : table)
            EXPECT_TRUE(used(part, row.name, &row == &table.front())) << part << "=" << row.name;
    };
    check("search", catalogue.searches);
    check("shadow", catalogue.shadows);
    check("normal", catalogue.normals);
    check("shading", catalogue.shadings);
}

// The bytes with one swizzle of a constant replaced: x by y, and so on.
Variant with_wrong_swizzle(Variant variant, std::size_t instruction) {
    d3d9::Shader shader = must(decode_stage(variant, ir::Stage::Pixel));
    for (d3d9::Source& source : shader.instructions[instruction].sources)
        if (source.file == d3d9::File::Const)
            source.swizzle = d3d9::replicate((source.swizzle[0] + 1) % 4);
    std::string& bytes = variant.pixel.bytecode.bytes;
    const std::vector<std::uint32_t> words = d3d9::encode(shader);
    const std::string before = bytes;
    for (std::size_t i = 0; i < words.size(); ++i)
        for (std::size_t byte = 0; byte < 4; ++byte)
            bytes[4 * i + byte] = static_cast<char>(words[i] >> (8 * byte));
    int differing = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) differing += bytes[i] != before[i];
    EXPECT_LE(differing, 2) << "no more than the bits of one token";
    return variant;
}

TEST(Direct3d9, OneWrongSwizzleIsSeenByBothReadersOfTheBytes) {
    const Knobs taps = {{"taps", "4"}};
    const std::string surface = "parallax_occlusion,output=displaced";
    const Variant variant =
        must(make_variant(templates::all_techniques(), request(surface, "ps_2_0", taps)));
    const vulkan::Picture text = on_device(
        must(make_variant(templates::all_techniques(), request(surface, "glsl_450", taps))));
    const d3d9::Shader shader = must(decode_stage(variant, ir::Stage::Pixel));
    int seen = 0, tried = 0;
    for (std::size_t i = 0; i < shader.instructions.size() && tried < 8; ++i) {
        const auto& sources = shader.instructions[i].sources;
        if (std::count_if(sources.begin(), sources.end(), [](const d3d9::Source& source) {
                return source.file == d3d9::File::Const &&
                       source.swizzle == d3d9::replicate(source.swizzle[0]);
            }) != 1)
            continue;
        ++tried;
        const Variant wrong = with_wrong_swizzle(variant, i);
        const vulkan::Picture bytes = interpreted(wrong), translated = on_device(wrong);
        EXPECT_LE(apart(bytes, translated).beyond, beyond_most) << "they read the same bytes";
        // Another constant of the register may happen to be the same.
        const bool differs = apart(bytes, text).beyond > beyond_most;
        EXPECT_EQ(differs, apart(translated, text).beyond > beyond_most);
        seen += differs;
    }
    EXPECT_GE(seen, 3) << "of " << tried;
}

// Mean distance of coordinates.
double mean_apart(const vulkan::Picture& a, const vulkan::Picture& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        sum += std::hypot(a.pixels[i][0] - b.pixels[i][0], a.pixels[i][1] - b.pixels[i][1]);
    return sum / static_cast<double>(a.pixels.size());
}

// R300 keeps 16 bits after the point, `_pp` 10: numbers near 1 are off by 2^-17 and 2^-11, and some
// ten roundings of smaller ones follow each other.
TEST(Direct3d9, NarrowArithmeticIsOffByItsBits) {
    const Variant variant = must(
        make_variant(templates::all_techniques(),
                     request("parallax_occlusion,output=displaced", "ps_2_0", {{"taps", "6"}})));
    const measure::InterpretedQuad quad =
        must(measure::InterpretedQuad::prepare(variant, textures(), test_scale, size, size));
    const measure::InterpretedQuad in_half = must(quad.with_partial_precision());
    const vulkan::Picture wide = must(quad.draw(view, light, d3d9::Arithmetic::Fp32)).picture;
    // Nothing that we emit says _pp by itself.
    EXPECT_TRUE(
        same_bits(wide, must(quad.draw(view, light, d3d9::Arithmetic::Fp16Partial)).picture));
    const measure::InterpretedPicture drawn = must(quad.draw(view, light, d3d9::Arithmetic::Fp24));
    EXPECT_EQ(drawn.reads_max, 7) << "six taps and the one that the hit is read again by";
    const double fp24 = mean_apart(wide, drawn.picture);
    const double fp16 =
        mean_apart(wide, must(in_half.draw(view, light, d3d9::Arithmetic::Fp16Partial)).picture);
    EXPECT_GT(fp24, 1.0 / (1 << 20));
    EXPECT_LT(fp24, 1.0 / (1 << 14));
    EXPECT_GT(fp16, 8 * fp24);
    EXPECT_LT(fp16, 1.0 / (1 << 8));
    RecordProperty("fp24", fmt::format("{:.2e}", fp24));
    RecordProperty("fp16", fmt::format("{:.2e}", fp16));
}

}  // namespace
}  // namespace intaglio::exec
