// Costs that are a sum of independent quadratic blocks,
//     cost(x) = constant + sum_B ( x_B' Q_B x_B - g_B' x_B ),    Q_B symmetric positive definite,
// as the relative-entropy filter's windows are: what solvers that use this structure ask a problem for.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "problems/lattice.hpp"

namespace odobench {

struct QuadraticBlock {
  std::vector<Eigen::Index> index;  // which parameters it is about; every parameter belongs to one block
  Eigen::MatrixXd q;                // size x size
  Eigen::VectorXd g;                // size
};

struct BlockQuadratic {
  double constant = 0;
  std::vector<QuadraticBlock> blocks;

  Eigen::Index dimension() const;
  double cost(const Eigen::Ref<const Eigen::VectorXd>& x) const;
  // Returns the cost and fills its gradient 2 Q x - g (dimension).
  double cost_and_gradient(const Eigen::Ref<const Eigen::VectorXd>& x,
                           Eigen::Ref<Eigen::VectorXd> gradient) const;
  // The blocks' g one after the other (dimension), and a point given in that order sorted into parameters.
  Eigen::VectorXd stacked_g() const;
  Eigen::VectorXd unstack(const Eigen::Ref<const Eigen::VectorXd>& stacked) const;
};

struct SearchResult {
  double cost = 0;               // of the blocks, without the constant
  int iterations = 0;            // of the method
  std::int64_t evaluations = 0;  // candidates whose cost was looked at
};

// A search made for given blocks Q_B, run for one linear term after the other: the sliding filter's inner
// loop. Vectors hold the blocks one after the other, x in the order of `g`. Not for two threads at once: it
// owns its scratch memory.
class BlockSearch {
 public:
  virtual ~BlockSearch() = default;
  virtual SearchResult minimise(std::span<const double> g, std::span<double> x) = 0;
};

// A point on a lattice whose cost is such a sum; a change costs O(1), a move O(size of its block).
// `quadratic` outlives the point.
std::unique_ptr<LatticePoint> block_quadratic_point(const BlockQuadratic& quadratic,
                                                    const Eigen::Ref<const Eigen::VectorXd>& x);

}  // namespace odobench
