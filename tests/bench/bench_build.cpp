// How long a thousand variants take to build, against what glslang alone takes for the same texts.
//
//     bench_build [VARIANTS] [THREADS] [ROUNDS]
//
// Variants: searches x shadows x shadings x a knob's values x languages, in a fixed order, those
// that a target refuses left out.  Both sides run on the same threads in turn, after a round that
// makes glslang's tables; the least time of each side counts.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "src/build/bundle.h"
#include "src/build/parallel.h"
#include "src/check/frontend.h"
#include "templates/all_techniques.h"

namespace {

using namespace intaglio;
using Clock = std::chrono::steady_clock;

constexpr const char* languages[] = {"glsl_450", "glsl_330", "glsl_120", "essl_300", "essl_100",
                                     "hlsl_5_0", "hlsl_3_0", "hlsl_2_b", "hlsl_2_0"};

// One number of each search, and values that give other programs.
struct Search {
    const char* name;
    const char* knob;
    std::vector<const char*> values;
};
const std::vector<Search>& searches() {
    static const std::vector<Search> all = {
        {"parallax_occlusion", "taps", {"4", "8", "12", "16"}},
        {"steep_parallax", "max_steps", {"8", "16"}},
        {"relief", "linear_steps", {"8", "16"}},
        {"relief_secant", "linear_steps", {"8", "16"}},
        {"parallax_iterative", "iterations", {"2", "4"}},
        {"cone_relaxed", "cone_steps", {"8", "16"}},
        {"parallax", nullptr, {""}},
        {"none", nullptr, {""}},
    };
    return all;
}

std::vector<plan::Order> candidates() {
    std::vector<plan::Order> orders;
    for (const char* shading : {"phong", "lambert", "ambient_only"})
        for (const char* shadow : {"none", "occlusion_profile", "horizon"})
            for (const Search& search : searches())
                for (const char* value : search.values)
                    for (const char* language : languages) {
                        plan::Order order;
                        order.surface = fmt::format("s{}", orders.size());
                        order.request.surface = fmt::format("search={},shadow={},shading={}",
                                                            search.name, shadow, shading);
                        order.request.target = language;
                        if (search.knob != nullptr)
                            order.request.knobs.emplace_back(search.knob, value);
                        orders.push_back(std::move(order));
                    }
    return orders;
}

double seconds_of(const auto& work) {
    const auto begun = Clock::now();
    work();
    return std::chrono::duration<double>(Clock::now() - begun).count();
}

struct Texts {
    check::Source vertex, pixel;
};

// What glslang and spirv-val do with a pair of texts that somebody hands them: parsed once, made
// SPIR-V where there is one, validated.
bool glslang_alone(const Texts& texts) {
    for (const check::Source* source : {&texts.vertex, &texts.pixel}) {
        if (check::has_spirv(source->language) ? !check::to_spirv(*source).ok()
                                               : !check::parse(*source).ok())
            return false;
    }
    return true;
}

int run(int wanted, int threads, int rounds) {
    const dsl::Catalogue catalogue = templates::all_techniques();
    std::vector<plan::Order> all = candidates();
    // Which of them there are; this round also makes glslang's tables.
    std::vector<char> fine(all.size(), 0);
    std::vector<std::string> why(all.size());
    std::vector<Texts> texts_of(all.size());
    build::for_each_index(all.size(), threads, [&](std::size_t i) {
        const Result<Variant> variant = make_variant(catalogue, all[i].request);
        if (!variant) {
            why[i] = variant.error().message;
            return;
        }
        texts_of[i] = {source_of(*variant, ir::Stage::Vertex),
                       source_of(*variant, ir::Stage::Pixel)};
        fine[i] = glslang_alone(texts_of[i]);
    });
    std::vector<plan::Order> orders;
    std::vector<Texts> texts;
    for (std::size_t i = 0; i < all.size() && orders.size() < static_cast<std::size_t>(wanted); ++i)
        if (fine[i]) {
            orders.push_back(all[i]);
            texts.push_back(std::move(texts_of[i]));
        }
    if (orders.empty()) {
        fmt::print(stderr, "no variant: {}\n", why.front());
        return 3;
    }
    std::vector<char> built(orders.size(), 0);
    double emit = 1e30, build = 1e30, alone = 1e30;
    for (int round = 0; round < rounds; ++round) {
        alone = std::min(alone, seconds_of([&] {
                             build::for_each_index(texts.size(), threads, [&](std::size_t i) {
                                 built[i] = glslang_alone(texts[i]);
                             });
                         }));
        emit = std::min(emit, seconds_of([&] {
                            build::for_each_index(orders.size(), threads, [&](std::size_t i) {
                                built[i] = make_variant(catalogue, orders[i].request).ok();
                            });
                        }));
        build = std::min(build, seconds_of([&] {
                             build::for_each_index(orders.size(), threads, [&](std::size_t i) {
                                 built[i] = build::make_bundle(catalogue, orders[i]).ok();
                             });
                         }));
    }
    const auto each = [&](double seconds) {
        return seconds * 1000 / static_cast<double>(orders.size());
    };
    fmt::print("{} variants of {} candidates, {} threads, the least of {} rounds\n", orders.size(),
               all.size(), threads, rounds);
    fmt::print("  glslang and spirv-val alone      {:6.2f} s  {:6.2f} ms each\n", alone,
               each(alone));
    fmt::print("  emitted                          {:6.2f} s  {:6.2f} ms each\n", emit, each(emit));
    fmt::print("  emitted, validated, reflected    {:6.2f} s  {:6.2f} ms each\n", build,
               each(build));
    fmt::print("  ratio                            {:6.2f}\n", build / alone);
    for (const char ok : built)
        if (!ok) return 3;
    return 0;
}

}  // namespace

int main(int count, char** arguments) {
    const auto number = [&](int index, int otherwise) {
        return count > index ? std::max(1, std::atoi(arguments[index])) : otherwise;
    };
    return run(number(1, 1000), number(2, 2), number(3, 3));
}
