// Recordings as the classical methods take them: wheel angles per interval, measured poses seen from the
// start.
#pragma once

#include <string>
#include <vector>

#include "problems/calibration/classical/classical.hpp"
#include "problems/robots/wheeled_robot.hpp"

namespace odobench::classical {

struct Drive {
  std::string id;
  Matrix signals;                   // of the robot, one column per interval: rad; steering angles
  Vector seconds;                   // of the intervals
  std::vector<std::size_t> stamps;  // with a reference; the first is 0
  Matrix measured;                  // 3 x stamps in the frame of the start, headings without jumps
  std::vector<std::size_t> rows;    // entries of `stamps` that are sample rows, the first 0
  Matrix odometry;                  // 3 x (intervals + 1) in the frame of the start, nominal values
  int sense = 0;                    // 1 counter-clockwise, -1 clockwise, 0 less than a quarter turn

  Eigen::Vector3d end() const { return measured.col(measured.cols() - 1); }
  double turned() const { return odometry(2, odometry.cols() - 1); }
  bool referenced_everywhere() const { return measured.cols() == odometry.cols(); }
  // Length of the path by odometry, m.
  double path() const;
  // Size of the path in x and y (m): of the reference where it is everywhere, else of the odometry.
  Eigen::Vector2d extent() const;
};

class Drives {
 public:
  // Throws std::invalid_argument as WheeledForm does: a signal is missing or of another kind, no reference
  // after the start.
  Drives(const Robot& robot, const std::vector<Recording>& recordings, const Options& options);

  const std::vector<Drive>& list() const { return list_; }
  const Options& options() const { return options_; }
  std::vector<const Drive*> of_sense(int sense) const;
  const Vector& nominal() const { return nominal_; }
  // Position of a parameter. Throws std::invalid_argument where the robot has none of the name.
  Eigen::Index position(const std::string& parameter) const;
  double nominal(const std::string& parameter) const { return nominal_[position(parameter)]; }
  // Poses with other values, 3 x (intervals + 1).
  Matrix odometry(const Drive& drive, const Vector& z, robots::IntegrationRule rule) const;
  // Measured minus odometry at the last reference; heading in (-pi, pi].
  Eigen::Vector3d end_error(const Drive& drive, const Vector& z) const;

 private:
  Drive read(const Recording& recording, const Matrix& signals, const Vector& seconds) const;

  robots::WheeledRobot robot_;
  Options options_;
  Vector nominal_;
  std::vector<Drive> list_;
};

// Motion from one pose to another, seen from the first.
Eigen::Vector3d relative(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

// The differential robot's motions of the intervals (3 x N) with radii and track 1: angles 2 x N, right and
// left.
Matrix unit_track_motions(const Matrix& angles, double right_by_track, double left_by_track);

}  // namespace odobench::classical
