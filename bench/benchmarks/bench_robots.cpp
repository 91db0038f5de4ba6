// Speed of the general form of the calibration cost, robot class by robot class, on the demo set of each:
// cost, normal equations, and for a differential drive the ratio to its equations as written.
//   bench_robots [Google Benchmark's flags]
// Counters: ns_per_sample; x_direct = time of one direct evaluation / time of this one, measured in this
// process; costs = time of this one / time of one cost.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <string>

#include "datasets/robots/layouts.hpp"
#include "problems/calibration/calibration_problem.hpp"
#include "problems/simulation/robot_demo.hpp"

namespace odobench {
namespace {

// A differential drive sample by sample, arcs as written: b, r_right, r_left.
double direct_differential(const std::vector<Recording>& recordings, const Vector& z) {
  double sum = 0;
  for (const Recording& r : recordings) {
    const std::vector<double>&right = r.find("wheel.right")->values, &left = r.find("wheel.left")->values;
    double x = r.reference.x[0], y = r.reference.y[0], theta = r.reference.theta[0];
    for (std::size_t k = 1; k < r.size(); ++k) {
      const double u = z[1] * right[k], v = z[2] * left[k];
      const double ahead = (u + v) / 2, turn = (u - v) / z[0], h = turn / 2;
      const double f = std::abs(h) < 1e-4 ? 1 - h * h / 6 : std::sin(h) / h;
      x += f * ahead * std::cos(theta + h);
      y += f * ahead * std::sin(theta + h);
      theta += turn;
      const double ex = x - r.reference.x[k], ey = y - r.reference.y[k], et = theta - r.reference.theta[k];
      sum += ex * ex + ey * ey + et * et;
    }
  }
  return sum;
}

double seconds_of(const std::function<void()>& body) {
  double best = 1e9;
  for (int k = 0; k < 7; ++k) {
    const auto begin = std::chrono::steady_clock::now();
    body();
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  return best;
}

struct Robot {
  Dataset set;
  std::shared_ptr<const CalibrationProblem> problem;
  Vector nominal;
  double samples = 0, cost_seconds = 0, direct_seconds = 0;
};

std::shared_ptr<const Robot> load(const std::string& kinematics) {
  auto r = std::make_shared<Robot>();
  r->set = make_robot_demo(kinematics, 1);
  CalibrationOptions options;
  options.rule = r->set.robot.rule;
  r->problem = std::make_shared<const CalibrationProblem>(r->set.robot, r->set.recordings, options);
  r->nominal.resize(static_cast<Eigen::Index>(r->set.robot.parameters.size()));
  for (Eigen::Index i = 0; i < r->nominal.size(); ++i)
    r->nominal[i] = r->set.robot.parameters[static_cast<std::size_t>(i)].nominal;
  for (const Recording& recording : r->set.recordings) r->samples += static_cast<double>(recording.size());
  r->cost_seconds = seconds_of([&] { benchmark::DoNotOptimize(r->problem->cost(r->nominal)); });
  if (kinematics == "differential")
    r->direct_seconds =
        seconds_of([&] { benchmark::DoNotOptimize(direct_differential(r->set.recordings, r->nominal)); });
  return r;
}

void add(const std::string& name, const std::shared_ptr<const Robot>& robot,
         const std::function<void(const Robot&)>& body) {
  benchmark::RegisterBenchmark(
      name.c_str(),
      [robot, body](benchmark::State& state) {
        double total = 0;
        for (auto _ : state) {
          const auto begin = std::chrono::steady_clock::now();
          body(*robot);
          const double seconds =
              std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
          state.SetIterationTime(seconds);
          total += seconds;
        }
        const double each = total / static_cast<double>(state.iterations());
        state.counters["ns_per_sample"] = 1e9 * each / robot->samples;
        state.counters["costs"] = each / robot->cost_seconds;
        if (robot->direct_seconds > 0) state.counters["x_direct"] = robot->direct_seconds / each;
      })
      ->Unit(benchmark::kMicrosecond)
      ->UseManualTime();
}

void register_all() {
  for (const robots::Layout& layout : robots::layouts()) {
    const std::shared_ptr<const Robot> robot = load(layout.name);
    if (robot->direct_seconds > 0)
      add(layout.name + "/direct", robot,
          [](const Robot& r) { benchmark::DoNotOptimize(direct_differential(r.set.recordings, r.nominal)); });
    add(layout.name + "/cost", robot,
        [](const Robot& r) { benchmark::DoNotOptimize(r.problem->cost(r.nominal)); });
    add(layout.name + "/normal_equations", robot, [](const Robot& r) {
      NormalEquations e;
      r.problem->normal_equations(r.nominal, e);
      benchmark::DoNotOptimize(e.cost);
    });
  }
}

}  // namespace
}  // namespace odobench

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  odobench::register_all();
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
