#include "bench/identifiability.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

namespace odobench {
namespace {

double half_width(const ParameterInfo& p) {
  return (p.upper - p.lower) / 2;
}
double scale_of(const ParameterInfo& p) {
  return p.nominal != 0 ? std::abs(p.nominal) : half_width(p);
}

}  // namespace

Identifiability identifiability(const Problem& problem, const ConstVectorRef& x) {
  const std::vector<ParameterInfo>& parameters = problem.parameters();
  Identifiability result;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (parameters[i].lower < parameters[i].upper) result.parameters.push_back(static_cast<Eigen::Index>(i));
  const auto n = static_cast<Eigen::Index>(result.parameters.size());

  const Problem own = problem;
  NormalEquations e;
  own.normal_equations(x, e);
  Matrix scaled(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      const Eigen::Index row = result.parameters[static_cast<std::size_t>(i)];
      const Eigen::Index column = result.parameters[static_cast<std::size_t>(j)];
      scaled(i, j) = e.jtj(row, column) * scale_of(parameters[static_cast<std::size_t>(row)]) *
                     scale_of(parameters[static_cast<std::size_t>(column)]);
    }
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(scaled);
  const Vector values = eigen.eigenvalues();  // ascending
  // What rounding leaves of a zero eigenvalue is not information.
  const double noise =
      1e-14 * static_cast<double>(n) * std::max(values.size() > 0 ? values[n - 1] : 0.0, 0.0);
  const double freedom = static_cast<double>(problem.residual_count() - n);
  const double variance = freedom > 0 ? e.cost / freedom : std::numeric_limits<double>::infinity();
  result.singular_values = values.cwiseMax(0.0).cwiseSqrt().reverse();
  result.standard_deviations = Vector::Zero(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    for (Eigen::Index i = 0; i < n; ++i) {
      const double part = eigen.eigenvectors()(i, k);
      if (values[k] > noise)
        result.standard_deviations[i] += variance * part * part / values[k];
      else if (std::abs(part) > 1e-6)
        result.standard_deviations[i] = std::numeric_limits<double>::infinity();
    }
  }
  result.standard_deviations = result.standard_deviations.cwiseSqrt();
  if (n > 0) result.weakest = eigen.eigenvectors().col(0);
  return result;
}

std::string identifiability_note(const Problem& problem, const ConstVectorRef& x, const std::string& what) {
  const Identifiability id = identifiability(problem, x);
  std::string list;
  const auto n = static_cast<Eigen::Index>(id.parameters.size());
  for (Eigen::Index i = 0; i < n; ++i) {
    const ParameterInfo& p =
        problem.parameters()[static_cast<std::size_t>(id.parameters[static_cast<std::size_t>(i)])];
    const double deviation = id.standard_deviations[i];
    if (deviation * scale_of(p) > half_width(p))
      list += fmt::format("{}{} {:.1f} %", list.empty() ? "" : ", ", p.name, 100 * deviation);
  }
  if (list.empty()) return {};
  return fmt::format(
      "Barely determined ({}): the singular values of the scaled Jacobian span {:.3g} .. "
      "{:.2g}, and "
      "the relative standard deviation exceeds the half width of the box for {}. Trust the costs and errors "
      "more than "
      "these single parameters.",
      what, id.singular_values[0], id.singular_values[n - 1], list);
}

}  // namespace odobench
