#include "bench/verbs/simulate_command.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "base/files.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "base/sha256.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/catalogue/scenarios.hpp"
#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "bench/studies/work_size.hpp"
#include "bench/verbs/written_files.hpp"
#include "problems/simulation/raw_csv.hpp"
#include "problems/simulation/simulated_set.hpp"

namespace odobench {
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
  announce(size, o.quiet);
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
  announce(fmt::format("--scenario={}: {:.2g} samples, {:.2g} fixed steps", o.scenario, count, steps),
           count * kSecondsPerMotorSample + steps * kSecondsPerStep, o.quiet);
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

std::vector<Table> detail_tables(const simulate::RecordingScenario& s) {
  Table drives{"drives",
               fmt::format("Drives of {}", s.name),
               {text_column("drive"), text_column("description"), number_column("phases"),
                number_column("duration_s", "duration", "s")},
               {},
               {s.description}};
  for (const simulate::Drive& d : s.drives)
    drives.rows.push_back({text_cell(d.name), text_cell(d.description),
                           count_cell(static_cast<double>(d.phases.size())), fixed_cell(d.duration(), 1)});
  Table robot{
      "robot",
      "True and believed parameters",
      {text_column("parameter"), text_column("unit"), number_column("truth"), number_column("believed")},
      {},
      {}};
  for (std::size_t i = 0; i < s.robot.parameters.size(); ++i)
    robot.rows.push_back({text_cell(s.robot.parameters[i].name), text_cell(s.robot.parameters[i].unit),
                          significant_cell(s.truth.parameters[i], 7),
                          significant_cell(s.control.believed[i], 7)});
  return {drives, robot};
}

std::vector<Table> detail_tables(const DynamicsScenario& s) {
  Table segments{"segments",
                 fmt::format("Segments of {}", s.name),
                 {text_column("until_s", "until [s]"), text_column("voltages_V", "voltages [V]"),
                  text_column("steering_deg", "steering [deg]")},
                 {},
                 {s.description}};
  for (const dynamics::Segment& g : s.setup.segments) {
    std::string voltages, steering;
    for (std::size_t i = 0; i < dynamics::kWheels; ++i) {
      voltages += fmt::format("{}{:g}", i > 0 ? ", " : "", g.voltage[i]);
      steering += fmt::format("{}{:g}", i > 0 ? ", " : "", g.steering[i] * 180 / 3.14159265358979323846);
    }
    segments.rows.push_back(
        {text_cell(fmt::format("{:g}", g.until_s)), text_cell(voltages), text_cell(steering)});
  }
  Table robot{"robot",
              "Robot parameters",
              {text_column("parameter"), text_column("symbol"), number_column("value"), text_column("unit"),
               text_column("origin"), text_column("remark")},
              {},
              {"Origin: given by the thesis, or chosen because it gives nothing."}};
  dynamics::RobotParameters copy = s.setup.robot;
  for (const dynamics::ParameterDescription& d : dynamics::parameter_descriptions())
    robot.rows.push_back({text_cell(d.name), text_cell(d.symbol), significant_cell(d.value(copy), 7),
                          text_cell(d.unit), text_cell(d.given ? "given" : "chosen"), text_cell(d.text)});
  return {segments, robot};
}

}  // namespace

ExitCode simulate_command(const SimulateOptions& options) {
  Scenario scenario = load_scenario(options.scenario);
  if (const auto* recordings = std::get_if<simulate::RecordingScenario>(&scenario))
    write_recordings(*recordings, options);
  else
    write_dynamics(std::get<DynamicsScenario>(std::move(scenario)), options);
  return ExitCode::Success;
}

std::vector<Table> scenario_tables(const std::string& source) {
  if (!source.empty())
    return std::visit([](const auto& s) { return detail_tables(s); }, load_scenario(source));
  Table table{
      "scenarios",
      "Scenarios, as in bench simulate --scenario=NAME",
      {text_column("scenario"), text_column("kind"), number_column("drives"), text_column("description")},
      {},
      {"'bench list scenarios NAME' shows one in detail; docs/simulation.md describes the format."}};
  for (const auto& [name, path] : known_scenarios()) {
    const Scenario scenario = load_scenario(path.string());
    if (const auto* r = std::get_if<simulate::RecordingScenario>(&scenario))
      table.rows.push_back({text_cell(name), text_cell("recordings"),
                            count_cell(static_cast<double>(r->drives.size()) * r->repetitions),
                            text_cell(r->description)});
    else
      table.rows.push_back({text_cell(name), text_cell("dynamics"), count_cell(1),
                            text_cell(std::get<DynamicsScenario>(scenario).description)});
  }
  return {table};
}

}  // namespace odobench
