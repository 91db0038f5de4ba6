#include "bench/verbs/verbs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "bench/catalogue/option_values.hpp"
#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "bench/console/terminal_watcher.hpp"
#include "bench/options/common_options.hpp"
#include "bench/options/table_options.hpp"
#include "bench/options/trust_options.hpp"
#include "bench/studies/importing/calibrate_study.hpp"
#include "bench/studies/records.hpp"
#include "reports/kinds/calibration/calibration_tables.hpp"

namespace odobench {
namespace {

constexpr const char* kCalibrateExamples = R"(Examples:
  bench calibrate drive.bag --nominal=b=0.40,r=0.05 --out=robot
  bench calibrate ticks.csv mocap.csv --per-turn=4096 --nominal=b=0.40,r=0.05
  bench calibrate run_*.mcap --map=map.json
What the log does not say and may not be assumed (counts of a turn, nominal sizes) is refused with the option to add.
'bench import LOG... --propose > map.json' shows what would be assumed.)";

struct CalibrateOptions {
  std::vector<std::string> logs;
  std::string map, robot, name, out = "calibration";
  std::vector<std::string> nominal, messages, accept;
  CalibrationChoice calibration = screened();
  ValidationChoice validation;
  double per_turn = 0;
  bool keep_cut = false, overwrite = false, quiet = false;
  std::string format = "console";
  std::vector<std::string> tables;
};

void add_options(CLI::App& app, CalibrateOptions& o) {
  app.add_option("logs", o.logs, "logs of any format, or a set.json")->required()->type_name("LOG...");
  app.add_option("--map", o.map, "what is what in them (docs/import.md) [proposed by looking at them]")
      ->type_name("MAP.JSON");
  app.add_option("--robot", o.robot, "class of the robot, see 'bench list robots' [as the wheels' names say]")
      ->type_name("CLASS");
  app.add_option("--nominal", o.nominal,
                 "sizes as the controller has them, m; r is for all radii: b=0.4,r=0.05")
      ->type_name("NAME=VALUE,...")
      ->allow_extra_args(false);
  app.add_option("--per-turn", o.per_turn, "counts of a turn of the wheel, gear included")
      ->type_name("N")
      ->check(CLI::PositiveNumber);
  app.add_option("--name", o.name, "of the robot and the set")->type_name("NAME");
  app.add_option("--msg", o.messages, "definition of a message that a log lacks; may be given again")
      ->type_name("FILE.msg")
      ->allow_extra_args(false);
  add_value(app, "--cost", "NAME",
            "every_sample, final_pose, segments, optiodom [every_sample; segments where the reference is "
            "another odometry]",
            [&o](const std::string& text) { o.calibration.cost = cost_kind(text); });
  app.add_flag("--mount", o.calibration.mount, "fit the place of the tracked frame with the parameters");
  add_model(app, o.calibration);
  app.add_option("--accept", o.accept,
                 "calibrate although 'bench inspect' finds errors of these kinds, or 'all'; a comma list")
      ->type_name("KIND,...")
      ->allow_extra_args(false);
  add_validation(app, o.validation);
  add_screen(app, o.calibration.screen);
  app.add_flag("--keep-cut", o.keep_cut, "of a log that is cut off take what stands before");
  app.add_option("--out", o.out, "folder for map, set, results and page [calibration]")->type_name("DIR");
  app.add_flag("--overwrite", o.overwrite, "replace what is there");
  app.add_flag("--quiet", o.quiet, "no remarks on standard error, only warnings and errors");
  add_format(app, o.format);
  add_tables(app, o.tables, TablesByDefault::Key);
  app.footer(kCalibrateExamples);
}

CalibrateStudy study_of(const CalibrateOptions& o) {
  CalibrateStudy study;
  study.logs.assign(o.logs.begin(), o.logs.end());
  study.map = o.map;
  study.answers.robot = o.robot;
  study.answers.name = o.name;
  for (const std::string& list : o.nominal) study.answers.nominal.merge(parse_nominal("--nominal", list));
  if (o.per_turn > 0) study.answers.per_turn = o.per_turn;
  const bool answered = !o.robot.empty() || !o.nominal.empty() || o.per_turn > 0 || !o.name.empty();
  if (!o.map.empty() && answered)
    throw std::invalid_argument(
        "--map says what --robot, --nominal, --per-turn and --name would: leave them out");
  study.options.keep_cut = o.keep_cut;
  study.options.messages.assign(o.messages.begin(), o.messages.end());
  study.accept = o.accept;
  study.validation = o.validation;
  study.calibration = o.calibration;
  study.out = o.out;
  study.overwrite = o.overwrite;
  return study;
}

ExitCode calibrate_command(const CalibrateOptions& options, const Catalogue& catalogue) {
  const Format format = parse_format(options.format);
  TerminalWatcher watcher(options.quiet);
  const Calibrated done = calibrate_logs(study_of(options), catalogue, watcher, InterruptGuard::stop());
  std::vector<Table> tables = comparison_tables(done.records, notes_of_best(done.records));
  const ExitCode printed =
      print_chosen(std::move(tables), options.tables, format, TablesByDefault::Key, options.quiet);
  for (const std::filesystem::path& file : done.files) note(file.string());
  note(fmt::format(
      "next: bench report {0} shows all tables; bench export {0} --to=ros2 writes a controller's parameters",
      done.results.string()));
  if (!done.sensors.empty())
    note(fmt::format("next: bench fuse --data={} --sensors={} --parameters=nominal,{}:lm --filter=none,ekf",
                     done.set.string(), done.sensors.string(), done.results.string()));
  const bool any = std::any_of(done.records.begin(), done.records.end(),
                               [](const RunRecord& r) { return r.kind == "run" && r.cost; });
  return any ? printed : ExitCode::CheckFailed;
}

}  // namespace

VerbAction add_calibrate(CLI::App& app) {
  return verb_action<CalibrateOptions>(app, add_options, calibrate_command);
}

}  // namespace odobench
