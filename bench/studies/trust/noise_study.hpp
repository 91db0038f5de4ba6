// The noise of a calibrated odometry, measured from the drives it was calibrated with.
#pragma once

#include <string>
#include <vector>

#include "bench/catalogue/problem_factory.hpp"
#include "problems/trust/odometry_noise.hpp"
#include "reports/kinds/trust/noise_record.hpp"
#include "reports/records/record.hpp"

namespace odobench {

// Fits the model at the record's parameters and puts its figures into the record
// (reports/kinds/trust/noise_record.hpp). Returns what has to be said: why there are none, what the drives do
// not tell, a model that left-out drives contradict. A problem that is no calibration gets nothing.
std::vector<std::string> describe_noise(const LoadedProblem& loaded, RunRecord& record);

// `total`: the model with what repeats.
NoiseFigures figures_of(const NoiseFit& fit, const NoiseModel& total);

}  // namespace odobench
