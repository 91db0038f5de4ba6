#include "bench/studies/fusion/fusion_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "bench/catalogue/option_values.hpp"
#include "bench/studies/calibration/stored_parameters.hpp"
#include "bench/studies/context.hpp"
#include "bench/studies/fusion/fusable_recordings.hpp"
#include "bench/studies/fusion/fusion_remarks.hpp"
#include "bench/studies/fusion/fusion_runs.hpp"
#include "bench/studies/fusion/wheel_noise.hpp"
#include "bench/studies/inspection/inspection_study.hpp"
#include "bench/studies/parameter_sets.hpp"
#include "bench/studies/run_tracks.hpp"
#include "bench/studies/work_size.hpp"
#include "reports/kinds/fusion/fusion_record.hpp"

namespace odobench {
namespace {

// Title, description and sensors of the table, in words.
std::vector<std::string> sensor_notes(const Table& table) {
  std::vector<std::string> notes{table.title};
  for (const std::vector<Cell>& row : table.rows) {
    std::string text = row.front().text + ": ";
    for (std::size_t c = 1; c < row.size(); ++c)
      text += fmt::format("{}{} {}", c > 1 ? "; " : "", table.columns[c].name, row[c].text);
    notes.push_back(text);
  }
  notes.insert(notes.end(), table.notes.begin(), table.notes.end());
  return notes;
}

// What all records of a study have in common.
RunRecord common_record(const LoadedProblem& loaded, std::uint64_t seed, const Table& sensors,
                        const RunContext& context) {
  RunRecord record;
  record.dataset = loaded.dataset_name();
  record.dataset_sha256 = loaded.dataset_sha256;
  record.seed = record.base_seed = seed;
  record.termination = "evaluated";
  record.notes = sensor_notes(sensors);
  record.context = context;
  return record;
}

const FusionRow* row_of_wheels(const std::vector<FusionRow>& rows, const std::string& label) {
  for (const FusionRow& row : rows)
    if (!row.filtered && row.label == label) return &row;
  return nullptr;
}

}  // namespace

FusionRuns fuse_recordings(const FusionStudy& study, Watcher& watcher, const Stop& stop) {
  const std::vector<FilterChoice> filters = parse_filters(study.filters);
  const SensorsFile sensors = read_sensors(study.sensors);
  const InstructionSet kernel = kernel_in_force(study.kernel);
  const LoadedProblem loaded = load_calibration(study.data, kernel);
  const FusableRecordings fusable = fusable_recordings(loaded);
  const std::vector<std::string> findings = say_findings(loaded, {}, false, study.threads, watcher);
  const std::vector<ParameterSet> sets = read_judged_parameters(loaded, study.parameters, watcher);
  const std::vector<Recording>& recordings = fusable.recordings;
  const std::uint64_t seed = study.seed.value_or(sensors.seed);
  const double measurements = require_measurements(sensors, recordings);
  const auto times = static_cast<double>(filters.size() * sets.size());
  announce(
      fmt::format("--sensors={}: {:.2g} measurements, filtered {} times", study.sensors, measurements, times),
      measurements * times * kSecondsPerMeasurement, watcher);

  const WheelNoiseChoice choice = wheel_noise_choice(study.odometry_noise, sensors);
  std::vector<SensorsFile> believed(sets.size(), sensors);
  std::vector<std::string> wheels;
  for (std::size_t k = 0; k < sets.size(); ++k) {
    std::string text = believe_wheels(choice, loaded, sets[k].values, sets[k].label, believed[k]);
    if (std::find(wheels.begin(), wheels.end(), text) == wheels.end()) wheels.push_back(std::move(text));
  }
  auto streams = all_streams(sensors, recordings, seed, study.threads, stop);
  shift_streams(fusable, sensors, streams);
  FusionRuns runs;
  runs.tracks = reference_tracks(kFusionProblem, loaded);
  runs.sensors = sensor_table(sensors, seed, loaded.dataset_name(), wheels);
  const RunRecord common =
      common_record(loaded, seed, runs.sensors, run_context(thread_count(study.threads), kernel));
  for (const FilterChoice& filter : filters)
    for (std::size_t k = 0; k < sets.size(); ++k) {
      const ParameterSet& set = sets[k];
      FusedRow fused = fuse_all(recordings, set.values, filter, believed[k], streams, study.threads, stop);
      fused.row.label = filter.filtered ? set.label + "+" + filter.name : set.label;
      RunRecord record = common;
      for (const std::string& text :
           fusion_remarks(believed[k], fused.row, row_of_wheels(runs.rows, set.label))) {
        record.notes.push_back(fused.row.label + ": " + text);
        watcher.warn(record.notes.back());
      }
      put_fusion_row(fused.row, record);
      record.errors = std::move(fused.errors);
      record.time_utc = utc_now();
      if (runs.records.empty()) record.notes.insert(record.notes.end(), findings.begin(), findings.end());
      runs.records.push_back(std::move(record));
      if (study.keep_tracks) runs.tracks.tracks.push_back({fused.row.label, 1, std::move(fused.track)});
      runs.rows.push_back(std::move(fused.row));
    }
  return runs;
}

}  // namespace odobench
