#include "problems/robots/integration.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace odobench::robots {
namespace {

constexpr double kOptiodomStraight = 1e-5;  // rad/s

void check_integration(IntegrationRule rule, const ConstMatrixRef& motions, const Eigen::Vector3d& start,
                       const MatrixRef& poses, const Vector& seconds) {
  const Eigen::Index n = motions.cols();
  if (motions.rows() != 3 || poses.rows() != 3 || poses.cols() != n + 1)
    throw std::invalid_argument(
        fmt::format("integration: motions {} x {} and poses {} x {}, expected 3 x {} and 3 x {}",
                    motions.rows(), n, poses.rows(), poses.cols(), n, n + 1));
  if (!start.allFinite() || !motions.allFinite())
    throw std::invalid_argument("integration: a start or a motion that is not finite");
  if (rule != IntegrationRule::OptiodomOmni) return;
  if (seconds.size() != n)
    throw std::invalid_argument(fmt::format(
        "integration: optiodom-omni needs the lengths of {} intervals, found {}", n, seconds.size()));
  for (Eigen::Index k = 0; k < n; ++k)
    if (!(seconds[k] > 0))
      throw std::invalid_argument(
          fmt::format("integration: interval {} lasts {} s, expected more than 0", k, seconds[k]));
}

// How an interval is weighed: a = theta + turn dtheta, f and df/d(dtheta).
struct IntervalWeight {
  double turn, f, df;
};

IntervalWeight interval_weight(IntegrationRule rule, double dtheta, const Vector& seconds, Eigen::Index k) {
  const double h = dtheta / 2;
  switch (rule) {
    case IntegrationRule::Euler:
      return {0, 1, 0};
    case IntegrationRule::Midpoint:
      return {0.5, 1, 0};
    case IntegrationRule::Arc:
      return {0.5, sine_quotient(h), sine_quotient_derivative(h) / 2};
    case IntegrationRule::OptiodomOmni:
      if (std::abs(dtheta) / seconds[k] < kOptiodomStraight) return {0, 1, 0};
      return {1, sine_quotient(h), sine_quotient_derivative(h) / 2};
  }
  throw std::logic_error("integration: unknown rule");
}

void integrate_poses(IntegrationRule rule, const ConstMatrixRef& motions, const Eigen::Vector3d& start,
                     MatrixRef& poses, const Vector& seconds) {
  poses.col(0) = start;
  for (Eigen::Index k = 0; k < motions.cols(); ++k) poses(2, k + 1) = poses(2, k) + motions(2, k);
  for (Eigen::Index k = 0; k < motions.cols(); ++k) {
    const IntervalWeight w = interval_weight(rule, motions(2, k), seconds, k);
    const double a = poses(2, k) + w.turn * motions(2, k);
    const double c = w.f * std::cos(a), s = w.f * std::sin(a);
    poses(0, k + 1) = poses(0, k) + (c * motions(0, k) - s * motions(1, k));
    poses(1, k + 1) = poses(1, k) + (s * motions(0, k) + c * motions(1, k));
  }
}

}  // namespace

double sine_quotient(double h) {
  return std::abs(h) < 1e-4 ? 1 - h * h / 6 : std::sin(h) / h;
}

double sine_quotient_derivative(double h) {
  // (cos h - f) / h loses digits as 1 / h^2: a series as long as it takes up to 0.1.
  if (std::abs(h) < 0.1) {
    const double q = h * h;
    return -h / 3 * (1 - q / 10 * (1 - q / 28 * (1 - q / 54 * (1 - q / 88))));
  }
  return (std::cos(h) - std::sin(h) / h) / h;
}

void integrate(IntegrationRule rule, const ConstMatrixRef& motions, const Eigen::Vector3d& start,
               MatrixRef poses, const Vector& seconds) {
  check_integration(rule, motions, start, poses, seconds);
  integrate_poses(rule, motions, start, poses, seconds);
}

void integrate(IntegrationRule rule, const ConstMatrixRef& motions, const ConstMatrixRef& motions_by,
               const Eigen::Vector3d& start, MatrixRef poses, MatrixRef poses_by, const Vector& seconds) {
  check_integration(rule, motions, start, poses, seconds);
  const Eigen::Index n = motions.cols();
  if (motions_by.rows() != 3 * n || poses_by.rows() != 3 * (n + 1) || poses_by.cols() != motions_by.cols())
    throw std::invalid_argument(fmt::format(
        "integration: derivatives {} x {} and {} x {}, expected {} and {} rows and as many columns",
        motions_by.rows(), motions_by.cols(), poses_by.rows(), poses_by.cols(), 3 * n, 3 * (n + 1)));
  integrate_poses(rule, motions, start, poses, seconds);
  // Of an interval's step: by dx and dy the columns of f R(a), by the heading `step` turned by a quarter, by
  // dtheta `slope`.
  struct Step {
    double c, s, step_x, step_y, slope_x, slope_y;
  };
  std::vector<Step> steps(static_cast<std::size_t>(n));
  for (Eigen::Index k = 0; k < n; ++k) {
    const IntervalWeight w = interval_weight(rule, motions(2, k), seconds, k);
    const double a = poses(2, k) + w.turn * motions(2, k), c = std::cos(a), s = std::sin(a);
    const double x = c * motions(0, k) - s * motions(1, k), y = s * motions(0, k) + c * motions(1, k);
    steps[static_cast<std::size_t>(k)] = {
        w.f * c, w.f * s, w.f * x, w.f * y, w.df * x - w.turn * w.f * y, w.df * y + w.turn * w.f * x};
  }
  for (Eigen::Index p = 0; p < motions_by.cols(); ++p) {
    double x = 0, y = 0, theta = 0;
    poses_by.col(p).head<3>().setZero();
    for (Eigen::Index k = 0; k < n; ++k) {
      const Step& t = steps[static_cast<std::size_t>(k)];
      const double dx = motions_by(3 * k, p), dy = motions_by(3 * k + 1, p),
                   dtheta = motions_by(3 * k + 2, p);
      x += t.c * dx - t.s * dy - t.step_y * theta + t.slope_x * dtheta;
      y += t.s * dx + t.c * dy + t.step_x * theta + t.slope_y * dtheta;
      theta += dtheta;
      poses_by(3 * k + 3, p) = x;
      poses_by(3 * k + 4, p) = y;
      poses_by(3 * k + 5, p) = theta;
    }
  }
}

}  // namespace odobench::robots
