// Edit distance over short names.
#include "generator/base/nearest.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

namespace intaglio {
namespace {

// Levenshtein distance, one row at a time.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
        }
    }
    return row.back();
}

}  // namespace

std::string nearest_name(std::string_view name, std::span<const std::string> candidates) {
    std::string best;
    std::size_t least = std::max<std::size_t>(2, name.size() / 2) + 1;
    for (const std::string& candidate : candidates) {
        const std::size_t distance = edit_distance(name, candidate);
        if (distance < least) {
            least = distance;
            best = candidate;
        }
    }
    return best;
}

std::string unknown_name_sentence(std::string_view kind, std::string_view name,
                                  std::span<const std::string> candidates) {
    const std::string nearest = nearest_name(name, candidates);
    if (!nearest.empty())
        return fmt::format("unknown {} '{}'; did you mean '{}'?", kind, name, nearest);
    std::string list;
    for (const std::string& candidate : candidates) list += (list.empty() ? "" : ", ") + candidate;
    return fmt::format("unknown {} '{}'; there are: {}", kind, name, list);
}

}  // namespace intaglio
