// How far a calibration can be trusted, in its record.
#pragma once

#include "bench/catalogue/problem_factory.hpp"
#include "reports/records/record.hpp"

namespace odobench {

// Sets record.trust of a calibration at x; where the robot has no twist at x a note says so. Nothing for
// other problems.
void describe_trust(const LoadedProblem& loaded, const Vector& x, RunRecord& record);

}  // namespace odobench
