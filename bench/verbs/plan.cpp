#include "bench/verbs/verbs.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "base/error.hpp"

#include "bench/catalogue/number_text.hpp"
#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "bench/console/terminal_watcher.hpp"
#include "bench/options/common_options.hpp"
#include "bench/studies/importing/log_study.hpp"
#include "bench/studies/planning/drive_plan.hpp"
#include "bench/studies/run_folder.hpp"
#include "reports/kinds/planning/planning_tables.hpp"

namespace odobench {
namespace {

struct PlanOptions {
  DrivePlan study;
  std::string data;
  std::string out;  // folder for the record and tables; empty: none
  bool overwrite = false;
  std::string format = "console";
};

void add_options(CLI::App& app, PlanOptions& o) {
  add_scenario(app, "--robot", o.study.robot);
  app.add_option("--data", o.data, "a set of recordings in the place of --robot")->type_name("SET.JSON");
  app.add_option("--between", o.study.between,
                 "which drives decide between two models that are fitted to the recordings, names as in "
                 "'bench models', combined by '+', 'plain' for none; with a set of recordings")
      ->type_name("MODEL,MODEL")
      ->allow_extra_args(false);
  app.add_option("--drives", o.study.drives,
                 "drives, a name once per time it is driven, or 'none'; a comma list [those of the scenario]")
      ->type_name("LIST")
      ->allow_extra_args(false);
  app.add_option("--candidates", o.study.candidates,
                 "propose drives out of these, 'all' or a comma list, until --wanted is met")
      ->type_name("LIST")
      ->allow_extra_args(false);
  app.add_option_function<std::string>(
         "--wanted",
         [&o](const std::string& text) { o.study.wanted = finite_number("--wanted", text, true, 1e6) / 100; },
         "standard deviation of every parameter, % of its nominal value [0.5]")
      ->type_name("PERCENT");
  add_count(app, "--replicas", o.study.replicas, 2, 10000,
            "simulations per drive that its noise is taken from [32]");
  add_noise_options(app, o.study.seed, o.study.threads);
  add_kernel(app, o.study.kernel, kLastBits);
  add_study_folder(app, o.out, o.overwrite);
  add_format(app, o.format);
}

// --data stands for --robot; --between leaves nothing to the other options.
DrivePlan study_of(const PlanOptions& o) {
  DrivePlan study = o.study;
  if (study.robot.empty() == o.data.empty())
    throw std::invalid_argument(study.robot.empty()
                                    ? "--robot or --data: neither is given, expected one of them"
                                    : "--robot and --data: both are given, expected one of them");
  if (!o.data.empty()) {
    if (!is_dataset(o.data))
      throw DataError(fmt::format("--data={}: found something else, expected a data set (set.json)", o.data));
    study.robot = o.data;
  }
  if (study.between.empty()) return study;
  if (!study.drives.empty() || !study.candidates.empty())
    throw std::invalid_argument(
        "--between: it takes every drive that is known, without --drives and --candidates");
  if (!is_dataset(study.robot))
    throw DataError(fmt::format(
        "--robot={}: found no recordings, expected a data set (set.json), which --between fits its models to",
        study.robot));
  return study;
}

ExitCode plan_command(const PlanOptions& o) {
  const Format format = parse_format(o.format);
  RunFolder folder(o.out, o.overwrite);
  folder.require_free();
  TerminalWatcher watcher;
  const std::vector<RunRecord> records = plan_drives(study_of(o), watcher, InterruptGuard::stop());
  const std::vector<Table> tables = planning_tables(records.front(), !o.study.candidates.empty());
  folder.keep(records, tables, watcher);
  print_tables(tables, format);
  return ExitCode::Success;
}

}  // namespace

VerbAction add_plan(CLI::App& app) {
  return verb_action<PlanOptions>(app, add_options, plan_command);
}

}  // namespace odobench
