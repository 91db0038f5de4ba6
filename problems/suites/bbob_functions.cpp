#include "problems/suites/bbob_functions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "problems/suites/bbob_transforms.hpp"

namespace odobench {
namespace {

using bbob::share;
using Eigen::Index;

constexpr double kTau = 2 * std::numbers::pi;

// Where raw functions of z put their derivative dJ/dz; null where only the value is wanted.
using Slot = Vector*;

Vector multiplied(const Matrix& m, const Vector& x) {
  return m.size() == 0 ? x : Vector(m * x);
}

double quadratic(const Vector& weights, const Vector& z, Slot slope) {
  if (slope != nullptr) *slope = 2 * weights.cwiseProduct(z);
  return weights.dot(z.cwiseAbs2());
}

Vector ellipsoid_weights(Index n) {
  Vector w(n);
  for (Index i = 0; i < n; ++i) w[i] = std::pow(1e6, share(i, n));
  return w;
}

// All 1 but the first (discus), or all `high` but the first (bent cigar).
Vector odd_first(Index n, double first, double others) {
  Vector w = Vector::Constant(n, others);
  w[0] = first;
  return w;
}

double rastrigin(const Vector& z, Slot slope) {
  if (slope != nullptr) *slope = 2 * z.array() + 10 * kTau * (kTau * z.array()).sin();
  return 10 * (static_cast<double>(z.size()) - (kTau * z.array()).cos().sum()) + z.squaredNorm();
}

double rosenbrock(const Vector& z, Slot slope) {
  double sum = 0;
  if (slope != nullptr) slope->setZero(z.size());
  for (Index i = 0; i + 1 < z.size(); ++i) {
    const double a = z[i] * z[i] - z[i + 1], b = z[i] - 1;
    sum += 100 * a * a + b * b;
    if (slope == nullptr) continue;
    (*slope)[i] += 400 * a * z[i] + 2 * b;
    (*slope)[i + 1] -= 200 * a;
  }
  return sum;
}

double griewank_rosenbrock(const Vector& z, Slot slope) {
  double sum = 0;
  if (slope != nullptr) slope->setZero(z.size());
  const double scale = 10 / static_cast<double>(z.size() - 1);
  for (Index i = 0; i + 1 < z.size(); ++i) {
    const double a = z[i] * z[i] - z[i + 1], b = 1 - z[i];
    const double s = 100 * a * a + b * b;
    sum += s / 4000 - std::cos(s);
    if (slope == nullptr) continue;
    const double factor = scale * (1.0 / 4000 + std::sin(s));
    (*slope)[i] += factor * (400 * a * z[i] - 2 * b);
    (*slope)[i + 1] -= factor * 200 * a;
  }
  return scale * sum + 10;
}

double different_powers(const Vector& z, Slot slope) {
  const Index n = z.size();
  double sum = 0;
  Vector powers(n);
  for (Index i = 0; i < n; ++i) {
    powers[i] = 2 + 4 * share(i, n);
    sum += std::pow(std::abs(z[i]), powers[i]);
  }
  const double root = std::sqrt(sum);
  if (slope != nullptr)
    for (Index i = 0; i < n; ++i)
      (*slope)[i] =
          root == 0 ? 0
                    : std::copysign(powers[i] * std::pow(std::abs(z[i]), powers[i] - 1), z[i]) / (2 * root);
  return root;
}

double attractive_sector(const BbobInstance& f, const Vector& z) {
  double sum = 0;
  for (Index i = 0; i < z.size(); ++i) {
    const double scaled = z[i] * f.best[i] > 0 ? 100 * z[i] : z[i];
    sum += scaled * scaled;
  }
  return std::pow(bbob::oscillate(sum).value, 0.9);
}

double step_ellipsoid(const BbobInstance& f, const ConstVectorRef& x, const Vector& moved) {
  const Index n = x.size();
  // z-hat, stretched by Lambda^10; halves are rounded upward.
  Vector z = bbob::stretches(10, n).cwiseProduct(f.outer * moved);
  const double first = std::abs(z[0]);
  for (double& value : z)
    value = std::abs(value) > 0.5 ? std::floor(value + 0.5) : std::floor(10 * value + 0.5) / 10;
  z = f.inner * z;
  double sum = 0;
  for (Index i = 0; i < n; ++i) sum += std::pow(100, share(i, n)) * z[i] * z[i];
  return 0.1 * std::max(first / 1e4, sum) + BbobInstance::outside(x);
}

double weierstrass(const Vector& z) {
  constexpr int kTerms = 12;
  double sum = 0, at_zero = 0;
  for (int k = 0; k < kTerms; ++k) {
    const double a = std::pow(0.5, k), b = std::pow(3.0, k);
    at_zero += a * std::cos(kTau * b * 0.5);
    for (const double value : z) sum += a * std::cos(kTau * b * (value + 0.5));
  }
  const double gap = sum / static_cast<double>(z.size()) - at_zero;
  return 10 * gap * gap * gap;
}

double schaffers(const Vector& z) {
  double sum = 0;
  for (Index i = 0; i + 1 < z.size(); ++i) {
    const double s = z[i] * z[i] + z[i + 1] * z[i + 1];
    const double wave = std::sin(50 * std::pow(s, 0.1));
    sum += std::pow(s, 0.25) * (1 + wave * wave);
  }
  const double mean = sum / static_cast<double>(z.size() - 1);
  return mean * mean;
}

// sqrt(|z|) is stationary at 420.96874633: the constant of the report, which the sum reaches to 1e-12.
double schwefel(const BbobInstance& f, const ConstVectorRef& x) {
  const Index n = x.size();
  const double peak = 2 * std::abs(f.best[0]);
  Vector z(n);
  for (Index i = 0; i < n; ++i) {
    z[i] = f.best[i] < 0 ? -2 * x[i] : 2 * x[i];
    if (i > 0) z[i] += 0.25 * ((f.best[i - 1] < 0 ? -2 * x[i - 1] : 2 * x[i - 1]) - peak);
  }
  z = 100 * (bbob::stretches(10, n).cwiseProduct((z.array() - peak).matrix()).array() + peak);
  double sum = 0;
  for (const double value : z) sum += value * std::sin(std::sqrt(std::abs(value)));
  return 4.189828872724339 - sum / (100 * static_cast<double>(n)) + 100 * BbobInstance::outside(z / 100);
}

double gallagher(const BbobInstance& f, const ConstVectorRef& x) {
  const Vector turned = f.outer * x;
  double highest = 0;
  const double factor = -0.5 / static_cast<double>(x.size());
  for (Index k = 0; k < f.peaks.cols(); ++k) {
    const double squares = f.peak_weights.col(k).dot((turned - f.peaks.col(k)).cwiseAbs2());
    highest = std::max(highest, f.heights[k] * std::exp(factor * squares));
  }
  const double value = bbob::oscillate(10 - highest).value;
  return value * value + BbobInstance::outside(x);
}

double katsuura(const Vector& z) {
  const auto n = static_cast<double>(z.size());
  double product = 1;
  for (Index i = 0; i < z.size(); ++i) {
    double sum = 0;
    for (int j = 1; j <= 32; ++j) {
      const double power = std::ldexp(1.0, j);
      sum += std::abs(power * z[i] - std::floor(power * z[i] + 0.5)) / power;
    }
    product *= std::pow(1 + static_cast<double>(i + 1) * sum, 10 / std::pow(n, 1.2));
  }
  return 10 / (n * n) * (product - 1);
}

double lunacek(const BbobInstance& f, const ConstVectorRef& x) {
  const Index n = x.size();
  const auto count = static_cast<double>(n);
  constexpr double kFirst = 2.5, kDepth = 1;
  const double s = 1 - 0.5 / (std::sqrt(count + 20) - 4.1);
  const double second = -std::sqrt((kFirst * kFirst - kDepth) / s);
  Vector hat(n);
  for (Index i = 0; i < n; ++i) hat[i] = f.best[i] < 0 ? -2 * x[i] : 2 * x[i];
  const Vector z = f.inner * (hat.array() - kFirst).matrix();
  const double near = (hat.array() - kFirst).square().sum(), far = (hat.array() - second).square().sum();
  return std::min(near, kDepth * count + s * far) + 10 * (count - (kTau * z.array()).cos().sum()) +
         1e4 * BbobInstance::outside(x);
}

// Most functions: outer (x - best), maps of single parameters, inner, then a function of z.
struct Chain {
  Vector first, second, z;  // slopes of the two maps, what the function gets
};

void oscillate_all(Vector& z, Vector& slope) {
  for (Index i = 0; i < z.size(); ++i) {
    const bbob::Slope s = bbob::oscillate(z[i]);
    z[i] = s.value;
    slope[i] = s.derivative;
  }
}

void asymmetric_all(double beta, Vector& z, Vector& slope) {
  for (Index i = 0; i < z.size(); ++i) {
    const bbob::Slope s = bbob::asymmetric(z[i], beta, share(i, z.size()));
    z[i] = s.value;
    slope[i] = s.derivative;
  }
}

Chain chain_of(const BbobInstance& f, const Vector& moved) {
  const Index n = moved.size();
  Chain c;
  c.z = multiplied(f.outer, moved);
  c.first = c.second = Vector::Ones(n);
  switch (f.function) {
    case 2:
    case 3:
    case 4:
    case 10:
    case 11:
    case 15:
    case 16:
      oscillate_all(c.z, c.first);
      break;
    default:
      break;
  }
  if (f.function == 3 || f.function == 15) asymmetric_all(0.2, c.z, c.second);
  if (f.function == 12 || f.function == 17 || f.function == 18) asymmetric_all(0.5, c.z, c.second);
  if (f.function == 4) {
    const Vector steep = bbob::stretches(10, n);
    for (Index i = 0; i < n; ++i) c.z[i] *= c.z[i] > 0 && i % 2 == 0 ? 10 * steep[i] : steep[i];
  }
  c.z = multiplied(f.inner, c.z);
  if (f.function == 8) c.z.array() += 1;
  if (f.function == 9 || f.function == 19) c.z.array() += 0.5;
  return c;
}

double of_chain(const BbobInstance& f, const Vector& z, Slot slope) {
  const Index n = z.size();
  switch (f.function) {
    case 1:
      return quadratic(Vector::Ones(n), z, slope);
    case 2:
    case 10:
      return quadratic(ellipsoid_weights(n), z, slope);
    case 3:
    case 4:
    case 15:
      return rastrigin(z, slope);
    case 6:
      return attractive_sector(f, z);
    case 8:
    case 9:
      return rosenbrock(z, slope);
    case 11:
      return quadratic(odd_first(n, 1e6, 1), z, slope);
    case 12:
      return quadratic(odd_first(n, 1, 1e6), z, slope);
    case 13:
      return z[0] * z[0] + 100 * z.tail(n - 1).norm();
    case 14:
      return different_powers(z, slope);
    case 16:
      return weierstrass(z);
    case 17:
    case 18:
      return schaffers(z);
    case 19:
      return griewank_rosenbrock(z, slope);
    case 23:
      return katsuura(z);
    default:
      throw std::logic_error(fmt::format("bbob:f{} is no function of one chain", f.function));
  }
}

double penalty_factor(int function, Index n) {
  switch (function) {
    case 4:
      return 100;
    case 16:
      return 10 / static_cast<double>(n);
    case 17:
    case 18:
      return 10;
    case 23:
      return 1;
    default:
      return 0;
  }
}

// s = sign(x_opt) 10^share; beyond the optimum's corner the slope is level.
double linear_slope(const BbobInstance& f, const ConstVectorRef& x, Slot slope) {
  double sum = 0;
  for (Index i = 0; i < x.size(); ++i) {
    const double s = std::copysign(std::pow(10, share(i, x.size())), f.best[i]);
    const bool inside = x[i] * f.best[i] < 25;
    sum += 5 * std::abs(s) - s * (inside ? x[i] : f.best[i]);
    if (slope != nullptr) (*slope)[i] = inside ? -s : 0;
  }
  return sum;
}

}  // namespace

double BbobInstance::outside(const ConstVectorRef& x) {
  double sum = 0;
  for (const double value : x) {
    const double beyond = std::abs(value) - 5;
    if (beyond > 0) sum += beyond * beyond;
  }
  return sum;
}

double BbobInstance::raw(const ConstVectorRef& x) const {
  switch (function) {
    case 5:
      return linear_slope(*this, x, nullptr);
    case 7:
      return step_ellipsoid(*this, x, x - best);
    case 20:
      return schwefel(*this, x);
    case 21:
    case 22:
      return gallagher(*this, x);
    case 24:
      return lunacek(*this, x);
    case 9:
    case 19:  // rotated about the origin
      return of_chain(*this, chain_of(*this, x).z, nullptr);
    default: {
      const double value = of_chain(*this, chain_of(*this, x - best).z, nullptr);
      const double factor = penalty_factor(function, x.size());
      return factor == 0 ? value : value + factor * outside(x);
    }
  }
}

bool BbobInstance::has_gradient(int function) {
  constexpr std::array kSmooth{1, 2, 3, 5, 8, 9, 10, 11, 12, 14, 15, 19};
  return std::find(kSmooth.begin(), kSmooth.end(), function) != kSmooth.end();
}

double BbobInstance::raw_and_gradient(const ConstVectorRef& x, VectorRef gradient) const {
  if (!has_gradient(function)) throw std::logic_error(fmt::format("bbob:f{} has no gradient", function));
  Vector slope(x.size());
  if (function == 5) {
    const double value = linear_slope(*this, x, &slope);
    gradient = slope;
    return value;
  }
  const bool about_origin = function == 9 || function == 19;
  const Chain c = chain_of(*this, about_origin ? Vector(x) : Vector(x - best));
  const double value = of_chain(*this, c.z, &slope);
  if (inner.size() > 0) slope = inner.transpose() * slope;
  slope = slope.cwiseProduct(c.second).cwiseProduct(c.first);
  gradient = outer.size() == 0 ? slope : Vector(outer.transpose() * slope);
  return value;
}

}  // namespace odobench
