#include "problems/trust/twist_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/angle.hpp"
#include "problems/information/combinations.hpp"
#include "problems/robots/wheeled_robot.hpp"

namespace odobench {

using Eigen::Index;
using Eigen::Vector3d;

namespace {

constexpr double kUnmoved = 1e-9;  // change of an entry by a relative change of a parameter of 1
constexpr double kSame = 1e-12;    // of two entries and their gradients
constexpr double kLinear = 1e-9;   // |u - M u_cmd| for commands of size 1

// A robot with its numbers among those of a problem.
class RobotAt {
 public:
  RobotAt(const Robot& robot, const std::vector<ParameterInfo>& parameters)
      : robot_(robot.table), nominal_(robot_.nominal()), count_(static_cast<Index>(parameters.size())) {
    for (const RobotParameter& own : robot_.parameters()) {
      Index at = -1;
      for (Index i = 0; i < count_; ++i)
        if (parameters[static_cast<std::size_t>(i)].name == own.name) at = i;
      places_.push_back(at);
    }
  }
  const robots::WheeledRobot& robot() const { return robot_; }

  // Throws std::invalid_argument for a twist that the robot cannot do.
  Vector signals(const Vector3d& command) const { return robot_.inverse(command, nominal_); }
  Vector3d twist(const Vector& signals, const ConstVectorRef& z) const {
    Matrix out(3, 1);
    robot_.twists(signals, numbers(z), out);
    return out;
  }
  // gradient: 3 x parameters of the problem.
  Vector3d twist(const Vector& signals, const ConstVectorRef& z, Matrix& gradient) const {
    Matrix out(3, 1), own(3, nominal_.size());
    robot_.twists_and_jacobian(signals, numbers(z), out, own);
    gradient = Matrix::Zero(3, count_);
    for (std::size_t k = 0; k < places_.size(); ++k)
      if (places_[k] >= 0) gradient.col(places_[k]) += own.col(static_cast<Index>(k));
    return out;
  }

 private:
  Vector numbers(const ConstVectorRef& z) const {
    Vector own = nominal_;
    for (std::size_t k = 0; k < places_.size(); ++k)
      if (places_[k] >= 0) own[static_cast<Index>(k)] = z[places_[k]];
    return own;
  }

  robots::WheeledRobot robot_;
  Vector nominal_;
  std::vector<Index> places_;
  Index count_;
};

enum class Direction { X, Y, Turn, Left, Right };

struct Column {
  Direction direction;
  Vector3d command;
  Vector signals;
};

bool add_if_possible(const RobotAt& robot, Direction direction, const Vector3d& command,
                     std::vector<Column>& columns) {
  try {
    columns.push_back({direction, command, robot.signals(command)});
    return true;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

// Curvature of arcs, 1/m; 0 where no wheel is steered away from the origin.
double arc_curvature(const Robot& robot) {
  std::vector<double> nominal;
  for (const BoundParameter& p : robot.table.parameters) nominal.push_back(p.parameter.nominal);
  double farthest = 0;
  for (const Wheel& wheel : wheels_with(robot.table, nominal))
    if (!wheel.steering.empty()) farthest = std::max(farthest, std::hypot(wheel.x, wheel.y));
  return farthest > 0 ? 1 / (2 * farthest) : 0;
}

std::vector<Column> columns_of(const Robot& robot, const RobotAt& at, std::vector<std::string>& remarks) {
  std::vector<Column> columns;
  add_if_possible(at, Direction::X, {1, 0, 0}, columns);
  const bool sideways = add_if_possible(at, Direction::Y, {0, 1, 0}, columns);
  if (!sideways) remarks.emplace_back("This robot cannot be driven sideways.");
  const double curvature = sideways ? 0 : arc_curvature(robot);
  if (curvature == 0) {
    if (!add_if_possible(at, Direction::Turn, {0, 0, 1}, columns))
      remarks.emplace_back("This robot cannot turn on the spot.");
    return columns;
  }
  add_if_possible(at, Direction::Left, {1, 0, curvature}, columns);
  add_if_possible(at, Direction::Right, {1, 0, -curvature}, columns);
  remarks.push_back(fmt::format("Arcs are of {:.3g} m radius.", 1 / curvature));
  return columns;
}

const char* ending(Direction direction) {
  switch (direction) {
    case Direction::X:
      return " along x";
    case Direction::Y:
      return " along y";
    case Direction::Left:
      return " on a left arc";
    case Direction::Right:
      return " on a right arc";
    case Direction::Turn:
      break;
  }
  return "";
}

std::string name_of_entry(Direction direction, Index row) {
  if (direction == Direction::Left || direction == Direction::Right) {
    constexpr std::array<const char*, 3> kRows = {"path", "drift", "turn"};
    return fmt::format("{}_{}", direction == Direction::Left ? "left" : "right",
                       kRows[static_cast<std::size_t>(row)]);
  }
  const int column = direction == Direction::X ? 1 : direction == Direction::Y ? 2 : 3;
  return fmt::format("m{}{}", row + 1, column);
}

TwistNumber described(Direction direction, Index row) {
  TwistNumber number;
  number.name = name_of_entry(direction, row);
  const bool arc = direction == Direction::Left || direction == Direction::Right;
  const Index along = direction == Direction::Y ? 1 : 0;
  if (direction == Direction::Turn) {
    number.entry = row == 2 ? TwistEntry::Turn : TwistEntry::Shift;
    number.words = row == 2   ? "turn factor"
                   : row == 0 ? "shift forward per turn"
                              : "shift to the left per turn";
  } else if (row == 2) {
    number.entry = arc ? TwistEntry::Turn : TwistEntry::Swing;
    number.words = std::string(arc ? "turn factor" : "turn per metre") + ending(direction);
  } else {
    number.entry = row == along ? TwistEntry::Path : TwistEntry::Drift;
    number.words = (row == along ? std::string("path factor")
                    : along == 0 ? std::string("drift to the left per metre")
                                 : std::string("drift forward per metre")) +
                   ending(direction);
  }
  number.unit = number.entry == TwistEntry::Swing   ? "rad/m"
                : number.entry == TwistEntry::Shift ? "m/rad"
                : number.entry == TwistEntry::Drift ? "m/m"
                                                    : "";
  return number;
}

// Relative to the command where it is one (a turn on an arc is that over its curvature).
double unit_of_entry(const Column& column, Index row) {
  return row == 2 && column.command[2] != 0 ? column.command[2] : 1;
}

// Points of the box that show whether a parameter moves anything.
std::vector<Vector> points(const std::vector<ParameterInfo>& parameters, const ConstVectorRef& z) {
  std::vector<Vector> list = {z};
  for (int k = 1; k <= 2; ++k) {
    Vector other = z;
    for (Index i = 0; i < other.size(); ++i) {
      const ParameterInfo& p = parameters[static_cast<std::size_t>(i)];
      other[i] = p.nominal + 0.3 * (p.upper - p.lower) * std::sin(k + 1.7 * static_cast<double>(i));
    }
    list.push_back(std::move(other));
  }
  return list;
}

// Sensitivity of the rows of a column to relative changes of free parameters.
Vector3d sensitivity(const RobotAt& at, const Column& column, const std::vector<ParameterInfo>& parameters,
                     const ConstVectorRef& z) {
  const Vector scale = relative_scales(parameters);
  Vector3d most = Vector3d::Zero();
  for (const Vector& point : points(parameters, z)) {
    Matrix gradient;
    at.twist(column.signals, point, gradient);
    for (Index i = 0; i < scale.size(); ++i) {
      const ParameterInfo& p = parameters[static_cast<std::size_t>(i)];
      if (p.lower < p.upper) most = most.cwiseMax((gradient.col(i) * scale[i]).cwiseAbs());
    }
  }
  return most;
}

// The path factor of driving along x and y is one number where they are always the same.
void merge_path_factors(std::vector<TwistNumber>& numbers) {
  TwistNumber* x = nullptr;
  for (auto at = numbers.begin(); at != numbers.end(); ++at) {
    if (at->name == "m11") x = &*at;
    if (at->name != "m22" || x == nullptr) continue;
    const double apart =
        std::max(std::abs(x->value - at->value), (x->gradient - at->gradient).cwiseAbs().maxCoeff() /
                                                     std::max(1.0, x->gradient.cwiseAbs().maxCoeff()));
    if (apart > kSame) return;
    x->words = "path factor";
    numbers.erase(at);
    return;
  }
}

bool is_linear(const RobotAt& at, const std::vector<Column>& columns, const ConstVectorRef& z) {
  constexpr std::array<std::array<double, 3>, 3> kWeights = {
      {{0.3, 0.5, 0.2}, {0.6, 0.1, 0.9}, {0.1, 0.8, 0.4}}};
  for (const auto& weights : kWeights) {
    Vector3d command = Vector3d::Zero(), expected = Vector3d::Zero();
    for (std::size_t k = 0; k < columns.size(); ++k) {
      command += weights[k] * columns[k].command;
      expected += weights[k] * at.twist(columns[k].signals, z);
    }
    if ((at.twist(at.signals(command), z) - expected).norm() > kLinear) return false;
  }
  return true;
}

}  // namespace

TwistMap twist_map(const Robot& robot, const std::vector<ParameterInfo>& parameters,
                   const ConstVectorRef& z) {
  const RobotAt at(robot, parameters);
  TwistMap map;
  Vector nominal(z.size());
  for (Index i = 0; i < z.size(); ++i) nominal[i] = parameters[static_cast<std::size_t>(i)].nominal;
  const std::vector<Column> columns = columns_of(robot, at, map.remarks);
  std::string still;
  for (const Column& column : columns) {
    Matrix gradient;
    const Vector3d twist = at.twist(column.signals, z, gradient);
    const Vector3d before = at.twist(column.signals, nominal);
    const Vector3d moves = sensitivity(at, column, parameters, z);
    for (Index row = 0; row < 3; ++row) {
      TwistNumber number = described(column.direction, row);
      const double unit = unit_of_entry(column, row);
      number.nominal = before[row] / unit;
      number.value = twist[row] / unit;
      number.gradient = gradient.row(row).transpose() / unit;
      if (moves[row] > kUnmoved)
        map.numbers.push_back(std::move(number));
      else
        still += (still.empty() ? "" : ", ") + number.words;
    }
  }
  merge_path_factors(map.numbers);
  map.linear = is_linear(at, columns, z);
  if (!still.empty()) map.remarks.push_back("No free parameter moves: " + still + ".");
  if (!map.linear)
    map.remarks.emplace_back(
        "Commands between these are not exactly their combinations for this robot: the numbers hold for "
        "these "
        "commands.");
  return map;
}

Matrix twist_matrix(const Robot& robot, const std::vector<ParameterInfo>& parameters,
                    const ConstVectorRef& z) {
  const RobotAt at(robot, parameters);
  Matrix matrix = Matrix::Constant(3, 3, std::numeric_limits<double>::quiet_NaN());
  for (Index k = 0; k < 3; ++k) {
    try {
      matrix.col(k) = at.twist(at.signals(Vector3d::Unit(k)), z);
    } catch (const std::invalid_argument&) {
      continue;  // a command that the robot cannot do
    }
  }
  return matrix;
}

ReadableUnit readable_unit(TwistEntry entry) {
  switch (entry) {
    case TwistEntry::Path:
    case TwistEntry::Turn:
      return {"%", 100};
    case TwistEntry::Swing:
      return {"deg/m", 1 / kDegree};
    case TwistEntry::Shift:
      return {"mm/turn", 1000 * 2 * kPi};
    case TwistEntry::Drift:
      break;
  }
  return {"mm/m", 1000};
}

std::string words_with(const TwistNumber& number, double half_width) {
  const ReadableUnit unit = readable_unit(number.entry);
  const bool factor = number.entry == TwistEntry::Path || number.entry == TwistEntry::Turn;
  const double shown = unit.per_unit * (factor ? number.value - number.nominal : number.value);
  std::string what = number.words;
  if (const auto at = what.find(" factor"); at != std::string::npos) what.erase(at, 7);
  for (const char* per : {" per metre", " per turn"})
    if (const auto at = what.find(per); at != std::string::npos) what.erase(at, std::string(per).size());
  // Two digits of the half width.
  const double half = unit.per_unit * half_width;
  if (!(half > 0) || !std::isfinite(half)) return fmt::format("{} {:+.2f} {}", what, shown, unit.unit);
  const int digits = std::clamp(1 - static_cast<int>(std::floor(std::log10(half))), 0, 9);
  return fmt::format("{} {:+.{}f} +- {:.{}f} {}", what, shown, digits, half, digits, unit.unit);
}

}  // namespace odobench
