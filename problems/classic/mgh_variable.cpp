#include <cmath>

#include "problems/classic/mgh_functions.hpp"

namespace odobench {
namespace {

using Eigen::Index;

int as_many(int n) {
  return n;
}

int twice(int n) {
  return 2 * n;
}

Vector ones(int n) {
  return Vector::Ones(n);
}

Vector halves(int n) {
  return Vector::Constant(n, 0.5);
}

Vector minus_ones(int n) {
  return Vector::Constant(n, -1.0);
}

Vector repeated(const Eigen::RowVectorXd& block, int n) {
  return block.transpose().replicate(n / block.size(), 1);
}

// t_i (t_i - 1) on an even grid: zero at both ends.
Vector parabola(int n) {
  const Vector t = Vector::LinSpaced(n, 1.0, n) / (n + 1.0);
  return t.array() * (t.array() - 1.0);
}

// A polynomial p that should fulfil p' = 1 + p^2 at t_i = i / 29 and p(0) = 0.
void watson(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  for (Index i = 0; i < 29; ++i) {
    const double t = static_cast<double>(i + 1) / 29;
    double slope = 0, value = 0;
    for (Index k = x.size() - 1; k >= 0; --k) {
      value = value * t + x[k];
      if (k > 0) slope = slope * t + static_cast<double>(k) * x[k];
    }
    r[i] = slope - value * value - 1;
    if (!j) continue;
    double power = 1;  // t^k
    for (Index k = 0; k < x.size(); ++k, power *= t) {
      (*j)(i, k) += -2 * value * power;
      if (k + 1 < x.size()) (*j)(i, k + 1) = static_cast<double>(k + 1) * power;
    }
  }
  r[29] = x[0];
  r[30] = x[1] - x[0] * x[0] - 1;
  if (!j) return;
  (*j)(29, 0) = 1;
  (*j)(30, 0) = -2 * x[0];
  (*j)(30, 1) = 1;
}

void extended_rosenbrock(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  for (Index i = 0; i < x.size(); i += 2) {
    r[i] = 10 * (x[i + 1] - x[i] * x[i]);
    r[i + 1] = 1 - x[i];
    if (j) j->block(i, i, 2, 2) << -20 * x[i], 10, -1, 0;
  }
}

void extended_powell_singular(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  const double a = std::sqrt(5.0), b = std::sqrt(10.0);
  for (Index i = 0; i < x.size(); i += 4) {
    const double u = x[i + 1] - 2 * x[i + 2], v = x[i] - x[i + 3];
    r.segment(i, 4) << x[i] + 10 * x[i + 1], a * (x[i + 2] - x[i + 3]), u * u, b * v * v;
    if (j) j->block(i, i, 4, 4) << 1, 10, 0, 0, 0, 0, a, -a, 0, 2 * u, -4 * u, 0, 2 * b * v, 0, 0, -2 * b * v;
  }
}

void penalty_1(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  const Index n = x.size();
  const double a = std::sqrt(1e-5);
  r.head(n) = a * (x.array() - 1);
  r[n] = x.squaredNorm() - 0.25;
  if (!j) return;
  j->diagonal().setConstant(a);
  j->row(n) = 2 * x.transpose();
}

void penalty_2(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  const Index n = x.size();
  const double a = std::sqrt(1e-5);
  const Vector e = (x.array() / 10).exp();
  r[0] = x[0] - 0.2;
  r[2 * n - 1] = -1;
  if (j) (*j)(0, 0) = 1;
  for (Index i = 1; i < n; ++i) {
    const double k = static_cast<double>(i + 1);
    r[i] = a * (e[i] + e[i - 1] - (std::exp(k / 10) + std::exp((k - 1) / 10)));
    r[n + i - 1] = a * (e[i] - std::exp(-0.1));
    if (!j) continue;
    (*j)(i, i) = a * e[i] / 10;
    (*j)(i, i - 1) = a * e[i - 1] / 10;
    (*j)(n + i - 1, i) = a * e[i] / 10;
  }
  for (Index i = 0; i < n; ++i) {
    const double weight = static_cast<double>(n - i);
    r[2 * n - 1] += weight * x[i] * x[i];
    if (j) (*j)(2 * n - 1, i) = 2 * weight * x[i];
  }
}

void variably_dimensioned(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  const Index n = x.size();
  const Vector weight = Vector::LinSpaced(n, 1.0, static_cast<double>(n));
  const double sum = weight.dot((x.array() - 1).matrix());
  r.head(n) = x.array() - 1;
  r[n] = sum;
  r[n + 1] = sum * sum;
  if (!j) return;
  j->diagonal().setOnes();
  j->row(n) = weight.transpose();
  j->row(n + 1) = 2 * sum * weight.transpose();
}

void trigonometric(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  const Index n = x.size();
  // n - sum cos x_j without the cancellation that would leave a cost of 1e-30 at x = 0.
  const double sum = 2 * (x.array() / 2).sin().square().sum();
  for (Index i = 0; i < n; ++i) {
    const double k = static_cast<double>(i + 1);
    r[i] = sum + k * 2 * square(std::sin(x[i] / 2)) - std::sin(x[i]);
    if (!j) continue;
    j->row(i) = x.array().sin().matrix().transpose();
    (*j)(i, i) += k * std::sin(x[i]) - std::cos(x[i]);
  }
}

void brown_almost_linear(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  const Index n = x.size();
  const double sum = x.sum() - static_cast<double>(n + 1);
  r = x.array() + sum;
  r[n - 1] = x.prod() - 1;
  if (!j) return;
  j->topRows(n - 1).setOnes();
  j->topRows(n - 1).diagonal().setConstant(2);
  // Products of all but one without division: x_k may be zero.
  double left = 1, right = 1;
  j->row(n - 1).setOnes();
  for (Index i = 0; i < n; ++i) {
    (*j)(n - 1, i) *= left;
    (*j)(n - 1, n - 1 - i) *= right;
    left *= x[i];
    right *= x[n - 1 - i];
  }
}

void discrete_boundary_value(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  const Index n = x.size();
  const double h = 1.0 / static_cast<double>(n + 1);
  for (Index i = 0; i < n; ++i) {
    const double s = x[i] + static_cast<double>(i + 1) * h + 1;
    r[i] = 2 * x[i] - (i > 0 ? x[i - 1] : 0) - (i + 1 < n ? x[i + 1] : 0) + h * h * s * s * s / 2;
    if (!j) continue;
    (*j)(i, i) = 2 + 1.5 * h * h * s * s;
    if (i > 0) (*j)(i, i - 1) = -1;
    if (i + 1 < n) (*j)(i, i + 1) = -1;
  }
}

void discrete_integral_equation(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  const Index n = x.size();
  const double h = 1.0 / static_cast<double>(n + 1);
  for (Index i = 0; i < n; ++i) {
    const double ti = static_cast<double>(i + 1) * h;
    double sum = 0;
    for (Index k = 0; k < n; ++k) {
      const double tk = static_cast<double>(k + 1) * h, s = x[k] + tk + 1;
      const double weight = k <= i ? (1 - ti) * tk : ti * (1 - tk);
      sum += weight * s * s * s;
      if (j) (*j)(i, k) = 1.5 * h * weight * s * s;
    }
    r[i] = x[i] + h * sum / 2;
    if (j) (*j)(i, i) += 1;
  }
}

void broyden_tridiagonal(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  const Index n = x.size();
  for (Index i = 0; i < n; ++i) {
    r[i] = (3 - 2 * x[i]) * x[i] - (i > 0 ? x[i - 1] : 0) - (i + 1 < n ? 2 * x[i + 1] : 0) + 1;
    if (!j) continue;
    (*j)(i, i) = 3 - 4 * x[i];
    if (i > 0) (*j)(i, i - 1) = -1;
    if (i + 1 < n) (*j)(i, i + 1) = -2;
  }
}

void broyden_banded(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  const Index n = x.size();
  for (Index i = 0; i < n; ++i) {
    r[i] = x[i] * (2 + 5 * x[i] * x[i]) + 1;
    if (j) (*j)(i, i) = 2 + 15 * x[i] * x[i];
    for (Index k = std::max<Index>(0, i - 5); k <= std::min(n - 1, i + 1); ++k) {
      if (k == i) continue;
      r[i] -= x[k] * (1 + x[k]);
      if (j) (*j)(i, k) = -1 - 2 * x[k];
    }
  }
}

void linear_full_rank(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  const double scale = 2 / static_cast<double>(r.size());
  r.setConstant(-scale * x.sum() - 1);
  r.head(x.size()) += x;
  if (!j) return;
  j->setConstant(-scale);
  j->diagonal().array() += 1;
}

void linear_rank_1(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  const Index n = x.size(), m = r.size();
  const Vector columns = Vector::LinSpaced(n, 1.0, static_cast<double>(n));
  const Vector rows = Vector::LinSpaced(m, 1.0, static_cast<double>(m));
  r = rows.array() * columns.dot(x) - 1;
  if (j) *j = rows * columns.transpose();
}

void linear_rank_1_zero(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  const Index n = x.size(), m = r.size();
  Vector columns = Vector::LinSpaced(n, 1.0, static_cast<double>(n));
  Vector rows = Vector::LinSpaced(m, 0.0, static_cast<double>(m - 1));
  columns[0] = columns[n - 1] = rows[m - 1] = 0;
  r = rows.array() * columns.dot(x) - 1;
  if (j) *j = rows * columns.transpose();
}

// Means of the shifted Chebyshev polynomials over the abscissae x_j against their integrals over [0, 1].
void chebyquad(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  const Index n = x.size(), m = r.size();
  const double weight = 1 / static_cast<double>(n);
  r.setZero();
  for (Index k = 0; k < n; ++k) {
    const double u = 2 * x[k] - 1;
    double before = 1, now = u, slope_before = 0, slope = 2;
    for (Index i = 0; i < m; ++i) {
      r[i] += weight * now;
      if (j) (*j)(i, k) = weight * slope;
      const double next = 2 * u * now - before, slope_next = 4 * now + 2 * u * slope - slope_before;
      before = now, now = next, slope_before = slope, slope = slope_next;
    }
  }
  for (Index i = 1; i < m; i += 2) r[i] += 1 / (square(static_cast<double>(i + 1)) - 1);
}

}  // namespace

const std::vector<MghFunction>& mgh_variable_functions() {
  const auto at_least = [](int n, int step = 1) { return DimensionRule::at_least(n, step); };
  static const std::vector<MghFunction> list{
      {"watson", "20, Watson", 6, DimensionRule{2, 31, 1}, [](int) { return 31; },
       [](int n) -> Vector { return Vector::Zero(n); }, watson},
      {"extended-rosenbrock", "21, extended Rosenbrock", 10, at_least(2, 2), as_many,
       [](int n) { return repeated(Eigen::RowVector2d(-1.2, 1), n); }, extended_rosenbrock},
      {"extended-powell-singular", "22, extended Powell, singular", 12, at_least(4, 4), as_many,
       [](int n) { return repeated(Eigen::RowVector4d(3, -1, 0, 1), n); }, extended_powell_singular},
      {"penalty-1", "23, penalty function I", 10, at_least(2), [](int n) { return n + 1; },
       [](int n) -> Vector { return Vector::LinSpaced(n, 1.0, n); }, penalty_1},
      {"penalty-2", "24, penalty function II", 10, at_least(2), twice, halves, penalty_2},
      {"variably-dimensioned", "25, variably dimensioned", 10, at_least(2), [](int n) { return n + 2; },
       [](int n) -> Vector { return 1 - Eigen::ArrayXd::LinSpaced(n, 1.0, n) / n; }, variably_dimensioned},
      {"trigonometric", "26, trigonometric", 10, at_least(2), as_many,
       [](int n) -> Vector { return Vector::Constant(n, 1.0 / n); }, trigonometric},
      {"brown-almost-linear", "27, Brown, almost linear", 10, at_least(2), as_many, halves,
       brown_almost_linear},
      {"discrete-boundary-value", "28, discrete boundary value", 10, at_least(2), as_many, parabola,
       discrete_boundary_value},
      {"discrete-integral-equation", "29, discrete integral equation", 10, at_least(2), as_many, parabola,
       discrete_integral_equation},
      {"broyden-tridiagonal", "30, Broyden, tridiagonal", 10, at_least(2), as_many, minus_ones,
       broyden_tridiagonal},
      {"broyden-banded", "31, Broyden, banded", 10, at_least(2), as_many, minus_ones, broyden_banded},
      {"linear-full-rank", "32, linear, full rank", 10, at_least(2), twice, ones, linear_full_rank},
      {"linear-rank-1", "33, linear, rank 1", 10, at_least(2), twice, ones, linear_rank_1},
      {"linear-rank-1-zero", "34, linear, rank 1 with zero columns and rows", 10, at_least(3), twice, ones,
       linear_rank_1_zero},
      {"chebyquad", "35, Chebyquad", 8, at_least(2), as_many,
       [](int n) -> Vector { return Vector::LinSpaced(n, 1.0, n) / (n + 1.0); }, chebyquad}};
  return list;
}

}  // namespace odobench
