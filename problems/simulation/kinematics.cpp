#include "problems/simulation/kinematics.hpp"

#include <cmath>

#include "base/angle.hpp"
#include "problems/robots/four_wheel_steering.hpp"

namespace odobench::simulate {
namespace {

constexpr double kStanding = 1e-9;  // m/s

struct Contact {
  double x, y, vx, vy;
};

Contact contact(const Parameters& z, const WheelState& w, const ContactOffset& offset, std::size_t i) {
  const double c = std::cos(w.steering[i]), s = std::sin(w.steering[i]);
  const double v = z[2 * kWheelCount + i] * w.speed[i];
  return {z[i] - offset[i] * s, z[kWheelCount + i] + offset[i] * c, c * v, s * v};
}

// sin(x) / x and (1 - cos(x)) / x without loss for small x.
double sine_ratio(double x) {
  return std::abs(x) < 1e-5 ? 1 - x * x / 6 : std::sin(x) / x;
}
double versine_ratio(double x) {
  const double half = x / 2;
  return std::sin(half) * sine_ratio(half);
}

}  // namespace

WheelState inverse_kinematics(const Parameters& z, const Twist& t, const PerWheel& held) {
  WheelState w;
  for (std::size_t i = 0; i < kWheelCount; ++i) {
    const double vx = t.vx - z[kWheelCount + i] * t.omega, vy = t.vy + z[i] * t.omega;
    const double v = std::hypot(vx, vy);
    if (v < kStanding) {
      w.steering[i] = held[i];
      continue;
    }
    double direction = std::atan2(vy, vx), speed = v / z[2 * kWheelCount + i];
    if (direction > kPi / 2) {
      direction -= kPi;
      speed = -speed;
    } else if (direction <= -kPi / 2) {
      direction += kPi;
      speed = -speed;
    }
    w.steering[i] = direction;
    w.speed[i] = speed;
  }
  return w;
}

Twist forward_published(const Parameters& z, const WheelState& w, const ContactOffset& offset) {
  const auto [vx, vy, omega] = robots::published_velocity(0, [&](std::size_t i) {
    return robots::SteeredWheel{z[i], z[kWheelCount + i], z[2 * kWheelCount + i] * w.speed[i], w.steering[i],
                                offset[i]};
  });
  return {vx, vy, omega};
}

Twist forward_least_squares(const Parameters& z, const WheelState& w, const ContactOffset& offset) {
  // Normal equations of v_i = (vx - y_i omega, vy + x_i omega), reduced to omega by the means.
  double x = 0, y = 0, vx = 0, vy = 0;
  for (std::size_t i = 0; i < kWheelCount; ++i) {
    const Contact c = contact(z, w, offset, i);
    x += c.x / 4;
    y += c.y / 4;
    vx += c.vx / 4;
    vy += c.vy / 4;
  }
  double moment = 0, spread = 0;
  for (std::size_t i = 0; i < kWheelCount; ++i) {
    const Contact c = contact(z, w, offset, i);
    moment += (c.x - x) * (c.vy - vy) - (c.y - y) * (c.vx - vx);
    spread += (c.x - x) * (c.x - x) + (c.y - y) * (c.y - y);
  }
  const double omega = moment / spread;
  return {vx + y * omega, vy - x * omega, omega};
}

Pose moved(const Pose& from, const Twist& t, double seconds) {
  const double angle = t.omega * seconds;
  const double ahead = seconds * sine_ratio(angle), aside = seconds * versine_ratio(angle);
  const double dx = t.vx * ahead - t.vy * aside, dy = t.vy * ahead + t.vx * aside;
  const double c = std::cos(from.theta), s = std::sin(from.theta);
  return {from.x + c * dx - s * dy, from.y + s * dx + c * dy, from.theta + angle};
}

}  // namespace odobench::simulate
