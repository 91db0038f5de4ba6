#include "problems/fusion/robot_model.hpp"

#include "datasets/robot_4wis4wid.hpp"
#include "problems/robots/four_wheel_steering.hpp"

namespace odobench {

Twist wheel_twist(const Recording& recording, std::size_t k, const ConstVectorRef& z) {
  const auto a = z.segment(0, 4), b = z.segment(4, 4), r = z.segment(8, 4);
  const auto [vx, vy, omega] = robots::published_velocity(0, [&](std::size_t i) {
    const auto w = static_cast<Eigen::Index>(i);
    return robots::SteeredWheel{a[w], b[w], r[w] * wheel_speed_of(recording, i)[k],
                                steering_of(recording, i)[k]};
  });
  return {vx, vy, omega};
}

}  // namespace odobench
