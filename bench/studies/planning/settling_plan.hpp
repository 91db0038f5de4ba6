// Drives that settle parameters which the box decides.
#pragma once

#include <string>
#include <vector>

#include "base/stop.hpp"
#include "bench/studies/planning/drive_predictions.hpp"

namespace odobench {

struct SettlingDrive {
  std::string name, description;
  bool recorded = false;
  double seconds = 0;
  int repetitions = 0;
};

struct SettlingPlan {
  std::string refused;                // why there is none
  std::vector<std::string> open;      // parameters that the recordings leave open
  std::vector<SettlingDrive> drives;  // proposed, in the order of their use; empty where none helps
  std::vector<std::string> settled;   // of `open`, by these drives
  double largest_before = 0, largest_after = 0;  // 95 % half width over that of the box, of those in `open`
};

// With C of fitted_covariance() (box included) and the derivatives G of end poses, n drives of a kind with
// scatter S and repeating errors B add G'(S / n + B)^-1 G to C^-1: a Bayesian D-criterion (K. Chaloner,
// I. Verdinelli, Statistical Science 10(3), 1995). A parameter is open where 1.96 sd exceeds half of its
// box's half width. Greedy: each time the drive that lowers the sum over those open of log(1.96 sd / that
// half) most, until none is open, kMostSettling drives are used up, or a drive lowers it by less than 1 %.
// Deterministic. Throws as drive_candidates(), Interruption.
inline constexpr int kMostSettling = 12;
SettlingPlan plan_settling(const CalibrationProblem& plain, const Robot& robot, const ModelFits& fits,
                           int threads, const Stop& stop);

}  // namespace odobench
