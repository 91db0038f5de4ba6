#include "problems/simulation/motors/robot.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace odobench::dynamics {
namespace {

// SI units; less is a typing error and makes the equations stiff beyond any step.
constexpr double kLeastParameter = 1e-9;

PerWheel wheel_x(const RobotParameters& p) {
  return {-p.half_length, p.half_length, p.half_length, -p.half_length};
}
PerWheel wheel_y(const RobotParameters& p) {
  return {p.half_width, p.half_width, -p.half_width, -p.half_width};
}

// What the ground does, in the body frame.
struct Ground {
  Vec2 force;
  double torque = 0;
  PerWheel load{};  // N m
  double drive_power = 0, friction_power = 0;
};

Ground published(const RobotParameters& p, const ModelOptions& o, const Inputs& in, const State& s,
                 const Vec2& body) {
  Ground g;
  const PerWheel x = wheel_x(p), y = wheel_y(p);
  for (std::size_t i = 0; i < kWheels; ++i) {
    const double ex = std::cos(in.steering[i]), ey = std::sin(in.steering[i]);
    const double force = p.drive_gain * p.wheel_radius * s[kSpeed + i];
    const double lever = o.torque_with_radius ? force : p.drive_gain * s[kSpeed + i];
    g.force.x += force * ex;
    g.force.y += force * ey;
    g.torque += x[i] * (lever * ey) - y[i] * (lever * ex);
    const double along = (body.x - y[i] * s[kOmega]) * ex + (body.y + x[i] * s[kOmega]) * ey;
    if (o.load_torque) g.load[i] = p.wheel_radius * (force - p.drive_gain * along);
  }
  g.drive_power = g.force.x * body.x + g.force.y * body.y + g.torque * s[kOmega];
  g.friction_power =
      p.linear_friction * (body.x * body.x + body.y * body.y) + p.rotary_friction * s[kOmega] * s[kOmega];
  g.force.x -= p.linear_friction * body.x;
  g.force.y -= p.linear_friction * body.y;
  g.torque -= p.rotary_friction * s[kOmega];
  return g;
}

Ground contact(const RobotParameters& p, const ModelOptions& o, const Inputs& in, const State& s,
               const Vec2& body) {
  Ground g;
  const PerWheel x = wheel_x(p), y = wheel_y(p);
  for (std::size_t i = 0; i < kWheels; ++i) {
    const double ex = std::cos(in.steering[i]), ey = std::sin(in.steering[i]);
    const double vx = body.x - y[i] * s[kOmega], vy = body.y + x[i] * s[kOmega];
    const double slip = p.wheel_radius * s[kSpeed + i] - (vx * ex + vy * ey), aside = vy * ex - vx * ey;
    const double ahead = p.drive_gain * slip, lateral = -p.lateral_gain * aside;
    const double fx = ahead * ex - lateral * ey, fy = ahead * ey + lateral * ex;
    g.force.x += fx;
    g.force.y += fy;
    g.torque += x[i] * fy - y[i] * fx;
    if (o.load_torque) g.load[i] = p.wheel_radius * ahead;
    g.drive_power += ahead * p.wheel_radius * s[kSpeed + i];
    g.friction_power += ahead * slip - lateral * aside;
  }
  return g;
}

}  // namespace

std::vector<std::string> robot_set_names() {
  return {"grip", "hint"};
}

RobotParameters robot_set(const std::string& name) {
  RobotParameters p;
  const double length = 2 * p.half_length, width = 2 * p.half_width;
  p.yaw_inertia = p.mass * (length * length + width * width) / 12;
  if (name == "hint")
    p.drive_gain = 0.235535207319;
  else if (name != "grip")
    throw std::invalid_argument(fmt::format("found the robot set '{}', expected grip or hint", name));
  p.lateral_gain = 10 * p.drive_gain;
  p.linear_friction = 4 * p.drive_gain;
  p.rotary_friction = 4 * p.drive_gain * (p.half_length * p.half_length + p.half_width * p.half_width);
  return p;
}

const std::vector<ParameterDescription>& parameter_descriptions() {
  using P = RobotParameters;
  static const std::vector<ParameterDescription> list = {
      {"mass", "m", "kg", true, false, 1e6, "table 2.1", [](P& p) -> double& { return p.mass; }},
      {"half_length", "a", "m", true, false, 100, "half of the length 0.775 m of table 2.1",
       [](P& p) -> double& { return p.half_length; }},
      {"half_width", "b", "m", true, false, 100, "half of the width 0.55 m of table 2.1",
       [](P& p) -> double& { return p.half_width; }},
      {"yaw_inertia", "Izz", "kg m2", false, false, 1e9, "m (length^2 + width^2) / 12, a plate",
       [](P& p) -> double& { return p.yaw_inertia; }},
      {"wheel_radius", "r", "m", false, false, 100, "", [](P& p) -> double& { return p.wheel_radius; }},
      {"drive_gain", "k", "N s/m", false, false, 1e9, "drive force per speed of slip",
       [](P& p) -> double& { return p.drive_gain; }},
      {"lateral_gain", "klat", "N s/m", false, true, 1e9,
       "side force per sideways speed; wheel contact only; 10 k",
       [](P& p) -> double& { return p.lateral_gain; }},
      {"linear_friction", "ktr", "N s/m", false, true, 1e9, "as published only; 4 k",
       [](P& p) -> double& { return p.linear_friction; }},
      {"rotary_friction", "krot", "N m s/rad", false, true, 1e12, "as published only; 4 k (a^2 + b^2)",
       [](P& p) -> double& { return p.rotary_friction; }},
      {"resistance", "R", "ohm", false, false, 1e6, "", [](P& p) -> double& { return p.motor.resistance; }},
      {"inductance", "La", "H", false, false, 1e3, "", [](P& p) -> double& { return p.motor.inductance; }},
      {"flux_constant", "cphi", "V s/rad", false, false, 1e4, "torque per current, voltage per speed",
       [](P& p) -> double& { return p.motor.flux_constant; }},
      {"wheel_inertia", "Iw", "kg m2", false, false, 1e4, "",
       [](P& p) -> double& { return p.motor.inertia; }},
      {"bearing_loss", "kdc", "N m s/rad", false, true, 1e4, "",
       [](P& p) -> double& { return p.motor.bearing_loss; }},
  };
  return list;
}

void validate(const RobotParameters& parameters) {
  RobotParameters p = parameters;
  for (const ParameterDescription& d : parameter_descriptions()) {
    const double value = d.value(p);
    if (!std::isfinite(value) || value < 0 || (value == 0 && !d.may_be_zero))
      throw std::invalid_argument(fmt::format("{} is {} {}, expected a {}", d.name, value, d.unit,
                                              d.may_be_zero ? "number >= 0" : "positive number"));
    if (value > d.most)
      throw std::invalid_argument(
          fmt::format("{} is {} {}, expected at most {} {}", d.name, value, d.unit, d.most, d.unit));
    if (value != 0 && value < kLeastParameter)
      throw std::invalid_argument(fmt::format("{} is {} {}, expected at least {} {}", d.name, value, d.unit,
                                              kLeastParameter, d.unit));
  }
}

void ModelOptions::validate() const {
  if (wheel_contact && !torque_with_radius)
    throw std::invalid_argument(
        "contradictory options: wheel_contact needs torque_with_radius, found the torque without r");
}

State rates(const RobotParameters& p, const ModelOptions& o, const Inputs& in, const State& s) {
  State d{};
  const double c = std::cos(s[kTheta]), sn = std::sin(s[kTheta]);
  const Vec2 body{c * s[kVx] + sn * s[kVy], -sn * s[kVx] + c * s[kVy]};
  const Ground g = o.wheel_contact ? contact(p, o, in, s, body) : published(p, o, in, s, body);
  for (std::size_t i = 0; i < kWheels; ++i) {
    const double current = s[kCurrent + i], speed = s[kSpeed + i];
    const MotorRates m = motor_rates(p.motor, in.voltage[i], current, speed, g.load[i]);
    d[kCurrent + i] = m.current;
    d[kSpeed + i] = m.speed;
    d[kAngle + i] = speed;
    d[kElectrical] += in.voltage[i] * current;
    d[kOhmic] += p.motor.resistance * current * current;
    d[kBearing] += p.motor.bearing_loss * speed * speed;
    d[kLoad] += g.load[i] * speed;
  }
  d[kVx] = (c * g.force.x - sn * g.force.y) / p.mass;
  d[kVy] = (sn * g.force.x + c * g.force.y) / p.mass;
  d[kX] = s[kVx];
  d[kY] = s[kVy];
  d[kTheta] = s[kOmega];
  d[kOmega] = g.torque / p.yaw_inertia;
  d[kDrive] = g.drive_power;
  d[kFriction] = g.friction_power;
  return d;
}

Balance balance(const RobotParameters& p, const State& s) {
  const double kinetic =
      (p.mass * (s[kVx] * s[kVx] + s[kVy] * s[kVy]) + p.yaw_inertia * s[kOmega] * s[kOmega]) / 2;
  double stored = 0;
  for (std::size_t i = 0; i < kWheels; ++i)
    stored += (p.motor.inductance * s[kCurrent + i] * s[kCurrent + i] +
               p.motor.inertia * s[kSpeed + i] * s[kSpeed + i]) /
              2;
  return {s[kDrive] - s[kFriction] - kinetic, s[kElectrical] - s[kOhmic] - s[kBearing] - s[kLoad] - stored};
}

CircularMotion published_steady_state(const RobotParameters& p, bool torque_with_radius,
                                      const PerWheel& speed, const PerWheel& steering) {
  Vec2 force;
  double torque = 0;
  const PerWheel x = wheel_x(p), y = wheel_y(p);
  for (std::size_t i = 0; i < kWheels; ++i) {
    const double f = p.drive_gain * speed[i] * p.wheel_radius;
    force.x += f * std::cos(steering[i]);
    force.y += f * std::sin(steering[i]);
    torque += (x[i] * std::sin(steering[i]) - y[i] * std::cos(steering[i])) *
              (torque_with_radius ? f : f / p.wheel_radius);
  }
  const double omega = torque / p.rotary_friction;
  return {omega, std::hypot(force.x, force.y) / std::hypot(p.linear_friction, p.mass * omega),
          -std::atan(p.mass * omega / p.linear_friction)};
}

}  // namespace odobench::dynamics
