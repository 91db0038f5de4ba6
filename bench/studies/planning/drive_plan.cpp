#include "bench/studies/planning/drive_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "base/names.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/catalogue/problem_factory.hpp"
#include "bench/catalogue/robots.hpp"
#include "bench/catalogue/scenarios.hpp"
#include "bench/studies/planning/plan_parts.hpp"
#include "bench/studies/work_size.hpp"
#include "datasets/robots/layouts.hpp"
#include "problems/simulation/simulated_set.hpp"

namespace odobench {
namespace {

// What --drives and --candidates choose from: the scenario's own drives, then those known by name.
std::vector<simulate::Drive> choices(const simulate::RecordingScenario& s) {
  std::vector<simulate::Drive> all = s.drives;
  for (simulate::Drive& d : simulate::known_drives()) {
    const auto same = [&d](const simulate::Drive& other) { return other.name == d.name; };
    if (std::none_of(all.begin(), all.end(), same)) all.push_back(std::move(d));
  }
  return all;
}

void require_known(const std::string& source) {
  std::error_code error;
  if (std::filesystem::exists(source, error)) return;
  std::vector<std::string> names;
  std::string list;
  for (const auto& [name, path] : known_scenarios()) {
    names.push_back(name);
    list += (list.empty() ? "" : ", ") + name;
  }
  for (const robots::Layout& layout : robots::layouts()) names.push_back(layout.name);
  if (std::find(names.begin(), names.end(), source) == names.end())
    throw std::invalid_argument(fmt::format(
        "--robot={}: neither a file nor a scenario nor a class of robots{}; scenarios: {}; classes: "
        "see 'bench list robots'",
        source, did_you_mean(source, names), list));
}

std::vector<DriveInformation> informations(const simulate::RecordingScenario& s,
                                           const std::vector<simulate::Drive>& drives, const DrivePlan& study,
                                           InstructionSet kernel, Watcher& watcher, const Stop& stop) {
  const std::vector<ParameterInfo> parameters = robot_parameters(s.robot);
  const Vector truth = Eigen::Map<const Vector>(s.truth.parameters.data(), kCalibrationParameters);
  const std::uint64_t seed = derive_seed(study.seed, {"plan", s.name});
  std::vector<DriveInformation> list(drives.size());
  const std::int64_t each = s.exact ? 1 : study.replicas;
  watcher.count_begins("simulated drives", static_cast<std::int64_t>(list.size()) * each);
  parallel_for(
      list.size(), study.threads,
      [&](std::size_t i) {
        const simulate::Drive& drive = drives[i];
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

}  // namespace

std::vector<RunRecord> plan_drives(const DrivePlan& study, Watcher& watcher, const Stop& stop) {
  const InstructionSet kernel = kernel_in_force(study.kernel);
  if (!study.between.empty()) return plan_between(study, kernel, watcher, stop);
  if (is_robot(study.robot)) return plan_robot(study, kernel, watcher, stop);
  require_known(study.robot);
  const simulate::RecordingScenario scenario = load_recording_scenario(study.robot);
  const std::vector<simulate::Drive> all = choices(scenario);
  std::vector<std::string> names;
  for (const simulate::Drive& d : all) names.push_back(d.name);
  std::vector<int> own(all.size(), 0);
  std::fill_n(own.begin(), scenario.drives.size(), scenario.repetitions);
  const DriveSelection selection = select_drives(names, own, study);
  simulate::RecordingScenario checked = scenario;
  checked.drives.clear();
  for (const std::size_t i : selection.drives) checked.drives.push_back(all[i]);
  checked.slip.gains.clear();
  simulate::validate(checked, "--drives");
  require_and_announce(checked, study, watcher);
  const std::vector<ParameterInfo> parameters = robot_parameters(scenario.robot);
  const std::vector<DriveInformation> drives =
      informations(scenario, checked.drives, study, kernel, watcher, stop);
  const PlanAnalysis analysis = analyse_drives(drives, selection.counts, parameters, study.wanted);
  RunRecord record = plan_record(scenario.name, analysis, parameters, study, kernel);
  if (const std::string few = scenario.exact ? "" : too_few_replicas(selection, parameters.size(), study);
      !few.empty())
    record.notes.push_back(few);
  if (!study.candidates.empty()) put_proposals(drives, selection, parameters, study.wanted, record);
  return {record};
}

}  // namespace odobench
