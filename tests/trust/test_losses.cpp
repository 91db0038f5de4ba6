// Robust losses of a calibration: values, derivatives, reference costs and optima, every class of solvers.
#include "problems/calibration/losses/loss.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "problems/calibration/recording_costs.hpp"
#include "problems/simulation/demo_generator.hpp"
#include "problems/simulation/robot_demo.hpp"
#include "problems/trust/error_scales.hpp"
#include "problems/trust/weighted_down.hpp"
#include "solvers/solve.hpp"
#include "tests/support/data/corrupted_drives.hpp"
#include "tests/support/data/vitko_problem.hpp"

namespace odobench {
namespace {

using nlohmann::json;
using testing::vitko_dataset;

const json& reference() {
  static const json all = json::parse(
      std::ifstream(testing::shared_folder() / "reference" / "models_richer_vitko2024.json"))["robust"];
  return all;
}

// "sample_huber", "recording_tukey", "weighted", "segment_5s" as the reference calls them.
CalibrationOptions options_of(const std::string& name) {
  const json& constants = reference()["constants"];
  CalibrationOptions options;
  options.from_origin = true;
  const double sp = constants["sp"], st = constants["st"];
  if (name == "weighted") {
    options.position_weight = 1 / (sp * sp);
    options.heading_weight = 1 / (st * st);
  } else if (name.starts_with("segment_")) {
    options.cost = CostKind::Segments;
    const double piece = std::stod(name.substr(8));
    (name.ends_with("s") ? options.piece_seconds : options.piece_metres) = piece;
  } else if (name != "squared") {
    const bool sample = name.starts_with("sample_");
    const std::string kind = name.substr(name.find('_') + 1);
    options.loss = parse_loss(kind + (sample ? ":sample" : ":recording"));
    EXPECT_EQ(options.loss.tuning,
              constants[sample ? "delta_sample" : "delta_recording"][kind].get<double>());
    options.loss.position_scale = sample ? sp : constants["sigma_recording"].get<double>();
    options.loss.heading_scale = st;
  }
  return options;
}

Vector vector_of(const json& values) {
  Vector z(static_cast<Eigen::Index>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i) z[static_cast<Eigen::Index>(i)] = values[i];
  return z;
}

std::vector<Recording> corrupted(const std::string& corruption) {
  std::vector<Recording> recordings = vitko_dataset().recordings;
  testing::corrupt(recordings, corruption);
  return recordings;
}

CalibrationProblem problem_of(const std::string& corruption, const CalibrationOptions& options) {
  return CalibrationProblem(vitko_dataset().robot, corrupted(corruption), options);
}

TEST(Losses, CostsOfEveryLossAndCorruptionAsInTheReference) {
  ODOBENCH_NEEDS_SHARED();
  int compared = 0;
  for (const auto& [corruption, losses] : reference()["cost"].items())
    for (const auto& [loss, values] : losses.items()) {
      const CalibrationProblem problem = problem_of(corruption, options_of(loss));
      for (const auto& [point, expected] : values.items()) {
        const double cost = problem.cost(vector_of(reference()["points"][point]));
        EXPECT_NEAR(cost / expected.get<double>(), 1, 1e-8) << corruption << " " << loss << " " << point;
        ++compared;
      }
    }
  EXPECT_EQ(compared, 7 * 11 * 3);
}

// e_sr: sum over trajectories and x, y, theta of the mean largest error, without what corruptions touch.
double total_of_untouched(const CalibrationProblem& clean, const Vector& z) {
  std::map<std::string, std::pair<double, int>> sums;
  for (const MaxErrors& e : clean.max_errors(z)) {
    if (testing::touched_by_corruptions(e.recording)) continue;
    sums[e.trajectory].first += e.x + e.y + e.theta;
    ++sums[e.trajectory].second;
  }
  double total = 0;
  for (const auto& [trajectory, sum] : sums) total += sum.first / sum.second;
  return total;
}

Result solved(const CalibrationProblem& problem, const std::string& solver, const Vector& start,
              std::int64_t evaluations = 0) {
  const Problem handle(std::shared_ptr<const CalibrationProblem>(&problem, [](const auto*) {}));
  SolveOptions options;
  if (evaluations > 0) options.budget.max_evaluations = evaluations;
  options.seed = 3;
  return solve(handle, {solver, {}}, start.size() > 0 ? start : handle.start(), options);
}

TEST(Losses, OptimaAsInTheReference) {
  ODOBENCH_NEEDS_SHARED();
  const CalibrationProblem clean(vitko_dataset().robot, vitko_dataset().recordings, options_of("squared"));
  std::map<std::string, Vector> squares;
  for (const auto& [name, expected] : reference()["optima"].items()) {
    const std::size_t colon = name.find(':');
    const std::string corruption = name.substr(0, colon), loss = name.substr(colon + 1);
    if (squares.count(corruption) == 0)
      squares[corruption] = solved(problem_of(corruption, options_of("squared")), "lm", {}).x;
    Vector start = squares[corruption];
    if (loss.ends_with("tukey")) {
      const std::string cauchy = loss.substr(0, loss.find('_')) + "_cauchy";
      start = solved(problem_of(corruption, options_of(cauchy)), "lm", start).x;
    }
    const Result found = solved(problem_of(corruption, options_of(loss)), "lm", start);
    EXPECT_EQ(found.termination, Termination::Converged) << name << ": " << found.message;
    EXPECT_NEAR(found.cost / expected["cost"].get<double>(), 1, 1e-8) << name;
    EXPECT_NEAR(total_of_untouched(clean, found.x), expected["e_sr_26_untouched"]["sum"].get<double>(), 2e-5)
        << name;
  }
}

TEST(Losses, ScalesAtTheSquaredOptimumOfTheReference) {
  ODOBENCH_NEEDS_SHARED();
  const CalibrationProblem clean(vitko_dataset().robot, vitko_dataset().recordings, options_of("squared"));
  const Vector z = vector_of(reference()["optima"]["clean:squared"]["parameters"]);
  const ErrorScales scales = error_scales(clean, z);
  EXPECT_NEAR(scales.position, 3.6e-3, 0.05e-3);
  EXPECT_NEAR(scales.heading, 13.3e-3, 0.05e-3);
  CalibrationOptions weighted = options_of("weighted");
  const CalibrationProblem same(vitko_dataset().robot, vitko_dataset().recordings, weighted);
  EXPECT_NEAR(error_scales(same, z).position, scales.position, 1e-12);  // whatever the weights of J
  EXPECT_NEAR(error_scales(same, z).heading, scales.heading, 1e-12);
}

TEST(Losses, ValuesAndTheirDerivatives) {
  for (const char* name : {"huber=1.3", "cauchy=2", "tukey=4"}) {
    const Loss loss = parse_loss(name);
    for (const double s : {1e-9, 0.3, 1.5, 3.9, 15.0, 17.0, 1e4}) {
      const LossValue at = loss.at(s);
      const double h = 1e-5 * s;
      EXPECT_NEAR(at.weight, (loss.at(s + h).rho - loss.at(s - h).rho) / (2 * h), 1e-6) << name << s;
      EXPECT_NEAR(at.slope * s, (loss.at(s + h).factor - loss.at(s - h).factor) / (2 * h) * s, 1e-6) << name;
      EXPECT_NEAR(at.factor * at.factor * s, at.rho, 1e-12 * at.rho) << name;
    }
    EXPECT_EQ(loss.at(0).rho, 0);
    EXPECT_NEAR(loss.at(1e-6).rho, 1e-6, 1e-12);
  }
  EXPECT_DOUBLE_EQ(parse_loss("huber=2").at(9).rho, 2 * 2 * 3 - 4);
  EXPECT_DOUBLE_EQ(parse_loss("cauchy=2").at(12).rho, 4 * std::log(4.0));
  EXPECT_DOUBLE_EQ(parse_loss("tukey=3").at(100).rho, 3);
  EXPECT_DOUBLE_EQ(parse_loss("tukey=3").at(4.5).rho, 3 * (1 - 0.125));
}

struct Case {
  const char *robot, *loss;
  CostKind cost;
  std::vector<std::string> model = {};
};

class RobustProblem : public ::testing::TestWithParam<Case> {
 protected:
  RobustProblem()
      : set_(std::string(GetParam().robot) == "4wis4wid" ? make_demo_dataset()
                                                         : make_robot_demo(GetParam().robot, 1)) {
    set_.recordings.resize(4);
    options_.rule = set_.robot.rule;
    options_.from_origin = set_.robot.kinematics == "4wis4wid";
    options_.cost = GetParam().cost;
    options_.model = model_terms(GetParam().model);
    options_.mount = options_.model.mount;
    squares_ = std::make_unique<CalibrationProblem>(set_.robot, set_.recordings, options_);
    options_.loss = parse_loss(GetParam().loss);
    const Vector start = point();
    // Scales so that some errors are beyond the tuning constant and some are not.
    const ErrorScales scales = error_scales(*squares_, start);
    options_.loss.position_scale =
        0.5 *
        (options_.loss.scope == LossScope::Sample ? scales.position : recording_scale(*squares_, start));
    options_.loss.heading_scale = scales.heading > 0 ? 0.5 * scales.heading : 1;
    problem_ = std::make_unique<CalibrationProblem>(set_.robot, set_.recordings, options_);
  }
  Vector point() const {
    const auto& parameters = squares_->parameters();
    Vector z(static_cast<Eigen::Index>(parameters.size()));
    for (Eigen::Index i = 0; i < z.size(); ++i) {
      const ParameterInfo& p = parameters[static_cast<std::size_t>(i)];
      z[i] = p.nominal + 0.3 * (p.upper - p.lower) * std::sin(1.0 + static_cast<double>(i));
    }
    return z;
  }
  Dataset set_;
  CalibrationOptions options_;
  std::unique_ptr<CalibrationProblem> squares_, problem_;
};

TEST_P(RobustProblem, ResidualsJacobianAndNormalEquationsAgree) {
  const Vector z = point();
  const Eigen::Index m = problem_->residual_count(), n = z.size();
  ASSERT_EQ(m, squares_->residual_count());
  Vector r(m), alone(m);
  Matrix j(m, n);
  problem_->residuals_and_jacobian(z, r, j);
  problem_->residuals(z, alone);
  const double cost = problem_->cost(z);
  EXPECT_GT(cost, 0);
  EXPECT_NEAR(r.squaredNorm(), cost, 1e-10 * cost);
  EXPECT_NEAR(alone.squaredNorm(), cost, 1e-12 * cost);
  NormalEquations e;
  problem_->normal_equations(z, e);
  EXPECT_NEAR(e.cost, cost, 1e-10 * cost);
  EXPECT_LT((e.jtr - j.transpose() * r).norm(), 1e-9 * e.jtr.norm());
  EXPECT_LT((e.jtj - j.transpose() * j).norm(), 1e-9 * e.jtj.norm());
  for (Eigen::Index i = 0; i < n; ++i) {
    const ParameterInfo& p = problem_->parameters()[static_cast<std::size_t>(i)];
    const double h = 1e-5 * (p.upper - p.lower);
    Vector up = z, down = z, a(m), b(m);
    up[i] += h;
    down[i] -= h;
    problem_->residuals(up, a);
    problem_->residuals(down, b);
    EXPECT_LT(((a - b) / (2 * h) - j.col(i)).norm(), 2e-5 * std::max(j.col(i).norm(), 1e-6 * j.norm())) << i;
    EXPECT_NEAR((problem_->cost(up) - problem_->cost(down)) / (2 * h), 2 * e.jtr[i],
                1e-5 * std::max(2 * std::abs(e.jtr[i]), 1e-3 * e.jtr.norm()))
        << i;
  }
  Matrix candidates(n, 2);
  candidates << z, 1.001 * z;
  Vector costs(2);
  problem_->batch_cost(candidates, costs);
  EXPECT_NEAR(costs[0], cost, 1e-12 * cost);
  EXPECT_NEAR(costs[1], problem_->cost(1.001 * z), 1e-12 * costs[1]);
}

TEST_P(RobustProblem, IsTheSumOfItsRecordings) {
  const RecordingCosts each(set_.robot, set_.recordings, options_);
  const Vector z = point();
  EXPECT_NEAR(each.costs(z).sum(), problem_->cost(z), 1e-11 * problem_->cost(z));
}

TEST_P(RobustProblem, AConstantOutOfReachGivesLeastSquares) {
  CalibrationOptions wide = options_;
  wide.loss.tuning = 1e6;
  wide.loss.position_scale = wide.loss.heading_scale = 1;
  const CalibrationProblem problem(set_.robot, set_.recordings, wide);
  const Vector z = point();
  EXPECT_NEAR(problem.cost(z), squares_->cost(z), 1e-8 * squares_->cost(z));
  EXPECT_GT(std::abs(problem_->cost(z) / squares_->cost(z) - 1), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(
    Losses, RobustProblem,
    ::testing::Values(Case{"4wis4wid", "cauchy", CostKind::EverySample},
                      Case{"4wis4wid", "huber:recording", CostKind::EverySample},
                      Case{"4wis4wid", "tukey", CostKind::Segments},
                      Case{"differential", "cauchy:recording", CostKind::EverySample},
                      Case{"differential", "huber", CostKind::Optiodom},
                      Case{"mecanum", "tukey=8:recording", CostKind::Segments},
                      Case{"4wis4wid", "cauchy", CostKind::EverySample, {"least_squares", "contact_offset"}},
                      Case{"4wis4wid", "tukey", CostKind::EverySample, {"steering_zeros", "lever_arm"}},
                      Case{"4wis4wid", "huber:recording", CostKind::EverySample, {"contact_offsets"}}));

// Each class of methods calls another part of the interface.
TEST(Losses, EveryClassOfSolversTakesThem) {
  Dataset set = make_demo_dataset();
  set.recordings.resize(3);
  CalibrationOptions options;
  options.from_origin = true;
  for (const char* loss : {"cauchy", "cauchy:recording"}) {
    options.loss = parse_loss(loss);
    options.loss.position_scale = options.loss.heading_scale = 0.01;
    const CalibrationProblem problem(set.robot, set.recordings, options);
    const Result best = solved(problem, "lm", {});
    EXPECT_EQ(best.termination, Termination::Converged) << best.message;
    const double before =
        problem.cost(Problem(CalibrationProblem(set.robot, set.recordings, options)).start());
    for (const char* solver : {"ip", "pso", "ga", "cmaes", "nlopt:bobyqa", "multistart"}) {
      const Result result = solved(problem, solver, {}, 300);
      ASSERT_TRUE(result.usable()) << solver << ": " << result.message;
      EXPECT_LT(result.cost, before) << solver;
      EXPECT_GE(result.cost, best.cost * (1 - 1e-9)) << solver;
      EXPECT_NEAR(result.cost, problem.cost(result.x), 1e-12 * result.cost) << solver;
    }
  }
}

TEST(Losses, SaysWhatIsCountedForLess) {
  Dataset set = make_demo_dataset();
  CalibrationOptions options;
  options.from_origin = true;
  Recording& bad = set.recordings[1];
  for (std::size_t k = 100; k < 150; ++k) bad.reference.x[k] += 0.5;
  const CalibrationProblem squares(set.robot, set.recordings, options);
  options.loss = parse_loss("cauchy");
  options.loss.position_scale = options.loss.heading_scale = 0.01;
  const CalibrationProblem problem(set.robot, set.recordings, options);
  const Vector z = solved(problem, "lm", {}).x;
  const auto list = weighted_down(set.robot, problem, z);
  ASSERT_GE(list.size(), 4U);
  EXPECT_EQ(list[0].recording, 1U);
  EXPECT_FALSE(list[0].first.has_value());
  EXPECT_GE(list[0].ratio, list[1].ratio);
  EXPECT_GE(list[1].ratio, list[2].ratio);
  const auto stretch = std::find_if(list.begin() + 3, list.end(),
                                    [](const WeightedDown& w) { return w.recording == 1 && w.first; });
  ASSERT_NE(stretch, list.end());
  EXPECT_EQ(*stretch->first, 100U);
  EXPECT_EQ(*stretch->last, 149U);
  EXPECT_LT(stretch->weight, 0.1);
  EXPECT_TRUE(weighted_down(set.robot, squares, z).empty());
}

TEST(Losses, RefusesWhatIsNone) {
  for (const char* text : {"", "gauss", "cauchy=", "cauchy=x", "cauchy=-1", "cauchy=0", "cauchy=1e9",
                           "cauchy:drive", "squared=2", "squared:recording", "huber=1:", "huber=nan"})
    EXPECT_THROW(parse_loss(text), std::invalid_argument) << text;
  EXPECT_EQ(parse_loss("tukey=3:recording").name(), "tukey=3:recording");
  EXPECT_EQ(parse_loss("cauchy").name(), "cauchy=2.385");
  EXPECT_FALSE(parse_loss("squared").robust());
  const Dataset set = make_demo_dataset();
  CalibrationOptions options;
  options.loss = parse_loss("cauchy");  // without scales
  EXPECT_THROW(CalibrationProblem(set.robot, set.recordings, options), std::invalid_argument);
}

}  // namespace
}  // namespace odobench
