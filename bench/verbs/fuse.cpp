#include "bench/verbs/fuse.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "bench/catalogue/number_text.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "bench/studies/context.hpp"
#include "bench/studies/fusion_runs.hpp"
#include "bench/studies/parameter_sets.hpp"
#include "bench/studies/records.hpp"
#include "bench/studies/run_tracks.hpp"
#include "bench/studies/work_size.hpp"
#include "bench/verbs/common_options.hpp"
#include "reports/kinds/fusion/fusion_record.hpp"

namespace odobench {
namespace {

struct FuseOptions {
  std::string data;                     // empty: the demo set
  std::vector<std::string> parameters;  // as of `bench evaluate`
  std::vector<std::string> filters;     // comma lists; empty: none,ekf,ukf
  std::string sensors;                  // file
  std::optional<std::uint64_t> seed;    // instead of the file's
  int threads = 0;                      // 0: one per core
  std::optional<InstructionSet> kernel;
  std::string out;  // folder for records, tables and tracks; empty: none
  bool overwrite = false;
  std::string format = "console";
};

void add_options(CLI::App& app, FuseOptions& o) {
  app.add_option("--data", o.data, "data set [the demo set]")->type_name("SET.JSON");
  app.add_option("--parameters", o.parameters, "parameter sets as of 'bench evaluate' [nominal]")
      ->type_name("LIST")
      ->allow_extra_args(false);
  app.add_option("--filter", o.filters,
                 "none, ekf, ukf, ekf-smoothed, ukf-smoothed, ekf-literal; a comma list [none,ekf,ukf]")
      ->type_name("LIST")
      ->allow_extra_args(false);
  app.add_option("--sensors", o.sensors, "JSON file: the sensors, their errors, what the filter believes")
      ->required()
      ->type_name("FILE");
  app.add_option_function<std::string>(
         "--seed", [&o](const std::string& text) { o.seed = seed_number("--seed", text); },
         "of the synthetic sensors [that of the file]")
      ->type_name("N");
  add_threads(app, o.threads);
  add_kernel(app, o.kernel, kNamedOnly);
  app.add_option("--out", o.out, "keep records, tables and tracks in this folder")->type_name("DIR");
  app.add_flag("--overwrite", o.overwrite, "replace runs that the folder holds");
  add_format(app, o.format);
}

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

void save_fusion(const FuseOptions& options, const std::vector<RunRecord>& records, const TrackSet& tracks,
                 const std::vector<Table>& tables) {
  InterruptGuard::remember();
  RecordFile file(options.out, options.overwrite);
  for (const RunRecord& record : records) file.append(record);
  save_tracks(tracks, options.out);
  save_tables(tables, options.out);
}

ExitCode fuse_command(const FuseOptions& options) {
  const Format format = parse_format(options.format);
  const std::vector<FilterChoice> filters = parse_filters(options.filters);
  const SensorsFile sensors = read_sensors(options.sensors);
  const InstructionSet kernel = kernel_in_force(options.kernel);
  const LoadedProblem loaded = load_calibration(options.data, kernel);
  const std::vector<ParameterSet> sets = read_parameter_list(loaded, options.parameters);
  if (!options.out.empty()) require_no_records(options.out, options.overwrite);
  const std::uint64_t seed = options.seed.value_or(sensors.seed);
  const std::vector<Recording>& recordings = loaded.calibration->recordings();
  const double measurements = require_measurements(sensors, recordings);
  const auto runs = static_cast<double>(filters.size() * sets.size());
  announce(fmt::format("--sensors={}: {:.2g} measurements, filtered {} times", options.sensors, measurements,
                       runs),
           measurements * runs * kSecondsPerMeasurement, false);
  const std::vector<std::vector<SensorStream>> streams =
      all_streams(sensors, recordings, seed, options.threads);
  const Table about = sensor_table(sensors, seed, loaded.dataset_name());
  const RunContext context = run_context(thread_count(options.threads), kernel);
  std::vector<RunRecord> records;
  std::vector<FusionRow> rows;
  TrackSet tracks = reference_tracks(kFusionProblem, loaded);
  for (const FilterChoice& filter : filters)
    for (const ParameterSet& set : sets) {
      FusedRow fused = fuse_all(recordings, set.values, filter, sensors, streams, options.threads);
      fused.row.label = filter.filtered ? set.label + "+" + filter.name : set.label;
      RunRecord record;
      put_fusion_row(fused.row, record);
      record.dataset = loaded.dataset_name();
      record.dataset_sha256 = loaded.dataset_sha256;
      record.seed = record.base_seed = seed;
      record.termination = "evaluated";
      record.errors = std::move(fused.errors);
      record.notes = sensor_notes(about);
      record.context = context;
      record.time_utc = utc_now();
      records.push_back(std::move(record));
      if (!options.out.empty()) tracks.tracks.push_back({fused.row.label, 1, std::move(fused.track)});
      rows.push_back(std::move(fused.row));
    }
  const std::vector<Table> tables = fusion_tables(&about, records, rows);
  if (!options.out.empty()) save_fusion(options, records, tracks, tables);
  print_tables(tables, format);
  return ExitCode::Success;
}

}  // namespace

VerbAction add_fuse(CLI::App& app) {
  return verb_action<FuseOptions>(app, add_options, fuse_command);
}

}  // namespace odobench
