// J of a robot with more than its table of wheels (model_terms.hpp): the tracked frame's place, time offsets,
// contacts that steering moves, free starts; and the fast form of tables that are not linear.
//
// The motion of interval k is the twist of the wheels' equations (problems/robots/wheel_rows.hpp, or the
// published mean with v = radius w + offset d(steering)), integrated by the rule to poses (c, alpha) from the
// start. With start (p0, theta_s) and mount (l, beta)
//     position = p0 + R(theta_s - beta) [c + (R(alpha) - I) l],   heading = theta_s + alpha
// as in problems/calibration/wheeled_form.hpp. A pass over a recording never holds its Jacobian: segments
// side by side give sums of products of derivatives seen from each segment's start, and the derivative of
// that start by the parameters (3 x n) puts them together:
//     d pose = sigma_xy + sigma_theta Q p + d_local pose,  in the frame of the segment's start.
//
// A free start s = (x, y, heading) of each recording is eliminated: J(z) = min_s J(z, s) by Newton's method,
// and the residuals' derivative is that of r(z, s(z)), ds/dz = -H_ss^-1 H_sz with second derivatives.
#pragma once

#include <memory>
#include <vector>

#include "datasets/recording.hpp"
#include "problems/calibration/calibration_options.hpp"
#include "problems/calibration/models/model_signals.hpp"
#include "problems/instruction_set.hpp"
#include "problems/problem.hpp"
#include "problems/robots/wheeled_robot.hpp"

namespace odobench {

class ModelForm {
 public:
  // robot: of with_model(). Throws std::invalid_argument for what recordings lack (naming them), for more
  // than 16 wheels or 40 parameters, for segments as cost, and for optiodom-omni as rule.
  ModelForm(robots::WheeledRobot robot, const std::vector<Recording>& recordings,
            const CalibrationOptions& options, InstructionSet kernel);
  static bool serves(const CalibrationOptions& options);

  const std::vector<std::size_t>& rows(std::size_t recording) const { return drives_.at(recording).rows; }
  const robots::WheeledRobot& robot() const { return robot_; }

  // z: the table's parameters, then parameters_beyond_table().
  Eigen::Index parameter_count() const { return columns_; }
  Eigen::Index residual_count() const { return residual_count_; }
  Eigen::Index residual_count(std::size_t recording) const {
    return per_row() * (static_cast<Eigen::Index>(rows(recording).size()) - 1);
  }
  double cost(const ConstVectorRef& z) const;
  void residuals(const ConstVectorRef& z, VectorRef r) const;
  void residuals_and_jacobian(const ConstVectorRef& z, VectorRef r, MatrixRef j) const;
  void normal_equations(const ConstVectorRef& z, NormalEquations& out) const;
  // Poses of the tracked frame at every stamp, 3 x samples, from the usual start: free starts are those of J
  // and of residuals alone.
  Matrix track(std::size_t recording, const ConstVectorRef& z) const;
  // How much a free start differs from the usual one: x, y (m), heading (rad). 0 without start_pose.
  Eigen::Vector3d start_shift(std::size_t recording, const ConstVectorRef& z) const;

 private:
  struct Drive {
    ModelSignals::Raw raw;
    Eigen::Index steps = 0;    // of a lane
    std::vector<double> data;  // empty where it depends on z
    Eigen::Vector3d start;
    std::vector<std::size_t> rows;  // stamps, the start first
    Matrix reference;               // 3 x rows
    std::vector<int> row_of;        // of every interval's end: its row, or -1
    bool wrapped = false, of_kind = false;
  };
  struct Point;
  struct Pass;

  void read_drive(const Recording& recording);
  void choose_rows(const Recording& recording, Drive& drive) const;
  void plan_slots();
  Point point(const ConstVectorRef& z) const;
  Pass walk(const Drive& drive, const Point& at) const;
  void place_lanes(Pass& pass) const;
  void find_errors(const Drive& drive, const Point& at, bool free_start, Pass& pass) const;
  Eigen::Vector3d fit_start(const Drive& drive, const Point& at, const Pass& pass) const;
  Matrix start_columns(const Point& at, const Pass& pass) const;
  void next_lane(const Pass& pass, int lane, const double* sums, Matrix& sigma) const;
  void add_normal(const Drive& drive, const Point& at, NormalEquations& out) const;
  void write_rows(const Drive& drive, const Point& at, VectorRef r, MatrixRef j) const;
  void put_residuals(const Drive& drive, const Pass& pass, VectorRef r) const;
  Eigen::Index per_row() const { return options_.cost == CostKind::Optiodom ? 2 : 3; }
  double heading_weight() const { return options_.cost == CostKind::Optiodom ? 0 : options_.heading_weight; }
  bool free_starts() const { return options_.model.start_pose; }

  robots::WheeledRobot robot_;
  CalibrationOptions options_;
  kernel::ModelKernel kernel_;
  ModelSignals signals_;
  Eigen::Index columns_ = 0, table_columns_ = 0, residual_count_ = 0;
  int lever_ = -1, yaw_ = -1, time_ = -1, factor_ = -1;  // columns
  bool data_changes_ = false;
  std::vector<std::vector<kernel::ModelTerm>> slot_terms_;
  std::vector<kernel::ModelSlot> slots_;
  std::vector<Drive> drives_;
};

}  // namespace odobench
