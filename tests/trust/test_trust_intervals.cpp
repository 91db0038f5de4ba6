// Covariances, degrees of freedom and intervals: given algebra, the real recordings, what must not change
// them, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <nlohmann/json.hpp>

#include "problems/simulation/demo_generator.hpp"
#include "problems/simulation/robot_demo.hpp"
#include "problems/trust/trust.hpp"
#include "solvers/solve.hpp"
#include "tests/support/data/report_records.hpp"
#include "tests/support/data/vitko_problem.hpp"

namespace odobench {
namespace {

using nlohmann::json;

Vector vector_of(const json& list) {
  Vector v(static_cast<Eigen::Index>(list.size()));
  for (Eigen::Index i = 0; i < v.size(); ++i) v[i] = list[static_cast<std::size_t>(i)].get<double>();
  return v;
}
Matrix matrix_of(const json& rows) {
  Matrix m(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(rows[0].size()));
  for (Eigen::Index i = 0; i < m.rows(); ++i)
    m.row(i) = vector_of(rows[static_cast<std::size_t>(i)]).transpose();
  return m;
}
void expect_near(const Matrix& found, const Matrix& expected, double tolerance, const std::string& what) {
  ASSERT_EQ(found.rows(), expected.rows()) << what;
  EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), tolerance * expected.cwiseAbs().maxCoeff()) << what;
}

// The cases of the independent evaluation, small enough to stand here: H_n, g_n, kinds and what follows
// from them.
struct Algebra {
  std::vector<Vector> g;
  std::vector<Matrix> h;
  std::vector<std::string> kinds;
};
Algebra algebra_of(const json& one) {
  Algebra a;
  for (const json& g : one["g"]) a.g.push_back(vector_of(g));
  for (const json& h : one["H"]) a.h.push_back(matrix_of(h));
  a.kinds = one["stratum"].get<std::vector<std::string>>();
  return a;
}

TEST(RecordingCovariances, AgreeWithTheGivenAlgebra) {
  ODOBENCH_NEEDS_SHARED();
  const json given = testing::reference_json("uncertainty_vitko2024.json")["algebra_cases"];
  for (const json& one : given) {
    const Algebra a = algebra_of(one);
    const RecordingCovariances c(a.g, a.h);
    expect_near(c.naive(one["J"], one["N"]), matrix_of(one["naive"]), 1e-10, "naive");
    expect_near(c.sandwich(), matrix_of(one["sandwich"]), 1e-10, "sandwich");
    expect_near(c.cr2(), matrix_of(one["CR2"]), 1e-10, "CR2");
    expect_near(c.cr3(), matrix_of(one["CR3"]), 1e-10, "CR3");
    expect_near(c.stratified(a.kinds), matrix_of(one["stratified"]), 1e-10, "stratified");
    for (Eigen::Index i = 0; i < a.g[0].size(); ++i) {
      const Vector unit = Vector::Unit(a.g[0].size(), i);
      const auto at = static_cast<std::size_t>(i);
      EXPECT_NEAR(c.df_cr2(unit), one["df_CR2"][at].get<double>(), 1e-9);
      EXPECT_NEAR(c.df_cr3(unit), one["df_CR3"][at].get<double>(), 1e-9);
      EXPECT_NEAR(t_quantile(c.df_cr3(unit)), one["t975"][at].get<double>(), 1e-8);
    }
    EXPECT_NEAR(c.leverages().maxCoeff(), one["largest_leverage"].get<double>(), 1e-10);
  }
}

// Two parameters, five recordings: the same by plain inverses and powers written out.
TEST(RecordingCovariances, AreWhatTheirDefinitionsSay) {
  Algebra a;
  for (int n = 0; n < 5; ++n) {
    Matrix j(3, 2);
    j << 1 + n, 0.2 * n, 0.5, 2 - 0.3 * n, -0.4, 0.1 + n * 0.2;
    a.h.push_back(j.transpose() * j);
    a.g.push_back(Eigen::Vector2d(std::sin(1.0 + n), std::cos(2.0 * n)));
    a.kinds.push_back(n % 2 == 0 ? "a" : "b");
  }
  Matrix h = Matrix::Zero(2, 2), sum = Matrix::Zero(2, 2), left = Matrix::Zero(2, 2);
  for (const Matrix& one : a.h) h += one;
  for (std::size_t n = 0; n < 5; ++n) {
    const Vector d = (h - a.h[n]).inverse() * a.g[n];
    sum += a.g[n] * a.g[n].transpose();
    left += 0.8 * d * d.transpose();
  }
  const RecordingCovariances c(a.g, a.h);
  expect_near(c.sandwich(), 1.25 * h.inverse() * sum * h.inverse(), 1e-12, "sandwich");
  expect_near(c.cr3(), left, 1e-12, "CR3");
  const Vector ga = a.g[0] + a.g[2] + a.g[4], gb = a.g[1] + a.g[3];
  const Matrix kinds = 2 * h.inverse() * (ga * ga.transpose() + gb * gb.transpose()) * h.inverse();
  expect_near(c.between_kinds(a.kinds), kinds, 1e-12, "between kinds");
  EXPECT_THROW(c.stratified({"a"}), std::invalid_argument);
  EXPECT_THROW(c.naive(1, 2), std::invalid_argument);
  EXPECT_THROW(RecordingCovariances({}, {}), std::invalid_argument);
}

TEST(RecordingCovariances, SayWhatNoRecordingTells) {
  // The sum of both parameters only.
  const Vector g = Eigen::Vector2d(1, 1);
  const Matrix h = Matrix::Ones(2, 2);
  const RecordingCovariances c({g, -g, 0.5 * g}, {h, 2 * h, h});
  EXPECT_TRUE(c.undetermined(Eigen::Vector2d(1, 0)));
  EXPECT_TRUE(c.undetermined(Eigen::Vector2d(1, 0.999)));
  EXPECT_FALSE(c.undetermined(Eigen::Vector2d(1, 1)));
}

CalibrationOptions thesis_options() {
  CalibrationOptions options;
  options.from_origin = true;
  return options;
}

const std::shared_ptr<const RecordingCosts>& vitko_costs() {
  static const auto costs = std::make_shared<const RecordingCosts>(
      testing::vitko_dataset().robot, testing::vitko_dataset().recordings, thesis_options());
  return costs;
}

TEST(TrustOfRealDrives, ScoresAndCovariancesAtTheGivenPoint) {
  ODOBENCH_NEEDS_SHARED();
  const json reference = testing::reference_json("uncertainty_vitko2024.json");
  const Vector z = vector_of(reference["optimum"]["z_m"]);
  const RecordingScores all = recording_scores(*vitko_costs(), z);
  EXPECT_EQ(all.recordings, reference["scores_relative"]["ids"].get<std::vector<std::string>>());
  EXPECT_EQ(all.residuals, 409227);
  EXPECT_NEAR(all.cost(), reference["optimum"]["J"].get<double>(), 1e-9 * all.cost());
  const Matrix g = matrix_of(reference["scores_relative"]["g"]);
  for (Eigen::Index n = 0; n < 30; ++n)
    EXPECT_LT((all.g[static_cast<std::size_t>(n)] - g.row(n).transpose()).cwiseAbs().maxCoeff(),
              1e-9 * g.cwiseAbs().maxCoeff());
  expect_near(all.information(), matrix_of(reference["JtJ_relative_all_12"]), 1e-9, "J'J");

  const RecordingScores free = restricted(all, {2, 3, 6, 8, 10, 11});
  const RecordingCovariances c(free.g, free.h);
  const auto deviations = [](const Matrix& m) { return Vector(100 * m.diagonal().cwiseSqrt()); };
  const json& sd = reference["free_set"]["sd_percent"];
  const double close = 1e-6;  // of scores that agree to 1e-9: the weakest direction takes three digits
  expect_near(deviations(c.naive(all.cost(), all.residuals)), vector_of(sd["naive"]), close, "naive");
  expect_near(deviations(c.sandwich()), vector_of(sd["sandwich"]), close, "sandwich");
  expect_near(deviations(c.cr2()), vector_of(sd["CR2"]), close, "CR2");
  expect_near(deviations(c.cr3()), vector_of(sd["CR3"]), close, "CR3");
  expect_near(deviations(c.stratified(free.kinds)), vector_of(sd["stratified"]), close, "stratified");
  expect_near(deviations(c.between_kinds(free.kinds)), vector_of(sd["sandwich_by_trajectory"]), close,
              "kinds");
  const json& intervals = reference["default_intervals"]["free_set"];
  for (Eigen::Index i = 0; i < 6; ++i)
    EXPECT_NEAR(c.df_cr3(Vector::Unit(6, i)), intervals["df"][static_cast<std::size_t>(i)].get<double>(),
                1e-5);
  EXPECT_NEAR(c.leverages().maxCoeff(), intervals["largest_leverage_recording"].get<double>(), 1e-7);
  expect_near(c.leverages(), vector_of(reference["free_set"]["leverage_per_recording"]), 1e-7, "leverage");

  const KindTest kinds = kind_test(all.g, all.h, all.kinds);
  const json& f = reference["default_intervals"]["all_12"]["kind_F"];
  for (std::size_t k = 0; k < 12; ++k)
    EXPECT_NEAR(kinds.all_f[k], f[k].get<double>(), 1e-4 * (1 + f[k].get<double>())) << k;
  EXPECT_EQ(kinds.df_between, 5);
  EXPECT_EQ(kinds.df_within, 24);
  EXPECT_TRUE(kinds.systematic);
  EXPECT_NEAR(std::log10(kinds.p), std::log10(1.992929776024118e-18), 1e-4);
}

void expect_six(const Trust& trust, const json& six, double tolerance) {
  ASSERT_EQ(trust.determined.size(), 6U);
  static const char* names[] = {"m11", "m13", "m23", "m31", "m32", "m33"};
  for (std::size_t k = 0; k < 6; ++k) {
    std::size_t at = 0;
    while (at < 6 && trust.determined[at].number.name != names[k]) ++at;
    ASSERT_LT(at, 6U) << names[k];
    const TwistNumber& number = trust.determined[at].number;
    const Interval& i = trust.determined[at].interval;
    ASSERT_EQ(i.refused, NoInterval::None) << names[k];
    const auto expect = [&](const char* key, double found) {
      if (!six.contains(key)) return;
      const double value = six[key][k].get<double>();
      EXPECT_NEAR(found, value, tolerance * std::abs(value)) << names[k] << " " << key;
    };
    expect("estimate", number.value);
    expect("sd", i.deviation);
    expect("nu", i.df);
    expect("half", i.half_width);
    expect("sd_same_drives", i.same_deviation);
    expect("half_same_drives", i.same_half_width);
  }
}

// By the curvature that the independent evaluation states. Its point and its curvature do not quite
// belong together:
// the curvature is that of a point some 2e-6 along the flattest direction, which is 2e-4 of the intervals.
TEST(TrustOfRealDrives, RecommendedIntervalsByTheGivenCurvature) {
  ODOBENCH_NEEDS_SHARED();
  const json reference = testing::reference_json("trust_vitko2024.json");
  const Vector z = vector_of(reference["uncertainty"]["p_mm"]) / 1000;
  const RecordingScores free = restricted(recording_scores(*vitko_costs(), z), {2, 3, 6, 8, 10, 11});
  const LeaveOneOut moves(free, matrix_of(reference["uncertainty"]["exact_half_hessian_free"]));
  const TwistMap map = twist_map(testing::vitko_dataset().robot, vitko_costs()->parameters(), z);
  Trust trust;
  for (const TwistNumber& number : map.numbers)
    trust.determined.push_back(
        {number, moves.interval(free.scale.cwiseProduct(Vector(number.gradient(free.parameters))))});
  expect_six(trust, reference["recommended_intervals"]["six"], 1e-8);
}

// The other independent evaluation states curvature and point together.
TEST(TrustOfRealDrives, ExactCurvature) {
  ODOBENCH_NEEDS_SHARED();
  const json reference = testing::reference_json("uncertainty_vitko2024.json");
  const Vector z = vector_of(reference["optimum"]["z_m"]);
  const Matrix found = exact_half_hessian(
      [](const Vector& at) {
        Vector sum = Vector::Zero(12);
        for (const NormalEquations& e : vitko_costs()->normal_equations(at)) sum += e.jtr;
        return sum;
      },
      recording_scores(*vitko_costs(), z), z);
  expect_near(found, matrix_of(reference["half_hessian_relative_all_12"]), 1e-11, "curvature");
}

TEST(TrustOfRealDrives, RecommendedIntervals) {
  ODOBENCH_NEEDS_SHARED();
  const json reference = testing::reference_json("trust_vitko2024.json");
  const Vector z = vector_of(reference["uncertainty"]["p_mm"]) / 1000;
  const Trust trust = assess_trust(*vitko_costs(), testing::vitko_dataset().robot, z);
  const json& wanted = reference["recommended_intervals"];
  expect_six(trust, wanted["six"], 5e-4);
  EXPECT_TRUE(trust.exact_hessian);
  EXPECT_TRUE(trust.map_linear);
  const Vector eigenvalues = vector_of(wanted["exact_hessian_eigenvalues"]);
  for (Eigen::Index i = 0; i < 6; ++i)
    EXPECT_NEAR(trust.hessian_eigenvalues[i], eigenvalues[i], 1e-5 * eigenvalues[i]);
  EXPECT_EQ(trust.active.size(), 6U);
  for (const ParameterInterval& p : trust.parameters) {
    EXPECT_EQ(p.interval.refused, NoInterval::BoundActive) << p.name;
    EXPECT_TRUE(std::isnan(p.interval.half_width)) << p.name;
    EXPECT_THAT(p.interval.reason, ::testing::HasSubstr("decided by the box"));
  }
  EXPECT_EQ(trust.sentences.back(), kWhatIntervalsHold);
  EXPECT_THAT(trust.sentences, ::testing::Contains(::testing::HasSubstr("F = 188")));
  EXPECT_THAT(trust.sentences[0], ::testing::HasSubstr("path +1.623 +- 0.077 %"));
}

TEST(TrustOfRealDrives, RecommendedIntervalsOfSomeRepetitions) {
  ODOBENCH_NEEDS_SHARED();
  const json all = testing::reference_json("trust_vitko2024.json")["recommended_intervals"];
  for (const bool first : {true, false}) {
    std::vector<Recording> some;
    for (const Recording& r : testing::vitko_dataset().recordings)
      if ((r.repetition <= 2) == first) some.push_back(r);
    const json& wanted = all[first ? "repetitions 1-2" : "repetitions 3-5"];
    const RecordingCosts costs(testing::vitko_dataset().robot, some, thesis_options());
    const Vector z = vector_of(wanted["p_mm"]) / 1000;
    EXPECT_NEAR(costs.costs(z).sum(), wanted["J"].get<double>(), 1e-9 * wanted["J"].get<double>());
    expect_six(assess_trust(costs, testing::vitko_dataset().robot, z), wanted, 5e-4);
  }
}

// Solved sets of demo robots.
struct Solved {
  Dataset set;
  CalibrationOptions options;
  std::unique_ptr<RecordingCosts> costs;
  Vector z;
};
Solved solved(Dataset set, const CalibrationOptions& given = {}) {
  Solved s{std::move(set), given, nullptr, {}};
  s.options.rule = s.set.robot.rule;
  s.options.from_origin = s.set.robot.kinematics == "4wis4wid";
  s.costs = std::make_unique<RecordingCosts>(s.set.robot, s.set.recordings, s.options);
  const Problem problem(std::make_shared<const CalibrationProblem>(s.set.robot, s.set.recordings, s.options));
  s.z = solve(problem, {"lm", {}}, problem.start(), {}).x;
  return s;
}
Trust trust_of(const Solved& s) {
  return assess_trust(*s.costs, s.set.robot, s.z);
}

void expect_same(const Trust& a, const Trust& b, double tolerance) {
  ASSERT_EQ(a.determined.size(), b.determined.size());
  for (std::size_t k = 0; k < a.determined.size(); ++k) {
    EXPECT_NEAR(a.determined[k].interval.half_width, b.determined[k].interval.half_width,
                tolerance * b.determined[k].interval.half_width)
        << a.determined[k].number.name;
    EXPECT_NEAR(a.determined[k].interval.df, b.determined[k].interval.df,
                tolerance * b.determined[k].interval.df);
  }
  for (std::size_t k = 0; k < a.parameters.size(); ++k) {
    EXPECT_EQ(a.parameters[k].interval.refused, b.parameters[k].interval.refused);
    if (a.parameters[k].interval.refused != NoInterval::None) continue;
    EXPECT_NEAR(a.parameters[k].interval.half_width, b.parameters[k].interval.half_width,
                tolerance * b.parameters[k].interval.half_width);
  }
}

TEST(Trust, WeightsOfTheCostChangeNoInterval) {
  const Solved plain = solved(make_robot_demo("differential", 1));
  CalibrationOptions heavy;
  heavy.position_weight = heavy.heading_weight = 400;
  const Solved weighted = solved(make_robot_demo("differential", 1), heavy);
  expect_same(trust_of(weighted), trust_of(plain), 1e-4);
  EXPECT_EQ(trust_of(plain).active.size(), 0U);
  EXPECT_EQ(trust_of(plain).parameters[0].interval.refused, NoInterval::None);
}

// Every sample twice, half a microsecond... as near as stamps allow: the same drives, sampled twice as
// densely.
Recording doubled(const Recording& r) {
  Recording twice = r;
  twice.time_us.clear();
  for (const std::int64_t t : r.time_us) {
    twice.time_us.push_back(t);
    twice.time_us.push_back(t + 1);
  }
  const auto repeat = [](std::vector<double>& values) {
    std::vector<double> out;
    for (const double v : values) out.insert(out.end(), {v, v});
    values = std::move(out);
  };
  for (Signal& s : twice.signals) repeat(s.values);
  repeat(twice.reference.x);
  repeat(twice.reference.y);
  repeat(twice.reference.theta);
  return twice;
}

TEST(Trust, SamplingTwiceAsDenselyChangesNextToNothing) {
  const Solved plain = solved(make_demo_dataset());
  Dataset dense = plain.set;
  for (Recording& r : dense.recordings) {
    ASSERT_TRUE(r.reference.sample.empty());
    r = doubled(r);
  }
  const Solved twice = solved(std::move(dense));
  expect_same(trust_of(twice), trust_of(plain), 0.01);
  // What takes samples for independent shrinks by the root of two.
  const RecordingScores a = recording_scores(*plain.costs, plain.z),
                        b = recording_scores(*twice.costs, twice.z);
  const double before = RecordingCovariances(a.g, a.h).naive(a.cost(), a.residuals)(8, 8);
  const double after = RecordingCovariances(b.g, b.h).naive(b.cost(), b.residuals)(8, 8);
  EXPECT_NEAR(std::sqrt(before / after), std::sqrt(2), 0.01);
}

TEST(Trust, RefusesWhatTooFewRecordingsTell) {
  Solved s = solved(make_robot_demo("differential", 1));
  for (const std::size_t count : {1U, 4U}) {
    Dataset few = s.set;
    few.recordings.resize(count);
    const Trust trust = trust_of(solved(std::move(few)));
    ASSERT_FALSE(trust.determined.empty());
    for (const DeterminedNumber& d : trust.determined) {
      EXPECT_EQ(d.interval.refused, count == 1 ? NoInterval::OneRecording : NoInterval::TooFewRecordings);
      EXPECT_TRUE(std::isnan(d.interval.half_width));
    }
    EXPECT_THAT(trust.sentences.back(), ::testing::HasSubstr("No intervals: "));
  }
  Dataset five = s.set;
  five.recordings.resize(5);
  const Trust enough = trust_of(solved(std::move(five)));
  EXPECT_NE(enough.determined[0].interval.refused, NoInterval::TooFewRecordings);
}

TEST(Trust, SaysWhichRecordingAloneTells) {
  // Parameter 1 is told by all, parameter 2 by the last alone.
  RecordingScores s;
  s.scale = Vector::Ones(2);
  s.parameters = {0, 1};
  s.costs = Vector::Ones(6);
  for (int n = 0; n < 6; ++n) {
    s.recordings.push_back("drive_" + std::to_string(n));
    s.kinds.push_back(n % 2 == 0 ? "a" : "b");
    s.g.push_back(Eigen::Vector2d(n % 2 == 0 ? 1 : -1, n == 5 ? 0.1 : 0));
    s.h.push_back(Eigen::Vector2d(1, n == 5 ? 4 : 0).asDiagonal());
  }
  const LeaveOneOut moves(s, Matrix());
  const Interval alone = moves.interval(Eigen::Vector2d(0, 1));
  EXPECT_EQ(alone.refused, NoInterval::OneRecordingTells);
  EXPECT_THAT(alone.reason, ::testing::HasSubstr("drive_5"));
  const Interval shared = moves.interval(Eigen::Vector2d(1, 0));
  EXPECT_EQ(shared.refused, NoInterval::None);
  // d_n = +-1/5, their mean 0: v = 5/6 * 6/25; six equal weights.
  EXPECT_NEAR(shared.deviation, std::sqrt(0.2), 1e-12);
  EXPECT_NEAR(shared.df, 6, 1e-12);
  EXPECT_NEAR(shared.half_width, t_quantile(6) * std::sqrt(0.2), 1e-12);
  EXPECT_NEAR(shared.same_deviation, 0, 1e-12) << "alike within each kind";
  EXPECT_NEAR(moves.interval(Eigen::Vector2d(1, 0), 2).deviation, std::sqrt(4.2), 1e-12);
  EXPECT_EQ(jackknife_interval(s, RecordingCovariances(s.g, s.h), Eigen::Vector2d(0, 1)).refused,
            NoInterval::OneRecordingTells);
  s.costs.setZero();
  EXPECT_EQ(LeaveOneOut(s, Matrix()).interval(Eigen::Vector2d(1, 0)).refused, NoInterval::NoNoise);
}

TEST(Trust, TellsCombinationsButNotWhatIsInThem) {
  const Trust trust = trust_of(solved(make_robot_demo("mecanum", 1)));
  for (const DeterminedNumber& d : trust.determined)
    EXPECT_EQ(d.interval.refused, NoInterval::None) << d.number.name << ": " << d.interval.reason;
  for (const ParameterInterval& p : trust.parameters) {
    if (p.name != "lx" && p.name != "ly") continue;
    EXPECT_THAT(p.interval.refused, ::testing::AnyOf(NoInterval::Undetermined, NoInterval::WiderThanBox,
                                                     NoInterval::BoundActive));
  }
}

}  // namespace
}  // namespace odobench
