// What verbs share, called as functions: numbers as typed, problems by pattern, cells and their seeds,
// statistics of a run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/random.hpp"
#include "bench/catalogue/catalogue.hpp"
#include "bench/catalogue/number_text.hpp"
#include "bench/catalogue/option_values.hpp"
#include "bench/studies/cells.hpp"
#include "bench/studies/entropy/entropy_statistics.hpp"
#include "bench/studies/fusion/fusion_runs.hpp"
#include "bench/studies/parameter_sets.hpp"
#include "tests/support/run_process.hpp"

namespace odobench::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string refusal(const std::function<void()>& call) {
  try {
    call();
  } catch (const std::exception& e) {
    return e.what();
  }
  return "";
}

// What comes with the program.
const Catalogue& known() {
  static Catalogue catalogue;
  if (catalogue.problems().empty()) add_known(catalogue);
  return catalogue;
}

TEST(NumberText, WholeNumbersInAnyNotation) {
  EXPECT_EQ(whole_number("--n", "12", 1), 12);
  EXPECT_EQ(whole_number("--n", "1e5", 1), 100000);
  EXPECT_EQ(whole_number("--n", "-3.0", -5), -3);
  EXPECT_EQ(whole_number("--n", "9007199254740992.0", 1), 9007199254740992);  // 2^53
  EXPECT_EQ(whole_number("--n", "9223372036854775807", 1), std::numeric_limits<std::int64_t>::max());
  for (const char* bad : {"", " 1", "1 ", "1.5", "0x10", "1e400", "9007199254740993.0e3", "nan", "0"})
    EXPECT_THAT(refusal([&] { whole_number("--n", bad, 1); }), HasSubstr("expected a whole number >= 1"))
        << bad;
  EXPECT_EQ(refusal([] { whole_number("--n", "7", 1, 6); }), "--n=7: expected a whole number in 1..6");
}

TEST(NumberText, SeedsAndFiniteNumbers) {
  EXPECT_EQ(seed_number("--seed", "18446744073709551615"), std::numeric_limits<std::uint64_t>::max());
  EXPECT_THAT(refusal([] { seed_number("--seed", "18446744073709551616"); }), HasSubstr("in 0..184467"));
  EXPECT_THAT(refusal([] { seed_number("--seed", "-1"); }), HasSubstr("expected a whole number"));
  EXPECT_EQ(finite_number("--x", "-2.5", false), -2.5);
  EXPECT_EQ(finite_number("--x", "7", true, 7), 7);
  EXPECT_EQ(refusal([] { finite_number("--x", "0", true); }), "--x=0: expected a finite number > 0");
  EXPECT_EQ(refusal([] { finite_number("--x", "7.1", true, 7); }), "--x=7.1: expected at most 7");
  EXPECT_EQ(refusal([] { finite_number("--x", "-8", false, 7); }), "--x=-8: expected at most 7 in size");
}

TEST(OptionValues, CommaListsKeepEmptyItems) {
  EXPECT_THAT(comma_items(std::string("a,b,")), ElementsAre("a", "b", ""));
  EXPECT_THAT(comma_items(std::vector<std::string>{"a", "b,c"}), ElementsAre("a", "b", "c"));
}

TEST(Catalogue, ProblemsByPattern) {
  std::vector<std::string> notes;
  const std::vector<std::string> all = resolve_problems(known(), {"nist:*"}, 0, notes);
  EXPECT_GT(all.size(), 20u);
  EXPECT_EQ(std::set<std::string>(all.begin(), all.end()).size(), all.size());
  EXPECT_THAT(resolve_problems(known(), {"rosenbrock,sphere", "rosenbrock"}, 0, notes),
              ElementsAre("rosenbrock", "sphere"));
  EXPECT_THAT(refusal([&] { resolve_problems(known(), {"rosenbrok"}, 0, notes); }),
              HasSubstr("did you mean 'rosenbrock'?"));
  EXPECT_NE(refusal([&] { resolve_problems(known(), {"sphere,"}, 0, notes); }), "");
  EXPECT_NE(refusal([&] { resolve_problems(known(), {"nowhere:*"}, 0, notes); }), "");
}

TEST(Catalogue, ImportersByName) {
  Catalogue catalogue;
  add_known(catalogue);
  EXPECT_THAT(refusal([&] { catalogue.importer("optiodon"); }),
              HasSubstr("did you mean 'optiodom'?: known sources: csv, vitko2024, optiodom"));
  ImporterEntry mine;
  mine.name = "mine";
  mine.read = [](const ImportRequest& request) {
    Dataset set;
    set.name = request.from;
    return set;
  };
  catalogue.add(mine);
  ImportRequest request;
  request.from = "folder";
  EXPECT_EQ(catalogue.importer("mine").read(request).name, "folder");
  EXPECT_THAT(refusal([&] { catalogue.importer("x"); }),
              HasSubstr("known sources: csv, vitko2024, optiodom, mine"));
  EXPECT_THROW(catalogue.add(mine), std::logic_error);
}

TEST(Catalogue, ABoxIsNamesUnitsAndBounds) {
  std::vector<ParameterInfo> box{{"a", "m", 1, 0, 2}, {"b", "rad", 0, -1, 1}};
  const std::string sum = box_check_sum(box);
  EXPECT_EQ(sum.size(), 16u);
  box[0].nominal = 1.5;  // no part of what a solver may choose from
  EXPECT_EQ(box_check_sum(box), sum);
  box[1].upper = 1 + 1e-15;
  EXPECT_NE(box_check_sum(box), sum);
}

TEST(ParameterSets, AreNominalKnownOrFiles) {
  const TemporaryFolder folder;
  ParameterNames names{{{"a", "m", 1, 0, 2}, {"b", "m", 3, 0, 6}}, {{"truth", "", {1.5, 2.5}}}};
  EXPECT_EQ(read_parameters(names, "nominal").at(0).values, Eigen::Vector2d(1, 3));
  EXPECT_EQ(read_parameters(names, "truth").at(0).values, Eigen::Vector2d(1.5, 2.5));
  const std::string file = folder.file("mine.json", R"([{"a": 1, "b": 2}, {"name": "x", "a": 3, "b": 4}])");
  const std::vector<ParameterSet> sets = read_parameters(names, file);
  ASSERT_EQ(sets.size(), 2u);
  EXPECT_EQ(sets[0].label, "mine 1");
  EXPECT_EQ(sets[1].label, "x");
  EXPECT_EQ(sets[1].values, Eigen::Vector2d(3, 4));
  EXPECT_THAT(refusal([&] { read_parameters(names, "thruth"); }), HasSubstr("did you mean 'truth'?"));
  EXPECT_THAT(refusal([&] { read_parameters(names, folder.file("m.json", R"({"a": 1})")); }),
              HasSubstr("m.json: 'b' is missing"));
  EXPECT_THAT(refusal([&] { read_parameters(names, folder.file("w.json", R"({"a": 1, "b": 1e51})")); }),
              HasSubstr("w.json: 'b' is 1e+51, expected a number of at most 1e+50 in size"));
  std::vector<ParameterSet> list = sets;
  EXPECT_THAT(refusal([&] { add_parameter_set(sets[1], list); }), HasSubstr("two sets are called 'x'"));
}

TEST(Cells, HaveSeedsOfTheirOwnAndSharedStarts) {
  std::vector<std::string> notes;
  CellPlan plan;
  plan.solvers = resolve_solvers(known(), {"lm,ga,lm"}, notes);
  EXPECT_EQ(plan.solvers.size(), 2u);  // one of them twice, with a note
  EXPECT_EQ(notes.size(), 1u);
  plan.repeat = 3;
  plan.random_start = true;
  plan.problem = "p";
  plan.dataset = "d";
  CellList cells(known());
  cells.add(plan, 0, notes);
  ASSERT_EQ(cells.size(), 6u);
  std::set<std::uint64_t> seeds;
  for (std::size_t i = 0; i < cells.size(); ++i) seeds.insert(cells[i].seed);
  EXPECT_EQ(seeds.size(), 6u);
  EXPECT_EQ(cells[4].seed, derive_seed(1, {"p", "d", "ga", "2"}));
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(cells[k].start_seed, cells[3 + k].start_seed);
  plan.random_start = false;
  CellList nominal(known());
  nominal.add(plan, 0, notes);
  EXPECT_EQ(nominal.size(), 4u);  // lm repeats itself: one cell
  plan.repeat = 300'000;
  EXPECT_THAT(refusal([&] { CellList(known()).add(plan, 0, notes); }), HasSubstr("200"));
}

class Counting : public CellWatcher {
 public:
  void started(std::size_t) override { ++begun; }
  void progressed(std::size_t, const Progress&) override {}
  void finished(std::size_t cell, const Result& result, const std::string&) override {
    const std::lock_guard lock(mutex_);
    costs[cell] = result.cost;
    if (costs.size() == throw_after) throw std::runtime_error("the disc is full");
  }
  std::atomic<int> begun{0};
  std::map<std::size_t, double> costs;
  std::size_t throw_after = 0;

 private:
  std::mutex mutex_;
};

TEST(Cells, GiveTheSameForAnyThreadsAndEndWithTheWatcher) {
  std::vector<std::string> notes;
  const std::vector<Problem> problems{known().problem("rosenbrock").make({}).problem};
  CellPlan plan;
  plan.solvers = resolve_solvers(known(), {"pso[swarm=8],cmaes,lm"}, notes);
  plan.repeat = 4;
  plan.problem = "rosenbrock";
  CellList cells(known());
  cells.add(plan, 0, notes);
  Budget budget;
  budget.max_evaluations = 200;
  Counting one, two;
  run_cells(problems, cells, budget, 1, Stop(), one);
  run_cells(problems, cells, budget, 2, Stop(), two);
  EXPECT_EQ(one.costs.size(), cells.size());
  EXPECT_EQ(one.costs, two.costs);
  Counting full;
  full.throw_after = 3;
  EXPECT_EQ(refusal([&] { run_cells(problems, cells, budget, 1, Stop(), full); }), "the disc is full");
  EXPECT_EQ(full.begun, 3);
  const std::atomic<bool> stop{true};
  Counting none;
  run_cells(problems, cells, budget, 2, Stop(stop), none);
  EXPECT_TRUE(none.costs.empty());
}

TEST(FusionRuns, FiltersByName) {
  EXPECT_EQ(parse_filters({}).size(), 3u);
  const std::vector<FilterChoice> filters = parse_filters({"none,ekf-smoothed", "ukf"});
  ASSERT_EQ(filters.size(), 3u);
  EXPECT_FALSE(filters[0].filtered);
  EXPECT_TRUE(filters[1].smooth);
  EXPECT_EQ(filters[2].kind, FilterKind::Unscented);
  EXPECT_THAT(refusal([] { parse_filters({"efk"}); }), HasSubstr("did you mean 'ekf'?"));
  EXPECT_THAT(refusal([] { parse_filters({"ekf,ekf"}); }), HasSubstr("'ekf' is given twice"));
}

TEST(EntropyStatistics, AveragesDoNotLoseSmallNumbers) {
  Average average;
  average.add(1e16);
  for (int i = 0; i < 1000; ++i) average.add(1);
  average.add(-1e16);
  EXPECT_EQ(average.count(), 1002);
  EXPECT_DOUBLE_EQ(average.mean(), 1000.0 / 1002);
  EXPECT_EQ(average.max(), 1e16);
  EXPECT_EQ(average.min(), -1e16);
}

TEST(EntropyStatistics, TheLastOfARun) {
  LastOf<int> last(3);
  for (int i = 1; i <= 5; ++i) last.push(i);
  EXPECT_EQ(last[0], 3);
  EXPECT_EQ(last[2], 5);
}

}  // namespace
}  // namespace odobench::testing
