#include "solvers/certificate/derivative_check.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "base/range.hpp"

namespace odobench {
namespace {

constexpr double kFirstStep = 1e-2;
constexpr double kShrink = 4;
constexpr int kSteps = 11;  // down to 1e-8 of the scale
constexpr double kTolerance = 1e-6;
constexpr double kGramTolerance = 1e-9;  // two sums of the same products
constexpr double kSafety = 10;
constexpr double kUsable = 1e-4;
constexpr double kEnough = 1e-9;  // of the column: smaller steps have nothing to add

// Values of the problem along one parameter; empty where they are not finite.
using Along = std::function<Vector(double shift)>;

// uncertainty: of the worst entry. Infinite where no step led anywhere.
struct Slope {
  Vector value;
  double uncertainty = std::numeric_limits<double>::infinity();
};

// The next row of the tableau: slopes at this step, extrapolated with the row before. Keeps the entry whose
// neighbours agree best, all components together: among many, some would agree by chance. `rounding`: what it
// leaves in a slope at this step.
void extrapolate(std::vector<Vector>& tableau, Vector slope, double power, double rounding, Slope& best) {
  std::vector<Vector> row{std::move(slope)};
  double factor = power;
  for (const Vector& before : tableau) {
    Vector next = (factor * row.back() - before) / (factor - 1);
    const double apart =
        std::max((next - row.back()).cwiseAbs().maxCoeff(), (next - before).cwiseAbs().maxCoeff());
    if (const double unsure = std::max(apart, rounding); unsure < best.uncertainty) best = {next, unsure};
    row.push_back(std::move(next));
    factor *= power;
  }
  tableau = std::move(row);
}

Slope differences(const ParameterInfo& p, double x, const Vector& here, const Along& along) {
  const double scale = std::max(std::abs(x), 1e-4 * (p.upper - p.lower));
  double h = std::min(kFirstStep * scale, 0.25 * (p.upper - p.lower));
  const double below = x - p.lower, above = p.upper - x;
  const bool central = std::min(below, above) >= h;
  const double side = above >= below ? 1.0 : -1.0;
  Slope best{Vector::Zero(here.size())};
  std::vector<Vector> tableau;
  for (int step = 0; step < kSteps; ++step, h /= kShrink) {
    // The step as the parameter can make it, so that its own rounding is no part of the slope.
    const double up = (x + side * h) - x, down = central ? (x - side * h) - x : 0.0;
    if (up == 0) break;
    const Vector ahead = along(up), behind = central ? along(down) : here;
    if (ahead.size() == 0 || behind.size() == 0) {  // the step reaches where nothing is defined
      tableau.clear();
      continue;
    }
    const double rounding = 4 * std::numeric_limits<double>::epsilon() *
                            std::max(ahead.cwiseAbs().maxCoeff(), behind.cwiseAbs().maxCoeff()) / h;
    extrapolate(tableau, (ahead - behind) / (up - down), central ? kShrink * kShrink : kShrink, rounding,
                best);
    if (best.uncertainty <= kEnough * best.value.cwiseAbs().maxCoeff()) break;
  }
  return best;
}

// The worst entry of a column that is stated against one that was differenced.
DerivativeComparison compare_column(const char* kind, const std::string& parameter,
                                    const ConstVectorRef& stated, const Slope& slope) {
  for (Eigen::Index i = 0; i < stated.size(); ++i)
    if (!std::isfinite(stated[i]))
      return {kind, parameter, kNotANumber, kTolerance, stated[i], slope.value[i], i};
  Eigen::Index worst = 0;
  const double apart = (stated - slope.value).cwiseAbs().maxCoeff(&worst);
  const double size = std::max(stated.cwiseAbs().maxCoeff(), slope.value.cwiseAbs().maxCoeff());
  DerivativeComparison c{kind, parameter, 0, kTolerance, stated[worst], slope.value[worst], worst};
  if (size > 0) c.error = apart / size;
  if (size > 0 || std::isinf(slope.uncertainty))
    c.limit = std::max(kTolerance, kSafety * slope.uncertainty / size);
  return c;
}

DerivativeComparison compare_gram(const std::vector<ParameterInfo>& list, const Matrix& stated,
                                  const Matrix& product, Eigen::Index i) {
  const std::string& name = list[static_cast<std::size_t>(i)].name;
  DerivativeComparison c{"J'J", name, 0, kGramTolerance, stated(i, i), product(i, i), i};
  for (Eigen::Index k = 0; k < stated.rows(); ++k) {
    if (!std::isfinite(stated(i, k)))
      return {"J'J", name, kNotANumber, kGramTolerance, stated(i, k), product(i, k), k};
    const double size = std::sqrt(product(i, i)) * std::sqrt(product(k, k));
    const double apart = std::abs(stated(i, k) - product(i, k));
    const double error =
        size > 0 ? apart / size : (apart > 0 ? std::numeric_limits<double>::infinity() : 0.0);
    if (error > c.error) {
      c.error = error;
      c.stated = stated(i, k);
      c.differenced = product(i, k);
      c.row = k;
    }
  }
  return c;
}

// A sum of products that cancel has lost digits, and a unit in the last place of the parameters changes 2 J'r
// by 2 J'J of it.
double gradient_rounding(const Matrix& j, const Vector& r, const ConstVectorRef& x, Eigen::Index i) {
  const Vector column = j.col(i).cwiseAbs();
  double sum = 2 * column.dot(r.cwiseAbs());
  for (Eigen::Index k = 0; k < x.size(); ++k) sum += 2 * std::abs(x[k]) * std::abs(j.col(k).dot(j.col(i)));
  return 2 * std::numeric_limits<double>::epsilon() * sum;
}

Vector finite_or_empty(Vector values) {
  return values.allFinite() ? values : Vector();
}

Vector residuals_at(const Problem& problem, const ConstVectorRef& x) {
  Vector r(problem.residual_count());
  problem.residuals(x, r);
  return finite_or_empty(std::move(r));
}

Vector moved(const ConstVectorRef& x, Eigen::Index i, double shift) {
  Vector at = x;
  at[i] += shift;
  return at;
}

Slope residual_slope(const Problem& problem, const ConstVectorRef& x, const Vector& here, Eigen::Index i) {
  return differences(problem.parameters()[static_cast<std::size_t>(i)], x[i], here,
                     [&](double shift) { return residuals_at(problem, moved(x, i, shift)); });
}

}  // namespace

Matrix difference_jacobian(const Problem& problem, const ConstVectorRef& x) {
  if (!problem.has_residuals()) return {};
  const auto& list = problem.parameters();
  Matrix j = Matrix::Zero(problem.residual_count(), static_cast<Eigen::Index>(list.size()));
  const Vector here = residuals_at(problem, x);
  if (here.size() == 0) return {};
  for (Eigen::Index i = 0; i < j.cols(); ++i) {
    const ParameterInfo& p = list[static_cast<std::size_t>(i)];
    if (!(p.lower < p.upper)) continue;
    const Slope slope = residual_slope(problem, x, here, i);
    const double size = slope.value.cwiseAbs().maxCoeff();
    if (!(slope.uncertainty <= kUsable * size) && slope.uncertainty > 0) return {};
    j.col(i) = slope.value;
  }
  return j;
}

std::vector<DerivativeComparison> compare_derivatives(const Problem& problem, const ConstVectorRef& x) {
  std::vector<DerivativeComparison> found;
  if (!problem.has_gradient()) return found;
  const auto& list = problem.parameters();
  const auto n = static_cast<Eigen::Index>(list.size());
  const Vector cost = Vector::Constant(1, problem.cost(x));
  if (!cost.allFinite()) return found;
  Vector gradient(n);
  problem.cost_and_gradient(x, gradient);
  Vector residuals;
  Matrix jacobian;
  if (problem.has_residuals()) {
    residuals.resize(problem.residual_count());
    jacobian.resize(problem.residual_count(), n);
    problem.residuals_and_jacobian(x, residuals, jacobian);
  }
  NormalEquations own;
  const bool gram = problem.has_residuals() && !problem.forms_normal_equations();
  Matrix product;
  if (gram) {
    problem.normal_equations(x, own);
    product = jacobian.transpose() * jacobian;
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const ParameterInfo& p = list[static_cast<std::size_t>(i)];
    if (!(p.lower < p.upper)) continue;
    if (problem.has_residuals())
      found.push_back(
          compare_column("Jacobian", p.name, jacobian.col(i), residual_slope(problem, x, residuals, i)));
    Slope slope = differences(p, x[i], cost, [&](double shift) {
      return finite_or_empty(Vector::Constant(1, problem.cost(moved(x, i, shift))));
    });
    if (problem.has_residuals()) slope.uncertainty += gradient_rounding(jacobian, residuals, x, i);
    found.push_back(compare_column("gradient", p.name, gradient.segment(i, 1), slope));
    if (gram) found.push_back(compare_gram(list, own.jtj, product, i));
  }
  return found;
}

}  // namespace odobench
