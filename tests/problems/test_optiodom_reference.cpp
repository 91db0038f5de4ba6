// J of OptiOdom's recordings under four costs and three rules, its gradients and minima, sample rows and
// largest errors, against an independent evaluation.
#include <gtest/gtest.h>

#include <cmath>

#include "problems/calibration/calibration_problem.hpp"
#include "problems/calibration/classical/classical.hpp"
#include "problems/calibration/drive_errors.hpp"
#include "solvers/solve.hpp"
#include "tests/support/data/optiodom.hpp"

namespace odobench {
namespace {

using nlohmann::json;
using robots::IntegrationRule;
using testing::optiodom_reference;
using testing::optiodom_set;
using testing::our_parameters;
using testing::their_gradient;
using testing::their_parameters;
using testing::vector_of_json;

bool is_omni(const std::string& type) {
  return type == "omni3" || type == "omni4";
}
// The rule of the reference for a cost.
CalibrationOptions options_of(const std::string& type, const std::string& cost) {
  CalibrationOptions options;
  options.cost = cost_kind(cost);
  options.rule = cost != "optiodom" ? IntegrationRule::Arc
                 : is_omni(type)    ? IntegrationRule::OptiodomOmni
                                    : IntegrationRule::Midpoint;
  return options;
}

void expect_cost_and_gradient(const CalibrationProblem& problem, const std::string& type, const Vector& z,
                              const json& cost, const json& gradient, const std::string& what) {
  const Vector ours = our_parameters(type, z), expected = vector_of_json(gradient);
  const double j = cost.get<double>();
  EXPECT_NEAR(problem.cost(ours), j, 1e-10 * j) << what;
  NormalEquations e;
  problem.normal_equations(ours, e);
  EXPECT_NEAR(e.cost, j, 1e-10 * j) << what;
  const Vector found = their_gradient(type, 2 * e.jtr);
  EXPECT_LT((found - expected).norm(), 1e-9 * expected.norm()) << what;
}

TEST(OptiodomReference, CostsAndGradients) {
  ODOBENCH_NEEDS_OPTIODOM();
  EXPECT_EQ(optiodom_reference().size(), 19u);
  for (const auto& [folder, set] : optiodom_reference().items()) {
    const std::string type = set.at("type");
    const Dataset& data = optiodom_set(folder);
    for (const auto& [cost, expected] : set.at("problems").items()) {
      const std::string what = folder + " " + cost;
      const CalibrationProblem problem(data.robot, data.recordings, options_of(type, cost));
      EXPECT_EQ(problem.residual_count(), expected.at("residuals").get<Eigen::Index>()) << what;
      expect_cost_and_gradient(problem, type, vector_of_json(set.at("nominal")), expected.at("J_nominal"),
                               expected.at("gradient_nominal"), what);
      ASSERT_EQ(expected.at("points").size(), 3u);
      for (const json& point : expected.at("points"))
        expect_cost_and_gradient(problem, type, vector_of_json(point.at("z")), point.at("J"),
                                 point.at("gradient"), what + " at a point");
      if (cost != "every_sample") continue;
      ASSERT_EQ(expected.at("J_nominal_by_rule").size(), 3u);
      for (const auto& [rule, j] : expected.at("J_nominal_by_rule").items()) {
        CalibrationOptions options = options_of(type, cost);
        options.rule = robots::integration_rule(rule);
        const CalibrationProblem by_rule(data.robot, data.recordings, options);
        EXPECT_NEAR(by_rule.cost(our_parameters(type, vector_of_json(set.at("nominal")))), j.get<double>(),
                    1e-10 * j.get<double>())
            << what << " " << rule;
      }
    }
  }
}

TEST(OptiodomReference, SampleRowsAndFiles) {
  ODOBENCH_NEEDS_OPTIODOM();
  for (const auto& [folder, set] : optiodom_reference().items()) {
    const Dataset& data = optiodom_set(folder);
    const CalibrationProblem problem(data.robot, data.recordings, options_of(set.at("type"), "optiodom"));
    ASSERT_EQ(data.recordings.size(), set.at("files").size());
    for (std::size_t i = 0; i < data.recordings.size(); ++i) {
      std::vector<std::size_t> rows = problem.general()->rows(i);
      EXPECT_EQ(rows.front(), 0u);
      rows.erase(rows.begin());
      EXPECT_EQ(rows, set.at("sample_rows")[i].get<std::vector<std::size_t>>()) << data.recordings[i].id;
      EXPECT_EQ(data.recordings[i].size(), set.at("files")[i].at("rows").get<std::size_t>());
      const SourceFile& file =
          data.provenance.files.at(data.provenance.files.size() - data.recordings.size() + i);
      EXPECT_EQ(file.path, set.at("files")[i].at("name").get<std::string>());
      EXPECT_EQ(file.sha256, set.at("files")[i].at("sha256").get<std::string>());
    }
  }
}

TEST(OptiodomReference, OrderOfRunsAndFirstIncrementsDoNotMatter) {
  ODOBENCH_NEEDS_OPTIODOM();
  const Dataset& data = optiodom_set("omni3/square/221220201934");
  for (const std::string cost : {"optiodom", "segments"}) {
    const CalibrationOptions options = options_of("omni3", cost);
    const CalibrationProblem problem(data.robot, data.recordings, options);
    const Vector z = problem.general()->robot().nominal() * 1.01;
    std::vector<Recording> changed(data.recordings.rbegin(), data.recordings.rend());
    EXPECT_NEAR(CalibrationProblem(data.robot, changed, options).cost(z), problem.cost(z),
                1e-13 * problem.cost(z));
    changed = data.recordings;
    for (Recording& r : changed)
      for (Signal& signal : r.signals) signal.values[0] = 1e9;
    EXPECT_EQ(CalibrationProblem(data.robot, changed, options).cost(z), problem.cost(z));
    changed[0].signals[0].values[1] += 0.01;
    EXPECT_NE(CalibrationProblem(data.robot, changed, options).cost(z), problem.cost(z));
  }
}

// The reference's box: 20 % of lengths, 0.2 rad.
Robot in_wide_box(Robot robot) {
  for (RobotParameter& p : robot.parameters) {
    if (p.name == "roller") continue;
    const double box = p.unit == "m" ? 0.2 * p.nominal : 0.2;
    p.lower = p.nominal - box;
    p.upper = p.nominal + box;
  }
  return robot;
}

Vector minimum_by_lm(const Problem& problem, const Vector& start) {
  return solve(problem, {"lm", {}}, start, {}).x;
}

void expect_optimum(const std::string& folder, const std::string& cost, const Vector& start, Vector* end) {
  const json& set = optiodom_reference().at(folder);
  const std::string type = set.at("type"), what = folder + " " + cost;
  const json& optimum = set.at("problems").at(cost).at("optimum");
  const Dataset& data = optiodom_set(folder);
  const auto problem = std::make_shared<const CalibrationProblem>(in_wide_box(data.robot), data.recordings,
                                                                  options_of(type, cost));
  const Vector z = minimum_by_lm(Problem(problem), start.size() > 0 ? start : Problem(problem).start());
  if (end != nullptr) *end = z;
  const double j = optimum.at("J").get<double>();
  EXPECT_NEAR(problem->cost(z), j, 1e-9 * j + 1e-15) << what;
  Vector found = their_parameters(type, z), expected = vector_of_json(optimum.at("z"));
  if (type == "omni4") found.head(2).setConstant(found.head(2).mean());  // only the sum is known
  const json& deviation = optimum.at("relative_sd_percent");
  for (Eigen::Index i = 0; i < expected.size(); ++i) {
    // L1 and L2 of omni4 share one deviation.
    const auto d = static_cast<std::size_t>(type == "omni4" ? std::max<Eigen::Index>(i - 1, 0) : i);
    if (deviation[d].is_null() || deviation[d].get<double>() >= 10) continue;
    EXPECT_NEAR(found[i], expected[i], 1e-6 * std::max(std::abs(expected[i]), 0.1))
        << what << " parameter " << i;
  }
}

TEST(OptiodomReference, MinimaByLevenbergMarquardt) {
  ODOBENCH_NEEDS_OPTIODOM();
  for (const auto& [folder, set] : optiodom_reference().items()) {
    Vector segments;
    expect_optimum(folder, "segments", {}, &segments);
    expect_optimum(folder, "every_sample", {}, nullptr);
    expect_optimum(folder, "final_pose", {}, nullptr);
    // It has local minima: from where `segments` ends.
    expect_optimum(folder, "optiodom", segments, nullptr);
  }
}

// Largest errors over all rows and recordings, and at the ends: m, degrees.
struct Maxima {
  double position = 0, heading = 0, final_position = 0, final_heading = 0;
};
Maxima maxima_of(const CalibrationProblem& problem, const Vector& z) {
  Maxima m;
  for (std::size_t i = 0; i < problem.recordings().size(); ++i) {
    const DriveErrors e = drive_errors(problem.recordings()[i], problem.integrate(i, z));
    m.position = std::max(m.position, e.max_position);
    m.heading = std::max(m.heading, e.max_heading / kDegree);
    m.final_position = std::max(m.final_position, e.end_position);
    m.final_heading = std::max(m.final_heading, e.end_heading / kDegree);
  }
  return m;
}

void expect_table(const Maxima& found, const json& table, const std::string& what) {
  EXPECT_NEAR(found.position, table.at("max_position_m").get<double>(), 1e-9) << what;
  EXPECT_NEAR(found.heading, table.at("max_heading_deg").get<double>(), 1e-9) << what;
  EXPECT_NEAR(found.final_position, table.at("final_position_m").get<double>(), 1e-9) << what;
  EXPECT_NEAR(found.final_heading, table.at("final_heading_deg").get<double>(), 1e-9) << what;
}

TEST(OptiodomReference, LargestErrors) {
  ODOBENCH_NEEDS_OPTIODOM();
  for (const auto& [folder, set] : optiodom_reference().items()) {
    const std::string type = set.at("type");
    const Dataset& data = optiodom_set(folder);
    const CalibrationProblem problem(data.robot, data.recordings, options_of(type, "optiodom"));
    const CalibrationProblem exact(data.robot, data.recordings, options_of(type, "every_sample"));
    const json& optima = set.at("problems");
    const std::vector<std::pair<std::string, Vector>> cases = {
        {"nominal", vector_of_json(set.at("nominal"))},
        {"optimum_optiodom", vector_of_json(optima.at("optiodom").at("optimum").at("z"))},
        {"optimum_every_sample", vector_of_json(optima.at("every_sample").at("optimum").at("z"))},
        {"published_optiodom_parameters", vector_of_json(set.at("published").at("optiodom").at("z"))}};
    for (const auto& [name, z] : cases)
      expect_table(maxima_of(problem, our_parameters(type, z)), set.at("tables").at(name),
                   folder + " " + name);
    if (is_omni(type))
      expect_table(maxima_of(exact, our_parameters(type, cases[0].second)),
                   set.at("tables").at("nominal_exact_arc"), folder + " exact arc");
  }
}

// UMBmark's measure from the end errors, before and after.
TEST(OptiodomReference, CentresOfEndErrors) {
  ODOBENCH_NEEDS_OPTIODOM();
  int sets = 0;
  for (const auto& [folder, set] : optiodom_reference().items()) {
    if (!set.contains("umbmark_measure")) continue;
    ++sets;
    const Dataset& data = optiodom_set(folder);
    const CalibrationProblem problem(data.robot, data.recordings, options_of("diff", "optiodom"));
    const Vector nominal = our_parameters("diff", vector_of_json(set.at("nominal")));
    for (const auto& [name, expected] : set.at("umbmark_measure").items()) {
      const json& z =
          name == "nominal" ? set.at("nominal") : set.at("problems").at("optiodom").at("optimum").at("z");
      Eigen::Vector3d sums[2] = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
      double drives[2] = {0, 0};
      for (std::size_t i = 0; i < data.recordings.size(); ++i) {
        const int sense = sense_of(problem.integrate(i, nominal));
        ASSERT_NE(sense, 0) << folder;
        EXPECT_EQ(sense, i < data.recordings.size() / 2 ? -1 : 1) << folder << " run " << i;
        const PoseTrack track = problem.integrate(i, our_parameters("diff", vector_of_json(z)));
        sums[sense > 0 ? 1 : 0] += drive_errors(problem.recordings()[i], track).end;
        ++drives[sense > 0 ? 1 : 0];
      }
      const double cw = (sums[0] / drives[0]).head<2>().norm(), ccw = (sums[1] / drives[1]).head<2>().norm();
      EXPECT_NEAR(cw, expected.at("r_cw").get<double>(), 1e-9) << folder << " " << name;
      EXPECT_NEAR(ccw, expected.at("r_ccw").get<double>(), 1e-9) << folder << " " << name;
      EXPECT_NEAR(std::max(cw, ccw), expected.at("E_max_syst").get<double>(), 1e-9) << folder << " " << name;
    }
  }
  EXPECT_EQ(sets, 2);
}

// Lin's matrix as poses: the published cells, and J as the general form has it of the same poses.
TEST(OptiodomReference, PosesOfLinsMatrix) {
  ODOBENCH_NEEDS_OPTIODOM();
  int sets = 0;
  for (const auto& [folder, set] : optiodom_reference().items()) {
    if (!set.at("classical").contains("lin")) continue;
    ++sets;
    const Dataset& data = optiodom_set(folder);
    const classical::Result lin = classical::method("lin").run(data.robot, data.recordings, {});
    const std::vector<Matrix> tracks =
        classical::tracks_by_matrix(lin.matrix, data.robot, data.recordings, IntegrationRule::OptiodomOmni);
    Maxima m;
    for (std::size_t i = 0; i < tracks.size(); ++i) {
      const auto row = [&](Eigen::Index r) {
        const Vector values = tracks[i].row(r).transpose();
        return std::vector<double>(values.begin(), values.end());
      };
      const DriveErrors e = drive_errors(data.recordings[i], {row(0), row(1), row(2)});
      m.position = std::max(m.position, e.max_position);
      m.heading = std::max(m.heading, e.max_heading / kDegree);
      m.final_position = std::max(m.final_position, e.end_position);
      m.final_heading = std::max(m.final_heading, e.end_heading / kDegree);
    }
    expect_table(m, set.at("classical").at("lin").at("table"), folder + " lin");
  }
  EXPECT_EQ(sets, 7);
}

// J of poses is J of the parameters that they are made of, for every cost.
TEST(OptiodomReference, CostOfTracks) {
  ODOBENCH_NEEDS_OPTIODOM();
  for (const std::string folder : {"diff/free/030120210006", "omni3/joystick/221220202228"}) {
    const std::string type = folder.substr(0, folder.find('/'));
    const Dataset& data = optiodom_set(folder);
    for (const std::string cost : {"every_sample", "final_pose", "segments", "optiodom"}) {
      CalibrationOptions options = options_of(type, cost);
      options.position_weight = 3;
      options.heading_weight = 0.25;
      const CalibrationProblem problem(data.robot, data.recordings, options);
      const Vector z =
          1.02 * our_parameters(type, vector_of_json(optiodom_reference().at(folder).at("nominal")));
      std::vector<PoseTrack> tracks;
      for (std::size_t i = 0; i < data.recordings.size(); ++i) tracks.push_back(problem.integrate(i, z));
      EXPECT_NEAR(cost_of_tracks(problem, tracks), problem.cost(z), 1e-10 * problem.cost(z))
          << folder << " " << cost;
    }
  }
}

}  // namespace
}  // namespace odobench
