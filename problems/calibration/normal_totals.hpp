// J'J and J'r of the positions of a whole set of drives, from the kernels' sums over segments.
#pragma once

#include <vector>

#include "problems/calibration/kernel/kernel.hpp"
#include "problems/matrices.hpp"

namespace odobench {

// A segment's errors and derivatives are relative to its start, where the error is e0 and the derivative g0:
//     sum (g + g0)(e + e0)   = sum g e + sum g e0 + g0 (sum e + n e0)
//     sum (g + g0)(g + g0)'  = sum g g' + (sum g + n/2 g0) g0' + g0 (sum g + n/2 g0)'
// added up lane by lane, and lanes at the end.
class NormalTotals {
 public:
  // cost: what the sum begins with.
  explicit NormalTotals(int columns, double cost = 0);

  // A drive begins at (x, y), which depends on no parameter.
  void start(double x, double y);
  // Blocks of a drive in time order: `width` segments of `steps` samples each.
  // reference_x, reference_y: the reference where segment `lane` begins.
  void add(const kernel::NormalSums& sums, int width, long steps, const double* reference_x,
           const double* reference_y);

  double cost() const { return cost_ + drive_cost_; }  // J's bits, drive by drive
  Vector jtr() const;
  Matrix jtj() const;  // both triangles

 private:
  template <int Width>
  void add_lanes(const kernel::NormalSums& sums, long steps, const double* reference_x,
                 const double* reference_y);

  int columns_;
  double cost_;                            // of the drives before
  double x_ = 0, y_ = 0, drive_cost_ = 0;  // of the drive so far
  std::vector<double> gx_, gy_;            // derivative of the position so far
  std::vector<double> jtr_, jtj_;          // [entry][lane]
};

}  // namespace odobench
