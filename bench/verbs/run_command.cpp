#include "bench/verbs/run_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>

#include "base/files.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/catalogue/problem_factory.hpp"
#include "bench/console/interrupt.hpp"
#include "bench/console/progress.hpp"
#include "bench/console/table_output.hpp"
#include "bench/studies/cells.hpp"
#include "bench/studies/context.hpp"
#include "bench/studies/derivative_table.hpp"
#include "bench/studies/records.hpp"
#include "bench/studies/run_tracks.hpp"
#include "reports/kinds/calibration/calibration_tables.hpp"

namespace odobench {
namespace {

// Turns finished runs into records, on disc at once and in memory in the order of the cells.
class Recorder final : public CellWatcher {
 public:
  Recorder(const std::vector<LoadedProblem>& loaded, const CellList& cells, std::uint64_t base_seed,
           const Budget& budget, const RunContext& context, RecordFile* file, ProgressLine& progress)
      : loaded_(loaded),
        cells_(cells),
        base_seed_(base_seed),
        budget_(budget),
        context_(context),
        file_(file),
        progress_(progress),
        records_(cells.size()) {}

  void started(std::size_t cell) override { progress_.started(cell); }
  void progressed(std::size_t cell, const Progress& progress) override {
    progress_.progressed(cell, progress);
  }
  void finished(std::size_t cell, const Result& result, const std::string& time_utc) override {
    const RunCell what = cells_[cell];
    auto record = std::make_unique<RunRecord>(
        run_record(loaded_[what.problem], what, base_seed_, budget_, result, context_, time_utc));
    {
      const std::lock_guard lock(mutex_);
      if (file_ != nullptr) file_->append(*record);
      in_order_ = in_order_ && cell == finished_;
      ++finished_;
      records_[cell] = std::move(record);
    }
    progress_.finished(cell);
  }

  // Of the cells that ran, in their order, moved behind `list`.
  void move_to(std::vector<RunRecord>& list) {
    list.reserve(list.size() + finished_);
    for (std::unique_ptr<RunRecord>& record : records_) {
      if (record) list.push_back(std::move(*record));
      record.reset();
    }
  }
  bool in_order() const { return in_order_; }

 private:
  const std::vector<LoadedProblem>& loaded_;
  const CellList& cells_;
  const std::uint64_t base_seed_;
  const Budget& budget_;
  const RunContext& context_;
  RecordFile* file_;
  ProgressLine& progress_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<RunRecord>> records_;
  std::size_t finished_ = 0;
  bool in_order_ = true;
};

bool any_result(const std::vector<RunRecord>& records) {
  return std::any_of(records.begin(), records.end(),
                     [](const RunRecord& r) { return r.kind == "run" && r.cost; });
}

CellPlan make_plan(const RunOptions& options, std::vector<std::string>& notes) {
  CellPlan plan;
  plan.solvers = resolve_solvers(
      options.solvers.empty() ? std::vector<std::string>{"lm,ip,ga,pso"} : options.solvers, notes);
  if (!options.polish.empty()) {
    std::vector<std::string> dropped;
    const std::vector<SolverSpec> polish = resolve_solvers({options.polish}, dropped);
    if (polish.size() != 1)
      throw std::invalid_argument(fmt::format("--polish={}: expected one solver", options.polish));
    plan.polish = polish.front();
  }
  plan.repeat = options.repeat;
  plan.base_seed = options.seed;
  plan.random_start = options.start == "random";
  return plan;
}

std::vector<LoadedProblem> load_problems(const RunOptions& options, InstructionSet kernel,
                                         std::vector<std::string>& notes) {
  const std::vector<std::string> names =
      resolve_problems(options.problems.empty() ? std::vector<std::string>{"calibration"} : options.problems,
                       options.dimension, notes);
  if (!options.data.empty() && std::find(names.begin(), names.end(), "calibration") == names.end())
    throw std::invalid_argument(fmt::format("--data: the problem '{}' takes no data set", names.front()));
  std::vector<LoadedProblem> loaded;
  for (const std::string& name : names)
    loaded.push_back(
        make_problem(name, options.dimension, name == "calibration" ? options.data : "", kernel));
  return loaded;
}

// The cells of every problem, problem by problem. Remarks are the same for all.
CellList plan_all(CellPlan plan, const std::vector<LoadedProblem>& loaded, std::vector<std::string>& notes) {
  CellList cells;
  std::vector<std::string> repeated;
  for (std::size_t k = 0; k < loaded.size(); ++k) {
    plan.problem = loaded[k].name();
    plan.dataset = loaded[k].dataset_name();
    cells.add(plan, k, k == 0 ? notes : repeated);
  }
  return cells;
}

ExitCode outcome(const RunOptions& options, const std::vector<RunRecord>& records, std::size_t cells,
                 bool interrupted) {
  std::size_t runs = 0, stopped = 0;
  for (const RunRecord& r : records) {
    if (r.kind == "evaluation") continue;
    ++runs;
    if (r.termination == to_string(Termination::Interrupted)) ++stopped;
  }
  if (interrupted && (stopped > 0 || runs < cells)) {
    note(fmt::format("interrupted: {} of {} runs complete, {} stopped early, {} not started{}",
                     runs - stopped, cells, stopped, cells - runs,
                     options.out.empty() ? "" : "; records are in " + options.out));
    return ExitCode::Interrupted;
  }
  if (!any_result(records)) {
    warn("not one solver gave a result");
    return ExitCode::CheckFailed;
  }
  return ExitCode::Success;
}

}  // namespace

ExitCode run_command(const RunOptions& options) {
  const Format format = parse_format(options.format);
  std::vector<std::string> notes;
  CellPlan plan = make_plan(options, notes);
  const InstructionSet kernel = kernel_in_force(options.kernel);
  const std::vector<LoadedProblem> loaded = load_problems(options, kernel, notes);
  const CellList cells = plan_all(plan, loaded, notes);

  const int threads = thread_count(options.threads);
  const RunContext context = run_context(threads, kernel);
  if (!options.out.empty()) require_no_records(options.out, options.overwrite);
  if (!options.quiet)
    for (const std::string& text : notes) note(text);

  std::vector<Table> tables;
  if (options.check_derivatives) {
    const DerivativeTable checked = check_derivatives(loaded, options.seed, options.quiet);
    if (!checked.agrees) {
      print_tables({checked.table}, format);
      warn("derivatives disagree with differences; nothing was run");
      return ExitCode::CheckFailed;
    }
    tables.push_back(checked.table);
  }

  std::vector<RunRecord> records;
  for (const LoadedProblem& one : loaded)
    if (one.calibration) records.push_back(evaluation_record(one, "nominal", one.problem.start(), context));
  InterruptGuard::remember();
  std::unique_ptr<RecordFile> file;
  if (!options.out.empty()) {
    file = std::make_unique<RecordFile>(options.out, options.overwrite);
    for (const RunRecord& r : records) file->append(r);
  }

  ProgressLine progress(!options.quiet, cells.size(), [&](std::size_t i) {
    const RunCell cell = cells[i];
    return loaded.size() == 1 ? cell.label() : loaded[cell.problem].name() + " " + cell.label();
  });
  Recorder recorder(loaded, cells, plan.base_seed, options.budget, context, file.get(), progress);
  std::vector<Problem> problems;
  for (const LoadedProblem& one : loaded) problems.push_back(one.problem);
  run_cells(problems, cells, options.budget, threads, InterruptGuard::flag(), recorder);
  progress.clear();
  const bool interrupted = InterruptGuard::flag().load();
  recorder.move_to(records);

  for (Table& table : comparison_tables(records, notes_of_best(records))) tables.push_back(std::move(table));
  if (file) {
    for (const LoadedProblem& one : loaded) save_run_tracks(one, records, options.out);
    // Cells end in an order that depends on the threads; the finished file does not.
    if (!recorder.in_order()) file->replace(records);
    save_tables(tables, options.out);
  }
  print_tables(tables, format);
  return outcome(options, records, cells.size(), interrupted);
}

}  // namespace odobench
