#include "bench/verbs/verbs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "bench/catalogue/number_text.hpp"
#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "bench/console/terminal_watcher.hpp"
#include "bench/options/common_options.hpp"
#include "bench/options/table_options.hpp"
#include "bench/options/trust_options.hpp"
#include "bench/studies/calibration/solver_study.hpp"
#include "bench/studies/records.hpp"
#include "bench/studies/trust/trust_study.hpp"
#include "reports/kinds/calibration/calibration_tables.hpp"

namespace odobench {
namespace {

constexpr const char* kRunExamples = R"(Examples:
  bench --solver=lm --data=set.json
  bench --solver=pso,cmaes --repeat=20 --seed=7 --max-evals=30000 --out=results --format=md
  bench --solver=lm,ip --start=random --repeat=20
  bench --solver=lm --data=diff.json --cost=segments --classical --start=censi
  bench --solver=lm --data=set.json --validate=kfold:5 --bootstrap=500 --out=results
  bench --solver=lm --data=set.json --profile=r1,b3 --combination="left wheels=(r1+r2)/2"
  bench --config=experiment.json --threads=1
A configuration file holds these options without dashes: {"solver": ["lm", "pso[swarm=60]"], "repeat": 10}
Every method also ends by itself; 'bench list solvers' shows its options.)";

struct RunOptions {
  SolverStudy study;
  TrustChoice trust;
  std::string out;  // folder for records and tables; empty: none
  bool overwrite = false;
  std::string format = "console";
  std::vector<std::string> tables;
  bool quiet = false;
  std::string config;  // file with options that the command line does not give
};

// --start.
void add_start(CLI::App& app, SolverStudy& study) {
  add_value(app, "--start", "nominal|random|METHOD",
            "where runs begin; random starts are shared by all solvers; the result of a classical method of "
            "the robot, e.g. censi [nominal; with a loss the least-squares solution]",
            [&study](const std::string& text) {
              require_start(text);
              study.random_start = text == "random";
              study.nominal_start = text == "nominal";
              study.start_method = text == "nominal" || text == "random" ? "" : text;
            });
}

void add_options(CLI::App& app, RunOptions& options) {
  app.add_option(
         "--solver", options.study.solvers,
         "solvers, e.g. lm,pso[swarm=60,inertia=0.7]; 'all' for every one; may be given again [lm,ip,ga,pso]")
      ->type_name("LIST")
      ->allow_extra_args(false);
  app.add_option("--data", options.study.data, "data set of the calibration problem [the demo set]")
      ->type_name("SET.JSON");
  app.add_option(
         "--problem", options.study.problems,
         "problems and patterns of names, e.g. rosenbrock,nist:*,mgh:*/10; may be given again [calibration]")
      ->type_name("LIST")
      ->allow_extra_args(false);
  add_calibration(app, options.study.calibration);
  add_screen(app, options.study.calibration.screen);
  add_value(app, "--dimension", "N", "dimension of classic problems", [&options](const std::string& text) {
    options.study.dimension = static_cast<int>(whole_number("--dimension", text, 1, 1000));
  });
  add_count(app, "--repeat", options.study.repeat, 1, 100000,
            "runs of every solver, each with a seed of its own [1]");
  add_seed(app, options.study.seed, "base of all seeds [1]");
  add_threads(app, options.study.threads);
  add_kernel(app, options.study.kernel, kLastBits);
  add_budget(app, options.study.budget);
  add_classical(app, options.study.classical);
  app.add_option("--accept", options.study.accept,
                 "calibrate although 'bench inspect' finds errors of these kinds, or 'all'; a comma list")
      ->type_name("KIND,...")
      ->allow_extra_args(false);
  add_start(app, options.study);
  app.add_flag("--check-derivatives", options.study.check_derivatives,
               "before the run, compare Jacobian and gradient with differences at the start and at three "
               "random points; exit "
               "code 1 where they disagree");
  app.add_option("--polish", options.study.polish,
                 "solver that goes on from the best point of each run, within its budget")
      ->type_name("SOLVER");
  add_validation(app, options.trust.validation);
  add_bootstrap(app, options.trust);
  add_profile(app, options.trust);
  add_run_folder(app, options.out, options.overwrite);
  app.add_flag(
      "--resume", options.study.resume,
      "go on in --out where an earlier call was ended: its complete runs are kept, missing ones run");
  app.add_option("--format", options.format, "of the tables on standard output [console]")
      ->type_name("console|md|csv|json|latex");
  add_tables(app, options.tables, TablesByDefault::Key);
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

ExitCode outcome(const RunOptions& options, const SolverRuns& runs) {
  std::size_t made = 0, stopped = 0;
  for (const RunRecord& r : runs.records) {
    if (r.solver.empty()) continue;  // evaluated, or a classical method that does not apply
    ++made;
    if (r.termination == to_string(Termination::Interrupted)) ++stopped;
  }
  if (runs.interrupted && (stopped > 0 || made < runs.planned)) {
    note(fmt::format("interrupted: {} of {} runs complete, {} stopped early, {} not started{}",
                     made - stopped, runs.planned, stopped, runs.planned - made,
                     options.out.empty() ? "" : "; records are in " + options.out));
    return ExitCode::Interrupted;
  }
  if (!any_result(runs.records)) {
    warn("not one solver gave a result");
    return ExitCode::CheckFailed;
  }
  return ExitCode::Success;
}

// Where the files are and what to do with them.
void say_what_is_next(const RunOptions& options, const std::vector<RunRecord>& records) {
  if (options.quiet || !any_result(records)) return;
  if (options.out.empty())
    hint("nothing was kept: --out=DIR keeps records and tables for report, export and compare");
  else
    hint(
        fmt::format("{0}: records and tables; next: bench report {0} --out=report.html, bench export {0} "
                    "--to=yaml",
                    options.out));
}

void require_resumable(const RunOptions& options) {
  if (!options.study.resume) return;
  if (options.out.empty()) throw std::invalid_argument("--resume: --out is missing, the folder to go on in");
  if (options.overwrite)
    throw std::invalid_argument("--resume: it contradicts --overwrite, expected one of them");
  if (!options.study.start_method.empty())
    throw std::invalid_argument(
        fmt::format("--resume: not with --start={}, whose result is not part of the records",
                    options.study.start_method));
}

ExitCode run_command(const RunOptions& options, const Catalogue& catalogue) {
  const Format format = parse_format(options.format);
  require_resumable(options);
  TerminalWatcher watcher(options.quiet);
  RunFolder folder(options.out, options.overwrite || options.study.resume);
  const Stop stop = InterruptGuard::stop();
  TrustStudy trust(options.trust, options.study, catalogue, folder, watcher, stop);
  const SolverRuns runs = run_solvers(trust.with(options.study), catalogue, folder, watcher, stop);
  std::vector<Table> tables;
  if (runs.derivatives) tables.push_back(runs.derivatives->table);
  if (runs.derivatives && !runs.derivatives->agrees) {
    print_tables(tables, format);
    warn("derivatives disagree with differences; nothing was run");
    return ExitCode::CheckFailed;
  }
  for (Table& table : comparison_tables(runs.records, notes_of_best(runs.records)))
    tables.push_back(std::move(table));
  folder.save(tables);
  const ExitCode printed =
      print_chosen(std::move(tables), options.tables, format, TablesByDefault::Key, options.quiet);
  say_what_is_next(options, runs.records);
  if (trust.interrupted()) {
    const bool resumable = options.trust.bootstrap > 0 && !options.out.empty();
    note(fmt::format("interrupted: all runs are complete, their validation{} is not{}",
                     options.trust.bootstrap > 0 ? " or bootstrap" : "",
                     resumable ? "; the same call with --overwrite goes on with the bootstrap" : ""));
    return ExitCode::Interrupted;
  }
  const ExitCode ended = outcome(options, runs);
  return ended == ExitCode::Success ? printed : ended;
}

}  // namespace

VerbAction add_run(CLI::App& app) {
  const auto options = std::make_shared<RunOptions>();
  add_options(app, *options);
  return [&app, options](const Catalogue& catalogue) {
    if (!options->config.empty()) apply_config(app, options->config);
    return run_command(*options, catalogue);
  };
}

}  // namespace odobench
