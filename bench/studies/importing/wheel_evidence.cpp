#include "bench/studies/importing/wheel_evidence.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace odobench {
namespace {

constexpr double kStep = 0.05, kSlopeSpan = 0.2;  // s

constexpr double kTurned =
    0.7;  // sine of a frame's angle to the way from which its x says nothing of forward

// The direction in the tracked frame that the robot drives along: across it the frame moves by kappa omega
// alone, so n in the null space of [v_x, v_y, omega] (n_x, n_y, -kappa) is across.
Eigen::Vector2d way_of(const Eigen::MatrixX3d& body) {
  Eigen::Matrix3d normal = body.transpose() * body;
  // Lengths by turns at a lever of 1 m.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(normal);
  const Eigen::Vector3d across = eigen.eigenvectors().col(0);
  if (!(across.head<2>().norm() > 1e-3)) return {1, 0};
  Eigen::Vector2d way(across[1], -across[0]);
  way.normalize();
  return way[0] < 0 ? Eigen::Vector2d(-way) : way;
}

}  // namespace

std::vector<WheelEvidence> wheel_evidence(const log_import::LogCurves& curves, double offset) {
  double from = curves.x.time.front() - offset, to = curves.x.time.back() - offset;
  for (const log_import::Curve& signal : curves.signals) {
    from = std::max(from, signal.time.front());
    to = std::min(to, signal.time.back());
  }
  const auto count = static_cast<Eigen::Index>((to - from - kSlopeSpan) / kStep);
  if (!(to - from > 1) || count < 10) return {};
  Eigen::MatrixX3d body(count, 3);
  std::size_t hx = 0, hy = 0, ht = 0;
  const auto pose = [&](double t) {
    return Eigen::Vector3d(curves.x.at(t + offset, hx), curves.y.at(t + offset, hy),
                           curves.heading.at(t + offset, ht));
  };
  for (Eigen::Index k = 0; k < count; ++k) {
    const double t = from + kStep * static_cast<double>(k);
    const Eigen::Vector3d a = pose(t), b = pose(t + kSlopeSpan), d = (b - a) / kSlopeSpan;
    const double heading = (a[2] + b[2]) / 2;
    body(k, 0) = std::cos(heading) * d[0] + std::sin(heading) * d[1];
    body(k, 1) = std::cos(heading) * d[1] - std::sin(heading) * d[0];
    body(k, 2) = d[2];
  }
  const Eigen::Vector2d way = way_of(body);
  Eigen::MatrixX2d motion(count, 2);
  motion << body.leftCols<2>() * way, body.col(2);
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
  // Which end of the way is forward: of a frame that is turned by less than a right angle it is its own x.
  const auto backwards = static_cast<std::size_t>(
      std::count_if(all.begin(), all.end(), [](const WheelEvidence& e) { return e.along < 0; }));
  if (std::abs(way[1]) > kTurned && 2 * backwards > all.size())
    for (WheelEvidence& e : all) e.along = -e.along;
  return all;
}

std::optional<CounterJumps> counter_jumps(const log_import::Curve& curve, double count) {
  const std::vector<double>& v = curve.value;
  const auto [low, high] = std::minmax_element(v.begin(), v.end());
  for (int bits = 8; bits <= 32; ++bits) {
    const double turn = std::pow(2.0, bits);
    if ((*high - *low) / count > turn) continue;
    CounterJumps jumps{bits, 0};
    double most = 0, left = 0;  // of all other steps; of what is left of the jumps
    for (std::size_t k = 1; k < v.size(); ++k) {
      const double step = std::abs(v[k] - v[k - 1]) / count;
      if (step > turn / 2) {
        left = std::max(left, std::abs(turn - step));
        ++jumps.count;
      } else {
        most = std::max(most, step);
      }
    }
    // Steps so long that nobody could tell forwards from backwards are none, nor is a counter that is set to
    // 0.
    const bool runs_over = jumps.count > 0 && most < turn / 8 && left < 1.5 * most + 2;
    return runs_over ? std::optional(jumps) : std::nullopt;
  }
  return std::nullopt;
}

std::optional<TurnEvidence> turn_evidence(const log_import::LogCurves& curves) {
  double from = curves.heading.time.front(), to = curves.heading.time.back();
  for (const log_import::Curve& signal : curves.signals) {
    from = std::max(from, signal.time.front());
    to = std::min(to, signal.time.back());
  }
  const auto count = static_cast<Eigen::Index>((to - from - kSlopeSpan) / kStep);
  if (!(to - from > 1) || count < 10) return std::nullopt;
  const auto rates = [&](const log_import::Curve& curve) {
    Eigen::VectorXd out(count);
    std::size_t hint = 0;
    for (Eigen::Index k = 0; k < count; ++k) {
      const double t = from + kStep * static_cast<double>(k), before = curve.at(t, hint);
      out[k] = (curve.at(t + kSlopeSpan, hint) - before) / kSlopeSpan;
    }
    return out;
  };
  const Eigen::VectorXd turning = rates(curves.heading);
  Eigen::MatrixXd wheels(count, static_cast<Eigen::Index>(curves.signals.size()));
  for (std::size_t i = 0; i < curves.signals.size(); ++i)
    wheels.col(static_cast<Eigen::Index>(i)) = rates(curves.signals[i]);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(wheels);
  if (qr.rank() < wheels.cols() || !(turning.cwiseAbs().maxCoeff() > 0.1)) return std::nullopt;
  const Eigen::VectorXd share = qr.solve(turning);
  return TurnEvidence{{share.begin(), share.end()},
                      1 - (turning - wheels * share).squaredNorm() / turning.squaredNorm()};
}

}  // namespace odobench
