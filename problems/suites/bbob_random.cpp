#include "problems/suites/bbob_random.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace odobench {
namespace {

constexpr std::int64_t kModulus = 2147483647;

std::int64_t next(std::int64_t state) {
  return 16807 * state % kModulus;
}

}  // namespace

std::vector<double> bbob_uniform(std::size_t count, std::int64_t seed) {
  std::array<std::int64_t, 32> table{};
  std::int64_t state = std::max<std::int64_t>(1, std::abs(seed));
  for (int i = 39; i >= 0; --i) {
    state = next(state);
    if (i < 32) table[static_cast<std::size_t>(i)] = state;
  }
  std::int64_t drawn = table[0];
  std::vector<double> numbers(count);
  for (double& number : numbers) {
    state = next(state);
    std::int64_t& place = table[static_cast<std::size_t>(drawn / 67108865)];
    drawn = place;
    place = state;
    number = static_cast<double>(drawn) / static_cast<double>(kModulus);
    if (number == 0) number = 1e-99;
  }
  return numbers;
}

std::vector<double> bbob_normal(std::size_t count, std::int64_t seed) {
  const std::vector<double> u = bbob_uniform(2 * count, seed);
  std::vector<double> numbers(count);
  for (std::size_t i = 0; i < count; ++i) {
    numbers[i] = std::sqrt(-2 * std::log(u[i])) * std::cos(2 * std::numbers::pi * u[count + i]);
    if (numbers[i] == 0) numbers[i] = 1e-99;
  }
  return numbers;
}

Matrix bbob_rotation(std::int64_t seed, Eigen::Index n) {
  const std::vector<double> normal = bbob_normal(static_cast<std::size_t>(n * n), seed);
  Matrix b(n, n);
  for (Eigen::Index column = 0; column < n; ++column) {
    for (Eigen::Index row = 0; row < n; ++row)
      b(row, column) = normal[static_cast<std::size_t>(column * n + row)];
    for (Eigen::Index before = 0; before < column; ++before)
      b.col(column) -= b.col(column).dot(b.col(before)) * b.col(before);
    b.col(column) /= b.col(column).norm();
  }
  return b;
}

Vector bbob_optimum(std::int64_t seed, Eigen::Index n) {
  const std::vector<double> u = bbob_uniform(static_cast<std::size_t>(n), seed);
  Vector x(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    x[i] = 8 * std::floor(1e4 * u[static_cast<std::size_t>(i)]) / 1e4 - 4;
    if (x[i] == 0) x[i] = -1e-5;
  }
  return x;
}

std::int64_t bbob_seed(int function, int instance) {
  const int shared = function == 4 ? 3 : function == 18 ? 17 : function;
  return shared + std::int64_t{10000} * instance;
}

double bbob_offset(int function, int instance) {
  const std::int64_t seed = bbob_seed(function, instance);
  const double ratio = bbob_normal(1, seed)[0] / bbob_normal(1, seed + 1)[0];
  return std::clamp(std::floor(1e4 * ratio + 0.5) / 100, -1000.0, 1000.0);
}

}  // namespace odobench
