// Which recordings, and which stretches of them, a robust loss counts for less.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "problems/calibration/calibration_problem.hpp"

namespace odobench {

struct WeightedDown {
  std::size_t recording = 0;
  // sqrt(J_n / N_n) of the squared errors over its median of all recordings.
  double ratio = 0;
  bool outlier = false;  // the ratio is above 6
  // Of a stretch: its first and last sample. None: the whole recording.
  std::optional<std::size_t> first = {}, last = {};
  double weight = 1;  // rho': the lowest of the stretch, the mean over the rows of a recording
};

// At the parameters z of a problem with a robust loss: the three recordings with the largest ratios, and all
// outliers, the largest first; then, of a loss per sample, of every recording the longest five stretches of
// rows where the position or the heading weighs less than 0.1, in order of time. Nothing for least squares.
std::vector<WeightedDown> weighted_down(const Robot& robot, const CalibrationProblem& problem,
                                        const ConstVectorRef& z);

}  // namespace odobench
