// Numbered work on several threads.  Who does what is left to chance, so that work writes to places
// of its own, and what it decides is decided after all of it.
#pragma once

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace intaglio::plan {

// work(0) to work(count - 1), each once.
template <typename Work>
void in_parallel(std::size_t count, int workers, const Work& work) {
    if (workers <= 1 || count <= 1) {
        for (std::size_t i = 0; i < count; ++i) work(i);
        return;
    }
    std::atomic<std::size_t> next = 0;
    std::vector<std::jthread> threads;
    const std::size_t most = std::min(count, static_cast<std::size_t>(workers));
    for (std::size_t thread = 0; thread < most; ++thread)
        threads.emplace_back([&] {
            for (std::size_t i = next++; i < count; i = next++) work(i);
        });
}

}  // namespace intaglio::plan
