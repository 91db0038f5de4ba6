// Speed of the filters with three states: a step is a prediction and an update with a pose, as it happens at
// a camera's frame; `predict` alone is what happens between frames. Further: a whole recording through
// fuse().
//   bench_filters [Google Benchmark's flags]
#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include "datasets/robot_4wis4wid.hpp"
#include "problems/fusion/fusion.hpp"
#include "problems/fusion/robot_model.hpp"

namespace odobench {
namespace {

using Model = RobotModel<false, false, false>;
using Filter = KalmanFilter<Model>;

KalmanOptions options_of(FilterKind kind) {
  KalmanOptions options;
  options.kind = kind;
  return options;
}

// Inputs that differ from step to step, so that nothing can be foreseen.
struct Inputs {
  std::vector<Twist> twists;
  std::vector<Eigen::Vector3d> poses;
};
Inputs inputs() {
  Inputs in;
  Eigen::Vector3d pose = Eigen::Vector3d::Zero();
  for (int k = 0; k < 1024; ++k) {
    in.twists.push_back(
        {0.05 + 0.01 * std::sin(0.3 * k), 0.01 * std::cos(0.2 * k), 0.08 * std::sin(0.1 * k)});
    pose = Model().move(pose, Eigen::Vector3d::Zero(), in.twists.back(), 0.016);
    in.poses.push_back(pose + Eigen::Vector3d(0.01 * std::sin(1.7 * k), 0.01 * std::cos(1.1 * k), 0.0));
  }
  return in;
}

void step(benchmark::State& state, FilterKind kind, bool gyro, bool camera) {
  const Inputs in = inputs();
  Filter filter({}, options_of(kind), Eigen::Vector3d::Zero(), Matrix(Eigen::Matrix3d::Identity() * 1e-4));
  const Eigen::Matrix3d lq = Eigen::Vector3d(0.01, 0.01, 0.02).asDiagonal();
  const Eigen::Matrix3d lr = Eigen::Vector3d(0.02, 0.02, 0.01).asDiagonal();
  std::size_t k = 0;
  for (auto _ : state) {
    k = (k + 1) & 1023;
    const auto reading =
        filter.model().yaw_rate(filter.state(), in.twists[k].omega, in.twists[k].omega + 1e-4, 1e-3);
    filter.predict(in.twists[k], lq, 0.016, gyro ? &reading : nullptr);
    if (camera) filter.update(PoseSensor<3>(), in.poses[k], lr);
    benchmark::DoNotOptimize(filter.state().data());
  }
}

BENCHMARK_CAPTURE(step, ekf_step, FilterKind::Extended, false, true);
BENCHMARK_CAPTURE(step, ekf_step_with_gyro, FilterKind::Extended, true, true);
BENCHMARK_CAPTURE(step, ekf_predict, FilterKind::Extended, false, false);
BENCHMARK_CAPTURE(step, ukf_step, FilterKind::Unscented, false, true);
BENCHMARK_CAPTURE(step, ukf_step_with_gyro, FilterKind::Unscented, true, true);
BENCHMARK_CAPTURE(step, ukf_predict, FilterKind::Unscented, false, false);

// 80 s of wheels at 62.5 Hz, camera at 30 Hz, gyro at 50 Hz.
void recording(benchmark::State& state, FilterKind kind) {
  Recording r = recording_4wis4wid();
  r.id = "made up";
  for (int k = 0; k < 5000; ++k) {
    r.time_us.push_back(k * 16'000);
    r.reference.x.push_back(0);
    r.reference.y.push_back(0);
    r.reference.theta.push_back(0);
    for (std::size_t i = 0; i < kWheelCount; ++i) {
      steering_of(r, i).push_back(0.1 * std::sin(0.01 * k));
      wheel_speed_of(r, i).push_back(1.97);
    }
  }
  std::vector<SensorStream> sensors{{"camera", SensorKind::Pose, 0.02, 0.02, 0, 0, {}},
                                    {"gyro", SensorKind::YawRate, 0, 0, 2e-3, 0.02, {}}};
  for (std::int64_t t = 5'000; t < r.time_us.back(); t += 33'333)
    sensors[0].data.push_back({t, t, Eigen::Vector3d(5e-8 * static_cast<double>(t), 0, 0)});
  for (std::int64_t t = 2'000; t < r.time_us.back(); t += 20'000)
    sensors[1].data.push_back({t, t, Eigen::Vector3d(0.001, 0, 0)});
  Vector z(12);
  z << 0.1125, -0.1125, -0.1125, 0.1125, 0.1125, 0.1125, -0.1125, -0.1125, 0.0254, 0.0254, 0.0254, 0.0254;
  FusionOptions options;
  options.filter.kind = kind;
  for (auto _ : state) {
    const FusionResult result = fuse(r, z, sensors, options);
    benchmark::DoNotOptimize(result.track.x.data());
  }
}
BENCHMARK_CAPTURE(recording, ekf, FilterKind::Extended)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(recording, ukf, FilterKind::Unscented)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace odobench

BENCHMARK_MAIN();
