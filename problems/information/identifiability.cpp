#include "problems/information/identifiability.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "problems/information/combinations.hpp"

namespace odobench {
namespace {

double half_width(const ParameterInfo& p) {
  return (p.upper - p.lower) / 2;
}

// (J'J)^-1 over what J'J in doubles can tell, and the roots of its diagonal: infinite where that is nothing.
struct Covariance {
  Matrix matrix;
  Vector deviations;
};

// By the eigenvalues of the equilibrated J'J (unit diagonal): units decide nothing about which of them are
// rounding.
Covariance covariance_of(const Matrix& jtj) {
  const Eigen::Index n = jtj.rows();
  const Vector size = jtj.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Vector inverse = (size.array() > 0).select(1.0 / size.array(), 0.0);
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(inverse.asDiagonal() * jtj * inverse.asDiagonal());
  const Vector values = eigen.eigenvalues();
  // What rounding leaves of a zero eigenvalue is not information.
  const double noise = 1e-14 * static_cast<double>(n) * std::max(values[n - 1], 0.0);
  Covariance out{Matrix::Zero(n, n), Vector::Zero(n)};
  for (Eigen::Index k = 0; k < n; ++k) {
    const Vector v = eigen.eigenvectors().col(k);
    if (values[k] > noise) {
      const Vector scaled = inverse.cwiseProduct(v);
      out.matrix += scaled * scaled.transpose() / values[k];
      continue;
    }
    for (Eigen::Index i = 0; i < n; ++i)
      if (std::abs(v[i]) > 1e-6) out.deviations[i] = std::numeric_limits<double>::infinity();
  }
  for (Eigen::Index i = 0; i < n; ++i)
    out.deviations[i] = size[i] > 0 ? out.deviations[i] + std::sqrt(out.matrix(i, i))
                                    : std::numeric_limits<double>::infinity();
  return out;
}

}  // namespace

Identifiability identifiability(const Problem& problem, const ConstVectorRef& x) {
  const std::vector<ParameterInfo>& parameters = problem.parameters();
  Identifiability result;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (parameters[i].lower < parameters[i].upper) result.parameters.push_back(static_cast<Eigen::Index>(i));
  const auto n = static_cast<Eigen::Index>(result.parameters.size());
  if (n == 0) return result;  // everything is held fixed: nothing to determine

  const Problem own = problem;
  NormalEquations e;
  own.normal_equations(x, e);
  const Vector scale = relative_scales(parameters);
  Matrix scaled(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) {
      const Eigen::Index row = result.parameters[static_cast<std::size_t>(i)];
      const Eigen::Index column = result.parameters[static_cast<std::size_t>(j)];
      scaled(i, j) = e.jtj(row, column) * scale[row] * scale[column];
    }
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(scaled);
  const double freedom = static_cast<double>(problem.residual_count() - n);
  const double variance = freedom > 0 ? e.cost / freedom : std::numeric_limits<double>::infinity();
  result.residual_deviation = std::sqrt(variance);
  result.singular_values = eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().reverse();
  result.directions = eigen.eigenvectors().rowwise().reverse();
  const Covariance covariance = covariance_of(scaled);
  result.standard_deviations = std::sqrt(variance) * covariance.deviations;
  const Vector inverse = covariance.deviations.cwiseInverse();
  result.correlation = inverse.asDiagonal() * covariance.matrix * inverse.asDiagonal();
  for (Eigen::Index i = 0; i < n; ++i)
    if (!std::isfinite(result.standard_deviations[i]))
      result.correlation.row(i).setConstant(std::numeric_limits<double>::quiet_NaN()),
          result.correlation.col(i).setConstant(std::numeric_limits<double>::quiet_NaN());
  return result;
}

std::map<std::string, std::vector<double>> identifiability_series(const Identifiability& id) {
  const auto list = [](const auto& values) {
    return std::vector<double>(values.data(), values.data() + values.size());
  };
  // Columns of `directions` lie one after the other; the correlation is symmetric.
  return {{"singular_values", list(id.singular_values)},
          {"directions", list(id.directions)},
          {"sd_if_samples_were_independent", list(id.standard_deviations)},
          {"correlation", list(id.correlation)},
          {"residual_deviation", {id.residual_deviation}}};
}

std::vector<std::string> undetermined_combinations(const Problem& problem, const Identifiability& id) {
  const auto n = static_cast<Eigen::Index>(id.parameters.size());
  std::vector<ParameterInfo> free;
  for (const Eigen::Index i : id.parameters)
    free.push_back(problem.parameters()[static_cast<std::size_t>(i)]);
  double box = 0;
  const Vector scale = relative_scales(free);
  for (Eigen::Index i = 0; i < n; ++i)
    box += half_width(free[static_cast<std::size_t>(i)]) / scale[i] / static_cast<double>(n);
  Eigen::Index told = n;
  while (told > 0 && !(id.residual_deviation <= box * id.singular_values[told - 1])) --told;
  const Matrix basis = sparse_basis(id.directions.rightCols(n - told));
  std::vector<std::string> all;
  for (Eigen::Index k = 0; k < basis.cols(); ++k) all.push_back(combination_words(basis.col(k), free));
  return all;
}

std::string identifiability_note(const Problem& problem, const Identifiability& id, const std::string& what) {
  std::string list;
  const auto n = static_cast<Eigen::Index>(id.parameters.size());
  const Vector scale = relative_scales(problem.parameters());
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Index at = id.parameters[static_cast<std::size_t>(i)];
    const ParameterInfo& p = problem.parameters()[static_cast<std::size_t>(at)];
    const double deviation = id.standard_deviations[i];
    if (deviation * scale[at] > half_width(p))
      list += (list.empty() ? "" : ", ") + p.name +
              (std::isfinite(deviation) ? fmt::format(" {:.1f} %", 100 * deviation) : " (no limit)");
  }
  if (list.empty()) return {};
  const std::vector<std::string> blind = undetermined_combinations(problem, id);
  return fmt::format(
      "Barely determined ({}): the singular values of the scaled Jacobian span {:.3g} .. "
      "{:.2g}, and "
      "even if residuals were independent the relative standard deviation would exceed the half width of the "
      "box for {}; the real one is several times larger: the box decides them. {}Trust the costs and errors "
      "more than these single "
      "parameters.",
      what, id.singular_values[0], id.singular_values[n - 1], list,
      blind.empty()
          ? ""
          : fmt::format("Changing {}, those after 'against' the other way, changes next to nothing. ",
                        fmt::join(blind, "; or ")));
}

}  // namespace odobench
