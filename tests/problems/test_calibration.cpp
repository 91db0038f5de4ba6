#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "problems/calibration/calibration_problem.hpp"
#include "problems/calibration/kernel/kernel.hpp"
#include "problems/calibration/structure.hpp"
#include "problems/instruction_set.hpp"
#include "solvers/certificate/verdict.hpp"
#include "solvers/solve.hpp"
#include "tests/support/data/synthetic_recording.hpp"
#include "tests/support/shared_data.hpp"

namespace odobench {
namespace {

using testing::nominal_robot;
using testing::synthetic_recording;

std::vector<Recording> some_recordings() {
  // Long ones with several blocks, and lengths around the lane counts where blocks and tails begin and end.
  std::vector<Recording> list{synthetic_recording(2400, 0.016, 1), synthetic_recording(777, 0.02, 2)};
  for (int samples : {2, 3, 4, 5, 8, 9, 10, 16, 17, 18, 33})
    list.push_back(synthetic_recording(samples, 0.05, samples));
  return list;
}

Vector nominal_vector() {
  return Problem(CalibrationProblem(nominal_robot(), some_recordings())).start();
}

Vector perturbed(int variant) {
  Vector z = nominal_vector();
  for (Eigen::Index i = 0; i < z.size(); ++i)
    z[i] *= 1.0 + 0.05 * std::sin(1.0 + 2.3 * static_cast<double>(i) + variant);
  return z;
}

TEST(Calibration, EveryKernelAgreesWithTheDirectForm) {
  const auto recordings = some_recordings();
  for (const InstructionSet k : available_instruction_sets()) {
    const CalibrationStructure structure(recordings, nominal_vector(), k);
    for (int variant = 0; variant < 4; ++variant) {
      const Vector z = perturbed(variant);
      const double expected = direct::cost(recordings, z);
      EXPECT_NEAR(structure.cost(z) / expected, 1.0, 1e-12) << to_string(k) << " variant " << variant;
    }
  }
}

TEST(Calibration, StepsThatTurnFarUseTheExactRotation) {
  // 2 s between samples: the heading turns by more than the rotation polynomial covers.
  const std::vector<Recording> recordings{synthetic_recording(300, 2.0, 1)};
  const Vector z = perturbed(1);
  for (const InstructionSet k : available_instruction_sets()) {
    const CalibrationStructure structure(recordings, nominal_vector(), k);
    EXPECT_NEAR(structure.cost(z) / direct::cost(recordings, z), 1.0, 1e-11) << to_string(k);
    NormalEquations e;
    structure.normal_equations(z, e);
    EXPECT_NEAR(e.cost / direct::cost(recordings, z), 1.0, 1e-11) << to_string(k);
  }
}

// One turn by `angle`, then a step of 1 m straight ahead.
TEST(Calibration, TheRotationHoldsAsFarAsItSays) {
  for (const InstructionSet set : available_instruction_sets()) {
    const kernel::Kernel kernel = kernel::select(set);
    const auto width = static_cast<std::size_t>(kernel.width);
    for (const double angle : {kernel::kMaxAngle, -kernel::kMaxAngle, 0.2, 0.01, 0.0})
      for (const bool exact : {false, true}) {
        std::vector<double> data(2 * kernel::kStreams * width, 0.0);
        for (std::size_t lane = 0; lane < width; ++lane) {
          data[lane] = angle;                               // C_1 of the first step
          data[(kernel::kStreams + 1) * width + lane] = 1;  // C_2 of the second
        }
        const double s[kernel::kLinear] = {0, 1, 0, 0, -1};  // r_2 = 1, P_1 = -1
        kernel::CostSums sums{};
        std::fill_n(sums.cos0, kernel::kMaxWidth, 1.0);
        kernel.cost({data.data(), 2}, s, exact, sums);
        for (std::size_t lane = 0; lane < width; ++lane) {
          EXPECT_NEAR(sums.x[lane], std::cos(angle), 3e-16) << to_string(set) << " " << angle;
          EXPECT_NEAR(sums.y[lane], std::sin(angle), 1e-16) << to_string(set) << " " << angle;
        }
      }
  }
}

TEST(Calibration, NormalEquationsAreThoseOfTheDenseJacobian) {
  const auto recordings = some_recordings();
  const CalibrationProblem problem(nominal_robot(), recordings);
  const Vector z = perturbed(2);
  Vector r(problem.residual_count());
  Matrix j(problem.residual_count(), 12);
  problem.residuals_and_jacobian(z, r, j);
  const Matrix jtj = j.transpose() * j;
  const Vector jtr = j.transpose() * r;
  for (const InstructionSet k : available_instruction_sets()) {
    NormalEquations e;
    CalibrationStructure(recordings, nominal_vector(), k).normal_equations(z, e);
    EXPECT_NEAR(e.cost / r.squaredNorm(), 1.0, 1e-12) << to_string(k);
    for (Eigen::Index i = 0; i < 12; ++i) {
      EXPECT_NEAR(e.jtr[i], jtr[i], 1e-11 * std::sqrt(jtj(i, i) * r.squaredNorm()))
          << to_string(k) << " " << i;
      for (Eigen::Index l = 0; l < 12; ++l)
        EXPECT_NEAR(e.jtj(i, l), jtj(i, l), 1e-11 * std::sqrt(jtj(i, i) * jtj(l, l)))
            << to_string(k) << " " << i << " " << l;
    }
  }
}

// Rows of eight or sixteen steps at a time, two steps a row: every length around where these end, in all
// lanes and in the last steps of a recording.
TEST(Calibration, NormalEquationsAtTheEndsOfBlocks) {
  const Vector z = perturbed(1);
  for (const InstructionSet k : available_instruction_sets()) {
    const int width = kernel::select(k).width;
    for (const int steps : {1, 2, 7, 8, 9, 15, 16, 17, 31, 32, 33})
      for (const int last : {0, 1, 2}) {
        const std::vector<Recording> recordings{
            synthetic_recording(width * steps + std::min(last, width - 1) + 1, 0.03, steps)};
        const CalibrationProblem problem(nominal_robot(), recordings, k);
        Vector r(problem.residual_count());
        Matrix j(r.size(), 12);
        problem.residuals_and_jacobian(z, r, j);
        NormalEquations e;
        problem.normal_equations(z, e);
        EXPECT_EQ(e.cost, problem.cost(z)) << to_string(k) << " " << steps;
        const Vector norms = j.colwise().norm();
        EXPECT_LT(((e.jtr - j.transpose() * r).array() / norms.array()).abs().maxCoeff(), 1e-11 * r.norm())
            << to_string(k) << " " << steps;
        const Matrix difference = e.jtj - j.transpose() * j;
        EXPECT_LT(difference.cwiseQuotient(norms * norms.transpose()).cwiseAbs().maxCoeff(), 1e-11)
            << to_string(k) << " " << steps;
      }
  }
}

TEST(Calibration, EveryNumberOfTheJacobianIsWritten) {
  for (const int samples : {2, 64, 65, 66, 129, 700}) {
    const std::vector<Recording> recordings{synthetic_recording(samples, 0.03, 1),
                                            synthetic_recording(5, 0.03, 2)};
    const CalibrationProblem problem(nominal_robot(), recordings);
    const Vector z = perturbed(2);
    Vector r = Vector::Constant(problem.residual_count(), NAN), expected(r.size());
    Matrix j = Matrix::Constant(r.size(), 12, NAN);
    problem.residuals_and_jacobian(z, r, j);
    problem.residuals(z, expected);
    EXPECT_TRUE(j.allFinite()) << samples;
    EXPECT_LT((r - expected).norm(), 1e-12 * expected.norm()) << samples;
  }
}

TEST(Calibration, JacobianMatchesCentralDifferences) {
  const CalibrationProblem problem(nominal_robot(), {synthetic_recording(400, 0.03, 3)});
  const Vector z = perturbed(3);
  Vector r(problem.residual_count()), plus(r.size()), minus(r.size());
  Matrix j(r.size(), 12);
  problem.residuals_and_jacobian(z, r, j);
  for (Eigen::Index i = 0; i < 12; ++i) {
    Vector shifted = z;
    const double h = 1e-5 * std::abs(z[i]);
    shifted[i] = z[i] + h;
    problem.residuals(shifted, plus);
    shifted[i] = z[i] - h;
    problem.residuals(shifted, minus);
    const double error = ((plus - minus) / (2 * h) - j.col(i)).norm();
    EXPECT_LE(error, 1e-7 * j.col(i).norm()) << "column " << i;
  }
}

TEST(Calibration, BatchHasTheBitsOfSingleEvaluations) {
  const CalibrationProblem problem(nominal_robot(), some_recordings());
  Matrix candidates(12, 13);
  for (Eigen::Index k = 0; k < candidates.cols(); ++k) candidates.col(k) = perturbed(static_cast<int>(k));
  Vector costs(13);
  problem.batch_cost(candidates, costs);
  for (Eigen::Index k = 0; k < candidates.cols(); ++k)
    EXPECT_EQ(costs[k], problem.cost(candidates.col(k))) << k;
}

// The recordings as this robot would have driven them, moved by `noise` (m, rad) up and down in turn.
std::vector<Recording> driven_by(const Vector& truth, double noise) {
  std::vector<Recording> recordings = some_recordings();
  for (Recording& r : recordings) {
    const PoseTrack q = direct::integrate(r, truth);
    for (std::size_t k = 0; k < r.size(); ++k) {
      const double error = k > 0 ? noise * std::sin(1.0 + 12.9898 * static_cast<double>(k)) : 0.0;
      r.reference.x[k] = q.x[k] + error;
      r.reference.y[k] = q.y[k] - error;
      r.reference.theta[k] = q.theta[k] + error;
    }
  }
  return recordings;
}

// The structured form squares errors of the heading, not headings: near exact data it has the digits of the
// equations as written.
TEST(Calibration, TheStructuredCostKeepsItsDigitsNearExactData) {
  const Vector truth = perturbed(4);
  for (const auto& [noise, relative] : std::vector<std::pair<double, double>>{
           {1e-9, 1e-6}, {1e-8, 1e-7}, {1e-7, 1e-8}, {1e-6, 1e-9}, {1e-5, 1e-10}, {1e-3, 1e-12}}) {
    const std::vector<Recording> recordings = driven_by(truth, noise);
    const double expected = direct::cost(recordings, truth);
    for (const InstructionSet k : available_instruction_sets()) {
      const CalibrationStructure structure(recordings, nominal_vector(), k);
      NormalEquations e;
      structure.normal_equations(truth, e);
      Vector batch(1);
      structure.batch_cost(truth, batch);
      for (const double cost : {structure.cost(truth), e.cost, batch[0]})
        EXPECT_NEAR(cost / expected, 1.0, relative) << to_string(k) << " noise " << noise;
    }
  }
}

TEST(Calibration, TheGradientKeepsItsDigitsNearExactData) {
  const Vector truth = perturbed(4);
  const std::vector<Recording> recordings = driven_by(truth, 1e-8);
  for (const InstructionSet k : available_instruction_sets()) {
    const CalibrationProblem problem(nominal_robot(), recordings, k);
    Vector r(problem.residual_count());
    Matrix j(problem.residual_count(), 12);
    problem.residuals_and_jacobian(truth, r, j);
    NormalEquations e;
    problem.normal_equations(truth, e);
    const Vector jtr = j.transpose() * r;
    for (Eigen::Index i = 0; i < 12; ++i)
      EXPECT_NEAR(e.jtr[i], jtr[i], 2e-7 * j.col(i).norm() * r.norm()) << to_string(k) << " " << i;
  }
}

// Data without noise: what rounding leaves is below the stated floor and never negative, not even before the
// clamp, and a solver that gets there has converged.
TEST(Calibration, ExactDataEndAtTheRoundingFloor) {
  const Vector truth = perturbed(4);
  const std::vector<Recording> recordings = driven_by(truth, 0);
  for (const InstructionSet k : available_instruction_sets()) {
    const CalibrationProblem model(nominal_robot(), recordings, k);
    const CalibrationStructure structure(recordings, nominal_vector(), k);
    EXPECT_LT(model.rounding_floor(truth), 1e-20);
    for (int scatter = 0; scatter < 20; ++scatter) {
      Vector x = truth;
      x[scatter % 12] *= 1 + 1e-12 * scatter;
      NormalEquations e;
      structure.normal_equations(x, e);
      Vector batch(1);
      structure.batch_cost(x, batch);
      const double exact = direct::cost(recordings, x);
      for (const double cost : {structure.cost(x), e.cost, batch[0]}) {
        EXPECT_GE(cost, 0);
        EXPECT_LE(std::abs(cost - exact), model.rounding_floor(x)) << to_string(k);
      }
      EXPECT_GE(model.cost(x), 0);
    }
    const Problem problem(std::make_shared<const CalibrationProblem>(nominal_robot(), recordings, k));
    for (const char* solver : {"lm", "ceres", "ip", "nlopt:slsqp"}) {
      SolveOptions options;
      options.budget.max_evaluations = 1000;
      const Result r = solve(problem, {solver, {}}, problem.start(), options);
      EXPECT_EQ(r.termination, Termination::Converged) << to_string(k) << " " << r.brief();
      EXPECT_LE(r.cost, 1e-11) << r.brief();
      EXPECT_GE(r.cost, 0) << r.brief();
      const auto check = check_optimality(problem, r.x);
      ASSERT_TRUE(check);
      EXPECT_TRUE(check->holds()) << to_string(k) << " " << r.brief() << " " << check->text();
      if (std::string(solver) == "lm") {
        EXPECT_LE(r.cost, 1e-20) << r.brief();
        EXPECT_LE(r.counts.total(), 200) << r.brief();
      }
    }
  }
}

TEST(Calibration, NotANumberComesOutAsNotANumber) {
  const CalibrationProblem problem(nominal_robot(), some_recordings());
  Vector z = perturbed(0);
  z[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(problem.cost(z)));
}

TEST(Calibration, RefusesWhatIsNoCalibrationProblem) {
  const auto message = [](std::vector<ParameterInfo> parameters,
                          std::vector<Recording> recordings) -> std::string {
    try {
      const CalibrationProblem problem(std::move(parameters), std::move(recordings));
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  auto swapped = nominal_robot();
  std::swap(swapped[0], swapped[1]);
  auto inverted = nominal_robot();
  std::swap(inverted[5].lower, inverted[5].upper);
  auto at_origin = nominal_robot();
  at_origin[2].lower = at_origin[6].lower = -1;
  at_origin[2].upper = at_origin[6].upper = 1;
  EXPECT_EQ(message({}, some_recordings()),
            "calibration: 0 parameters, expected the 12 of a1..a4, b1..b4, r1..r4");
  EXPECT_EQ(message(swapped, some_recordings()), "calibration: parameter 1 is 'a2', expected 'a1'");
  EXPECT_NE(message(inverted, some_recordings()).find("'b2': lower"), std::string::npos);
  EXPECT_NE(message(at_origin, some_recordings()).find("wheel 3 stand at the origin"), std::string::npos);
  EXPECT_EQ(message(nominal_robot(), {}), "calibration: no recordings, expected at least one");
  EXPECT_NE(message(nominal_robot(), {synthetic_recording(1, 0.1, 1)}).find("1 samples"), std::string::npos);
}

}  // namespace
}  // namespace odobench
