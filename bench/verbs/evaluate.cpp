#include "bench/verbs/verbs.hpp"

#include "bench/catalogue/option_values.hpp"
#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "bench/console/terminal_watcher.hpp"
#include "bench/options/common_options.hpp"
#include "bench/options/table_options.hpp"
#include "bench/studies/calibration/evaluation_study.hpp"
#include "bench/studies/calibration/tracks_csv.hpp"
#include "bench/studies/run_folder.hpp"
#include "bench/studies/run_tracks.hpp"
#include "reports/kinds/calibration/calibration_tables.hpp"

namespace odobench {
namespace {

struct EvaluateOptions {
  EvaluationStudy study;
  std::string tracks;  // CSV file for the paths; empty: none
  std::string out;     // folder for records, tables and tracks; empty: none
  bool overwrite = false;
  std::string format = "console";
  std::vector<std::string> shown;
};

void add_options(CLI::App& app, EvaluateOptions& o) {
  app.add_option("--data", o.study.data, "data set [the demo set]")->type_name("SET.JSON");
  app.add_option(
         "--parameters", o.study.parameters,
         "JSON files ({\"a1\": 0.1125, ...} in metres and radians, or an array of such), 'nominal', or names "
         "the set knows "
         "such as published:lm, truth, or the folder of a run (best run of each row; DIR:ROW for one); a "
         "comma list, may be given again [nominal]")
      ->type_name("LIST")
      ->allow_extra_args(false);
  app.add_option(
         "--tracks", o.tracks,
         "write the paths that the parameters give as CSV, for plots; - for standard output, without tables")
      ->type_name("FILE.CSV");
  add_calibration(app, o.study.calibration);
  add_screen(app, o.study.calibration.screen);
  add_classical(app, o.study.classical);
  add_kernel(app, o.study.kernel, kLastBits);
  app.add_option("--out", o.out, "keep records, tables and tracks in this folder")->type_name("DIR");
  app.add_flag("--overwrite", o.overwrite, "replace what --tracks or --out find there");
  add_format(app, o.format);
  add_tables(app, o.shown, TablesByDefault::All);
}

ExitCode evaluate_command(const EvaluateOptions& options) {
  const Format format = parse_format(options.format);
  refuse_existing("--tracks", options.tracks, options.overwrite);
  RunFolder folder(options.out, options.overwrite);
  folder.require_free();
  TerminalWatcher watcher;
  const Evaluation found = evaluate_parameters(options.study, watcher, InterruptGuard::stop());
  const std::vector<Table> tables = evaluation_tables(found.records, found.records.front().notes);
  if (folder.keeps()) {
    const TrackSet tracks = run_tracks(found.loaded, found.records);
    folder.keep(found.records, tables, watcher, &tracks);
  }
  if (!options.tracks.empty()) {
    const std::string csv = tracks_csv(*found.loaded.calibration, found.sets);
    watcher.results_begin();
    write_result(options.tracks, csv, existing_files(options.overwrite));
  }
  if (options.tracks != "-") return print_chosen(tables, options.shown, format, TablesByDefault::All);
  return ExitCode::Success;
}

}  // namespace

VerbAction add_evaluate(CLI::App& app) {
  return verb_action<EvaluateOptions>(app, add_options, evaluate_command);
}

}  // namespace odobench
