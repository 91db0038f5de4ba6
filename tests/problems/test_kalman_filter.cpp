// The filters against an independent run, batch least squares, closed forms, and their own consistency.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "datasets/robot_4wis4wid.hpp"
#include "problems/fusion/robot_model.hpp"
#include "problems/kalman/consistency.hpp"
#include "problems/kalman/linear_model.hpp"
#include "tests/support/data/report_records.hpp"
#include "tests/support/data_error.hpp"
#include "tests/support/normal.hpp"
#include "tests/support/shared_data.hpp"

namespace odobench {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using testing::Normal;

using Pose = RobotModel<false, false, false>;
using PoseFilter = KalmanFilter<Pose>;
using Eigen::Matrix3d;
using Eigen::Vector3d;

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int kManySteps = 100'000;
#else
constexpr int kManySteps = 10'000'000;
#endif

Vector3d vector3(const json& j) {
  return {j.at(0).get<double>(), j.at(1).get<double>(), j.at(2).get<double>()};
}
Matrix3d root_of_diagonal(const Vector3d& d) {
  return d.cwiseSqrt().asDiagonal();
}

Twist twist_of_step(const json& step, const Vector& z) {
  Recording r = recording_4wis4wid();
  r.time_us = {0};
  for (std::size_t i = 0; i < kWheelCount; ++i) {
    steering_of(r, i) = {step.at("delta").at(i).get<double>()};
    wheel_speed_of(r, i) = {step.at("omega").at(i).get<double>()};
  }
  return wheel_twist(r, 0, z);
}

// Runs the deterministic drive of ekf.json and calls check(filter, step, innovation) after each step.
template <class Check>
void run_reference(FilterKind kind, const json& v, Check check) {
  Vector z(12);
  for (Eigen::Index i = 0; i < 12; ++i) z[i] = v.at("p").at(static_cast<std::size_t>(i)).get<double>();
  KalmanOptions options;
  options.kind = kind;
  PoseFilter filter({}, options, vector3(v.at("x0")), Matrix(vector3(v.at("P0")).asDiagonal()));
  const Matrix3d lq = root_of_diagonal(vector3(v.at("Qu_diag"))),
                 lr = root_of_diagonal(vector3(v.at("R_diag")));
  for (const json& step : v.at("steps")) {
    const Twist u = twist_of_step(step, z);
    ProcessMeasurement<3, 3> gyro;
    const bool has_gyro = !step.at("gyro").is_null();
    if (has_gyro)
      gyro = filter.model().yaw_rate(filter.state(), u.omega, step.at("gyro").get<double>(),
                                     std::sqrt(v.at("rg").get<double>()));
    filter.predict(u, lq, step.at("dt").get<double>(), has_gyro ? &gyro : nullptr);
    std::optional<Innovation<3>> innovation;
    if (step.contains("camera")) innovation = filter.update(PoseSensor<3>(), vector3(step.at("camera")), lr);
    check(filter, step, innovation);
  }
}

TEST(ExtendedFilter, MatchesTheReferenceDriveTo12Digits) {
  ODOBENCH_NEEDS_SHARED();
  const json v = testing::reference_json("ekf.json").at("vector");
  ASSERT_EQ(v.at("steps").size(), 120u);
  int cameras = 0;
  run_reference(FilterKind::Extended, v,
                [&](const PoseFilter& filter, const json& step, const auto& innovation) {
                  SCOPED_TRACE(step.at("k").dump());
                  EXPECT_LE((filter.state() - vector3(step.at("x"))).cwiseAbs().maxCoeff(), 1e-12);
                  const Matrix3d p = filter.covariance();
                  for (Eigen::Index i = 0; i < 9; ++i)
                    EXPECT_NEAR(p(i / 3, i % 3), step.at("P").at(static_cast<std::size_t>(i)).get<double>(),
                                1e-12 * p.cwiseAbs().maxCoeff());
                  if (!innovation) return;
                  ++cameras;
                  EXPECT_LE((innovation->nu - vector3(step.at("innovation"))).cwiseAbs().maxCoeff(), 1e-12);
                  EXPECT_NEAR(innovation->nis, step.at("nis").get<double>(), 1e-11);
                });
  EXPECT_EQ(cameras, 40);
}

TEST(UnscentedFilter, StaysNearTheExtendedOneOnTheReferenceDrive) {
  ODOBENCH_NEEDS_SHARED();
  const json v = testing::reference_json("ekf.json").at("vector");
  double most = 0, least = 1;
  run_reference(FilterKind::Unscented, v, [&](const PoseFilter& filter, const json& step, const auto&) {
    const double difference = (filter.state() - vector3(step.at("x"))).cwiseAbs().maxCoeff();
    most = std::max(most, difference);
    least = std::min(least, difference);
  });
  EXPECT_LE(most, 1e-5);
  EXPECT_GT(most, 1e-9);  // it is another filter
}

// A linear drive: position and velocity in the plane, unknown start, forces, position measured.
struct LinearCase {
  LinearSystemModel model;
  Matrix q, p0, r;
  LinearSensor sensor;
  std::vector<Vector> inputs, measurements;
};

LinearCase linear_case(int steps) {
  LinearSystem s;
  s.a = Matrix::Zero(4, 4);
  s.a(0, 1) = s.a(2, 3) = 1;
  s.a(1, 3) = 0.4;
  s.a(3, 1) = -0.4;
  s.b = s.g = Matrix::Zero(4, 2);
  s.b(1, 0) = s.b(3, 1) = s.g(1, 0) = s.g(3, 1) = 1;
  s.qc = Matrix::Identity(2, 2) * 0.02;
  const Discretisation d = discretise(s, 0.1);
  LinearCase c{{d.f, d.psi}, d.q, Matrix::Identity(4, 4), Matrix::Identity(2, 2) * 0.01, {}, {}, {}};
  c.sensor.h = Matrix::Zero(2, 4);
  c.sensor.h(0, 0) = c.sensor.h(1, 2) = 1;
  for (int k = 0; k < steps; ++k) {
    c.inputs.push_back(Eigen::Vector2d(std::sin(0.3 * k), std::cos(0.2 * k)));
    c.measurements.push_back(Eigen::Vector2d(std::sin(1.1 * k), 0.05 * k + std::cos(2.3 * k)));
  }
  return c;
}

Vector filtered(const LinearCase& c, FilterKind kind, Matrix* covariance) {
  KalmanOptions options;
  options.kind = kind;
  LinearKalmanFilter filter(c.model, options, Vector::Zero(4), c.p0);
  const Matrix lq = covariance_factor("Q", c.q), lr = covariance_factor("R", c.r);
  for (std::size_t k = 0; k < c.inputs.size(); ++k) {
    filter.predict(c.inputs[k], lq, 0.1);
    filter.update(c.sensor, c.measurements[k], lr);
  }
  *covariance = filter.covariance();
  return filter.state();
}

// All states and measurements at once, weighted by the inverse covariances.
Vector batch(const LinearCase& c, Matrix* covariance) {
  const auto steps = static_cast<Eigen::Index>(c.inputs.size());
  const Eigen::Index n = 4, m = 2, columns = n * (steps + 1);
  Matrix a = Matrix::Zero(n + steps * (n + m), columns);
  Vector b = Vector::Zero(a.rows());
  const auto whiten = [](const Matrix& p) { return Matrix(covariance_factor("P", p).inverse()); };
  const Matrix wq = whiten(c.q), wr = whiten(c.r);
  a.topLeftCorner(n, n) = whiten(c.p0);
  for (Eigen::Index k = 0; k < steps; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const Eigen::Index row = n + k * (n + m), column = n * k;
    a.block(row, column, n, n) = -wq * c.model.f;
    a.block(row, column + n, n, n) = wq;
    b.segment(row, n) = wq * c.model.psi * c.inputs[i];
    a.block(row + n, column + n, m, n) = wr * c.sensor.h;
    b.segment(row + n, m) = wr * c.measurements[i];
  }
  const Eigen::HouseholderQR<Matrix> qr(a);
  const Vector x = qr.solve(b);
  const Matrix r = qr.matrixQR().topRows(columns).triangularView<Eigen::Upper>();
  const Matrix ri = r.triangularView<Eigen::Upper>().solve(Matrix::Identity(columns, columns));
  *covariance = (ri * ri.transpose()).bottomRightCorner(n, n);
  return x.tail(n);
}

TEST(LinearFilter, EqualsBatchLeastSquares) {
  const LinearCase c = linear_case(40);
  Matrix expected_p, p;
  const Vector expected = batch(c, &expected_p);
  for (const FilterKind kind : {FilterKind::Extended, FilterKind::Unscented}) {
    const Vector x = filtered(c, kind, &p);
    EXPECT_LE((x - expected).cwiseAbs().maxCoeff(), 1e-10);
    EXPECT_LE((p - expected_p).cwiseAbs().maxCoeff(), 1e-10);
  }
}

TEST(ExtendedFilter, RecoversTheTruthFromExactMeasurements) {
  for (const FilterKind kind : {FilterKind::Extended, FilterKind::Unscented}) {
    KalmanOptions options;
    options.kind = kind;
    PoseFilter filter({}, options, Vector3d(0.3, -0.2, 0.1), Matrix3d::Identity());
    Vector3d truth(0, 0, 3.0);
    const Twist u{0.05, 0.01, 0.3};
    for (int k = 0; k < 400; ++k) {
      filter.predict(u, Matrix3d::Identity() * 1e-2, 0.02);
      truth = Pose().move(truth, Vector3d::Zero(), u, 0.02);
      Vector3d z = truth;
      z[2] = wrapped_angle(z[2]);
      filter.update(PoseSensor<3>(), z, Matrix3d::Identity() * 1e-9);
    }
    // The state's heading is not wrapped, only what it is compared with.
    Vector3d e = filter.state() - truth;
    e[2] = wrapped_angle(e[2]);
    EXPECT_LE(e.cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(ExtendedFilter, ReadToTheLetterItLeadsByOneIncrement) {
  for (const double gain : {0.1, 1.0, 10.0}) {
    for (const bool literal : {false, true}) {
      KalmanOptions options;
      options.literal_47 = literal;
      PoseFilter filter({}, options, Vector3d::Zero(), Matrix3d::Identity() * 1e-4);
      Vector3d truth = Vector3d::Zero();
      const Twist u{0.05, 0, 0};
      for (int k = 0; k < 3000; ++k) {
        filter.predict(u, Matrix3d::Identity() * 0.01 * gain, 0.016);
        truth[0] += 0.05 * 0.016;
        filter.update(PoseSensor<3>(), truth, Matrix3d::Identity() * 0.001);
      }
      EXPECT_NEAR(filter.state()[0] - truth[0], literal ? 0.05 * 0.016 : 0.0, 1e-9) << gain << literal;
    }
  }
}

TEST(ExtendedFilter, StaysPositiveDefiniteForTenMillionSteps) {
  PoseFilter filter({}, {}, Vector3d::Zero(), Matrix3d::Identity() * 1e6);
  const Matrix3d lq = Vector3d(1e-2, 1e-6, 1e-3).asDiagonal(), lr = Vector3d(1e-7, 1, 1e-5).asDiagonal();
  const Twist u{0.3, -0.1, 0.2};
  Vector3d truth = Vector3d::Zero();
  for (int k = 0; k < kManySteps; ++k) {
    filter.predict(u, lq, 0.01);
    truth = Pose().move(truth, Vector3d::Zero(), u, 0.01);
    filter.update(PoseSensor<3>(), truth, lr);
    if (k % 1000 != 0) continue;
    const Matrix3d p = filter.covariance();
    ASSERT_EQ((p - p.transpose()).cwiseAbs().maxCoeff(), 0) << k;
    ASSERT_GT(filter.factor().diagonal().minCoeff(), 0) << k;
    ASSERT_NO_THROW(require_covariance("P", p, Definiteness::Positive)) << k;
  }
  EXPECT_LE((filter.state() - truth).norm(), 1e-6);
}

TEST(UnscentedFilter, StaysPositiveDefiniteToo) {
  KalmanOptions options;
  options.kind = FilterKind::Unscented;
  PoseFilter filter({}, options, Vector3d::Zero(), Matrix3d::Identity());
  const Matrix3d lq = Vector3d(1e-2, 1e-6, 1e-3).asDiagonal(), lr = Vector3d(1e-7, 1, 1e-5).asDiagonal();
  Vector3d truth = Vector3d::Zero();
  for (int k = 0; k < kManySteps / 20; ++k) {
    filter.predict({0.3, -0.1, 0.2}, lq, 0.01);
    truth = Pose().move(truth, Vector3d::Zero(), {0.3, -0.1, 0.2}, 0.01);
    filter.update(PoseSensor<3>(), truth, lr);
    if (k % 1000 == 0) {
      ASSERT_NO_THROW(require_covariance("P", Matrix(filter.covariance()), Definiteness::Positive)) << k;
    }
  }
}

TEST(Filter, GatesOutliersAndSaysSo) {
  PoseFilter filter({}, {}, Vector3d::Zero(), Matrix3d::Identity() * 1e-4);
  const double gate = chi_square_quantile(0.997, 3);
  const Matrix3d lr = Matrix3d::Identity() * 0.01;
  const auto outlier = filter.update(PoseSensor<3>(), Vector3d(1, 0, 0), lr, gate);
  EXPECT_FALSE(outlier.accepted);
  EXPECT_GT(outlier.nis, gate);
  EXPECT_EQ(filter.state(), Vector3d::Zero());
  EXPECT_TRUE(filter.update(PoseSensor<3>(), Vector3d(0.01, 0, 0), lr, gate).accepted);
  const Vector3d before = filter.state();
  const auto gyro = filter.model().yaw_rate(filter.state(), 0, 5.0, 1e-3);
  EXPECT_FALSE(filter.predict({0, 0, 0}, Matrix3d::Identity() * 0.01, 0.1, &gyro, gate).accepted);
  EXPECT_EQ(filter.state(), before);
}

TEST(Filter, ComparesAnglesAcrossTheJump) {
  for (const FilterKind kind : {FilterKind::Extended, FilterKind::Unscented}) {
    KalmanOptions options;
    options.kind = kind;
    PoseFilter filter({}, options, Vector3d(0, 0, 7 * kPi - 0.001), Matrix3d::Identity() * 1e-2);
    const auto i = filter.update(PoseSensor<3>(), Vector3d(0, 0, -kPi + 0.001), Matrix3d::Identity() * 1e-6);
    EXPECT_NEAR(i.nu[2], 0.002, 1e-12);
    EXPECT_NEAR(filter.state()[2], 7 * kPi + 0.001, 1e-6);
  }
  EXPECT_EQ(wrapped_angle(kPi), kPi);
  EXPECT_EQ(wrapped_angle(-kPi), kPi);
  EXPECT_EQ(wrapped_angle(0.1), 0.1);
  EXPECT_NEAR(wrapped_angle(2 * kPi + 0.1), 0.1, 1e-15);
}

TEST(Filter, RelativePosesHaveTheRightJacobian) {
  using Model = RobotModel<true, true, true>;
  const RelativePoseSensor<Model::kStates, Model::kCopy> sensor;
  Eigen::Matrix<double, Model::kStates, 1> x;
  x << 0.3, -0.2, 1.1, 0.01, 0.02, 0.1, -0.4, 0.7;
  const auto h = sensor.jacobian(x);
  const Model model;
  Eigen::Matrix<double, Model::kNoises, 1> w;
  w << 0.01, -0.02, 0.03, 0.001, 0.002;
  const Twist u{0.2, -0.1, 0.4};
  Eigen::Matrix<double, Model::kStates, Model::kStates> f;
  Eigen::Matrix<double, Model::kStates, Model::kNoises> g;
  EXPECT_LE((model.linearise(x, w, u, 0.3, f, g) - model.move(x, w, u, 0.3)).norm(), 1e-15);
  constexpr double kStep = 1e-6;
  for (int i = 0; i < Model::kStates; ++i) {
    auto up = x, down = x;
    up[i] += kStep;
    down[i] -= kStep;
    EXPECT_LE((h.col(i) - (sensor.measure(up) - sensor.measure(down)) / (2 * kStep)).norm(), 1e-9) << i;
    EXPECT_LE((f.col(i) - (model.move(up, w, u, 0.3) - model.move(down, w, u, 0.3)) / (2 * kStep)).norm(),
              1e-9)
        << i;
  }
  for (int i = 0; i < Model::kNoises; ++i) {
    auto up = w, down = w;
    up[i] += kStep;
    down[i] -= kStep;
    EXPECT_LE((g.col(i) - (model.move(x, up, u, 0.3) - model.move(x, down, u, 0.3)) / (2 * kStep)).norm(),
              1e-9)
        << i;
  }
}

TEST(Filter, LearnsTheBiasOfAGyro) {
  using Model = RobotModel<true, false, false>;
  for (const FilterKind kind : {FilterKind::Extended, FilterKind::Unscented}) {
    KalmanOptions options;
    options.kind = kind;
    KalmanFilter<Model> filter({}, options, Eigen::Vector4d::Zero(),
                               Matrix(Eigen::Vector4d(1e-6, 1e-6, 1e-6, 1e-2).asDiagonal()));
    const Eigen::Matrix4d lq = Eigen::Vector4d(1e-3, 1e-3, 0.05, 1e-7).asDiagonal();
    Normal normal(3);
    Vector3d truth = Vector3d::Zero();
    for (int k = 0; k < 4000; ++k) {
      const Twist u{0.05, 0, 0.2}, wheels{0.05, 0, 0.2 + normal(0.05)};
      const auto gyro =
          filter.model().yaw_rate(filter.state(), wheels.omega, 0.2 + 0.03 + normal(1e-3), 1e-3);
      filter.predict(wheels, lq, 0.01, &gyro);
      truth = Pose().move(truth, Vector3d::Zero(), u, 0.01);
      if (k % 10 == 0)
        filter.update(HeadingSensor<4>(), Eigen::Matrix<double, 1, 1>(wrapped_angle(truth[2] + normal(1e-3))),
                      Eigen::Matrix<double, 1, 1>(1e-3));
    }
    EXPECT_NEAR(filter.state()[3], 0.03, 5 * std::sqrt(filter.covariance()(3, 3)));
    EXPECT_NEAR(filter.state()[3], 0.03, 1e-3);
    EXPECT_LE(std::sqrt(filter.covariance()(3, 3)), 5e-4);
  }
}

TEST(Filter, RefusesBadInput) {
  const Vector3d zero = Vector3d::Zero();
  Matrix p = Matrix::Identity(3, 3);
  p(2, 2) = -1;
  EXPECT_THAT(testing::refusal_of<std::invalid_argument>([&] { PoseFilter({}, {}, zero, p); }),
              HasSubstr("initial covariance has the eigenvalue -1"));
  p << 1, 2, 0, 2, 1, 0, 0, 0, 1;
  EXPECT_THAT(testing::refusal_of<std::invalid_argument>([&] { PoseFilter({}, {}, zero, p); }),
              HasSubstr("eigenvalue -1"));
  EXPECT_THAT(
      testing::refusal_of<std::invalid_argument>([&] { PoseFilter({}, {}, zero, Matrix::Identity(4, 4)); }),
      HasSubstr("initial covariance is 4 x 4, expected 3 rows"));
  const Vector3d nan = Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_THAT(
      testing::refusal_of<std::invalid_argument>([&] { PoseFilter({}, {}, nan, Matrix::Identity(3, 3)); }),
      HasSubstr("not finite"));
  KalmanOptions options;
  options.kind = FilterKind::Unscented;
  options.unscented.alpha = 1e-3;
  EXPECT_THAT(testing::refusal_of<std::invalid_argument>(
                  [&] { PoseFilter({}, options, zero, Matrix::Identity(3, 3)); }),
              HasSubstr("the centre's covariance weight"));
  options.unscented.alpha = 0;
  EXPECT_THAT(testing::refusal_of<std::invalid_argument>(
                  [&] { PoseFilter({}, options, zero, Matrix::Identity(3, 3)); }),
              HasSubstr("expected > 0"));

  PoseFilter filter({}, {}, zero, Matrix::Zero(3, 3));
  EXPECT_THAT(testing::refusal_of<std::runtime_error>(
                  [&] { filter.update(PoseSensor<3>(), zero, Matrix3d::Zero()); }),
              HasSubstr("no positive definite covariance"));
  EXPECT_THAT(testing::refusal_of<std::runtime_error>(
                  [&] { filter.update(PoseSensor<3>(), nan, Matrix3d::Identity()); }),
              HasSubstr("not finite"));
  EXPECT_THAT(testing::refusal_of<std::runtime_error>([&] {
                filter.predict({std::numeric_limits<double>::infinity(), 0, 0}, Matrix3d::Identity(), 0.1);
              }),
              HasSubstr("not finite"));
  LinearKalmanFilter linear({Matrix::Identity(2, 2), Matrix(2, 0)}, {}, Vector::Zero(2),
                            Matrix::Identity(2, 2));
  LinearSensor sensor;
  sensor.h = Matrix::Identity(1, 3);
  EXPECT_THAT(testing::refusal_of<std::invalid_argument>(
                  [&] { linear.update(sensor, Vector::Zero(1), Matrix::Identity(1, 1)); }),
              HasSubstr("H has 3 columns, expected 2"));
}

}  // namespace
}  // namespace odobench
