// What an instance of a BBOB function is made of; the parts by the numbers of the report.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "problems/suites/bbob_functions.hpp"
#include "problems/suites/bbob_random.hpp"
#include "problems/suites/bbob_transforms.hpp"

namespace odobench {
namespace {

using Eigen::Index;

struct Described {
  const char* title;
  const char* hard;
};

constexpr std::array<Described, kBbobFunctions> kDescribed{{
    {"sphere", "nothing: how fast a method gets the last digits"},
    {"separable ellipsoid", "condition 1e6 along the axes, slightly bent"},
    {"separable Rastrigin", "some 10^n regular local minima on a grid, separable"},
    {"Bueche and Rastrigin", "as f3, and a step of slope at the optimum misleads symmetric models"},
    {"linear slope", "the optimum is a corner of the box: steps must grow to it"},
    {"attractive sector", "only a small cone of directions is steep, the optimum lies at its tip"},
    {"step ellipsoid", "plateaus: no gradient anywhere but at the optimum"},
    {"Rosenbrock", "a bent valley to follow, a second minimum for n >= 4"},
    {"rotated Rosenbrock", "as f8, and the valley turns with all parameters"},
    {"rotated ellipsoid", "condition 1e6, no axis to search along"},
    {"discus", "one direction is 1000 times steeper than all others"},
    {"bent cigar", "one direction is 1000 times flatter, and bends"},
    {"sharp ridge", "a ridge that is not differentiable, along which alone the way goes down"},
    {"sum of different powers", "the scales of directions grow apart near the optimum"},
    {"rotated Rastrigin", "some 10^n local minima, neither regular nor separable"},
    {"Weierstrass", "rugged at every scale, the optimum is not unique"},
    {"Schaffer F7", "modulation whose period and height change over the box"},
    {"ill-conditioned Schaffer F7", "as f17 at condition 1000"},
    {"Griewank and Rosenbrock", "the bent valley of f9 under local minima"},
    {"Schwefel", "2^n corners of deep minima far apart, the best of them near a wall of the box"},
    {"Gallagher, 101 peaks", "the right one of 101 peaks without a common slope"},
    {"Gallagher, 21 peaks", "the right one of 21 narrow peaks without a common slope"},
    {"Katsuura", "rugged everywhere, more than 10^n optima of nearly one height"},
    {"Lunacek bi-Rastrigin", "two funnels: the wide one leads away from the optimum"},
}};

constexpr std::int64_t kSecondSeed = 1000000;

Matrix diagonal(const Vector& d) {
  return d.asDiagonal();
}

// Order of n uniform numbers: the index of the smallest first.
std::vector<double> permutation(std::size_t n, std::int64_t seed) {
  const std::vector<double> u = bbob_uniform(n, seed);
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return u[a] < u[b]; });
  return {order.begin(), order.end()};
}

// Peak 0 is the optimum, of height 10 and condition sqrt(1000) (f21) or 1000 (f22); the others have heights
// 1.1 .. 9.1 and conditions 1 .. 1000 in random order.
void add_peaks(BbobInstance& f, Index n, std::int64_t seed) {
  const std::size_t count = f.function == 21 ? 101 : 21;
  const double width = f.function == 21 ? 10 : 9.8, half = f.function == 21 ? 5 : 4.9;
  const auto size = static_cast<std::size_t>(n);
  const auto others = static_cast<double>(count - 2);
  f.outer = bbob_rotation(seed, n);
  f.heights.resize(static_cast<Index>(count));
  f.heights[0] = 10;
  std::vector<double> conditions{f.function == 21 ? std::sqrt(1000.0) : 1000.0};
  const std::vector<double> order = permutation(count - 1, seed);
  for (std::size_t k = 1; k < count; ++k) {
    conditions.push_back(std::pow(1000, order[k - 1] / others));
    f.heights[static_cast<Index>(k)] = 1.1 + 8 * static_cast<double>(k - 1) / others;
  }
  const std::vector<double> u = bbob_uniform(size * count, seed);
  Matrix places(n, static_cast<Index>(count));
  f.peak_weights.resize(n, static_cast<Index>(count));
  for (std::size_t k = 0; k < count; ++k) {
    const std::vector<double> axes = permutation(size, seed + static_cast<std::int64_t>(1000 * k));
    for (std::size_t j = 0; j < size; ++j) {
      const auto row = static_cast<Index>(j), column = static_cast<Index>(k);
      f.peak_weights(row, column) = std::pow(conditions[k], axes[j] / static_cast<double>(size - 1) - 0.5);
      places(row, column) = width * u[k * size + j] - half;
    }
  }
  places.col(0) *= 0.8;
  f.best = places.col(0);
  f.peaks = f.outer * places;
}

void add_optimum(BbobInstance& f, Index n, std::int64_t seed) {
  f.best = bbob_optimum(f.function == 12 ? seed + kSecondSeed : seed, n);
  const auto signs = [&](const std::vector<double>& u, double middle, double size) {
    for (Index i = 0; i < n; ++i) f.best[i] = u[static_cast<std::size_t>(i)] < middle ? -size : size;
  };
  const auto count = static_cast<std::size_t>(n);
  if (f.function == 4)
    for (Index i = 0; i < n; i += 2) f.best[i] = std::abs(f.best[i]);
  if (f.function == 5)
    for (double& value : f.best) value = value < 0 ? -5 : 5;
  if (f.function == 8) f.best *= 0.75;
  if (f.function == 20) signs(bbob_uniform(count, seed), 0.5, 4.2096874637 / 2);
  if (f.function == 24) signs(bbob_normal(count, seed), 0, 1.25);
}

void add_matrices(BbobInstance& f, Index n, std::int64_t seed) {
  const auto first = [&] { return bbob_rotation(seed + kSecondSeed, n); };
  const auto second = [&] { return bbob_rotation(seed, n); };
  const auto between = [&](double alpha) {
    return Matrix(first() * bbob::stretches(alpha, n).asDiagonal() * second());
  };
  const double spread = std::max(1.0, std::sqrt(static_cast<double>(n)) / 8);
  const int k = f.function;
  if (k == 3) f.inner = diagonal(bbob::stretches(10, n));
  if (k == 6 || k == 13) f.outer = between(10);
  if (k == 23) f.outer = between(100);
  if (k == 7) f.outer = second(), f.inner = first();
  if (k == 8) f.outer = diagonal(Vector::Constant(n, spread));
  if (k == 9 || k == 19) f.outer = spread * second();
  if ((k >= 10 && k <= 12) || (k >= 14 && k <= 18)) f.outer = first();
  if (k == 12) f.inner = f.outer;
  if (k == 15) f.inner = between(10);
  if (k == 16) f.inner = between(0.01);
  if (k == 17 || k == 18) f.inner = bbob::stretches(k == 17 ? 10 : 1000, n).asDiagonal() * second();
  if (k == 24) f.inner = between(100);
  // z = 1: where Rosenbrock's valley ends.
  if (k == 9 || k == 19) f.best = f.outer.transpose() * Vector::Constant(n, 0.5) / (spread * spread);
}

}  // namespace

BbobInstance BbobInstance::make(int function, int n, int instance) {
  if (function < 1 || function > kBbobFunctions)
    throw std::invalid_argument(fmt::format("bbob:f{}: expected f1 to f{}", function, kBbobFunctions));
  if (n < 2)
    throw std::invalid_argument(fmt::format("bbob:f{}: dimension {}; expected 2 or more", function, n));
  BbobInstance f;
  f.function = function;
  f.offset = bbob_offset(function, instance);
  const std::int64_t seed = bbob_seed(function, instance);
  if (function == 21 || function == 22) {
    add_peaks(f, n, seed);
    return f;
  }
  add_optimum(f, n, seed);
  add_matrices(f, n, seed);
  return f;
}

const char* bbob_title(int function) {
  return kDescribed.at(static_cast<std::size_t>(function - 1)).title;
}
const char* bbob_hardness(int function) {
  return kDescribed.at(static_cast<std::size_t>(function - 1)).hard;
}

}  // namespace odobench
