#include "bench/studies/planning/drive_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/names.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/catalogue/problem_factory.hpp"
#include "bench/catalogue/scenarios.hpp"
#include "bench/studies/context.hpp"
#include "bench/studies/records.hpp"
#include "bench/studies/work_size.hpp"
#include "problems/information/drive_planning.hpp"
#include "problems/simulation/simulated_set.hpp"
#include "reports/kinds/planning/planning_tables.hpp"

namespace odobench {
namespace {

constexpr int kMostProposals = 60;

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

Selection select(const simulate::RecordingScenario& s, const DrivePlan& study) {
  const std::vector<simulate::Drive> all = choices(s);
  std::vector<int> counts(all.size(), 0);
  std::vector<bool> candidate(all.size(), false);
  if (study.drives.empty())
    for (std::size_t i = 0; i < s.drives.size(); ++i) counts[i] = s.repetitions;
  else if (!(study.drives.size() == 1 && study.drives.front() == "none"))
    for (const std::string& name : comma_items(study.drives)) ++counts[index_of(all, name, "--drives")];
  for (const std::string& name : comma_items(study.candidates)) {
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
                                           const DrivePlan& study, InstructionSet kernel, Watcher& watcher,
                                           const Stop& stop) {
  const std::vector<ParameterInfo> parameters = robot_parameters(s.robot);
  const Vector truth = Eigen::Map<const Vector>(s.truth.parameters.data(), kCalibrationParameters);
  const std::uint64_t seed = derive_seed(study.seed, {"plan", s.name});
  std::vector<DriveInformation> list(selection.drives.size());
  const std::int64_t each = s.exact ? 1 : study.replicas;
  watcher.count_begins("simulated drives", static_cast<std::int64_t>(list.size()) * each);
  parallel_for(
      list.size(), study.threads,
      [&](std::size_t i) {
        const simulate::Drive& drive = selection.drives[i];
        if (s.exact) {
          list[i] = ideal_information(drive.name, parameters, simulate::exact_recording(s, drive), truth,
                                      s.capture.position_noise, kernel);
          return;
        }
        std::vector<Recording> replicas;
        for (int k = 1; k <= study.replicas; ++k) {
          replicas.push_back(simulate::simulate_drive(s, drive, k, seed).recording);
          watcher.count_one();
        }
        list[i] = drive_information(drive.name, parameters, replicas, truth, kernel);
      },
      stop);
  watcher.count_ends();
  return list;
}

// Adds what is proposed to the record. Planned drives that are no candidates stay as they are.
void put_proposals(const std::vector<DriveInformation>& drives, const Selection& selection,
                   const std::vector<ParameterInfo>& parameters, double wanted, RunRecord& record) {
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
  for (const Proposal& p : propose_drives(candidates, counts, fixed, parameters, wanted, kMostProposals)) {
    record.notes.push_back(kProposedNote + candidates[p.drive].name);
    record.series["proposed"].push_back(p.largest_deviation);
  }
}

// The replicas of a drive are in memory together, of as many drives as there are threads, without the logs
// they are made of.
constexpr double kRecordingShare = 0.25;

void require_and_announce(simulate::RecordingScenario s, const DrivePlan& study, Watcher& watcher) {
  s.repetitions = s.exact ? 1 : study.replicas;
  double longest = 0;
  for (const simulate::Drive& drive : s.drives) longest = std::max(longest, simulate::most_samples(s, drive));
  const double at_once = std::min<double>(thread_count(study.threads), static_cast<double>(s.drives.size()));
  const WorkSize size{
      fmt::format("--robot={} --replicas={}: {} drives", study.robot, s.repetitions, s.drives.size()),
      kRecordingShare * at_once * s.repetitions * longest, simulate::most_samples(s)};
  require_size(size);
  announce(size, watcher);
}

// The scatter of r simulations of a drive has a rank of r - 1 at most: along the rest nothing would be
// uncertain.
std::string too_few_replicas(const Selection& selection, std::size_t parameters, const DrivePlan& study) {
  const auto drives = static_cast<std::size_t>(
      std::count_if(selection.counts.begin(), selection.counts.end(), [](int count) { return count > 0; }));
  const std::size_t rank = drives * static_cast<std::size_t>(study.replicas - 1);
  if (drives == 0 || rank >= parameters) return "";
  return fmt::format(
      "--replicas={}: the noise of {} drive{} shows in {} of {} combinations, the others look exactly "
      "determined; "
      "give at least --replicas={}",
      study.replicas, drives, drives == 1 ? "" : "s", rank, parameters,
      (parameters + drives - 1) / drives + 1);
}

// The relative standard deviations and directions of the plan; what is not determined has no measure.
RunRecord plan_record(const simulate::RecordingScenario& s, const PlanAnalysis& a,
                      const std::vector<ParameterInfo>& parameters, const DrivePlan& study,
                      InstructionSet kernel) {
  Vector nominal(static_cast<Eigen::Index>(parameters.size()));
  for (Eigen::Index i = 0; i < nominal.size(); ++i)
    nominal[i] = parameters[static_cast<std::size_t>(i)].nominal;
  RunRecord record = study_record(kPlanningProblem, s.name, "plan", parameters, nominal,
                                  run_context(thread_count(study.threads), kernel));
  record.message = "what calibrations on these drives would determine";
  record.seed = record.base_seed = study.seed;
  record.measures.put({"wanted", study.wanted, ""});
  double determined = 0;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const double deviation = a.standard_deviations[static_cast<Eigen::Index>(i)];
    record.series["standard_deviations"].push_back(deviation);
    if (std::isfinite(deviation))
      record.measures.put(
          {"deviation." + parameters[i].name, deviation, "", Better::None, parameters[i].name});
    determined += deviation <= study.wanted ? 1 : 0;
  }
  record.measures.put({"determined", determined, ""});
  for (const Direction& d : a.directions) {
    record.series["singular_values"].push_back(d.singular_value);
    record.series["direction_deviations"].push_back(d.standard_deviation);
    for (const double part : d.vector) record.series["directions"].push_back(part);
  }
  for (const std::string& words : a.undetermined_words) record.notes.push_back(kUndeterminedNote + words);
  return record;
}

}  // namespace

std::vector<RunRecord> plan_drives(const DrivePlan& study, Watcher& watcher, const Stop& stop) {
  const InstructionSet kernel = kernel_in_force(study.kernel);
  const simulate::RecordingScenario scenario = load_recording_scenario(study.robot);
  const Selection selection = select(scenario, study);
  simulate::RecordingScenario checked = scenario;
  checked.drives = selection.drives;
  checked.slip.gains.clear();
  simulate::validate(checked, "--drives");
  require_and_announce(checked, study, watcher);
  const std::vector<ParameterInfo> parameters = robot_parameters(scenario.robot);
  const std::vector<DriveInformation> drives =
      informations(scenario, selection, study, kernel, watcher, stop);
  const PlanAnalysis analysis = analyse_drives(drives, selection.counts, parameters, study.wanted);
  RunRecord record = plan_record(scenario, analysis, parameters, study, kernel);
  if (const std::string few = scenario.exact ? "" : too_few_replicas(selection, parameters.size(), study);
      !few.empty())
    record.notes.push_back(few);
  if (!study.candidates.empty()) put_proposals(drives, selection, parameters, study.wanted, record);
  return {record};
}

}  // namespace odobench
