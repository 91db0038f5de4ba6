#include "bench/verbs/verbs.hpp"

#include "base/files.hpp"
#include "bench/catalogue/number_text.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "bench/console/terminal_watcher.hpp"
#include "bench/options/common_options.hpp"
#include "bench/studies/fusion/tuning_study.hpp"
#include "bench/studies/run_folder.hpp"
#include "reports/kinds/fusion/tuning_tables.hpp"

namespace odobench {
namespace {

struct TuneOptions {
  TuningStudy study;
  std::string out;      // sensors file to write; empty: none
  std::string records;  // folder for records and tables; empty: none
  bool overwrite = false;
  std::string format = "console";
};

void add_options(CLI::App& app, TuneOptions& o) {
  app.add_option("--data", o.study.data, "data set [the demo set]")->type_name("SET.JSON");
  app.add_option("--parameters", o.study.parameters, "parameter set of the wheels [nominal]")
      ->type_name("NAME|FILE");
  app.add_option("--sensors", o.study.sensors, "JSON file as of 'bench fuse'; its sigmas are the start")
      ->required()
      ->type_name("FILE");
  app.add_option("--solver", o.study.solvers, "solvers as of 'bench run' [nlopt:bobyqa]")
      ->type_name("LIST")
      ->allow_extra_args(false);
  app.add_option("--filter", o.study.filter, "ekf or ukf [ekf]")->type_name("NAME");
  app.add_option("--objective", o.study.objective,
                 "likelihood (of the innovations) or error (of the pose against the reference) [likelihood]")
      ->type_name("NAME");
  app.add_option_function<std::string>(
         "--max-evals",
         [&o](const std::string& text) { o.study.max_evaluations = whole_number("--max-evals", text, 1); },
         "evaluations of a run at most [200]")
      ->type_name("N");
  app.add_option_function<std::string>(
         "--seed", [&o](const std::string& text) { o.study.seed = seed_number("--seed", text); },
         "of the synthetic sensors and the solvers [that of the file]")
      ->type_name("N");
  add_kernel(app, o.study.kernel, kNamedOnly);
  app.add_option("--out", o.out, "write the sensors file with the best sigmas")->type_name("FILE");
  app.add_option("--records", o.records, "folder for records (runs.jsonl) and tables.*")->type_name("DIR");
  app.add_flag("--overwrite", o.overwrite, "replace what --out and --records find there");
  add_format(app, o.format);
}

ExitCode tune_command(const TuneOptions& options, const Catalogue& catalogue) {
  const Format format = parse_format(options.format);
  refuse_existing("--out", options.out, options.overwrite);
  RunFolder folder(options.records, options.overwrite, "--records");
  folder.require_free();
  TerminalWatcher watcher;
  const Tuning tuning = tune_filter(options.study, catalogue, watcher, InterruptGuard::stop());
  if (tuning.records.size() == 1) {
    warn("not one solver gave a result");
    return ExitCode::CheckFailed;
  }
  if (!options.out.empty()) {
    watcher.results_begin();
    write_file(options.out, tuning.best_sensors, existing_files(options.overwrite));
  }
  std::vector<Table> tables = tuning_tables(tuning.records, tuning.circumstances);
  tables.insert(tables.begin(), tuning.sensors);
  folder.keep(tuning.records, tables, watcher);
  print_tables(tables, format);
  return ExitCode::Success;
}

}  // namespace

VerbAction add_tune(CLI::App& app) {
  return verb_action<TuneOptions>(app, add_options, tune_command);
}

}  // namespace odobench
