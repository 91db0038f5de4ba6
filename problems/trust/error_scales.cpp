#include "problems/trust/error_scales.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace odobench {

using Eigen::Index;

namespace {

constexpr double kPlaneMedian = 1.17741, kLineMedian = 1.4826;

Index residuals_of_row(const CalibrationProblem& problem) {
  return problem.options().cost == CostKind::Optiodom ? 2 : 3;
}

}  // namespace

double middle_of(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto half = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), half, values.end());
  if (values.size() % 2 == 1) return *half;
  return 0.5 * (*half + *std::max_element(values.begin(), half));
}

double four_digits(double value) {
  return std::strtod(fmt::format("{:.4g}", value).c_str(), nullptr);
}

ErrorScales error_scales(const CalibrationProblem& problem, const ConstVectorRef& z) {
  Vector r(problem.residual_count());
  problem.residuals(z, r);
  const Index row = residuals_of_row(problem);
  std::vector<double> distances, headings;
  for (Index i = 0; i < r.size(); i += row) {
    distances.push_back(std::hypot(r[i], r[i + 1]));
    if (row == 3) headings.push_back(std::abs(r[i + 2]));
  }
  return {middle_of(std::move(distances)) / kPlaneMedian / std::sqrt(problem.options().position_weight),
          kLineMedian * middle_of(std::move(headings)) / std::sqrt(problem.options().heading_weight)};
}

std::vector<double> recording_deviations(const CalibrationProblem& problem, const ConstVectorRef& z) {
  Vector r(problem.residual_count());
  problem.residuals(z, r);
  const Index row = residuals_of_row(problem);
  std::vector<double> deviations;
  Index first = 0;
  for (std::size_t n = 0; n < problem.recordings().size(); ++n) {
    const Index count = problem.residual_count(n);
    const auto rows = static_cast<double>(std::max<Index>(count / row, 1));
    deviations.push_back(std::sqrt(r.segment(first, count).squaredNorm() / rows));
    first += count;
  }
  return deviations;
}

double recording_scale(const CalibrationProblem& problem, const ConstVectorRef& z) {
  return middle_of(recording_deviations(problem, z));
}

}  // namespace odobench
