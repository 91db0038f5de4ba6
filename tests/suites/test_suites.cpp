// The suites mw and robots.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "problems/suites/more_wild.hpp"
#include "problems/suites/robot_problems.hpp"
#include "solvers/certificate/derivative_check.hpp"
#include "solvers/solve.hpp"

namespace odobench {
namespace {

// Costs at the starts, to the digits with which they are published for the authors' programs (table of
// dfo.dat with start values in the benchmark sets of optimagic, more_wild.py).
const std::map<std::string, double>& start_costs() {
  static const std::map<std::string, double> costs{{"mw:linear-full-rank", 72},
                                                   {"mw:linear-full-rank/10", 1125},
                                                   {"mw:linear-rank-1", 1.165420e7},
                                                   {"mw:linear-rank-1/10", 1.168591e9},
                                                   {"mw:linear-rank-1-zero", 4.989195e6},
                                                   {"mw:linear-rank-1-zero/10", 5.009356e8},
                                                   {"mw:rosenbrock", 24.2},
                                                   {"mw:rosenbrock/10", 1.795769e6},
                                                   {"mw:helical-valley", 2500},
                                                   {"mw:helical-valley/10", 10600},
                                                   {"mw:powell-singular", 215},
                                                   {"mw:powell-singular/10", 1.615400e6},
                                                   {"mw:freudenstein-roth", 400.5},
                                                   {"mw:freudenstein-roth/10", 1.545754e8},
                                                   {"mw:bard", 41.68170},
                                                   {"mw:bard/10", 1306.234},
                                                   {"mw:kowalik-osborne", 5.313172e-3},
                                                   {"mw:meyer", 1.693608e9},
                                                   {"mw:watson-6", 16.43083},
                                                   {"mw:watson-6/10", 2.323367e6},
                                                   {"mw:watson-9", 26.90417},
                                                   {"mw:watson-9/10", 8.158877e6},
                                                   {"mw:watson-12", 73.67821},
                                                   {"mw:watson-12/10", 2.059384e7},
                                                   {"mw:box-3d", 1031.154},
                                                   {"mw:jennrich-sampson", 4171.306},
                                                   {"mw:brown-dennis", 7.926693e6},
                                                   {"mw:brown-dennis/10", 3.081064e11},
                                                   {"mw:chebyquad-6", 4.642817e-2},
                                                   {"mw:chebyquad-7", 3.377064e-2},
                                                   {"mw:chebyquad-8", 3.861770e-2},
                                                   {"mw:chebyquad-9", 2.888298e-2},
                                                   {"mw:chebyquad-10", 3.376327e-2},
                                                   {"mw:chebyquad-11", 2.674060e-2},
                                                   {"mw:brown-almost-linear", 273.2480},
                                                   {"mw:osborne-1", 16.17411},
                                                   {"mw:osborne-2", 2.093420},
                                                   {"mw:osborne-2/10", 199.6847},
                                                   {"mw:bdqrtic-8", 904},
                                                   {"mw:bdqrtic-10", 1356},
                                                   {"mw:bdqrtic-11", 1582},
                                                   {"mw:bdqrtic-12", 1808},
                                                   {"mw:cube-5", 56.5},
                                                   {"mw:cube-6", 70.5625},
                                                   {"mw:cube-8", 98.6875},
                                                   {"mw:mancino-5", 2.539084e9},
                                                   {"mw:mancino-5/10", 6.873795e12},
                                                   {"mw:mancino-8", 3.367961e9},
                                                   {"mw:mancino-10", 3.735127e9},
                                                   {"mw:mancino-12", 3.991072e9},
                                                   {"mw:mancino-12/10", 1.130015e13},
                                                   {"mw:heart8", 9.385672},
                                                   {"mw:heart8/10", 3.365815e10}};
  return costs;
}

TEST(MoreWild, FiftyThreeProblemsThatBeginAsPublished) {
  const std::vector<ClassicEntry> entries = more_wild_entries();
  EXPECT_EQ(entries.size(), 53u);
  for (const ClassicEntry& entry : entries) {
    const Problem problem = make_more_wild_problem(entry.name);
    EXPECT_EQ(problem.dimension(), entry.dimension);
    EXPECT_EQ(problem.residual_count(), entry.residuals);
    EXPECT_EQ(problem.known_optimum(), entry.best_cost);
    EXPECT_NEAR(problem.cost(problem.start()) / start_costs().at(entry.name), 1, 5.1e-7) << entry.name;
  }
}

TEST(MoreWild, JacobiansAgreeWithDifferences) {
  for (const char* name : {"mw:bdqrtic-8", "mw:cube-5", "mw:mancino-5", "mw:heart8", "mw:heart8/10"}) {
    const Problem problem = make_more_wild_problem(name);
    const auto comparisons = compare_derivatives(problem, problem.start());
    EXPECT_GE(comparisons.size(), 5u);
    for (const DerivativeComparison& c : comparisons)
      EXPECT_TRUE(c.agrees()) << name << " " << c.kind << " " << c.parameter << " " << c.error;
  }
}

// Levenberg and Marquardt ends at the known optimum from most starts, and nowhere below it.
TEST(MoreWild, LowestKnownCosts) {
  int solved = 0;
  for (const ClassicEntry& entry : more_wild_entries()) {
    const Problem problem = make_more_wild_problem(entry.name);
    SolveOptions options;
    options.budget.max_evaluations = 2000;
    const Result result = solve(problem, {"lm", {}}, problem.start(), options);
    const double best = *problem.known_optimum();
    EXPECT_GE(result.cost, best - 1e-9 * std::abs(best)) << result.brief();
    if (reaches_known_optimum(problem, result.x, result.cost)) ++solved;
  }
  EXPECT_GE(solved, 42);
}

TEST(RobotProblems, LevenbergMarquardtFindsTheKnownOptimum) {
  std::size_t known = 0, made = 0;
  for (const ClassicEntry& entry : robot_problem_entries()) {
    if (entry.dimension > 12) continue;  // swerve and the rest take the time of all others together
    const Problem problem = make_robot_problem(entry.name, 1, InstructionSet::Baseline);
    EXPECT_EQ(problem.name(), entry.name);
    EXPECT_EQ(problem.dimension(), entry.dimension);
    ++made;
    if (!problem.known_optimum()) continue;
    ++known;
    SolveOptions options;
    options.budget.max_evaluations = 300;
    const Result result = solve(problem, {"lm", {}}, problem.start(), options);
    EXPECT_NEAR(result.cost / *problem.known_optimum(), 1, 1e-8) << result.brief();
  }
  EXPECT_GE(made, 8u);
  EXPECT_GE(known + 1, made);
}

TEST(RobotProblems, InstancesDifferAndRepeat) {
  const auto optimum = [](int instance) {
    return *make_robot_problem("robots:differential", instance, InstructionSet::Baseline).known_optimum();
  };
  EXPECT_EQ(optimum(2), optimum(2));
  EXPECT_NE(optimum(1), optimum(2));
  EXPECT_THROW(make_robot_problem("robots:differential", 0, InstructionSet::Baseline), std::invalid_argument);
  EXPECT_THROW(make_robot_problem("robots:hexapod", 1, InstructionSet::Baseline), std::invalid_argument);
}

}  // namespace
}  // namespace odobench
