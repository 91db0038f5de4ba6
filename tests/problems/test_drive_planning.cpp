// What a plan promises: the right rank and null directions of ideal drives, and standard deviations that
// calibrations of simulated drives keep.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "base/parallel.hpp"
#include "problems/information/drive_planning.hpp"
#include "problems/simulation/scenario_file.hpp"
#include "problems/simulation/simulated_set.hpp"
#include "reports/statistics/statistics.hpp"
#include "solvers/solve.hpp"
#include "tests/support/data/report_records.hpp"
#include "tests/support/data/vitko_problem.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench {
namespace {

using simulate::RecordingScenario;

RecordingScenario known(const std::string& name) {
  return simulate::read_scenario(JsonNode::read(source_dir() / "datasets" / "scenarios" / (name + ".json")));
}
Vector vector_of(const simulate::Parameters& z) {
  return Eigen::Map<const Vector>(z.data(), kCalibrationParameters);
}
std::vector<DriveInformation> informations(const RecordingScenario& s, int replicas, std::uint64_t seed) {
  std::vector<DriveInformation> list(s.drives.size());
  parallel_for(list.size(), 0, [&](std::size_t i) {
    std::vector<Recording> recordings;
    for (int k = 1; k <= replicas; ++k)
      recordings.push_back(simulate::simulate_drive(s, s.drives[i], k, seed).recording);
    list[i] =
        drive_information(s.drives[i].name, s.robot.parameters, recordings, vector_of(s.truth.parameters));
  });
  return list;
}
Vector calibrated(const Dataset& set) {
  const auto model = std::make_shared<const CalibrationProblem>(testing::parameters_of(set), set.recordings);
  const Problem problem(model);
  return solve(problem, parse_solver_list("lm").front(), problem.start(), {}).x;
}
std::vector<DriveInformation> ideal(const RecordingScenario& s) {
  std::vector<DriveInformation> list;
  for (const simulate::Drive& d : s.drives)
    list.push_back(ideal_information(d.name, s.robot.parameters, simulate::exact_recording(s, d),
                                     vector_of(s.truth.parameters), 1e-4));
  return list;
}

// The six ideal drives of the nominal robot show six combinations of twelve parameters.
TEST(DrivePlanning, IdealDrivesHaveRankSix) {
  RecordingScenario s = known("exact");
  s.truth.parameters = simulate::nominal_parameters(s.robot);
  const PlanAnalysis a = analyse_drives(ideal(s), std::vector<int>(6, 1), s.robot.parameters, 0.01);
  ASSERT_EQ(a.directions.size(), 12u);
  for (std::size_t k = 0; k < 12; ++k) EXPECT_EQ(a.directions[k].singular_value > 0, k < 6) << k;
  for (const double sd : a.standard_deviations) EXPECT_TRUE(std::isinf(sd));
  EXPECT_EQ(a.undetermined.cols(), 6);
  EXPECT_THAT(a.undetermined_words, ::testing::SizeIs(6));
}

// Its null space is that of the twist Jacobian: the basis given in the reference lies in it, and back.
TEST(DrivePlanning, NullDirectionsAreTheReferences) {
  ODOBENCH_NEEDS_SHARED();
  const nlohmann::json reference = testing::reference_json("identifiability.json");
  RecordingScenario s = known("exact");
  s.truth.parameters = simulate::nominal_parameters(s.robot);
  const PlanAnalysis a = analyse_drives(ideal(s), std::vector<int>(6, 1), s.robot.parameters, 0.01);
  Matrix seen(12, 6);
  for (Eigen::Index k = 0; k < 6; ++k) seen.col(k) = a.directions[static_cast<std::size_t>(k)].vector;
  for (const auto& row : reference.at("null_basis")) {
    Vector q(12);
    for (Eigen::Index i = 0; i < 12; ++i)
      q[i] = std::copysign(row[static_cast<std::size_t>(i)].get<double>(),
                           row[static_cast<std::size_t>(i)].get<double>() *
                               s.robot.parameters[static_cast<std::size_t>(i)].nominal);
    EXPECT_LT((seen.transpose() * q).norm(), 1e-4 * q.norm());
  }
}

TEST(DrivePlanning, WordsNameWhoGoesAgainstWhom) {
  std::vector<ParameterInfo> two = {{"a1", "m", 0.1, 0.05, 0.15}, {"a2", "m", -0.1, -0.15, -0.05}};
  Matrix normal(2, 2);
  normal << 1, 1, 1, 1;  // sees a1 / 0.1 + a2 / -0.1 only
  const std::vector<DriveInformation> drives = {{"d", normal, Vector::Zero(2), 1e-6 * normal}};
  const PlanAnalysis a = analyse_drives(drives, {1}, two, 0.01);
  // q1 up, q2 down: a2, whose nominal value is negative, grows in size as a1 does.
  EXPECT_THAT(a.undetermined_words, ::testing::ElementsAre("a1, a2 together"));
  two[1] = {"a2", "m", 0.1, 0.05, 0.15};
  EXPECT_THAT(analyse_drives(drives, {1}, two, 0.01).undetermined_words,
              ::testing::ElementsAre("a1 against a2"));
  normal << 1, 0, 0, 0;
  const std::vector<DriveInformation> alone = {{"d", normal, Vector::Zero(2), 1e-6 * normal}};
  const PlanAnalysis b = analyse_drives(alone, {1}, two, 0.01);
  EXPECT_THAT(b.undetermined_words, ::testing::ElementsAre("a2 alone"));
  EXPECT_NEAR(b.standard_deviations[0], 1e-3, 1e-12);
  EXPECT_TRUE(std::isinf(b.standard_deviations[1]));
}

// White noise averages, a bias does not.
TEST(DrivePlanning, RepetitionHelpsAgainstNoiseOnly) {
  const std::vector<ParameterInfo> one = {{"r1", "m", 1, 0.5, 1.5}};
  const Matrix unit = Matrix::Identity(1, 1);
  const std::vector<DriveInformation> noisy = {{"d", unit, Vector::Zero(1), 1e-4 * unit}};
  const std::vector<DriveInformation> biased = {{"d", unit, Vector::Constant(1, 1e-2), 0 * unit}};
  EXPECT_NEAR(analyse_drives(noisy, {1}, one, 1).standard_deviations[0], 1e-2, 1e-12);
  EXPECT_NEAR(analyse_drives(noisy, {4}, one, 1).standard_deviations[0], 5e-3, 1e-12);
  EXPECT_NEAR(analyse_drives(biased, {4}, one, 1).standard_deviations[0], 1e-2, 1e-12);
}

TEST(DrivePlanning, ProposesWhatIsMissing) {
  const std::vector<ParameterInfo> two = {{"a1", "m", 1, 0.9, 1.1}, {"a2", "m", 1, 0.9, 1.1}};
  Matrix first = Matrix::Zero(2, 2), second = first;
  first(0, 0) = second(1, 1) = 1;
  const std::vector<DriveInformation> drives = {{"sees a1", first, Vector::Zero(2), 1e-4 * first},
                                                {"sees a2", second, Vector::Zero(2), 1e-4 * second}};
  const std::vector<Proposal> list = propose_drives(drives, {4, 0}, {}, two, 0.0051, 20);
  ASSERT_EQ(list.size(), 4u);  // a1 is known well enough already
  for (const Proposal& p : list) EXPECT_EQ(p.drive, 1u);
  EXPECT_LE(list.back().largest_deviation, 0.0051);
  EXPECT_GT(list[2].largest_deviation, 0.0051);
  EXPECT_EQ(propose_drives(drives, {4, 4}, {}, two, 0.0051, 20).size(), 0u);
  EXPECT_EQ(propose_drives(drives, {0, 0}, {}, two, 1e-5, 7).size(), 7u);  // gives up
  const DriveInformation fixed{"", Matrix::Identity(2, 2) * 100, Vector::Zero(2),
                               Matrix::Identity(2, 2) * 1e-2};
  EXPECT_EQ(propose_drives(drives, {0, 0}, fixed, two, 0.0051, 20).size(), 0u);
}

TEST(DrivePlanning, RefusesWhatDoesNotFit) {
  const RecordingScenario s = known("exact");
  EXPECT_THROW(drive_information("d", s.robot.parameters, {}, vector_of(s.truth.parameters)),
               std::invalid_argument);
  EXPECT_THROW(analyse_drives(ideal(s), {1, 2}, s.robot.parameters, 0.01), std::invalid_argument);
}

// ODOBENCH_SEEDS sets how many data sets are calibrated; 100 for the figure in docs/simulation.md.
int seeds() {
  const char* text = std::getenv("ODOBENCH_SEEDS");
  return text != nullptr ? std::atoi(text) : 6;
}

double total_error(const Dataset& set, const Vector& z) {
  const CalibrationProblem problem(testing::parameters_of(set), set.recordings);
  std::vector<RecordingError> errors;
  for (const MaxErrors& e : problem.max_errors(z))
    errors.push_back({e.recording, e.trajectory, e.repetition, {e.x, e.y, e.theta}});
  return error_totals(error_statistics(errors)).total;
}

TEST(DrivePlanning, DeterminedParametersComeBack) {
  const RecordingScenario s = known("rich");
  const std::vector<int> counts(s.drives.size(), s.repetitions);
  const PlanAnalysis plan = analyse_drives(informations(s, 40, 99), counts, s.robot.parameters, 0.005);
  std::vector<Eigen::Index> determined;
  for (Eigen::Index i = 0; i < 12; ++i)
    if (plan.standard_deviations[i] <= 0.005) determined.push_back(i);
  ASSERT_GE(determined.size(), 6u);
  int good = 0;
  double sum = 0;
  for (int seed = 1; seed <= seeds(); ++seed) {
    const Vector z = calibrated(simulate::simulate_set(s, static_cast<std::uint64_t>(seed)).dataset);
    bool inside = true;
    for (const Eigen::Index i : determined) {
      const double off = (z[i] - s.truth.parameters[static_cast<std::size_t>(i)]) /
                         std::abs(s.robot.parameters[static_cast<std::size_t>(i)].nominal);
      sum += std::pow(off / plan.standard_deviations[i], 2);
      inside = inside && std::abs(off) <= 3 * plan.standard_deviations[i];
    }
    good += inside;
  }
  const double ratio = std::sqrt(sum / (static_cast<double>(determined.size()) * seeds()));
  std::printf("%d of %d seeds within 3 standard deviations, %zu parameters, rms ratio %.2f\n", good, seeds(),
              determined.size(), ratio);
  EXPECT_GE(good, static_cast<int>(std::ceil(0.95 * seeds() - 1e-9)) - (seeds() < 20 ? 1 : 0));
  EXPECT_GT(ratio, 0.3) << "the plan is too pessimistic to be of use";
  EXPECT_LT(ratio, 1.5);
}

// A calibration predicts new drives as well as the truth does.
TEST(DrivePlanning, CalibrationsPredictFreshDrives) {
  for (const std::string name : {"vitko2024", "off_nominal"}) {
    const RecordingScenario s = known(name);
    const int count = std::min(seeds(), 10);
    double found = 0, truth = 0;
    for (int seed = 1; seed <= count; ++seed) {
      const Vector z = calibrated(simulate::simulate_set(s, static_cast<std::uint64_t>(seed)).dataset);
      const Dataset fresh = simulate::simulate_set(s, static_cast<std::uint64_t>(1000 + seed)).dataset;
      found += total_error(fresh, z) / count;
      truth += total_error(fresh, vector_of(s.truth.parameters)) / count;
    }
    std::printf("%s: total error on fresh drives %.6f, of the truth %.6f\n", name.c_str(), found, truth);
    EXPECT_LT(found, 1.1 * truth) << name;
  }
}

}  // namespace
}  // namespace odobench
