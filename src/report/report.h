// A measurement as text: a table for people, JSON and CSV for programs.  All three depend on
// nothing but their arguments and keep the order of the cases, which is that of measure::measure:
// by map, view, light, row.
#pragma once

#include <cstddef>
#include <string>

#include "src/measure/measure.h"
#include "src/report/command.h"

namespace intaglio::report {

// For a terminal: one block per map, view and light with a line per variant; then, where views
// differ in elevation, one overview per map; then what made each number.  Nothing in a block is
// merged. The overview has a column per elevation; where several azimuths or lights share one, it
// shows the largest of their values and says so, because the percentile of a union cannot be had
// from percentiles.  Where a line would pass `table_width` columns, techniques and knobs are cut
// short
// ("..") and written out below.
inline constexpr std::size_t table_width = 150;
std::string table(const measure::Plan& plan, const measure::Measurement& measurement);

// Of JSON and CSV.  Raised when a member or column goes or changes its meaning; new ones may come.
// Both hold every number in full (the shortest digits that read back as the same double).  What is
// not known is null in JSON and empty in CSV: times without rounds, errors where no pixel reported
// a hit, commands without map arguments.
inline constexpr int schema_version = 1;

// {schema: "intaglio.measurement", version, made_by, device, plan, maps, rows, cases}: a case names
// its map and, counted from 0, its row; it says where the worst pixel is, in pixels and in uv, and
// which command draws it.  Indented; ends in a line break.
std::string to_json(const measure::Plan& plan, const measure::Measurement& measurement,
                    const MapArguments& map_arguments = {});

// RFC 4180: CRLF, a header, one record per case.
std::string to_csv(const measure::Plan& plan, const measure::Measurement& measurement,
                   const MapArguments& map_arguments = {});

// One field of a record, quoted where it must be.
std::string csv_field(const std::string& text);

}  // namespace intaglio::report
