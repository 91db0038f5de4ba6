#include "problems/classic/test_functions.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace odobench {
namespace {

std::vector<ParameterInfo> box(int n, double start, double low, double high) {
  std::vector<ParameterInfo> list;
  for (int i = 1; i <= n; ++i) list.push_back({fmt::format("x{}", i), "1", start, low, high});
  return list;
}

// Shared members of the models whose cost is a sum of squares given by Derived::residuals_and_jacobian.
struct Base {
  std::string label;
  std::vector<ParameterInfo> list;
  std::string name() const { return label; }
  const std::vector<ParameterInfo>& parameters() const { return list; }
  Eigen::Index dimension() const { return static_cast<Eigen::Index>(list.size()); }
};

struct WithOptimum : Base {
  double known_optimum() const { return 0.0; }
};

// r = A (x - c): sphere, ellipsoid, corner.
template <class B>
struct LinearResiduals : B {
  Matrix a;
  Vector c;
  double cost(const ConstVectorRef& x) const { return (a * (x - c)).squaredNorm(); }
  std::vector<Vector> known_minimisers() const { return {c}; }
  Eigen::Index residual_count() const { return a.rows(); }
  void residuals(const ConstVectorRef& x, VectorRef r) const { r = a * (x - c); }
  void residuals_and_jacobian(const ConstVectorRef& x, VectorRef r, MatrixRef j) const {
    r = a * (x - c);
    j = a;
  }
};

Matrix ellipsoid_matrix(int n) {
  Matrix seed(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) seed(i, j) = std::sin(1.0 + 3.0 * i + 7.0 * j + i * j);
  const Matrix q = Eigen::HouseholderQR<Matrix>(seed).householderQ();
  Vector d(n);
  for (int i = 0; i < n; ++i) d[i] = std::pow(10.0, 3.0 * i / (n - 1));
  return d.asDiagonal() * q;
}

// Minimum of |A (x - c)|^2 in [-1, 1]^n by principal pivoting: from a guess which parameters lie on which
// bound, every one that contradicts the conditions of Karush, Kuhn and Tucker changes its place (one at a
// time when that goes in circles: Murty's rule) until none does, which proves the optimum. Empty when that
// takes more than 1000 changes.
std::optional<Vector> corner_of_box(const Matrix& a, const Vector& c) {
  const Eigen::Index n = c.size();
  Eigen::VectorXi side = Eigen::VectorXi::Zero(n);  // -1, 1: on that bound; 0: free
  for (int change = 0; change < 1000; ++change) {
    std::vector<Eigen::Index> free;
    Vector x = side.cast<double>();
    for (Eigen::Index i = 0; i < n; ++i)
      if (side[i] == 0) free.push_back(i);
    if (!free.empty()) x(free) = a(Eigen::all, free).colPivHouseholderQr().solve(a * (c - x)).eval();
    const Vector gradient = a.transpose() * (a * (x - c));
    bool right = true;
    for (Eigen::Index i = 0; i < n && (right || change < 100); ++i) {
      int next = side[i];
      if (side[i] == 0 && std::abs(x[i]) > 1)
        next = x[i] < 0 ? -1 : 1;
      else if (side[i] * gradient[i] > 0)
        next = 0;
      right = right && next == side[i];
      side[i] = next;
    }
    if (right) return x;
  }
  return std::nullopt;
}

struct Corner : LinearResiduals<Base> {
  Corner(const std::string& title, int n)
      : LinearResiduals<Base>{{title, box(n, 0.0, -1, 1)},
                              ellipsoid_matrix(n),
                              Vector::LinSpaced(n, -3.0, 2.0)},
        best(corner_of_box(a, c)) {}
  std::optional<double> known_optimum() const { return best ? std::optional(cost(*best)) : std::nullopt; }
  std::vector<Vector> known_minimisers() const { return best ? std::vector{*best} : std::vector<Vector>{}; }
  std::optional<Vector> best;
};

struct Rosenbrock : WithOptimum {
  double cost(const ConstVectorRef& x) const {
    Vector r(residual_count());
    residuals(x, r);
    return r.squaredNorm();
  }
  std::vector<Vector> known_minimisers() const { return {Vector::Ones(dimension())}; }
  Eigen::Index residual_count() const { return 2 * (dimension() - 1); }
  void residuals(const ConstVectorRef& x, VectorRef r) const {
    for (Eigen::Index i = 0; i + 1 < x.size(); ++i) {
      r[2 * i] = 10.0 * (x[i + 1] - x[i] * x[i]);
      r[2 * i + 1] = 1.0 - x[i];
    }
  }
  void residuals_and_jacobian(const ConstVectorRef& x, VectorRef r, MatrixRef j) const {
    residuals(x, r);
    j.setZero();
    for (Eigen::Index i = 0; i + 1 < x.size(); ++i) {
      j(2 * i, i) = -20.0 * x[i];
      j(2 * i, i + 1) = 10.0;
      j(2 * i + 1, i) = -1.0;
    }
  }
};

struct Powell : WithOptimum {
  double cost(const ConstVectorRef& x) const {
    Vector r(4);
    residuals(x, r);
    return r.squaredNorm();
  }
  std::vector<Vector> known_minimisers() const { return {Vector::Zero(4)}; }
  Eigen::Index residual_count() const { return 4; }
  void residuals(const ConstVectorRef& x, VectorRef r) const {
    r[0] = x[0] + 10.0 * x[1];
    r[1] = std::sqrt(5.0) * (x[2] - x[3]);
    r[2] = (x[1] - 2.0 * x[2]) * (x[1] - 2.0 * x[2]);
    r[3] = std::sqrt(10.0) * (x[0] - x[3]) * (x[0] - x[3]);
  }
  void residuals_and_jacobian(const ConstVectorRef& x, VectorRef r, MatrixRef j) const {
    residuals(x, r);
    const double s = 2.0 * (x[1] - 2.0 * x[2]);
    const double t = 2.0 * std::sqrt(10.0) * (x[0] - x[3]);
    j << 1, 10, 0, 0, 0, 0, std::sqrt(5.0), -std::sqrt(5.0), 0, s, -2 * s, 0, t, 0, 0, -t;
  }
};

struct Rastrigin : WithOptimum {
  // Each term is a difference of numbers up to 10.
  double rounding_floor(const ConstVectorRef& x) const {
    return 20.0 * std::numeric_limits<double>::epsilon() * static_cast<double>(x.size());
  }
  double cost(const ConstVectorRef& x) const {
    Vector g(x.size());
    return cost_and_gradient(x, g);
  }
  double cost_and_gradient(const ConstVectorRef& x, VectorRef g) const {
    constexpr double kTau = 2.0 * std::numbers::pi;
    double sum = 0;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      sum += x[i] * x[i] - 10.0 * std::cos(kTau * x[i]) + 10.0;
      g[i] = 2.0 * x[i] + 10.0 * kTau * std::sin(kTau * x[i]);
    }
    return sum;
  }
  std::vector<Vector> known_minimisers() const { return {Vector::Zero(dimension())}; }
};

struct Step : WithOptimum {
  double cost(const ConstVectorRef& x) const { return (4.0 * x.array()).abs().floor().sum(); }
};

}  // namespace

std::vector<ClassicEntry> test_function_entries() {
  const DimensionRule any = DimensionRule::at_least(2);
  const auto squares = [](int n) { return 2 * (n - 1); };
  return {{"sphere", "classic", 12, any, 12, "sum of squares of x_i - 1/3", 0.0},
          {"ellipsoid", "classic", 12, any, 12, "rotated quadratic valley of condition 1e6", 0.0},
          {"corner", "classic", 12, any, 12, "the ellipsoid with its centre outside the box",
           make_test_function("corner", 12).known_optimum()},
          {"rosenbrock", "classic", 12, any, squares(12), "Rosenbrock (1960), chained", 0.0},
          {"powell", "classic", 4, DimensionRule::exactly(4), 4, "Powell (1962), singular", 0.0},
          {"rastrigin", "classic", 12, any, 0, "Rastrigin (1974): many local minima", 0.0},
          {"step", "classic", 12, any, 0, "piecewise constant: no derivatives", 0.0}};
}

Problem make_test_function(const std::string& name, int n) {
  if (name == "sphere")
    return Problem(LinearResiduals<WithOptimum>{
        {{name, box(n, -0.5, -1, 1)}}, Matrix::Identity(n, n), Vector::Constant(n, 1.0 / 3)});
  if (name == "ellipsoid")
    return Problem(LinearResiduals<WithOptimum>{
        {{name, box(n, -0.5, -1, 1)}}, ellipsoid_matrix(n), Vector::LinSpaced(n, -0.4, 0.6)});
  if (name == "corner") return Problem(Corner(name, n));
  if (name == "rosenbrock") return Problem(Rosenbrock{{{name, box(n, -1.2, -2, 2)}}});
  if (name == "powell") return Problem(Powell{{{name, box(n, 1.0, -4, 5)}}});
  if (name == "rastrigin") return Problem(Rastrigin{{{name, box(n, 2.2, -5.12, 4.12)}}});
  if (name == "step") return Problem(Step{{{name, box(n, 0.9, -1, 1)}}});
  throw std::invalid_argument(fmt::format("unknown problem '{}'", name));
}

}  // namespace odobench
