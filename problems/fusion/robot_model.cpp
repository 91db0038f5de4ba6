#include "problems/fusion/robot_model.hpp"

#include "datasets/robot_4wis4wid.hpp"

namespace odobench {

Twist wheel_twist(const Recording& recording, std::size_t k, const ConstVectorRef& z) {
  const auto a = z.segment(0, 4), b = z.segment(4, 4), r = z.segment(8, 4);
  Twist u;
  for (std::size_t i = 0; i < kWheelCount; ++i) {
    const auto w = static_cast<Eigen::Index>(i);
    const double c = std::cos(steering_of(recording, i)[k]), s = std::sin(steering_of(recording, i)[k]);
    const double v = r[w] * wheel_speed_of(recording, i)[k];
    u.vx += c / 4 * v;
    u.vy += s / 4 * v;
    u.omega += (-b[w] * c + a[w] * s) / (4 * (a[w] * a[w] + b[w] * b[w])) * v;
  }
  return u;
}

}  // namespace odobench
