#include "problems/classic/more_garbow_hillstrom.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "problems/classic/mgh_functions.hpp"

namespace odobench {
namespace {

constexpr std::array kFactors{1, 10, 100};

Vector far_start(const MghFunction& function, int n, int factor) {
  const Vector start = function.start(n);
  if (factor != 1 && start.isZero(0)) return Vector::Constant(n, factor);
  return factor * start;
}

class LeastSquares {
 public:
  LeastSquares(std::string name, const MghFunction& function, int n, int factor)
      : name_(std::move(name)),
        evaluate_(function.evaluate),
        residual_count_(function.residual_count(n)),
        optimum_(mgh_optimum(function.name, n, function.residual_count(n))) {
    const Vector start = far_start(function, n, factor);
    for (int i = 0; i < n; ++i) {
      double most = std::max(1.0, std::abs(start[i]));
      for (const Vector& x : optimum_.minimisers) most = std::max(most, std::abs(x[i]));
      parameters_.push_back({fmt::format("x{}", i + 1), "1", start[i], -10 * most, 10 * most});
    }
  }
  std::string name() const { return name_; }
  const std::vector<ParameterInfo>& parameters() const { return parameters_; }
  std::optional<double> known_optimum() const { return optimum_.cost; }
  const std::vector<Vector>& known_minimisers() const { return optimum_.minimisers; }
  Eigen::Index residual_count() const { return residual_count_; }

  double cost(const ConstVectorRef& x) const {
    Vector r(residual_count_);
    residuals(x, r);
    return r.squaredNorm();
  }
  void residuals(const ConstVectorRef& x, VectorRef r) const { evaluate_(x, r, nullptr); }
  void residuals_and_jacobian(const ConstVectorRef& x, VectorRef r, MatrixRef j) const {
    j.setZero();
    evaluate_(x, r, &j);
  }

 private:
  std::string name_;
  decltype(MghFunction::evaluate) evaluate_;
  Eigen::Index residual_count_;
  MghOptimum optimum_;
  std::vector<ParameterInfo> parameters_;
};

std::string problem_name(const MghFunction& function, int factor) {
  return factor == 1 ? fmt::format("mgh:{}", function.name) : fmt::format("mgh:{}/{}", function.name, factor);
}

void for_each(const std::function<void(const MghFunction&, int factor)>& act) {
  for (const std::vector<MghFunction>* list : {&mgh_fixed_functions(), &mgh_variable_functions()})
    for (const MghFunction& function : *list)
      for (const int factor : kFactors) act(function, factor);
}

}  // namespace

std::vector<ClassicEntry> mgh_entries() {
  std::vector<ClassicEntry> list;
  for_each([&](const MghFunction& f, int factor) {
    const int n = f.dimension, m = f.residual_count(n);
    const std::string where = factor == 1 ? "" : fmt::format(", {} times the start", factor);
    list.push_back({problem_name(f, factor), "mgh", n, f.dimensions, m,
                    fmt::format("More, Garbow, Hillstrom (1981) {}{}", f.title, where),
                    mgh_optimum(f.name, n, m).cost});
  });
  return list;
}

Problem make_mgh_problem(const std::string& name, int dimension) {
  std::optional<Problem> problem;
  for_each([&](const MghFunction& function, int factor) {
    if (name == problem_name(function, factor))
      problem.emplace(LeastSquares(name, function, dimension, factor));
  });
  if (!problem) throw std::invalid_argument(fmt::format("unknown problem '{}'", name));
  return *problem;
}

}  // namespace odobench
