// The parameter box as the unit cube that every solver sees: u in [-1, 1]^m, one coordinate per parameter
// that is not held fixed (lower < upper), x = centre + half * u. u = -1, 0 and 1 map to the bounds and the
// centre exactly, small distances from any of the three keep their digits, and every x that leaves here lies
// in the box to the last bit.
#pragma once

#include "problems/problem.hpp"

namespace odobench {

class Box {
 public:
  explicit Box(const std::vector<ParameterInfo>& parameters);
  // Number m of free coordinates; may be 0.
  Eigen::Index dimension() const { return static_cast<Eigen::Index>(free_.size()); }
  // u (m) -> x (n); coordinates outside [-1, 1] are clamped.
  Vector to_parameters(const ConstVectorRef& u) const;
  // x (n) -> u (m), clamped.
  Vector to_unit(const ConstVectorRef& x) const;
  // dJ/dx (n) -> dJ/du (m).
  Vector gradient_to_unit(const ConstVectorRef& g) const;
  // Columns of a Jacobian, rows and columns of J'J, entries of J'r.
  Matrix jacobian_to_unit(const ConstMatrixRef& j) const;
  NormalEquations to_unit(const NormalEquations& e) const;
  // Free coordinate i is this index in x.
  Eigen::Index parameter_index(Eigen::Index i) const { return free_[static_cast<std::size_t>(i)]; }
  // How far apart representable neighbours of the point are, in unit coordinates (m): by the rounding of x
  // and of u.
  Vector resolution(const ConstVectorRef& u) const;
  bool contains(const ConstVectorRef& x) const;

 private:
  Vector lower_, upper_, half_, centre_;  // n
  std::vector<Eigen::Index> free_;        // m
};

}  // namespace odobench
