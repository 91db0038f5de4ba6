#include "bench/verbs/verbs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "base/names.hpp"
#include "bench/catalogue/locations.hpp"
#include "bench/console/table_output.hpp"
#include "bench/options/common_options.hpp"
#include "bench/studies/scenario_tables.hpp"
#include "bench/verbs/suite_tables.hpp"
#include "datasets/dataset.hpp"
#include "datasets/robots/layouts.hpp"
#include "problems/robots/wheeled_robot.hpp"
#include "solvers/options.hpp"

namespace odobench {
namespace {

struct ListOptions {
  std::string what;  // solvers | problems | suites | robots | data | scenarios
  std::string data;  // with `data`, `scenarios`: the one to describe; empty: known places
  std::string format = "console";
};

void add_options(CLI::App& app, ListOptions& o) {
  app.add_option("what", o.what, "solvers, problems, suites, robots, data or scenarios")->required();
  app.add_option("set", o.data, "with data or scenarios: the one to describe [known places]");
  add_format(app, o.format);
}

std::vector<Table> solver_tables(const Catalogue& catalogue) {
  Table solvers{
      "solvers", "Solvers", {text_column("solver"), text_column("kind"), text_column("summary")}, {}, {}};
  Table options{"options",
                "Options, as in --solver=NAME[option=value,...]",
                {text_column("solver"), text_column("option"), text_column("default"), text_column("allowed"),
                 text_column("help")},
                {},
                {}};
  for (const SolverEntry& entry : catalogue.solvers().entries()) {
    solvers.rows.push_back({text_cell(entry.name),
                            text_cell(entry.stochastic ? "stochastic" : "deterministic"),
                            text_cell(entry.summary)});
    for (const OptionDescription& o : entry.options())
      options.rows.push_back({text_cell(entry.name), text_cell(o.name), text_cell(o.value),
                              text_cell(o.allowed), text_cell(o.help)});
  }
  return {solvers, options};
}

Table problem_table(const std::string& id, const std::string& title, const std::string& note) {
  return {id,
          title,
          {text_column("problem"), number_column("dimension", "usual dimension"), text_column("dimensions"),
           number_column("residuals"), text_column("derivatives"), text_column("optimum", "lowest known J"),
           text_column("source")},
          {},
          {note}};
}

std::string derivatives_of(const ProblemEntry& entry) {
  if (!entry.derivatives.empty()) return entry.derivatives;
  const Problem problem = entry.make({}).problem;
  return problem.has_residuals() ? "residuals, Jacobian" : problem.has_gradient() ? "gradient" : "none";
}

std::vector<Cell> problem_row(const ProblemEntry& entry) {
  const ClassicEntry& about = entry.about;
  return {
      text_cell(about.name),
      count_cell(about.dimension),
      text_cell(about.dimensions.text()),
      about.residuals > 0 ? count_cell(about.residuals) : Cell{},
      text_cell(derivatives_of(entry)),
      entry.takes_data ? Cell{} : text_cell(about.best_cost ? fmt::format("{:.10g}", *about.best_cost) : ""),
      entry.takes_data ? Cell{} : text_cell(about.source)};
}

// One table per family: those with a title and a note of their own, then others as they come.
std::vector<Table> problem_tables(const Catalogue& catalogue) {
  std::vector<Table> tables{
      problem_table("problems.calibration", "Calibration, as in --data=set.json",
                    "Parameters, box and recordings come from the set."),
      problem_table("problems.classic", "Test functions, as in --problem=NAME --dimension=N",
                    "Many at once: --problem=rosenbrock,powell or --problem='*'."),
      problem_table("problems.nist", "Certified regression problems (NIST StRD): nist:NAME/START",
                    "All of them: --problem='nist:*'."),
      problem_table("problems.mgh", "More, Garbow, Hillstrom (1981): mgh:NAME, mgh:NAME/10, mgh:NAME/100",
                    "All of them: --problem='mgh:*'; from the standard starts only: 'mgh:*[!0]'."),
      problem_table("problems.bbob", "BBOB (2009): bbob:f1 to bbob:f24, as in bbob:f1[n=5,instance=3]",
                    "Fifteen instances of all of them: --problem='bbob:*[n=5,instance=1..15]'."),
      problem_table("problems.mw", "More, Wild (2009): mw:NAME, mw:NAME/10",
                    "All of them: --problem='mw:*'."),
      problem_table("problems.robots",
                    "Calibrations of simulated robots, as in robots:differential[instance=3]",
                    "All of them: --problem='robots:*'.")};
  for (const ProblemEntry& entry : catalogue.problems()) {
    const std::string id = "problems." + entry.about.family;
    auto table = std::find_if(tables.begin(), tables.end(), [&](const Table& t) { return t.id == id; });
    if (table == tables.end())
      table = tables.insert(table, problem_table(id, "Problems of the family " + entry.about.family,
                                                 "As in --problem=NAME --dimension=N."));
    table->rows.push_back(problem_row(entry));
  }
  return tables;
}

// The classes, their parameters, and what no data can tell of them.
std::vector<Table> robot_tables() {
  Table classes{"robots",
                "Classes of robots, as in \"kinematics\" of a set.json and in bench demo --robot=CLASS",
                {text_column("class"), text_column("description"), number_column("parameters"),
                 text_column("signals"), text_column("integration"), text_column("twist")},
                {},
                {"Any other robot is a table of wheels of its own: docs/robots.md."}};
  Table parameters{"robots.parameters",
                   "Their parameters",
                   {text_column("class"), text_column("parameter"), text_column("unit"),
                    number_column("nominal"), number_column("lower"), number_column("upper")},
                   {},
                   {}};
  Table blind{
      "robots.blind", "What data cannot tell", {text_column("class"), text_column("combination")}, {}, {}};
  for (const robots::Layout& layout : robots::layouts()) {
    const robots::WheeledRobot robot(robots::make_robot(layout));
    classes.rows.push_back(
        {text_cell(layout.name), text_cell(layout.description),
         count_cell(static_cast<double>(robot.parameters().size())),
         text_cell(fmt::format("{}", fmt::join(robot.signals(), ", "))),
         text_cell(std::string(robots::name_of(layout.rule))),
         text_cell(std::string(kTwistRuleNames[static_cast<std::size_t>(robot.table().rule)]))});
    for (const RobotParameter& p : robot.parameters())
      parameters.rows.push_back({text_cell(layout.name), text_cell(p.name), text_cell(p.unit),
                                 significant_cell(p.nominal, 5), significant_cell(p.lower, 5),
                                 significant_cell(p.upper, 5)});
    for (const std::string& text : layout.blind)
      blind.rows.push_back({text_cell(layout.name), text_cell(text)});
  }
  return {classes, parameters, blind};
}

std::vector<Table> known_data_tables() {
  Table table{"data",
              "Known data sets",
              {text_column("name"), text_column("file")},
              {},
              {"'bench list data FILE' describes a set; 'bench import vitko2024 --from=DIR --out=set.json' "
               "makes one of raw files."}};
  for (const auto& [name, path] : known_sets())
    table.rows.push_back({text_cell(name), text_cell(path.string())});
  return {table};
}

double seconds_of(const Recording& r) {
  return r.size() < 2 ? 0.0 : static_cast<double>(r.time_us.back() - r.time_us.front()) * 1e-6;
}

Table overview_table(const Dataset& set, const std::string& path) {
  Table table{
      "set", fmt::format("Data set {}", set.name), {text_column("item"), text_column("value")}, {}, {}};
  const auto row = [&](const char* item, const std::string& value) {
    if (!value.empty()) table.rows.push_back({text_cell(item), text_cell(value)});
  };
  std::size_t samples = 0;
  double seconds = 0;
  for (const Recording& r : set.recordings) {
    samples += r.size();
    seconds += seconds_of(r);
  }
  row("file", path);
  row("description", set.description);
  row("robot", set.robot.name);
  row("kinematics", set.robot.kinematics);
  row("recordings", fmt::format("{} of {} trajectories, {} samples, {:.1f} s", set.recordings.size(),
                                set.trajectories.size(), samples, seconds));
  row("source", set.provenance.source);
  row("licence", set.provenance.licence);
  row("made by", set.provenance.made_by);
  if (!set.provenance.files.empty())
    row("source files", fmt::format("{}, each with its SHA-256 in the set", set.provenance.files.size()));
  table.notes = set.notes;
  return table;
}

Table parameter_table(const Dataset& set) {
  Table table{"parameters",
              "Robot parameters",
              {text_column("parameter"), text_column("unit"), number_column("nominal"),
               number_column("lower"), number_column("upper")},
              {},
              {}};
  for (std::size_t k = 0; k < set.known_parameters.size(); ++k) {
    const NamedParameters& known = set.known_parameters[k];
    table.columns.push_back(number_column(fmt::format("known_{}", k + 1), known.name));
    if (!known.description.empty())
      table.notes.push_back(fmt::format("{}: {}", known.name, known.description));
  }
  for (std::size_t i = 0; i < set.robot.parameters.size(); ++i) {
    const RobotParameter& p = set.robot.parameters[i];
    table.rows.push_back({text_cell(p.name), text_cell(p.unit), significant_cell(p.nominal, 7),
                          significant_cell(p.lower, 7), significant_cell(p.upper, 7)});
    for (const NamedParameters& known : set.known_parameters)
      table.rows.back().push_back(significant_cell(known.values.at(i), 7));
  }
  return table;
}

std::vector<Table> set_tables(const std::string& path) {
  const Dataset set = load_dataset(path);
  Table trajectories{"trajectories",
                     "Trajectories",
                     {text_column("trajectory"), text_column("description"), number_column("recordings"),
                      number_column("samples"), number_column("duration", "duration", "s")},
                     {},
                     {}};
  for (const Trajectory& t : set.trajectories) {
    double count = 0, samples = 0, seconds = 0;
    for (const Recording& r : set.recordings) {
      if (r.trajectory != t.name) continue;
      count += 1;
      samples += static_cast<double>(r.size());
      seconds += seconds_of(r);
    }
    trajectories.rows.push_back({text_cell(t.name), text_cell(t.description), count_cell(count),
                                 count_cell(samples), fixed_cell(seconds, 3)});
  }
  Table recordings{"recordings",
                   "Recordings",
                   {text_column("recording"), text_column("trajectory"), number_column("repetition"),
                    number_column("samples"), number_column("duration", "duration", "s")},
                   {},
                   {}};
  for (const Recording& r : set.recordings)
    recordings.rows.push_back({text_cell(r.id), text_cell(r.trajectory), count_cell(r.repetition),
                               count_cell(static_cast<double>(r.size())), fixed_cell(seconds_of(r), 3)});
  return {overview_table(set, path), parameter_table(set), trajectories, recordings};
}

ExitCode list_command(const ListOptions& options, const Catalogue& catalogue) {
  const Format format = parse_format(options.format);
  const std::vector<std::string> known = {"solvers", "problems", "suites", "robots", "data", "scenarios"};
  if (!options.data.empty() && options.what != "data" && options.what != "scenarios")
    throw std::invalid_argument(
        fmt::format("bench list {}: '{}' is not expected here", options.what, options.data));
  if (options.what == "solvers") {
    print_tables(solver_tables(catalogue), format);
  } else if (options.what == "problems") {
    print_tables(problem_tables(catalogue), format);
  } else if (options.what == "suites") {
    print_tables(suite_tables(catalogue), format);
  } else if (options.what == "data") {
    print_tables(options.data.empty() ? known_data_tables() : set_tables(options.data), format);
  } else if (options.what == "robots") {
    print_tables(robot_tables(), format);
  } else if (options.what == "scenarios") {
    print_tables(scenario_tables(options.data), format);
  } else {
    throw std::invalid_argument(
        fmt::format("bench list '{}'{}: expected solvers, problems, suites, robots, data or scenarios",
                    options.what, did_you_mean(options.what, known)));
  }
  return ExitCode::Success;
}

}  // namespace

VerbAction add_list(CLI::App& app) {
  return verb_action<ListOptions>(app, add_options, list_command);
}

}  // namespace odobench
