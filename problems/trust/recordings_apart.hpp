// The recordings of a calibration one by one, prepared when they are first asked for.
#pragma once

#include <memory>
#include <mutex>

#include "problems/calibration/recording_costs.hpp"

namespace odobench {

// Several threads may ask. Sets of more than 2 million samples are prepared anew for each that asks, and
// not kept: they take as much memory as the problem itself.
class RecordingsApart {
 public:
  RecordingsApart(Robot robot, std::shared_ptr<const CalibrationProblem> problem)
      : robot_(std::move(robot)), problem_(std::move(problem)) {}

  const Robot& robot() const { return robot_; }
  std::shared_ptr<const RecordingCosts> get() const;

 private:
  Robot robot_;
  std::shared_ptr<const CalibrationProblem> problem_;
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const RecordingCosts> kept_;
};

}  // namespace odobench
