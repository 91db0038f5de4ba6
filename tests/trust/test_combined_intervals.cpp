// Formulas of parameters, their intervals, and profiles of J with the intervals that they give.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "bench/studies/trust/profile_likelihood.hpp"
#include "problems/simulation/robot_demo.hpp"
#include "problems/trust/combined_intervals.hpp"
#include "problems/trust/trust.hpp"
#include "solvers/solve.hpp"
#include "tests/support/data/report_records.hpp"
#include "tests/support/data/vitko_problem.hpp"

namespace odobench {
namespace {

using ::testing::HasSubstr;

// x = 3 m, y = 0.5 m, phi = 0.2 rad with gradients e_1, e_2, e_3.
std::optional<Quantity> known_quantity(const std::string& name) {
  const std::vector<std::pair<std::string, double>> all = {{"x", 3}, {"y", 0.5}, {"phi", 0.2}};
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].first == name)
      return Quantity{all[i].second, Vector::Unit(3, static_cast<Eigen::Index>(i)),
                      dimension_of(i < 2 ? "m" : "rad"), false};
  return std::nullopt;
}
Quantity value_of(const std::string& text) {
  return evaluate(named_formula(text), known_quantity, {"x", "y", "phi"});
}
std::string refusal_of(const std::string& text) {
  try {
    value_of(text);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Formula, ValueGradientAndUnit) {
  const Quantity mean = value_of("mean = (x + y) / 2");
  EXPECT_EQ(mean.value, 1.75);
  EXPECT_EQ(mean.gradient, Eigen::Vector3d(0.5, 0.5, 0));
  EXPECT_EQ(unit_of(*mean.dimension), "m");
  EXPECT_DOUBLE_EQ(value_of("2 - 3*y - -x^2/4").value, 2 - 1.5 + 9.0 / 4);
  EXPECT_DOUBLE_EQ(value_of("-x^2").value, -9);
  EXPECT_DOUBLE_EQ(value_of("2^-1^2*x").value, 1.5) << "powers from the right";
  const Quantity root = value_of("sqrt(x*x + y*y)");
  EXPECT_DOUBLE_EQ(root.value, std::hypot(3, 0.5));
  EXPECT_NEAR((root.gradient - Eigen::Vector3d(3, 0.5, 0) / std::hypot(3, 0.5)).norm(), 0, 1e-15);
  EXPECT_EQ(unit_of(*root.dimension), "m");
  EXPECT_EQ(value_of("abs(y - x)").gradient, Eigen::Vector3d(1, -1, 0));
  EXPECT_EQ(unit_of(*value_of("x*y/phi").dimension), "m^2/rad");
  EXPECT_EQ(unit_of(*value_of("1/x").dimension), "1/m");
  EXPECT_EQ(unit_of(*value_of("x/y - 1").dimension), "");
  EXPECT_FALSE(value_of("x + phi").dimension) << "a sum of metres and radians has no unit";
  EXPECT_EQ(named_formula(" mean = (x+y)/2").name, "mean");
  EXPECT_EQ(named_formula("(x+y)/2").name, "(x+y)/2");
}

TEST(Formula, GradientsAreThoseOfDifferences) {
  for (const char* text : {"x*phi/(1 + y^2)", "sqrt(x/y) - phi*x", "(x - y)^3/phi^0.5"}) {
    const Vector found = value_of(text).gradient;
    for (Eigen::Index i = 0; i < 3; ++i) {
      const auto shifted = [&](double by) {
        return evaluate(named_formula(text),
                        [&](const std::string& name) {
                          std::optional<Quantity> q = known_quantity(name);
                          if (q && q->gradient[i] == 1) q->value += by;
                          return q;
                        },
                        {})
            .value;
      };
      EXPECT_NEAR(found[i], (shifted(1e-5) - shifted(-1e-5)) / 2e-5, 1e-8 * (1 + std::abs(found[i]))) << text;
    }
  }
}

TEST(Formula, SaysWhereItIsNone) {
  EXPECT_EQ(refusal_of("x + r9"), "'x + r9': at character 5: found 'r9', expected one of x, y, phi");
  EXPECT_THAT(refusal_of("x +"),
              HasSubstr("at character 4: found the end, expected a number, a name or '('"));
  EXPECT_THAT(refusal_of("(x + y"), HasSubstr("found the end, expected ')'"));
  EXPECT_THAT(refusal_of("x y"), HasSubstr("found 'y', expected an operator or the end"));
  EXPECT_THAT(refusal_of("x^y"), HasSubstr("expected an exponent without parameters"));
  EXPECT_THAT(refusal_of("x/(y - y)"), HasSubstr("not a finite number"));
  EXPECT_THAT(refusal_of(std::string(200, '(') + "x"), HasSubstr("at most 100"));
  EXPECT_THAT(refusal_of(std::string(200, '-') + "x"), HasSubstr("at most 100"));
  EXPECT_THAT(refusal_of(std::string(1001, 'x')), HasSubstr("expected at most 1000"));
  EXPECT_THAT(refusal_of(""), HasSubstr("found nothing"));
  EXPECT_THAT(refusal_of("a="), HasSubstr("found nothing"));
}

struct Calibrated {
  Dataset set;
  std::shared_ptr<const CalibrationProblem> model;
  std::unique_ptr<RecordingCosts> costs;
  Vector z;
};
Calibrated calibrated(const char* kinematics) {
  Calibrated out;
  out.set = make_robot_demo(kinematics, 1);
  CalibrationOptions options;
  options.rule = out.set.robot.rule;
  out.model = std::make_shared<const CalibrationProblem>(out.set.robot, out.set.recordings, options);
  out.costs = std::make_unique<RecordingCosts>(out.set.robot, out.set.recordings, options);
  const Problem problem(out.model);
  out.z = solve(problem, {"lm", {}}, problem.start(), {}).x;
  return out;
}

TEST(CombinationIntervals, AreThoseOfWhatTheyStandFor) {
  const Calibrated c = calibrated("differential");
  const Trust trust = assess_trust(*c.costs, c.set.robot, c.z);
  ASSERT_TRUE(trust.active.empty());
  const std::string single = trust.parameters[1].name, number = trust.determined.front().number.name;
  const auto list = combination_intervals(
      *c.costs, c.set.robot, c.z,
      {named_formula(number), named_formula("3*" + number + " - 1"), named_formula("r_left/r_right")});
  ASSERT_EQ(list.size(), 3U);
  EXPECT_TRUE(list[0].of_the_map);
  EXPECT_DOUBLE_EQ(list[0].value, trust.determined[0].number.value);
  EXPECT_DOUBLE_EQ(list[0].interval.half_width, trust.determined[0].interval.half_width);
  EXPECT_DOUBLE_EQ(list[0].interval.same_half_width, trust.determined[0].interval.same_half_width);
  EXPECT_NEAR(list[1].interval.half_width / list[0].interval.half_width, 3, 1e-9);
  EXPECT_EQ(list[2].unit, "");
  EXPECT_EQ(list[2].nominal, 1);
  EXPECT_GT(list[2].interval.half_width, 0);
  EXPECT_THROW(combination_intervals(*c.costs, c.set.robot, c.z, {named_formula("2")}),
               std::invalid_argument);
  EXPECT_THROW(combination_intervals(*c.costs, c.set.robot, c.z, {named_formula("r9")}),
               std::invalid_argument);
}

TEST(CombinationIntervals, OfTheMapAloneWhileABoundIsActive) {
  Calibrated c = calibrated("mecanum");
  const std::vector<ParameterInfo>& all = c.model->parameters();
  Eigen::Index at = 0;
  while (all[static_cast<std::size_t>(at)].name.rfind("r", 0) != 0) ++at;
  c.z[at] = all[static_cast<std::size_t>(at)].upper;
  const Trust trust = assess_trust(*c.costs, c.set.robot, c.z);
  ASSERT_FALSE(trust.active.empty());
  const std::string number = trust.determined.front().number.name;
  const auto list = combination_intervals(
      *c.costs, c.set.robot, c.z,
      {named_formula(number), named_formula("lx"), named_formula("(" + number + " + m33) / 2")});
  EXPECT_DOUBLE_EQ(list[0].interval.half_width, trust.determined[0].interval.half_width);
  EXPECT_FALSE(list[1].of_the_map);
  EXPECT_EQ(list[1].interval.refused, NoInterval::BoundActive);
  EXPECT_TRUE(std::isnan(list[1].interval.half_width));
  EXPECT_TRUE(list[2].of_the_map) << "whatever is made of the map alone";
  EXPECT_GT(list[2].interval.half_width, 0);
}

// Where J is nearly quadratic, the profile's interval is the linear one.
TEST(Profile, AgreesWithLinearisationWhereJIsQuadratic) {
  const Calibrated c = calibrated("differential");
  const Trust trust = assess_trust(*c.costs, c.set.robot, c.z);
  Watcher watcher;
  ProfileChoice all;
  all.all = true;
  const auto list = profiles(c.model, *c.costs, all, c.z, 2, watcher);
  const std::vector<RiseAlong> rises = rises_along(*c.costs, c.z);
  ASSERT_EQ(list.size(), c.model->parameters().size());
  for (std::size_t k = 0; k < list.size(); ++k) {
    const double at = c.z[static_cast<Eigen::Index>(k)], half = rises[k].half_width;
    EXPECT_NEAR(list[k].ends.upper - at, half, 0.02 * half) << list[k].parameter;
    EXPECT_NEAR(at - list[k].ends.lower, half, 0.02 * half) << list[k].parameter;
    EXPECT_TRUE(std::is_sorted(list[k].points.begin(), list[k].points.end(),
                               [](const auto& a, const auto& b) { return a.value < b.value; }));
    const double lowest = c.model->cost(c.z);
    for (const ProfilePoint& p : list[k].points) EXPECT_GE(p.cost, lowest * (1 - 1e-9));
    EXPECT_NEAR(half / trust.parameters[k].interval.half_width, 1, 0.35) << "beside CR3";
  }
  const auto again = profiles(c.model, *c.costs, profile_choice("r_left", 8), c.z, 1, watcher);
  ASSERT_EQ(again.size(), 1U);
  for (const ParameterProfile& p : list)
    if (p.parameter == "r_left") {
      EXPECT_EQ(p.ends.lower, again[0].ends.lower);
      EXPECT_EQ(p.points.size(), again[0].points.size());
    }
}

TEST(Profile, ChoiceIsRefusedInWords) {
  EXPECT_TRUE(profile_choice("all", 3).all);
  EXPECT_EQ(profile_choice("r1,b3", 3).parameters.size(), 2U);
  EXPECT_THROW(profile_choice("r1,r1", 3), std::invalid_argument);
  EXPECT_THROW(profile_choice("", 3), std::invalid_argument);
}

// The rise of J that the independent evaluation allows (its variance is the sandwich, ours the jackknife),
// and the ends that it finds with it.
TEST(Profile, OfTheRealDrivesHasTheGivenEnds) {
  ODOBENCH_NEEDS_SHARED();
  const nlohmann::json reference = odobench::testing::reference_json("trust_vitko2024.json");
  const auto model = odobench::testing::vitko_model();
  Vector z(12);
  for (Eigen::Index i = 0; i < 12; ++i)
    z[i] = reference["uncertainty"]["p_mm"][static_cast<std::size_t>(i)].get<double>() / 1000;
  const RecordingCosts costs(odobench::testing::vitko_dataset().robot, model->recordings(), model->options());
  Watcher watcher;
  const auto list = profiles(model, costs, profile_choice("a3,b3,r4", 6), z, 2, watcher);
  ASSERT_EQ(list.size(), 3U);
  const double given[] = {0.150, 0.189, 0.0596};
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(list[k].rise / given[k], 1, 0.35) << list[k].parameter << ": " << list[k].rise;
  EXPECT_TRUE(std::isinf(list[0].ends.lower)) << "a3 goes on to its bound";
}

}  // namespace
}  // namespace odobench
