#include "bench/studies/simulation/scenario_study.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>
#include <variant>

#include "base/files.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "base/sha256.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/catalogue/scenarios.hpp"
#include "bench/studies/work_size.hpp"
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
                   FileTransaction& files, const Stop& stop) {
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
  parallel_for(pairs.size(), threads, make, stop);
  std::string sums;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    files.add(out / fmt::format("abs_{}.csv", i + 1), pairs[i].capture);
    files.add(out / fmt::format("odom_{}.csv", i + 1), pairs[i].wheels);
    sums += pairs[i].sums;
  }
  files.add(out / "SHA256SUMS", sums);
}

WrittenScenario write_recordings(const simulate::RecordingScenario& s, const ScenarioStudy& o,
                                 Watcher& watcher, const Stop& stop) {
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
  announce(size, watcher);
  simulate::SimulatedSet set = simulate::simulate_set(s, o.seed, o.threads);
  const std::string truth_json = simulate::truth_json(s, o.seed, set),
                    truth_csv = simulate::truth_csv(s, set);
  watcher.results_begin();
  FileTransaction files(existing);
  files.add(out / "truth.json", truth_json);
  files.add(out / "truth.csv", truth_csv);
  if (o.raw)
    add_raw_files(set, o.threads, out, files, stop);
  else
    add_dataset(set.dataset, set_json, files, false, stop);
  const std::vector<fs::path> written = files.targets();
  files.commit();
  std::size_t samples = 0;
  for (const Recording& r : set.dataset.recordings) samples += r.size();
  watcher.note(fmt::format("{}: {} recordings, {} samples, truth.json and truth.csv beside them",
                           (o.raw ? out : set_json).string(), set.dataset.recordings.size(), samples));
  return {written, std::move(set.dataset)};
}

WrittenScenario write_dynamics(DynamicsScenario s, const ScenarioStudy& o, Watcher& watcher) {
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
           count * kSecondsPerMotorSample + steps * kSecondsPerStep, watcher);
  const std::vector<dynamics::Sample> samples = dynamics::simulate_drive(s.setup, s.output_step_s);
  Random random(derive_seed(o.seed, {"dynamics", s.name}));
  const dynamics::SensorRun run =
      dynamics::sense(s.setup.robot, samples, s.frame, s.noise, [&random] { return random.normal(); });
  const std::string sensors = dynamics::sensor_csv(run.rows), truth = dynamics::truth_csv(run.truth),
                    states = dynamics::state_csv(s.setup.robot, samples);
  watcher.results_begin();
  FileTransaction files(existing_files(o.overwrite));
  files.add(out / "sensors.csv", sensors);
  files.add(out / "truth.csv", truth);
  files.add(out / "state.csv", states);
  files.add(out / "robot.json", robot_json(s.setup.robot));
  const std::vector<fs::path> written = files.targets();
  files.commit();
  watcher.note(fmt::format("{}: sensors.csv, truth.csv and state.csv of {} samples, robot.json", out.string(),
                           samples.size()));
  return {written, std::nullopt};
}

}  // namespace

WrittenScenario simulate_scenario(const ScenarioStudy& study, Watcher& watcher, const Stop& stop) {
  Scenario scenario = load_scenario(study.scenario);
  if (const auto* recordings = std::get_if<simulate::RecordingScenario>(&scenario))
    return write_recordings(*recordings, study, watcher, stop);
  return write_dynamics(std::get<DynamicsScenario>(std::move(scenario)), study, watcher);
}

}  // namespace odobench
