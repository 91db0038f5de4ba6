#include "bench/studies/records.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "base/sha256.hpp"
#include "base/text.hpp"
#include "bench/studies/context.hpp"
#include "bench/studies/trust_figures.hpp"
#include "problems/calibration/drive_errors.hpp"
#include "problems/classic/classic_problems.hpp"
#include "problems/information/identifiability.hpp"
#include "problems/trust/weighted_down.hpp"
#include "reports/kinds/calibration/drive_tables.hpp"
#include "reports/kinds/calibration/fit_table.hpp"
#include "reports/kinds/trust/loss_tables.hpp"
#include "reports/records/record_store.hpp"

namespace odobench {
namespace {

// Parameters this close to a bound, in units of the width of their box, count as on it: methods that step
// over bounds land on them, others only come near.
constexpr double kAtBound = 1e-6;

std::vector<ParameterValue> parameter_values(const std::vector<ParameterInfo>& parameters, const Vector& x) {
  std::vector<ParameterValue> values;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const ParameterInfo& p = parameters[i];
    const double value = x[static_cast<Eigen::Index>(i)];
    const double near = kAtBound * (p.upper - p.lower);
    const char* at = p.lower == p.upper        ? ""
                     : value <= p.lower + near ? "lower"
                     : value >= p.upper - near ? "upper"
                                               : "";
    values.push_back({p.name, p.unit, value, p.nominal, p.lower, p.upper, at});
  }
  return values;
}

std::vector<PoseTrack> tracks_of(const CalibrationProblem& problem, const Vector& z) {
  std::vector<PoseTrack> tracks;
  for (std::size_t i = 0; i < problem.recordings().size(); ++i) tracks.push_back(problem.integrate(i, z));
  return tracks;
}

// Figures of each drive: how well it fits, and more for robots other than the thesis', whose tables know x
// and y apart.
void describe_drives(const LoadedProblem& loaded, const std::vector<PoseTrack>& tracks, RunRecord& record) {
  const CalibrationProblem& problem = *loaded.calibration;
  Vector nominal(static_cast<Eigen::Index>(problem.parameters().size()));
  for (std::size_t i = 0; i < problem.parameters().size(); ++i)
    nominal[static_cast<Eigen::Index>(i)] = problem.parameters()[i].nominal;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const DriveErrors e = drive_errors(problem.recordings()[i], tracks[i]);
    const double fit[] = {e.rms_position, e.rms_heading, e.max_position, static_cast<double>(e.samples)};
    for (std::size_t k = 0; k < kFitSeries.size(); ++k) record.series[kFitSeries[k]].push_back(fit[k]);
    if (problem.structured()) continue;
    const double figures[] = {e.max_position,
                              e.max_heading,
                              e.end_position,
                              e.end_heading,
                              e.end[0],
                              e.end[1],
                              static_cast<double>(sense_of(problem.integrate(i, nominal)))};
    for (std::size_t k = 0; k < kDriveSeries.size(); ++k)
      record.series[kDriveSeries[k]].push_back(figures[k]);
  }
}

void describe_tracks(const LoadedProblem& loaded, const std::vector<PoseTrack>& tracks, RunRecord& record) {
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const MaxErrors e = max_errors(loaded.calibration->recordings()[i], tracks[i]);
    record.errors.push_back({e.recording, e.trajectory, e.repetition, {e.x, e.y, e.theta}});
  }
  describe_drives(loaded, tracks, record);
}

// The loss with its scales, and what it counts for less.
void describe_loss(const LoadedProblem& loaded, const Vector& z, RunRecord& record) {
  const Loss& loss = loaded.calibration->options().loss;
  if (!loss.robust()) return;
  if (loss.scope == LossScope::Recording) {
    record.measures.put({"loss.recording_scale", loss.position_scale, ""});
  } else {
    record.measures.put({"loss.position_scale", loss.position_scale, "m"});
    record.measures.put({"loss.heading_scale", loss.heading_scale, "rad"});
  }
  record.measures.put({"loss.tuning", loss.tuning, ""});
  for (const char* series : kWeightedDownSeries) record.series[series];
  for (const WeightedDown& one : weighted_down(loaded.dataset->robot, *loaded.calibration, z)) {
    const auto sample = [](const std::optional<std::size_t>& k) {
      return k ? static_cast<double>(*k) : std::numeric_limits<double>::quiet_NaN();
    };
    const double values[] = {static_cast<double>(one.recording), one.ratio, one.weight, sample(one.first),
                             sample(one.last)};
    for (std::size_t k = 0; k < kWeightedDownSeries.size(); ++k)
      record.series[kWeightedDownSeries[k]].push_back(values[k]);
    if (one.outlier && !one.first)
      record.notes.push_back(
          fmt::format("{}: its errors are {:.3g} times those of the usual drive; the loss "
                      "counts them for {:.2g} of their squares",
                      record.errors[one.recording].recording, one.ratio, one.weight));
  }
}

// Errors on the recordings that were left out.
void describe_set_aside(const LoadedProblem& loaded, const Vector& z, RunRecord& record) {
  if (!loaded.aside) return;
  const std::vector<MaxErrors> errors = loaded.aside->max_errors(z);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const MaxErrors& e = errors[i];
    const auto put = [&](const char* what, double value, const char* unit) {
      record.measures.put({set_aside_measure(e.recording, what), value, unit, Better::None, e.recording});
    };
    put("z", loaded.set_aside[i].z, "");
    put("x", e.x, "m");
    put("y", e.y, "m");
    put("heading", e.theta, "rad");
  }
}

void describe_point(const LoadedProblem& loaded, const Vector& x, RunRecord& record) {
  record.parameters = parameter_values(loaded.problem.parameters(), x);
  if (!loaded.calibration) return;
  describe_tracks(loaded, tracks_of(*loaded.calibration, x), record);
  describe_loss(loaded, x, record);
  describe_set_aside(loaded, x, record);
}

std::map<std::string, double> budget_figures(const Budget& budget) {
  std::map<std::string, double> figures{{"max_evaluations", static_cast<double>(budget.max_evaluations)},
                                        {"max_seconds", budget.max_seconds}};
  if (std::isfinite(budget.target_cost)) figures["target"] = budget.target_cost;
  return figures;
}

// Every optimum that a method of many starts has seen: series optima.cost, optima.runs and optima.parameters
// (row by row), and a note.
void describe_optima(const std::vector<LocalOptimum>& optima, RunRecord& record) {
  if (optima.empty()) return;
  constexpr std::size_t kNamed = 10;
  int runs = 0;
  for (const LocalOptimum& o : optima) runs += o.runs;
  std::string list;
  for (std::size_t k = 0; k < optima.size(); ++k) {
    const LocalOptimum& o = optima[k];
    record.series["optima.cost"].push_back(o.cost);
    record.series["optima.runs"].push_back(o.runs);
    for (const double value : o.x) record.series["optima.parameters"].push_back(value);
    if (k < kNamed)
      list += fmt::format("{}{:.10g} ({} of {} searches, {:.0f} %)", list.empty() ? "" : ", ", o.cost, o.runs,
                          runs, 100.0 * o.runs / runs);
  }
  if (optima.size() > kNamed) list += fmt::format(" and {} more", optima.size() - kNamed);
  record.notes.push_back(fmt::format(
      "{}: distinct optima by J and the share of the searches that ended there: {}.", record.label, list));
}

// Where the best cost is known: how near the result came, and a second opinion on its optimality.
std::optional<KnownAnswer> known_answer(const Problem& problem, const Result& result) {
  if (!problem.known_optimum() || !result.usable()) return std::nullopt;
  KnownAnswer known;
  known.cost = *problem.known_optimum();
  if (!problem.known_minimisers().empty())
    known.digits = log_relative_error(result.x, problem.known_minimisers());
  known.solved = reaches_known_optimum(problem, result.x, result.cost);
  if (result.termination == Termination::Converged) known.promise = promise_by_differences(problem, result.x);
  return known;
}

RunRecord empty_record(const std::string& problem, const std::string& dataset,
                       const std::vector<ParameterInfo>& parameters, const RunContext& context,
                       const std::string& time_utc) {
  RunRecord record;
  record.problem = problem;
  record.box = box_check_sum(parameters);
  record.dataset = dataset;
  record.context = context;
  record.time_utc = time_utc;
  return record;
}

RunRecord empty_record(const LoadedProblem& loaded, const RunContext& context, const std::string& time_utc) {
  RunRecord record =
      empty_record(loaded.name(), loaded.dataset_name(), loaded.problem.parameters(), context, time_utc);
  record.dataset_sha256 = loaded.dataset_sha256;
  return record;
}

}  // namespace

RunRecord planned_record(const LoadedProblem& loaded, const RunCell& cell, const OptionValues& options,
                         std::uint64_t base_seed, const Budget& budget, const RunContext& context,
                         const std::string& time_utc) {
  RunRecord record = empty_record(loaded, context, time_utc);
  record.label = cell.label();
  record.solver = cell.solver.name;
  record.options = options;
  record.polish = cell.polish.name.empty() ? "" : cell.polish.text();
  record.seed = cell.seed;
  record.base_seed = base_seed;
  record.repetition = cell.repetition;
  record.start = cell.random_start ? "random" : cell.start_name.empty() ? "nominal" : cell.start_name;
  record.random = cell.draws_random_numbers;
  record.budget = budget_figures(budget);
  return record;
}

RunRecord run_record(const LoadedProblem& loaded, const RunCell& cell, std::uint64_t base_seed,
                     const Budget& budget, const Result& result, const RunContext& context,
                     const std::string& time_utc) {
  RunRecord record = planned_record(loaded, cell, result.options, base_seed, budget, context, time_utc);
  record.kind = result.termination == Termination::NotApplicable ? "skipped" : "run";
  record.termination = to_string(result.termination);
  record.message = result.message;
  if (result.check)
    record.check = {result.check->test, result.check->value, result.check->limit, result.check->evaluations};
  record.known = known_answer(loaded.problem, result);
  if (result.usable()) {
    record.cost = result.cost;
    describe_point(loaded, result.x, record);
    if (loaded.calibration) {
      const std::string what = fmt::format("{}, at the result of {}", record.dataset, record.label);
      const Identifiability id = identifiability(loaded.problem, result.x);
      if (!id.parameters.empty()) record.series.merge(identifiability_series(id));
      const std::string note = identifiability_note(loaded.problem, id, what);
      if (!note.empty()) record.notes.push_back(note);
      describe_trust(loaded, result.x, record);
    }
  }
  describe_optima(result.optima, record);
  record.cost_before_polish = result.cost_before_polish;
  record.evaluations = result.counts.total();
  record.cost_evaluations = result.counts.cost;
  record.derivative_evaluations = result.counts.total() - result.counts.cost;
  record.non_finite = result.non_finite;
  record.iterations = result.iterations;
  record.seconds = result.seconds;
  for (const TraceEntry& t : result.trace) record.trace.push_back({t.evaluations, t.seconds, t.cost});
  return record;
}

std::vector<std::string> notes_of_best(const std::vector<RunRecord>& records) {
  std::map<std::pair<std::string, std::string>, const RunRecord*> best;
  for (const RunRecord& r : records) {
    if (r.kind != "run" || !r.cost) continue;
    const RunRecord*& lowest = best[{r.problem, r.dataset}];
    if (lowest == nullptr || *r.cost < *lowest->cost) lowest = &r;
  }
  std::vector<std::string> notes;
  for (const RunRecord& r : records)  // what was found in the recordings
    if (r.kind == "evaluation" && r.label == "nominal" && best.contains({r.problem, r.dataset}))
      notes.insert(notes.end(), r.notes.begin(), r.notes.end());
  for (const auto& [group, record] : best)
    notes.insert(notes.end(), record->notes.begin(), record->notes.end());
  return notes;
}

RunRecord evaluation_record(const LoadedProblem& loaded, const std::string& label, const Vector& parameters,
                            const RunContext& context) {
  RunRecord record = empty_record(loaded, context, utc_now());
  record.label = label;
  record.kind = "evaluation";
  record.termination = "evaluated";
  record.message = "cost and errors of given parameters";
  const Problem own = loaded.problem;
  record.cost = own.cost(parameters);
  record.evaluations = record.cost_evaluations = own.counts().total();
  describe_point(loaded, parameters, record);
  return record;
}

RunRecord tracks_record(const LoadedProblem& loaded, const std::string& label,
                        const std::vector<PoseTrack>& tracks, const RunContext& context) {
  RunRecord record = empty_record(loaded, context, utc_now());
  record.label = label;
  record.kind = "evaluation";
  record.termination = "evaluated";
  record.cost = cost_of_tracks(*loaded.calibration, tracks);
  describe_tracks(loaded, tracks, record);
  return record;
}

RunRecord skipped_record(const LoadedProblem& loaded, const std::string& label, const std::string& reason,
                         const RunContext& context) {
  RunRecord record = empty_record(loaded, context, utc_now());
  record.label = label;
  record.kind = "skipped";
  record.termination = to_string(Termination::NotApplicable);
  record.message = reason;
  return record;
}

RunRecord study_record(const std::string& problem, const std::string& dataset, const std::string& label,
                       const std::vector<ParameterInfo>& parameters, const Vector& values,
                       const RunContext& context) {
  RunRecord record = empty_record(problem, dataset, parameters, context, utc_now());
  record.label = label;
  record.kind = "evaluation";
  record.termination = "evaluated";
  record.parameters = parameter_values(parameters, values);
  return record;
}

std::vector<const RunRecord*> best_of_rows(const std::vector<RunRecord>& records) {
  std::vector<const RunRecord*> best;
  for (const RunRecord& record : records) {
    if (record.parameters.empty() || !record.cost || !std::isfinite(*record.cost)) continue;
    const auto same = [&](const RunRecord* other) {
      return other->label == record.label && other->dataset == record.dataset &&
             other->problem == record.problem;
    };
    const auto at = std::find_if(best.begin(), best.end(), same);
    if (at == best.end())
      best.push_back(&record);
    else if (*record.cost < *(*at)->cost)
      *at = &record;
  }
  return best;
}

std::vector<RunRecord> read_all_records(const std::vector<std::string>& runs, Watcher& watcher) {
  std::vector<RunRecord> records;
  std::set<std::string> seen;  // check sums: two runs never agree in every digit of their times
  std::size_t repeated = 0;
  for (const std::string& run : runs) {
    std::filesystem::path path = run;
    if (std::filesystem::is_directory(path)) path /= "runs.jsonl";
    if (!std::filesystem::exists(path))
      throw DataError(fmt::format("{}: there is no such file", path.string()));
    for (RunRecord& r : is_record_store(path) ? read_store(path) : read_records(path.string())) {
      if (seen.insert(sha256(to_json_line(r))).second)
        records.push_back(std::move(r));
      else
        ++repeated;
    }
  }
  if (repeated > 0)
    watcher.note(
        fmt::format("{} record{} read twice and counted once", repeated, repeated == 1 ? " was" : "s were"));
  if (records.empty())
    throw DataError(fmt::format("{}: found no run record, expected at least one",
                                shown(fmt::format("{}", fmt::join(runs, ", ")))));
  return records;
}

}  // namespace odobench
