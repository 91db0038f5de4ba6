#include "bench/verbs/verbs.hpp"

#include "bench/catalogue/number_text.hpp"
#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "bench/console/terminal_watcher.hpp"
#include "bench/options/common_options.hpp"
#include "bench/studies/fusion/fusion_study.hpp"
#include "bench/studies/run_folder.hpp"

namespace odobench {
namespace {

struct FuseOptions {
  FusionStudy study;
  std::string out;  // folder for records, tables and tracks; empty: none
  bool overwrite = false;
  std::string format = "console";
};

void add_options(CLI::App& app, FuseOptions& o) {
  app.add_option("--data", o.study.data, "data set [the demo set]")->type_name("SET.JSON");
  app.add_option("--parameters", o.study.parameters, "parameter sets as of 'bench evaluate' [nominal]")
      ->type_name("LIST")
      ->allow_extra_args(false);
  app.add_option("--filter", o.study.filters,
                 "none, ekf, ukf, ekf-smoothed, ukf-smoothed, ekf-literal; a comma list [none,ekf,ukf]")
      ->type_name("LIST")
      ->allow_extra_args(false);
  app.add_option("--sensors", o.study.sensors,
                 "JSON file: the sensors, their errors, what the filter believes")
      ->required()
      ->type_name("FILE");
  app.add_option(
         "--odometry-noise", o.study.odometry_noise,
         "what the filter believes of the wheels: measured (on these drives), total (with what repeats), "
         "file, or V,W of a sample, m/s and rad/s [file where it has \"wheels\", else total]")
      ->type_name("measured|total|file|V,W");
  app.add_option_function<std::string>(
         "--seed", [&o](const std::string& text) { o.study.seed = seed_number("--seed", text); },
         "of the synthetic sensors [that of the file]")
      ->type_name("N");
  add_threads(app, o.study.threads);
  add_kernel(app, o.study.kernel, kNamedOnly);
  app.add_option("--out", o.out, "keep records, tables and tracks in this folder")->type_name("DIR");
  app.add_flag("--overwrite", o.overwrite, "replace runs that the folder holds");
  add_format(app, o.format);
}

ExitCode fuse_command(const FuseOptions& options) {
  const Format format = parse_format(options.format);
  RunFolder folder(options.out, options.overwrite);
  folder.require_free();
  TerminalWatcher watcher;
  FusionStudy study = options.study;
  study.keep_tracks = folder.keeps();
  const FusionRuns runs = fuse_recordings(study, watcher, InterruptGuard::stop());
  const std::vector<Table> tables = fusion_tables(&runs.sensors, runs.records, runs.rows);
  folder.keep(runs.records, tables, watcher, &runs.tracks);
  print_tables(tables, format);
  return ExitCode::Success;
}

}  // namespace

VerbAction add_fuse(CLI::App& app) {
  return verb_action<FuseOptions>(app, add_options, fuse_command);
}

}  // namespace odobench
