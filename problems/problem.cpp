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

}  // namespace odobench
