#include "solvers/lattice/ternary_blocks.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace odobench {

void check_blocks(const std::vector<QuadraticBlock>& blocks) {
  if (blocks.empty() || blocks.size() > 64)
    throw std::invalid_argument(fmt::format("quadratic blocks: found {}, expected 1 to 64", blocks.size()));
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const Eigen::MatrixXd& q = blocks[b].q;
    const auto refuse = [&](const char* what) {
      throw std::invalid_argument(fmt::format("quadratic block {}: {}", b + 1, what));
    };
    if (q.rows() == 0 || q.rows() != q.cols() || q.rows() != blocks[b].g.size() ||
        q.rows() != static_cast<Eigen::Index>(blocks[b].index.size()))
      refuse("sizes of Q, g and the list of parameters differ or are 0");
    if (!q.allFinite()) refuse("Q is not finite");
    if (!q.isApprox(q.transpose(), 1e-12)) refuse("Q is not symmetric");
    if (Eigen::LLT<Eigen::MatrixXd>(q).info() != Eigen::Success) refuse("Q is not positive definite");
  }
}

namespace {

// One node of the tree: which variables are still free, and s = g - 2 Q t of the fixed ones.
struct Node {
  std::vector<int> free;
  Eigen::VectorXd s, t;
  double cost = 0;
};

class Tree {
 public:
  Tree(const Eigen::MatrixXd& q, const std::function<bool()>& stop, Eigen::Ref<Eigen::VectorXd> best,
       double best_cost)
      : q_(q), stop_(stop), best_(best), best_cost_(best_cost) {}

  void descend(Node node) {
    if (++nodes % 256 == 0 && stop_ && stop_()) stopped_ = true;
    if (stopped_) return;
    fix_what_no_choice_can_turn(node);
    if (node.free.empty()) {
      if (node.cost < best_cost_) {
        best_cost_ = node.cost;
        best_ = node.t;
      }
      return;
    }
    const Eigen::VectorXd relaxed = relax(node);
    if (lower_bound(node, relaxed) >= best_cost_) return;

    std::size_t branch = 0;  // the variable that is furthest from any level
    double furthest = -1;
    for (std::size_t f = 0; f < node.free.size(); ++f) {
      const double x = relaxed[static_cast<Eigen::Index>(f)], distance = std::abs(x - std::round(x));
      if (distance <= furthest) continue;
      furthest = distance;
      branch = f;
    }
    const double x = relaxed[static_cast<Eigen::Index>(branch)];
    std::array<double, 3> levels = {-1, 0, 1};
    std::sort(levels.begin(), levels.end(),
              [x](double a, double b) { return std::abs(a - x) < std::abs(b - x); });
    for (const double level : levels) {
      Node child = node;
      fix(child, branch, level);
      descend(std::move(child));
    }
  }

  double best_cost() const { return best_cost_; }
  std::int64_t nodes = 0;

 private:
  void fix(Node& node, std::size_t f, double value) const {
    const int i = node.free[f];
    node.cost += value * (value * q_(i, i) - node.s[i]);
    node.t[i] = value;
    node.s -= 2.0 * value * q_.col(i);
    node.free.erase(node.free.begin() + static_cast<std::ptrdiff_t>(f));
  }

  void fix_what_no_choice_can_turn(Node& node) const {
    for (std::size_t f = 0; f < node.free.size();) {
      const int i = node.free[f];
      double others = 0;
      for (const int j : node.free)
        if (j != i) others += 2.0 * std::abs(q_(i, j));
      const double slope = std::abs(node.s[i]);
      if (slope - others > q_(i, i)) {
        fix(node, f, node.s[i] > 0 ? 1 : -1);
        f = 0;
      } else if (slope + others < q_(i, i)) {
        fix(node, f, 0);
        f = 0;
      } else {
        ++f;
      }
    }
  }

  // A few sweeps of coordinate descent on the box: near the relaxation's optimum is near enough, see
  // lower_bound.
  Eigen::VectorXd relax(const Node& node) const {
    const auto size = static_cast<Eigen::Index>(node.free.size());
    Eigen::VectorXd x = Eigen::VectorXd::Zero(size);
    for (int sweep = 0; sweep < 20; ++sweep)
      for (Eigen::Index f = 0; f < size; ++f) {
        const int i = node.free[static_cast<std::size_t>(f)];
        double slope = node.s[i];
        for (Eigen::Index h = 0; h < size; ++h)
          if (h != f) slope -= 2.0 * q_(i, node.free[static_cast<std::size_t>(h)]) * x[h];
        x[f] = std::clamp(slope / (2.0 * q_(i, i)), -1.0, 1.0);
      }
    return x;
  }

  // By convexity no point of the box lies below the tangent at x, whatever x is.
  double lower_bound(const Node& node, const Eigen::VectorXd& x) const {
    double bound = node.cost;
    for (Eigen::Index f = 0; f < x.size(); ++f) {
      const int i = node.free[static_cast<std::size_t>(f)];
      double qx = 0;
      for (Eigen::Index h = 0; h < x.size(); ++h) qx += q_(i, node.free[static_cast<std::size_t>(h)]) * x[h];
      const double gradient = 2.0 * qx - node.s[i];
      bound += x[f] * (qx - node.s[i]) - std::abs(gradient) - gradient * x[f];
    }
    return bound;
  }

  const Eigen::MatrixXd& q_;
  const std::function<bool()>& stop_;
  Eigen::Ref<Eigen::VectorXd> best_;
  double best_cost_;
  bool stopped_ = false;
};

}  // namespace

TernaryBranchAndBound::TernaryBranchAndBound(const Eigen::MatrixXd& q) : q_(q) {}

double TernaryBranchAndBound::minimise(const Eigen::Ref<const Eigen::VectorXd>& g,
                                       Eigen::Ref<Eigen::VectorXd> t, const std::function<bool()>& stop,
                                       std::int64_t& nodes) const {
  Tree tree(q_, stop, t, t.dot(q_ * t - g));
  Node root{{}, g, Eigen::VectorXd::Zero(g.size()), 0};
  for (int i = 0; i < static_cast<int>(g.size()); ++i) root.free.push_back(i);
  tree.descend(std::move(root));
  nodes += tree.nodes;
  return tree.best_cost();
}

}  // namespace odobench
