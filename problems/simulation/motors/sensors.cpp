#include "problems/simulation/motors/sensors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "base/angle.hpp"

namespace odobench::dynamics {
namespace {

constexpr double kLargestVariance = 1e6;  // m^2, m^2/s^4, deg^2

Vec2 turned(const Vec2& v, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * v.x - s * v.y, s * v.x + c * v.y};
}

Vec2 wheel_centre(const RobotParameters& p, std::size_t wheel) {
  return {wheel == 1 || wheel == 2 ? p.half_length : -p.half_length,
          wheel < 2 ? p.half_width : -p.half_width};
}

// Displacement of the body's point `at` between two samples, in the body frame at the middle heading.
Vec2 displacement(const State& from, const State& to, const Vec2& at) {
  const Vec2 a = turned(at, from[kTheta]), b = turned(at, to[kTheta]);
  const Vec2 world{to[kX] + b.x - from[kX] - a.x, to[kY] + b.y - from[kY] - a.y};
  return turned(world, -(from[kTheta] + to[kTheta]) / 2);
}

TruthRow true_row(const RobotParameters& p, const Sample& before, const Sample& now) {
  const double alpha = std::atan2(p.half_width, p.half_length);
  TruthRow row;
  const Vec2 centre = turned(displacement(before.state, now.state, {}), alpha);
  const Vec2 a = turned(turned({now.rates[kVx], now.rates[kVy]}, -now.state[kTheta]), alpha);
  row.sx = centre.x;
  row.sy = centre.y;
  row.dtheta_deg = (now.state[kTheta] - before.state[kTheta]) / kDegree;
  row.ax = a.x;
  row.ay = a.y;
  for (std::size_t i = 0; i < kWheels; ++i) {
    const Vec2 d = turned(displacement(before.state, now.state, wheel_centre(p, i)), alpha);
    row.encoder_x[i] = d.x;
    row.encoder_y[i] = d.y;
  }
  return row;
}

}  // namespace

void SensorNoise::validate() const {
  const auto require = [](double variance, const char* name) {
    if (!(variance >= 0 && variance <= kLargestVariance))
      throw std::invalid_argument(fmt::format("the variance {} is {}, expected a number >= 0 up to {}", name,
                                              variance, kLargestVariance));
  };
  require(encoder_m2, "encoder_m2");
  require(acceleration_m2_s4, "acceleration_m2_s4");
  require(yaw_deg2, "yaw_deg2");
}

SensorRun sense(const RobotParameters& robot, const std::vector<Sample>& samples, AccelerationFrame frame,
                const SensorNoise& noise, const std::function<double()>& normal) {
  noise.validate();
  const double encoder = std::sqrt(noise.encoder_m2), acceleration = std::sqrt(noise.acceleration_m2_s4),
               yaw = std::sqrt(noise.yaw_deg2);
  SensorRun run;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const Sample &now = samples[k], &before = samples[k > 0 ? k - 1 : 0];
    run.truth.push_back(true_row(robot, before, now));
    SensorRow row;
    row.time_s = now.time_s;
    for (std::size_t i = 0; i < kWheels; ++i)
      row.encoder_m[i] =
          robot.wheel_radius * (now.state[kAngle + i] - before.state[kAngle + i]) + encoder * normal();
    Vec2 a{now.rates[kVx], now.rates[kVy]};
    if (frame == AccelerationFrame::Body) a = turned(a, -now.state[kTheta]);
    row.ax = a.x + acceleration * normal();
    row.ay = a.y + acceleration * normal();
    row.yaw_step_deg = (now.state[kTheta] - before.state[kTheta]) / kDegree + yaw * normal();
    row.steering = now.inputs.steering;
    run.rows.push_back(row);
  }
  return run;
}

std::string sensor_csv(const std::vector<SensorRow>& rows) {
  const bool steered = std::any_of(rows.begin(), rows.end(), [](const SensorRow& row) {
    return std::any_of(row.steering.begin(), row.steering.end(), [](double xi) { return xi != 0; });
  });
  std::string text = "time_s,enc1_m,enc2_m,enc3_m,enc4_m,ax_m_s2,ay_m_s2,yaw_step_deg";
  text += steered ? ",psi1_rad,psi2_rad,psi3_rad,psi4_rad\n" : "\n";
  const auto out = std::back_inserter(text);
  for (const SensorRow& row : rows) {
    fmt::format_to(out, "{},{},{},{},{},{},{},{}", row.time_s, row.encoder_m[0], row.encoder_m[1],
                   row.encoder_m[2], row.encoder_m[3], row.ax, row.ay, row.yaw_step_deg);
    if (steered)
      for (const double xi : row.steering) fmt::format_to(out, ",{}", xi);
    text += '\n';
  }
  return text;
}

std::string truth_csv(const std::vector<TruthRow>& rows) {
  std::string text = "sx,sy,dtheta_deg,ax,ay,enc1x,enc1y,enc2x,enc2y,enc3x,enc3y,enc4x,enc4y\n";
  const auto out = std::back_inserter(text);
  for (const TruthRow& row : rows) {
    fmt::format_to(out, "{},{},{},{},{}", row.sx, row.sy, row.dtheta_deg, row.ax, row.ay);
    for (std::size_t i = 0; i < kWheels; ++i)
      fmt::format_to(out, ",{},{}", row.encoder_x[i], row.encoder_y[i]);
    text += '\n';
  }
  return text;
}

std::string state_csv(const RobotParameters& robot, const std::vector<Sample>& samples) {
  std::string text =
      "time_s,u1_V,u2_V,u3_V,u4_V,xi1_rad,xi2_rad,xi3_rad,xi4_rad,i1_A,i2_A,i3_A,i4_A,w1_rad_s,w2_rad_s,"
      "w3_rad_s,w4_rad_s,vx_m_s,vy_m_s,x_m,y_m,theta_rad,omega_rad_s,ax_m_s2,ay_m_s2,alpha_rad_s2,"
      "body_balance_J,motor_balance_J\n";
  const auto out = std::back_inserter(text);
  for (const Sample& s : samples) {
    fmt::format_to(out, "{}", s.time_s);
    for (const double u : s.inputs.voltage) fmt::format_to(out, ",{}", u);
    for (const double xi : s.inputs.steering) fmt::format_to(out, ",{}", xi);
    for (std::size_t i = kCurrent; i <= kOmega; ++i) fmt::format_to(out, ",{}", s.state[i]);
    const Balance b = balance(robot, s.state);
    fmt::format_to(out, ",{},{},{},{},{}\n", s.rates[kVx], s.rates[kVy], s.rates[kOmega], b.body, b.motor);
  }
  return text;
}

}  // namespace odobench::dynamics
