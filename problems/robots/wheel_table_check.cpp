#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "problems/robots/wheeled_robot.hpp"

namespace odobench::robots {
namespace {

[[noreturn]] void refuse_table(const std::string& what) {
  throw std::invalid_argument("robot: " + what);
}

// Counted from 1, as people and messages do.
std::string wheel_name(std::size_t index) {
  return fmt::format("wheel {}", index + 1);
}

void check_wheel(const Wheel& w, const std::string& name) {
  for (std::size_t f = 0; f < kWheelFieldNames.size(); ++f)
    if (!std::isfinite(w.*kWheelFieldMembers[f]))
      refuse_table(fmt::format("{}: {} is not finite", name, kWheelFieldNames[f]));
  std::set<std::string> names;
  for (const DriveSignal& signal : w.drive) {
    if (signal.name.empty()) refuse_table(name + ": a drive signal without a name");
    if (!std::isfinite(signal.weight) || signal.weight == 0)
      refuse_table(fmt::format("{}: weight {} of drive signal '{}', expected a number other than 0", name,
                               signal.weight, signal.name));
    if (!names.insert(signal.name).second)
      refuse_table(fmt::format("{}: drive signal '{}' is listed twice", name, signal.name));
  }
  if (w.steering.empty() && w.zero != 0) refuse_table(name + ": a steering zero, but no steering signal");
}

void check_parameter(const RobotParameter& p, std::set<std::string>& names) {
  if (p.name.empty()) refuse_table("a parameter without a name");
  if (!names.insert(p.name).second) refuse_table(fmt::format("parameter '{}' is listed twice", p.name));
  if (p.unit != "m" && p.unit != "rad" && p.unit != "ratio")
    refuse_table(fmt::format("parameter '{}': unit '{}', expected 'm', 'rad' or 'ratio'", p.name, p.unit));
  if (!std::isfinite(p.nominal) || !std::isfinite(p.lower) || !std::isfinite(p.upper) ||
      p.lower > p.nominal || p.nominal > p.upper)
    refuse_table(
        fmt::format("parameter '{}': lower {}, nominal {}, upper {}, expected lower <= nominal <= upper",
                    p.name, p.lower, p.nominal, p.upper));
}

// Why a change of this field would change nothing; "" when it does.
std::string no_effect(const Wheel& w, WheelField field) {
  if (w.drive.empty() && w.slides) return "neither drives nor holds its side";
  const bool of_drive = field == WheelField::Radius || field == WheelField::Roller;
  if (of_drive && w.drive.empty()) return "has no drive signal";
  const bool of_steering = field == WheelField::Zero || field == WheelField::Gain;
  if (of_steering && w.steering.empty()) return "is not steered";
  return "";
}

void check_bindings(const WheelTable& table, const BoundParameter& bound) {
  const std::string name = fmt::format("parameter '{}'", bound.parameter.name);
  if (bound.bindings.empty()) refuse_table(name + " is bound to nothing");
  std::set<std::pair<std::size_t, WheelField>> seen;
  for (const Binding& b : bound.bindings) {
    if (b.wheel >= table.wheels.size())
      refuse_table(fmt::format("{} is bound to wheel {} of {}", name, b.wheel + 1, table.wheels.size()));
    const std::string where = fmt::format("{} of {}", name_of(b.field), wheel_name(b.wheel));
    if (!std::isfinite(b.factor) || b.factor == 0)
      refuse_table(fmt::format("{}: factor {} on {}, expected a number other than 0", name, b.factor, where));
    if (!seen.emplace(b.wheel, b.field).second)
      refuse_table(fmt::format("{} is bound twice to {}", name, where));
    const std::string why = no_effect(table.wheels[b.wheel], b.field);
    if (!why.empty()) refuse_table(fmt::format("{} is bound to {}, which {}", name, where, why));
  }
}

double nominal_field(const WheelTable& table, std::size_t wheel, WheelField field) {
  double value = field_of(table.wheels[wheel], field);
  for (const BoundParameter& bound : table.parameters)
    for (const Binding& b : bound.bindings)
      if (b.wheel == wheel && b.field == field) value += b.factor * bound.parameter.nominal;
  return value;
}

bool is_bound(const WheelTable& table, std::size_t wheel, WheelField field) {
  return std::any_of(table.parameters.begin(), table.parameters.end(), [&](const BoundParameter& bound) {
    return std::any_of(bound.bindings.begin(), bound.bindings.end(),
                       [&](const Binding& b) { return b.wheel == wheel && b.field == field; });
  });
}

void check_mean(const WheelTable& table) {
  for (std::size_t i = 0; i < table.wheels.size(); ++i) {
    const Wheel& w = table.wheels[i];
    const bool roller = w.roller != 0 || is_bound(table, i, WheelField::Roller);
    if (w.drive.empty() || w.steering.empty() || w.slides || roller)
      refuse_table(
          fmt::format("the mean is for wheels that are steered and driven, have no rollers and do not "
                      "slide; {} is not",
                      wheel_name(i)));
  }
}

// A signal either drives or steers.
void check_kinds(const WheelTable& table) {
  std::set<std::string> drives;
  for (const Wheel& w : table.wheels)
    for (const DriveSignal& signal : w.drive) drives.insert(signal.name);
  for (std::size_t i = 0; i < table.wheels.size(); ++i)
    if (drives.contains(table.wheels[i].steering))
      refuse_table(
          fmt::format("{} is steered by '{}', which drives", wheel_name(i), table.wheels[i].steering));
}

}  // namespace

void check(const WheelTable& table) {
  if (table.wheels.empty()) refuse_table("no wheels");
  std::size_t rows = 0, drives = 0;
  for (std::size_t i = 0; i < table.wheels.size(); ++i) {
    check_wheel(table.wheels[i], wheel_name(i));
    drives += table.wheels[i].drive.empty() ? 0 : 1;
    rows += (table.wheels[i].drive.empty() ? 0 : 1) + (table.wheels[i].slides ? 0 : 1);
  }
  std::set<std::string> names;
  for (const BoundParameter& bound : table.parameters) {
    check_parameter(bound.parameter, names);
    check_bindings(table, bound);
  }
  check_kinds(table);
  if (drives == 0) refuse_table("no wheel has a drive signal");
  for (std::size_t i = 0; i < table.wheels.size(); ++i)
    if (!table.wheels[i].drive.empty() && nominal_field(table, i, WheelField::Radius) == 0)
      refuse_table(fmt::format("{} is driven, but its radius is 0", wheel_name(i)));
  if (table.rule == TwistRule::Mean) return check_mean(table);
  if (rows < 3)
    refuse_table(fmt::format("{} wheels state {} equations, expected 3 or more", table.wheels.size(), rows));
}

}  // namespace odobench::robots
