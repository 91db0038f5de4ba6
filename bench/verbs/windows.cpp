#include "bench/verbs/verbs.hpp"

#include <fmt/format.h>

#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "bench/console/terminal_watcher.hpp"
#include "bench/options/common_options.hpp"
#include "bench/studies/entropy/window_study.hpp"
#include "reports/kinds/entropy/window_tables.hpp"

namespace odobench {
namespace {

constexpr const char* kWindowsExamples = R"(Examples:
  bench windows windows.json --solver=coordinate,exact,relaxed,lm,ip,ga,pso,nlopt:bobyqa
  bench windows windows.json --only=csharp --format=json
  bench windows windows.json --solver=exact,pso --repeat=5 --out=results)";

struct WindowsOptions {
  WindowStudy study;
  std::string out;  // folder for records and tables; empty: none
  bool overwrite = false;
  std::string format = "console";
  bool quiet = false;
};

void add_options(CLI::App& app, WindowsOptions& o) {
  app.add_option("file", o.study.file, "windows, JSON of the format entropy-window-1")->required();
  app.add_option("--solver", o.study.solvers,
                 "solvers, e.g. exact,pso[swarm=60]; 'all' for every one; may be given again "
                 "[coordinate,exact,relaxed]")
      ->type_name("LIST")
      ->allow_extra_args(false);
  app.add_option("--only", o.study.only, "ids or groups of windows [all]")
      ->type_name("LIST")
      ->allow_extra_args(false);
  add_count(app, "--repeat", o.study.repeat, 1, 100000, "runs of every solver that draws random numbers [1]");
  add_seed(app, o.study.seed, "base of all seeds [1]");
  add_threads(app, o.study.threads);
  add_kernel(app, o.study.kernel, kNamedOnly);
  add_budget(app, o.study.budget);
  add_run_folder(app, o.out, o.overwrite);
  app.add_option("--format", o.format, "of the tables on standard output [console]")
      ->type_name("console|md|csv|json|latex");
  app.add_flag("--quiet", o.quiet, "no progress and no remarks on standard error, only warnings and errors");
  app.footer(kWindowsExamples);
}

ExitCode outcome(const WindowRuns& runs, const std::string& out) {
  std::size_t stopped = 0;
  bool any = false;
  for (const RunRecord& r : runs.records) {
    if (r.termination == to_string(Termination::Interrupted)) ++stopped;
    any = any || (r.kind == "run" && r.cost);
  }
  if (runs.interrupted && (stopped > 0 || runs.records.size() < runs.planned)) {
    note(fmt::format("interrupted: {} of {} runs complete{}", runs.records.size() - stopped, runs.planned,
                     out.empty() ? "" : "; records are in " + out));
    return ExitCode::Interrupted;
  }
  if (any) return ExitCode::Success;
  warn("not one solver gave a result");
  return ExitCode::CheckFailed;
}

ExitCode windows_command(const WindowsOptions& options, const Catalogue& catalogue) {
  const Format format = parse_format(options.format);
  TerminalWatcher watcher(options.quiet);
  RunFolder folder(options.out, options.overwrite);
  const WindowRuns runs = run_on_windows(options.study, catalogue, folder, watcher, InterruptGuard::stop());
  const bool machine = format == Format::Json || format == Format::Csv;
  if (folder.keeps()) folder.save(window_tables(runs.records, false));
  print_tables(window_tables(runs.records, machine), format);
  return outcome(runs, options.out);
}

}  // namespace

VerbAction add_windows(CLI::App& app) {
  return verb_action<WindowsOptions>(app, add_options, windows_command);
}

}  // namespace odobench
