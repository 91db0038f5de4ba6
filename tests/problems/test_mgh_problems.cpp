// The test problems of More, Garbow and Hillstrom, and the catalogue of all problems without data.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <set>

#include "problems/classic/more_garbow_hillstrom.hpp"
#include "solvers/solve.hpp"
#include "tests/support/data/mgh_reference.hpp"
#include "tests/support/jacobian_check.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench {
namespace {

struct Named {
  std::string name;
  bool fixed;
  std::vector<int> dimensions;
};

const std::vector<Named>& functions() {
  static const std::vector<Named> list{{"rosenbrock", true, {2}},
                                       {"freudenstein-roth", true, {2}},
                                       {"powell-badly-scaled", true, {2}},
                                       {"brown-badly-scaled", true, {2}},
                                       {"beale", true, {2}},
                                       {"jennrich-sampson", true, {2}},
                                       {"helical-valley", true, {3}},
                                       {"bard", true, {3}},
                                       {"gaussian", true, {3}},
                                       {"meyer", true, {3}},
                                       {"gulf", true, {3}},
                                       {"box-3d", true, {3}},
                                       {"powell-singular", true, {4}},
                                       {"wood", true, {4}},
                                       {"kowalik-osborne", true, {4}},
                                       {"brown-dennis", true, {4}},
                                       {"osborne-1", true, {5}},
                                       {"biggs-exp6", true, {6}},
                                       {"osborne-2", true, {11}},
                                       {"watson", false, {2, 6, 9, 12, 31}},
                                       {"extended-rosenbrock", false, {2, 10}},
                                       {"extended-powell-singular", false, {4, 12}},
                                       {"penalty-1", false, {2, 4, 10}},
                                       {"penalty-2", false, {2, 4, 10}},
                                       {"variably-dimensioned", false, {2, 10}},
                                       {"trigonometric", false, {2, 10}},
                                       {"brown-almost-linear", false, {2, 10, 30}},
                                       {"discrete-boundary-value", false, {2, 10}},
                                       {"discrete-integral-equation", false, {2, 10}},
                                       {"broyden-tridiagonal", false, {2, 10}},
                                       {"broyden-banded", false, {2, 10}},
                                       {"linear-full-rank", false, {2, 10}},
                                       {"linear-rank-1", false, {2, 10}},
                                       {"linear-rank-1-zero", false, {3, 10}},
                                       {"chebyquad", false, {2, 8, 9, 10}}};
  return list;
}

testing::LongResiduals reference(const Named& function, const Problem& problem) {
  const int m = static_cast<int>(problem.residual_count());
  return [&function, m](const std::vector<long double>& x) {
    return function.fixed ? testing::mgh_fixed_reference(function.name, x, m)
                          : testing::mgh_variable_reference(function.name, x, m);
  };
}

TEST(MghProblems, ResidualsAndJacobianFollowThePaper) {
  for (const Named& function : functions())
    for (const int n : function.dimensions)
      for (const char* factor : {"", "/10"}) {
        const Problem problem = make_classic_problem("mgh:" + function.name + factor, n);
        std::vector<Vector> points = testing::points_to_check(problem, 1);
        if (problem.known_minimisers().empty())
          points.push_back(solve(problem, {"lm", {}}, problem.start(), {}).x);
        for (const Vector& x : points) {
          const auto errors = testing::compare_jacobian(problem, x, reference(function, problem), 1);
          EXPECT_LE(errors.residual, function.name == "meyer" ? 1e-11 : 1e-13)
              << problem.name() << " at " << x.transpose();
          EXPECT_LE(errors.jacobian, 2e-11) << problem.name() << " at " << x.transpose();
        }
      }
}

struct Tilted {  // its Jacobian is wrong in the tenth digit, its residuals in the twelfth
  std::vector<ParameterInfo> list{{"x1", "1", 1, -2, 2}, {"x2", "1", 1, -2, 2}};
  std::string name() const { return "tilted"; }
  const std::vector<ParameterInfo>& parameters() const { return list; }
  double cost(const ConstVectorRef& x) const {
    Vector r(2);
    residuals(x, r);
    return r.squaredNorm();
  }
  Eigen::Index residual_count() const { return 2; }
  void residuals(const ConstVectorRef& x, VectorRef r) const {
    r << 10 * (x[1] - x[0] * x[0]) + 1e-12, 1 - x[0];
  }
  void residuals_and_jacobian(const ConstVectorRef& x, VectorRef r, MatrixRef j) const {
    residuals(x, r);
    j << -20 * x[0] * (1 + 1e-10), 10, -1, 0;
  }
};

TEST(MghProblems, TheComparisonItselfSeesSmallErrors) {
  const Problem problem{Tilted{}};
  const auto errors =
      testing::compare_jacobian(problem, Eigen::Vector2d(0.7, 0.9), reference(functions()[0], problem), 1);
  EXPECT_NEAR(errors.residual, 1e-12 / 4.1, 1e-15);  // the largest residual is 4.1
  EXPECT_NEAR(errors.jacobian, 1e-10, 1e-12);
}

// Norms of the residuals at the starts as the authors' own test program for MINPACK prints them, with eight
// digits.
TEST(MghProblems, StartsHaveTheNormsOfMinpacksTests) {
  const struct {
    const char* name;
    int n;
    double norm;
  } known[] = {{"rosenbrock", 2, 4.9193496e+00},
               {"rosenbrock/10", 2, 1.3400631e+03},
               {"rosenbrock/100", 2, 1.4300005e+05},
               {"helical-valley", 3, 5.0000000e+01},
               {"helical-valley/10", 3, 1.0295630e+02},
               {"helical-valley/100", 3, 9.9126182e+02},
               {"powell-singular", 4, 1.4662878e+01},
               {"powell-singular/10", 4, 1.2709839e+03},
               {"powell-singular/100", 4, 1.2688790e+05},
               {"freudenstein-roth", 2, 2.0012496e+01},
               {"freudenstein-roth/10", 2, 1.2432834e+04},
               {"freudenstein-roth/100", 2, 1.1426455e+07},
               {"bard", 3, 6.4561363e+00},
               {"bard/10", 3, 3.6141853e+01},
               {"bard/100", 3, 3.8411468e+02},
               {"kowalik-osborne", 4, 7.2891510e-02},
               {"kowalik-osborne/10", 4, 2.9793701e+00},
               {"kowalik-osborne/100", 4, 2.9959062e+01},
               {"meyer", 3, 4.1153467e+04},
               {"meyer/10", 3, 4.1682169e+06},
               {"watson", 6, 5.4772256e+00},
               {"watson/10", 6, 6.4331258e+03},
               {"watson/100", 6, 6.7425604e+05},
               {"watson/10", 9, 1.2088127e+04},
               {"watson/100", 9, 1.2691093e+06},
               {"watson/10", 12, 1.9220759e+04},
               {"watson/100", 12, 2.0189180e+06},
               {"box-3d", 3, 3.2111584e+01},
               {"jennrich-sampson", 2, 6.4585650e+01},
               {"brown-dennis", 4, 2.8154384e+03},
               {"brown-dennis/10", 4, 5.5507335e+05},
               {"brown-dennis/100", 4, 6.1211252e+07},
               {"chebyquad", 8, 1.9651386e-01},
               {"chebyquad", 9, 1.6994993e-01},
               {"chebyquad", 10, 1.8374783e-01},
               {"brown-almost-linear", 10, 1.6530216e+01},
               {"brown-almost-linear/10", 10, 9.7656240e+06},
               {"brown-almost-linear/100", 10, 9.7656250e+16},
               {"brown-almost-linear", 30, 8.3476044e+01},
               {"brown-almost-linear", 40, 1.2802636e+02},
               {"linear-full-rank", 5, 5.0000000e+00},
               {"linear-rank-1", 5, 2.9152187e+02},
               {"linear-rank-1-zero", 5, 1.2603968e+02},
               {"osborne-1", 5, 9.3756402e-01},
               {"osborne-2", 11, 1.4468654e+00}};
  for (const auto& k : known) {
    const Problem problem = make_classic_problem(std::string("mgh:") + k.name, k.n);
    EXPECT_NEAR(std::sqrt(problem.cost(problem.start())) / k.norm, 1, 1e-7) << k.name << " " << k.n;
  }
}

// By hand, from the formulas of the paper.
TEST(MghProblems, StartsHaveTheirCosts) {
  const auto cost = [](const char* name) {
    const Problem problem = make_classic_problem(std::string("mgh:") + name);
    return problem.cost(problem.start());
  };
  EXPECT_NEAR(cost("rosenbrock"), 24.2, 1e-13);
  EXPECT_DOUBLE_EQ(cost("freudenstein-roth"), 400.5);
  EXPECT_DOUBLE_EQ(cost("powell-badly-scaled"), 1 + std::pow(1 + std::exp(-1.0) - 1.0001, 2));
  EXPECT_DOUBLE_EQ(cost("brown-badly-scaled"), 999999.0 * 999999.0 + std::pow(1 - 2e-6, 2) + 1);
  EXPECT_DOUBLE_EQ(cost("beale"), 14.203125);
  EXPECT_NEAR(cost("helical-valley"), 2500, 1e-11);
  EXPECT_NEAR(cost("powell-singular"), 215, 1e-12);
  EXPECT_NEAR(cost("wood"), 19192, 1e-10);
  EXPECT_NEAR(cost("extended-rosenbrock"), 5 * 24.2, 1e-12);
  EXPECT_NEAR(cost("extended-powell-singular"), 3 * 215, 1e-12);
  EXPECT_NEAR(cost("penalty-1"), 285e-5 + 384.75 * 384.75, 1e-9);
  EXPECT_NEAR(cost("variably-dimensioned"), 3.85 + 38.5 * 38.5 + std::pow(38.5, 4), 1e-8);
  EXPECT_DOUBLE_EQ(cost("broyden-tridiagonal"), 9 + 8 + 4);  // r = (-2, -1, ..., -1, -3)
  EXPECT_DOUBLE_EQ(cost("broyden-banded"), 360);             // r = -6: x (1 + x) vanishes at -1
}

// The minima that the paper prints, to their six digits; for chebyquad with n = 10 a lower one is known.
TEST(MghProblems, BestCostsAreThePublishedOnes) {
  const struct {
    const char* name;
    int n;
    double cost;
  } published[] = {{"jennrich-sampson", 2, 124.362},
                   {"bard", 3, 8.21487e-3},
                   {"gaussian", 3, 1.12793e-8},
                   {"meyer", 3, 87.9458},
                   {"kowalik-osborne", 4, 3.07505e-4},
                   {"brown-dennis", 4, 85822.2},
                   {"osborne-1", 5, 5.46489e-5},
                   {"osborne-2", 11, 4.01377e-2},
                   {"watson", 6, 2.28767e-3},
                   {"watson", 9, 1.39976e-6},
                   {"watson", 12, 4.72238e-10},
                   {"penalty-1", 4, 2.24997e-5},
                   {"penalty-1", 10, 7.08765e-5},
                   {"penalty-2", 4, 9.37629e-6},
                   {"penalty-2", 10, 2.93660e-4},
                   {"chebyquad", 8, 3.51687e-3},
                   {"linear-full-rank", 10, 10},
                   {"linear-rank-1", 10, 20 * 19 / 82.0},
                   {"linear-rank-1-zero", 10, (400 + 60 - 6) / 74.0}};
  for (const auto& p : published) {
    const Problem problem = make_classic_problem(std::string("mgh:") + p.name, p.n);
    EXPECT_NEAR(*problem.known_optimum() / p.cost, 1, 5e-6) << p.name << " " << p.n;
  }
  const Problem chebyquad = make_classic_problem("mgh:chebyquad", 10);
  EXPECT_LT(*chebyquad.known_optimum(), 6.50395e-3);
}

// There the cost is the stated one and no parameter has a slope: |J_k'r| <= 1e-8 |J_k| |r|.
TEST(MghProblems, KnownMinimisersAreMinimisers) {
  for (const Named& function : functions())
    for (const int n : function.dimensions)
      for (const char* factor : {"", "/10", "/100"}) {
        const Problem problem = make_classic_problem("mgh:" + function.name + factor, n);
        for (const Vector& x : problem.known_minimisers()) {
          SCOPED_TRACE(::testing::Message() << problem.name() << " at " << x.transpose());
          ASSERT_TRUE(problem.known_optimum());
          for (std::size_t i = 0; i < problem.parameters().size(); ++i)
            EXPECT_LE(std::abs(x[static_cast<Eigen::Index>(i)]), problem.parameters()[i].upper / 9.9);
          const double best = *problem.known_optimum(), cost = problem.cost(x);
          if (best == 0) {
            EXPECT_LE(cost, 1e-24);
            continue;
          }
          EXPECT_NEAR(cost / best, 1, 1e-9);
          Vector r(problem.residual_count());
          Matrix j(problem.residual_count(), problem.dimension());
          problem.residuals_and_jacobian(x, r, j);
          for (Eigen::Index k = 0; k < j.cols(); ++k)
            EXPECT_LE(std::abs(j.col(k).dot(r)), 1e-8 * j.col(k).norm() * r.norm()) << "parameter " << k + 1;
        }
      }
}

TEST(MghProblems, BoxHoldsStartsAndMinimisersByOneRule) {
  for (const ClassicEntry& entry : mgh_entries()) {
    const Problem problem = make_classic_problem(entry.name);
    for (std::size_t i = 0; i < problem.parameters().size(); ++i) {
      const ParameterInfo& p = problem.parameters()[i];
      double most = std::max(1.0, std::abs(p.nominal));
      for (const Vector& x : problem.known_minimisers())
        most = std::max(most, std::abs(x[static_cast<Eigen::Index>(i)]));
      EXPECT_EQ(p.upper, 10 * most) << entry.name;
      EXPECT_EQ(p.lower, -10 * most) << entry.name;
    }
  }
}

TEST(MghProblems, FactorsMultiplyTheStart) {
  for (const Named& function : functions()) {
    const Vector start = make_classic_problem("mgh:" + function.name).start();
    for (const int factor : {10, 100}) {
      const Vector far = make_classic_problem("mgh:" + function.name + "/" + std::to_string(factor)).start();
      if (function.name == "watson")  // its start is zero
        EXPECT_EQ(far, Vector::Constant(6, factor));
      else
        EXPECT_EQ(far, factor * start) << function.name;
    }
  }
}

TEST(MghProblems, OverflowIsNoFault) {
  for (const Named& function : functions()) {
    const Problem problem = make_classic_problem("mgh:" + function.name);
    Vector r(problem.residual_count());
    Matrix j(problem.residual_count(), problem.dimension());
    for (const double value : {0.0, 1e6, -1e6, 1e160, -1e160, 1e300, -1e300, 1e-300}) {
      const Vector x = Vector::Constant(problem.dimension(), value);
      EXPECT_NO_THROW(problem.residuals_and_jacobian(x, r, j)) << function.name;
      EXPECT_FALSE(problem.cost(x) < 0) << function.name;
    }
  }
}

TEST(ClassicCatalogue, StatesWhatTheProblemsAre) {
  std::set<std::string> names;
  std::map<std::string, int> families;
  for (const ClassicEntry& entry : classic_catalogue()) {
    SCOPED_TRACE(entry.name);
    EXPECT_TRUE(names.insert(entry.name).second);
    ++families[entry.family];
    const Problem problem = make_classic_problem(entry.name);
    EXPECT_EQ(problem.name(), entry.name);
    EXPECT_EQ(problem.dimension(), entry.dimension);
    EXPECT_EQ(problem.known_optimum(), entry.best_cost);
    EXPECT_EQ(problem.has_residuals() ? problem.residual_count() : 0, entry.residuals);
    EXPECT_TRUE(entry.dimensions.allows(entry.dimension));
    EXPECT_FALSE(entry.source.empty());
    EXPECT_EQ(find_classic_problem(entry.name), &entry);
    if (entry.family != "classic") continue;
    for (const Vector& x : problem.known_minimisers())
      EXPECT_NEAR(problem.cost(x), *entry.best_cost, 1e-12 * *entry.best_cost);
  }
  EXPECT_EQ(families, (std::map<std::string, int>{{"classic", 7}, {"mgh", 105}, {"nist", 54}}));
  EXPECT_EQ(classic_problem_names().size(), classic_catalogue().size());
  EXPECT_EQ(find_classic_problem("mgh:rosenbrock/1000"), nullptr);
}

std::string refusal(const std::string& name, int dimension) {
  try {
    make_classic_problem(name, dimension);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(ClassicCatalogue, RefusesOtherDimensions) {
  EXPECT_EQ(refusal("nist:Misra1a/1", 3), "problem 'nist:Misra1a/1': dimension 3; expected 2");
  EXPECT_EQ(refusal("mgh:watson", 32), "problem 'mgh:watson': dimension 32; expected 2..31");
  EXPECT_EQ(refusal("mgh:extended-powell-singular/10", 6),
            "problem 'mgh:extended-powell-singular/10': dimension 6; expected 4, 8, 12, ...");
  EXPECT_EQ(refusal("mgh:trigonometric", 1), "problem 'mgh:trigonometric': dimension 1; expected >= 2");
  EXPECT_EQ(refusal("sphere", -1), "problem 'sphere': dimension -1; expected >= 2");
  EXPECT_EQ(refusal("nist:Misra1a", 0), "unknown problem 'nist:Misra1a'");
  EXPECT_EQ(refusal("mgh:trigonometric", 40), "");
}

TEST(LogRelativeError, CountsTheDigitsOfTheWorstParameter) {
  const std::vector<Vector> one{Eigen::Vector2d(100, -2)};
  EXPECT_EQ(log_relative_error(Eigen::Vector2d(100, -2), one), kMostDigits);
  EXPECT_NEAR(log_relative_error(Eigen::Vector2d(100.001, -2), one), 5, 1e-6);
  EXPECT_NEAR(log_relative_error(Eigen::Vector2d(100.001, -2.002), one), 3, 1e-6);
  EXPECT_EQ(log_relative_error(Eigen::Vector2d(100, 2), one), 0);
  EXPECT_EQ(log_relative_error(Eigen::Vector2d(100, std::nan("")), one), 0);
  EXPECT_EQ(log_relative_error(Eigen::Vector2d(std::nan(""), -2), one), 0);
  const std::vector<Vector> two{Eigen::Vector2d(100, -2), Eigen::Vector2d(0, 1)};
  EXPECT_NEAR(log_relative_error(Eigen::Vector2d(1e-4, 1), two), 4, 1e-9);
  EXPECT_THROW(log_relative_error(Eigen::Vector2d(1, 1), {}), std::invalid_argument);
  EXPECT_THROW(log_relative_error(Eigen::Vector3d(1, 1, 1), two), std::invalid_argument);
}

struct Misplaced {  // a minimiser outside its box
  std::vector<ParameterInfo> list{{"x", "1", 0, -1, 1}};
  std::vector<Vector> minimisers{Vector::Constant(1, 2.0)};
  std::string name() const { return "misplaced"; }
  const std::vector<ParameterInfo>& parameters() const { return list; }
  double cost(const ConstVectorRef& x) const { return (x[0] - 2) * (x[0] - 2); }
  const std::vector<Vector>& known_minimisers() const { return minimisers; }
};

TEST(Problem, KnownMinimisersLieInTheBox) {
  EXPECT_THROW(Problem{Misplaced{}}, std::invalid_argument);
  Misplaced model;
  model.minimisers = {Eigen::Vector2d(0, 0)};
  EXPECT_THROW(Problem{model}, std::invalid_argument);
  model.minimisers = {Vector::Constant(1, 1.0)};
  EXPECT_EQ(Problem{model}.known_minimiser(), Vector::Constant(1, 1.0));
  EXPECT_EQ(make_classic_problem("step", 3).known_minimiser(), std::nullopt);
}

TEST(ClassicCatalogue, DocumentationListsEveryProblem) {
  std::ifstream file(testing::source_dir() / "docs" / "problems.md");
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  for (const ClassicEntry& entry : classic_catalogue()) {
    const std::string name = entry.name.substr(0, entry.name.find('/'));
    EXPECT_NE(text.find("| `" + name + "` |"), std::string::npos) << name;
    if (entry.best_cost && *entry.best_cost != 0) {
      EXPECT_NE(text.find(fmt::format(" {:.10g} |", *entry.best_cost)), std::string::npos) << name;
    }
  }
}

// Strictly convex: the conditions of Karush, Kuhn and Tucker hold at one point only, and lm's steps are exact
// there.
TEST(ClassicCatalogue, CornerKnowsItsOptimum) {
  for (const int n : {2, 5, 12, 40}) {
    const Problem problem = make_classic_problem("corner", n);
    ASSERT_TRUE(problem.known_optimum());
    const Result r = solve(problem, {"lm", {}}, problem.start(), {});
    EXPECT_NEAR(r.cost / *problem.known_optimum(), 1, 1e-10) << n;
    EXPECT_NEAR(problem.cost(*problem.known_minimiser()) / *problem.known_optimum(), 1, 1e-12) << n;
    EXPECT_LT((*problem.known_minimiser() - r.x).cwiseAbs().maxCoeff(), 1e-6) << n;
  }
}

}  // namespace
}  // namespace odobench
