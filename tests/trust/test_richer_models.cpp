// Nuisance parameters and richer models: derivatives against differences, free starts against explicit ones,
// the reference values of the real recordings.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "bench/catalogue/problem_factory.hpp"
#include "datasets/native/robot_json.hpp"
#include "problems/calibration/models/model_signals.hpp"
#include "problems/calibration/recording_costs.hpp"
#include "problems/simulation/demo_generator.hpp"
#include "problems/simulation/robot_demo.hpp"
#include "solvers/solve.hpp"
#include "tests/support/data/vitko_problem.hpp"

namespace odobench {
namespace {

using Names = std::vector<std::string>;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

// A set cut down to two recordings of at most 60 samples, and a calibration of it with a model.
Dataset small_set(const std::string& robot) {
  Dataset set = robot == "4wis4wid" ? make_demo_dataset() : make_robot_demo(robot, 1);
  // The first and the last: other trajectories.
  set.recordings = {set.recordings.front(), set.recordings.back()};
  for (Recording& r : set.recordings) {
    const std::size_t kept = std::min<std::size_t>(r.size(), 60);
    r.time_us.resize(kept);
    for (Signal& s : r.signals) s.values.resize(kept);
    for (auto* list : {&r.reference.x, &r.reference.y, &r.reference.theta})
      if (r.reference.sample.empty()) list->resize(kept);
    if (r.reference.sample.empty()) continue;
    while (r.reference.sample.back() >= kept) {
      r.reference.sample.pop_back();
      for (auto* list : {&r.reference.x, &r.reference.y, &r.reference.theta}) list->pop_back();
    }
  }
  return set;
}

CalibrationOptions options_of(const Robot& robot, const Names& names) {
  CalibrationChoice choice;
  choice.model = names;
  return calibration_options(robot, choice);
}

// Inside the box and away from its middle; a different place for each variant.
Vector a_point(const std::vector<ParameterInfo>& parameters, int variant = 0) {
  Vector z(static_cast<Eigen::Index>(parameters.size()));
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    const ParameterInfo& p = parameters[static_cast<std::size_t>(i)];
    z[i] = p.nominal + 0.3 * (p.upper - p.lower) * std::sin(1.0 + 1.7 * static_cast<double>(i) + variant);
  }
  return z;
}

struct ModelCase {
  const char* robot;
  Names names;
};
std::string text_of(const ModelCase& c) {
  return std::string(c.robot) + " " + model_terms(c.names).text();
}

std::vector<ModelCase> model_cases() {
  std::vector<ModelCase> cases;
  const Names holonomic[] = {{"least_squares", "contact_offset"},
                             {"mean", "contact_offsets", "steering_zeros"},
                             {"least_squares", "contact_offsets", "steering_zeros", "lever_arm"},
                             {"contact_offset", "no_steering_rate", "time_offset"},
                             {"least_squares", "contact_offset", "time_offset:speeds"},
                             {"mean", "contact_offset", "time_offset"},
                             {"mount", "start_pose"},
                             {"heading_offset", "anchor"},
                             {"least_squares", "contact_offset", "time_offset=-0.02:speeds", "start_pose"},
                             {"fixed_layout", "contact_offset", "least_squares"},
                             {"layout_scale", "common_radius", "time_offset"}};
  for (const Names& names : holonomic) cases.push_back({"4wis4wid", names});
  for (const char* robot : {"differential", "tricycle", "omni3", "mecanum", "swerve"})
    for (const Names& names : {Names{"time_offset"}, Names{"mount", "time_offset:speeds"},
                               Names{"start_pose", "lever_arm"}, Names{"common_radius", "heading_offset"}})
      cases.push_back({robot, names});
  cases.push_back({"swerve", {"steering_rate", "time_offset"}});
  cases.push_back({"tricycle", {"contact_offsets", "time_offset"}});
  return cases;
}

class RicherModel : public ::testing::TestWithParam<ModelCase> {};

// Central differences of fourth order; every column to 1e-6 of its largest entry.
void expect_derivatives(const Problem& problem, const Vector& z) {
  const Eigen::Index m = problem.residual_count(), n = z.size();
  Vector r(m), alone(m);
  Matrix j(m, n);
  problem.residuals_and_jacobian(z, r, j);
  problem.residuals(z, alone);
  EXPECT_LT((r - alone).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_NEAR(problem.cost(z), r.squaredNorm(), 1e-12 * r.squaredNorm());
  const auto at = [&](Eigen::Index k, double h) {
    Vector y = z, out(m);
    y[k] += h;
    problem.residuals(y, out);
    return out;
  };
  for (Eigen::Index k = 0; k < n; ++k) {
    const ParameterInfo& p = problem.parameters()[static_cast<std::size_t>(k)];
    if (p.lower == p.upper) {
      EXPECT_EQ(j.col(k).norm(), 0) << p.name;
      continue;
    }
    const double h = 2e-4 * (p.upper - p.lower);
    const Vector slope = (8 * (at(k, h) - at(k, -h)) - (at(k, 2 * h) - at(k, -2 * h))) / (12 * h);
    EXPECT_LT((j.col(k) - slope).cwiseAbs().maxCoeff(), 1e-6 * slope.cwiseAbs().maxCoeff() + 1e-12) << p.name;
  }
  NormalEquations e;
  problem.normal_equations(z, e);
  EXPECT_NEAR(e.cost, r.squaredNorm(), 1e-12 * r.squaredNorm());
  EXPECT_LT((e.jtr - j.transpose() * r).norm(), 1e-10 * j.norm() * r.norm());
  EXPECT_LT((e.jtj - j.transpose() * j).norm(), 1e-10 * j.squaredNorm());
}

TEST_P(RicherModel, DerivativesAreThoseOfTheResiduals) {
  const Dataset set = small_set(GetParam().robot);
  const CalibrationOptions options = options_of(set.robot, GetParam().names);
  for (const InstructionSet kernel : available_instruction_sets()) {
    const Problem problem{CalibrationProblem(set.robot, set.recordings, options, kernel)};
    expect_derivatives(problem, a_point(problem.parameters()));
  }
}

TEST_P(RicherModel, ASetOfTheUserKeepsIt) {
  Dataset set = small_set(GetParam().robot);
  set.robot.model = GetParam().names;
  const auto json = robot_json(set.robot, 2);
  const Robot read = read_robot(JsonNode::parse(json.dump(), "set.json"), 2);
  EXPECT_EQ(read.model, GetParam().names);
  EXPECT_EQ(calibration_options(read).model, model_terms(GetParam().names));
  EXPECT_EQ(model_terms(model_terms(GetParam().names).names()), model_terms(GetParam().names));
}

INSTANTIATE_TEST_SUITE_P(Robots, RicherModel, ::testing::ValuesIn(model_cases()), [](const auto& one) {
  std::string name = text_of(one.param);
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
});

// Free starts: J is the least over explicit ones, which a mount-free recording has as x, y, heading.
TEST(FreeStart, IsTheMinimumOverStarts) {
  const Dataset set = small_set("4wis4wid");
  CalibrationOptions options = options_of(set.robot, {"least_squares", "contact_offset", "start_pose"});
  const CalibrationProblem eliminated(set.robot, set.recordings, options);
  options.model.start_pose = false;
  const Vector z = a_point(eliminated.parameters());
  Eigen::Index row = 0;
  Vector r(eliminated.residual_count());
  eliminated.residuals(z, r);
  for (std::size_t n = 0; n < set.recordings.size(); ++n) {
    const CalibrationProblem fixed(set.robot, {set.recordings[n]}, options);
    const Eigen::Vector3d shift = eliminated.extended()->start_shift(n, z);
    const PoseTrack track = fixed.integrate(0, z);
    const Reference& ref = set.recordings[n].reference;
    const auto cost_of = [&](const Eigen::Vector3d& s) {  // the whole path moved by hand
      double sum = 0;
      const double c = std::cos(s[2]), sn = std::sin(s[2]);
      for (std::size_t k = 1; k < track.x.size(); ++k) {
        const double dx = track.x[k] - track.x[0], dy = track.y[k] - track.y[0];
        sum += std::pow(track.x[0] + s[0] + c * dx - sn * dy - ref.x[k], 2) +
               std::pow(track.y[0] + s[1] + sn * dx + c * dy - ref.y[k], 2) +
               std::pow(track.theta[k] + s[2] - ref.theta[k], 2);
      }
      return sum;
    };
    const auto rows = 3 * static_cast<Eigen::Index>(track.x.size() - 1);
    const double least = r.segment(row, rows).squaredNorm();
    row += rows;
    EXPECT_NEAR(cost_of(shift), least, 1e-11 * least);
    for (int i = 0; i < 3; ++i)
      for (const double step : {-1e-4, 1e-4}) {
        Eigen::Vector3d moved = shift;
        moved[i] += step;
        EXPECT_GT(cost_of(moved), least);
      }
  }
}

TEST(Signals, AreReadEarlierAlongStraightLines) {
  Vector t(4), v(4), out, by;
  t << 0, 1, 3, 4;
  v << 0, 2, 2, 5;
  read_earlier(t, v, 0.5, out, by);  // at -0.5, 0.5, 2.5, 3.5
  EXPECT_EQ(out, (Vector(4) << 0, 1, 2, 3.5).finished());
  EXPECT_EQ(by, (Vector(4) << 0, -2, 0, -3).finished());
  read_earlier(t, v, -2, out, by);  // at 2, 3, 5, 6
  EXPECT_EQ(out, (Vector(4) << 2, 2, 5, 5).finished());
  EXPECT_EQ(by, (Vector(4) << 0, -1.5, 0, 0).finished());
}

TEST(ModelNames, WrongOnesAreRefused) {
  const auto expect = [](const Names& names, const char* part) {
    EXPECT_THAT([&] { model_terms(names); }, ThrowsMessage<std::invalid_argument>(HasSubstr(part)));
  };
  expect({"contact_ofset"}, "did you mean 'contact_offset'?");
  expect({"contact_offset", "contact_offsets"}, "contradict");
  expect({"contact_offset:-1"}, "found '-1', expected a number above 0");
  expect({"contact_offset=0.01"}, "only time_offset is held at a value");
  expect({"start_pose:3"}, "takes nothing behind a colon");
  expect({"time_offset=x"}, "found 'x', expected a number of seconds");
  expect({"time_offset=0.1:wheels"}, "expected ':speeds' or ':all'");
  expect({"speed_factor"}, "speed_factor:KIND");
  expect({"steering_zero"}, "steering_zero:N with the number of a wheel");
  expect({"mount", "mount"}, "named twice");
  expect({"mount", "lever_arm"}, "contradict");
}

TEST(ModelNames, WhatTheRobotHasNothingForIsRefused) {
  const auto expect = [](const char* robot, const Names& names, const char* part) {
    const Dataset set = small_set(robot);
    EXPECT_THAT([&] { CalibrationProblem(set.robot, set.recordings, options_of(set.robot, names)); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(part)));
  };
  expect("differential", {"steering_zeros"}, "the robot (differential) has no steered wheel");
  expect("differential", {"contact_offset"}, "has no steered wheel left or right of its middle");
  expect("differential", {"steering_rate"}, "has no steered wheel");
  expect("4wis4wid", {"steering_zero:5"}, "no steered wheel of this number");
  expect("swerve", {"steering_zeros"}, "is a parameter of the robot already");
  expect("differential", {"mean"}, "the mean is for wheels that are steered and driven");
  Dataset set = small_set("4wis4wid");
  CalibrationOptions options = options_of(set.robot, {"contact_offset"});
  options.cost = CostKind::Segments;
  EXPECT_THAT(
      [&] { CalibrationProblem(set.robot, set.recordings, options); },
      ThrowsMessage<std::invalid_argument>(HasSubstr("expected every_sample, final_pose or optiodom")));
}

// ---- the real recordings ----

nlohmann::json reference_file(const char* name) {
  std::ifstream file(testing::shared_folder() / "reference" / name);
  return nlohmann::json::parse(file);
}

// Names of the reference's models in those of this program.
Names names_of(const std::string& model) {
  Names names;
  std::string rest = model;
  const auto take = [&](const std::string& part, const Names& add) {
    const std::size_t at = ("_" + rest + "_").find("_" + part + "_");
    if (at == std::string::npos) return;
    names.insert(names.end(), add.begin(), add.end());
  };
  take("ls", {"least_squares"});
  take("r4", {"least_squares", "fixed_layout"});
  take("r1", {"least_squares", "fixed_layout", "common_radius"});
  take("mean", {"mean"});
  take("c1", {"contact_offset"});
  take("c4", {"contact_offsets"});
  take("e4", {"steering_zeros:0.035"});
  take("norate", {"no_steering_rate"});
  take("lever", {"lever_arm"});
  take("beta", {"heading_offset"});
  take("frame", {"lever_arm", "heading_offset"});
  take("start", {"start_pose"});
  take("anchor", {"anchor"});
  return names;
}

double value_of(const nlohmann::json& order, const nlohmann::json& values, std::string name,
                const ParameterInfo& p) {
  if (name == "offset") name = "c4";  // on the right, where it is +c
  if (name.rfind("offset", 0) == 0) name = "c" + name.substr(6);
  if (name.rfind("zero", 0) == 0) name = "e" + name.substr(4);
  if (name == "mount_x") name = "lx";
  if (name == "mount_y") name = "ly";
  if (name == "mount_yaw") name = "beta";
  if (name == "radius_factor") return values.at(8).get<double>() / 0.0254;
  if (p.lower == p.upper) return p.nominal;
  for (std::size_t i = 0; i < order.size(); ++i)
    if (order[i] == name) return values.at(i);
  throw std::out_of_range(name);
}

Vector at_reference(const CalibrationProblem& problem, const nlohmann::json& order,
                    const nlohmann::json& values) {
  Vector z(static_cast<Eigen::Index>(problem.parameters().size()));
  for (std::size_t i = 0; i < problem.parameters().size(); ++i)
    z[static_cast<Eigen::Index>(i)] =
        value_of(order, values, problem.parameters()[i].name, problem.parameters()[i]);
  return z;
}

CalibrationProblem real_problem(const Names& names) {
  const Dataset& set = testing::vitko_dataset();
  return CalibrationProblem(set.robot, set.recordings, options_of(set.robot, names));
}

double sum_of_errors(const CalibrationProblem& problem, const Vector& z) {
  double total = 0;
  for (const MaxErrors& e : problem.max_errors(z)) total += (e.x + e.y + e.theta) / 5;
  return total;
}

double optimum_from(const CalibrationProblem& problem, const Vector& start, Vector* z = nullptr) {
  const Problem handle(std::make_shared<const CalibrationProblem>(testing::vitko_dataset().robot,
                                                                  problem.recordings(), problem.options()));
  const Result result = solve(handle, {"lm", {}}, start, {});
  if (z != nullptr) *z = result.x;
  return result.cost;
}

TEST(RealModels, CostsAtFixedPoints) {
  ODOBENCH_NEEDS_SHARED();
  const nlohmann::json reference = reference_file("models_richer_vitko2024.json");
  int compared = 0;
  for (const auto& point : reference["points"])
    for (const auto& [name, cost] : point["J"].items()) {
      // Their twist is shifted in time, here the signals are: another number by 1e-5, see docs/models.md.
      if (name == "ls_tau" || name.find("_all_") != std::string::npos) continue;
      const CalibrationProblem problem = real_problem(names_of(name));
      const Vector z = at_reference(problem, point["order"], point["point"]);
      EXPECT_NEAR(problem.cost(z), cost.get<double>(), 1e-11 * cost.get<double>()) << name;
      EXPECT_NEAR(sum_of_errors(problem, z), point["e_sr"][name].get<double>(), 1e-9) << name;
      ++compared;
    }
  EXPECT_EQ(compared, 24);
}

// J and totals at the reference's optima, and our own optima from there and from nominal.
TEST(RealModels, Optima) {
  ODOBENCH_NEEDS_SHARED();
  const nlohmann::json reference = reference_file("models_richer_vitko2024.json");
  const nlohmann::json order = reference["points"][0]["order"];
  for (const auto& [name, model] : reference["models"].items()) {
    if (name == "ls_tau" || name == "ls_taun") continue;
    SCOPED_TRACE(name);
    const CalibrationProblem problem = real_problem(names_of(name));
    const Vector z = at_reference(problem, order, model["z25"]);
    const double cost = model["J"];
    EXPECT_NEAR(problem.cost(z), cost, 1e-8 * cost);
    if (name.find("anchor") == std::string::npos) {
      EXPECT_NEAR(sum_of_errors(problem, z), model["e_sr"]["sum"].get<double>(), 1e-8);
    }
    if (name.find("start") == std::string::npos) {
      EXPECT_LE(optimum_from(problem, z), cost * (1 + 1e-8));
      EXPECT_NEAR(optimum_from(problem, z), cost, 3e-6 * cost);
    }
  }
}

TEST(RealModels, LagOfTheWheelLogHeld) {
  ODOBENCH_NEEDS_SHARED();
  const nlohmann::json reference = reference_file("models_richer_vitko2024.json");
  for (const auto& row : reference["speed_lead"]) {
    Names names = names_of(row["model"]);
    names.push_back(row["steering_lead_s"] == 0.0 ? "time_offset=-0.058:speeds" : "time_offset=-0.058");
    SCOPED_TRACE(model_terms(names).text());
    const CalibrationProblem problem = real_problem(names);
    Vector z = Problem(std::make_shared<const CalibrationProblem>(real_problem(names))).start();
    const double cost = row["J"], found = optimum_from(problem, z, &z);
    EXPECT_NEAR(found, cost, 1e-7 * cost);
    EXPECT_NEAR(sum_of_errors(problem, z), row["e_sr"]["sum"].get<double>(), 1e-5);
  }
}

// Of the second evaluation, whose offsets end at +-20 mm.
TEST(RealModels, SecondEvaluation) {
  ODOBENCH_NEEDS_SHARED();
  const nlohmann::json models = reference_file("trust_vitko2024.json")["models"];
  const std::map<std::string, Names> names = {
      {"lsq", {"least_squares"}},
      {"lsq_c1", {"least_squares", "contact_offset:0.02"}},
      {"lsq_c1_norate", {"least_squares", "contact_offset:0.02", "no_steering_rate"}},
      {"lsq_c4_norate", {"least_squares", "contact_offsets:0.02", "no_steering_rate"}},
      {"thesis_start", {"mean", "start_pose"}},
      {"r4_A_c1", {"least_squares", "contact_offset:0.02", "layout_scale"}}};
  for (const auto& [name, list] : names) {
    SCOPED_TRACE(name);
    const CalibrationProblem problem = real_problem(list);
    const Vector start = Problem(std::make_shared<const CalibrationProblem>(real_problem(list))).start();
    const double cost = models[name]["J"];
    EXPECT_NEAR(optimum_from(problem, start), cost, 1e-7 * cost);
  }
}

}  // namespace
}  // namespace odobench
