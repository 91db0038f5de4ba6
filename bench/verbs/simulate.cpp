#include "bench/verbs/verbs.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "base/files.hpp"
#include "bench/catalogue/number_text.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "bench/console/terminal_watcher.hpp"
#include "bench/options/common_options.hpp"
#include "bench/options/written_files.hpp"
#include "bench/studies/planning/robot_drives.hpp"
#include "bench/studies/simulation/scenario_study.hpp"

namespace odobench {
namespace {

struct SimulateOptions {
  ScenarioStudy study;
  RobotSimulation robot;  // without a scenario
  std::string out;
  std::optional<int> repeat;
  bool quiet = false;
  bool json = false;  // say on standard output what was written
};

void add_options(CLI::App& app, SimulateOptions& o) {
  add_scenario(app, "--scenario", o.study.scenario);
  add_robot(app, o.robot.robot);
  app.add_option("--parameters", o.robot.parameters,
                 "of --robot: the true ones, a name that its set knows or a JSON file [nominal]")
      ->type_name("NAME|FILE");
  app.add_option("--drives", o.robot.drives,
                 "of --robot: names or 'all'; a comma list [squares, circles, lines]")
      ->type_name("LIST")
      ->allow_extra_args(false);
  add_value(app, "--repeat", "N", "of --robot: recordings of each drive [3]", [&o](const std::string& text) {
    o.repeat = static_cast<int>(whole_number("--repeat", text, 1, 10000));
  });
  app.add_option("--out", o.out, "folder to write")->required()->type_name("DIR");
  add_noise_options(app, o.study.seed, o.study.threads);
  app.add_flag("--raw", o.study.raw, "raw CSV files as published, for 'bench import vitko2024'");
  app.add_flag("--as-published", o.study.as_published,
               "the motor robot with the errors of its thesis (kind dynamics)");
  app.add_flag("--overwrite", o.study.overwrite, "replace files that are there");
  app.add_flag("--quiet", o.quiet, "no remarks");
  add_json(app, o.json);
}

void simulate_robot_drives(const SimulateOptions& o) {
  for (const auto& [given, name] :
       {std::pair(o.study.raw, "--raw"), std::pair(o.study.as_published, "--as-published")})
    if (given) throw std::invalid_argument(fmt::format("{}: it belongs to scenarios", name));
  const std::filesystem::path set_json = std::filesystem::path(o.out) / "set.json";
  require_writable(set_json, existing_files(o.study.overwrite));
  RobotSimulation study = o.robot;
  study.repeat = o.repeat.value_or(study.repeat);
  study.seed = o.study.seed;
  study.threads = o.study.threads;
  TerminalWatcher watcher(o.quiet);
  const Dataset dataset = simulate_robot(study, watcher, InterruptGuard::stop());
  save_announced(dataset, set_json, o.study.overwrite, o.json, o.quiet);
}

void simulate_from_scenario(const SimulateOptions& o) {
  for (const auto& [given, name] :
       {std::pair(!o.robot.parameters.empty(), "--parameters"),
        std::pair(!o.robot.drives.empty(), "--drives"), std::pair(o.repeat.has_value(), "--repeat")})
    if (given)
      throw std::invalid_argument(fmt::format("{}: it belongs to --robot; a scenario states its own", name));
  ScenarioStudy study = o.study;
  study.out = o.out;
  TerminalWatcher watcher(o.quiet);
  const WrittenScenario written = simulate_scenario(study, watcher, InterruptGuard::stop());
  if (!o.json) return;
  std::vector<Table> tables{written_table(written.files)};
  if (written.dataset) tables.insert(tables.begin(), dataset_table(*written.dataset));
  print_tables(tables, Format::Json);
}

ExitCode simulate_command(const SimulateOptions& options) {
  require_one(options.study.scenario, options.robot.robot);
  if (options.robot.robot.empty())
    simulate_from_scenario(options);
  else
    simulate_robot_drives(options);
  return ExitCode::Success;
}

}  // namespace

VerbAction add_simulate(CLI::App& app) {
  return verb_action<SimulateOptions>(app, add_options, simulate_command);
}

}  // namespace odobench
