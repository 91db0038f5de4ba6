#include "bench/studies/calibration/wall_remark.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/range.hpp"
#include "solvers/solve.hpp"

namespace odobench {
namespace {

constexpr double kLeastTurn = 1;  // rad
constexpr double kNoFactor = 0.02;
constexpr double kAgreement = 0.1;  // of the drives
constexpr double kExplained = 0.1;  // of the cost

// How much further the robot turned than odometry says, where all drives that turn agree; else 1.
double common_turning_factor(const CalibrationProblem& problem, const Vector& z) {
  double both = 0, own = 0, least = kInfinity, most = -kInfinity;
  for (std::size_t i = 0; i < problem.recordings().size(); ++i) {
    const Reference& reference = problem.recordings()[i].reference;
    if (!reference.sample.empty()) continue;  // turns are not counted there
    const double turned = reference.theta.back() - reference.theta.front();
    if (std::abs(turned) < kLeastTurn) continue;
    const PoseTrack track = problem.integrate(i, z);
    const double said = track.theta.back() - track.theta.front();
    both += turned * said;
    own += said * said;
    least = std::min(least, turned / said);
    most = std::max(most, turned / said);
  }
  if (!(own > 0)) return 1;
  const double factor = both / own;
  return most - least < kAgreement * std::abs(factor) ? factor : 1;
}

// One factor for all lengths of a kind: "a" of a1..a4, "r" of r_right and r_left.
std::string kind_of(const std::string& name) {
  return name.substr(0, name.find_first_of("_0123456789"));
}

// J of the nominal parameters times a factor for each kind.
class ScaledNominal {
 public:
  explicit ScaledNominal(const CalibrationProblem& problem) : problem_(problem) {
    for (const ParameterInfo& p : problem.parameters()) {
      std::size_t kind = 0;
      while (kind < kinds_.size() && kinds_[kind].name != kind_of(p.name)) ++kind;
      // What is 0 has no factor, what is an angle no scale.
      const bool scales = p.nominal != 0 && p.unit != "rad";
      if (scales && kind == kinds_.size()) kinds_.push_back({kind_of(p.name), "", 1, 0.05, 20});
      of_.push_back(scales ? static_cast<Eigen::Index>(kind) : -1);
    }
  }

  std::string name() const { return "factors of nominal parameters"; }
  const std::vector<ParameterInfo>& parameters() const { return kinds_; }
  Vector scaled(const ConstVectorRef& factors) const {
    Vector z(static_cast<Eigen::Index>(of_.size()));
    for (std::size_t i = 0; i < of_.size(); ++i)
      z[static_cast<Eigen::Index>(i)] = problem_.parameters()[i].nominal * (of_[i] < 0 ? 1 : factors[of_[i]]);
    return z;
  }
  double cost(const ConstVectorRef& factors) const { return problem_.cost(scaled(factors)); }
  void normal_equations(const ConstVectorRef& factors, NormalEquations& out) const {
    NormalEquations all;
    problem_.normal_equations(scaled(factors), all);
    Matrix by = Matrix::Zero(static_cast<Eigen::Index>(of_.size()), static_cast<Eigen::Index>(kinds_.size()));
    for (std::size_t i = 0; i < of_.size(); ++i)
      if (of_[i] >= 0) by(static_cast<Eigen::Index>(i), of_[i]) = problem_.parameters()[i].nominal;
    out.cost = all.cost;
    out.jtr = by.transpose() * all.jtr;
    out.jtj = by.transpose() * all.jtj * by;
  }
  // The other factors stay 1.
  ScaledNominal alone(std::size_t kind) const {
    ScaledNominal one = *this;
    for (std::size_t k = 0; k < one.kinds_.size(); ++k)
      if (k != kind) one.kinds_[k].lower = one.kinds_[k].upper = 1;
    return one;
  }
  // "b1, b2, b3, b4".
  std::string members(std::size_t kind) const {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < of_.size(); ++i)
      if (of_[i] == static_cast<Eigen::Index>(kind)) names.push_back(problem_.parameters()[i].name);
    return fmt::format("{}", fmt::join(names, ", "));
  }
  // Whether a parameter of the kind leaves its box by this factor.
  bool leaves(std::size_t kind, double factor) const {
    for (std::size_t i = 0; i < of_.size(); ++i) {
      const ParameterInfo& p = problem_.parameters()[i];
      const double value = p.nominal * factor;
      if (of_[i] == static_cast<Eigen::Index>(kind) && (value < p.lower || value > p.upper)) return true;
    }
    return false;
  }

 private:
  const CalibrationProblem& problem_;
  std::vector<ParameterInfo> kinds_;
  std::vector<Eigen::Index> of_;  // kind of each parameter, -1: none
};

// The factor of one kind alone that brings the cost below what counts as an explanation, the best of
// them, with what it leaves of the cost; "" where none does. Several at once would find combinations that
// drives do not tell apart.
std::string kind_that_leaves(const CalibrationProblem& problem, double cost) {
  const ScaledNominal all(problem);
  std::string text;
  double lowest = kExplained * cost;
  for (std::size_t k = 0; k < all.parameters().size(); ++k) {
    const auto one = std::make_shared<const ScaledNominal>(all.alone(k));
    const Vector ones = Vector::Ones(static_cast<Eigen::Index>(all.parameters().size()));
    const Result found = solve(Problem(one), parse_solver_list("lm").front(), ones, {});
    const double factor = found.usable() ? found.x[static_cast<Eigen::Index>(k)] : 1;
    if (!found.usable() || !(found.cost < lowest) || !all.leaves(k, factor)) continue;
    lowest = found.cost;
    text =
        fmt::format("; {} times {:.3g}, which their box does not allow, bring J from {:.4g} to {:.4g} alone",
                    all.members(k), factor, cost, found.cost);
  }
  return text;
}

}  // namespace

std::string wall_remark(const LoadedProblem& loaded, const RunRecord& record) {
  if (!loaded.calibration || !record.cost || record.parameters.empty()) return "";
  std::vector<std::string> walls;
  Vector z(static_cast<Eigen::Index>(record.parameters.size()));
  for (std::size_t i = 0; i < record.parameters.size(); ++i) {
    z[static_cast<Eigen::Index>(i)] = record.parameters[i].value;
    if (!record.parameters[i].at_bound.empty()) walls.push_back(record.parameters[i].name);
  }
  const double factor = walls.empty() ? 1 : common_turning_factor(*loaded.calibration, z);
  if (!(std::abs(factor - 1) > kNoFactor)) return "";
  std::string text = fmt::format(
      "{} end on bounds, and the robot turned {:.3g} times as far as the wheels say: a common factor of all "
      "turns, as of a track, a wheelbase or radii entered wrongly",
      fmt::join(walls, ", "), factor);
  if (loaded.calibration->options().mount) return text;
  return text + kind_that_leaves(*loaded.calibration, *record.cost);
}

}  // namespace odobench
