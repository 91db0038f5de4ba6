#include "bench/studies/trust/trust_study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <set>
#include <stdexcept>
#include <utility>

#include "base/random.hpp"
#include "base/text.hpp"
#include "bench/studies/trust/noise_study.hpp"
#include "bench/studies/trust/replicate_file.hpp"
#include "bench/studies/trust/validation.hpp"
#include "bench/studies/trust_figures.hpp"
#include "problems/trust/combined_intervals.hpp"
#include "reports/figures/vega.hpp"
#include "reports/kinds/trust/bootstrap_record.hpp"
#include "reports/kinds/trust/profile_record.hpp"
#include "reports/kinds/trust/validation_sentences.hpp"
#include "reports/statistics/row_groups.hpp"

namespace odobench {
namespace {

// For the estimate of what folds take. Evaluations of J with derivatives per fit, seconds per sample that is
// judged, and of the structured form seconds per sample and evaluation, on one core of 2020: from counts, so
// that the thesis' robot has the same tables on every machine. The general form takes from 3 to 400 ns, as
// the robot is: it is measured.
constexpr double kEvaluationsPerFit = 50;
constexpr double kStructured_s = 7e-9, kJudged_s = 100e-9;

Vector point_of(const RunRecord& record) {
  Vector z(static_cast<Eigen::Index>(record.parameters.size()));
  for (Eigen::Index i = 0; i < z.size(); ++i) z[i] = record.parameters[static_cast<std::size_t>(i)].value;
  return z;
}

double samples_of(const CalibrationProblem& problem) {
  double samples = 0;
  for (const Recording& r : problem.recordings()) samples += static_cast<double>(r.size());
  return samples;
}

// Processor time of one evaluation at the nominal parameters.
double seconds_of_evaluation(const CalibrationProblem& problem, double samples) {
  if (problem.structured()) return kStructured_s * samples;
  NormalEquations out;
  const std::clock_t begin = std::clock();
  problem.normal_equations(nominal_of(problem.parameters()), out);
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

// Of every row the run that tables show, and the lowest one.
std::set<const RunRecord*> shown_runs(const std::vector<RunRecord>& records) {
  std::set<const RunRecord*> shown;
  for (const Comparison& comparison : compare(records))
    for (const ComparisonRow& row : comparison.rows) {
      if (row.kind != "run") continue;
      shown.insert(row.shown);
      const RunRecord* lowest = row.shown;
      for (const RunRecord* run : row.runs)
        if (run->cost && lowest->cost && *run->cost < *lowest->cost) lowest = run;
      shown.insert(lowest);
    }
  return shown;
}

std::vector<ProfileFigures> profile_figures(const std::vector<ParameterProfile>& profiles) {
  std::vector<ProfileFigures> list;
  for (const ParameterProfile& p : profiles) {
    ProfileFigures one{p.parameter, {}, {}, p.rise, p.ends.lower, p.ends.upper};
    for (const ProfilePoint& point : p.points) {
      one.values.push_back(point.value);
      one.costs.push_back(point.cost);
    }
    list.push_back(std::move(one));
  }
  return list;
}

}  // namespace

struct TrustStudy::Subject {
  const LoadedProblem& loaded;
  std::vector<RunRecord*> runs;  // with a cost, of those that tables show or that are lowest
  RunRecord* lowest = nullptr;
  std::vector<DriveName> drives;
  std::shared_ptr<const RecordingCosts> each = nullptr;  // made when it is needed first
  std::optional<Refit> full = std::nullopt;
  int threads = 0;

  const RecordingCosts& costs() {
    if (!each) each = loaded.apart->get();
    return *each;
  }
};

TrustStudy::TrustStudy(const TrustChoice& choice, const SolverStudy& study, const Catalogue& catalogue,
                       const RunFolder& folder, Watcher& watcher, const Stop& stop)
    : choice_(choice),
      study_(study),
      catalogue_(catalogue),
      folder_(folder),
      watcher_(watcher),
      stop_(stop) {}

SolverStudy TrustStudy::with(SolverStudy study) {
  study.require = [this](const std::vector<LoadedProblem>& loaded) { require(loaded); };
  study.describe = describe_noise;
  study.judge = [this](const std::vector<LoadedProblem>& loaded, std::vector<RunRecord>& records) {
    return judge(loaded, records);
  };
  return study;
}

void TrustStudy::require(const std::vector<LoadedProblem>& loaded) const {
  const auto calibrates = [](const LoadedProblem& one) { return one.calibration != nullptr; };
  const bool any = std::any_of(loaded.begin(), loaded.end(), calibrates);
  if (!choice_.validation.automatic && choice_.validation.wanted() && !any)
    throw std::invalid_argument(
        fmt::format("--validate: the problem '{}' is no calibration", loaded.front().name()));
  for (const auto& [asked, option] : {std::pair(choice_.profile.wanted(), "--profile"),
                                      std::pair(!choice_.combinations.empty(), "--combination")})
    if (asked && !any)
      throw std::invalid_argument(
          fmt::format("{}: the problem '{}' is no calibration", option, loaded.front().name()));
  for (const LoadedProblem& one : loaded)
    if (one.calibration) require_names(one);
  if (choice_.bootstrap == 0) return;
  if (!any)
    throw std::invalid_argument(
        fmt::format("--bootstrap: the problem '{}' is no calibration", loaded.front().name()));
  for (const LoadedProblem& one : loaded) {
    if (!one.calibration) continue;
    const std::string why = why_no_bootstrap(drive_names(one.calibration->recordings()), choice_.scheme);
    if (!why.empty()) throw std::invalid_argument(fmt::format("--bootstrap={}: {}", choice_.bootstrap, why));
  }
}

// Refuses names and formulas that this calibration does not have.
void TrustStudy::require_names(const LoadedProblem& one) const {
  const std::vector<ParameterInfo>& parameters = one.problem.parameters();
  for (const std::string& name : choice_.profile.parameters) {
    const auto at = std::find_if(parameters.begin(), parameters.end(),
                                 [&](const ParameterInfo& p) { return p.name == name; });
    std::vector<std::string> free;
    for (const ParameterInfo& p : parameters)
      if (p.lower < p.upper) free.push_back(p.name);
    if (at == parameters.end() || !(at->lower < at->upper))
      throw std::invalid_argument(fmt::format("--profile: found '{}', expected one of {}, or all",
                                              shown(name), fmt::join(free, ", ")));
  }
  for (const Formula& formula : choice_.combinations) try {
      formula_at(formula, one.apart->robot(), parameters, nominal_of(parameters));
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("--combination={}", error.what()));
    }
}

bool TrustStudy::judge(const std::vector<LoadedProblem>& loaded, std::vector<RunRecord>& records) {
  if (!choice_.validation.wanted() && choice_.bootstrap == 0 && !choice_.profile.wanted() &&
      choice_.combinations.empty())
    return false;
  bool changed = false;
  const std::set<const RunRecord*> shown = shown_runs(records);
  try {
    for (const LoadedProblem& one : loaded) {
      if (!one.calibration) continue;
      Subject subject{one, {}, nullptr, drive_names(one.calibration->recordings())};
      subject.threads = study_.threads;
      for (RunRecord& r : records) {
        if (r.kind != "run" || !r.cost || !std::isfinite(*r.cost) || r.problem != one.name() ||
            r.dataset != one.dataset_name() || shown.count(&r) == 0)
          continue;
        subject.runs.push_back(&r);
        if (subject.lowest == nullptr || *r.cost < *subject.lowest->cost) subject.lowest = &r;
      }
      if (subject.lowest != nullptr) changed = judge(subject) || changed;
    }
  } catch (const Interruption&) {
    watcher_.count_ends();
    interrupted_ = true;
  }
  return changed;
}

bool TrustStudy::judge(Subject& subject) {
  bool changed = false;
  const std::vector<FoldPlan> asked = plans(subject);
  if (!asked.empty() && affordable(subject, asked)) {
    changed = choice_.validation.own_solvers ? validate_own(subject, asked) : validate_shared(subject, asked);
    warn_of(*subject.lowest);
  }
  if (!choice_.combinations.empty()) changed = combine(subject) || changed;
  if (choice_.profile.wanted()) changed = profile(subject) || changed;
  if (choice_.bootstrap > 0) changed = resample(subject) || changed;
  return changed;
}

// The plans that have folds; what the others lack is said.
std::vector<FoldPlan> TrustStudy::plans(const Subject& subject) const {
  const ValidationChoice& validation = choice_.validation;
  const auto say = [&](const std::string& text) {
    validation.automatic ? watcher_.note(text) : watcher_.warn(text);
  };
  std::vector<FoldPlan> all, usable;
  if (validation.repetitions) all.push_back(leave_one_repetition_out(subject.drives));
  if (validation.trajectories) all.push_back(leave_one_trajectory_out(subject.drives));
  try {
    if (validation.k_fold > 0)
      all.push_back(stratified_k_fold(subject.drives, validation.k_fold, study_.seed));
  } catch (const std::invalid_argument& error) {
    say(fmt::format("--validate={}", error.what()));
  }
  for (FoldPlan& plan : all) {
    if (plan.folds.empty()) {
      const bool said = std::any_of(all.begin(), all.end(), [&](const FoldPlan& other) {
        return &other < &plan && other.why_not == plan.why_not;
      });
      if (!said)
        say(fmt::format("not validated{}: {}",
                        subject.drives.size() < 2     ? ""
                        : plan.scheme == kRepetitions ? " on the same drives again"
                                                      : " on kinds of drives never seen",
                        plan.why_not));
      continue;
    }
    if (plan.never_left_out > 0)
      watcher_.note(
          fmt::format("{} of {} recordings are of kinds that were driven once: no repetition of "
                      "them can be left out",
                      plan.never_left_out, subject.drives.size()));
    usable.push_back(std::move(plan));
  }
  return usable;
}

bool TrustStudy::affordable(const Subject& subject, const std::vector<FoldPlan>& plans) const {
  if (!choice_.validation.automatic) return true;
  const CalibrationProblem& problem = *subject.loaded.calibration;
  std::size_t folds = 1;
  for (const FoldPlan& plan : plans) folds += plan.folds.size();
  const double samples = samples_of(problem);
  const double one_fit = kEvaluationsPerFit * seconds_of_evaluation(problem, samples) + kJudged_s * samples;
  const double seconds = static_cast<double>(folds) * one_fit;
  if (seconds < kAutomaticValidation_s) return true;
  watcher_.note(
      fmt::format("not validated: {} fits would take about {:.2g} s of one processor; "
                  "--validate=repetitions,trajectories "
                  "makes them",
                  folds, seconds));
  return false;
}

bool TrustStudy::validate_shared(Subject& subject, const std::vector<FoldPlan>& plans) {
  ValidationOptions options;
  options.solvers = &catalogue_.solvers();
  options.seed = study_.seed;
  options.threads = subject.threads;
  options.start = point_of(*subject.lowest);
  options.second_start = nominal_of(subject.loaded.problem.parameters());
  subject.costs();
  Validation validation = validate(subject.each, plans, options, watcher_, stop_);
  bool changed = false;
  for (RunRecord* run : subject.runs) {
    if (*run->cost > validation.full.cost * (1 + kSameOptimum)) continue;
    for (const SchemeFigures& scheme : validation.schemes) put_validation(scheme, *run);
    changed = true;
  }
  subject.full = std::move(validation.full);
  return changed;
}

bool TrustStudy::validate_own(Subject& subject, const std::vector<FoldPlan>& plans) {
  subject.costs();
  bool changed = false;
  std::set<std::string> done;
  std::vector<RunRecord*> runs = subject.runs;
  std::stable_sort(runs.begin(), runs.end(),
                   [](const RunRecord* a, const RunRecord* b) { return *a->cost < *b->cost; });
  for (RunRecord* run : runs) {  // the lowest of each row first
    const bool first = done.insert(run->label).second;
    if (!first) continue;
    ValidationOptions options;
    options.solver = {run->solver, {}};
    for (const auto& [name, value] : run->options) options.solver.options[name] = value;
    if (!run->polish.empty()) options.polish = parse_solver_list(run->polish).front();
    options.budget = study_.budget;
    options.solvers = &catalogue_.solvers();
    options.seed = derive_seed(run->seed, {"validation"});
    options.threads = subject.threads;
    options.start = nominal_of(subject.loaded.problem.parameters());
    const Validation validation = validate(subject.each, plans, options, watcher_, stop_);
    for (const SchemeFigures& scheme : validation.schemes) put_validation(scheme, *run);
    changed = true;
  }
  return changed;
}

const Refit& TrustStudy::full_fit(Subject& subject) {
  subject.costs();
  if (subject.full) return *subject.full;
  RefitOptions options;
  options.solvers = &catalogue_.solvers();
  options.start = point_of(*subject.lowest);
  subject.full = refit(subject.each, Vector::Ones(static_cast<Eigen::Index>(subject.each->size())), options,
                       derive_seed(study_.seed, {"full"}), stop_);
  return *subject.full;
}

bool TrustStudy::combine(Subject& subject) {
  bool changed = false;
  for (RunRecord* run : subject.runs) {
    try {
      describe_combinations(subject.loaded, choice_.combinations, *run);
      changed = true;
    } catch (const std::exception& error) {
      watcher_.warn(fmt::format("{}: --combination={}", run->label, error.what()));
    }
  }
  return changed;
}

bool TrustStudy::profile(Subject& subject) {
  const Vector& z = full_fit(subject).z;
  put_profiles(profile_figures(profiles(subject.loaded.calibration, subject.costs(), choice_.profile, z,
                                        subject.threads, watcher_, stop_)),
               *subject.lowest);
  return true;
}

bool TrustStudy::resample(Subject& subject) {
  RefitOptions options;
  options.solvers = &catalogue_.solvers();
  options.start = full_fit(subject).z;
  options.second_start = nominal_of(subject.loaded.problem.parameters());
  const BootstrapPlan plan{static_cast<std::size_t>(choice_.bootstrap), choice_.scheme, study_.seed,
                           subject.threads, options};
  std::unique_ptr<ReplicateFile> file;
  if (folder_.keeps()) {
    const Vector& start = options.start;
    file = std::make_unique<ReplicateFile>(
        folder_.path() / "bootstrap" / (vega::slug(subject.loaded.name()) + ".jsonl"),
        nlohmann::json{{"bootstrap", 1},
                       {"problem", subject.loaded.name()},
                       {"dataset_sha256", subject.loaded.dataset_sha256},
                       {"box", subject.lowest->box},
                       {"scheme", name_of(plan.scheme)},
                       {"seed", plan.seed},
                       {"solver", options.solver.text()},
                       {"kernel", subject.lowest->context.kernel},
                       {"version", subject.lowest->context.version},
                       {"start", std::vector<double>(start.data(), start.data() + start.size())}});
    if (!file->damage().empty())
      watcher_.warn(fmt::format("{}; replicates from there on are made again", file->damage()));
    if (file->size() > 0)
      watcher_.note(
          fmt::format("bootstrap: {} replicates of an earlier call with this seed are there", file->size()));
  }
  const std::vector<Replicate> replicates = bootstrap(subject.each, plan, file.get(), watcher_, stop_);
  if (file) file->finish();
  BootstrapFigures figures;
  figures.scheme = name_of(plan.scheme);
  for (const Replicate& r : replicates) {
    figures.costs.push_back(r.cost);
    figures.recordings.insert(figures.recordings.end(), r.resample.begin(), r.resample.end());
    figures.parameters.insert(figures.parameters.end(), r.z.data(), r.z.data() + r.z.size());
  }
  put_bootstrap(figures, *subject.lowest);
  return true;
}

void TrustStudy::warn_of(const RunRecord& record) const {
  if (const std::string text = validation_warning(record); !text.empty())
    watcher_.warn(fmt::format("{}: {}", record.label, text));
}

}  // namespace odobench
