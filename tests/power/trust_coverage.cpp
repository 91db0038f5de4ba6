// Whether 95 % intervals hold the truth in 95 % of the cases: simulated sets of known truth, calibrated and
// judged. Prints the table of docs/uncertainty.md; scripts/coverage_figure.py draws its figure from it.
//
// usage: trust_coverage [SETS [FIRST_SEED [KIND]]]      sets of each kind, 200, from seed 1001; KIND alone
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/parallel.hpp"
#include "base/stop.hpp"
#include "bench/catalogue/scenarios.hpp"
#include "bench/studies/planning/robot_drives.hpp"
#include "bench/studies/watcher.hpp"
#include "datasets/dataset.hpp"
#include "problems/simulation/robot_demo.hpp"
#include "problems/simulation/simulated_set.hpp"
#include "tests/support/data/coverage.hpp"
#include "tests/support/run_process.hpp"

namespace odobench {
namespace {

using testing::Held;
using testing::SetCoverage;
using Make = std::function<Dataset(std::uint64_t seed, int repetitions)>;

struct Kind {
  std::string name;
  Make make;
  CalibrationChoice choice = {};
};

Make of_scenario(const std::string& name, const std::function<void(simulate::RecordingScenario&)>& change) {
  simulate::RecordingScenario scenario = load_recording_scenario(name);
  change(scenario);
  return [scenario](std::uint64_t seed, int repetitions) {
    simulate::RecordingScenario s = scenario;
    if (repetitions > 0) s.repetitions = repetitions;
    return simulate::simulate_set(s, seed, 1).dataset;
  };
}

// The robot of one demo set, driven again and again.
Make of_robot(const std::string& kinematics, const std::string& file) {
  save_dataset(make_robot_demo(kinematics, 301), file);
  return [file](std::uint64_t seed, int repetitions) {
    Watcher nobody;
    return simulate_robot({file, "truth", {}, repetitions > 0 ? repetitions : 3, seed, 1}, nobody, Stop());
  };
}

struct Totals {
  std::map<std::string, Held> determined, same_drives;
  Held parameters, end_errors;
  double on_bounds = 0, systematic = 0, rule_said = 0;
};

void add(const SetCoverage& one, Totals& all) {
  for (const auto& [name, held] : one.determined) all.determined[name] += held;
  for (const auto& [name, held] : one.same_drives) all.same_drives[name] += held;
  all.parameters += one.parameters;
  all.end_errors += one.end_errors;
  all.on_bounds += one.on_bounds;
  all.systematic += one.systematic ? 1 : 0;
  all.rule_said += one.rule_said ? 1 : 0;
}

void say(const std::string& set, const std::string& what, const Held& held) {
  if (held.given + held.refused > 0)
    fmt::print("{},{},{:.1f},{},{}\n", set, what, held.share(), held.given, held.refused);
}

void print(const std::string& set, int sets, const Totals& all) {
  Held determined, same;
  for (const auto& [name, held] : all.determined) determined += held;
  for (const auto& [name, held] : all.same_drives) same += held;
  say(set, "determined", determined);
  for (const auto& [name, held] : all.determined) say(set, "determined." + name, held);
  say(set, "same_drives", same);
  say(set, "parameters", all.parameters);
  say(set, "end_errors", all.end_errors);
  fmt::print("{},on_bounds,{:.2f},{},\n{},systematic_percent,{:.1f},{},\n", set, all.on_bounds / sets, sets,
             set, 100 * all.systematic / sets, sets);
  fmt::print("{},rule_said_percent,{:.1f},{},\n", set, 100 * all.rule_said / sets, sets);
  std::fflush(stdout);
}

int run(int sets, std::uint64_t first, const std::string& only) {
  const testing::TemporaryFolder folder;
  const auto nothing = [](simulate::RecordingScenario&) {};
  const auto slip = [](simulate::RecordingScenario& s) {
    s.slip.fixed = 1e-3;
    s.slip.yaw_bias = 5e-5;
  };
  CalibrationChoice arc, anchored;
  arc.rule = anchored.rule = robots::IntegrationRule::Arc;
  anchored.model = std::vector<std::string>{"anchor"};
  const std::vector<Kind> kinds = {
      {"rich", of_scenario("rich", nothing)},
      {"rich_slip", of_scenario("rich", slip)},
      {"off_nominal", of_scenario("off_nominal", nothing)},
      {"off_nominal_arc", of_scenario("off_nominal", nothing), arc},
      {"off_nominal_arc_anchor", of_scenario("off_nominal", nothing), anchored},
      {"rich_arc_anchor", of_scenario("rich", nothing), anchored},
      {"differential", of_robot("differential", (folder / "differential.json").string())},
      {"mecanum", of_robot("mecanum", (folder / "mecanum.json").string())}};
  fmt::print("set,what,percent,intervals,refused\n");
  for (const Kind& kind : kinds) {
    if (!only.empty() && only != kind.name) continue;
    std::vector<SetCoverage> each(static_cast<std::size_t>(sets));
    parallel_for(
        each.size(), 0,
        [&](std::size_t i) {
          const std::uint64_t seed = first + i;
          each[i] = testing::coverage_of(kind.make(seed, 0), kind.make(seed + 1'000'000, 1), kind.choice);
        },
        Stop());
    Totals all;
    for (const SetCoverage& one : each) add(one, all);
    print(kind.name, sets, all);
  }
  return 0;
}

}  // namespace
}  // namespace odobench

int main(int argc, char** argv) {
  const int sets = argc > 1 ? std::atoi(argv[1]) : 200;
  const std::uint64_t first = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1001;
  return odobench::run(sets > 0 ? sets : 200, first, argc > 3 ? argv[3] : "");
}
