#include <cmath>
#include <stdexcept>

#include "datasets/robot_4wis4wid.hpp"
#include "problems/calibration/calibration_problem.hpp"
#include "problems/robots/four_wheel_steering.hpp"

namespace odobench::direct {

PoseTrack integrate(const Recording& recording, const ConstVectorRef& z) {
  const auto a = z.segment(0, 4), b = z.segment(4, 4), r = z.segment(8, 4);
  const std::size_t n = recording.size();
  PoseTrack q;
  q.x.assign(n, 0.0);
  q.y.assign(n, 0.0);
  q.theta.assign(n, recording.reference.theta.at(0));
  for (std::size_t k = 0; k + 1 < n; ++k) {
    const auto [vx, vy, omega] = robots::published_velocity(q.theta[k], [&](std::size_t i) {
      const auto w = static_cast<Eigen::Index>(i);
      return robots::SteeredWheel{a[w], b[w], r[w] * wheel_speed_of(recording, i)[k],
                                  steering_of(recording, i)[k]};
    });
    const double dt = static_cast<double>(recording.time_us[k + 1] - recording.time_us[k]) * 1e-6;
    q.x[k + 1] = q.x[k] + dt * vx;
    q.y[k + 1] = q.y[k] + dt * vy;
    q.theta[k + 1] = q.theta[k] + dt * omega;
  }
  return q;
}

double cost(std::span<const Recording> recordings, const ConstVectorRef& z) {
  double sum = 0;
  for (const Recording& recording : recordings) {
    const PoseTrack q = integrate(recording, z);
    for (std::size_t k = 1; k < recording.size(); ++k) {
      const double ex = q.x[k] - recording.reference.x[k], ey = q.y[k] - recording.reference.y[k],
                   et = q.theta[k] - recording.reference.theta[k];
      sum += ex * ex + ey * ey + et * et;
    }
  }
  return sum;
}

}  // namespace odobench::direct
