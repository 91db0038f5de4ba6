// J of a calibration with a robust loss, on top of the same calibration in least squares.
//
// With the residuals e of the squared problem (whatever robot, model and cost it has), s as in loss.hpp:
//     per sample     J = sum over rows of rho((e_x^2 + e_y^2) / sp^2) + rho(e_h^2 / st^2)
//     per recording  J = sum over recordings of N sg^2 rho(MS / sg^2),  MS = J_n / N, N rows of recording n
// Residuals are e f(s) in units of the scale, f = sqrt(rho(s) / s): their squares sum up to J exactly, and
// the normal equations are the products of their analytic Jacobian
//     dr = f E + 2 f' e (e'E),   E = de/dz.
// Recordings are evaluated one after the other, so that memory is that of the longest. Per recording the
// fast forms of the squared problem give J_n, J_n'r_n and J_n'J_n, which is all that is needed:
//     J'r = rho' J_n'r_n,   J'J = f^2 J_n'J_n + (4 f f' + 4 s f'^2) / (N sg^2) (J_n'r_n)(J_n'r_n)'.
#pragma once

#include <vector>

#include "problems/calibration/losses/loss.hpp"
#include "problems/calibration/recording_costs.hpp"

namespace odobench {

// J of the residuals e of one recording, `row` of them (2 or 3) to a row: of what has no parameters.
double robust_cost(const Loss& loss, const ConstVectorRef& e, Eigen::Index row);

// Immutable; every member may be called from several threads.
class RobustForm {
 public:
  // `options` with a robust loss whose scales are above 0; recordings of theirs are copied. Throws as
  // CalibrationProblem does.
  RobustForm(const Robot& robot, const std::vector<Recording>& recordings, const CalibrationOptions& options,
             InstructionSet kernel);

  const Loss& loss() const { return loss_; }
  double cost(const ConstVectorRef& z) const;
  void batch_cost(const ConstMatrixRef& candidates, VectorRef costs) const;
  void residuals(const ConstVectorRef& z, VectorRef r) const;
  void residuals_and_jacobian(const ConstVectorRef& z, VectorRef r, MatrixRef j) const;
  void normal_equations(const ConstVectorRef& z, NormalEquations& out) const;
  // What an error in a residual of the squared problem is multiplied by at most, squared.
  double floor_factor() const;

 private:
  double recording_cost(double squares, std::size_t n) const;
  // Rows of a recording, in place; j may be null.
  void shape(std::size_t n, VectorRef r, MatrixRef* j) const;
  void shape_rows(VectorRef r, MatrixRef* j) const;

  RecordingCosts squared_;
  Loss loss_;
  Eigen::Index row_;  // residuals of a row: 2 or 3
};

}  // namespace odobench
