// A calibration recording by recording against the calibration of all of them.
#include "problems/calibration/recording_costs.hpp"

#include <gtest/gtest.h>

#include "problems/simulation/demo_generator.hpp"
#include "problems/simulation/robot_demo.hpp"

namespace odobench {
namespace {

// Inside the box, away from its middle.
Vector a_point(const std::vector<ParameterInfo>& parameters) {
  Vector z(static_cast<Eigen::Index>(parameters.size()));
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const ParameterInfo& p = parameters[static_cast<std::size_t>(i)];
    z[i] = p.nominal + 0.3 * (p.upper - p.lower) * std::sin(1.0 + static_cast<double>(i));
  }
  return z;
}

class RecordingCostsOf : public ::testing::TestWithParam<const char*> {
 protected:
  RecordingCostsOf()
      : set_(std::string(GetParam()) == "4wis4wid" ? make_demo_dataset() : make_robot_demo(GetParam(), 1)) {
    options_.rule = set_.robot.rule;
    set_.recordings.resize(5);
    each_ = std::make_shared<RecordingCosts>(set_.robot, set_.recordings, options_);
  }
  CalibrationProblem problem_of(std::vector<Recording> recordings) const {
    return CalibrationProblem(set_.robot, std::move(recordings), options_);
  }
  Dataset set_;
  CalibrationOptions options_;
  std::shared_ptr<const RecordingCosts> each_;
};

TEST_P(RecordingCostsOf, WeightsOfOneGiveTheProblemOfAll) {
  const CalibrationProblem all = problem_of(set_.recordings);
  const WeightedCalibration weighted(each_, Vector::Ones(5));
  const Vector z = a_point(all.parameters());
  EXPECT_NEAR(weighted.cost(z), all.cost(z), 1e-12 * all.cost(z));
  EXPECT_NEAR(each_->costs(z).sum(), all.cost(z), 1e-12 * all.cost(z));
  NormalEquations expected, found;
  all.normal_equations(z, expected);
  weighted.normal_equations(z, found);
  EXPECT_NEAR(found.cost, expected.cost, 1e-12 * expected.cost);
  EXPECT_LT((found.jtr - expected.jtr).norm(), 1e-10 * expected.jtr.norm());
  EXPECT_LT((found.jtj - expected.jtj).norm(), 1e-10 * expected.jtj.norm());
  EXPECT_GE(weighted.rounding_floor(z), 0.5 * all.rounding_floor(z));
}

TEST_P(RecordingCostsOf, ARecordingThatCountsTwiceStandsTwice) {
  std::vector<Recording> drawn = {set_.recordings[0], set_.recordings[2], set_.recordings[2]};
  drawn.back().id += "_again";
  const CalibrationProblem twice = problem_of(drawn);
  Vector weights(5);
  weights << 1, 0, 2, 0, 0;
  const WeightedCalibration weighted(each_, weights);
  const Vector z = a_point(twice.parameters());
  EXPECT_NEAR(weighted.cost(z), twice.cost(z), 1e-12 * twice.cost(z));
  Matrix candidates(z.size(), 2);
  candidates << z, 1.001 * z;
  Vector costs(2);
  weighted.batch_cost(candidates, costs);
  EXPECT_DOUBLE_EQ(costs[0], weighted.cost(z));
  EXPECT_DOUBLE_EQ(costs[1], weighted.cost(1.001 * z));
}

INSTANTIATE_TEST_SUITE_P(Robots, RecordingCostsOf, ::testing::Values("4wis4wid", "differential", "mecanum"));

TEST(RecordingCosts, RefusesWeightsThatAreNone) {
  const Dataset set = make_robot_demo("differential", 1);
  CalibrationOptions options;
  options.rule = set.robot.rule;
  const auto each = std::make_shared<const RecordingCosts>(set.robot, set.recordings, options);
  const auto count = static_cast<Eigen::Index>(each->size());
  EXPECT_THROW(WeightedCalibration(each, Vector::Ones(count + 1)), std::invalid_argument);
  EXPECT_THROW(WeightedCalibration(each, Vector::Zero(count)), std::invalid_argument);
  Vector negative = Vector::Ones(count);
  negative[0] = -1;
  EXPECT_THROW(WeightedCalibration(each, negative), std::invalid_argument);
  EXPECT_THROW(RecordingCosts(set.robot, {}, options), std::invalid_argument);
}

}  // namespace
}  // namespace odobench
