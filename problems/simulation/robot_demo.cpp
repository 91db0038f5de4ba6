#include "problems/simulation/robot_demo.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/angle.hpp"
#include "base/random.hpp"
#include "datasets/robots/layouts.hpp"
#include "problems/simulation/robot_simulator.hpp"

namespace odobench {
namespace {

constexpr int kRepetitions = 3;

// Parameters a little off their nominal values, with digits that people can compare.
Vector made_up_truth(const Robot& robot, Random& noise) {
  Vector z = nominal_values(robot);
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const RobotParameter& p = robot.parameters[static_cast<std::size_t>(i)];
    if (p.lower == p.upper) continue;
    const double share = noise.uniform(-1, 1);
    const double off = p.unit == "m" ? z[i] + 0.04 * share * (z[i] != 0 ? z[i] : 0.1 * (p.upper - p.lower))
                       : p.unit == "rad" ? z[i] + 2 * kDegree * share
                                         : z[i] * (1 + 0.03 * share);
    z[i] = std::clamp(std::round(off * 1e7) / 1e7, p.lower, p.upper);
  }
  return z;
}

}  // namespace

Dataset make_robot_demo(const std::string& kinematics, std::uint64_t seed) {
  Dataset d;
  d.robot = robot_of_class(kinematics, {});
  d.name = "demo_" + kinematics;
  d.description = fmt::format("made up: {}, true parameters known", robots::layout(kinematics).description);
  d.provenance = {"made by odobench, problems/simulation/robot_demo.hpp",
                  "MIT",
                  fmt::format("bench demo --robot={} --seed={}", kinematics, seed),
                  {}};
  const RobotSimulator simulator(d.robot);
  Random of_truth(mixed_seed(seed, 1'000'000));
  const Vector truth = made_up_truth(d.robot, of_truth);
  const RobotAbilities can = simulator.abilities(truth);
  for (const RobotDrive& drive : standard_drives(can)) {
    d.trajectories.push_back({drive.name, drive.description});
    for (int repetition = 1; repetition <= kRepetitions; ++repetition) {
      Random noise(mixed_seed(seed, d.recordings.size()));
      Recording r = simulator.record(drive, can, truth, truth, noise).recording;
      r.trajectory = drive.name;
      r.repetition = repetition;
      r.id = fmt::format("{}_{}", drive.name, repetition);
      d.recordings.push_back(std::move(r));
    }
  }
  d.known_parameters = {{"truth", "the parameters that the drives were made with",
                         std::vector<double>(truth.begin(), truth.end())}};
  return d;
}

}  // namespace odobench
