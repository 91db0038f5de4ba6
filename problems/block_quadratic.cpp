#include "problems/block_quadratic.hpp"

namespace odobench {
namespace {

class QuadraticPoint final : public LatticePoint {
 public:
  QuadraticPoint(const BlockQuadratic& quadratic, const Eigen::Ref<const Eigen::VectorXd>& x)
      : quadratic_(quadratic), x_(x), gradient_(x.size()), place_(static_cast<std::size_t>(x.size())) {
    cost_ = quadratic_.cost_and_gradient(x_, gradient_);
    for (const QuadraticBlock& block : quadratic_.blocks)
      for (std::size_t i = 0; i < block.index.size(); ++i)
        place_[static_cast<std::size_t>(block.index[i])] = {&block, static_cast<Eigen::Index>(i)};
  }
  const Eigen::VectorXd& x() const override { return x_; }
  double cost() const override { return cost_; }
  double change(Eigen::Index i, double value) const override {
    const Place& place = place_[static_cast<std::size_t>(i)];
    const double d = value - x_[i];
    return d * (gradient_[i] + d * place.block->q(place.row, place.row));
  }
  void move(Eigen::Index i, double value) override {
    const Place& place = place_[static_cast<std::size_t>(i)];
    const double d = value - x_[i];
    x_[i] = value;
    for (std::size_t j = 0; j < place.block->index.size(); ++j)
      gradient_[place.block->index[j]] += 2.0 * d * place.block->q(static_cast<Eigen::Index>(j), place.row);
    cost_ = quadratic_.cost(x_);  // no drift over many moves
  }

 private:
  struct Place {
    const QuadraticBlock* block = nullptr;
    Eigen::Index row = 0;
  };
  const BlockQuadratic& quadratic_;
  Eigen::VectorXd x_, gradient_;
  std::vector<Place> place_;
  double cost_;
};

}  // namespace

Eigen::Index BlockQuadratic::dimension() const {
  Eigen::Index n = 0;
  for (const QuadraticBlock& block : blocks) n += block.g.size();
  return n;
}

double BlockQuadratic::cost(const Eigen::Ref<const Eigen::VectorXd>& x) const {
  double sum = 0;
  for (const QuadraticBlock& block : blocks) {
    const auto size = block.g.size();
    for (Eigen::Index i = 0; i < size; ++i) {
      double row = -block.g[i];
      for (Eigen::Index j = 0; j < size; ++j)
        row += block.q(j, i) * x[block.index[static_cast<std::size_t>(j)]];
      sum += row * x[block.index[static_cast<std::size_t>(i)]];
    }
  }
  return constant + sum;
}

double BlockQuadratic::cost_and_gradient(const Eigen::Ref<const Eigen::VectorXd>& x,
                                         Eigen::Ref<Eigen::VectorXd> gradient) const {
  for (const QuadraticBlock& block : blocks) {
    const auto size = block.g.size();
    for (Eigen::Index i = 0; i < size; ++i) {
      double row = 0;
      for (Eigen::Index j = 0; j < size; ++j)
        row += block.q(j, i) * x[block.index[static_cast<std::size_t>(j)]];
      gradient[block.index[static_cast<std::size_t>(i)]] = 2.0 * row - block.g[i];
    }
  }
  return cost(x);
}

Eigen::VectorXd BlockQuadratic::stacked_g() const {
  Eigen::VectorXd g(dimension());
  Eigen::Index at = 0;
  for (const QuadraticBlock& block : blocks) {
    g.segment(at, block.g.size()) = block.g;
    at += block.g.size();
  }
  return g;
}

Eigen::VectorXd BlockQuadratic::unstack(const Eigen::Ref<const Eigen::VectorXd>& stacked) const {
  Eigen::VectorXd x(stacked.size());
  Eigen::Index at = 0;
  for (const QuadraticBlock& block : blocks)
    for (const Eigen::Index i : block.index) x[i] = stacked[at++];
  return x;
}

std::unique_ptr<LatticePoint> block_quadratic_point(const BlockQuadratic& quadratic,
                                                    const Eigen::Ref<const Eigen::VectorXd>& x) {
  return std::make_unique<QuadraticPoint>(quadratic, x);
}

}  // namespace odobench
