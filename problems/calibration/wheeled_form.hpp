// J of any wheeled robot: the general form, from its table of wheels.
//
// The motion of interval k, from stamp k to stamp k + 1, is the robot's twist of the speeds at stamp k times
// its length, or the twist of the increments at stamp k + 1 (datasets/recording.hpp); steering angles are
// those of the same entry. Motions are integrated from (0, 0, 0) to relative poses (c, alpha) and moved to
// the start (p0, theta0), with the tracked frame at l = (l_xy, l_th) in the body frame:
//     position = p0 + R(theta0 - l_th) [c + (R(alpha) - I) l_xy],   heading = theta0 + alpha
// so l = 0 is a tracked body. Motion between two rows i, j, seen from the tracked frame at i:
//     R(-l_th - alpha_i) [c_j - c_i + (R(alpha_j) - R(alpha_i)) l_xy],   alpha_j - alpha_i
#pragma once

#include <memory>
#include <vector>

#include "datasets/recording.hpp"
#include "problems/calibration/calibration_options.hpp"
#include "problems/calibration/linear_streams.hpp"
#include "problems/problem.hpp"
#include "problems/robots/wheeled_robot.hpp"

namespace odobench {

class WheeledForm {
 public:
  // Throws std::invalid_argument naming the recording: a signal of the robot that it does not have, one that
  // is no speed, increment or angle where the robot needs it, speeds beside increments; no reference after
  // the start.
  WheeledForm(robots::WheeledRobot robot, const std::vector<Recording>& recordings,
              const CalibrationOptions& options, InstructionSet kernel = widest_instruction_set());

  const robots::WheeledRobot& robot() const { return robot_; }
  // Rows of every recording (of Segments: where pieces begin and end), the first of them the start.
  const std::vector<std::size_t>& rows(std::size_t recording) const { return drives_[recording].rows; }

  // A recording as the robot takes it, one column per interval: motions of the wheels (rad), steering angles;
  // and the lengths of the intervals, s.
  const Matrix& signals(std::size_t recording) const { return drives_[recording].signals; }
  const Vector& seconds(std::size_t recording) const { return drives_[recording].seconds; }

  // z: the robot's parameters, then x, y, yaw of the mount where it is free.
  Eigen::Index parameter_count() const { return parameter_count_; }
  Eigen::Index residual_count() const { return residual_count_; }
  Eigen::Index residual_count(std::size_t recording) const { return drives_.at(recording).residuals; }
  double cost(const ConstVectorRef& z) const;
  void residuals(const ConstVectorRef& z, VectorRef r) const;
  void residuals_and_jacobian(const ConstVectorRef& z, VectorRef r, MatrixRef j) const;
  void normal_equations(const ConstVectorRef& z, NormalEquations& out) const;
  // Poses of the tracked frame at every stamp, 3 x samples.
  Matrix track(std::size_t recording, const ConstVectorRef& z) const;
  // |b - A t| of every interval: how much the wheels contradict each other, m.
  Vector slip(std::size_t recording, const ConstVectorRef& z) const;

 private:
  // A recording as the robot takes it.
  struct Drive {
    Matrix signals;  // of the robot, one column per interval
    Matrix streams;  // of a robot that is linear
    Vector seconds;  // of the intervals
    Eigen::Vector3d start;
    std::vector<std::size_t> rows;  // stamps
    Matrix reference;               // 3 x rows
    bool wrapped = false;           // headings are known up to turns
    Eigen::Index residuals = 0;
  };
  // The robot's part of z, and the rest.
  struct Point {
    bool usable = true;  // false: numbers that no robot has, which have no cost
    Vector robot;
    Eigen::Vector3d mount = Eigen::Vector3d::Zero();
    Matrix matrix;                    // of a robot that is linear
    std::vector<Matrix> derivatives;  // of it by z
  };

  Drive prepare(const Recording& recording) const;
  void prepare_fast_cost(InstructionSet kernel);
  void choose_rows(const Recording& recording, Drive& drive) const;
  // Of options with pieces by time or along the reference.
  void choose_pieces(const Recording& recording, const std::vector<std::size_t>& stamps, Drive& drive) const;
  Point point(const ConstVectorRef& z, bool derivatives) const;
  Matrix motions(const Drive& drive, const Point& at) const;
  Matrix poses(const Drive& drive, const Point& at) const;
  // j: residuals x n, or null.
  void residuals(const Drive& drive, const Point& at, VectorRef r, MatrixRef* j) const;
  void absolute_residuals(const Drive& drive, const Point& at, const Matrix& poses, const Matrix& by,
                          VectorRef r, MatrixRef* j) const;
  void piece_residuals(const Drive& drive, const Point& at, const Matrix& poses, const Matrix& by,
                       VectorRef r, MatrixRef* j) const;
  Eigen::Index residuals_per_row() const { return options_.cost == CostKind::Optiodom ? 2 : 3; }

  robots::WheeledRobot robot_;
  CalibrationOptions options_;
  Eigen::Index parameter_count_ = 0, residual_count_ = 0;
  std::vector<Drive> drives_;
  std::unique_ptr<LinearStreams> fast_;  // of a linear robot with a reference at every sample
};

}  // namespace odobench
