#include "bench/studies/planning/robot_verification.hpp"

#include <fmt/format.h>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "bench/studies/planning/robot_drives.hpp"
#include "bench/studies/work_size.hpp"

namespace odobench {
namespace {

constexpr int kRepetitions = 3;  // of each drive in a repeat

class RobotTours {
 public:
  RobotTours(const VerificationStudy& study, InstructionSet kernel)
      : study_(study),
        kernel_(kernel),
        known_(load_robot(study.robot)),
        of_robot_(known_),
        simulator_(known_.robot) {}

  Verification run(Watcher& watcher, const Stop& stop) {
    Verification v;
    const std::string first = split_sources(study_.parameters).front();
    truth_ = study_.truth.empty() ? true_parameters(known_, first, "--parameters")
                                  : true_parameters(known_, study_.truth, "--truth");
    const std::vector<ParameterSet> sets = verified_sets(parameter_names(known_), study_);
    std::vector<std::vector<VerifyOutcome>>& outcomes = v.rounds.outcomes;
    for (const ParameterSet& set : sets) {
      v.rounds.labels.push_back(set.label);
      if (const std::string outside = outside_box(known_.robot, set.values); !outside.empty())
        watcher.warn(
            fmt::format("parameters '{}' lie outside the box of {}: {}", set.label, known_.name, outside));
    }
    const RobotAbilities nominal =
        of_robot_([&] { return simulator_.abilities(nominal_values(known_.robot)); });
    drives_ = standard_drives(nominal);
    for (const RobotDrive& d : drives_) v.rounds.drives.push_back(d.name);
    require_and_announce(nominal, sets.size(), watcher);
    outcomes.resize(sets.size());
    watcher.count_begins("tours of all drives", static_cast<std::int64_t>(sets.size()) * study_.repeat);
    for (std::size_t i = 0; i < sets.size(); ++i)
      for (int k = 1; k <= study_.repeat; ++k) {
        stop.check();
        outcomes[i].push_back(tour(sets[i], k, stop));
        watcher.count_one();
      }
    watcher.count_ends();
    v.records =
        verification_records({known_.name, v.rounds.drives, kRepetitions, robot_parameters(known_.robot)},
                             sets, outcomes, study_, kernel_);
    v.rounds.notes.push_back(fmt::format("The drives are simulated with '{}' as the truth", truth_.label));
    for (RunRecord& record : v.records) record.notes = v.rounds.notes;
    return v;
  }

 private:
  void require_and_announce(const RobotAbilities& can, std::size_t sets, Watcher& watcher) const {
    double samples = 0;
    for (const RobotDrive& d : drives_) samples += kRepetitions * RobotSimulator::samples(d, can);
    const WorkSize size{fmt::format("--robot={} --repeat={}: {} sets drive {} drives {} times", study_.robot,
                                    study_.repeat, sets, drives_.size(), kRepetitions),
                        samples, samples * study_.repeat * static_cast<double>(sets)};
    require_size(size);
    announce(size, watcher);
  }

  // All drives once with one set. Noise is the same for every set.
  VerifyOutcome tour(const ParameterSet& set, int repeat, const Stop& stop) const {
    const std::uint64_t seed = derive_seed(study_.seed, {"verify", known_.name, std::to_string(repeat)});
    constexpr auto kEach = static_cast<std::size_t>(kRepetitions);
    std::vector<RobotRun> runs(drives_.size() * kEach);
    try {
      const RobotAbilities can = simulator_.abilities(set.values);
      parallel_for(
          runs.size(), study_.threads,
          [&](std::size_t i) {
            runs[i] = driven(simulator_, drives_[i / kEach], can, truth_.values, set.values, seed,
                             static_cast<int>(i % kEach) + 1, true);
          },
          stop);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(
          fmt::format("--parameters: a robot cannot be driven by set '{}': {}", set.label, error.what()));
    }
    VerifyOutcome outcome;
    std::vector<Recording> recordings;
    for (std::size_t t = 0; t < drives_.size(); ++t) {
      std::array<double, 2> mean{};
      for (std::size_t k = 0; k < kEach; ++k) {
        RobotRun& one = runs[t * kEach + k];
        mean[0] += one.position_miss / kRepetitions;
        mean[1] += one.heading_miss / kRepetitions;
        recordings.push_back(std::move(one.recording));
      }
      outcome.arrival.push_back(mean);
    }
    const CalibrationProblem problem(known_.robot, std::move(recordings), calibration_options(known_.robot),
                                     kernel_);
    put_errors(problem, set.values, outcome);
    return outcome;
  }

  const VerificationStudy& study_;
  InstructionSet kernel_;
  KnownRobot known_;
  RobotWords of_robot_;
  RobotSimulator simulator_;
  ParameterSet truth_;
  std::vector<RobotDrive> drives_;
};

}  // namespace

Verification verify_robot(const VerificationStudy& study, InstructionSet kernel, Watcher& watcher,
                          const Stop& stop) {
  return RobotTours(study, kernel).run(watcher, stop);
}

}  // namespace odobench
