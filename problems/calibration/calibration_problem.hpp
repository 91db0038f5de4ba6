// Odometry calibration of a robot with four independently steered and driven wheels (4WIS4WID), the batch
// least-squares problem of J. Vitko, master's thesis, University of Zagreb, 2024 (equation numbers are the
// thesis').
//
// Parameters z = (a1..a4, b1..b4, r1..r4), metres: wheel i stands at (a_i, b_i) in the body frame (x forward,
// y left), its radius is r_i. With steering angle d_i [rad], wheel speed w_i [rad/s], v_i = r_i w_i:
//     vx    = 1/4 sum_i cos(d_i + theta) v_i                                                (2.16)
//     vy    = 1/4 sum_i sin(d_i + theta) v_i
//     omega = sum_i W_i v_i,  W_i = (-b_i cos d_i + a_i sin d_i) / (4 (a_i^2 + b_i^2))      (2.17)
//     q[k+1] = q[k] + (t[k+1] - t[k]) (vx, vy, omega)[k],  q[0] = (0, 0, theta_ref[0])      (3.1)-(3.2)
//     J(z) = sum over recordings, k >= 1 of (x-x_ref)^2 + (y-y_ref)^2 + (theta-theta_ref)^2 (3.3)
// SI units without weights: metres and radians are mixed as in the thesis. J is dimensionless by that
// convention.
#pragma once

#include <memory>
#include <span>

#include "base/pose.hpp"
#include "datasets/recording.hpp"
#include "datasets/robots/robot.hpp"
#include "problems/calibration/calibration_options.hpp"
#include "problems/calibration/model_form.hpp"
#include "problems/calibration/wheeled_form.hpp"
#include "problems/instruction_set.hpp"
#include "problems/problem.hpp"

namespace odobench {

class RobustForm;

inline constexpr Eigen::Index kCalibrationParameters = 12;

// Largest absolute error of one recording over its samples: |x-x_ref|, |y-y_ref| [m], |theta-theta_ref|
// [rad].
struct MaxErrors {
  std::string recording, trajectory;
  int repetition = 0;
  double x = 0, y = 0, theta = 0;
};

MaxErrors max_errors(const Recording& recording, const PoseTrack& track);

namespace direct {
// The equations as written, sample by sample: the reference for tests and benchmarks.
PoseTrack integrate(const Recording& recording, const ConstVectorRef& z);
double cost(std::span<const Recording> recordings, const ConstVectorRef& z);
}  // namespace direct

// Odometry calibration of a robot from recordings: J, residuals (in the order of the recordings; x, y, theta
// row by row), Jacobian, normal equations in one pass, and batches of candidates.
//
// The thesis' robot with the thesis' cost has a structured form: with P_i = r_i b_i / (a_i^2+b_i^2) and Q_i =
// r_i a_i / (a_i^2+b_i^2) the heading is linear in (P, Q) and the body velocity is linear in r, so an
// evaluation needs no trigonometry of the steering angles, the heading part of J is a constant quadratic
// form, and the Jacobian is analytic. Everything else has the general form of
// problems/calibration/wheeled_form.hpp, or with options.model that of problems/calibration/models/, whose
// Jacobians are analytic, too. A robust loss (problems/calibration/robust_form.hpp) changes what their
// residuals count for.
//
// Immutable; every member may be called from several threads.
class CalibrationProblem {
 public:
  // The thesis' robot and cost. parameters: the twelve, in the order above. `kernel`: what evaluates the
  // structured form; it decides the last bits of cost, normal equations and batches. Throws
  // std::invalid_argument on another count, on no recordings, on a recording with fewer than two samples, or
  // on a kernel that the processor does not have.
  CalibrationProblem(std::vector<ParameterInfo> parameters, std::vector<Recording> recordings,
                     InstructionSet kernel = widest_instruction_set());
  // Any robot and cost; the structured form where options.as_in_thesis() and the robot is the thesis' with
  // the mean. With options.mount three parameters more: mount_x, mount_y [m], mount_yaw [rad], within 0.25 m
  // and 0.2 rad; with options.model those of with_model() and parameters_beyond_table(). Throws
  // std::invalid_argument as above, for what the robot needs and a recording lacks, and for models that the
  // robot, the cost or the rule does not allow.
  CalibrationProblem(const Robot& robot, std::vector<Recording> recordings, const CalibrationOptions& options,
                     InstructionSet kernel = widest_instruction_set());
  ~CalibrationProblem();
  CalibrationProblem(CalibrationProblem&&) noexcept;
  CalibrationProblem& operator=(CalibrationProblem&&) noexcept;

  std::string name() const { return "calibration"; }
  const std::vector<ParameterInfo>& parameters() const { return parameters_; }
  const CalibrationOptions& options() const { return options_; }
  double cost(const ConstVectorRef& z) const;
  Eigen::Index residual_count() const;
  // Of one recording; its residuals stand together, in the order of the recordings.
  Eigen::Index residual_count(std::size_t recording) const;
  void residuals(const ConstVectorRef& z, VectorRef r) const;
  void residuals_and_jacobian(const ConstVectorRef& z, VectorRef r, MatrixRef j) const;
  void normal_equations(const ConstVectorRef& z, NormalEquations& out) const;
  void batch_cost(const ConstMatrixRef& candidates, VectorRef costs) const;
  // F + 2 sqrt(F J(z)), F = (2 eps)^2 sum k (x_k^2 + y_k^2 + theta_k^2) over the references: k additions
  // leave an error of about 2 eps sqrt(k) |x_k| in a pose. Sums of squares only: what is left never exceeds
  // that of the equations as written.
  double rounding_floor(const ConstVectorRef& z) const;

  const std::vector<Recording>& recordings() const { return recordings_; }
  InstructionSet kernel() const { return kernel_; }
  // Whether the structured form evaluates J, or the squares in it where the loss is a robust one.
  bool structured() const { return structure_ != nullptr; }
  // Null where another form evaluates J.
  const WheeledForm* general() const { return general_.get(); }
  const ModelForm* extended() const { return extended_.get(); }
  // Stamps of the residuals' rows (of Segments: where pieces begin and end), the start first. Not of the
  // structured form, whose rows are all stamps: std::logic_error.
  const std::vector<std::size_t>& rows(std::size_t recording) const;
  PoseTrack integrate(std::size_t recording, const ConstVectorRef& z) const;
  // One entry per recording, for the error tables, over the samples with a reference.
  std::vector<MaxErrors> max_errors(const ConstVectorRef& z) const;

 private:
  struct Structure;
  void set_rounding_floor();
  void choose_form(const Robot& robot, const CalibrationOptions& options);
  std::vector<ParameterInfo> parameters_;
  std::vector<Recording> recordings_;
  CalibrationOptions options_;
  InstructionSet kernel_;
  double exact_floor_ = 0;  // F
  std::unique_ptr<Structure> structure_;
  std::unique_ptr<WheeledForm> general_;
  std::unique_ptr<const RobustForm> robust_;  // of another loss than the squared one
  std::unique_ptr<ModelForm> extended_;
};

}  // namespace odobench
