// Drives that differ from their repetitions, found before anything is fitted.
//
// The misfit of a model repeats in every repetition of a drive, a fault does not. Of each recording the
// error of the path by nominal parameters is taken at 24 moments, i/24 of the time of the shortest repetition
// of its kind, i = 1 ... 24, each as the median of the 11 entries of the reference around it: x, y in the
// frame of the reference, or of its own first heading where these differ by more than 0.1 rad in a kind (m);
// heading (rad). D_xy and D_th are the root mean squares of its deviation from the curve of the kind, the
// median of its repetitions part by part, and
//     z = max over xy, th of D / max(median D of the kind, median D of all)
// Kinds are trajectories of at least three repetitions alike in time and length: between half and twice the
// median of the kind. z > 8 is nothing that the 30 published recordings reach (5.6).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "problems/calibration/calibration_problem.hpp"

namespace odobench {

inline constexpr double kUsualScreen = 8;

struct SiblingScore {
  bool compared = false;  // false: too few repetitions
  double z = 0;
  bool set_aside = false;
};

struct Screening {
  double limit = 0;                  // 0: nobody looked
  std::vector<SiblingScore> scores;  // of all recordings, in their order
  // Kinds of which half or more exceed the limit, where no majority says what is right: nothing of them is
  // set aside.
  std::vector<std::string> undecided;

  bool any_compared() const;
  std::vector<std::size_t> set_aside() const;  // indices
};

// Whatever robot and model: `options` give the path by nominal parameters (rule, twist, start), their cost
// and loss do not matter. limit > 0. Throws as CalibrationProblem does.
Screening screen_siblings(const Robot& robot, std::span<const Recording> recordings,
                          const CalibrationOptions& options, double limit);

}  // namespace odobench
