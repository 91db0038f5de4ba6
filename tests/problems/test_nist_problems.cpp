// The certified regression problems of NIST.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "problems/classic/nist.hpp"
#include "solvers/solve.hpp"
#include "tests/support/expression.hpp"
#include "tests/support/jacobian_check.hpp"

namespace odobench {
namespace {

using testing::Expression;

std::string name_of(const NistData& data, int start) {
  return "nist:" + data.name + "/" + std::to_string(start);
}

// r = f - y from NIST's formula as text.
testing::LongResiduals residuals_by_formula(const NistData& data) {
  const bool logarithm = data.name == "Nelson";
  return [&data, logarithm](const std::vector<long double>& b) {
    Expression model(data.model.substr(0, data.model.find(',')));
    std::map<std::string, long double> values;
    for (std::size_t k = 0; k < b.size(); ++k) values["b" + std::to_string(k + 1)] = b[k];
    std::vector<long double> r;
    for (Eigen::Index i = 0; i < data.observations.rows(); ++i) {
      for (Eigen::Index c = 1; c < data.observations.cols(); ++c)
        values[data.columns[static_cast<std::size_t>(c)]] = data.observations(i, c);
      const long double y = data.observations(i, 0);
      r.push_back(model(values) - (logarithm ? std::log(y) : y));
    }
    return r;
  };
}

TEST(Expression, FollowsTheUsualRules) {
  EXPECT_EQ(Expression("2-3*-4/8")({}), 3.5L);
  EXPECT_EQ(Expression("-a^2")({{"a", 3.0L}}), -9.0L);
  EXPECT_EQ(Expression("2^-1")({}), 0.5L);
  EXPECT_EQ(Expression("2*(a+1)^2/x1")({{"a", 1.0L}, {"x1", 4.0L}}), 2.0L);
  EXPECT_EQ(Expression("exp(0)+cos(0)")({}), 2.0L);
  EXPECT_THROW(Expression("2*q")({}), std::invalid_argument);
  EXPECT_THROW(Expression("(2")({}), std::invalid_argument);
  EXPECT_THROW(Expression("2)")({}), std::invalid_argument);
}

// Numbers of observations and parameters as on NIST's pages.
TEST(NistProblems, AllAreThere) {
  std::vector<std::string> shapes;
  for (const NistData& data : nist_data())
    shapes.push_back(data.name + " " + std::to_string(data.observations.rows()) + "x" +
                     std::to_string(data.certified.size()));
  EXPECT_THAT(shapes, ::testing::ElementsAre(
                          "Bennett5 154x3", "BoxBOD 6x2", "Chwirut1 214x3", "Chwirut2 54x3", "DanWood 6x2",
                          "ENSO 168x9", "Eckerle4 35x3", "Gauss1 250x8", "Gauss2 250x8", "Gauss3 250x8",
                          "Hahn1 236x7", "Kirby2 151x5", "Lanczos1 24x6", "Lanczos2 24x6", "Lanczos3 24x6",
                          "MGH09 11x4", "MGH10 16x3", "MGH17 33x5", "Misra1a 14x2", "Misra1b 14x2",
                          "Misra1c 14x2", "Misra1d 14x2", "Nelson 128x3", "Rat42 9x3", "Rat43 15x4",
                          "Roszman1 25x4", "Thurber 37x7"));
  EXPECT_EQ(nist_entries().size(), 54u);
}

TEST(NistProblems, ResidualsAndJacobianFollowTheFormula) {
  for (const NistData& data : nist_data())
    for (const int start : {1, 2}) {
      const Problem problem = make_classic_problem(name_of(data, start));
      for (const Vector& x : testing::points_to_check(problem, 0)) {
        const auto errors = testing::compare_jacobian(problem, x, residuals_by_formula(data), 0);
        EXPECT_LE(errors.residual, 1e-11) << problem.name() << " at " << x.transpose();
        EXPECT_LE(errors.jacobian, 2e-11) << problem.name() << " at " << x.transpose();
      }
    }
}

// Certified to 11 digits; what their rounding costs is of second order, except on data without noise.
TEST(NistProblems, CertifiedParametersHaveTheCertifiedCost) {
  for (const NistData& data : nist_data()) {
    const Problem problem = make_classic_problem(name_of(data, 1));
    EXPECT_EQ(problem.known_optimum(), data.certified_rss);
    ASSERT_FALSE(problem.known_minimisers().empty());
    EXPECT_EQ(*problem.known_minimiser(), data.certified);
    for (const Vector& x : problem.known_minimisers()) {
      if (data.name == "Lanczos1")
        EXPECT_LE(problem.cost(x), 1e-20);
      else
        EXPECT_NEAR(problem.cost(x) / data.certified_rss, 1, 5e-10)
            << problem.name() << " at " << x.transpose();
    }
  }
}

TEST(NistProblems, NoiseFreeDataReachTheirCertifiedCost) {
  const Problem problem = make_classic_problem("nist:Lanczos1/2");
  const Result r = solve(problem, {"lm", {}}, problem.start(), {});
  EXPECT_NEAR(r.cost / *problem.known_optimum(), 1, 0.05) << r.full();
}

TEST(NistProblems, BoxIsTenTimesTheLargestOfStartsAndSolution) {
  for (const NistData& data : nist_data())
    for (const int start : {1, 2}) {
      const Problem problem = make_classic_problem(name_of(data, start));
      EXPECT_EQ(problem.start(), data.starts[static_cast<std::size_t>(start - 1)]);
      for (Eigen::Index i = 0; i < problem.dimension(); ++i) {
        const ParameterInfo& p = problem.parameters()[static_cast<std::size_t>(i)];
        const double most =
            std::max({std::abs(data.starts[0][i]), std::abs(data.starts[1][i]), std::abs(data.certified[i])});
        EXPECT_EQ(p.upper, 10 * most);
        EXPECT_EQ(p.lower, -10 * most);
      }
    }
}

std::size_t minimisers(const char* name) {
  return make_classic_problem(name).known_minimisers().size();
}

TEST(NistProblems, EqualAnswersCountAsRight) {
  EXPECT_EQ(minimisers("nist:Misra1a/1"), 1u);
  EXPECT_EQ(minimisers("nist:Lanczos2/1"), 6u);
  EXPECT_EQ(minimisers("nist:MGH17/1"), 2u);
  EXPECT_EQ(minimisers("nist:Eckerle4/1"), 2u);
  EXPECT_EQ(minimisers("nist:ENSO/1"), 8u);
  EXPECT_EQ(minimisers("nist:Gauss1/1"), 8u);
  const Problem problem = make_classic_problem("nist:MGH17/2");
  Vector x = *problem.known_minimiser();
  std::swap(x[1], x[2]);
  EXPECT_LT(log_relative_error(x, problem.known_minimisers()), 1);
  std::swap(x[3], x[4]);
  EXPECT_EQ(log_relative_error(x, problem.known_minimisers()), kMostDigits);
}

// Whole months: a period of 44.3 cannot be told from one of 1 / (1 - 1/44.3).
TEST(NistProblems, MonthlySamplesHaveAliases) {
  const Problem problem = make_classic_problem("nist:ENSO/1");
  Vector x = *problem.known_minimiser();
  x[3] = 1 / (1 - 1 / x[3]);
  x[5] = -x[5];
  EXPECT_NEAR(problem.cost(x), *problem.known_optimum(), 1e-6);
}

TEST(NistProblems, OverflowIsNotFiniteAndNoFault) {
  for (const NistData& data : nist_data()) {
    const Problem problem = make_classic_problem(name_of(data, 1));
    Vector r(problem.residual_count());
    Matrix j(problem.residual_count(), problem.dimension());
    for (const double value : {0.0, -1.0, 1e6, -1e6, 1e160, -1e160, 1e300, -1e300, 1e-300}) {
      const Vector x = Vector::Constant(problem.dimension(), value);
      EXPECT_NO_THROW(problem.residuals_and_jacobian(x, r, j)) << data.name;
      EXPECT_FALSE(problem.cost(x) < 0) << data.name;
    }
  }
  const Problem bennett = make_classic_problem("nist:Bennett5/1");
  EXPECT_FALSE(std::isfinite(bennett.cost(Eigen::Vector3d(-2000, -50, 0.8))));
  const Problem misra = make_classic_problem("nist:Misra1c/1");
  EXPECT_FALSE(std::isfinite(misra.cost(Eigen::Vector2d(500, -0.9))));
}

// Where exp overflows although the curve is a plain step: Rat43 and Rat42 stay finite, with finite
// derivatives.
TEST(NistProblems, SigmoidsAreStableFarOut) {
  for (const char* name : {"nist:Rat42/1", "nist:Rat43/1"}) {
    const Problem problem = make_classic_problem(name);
    Vector x = problem.start();
    x[1] = 5000;
    Vector r(problem.residual_count());
    Matrix j(problem.residual_count(), problem.dimension());
    problem.residuals_and_jacobian(x, r, j);
    EXPECT_TRUE(r.allFinite() && j.allFinite()) << name;
    EXPECT_EQ(j.cwiseAbs().maxCoeff(), 0) << name;
  }
}

}  // namespace
}  // namespace odobench
