// The one list of kinds of records. A kind more is a folder beside this file and a row in kinds.cpp.
#pragma once

#include <string_view>
#include <vector>

#include "reports/kinds/kind.hpp"

namespace odobench {

// In the order in which reports show them.
const std::vector<RecordKind>& record_kinds();

// Of records and tracks of this problem.
const RecordKind& kind_of(std::string_view problem);

// Those that the tables of `kind` show: its own, and those of kinds that are shown with it.
bool shows(const RecordKind& kind, std::string_view problem);
std::vector<RunRecord> records_shown(const RecordKind& kind, const std::vector<RunRecord>& records);

// The tables of records of any kind. `full_digits` as in window_tables().
std::vector<Table> record_tables(const std::vector<RunRecord>& records, const std::vector<std::string>& notes,
                                 bool full_digits);

// One sentence per problem whose records hold nothing but measures and series that no row reads: made by
// another version, they would be passed over in silence.
std::vector<std::string> unknown_records(const std::vector<RunRecord>& records);

}  // namespace odobench
