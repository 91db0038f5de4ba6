#include "bench/studies/calibration/solver_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "bench/studies/calibration/fit_remarks.hpp"
#include "bench/studies/calibration/rule_remark.hpp"
#include "bench/studies/calibration/wall_remark.hpp"
#include "bench/studies/cell_recorder.hpp"
#include "bench/studies/context.hpp"
#include "bench/studies/inspection/inspection_study.hpp"
#include "bench/studies/parameter_files.hpp"
#include "bench/studies/records.hpp"
#include "bench/studies/run_tracks.hpp"
#include "reports/records/record_key.hpp"

namespace odobench {
namespace {

CellPlan make_plan(const SolverStudy& study, const Catalogue& catalogue, std::vector<std::string>& notes) {
  CellPlan plan;
  plan.solvers = resolve_solvers(
      catalogue, study.solvers.empty() ? std::vector<std::string>{"lm,ip,ga,pso"} : study.solvers, notes);
  if (!study.polish.empty()) {
    std::vector<std::string> dropped;
    const std::vector<SolverSpec> polish = resolve_solvers(catalogue, {study.polish}, dropped);
    if (polish.size() != 1)
      throw std::invalid_argument(fmt::format("--polish={}: expected one solver", study.polish));
    plan.polish = polish.front();
  }
  plan.repeat = study.repeat;
  plan.base_seed = study.seed;
  plan.random_start = study.random_start;
  return plan;
}

std::vector<LoadedProblem> load_problems(const SolverStudy& study, const Catalogue& catalogue,
                                         InstructionSet kernel, std::vector<std::string>& notes) {
  const std::vector<std::string> names = resolve_problems(
      catalogue, study.problems.empty() ? std::vector<std::string>{"calibration"} : study.problems,
      study.dimension, notes);
  const auto takes_data = [&](const std::string& name) { return catalogue.problem(name).takes_data; };
  if (!study.data.empty() && std::none_of(names.begin(), names.end(), takes_data))
    throw std::invalid_argument(fmt::format("--data: the problem '{}' takes no data set", names.front()));
  std::vector<LoadedProblem> loaded;
  for (const std::string& name : names)
    loaded.push_back(catalogue.problem(name).make(
        {study.dimension, takes_data(name) ? study.data : "", study.calibration, kernel}));
  for (const LoadedProblem& one : loaded)
    for (const std::string& remark : one.remarks) notes.push_back(remark);
  const bool calibrates = std::any_of(loaded.begin(), loaded.end(),
                                      [](const LoadedProblem& one) { return one.calibration != nullptr; });
  if (study.classical.wanted && !calibrates)
    throw std::invalid_argument(
        fmt::format("--classical: the problem '{}' is no calibration", loaded.front().name()));
  return loaded;
}

// What is compared with the runs: the nominal parameters, and the classical methods that are asked for.
void add_evaluations(const SolverStudy& study, const LoadedProblem& loaded, const RunContext& context,
                     const std::vector<std::string>& findings, Watcher& watcher,
                     std::vector<RunRecord>& records) {
  records.push_back(evaluation_record(loaded, "nominal", loaded.problem.start(), context));
  records.back().notes = findings;
  for (RunRecord& record : classical_records(loaded, study.classical, context, nullptr, watcher))
    records.push_back(std::move(record));
}

// The cells of every problem, problem by problem. Remarks are the same for all.
CellList plan_all(CellPlan plan, const SolverStudy& study, const Catalogue& catalogue,
                  const std::vector<LoadedProblem>& loaded, std::vector<std::string>& notes) {
  CellList cells(catalogue);
  std::vector<std::string> repeated;
  for (std::size_t k = 0; k < loaded.size(); ++k) {
    plan.problem = loaded[k].name();
    plan.dataset = loaded[k].dataset_name();
    plan.start_name = study.nominal_start ? "" : loaded[k].start_name;
    plan.start = study.nominal_start ? Vector() : loaded[k].start;
    if (!study.start_method.empty()) {
      plan.start_name = study.start_method;
      plan.start = classical_start(loaded[k], study.start_method, study.classical, notes);
    }
    cells.add(plan, k, k == 0 ? notes : repeated);
  }
  return cells;
}

// Notes on the lowest run of each calibration, and what else describes it. Returns whether there is any.
bool add_remarks(const SolverStudy& study, const std::vector<LoadedProblem>& loaded,
                 std::vector<RunRecord>& records) {
  bool any = false;
  for (const LoadedProblem& one : loaded) {
    RunRecord* lowest = nullptr;
    const RunRecord* nominal = nullptr;
    for (RunRecord& r : records) {
      if (r.kind == "evaluation" && r.label == "nominal" && r.problem == one.name() &&
          r.dataset == one.dataset_name())
        nominal = &r;
      if (r.kind == "run" && r.cost && r.problem == one.name() && r.dataset == one.dataset_name() &&
          (lowest == nullptr || *r.cost < *lowest->cost))
        lowest = &r;
    }
    if (lowest == nullptr) continue;
    std::vector<std::string> remarks = {wall_remark(one, *lowest), rule_remark(one, *lowest)};
    if (nominal != nullptr)
      for (std::string& remark : fit_remarks(one, *lowest, *nominal)) remarks.push_back(std::move(remark));
    if (study.describe && one.calibration) {
      for (std::string& remark : study.describe(one, *lowest)) remarks.push_back(std::move(remark));
      any = true;
    }
    for (const std::string& remark : remarks) {
      // Of a run that an earlier call made, it may be there already.
      if (remark.empty() ||
          std::find(lowest->notes.begin(), lowest->notes.end(), remark) != lowest->notes.end())
        continue;
      lowest->notes.push_back(remark);
      any = true;
    }
  }
  return any;
}

// What an earlier call left in the folder.
struct Kept {
  std::vector<std::pair<std::size_t, RunRecord>> runs;  // by cell
  std::vector<std::size_t> missing;
};

std::string describe(const RunRecord& r) {
  return fmt::format("'{}' on {}, repetition {}, by {} (revision {}, kernel {})", r.label, r.problem,
                     r.repetition, r.context.version, r.context.git_revision, r.context.kernel);
}

// Throws std::invalid_argument on a run that this study would not make.
Kept find_kept(const SolverStudy& study, const std::vector<LoadedProblem>& loaded, const CellList& cells,
               const RunContext& context, std::vector<RunRecord> stored) {
  std::map<std::string, RunRecord> there;
  for (RunRecord& record : stored)
    if (!record.solver.empty() && record.termination != to_string(Termination::Interrupted))
      there.insert_or_assign(record_key(record), std::move(record));
  Kept kept;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const RunCell cell = cells[i];
    OptionValues options;
    cells.catalogue().solver(cell.solver.name).make(cell.solver.options, &options);
    const auto found = there.find(record_key(
        planned_record(loaded[cell.problem], cell, options, study.seed, study.budget, context, "")));
    if (found == there.end()) {
      kept.missing.push_back(i);
      continue;
    }
    kept.runs.emplace_back(i, std::move(found->second));
    there.erase(found);
  }
  if (!there.empty())
    throw std::invalid_argument(
        fmt::format("--resume: found {} run{} that this command does not make, such as {}; expected the "
                    "options, data and "
                    "program (now {}, revision {}, kernel {}) that began it, or more",
                    there.size(), there.size() == 1 ? "" : "s", describe(there.begin()->second),
                    context.version, context.git_revision, context.kernel));
  return kept;
}

Kept open_folder(const SolverStudy& study, const std::vector<LoadedProblem>& loaded, const CellList& cells,
                 const RunContext& context, RunFolder& folder, Watcher& watcher,
                 const std::vector<RunRecord>& evaluations) {
  if (!study.resume) {
    folder.open();
    for (const RunRecord& record : evaluations) folder.append(record);
    Kept none;
    none.missing.resize(cells.size());
    std::iota(none.missing.begin(), none.missing.end(), std::size_t{0});
    return none;
  }
  Kept kept = find_kept(study, loaded, cells, context, folder.stored(watcher));
  watcher.note(fmt::format("{} of {} runs are there already and are kept; {} to run", kept.runs.size(),
                           cells.size(), kept.missing.size()));
  std::vector<RunRecord> all = evaluations;
  for (const auto& [cell, record] : kept.runs) all.push_back(record);
  folder.resume(all);
  return kept;
}

// The records of all cells that ran, behind those that are there.
void run_all(const SolverStudy& study, const std::vector<LoadedProblem>& loaded, const CellList& cells,
             const RunContext& context, Kept kept, RunFolder& folder, Watcher& watcher, const Stop& stop,
             SolverRuns& runs) {
  const auto label = [&](std::size_t i) {
    const RunCell cell = cells[i];
    return loaded.size() == 1 ? cell.label() : loaded[cell.problem].name() + " " + cell.label();
  };
  const auto record = [&](const RunCell& cell, const Result& result, const std::string& time_utc) {
    return run_record(loaded[cell.problem], cell, study.seed, study.budget, result, context, time_utc);
  };
  std::vector<Problem> problems;
  for (const LoadedProblem& one : loaded) problems.push_back(one.problem);
  CellRecorder recorder(cells, record, folder, watcher);
  runs.kept = kept.runs.size();
  for (auto& [cell, kept_record] : kept.runs) recorder.keep(cell, std::move(kept_record));
  watcher.runs_begin(kept.missing.size(), label);
  run_cells(problems, cells, kept.missing, study.budget, context.threads, stop, recorder);
  watcher.runs_end();
  runs.interrupted = stop.requested();
  recorder.move_to(runs.records);
  bool remarked = !runs.interrupted && add_remarks(study, loaded, runs.records);
  if (!runs.interrupted && study.judge) remarked = study.judge(loaded, runs.records) || remarked;
  // Cells end in an order that depends on the threads; the finished file does not.
  if (remarked || !recorder.in_order()) folder.replace(runs.records);
  if (!folder.keeps()) return;
  std::vector<TrackSet> tracks;
  for (const LoadedProblem& one : loaded)
    if (one.calibration) tracks.push_back(run_tracks(one, runs.records));
  folder.save(tracks, parameter_files(loaded, runs.records));
}

}  // namespace

SolverRuns run_solvers(const SolverStudy& study, const Catalogue& catalogue, RunFolder& folder,
                       Watcher& watcher, const Stop& stop) {
  std::vector<std::string> notes;
  const CellPlan plan = make_plan(study, catalogue, notes);
  const InstructionSet kernel = kernel_in_force(study.kernel);
  const std::vector<LoadedProblem> loaded = load_problems(study, catalogue, kernel, notes);
  const CellList cells = plan_all(plan, study, catalogue, loaded, notes);
  const RunContext context = run_context(thread_count(study.threads), kernel);
  if (study.require) study.require(loaded);
  folder.require_free();
  for (const std::string& text : notes) watcher.note(text);
  const AcceptedKinds accepted = accepted_kinds(study.accept);
  std::vector<std::vector<std::string>> findings;
  for (const LoadedProblem& one : loaded) {
    findings.push_back(one.left_out);
    for (const std::string& sentence : one.left_out) watcher.warn(sentence);
    for (std::string& finding : say_findings(one, accepted, true, study.threads, watcher))
      findings.back().push_back(std::move(finding));
  }

  SolverRuns runs;
  runs.planned = cells.size();
  if (study.check_derivatives) {
    runs.derivatives = check_derivatives(loaded, study.seed, watcher, stop);
    if (!runs.derivatives->agrees) return runs;
  }
  for (std::size_t k = 0; k < loaded.size(); ++k)
    if (loaded[k].calibration) add_evaluations(study, loaded[k], context, findings[k], watcher, runs.records);
  watcher.results_begin();
  Kept kept = open_folder(study, loaded, cells, context, folder, watcher, runs.records);
  run_all(study, loaded, cells, context, std::move(kept), folder, watcher, stop, runs);
  return runs;
}

}  // namespace odobench
