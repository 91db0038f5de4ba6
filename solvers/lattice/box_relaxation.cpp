#include "solvers/box/box_quadratic.hpp"
#include "solvers/lattice/ternary_blocks.hpp"
#include "solvers/lattice/ternary_search.hpp"

namespace odobench {
namespace {

class BoxRelaxation final : public BlockSearch {
 public:
  explicit BoxRelaxation(const std::vector<QuadraticBlock>& blocks) {
    check_blocks(blocks);
    for (const QuadraticBlock& block : blocks) hessians_.push_back(2.0 * block.q);
  }

  SearchResult minimise(std::span<const double> g, std::span<double> x) override {
    SearchResult result;
    result.iterations = 1;
    const double* from = g.data();
    double* to = x.data();
    for (const Eigen::MatrixXd& hessian : hessians_) {
      const Eigen::Index n = hessian.rows();
      const Eigen::Map<const Vector> linear(from, n);
      const Vector best =
          solve_box_quadratic(hessian, -linear, Vector::Constant(n, -1.0), Vector::Constant(n, 1.0));
      Eigen::Map<Vector>(to, n) = best;
      result.cost += best.dot(0.5 * (hessian * best) - linear);
      ++result.evaluations;
      from += n;
      to += n;
    }
    return result;
  }

 private:
  std::vector<Eigen::MatrixXd> hessians_;
};

}  // namespace

std::unique_ptr<BlockSearch> box_relaxation(const std::vector<QuadraticBlock>& blocks) {
  return std::make_unique<BoxRelaxation>(blocks);
}

}  // namespace odobench
