#include "problems/suites/robot_problems.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <memory>
#include <stdexcept>
#include <utility>

#include "datasets/robots/layouts.hpp"
#include "problems/calibration/calibration_problem.hpp"
#include "problems/robots/wheeled_robot.hpp"
#include "problems/simulation/robot_demo.hpp"

namespace odobench {
namespace {

constexpr const char* kPrefix = "robots:";

// What a step may not see: directions this much flatter than the steepest, parameters scaled by their boxes.
constexpr double kFlat = 1e-12;

struct RobotProblem {
  std::string label;
  std::shared_ptr<const CalibrationProblem> calibration;
  Vector minimiser;  // empty: not known
  double lowest = 0;

  std::string name() const { return label; }
  const std::vector<ParameterInfo>& parameters() const { return calibration->parameters(); }
  double cost(const ConstVectorRef& z) const { return calibration->cost(z); }
  Eigen::Index residual_count() const { return calibration->residual_count(); }
  void residuals(const ConstVectorRef& z, VectorRef r) const { calibration->residuals(z, r); }
  void residuals_and_jacobian(const ConstVectorRef& z, VectorRef r, MatrixRef j) const {
    calibration->residuals_and_jacobian(z, r, j);
  }
  void normal_equations(const ConstVectorRef& z, NormalEquations& out) const {
    calibration->normal_equations(z, out);
  }
  void batch_cost(const ConstMatrixRef& candidates, VectorRef costs) const {
    calibration->batch_cost(candidates, costs);
  }
  double rounding_floor(const ConstVectorRef& z) const { return calibration->rounding_floor(z); }
  std::optional<double> known_optimum() const {
    return minimiser.size() == 0 ? std::nullopt : std::optional(lowest);
  }
  std::vector<Vector> known_minimisers() const {
    return minimiser.size() == 0 ? std::vector<Vector>{} : std::vector<Vector>{minimiser};
  }
};

// -(J'J)^+ J'r in units of the boxes' widths.
Vector gauss_newton_step(const CalibrationProblem& problem, const Vector& z) {
  Vector width(z.size());
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const ParameterInfo& p = problem.parameters()[static_cast<std::size_t>(i)];
    width[i] = p.upper - p.lower;
  }
  NormalEquations e;
  problem.normal_equations(z, e);
  const Eigen::SelfAdjointEigenSolver<Matrix> spectrum(width.asDiagonal() * e.jtj * width.asDiagonal());
  Vector along = spectrum.eigenvectors().transpose() * width.cwiseProduct(e.jtr);
  for (Eigen::Index i = 0; i < along.size(); ++i) {
    const double value = spectrum.eigenvalues()[i];
    along[i] = value > kFlat * spectrum.eigenvalues()[z.size() - 1] ? -along[i] / value : 0;
  }
  return width.cwiseProduct(spectrum.eigenvectors() * along);
}

bool inside(const std::vector<ParameterInfo>& box, const Vector& z) {
  for (std::size_t i = 0; i < box.size(); ++i) {
    const double value = z[static_cast<Eigen::Index>(i)];
    if (!(value >= box[i].lower && value <= box[i].upper)) return false;
  }
  return true;
}

void find_optimum(Vector z, RobotProblem& problem) {
  double cost = problem.cost(z);
  for (int iteration = 0; iteration < 50; ++iteration) {
    Vector step = gauss_newton_step(*problem.calibration, z);
    Vector next = z + step;
    for (int halved = 0; halved < 20 && inside(problem.parameters(), next) && !(problem.cost(next) < cost);
         ++halved) {
      step /= 2;
      next = z + step;
    }
    if (!inside(problem.parameters(), next)) return;
    const double lower = problem.cost(next);
    if (!(lower < cost)) break;
    z = next;
    cost = lower;
  }
  problem.minimiser = z;
  problem.lowest = cost;
}

}  // namespace

std::vector<ClassicEntry> robot_problem_entries() {
  std::vector<ClassicEntry> list;
  for (const robots::Layout& layout : robots::layouts()) {
    const robots::WheeledRobot robot(robots::make_robot(layout));
    const int n = static_cast<int>(robot.parameters().size());
    ClassicEntry entry{kPrefix + layout.name,
                       "robots",
                       n,
                       DimensionRule::exactly(n),
                       0,
                       "simulated drives, " + layout.description,
                       std::nullopt};
    entry.instances = kRobotInstances;
    entry.hard = layout.blind.empty() ? "noise; errors of the path add up"
                                      : "data barely tell: " + layout.blind.front();
    list.push_back(std::move(entry));
  }
  return list;
}

Problem make_robot_problem(const std::string& name, int instance, InstructionSet kernel) {
  if (!name.starts_with(kPrefix)) throw std::invalid_argument(fmt::format("unknown problem '{}'", name));
  if (instance < 1 || instance > kRobotInstances)
    throw std::invalid_argument(
        fmt::format("problem '{}': instance {}; expected 1..{}", name, instance, kRobotInstances));
  Dataset set =
      make_robot_demo(name.substr(std::string(kPrefix).size()), static_cast<std::uint64_t>(instance));
  std::erase_if(set.recordings, [](const Recording& r) { return r.repetition != 1; });
  CalibrationOptions options;
  options.rule = set.robot.rule;
  options.from_origin = set.robot.kinematics == "4wis4wid";
  RobotProblem problem;
  problem.label = name;
  problem.calibration =
      std::make_shared<const CalibrationProblem>(set.robot, std::move(set.recordings), options, kernel);
  const std::vector<double>& truth = set.known_parameters.front().values;
  find_optimum(Eigen::Map<const Vector>(truth.data(), static_cast<Eigen::Index>(truth.size())), problem);
  return Problem(std::move(problem));
}

}  // namespace odobench
