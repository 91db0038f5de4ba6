#include "bench/verbs/evaluate.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/error.hpp"
#include "base/files.hpp"
#include "base/json_node.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "bench/studies/context.hpp"
#include "bench/studies/parameter_sets.hpp"
#include "bench/studies/records.hpp"
#include "bench/studies/run_tracks.hpp"
#include "bench/studies/tracks.hpp"
#include "bench/verbs/common_options.hpp"
#include "reports/kinds/calibration/calibration_tables.hpp"
#include "solvers/options.hpp"

namespace odobench {
namespace {

struct EvaluateOptions {
  std::string data;
  std::vector<std::string> parameters;  // files or names, as typed; empty: nominal
  std::string tracks;                   // CSV file for the paths; empty: none
  std::optional<InstructionSet> kernel;
  std::string out;  // folder for records, tables and tracks; empty: none
  bool overwrite = false;
  std::string format = "console";
};

void add_options(CLI::App& app, EvaluateOptions& o) {
  app.add_option("--data", o.data, "data set [the demo set]")->type_name("SET.JSON");
  app.add_option("--parameters", o.parameters,
                 "JSON files ({\"a1\": 0.1125, ...} in metres, or an array of such), 'nominal', or names "
                 "the set knows "
                 "such as published:lm, truth; a comma list, may be given again [nominal]")
      ->type_name("LIST")
      ->allow_extra_args(false);
  app.add_option(
         "--tracks", o.tracks,
         "write the paths that the parameters give as CSV, for plots; - for standard output, without tables")
      ->type_name("FILE.CSV");
  add_kernel(app, o.kernel, kLastBits);
  app.add_option("--out", o.out, "keep records, tables and tracks in this folder")->type_name("DIR");
  app.add_flag("--overwrite", o.overwrite, "replace what --tracks or --out find there");
  add_format(app, o.format);
}

void require_finite(const RunRecord& record) {
  bool finite = record.cost && std::isfinite(*record.cost);
  for (const RecordingError& e : record.errors)
    for (const double error : e.max_error) finite = finite && std::isfinite(error);
  if (!finite)
    throw DataError(
        fmt::format("parameters '{}' on data set '{}': the cost overflows, expected values of a robot's size",
                    record.label, record.dataset));
}

ExitCode evaluate_command(const EvaluateOptions& options) {
  const Format format = parse_format(options.format);
  refuse_existing("--tracks", options.tracks, options.overwrite);
  if (!options.out.empty()) require_no_records(options.out, options.overwrite);
  const InstructionSet kernel = kernel_in_force(options.kernel);
  const LoadedProblem loaded = load_calibration(options.data, kernel);
  const std::vector<ParameterSet> sets = read_parameter_list(loaded, options.parameters);
  const RunContext context = run_context(1, kernel);
  std::vector<RunRecord> records;
  for (const ParameterSet& set : sets) {
    records.push_back(evaluation_record(loaded, set.label, set.values, context));
    require_finite(records.back());
  }
  const std::vector<Table> tables = evaluation_tables(records);
  if (!options.out.empty()) {
    InterruptGuard::remember();
    RecordFile file(options.out, options.overwrite);
    for (const RunRecord& r : records) file.append(r);
    save_run_tracks(loaded, records, options.out);
    save_tables(tables, options.out);
  }
  if (!options.tracks.empty()) {
    const std::string csv = tracks_csv(*loaded.calibration, sets);
    InterruptGuard::remember();
    write_result(options.tracks, csv, existing_files(options.overwrite));
  }
  if (options.tracks != "-") print_tables(tables, format);
  return ExitCode::Success;
}

}  // namespace

VerbAction add_evaluate(CLI::App& app) {
  return verb_action<EvaluateOptions>(app, add_options, evaluate_command);
}

}  // namespace odobench
