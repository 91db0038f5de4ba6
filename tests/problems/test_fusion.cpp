// Streams of measurements through the filters: order, delays, gaps, smoothing, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "datasets/robot_4wis4wid.hpp"
#include "problems/fusion/fusion.hpp"
#include "problems/fusion/robot_model.hpp"
#include "problems/fusion/sensor_streams.hpp"
#include "tests/support/data/synthetic_recording.hpp"
#include "tests/support/data_error.hpp"

namespace odobench {
namespace {

using ::testing::HasSubstr;

Vector nominal() {
  Vector z(12);
  const std::vector<ParameterInfo> list = testing::nominal_robot();
  for (Eigen::Index i = 0; i < 12; ++i) z[i] = list[static_cast<std::size_t>(i)].nominal;
  return z;
}

// A drive whose reference is what wheels with the nominal parameters say.
Recording exact_drive(int samples = 600) {
  Recording r = testing::synthetic_recording(samples, 0.016, 1);
  for (std::size_t i = 0; i < kWheelCount; ++i)
    for (double& d : steering_of(r, i)) d *= 0.5;
  const PoseTrack track = direct::integrate(r, nominal());
  r.reference.x = track.x;
  r.reference.y = track.y;
  r.reference.theta = track.theta;
  return r;
}

SensorStream heading(const Recording& r, std::size_t every, double sigma) {
  SensorStream s{"compass", SensorKind::Heading, 0, sigma, 0, 0, {}};
  for (std::size_t k = every; k < r.size(); k += every)
    s.data.push_back({r.time_us[k], r.time_us[k], {0, 0, wrapped_angle(r.reference.theta[k])}});
  return s;
}

SensorStream pose(const Recording& r, std::size_t every, double position, double angle) {
  SensorStream s{"camera", SensorKind::Pose, position, angle, 0, 0, {}};
  for (std::size_t k = every; k < r.size(); k += every)
    s.data.push_back({r.time_us[k],
                      r.time_us[k],
                      {r.reference.x[k], r.reference.y[k], wrapped_angle(r.reference.theta[k])}});
  return s;
}

Vector wrong() {
  Vector z = nominal();
  z.tail(4) *= 1.05;
  z.segment(4, 4) *= 0.96;
  return z;
}

double largest_error(const Recording& r, const PoseTrack& track) {
  const MaxErrors e = track_errors(r, track, {}).max;
  return std::max({e.x, e.y, e.theta});
}

TEST(Fusion, WithoutMeasurementsInTimeItIsTheOdometry) {
  const Recording r = exact_drive();
  // One measurement that says nothing: the filter needs some data.
  const SensorStream weak = heading(r, 500, 1e6);
  for (const FilterKind kind : {FilterKind::Extended, FilterKind::Unscented}) {
    FusionOptions options;
    options.filter.kind = kind;
    options.sigma_velocity = options.sigma_yaw_rate = 1e-5;
    options.initial_position = options.initial_heading = 0;
    const FusionResult result = fuse(r, wrong(), std::vector{weak}, options);
    const PoseTrack odometry = direct::integrate(r, wrong());
    double most = 0;
    for (std::size_t k = 0; k < r.size(); ++k)
      most = std::max({most, std::abs(result.track.x[k] - odometry.x[k]),
                       std::abs(result.track.y[k] - odometry.y[k]),
                       std::abs(result.track.theta[k] - odometry.theta[k])});
    EXPECT_LE(most, 1e-9);
  }
}

TEST(Fusion, ExactSensorsCorrectWrongWheels) {
  const Recording r = exact_drive();
  const double odometry = largest_error(r, direct::integrate(r, wrong()));
  const std::vector<SensorStream> camera{pose(r, 5, 1e-4, 1e-4)};
  for (const FilterKind kind : {FilterKind::Extended, FilterKind::Unscented}) {
    FusionOptions options;
    options.filter.kind = kind;
    const FusionResult result = fuse(r, wrong(), camera, options);
    EXPECT_LE(largest_error(r, result.track), 0.1 * odometry);
    EXPECT_EQ(result.sensors[0].used, static_cast<std::int64_t>(camera[0].data.size()));
    EXPECT_EQ(result.sensors[0].rejected, 0);
    EXPECT_EQ(result.sensors[0].dof, 3);
  }
}

TEST(Fusion, CuttingAnIntervalChangesNothing) {
  // A useless sensor at odd stamps cuts every interval in two.
  const Recording r = exact_drive(200);
  FusionOptions options;
  const FusionResult whole = fuse(r, wrong(), std::vector{heading(r, 199, 1e9)}, options);
  SensorStream odd = heading(r, 199, 1e9);
  odd.data.clear();
  for (std::size_t k = 0; k + 1 < r.size(); ++k) {
    const std::int64_t t = (2 * r.time_us[k] + r.time_us[k + 1]) / 3;
    odd.data.push_back({t, t, {0, 0, 0}});
  }
  const FusionResult cut = fuse(r, wrong(), std::vector{odd}, options);
  for (std::size_t k = 0; k < r.size(); k += 20) {
    const Eigen::Matrix3d a = whole.factors[k] * whole.factors[k].transpose();
    const Eigen::Matrix3d b = cut.factors[k] * cut.factors[k].transpose();
    EXPECT_LE((a - b).norm(), 2e-2 * a.norm()) << k;  // not bit for bit: Euler's steps are shorter
    EXPECT_NEAR(whole.track.x[k], cut.track.x[k], 2e-3);
  }
}

TEST(Fusion, DelayedMeasurementsAreUsedInTheOrderOfTheirStamps) {
  const Recording r = exact_drive();
  std::vector<SensorStream> prompt{pose(r, 5, 1e-2, 1e-2), heading(r, 7, 1e-2)};
  std::vector<SensorStream> delayed = prompt;
  for (Measurement& m : delayed[0].data) m.arrival_us += 40'000;
  FusionOptions options;
  const FusionResult a = fuse(r, wrong(), prompt, options), b = fuse(r, wrong(), delayed, options);
  // Late knowledge at every instant, but the same once everything has arrived: some time after the last
  // frame.
  std::size_t same = 0, different = 0;
  for (std::size_t k = 10; k < r.size(); ++k) (a.track.x[k] == b.track.x[k] ? same : different) += 1;
  EXPECT_GT(same, 10u);
  EXPECT_GT(different, 50u);
  EXPECT_EQ(b.sensors[0].used, a.sensors[0].used);
  // An early frame alone: wherever its arrival lies behind, both are the same bits.
  prompt = {pose(r, 100, 1e-2, 1e-2)};
  prompt[0].data.resize(1);
  delayed = prompt;
  delayed[0].data[0].arrival_us += 500'000;
  const FusionResult c = fuse(r, wrong(), prompt, options), d = fuse(r, wrong(), delayed, options);
  const FusionResult none = fuse(r, wrong(), std::vector{heading(r, 599, 1e9)}, options);
  EXPECT_EQ(c.track.x.back(), d.track.x.back());
  EXPECT_EQ(c.track.theta.back(), d.track.theta.back());
  EXPECT_NE(c.track.x[101], d.track.x[101]);
  EXPECT_EQ(d.track.x[101], none.track.x[101]);
  // Beyond the largest delay: not used, counted.
  options.max_delay_s = 0.4;
  const FusionResult late = fuse(r, wrong(), delayed, options);
  EXPECT_EQ(late.sensors[0].late, 1);
  EXPECT_EQ(late.sensors[0].used, 0);
  EXPECT_EQ(late.track.x.back(), none.track.x.back());
}

TEST(Fusion, CountsOutliersAndWhatLiesOutside) {
  const Recording r = exact_drive();
  SensorStream camera = pose(r, 5, 1e-2, 1e-2);
  camera.data[20].value[0] += 5;
  camera.data[40].value[1] -= 3;
  camera.data.insert(camera.data.begin(), {-5, -5, {0, 0, 0}});
  FusionOptions options;
  options.gate_probability = 0.9999;
  const FusionResult result = fuse(r, nominal(), std::vector{camera}, options);
  EXPECT_EQ(result.sensors[0].rejected, 2);
  EXPECT_EQ(result.sensors[0].outside, 1);
  EXPECT_EQ(result.sensors[0].used, static_cast<std::int64_t>(camera.data.size()) - 3);
  EXPECT_LE(largest_error(r, result.track), 1e-3);
  options.gate_probability = 0;
  EXPECT_GE(largest_error(r, fuse(r, nominal(), std::vector{camera}, options).track), 0.1);
}

TEST(Fusion, SmoothingAgreesAtTheEndAndIsSharperBefore) {
  const Recording r = exact_drive();
  const std::vector<SensorStream> camera{pose(r, 50, 1e-3, 1e-3)};
  for (const FilterKind kind : {FilterKind::Extended, FilterKind::Unscented})
    for (const bool more : {false, true}) {
      FusionOptions options;
      options.filter.kind = kind;
      options.smooth = true;
      if (more) options.odometry_scale = WalkingState{0.1, 1e-4};
      const FusionResult result = fuse(r, wrong(), camera, options);
      ASSERT_EQ(result.smoothed.x.size(), r.size());
      EXPECT_NEAR(result.smoothed.x.back(), result.track.x.back(), 1e-12);
      for (std::size_t k = 60; k < 500; k += 20) {
        const double before = result.factors[k].norm(), after = result.smoothed_factors[k].norm();
        EXPECT_LE(after, before * (1 + 1e-9)) << k;
      }
      EXPECT_LE(track_errors(r, result.smoothed, {}).rmse_position,
                0.7 * track_errors(r, result.track, {}).rmse_position);
    }
}

TEST(Fusion, SmoothingEqualsBatchLeastSquares) {
  // Straight ahead with a known heading: x is a random walk about the odometry, a linear problem.
  constexpr Eigen::Index kSamples = 120;
  constexpr double kSigmaV = 0.02, kSigmaZ = 0.003, kSigma0 = 0.01;
  Recording r = recording_4wis4wid();
  r.id = "straight";
  SensorStream camera{"camera", SensorKind::Pose, kSigmaZ, 1.0, 0, 0, {}};
  for (Eigen::Index k = 0; k < kSamples; ++k) {
    r.time_us.push_back(k * 16'000 + (k % 3) * 1'000);
    for (std::size_t i = 0; i < kWheelCount; ++i) {
      steering_of(r, i).push_back(0);
      wheel_speed_of(r, i).push_back(2);
    }
    r.reference.x.push_back(0);
    r.reference.y.push_back(0);
    r.reference.theta.push_back(0);
    if (k % 10 == 9)
      camera.data.push_back(
          {r.time_us.back(), r.time_us.back(), {0.05 * std::sin(1.0 * static_cast<double>(k)), 0, 0}});
  }
  Matrix information = Matrix::Zero(kSamples, kSamples);
  Vector right = Vector::Zero(kSamples);
  information(0, 0) = 1 / (kSigma0 * kSigma0);
  for (Eigen::Index k = 0; k + 1 < kSamples; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const double dt = static_cast<double>(r.time_us[i + 1] - r.time_us[i]) * 1e-6;
    const double weight = 1 / (dt * dt * kSigmaV * kSigmaV), step = dt * 2 * 0.0254;
    information(k, k) += weight;
    information(k + 1, k + 1) += weight;
    information(k, k + 1) -= weight;
    information(k + 1, k) -= weight;
    right[k] -= weight * step;
    right[k + 1] += weight * step;
  }
  for (const Measurement& m : camera.data) {
    const auto k = std::lower_bound(r.time_us.begin(), r.time_us.end(), m.time_us) - r.time_us.begin();
    information(k, k) += 1 / (kSigmaZ * kSigmaZ);
    right[k] += m.value[0] / (kSigmaZ * kSigmaZ);
  }
  const Matrix covariance = information.inverse();
  const Vector batch = covariance * right;
  for (const FilterKind kind : {FilterKind::Extended, FilterKind::Unscented}) {
    FusionOptions options;
    options.filter.kind = kind;
    options.smooth = true;
    options.sigma_velocity = kSigmaV;
    options.sigma_yaw_rate = 1e-9;
    options.initial_position = kSigma0;
    options.initial_heading = 1e-9;
    const FusionResult result = fuse(r, nominal(), std::vector{camera}, options);
    for (Eigen::Index k = 0; k < kSamples; ++k) {
      const auto i = static_cast<std::size_t>(k);
      EXPECT_NEAR(result.smoothed.x[i], batch[k], 1e-9) << k;
      EXPECT_NEAR(result.smoothed_factors[i].row(0).squaredNorm() / covariance(k, k), 1, 1e-6) << k;
    }
  }
}

TEST(Fusion, LearnsScaleAndBias) {
  const Recording r = exact_drive(3000);
  Vector z = nominal();
  z.tail(4) /= 1.03;  // the wheels report 3 % too little
  std::vector<SensorStream> sensors{pose(r, 5, 1e-3, 1e-3),
                                    {"gyro", SensorKind::YawRate, 0, 0, 1e-3, 0.02, {}}};
  for (std::size_t k = 0; k + 1 < r.size(); ++k) {
    const double dt = static_cast<double>(r.time_us[k + 1] - r.time_us[k]) * 1e-6;
    sensors[1].data.push_back(
        {r.time_us[k], r.time_us[k], {(r.reference.theta[k + 1] - r.reference.theta[k]) / dt + 0.02, 0, 0}});
  }
  FusionOptions options;
  options.gyro_bias = WalkingState{0.05, 1e-5};
  options.odometry_scale = WalkingState{0.1, 1e-5};
  for (const FilterKind kind : {FilterKind::Extended, FilterKind::Unscented}) {
    options.filter.kind = kind;
    const FusionResult result = fuse(r, z, sensors, options);
    ASSERT_TRUE(result.gyro_bias && result.odometry_scale);
    EXPECT_NEAR(*result.gyro_bias, 0.02, 1e-3);
    EXPECT_NEAR(*result.odometry_scale, 0.03, 5e-3);
  }
}

TEST(Fusion, RelativePosesDefeatDrift) {
  const Recording r = exact_drive(2000);
  SensorStream absolute = pose(r, 10, 1e-3, 1e-3);
  for (std::size_t i = 0; i < absolute.data.size(); ++i)  // an offset that jumped once, long ago
    if (i > 20) absolute.data[i].value += Eigen::Vector3d(0.3, -0.2, 0);
  SensorStream relative = absolute;
  relative.kind = SensorKind::RelativePose;
  FusionOptions options;
  options.gate_probability = 0.9999;
  const double with_offset = largest_error(r, fuse(r, nominal(), std::vector{relative}, options).track);
  options.gate_probability = 0;
  const double absolute_error = largest_error(r, fuse(r, nominal(), std::vector{absolute}, options).track);
  EXPECT_LE(with_offset, 5e-3);
  EXPECT_GE(absolute_error, 0.2);
  EXPECT_EQ(fuse(r, nominal(), std::vector{relative}, options).sensors[0].used,
            static_cast<std::int64_t>(relative.data.size()) - 1);
}

TEST(Fusion, KeepsInnovationsOnRequest) {
  const Recording r = exact_drive();
  const std::vector<SensorStream> camera{pose(r, 5, 1e-2, 1e-2)};
  const FusionResult result = fuse(r, wrong(), camera, {}, true);
  EXPECT_EQ(result.whitened.size(), 3 * camera[0].data.size());
  double sum = 0;
  for (const double w : result.whitened) sum += w * w;
  for (const double d : result.log_dets) sum += d;
  EXPECT_NEAR(-0.5 * sum, result.sensors[0].log_likelihood, 1e-9 * std::abs(sum));
  EXPECT_TRUE(fuse(r, wrong(), camera, {}).whitened.empty());
}

TEST(Fusion, RefusesBadInput) {
  const Recording r = exact_drive(50);
  const std::vector<SensorStream> good{pose(r, 5, 1e-2, 1e-2)};
  const auto usage = [&](const std::vector<SensorStream>& s, const FusionOptions& o) {
    return testing::refusal_of<std::invalid_argument>([&] { fuse(r, nominal(), s, o); });
  };
  const auto data = [&](const std::vector<SensorStream>& s) {
    return testing::refusal_of<std::runtime_error>([&] { fuse(r, nominal(), s, {}); });
  };
  FusionOptions o;
  o.sigma_velocity = 0;
  EXPECT_THAT(usage(good, o), HasSubstr("sigma of the wheels' velocity is 0"));
  o = {};
  o.initial_heading = -1;
  EXPECT_THAT(usage(good, o), HasSubstr("initial heading is -1"));
  o = {};
  o.gate_probability = 1;
  EXPECT_THAT(usage(good, o), HasSubstr("gate probability is 1"));
  o = {};
  o.gyro_bias = WalkingState{0.1, 0};
  EXPECT_THAT(usage(good, o), HasSubstr("no yaw-rate sensor"));
  o = {};
  o.odometry_scale = WalkingState{-0.1, 0};
  EXPECT_THAT(usage(good, o), HasSubstr("odometry scale: initial -0.1"));
  auto s = good;
  s[0].sigma_heading = -1;
  EXPECT_THAT(usage(s, {}), HasSubstr("sensor 'camera': sigma of the heading is -1"));
  s = {good[0], good[0]};
  EXPECT_THAT(usage(s, {}), HasSubstr("two sensors are called 'camera'"));
  s = good;
  s[0].kind = SensorKind::RelativePose;
  o = {};
  o.smooth = true;
  EXPECT_THAT(usage(s, o), HasSubstr("relative poses"));

  s = good;
  s[0].data.clear();
  EXPECT_THAT(data(s), HasSubstr("sensor 'camera' has no data in recording"));
  s = good;
  for (Measurement& m : s[0].data) m.time_us = m.arrival_us = m.time_us + 1'000'000'000;
  EXPECT_THAT(data(s), HasSubstr("has no data"));
  s = good;
  std::swap(s[0].data[2], s[0].data[3]);
  EXPECT_THAT(data(s), HasSubstr("expected increasing stamps"));
  s = good;
  s[0].data[1].arrival_us -= 1;
  EXPECT_THAT(data(s), HasSubstr("before its stamp"));
  s = good;
  s[0].data[1].value[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(data(s), HasSubstr("not finite"));
  Recording shuffled = r;
  std::swap(shuffled.time_us[3], shuffled.time_us[4]);
  EXPECT_THAT(testing::refusal_of<std::runtime_error>([&] { fuse(shuffled, nominal(), good, {}); }),
              HasSubstr("expected increasing stamps"));
}

TEST(SensorStreams, HaveTheErrorsTheyAreMadeWith) {
  const Recording r = exact_drive(6000);
  CameraErrors none;
  StreamTiming timing;
  timing.smooth_s = 0.05;
  const auto clean = synthetic_camera(r, none, timing, 1);
  ASSERT_GT(clean.size(), 2500u);
  for (const Measurement& m : clean) {
    const auto k = static_cast<std::size_t>(std::lower_bound(r.time_us.begin(), r.time_us.end(), m.time_us) -
                                            r.time_us.begin());
    EXPECT_NEAR(m.value[0], r.reference.x[k], 2e-3);
    EXPECT_NEAR(wrapped_angle(m.value[2] - r.reference.theta[k]), 0, 1e-2);
    EXPECT_EQ(m.arrival_us, m.time_us);
  }
  CameraErrors noisy;
  noisy.position_noise = 0.01;
  double sum = 0;
  const auto noise = synthetic_camera(r, noisy, timing, 1);
  ASSERT_EQ(noise.size(), clean.size());
  for (std::size_t i = 0; i < noise.size(); ++i) sum += std::pow(noise[i].value[0] - clean[i].value[0], 2);
  EXPECT_NEAR(std::sqrt(sum / static_cast<double>(noise.size())), 0.01, 5e-4);
  CameraErrors scaled;
  scaled.scale_mean = -0.1;
  const auto shrunk = synthetic_camera(r, scaled, timing, 1);
  EXPECT_NEAR(shrunk.back().value[0] - shrunk[0].value[0], 0.9 * (clean.back().value[0] - clean[0].value[0]),
              1e-3);
  timing.missing = 0.3;
  timing.delay_s = 0.05;
  const auto some = synthetic_camera(r, none, timing, 1);
  EXPECT_NEAR(static_cast<double>(some.size()) / static_cast<double>(clean.size()), 0.7, 0.05);
  EXPECT_EQ(some[0].arrival_us - some[0].time_us, 50'000);
  EXPECT_EQ(synthetic_camera(r, noisy, timing, 5)[7].value, synthetic_camera(r, noisy, timing, 5)[7].value);
  EXPECT_NE(synthetic_camera(r, noisy, timing, 5)[7].value, synthetic_camera(r, noisy, timing, 6)[7].value);
  timing = {};
  timing.rate_hz = 100;
  const auto gyro = synthetic_gyro(r, {0.01, 0, 0}, timing, 3);
  double total = 0;
  for (std::size_t i = 0; i + 1 < gyro.size(); ++i)
    total += gyro[i].value[0] * static_cast<double>(gyro[i + 1].time_us - gyro[i].time_us) * 1e-6;
  const double seconds = static_cast<double>(r.time_us.back()) * 1e-6;
  const double bias = (total - (r.reference.theta.back() - r.reference.theta.front())) / seconds;
  EXPECT_GT(std::abs(bias), 1e-4);
  EXPECT_LT(std::abs(bias), 0.04);
  timing.rate_hz = 0;
  EXPECT_THAT(testing::refusal_of<std::invalid_argument>([&] { synthetic_gyro(r, {}, timing, 1); }),
              HasSubstr("rate_hz is 0"));
  timing = {};
  timing.missing = 1;
  EXPECT_THAT(testing::refusal_of<std::invalid_argument>([&] { synthetic_camera(r, {}, timing, 1); }),
              HasSubstr("missing is 1"));
}

}  // namespace
}  // namespace odobench
