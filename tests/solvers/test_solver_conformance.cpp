// What every registered solver must do, whatever its method: a new row of the registry is tested here by
// itself.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "problems/classic/classic_problems.hpp"
#include "problems/entropy/window_problem.hpp"
#include "solvers/registry.hpp"
#include "solvers/solve.hpp"
#include "tests/support/data/entropy_windows.hpp"

namespace odobench {
namespace {

using ::testing::HasSubstr;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// r = scale (x - c) with a quartic coupling of neighbours, in any box, with switches for what goes wrong in
// practice.
struct Testbed {
  std::vector<ParameterInfo> list;
  double scale = 1;
  double nan_above = std::numeric_limits<double>::infinity();  // cost NaN where x[0] exceeds it
  std::chrono::microseconds delay{0};

  std::string name() const { return "testbed"; }
  const std::vector<ParameterInfo>& parameters() const { return list; }
  Eigen::Index residual_count() const { return 2 * static_cast<Eigen::Index>(list.size()) - 1; }
  double cost(const ConstVectorRef& x) const {
    Vector r(residual_count());
    residuals(x, r);
    return r.squaredNorm();
  }
  void residuals(const ConstVectorRef& x, VectorRef r) const {
    if (delay.count() > 0) std::this_thread::sleep_for(delay);
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const auto& p = list[static_cast<std::size_t>(i)];
      r[i] = scale * (x[i] - (p.nominal + 0.3 * (p.upper - p.nominal))) / half(i);
    }
    for (Eigen::Index i = 0; i + 1 < x.size(); ++i)
      r[x.size() + i] = scale * (unit(x, i) + unit(x, i + 1)) * unit(x, i + 1);
    if (x[0] > nan_above) r.setConstant(kNan);
  }
  void residuals_and_jacobian(const ConstVectorRef& x, VectorRef r, MatrixRef j) const {
    residuals(x, r);
    j.setZero();
    for (Eigen::Index i = 0; i < x.size(); ++i) j(i, i) = scale / half(i);
    for (Eigen::Index i = 0; i + 1 < x.size(); ++i) {
      j(x.size() + i, i) = scale * unit(x, i + 1) / half(i);
      j(x.size() + i, i + 1) = scale * (unit(x, i) + 2 * unit(x, i + 1)) / half(i + 1);
    }
    if (x[0] > nan_above) j.setConstant(kNan);
  }
  void normal_equations(const ConstVectorRef& x, NormalEquations& out) const {
    Vector r(residual_count());
    Matrix j(residual_count(), x.size());
    residuals_and_jacobian(x, r, j);
    out = {r.squaredNorm(), j.transpose() * r, j.transpose() * j};
  }
  double half(Eigen::Index i) const {
    const auto& p = list[static_cast<std::size_t>(i)];
    return p.upper > p.lower ? 0.5 * (p.upper - p.lower) : 1.0;
  }
  double unit(const ConstVectorRef& x, Eigen::Index i) const {
    return (x[i] - list[static_cast<std::size_t>(i)].nominal) / half(i);
  }
};

Testbed testbed(int n) {
  Testbed bed;
  for (int i = 0; i < n; ++i) {
    const double nominal = 0.1 + 0.037 * i;  // bounds that are no round numbers in binary
    bed.list.push_back({"p" + std::to_string(i), "m", nominal, 0.95 * nominal, 1.05 * nominal});
  }
  return bed;
}

class Conformance : public ::testing::TestWithParam<std::string> {
 protected:
  Result run(const Problem& problem, const SolveOptions& options) const {
    return solve(problem, {GetParam(), {}}, problem.start(), options);
  }
  Result run(const Problem& problem, std::int64_t evaluations) const {
    SolveOptions options;
    options.budget.max_evaluations = evaluations;
    options.seed = 42;
    return run(problem, options);
  }
};

// A solver that cannot run must say why; true when there is nothing else to test.
bool not_applicable(const Result& r) {
  if (r.termination != Termination::NotApplicable) return false;
  EXPECT_GE(r.message.size(), 10u) << r.solver;
  EXPECT_EQ(r.counts.total(), 0);
  EXPECT_FALSE(r.usable());
  return true;
}

void expect_same_bits(const Result& a, const Result& b) {
  EXPECT_EQ(a.termination, b.termination);
  EXPECT_EQ(a.message, b.message);
  EXPECT_EQ(a.counts.total(), b.counts.total());
  ASSERT_EQ(a.x.size(), b.x.size());
  EXPECT_TRUE(a.x == b.x) << a.full() << b.full();
  if (a.usable()) {
    EXPECT_EQ(a.cost, b.cost);
  }
}

void expect_sound(const Result& r, const Problem& problem) {
  ASSERT_TRUE(r.usable()) << r.brief();
  EXPECT_NE(r.termination, Termination::NotStarted);
  EXPECT_FALSE(r.message.empty());
  for (std::size_t i = 0; i < problem.parameters().size(); ++i) {
    const double x = r.x[static_cast<Eigen::Index>(i)];
    EXPECT_TRUE(x >= problem.parameters()[i].lower && x <= problem.parameters()[i].upper) << r.full();
  }
  EXPECT_EQ(r.cost, problem.cost(r.x)) << r.brief();
}

std::vector<Problem> problems() {
  return {Problem(testbed(4)),
          make_classic_problem("rosenbrock", 4),
          make_classic_problem("corner", 5),
          make_classic_problem("powell", 4),
          make_classic_problem("rastrigin", 3),
          make_classic_problem("step", 3)};
}

TEST_P(Conformance, SameSeedSameBitsInsideTheBox) {
  for (const Problem& problem : problems()) {
    SCOPED_TRACE(problem.name());
    const Result one = run(problem, 300);
    if (not_applicable(one)) continue;
    expect_same_bits(one, run(problem, 300));
    expect_sound(one, problem);
  }
}

TEST_P(Conformance, ThreadsDoNotChangeBits) {
  for (const char* name : {"rosenbrock", "rastrigin"}) {
    const Problem problem = make_classic_problem(name, 6);
    SolveOptions options;
    options.budget.max_evaluations = 1500;
    options.seed = 7;
    const Result one = run(problem, options);
    options.threads = 2;
    Result two;
    tbb::task_arena(2).execute([&] { two = run(problem, options); });
    expect_same_bits(one, two);
  }
}

TEST_P(Conformance, EvaluationBudgetIsNeverExceeded) {
  for (const Problem& problem : problems())
    for (const std::int64_t budget : {1, 7, 100}) {
      const Result r = run(problem, budget);
      if (not_applicable(r)) break;
      EXPECT_LE(r.counts.total(), budget) << problem.name();
      EXPECT_GE(r.counts.total(), 1) << problem.name();
      if (r.termination == Termination::MaxEvaluations) {
        EXPECT_EQ(r.counts.total(), budget) << problem.name();
      }
      expect_sound(r, problem);
    }
}

TEST_P(Conformance, TimeLimitEndsTheRun) {
  Testbed slow = testbed(4);
  slow.delay = std::chrono::milliseconds(1);
  SolveOptions options;
  options.budget.max_seconds = 0.04;
  const auto begin = std::chrono::steady_clock::now();
  const Result r = run(Problem(slow), options);
  if (not_applicable(r)) return;
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
  EXPECT_LE(r.counts.total(), 80);  // 40 ms at 1 ms each, and what was under way
  if (r.termination == Termination::TimeLimit) {
    EXPECT_GE(r.seconds, 0.04);
  }
}

TEST_P(Conformance, TargetEndsTheRun) {
  const Problem problem = make_classic_problem("sphere", 3);
  SolveOptions options;
  options.budget.max_evaluations = 20000;
  options.budget.target_cost = 0.5 * problem.cost(problem.start());
  const Result r = run(problem, options);
  if (not_applicable(r)) return;
  EXPECT_EQ(r.termination, Termination::TargetReached) << r.brief();
  EXPECT_LE(r.cost, options.budget.target_cost);
}

TEST_P(Conformance, InterruptionSetBeforehand) {
  const Problem problem = make_classic_problem("sphere", 3);
  const std::atomic<bool> flag{true};
  SolveOptions options;
  options.interrupt = &flag;
  const Result r = run(problem, options);
  if (not_applicable(r)) return;
  EXPECT_EQ(r.termination, Termination::Interrupted) << r.brief();
  EXPECT_EQ(r.counts.total(), 0);
  EXPECT_FALSE(r.usable());
}

TEST_P(Conformance, InterruptionByTheObserver) {
  const Problem problem = make_classic_problem("rosenbrock", 6);
  std::atomic<bool> flag{false};
  std::int64_t seen = -1;
  SolveOptions options;
  options.budget.max_evaluations = 100000;
  options.interrupt = &flag;
  options.observer = [&](const Progress& progress) {
    if (seen < 0) seen = progress.evaluations;
    flag = true;
  };
  const Result r = run(problem, options);
  if (not_applicable(r)) return;
  ASSERT_GE(seen, 0) << "no iteration was reported; " << r.brief();
  EXPECT_EQ(r.termination, Termination::Interrupted) << r.brief();
  EXPECT_LE(r.counts.total(), seen + 32) << r.brief();  // at most a chunk of a batch
}

TEST_P(Conformance, SurvivesNanInPartOfTheBox) {
  Testbed bed = testbed(3);
  bed.nan_above = bed.list[0].nominal + 0.1 * (bed.list[0].upper - bed.list[0].nominal);
  const Problem problem{bed};
  const Result r = run(problem, 2000);
  if (not_applicable(r)) return;
  expect_sound(r, problem);
  EXPECT_TRUE(std::isfinite(r.cost));
  EXPECT_LE(r.counts.total(), 2000);
  EXPECT_LE(r.cost, problem.cost(problem.start())) << r.brief();
}

TEST_P(Conformance, NanEverywhereFails) {
  Testbed bed = testbed(3);
  bed.nan_above = -1;
  const Result r = run(Problem(bed), 300);
  if (not_applicable(r)) return;
  EXPECT_EQ(r.termination, Termination::Failed) << r.brief();
  EXPECT_FALSE(r.usable());
  EXPECT_EQ(r.non_finite, r.counts.total());
  EXPECT_THAT(r.message, HasSubstr("no finite cost"));
}

TEST_P(Conformance, FixedParametersStay) {
  Testbed bed = testbed(4);
  bed.list[1].nominal = bed.list[1].upper = bed.list[1].lower;
  const Problem problem{bed};
  const Result r = run(problem, 1000);
  if (not_applicable(r)) return;
  expect_sound(r, problem);
  EXPECT_EQ(r.x[1], bed.list[1].lower);
  EXPECT_LT(r.cost, problem.cost(problem.start())) << r.brief();
}

TEST_P(Conformance, OneParameterAndNone) {
  const Problem one(testbed(1));
  const Result r = run(one, 3000);
  if (not_applicable(r)) return;
  expect_sound(r, one);
  EXPECT_LE(r.cost, 1e-3 * one.cost(one.start())) << r.brief();

  Testbed none = testbed(2);
  for (ParameterInfo& p : none.list) p.lower = p.upper = p.nominal;
  const Result fixed = run(Problem(none), 3000);
  EXPECT_EQ(fixed.termination, Termination::Converged) << fixed.brief();
  EXPECT_EQ(fixed.counts.total(), 1);
}

// A power of four scales residuals and cost exactly, so not a bit of the path may change.
TEST_P(Conformance, ScaleOfTheCostChangesNothing) {
  Testbed bed = testbed(4);
  const Result one = run(Problem(bed), 500);
  bed.scale = std::ldexp(1.0, -13);  // the cost times 1.5e-8
  const Result small = run(Problem(bed), 500);
  if (not_applicable(one)) return;
  EXPECT_TRUE(one.x == small.x) << one.full() << small.full();
  EXPECT_EQ(one.counts.total(), small.counts.total());
  EXPECT_EQ(one.cost * std::ldexp(1.0, -26), small.cost);
  EXPECT_EQ(one.termination, small.termination) << one.brief() << small.brief();
}

TEST_P(Conformance, OptionsAreDocumentedAndChecked) {
  const SolverEntry& entry = find_solver(GetParam());
  EXPECT_FALSE(entry.summary.empty());
  OptionValues in_force;
  entry.make({}, &in_force);
  const auto options = entry.options();
  ASSERT_EQ(options.size(), in_force.size());
  for (const OptionDescription& option : options) {
    EXPECT_FALSE(option.help.empty()) << option.name;
    EXPECT_EQ(in_force.at(option.name), option.value) << option.name;
    entry.make({{option.name, option.value}}, nullptr);  // a default must be an allowed value
    try {
      entry.make({{option.name, "no such value"}}, nullptr);
      ADD_FAILURE() << option.name << " took nonsense";
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), HasSubstr(GetParam()));
      EXPECT_THAT(error.what(), HasSubstr(option.name));
    }
  }
  try {
    entry.make({{"no_such_option", "1"}}, nullptr);
    ADD_FAILURE() << "an unknown option was taken";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("no_such_option"));
    for (const OptionDescription& option : options) EXPECT_THAT(error.what(), HasSubstr(option.name));
  }
}

std::vector<std::string> solver_names() {
  std::vector<std::string> names;
  for (const SolverEntry& entry : solver_registry()) names.push_back(entry.name);
  return names;
}

// A problem whose parameters have admissible levels: methods that know of them stay on them, all stay in the
// box.
TEST_P(Conformance, RunsOnALattice) {
  const Problem problem{WindowProblem(testing::random_window(5, 1))};
  for (const std::int64_t evaluations : {1, 7, 300}) {
    const Result a = run(problem, evaluations);
    if (not_applicable(a)) return;
    ASSERT_TRUE(a.usable()) << a.brief();
    EXPECT_LE(a.counts.total(), evaluations) << a.brief();
    EXPECT_LE(a.x.cwiseAbs().maxCoeff(), 1) << a.full();
    EXPECT_EQ(a.cost, problem.cost(a.x)) << a.brief();
    if (GetParam() == "coordinate" || GetParam() == "exact") {
      EXPECT_EQ(a.x, a.x.array().round().matrix()) << a.full();
    }
    expect_same_bits(a, run(problem, evaluations));
  }
}

INSTANTIATE_TEST_SUITE_P(Every, Conformance, ::testing::ValuesIn(solver_names()), [](const auto& tested) {
  std::string name = tested.param;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == ':' || c == '-'; }, '_');
  return name;
});

TEST(WhyNot, DerivativesAreAskedForByName) {
  const Problem step = make_classic_problem("step", 3), rastrigin = make_classic_problem("rastrigin", 3);
  for (const char* name : {"lm", "ceres", "ip", "nlopt:slsqp", "nlopt:lbfgs", "nlopt:mlsl", "nlopt:stogo"}) {
    const Result r = solve(step, {name, {}}, step.start(), {});
    EXPECT_EQ(r.termination, Termination::NotApplicable) << r.brief();
    EXPECT_THAT(r.message, HasSubstr("needs")) << name;
  }
  EXPECT_THAT(solve(rastrigin, {"ip", {}}, rastrigin.start(), {}).message, HasSubstr("hessian=lbfgs"));
  EXPECT_EQ(solve(rastrigin, {"ip", {{"hessian", "lbfgs"}}}, rastrigin.start(), {}).termination,
            Termination::Converged);
  EXPECT_NE(solve(rastrigin, {"nlopt:slsqp", {}}, rastrigin.start(), {}).termination,
            Termination::NotApplicable);
  const Problem wide = make_classic_problem("rastrigin", 11);
  EXPECT_THAT(solve(wide, {"nlopt:ags", {}}, wide.start(), {}).message, HasSubstr("at most 10"));
}

}  // namespace
}  // namespace odobench
