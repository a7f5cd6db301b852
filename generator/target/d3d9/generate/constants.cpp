// Constants to definitions: equal values are one, of either sign; vectors lie so that a legal
// swizzle shows them; what one instruction reads together lies together.
#include <algorithm>
#include <bit>

#include "generator/target/d3d9/generate/code.h"

namespace intaglio::d3d9 {
namespace {

constexpr std::uint32_t sign_bit = 0x80000000u;

struct Row {
    std::array<std::uint32_t, 4> bits{};
    Mask used = 0;
};

// The swizzle by which the row shows what is wanted, adding what is missing.
std::optional<Swizzle> fit(Row& row, const Wanted& wanted, std::uint32_t flip,
                           const Limits& limits) {
    std::optional<Swizzle> best;
    Row best_row;
    int fewest = 5;
    // Each choice of a lane for each position, as long as values agree.
    for (int code = 0; code < 256; ++code) {
        std::array<int, 4> lanes{-1, -1, -1, -1};
        Row trial = row;
        int added = 0;
        bool fits = true;
        for (std::size_t k = 0; k < 4 && fits; ++k) {
            const int lane = code >> (2 * k) & 3;
            if ((wanted.mask >> k & 1) == 0) {
                fits = lane == 0;
                continue;
            }
            const auto l = static_cast<std::size_t>(lane);
            const std::uint32_t bits = wanted.bits[k] ^ flip;
            if ((trial.used >> lane & 1) == 0) {
                trial.used = static_cast<Mask>(trial.used | (1 << lane));
                trial.bits[l] = bits;
                ++added;
            } else if (trial.bits[l] != bits) {
                fits = false;
            }
            lanes[k] = lane;
        }
        if (!fits || added >= fewest) continue;
        const auto swizzle = find_swizzle(lanes, limits);
        if (!swizzle) continue;
        best = swizzle;
        best_row = trial;
        fewest = added;
    }
    if (best) row = best_row;
    return best;
}

bool fit_source(Row& row, VirtualSource& source, const Limits& limits) {
    for (const std::uint32_t flip : {0u, sign_bit}) {
        Row trial = row;
        // A sign is only worth it where the value is there already.
        const auto swizzle = fit(trial, source.wanted, flip, limits);
        if (!swizzle || (flip != 0 && trial.used != row.used)) continue;
        row = trial;
        source.swizzle = *swizzle;
        if (flip != 0) source.negate = !source.negate;
        return true;
    }
    return false;
}

}  // namespace

bool can_share(const Wanted& a, const Wanted& b, const Limits& limits) {
    Row row;
    return fit(row, a, 0, limits) && fit(row, b, 0, limits);
}

std::optional<std::vector<Definition>> pool_constants(Code& code, const Limits& limits, int first) {
    std::vector<std::vector<VirtualSource*>> bundles;
    for (VirtualInstruction& instruction : code.instructions) {
        std::vector<VirtualSource*> bundle;
        for (VirtualSource& source : instruction.sources)
            if (source.kind == VirtualSource::Kind::Constant) bundle.push_back(&source);
        if (!bundle.empty()) bundles.push_back(std::move(bundle));
    }
    const auto size = [](const std::vector<VirtualSource*>& bundle) {
        std::vector<std::uint32_t> values;
        for (const VirtualSource* source : bundle)
            for (std::size_t k = 0; k < 4; ++k)
                if ((source->wanted.mask >> k & 1) != 0) values.push_back(source->wanted.bits[k]);
        std::sort(values.begin(), values.end());
        return std::unique(values.begin(), values.end()) - values.begin();
    };
    std::stable_sort(bundles.begin(), bundles.end(),
                     [&](const auto& a, const auto& b) { return size(a) > size(b); });
    std::vector<Row> rows;
    for (const auto& bundle : bundles) {
        // The row to which it adds least.
        std::size_t best = rows.size();
        int fewest = 5;
        for (std::size_t r = 0; r < rows.size(); ++r) {
            Row trial = rows[r];
            bool fits = true;
            for (const VirtualSource* source : bundle) {
                VirtualSource copy = *source;
                fits = fits && fit_source(trial, copy, limits);
            }
            const int added = std::popcount(trial.used) - std::popcount(rows[r].used);
            if (fits && added < fewest) {
                best = r;
                fewest = added;
            }
        }
        if (best == rows.size()) rows.emplace_back();
        for (VirtualSource* source : bundle) {
            fit_source(rows[best], *source, limits);
            source->index = first + static_cast<int>(best);
        }
    }
    if (first + static_cast<int>(rows.size()) > limits.constants) return std::nullopt;
    std::vector<Definition> definitions;
    for (std::size_t r = 0; r < rows.size(); ++r) {
        Definition definition;
        definition.index = first + static_cast<int>(r);
        definition.bits = rows[r].bits;
        definitions.push_back(definition);
    }
    return definitions;
}

}  // namespace intaglio::d3d9
