// The part of a model that is a table of wheels with more, or fewer, parameters.
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "problems/calibration/models/model_terms.hpp"

namespace odobench {
namespace {

bool is_bound(const Robot& robot, std::size_t wheel, WheelField field) {
  for (const BoundParameter& p : robot.table.parameters)
    for (const Binding& b : p.bindings)
      if (b.wheel == wheel && b.field == field) return true;
  return false;
}

void add(Robot& robot, BoundParameter bound) {
  for (const RobotParameter& p : robot.parameters)
    if (p.name == bound.parameter.name)
      throw std::invalid_argument(
          fmt::format("model: the robot has a parameter '{}' of its own", bound.parameter.name));
  robot.parameters.push_back(bound.parameter);
  robot.table.parameters.push_back(std::move(bound));
}

void hold(Robot& robot, std::size_t p) {
  RobotParameter& held = robot.table.parameters[p].parameter;
  held.lower = held.upper = held.nominal;
  robot.parameters[p] = held;
}

// Parameters all of whose bindings are among these fields.
void hold_fields(Robot& robot, std::initializer_list<WheelField> fields) {
  for (std::size_t p = 0; p < robot.table.parameters.size(); ++p) {
    const std::vector<Binding>& bindings = robot.table.parameters[p].bindings;
    if (std::all_of(bindings.begin(), bindings.end(), [&](const Binding& b) {
          return std::find(fields.begin(), fields.end(), b.field) != fields.end();
        }))
      hold(robot, p);
  }
}

std::vector<Wheel> nominal_wheels(const Robot& robot) {
  std::vector<double> values;
  for (const RobotParameter& p : robot.parameters) values.push_back(p.nominal);
  return wheels_with(robot.table, values);
}

void refuse_without(bool any, const Robot& robot, const char* name, const char* what) {
  if (!any)
    throw std::invalid_argument(
        fmt::format("model '{}': the robot ({}) has no {}", name, robot.kinematics, what));
}

void refuse_bound(const Robot& robot, std::size_t wheel, WheelField field, const char* name) {
  if (is_bound(robot, wheel, field))
    throw std::invalid_argument(
        fmt::format("model '{}': the {} of wheel {} is a parameter of the robot already", name,
                    name_of(field), wheel + 1));
}

void add_offsets(Robot& robot, const ModelTerms& terms, const std::vector<Wheel>& wheels) {
  const bool shared = terms.offsets == ModelTerms::Offsets::Shared;
  const char* name = shared ? "contact_offset" : "contact_offsets";
  const double bound = terms.offset_bound;
  BoundParameter one{{"offset", "m", 0, -bound, bound}, {}};
  std::size_t steered = 0;
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    if (!is_steered(wheels[i])) continue;
    if (shared && wheels[i].y == 0) continue;  // neither left nor right
    ++steered;
    refuse_bound(robot, i, WheelField::Offset, name);
    if (shared)
      one.bindings.push_back({i, WheelField::Offset, wheels[i].y > 0 ? -1.0 : 1.0});
    else
      add(robot, {{fmt::format("offset{}", i + 1), "m", 0, -bound, bound}, {{i, WheelField::Offset, 1}}});
  }
  refuse_without(steered > 0, robot, name,
                 shared ? "steered wheel left or right of its middle" : "steered wheel");
  if (shared) add(robot, std::move(one));
}

void add_zeros(Robot& robot, const ModelTerms& terms, const std::vector<Wheel>& wheels) {
  const char* name = terms.zero_of != 0 ? "steering_zero" : "steering_zeros";
  std::size_t steered = 0;
  for (std::size_t i = 0; i < wheels.size(); ++i) {
    if (!is_steered(wheels[i])) continue;
    if (terms.zero_of != 0 && static_cast<std::size_t>(terms.zero_of) != i + 1) continue;
    ++steered;
    refuse_bound(robot, i, WheelField::Zero, name);
    add(robot, {{fmt::format("zero{}", i + 1), "rad", 0, -terms.zero_bound, terms.zero_bound},
                {{i, WheelField::Zero, 1}}});
  }
  refuse_without(steered > 0, robot, name,
                 terms.zero_of != 0 ? "steered wheel of this number" : "steered wheel");
}

// A factor f with nominal value 1 on fields that are held at v: v f, as -v in the wheel, v by the parameters
// that are held, and v f by this one.
void add_factor(Robot& robot, const char* name, double bound, std::initializer_list<WheelField> fields,
                const std::vector<Wheel>& wheels) {
  BoundParameter factor{{name, "ratio", 1, 1 - bound, 1 + bound}, {}};
  for (std::size_t i = 0; i < wheels.size(); ++i)
    for (const WheelField field : fields) {
      const double value = field_of(wheels[i], field);
      if (value == 0 || (field == WheelField::Radius && wheels[i].drive.empty())) continue;
      factor.bindings.push_back({i, field, value});
      field_of(robot.table.wheels[i], field) -= value;
    }
  refuse_without(!factor.bindings.empty(), robot, name, "number for it to act on");
  add(robot, std::move(factor));
}

}  // namespace

bool is_steered(const Wheel& wheel) {
  return !wheel.steering.empty();
}

Robot with_model(const Robot& robot, const ModelTerms& terms) {
  Robot out = robot;
  using enum WheelField;
  const std::vector<Wheel> wheels = nominal_wheels(robot);
  if (terms.twist) out.table.rule = *terms.twist;
  const bool steered = std::any_of(wheels.begin(), wheels.end(), is_steered);
  if (terms.steering_rate.value_or(false)) refuse_without(steered, robot, "steering_rate", "steered wheel");
  if (terms.fixed_layout || terms.layout_scale) hold_fields(out, {X, Y, Mount});
  if (terms.common_radius) hold_fields(out, {Radius});
  if (terms.layout_scale) add_factor(out, "layout_scale", terms.layout_bound, {X, Y}, wheels);
  if (terms.common_radius) add_factor(out, "radius_factor", terms.radius_bound, {Radius}, wheels);
  if (terms.steering_zeros || terms.zero_of != 0) add_zeros(out, terms, wheels);
  if (terms.offsets != ModelTerms::Offsets::None) add_offsets(out, terms, wheels);
  return out;
}

std::vector<RobotParameter> parameters_beyond_table(const ModelTerms& terms, bool mount) {
  std::vector<RobotParameter> list;
  const auto around = [&](const char* name, const char* unit, double nominal, double bound) {
    list.push_back({name, unit, nominal, nominal - bound, nominal + bound});
  };
  const bool whole = mount || terms.mount;
  if (whole || terms.lever_arm) {
    around("mount_x", "m", 0, whole ? 0.25 : terms.lever_bound);
    around("mount_y", "m", 0, whole ? 0.25 : terms.lever_bound);
  }
  if (whole || terms.heading_offset) around("mount_yaw", "rad", 0, whole ? 0.2 : terms.heading_bound);
  if (terms.free_time_offset) around("time_offset", "s", 0, terms.time_bound);
  if (!terms.speed_factor_of.empty()) around("speed_factor", "ratio", 1, terms.factor_bound);
  return list;
}

}  // namespace odobench
