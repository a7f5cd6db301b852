// How long work is carried out: by how many threads, and who hears how far it is.  Neither changes
// a result.
#pragma once

#include <functional>

namespace intaglio::maps {

struct Work {
    int threads = 0;  // 0: as many as the machine has
    // Called after each row with how many are done of how many, one call at a time, from whichever
    // thread did it.
    std::function<void(int done, int all)> progress = {};
};

}  // namespace intaglio::maps
