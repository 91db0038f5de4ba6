// What decides the result of a run, and what of a record is its result, as check sums.
#pragma once

#include <string>

#include "reports/records/record.hpp"

namespace odobench {

// SHA-256 of all that decides the result of a run: problem and box, check sum of the data set, solver with
// every option, polish, seeds, repetition, start, budget, and the program (version, revision, compiler,
// libraries, kernel); the data set's name and the row's label belong to it, too. A record that is planned and
// has none of its results yet has the same key as later. Of a record that no solver made (the nominal
// parameters, a filter's figures) the check sum of its result.
std::string record_key(const RunRecord& record);

// SHA-256 of a record without times, what depends on them, and where it was made: equal where two runs gave
// the same to the last bit.
std::string result_check_sum(const RunRecord& record);

}  // namespace odobench
