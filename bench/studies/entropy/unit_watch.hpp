// Whether the channels of a filter log go together: millimetres, milliseconds, degrees under rad, signs.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "bench/studies/entropy/entropy_setup.hpp"

namespace odobench {

// Sums over the rows of a run. The wheels alone say how the robot turns: each measures its way along its own
// direction e, m = e.(s + c r), with c the way by a rotation of r = 1 m (2.24)-(2.27); r by least squares
// from the four of them, in degrees by (2.28). The rotation channel R and r, both summed up since the start,
// are compared as sum(R r) / sum(r r).
class UnitWatch {
 public:
  explicit UnitWatch(const EntropyConstants& constants);
  void add(const ConvertedRow& row);

  // A sentence per suspicion, with figures: wheels faster than 15 m/s in the mean, a sampling period above
  // 5 s or below 0.1 ms, rotation off by 180/pi or pi/180 (within 30 %) or against the wheels, wheels that
  // only grow.
  std::vector<std::string> remarks() const;

 private:
  void find_weights();

  EntropyConstants constants_;
  EntropyPrediction unit_;            // by a rotation of 1 m
  std::array<double, 4> steering_{};  // of the weights
  std::array<double, 4> weights_{};   // rotation in deg per m of each wheel's way
  double rows_ = 0, path_ = 0, growing_ = 0, first_ = 0, last_ = 0;
  double turned_ = 0, said_ = 0;                 // since the start, deg
  double by_wheels_ = 0, both_ = 0, given_ = 0;  // sums of squares and of the product, deg^2
};

}  // namespace odobench
