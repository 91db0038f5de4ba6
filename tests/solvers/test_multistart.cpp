#include "solvers/local/multistart.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "problems/classic/classic_problems.hpp"
#include "solvers/solve.hpp"

namespace odobench {
namespace {

using ::testing::HasSubstr;

// J = (x^2 - 1)^2 + (0.1 (x - 1))^2: minima at 1 (J = 0) and near -1 (J near 0.04), a ridge near 0 between
// their basins.
struct TwoValleys {
  std::vector<ParameterInfo> list{{"x", "1", -1.2, -2, 2}};
  std::string name() const { return "two-valleys"; }
  const std::vector<ParameterInfo>& parameters() const { return list; }
  Eigen::Index residual_count() const { return 2; }
  double cost(const ConstVectorRef& x) const {
    Vector r(2);
    residuals(x, r);
    return r.squaredNorm();
  }
  void residuals(const ConstVectorRef& x, VectorRef r) const { r << x[0] * x[0] - 1, 0.1 * (x[0] - 1); }
  void residuals_and_jacobian(const ConstVectorRef& x, VectorRef r, MatrixRef j) const {
    residuals(x, r);
    j << 2 * x[0], 0.1;
  }
};

Result run_on(const Problem& problem, const std::string& spec, std::uint64_t seed = 1,
              std::int64_t evaluations = 20000) {
  SolveOptions options;
  options.seed = seed;
  options.budget.max_evaluations = evaluations;
  return solve(problem, parse_solver_list(spec).front(), problem.start(), options);
}

std::string refusal(const std::string& spec) {
  try {
    run_on(Problem{TwoValleys{}}, spec);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Multistart, FindsBothValleysAndTheShareOfTheirBasins) {
  for (const char* sampling : {"sobol", "lhs"}) {
    const Result r = run_on(Problem{TwoValleys{}},
                            std::string("multistart[starts=101,effort=0,sampling=") + sampling + "]");
    EXPECT_EQ(r.termination, Termination::Converged) << r.brief();
    ASSERT_EQ(r.optima.size(), 2u) << r.brief();
    EXPECT_NEAR(r.optima[0].x[0], 1.0, 1e-6);
    EXPECT_NEAR(r.optima[1].x[0], -0.995, 1e-3);
    EXPECT_NEAR(r.optima[1].cost, 0.0398, 1e-3);
    EXPECT_EQ(r.cost, r.optima[0].cost);
    EXPECT_EQ(r.optima[0].runs + r.optima[1].runs, 101);
    // Nearly halves: the ridge is near 0, but a first step from beside it may leap over.
    EXPECT_GE(r.optima[0].runs, 40);
    EXPECT_LE(r.optima[0].runs, 61);
    EXPECT_THAT(r.message, HasSubstr("2 optima from 101 of 101 starts"));
  }
}

// The driver's start lies in the valley of the higher optimum.
TEST(Multistart, LeavesTheFirstOptimumForALowerOne) {
  EXPECT_GT(run_on(Problem{TwoValleys{}}, "lm").cost, 0.03);
  EXPECT_LT(run_on(Problem{TwoValleys{}}, "multistart").cost, 1e-15);
}

TEST(Multistart, CostsAtMostThreeTimesWhatOneStartTakesWhereThatSuffices) {
  int problems = 0;
  for (const ClassicEntry& entry : classic_catalogue()) {
    if (entry.family != "nist") continue;
    ++problems;
    const Problem problem = make_classic_problem(entry.name);
    const Result one = run_on(problem, "lm"), many = run_on(problem, "multistart[solver=lm]");
    EXPECT_GE(log_relative_error(many.x, problem.known_minimisers()), 6.0)
        << entry.name << ' ' << many.brief();
    EXPECT_EQ(many.termination, Termination::Converged) << entry.name << ' ' << many.brief();
    EXPECT_LE(many.counts.total(), 3 * one.counts.total()) << entry.name;
    EXPECT_LE(many.cost, one.cost) << entry.name;
  }
  EXPECT_EQ(problems, 54);
}

TEST(Multistart, CountsTraceAndBudgetAreThoseOfAllSearchesTogether) {
  const Problem problem = make_classic_problem("rosenbrock", 4);
  const Result all = run_on(problem, "multistart[starts=8,effort=0]", 3);
  EXPECT_THAT(all.message, HasSubstr("of 8 starts"));
  for (std::size_t k = 1; k < all.trace.size(); ++k) {
    EXPECT_LT(all.trace[k].cost, all.trace[k - 1].cost);
    EXPECT_GT(all.trace[k].evaluations, all.trace[k - 1].evaluations);
  }
  EXPECT_EQ(all.trace.back().cost, all.cost);
  const std::int64_t enough = all.counts.total();
  ASSERT_GT(enough, 40);
  const Result cut = run_on(problem, "multistart[starts=8,effort=0]", 3, enough - 7);
  EXPECT_EQ(cut.counts.total(), enough - 7);
  EXPECT_EQ(cut.termination, Termination::MaxEvaluations);
  EXPECT_FALSE(cut.optima.empty());
  EXPECT_EQ(run_on(problem, "multistart[starts=8,effort=0]", 3).cost, all.cost);
}

TEST(Multistart, TheInnerMethodMayHaveOptionsOfItsOwn) {
  const SolverSpec spec =
      parse_solver_list("lm,multistart[solver=lm[patience=100,iterations=50],starts=3],pso")[1];
  EXPECT_EQ(spec.options.at("solver"), "lm[patience=100,iterations=50]");
  EXPECT_EQ(spec.options.at("starts"), "3");
  EXPECT_EQ(parse_solver_list(spec.text()).front().text(), spec.text());
  EXPECT_LT(run_on(Problem{TwoValleys{}}, spec.text()).cost, 0.05);
  EXPECT_LT(run_on(Problem{TwoValleys{}}, "multistart[solver=nlopt:slsqp]").cost, 1e-12);
}

TEST(Multistart, RefusesWhatItCannotRun) {
  EXPECT_THAT(refusal("multistart[solver=multistart]"), HasSubstr("expected a local method"));
  EXPECT_THAT(refusal("multistart[solver=lmm]"), HasSubstr("did you mean 'lm'?"));
  EXPECT_THAT(refusal("multistart[solver=lm[patience=x]]"), HasSubstr("patience=x; expected a whole number"));
  EXPECT_THAT(refusal("multistart[starts=0]"), HasSubstr("starts=0; expected 1..100000"));
  EXPECT_THAT(refusal("multistart[solver=lm[starts=3]"), HasSubstr("unbalanced brackets"));
  EXPECT_THAT(refusal("lm[a=1]]"), HasSubstr("unbalanced brackets"));
  EXPECT_THAT(refusal("lm[a=1][b=2]"), HasSubstr("text after ']'"));
}

// Every one of n equal slices of every axis holds one point of a Latin hypercube.
TEST(Multistart, LatinHypercubesHaveOnePointInEverySlice) {
  Random random(7);
  const Matrix points = latin_hypercube(5, 33, random);
  for (Eigen::Index i = 0; i < 5; ++i) {
    std::set<int> slices;
    for (Eigen::Index k = 0; k < 33; ++k) slices.insert(static_cast<int>((points(i, k) + 1) / 2 * 33));
    EXPECT_EQ(slices.size(), 33u);
    EXPECT_EQ(*slices.begin(), 0);
    EXPECT_EQ(*slices.rbegin(), 32);
  }
}

// Sorted along any axis, n = 2^k shifted Sobol points leave no gap of two slices or more; random ones do.
TEST(Multistart, SobolPointsLeaveNoGaps) {
  Random random(7);
  const Matrix points = sobol_starts(12, 64, random);
  EXPECT_LE(points.cwiseAbs().maxCoeff(), 1.0);
  for (Eigen::Index i = 0; i < 12; ++i) {
    std::vector<double> axis;
    for (Eigen::Index k = 0; k < 64; ++k) axis.push_back((points(i, k) + 1) / 2);
    std::sort(axis.begin(), axis.end());
    for (std::size_t k = 1; k < axis.size(); ++k) EXPECT_LT(axis[k] - axis[k - 1], 3.0 / 64) << i;
  }
}

}  // namespace
}  // namespace odobench
