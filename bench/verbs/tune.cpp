#include "bench/verbs/tune.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "base/files.hpp"
#include "bench/catalogue/number_text.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/console/interrupt.hpp"
#include "bench/console/table_output.hpp"
#include "bench/studies/cells.hpp"
#include "bench/studies/context.hpp"
#include "bench/studies/fusion_runs.hpp"
#include "bench/studies/parameter_sets.hpp"
#include "bench/studies/records.hpp"
#include "bench/verbs/common_options.hpp"
#include "problems/fusion/sensors_file.hpp"
#include "problems/fusion/tuning_problem.hpp"
#include "solvers/solve.hpp"

namespace odobench {
namespace {

struct TuneOptions {
  std::string data;  // empty: the demo set
  std::string parameters = "nominal";
  std::string sensors;               // file
  std::vector<std::string> solvers;  // comma lists; empty: nlopt:bobyqa
  std::string filter = "ekf";
  std::string objective = "likelihood";
  std::int64_t max_evaluations = 200;
  std::optional<std::uint64_t> seed;
  std::optional<InstructionSet> kernel;
  std::string out;      // sensors file to write; empty: none
  std::string records;  // folder for records and tables; empty: none
  bool overwrite = false;
  std::string format = "console";
};

void add_options(CLI::App& app, TuneOptions& o) {
  app.add_option("--data", o.data, "data set [the demo set]")->type_name("SET.JSON");
  app.add_option("--parameters", o.parameters, "parameter set of the wheels [nominal]")
      ->type_name("NAME|FILE");
  app.add_option("--sensors", o.sensors, "JSON file as of 'bench fuse'; its sigmas are the start")
      ->required()
      ->type_name("FILE");
  app.add_option("--solver", o.solvers, "solvers as of 'bench run' [nlopt:bobyqa]")
      ->type_name("LIST")
      ->allow_extra_args(false);
  app.add_option("--filter", o.filter, "ekf or ukf [ekf]")->type_name("NAME");
  app.add_option("--objective", o.objective,
                 "likelihood (of the innovations) or error (of the pose against the reference) [likelihood]")
      ->type_name("NAME");
  app.add_option_function<std::string>(
         "--max-evals",
         [&o](const std::string& text) { o.max_evaluations = whole_number("--max-evals", text, 1); },
         "evaluations of a run at most [200]")
      ->type_name("N");
  app.add_option_function<std::string>(
         "--seed", [&o](const std::string& text) { o.seed = seed_number("--seed", text); },
         "of the synthetic sensors and the solvers [that of the file]")
      ->type_name("N");
  add_kernel(app, o.kernel, kNamedOnly);
  app.add_option("--out", o.out, "write the sensors file with the best sigmas")->type_name("FILE");
  app.add_option("--records", o.records, "folder for records (runs.jsonl) and tables.*")->type_name("DIR");
  app.add_flag("--overwrite", o.overwrite, "replace what --out and --records find there");
  add_format(app, o.format);
}

struct Split {
  std::vector<Recording> training, held_out;
};

// The first drive of each trajectory trains; the others judge, or the same ones where there are no others.
Split split(const std::vector<Recording>& recordings) {
  Split s;
  std::set<std::string> seen;
  for (const Recording& r : recordings)
    (seen.insert(r.trajectory).second ? s.training : s.held_out).push_back(r);
  return s;
}

// One setting of the sigmas: the given one, or what a solver found.
struct Setting {
  std::string label;
  Vector x;
  double cost = 0;
  double evaluations = 0;
  std::string stop;
  FusedRow held_out;
};

Table sigma_table(const Problem& problem, const std::vector<Setting>& settings,
                  const std::vector<std::string>& remarks) {
  Table table{"sigmas", "Standard deviations that the filter believes", {text_column("parameter")}, {}, {}};
  for (const Setting& s : settings) table.columns.push_back(number_column(s.label, s.label));
  for (Eigen::Index i = 0; i < problem.dimension(); ++i) {
    const std::string& name = problem.parameters()[static_cast<std::size_t>(i)].name;
    table.rows.push_back({text_cell(name.substr(name.find(' ') + 1))});
    for (const Setting& s : settings)
      table.rows.back().push_back(significant_cell(std::pow(10.0, s.x[i]), 4));
  }
  table.notes.push_back("Position in m, heading in rad, velocity in m/s, yaw rate in rad/s.");
  table.notes.insert(table.notes.end(), remarks.begin(), remarks.end());
  return table;
}

Table result_table(const std::vector<Setting>& settings, const Split& s, const std::string& objective) {
  Table table{
      "tuning",
      fmt::format("Tuning by {} on {} recordings, judged on {}{}", objective, s.training.size(),
                  s.held_out.empty() ? s.training.size() : s.held_out.size(),
                  s.held_out.empty() ? " (the same ones: there are no others)" : " others"),
      {text_column("setting"), best_if(Better::Lower, number_column("cost")), number_column("evaluations"),
       best_if(Better::Lower, number_column("rmse_position", "RMSE position", "m")),
       best_if(Better::Lower, number_column("rmse_heading", "RMSE heading", "rad")),
       number_column("nees", "NEES"), text_column("verdict"), text_column("stop")},
      {},
      {}};
  for (const Setting& one : settings)
    table.rows.push_back({text_cell(one.label), significant_cell(one.cost, 8), count_cell(one.evaluations),
                          fixed_cell(one.held_out.row.rmse_position, 6),
                          fixed_cell(one.held_out.row.rmse_heading, 6),
                          fixed_cell(one.held_out.row.mean_nees, 2), text_cell(one.held_out.row.verdict),
                          text_cell(one.stop)});
  if (objective == "likelihood")
    table.notes.push_back(
        "The likelihood sees the innovations only: sensors that drift make it prefer sigmas that follow "
        "them. Compare "
        "NEES.");
  return table;
}

void write_sensors(const TuneOptions& options, const FusionOptions& fusion,
                   const std::vector<SensorStream>& sensors) {
  nlohmann::ordered_json root = nlohmann::ordered_json::parse(read_file(options.sensors));
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
  InterruptGuard::remember();
  write_file(options.out, root.dump(2) + "\n", existing_files(options.overwrite));
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
void write_best(const TuneOptions& options, const FusionTuningProblem& model, const SensorsFile& sensors,
                const std::vector<Setting>& settings) {
  const auto best = std::min_element(settings.begin(), settings.end(),
                                     [](const Setting& a, const Setting& b) { return a.cost < b.cost; });
  FusionOptions fusion = sensors.options;
  std::vector<SensorStream> streams;
  for (const SyntheticSensor& sensor : sensors.sensors) streams.push_back(sensor.stream);
  model.apply(best->x, fusion, streams);
  write_sensors(options, fusion, streams);
}

// One record per setting: its cost, and how it did on the drives that judge.
std::vector<RunRecord> tuning_records(const Problem& problem, const std::vector<Setting>& settings,
                                      const LoadedProblem& loaded, const TuneOptions& options,
                                      std::uint64_t seed) {
  const RunContext context = run_context(1, kernel_in_force(options.kernel));
  std::vector<RunRecord> records;
  for (const Setting& s : settings) {
    RunRecord record = study_record("tuning:" + options.objective, loaded.dataset_name(), s.label,
                                    problem.parameters(), s.x, context);
    record.dataset_sha256 = loaded.dataset_sha256;
    record.seed = record.base_seed = seed;
    record.message = s.held_out.row.verdict;
    if (!s.stop.empty()) record.termination = s.stop;
    record.cost = s.cost;
    record.evaluations = record.cost_evaluations = static_cast<std::int64_t>(s.evaluations);
    record.errors = s.held_out.errors;
    record.measures = {{"rmse_position", s.held_out.row.rmse_position, "m"},
                       {"rmse_heading", s.held_out.row.rmse_heading, "rad"},
                       {"nees_mean", s.held_out.row.mean_nees, ""}};
    records.push_back(std::move(record));
  }
  return records;
}

// The given setting, then what each solver found from there.
std::vector<Setting> fitted(const Problem& problem, const FusionTuningProblem& model,
                            const std::vector<SolverSpec>& solvers, const TuneOptions& options,
                            std::uint64_t seed, const std::string& dataset,
                            std::vector<std::string>& remarks) {
  std::vector<Setting> settings{{"given", problem.start(), model.cost(problem.start()), 1, "", {}}};
  for (const SolverSpec& spec : solvers) {
    SolveOptions solve_options;
    solve_options.budget.max_evaluations = options.max_evaluations;
    solve_options.seed = derive_seed(seed, {"tune", dataset, spec.text()});
    const Result result = solve(problem, spec, problem.start(), solve_options);
    if (!result.usable()) {
      warn(fmt::format("{}: {}", spec.text(), result.message));
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

ExitCode tune_command(const TuneOptions& options) {
  const Format format = parse_format(options.format);
  const FilterChoice filter = tuned_filter(options.filter);
  const TuningObjective objective = objective_of(options.objective);
  std::vector<std::string> notes;
  const std::vector<SolverSpec> solvers = resolve_solvers(
      options.solvers.empty() ? std::vector<std::string>{"nlopt:bobyqa"} : options.solvers, notes);
  refuse_existing("--out", options.out, options.overwrite);
  if (!options.records.empty()) require_no_records(options.records, options.overwrite, "--records");
  SensorsFile sensors = read_sensors(options.sensors);
  sensors.options.filter.kind = filter.kind;
  const LoadedProblem loaded = load_calibration(options.data, kernel_in_force(options.kernel));
  const std::vector<ParameterSet> sets = read_parameter_list(loaded, {options.parameters});
  if (sets.size() != 1)
    throw std::invalid_argument(
        fmt::format("--parameters={}: {} parameter sets, expected one", options.parameters, sets.size()));
  const std::uint64_t seed = options.seed.value_or(sensors.seed);
  const Split s = split(loaded.calibration->recordings());
  const std::vector<Recording>& judge = s.held_out.empty() ? s.training : s.held_out;
  const auto judge_streams = all_streams(sensors, judge, seed, 0);
  const auto model = std::make_shared<const FusionTuningProblem>(
      std::make_shared<const std::vector<Recording>>(s.training), sets[0].values,
      all_streams(sensors, s.training, seed, 0), sensors.options, objective);
  const Problem problem(model);

  const auto judged = [&](const Vector& x) {
    SensorsFile changed = sensors;
    std::vector<std::vector<SensorStream>> streams = judge_streams;
    for (std::vector<SensorStream>& one : streams) model->apply(x, changed.options, one);
    return fuse_all(judge, sets[0].values, filter, changed, streams, 0);
  };
  std::vector<std::string> remarks;
  std::vector<Setting> settings =
      fitted(problem, *model, solvers, options, seed, loaded.dataset_name(), remarks);
  for (Setting& setting : settings) setting.held_out = judged(setting.x);
  if (settings.size() == 1) {
    warn("not one solver gave a result");
    return ExitCode::CheckFailed;
  }
  if (!options.out.empty()) write_best(options, *model, sensors, settings);
  const std::vector<Table> tables{sensor_table(sensors, seed, loaded.dataset_name()),
                                  sigma_table(problem, settings, remarks),
                                  result_table(settings, s, options.objective)};
  if (!options.records.empty())
    save_study(options.records, options.overwrite, tuning_records(problem, settings, loaded, options, seed),
               tables, "--records");
  print_tables(tables, format);
  return ExitCode::Success;
}

}  // namespace

VerbAction add_tune(CLI::App& app) {
  return verb_action<TuneOptions>(app, add_options, tune_command);
}

}  // namespace odobench
