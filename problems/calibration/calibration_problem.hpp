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

#include "datasets/recording.hpp"
#include "problems/instruction_set.hpp"
#include "problems/problem.hpp"

namespace odobench {

inline constexpr Eigen::Index kCalibrationParameters = 12;

// Estimated poses of one recording, one entry per sample.
struct PoseTrack {
  std::vector<double> x, y, theta;
};

// Largest absolute error of one recording over its samples: |x-x_ref|, |y-y_ref| [m], |theta-theta_ref|
// [rad].
struct MaxErrors {
  std::string recording, trajectory;
  int repetition = 0;
  double x = 0, y = 0, theta = 0;
};

namespace direct {
// The equations as written, sample by sample: the reference for tests and benchmarks.
PoseTrack integrate(const Recording& recording, const ConstVectorRef& z);
double cost(std::span<const Recording> recordings, const ConstVectorRef& z);
}  // namespace direct

// The structured form: with P_i = r_i b_i / (a_i^2+b_i^2) and Q_i = r_i a_i / (a_i^2+b_i^2) the heading is
// linear in (P, Q) and the body velocity is linear in r, so an evaluation needs no trigonometry of the
// steering angles, the heading part of J is a constant quadratic form, and the Jacobian is analytic.
// Evaluates J, residuals (3 per sample k >= 1, order x, y, theta, recording by recording), Jacobian, normal
// equations in one pass, and batches of candidates. Immutable; every member may be called from several
// threads.
class CalibrationProblem {
 public:
  // parameters: the twelve, in the order above. `kernel`: what evaluates the structured form; it decides the
  // last bits of cost, normal equations and batches. Throws std::invalid_argument on another count, on no
  // recordings, on a recording with fewer than two samples, or on a kernel that the processor does not have.
  CalibrationProblem(std::vector<ParameterInfo> parameters, std::vector<Recording> recordings,
                     InstructionSet kernel = widest_instruction_set());
  ~CalibrationProblem();
  CalibrationProblem(CalibrationProblem&&) noexcept;
  CalibrationProblem& operator=(CalibrationProblem&&) noexcept;

  std::string name() const { return "calibration"; }
  const std::vector<ParameterInfo>& parameters() const { return parameters_; }
  double cost(const ConstVectorRef& z) const;
  Eigen::Index residual_count() const;
  void residuals(const ConstVectorRef& z, VectorRef r) const;
  void residuals_and_jacobian(const ConstVectorRef& z, VectorRef r, MatrixRef j) const;
  void normal_equations(const ConstVectorRef& z, NormalEquations& out) const;
  void batch_cost(const ConstMatrixRef& candidates, VectorRef costs) const;
  // F + 2 sqrt(F J(z)), F = (2 eps)^2 sum k (x_k^2 + y_k^2 + theta_k^2) over the references: k additions
  // leave an error of about
  // 2 eps sqrt(k) |x_k| in a pose. Sums of squares only: what is left never exceeds that of the equations as
  // written.
  double rounding_floor(const ConstVectorRef& z) const;

  const std::vector<Recording>& recordings() const { return recordings_; }
  InstructionSet kernel() const { return kernel_; }
  PoseTrack integrate(std::size_t recording, const ConstVectorRef& z) const;
  // One entry per recording, for the error tables.
  std::vector<MaxErrors> max_errors(const ConstVectorRef& z) const;

 private:
  struct Structure;
  std::vector<ParameterInfo> parameters_;
  std::vector<Recording> recordings_;
  InstructionSet kernel_;
  double exact_floor_ = 0;  // F
  std::unique_ptr<Structure> structure_;
};

}  // namespace odobench
