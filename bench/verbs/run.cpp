#include "bench/verbs/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>

#include "base/files.hpp"
#include "bench/catalogue/number_text.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/catalogue/problem_factory.hpp"
#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "bench/console/terminal_watcher.hpp"
#include "bench/studies/cell_recorder.hpp"
#include "bench/studies/cells.hpp"
#include "bench/studies/context.hpp"
#include "bench/studies/derivative_table.hpp"
#include "bench/studies/records.hpp"
#include "bench/studies/run_tracks.hpp"
#include "bench/verbs/common_options.hpp"
#include "reports/kinds/calibration/calibration_tables.hpp"

namespace odobench {
namespace {

constexpr const char* kRunExamples = R"(Examples:
  bench --solver=lm --data=set.json
  bench --solver=pso,cmaes --repeat=20 --seed=7 --max-evals=30000 --out=results --format=md
  bench --solver=lm,ip --start=random --repeat=20
  bench --config=experiment.json --threads=1
A configuration file holds these options without dashes: {"solver": ["lm", "pso[swarm=60]"], "repeat": 10}
Every method also ends by itself; 'bench list solvers' shows its options.)";

struct RunOptions {
  std::vector<std::string> solvers;   // each a comma list as typed; empty: lm,ip,ga,pso
  std::string data;                   // path of set.json; empty: the demo set
  std::vector<std::string> problems;  // each a comma list of names and patterns; empty: calibration
  int dimension = 0;                  // of classic problems; 0: their usual ones
  bool check_derivatives = false;
  int repeat = 1;
  std::uint64_t seed = 1;
  int threads = 0;                       // 0: one per core
  std::optional<InstructionSet> kernel;  // none: kernel_in_force() knows
  Budget budget{kDefaultMaxEvaluations};
  std::string start = "nominal";
  std::string polish;  // solver, as typed; empty: none
  std::string out;     // folder for records and tables; empty: none
  bool overwrite = false;
  std::string format = "console";
  bool quiet = false;
  std::string config;  // file with options that the command line does not give
};

void add_options(CLI::App& app, RunOptions& options) {
  app.add_option(
         "--solver", options.solvers,
         "solvers, e.g. lm,pso[swarm=60,inertia=0.7]; 'all' for every one; may be given again [lm,ip,ga,pso]")
      ->type_name("LIST")
      ->allow_extra_args(false);
  app.add_option("--data", options.data, "data set of the calibration problem [the demo set]")
      ->type_name("SET.JSON");
  app.add_option(
         "--problem", options.problems,
         "problems and patterns of names, e.g. rosenbrock,nist:*,mgh:*/10; may be given again [calibration]")
      ->type_name("LIST")
      ->allow_extra_args(false);
  add_value(app, "--dimension", "N", "dimension of classic problems", [&options](const std::string& text) {
    options.dimension = static_cast<int>(whole_number("--dimension", text, 1, 1000));
  });
  add_count(app, "--repeat", options.repeat, 1, 100000,
            "runs of every solver, each with a seed of its own [1]");
  add_seed(app, options.seed, "base of all seeds [1]");
  add_threads(app, options.threads);
  add_kernel(app, options.kernel, kLastBits);
  add_budget(app, options.budget);
  add_value(app, "--start", "nominal|random",
            "where runs begin; random starts are shared by all solvers [nominal]",
            [&options](const std::string& text) {
              if (text != "nominal" && text != "random")
                throw std::invalid_argument(fmt::format("--start={}: expected nominal or random", text));
              options.start = text;
            });
  app.add_flag("--check-derivatives", options.check_derivatives,
               "before the run, compare Jacobian and gradient with differences at the start and at three "
               "random points; exit "
               "code 1 where they disagree");
  app.add_option("--polish", options.polish,
                 "solver that goes on from the best point of each run, within its budget")
      ->type_name("SOLVER");
  add_run_folder(app, options.out, options.overwrite);
  app.add_option("--format", options.format, "of the tables on standard output [console]")
      ->type_name("console|md|csv|json|latex");
  app.add_option("--config", options.config, "options from a JSON or INI/TOML file; the command line wins")
      ->type_name("FILE");
  app.add_flag("--quiet", options.quiet,
               "no progress and no remarks on standard error, only warnings and errors");
  app.footer(kRunExamples);
}

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

  TerminalWatcher watcher(options.quiet);
  const auto label = [&](std::size_t i) {
    const RunCell cell = cells[i];
    return loaded.size() == 1 ? cell.label() : loaded[cell.problem].name() + " " + cell.label();
  };
  CellRecorder recorder(
      cells,
      [&](const RunCell& cell, const Result& result, const std::string& time_utc) {
        return run_record(loaded[cell.problem], cell, plan.base_seed, options.budget, result, context,
                          time_utc);
      },
      file.get(), watcher);
  std::vector<Problem> problems;
  for (const LoadedProblem& one : loaded) problems.push_back(one.problem);
  watcher.runs_begin(cells.size(), label);
  run_cells(problems, cells, options.budget, threads, InterruptGuard::flag(), recorder);
  watcher.runs_end();
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

}  // namespace

VerbAction add_run(CLI::App& app) {
  const auto options = std::make_shared<RunOptions>();
  add_options(app, *options);
  return [&app, options] {
    if (!options->config.empty()) apply_config(app, options->config);
    return run_command(*options);
  };
}

}  // namespace odobench
