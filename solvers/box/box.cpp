#include "solvers/box/box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace odobench {
namespace {

// Points are measured from the centre in the inner half of the box, so that small numbers in a wide box keep
// their digits, and from the nearer bound in the outer half, so that points next to a bound keep their
// distance to it.
constexpr double kInner = 0.5;

}  // namespace

Box::Box(const std::vector<ParameterInfo>& parameters) {
  const auto n = static_cast<Eigen::Index>(parameters.size());
  lower_.resize(n);
  upper_.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    lower_[i] = parameters[static_cast<std::size_t>(i)].lower;
    upper_[i] = parameters[static_cast<std::size_t>(i)].upper;
    if (lower_[i] < upper_[i]) free_.push_back(i);
  }
  half_ = 0.5 * upper_ - 0.5 * lower_;
  centre_ = 0.5 * upper_ + 0.5 * lower_;
}

Vector Box::to_parameters(const ConstVectorRef& u) const {
  Vector x = lower_;
  for (std::size_t k = 0; k < free_.size(); ++k) {
    const Eigen::Index i = free_[k];
    const double v = u[static_cast<Eigen::Index>(k)];
    if (v <= -1.0)
      x[i] = lower_[i];
    else if (v >= 1.0)
      x[i] = upper_[i];
    else if (v > -kInner && v < kInner)
      x[i] = std::clamp(centre_[i] + v * half_[i], lower_[i], upper_[i]);
    else
      x[i] = std::clamp(v < 0 ? lower_[i] + (v + 1.0) * half_[i] : upper_[i] - (1.0 - v) * half_[i],
                        lower_[i], upper_[i]);
  }
  return x;
}

Vector Box::to_unit(const ConstVectorRef& x) const {
  Vector u(dimension());
  for (std::size_t k = 0; k < free_.size(); ++k) {
    const Eigen::Index i = free_[k];
    double v = (x[i] - centre_[i]) / half_[i];
    if (v <= -kInner)
      v = (x[i] - lower_[i]) / half_[i] - 1.0;
    else if (v >= kInner)
      v = 1.0 - (upper_[i] - x[i]) / half_[i];
    u[static_cast<Eigen::Index>(k)] = std::clamp(v, -1.0, 1.0);
  }
  return u;
}

Vector Box::gradient_to_unit(const ConstVectorRef& g) const {
  Vector out(dimension());
  for (Eigen::Index k = 0; k < out.size(); ++k) out[k] = g[parameter_index(k)] * half_[parameter_index(k)];
  return out;
}

Matrix Box::jacobian_to_unit(const ConstMatrixRef& j) const {
  Matrix out(j.rows(), dimension());
  for (Eigen::Index k = 0; k < out.cols(); ++k)
    out.col(k) = j.col(parameter_index(k)) * half_[parameter_index(k)];
  return out;
}

NormalEquations Box::to_unit(const NormalEquations& e) const {
  NormalEquations out;
  out.cost = e.cost;
  out.jtr = gradient_to_unit(e.jtr);
  out.jtj.resize(dimension(), dimension());
  for (Eigen::Index k = 0; k < dimension(); ++k)
    for (Eigen::Index l = 0; l < dimension(); ++l)
      out.jtj(k, l) = e.jtj(parameter_index(k), parameter_index(l)) * half_[parameter_index(k)] *
                      half_[parameter_index(l)];
  return out;
}

Vector Box::resolution(const ConstVectorRef& u) const {
  const Vector x = to_parameters(u);
  Vector out(dimension());
  for (Eigen::Index k = 0; k < out.size(); ++k) {
    const Eigen::Index i = parameter_index(k);
    const double from = std::abs(u[k]) < kInner ? std::abs(u[k]) : 1.0 - std::min(1.0, std::abs(u[k]));
    out[k] = std::numeric_limits<double>::epsilon() * std::hypot(x[i] / half_[i], from);
  }
  return out;
}

bool Box::contains(const ConstVectorRef& x) const {
  return (x.array() >= lower_.array()).all() && (x.array() <= upper_.array()).all();
}

}  // namespace odobench
