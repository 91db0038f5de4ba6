#include "bench/verbs/verbs.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "base/files.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "base/sha256.hpp"
#include "bench/catalogue/number_text.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/catalogue/scenarios.hpp"
#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "bench/console/terminal_watcher.hpp"
#include "bench/options/common_options.hpp"
#include "bench/options/written_files.hpp"
#include "bench/studies/planning/robot_drives.hpp"
#include "bench/studies/work_size.hpp"
#include "problems/simulation/raw_csv.hpp"
#include "problems/simulation/simulated_set.hpp"

namespace odobench {
namespace {

struct SimulateOptions {
  std::string scenario;   // file or name
  RobotSimulation study;  // of a robot without a scenario
  std::string out;
  std::uint64_t seed = 1;
  std::optional<int> repeat;
  bool raw = false;           // the published CSV format instead of a data set
  bool as_published = false;  // dynamics without the corrections
  int threads = 0;            // 0: one per core
  bool overwrite = false;
  bool quiet = false;
  bool json = false;  // say on standard output what was written
};

void add_options(CLI::App& app, SimulateOptions& o) {
  add_scenario(app, "--scenario", o.scenario);
  add_robot(app, o.study.robot);
  app.add_option("--parameters", o.study.parameters,
                 "of --robot: the true ones, a name that its set knows or a JSON file [nominal]")
      ->type_name("NAME|FILE");
  app.add_option("--drives", o.study.drives,
                 "of --robot: names or 'all'; a comma list [squares, circles, lines]")
      ->type_name("LIST")
      ->allow_extra_args(false);
  add_value(app, "--repeat", "N", "of --robot: recordings of each drive [3]", [&o](const std::string& text) {
    o.repeat = static_cast<int>(whole_number("--repeat", text, 1, 10000));
  });
  app.add_option("--out", o.out, "folder to write")->required()->type_name("DIR");
  add_noise_options(app, o.seed, o.threads);
  app.add_flag("--raw", o.raw, "raw CSV files as published, for 'bench import vitko2024'");
  app.add_flag("--as-published", o.as_published,
               "the motor robot with the errors of its thesis (kind dynamics)");
  app.add_flag("--overwrite", o.overwrite, "replace files that are there");
  app.add_flag("--quiet", o.quiet, "no remarks");
  add_json(app, o.json);
}

}  // namespace
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kRawDrives = 6;  // what the importer of raw files expects, five repetitions of each
constexpr int kRawRepetitions = 5;

void require_raw(const simulate::RecordingScenario& s) {
  if (s.exact)
    throw std::invalid_argument("--raw: contradictory options: an exact scenario has one clock and no logs");
  const std::vector<simulate::Drive> wanted = simulate::reference_drives();
  bool same = s.drives.size() == kRawDrives && s.repetitions == kRawRepetitions;
  for (std::size_t i = 0; same && i < kRawDrives; ++i) same = s.drives[i].name == wanted[i].name;
  if (!same)
    throw std::invalid_argument(fmt::format(
        "--raw: the scenario has {} drives, {} repetitions; the published files are line_x, line_y, "
        "circle_ccw, circle_cw, rotation_ccw, rotation_cw, five of each",
        s.drives.size(), s.repetitions));
}

void add_raw_files(const simulate::SimulatedSet& set, int threads, const fs::path& out,
                   FileTransaction& files) {
  struct Pair {
    std::string capture, wheels, sums;
  };
  std::vector<Pair> pairs(set.drives.size());
  const auto make = [&](std::size_t i) {
    const int number = static_cast<int>(i) + 1;
    Pair& p = pairs[i];
    p.capture = simulate::capture_csv(set.drives[i].logs, number);
    p.wheels = simulate::wheels_csv(set.drives[i].logs, number);
    p.sums =
        fmt::format("{}  abs_{}.csv\n{}  odom_{}.csv\n", sha256(p.capture), number, sha256(p.wheels), number);
  };
  parallel_for(pairs.size(), threads, make, InterruptGuard::stop());
  std::string sums;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    files.add(out / fmt::format("abs_{}.csv", i + 1), pairs[i].capture);
    files.add(out / fmt::format("odom_{}.csv", i + 1), pairs[i].wheels);
    sums += pairs[i].sums;
  }
  files.add(out / "SHA256SUMS", sums);
}

void write_recordings(const simulate::RecordingScenario& s, const SimulateOptions& o) {
  const fs::path out = o.out, set_json = out / "set.json";
  if (o.as_published)
    throw std::invalid_argument(
        "--as-published: it corrects nothing here; it belongs to scenarios of kind dynamics");
  if (o.raw) require_raw(s);
  const Existing existing = existing_files(o.overwrite);
  for (const fs::path& file : {o.raw ? out / "abs_1.csv" : set_json, out / "truth.json", out / "truth.csv"})
    require_writable(file, existing);
  const double samples_at_most = simulate::most_samples(s);
  const WorkSize size{
      fmt::format("--scenario={}: {} drives {} times", o.scenario, s.drives.size(), s.repetitions),
      samples_at_most, samples_at_most};
  require_size(size);
  TerminalWatcher watcher(o.quiet);
  announce(size, watcher);
  const simulate::SimulatedSet set = simulate::simulate_set(s, o.seed, o.threads);
  const std::string truth_json = simulate::truth_json(s, o.seed, set),
                    truth_csv = simulate::truth_csv(s, set);
  InterruptGuard::remember();
  FileTransaction files(existing);
  files.add(out / "truth.json", truth_json);
  files.add(out / "truth.csv", truth_csv);
  if (o.raw)
    add_raw_files(set, o.threads, out, files);
  else
    add_dataset(set.dataset, set_json, files, false, InterruptGuard::stop());
  const std::vector<fs::path> written = files.targets();
  files.commit();
  std::size_t samples = 0;
  for (const Recording& r : set.dataset.recordings) samples += r.size();
  if (!o.quiet)
    note(fmt::format("{}: {} recordings, {} samples, truth.json and truth.csv beside them",
                     (o.raw ? out : set_json).string(), set.dataset.recordings.size(), samples));
  if (o.json) print_tables({dataset_table(set.dataset), written_table(written)}, Format::Json);
}

void write_dynamics(DynamicsScenario s, const SimulateOptions& o) {
  if (o.raw) throw std::invalid_argument("--raw: it belongs to scenarios of kind recordings");
  const fs::path out = o.out;
  for (const char* name : {"sensors.csv", "truth.csv", "state.csv", "robot.json"})
    require_writable(out / name, existing_files(o.overwrite));
  if (o.as_published) {
    s.setup.model = dynamics::ModelOptions::as_published();
    s.frame = dynamics::AccelerationFrame::World;
  }
  const double end = s.setup.segments.back().until_s, count = end / s.output_step_s;
  const double steps = s.setup.integration.method == dynamics::Method::RungeKutta4
                           ? end / s.setup.integration.step_s
                           : 0;  // adaptive ones are not known beforehand
  TerminalWatcher watcher(o.quiet);
  announce(fmt::format("--scenario={}: {:.2g} samples, {:.2g} fixed steps", o.scenario, count, steps),
           count * kSecondsPerMotorSample + steps * kSecondsPerStep, watcher);
  const std::vector<dynamics::Sample> samples = dynamics::simulate_drive(s.setup, s.output_step_s);
  Random random(derive_seed(o.seed, {"dynamics", s.name}));
  const dynamics::SensorRun run =
      dynamics::sense(s.setup.robot, samples, s.frame, s.noise, [&random] { return random.normal(); });
  const std::string sensors = dynamics::sensor_csv(run.rows), truth = dynamics::truth_csv(run.truth),
                    states = dynamics::state_csv(s.setup.robot, samples);
  InterruptGuard::remember();
  FileTransaction files(existing_files(o.overwrite));
  files.add(out / "sensors.csv", sensors);
  files.add(out / "truth.csv", truth);
  files.add(out / "state.csv", states);
  files.add(out / "robot.json", robot_json(s.setup.robot));
  const std::vector<fs::path> written = files.targets();
  files.commit();
  if (!o.quiet)
    note(fmt::format("{}: sensors.csv, truth.csv and state.csv of {} samples, robot.json", out.string(),
                     samples.size()));
  if (o.json) print_tables({written_table(written)}, Format::Json);
}

void write_robot_drives(const SimulateOptions& o) {
  for (const auto& [given, name] : {std::pair(o.raw, "--raw"), std::pair(o.as_published, "--as-published")})
    if (given) throw std::invalid_argument(fmt::format("{}: it belongs to scenarios", name));
  const fs::path set_json = fs::path(o.out) / "set.json";
  require_writable(set_json, existing_files(o.overwrite));
  RobotSimulation study = o.study;
  study.repeat = o.repeat.value_or(study.repeat);
  study.seed = o.seed;
  study.threads = o.threads;
  TerminalWatcher watcher(o.quiet);
  const Dataset dataset = simulate_robot(study, watcher, InterruptGuard::stop());
  save_announced(dataset, set_json, o.overwrite, o.json, o.quiet);
}

ExitCode simulate_command(const SimulateOptions& options) {
  require_one(options.scenario, options.study.robot);
  if (!options.study.robot.empty()) {
    write_robot_drives(options);
    return ExitCode::Success;
  }
  for (const auto& [given, name] : {std::pair(!options.study.parameters.empty(), "--parameters"),
                                    std::pair(!options.study.drives.empty(), "--drives"),
                                    std::pair(options.repeat.has_value(), "--repeat")})
    if (given)
      throw std::invalid_argument(fmt::format("{}: it belongs to --robot; a scenario states its own", name));
  Scenario scenario = load_scenario(options.scenario);
  if (const auto* recordings = std::get_if<simulate::RecordingScenario>(&scenario))
    write_recordings(*recordings, options);
  else
    write_dynamics(std::get<DynamicsScenario>(std::move(scenario)), options);
  return ExitCode::Success;
}

}  // namespace

VerbAction add_simulate(CLI::App& app) {
  return verb_action<SimulateOptions>(app, add_options, simulate_command);
}

}  // namespace odobench
