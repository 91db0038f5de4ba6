#include "bench/verbs/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/names.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "bench/catalogue/number_text.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/catalogue/problem_factory.hpp"
#include "bench/catalogue/scenarios.hpp"
#include "bench/console/progress.hpp"
#include "bench/console/table_output.hpp"
#include "bench/studies/work_size.hpp"
#include "bench/verbs/common_options.hpp"
#include "problems/information/drive_planning.hpp"
#include "problems/simulation/simulated_set.hpp"
#include "solvers/options.hpp"

namespace odobench {
namespace {

struct PlanOptions {
  std::string robot;                    // scenario: file or name
  std::vector<std::string> drives;      // comma lists; empty: those of the scenario
  std::vector<std::string> candidates;  // comma lists to choose from; empty: no proposals
  double wanted = 0.005;                // relative standard deviation
  int replicas = 32;                    // fewer miss the rare late messages that decide
  std::uint64_t seed = 1;
  int threads = 0;
  std::optional<InstructionSet> kernel;
  std::string format = "console";
};

void add_options(CLI::App& app, PlanOptions& o) {
  add_scenario(app, "--robot", o.robot);
  app.add_option("--drives", o.drives,
                 "drives, a name once per time it is driven, or 'none'; a comma list [those of the scenario]")
      ->type_name("LIST")
      ->allow_extra_args(false);
  app.add_option("--candidates", o.candidates,
                 "propose drives out of these, 'all' or a comma list, until --wanted is met")
      ->type_name("LIST")
      ->allow_extra_args(false);
  app.add_option_function<std::string>(
         "--wanted",
         [&o](const std::string& text) { o.wanted = finite_number("--wanted", text, true, 1e6) / 100; },
         "standard deviation of every parameter, % of its nominal value [0.5]")
      ->type_name("PERCENT");
  add_count(app, "--replicas", o.replicas, 2, 10000,
            "simulations per drive that its noise is taken from [32]");
  add_noise_options(app, o.seed, o.threads);
  add_kernel(app, o.kernel, kLastBits);
  add_format(app, o.format);
}

constexpr int kMostProposals = 60;
constexpr std::size_t kShownComponents = 4;

// What --drives and --candidates choose from: the scenario's own drives, then those known by name.
std::vector<simulate::Drive> choices(const simulate::RecordingScenario& s) {
  std::vector<simulate::Drive> all = s.drives;
  for (simulate::Drive& d : simulate::known_drives()) {
    const auto same = [&d](const simulate::Drive& other) { return other.name == d.name; };
    if (std::none_of(all.begin(), all.end(), same)) all.push_back(std::move(d));
  }
  return all;
}

std::size_t index_of(const std::vector<simulate::Drive>& all, const std::string& name, const char* option) {
  std::vector<std::string> names;
  std::string list;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].name == name) return i;
    names.push_back(all[i].name);
    list += (list.empty() ? "" : ", ") + all[i].name;
  }
  throw std::invalid_argument(
      fmt::format("{}: unknown drive '{}'{}; known: {}", option, name, did_you_mean(name, names), list));
}

struct Selection {
  std::vector<simulate::Drive> drives;  // those used at all
  std::vector<int> counts;              // how often each is planned
  std::vector<bool> candidate;
};

Selection select(const simulate::RecordingScenario& s, const PlanOptions& o) {
  const std::vector<simulate::Drive> all = choices(s);
  std::vector<int> counts(all.size(), 0);
  std::vector<bool> candidate(all.size(), false);
  if (o.drives.empty())
    for (std::size_t i = 0; i < s.drives.size(); ++i) counts[i] = s.repetitions;
  else if (!(o.drives.size() == 1 && o.drives.front() == "none"))
    for (const std::string& name : comma_items(o.drives)) ++counts[index_of(all, name, "--drives")];
  for (const std::string& name : comma_items(o.candidates)) {
    if (name == "all")
      candidate.assign(all.size(), true);
    else
      candidate[index_of(all, name, "--candidates")] = true;
  }
  Selection selection;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (counts[i] == 0 && !candidate[i]) continue;
    selection.drives.push_back(all[i]);
    selection.counts.push_back(counts[i]);
    selection.candidate.push_back(candidate[i]);
  }
  if (selection.drives.empty())
    throw std::invalid_argument("--drives=none needs --candidates: there is nothing to plan");
  return selection;
}

std::vector<DriveInformation> informations(const simulate::RecordingScenario& s, const Selection& selection,
                                           const PlanOptions& o, InstructionSet kernel) {
  const std::vector<ParameterInfo> parameters = robot_parameters(s.robot);
  const Vector truth = Eigen::Map<const Vector>(s.truth.parameters.data(), kCalibrationParameters);
  const std::uint64_t seed = derive_seed(o.seed, {"plan", s.name});
  std::vector<DriveInformation> list(selection.drives.size());
  const std::int64_t each = s.exact ? 1 : o.replicas;
  CountLine progress(true, "simulated drives", static_cast<std::int64_t>(list.size()) * each);
  parallel_for(list.size(), o.threads, [&](std::size_t i) {
    const simulate::Drive& drive = selection.drives[i];
    if (s.exact) {
      list[i] = ideal_information(drive.name, parameters, simulate::exact_recording(s, drive), truth,
                                  s.capture.position_noise, kernel);
      return;
    }
    std::vector<Recording> replicas;
    for (int k = 1; k <= o.replicas; ++k) {
      replicas.push_back(simulate::simulate_drive(s, drive, k, seed).recording);
      progress.add_one();
    }
    list[i] = drive_information(drive.name, parameters, replicas, truth, kernel);
  });
  return list;
}

Cell percent(double relative) {
  return std::isfinite(relative) ? significant_cell(100 * relative, 3) : text_cell("not at all");
}

Table parameter_table(const PlanAnalysis& a, const std::vector<ParameterInfo>& parameters, double wanted) {
  Table t{"plan.parameters",
          "What these drives tell about each parameter",
          {text_column("parameter"), number_column("deviation", "deviation", "%"),
           number_column("absolute_deviation", "absolute deviation", "mm"), text_column("determined")},
          {},
          {}};
  int count = 0;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const double sd = a.standard_deviations[static_cast<Eigen::Index>(i)];
    const bool determined = sd <= wanted;
    count += determined;
    t.rows.push_back(
        {text_cell(parameters[i].name), percent(sd),
         std::isfinite(sd) ? significant_cell(1000 * sd * std::abs(parameters[i].nominal), 3) : Cell{},
         text_cell(determined ? "yes" : "no")});
  }
  t.notes.push_back(
      fmt::format("Standard deviation of a calibration by least squares, from simulated noise; determined: "
                  "at most {:g} %; {} of {}.",
                  100 * wanted, count, parameters.size()));
  return t;
}

Table direction_table(const PlanAnalysis& a, const std::vector<ParameterInfo>& parameters) {
  Table t{"plan.directions",
          "Combinations from best to worst determined",
          {text_column("rank"), number_column("singular_value"), number_column("deviation", "deviation", "%"),
           text_column("direction")},
          {},
          {"Singular values of the noise-weighted Jacobian in relative parameters; direction: its largest "
           "parts."}};
  for (std::size_t k = 0; k < a.directions.size(); ++k) {
    const Direction& d = a.directions[k];
    std::vector<std::size_t> order(parameters.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto part = [&d](std::size_t i) { return std::abs(d.vector[static_cast<Eigen::Index>(i)]); };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t x, std::size_t y) { return part(x) > part(y); });
    std::string text;
    for (std::size_t i = 0; i < kShownComponents; ++i)
      text += fmt::format("{}{:+.2f} {}", i > 0 ? " " : "", d.vector[static_cast<Eigen::Index>(order[i])],
                          parameters[order[i]].name);
    t.rows.push_back({text_cell(fmt::format("{}", k + 1)), significant_cell(d.singular_value, 4),
                      percent(d.standard_deviation), text_cell(text)});
  }
  return t;
}

Table undetermined_table(const PlanAnalysis& a, double wanted) {
  Table t{"plan.undetermined",
          "What stays undetermined",
          {text_column("number"), text_column("combination")},
          {},
          {fmt::format(
              "Changing these parameters together, those after 'against' the other way, changes nothing that "
              "{:g} % precision would show.",
              100 * wanted)}};
  for (std::size_t k = 0; k < a.undetermined_words.size(); ++k)
    t.rows.push_back({text_cell(fmt::format("{}", k + 1)), text_cell(a.undetermined_words[k])});
  return t;
}

Table proposal_table(const std::vector<Proposal>& proposals, const std::vector<DriveInformation>& drives,
                     double wanted) {
  Table t{"plan.proposals",
          "Drives to add, best first",
          {text_column("number"), text_column("drive"),
           number_column("largest_deviation", "largest deviation", "%")},
          {},
          {}};
  for (std::size_t k = 0; k < proposals.size(); ++k)
    t.rows.push_back({text_cell(fmt::format("{}", k + 1)), text_cell(drives[proposals[k].drive].name),
                      percent(proposals[k].largest_deviation)});
  const bool met = !proposals.empty() && proposals.back().largest_deviation <= wanted;
  if (proposals.empty())
    t.notes.push_back(fmt::format("Nothing to add: {:g} % is met.", 100 * wanted));
  else
    t.notes.push_back(met ? fmt::format("With these every parameter is known to {:g} %.", 100 * wanted)
                          : fmt::format("{} drives do not reach {:g} %; the candidates lack something.",
                                        proposals.size(), 100 * wanted));
  return t;
}

// Planned drives that are no candidates stay as they are.
Table proposals(const std::vector<DriveInformation>& drives, const Selection& selection,
                const std::vector<ParameterInfo>& parameters, double wanted) {
  std::vector<DriveInformation> candidates;
  std::vector<int> counts;
  DriveInformation fixed{"", Matrix::Zero(12, 12), Vector::Zero(12), Matrix::Zero(12, 12)};
  for (std::size_t i = 0; i < drives.size(); ++i) {
    if (selection.candidate[i]) {
      candidates.push_back(drives[i]);
      counts.push_back(selection.counts[i]);
      continue;
    }
    fixed.normal += selection.counts[i] * drives[i].normal;
    fixed.scatter += selection.counts[i] * drives[i].scatter;
    fixed.bias += selection.counts[i] * drives[i].bias;
  }
  return proposal_table(propose_drives(candidates, counts, fixed, parameters, wanted, kMostProposals),
                        candidates, wanted);
}

// The replicas of a drive are in memory together, of as many drives as there are threads, without the logs they are made of.
constexpr double kRecordingShare = 0.25;

void require_and_announce(simulate::RecordingScenario s, const PlanOptions& o) {
  s.repetitions = s.exact ? 1 : o.replicas;
  double longest = 0;
  for (const simulate::Drive& drive : s.drives) longest = std::max(longest, simulate::most_samples(s, drive));
  const double at_once = std::min<double>(thread_count(o.threads), static_cast<double>(s.drives.size()));
  const WorkSize size{
      fmt::format("--robot={} --replicas={}: {} drives", o.robot, s.repetitions, s.drives.size()),
      kRecordingShare * at_once * s.repetitions * longest, simulate::most_samples(s)};
  require_size(size);
  announce(size, false);
}

ExitCode plan_command(const PlanOptions& o) {
  const Format format = parse_format(o.format);
  const InstructionSet kernel = kernel_in_force(o.kernel);
  const simulate::RecordingScenario scenario = load_recording_scenario(o.robot);
  const Selection selection = select(scenario, o);
  simulate::RecordingScenario checked = scenario;
  checked.drives = selection.drives;
  checked.slip.gains.clear();
  simulate::validate(checked, "--drives");
  require_and_announce(checked, o);
  const std::vector<ParameterInfo> parameters = robot_parameters(scenario.robot);
  const std::vector<DriveInformation> drives = informations(scenario, selection, o, kernel);
  const PlanAnalysis analysis = analyse_drives(drives, selection.counts, parameters, o.wanted);
  std::vector<Table> tables = {parameter_table(analysis, parameters, o.wanted),
                               direction_table(analysis, parameters)};
  if (!analysis.undetermined_words.empty()) tables.push_back(undetermined_table(analysis, o.wanted));
  if (!o.candidates.empty()) tables.push_back(proposals(drives, selection, parameters, o.wanted));
  print_tables(tables, format);
  return ExitCode::Success;
}

}  // namespace

VerbAction add_plan(CLI::App& app) {
  return verb_action<PlanOptions>(app, add_options, plan_command);
}

}  // namespace odobench
