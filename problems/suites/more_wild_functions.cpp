#include "problems/suites/more_wild_functions.hpp"

#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace odobench {
namespace {

using Eigen::Index;

void bdqrtic(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  const Index n = x.size(), count = n - 4;
  for (Index i = 0; i < count; ++i) {
    r[i] = 3 - 4 * x[i];
    r[count + i] = 5 * square(x[n - 1]);
    for (Index k = 0; k < 4; ++k) r[count + i] += static_cast<double>(k + 1) * square(x[i + k]);
    if (!j) continue;
    (*j)(i, i) = -4;
    (*j)(count + i, n - 1) = 10 * x[n - 1];
    for (Index k = 0; k < 4; ++k) (*j)(count + i, i + k) += 2 * static_cast<double>(k + 1) * x[i + k];
  }
}

void cube(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  r[0] = x[0] - 1;
  if (j) (*j)(0, 0) = 1;
  for (Index i = 1; i < x.size(); ++i) {
    r[i] = 10 * (x[i] - x[i - 1] * square(x[i - 1]));
    if (!j) continue;
    (*j)(i, i) = 10;
    (*j)(i, i - 1) = -30 * square(x[i - 1]);
  }
}

// v (sin^5 log v + cos^5 log v), and its derivative by v.
std::pair<double, double> wave(double v) {
  const double s = std::sin(std::log(v)), c = std::cos(std::log(v));
  const double s4 = square(square(s)), c4 = square(square(c));
  const double sum = s4 * s + c4 * c;
  return {v * sum, sum + 5 * (s4 * c - c4 * s)};
}

void mancino(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  for (Index i = 0; i < x.size(); ++i) {
    const auto number = static_cast<double>(i + 1);
    double sum = 0, slope = 0;
    for (Index k = 0; k < x.size(); ++k) {
      const double v = std::sqrt(square(x[i]) + number / static_cast<double>(k + 1));
      const auto [value, by_v] = wave(v);
      sum += value;
      slope += by_v * x[i] / v;
    }
    r[i] = 1400 * x[i] + std::pow(number - 50, 3) + sum;
    if (j) (*j)(i, i) = 1400 + slope;
  }
}

Vector mancino_start(int n) {
  Vector start(n);
  for (int i = 1; i <= n; ++i) {
    double sum = 0;
    for (int k = 1; k <= n; ++k) sum += wave(std::sqrt(static_cast<double>(i) / k)).first;
    start[i - 1] = -8.710996e-4 * (std::pow(i - 50, 3) + sum);
  }
  return start;
}

// x = (a, b, c, d, t, u, v, w): with the complex p = t + i v, q = u + i w, A = a + i c, B = b + i d the
// equations are A + B, A p + B q, A p^2 + B q^2, A p^3 + B q^3 against eight numbers.
void heart8(const ConstVectorRef& x, VectorRef r, MatrixRef* j) {
  constexpr std::array kRight{0.69, 0.044, 1.57, 1.31, 2.65, -2.0, 12.6, -9.48};
  for (Index power = 0; power < 4; ++power)
    for (Index part = 0; part < 2; ++part)
      r[2 * power + part] = kRight[static_cast<std::size_t>(2 * power + part)];
  for (Index term = 0; term < 2; ++term) {
    const double a = x[term], c = x[2 + term], t = x[4 + term], v = x[6 + term];
    double re = 1, im = 0, re_before = 0, im_before = 0;  // of p^power and of p^(power - 1)
    for (Index power = 0; power < 4; ++power) {
      r[2 * power] += a * re - c * im;
      r[2 * power + 1] += a * im + c * re;
      if (j) {
        const auto order = static_cast<double>(power);
        const double by_re = order * (a * re_before - c * im_before),
                     by_im = order * (a * im_before + c * re_before);
        (*j)(2 * power, term) = re;
        (*j)(2 * power, 2 + term) = -im;
        (*j)(2 * power, 4 + term) = by_re;
        (*j)(2 * power, 6 + term) = -by_im;
        (*j)(2 * power + 1, term) = im;
        (*j)(2 * power + 1, 2 + term) = re;
        (*j)(2 * power + 1, 4 + term) = by_im;
        (*j)(2 * power + 1, 6 + term) = by_re;
      }
      re_before = re, im_before = im;
      re = re_before * t - im_before * v;
      im = re_before * v + im_before * t;
    }
  }
}

Vector heart8_start(int) {
  Vector start(8);
  start << -0.3, -0.39, 0.3, -0.344, -1.2, 2.69, 1.59, -1.5;
  return start;
}

}  // namespace

const std::vector<MghFunction>& more_wild_functions() {
  static const std::vector<MghFunction> list{
      {"bdqrtic", "bdqrtic", 8, DimensionRule::at_least(5), [](int n) { return 2 * (n - 4); },
       [](int n) -> Vector { return Vector::Ones(n); }, bdqrtic},
      {"cube", "cube", 5, DimensionRule::at_least(2), [](int n) { return n; },
       [](int n) -> Vector { return Vector::Constant(n, 0.5); }, cube},
      {"mancino", "mancino", 5, DimensionRule::at_least(2), [](int n) { return n; }, mancino_start, mancino},
      {"heart8", "heart8ls", 8, DimensionRule::exactly(8), [](int) { return 8; }, heart8_start, heart8}};
  return list;
}

MghOptimum more_wild_optimum(std::string_view name, int n) {
  if (name == "cube") return {0.0, {Vector::Ones(n)}};
  if (name == "bdqrtic") {
    static const std::map<int, double> kCosts{{8, 10.2389734213174347},
                                              {10, 18.2811617535935358},
                                              {11, 22.2605917348837578},
                                              {12, 26.272766396793963}};
    const auto found = kCosts.find(n);
    if (found == kCosts.end()) return {};
    return {found->second, {}};
  }
  return {0.0, {}};
}

}  // namespace odobench
