#include "bench/studies/planning/robot_drives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "base/error.hpp"
#include "base/names.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/studies/work_size.hpp"

namespace odobench {
namespace {

std::vector<RobotDrive> chosen(const std::vector<std::string>& lists, const RobotAbilities& can) {
  if (lists.empty()) return standard_drives(can);
  std::vector<RobotDrive> all = known_drives(can);
  std::vector<RobotDrive> drives;
  for (const std::string& name : comma_items(lists))
    if (name == "all") return all;
  for (RobotDrive& d : small_circles(can)) all.push_back(std::move(d));
  for (const std::string& name : comma_items(lists)) {
    std::vector<std::string> names;
    std::string list;
    const RobotDrive* found = nullptr;
    for (const RobotDrive& d : all) {
      if (d.name == name) found = &d;
      names.push_back(d.name);
      list += (list.empty() ? "" : ", ") + d.name;
    }
    if (found == nullptr)
      throw std::invalid_argument(
          fmt::format("--drives: unknown drive '{}'{}; known: {}", name, did_you_mean(name, names), list));
    const auto same = [&](const RobotDrive& d) { return d.name == name; };
    if (std::any_of(drives.begin(), drives.end(), same))
      throw std::invalid_argument(
          fmt::format("--drives: '{}' stands there twice; --repeat says how often", name));
    drives.push_back(*found);
  }
  return drives;
}

}  // namespace

ParameterNames parameter_names(const KnownRobot& known) {
  ParameterNames names{robot_parameters(known.robot), {}, known.robot.kinematics};
  if (known.dataset) names.known = known.dataset->known_parameters;
  return names;
}

std::string outside_box(const Robot& robot, const Vector& values) {
  std::string list;
  for (std::size_t i = 0; i < robot.parameters.size(); ++i) {
    const RobotParameter& p = robot.parameters[i];
    const double value = values[static_cast<Eigen::Index>(i)], slack = 1e-9 * (p.upper - p.lower);
    if (value < p.lower - slack || value > p.upper + slack)
      list += fmt::format("{}{}={} ({}..{})", list.empty() ? "" : ", ", p.name, value, p.lower, p.upper);
  }
  return list;
}

ParameterSet true_parameters(const KnownRobot& known, const std::string& source, const char* option) {
  std::vector<ParameterSet> sets = read_parameters(parameter_names(known), source, option);
  if (sets.size() != 1)
    throw std::invalid_argument(
        fmt::format("{}={}: it holds {} sets, expected one as the truth", option, source, sets.size()));
  const std::string outside = outside_box(known.robot, sets.front().values);
  if (!outside.empty())
    throw std::invalid_argument(
        fmt::format("{}={}: outside the box of {}, where no calibration finds it: {}; are they of another "
                    "robot?",
                    option, source, known.name, outside));
  return std::move(sets.front());
}

void RobotWords::refuse(const char* what) const {
  if (known_.dataset || known_.source != known_.name)
    throw DataError(fmt::format("{}: {}", known_.source, what));
  throw std::invalid_argument(fmt::format("--robot={}: {}", known_.source, what));
}

RobotRun driven(const RobotSimulator& simulator, const RobotDrive& drive, const RobotAbilities& can,
                const Vector& truth, const Vector& believed, std::uint64_t seed, int repetition,
                bool feedback) {
  Random random(derive_seed(seed, {"robot", drive.name, std::to_string(repetition)}));
  RobotRun run = simulator.record(drive, can, truth, believed, random, feedback);
  run.recording.trajectory = drive.name;
  run.recording.repetition = repetition;
  run.recording.id = fmt::format("{}_{}", drive.name, repetition);
  return run;
}

Dataset simulate_robot(const RobotSimulation& study, Watcher& watcher, const Stop& stop) {
  const KnownRobot known = load_robot(study.robot);
  const ParameterSet truth =
      true_parameters(known, study.parameters.empty() ? "nominal" : study.parameters, "--parameters");
  const RobotWords of_robot(known);
  const RobotSimulator simulator(known.robot);
  const Vector nominal = nominal_values(known.robot);
  const RobotAbilities can = of_robot([&] { return simulator.abilities(nominal); });
  const std::vector<RobotDrive> drives = chosen(study.drives, can);
  double samples = 0;
  for (const RobotDrive& drive : drives) samples += study.repeat * RobotSimulator::samples(drive, can);
  const WorkSize size{fmt::format("--robot={}: {} drives {} times", study.robot, drives.size(), study.repeat),
                      samples, samples};
  require_size(size);
  announce(size, watcher);
  if (study.parameters.empty())
    watcher.note("the true parameters are the nominal ones; --parameters gives others");
  Dataset d;
  d.robot = known.robot;
  d.name = "simulated_" + known.name;
  d.description = fmt::format("simulated drives of {}, true parameters known", known.name);
  d.provenance = {"simulated by odobench",
                  "none stated",
                  fmt::format("bench simulate --robot={} --seed={}", known.name, study.seed),
                  {}};
  const auto repeat = static_cast<std::size_t>(study.repeat);
  d.recordings.resize(drives.size() * repeat);
  of_robot([&] {
    parallel_for(
        d.recordings.size(), study.threads,
        [&](std::size_t i) {
          d.recordings[i] = driven(simulator, drives[i / repeat], can, truth.values, nominal, study.seed,
                                   static_cast<int>(i % repeat) + 1)
                                .recording;
        },
        stop);
  });
  for (const RobotDrive& drive : drives) d.trajectories.push_back({drive.name, drive.description});
  d.known_parameters = {{"truth", "the parameters that the drives were made with",
                         std::vector<double>(truth.values.begin(), truth.values.end())}};
  return d;
}

}  // namespace odobench
