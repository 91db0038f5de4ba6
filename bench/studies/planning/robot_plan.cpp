// The plan of a robot of any class or of a user's own wheels: drives of its set as they were recorded, others
// simulated.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <stdexcept>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "base/range.hpp"
#include "bench/studies/planning/plan_parts.hpp"
#include "bench/studies/planning/robot_drives.hpp"
#include "bench/studies/work_size.hpp"
#include "reports/kinds/planning/planning_tables.hpp"
#include "solvers/solve.hpp"

namespace odobench {
namespace {

constexpr int kUsualRepetitions = 3;  // of the standard drives of a class, as simulate makes them

struct RobotDrives {
  std::vector<std::string> names;  // of the set, then simulated ones
  std::vector<int> own;            // how often each was driven, or would be
  std::vector<RobotDrive> simulated;
  std::size_t recorded = 0;  // names of the set
};

RobotDrives drives_of(const KnownRobot& known, const RobotAbilities& can) {
  RobotDrives all;
  if (known.dataset)
    for (const Trajectory& t : known.dataset->trajectories) {
      const auto count = std::count_if(known.dataset->recordings.begin(), known.dataset->recordings.end(),
                                       [&](const Recording& r) { return r.trajectory == t.name; });
      if (count == 0) continue;
      all.names.push_back(t.name);
      all.own.push_back(static_cast<int>(count));
    }
  all.recorded = all.names.size();
  const std::size_t standard = standard_drives(can).size();
  std::size_t place = 0;
  for (RobotDrive& d : known_drives(can)) {
    const bool usual = place++ < standard;
    if (std::find(all.names.begin(), all.names.end(), d.name) != all.names.end()) continue;
    all.names.push_back(d.name);
    all.own.push_back(all.recorded == 0 && usual ? kUsualRepetitions : 0);
    all.simulated.push_back(std::move(d));
  }
  return all;
}

// What all drives together, planned and candidates, do not tell at all, in words.
std::string untold(const std::vector<DriveInformation>& drives, const DriveSelection& selection,
                   const std::vector<ParameterInfo>& parameters) {
  std::vector<int> counts = selection.counts;
  for (std::size_t i = 0; i < counts.size(); ++i) counts[i] += selection.candidate[i] ? 1 : 0;
  const PlanAnalysis all = analyse_drives(drives, counts, parameters, kLargestNumber);
  std::string list;
  for (const std::string& words : all.undetermined_words) list += (list.empty() ? "" : "; ") + words;
  return list;
}

// Where the recordings of the set are explained best.
Vector fitted(const KnownRobot& known, const CalibrationOptions& options, InstructionSet kernel) {
  const auto model =
      std::make_shared<const CalibrationProblem>(known.robot, known.dataset->recordings, options, kernel);
  const Problem problem(model);
  const Result result = solve(problem, parse_solver_list("lm").front(), nominal_values(known.robot), {});
  if (!result.usable())
    throw DataError(fmt::format("{}: no calibration of its recordings: {}", known.source, result.message));
  return result.x;
}

class RobotPlan {
 public:
  RobotPlan(const DrivePlan& study, InstructionSet kernel)
      : study_(study),
        kernel_(kernel),
        known_(load_robot(study.robot)),
        of_robot_(known_),
        options_(calibration_options(known_.robot)),
        simulator_(known_.robot) {}

  std::vector<RunRecord> run(Watcher& watcher, const Stop& stop) {
    const std::vector<ParameterInfo> parameters = free_parameters(known_.robot);
    if (parameters.empty())
      throw DataError(
          fmt::format("{}: every parameter is held fixed, nothing is to be found", known_.source));
    const Vector nominal = nominal_values(known_.robot);
    const RobotAbilities can = of_robot_([&] { return simulator_.abilities(nominal); });
    const RobotDrives all = drives_of(known_, can);
    const DriveSelection selection = select_drives(all.names, all.own, study_);
    require_and_announce(all, selection, can, watcher);
    const std::vector<DriveInformation> drives =
        of_robot_([&] { return informations(all, selection, can, nominal, watcher, stop); });
    const PlanAnalysis analysis = analyse_drives(drives, selection.counts, parameters, study_.wanted);
    RunRecord record = plan_record(known_.name, analysis, parameters, study_, kernel_);
    for (const std::string& note : notes_) record.notes.push_back(note);
    if (all.recorded == 0)
      if (const std::string few = too_few_replicas(selection, parameters.size(), study_); !few.empty())
        record.notes.push_back(few);
    if (study_.candidates.empty()) return {record};
    const std::string dark = untold(drives, selection, parameters);
    if (!dark.empty())
      record.notes.push_back(kNoCandidateNote + dark +
                             ": hold one of them fixed (lower = upper) and plan again");
    else
      put_proposals(drives, selection, parameters, study_.wanted, record);
    return {record};
  }

 private:
  void require_and_announce(const RobotDrives& all, const DriveSelection& selection,
                            const RobotAbilities& can, Watcher& watcher) const {
    double samples = 0;
    std::size_t count = 0;
    for (const std::size_t i : selection.drives)
      if (i >= all.recorded) {
        samples += study_.replicas * RobotSimulator::samples(all.simulated[i - all.recorded], can);
        ++count;
      }
    const WorkSize size{
        fmt::format("--robot={} --replicas={}: {} drives", study_.robot, study_.replicas, count), samples,
        samples};
    require_size(size);
    announce(size, watcher);
  }

  std::vector<DriveInformation> informations(const RobotDrives& all, const DriveSelection& selection,
                                             const RobotAbilities& can, const Vector& nominal,
                                             Watcher& watcher, const Stop& stop) {
    Vector z = nominal;
    RecordedInformation recorded;
    if (all.recorded > 0) {
      const std::vector<std::string> names(all.names.begin(),
                                           all.names.begin() + static_cast<std::ptrdiff_t>(all.recorded));
      z = fitted(known_, options_, kernel_);
      recorded = recorded_information(names, known_.robot, options_, known_.dataset->recordings, z, kernel_);
      notes_.push_back(recorded.by_recording
                           ? "Drives of the set: noise as their recordings scatter round the calibration, "
                             "other drives: simulated"
                           : "Drives of the set: noise of independent residuals, since there are too few "
                             "recordings to see "
                             "how they scatter, which is too sure; other drives: simulated");
    }
    std::vector<DriveInformation> list(selection.drives.size());
    watcher.count_begins("drives", static_cast<std::int64_t>(list.size()));
    parallel_for(
        list.size(), study_.threads,
        [&](std::size_t i) {
          const std::size_t drive = selection.drives[i];
          list[i] = drive < all.recorded ? recorded.drives[drive]
                                         : simulated(all.simulated[drive - all.recorded], can, z);
          watcher.count_one();
        },
        stop);
    watcher.count_ends();
    return list;
  }

  DriveInformation simulated(const RobotDrive& drive, const RobotAbilities& can, const Vector& z) const {
    const std::uint64_t seed = derive_seed(study_.seed, {"plan", known_.name});
    std::vector<Recording> replicas;
    for (int k = 1; k <= study_.replicas; ++k)
      replicas.push_back(driven(simulator_, drive, can, z, nominal_values(known_.robot), seed, k).recording);
    return drive_information(drive.name, known_.robot, options_, replicas, z, kernel_);
  }

  const DrivePlan& study_;
  InstructionSet kernel_;
  KnownRobot known_;
  RobotWords of_robot_;
  CalibrationOptions options_;
  RobotSimulator simulator_;
  std::vector<std::string> notes_;
};

}  // namespace

std::vector<RunRecord> plan_robot(const DrivePlan& study, InstructionSet kernel, Watcher& watcher,
                                  const Stop& stop) {
  return RobotPlan(study, kernel).run(watcher, stop);
}

}  // namespace odobench
