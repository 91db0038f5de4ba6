#include "bench/verbs/verify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "base/random.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/catalogue/problem_factory.hpp"
#include "bench/catalogue/scenarios.hpp"
#include "bench/console/progress.hpp"
#include "bench/console/table_output.hpp"
#include "bench/studies/context.hpp"
#include "bench/studies/parameter_sets.hpp"
#include "bench/studies/records.hpp"
#include "bench/studies/work_size.hpp"
#include "bench/verbs/common_options.hpp"
#include "problems/simulation/simulated_set.hpp"
#include "reports/kinds/verification/verification_tables.hpp"
#include "reports/statistics/statistics.hpp"

namespace odobench {
namespace {

struct VerifyOptions {
  std::string scenario;
  std::vector<std::string> parameters;  // files or names, comma lists
  int repeat = 10;
  std::uint64_t seed = 1;
  int threads = 0;
  std::optional<InstructionSet> kernel;
  std::string out;  // folder for records and tables; empty: none
  bool overwrite = false;
  std::string format = "console";
};

void add_options(CLI::App& app, VerifyOptions& o) {
  add_scenario(app, "--scenario", o.scenario);
  app.add_option("--parameters", o.parameters,
                 "JSON files, 'nominal', 'truth' or 'believed'; a comma list, may be given again")
      ->required()
      ->type_name("LIST")
      ->allow_extra_args(false);
  add_count(app, "--repeat", o.repeat, 1, 10000, "times that all drives are driven [10]");
  add_noise_options(app, o.seed, o.threads);
  add_kernel(app, o.kernel, kNamedOnly);
  add_study_folder(app, o.out, o.overwrite);
  add_format(app, o.format);
}

constexpr int kErrorDigits = 6;  // as in the thesis

// One repeat of all drives with one set.
struct VerifyOutcome {
  std::vector<RecordingError> recordings;
  std::vector<TrajectoryErrors> errors;
  Totals totals;
  // Mean distance of the true end from the reference's, m, and of the headings, rad, by trajectory.
  std::vector<std::array<double, 2>> arrival;
};

std::vector<ParameterSet> read_sets(const simulate::RecordingScenario& s, const VerifyOptions& o) {
  const ParameterNames names{robot_parameters(s.robot), simulate::known_parameters(s)};
  std::vector<ParameterSet> sets = read_parameters(names, "nominal");
  for (const std::string& source : split_sources(o.parameters))
    for (ParameterSet& set : read_parameters(names, source))
      if (set.label != "nominal" || set.values != sets.front().values)
        add_parameter_set(std::move(set), sets);
  return sets;
}

std::array<double, 2> arrival_of(const simulate::SimulatedDrive& d, const simulate::Drive& drive) {
  const simulate::Pose &start = d.logs.true_poses.front(), &end = d.logs.true_poses.back();
  const simulate::Pose wanted = drive.reference(drive.duration());
  const double c = std::cos(start.theta), s = std::sin(start.theta);
  const double x = start.x + c * wanted.x - s * wanted.y, y = start.y + s * wanted.x + c * wanted.y;
  return {std::hypot(end.x - x, end.y - y), std::abs(end.theta - start.theta - wanted.theta)};
}

VerifyOutcome drive_once(const simulate::RecordingScenario& s, const Vector& believed, std::uint64_t seed,
                         int threads, InstructionSet kernel) {
  simulate::SimulatedSet set = simulate::simulate_set(s, seed, threads);
  VerifyOutcome outcome;
  for (std::size_t t = 0; t < s.drives.size(); ++t) {
    const auto repetitions = static_cast<std::size_t>(s.repetitions);
    std::array<double, 2> mean{};
    for (std::size_t k = 0; k < repetitions; ++k) {
      const std::array<double, 2> one = arrival_of(set.drives[t * repetitions + k], s.drives[t]);
      for (std::size_t i = 0; i < 2; ++i) mean[i] += one[i] / static_cast<double>(repetitions);
    }
    outcome.arrival.push_back(mean);
  }
  const CalibrationProblem problem(robot_parameters(s.robot), std::move(set.dataset.recordings), kernel);
  std::vector<RecordingError> errors;
  for (const MaxErrors& e : problem.max_errors(believed))
    errors.push_back({e.recording, e.trajectory, e.repetition, {e.x, e.y, e.theta}});
  outcome.errors = error_statistics(errors);
  outcome.totals = error_totals(outcome.errors);
  outcome.recordings = std::move(errors);
  return outcome;
}

// Mean and half the width of its 95 % interval (Student); no interval of a single value.
struct Estimate {
  double mean = 0;
  std::optional<double> half_width;
};
Estimate estimate(const std::vector<double>& values) {
  const ErrorStatistics s = error_statistics_of(values);
  if (values.size() < 2 || std::isnan(s.mean)) return {s.mean, std::nullopt};
  const auto n = static_cast<double>(values.size());
  const boost::math::students_t distribution(n - 1);
  return {s.mean, boost::math::quantile(distribution, 0.975) * s.sigma / std::sqrt(n)};
}

using Outcomes = std::vector<std::vector<VerifyOutcome>>;  // by set and repeat
using Pick = std::function<double(const VerifyOutcome&)>;

std::vector<double> picked(const std::vector<VerifyOutcome>& outcomes, const Pick& pick) {
  std::vector<double> values;
  for (const VerifyOutcome& o : outcomes) values.push_back(pick(o));
  return values;
}

class TableMaker {
 public:
  TableMaker(const std::vector<ParameterSet>& sets, const Outcomes& outcomes)
      : sets_(sets), outcomes_(outcomes) {}

  Table start(std::string id, std::string title) const {
    Table t{
        std::move(id), std::move(title), {key("parameters")}, {}, {}, {0}};  // differences are to the first
    for (const ParameterSet& set : sets_) t.rows.push_back({text_cell(set.label)});
    return t;
  }
  // Two columns: the mean, with its difference to nominal, and its interval.
  void add(Table& t, const std::string& id, const std::string& name, const std::string& unit,
           const std::string& group, const Pick& pick) const {
    Column mean = key(id), interval = key(id + "_ci95");
    mean.align = interval.align = Align::Right;
    mean.name = name;
    interval.name = "±";
    mean.unit = interval.unit = unit;
    mean.group = interval.group = group;
    t.columns.push_back(best_if(Better::Lower, std::move(mean)));
    t.columns.push_back(std::move(interval));
    const double nominal = estimate(picked(outcomes_.front(), pick)).mean;
    for (std::size_t i = 0; i < sets_.size(); ++i) {
      const Estimate e = estimate(picked(outcomes_[i], pick));
      Cell cell = std::isnan(e.mean) ? Cell{} : fixed_cell(e.mean, kErrorDigits);
      if (i > 0 && !std::isnan(e.mean) && !std::isnan(nominal)) cell.difference = e.mean - nominal;
      cell.noise = e.half_width.value_or(std::numeric_limits<double>::infinity());
      t.rows[i].push_back(std::move(cell));
      t.rows[i].push_back(e.half_width ? fixed_cell(*e.half_width, kErrorDigits) : Cell{});
    }
  }
  // Change to nominal in %, drive against the same drive.
  void add_change(Table& t) const {
    Column mean = key("change_percent"), interval = key("change_percent_ci95");
    mean.align = interval.align = Align::Right;
    mean.name = "change";
    interval.name = "±";
    mean.unit = interval.unit = "%";
    t.columns.push_back(std::move(mean));
    t.columns.push_back(std::move(interval));
    for (std::size_t i = 0; i < sets_.size(); ++i) {
      std::vector<double> changes;
      for (std::size_t k = 0; k < outcomes_[i].size(); ++k)
        changes.push_back(100 * (outcomes_[i][k].totals.total / outcomes_[0][k].totals.total - 1));
      const Estimate e = estimate(changes);
      t.rows[i].push_back(i > 0 ? fixed_cell(e.mean, 2) : Cell{});
      t.rows[i].push_back(i > 0 && e.half_width ? fixed_cell(*e.half_width, 2) : Cell{});
    }
  }

 private:
  static Column key(const std::string& id) {
    Column c;
    c.id = c.name = id;
    c.align = Align::Left;
    return c;
  }
  const std::vector<ParameterSet>& sets_;
  const Outcomes& outcomes_;
};

constexpr std::array<const char*, 3> kUnits{"m", "m", "rad"};
constexpr std::array<const char*, 3> kShort{"x", "y", "θ"};

Table trajectory_table(const TableMaker& maker, const simulate::Drive& drive, std::size_t t) {
  Table table = maker.start("verify." + drive.name, fmt::format("New drives of trajectory {}", drive.name));
  for (std::size_t v = 0; v < 3; ++v) {
    const std::string id = kPoseVariables[v], name = kShort[v], unit = kUnits[v];
    maker.add(table, "e_max_" + id, fmt::format("e_{},max", name), unit, id,
              [t, v](const VerifyOutcome& o) { return o.errors.at(t).variables[v].max; });
    maker.add(table, "e_sr_" + id, fmt::format("e_{},sr", name), unit, id,
              [t, v](const VerifyOutcome& o) { return o.errors.at(t).variables[v].mean; });
    maker.add(table, "sigma_" + id, fmt::format("σ_{}", name), unit, id,
              [t, v](const VerifyOutcome& o) { return o.errors.at(t).variables[v].sigma; });
  }
  return table;
}

Table totals_table(const TableMaker& maker, int repeats) {
  Table table = maker.start("verify.totals", "Total error of the new drives");
  for (std::size_t v = 0; v < 3; ++v)
    maker.add(table, fmt::format("sum_e_sr_{}", kPoseVariables[v]), fmt::format("Σ e_{},sr", kShort[v]),
              kUnits[v], kPoseVariables[v], [v](const VerifyOutcome& o) { return o.totals.sums[v]; });
  maker.add(table, "total", "total", "", "total", [](const VerifyOutcome& o) { return o.totals.total; });
  maker.add_change(table);
  table.notes.push_back(
      fmt::format("Means over {} repeats of all drives, ±: half the width of their 95 % interval; in "
                  "brackets: difference to nominal. "
                  "Errors: odometry by the set against motion capture, on drives steered by the same set.",
                  repeats));
  return table;
}

Table arrival_table(const TableMaker& maker, const simulate::RecordingScenario& s) {
  Table table = maker.start("verify.arrival", "How far from the reference's end the robot really stopped");
  for (std::size_t t = 0; t < s.drives.size(); ++t) {
    const std::string& name = s.drives[t].name;
    maker.add(table, "position_" + name, name, "m", name,
              [t](const VerifyOutcome& o) { return o.arrival[t][0]; });
    maker.add(table, "heading_" + name, "heading", "rad", name,
              [t](const VerifyOutcome& o) { return o.arrival[t][1]; });
  }
  return table;
}

// One record per set: the errors of every drive of every repeat, and where the robot really ended.
std::vector<RunRecord> verification_records(const simulate::RecordingScenario& s,
                                            const std::vector<ParameterSet>& sets, const Outcomes& outcomes,
                                            const VerifyOptions& o, InstructionSet kernel) {
  const RunContext context = run_context(thread_count(o.threads), kernel);
  std::vector<RunRecord> records;
  for (std::size_t i = 0; i < sets.size(); ++i) {
    RunRecord record = study_record(kVerificationProblem, s.name, sets[i].label, robot_parameters(s.robot),
                                    sets[i].values, context);
    record.message = fmt::format("errors on {} new drives of each trajectory, steered by these parameters",
                                 o.repeat * s.repetitions);
    record.seed = record.base_seed = o.seed;
    for (std::size_t k = 0; k < outcomes[i].size(); ++k)
      for (RecordingError e : outcomes[i][k].recordings) {
        e.recording += fmt::format("#{}", k + 1);
        e.repetition += static_cast<int>(k) * s.repetitions;
        record.errors.push_back(std::move(e));
      }
    for (std::size_t t = 0; t < s.drives.size(); ++t) {
      const auto at = [&](std::size_t v) {
        return estimate(picked(outcomes[i], [&](const VerifyOutcome& one) { return one.arrival[t][v]; }))
            .mean;
      };
      const std::string& drive = s.drives[t].name;
      record.measures.put({kArrivalPosition + drive, at(0), "m", Better::None, drive});
      record.measures.put({kArrivalHeading + drive, at(1), "rad", Better::None, drive});
    }
    records.push_back(std::move(record));
  }
  return records;
}

ExitCode verify_command(const VerifyOptions& o) {
  const Format format = parse_format(o.format);
  if (!o.out.empty()) require_no_records(o.out, o.overwrite);
  const InstructionSet kernel = kernel_in_force(o.kernel);
  const simulate::RecordingScenario scenario = load_recording_scenario(o.scenario);
  if (!scenario.control.closed_loop)
    throw std::invalid_argument(fmt::format(
        "--scenario={}: it is open loop; parameters that a robot believes matter in the closed loop only",
        o.scenario));
  const std::vector<ParameterSet> sets = read_sets(scenario, o);
  std::vector<simulate::RecordingScenario> scenarios;
  for (const ParameterSet& set : sets) {
    scenarios.push_back(scenario);
    std::copy(set.values.begin(), set.values.end(), scenarios.back().control.believed.begin());
    simulate::validate(scenarios.back(), fmt::format("--parameters: set '{}'", set.label));
  }
  const double tour = simulate::most_samples(scenario);
  const WorkSize size{fmt::format("--scenario={} --repeat={}: {} sets drive {} drives {} times", o.scenario,
                                  o.repeat, sets.size(), scenario.drives.size(), scenario.repetitions),
                      tour, tour * o.repeat * static_cast<double>(sets.size())};
  require_size(size);
  announce(size, false);
  Outcomes outcomes(sets.size());
  {
    CountLine progress(true, "tours of all drives", static_cast<std::int64_t>(sets.size()) * o.repeat);
    for (std::size_t i = 0; i < sets.size(); ++i)
      for (int k = 1; k <= o.repeat; ++k) {
        outcomes[i].push_back(drive_once(scenarios[i], sets[i].values,
                                         derive_seed(o.seed, {"verify", scenario.name, std::to_string(k)}),
                                         o.threads, kernel));
        progress.add_one();
      }
  }
  const TableMaker maker(sets, outcomes);
  std::vector<Table> tables;
  for (std::size_t t = 0; t < scenario.drives.size(); ++t)
    tables.push_back(trajectory_table(maker, scenario.drives[t], t));
  tables.push_back(totals_table(maker, o.repeat));
  tables.push_back(arrival_table(maker, scenario));
  if (!o.out.empty())
    save_study(o.out, o.overwrite, verification_records(scenario, sets, outcomes, o, kernel), tables);
  print_tables(tables, format);
  return ExitCode::Success;
}

}  // namespace

VerbAction add_verify(CLI::App& app) {
  return verb_action<VerifyOptions>(app, add_options, verify_command);
}

}  // namespace odobench
