#include "bench/studies/trust/validation.hpp"

#include <fmt/format.h>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "bench/studies/trust/held_out_prediction.hpp"
#include "reports/statistics/statistics.hpp"

namespace odobench {
namespace {
using Eigen::Index;

// Of one recording at one point.
struct Judged {
  double cost = 0;
  RecordingError error;
};

Judged judge(const RecordingCosts& recordings, std::size_t n, const Vector& z) {
  const MaxErrors e = recordings[n].max_errors(z).front();
  return {recordings[n].cost(z), {e.recording, e.trajectory, e.repetition, {e.x, e.y, e.theta}}};
}

// J and total error of some recordings, whose figures are in their order.
struct Sums {
  double cost = 0;
  std::vector<RecordingError> errors;
  void add(const Judged& one) {
    cost += one.cost;
    errors.push_back(one.error);
  }
  double total() const { return error_totals(error_statistics(errors)).total; }
};

struct ThreeSums {
  Sums held_out, full, nominal;
  HeldOut figures() const {
    return {held_out.cost, full.cost, nominal.cost, held_out.total(), full.total(), nominal.total()};
  }
};

// Every recording at the fit to all and at the nominal parameters.
struct References {
  std::vector<Judged> full, nominal;
};

struct FoldResult {
  FoldFigures figures;
  std::vector<Judged> left_out;  // in the order of Fold::left_out
};

FoldResult run_fold(const std::shared_ptr<const RecordingCosts>& recordings, const Fold& fold,
                    const RefitOptions& refit_options, std::uint64_t seed, const References& references,
                    const Stop& stop) {
  Vector weights = Vector::Ones(static_cast<Index>(recordings->size()));
  for (const std::size_t n : fold.left_out) weights[static_cast<Index>(n)] = 0;
  const Refit fit = refit(recordings, weights, refit_options, seed, stop);
  FoldResult out;
  ThreeSums sums;
  Sums fitted;
  for (std::size_t n = 0; n < recordings->size(); ++n) {
    Judged one = judge(*recordings, n, fit.z);
    if (weights[static_cast<Index>(n)] > 0) {
      fitted.add(one);
      continue;
    }
    sums.held_out.add(one);
    sums.full.add(references.full[n]);
    sums.nominal.add(references.nominal[n]);
    out.left_out.push_back(std::move(one));
  }
  out.figures = {fold.name,      fold.left_out.size(), fit.cost,
                 fitted.total(), sums.figures(),       {fit.z.data(), fit.z.data() + fit.z.size()}};
  return out;
}

SchemeFigures scheme_figures(const FoldPlan& plan, std::vector<FoldResult> results,
                             const References& references) {
  const std::size_t count = references.full.size();
  SchemeFigures out{plan.scheme, std::vector<double>(count, 0), {}, {}, {}};
  std::vector<const Judged*> judged(count, nullptr);
  for (std::size_t f = 0; f < plan.folds.size(); ++f)
    for (std::size_t i = 0; i < plan.folds[f].left_out.size(); ++i) {
      const std::size_t n = plan.folds[f].left_out[i];
      out.fold_of[n] = static_cast<double>(f + 1);
      judged[n] = &results[f].left_out[i];
    }
  ThreeSums sums;
  for (std::size_t n = 0; n < count; ++n) {
    if (judged[n] == nullptr) continue;
    sums.held_out.add(*judged[n]);
    sums.full.add(references.full[n]);
    sums.nominal.add(references.nominal[n]);
  }
  out.all = sums.figures();
  for (FoldResult& result : results) out.folds.push_back(std::move(result.figures));
  return out;
}

}  // namespace

std::vector<DriveName> drive_names(std::span<const Recording> recordings) {
  std::vector<DriveName> names;
  for (const Recording& r : recordings) names.push_back({r.trajectory, r.repetition});
  return names;
}

std::vector<DriveName> drive_names(const RecordingCosts& recordings) {
  std::vector<DriveName> names;
  for (std::size_t n = 0; n < recordings.size(); ++n)
    names.push_back({recordings.recording(n).trajectory, recordings.recording(n).repetition});
  return names;
}

Vector nominal_of(const std::vector<ParameterInfo>& parameters) {
  Vector nominal(static_cast<Index>(parameters.size()));
  for (Index i = 0; i < nominal.size(); ++i) nominal[i] = parameters[static_cast<std::size_t>(i)].nominal;
  return nominal;
}

Validation validate(const std::shared_ptr<const RecordingCosts>& recordings,
                    const std::vector<FoldPlan>& plans, const ValidationOptions& options, Watcher& watcher,
                    const Stop& stop) {
  struct Work {
    std::size_t plan, fold;
  };
  std::vector<Work> work;
  for (std::size_t p = 0; p < plans.size(); ++p)
    for (std::size_t f = 0; f < plans[p].folds.size(); ++f) work.push_back({p, f});
  Validation out;
  RefitOptions refit_options{options.solver, options.start,   {},
                             options.budget, options.solvers, options.polish};
  const auto count = static_cast<Index>(recordings->size());
  out.full = refit(recordings, Vector::Ones(count), refit_options, derive_seed(options.seed, {"full"}), stop);
  refit_options.start = out.full.z;
  refit_options.second_start = options.second_start;
  const Vector nominal = nominal_of(recordings->parameters());
  References references{std::vector<Judged>(recordings->size()), std::vector<Judged>(recordings->size())};
  parallel_for(
      recordings->size(), options.threads,
      [&](std::size_t n) {
        references.full[n] = judge(*recordings, n, out.full.z);
        references.nominal[n] = judge(*recordings, n, nominal);
      },
      stop);
  std::vector<FoldResult> results(work.size());
  watcher.count_begins("folds", static_cast<std::int64_t>(work.size()));
  parallel_for(
      work.size(), options.threads,
      [&](std::size_t i) {
        const FoldPlan& plan = plans[work[i].plan];
        const Fold& fold = plan.folds[work[i].fold];
        results[i] = run_fold(recordings, fold, refit_options,
                              derive_seed(options.seed, {plan.scheme, fold.name}), references, stop);
        watcher.count_one();
      },
      stop);
  watcher.count_ends();
  auto next = std::make_move_iterator(results.begin());
  for (const FoldPlan& plan : plans) {
    if (plan.folds.empty()) continue;
    const auto end = next + static_cast<std::ptrdiff_t>(plan.folds.size());
    out.schemes.push_back(scheme_figures(plan, {next, end}, references));
    next = end;
    if (plan.scheme == kRepetitions && plan.never_left_out == 0)
      out.schemes.back().cost_predicted = predicted_held_out_cost(*recordings, out.full.z);
  }
  return out;
}

Validation validate(const Robot& robot, std::span<const Recording> recordings,
                    const CalibrationOptions& calibration, const std::vector<FoldPlan>& plans,
                    const ValidationOptions& options, const Stop& stop) {
  const auto each = std::make_shared<const RecordingCosts>(robot, recordings, calibration);
  ValidationOptions from_nominal = options;
  if (options.start.size() == 0) from_nominal.start = nominal_of(each->parameters());
  if (options.second_start.size() == 0) from_nominal.second_start = nominal_of(each->parameters());
  Watcher nobody;
  return validate(each, plans, from_nominal, nobody, stop);
}

}  // namespace odobench
