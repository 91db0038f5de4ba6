#include "problems/problem.hpp"

#include <fmt/core.h>

#include <atomic>
#include <cmath>
#include <set>
#include <stdexcept>

namespace odobench {

void validate(const std::vector<ParameterInfo>& parameters) {
  if (parameters.empty()) throw std::invalid_argument("parameters: found none, expected at least one");
  std::set<std::string> names;
  for (const ParameterInfo& p : parameters) {
    if (p.name.empty()) throw std::invalid_argument("parameters: found an empty name");
    if (!names.insert(p.name).second)
      throw std::invalid_argument(fmt::format("parameter '{}': the name occurs twice", p.name));
    if (!std::isfinite(p.lower) || !std::isfinite(p.nominal) || !std::isfinite(p.upper))
      throw std::invalid_argument(
          fmt::format("parameter '{}': lower {}, nominal {}, upper {}; expected finite values", p.name,
                      p.lower, p.nominal, p.upper));
    if (p.lower > p.upper)
      throw std::invalid_argument(fmt::format("parameter '{}': lower {} > upper {}; expected lower <= upper",
                                              p.name, p.lower, p.upper));
    if (p.nominal < p.lower || p.nominal > p.upper)
      throw std::invalid_argument(
          fmt::format("parameter '{}': nominal {} outside [{}, {}]; expected lower <= nominal <= upper",
                      p.name, p.nominal, p.lower, p.upper));
  }
}

namespace {

void check_minimisers(const std::string& problem, const std::vector<ParameterInfo>& parameters,
                      const std::vector<Vector>& minimisers) {
  for (const Vector& x : minimisers) {
    if (x.size() != static_cast<Eigen::Index>(parameters.size()))
      throw std::invalid_argument(fmt::format("problem '{}': a known minimiser has {} values, expected {}",
                                              problem, x.size(), parameters.size()));
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      const ParameterInfo& p = parameters[i];
      const double value = x[static_cast<Eigen::Index>(i)];
      if (!(value >= p.lower && value <= p.upper))
        throw std::invalid_argument(
            fmt::format("problem '{}', parameter '{}': known minimiser {} outside [{}, {}]", problem, p.name,
                        value, p.lower, p.upper));
    }
  }
}

}  // namespace

Problem& Problem::operator=(const Problem& other) {
  model_ = other.model_;
  counts_ = {};
  return *this;
}

void Problem::absent(const char* capability, const std::string& problem) {
  throw std::logic_error(fmt::format("problem '{}' offers no {}", problem, capability));
}

void Problem::adopt(Interface& model) {
  validate(model.parameters);
  const auto n = static_cast<Eigen::Index>(model.parameters.size());
  if (model.start.size() == 0) {
    model.start.resize(n);
    for (Eigen::Index i = 0; i < n; ++i)
      model.start[i] = model.parameters[static_cast<std::size_t>(i)].nominal;
  }
  if (model.start.size() != n)
    throw std::invalid_argument(
        fmt::format("problem '{}': start has {} values, expected {}", model.name, model.start.size(), n));
  check_minimisers(model.name, model.parameters, model.known_minimisers);
  if (model.lattice_levels.empty()) return;
  if (model.lattice_levels.size() != model.parameters.size())
    throw std::invalid_argument(fmt::format("problem '{}': found {} lists of lattice levels, expected {}",
                                            model.name, model.lattice_levels.size(), n));
  for (std::size_t i = 0; i < model.parameters.size(); ++i) {
    const Vector& levels = model.lattice_levels[i];
    const ParameterInfo& p = model.parameters[i];
    bool fine = levels.size() > 0 && levels[0] >= p.lower && levels[levels.size() - 1] <= p.upper;
    for (Eigen::Index l = 1; l < levels.size(); ++l) fine = fine && levels[l - 1] < levels[l];
    if (!fine)
      throw std::invalid_argument(
          fmt::format("problem '{}', parameter '{}': expected ascending lattice levels within [{}, {}]",
                      model.name, p.name, p.lower, p.upper));
  }
}

double Problem::cost(const ConstVectorRef& x) const {
  ++counts_.cost;
  return model_->cost(x);
}

double Problem::cost_and_gradient(const ConstVectorRef& x, VectorRef g) const {
  ++counts_.gradient;
  return model_->cost_and_gradient(x, g);
}

void Problem::residuals(const ConstVectorRef& x, VectorRef r) const {
  ++counts_.residuals;
  model_->residuals(x, r);
}

void Problem::residuals_and_jacobian(const ConstVectorRef& x, VectorRef r, MatrixRef j) const {
  ++counts_.residuals;
  model_->residuals_and_jacobian(x, r, j);
}

void Problem::normal_equations(const ConstVectorRef& x, NormalEquations& out) const {
  ++counts_.normal_equations;
  model_->normal_equations(x, out);
}

void Problem::batch_cost(const ConstMatrixRef& candidates, VectorRef costs) const {
  std::atomic_ref<std::int64_t>(counts_.cost).fetch_add(candidates.cols(), std::memory_order_relaxed);
  model_->batch_cost(candidates, costs);
}

std::unique_ptr<LatticePoint> Problem::lattice_point(const ConstVectorRef& x) const {
  return model_->lattice_point(x);
}

double Problem::lattice_change(const LatticePoint& point, Eigen::Index i, double value) const {
  ++counts_.lattice;
  return point.change(i, value);
}

}  // namespace odobench
