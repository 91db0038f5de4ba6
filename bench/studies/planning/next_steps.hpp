// What the lowest run of a calibration leaves open, and what to drive next: the end of `bench calibrate`.
#pragma once

#include <string>

#include "base/stop.hpp"
#include "bench/catalogue/problem_factory.hpp"
#include "bench/studies/watcher.hpp"
#include "reports/records/record.hpp"

namespace odobench {

// Longest that it may take on one core of 2020 by its estimate: beyond, a sentence says how to ask for it.
inline constexpr double kNextSteps_s = 2;

// Adds to record.trust, where there is one (reports/records/trust_record.hpp):
//   twice_box     where a parameter is on a bound: how much lower J is in a box twice as wide
//   explanations  where errors repeat within kinds of drive: what is left of J with a richer model each,
//                 fitted by fit_model()
//   next          drives that decide between the best of these and what does nearly as well (a factor on
//                 drives on the spot, at least 90 % of it), else the record's own model (plan_rivals());
//                 where nothing explains the errors, or recorded drives tell the two apart already,
//                 drives that settle what is open in the better one (plan_settling())
// `command`: of the set, "--data=set.json", for the sentence of what was left out. The estimate is made from
// counts of samples, so that records do not depend on the machine. Throws Interruption.
void describe_next_steps(const LoadedProblem& loaded, const std::string& command, int threads,
                         const Stop& stop, RunRecord& record);

}  // namespace odobench
