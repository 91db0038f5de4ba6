#include "problems/information/combinations.hpp"

#include <cmath>

namespace odobench {
namespace {

constexpr double kNegligible = 0.05;

}  // namespace

Vector relative_scales(const std::vector<ParameterInfo>& parameters) {
  Vector s(static_cast<Eigen::Index>(parameters.size()));
  for (Eigen::Index i = 0; i < s.size(); ++i) {
    const ParameterInfo& p = parameters[static_cast<std::size_t>(i)];
    s[i] = p.nominal != 0 ? std::abs(p.nominal) : (p.upper - p.lower) / 2;
  }
  return s;
}

Matrix sparse_basis(Matrix basis) {
  for (Eigen::Index column = 0; column < basis.cols(); ++column) {
    Eigen::Index row = 0, from = 0;
    basis.rightCols(basis.cols() - column).cwiseAbs().maxCoeff(&row, &from);
    basis.col(column).swap(basis.col(column + from));
    basis.col(column) /= basis(row, column);
    for (Eigen::Index other = 0; other < basis.cols(); ++other)
      if (other != column) basis.col(other) -= basis(row, other) * basis.col(column);
  }
  for (Eigen::Index column = 0; column < basis.cols(); ++column) {
    Eigen::Index row = 0;
    basis.col(column).cwiseAbs().maxCoeff(&row);
    basis.col(column) /= basis(row, column);
  }
  return basis;
}

std::string combination_words(const Vector& q, const std::vector<ParameterInfo>& parameters) {
  std::string one, other;
  double first = 0;
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    const ParameterInfo& p = parameters[static_cast<std::size_t>(i)];
    if (std::abs(q[i]) < kNegligible) continue;
    const double sign = q[i] * (p.nominal < 0 ? -1 : 1);
    if (first == 0) first = sign;
    std::string& side = sign * first > 0 ? one : other;
    side += (side.empty() ? "" : ", ") + p.name;
  }
  if (other.empty()) return one.find(',') == std::string::npos ? one + " alone" : one + " together";
  return one + " against " + other;
}

}  // namespace odobench
