// How far a calibration can be trusted, in its record.
#pragma once

#include "bench/catalogue/problem_factory.hpp"
#include "problems/information/formula.hpp"
#include "reports/records/record.hpp"

namespace odobench {

// Sets record.trust of a calibration at x and its measures (reports/records/trust_record.hpp), with
// trust.share_on_bounds, the part of the free parameters that lie on bounds (lower is better); where the
// robot has no twist at x a note says so. Nothing for other problems.
void describe_trust(const LoadedProblem& loaded, const Vector& x, RunRecord& record);

// Sets record.trust->combinations of a calibration at the record's parameters; nothing where it has no trust.
// Throws std::invalid_argument where a formula has no value there.
void describe_combinations(const LoadedProblem& loaded, const std::vector<Formula>& formulas,
                           RunRecord& record);

}  // namespace odobench
