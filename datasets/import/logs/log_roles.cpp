#include "datasets/import/logs/log_roles.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <optional>

#include "base/text.hpp"
#include "datasets/csv/column_name.hpp"
#include "datasets/import/logs/reference_roles.hpp"
#include "datasets/robots/layouts.hpp"
#include "datasets/robots/robot.hpp"

namespace odobench::log_import {
namespace {

struct WheelSet {
  std::vector<Role> wheels, steering;
  std::string kinematics;
  bool by_place = false;
  int rank = 100;  // the lower the better
};

bool whole_numbers(const LogField& field) {
  return field.type.starts_with("int") || field.type.starts_with("uint") ||
         (field.type == "number" && !field.first.empty() &&
          field.first.find_first_not_of("0123456789-+") == std::string::npos);
}

bool numeric(const LogField& field) {
  return field.type != "string" && field.type != "text" && field.type != "time" &&
         field.type != "quaternion" && field.type != "bool";
}

std::string kind_of(const std::string& unit, bool steering) {
  if (steering) return "angle";
  if (unit == "rpm" || unit.ends_with("/s")) return "speed";
  return unit == "m" || unit == "mm" || unit == "cm" ? "travel" : "position";
}

int rank_of(const WheelSet& set) {
  if (set.kinematics.empty()) return 90;
  const Role& first = set.wheels.front();
  const int by_kind = first.kind == "position" ? (first.unit == "count" ? 1 : 0)
                      : first.kind == "speed"  ? 2
                                               : 3;
  return by_kind + (set.by_place ? 10 : 0);
}

// "wheel.1" -> "1".
std::string behind_dot(const std::string& signal) {
  const std::size_t dot = signal.find('.');
  return dot == std::string::npos ? "" : signal.substr(dot + 1);
}

// What of the class these roles are: by their own names, else by quadrants. False where they are not those of
// it.
bool fit_class(const std::string& robot, WheelSet& set) {
  const WheelTable table = robots::make_robot(robots::layout(robot));
  std::vector<double> nominal;
  for (const BoundParameter& p : table.parameters) nominal.push_back(p.parameter.nominal);
  std::map<std::string, std::string> drives, steers;  // which -> quadrant
  for (const Wheel& w : wheels_with(table, nominal)) {
    const std::string quadrant =
        w.x == 0 || w.y == 0 ? "" : std::string(w.x > 0 ? "F" : "R") + (w.y > 0 ? "L" : "R");
    for (const DriveSignal& d : w.drive) drives[behind_dot(d.name)] = quadrant;
    if (!w.steering.empty()) steers[behind_dot(w.steering)] = quadrant;
  }
  const auto fit = [](const std::map<std::string, std::string>& wanted, std::vector<Role>& roles) {
    if (roles.size() != wanted.size()) return false;
    for (const bool by_quadrant : {false, true}) {
      std::map<std::string, std::string> found;  // which of the class -> of the role
      for (const Role& role : roles)
        for (const auto& [which, quadrant] : wanted)
          if (by_quadrant ? !quadrant.empty() && quadrant == role.quadrant : which == role.which)
            found[which] = role.field;
      if (found.size() != wanted.size()) continue;
      for (Role& role : roles)
        for (const auto& [which, field] : found)
          if (field == role.field) role.which = which;
      return true;
    }
    return false;
  };
  return fit(drives, set.wheels) && fit(steers, set.steering);
}

void finish(WheelSet& set, const std::string& robot) {
  std::vector<std::string> driven, steered;
  for (const Role& role : set.wheels) driven.push_back(role.which);
  for (const Role& role : set.steering) steered.push_back(role.which);
  set.kinematics = class_of_wheels(driven, steered);
  if (!robot.empty() && !set.wheels.empty() && fit_class(robot, set)) set.kinematics = robot;
  set.rank = rank_of(set);
}

// "left" of "position[name=left]"; nothing for other paths.
std::optional<std::string> joint_of(const std::string& path, const std::string& array) {
  const std::string head = array + "[name=";
  if (!path.starts_with(head) || !path.ends_with("]")) return std::nullopt;
  return path.substr(head.size(), path.size() - head.size() - 1);
}

WheelSet joints(const LogSource& source, std::size_t number, const std::string& array,
                const std::string& robot) {
  WheelSet set;
  for (const LogField& field : source.fields) {
    const std::optional<std::string> joint = joint_of(field.path, array);
    if (!joint) continue;
    const ColumnName name = column_name(*joint);
    const bool steers = name.meaning == Meaning::Steering;
    if (!steers && name.meaning != Meaning::Wheel) continue;
    if (steers && array != "position") continue;
    const std::string unit = array == "velocity" ? "rad/s" : "rad";
    (steers ? set.steering : set.wheels)
        .push_back({name.which, number, field.path, "", kind_of(unit, steers), unit, name.quadrant});
  }
  finish(set, robot);
  return set;
}

WheelSet named(const LogSource& source, std::size_t number, const std::string& robot) {
  WheelSet set;
  for (const LogField& field : source.fields) {
    if (!numeric(field) || field.path.starts_with("header.") || field.path.starts_with("#")) continue;
    const ColumnName name = column_name(field.path);
    const bool steers = name.meaning == Meaning::Steering;
    if (!steers && (name.meaning != Meaning::Wheel || name.odometry)) continue;
    const bool fits = name.unit != "s" && name.unit != "ms" && name.unit != "us" && name.unit != "ns";
    std::string unit = fits ? name.unit : "";
    if (unit.empty() && whole_numbers(field)) unit = "count";
    (steers ? set.steering : set.wheels)
        .push_back({name.which, number, field.path, "", kind_of(unit, steers), unit, name.quadrant});
  }
  finish(set, robot);
  return set;
}

// Two numbers side by side: "count[0]", "count[1]", or two columns without names.
WheelSet pair_by_place(const LogSource& source, std::size_t number, const std::string& robot) {
  WheelSet set;
  set.by_place = true;
  std::vector<const LogField*> pair;
  std::string base;
  for (const LogField& field : source.fields) {
    if (!field.path.ends_with("[0]") || !numeric(field)) continue;
    const std::string array = field.path.substr(0, field.path.size() - 3);
    const auto element = [&](int i) -> const LogField* {
      const std::string path = fmt::format("{}[{}]", array, i);
      const auto found = std::find_if(source.fields.begin(), source.fields.end(),
                                      [&](const LogField& f) { return f.path == path; });
      return found == source.fields.end() ? nullptr : &*found;
    };
    if (element(1) == nullptr || element(2) != nullptr || array.find("covariance") != std::string::npos)
      continue;
    const bool angles = array.find("pos") != std::string::npos || array.find("angle") != std::string::npos;
    if (!pair.empty() && !angles) continue;
    pair = {&field, element(1)};
    base = array;
  }
  if (pair.empty() && source.fields.size() == 3 && source.fields[1].path == "#2")
    pair = {&source.fields[1], &source.fields[2]};
  if (pair.empty()) return set;
  const ColumnName name = column_name(base);
  std::string unit = name.unit;
  if (unit.empty() && whole_numbers(*pair[0]) && whole_numbers(*pair[1])) unit = "count";
  if (unit.empty()) unit = base.find("vel") != std::string::npos ? "rad/s" : "rad";
  set.wheels = {{"left", number, pair[0]->path, "", kind_of(unit, false), unit},
                {"right", number, pair[1]->path, "", kind_of(unit, false), unit}};
  finish(set, robot);
  return set;
}

WheelSet wheels_of(const LogSource& source, std::size_t number, const std::string& robot) {
  WheelSet best;
  std::vector<WheelSet> sets;
  if (source.type.ends_with("JointState"))
    sets = {joints(source, number, "position", robot), joints(source, number, "velocity", robot)};
  else
    sets = {named(source, number, robot), pair_by_place(source, number, robot)};
  for (WheelSet& set : sets)
    if (!set.wheels.empty() && set.rank < best.rank) best = std::move(set);
  return best;
}

void find_gyro(const std::vector<SurveyedSource>& sources, Roles& roles) {
  for (std::size_t i = 0; i < sources.size(); ++i)
    for (const LogField& field : sources[i].source.fields) {
      const bool imu = sources[i].source.type.ends_with("/Imu") && field.path == "angular_velocity.z";
      const ColumnName name = column_name(field.path);
      const bool by_name = numeric(field) && field.path.find("gyro") != std::string::npos &&
                           (field.path.find('z') != std::string::npos);
      if (!imu && !by_name) continue;
      roles.gyro = {{"z", i, field.path, "", "", name.unit == "deg/s" ? "deg/s" : "rad/s"}};
      roles.reasons.push_back(fmt::format("gyro.z: {} {}", shown(sources[i].source.name), shown(field.path)));
      return;
    }
}

}  // namespace

Roles find_roles(const std::vector<SurveyedSource>& sources, const std::string& robot) {
  Roles roles;
  WheelSet best;
  std::size_t of = 0;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    if (!sources[i].source.unreadable.empty()) {
      roles.reasons.push_back(
          fmt::format("{}: {}", shown(sources[i].source.name), shown(sources[i].source.unreadable)));
      continue;
    }
    WheelSet set = wheels_of(sources[i].source, i, robot);
    if (set.rank >= best.rank) continue;
    best = std::move(set);
    of = i;
  }
  roles.kinematics = best.kinematics;
  roles.wheels = best.wheels;
  roles.steering = best.steering;
  roles.by_place = best.by_place;
  const auto say = [&](const Role& role, const char* what) {
    const std::string& name = sources[of].source.name;
    roles.reasons.push_back(fmt::format("{}{}{}: {}{}{}, {}", what, role.which.empty() ? "" : ".", role.which,
                                        shown(name), name.empty() ? "" : " ", shown(role.field),
                                        role.unit.empty() ? "unit unknown: null" : role.unit));
  };
  for (const Role& role : roles.wheels) say(role, "wheel");
  for (const Role& role : roles.steering) say(role, "steering");
  roles.reasons.push_back(
      roles.wheels.empty() ? "no wheels found: null"
      : roles.kinematics.empty()
          ? "robot: the wheels fit several classes or none: null; --robot=CLASS of bench calibrate says which"
          : fmt::format("robot: {}, {}", roles.kinematics,
                        roles.kinematics == robot ? "as asked for" : "as its wheels say"));
  find_reference(sources, roles);
  find_gyro(sources, roles);
  return roles;
}

}  // namespace odobench::log_import
