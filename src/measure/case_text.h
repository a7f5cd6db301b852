// A case as a line of results.jsonl, and the key that says what went into it.  The members of a
// line: docs/measure.md.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "src/measure/case.h"

namespace intaglio::measure {

// Raised when a member of a line goes or changes its meaning; new ones may come.
inline constexpr int line_schema = 1;

// Of all source code that a number depends on.
const char* source_id();

// What the techniques record for this request, whoever wrote them.  Empty where the target refuses
// it before anything is recorded.  Errors: those of record_variant but "target-limit".
Result<std::string> recorded_hash(const dsl::Catalogue& catalogue, const VariantRequest& request);

// What measured it: name and driver of the device, and the part of its name that asks for it.
struct MeasuredOn {
    std::string device, asked;
};

// 32 hexadecimal digits: two cases with the same key have the same line.
std::string key_of(const Case& what, const CaseMap& map, const std::string& recorded,
                   const MeasuredOn& on);

// One line of JSON without its end.
std::string line_of(const std::string& key, const Case& what, const CaseMap& map,
                    const CaseMetrics& metrics, const MeasuredOn& on);

// The key of a line; nothing where it is not a result.
std::optional<std::string> key_in(std::string_view line);
// Whether a line says that the target refuses the variant.
bool is_refusal(std::string_view line);

}  // namespace intaglio::measure
