// Recordings of a robot whose true model and whose noise are known: wheels that follow their commands, a
// path by a model, white increments of the motion on it.
#pragma once

#include <string>
#include <vector>

#include "base/random.hpp"
#include "problems/calibration/calibration_problem.hpp"

namespace odobench::testing {

struct PathNoise {
  double position = 1e-3;              // along and across, m / sqrt(m)
  double heading = 4e-3, turn = 3e-3;  // rad / sqrt(m), rad / sqrt(rad)
  double capture = 1e-4;               // of the reference, m and rad
};

// The robot of a class that drives by this model with parameters z (nominal + deviation; `extra` is the value
// of the model's own last parameter).
struct RivalTruth {
  Robot robot;
  CalibrationOptions options;  // with the model
  Vector z;
};
RivalTruth rival_truth(const std::string& robot_class, const std::vector<std::string>& model, double extra);

// Repetition k of drives of these names (of known_drives() and small_circles()), with trajectories of their
// names.
std::vector<Recording> true_recordings(const RivalTruth& truth, const std::vector<std::string>& drives,
                                       int repetitions, const PathNoise& noise, std::uint64_t seed);

}  // namespace odobench::testing
