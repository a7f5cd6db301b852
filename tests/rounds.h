// How much of a random or exhaustive test is run.  All of it without sanitizers; with them, where a
// round takes ten times as long and an error of memory shows in the first ones, a part.  A build
// with INTAGLIO_SANITIZE_ALL runs all of it too.
#pragma once

namespace intaglio {

#if defined(INTAGLIO_ALL_ROUNDS)
inline constexpr bool all_rounds = true;
#elif defined(__SANITIZE_ADDRESS__)
inline constexpr bool all_rounds = false;
#elif defined(__has_feature)
inline constexpr bool all_rounds = !__has_feature(address_sanitizer);
#else
inline constexpr bool all_rounds = true;
#endif

// Of `all` random rounds, and of what is counted in them.
template <typename Number>
constexpr Number rounds(Number all) {
    return all_rounds ? all : (all + 9) / 10;
}

// Of a walk over all combinations every so manyth is taken: a prime that is no table's length, so
// that each member of each table has its turn.
inline constexpr int stride = all_rounds ? 1 : 11;

}  // namespace intaglio
