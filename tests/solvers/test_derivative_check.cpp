// Derivatives that problems state against differences: every problem of the catalogue, the calibration, and
// what is wrong on purpose.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "problems/classic/classic_problems.hpp"
#include "solvers/certificate/derivative_check.hpp"
#include "solvers/solve.hpp"

namespace odobench {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;

struct Bent {
  enum class Fault { None, Sign, Entry, Digits, Gram, Infinite } fault = Fault::None;
  std::vector<ParameterInfo> list{{"a", "1", 0.7, 0, 2}, {"b", "1", 1.3, -3, 3}, {"c", "1", 2, 2, 2}};
  std::string name() const { return "bent"; }
  const std::vector<ParameterInfo>& parameters() const { return list; }
  Eigen::Index residual_count() const { return 3; }
  double cost(const ConstVectorRef& x) const {
    Vector r(3);
    residuals(x, r);
    return r.squaredNorm();
  }
  void residuals(const ConstVectorRef& x, VectorRef r) const {
    r << std::sqrt(x[0]) * x[1], std::exp(x[0]) - x[2], std::sin(x[1]) + 1e3;
  }
  void residuals_and_jacobian(const ConstVectorRef& x, VectorRef r, MatrixRef j) const {
    residuals(x, r);
    j << x[1] / (2 * std::sqrt(x[0])), std::sqrt(x[0]), 0, std::exp(x[0]), 0, -1, 0, std::cos(x[1]), 0;
    if (fault == Fault::Sign) j.col(1) *= -1;
    if (fault == Fault::Entry) j(2, 0) = 1e-3;
    if (fault == Fault::Digits) j(1, 0) *= 1 + 1e-5;
    if (fault == Fault::Infinite) j(0, 1) = INFINITY;
  }
  void normal_equations(const ConstVectorRef& x, NormalEquations& out) const {
    Vector r(3);
    Matrix j(3, 3);
    residuals_and_jacobian(x, r, j);
    out = {r.squaredNorm(), j.transpose() * r, j.transpose() * j};
    if (fault == Fault::Gram) out.jtj(0, 1) = out.jtj(1, 0) = out.jtj(0, 1) * 1.001;
  }
};

std::vector<std::string> disagreements(Bent::Fault fault, const Vector& x) {
  Bent bent;
  bent.fault = fault;
  std::vector<std::string> list;
  for (const DerivativeComparison& c : compare_derivatives(Problem(bent), x))
    if (!c.agrees()) list.push_back(c.kind + " " + c.parameter);
  return list;
}

TEST(DerivativeCheck, NamesWhatIsWrongAndNothingElse) {
  const Vector x = Eigen::Vector3d(0.7, 1.3, 2);
  using Fault = Bent::Fault;
  EXPECT_THAT(disagreements(Fault::None, x), ElementsAre());
  EXPECT_THAT(disagreements(Fault::Sign, x), ElementsAre("Jacobian b", "gradient b"));
  EXPECT_THAT(disagreements(Fault::Entry, x), ElementsAre("Jacobian a", "gradient a"));
  EXPECT_EQ(disagreements(Fault::Digits, x).front(), "Jacobian a");
  EXPECT_THAT(disagreements(Fault::Gram, x), ElementsAre("J'J a", "J'J b"));
  EXPECT_THAT(disagreements(Fault::Infinite, x), Contains("Jacobian b"));
}

// At a bound the function need not be defined beyond it; and d sqrt(a)/da is infinite at a = 0.
TEST(DerivativeCheck, BoundsAreNotCrossed) {
  EXPECT_THAT(disagreements(Bent::Fault::None, Eigen::Vector3d(2, -3, 2)), ElementsAre());
  EXPECT_THAT(disagreements(Bent::Fault::Sign, Eigen::Vector3d(2, -3, 2)),
              ElementsAre("Jacobian b", "gradient b"));
  EXPECT_EQ(disagreements(Bent::Fault::None, Eigen::Vector3d(0, 1.3, 2)).front(), "Jacobian a");
}

TEST(DerivativeCheck, SaysWhichEntryAndByHowMuch) {
  Bent bent;
  bent.fault = Bent::Fault::Entry;
  const DerivativeComparison c = compare_derivatives(Problem(bent), Eigen::Vector3d(0.7, 1.3, 2)).front();
  EXPECT_EQ(c.row, 2);
  EXPECT_EQ(c.stated, 1e-3);
  EXPECT_NEAR(c.differenced, 0, 1e-9);
  EXPECT_NEAR(c.error, 1e-3 / std::exp(0.7), 1e-9);
  EXPECT_FALSE(c.undecided());
}

// Of every problem that is registered, at its start and at three random points of its box.
TEST(DerivativeCheck, EveryProblemOfTheCatalogue) {
  int compared = 0, undecided = 0;
  for (const ClassicEntry& entry : classic_catalogue()) {
    const Problem problem = make_classic_problem(entry.name);
    for (int k = 0; k < 4; ++k) {
      const Vector x = k == 0 ? problem.start() : random_start(problem, static_cast<std::uint64_t>(k));
      for (const DerivativeComparison& c : compare_derivatives(problem, x)) {
        ++compared;
        undecided += c.undecided();
        EXPECT_TRUE(c.agrees()) << entry.name << ", point " << k << ", " << c.kind << " " << c.parameter
                                << ": " << c.stated << " for " << c.differenced << ", " << c.error << " > "
                                << c.limit;
      }
    }
  }
  EXPECT_GT(compared, 4000);
  EXPECT_LT(undecided, compared / 5) << compared;
}

}  // namespace
}  // namespace odobench
