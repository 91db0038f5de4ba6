#include "bench/studies/fusion/tuning_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <utility>

#include "base/files.hpp"
#include "base/random.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/studies/calibration/stored_parameters.hpp"
#include "bench/studies/cells.hpp"
#include "bench/studies/context.hpp"
#include "bench/studies/fusion/fusable_recordings.hpp"
#include "bench/studies/fusion/wheel_noise.hpp"
#include "bench/studies/parameter_sets.hpp"
#include "bench/studies/records.hpp"
#include "problems/fusion/sensors_file.hpp"
#include "problems/fusion/tuning_problem.hpp"
#include "solvers/solve.hpp"

namespace odobench {
namespace {

// One setting of the sigmas: the given one, or what a solver found.
struct TunedSetting {
  std::string label;
  Vector x;  // log10 of the sigmas, in the order of the problem's parameters
  double cost = 0;
  double evaluations = 0;
  std::string stop;
  FusedRow judged;  // on recordings that the fit has not seen, where there are such
};

struct Drives {
  std::vector<Recording> recordings;
  std::vector<std::vector<SensorStream>> streams;  // of each
};
struct Split {
  Drives training, held_out;
};

// The first drive of each trajectory trains; the others judge, or the same ones where there are no others.
Split split(const std::vector<Recording>& recordings, std::vector<std::vector<SensorStream>> streams) {
  Split s;
  std::set<std::string> seen;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    Drives& part = seen.insert(recordings[i].trajectory).second ? s.training : s.held_out;
    part.recordings.push_back(recordings[i]);
    part.streams.push_back(std::move(streams[i]));
  }
  return s;
}

std::string sensors_text(const TuningStudy& study, const FusionOptions& fusion,
                         const std::vector<SensorStream>& sensors) {
  nlohmann::ordered_json root = nlohmann::ordered_json::parse(read_file(study.sensors));
  root["wheels"]["sigma_velocity"] = fusion.sigma_velocity;
  root["wheels"]["sigma_yaw_rate"] = fusion.sigma_yaw_rate;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    nlohmann::ordered_json& filter = root["sensors"][i]["filter"];
    const SensorStream& s = sensors[i];
    if (s.kind == SensorKind::YawRate) {
      filter["sigma_yaw_rate"] = s.sigma_rate;
      continue;
    }
    if (s.kind != SensorKind::Heading) filter["sigma_position"] = s.sigma_position;
    filter["sigma_heading"] = s.sigma_heading;
  }
  return root.dump(2) + "\n";
}

// A sigma that the cost does not depend on (the wheels' velocity where only headings are measured) ends
// anywhere: it goes back to the given one. Returns the names.
std::string restore_flat(const FusionTuningProblem& model, const Vector& given, double cost, Vector& x) {
  constexpr double kFlat = 1e-7;
  std::string names;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    Vector y = x;
    y[i] = given[i];
    if (y[i] == x[i] || model.cost(y) > cost * (1 + kFlat)) continue;
    x = y;
    const std::string& name = model.parameters()[static_cast<std::size_t>(i)].name;
    names += (names.empty() ? "" : ", ") + name.substr(name.find(' ') + 1);
  }
  return names;
}

FilterChoice tuned_filter(const std::string& name) {
  const std::vector<FilterChoice> list = parse_filters({name});
  if (list.size() != 1 || !list[0].filtered || list[0].smooth || list[0].literal)
    throw std::invalid_argument(fmt::format("--filter={}: expected ekf or ukf", name));
  return list[0];
}

TuningObjective objective_of(const std::string& name) {
  if (name == "likelihood") return TuningObjective::Likelihood;
  if (name == "error") return TuningObjective::Error;
  throw std::invalid_argument(fmt::format("--objective={}: expected likelihood or error", name));
}

// The sensors file with the sigmas of the setting that costs least.
std::string best_sensors(const TuningStudy& study, const FusionTuningProblem& model,
                         const SensorsFile& sensors, const std::vector<TunedSetting>& settings) {
  const auto best =
      std::min_element(settings.begin(), settings.end(),
                       [](const TunedSetting& a, const TunedSetting& b) { return a.cost < b.cost; });
  FusionOptions fusion = sensors.options;
  std::vector<SensorStream> streams;
  for (const SyntheticSensor& sensor : sensors.sensors) streams.push_back(sensor.stream);
  model.apply(best->x, fusion, streams);
  return sensors_text(study, fusion, streams);
}

// One record per setting: its cost, and how it did on the drives that judge.
std::vector<RunRecord> tuning_records(const Problem& problem, const std::vector<TunedSetting>& settings,
                                      const LoadedProblem& loaded, const TuningStudy& study,
                                      std::uint64_t seed) {
  const RunContext context = run_context(1, kernel_in_force(study.kernel));
  std::vector<RunRecord> records;
  for (const TunedSetting& s : settings) {
    RunRecord record = study_record(fmt::format("{}:{}", kTuningProblem, study.objective),
                                    loaded.dataset_name(), s.label, problem.parameters(), s.x, context);
    record.dataset_sha256 = loaded.dataset_sha256;
    record.seed = record.base_seed = seed;
    record.message = s.judged.row.verdict;
    if (!s.stop.empty()) record.termination = s.stop;
    record.cost = s.cost;
    record.evaluations = record.cost_evaluations = static_cast<std::int64_t>(s.evaluations);
    record.errors = s.judged.errors;
    record.measures = {{"rmse_position", s.judged.row.rmse_position, "m"},
                       {"rmse_heading", s.judged.row.rmse_heading, "rad"},
                       {"nees_mean", s.judged.row.mean_nees, ""}};
    records.push_back(std::move(record));
  }
  return records;
}

// The given setting, then what each solver found from there.
std::vector<TunedSetting> fitted(const Problem& problem, const FusionTuningProblem& model,
                                 const std::vector<SolverSpec>& solvers, const Catalogue& catalogue,
                                 const TuningStudy& study, std::uint64_t seed, const std::string& dataset,
                                 std::vector<std::string>& remarks, Watcher& watcher, const Stop& stop) {
  std::vector<TunedSetting> settings{{"given", problem.start(), model.cost(problem.start()), 1, "", {}}};
  for (const SolverSpec& spec : solvers) {
    SolveOptions solve_options;
    solve_options.budget.max_evaluations = study.max_evaluations;
    solve_options.seed = derive_seed(seed, {"tune", dataset, spec.text()});
    solve_options.interrupt = stop.flag();
    solve_options.solvers = &catalogue.solvers();
    const Result result = solve(problem, spec, problem.start(), solve_options);
    stop.check();
    if (!result.usable()) {
      watcher.warn(fmt::format("{}: {}", spec.text(), result.message));
      continue;
    }
    Vector x = result.x;
    const std::string flat = restore_flat(model, problem.start(), result.cost, x);
    if (!flat.empty())
      remarks.push_back(fmt::format("{}: the cost does not depend on {}, kept as given.", spec.text(), flat));
    const auto evaluations = static_cast<double>(result.counts.total());
    settings.push_back({spec.text(), x, result.cost, evaluations, to_string(result.termination), {}});
  }
  return settings;
}

}  // namespace

Tuning tune_filter(const TuningStudy& study, const Catalogue& catalogue, Watcher& watcher, const Stop& stop) {
  const FilterChoice filter = tuned_filter(study.filter);
  const TuningObjective objective = objective_of(study.objective);
  std::vector<std::string> notes;
  const std::vector<SolverSpec> solvers = resolve_solvers(
      catalogue, study.solvers.empty() ? std::vector<std::string>{"nlopt:bobyqa"} : study.solvers, notes);
  SensorsFile sensors = read_sensors(study.sensors);
  sensors.options.filter.kind = filter.kind;
  const LoadedProblem loaded = load_calibration(study.data, kernel_in_force(study.kernel));
  const FusableRecordings fusable = fusable_recordings(loaded);
  std::vector<ParameterSet> sets = read_judged_parameters(loaded, {study.parameters}, watcher);
  // Beside a folder's row stand the nominal parameters, which nobody asked for here.
  if (sets.size() == 2 && sets.front().label == "nominal" && study.parameters.find(',') == std::string::npos)
    sets.erase(sets.begin());
  if (sets.size() != 1)
    throw std::invalid_argument(
        fmt::format("--parameters={}: {} parameter sets, expected one", study.parameters, sets.size()));
  const std::uint64_t seed = study.seed.value_or(sensors.seed);
  // Where the file does not say it, what the drives show of the wheels is where tuning begins.
  if (!sensors.wheels)
    notes.push_back(
        believe_wheels(wheel_noise_choice("", sensors), loaded, sets[0].values, sets[0].label, sensors));
  require_measurements(sensors, fusable.recordings);
  auto streams = all_streams(sensors, fusable.recordings, seed, 0, stop);
  shift_streams(fusable, sensors, streams);
  const Split s = split(fusable.recordings, std::move(streams));
  const Drives& judge = s.held_out.recordings.empty() ? s.training : s.held_out;
  for (const std::string& text : notes) watcher.note(text);
  const auto model = std::make_shared<const FusionTuningProblem>(
      std::make_shared<const std::vector<Recording>>(s.training.recordings), sets[0].values,
      s.training.streams, sensors.options, objective);
  const Problem problem(model);

  Tuning tuning;
  tuning.circumstances = {{}, s.training.recordings.size(), s.held_out.recordings.size()};
  std::vector<TunedSetting> settings =
      fitted(problem, *model, solvers, catalogue, study, seed, loaded.dataset_name(),
             tuning.circumstances.remarks, watcher, stop);
  for (TunedSetting& setting : settings) {
    SensorsFile changed = sensors;
    std::vector<std::vector<SensorStream>> tuned = judge.streams;
    for (std::vector<SensorStream>& one : tuned) model->apply(setting.x, changed.options, one);
    setting.judged = fuse_all(judge.recordings, sets[0].values, filter, changed, tuned, 0, stop);
  }
  tuning.sensors =
      sensor_table(sensors, seed, loaded.dataset_name(),
                   {fmt::format("Wheels in the filter: σ {:g} m/s and {:g} rad/s of a sample.",
                                sensors.options.sigma_velocity, sensors.options.sigma_yaw_rate)});
  tuning.best_sensors = best_sensors(study, *model, sensors, settings);
  tuning.records = tuning_records(problem, settings, loaded, study, seed);
  return tuning;
}

}  // namespace odobench
