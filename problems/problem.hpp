// The shared cost interface: a problem is anything with a cost.
//
// A model is a plain class with three mandatory members
//     std::string name() const;
//     const std::vector<ParameterInfo>& parameters() const;
//     double cost(const ConstVectorRef& x) const;
// and any of the optional ones below, which the handle detects by concepts and otherwise derives where that
// is exact (gradient = 2 J'r, a batch as a loop of costs) or reports as absent.
//
// x is in the units of the parameters, n = parameters().size(). A cost with residuals is J(x) = r(x)'r(x),
// without the factor 1/2. Models are immutable once built: every member is const and may be called from
// several threads.
#pragma once

#include <Eigen/Core>
#include <concepts>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/parameter.hpp"
#include "problems/block_quadratic.hpp"
#include "problems/lattice.hpp"
#include "problems/matrices.hpp"

namespace odobench {

// One calibrated quantity and its box.
using ParameterInfo = Parameter;

// Throws std::invalid_argument naming the parameter, the values and the violated relation unless all are
// finite and lower <= nominal <= upper, the list is not empty and the names are unique.
void validate(const std::vector<ParameterInfo>& parameters);

// J(x) = r'r, gradient half J'r (n) and Gauss-Newton matrix J'J (n x n, both triangles filled).
struct NormalEquations {
  double cost = 0;
  Vector jtr;
  Matrix jtj;
};

// Calls that reached the model. A batch of m candidates counts m cost calls.
struct EvaluationCounts {
  std::int64_t cost = 0;
  std::int64_t gradient = 0;
  std::int64_t residuals = 0;
  std::int64_t normal_equations = 0;
  std::int64_t lattice = 0;  // changes of a lattice point that were looked at
  std::int64_t total() const { return cost + gradient + residuals + normal_equations + lattice; }
  EvaluationCounts& operator+=(const EvaluationCounts& other) {
    cost += other.cost;
    gradient += other.gradient;
    residuals += other.residuals;
    normal_equations += other.normal_equations;
    lattice += other.lattice;
    return *this;
  }
};

template <class M>
concept ProblemModel = requires(const M& m, const ConstVectorRef& x) {
  { m.name() } -> std::convertible_to<std::string>;
  { m.parameters() } -> std::convertible_to<const std::vector<ParameterInfo>&>;
  { m.cost(x) } -> std::same_as<double>;
};
template <class M>
concept HasGradient = requires(const M& m, const ConstVectorRef& x, VectorRef g) {
  { m.cost_and_gradient(x, g) } -> std::same_as<double>;
};
// residual_count() rows; J is residual_count() x n.
template <class M>
concept HasResiduals = requires(const M& m, const ConstVectorRef& x, VectorRef r, MatrixRef j) {
  { m.residual_count() } -> std::convertible_to<Eigen::Index>;
  m.residuals(x, r);
  m.residuals_and_jacobian(x, r, j);
};
template <class M>
concept HasNormalEquations = requires(const M& m, const ConstVectorRef& x, NormalEquations& out) {
  m.normal_equations(x, out);
};
// candidates n x m, one per column; costs m. The value of a candidate must not depend on its neighbours.
template <class M>
concept HasBatchCost = requires(const M& m, const ConstMatrixRef& candidates, VectorRef costs) {
  m.batch_cost(candidates, costs);
};
template <class M>
concept HasStart = requires(const M& m) {
  { m.start() } -> std::convertible_to<Vector>;
};
// Admissible values of every parameter, each list ascending and inside the box, and a point that walks on
// them.
template <class M>
concept HasLattice = requires(const M& m, const ConstVectorRef& x) {
  { m.lattice_levels() } -> std::convertible_to<const std::vector<Vector>&>;
  { m.lattice_point(x) } -> std::same_as<std::unique_ptr<LatticePoint>>;
};
// The cost is exactly this sum of quadratic blocks.
template <class M>
concept HasBlockQuadratic = requires(const M& m) {
  { m.block_quadratic() } -> std::convertible_to<const BlockQuadratic&>;
};
// An upper estimate, in units of the cost, of what rounding leaves in cost(x): below it nothing can be told.
template <class M>
concept HasRoundingFloor = requires(const M& m, const ConstVectorRef& x) {
  { m.rounding_floor(x) } -> std::convertible_to<double>;
};
// Lowest cost in the box, where it is known: from theory, certified, or the lowest that anyone has found (the
// model says which). Empty where a model knows it for some of its instances only.
template <class M>
concept HasKnownOptimum = requires(const M& m) {
  { m.known_optimum() } -> std::convertible_to<std::optional<double>>;
};
// Points in the box where the known optimum is attained, as far as they are known (rounded to the digits they
// were stated with): the certified or published one first, then those of the same cost by a symmetry of the
// model.
template <class M>
concept HasKnownMinimisers = requires(const M& m) {
  { m.known_minimisers() } -> std::convertible_to<std::vector<Vector>>;
};

// Value handle around a shared, immutable model; counts the evaluations made through it. Copying is cheap and
// the copy starts with zeroed counts, so every run owns its own. One handle is not to be used from
// two threads at once, except for batch_cost.
class Problem {
 public:
  // Throws std::invalid_argument when the model's parameters are not valid.
  template <ProblemModel M>
  explicit Problem(std::shared_ptr<const M> model);
  template <ProblemModel M>
  explicit Problem(M model) : Problem(std::make_shared<const M>(std::move(model))) {}

  Problem(const Problem& other) : model_(other.model_) {}
  Problem& operator=(const Problem& other);
  Problem(Problem&&) = default;
  Problem& operator=(Problem&&) = default;
  ~Problem() = default;

  const std::string& name() const { return model_->name; }
  const std::vector<ParameterInfo>& parameters() const { return model_->parameters; }
  Eigen::Index dimension() const { return static_cast<Eigen::Index>(model_->parameters.size()); }
  // The model's start, by default the nominal values.
  const Vector& start() const { return model_->start; }
  std::optional<double> known_optimum() const { return model_->known_optimum; }
  // Empty where none is known.
  const std::vector<Vector>& known_minimisers() const { return model_->known_minimisers; }
  // The first of them.
  std::optional<Vector> known_minimiser() const {
    return known_minimisers().empty() ? std::nullopt : std::optional<Vector>(known_minimisers().front());
  }

  bool has_gradient() const { return model_->has_gradient; }
  bool has_residuals() const { return model_->has_residuals; }
  bool has_normal_equations() const { return model_->has_normal_equations; }
  // Normal equations are the products of residuals and Jacobian, not a form of the model's own.
  bool forms_normal_equations() const { return model_->forms_normal_equations; }
  bool has_fast_batch() const { return model_->has_batch; }
  Eigen::Index residual_count() const { return model_->residual_count; }
  bool has_lattice() const { return !model_->lattice_levels.empty(); }
  // Empty without has_lattice().
  const std::vector<Vector>& lattice_levels() const { return model_->lattice_levels; }
  // Null when the cost has no such form.
  const BlockQuadratic* block_quadratic() const { return model_->block_quadratic(); }

  // 0 where the model does not state one. Not counted.
  double rounding_floor(const ConstVectorRef& x) const { return model_->rounding_floor(x); }

  double cost(const ConstVectorRef& x) const;
  // Returns J, fills g = dJ/dx (n). Throws std::logic_error without has_gradient().
  double cost_and_gradient(const ConstVectorRef& x, VectorRef g) const;
  // r (residual_count), j (residual_count x n). Throws std::logic_error without has_residuals().
  void residuals(const ConstVectorRef& x, VectorRef r) const;
  void residuals_and_jacobian(const ConstVectorRef& x, VectorRef r, MatrixRef j) const;
  // Throws std::logic_error without has_normal_equations().
  void normal_equations(const ConstVectorRef& x, NormalEquations& out) const;
  void batch_cost(const ConstMatrixRef& candidates, VectorRef costs) const;
  // x must be admissible. Throws std::logic_error without has_lattice().
  std::unique_ptr<LatticePoint> lattice_point(const ConstVectorRef& x) const;
  // point.change(i, value), counted.
  double lattice_change(const LatticePoint& point, Eigen::Index i, double value) const;

  const EvaluationCounts& counts() const { return counts_; }
  // Takes calls into account that were made through another handle.
  void count(const EvaluationCounts& calls) const { counts_ += calls; }

 private:
  struct Interface {
    virtual ~Interface() = default;
    virtual double rounding_floor(const ConstVectorRef& x) const = 0;
    virtual double cost(const ConstVectorRef& x) const = 0;
    virtual double cost_and_gradient(const ConstVectorRef& x, VectorRef g) const = 0;
    virtual void residuals(const ConstVectorRef& x, VectorRef r) const = 0;
    virtual void residuals_and_jacobian(const ConstVectorRef& x, VectorRef r, MatrixRef j) const = 0;
    virtual void normal_equations(const ConstVectorRef& x, NormalEquations& out) const = 0;
    virtual void batch_cost(const ConstMatrixRef& candidates, VectorRef costs) const = 0;
    virtual std::unique_ptr<LatticePoint> lattice_point(const ConstVectorRef& x) const = 0;
    virtual const BlockQuadratic* block_quadratic() const = 0;
    std::string name;
    std::vector<ParameterInfo> parameters;
    Vector start;
    std::optional<double> known_optimum;
    std::vector<Vector> known_minimisers;
    bool has_gradient = false, has_residuals = false, has_normal_equations = false, has_batch = false;
    bool forms_normal_equations = false;
    Eigen::Index residual_count = 0;
    std::vector<Vector> lattice_levels;
  };
  template <ProblemModel M>
  struct Holder;
  [[noreturn]] static void absent(const char* capability, const std::string& problem);
  static void adopt(Interface& model);

  std::shared_ptr<const Interface> model_;
  mutable EvaluationCounts counts_;
};

template <ProblemModel M>
struct Problem::Holder final : Interface {
  explicit Holder(std::shared_ptr<const M> m) : model(std::move(m)) {
    name = model->name();
    parameters = model->parameters();
    if constexpr (HasStart<M>) start = model->start();
    if constexpr (HasKnownOptimum<M>) known_optimum = model->known_optimum();
    if constexpr (HasKnownMinimisers<M>) known_minimisers = model->known_minimisers();
    has_residuals = HasResiduals<M>;
    has_normal_equations = HasNormalEquations<M> || HasResiduals<M>;
    forms_normal_equations = HasResiduals<M> && !HasNormalEquations<M>;
    has_gradient = HasGradient<M> || has_normal_equations;
    has_batch = HasBatchCost<M>;
    if constexpr (HasResiduals<M>) residual_count = model->residual_count();
    if constexpr (HasLattice<M>) lattice_levels = model->lattice_levels();
  }
  double rounding_floor(const ConstVectorRef& x) const override {
    if constexpr (HasRoundingFloor<M>)
      return model->rounding_floor(x);
    else
      return 0.0;
  }
  double cost(const ConstVectorRef& x) const override { return model->cost(x); }
  double cost_and_gradient(const ConstVectorRef& x, VectorRef g) const override {
    if constexpr (HasGradient<M>) {
      return model->cost_and_gradient(x, g);
    } else {
      NormalEquations e;
      normal_equations(x, e);
      g = 2.0 * e.jtr;
      return e.cost;
    }
  }
  void residuals(const ConstVectorRef& x, VectorRef r) const override {
    if constexpr (HasResiduals<M>)
      model->residuals(x, r);
    else
      absent("residuals", name);
  }
  void residuals_and_jacobian(const ConstVectorRef& x, VectorRef r, MatrixRef j) const override {
    if constexpr (HasResiduals<M>)
      model->residuals_and_jacobian(x, r, j);
    else
      absent("a Jacobian", name);
  }
  void normal_equations(const ConstVectorRef& x, NormalEquations& out) const override {
    if constexpr (HasNormalEquations<M>) {
      model->normal_equations(x, out);
    } else if constexpr (HasResiduals<M>) {
      Vector r(residual_count);
      Matrix j(residual_count, static_cast<Eigen::Index>(parameters.size()));
      model->residuals_and_jacobian(x, r, j);
      out.cost = r.squaredNorm();
      out.jtr = j.transpose() * r;
      out.jtj = j.transpose() * j;
    } else {
      absent("normal equations", name);
    }
  }
  void batch_cost(const ConstMatrixRef& candidates, VectorRef costs) const override {
    if constexpr (HasBatchCost<M>) {
      model->batch_cost(candidates, costs);
    } else {
      for (Eigen::Index k = 0; k < candidates.cols(); ++k) costs[k] = model->cost(candidates.col(k));
    }
  }
  std::unique_ptr<LatticePoint> lattice_point(const ConstVectorRef& x) const override {
    if constexpr (HasLattice<M>)
      return model->lattice_point(x);
    else
      absent("a lattice", name);
  }
  const BlockQuadratic* block_quadratic() const override {
    if constexpr (HasBlockQuadratic<M>)
      return &model->block_quadratic();
    else
      return nullptr;
  }
  std::shared_ptr<const M> model;
};

template <ProblemModel M>
Problem::Problem(std::shared_ptr<const M> model) {
  auto holder = std::make_shared<Holder<M>>(std::move(model));
  adopt(*holder);
  model_ = std::move(holder);
}

}  // namespace odobench
