// The recordings rearranged once for the kernels, and what turns kernel sums into J, J'r and J'J.
#pragma once

#include <vector>

#include "problems/calibration/calibration_problem.hpp"
#include "problems/calibration/kernel/kernel.hpp"
#include "problems/calibration/normal_totals.hpp"
#include "problems/calibration/step_squares.hpp"

namespace odobench {

using LinearVector = Eigen::Matrix<double, kernel::kLinear, 1>;
using LinearMatrix = Eigen::Matrix<double, kernel::kLinear, kernel::kLinear>;
using HeadingVector = Eigen::Matrix<double, kernel::kHeading, 1>;
using Increments = Eigen::Matrix<double, kernel::kHeading, Eigen::Dynamic>;
using HeadingMatrix = Eigen::Matrix<double, kernel::kHeading, kernel::kHeading>;

// s(z) = (r, P, Q) of kernel.hpp and its Jacobian ds/dz (12 x 12), z in the order a, b, r.
LinearVector linear_parameters(const ConstVectorRef& z);
LinearMatrix linear_jacobian(const ConstVectorRef& z);

// Sum over all samples of the squared heading error, a constant quadratic form in h = (P, Q), kept as a sum
// of squares:
//     |R (h - h0) + q|^2 + rest,  [R q; 0 sqrt(rest)] = triangular factor of [F, F h0 - turned],
// F = dtheta/dh of every sample, h0 the nominal. Expanded as (h - h0)' F'F (h - h0) + ... it would lose half
// of the digits near exact data; this way it loses those of the parameters only, and is never negative.
struct HeadingForm {
  HeadingVector origin, q;
  HeadingMatrix r, a;  // upper triangle, R'R
  double rest = 0;
};

// Segments of a recording in time order; `width` of them form a block. The last few increments form one of
// width 1.
struct Segment {
  long steps = 0;
  HeadingVector heading0;       // dtheta/dh at its start: prefix sums of (-C, S)
  double x_ref = 0, y_ref = 0;  // reference position at its start
};
struct BlockPlan {
  int width = 0;
  long steps = 0;
  std::size_t data = 0;     // offset into the data
  std::size_t segment = 0;  // its first segment
};
struct RecordingPlan {
  double theta0 = 0;
  std::vector<BlockPlan> blocks;
  std::vector<Segment> segments;
};

class CalibrationStructure {
 public:
  CalibrationStructure(const std::vector<Recording>& recordings, const ConstVectorRef& nominal,
                       InstructionSet kernel);

  double cost(const ConstVectorRef& z) const;
  void batch_cost(const ConstMatrixRef& candidates, VectorRef costs) const;
  void normal_equations(const ConstVectorRef& z, NormalEquations& out) const;
  // `recordings`: those of the constructor. Every number of r and j is written, once.
  void residuals_and_jacobian(const std::vector<Recording>& recordings, const ConstVectorRef& z, VectorRef r,
                              MatrixRef j) const;

 private:
  // True when a step could turn further than the rotation polynomial holds.
  bool needs_exact_rotation(const LinearVector& s) const;
  // R (h - h0) + q
  HeadingVector heading_residual(const LinearVector& s) const;
  double heading_cost(const LinearVector& s) const;
  double recording_cost(const RecordingPlan& plan, const LinearVector& s, bool exact) const;
  void add_normal(const RecordingPlan& plan, const LinearVector& s, bool exact, NormalTotals& totals) const;
  void plan_recording(const Recording& recording, const Increments& list);

  kernel::Kernel kernel_;
  HeadingForm heading_;
  StepSquares squares_;                                 // of every second step, as the kernels leave them out
  HeadingVector largest_step_ = HeadingVector::Zero();  // max |C_i|, max |S_i|
  std::vector<RecordingPlan> plans_;
  std::vector<double> data_;
};

}  // namespace odobench
