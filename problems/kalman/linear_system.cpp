#include "problems/kalman/linear_system.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <unsupported/Eigen/MatrixFunctions>

#include "problems/kalman/covariance.hpp"

namespace odobench {
namespace {

[[noreturn]] void refuse(const LinearSystem& system, const std::string& what) {
  throw std::invalid_argument(
      fmt::format("linear system '{}': {}", system.name.empty() ? "without a name" : system.name, what));
}

std::string size_text(const Matrix& m) {
  return fmt::format("{} x {}", m.rows(), m.cols());
}

void check_names(const LinearSystem& system, const char* what, std::size_t names, Eigen::Index size) {
  if (names != 0 && names != static_cast<std::size_t>(size))
    refuse(system, fmt::format("{} names of {}, expected {}", names, what, size));
}

void check_period(double period) {
  if (!std::isfinite(period) || period <= 0)
    throw std::invalid_argument(fmt::format("period {}: expected a finite number > 0", period));
}

double one_norm(const Matrix& m) {
  return m.size() == 0 ? 0.0 : m.cwiseAbs().colwise().sum().maxCoeff();
}

// A factor by which a block is multiplied so that it does not decide how often the exponential is squared:
// columns of different size would cost digits of the smaller ones.
double balance(double block, double of) {
  return block > 0 ? (of > 0 ? of / block : 1 / block) : 1.0;
}

Matrix noise_intensity(const LinearSystem& system) {
  const Matrix w = system.g * system.qc * system.g.transpose();
  return 0.5 * (w + w.transpose());
}

// Van Loan over a step h with |A| h <= 1, where e^{-Ah} is harmless, then doubled: Q(2h) = Q(h) + F(h) Q(h)
// F(h)'.
Matrix noise_covariance(const LinearSystem& system, double period) {
  const Eigen::Index n = system.a.rows();
  if (system.g.cols() == 0) return Matrix::Zero(n, n);
  const Matrix w = noise_intensity(system);
  int doublings = 0;
  double h = period;
  for (; one_norm(system.a) * h > 1 && doublings < 2000; ++doublings) h /= 2;
  const double scale = balance(one_norm(w), std::max(one_norm(system.a), 1 / h));
  Matrix block = Matrix::Zero(2 * n, 2 * n);
  block.topLeftCorner(n, n) = -system.a * h;
  block.topRightCorner(n, n) = scale * h * w;
  block.bottomRightCorner(n, n) = system.a.transpose() * h;
  const Matrix e = block.exp();
  Matrix f = e.bottomRightCorner(n, n).transpose();
  Matrix q = f * e.topRightCorner(n, n) / scale;
  for (; doublings > 0; --doublings) {
    q += f * q * f.transpose();
    f *= f;
  }
  return 0.5 * (q + q.transpose());
}

double largest_difference(const Matrix& x, const Matrix& y) {
  return x.size() == 0 ? 0.0 : (x - y).cwiseAbs().maxCoeff();
}

}  // namespace

void validate(const LinearSystem& system) {
  const Eigen::Index n = system.a.rows();
  if (n == 0 || system.a.cols() != n)
    refuse(system, fmt::format("A is {}, expected a square matrix", size_text(system.a)));
  const auto rows = [&](const char* name, const Matrix& m) {
    if (m.cols() > 0 && m.rows() != n)
      refuse(system, fmt::format("{} is {}, expected {} rows as in A", name, size_text(m), n));
  };
  rows("B", system.b);
  rows("G", system.g);
  if (system.qc.rows() != system.g.cols() || system.qc.cols() != system.g.cols())
    refuse(system, fmt::format("Qc is {}, expected {} x {} as G has columns", size_text(system.qc),
                               system.g.cols(), system.g.cols()));
  check_names(system, "states", system.states.size(), n);
  check_names(system, "inputs", system.inputs.size(), system.b.cols());
  check_names(system, "noises", system.noises.size(), system.g.cols());
  for (const auto& [name, m] : {std::pair<const char*, const Matrix*>{"A", &system.a},
                                {"B", &system.b},
                                {"G", &system.g},
                                {"Qc", &system.qc}})
    if (!m->allFinite()) refuse(system, fmt::format("{} has an entry that is not finite", name));
  if (system.qc.size() > 0) {
    try {
      require_covariance("Qc", system.qc, Definiteness::Semidefinite);
    } catch (const std::invalid_argument& error) {
      refuse(system, error.what());
    }
  }
}

Discretisation discretise(const LinearSystem& system, double period) {
  validate(system);
  check_period(period);
  const Eigen::Index n = system.a.rows(), m = system.b.cols(), p = system.g.cols();
  Matrix block = Matrix::Zero(n + m + p, n + m + p);
  const double most = std::max(one_norm(system.a), 1 / period);
  const double scale_b = balance(one_norm(system.b), most), scale_g = balance(one_norm(system.g), most);
  block.topLeftCorner(n, n) = system.a * period;
  if (m > 0) block.block(0, n, n, m) = scale_b * period * system.b;
  if (p > 0) block.block(0, n + m, n, p) = scale_g * period * system.g;
  const Matrix e = block.exp();
  Discretisation d;
  d.f = e.topLeftCorner(n, n);
  d.psi = e.block(0, n, n, m) / scale_b;
  d.gamma = e.block(0, n + m, n, p) / scale_g;
  d.q = noise_covariance(system, period);
  if (!d.f.allFinite() || !d.psi.allFinite() || !d.gamma.allFinite() || !d.q.allFinite())
    refuse(system, fmt::format("the matrices for the period {} leave the range of a double", period));
  return d;
}

Matrix piecewise_constant_noise(const ConstMatrixRef& gamma, const ConstMatrixRef& w) {
  if (w.rows() != gamma.cols() || w.cols() != gamma.cols())
    throw std::invalid_argument(
        fmt::format("noise covariance is {} x {}, expected {} x {} as Gamma has columns", w.rows(), w.cols(),
                    gamma.cols(), gamma.cols()));
  const Matrix q = gamma * w * gamma.transpose();
  return 0.5 * (q + q.transpose());
}

SeriesDiscretisation discretise_series(const LinearSystem& system, double period, int order) {
  if (order < 1 || order > kMaxSeriesOrder - 2)
    throw std::invalid_argument(fmt::format("series order {}: expected 1 .. {}", order, kMaxSeriesOrder - 2));
  const Discretisation exact = discretise(system, period);
  const Eigen::Index n = system.a.rows();
  std::vector<Matrix> terms{Matrix::Identity(n, n)};  // (AT)^j / j!
  for (int j = 1; j <= order; ++j) terms.push_back(terms.back() * system.a * period / j);
  SeriesDiscretisation s;
  s.value.f = s.integral = s.value.q = Matrix::Zero(n, n);
  const Matrix w = system.g.cols() > 0 ? noise_intensity(system) : Matrix::Zero(n, n);
  for (int j = order; j >= 0; --j) {  // the small terms first
    const Matrix& term = terms[static_cast<std::size_t>(j)];
    s.value.f += term;
    s.integral += term * (period / (j + 1));
    for (int i = order; i >= 0; --i)
      s.value.q += terms[static_cast<std::size_t>(i)] * w * term.transpose() * (period / (i + j + 1));
  }
  s.value.q = (0.5 * (s.value.q + s.value.q.transpose())).eval();
  s.value.psi = system.b.cols() > 0 ? Matrix(s.integral * system.b) : Matrix(n, 0);
  s.value.gamma = system.g.cols() > 0 ? Matrix(s.integral * system.g) : Matrix(n, 0);

  const double theta = one_norm(system.a) * period;
  const double rest = theta < order + 2 ? 1 / (1 - theta / (order + 2)) : std::exp(theta);
  const double first = theta > 0 ? std::exp((order + 1) * std::log(theta) - std::lgamma(order + 2.0)) : 0.0;
  s.f_bound = first * rest;
  s.integral_bound = period * first / (order + 2) * rest;
  s.f_error = largest_difference(s.value.f, exact.f);
  s.psi_error = largest_difference(s.value.psi, exact.psi);
  s.gamma_error = largest_difference(s.value.gamma, exact.gamma);
  s.q_error = largest_difference(s.value.q, exact.q);
  return s;
}

}  // namespace odobench
