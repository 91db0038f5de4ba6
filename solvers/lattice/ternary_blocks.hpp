// What the searches over ternary blocks share.
#pragma once

#include <functional>
#include <vector>

#include "problems/problem.hpp"
#include "solvers/lattice/ternary_kernel.hpp"

namespace odobench {

namespace ternary {
inline int padded(int n) {
  return (n + kPad - 1) / kPad * kPad;
}
}  // namespace ternary

// Throws std::invalid_argument on a block that is not square, finite, symmetric and positive definite, or
// whose sizes do not agree; at most 64 blocks.
void check_blocks(const std::vector<QuadraticBlock>& blocks);

// Exact minimum of t'Qt - g't over {-1, 0, 1}^n for any n, depth first.
class TernaryBranchAndBound {
 public:
  explicit TernaryBranchAndBound(const Eigen::MatrixXd& q);
  // `t` (n): in a start, the first incumbent; out the best point. Returns its cost. `stop` may be empty.
  double minimise(const Eigen::Ref<const Eigen::VectorXd>& g, Eigen::Ref<Eigen::VectorXd> t,
                  const std::function<bool()>& stop, std::int64_t& nodes) const;

 private:
  Eigen::MatrixXd q_;
};

}  // namespace odobench
