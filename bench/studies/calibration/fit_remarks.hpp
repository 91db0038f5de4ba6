// What a calibration that fits badly has to say.
#pragma once

#include <string>
#include <vector>

#include "bench/catalogue/problem_factory.hpp"
#include "reports/records/record.hpp"

namespace odobench {

// Sentences where a calibration is a bad one, else nothing:
//   - the total error (sums of e_sr as of the table `totals`) is above that of the nominal parameters,
//   - half of the free parameters, and at least two, sit on bounds,
//   - of three drives at least, one makes more than half of the sum of squared errors at the samples with a
//     reference, and more than 5 times the median drive; weights are those of J.
// `nominal`: the record of the nominal parameters on the same data.
std::vector<std::string> fit_remarks(const LoadedProblem& loaded, const RunRecord& record,
                                     const RunRecord& nominal);

}  // namespace odobench
