// Faults of simulated sets, taken out again by the model that inspection names.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "bench/catalogue/problem_factory.hpp"
#include "problems/inspection/inspect.hpp"
#include "solvers/solve.hpp"
#include "tests/support/shared_data.hpp"

namespace odobench {
namespace {

using Names = std::vector<std::string>;
using ::testing::HasSubstr;

struct CaseFit {
  Problem problem;
  Vector z;
  double cost = 0;
  double value(const std::string& name) const {
    for (std::size_t i = 0; i < problem.parameters().size(); ++i)
      if (problem.parameters()[i].name == name) return z[static_cast<Eigen::Index>(i)];
    throw std::out_of_range(name);
  }
};

CaseFit fit_case(const std::string& name, const Names& model) {
  CalibrationChoice choice;
  choice.model = model;
  const LoadedProblem loaded = load_calibration(
      (testing::shared_folder() / "cases" / name / "set.json").string(), widest_instruction_set(), choice);
  const Result result = solve(loaded.problem, {"lm", {}}, loaded.problem.start(), {});
  return {loaded.problem, result.x, result.cost};
}

// What inspection says to do about the case.
std::string fix_of(const std::string& name, const std::string& kind) {
  const Dataset set = load_dataset(testing::shared_folder() / "cases" / name / "set.json");
  for (const inspection::Finding& f : inspection::inspect(set.robot, set.recordings))
    if (f.kind == kind) return std::string(f.fix());
  return "no such finding";
}

// Root mean square of what is left, m and rad: noise of the capture is 0.2 mm.
double left_over(const CaseFit& fit) {
  return std::sqrt(fit.cost / static_cast<double>(fit.problem.residual_count()));
}

TEST(Cases, SteeringZero) {
  ODOBENCH_NEEDS_SHARED();
  const CaseFit plain = fit_case("steering_2_zero_3deg", {});
  const CaseFit fit = fit_case("steering_2_zero_3deg", {"steering_zero:2"});
  EXPECT_THAT(fix_of("steering_2_zero_3deg", "steering_zero"), HasSubstr("--model=steering_zero:WHEEL"));
  EXPECT_LT(left_over(fit), 0.0003);
  EXPECT_GT(left_over(plain), 10 * left_over(fit));
  EXPECT_NEAR(fit.value("zero2"), -3 * M_PI / 180, 0.001);
}

// Errors of the first pose turn whole drives: with free starts what is left is white, and deviations by
// J / (m - n) (J'J)^-1 hold the truth.
TEST(Cases, ErrorsLargerThanSaid) {
  ODOBENCH_NEEDS_SHARED();
  const Dataset set =
      load_dataset(testing::shared_folder() / "cases" / "errors_larger_than_said" / "set.json");
  const auto held = [&](const Names& model) {
    const CaseFit fit = fit_case("errors_larger_than_said", model);
    NormalEquations e;
    fit.problem.normal_equations(fit.z, e);
    const Matrix inverse = e.jtj.inverse();
    const double variance = fit.cost / static_cast<double>(fit.problem.residual_count() - 12 - 15);
    int count = 0;
    for (Eigen::Index i = 0; i < 12; ++i) {
      const double truth = set.known_parameters.front().values[static_cast<std::size_t>(i)];
      count += std::abs(fit.z[i] - truth) < 1.96 * std::sqrt(variance * inverse(i, i));
    }
    return count;
  };
  EXPECT_GE(held({"start_pose"}), 11);
  EXPECT_LT(held({}), 6);
}

TEST(Cases, TrackedPoint) {
  ODOBENCH_NEEDS_SHARED();
  const CaseFit fit = fit_case("pivot_5cm_off", {"lever_arm"});
  EXPECT_THAT(fix_of("pivot_5cm_off", "tracked_point"), HasSubstr("--model=lever_arm"));
  EXPECT_LT(left_over(fit), 0.0003);
  EXPECT_NEAR(fit.value("mount_x"), 0.05, 0.003);
  EXPECT_NEAR(fit.value("mount_y"), 0.0, 0.003);
}

TEST(Cases, LateReference) {
  ODOBENCH_NEEDS_SHARED();
  const CaseFit fit = fit_case("capture_late_48ms", {"time_offset"});
  EXPECT_THAT(fix_of("capture_late_48ms", "reference_lag"), HasSubstr("--model=time_offset"));
  EXPECT_LT(left_over(fit), 0.0003);
  EXPECT_NEAR(fit.value("time_offset"), 0.048, 0.01);
}

TEST(Cases, RoomFrame) {
  ODOBENCH_NEEDS_SHARED();
  const CaseFit fit = fit_case("capture_in_room_frame", {"anchor"});
  EXPECT_THAT(fix_of("capture_in_room_frame", "start_offset"), HasSubstr("--model=anchor"));
  EXPECT_LT(left_over(fit), 0.0003);
  EXPECT_LT(left_over(fit_case("capture_in_room_frame", {"start_pose"})), 0.00025);
}

}  // namespace
}  // namespace odobench
