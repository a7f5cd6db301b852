// The same work for many indices on several threads.  Whoever calls it gives each index a place of
// its own, so that a result does not depend on which thread came first.
#pragma once

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace intaglio::build {

// 0: as many as the machine has.
inline int thread_count(int wanted) {
    if (wanted > 0) return wanted;
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

template <typename Work>
void for_each_index(std::size_t count, int threads, const Work& work) {
    std::atomic<std::size_t> next{0};
    const auto run = [&] {
        for (std::size_t i = next++; i < count; i = next++) work(i);
    };
    std::vector<std::thread> helpers;
    const std::size_t wanted = std::min(count, static_cast<std::size_t>(thread_count(threads)));
    for (std::size_t i = 1; i < wanted; ++i) helpers.emplace_back(run);
    run();
    for (std::thread& helper : helpers) helper.join();
}

}  // namespace intaglio::build
