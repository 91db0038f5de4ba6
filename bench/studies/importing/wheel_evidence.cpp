#include "bench/studies/importing/wheel_evidence.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace odobench {
namespace {

constexpr double kStep = 0.05, kSlopeSpan = 0.2;  // s

}  // namespace

std::vector<WheelEvidence> wheel_evidence(const log_import::LogCurves& curves, double offset) {
  double from = curves.x.time.front() - offset, to = curves.x.time.back() - offset;
  for (const log_import::Curve& signal : curves.signals) {
    from = std::max(from, signal.time.front());
    to = std::min(to, signal.time.back());
  }
  const auto count = static_cast<Eigen::Index>((to - from - kSlopeSpan) / kStep);
  if (!(to - from > 1) || count < 10) return {};
  Eigen::MatrixX2d motion(count, 2);
  std::size_t hx = 0, hy = 0, ht = 0;
  const auto pose = [&](double t) {
    return Eigen::Vector3d(curves.x.at(t + offset, hx), curves.y.at(t + offset, hy),
                           curves.heading.at(t + offset, ht));
  };
  for (Eigen::Index k = 0; k < count; ++k) {
    const double t = from + kStep * static_cast<double>(k);
    const Eigen::Vector3d a = pose(t), b = pose(t + kSlopeSpan), d = (b - a) / kSlopeSpan;
    const double heading = (a[2] + b[2]) / 2;
    motion(k, 0) = std::cos(heading) * d[0] + std::sin(heading) * d[1];
    motion(k, 1) = d[2];
  }
  const Eigen::Matrix2d normal = motion.transpose() * motion;
  if (!(normal.determinant() > 1e-6 * normal(0, 0) * normal(1, 1)) || !(normal(0, 0) > 0)) return {};
  std::vector<WheelEvidence> all;
  for (const log_import::Curve& signal : curves.signals) {
    Eigen::VectorXd rate(count);
    std::size_t hint = 0;
    for (Eigen::Index k = 0; k < count; ++k) {
      const double t = from + kStep * static_cast<double>(k);
      const double before = signal.at(t, hint);
      rate[k] = (signal.at(t + kSlopeSpan, hint) - before) / kSlopeSpan;
    }
    const Eigen::Vector2d z = normal.ldlt().solve(motion.transpose() * rate);
    const double total = rate.squaredNorm();
    all.push_back({z[0], z[1], total > 0 ? 1 - (rate - motion * z).squaredNorm() / total : 0});
  }
  return all;
}

}  // namespace odobench
