// Drives that decide between two models of a robot which both explain its recordings.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/stop.hpp"
#include "bench/studies/planning/drive_predictions.hpp"

namespace odobench {

struct RivalDrive {
  std::string name, description;
  bool recorded = false;
  double seconds = 0;
  Discrimination discrimination;
  std::optional<int> repetitions;  // for a right decision in 95 of 100; none: not within 100
};

struct RivalPlan {
  std::string refused;               // why there is none; `drives` is empty then
  std::vector<std::string> unknown;  // drives of which one of the models says nothing
  std::vector<RivalDrive> drives;    // least time to the decision first
};

// Of all drive_candidates(). a, b: fitted by fit_model() to the recordings of `plain`.
// The scatter of a drive's end is that of the odometry's own noise (problems/trust/odometry_noise.hpp) in the
// model with the lower J; what repeats of its errors counts as open in both models, since no repetition
// averages it out.
// Throws std::invalid_argument where the robot has no drives, Interruption.
RivalPlan plan_rivals(const CalibrationProblem& plain, const Robot& robot, const ModelFits& a,
                      const ModelFits& b, int threads, const Stop& stop);

}  // namespace odobench
