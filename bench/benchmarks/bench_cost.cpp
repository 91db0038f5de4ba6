// Speed of the calibration cost: direct form against the structured form, every vector width this processor
// has.
//   bench_cost [--data=set.json] [Google Benchmark's flags]      without --data: the demo set
// Counters: x_direct = time of one direct evaluation / time of this one per candidate, measured in this
// process; ns_per_sample = time per sample and candidate.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>

#include "bench/benchmarks/data_option.hpp"
#include "datasets/dataset.hpp"
#include "problems/calibration/calibration_problem.hpp"
#include "problems/calibration/structure.hpp"

namespace odobench {
namespace {

struct Setting {
  std::vector<ParameterInfo> parameters;
  std::vector<Recording> recordings;
  Vector nominal;
  double samples = 0;
  double direct_seconds = 0;  // best of several
};

Setting load_setting(const std::string& path) {
  Dataset set = load_dataset(path);
  Setting s;
  s.nominal.resize(static_cast<Eigen::Index>(set.robot.parameters.size()));
  s.parameters = set.robot.parameters;
  for (Eigen::Index i = 0; i < s.nominal.size(); ++i)
    s.nominal[i] = s.parameters[static_cast<std::size_t>(i)].nominal;
  s.recordings = std::move(set.recordings);
  for (const Recording& r : s.recordings) s.samples += static_cast<double>(r.size());
  s.direct_seconds = 1e9;
  for (int k = 0; k < 7; ++k) {
    const auto begin = std::chrono::steady_clock::now();
    benchmark::DoNotOptimize(direct::cost(s.recordings, s.nominal));
    s.direct_seconds = std::min(
        s.direct_seconds, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  return s;
}

void register_all(const Setting& s) {
  const auto add = [&s](const std::string& name, double candidates, auto body) {
    benchmark::RegisterBenchmark(
        name.c_str(),
        [&s, candidates, body](benchmark::State& state) {
          double total = 0;
          for (auto _ : state) {
            const auto begin = std::chrono::steady_clock::now();
            body();
            const double seconds =
                std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
            state.SetIterationTime(seconds);
            total += seconds;
          }
          const double each = total / static_cast<double>(state.iterations()) / candidates;
          state.counters["ns_per_sample"] = 1e9 * each / s.samples;
          state.counters["x_direct"] = s.direct_seconds / each;
        })
        ->Unit(benchmark::kMillisecond)
        ->UseManualTime();
  };
  add("direct_cost", 1, [&s] { benchmark::DoNotOptimize(direct::cost(s.recordings, s.nominal)); });
  const auto problem = std::make_shared<const CalibrationProblem>(s.parameters, s.recordings);
  add("structured_cost", 1, [&s, problem] { benchmark::DoNotOptimize(problem->cost(s.nominal)); });
  for (int count : {8, 32}) {
    add("batch_cost/" + std::to_string(count), count, [&s, problem, count] {
      const Matrix candidates = s.nominal.replicate(1, count);
      Vector costs(count);
      problem->batch_cost(candidates, costs);
      benchmark::DoNotOptimize(costs.data());
    });
  }
  add("normal_equations", 1, [&s, problem] {
    NormalEquations e;
    problem->normal_equations(s.nominal, e);
    benchmark::DoNotOptimize(e.cost);
  });
  const auto r = std::make_shared<Vector>(problem->residual_count());
  const auto j = std::make_shared<Matrix>(problem->residual_count(), kCalibrationParameters);
  add("residuals_and_jacobian", 1, [&s, problem, r, j] {
    problem->residuals_and_jacobian(s.nominal, *r, *j);
    benchmark::DoNotOptimize(j->data());
  });
  for (const InstructionSet k : available_instruction_sets()) {
    const auto structure = std::make_shared<const CalibrationStructure>(s.recordings, s.nominal, k);
    add(std::string("kernel/") + to_string(k) + "/cost", 1,
        [&s, structure] { benchmark::DoNotOptimize(structure->cost(s.nominal)); });
    add(std::string("kernel/") + to_string(k) + "/normal_equations", 1, [&s, structure] {
      NormalEquations e;
      structure->normal_equations(s.nominal, e);
      benchmark::DoNotOptimize(e.cost);
    });
  }
  add("set_up", 1, [&s] {
    const CalibrationProblem fresh(s.parameters, s.recordings);
    benchmark::DoNotOptimize(fresh.residual_count());
  });
}

}  // namespace
}  // namespace odobench

int main(int argc, char** argv) {
  const std::string data =
      odobench::take_data_option(argc, argv, ODOBENCH_SOURCE_DIR "/datasets/demo/set.json");
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  try {
    const odobench::Setting setting = odobench::load_setting(data);
    std::printf("%s: %zu recordings, %.0f samples, direct form %.3f ms\n", data.c_str(),
                setting.recordings.size(), setting.samples, 1e3 * setting.direct_seconds);
    odobench::register_all(setting);
    benchmark::RunSpecifiedBenchmarks();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_cost: error: %s\n", error.what());
    return 3;
  }
  return 0;
}
