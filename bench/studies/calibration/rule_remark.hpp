// Whether another rule of integration explains the drives better than the one that a calibration used.
#pragma once

#include <string>

#include "bench/catalogue/problem_factory.hpp"
#include "reports/records/record.hpp"

namespace odobench {

// "" unless J of the record's parameters by another rule (euler or arc) is below a quarter of the
// record's: then the sentence that names it. The parameters were not fitted by that rule, so one that is
// right loses by it, and a quarter is no accident. Nothing is said of the thesis' robot and cost, whose rule
// is the publication's.
std::string rule_remark(const LoadedProblem& loaded, const RunRecord& record);

}  // namespace odobench
