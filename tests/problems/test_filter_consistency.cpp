// Are the filters as good as they say? Many simulated robots for which everything is as the filter believes.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "problems/fusion/robot_model.hpp"
#include "problems/kalman/consistency.hpp"
#include "tests/support/normal.hpp"

namespace odobench {
namespace {

using Pose = RobotModel<false, false, false>;
using PoseFilter = KalmanFilter<Pose>;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using testing::Normal;

struct Consistency {
  double nees = 0, nis = 0, nees_inside = 0;
  Vector3d mean_error = Vector3d::Zero();
};

struct Drive {
  KalmanOptions options;
  bool gyro = true;
  int camera_every = 3;
};

// 200 robots that drive a circle for 40 s, everything as the filter believes.
Consistency simulate(const Drive& drive) {
  constexpr int kRobots = 200, kSteps = 2500;
  constexpr double kStep = 0.016;
  const Vector3d sigma_u(0.01, 0.01, 0.02), sigma_z(0.02, 0.02, 0.01), sigma_0(0.01, 0.01, 0.0316);
  const Matrix3d lq = sigma_u.asDiagonal(), lr = sigma_z.asDiagonal();
  const Twist u{0.05, 0, 2 * kPi / 80};
  std::vector<double> nees(kSteps, 0.0);
  Consistency out;
  double innovations = 0;
  for (int robot = 0; robot < kRobots; ++robot) {
    Normal normal(static_cast<std::uint64_t>(7000 + robot));
    Vector3d truth(0.5, 0, 2.0);
    PoseFilter filter({}, drive.options, truth + normal.three(sigma_0),
                      Matrix(sigma_0.cwiseAbs2().asDiagonal()));
    for (int k = 0; k < kSteps; ++k) {
      const Vector3d w = normal.three(sigma_u);
      const Twist wheels{u.vx + w[0], u.vy + w[1], u.omega + w[2]};
      const auto gyro = filter.model().yaw_rate(filter.state(), wheels.omega, u.omega + normal(1e-3), 1e-3);
      filter.predict(wheels, lq, kStep, drive.gyro && k % 2 == 0 ? &gyro : nullptr);
      truth = Pose().move(truth, Vector3d::Zero(), u, kStep);
      if (k % drive.camera_every == drive.camera_every - 1) {
        Vector3d z = truth + normal.three(sigma_z);
        z[2] = wrapped_angle(z[2]);
        out.nis += filter.update(PoseSensor<3>(), z, lr).nis;
        innovations += 1;
      }
      const Vector3d e = truth - filter.state();
      nees[static_cast<std::size_t>(k)] += forward_solved<3, 1>(filter.factor(), e).squaredNorm() / kRobots;
      out.mean_error += e / (1.0 * kRobots * kSteps);
    }
  }
  const ConsistencyBand band = consistency_band(3, kRobots);
  for (const double value : nees) {
    out.nees += value / kSteps;
    out.nees_inside += (band.holds(value) ? 1.0 : 0.0) / kSteps;
  }
  out.nis /= innovations;
  return out;
}

TEST(ExtendedFilter, IsAsGoodAsItSays) {
  for (const FilterKind kind : {FilterKind::Extended, FilterKind::Unscented}) {
    Drive drive;
    drive.options.kind = kind;
    for (const auto& [gyro, every] : {std::pair(true, 3), std::pair(false, 3), std::pair(true, 1)}) {
      drive.gyro = gyro;
      drive.camera_every = every;
      const Consistency c = simulate(drive);
      EXPECT_NEAR(c.nees, 3, 0.12);
      EXPECT_NEAR(c.nis, 3, 0.05);
      EXPECT_GE(c.nees_inside, 0.88);
    }
  }
}

TEST(ExtendedFilter, ReadToTheLetterItIsNotAsGoodAsItSays) {
  Drive drive;
  drive.options.literal_47 = true;
  drive.camera_every = 1;
  const Consistency c = simulate(drive);
  EXPECT_NEAR(c.mean_error[2], -2 * kPi / 80 * 0.016, 2e-4);
  EXPECT_GE(c.nees, 3.4);
  EXPECT_LE(c.nees_inside, 0.3);
  EXPECT_NEAR(c.nis, 3, 0.05);  // the innovations look perfect
}

TEST(Consistency, BandsAreThoseOfTheTables) {
  const ConsistencyBand band = consistency_band(3, 200);
  EXPECT_NEAR(band.lower, 2.6700927523296634, 1e-12);
  EXPECT_NEAR(band.upper, 3.348845761082056, 1e-12);
  EXPECT_NEAR(chi_square_quantile(0.95, 1), 3.841458820694124, 1e-12);
  EXPECT_THROW(chi_square_quantile(1, 3), std::invalid_argument);
  EXPECT_THROW(chi_square_quantile(0.5, 0), std::invalid_argument);
}

}  // namespace
}  // namespace odobench
