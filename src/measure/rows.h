// Work on the rows of a picture, spread over threads.
#pragma once

#include <algorithm>
#include <thread>
#include <vector>

namespace intaglio::measure {

// Runs `row(y)` for every row; rows write to places of their own.  `threads` 0: as many as the
// machine has cores; 1: on the caller's own, for callers that are many themselves.
template <typename Row>
void for_each_row(int height, int threads, const Row& row) {
    if (threads == 1) {
        for (int y = 0; y < height; ++y) row(y);
        return;
    }
    const int workers =
        threads > 0 ? threads : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    std::vector<std::jthread> running;
    for (int worker = 0; worker < workers; ++worker)
        running.emplace_back([&row, worker, workers, height] {
            for (int y = worker; y < height; y += workers) row(y);
        });
}

}  // namespace intaglio::measure
