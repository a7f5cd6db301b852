// How long a thousand variants take to build, against what glslang alone takes for the same texts.
//
//     bench_build [VARIANTS] [THREADS] [ROUNDS]
//
// Variants: searches x shadows x shadings x a knob's values x languages, in a fixed order, those
// that a target refuses left out.  Both sides run on the same threads in turn, after a round that
// makes glslang's tables; the least time of each side counts.  By the clock on the wall for all,
// and by the processor's for each variant, which other work on the machine stretches less.
#include <time.h>

#include <algorithm>
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

double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// What one side does with each of so many variants; true: it worked.
class Side {
  public:
    explicit Side(std::size_t count) : least_(count, 1e30), fine_(count, 0) {}

    void run(int threads, const auto& work) {
        const auto begun = Clock::now();
        build::for_each_index(least_.size(), threads, [&](std::size_t i) {
            const double before = processor_seconds();
            fine_[i] = work(i);
            least_[i] = std::min(least_[i], processor_seconds() - before);
        });
        wall_ = std::min(wall_, std::chrono::duration<double>(Clock::now() - begun).count());
    }

    double wall() const { return wall_; }
    // Of the variants that are wanted.
    double processor(const auto& wanted) const {
        double sum = 0;
        for (std::size_t i = 0; i < least_.size(); ++i)
            if (wanted(i)) sum += least_[i];
        return sum;
    }
    bool fine() const {
        return std::all_of(fine_.begin(), fine_.end(), [](char each) { return each != 0; });
    }

  private:
    double wall_ = 1e30;
    std::vector<double> least_;
    std::vector<char> fine_;
};

struct Sides {
    Side alone, emitted, built;
    bool fine() const { return alone.fine() && emitted.fine() && built.fine(); }
};

void print(const Sides& sides, const std::vector<plan::Order>& orders) {
    const auto row = [&](const char* what, const Side& side) {
        const double processor = side.processor([](std::size_t) { return true; });
        fmt::print("  {:30} {:6.2f} s {:6.2f} {:14.2f} s {:6.2f}\n", what, side.wall(),
                   side.wall() / sides.alone.wall(), processor,
                   processor / sides.alone.processor([](std::size_t) { return true; }));
    };
    fmt::print("  {:30} {:>15} {:>23}\n", "", "wall", "processor");
    row("glslang and spirv-val alone", sides.alone);
    row("emitted", sides.emitted);
    row("emitted, validated, reflected", sides.built);
    fmt::print("by language, processor        alone  emitted    built\n");
    for (const char* language : languages) {
        const auto of_it = [&](std::size_t i) { return orders[i].request.target == language; };
        const double alone = sides.alone.processor(of_it);
        fmt::print("  {:20} {:10.3f} s {:8.2f} {:8.2f}\n", language, alone,
                   sides.emitted.processor(of_it) / alone, sides.built.processor(of_it) / alone);
    }
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
    Sides sides{Side(orders.size()), Side(orders.size()), Side(orders.size())};
    for (int round = 0; round < rounds; ++round) {
        sides.alone.run(threads, [&](std::size_t i) { return glslang_alone(texts[i]); });
        sides.emitted.run(threads, [&](std::size_t i) {
            return make_variant(catalogue, orders[i].request).ok();
        });
        sides.built.run(
            threads, [&](std::size_t i) { return build::make_bundle(catalogue, orders[i]).ok(); });
    }
    fmt::print("{} variants of {} candidates, {} threads, the least of {} rounds\n", orders.size(),
               all.size(), threads, rounds);
    print(sides, orders);
    return sides.fine() ? 0 : 3;
}

}  // namespace

int main(int count, char** arguments) {
    const auto number = [&](int index, int otherwise) {
        return count > index ? std::max(1, std::atoi(arguments[index])) : otherwise;
    };
    return run(number(1, 1000), number(2, 2), number(3, 3));
}
