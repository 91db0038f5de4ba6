// A lattice of admissible values: what a problem offers whose parameters, or a search over them, are
// discrete.
#pragma once

#include <Eigen/Core>

namespace odobench {

// A point on the lattice that walks by changing one parameter at a time and knows at O(1) what a change would
// cost.
class LatticePoint {
 public:
  virtual ~LatticePoint() = default;
  virtual const Eigen::VectorXd& x() const = 0;
  virtual double cost() const = 0;
  // cost with x_i = value instead, minus cost().
  virtual double change(Eigen::Index i, double value) const = 0;
  virtual void move(Eigen::Index i, double value) = 0;
};

}  // namespace odobench
