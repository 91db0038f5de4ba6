#include "bench/studies/planning/next_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "bench/studies/planning/rival_models.hpp"
#include "bench/studies/planning/settling_plan.hpp"
#include "bench/studies/trust/model_fits.hpp"
#include "bench/studies/trust/models_study.hpp"
#include "solvers/solve.hpp"

namespace odobench {
namespace {

// Of the estimate: evaluations of J with derivatives per fit, seconds per sample and evaluation, and the
// prediction of drives and the noise of the recordings as so many evaluations.
constexpr double kEvaluationsPerFit = 30, kSample_s = 32e-9, kPlanAsEvaluations = 60;
constexpr double kWorthSaying = 0.1;  // of J
constexpr double kNearlyAsMuch = 0.9;
constexpr std::size_t kKept = 5;  // drives that decide, in the record

struct Guess {
  std::vector<std::string> names;
  std::string words;
  bool robot = true;
};

// What a calibration may lack, in words; what the robot has nothing for is sorted out later.
std::vector<Guess> guesses(const CalibrationProblem& problem, const Robot& robot) {
  std::vector<Guess> list;
  const bool mean = problem.options().model.twist.value_or(robot.table.rule) == TwistRule::Mean;
  const auto add = [&](std::vector<std::string> names, const char* words, bool of_robot = true) {
    if (mean && of_robot) names.insert(names.begin(), "least_squares");
    list.push_back({std::move(names), words, of_robot});
  };
  const bool steered = std::any_of(robot.table.wheels.begin(), robot.table.wheels.end(), is_steered);
  if (steered) {
    add({"contact_offset"}, "a contact offset");
    add({"steering_zeros:0.035"}, "zeros of the steering");
  }
  if (!problem.options().mount) {
    add({"lever_arm"}, "a tracked point elsewhere");
    add({"heading_offset"}, "a turned tracked frame");
  }
  if (const std::string kind = turning_kind(problem.recordings()); !kind.empty())
    list.push_back({{"speed_factor:" + kind}, "slip in turns on the spot", false});
  return list;
}

// The guess on top of the model that is there; nothing where the robot has nothing for it.
std::optional<ModelFits> with_guess(const CalibrationProblem& problem, const Robot& robot,
                                    const Guess& guess) {
  std::vector<std::string> names = problem.options().model.names();
  names.insert(names.end(), guess.names.begin(), guess.names.end());
  ModelFits fits;
  try {
    fits.terms = model_terms(names);
    CalibrationOptions options = problem.options();
    options.model = fits.terms;
    CalibrationProblem(robot, {problem.recordings().begin(), problem.recordings().end()}, options,
                       problem.kernel());
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
  fits.label = fits.terms.text();
  return fits;
}

bool near_bound(const ParameterInfo& p, double value) {
  const double width = p.upper - p.lower;
  return width > 0 && (value - p.lower < kOnBound * width || p.upper - value < kOnBound * width);
}

ExplanationRecord explanation_of(const ModelFits& fits, const Guess& guess, double cost) {
  ExplanationRecord e{fits.label, guess.words, fits.cost, 1 - fits.cost / cost, guess.robot, false,
                      "",         "",          0};
  for (std::size_t p = fits.own; p < fits.parameters.size(); ++p)
    e.on_bound = e.on_bound || near_bound(fits.parameters[p], fits.z[static_cast<Eigen::Index>(p)]);
  if (fits.parameters.size() == fits.own + 1) {
    e.parameter = fits.parameters.back().name;
    e.unit = fits.parameters.back().unit;
    e.value = fits.z[fits.z.size() - 1];
  }
  return e;
}

// J at the optimum in a box twice as wide about the nominal values, from z; lengths stay above a tenth of
// them.
double cost_in_twice_the_box(const CalibrationProblem& problem, const Robot& robot, const Vector& z) {
  Robot wide = robot;
  const auto widen = [](RobotParameter& p) {
    if (!(p.lower < p.upper)) return;
    p.upper = 2 * p.upper - p.nominal;
    const double lower = 2 * p.lower - p.nominal;
    p.lower = p.lower > 0 ? std::max(lower, 0.1 * p.lower) : lower;
  };
  for (RobotParameter& p : wide.parameters) widen(p);
  for (BoundParameter& p : wide.table.parameters) widen(p.parameter);
  const Problem twice(std::make_shared<const CalibrationProblem>(wide, problem.recordings(),
                                                                 problem.options(), problem.kernel()));
  SolveOptions options;
  options.budget.max_evaluations = 1000;
  const Result result = solve(twice, {"lm", {}}, z, options);
  return result.usable() ? result.cost : problem.cost(z);
}

class NextSteps {
 public:
  NextSteps(const LoadedProblem& loaded, int threads, const Stop& stop, RunRecord& record)
      : problem_(*loaded.calibration),
        robot_(loaded.dataset->robot),
        threads_(threads),
        stop_(stop),
        trust_(*record.trust) {
    own_.label = problem_.options().model.any() ? problem_.options().model.text() : "plain";
    own_.terms = problem_.options().model;
    own_.parameters = problem_.parameters();
    own_.own = own_.parameters.size();
    own_.z.resize(static_cast<Eigen::Index>(record.parameters.size()));
    for (std::size_t i = 0; i < record.parameters.size(); ++i) {
      own_.z[static_cast<Eigen::Index>(i)] = record.parameters[i].value;
      bounds_ = bounds_ || (!record.parameters[i].at_bound.empty() &&
                            record.parameters[i].lower < record.parameters[i].upper);
    }
    own_.cost = *record.cost;
    if (trust_.systematic)
      for (const Guess& guess : guesses(problem_, robot_))
        if (std::optional<ModelFits> fits = with_guess(problem_, robot_, guess)) {
          guesses_.push_back(guess);
          fits_.push_back(std::move(*fits));
        }
  }

  double seconds() const {
    double samples = 0;
    for (const Recording& r : problem_.recordings()) samples += static_cast<double>(r.size());
    const double fits = static_cast<double>(fits_.size()) + (bounds_ ? 1 : 0);
    return samples * kSample_s * (kEvaluationsPerFit * fits + kPlanAsEvaluations);
  }

  void find() {
    std::vector<double> twice(1, 0.0);
    parallel_for(
        fits_.size() + (bounds_ ? 1 : 0), threads_,
        [&](std::size_t i) {
          if (i < fits_.size())
            fit_model(problem_, robot_, {}, {}, stop_, fits_[i]);
          else
            twice[0] = cost_in_twice_the_box(problem_, robot_, own_.z);
        },
        stop_);
    if (bounds_) trust_.twice_box = std::min(twice[0], own_.cost);
    for (std::size_t i = 0; i < fits_.size(); ++i)
      trust_.explanations.push_back(explanation_of(fits_[i], guesses_[i], own_.cost));
    if (!decide()) settle(own_);
    std::stable_sort(trust_.explanations.begin(), trust_.explanations.end(),
                     [](const auto& a, const auto& b) { return a.explained > b.explained; });
  }

 private:
  // What explains most: of the robot, or the competitor.
  std::optional<std::size_t> best(bool robot) const {
    std::optional<std::size_t> found;
    for (std::size_t i = 0; i < fits_.size(); ++i) {
      const ExplanationRecord& e = trust_.explanations[i];
      if (e.robot != robot || e.on_bound || e.explained < kWorthSaying) continue;
      if (!found || e.explained > trust_.explanations[*found].explained) found = i;
    }
    return found;
  }

  bool decide() {
    const std::optional<std::size_t> model = best(true), other = best(false);
    if (!model && !other) return false;
    const std::size_t first = model ? *model : *other;
    const bool rival =
        model && other &&
        trust_.explanations[*other].explained > kNearlyAsMuch * trust_.explanations[*model].explained;
    const ModelFits& second = rival ? fits_[*other] : own_;
    const RivalPlan plan = plan_rivals(problem_, robot_, fits_[first], second, threads_, stop_);
    // Two models that recorded drives tell apart are decided: by J.
    const bool decided = std::any_of(plan.drives.begin(), plan.drives.end(),
                                     [](const RivalDrive& d) { return d.recorded && d.repetitions; });
    if (decided) {
      settle(fits_[first]);
      return true;
    }
    NextStepsRecord& next = trust_.next.emplace();
    if (!plan.refused.empty()) {
      next.skipped = plan.refused;
      return true;
    }
    next.first_words = guesses_[first].words;
    next.second_words = rival ? guesses_[*other].words : "the model as it is";
    for (std::size_t i = 0; i < std::min(kKept, plan.drives.size()); ++i) {
      const RivalDrive& d = plan.drives[i];
      const int n = d.repetitions.value_or(0);
      next.drives.push_back({"decide", fits_[first].label, second.label, d.name, d.description, d.recorded, n,
                             d.discrimination.separation(1),
                             probability_right(d.discrimination.separation(n > 0 ? n : 100)), d.seconds});
    }
    return true;
  }

  void settle(const ModelFits& fits) {
    const SettlingPlan plan = plan_settling(problem_, robot_, fits, threads_, stop_);
    if (plan.refused.empty() && plan.open.empty()) return;
    NextStepsRecord& next = trust_.next.emplace();
    next.skipped = plan.refused;
    next.open = plan.open;
    next.settled = plan.settled;
    next.largest_before = plan.largest_before;
    next.largest_after = plan.largest_after;
    for (const SettlingDrive& d : plan.drives)
      next.drives.push_back(
          {"settle", "", "", d.name, d.description, d.recorded, d.repetitions, 0, 0, d.seconds});
  }

  const CalibrationProblem& problem_;
  const Robot& robot_;
  int threads_;
  const Stop& stop_;
  TrustRecord& trust_;
  ModelFits own_;
  bool bounds_ = false;
  std::vector<Guess> guesses_;
  std::vector<ModelFits> fits_;
};

}  // namespace

void describe_next_steps(const LoadedProblem& loaded, const std::string& command, int threads,
                         const Stop& stop, RunRecord& record) {
  if (!loaded.calibration || !record.trust || !record.cost || !(*record.cost > 0)) return;
  const auto skip = [&](const std::string& why) { record.trust->next.emplace().skipped = why; };
  try {
    NextSteps steps(loaded, threads, stop, record);
    if (const double seconds = steps.seconds(); seconds > kNextSteps_s)
      return skip(
          fmt::format("about {:.2g} s of one processor; 'bench models {}' and 'bench plan {} "
                      "--between=plain,MODEL' make it",
                      seconds, command, command));
    steps.find();
  } catch (const DataError& error) {
    skip(error.what());
  } catch (const std::invalid_argument& error) {
    skip(error.what());
  }
}

}  // namespace odobench
