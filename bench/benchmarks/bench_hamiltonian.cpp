// Speed of the relative-entropy filter's Hamiltonian core: direct form against profile form, searches, whole
// runs.
//   bench_hamiltonian [--data=windows.json] [Google Benchmark's flags]
// Without --data: synthetic runs made here, `thesis` with the constants of the thesis' program and noise of
// its variances, `balanced` with weights under which no block of t is decided beforehand. With it: the
// windows of the file. Counters: x_direct = mean time of a direct greedy window / time of this per window,
// both of this process; windows/s; evaluations = candidates looked at per window; ns_per_evaluation where
// that is what is timed.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <numbers>
#include <random>

#include "bench/benchmarks/data_option.hpp"
#include "datasets/entropy/entropy_window_file.hpp"
#include "problems/entropy/direct_form.hpp"
#include "problems/entropy/sliding_filter.hpp"
#include "problems/entropy/window_problem.hpp"
#include "solvers/lattice/ternary_search.hpp"

namespace odobench {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

// A slow, smooth drive with noise; all wheels straight ahead as in the thesis' program.
std::vector<EntropySample> synthetic_run(int rows, double encoder_sd, double acceleration_sd,
                                         double rotation_sd) {
  std::mt19937_64 engine(2015);
  std::normal_distribution<double> normal;
  std::vector<EntropySample> run;
  for (int n = 0; n < rows; ++n) {
    const double phase = 2 * std::numbers::pi * n / 200.0;
    EntropySample s;
    for (double& wheel : s.wheel) wheel = 0.06 + 0.02 * std::sin(phase) + encoder_sd * normal(engine);
    s.ax = 0.06 * std::cos(phase) + acceleration_sd * normal(engine);
    s.ay = 0.04 * std::cos(phase) + acceleration_sd * normal(engine);
    s.rotation = 0.5 * std::sin(0.7 * phase) + rotation_sd * normal(engine);
    run.push_back(s);
  }
  return run;
}

struct Setting {
  std::string name;
  std::vector<EntropyWindow> windows;
  std::vector<ProfileForm> profiles;  // one per window of a file, one for all of a run
  std::vector<EntropySample> run;
  double direct_seconds = 0;  // mean of a direct greedy window, best of three passes

  const ProfileForm& profile(std::size_t i) const { return profiles[profiles.size() == 1 ? 0 : i]; }
};

void time_direct(Setting& s) {
  s.direct_seconds = 1e9;
  for (int pass = 0; pass < 3; ++pass) {
    const auto begin = Clock::now();
    for (const EntropyWindow& window : s.windows) benchmark::DoNotOptimize(direct_search(window).iterations);
    s.direct_seconds =
        std::min(s.direct_seconds, seconds_since(begin) / static_cast<double>(s.windows.size()));
  }
}

Setting run_setting(const std::string& name, const EntropyConstants& constants,
                    std::vector<EntropySample> run) {
  Setting s;
  s.name = name;
  s.run = std::move(run);
  s.profiles.emplace_back(constants);
  for (std::size_t k = 0; k + static_cast<std::size_t>(constants.samples) <= 200; ++k) {
    const auto first = s.run.begin() + static_cast<std::ptrdiff_t>(k);
    s.windows.push_back({name + std::to_string(k), name, constants, {first, first + constants.samples}});
  }
  return s;
}

std::vector<Setting> synthetic_settings() {
  EntropyConstants balanced;
  balanced.sigma_encoder = 0.005;
  balanced.sigma_acceleration = 0.05;
  balanced.sigma_rotation = 0.2;
  balanced.step_acceleration = 0.05;
  balanced.step_rotation = 5;
  std::vector<Setting> settings;
  settings.push_back(run_setting("thesis", {}, synthetic_run(4096, std::sqrt(0.0006), 0.1, std::sqrt(0.2))));
  settings.push_back(run_setting("balanced", balanced, synthetic_run(4096, 0.005, 0.05, 0.2)));
  return settings;
}

// `body(i)` handles window i and returns how many candidates it looked at.
template <class Body>
void add(const Setting& s, const std::string& what, Body body) {
  benchmark::RegisterBenchmark((what + "/" + s.name).c_str(), [&s, body](benchmark::State& state) {
    std::size_t i = 0;
    double evaluations = 0;
    const auto begin = Clock::now();
    for (auto _ : state) {
      evaluations += static_cast<double>(body(i));
      if (++i == s.windows.size()) i = 0;
    }
    const double each = seconds_since(begin) / static_cast<double>(state.iterations());
    state.counters["windows/s"] = 1 / each;
    state.counters["evaluations"] = evaluations / static_cast<double>(state.iterations());
    state.counters["x_direct"] = s.direct_seconds / each;
  })->Unit(benchmark::kMicrosecond);
}

// From raw samples to the five continuous unknowns.
struct FastWindow {
  explicit FastWindow(const Setting& s) : setting(s), g(s.windows.size()), x(s.windows.size()) {
    for (std::size_t i = 0; i < s.windows.size(); ++i) {
      g[i].resize(static_cast<std::size_t>(increment_count(s.windows[i].constants.samples)));
      x[i].resize(g[i].size());
      modes.emplace_back(s.windows[i].samples.size());
    }
    for (std::size_t i = 0; i < s.profiles.size(); ++i) readers.emplace_back(s.profiles[i]);
  }
  WindowZero set_up(std::size_t i) {
    ModeReader& reader = readers[readers.size() == 1 ? 0 : i];
    const EntropyWindow& window = setting.windows[i];
    for (std::size_t n = 0; n < window.samples.size(); ++n) modes[i][n] = reader.read(window.samples[n]);
    return setting.profile(i).linear_term(modes[i].data(), g[i]);
  }
  std::int64_t solve(std::size_t i, BlockSearch& search) {
    const WindowZero zero = set_up(i);
    const SearchResult result = search.minimise(g[i], x[i]);
    benchmark::DoNotOptimize(setting.profile(i).closed_form(zero, x[i]));
    return result.evaluations;
  }
  const Setting& setting;
  std::vector<std::vector<double>> g, x;
  std::vector<std::vector<SampleModes>> modes;
  std::vector<ModeReader> readers;
};

using Maker = std::function<std::unique_ptr<BlockSearch>(const std::vector<QuadraticBlock>&)>;

void add_search(const Setting& s, const std::string& what, const Maker& make) {
  auto fast = std::make_shared<FastWindow>(s);
  auto searches = std::make_shared<std::vector<std::unique_ptr<BlockSearch>>>();
  for (const ProfileForm& profile : s.profiles) searches->push_back(make(profile.blocks()));
  add(s, what, [fast, searches](std::size_t i) {
    return fast->solve(i, *(*searches)[searches->size() == 1 ? 0 : i]);
  });
}

// A whole run through the sliding filter; memory does not depend on `rows`.
void add_stream(const Setting& s, const std::string& what, std::int64_t rows, const Maker& make) {
  benchmark::RegisterBenchmark((what + "/" + s.name).c_str(), [&s, rows, make](benchmark::State& state) {
    const auto search = make(s.profiles[0].blocks());
    double evaluations = 0, windows = 0;
    const auto begin = Clock::now();
    for (auto _ : state) {
      SlidingFilter filter(s.profiles[0], search.get());
      for (std::int64_t row = 0; row < rows; ++row)
        if (const FilterOutput* out = filter.push(s.run[static_cast<std::size_t>(row) % s.run.size()])) {
          evaluations += static_cast<double>(out->search.evaluations);
          benchmark::DoNotOptimize(out->state.r1);
        }
      windows += static_cast<double>(filter.windows());
    }
    const double each = seconds_since(begin) / windows;
    state.counters["windows/s"] = 1 / each;
    state.counters["evaluations"] = evaluations / windows;
    state.counters["x_direct"] = s.direct_seconds / each;
  })->Unit(benchmark::kMillisecond);
}

void register_all(const Setting& s) {
  add(s, "direct_hamiltonian", [&s](std::size_t i) {
    const EntropyWindow& window = s.windows[i];
    const Vector zero = Vector::Zero(increment_count(window.constants.samples));
    benchmark::DoNotOptimize(hamiltonian(window, zero, closed_form(window, zero)));
    return 1;
  });
  add(s, "direct_greedy_window", [&s](std::size_t i) { return direct_search(s.windows[i]).evaluations; });
  const auto fast = std::make_shared<FastWindow>(s);
  add(s, "profile_set_up", [fast](std::size_t i) {
    benchmark::DoNotOptimize(fast->set_up(i).h0);
    return 1;
  });
  using Blocks = std::vector<QuadraticBlock>;
  add_search(s, "profile_greedy_window", [](const Blocks& b) { return ternary_greedy(b); });
  add_search(s, "exact_window", [](const Blocks& b) { return ternary_exact(b); });
  add_search(s, "relaxed_window", [](const Blocks& b) { return box_relaxation(b); });
  for (const InstructionSet kernel : available_instruction_sets()) {
    const std::string name = std::string("kernel/") + to_string(kernel);
    add_search(s, name + "/greedy", [kernel](const Blocks& b) { return ternary_greedy(b, kernel); });
    add_search(s, name + "/exact", [kernel](const Blocks& b) { return ternary_exact(b, {}, kernel); });
  }
  if (s.run.empty()) return;
  add_stream(s, "run_200_rows", 200, [](const Blocks& b) { return ternary_greedy(b); });
  add_stream(s, "run_1000000_rows", 1000000, [](const Blocks& b) { return ternary_greedy(b); });
  add_stream(s, "run_1000000_rows_exact", 1000000, [](const Blocks& b) { return ternary_exact(b); });
}

std::vector<Setting> settings_of_file(const std::string& path) {
  Setting s;
  s.name = "file";
  s.windows = load_entropy_windows(path);
  for (const EntropyWindow& window : s.windows) s.profiles.emplace_back(window.constants);
  return {s};
}

}  // namespace
}  // namespace odobench

int main(int argc, char** argv) {
  const std::string data = odobench::take_data_option(argc, argv);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  try {
    std::vector<odobench::Setting> settings =
        data.empty() ? odobench::synthetic_settings() : odobench::settings_of_file(data);
    for (odobench::Setting& setting : settings) {
      odobench::time_direct(setting);
      std::printf("%s: %zu windows, direct greedy window %.1f us\n", setting.name.c_str(),
                  setting.windows.size(), 1e6 * setting.direct_seconds);
      odobench::register_all(setting);
    }
    benchmark::RunSpecifiedBenchmarks();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_hamiltonian: error: %s\n", error.what());
    return 3;
  }
  return 0;
}
