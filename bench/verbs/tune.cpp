#include "bench/verbs/tune.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/files.hpp"
#include "bench/catalogue/number_text.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "bench/console/terminal_watcher.hpp"
#include "bench/studies/fusion/tuning_study.hpp"
#include "bench/studies/run_folder.hpp"
#include "bench/verbs/common_options.hpp"

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

Table sigma_table(const Tuning& tuning) {
  Table table{"sigmas", "Standard deviations that the filter believes", {text_column("parameter")}, {}, {}};
  for (const TunedSetting& s : tuning.settings) table.columns.push_back(number_column(s.label, s.label));
  for (Eigen::Index i = 0; i < static_cast<Eigen::Index>(tuning.parameters.size()); ++i) {
    const std::string& name = tuning.parameters[static_cast<std::size_t>(i)].name;
    table.rows.push_back({text_cell(name.substr(name.find(' ') + 1))});
    for (const TunedSetting& s : tuning.settings)
      table.rows.back().push_back(significant_cell(std::pow(10.0, s.x[i]), 4));
  }
  table.notes.push_back("Position in m, heading in rad, velocity in m/s, yaw rate in rad/s.");
  table.notes.insert(table.notes.end(), tuning.remarks.begin(), tuning.remarks.end());
  return table;
}

Table result_table(const Tuning& tuning, const std::string& objective) {
  Table table{
      "tuning",
      fmt::format("Tuning by {} on {} recordings, judged on {}{}", objective, tuning.training,
                  tuning.held_out == 0 ? tuning.training : tuning.held_out,
                  tuning.held_out == 0 ? " (the same ones: there are no others)" : " others"),
      {text_column("setting"), best_if(Better::Lower, number_column("cost")), number_column("evaluations"),
       best_if(Better::Lower, number_column("rmse_position", "RMSE position", "m")),
       best_if(Better::Lower, number_column("rmse_heading", "RMSE heading", "rad")),
       number_column("nees", "NEES"), text_column("verdict"), text_column("stop")},
      {},
      {}};
  for (const TunedSetting& one : tuning.settings)
    table.rows.push_back({text_cell(one.label), significant_cell(one.cost, 8), count_cell(one.evaluations),
                          fixed_cell(one.judged.row.rmse_position, 6),
                          fixed_cell(one.judged.row.rmse_heading, 6), fixed_cell(one.judged.row.mean_nees, 2),
                          text_cell(one.judged.row.verdict), text_cell(one.stop)});
  if (objective == "likelihood")
    table.notes.push_back(
        "The likelihood sees the innovations only: sensors that drift make it prefer sigmas that follow "
        "them. Compare "
        "NEES.");
  return table;
}

ExitCode tune_command(const TuneOptions& options, const Catalogue& catalogue) {
  const Format format = parse_format(options.format);
  refuse_existing("--out", options.out, options.overwrite);
  RunFolder folder(options.records, options.overwrite, "--records");
  folder.require_free();
  TerminalWatcher watcher;
  const Tuning tuning = tune_filter(options.study, catalogue, watcher, InterruptGuard::stop());
  if (tuning.settings.size() == 1) {
    warn("not one solver gave a result");
    return ExitCode::CheckFailed;
  }
  if (!options.out.empty()) {
    watcher.results_begin();
    write_file(options.out, tuning.best_sensors, existing_files(options.overwrite));
  }
  const std::vector<Table> tables{tuning.sensors, sigma_table(tuning),
                                  result_table(tuning, options.study.objective)};
  folder.keep(tuning.records, tables, watcher);
  print_tables(tables, format);
  return ExitCode::Success;
}

}  // namespace

VerbAction add_tune(CLI::App& app) {
  return verb_action<TuneOptions>(app, add_options, tune_command);
}

}  // namespace odobench
