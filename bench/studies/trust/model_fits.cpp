#include "bench/studies/trust/model_fits.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "solvers/solve.hpp"

namespace odobench {
namespace {

constexpr int kMoreStarts = 3;
constexpr double kSameOptimum = 1e-6;  // relative difference of J

struct Fit {
  Vector z;
  double cost = HUGE_VAL;
};

Fit fit_from(const Problem& problem, const Vector& start, std::int64_t& evaluations) {
  SolveOptions options;
  options.budget.max_evaluations = 1000;
  const Result result = solve(problem, {"lm", {{"cost_tolerance", "1e-11"}}}, start, options);
  evaluations += result.counts.total();
  return {result.x, result.usable() ? result.cost : HUGE_VAL};
}

// Distinct optima from these starts, the lowest first.
std::vector<Fit> optima_from(const Problem& problem, const std::vector<Vector>& starts, const Stop& stop,
                             std::int64_t& evaluations) {
  std::vector<Fit> optima;
  for (const Vector& start : starts) {
    stop.check();
    Fit fit = fit_from(problem, start, evaluations);
    if (fit.z.size() == 0) continue;
    const bool known = std::any_of(optima.begin(), optima.end(), [&](const Fit& o) {
      return std::abs(o.cost - fit.cost) <= kSameOptimum * std::abs(fit.cost);
    });
    if (!known) optima.push_back(std::move(fit));
  }
  std::stable_sort(optima.begin(), optima.end(), [](const Fit& a, const Fit& b) { return a.cost < b.cost; });
  if (optima.empty()) optima.push_back({starts.front(), problem.cost(starts.front())});
  return optima;
}

// The optimum of the shared offset as a start of single ones.
std::vector<Vector> shared_start(const CalibrationProblem& plain, const Robot& robot, const ModelFits& fits,
                                 const Problem& problem, std::int64_t& evaluations) {
  if (fits.terms.offsets != ModelTerms::Offsets::Each) return {};
  CalibrationOptions options = plain.options();
  options.model = fits.terms;
  options.model.offsets = ModelTerms::Offsets::Shared;
  try {
    const Robot shared_robot = with_model(robot, options.model);
    const Problem shared(
        std::make_shared<const CalibrationProblem>(robot, plain.recordings(), options, plain.kernel()));
    const Fit fit = fit_from(shared, shared.start(), evaluations);
    std::map<std::string, double> values;
    for (std::size_t p = 0; p < shared.parameters().size(); ++p)
      values[shared.parameters()[p].name] = fit.z[static_cast<Eigen::Index>(p)];
    for (const BoundParameter& p : shared_robot.table.parameters)
      if (p.parameter.name == "offset")
        for (const Binding& b : p.bindings)
          values["offset" + std::to_string(b.wheel + 1)] = b.factor * values.at("offset");
    Vector start = problem.start();
    for (std::size_t p = 0; p < problem.parameters().size(); ++p)
      if (const auto found = values.find(problem.parameters()[p].name); found != values.end())
        start[static_cast<Eigen::Index>(p)] = found->second;
    return {start};
  } catch (const std::invalid_argument&) {  // no wheel is left or right
    return {};
  }
}

std::vector<FoldFit> fit_folds(const std::shared_ptr<const RecordingCosts>& costs,
                               const std::vector<Fold>& folds, const std::vector<Vector>& starts,
                               const Stop& stop, std::int64_t& evaluations, std::vector<MaxErrors>& errors,
                               double& held_cost) {
  std::vector<FoldFit> fits;
  for (const Fold& fold : folds) {
    Vector weights = Vector::Ones(static_cast<Eigen::Index>(costs->size()));
    for (const std::size_t n : fold.left_out) weights[static_cast<Eigen::Index>(n)] = 0;
    const Problem problem{WeightedCalibration(costs, weights)};
    const Fit best = optima_from(problem, starts, stop, evaluations).front();
    for (const std::size_t n : fold.left_out) {
      errors.push_back((*costs)[n].max_errors(best.z).front());
      held_cost += (*costs)[n].cost(best.z);
    }
    fits.push_back({fold.name, best.z});
  }
  return fits;
}

void count_parameters(const CalibrationProblem& model, ModelFits& fits) {
  for (std::size_t p = 0; p < fits.parameters.size(); ++p) {
    const ParameterInfo& info = fits.parameters[p];
    const double width = info.upper - info.lower, value = fits.z[static_cast<Eigen::Index>(p)];
    if (width <= 0) continue;
    const bool bound = value - info.lower < kOnBound * width || info.upper - value < kOnBound * width;
    ++(bound ? fits.on_bounds : fits.free);
  }
  if (model.options().model.start_pose) fits.free += 3 * static_cast<int>(model.recordings().size());
}

}  // namespace

double error_total(const std::vector<MaxErrors>& errors) {
  std::map<std::string, std::pair<double, int>> sums;
  for (const MaxErrors& e : errors) {
    auto& [sum, count] = sums[e.trajectory];
    sum += e.x + e.y + e.theta;
    ++count;
  }
  double total = 0;
  for (const auto& [trajectory, sum] : sums) total += sum.first / sum.second;
  return total;
}

void fit_model(const CalibrationProblem& plain, const Robot& robot, const std::vector<Fold>& repetitions,
               const std::vector<Fold>& trajectories, const Stop& stop, ModelFits& fits) {
  CalibrationOptions options = plain.options();
  options.model = fits.terms;
  const auto model =
      std::make_shared<const CalibrationProblem>(robot, plain.recordings(), options, plain.kernel());
  const Problem problem(model);
  fits.parameters = model->parameters();
  fits.own = plain.parameters().size();
  for (const Recording& r : plain.recordings()) {
    const double turned = r.reference.theta.back() - r.reference.theta.front();
    fits.senses.push_back(turned > 1 ? 1 : turned < -1 ? -1 : 0);
  }
  std::vector<Vector> starts = {problem.start()};
  for (Vector& start : shared_start(plain, robot, fits, problem, fits.evaluations))
    starts.push_back(std::move(start));
  const bool valleys = fits.terms.offsets == ModelTerms::Offsets::Each || fits.terms.steering_zeros;
  if (valleys)
    for (int k = 1; k <= kMoreStarts; ++k)
      starts.push_back(random_start(problem, static_cast<std::uint64_t>(k)));
  const std::vector<Fit> optima = optima_from(problem, starts, stop, fits.evaluations);
  fits.z = optima.front().z;
  fits.cost = optima.front().cost;
  fits.errors = model->max_errors(fits.z);
  count_parameters(*model, fits);
  if (const ModelForm* form = model->extended(); form != nullptr && options.model.start_pose)
    for (std::size_t n = 0; n < plain.recordings().size(); ++n)
      fits.start_headings.push_back(form->start_shift(n, fits.z)[2]);

  if (repetitions.empty() && trajectories.empty()) return;
  std::vector<Vector> near;
  for (const Fit& optimum : optima) near.push_back(optimum.z);
  if (valleys) near.push_back(problem.start());
  const auto costs =
      std::make_shared<const RecordingCosts>(robot, plain.recordings(), options, plain.kernel());
  fits.repetitions =
      fit_folds(costs, repetitions, near, stop, fits.evaluations, fits.held_errors, fits.held_cost);
  fits.trajectories =
      fit_folds(costs, trajectories, near, stop, fits.evaluations, fits.new_kind_errors, fits.new_kind_cost);
}

}  // namespace odobench
