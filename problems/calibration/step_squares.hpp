// What two steps at a time leave of J'J. With g_1, g_2 the derivatives of the position after two steps and
// d = g_2 - g_1
//     g_1 g_1' + g_2 g_2' = 1/2 (g_1 + g_2) (g_1 + g_2)' + 1/2 d d'
// which halves the products of an evaluation, since the sum of d d' is a polynomial in r with constant
// coefficients: the heading turns d, but no product of two of its columns. In the frame of the heading, as
// complex numbers, with w_i = C_i + i S_i of the step, f = dtheta/d(P, Q) before it, and u = sum r_a w_a:
//     d = (w_1..w_4, i u f')
//     r_i, r_j                       Re(w_i conj w_j)
//     r_i, (P, Q)                    sum_a r_a Im(w_i conj w_a) f'
//     (P, Q), (P, Q)                 sum_a,b r_a r_b Re(w_a conj w_b) f f'
#pragma once

#include <Eigen/Core>

#include "problems/calibration/kernel/kernel.hpp"
#include "problems/matrices.hpp"

namespace odobench {

class StepSquares {
 public:
  using Squares = Eigen::Matrix<double, kernel::kLinear, kernel::kLinear>;

  StepSquares();
  // cs: (C_1..C_4, S_1..S_4) of a step, rad; heading: f before it (8 numbers each).
  void add(const double* cs, const double* heading);
  // After the last step.
  void finish() { reduce(); }
  // Sum of d d' at the linear parameters s (12), their first four r, m.
  Squares at(const ConstVectorRef& s) const;

 private:
  void reduce();

  static constexpr Eigen::Index kWheels = 4, kPairs = kWheels * (kWheels + 1) / 2;
  static constexpr Eigen::Index kProducts = kernel::triangle(kernel::kHeading), kRows = 256;
  // Of the steps since the last reduction: Re(w_a conj w_b) for b <= a, Im(w_a conj w_b) for all, f, and f
  // f'. Step by step, as they are written.
  template <Eigen::Index Columns>
  using Rows = Eigen::Matrix<double, kRows, Columns, Eigen::RowMajor>;
  Rows<kPairs> real_;
  Rows<kWheels * kWheels> imaginary_;
  Rows<kernel::kHeading> heading_;
  Rows<kProducts> products_;
  Eigen::Index filled_ = 0;
  // Sums of their products.
  Eigen::Matrix<double, kPairs, 1> wheels_;
  Eigen::Matrix<double, kWheels * kWheels, kernel::kHeading> cross_;
  Eigen::Matrix<double, kPairs, kProducts> squares_;
};

}  // namespace odobench
