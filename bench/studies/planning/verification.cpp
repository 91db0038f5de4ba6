#include "bench/studies/planning/verification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/random.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/catalogue/problem_factory.hpp"
#include "bench/catalogue/scenarios.hpp"
#include "bench/studies/context.hpp"
#include "bench/studies/parameter_sets.hpp"
#include "bench/studies/planning/robot_verification.hpp"
#include "bench/studies/records.hpp"
#include "bench/studies/work_size.hpp"
#include "problems/simulation/simulated_set.hpp"
#include "reports/statistics/statistics.hpp"

namespace odobench {

std::vector<ParameterSet> verified_sets(const ParameterNames& names, const VerificationStudy& study) {
  std::vector<ParameterSet> sets = read_parameters(names, "nominal");
  for (const std::string& source : split_sources(study.parameters))
    for (ParameterSet& set : read_parameters(names, source))
      if (set.label != "nominal" || set.values != sets.front().values)
        add_parameter_set(std::move(set), sets);
  return sets;
}

void put_errors(const CalibrationProblem& problem, const Vector& believed, VerifyOutcome& outcome) {
  std::vector<RecordingError> errors;
  for (const MaxErrors& e : problem.max_errors(believed))
    errors.push_back({e.recording, e.trajectory, e.repetition, {e.x, e.y, e.theta}});
  outcome.errors = error_statistics(errors);
  outcome.totals = error_totals(outcome.errors);
  outcome.recordings = std::move(errors);
}

std::vector<RunRecord> verification_records(const VerifiedDrives& of, const std::vector<ParameterSet>& sets,
                                            const std::vector<std::vector<VerifyOutcome>>& outcomes,
                                            const VerificationStudy& study, InstructionSet kernel) {
  const RunContext context = run_context(thread_count(study.threads), kernel);
  std::vector<RunRecord> records;
  for (std::size_t i = 0; i < sets.size(); ++i) {
    RunRecord record =
        study_record(kVerificationProblem, of.name, sets[i].label, of.parameters, sets[i].values, context);
    record.message = fmt::format("errors on {} new drives of each trajectory, steered by these parameters",
                                 study.repeat * of.repetitions);
    record.seed = record.base_seed = study.seed;
    for (std::size_t k = 0; k < outcomes[i].size(); ++k)
      for (RecordingError e : outcomes[i][k].recordings) {
        e.recording += fmt::format("#{}", k + 1);
        e.repetition += static_cast<int>(k) * of.repetitions;
        record.errors.push_back(std::move(e));
      }
    for (std::size_t t = 0; t < of.drives.size(); ++t) {
      const auto at = [&](std::size_t v) {
        return estimate(picked(outcomes[i], [&](const VerifyOutcome& one) { return one.arrival[t][v]; }))
            .mean;
      };
      const std::string& drive = of.drives[t];
      record.measures.put({kArrivalPosition + drive, at(0), "m", Better::None, drive});
      record.measures.put({kArrivalHeading + drive, at(1), "rad", Better::None, drive});
    }
    records.push_back(std::move(record));
  }
  return records;
}

namespace {

std::array<double, 2> arrival_of(const simulate::SimulatedDrive& d, const simulate::Drive& drive) {
  const Pose &start = d.logs.true_poses.front(), &end = d.logs.true_poses.back();
  const Pose wanted = drive.reference(drive.duration());
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
  put_errors(problem, believed, outcome);
  return outcome;
}

// The scenario with each set as what the robot believes.
std::vector<simulate::RecordingScenario> believing(const simulate::RecordingScenario& scenario,
                                                   const std::vector<ParameterSet>& sets) {
  std::vector<simulate::RecordingScenario> scenarios;
  for (const ParameterSet& set : sets) {
    scenarios.push_back(scenario);
    std::copy(set.values.begin(), set.values.end(), scenarios.back().control.believed.begin());
    simulate::validate(scenarios.back(), fmt::format("--parameters: set '{}'", set.label));
  }
  return scenarios;
}

void require_and_announce(const VerificationStudy& study, const simulate::RecordingScenario& scenario,
                          std::size_t sets, Watcher& watcher) {
  const double tour = simulate::most_samples(scenario);
  const WorkSize size{
      fmt::format("--scenario={} --repeat={}: {} sets drive {} drives {} times", study.scenario, study.repeat,
                  sets, scenario.drives.size(), scenario.repetitions),
      tour, tour * study.repeat * static_cast<double>(sets)};
  require_size(size);
  announce(size, watcher);
}

}  // namespace

Verification verify_parameters(const VerificationStudy& study, Watcher& watcher, const Stop& stop) {
  const InstructionSet kernel = kernel_in_force(study.kernel);
  if (!study.robot.empty()) return verify_robot(study, kernel, watcher, stop);
  const simulate::RecordingScenario scenario = load_recording_scenario(study.scenario);
  if (!scenario.control.closed_loop)
    throw std::invalid_argument(fmt::format(
        "--scenario={}: it is open loop; parameters that a robot believes matter in the closed loop only",
        study.scenario));
  Verification v;
  std::vector<std::vector<VerifyOutcome>>& outcomes = v.rounds.outcomes;
  for (const simulate::Drive& drive : scenario.drives) v.rounds.drives.push_back(drive.name);
  const std::vector<ParameterSet> sets =
      verified_sets({robot_parameters(scenario.robot), simulate::known_parameters(scenario)}, study);
  for (const ParameterSet& set : sets) v.rounds.labels.push_back(set.label);
  const std::vector<simulate::RecordingScenario> scenarios = believing(scenario, sets);
  require_and_announce(study, scenario, sets.size(), watcher);
  outcomes.resize(sets.size());
  watcher.count_begins("tours of all drives", static_cast<std::int64_t>(sets.size()) * study.repeat);
  for (std::size_t i = 0; i < sets.size(); ++i)
    for (int k = 1; k <= study.repeat; ++k) {
      stop.check();
      const std::uint64_t seed = derive_seed(study.seed, {"verify", scenario.name, std::to_string(k)});
      outcomes[i].push_back(drive_once(scenarios[i], sets[i].values, seed, study.threads, kernel));
      watcher.count_one();
    }
  watcher.count_ends();
  v.records = verification_records(
      {scenario.name, v.rounds.drives, scenario.repetitions, robot_parameters(scenario.robot)}, sets,
      outcomes, study, kernel);
  return v;
}

}  // namespace odobench
