#include "tests/support/data/rival_truth.hpp"

#include <cmath>
#include <stdexcept>

#include "bench/studies/planning/drive_predictions.hpp"
#include "problems/calibration/models/model_terms.hpp"
#include "problems/simulation/robot_simulator.hpp"

namespace odobench::testing {
namespace {

RobotDrive drive_named(const RobotAbilities& can, const std::string& name) {
  std::vector<RobotDrive> drives = known_drives(can);
  for (RobotDrive& d : small_circles(can)) drives.push_back(std::move(d));
  for (RobotDrive& d : drives)
    if (d.name == name) return d;
  throw std::invalid_argument("no drive " + name);
}

// The track with white increments in the body frame.
Reference disturbed(const PoseTrack& track, const PathNoise& noise, Random& random) {
  Reference out;
  double x = track.x[0], y = track.y[0], theta = track.theta[0];
  for (std::size_t k = 0; k < track.x.size(); ++k) {
    if (k > 0) {
      const double before = track.theta[k - 1], c = std::cos(before), s = std::sin(before);
      const double dx = track.x[k] - track.x[k - 1], dy = track.y[k] - track.y[k - 1];
      const double way = std::hypot(dx, dy), turned = track.theta[k] - before;
      const double ahead = c * dx + s * dy + random.normal(noise.position) * std::sqrt(way),
                   left = -s * dx + c * dy + random.normal(noise.position) * std::sqrt(way);
      x += std::cos(theta) * ahead - std::sin(theta) * left;
      y += std::sin(theta) * ahead + std::cos(theta) * left;
      theta += turned + random.normal(noise.heading) * std::sqrt(way) +
               random.normal(noise.turn) * std::sqrt(std::abs(turned));
    }
    out.x.push_back(x + random.normal(noise.capture));
    out.y.push_back(y + random.normal(noise.capture));
    out.theta.push_back(theta + random.normal(noise.capture));
  }
  return out;
}

}  // namespace

RivalTruth rival_truth(const std::string& robot_class, const std::vector<std::string>& model, double extra) {
  RivalTruth truth;
  truth.robot = robot_of_class(robot_class, {});
  truth.options.rule = truth.robot.rule;
  truth.options.model = model_terms(model);
  const Robot full = with_model(truth.robot, truth.options.model);
  std::vector<RobotParameter> parameters = full.parameters;
  for (const RobotParameter& p : parameters_beyond_table(truth.options.model, false)) parameters.push_back(p);
  truth.z.resize(static_cast<Eigen::Index>(parameters.size()));
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const RobotParameter& p = parameters[i];
    const double side = i % 3 == 0 ? 0.25 : i % 3 == 1 ? -0.2 : 0.1;
    truth.z[static_cast<Eigen::Index>(i)] = p.nominal + side * (p.upper - p.lower) / 2;
  }
  truth.z[truth.z.size() - 1] = extra;
  return truth;
}

std::vector<Recording> true_recordings(const RivalTruth& truth, const std::vector<std::string>& drives,
                                       int repetitions, const PathNoise& noise, std::uint64_t seed) {
  const RobotAbilities can = RobotSimulator(truth.robot).abilities(nominal_values(truth.robot));
  std::vector<Recording> all;
  for (const std::string& name : drives) {
    const Recording exact = commanded_recording(truth.robot, drive_named(can, name), can, {});
    for (int k = 1; k <= repetitions; ++k) {
      all.push_back(exact);
      all.back().id = name + "_" + std::to_string(k);
      all.back().repetition = k;
    }
  }
  std::vector<Recording> of_kind = all;  // a factor needs one of its kind
  if (!truth.options.model.speed_factor_of.empty()) {
    of_kind.push_back(commanded_recording(truth.robot, drive_named(can, "turn_cw"), can, {}));
    of_kind.back().id = "of_kind";
  }
  const CalibrationProblem problem(truth.robot, of_kind, truth.options);
  for (std::size_t i = 0; i < all.size(); ++i) {
    Random random(derive_seed(seed, {"truth", all[i].id}));
    all[i].reference = disturbed(problem.integrate(i, truth.z), noise, random);
  }
  return all;
}

}  // namespace odobench::testing
