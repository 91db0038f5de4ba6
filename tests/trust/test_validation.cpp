// Validation folds and bootstrap replicates against independent figures, and what they must not depend on.
#include "bench/studies/trust/validation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "bench/studies/trust/bootstrap.hpp"
#include "bench/studies/trust/held_out_prediction.hpp"
#include "bench/studies/trust/replicate_file.hpp"
#include "problems/simulation/robot_demo.hpp"
#include "reports/kinds/trust/bootstrap_record.hpp"
#include "reports/kinds/trust/validation_sentences.hpp"
#include "tests/support/data/vitko_problem.hpp"
#include "tests/support/run_process.hpp"

namespace odobench {
namespace {
using testing::vitko_dataset;

nlohmann::json reference(const char* name) {
  return nlohmann::json::parse(std::ifstream(testing::shared_folder() / "reference" / name));
}

CalibrationOptions as_in_thesis() {
  CalibrationOptions options;
  options.from_origin = true;
  return options;
}

std::shared_ptr<const RecordingCosts> vitko_costs() {
  static const auto costs = std::make_shared<const RecordingCosts>(
      vitko_dataset().robot, vitko_dataset().recordings, as_in_thesis());
  return costs;
}

std::vector<FoldPlan> both_questions(const std::vector<DriveName>& drives) {
  return {leave_one_repetition_out(drives), leave_one_trajectory_out(drives)};
}

const Validation& vitko_validation() {
  static const Validation validation = [] {
    ValidationOptions options;
    options.start = options.second_start = nominal_of(vitko_costs()->parameters());
    Watcher nobody;
    return validate(vitko_costs(), both_questions(drive_names(*vitko_costs())), options, nobody);
  }();
  return validation;
}

TEST(Validation, FoldsAreThoseOfTheReference) {
  ODOBENCH_NEEDS_SHARED();
  const nlohmann::json file = reference("uncertainty_vitko2024.json");
  const std::vector<SchemeFigures>& schemes = vitko_validation().schemes;
  ASSERT_EQ(schemes.size(), 2u);
  const char* const lists[] = {"leave_one_repetition_out", "leave_one_trajectory_out"};
  for (std::size_t s = 0; s < 2; ++s) {
    const nlohmann::json& folds = file.at(lists[s]);
    ASSERT_EQ(schemes[s].folds.size(), folds.size());
    for (std::size_t k = 0; k < folds.size(); ++k) {
      const FoldFigures& fold = schemes[s].folds[k];
      SCOPED_TRACE(fold.name);
      const auto near = [&](double found, const char* name, double relative) {
        const double expected = folds[k].at(name).get<double>();
        EXPECT_NEAR(found, expected, relative * expected) << name;
      };
      const double held_out = fold.name == "line_y" ? 1e-3 : 1e-6;
      near(fold.cost_fitted, "J_fitted", 1e-9);
      near(fold.held_out.cost_held_out, "J_held_out", held_out);
      near(fold.held_out.cost_nominal, "J_held_out_nominal", 1e-12);
      near(fold.held_out.cost_full, "J_held_out_of_full_fit", 1e-5);
      near(fold.total_fitted, "total_fitted", 1e-6);
      near(fold.held_out.total_held_out, "total_held_out", held_out);
      near(fold.held_out.total_nominal, "total_held_out_nominal", 1e-12);
      near(fold.held_out.total_full, "total_held_out_of_full_fit", 1e-5);
    }
  }
}

TEST(Validation, TotalsAndPredictionAreThoseOfTheReference) {
  ODOBENCH_NEEDS_SHARED();
  const nlohmann::json model = reference("trust_vitko2024.json").at("models").at("thesis");
  const SchemeFigures& repetitions = vitko_validation().schemes[0];
  const double held = model.at("total_held"), new_kind = model.at("loto_total"), cost = model.at("J_held"),
               predicted = model.at("J_held_predicted");
  EXPECT_NEAR(repetitions.all.total_held_out, held, 1e-6 * held);
  EXPECT_NEAR(repetitions.all.cost_held_out, cost, 1e-6 * cost);
  EXPECT_NEAR(vitko_validation().schemes[1].all.total_held_out, new_kind, 1e-3 * new_kind);
  ASSERT_TRUE(repetitions.cost_predicted);
  EXPECT_NEAR(*repetitions.cost_predicted, predicted, 1e-5 * predicted);
  EXPECT_GT(std::abs(*repetitions.cost_predicted - vitko_validation().full.cost), 1);  // it says something
}

// The reference was fitted by another program from another start: J agrees to rounding, the parameters where
// the drives tell them.
double worst_cost = 0, worst_parameter = 0;

void expect_replicate(const Resample& resample, double cost, const std::vector<double>& z_m) {
  RefitOptions options;
  options.start = vitko_validation().full.z;
  options.second_start = nominal_of(vitko_costs()->parameters());
  const Replicate found = fit_resample(vitko_costs(), resample, options, 1);
  worst_cost = std::max(worst_cost, std::abs(found.cost - cost) / cost);
  EXPECT_NEAR(found.cost, cost, 1e-9 * cost);
  for (std::size_t i = 0; i < z_m.size(); ++i) {
    const double difference = std::abs(found.z[static_cast<Eigen::Index>(i)] - z_m[i]) / std::abs(z_m[i]);
    worst_parameter = std::max(worst_parameter, difference);
    EXPECT_LT(difference, 2e-6) << i;
  }
}

// All 700 take five seconds. When this was written every one was compared: J within 3e-13, parameters 1.5e-6.
constexpr std::size_t kEvery = 29;

TEST(Bootstrap, GivenResamplesHaveTheOptimaOfTheFirstReference) {
  ODOBENCH_NEEDS_SHARED();
  const nlohmann::json file = reference("uncertainty_vitko2024.json").at("bootstrap_stratified");
  ASSERT_EQ(file.at("resamples").size(), 300u);
  for (std::size_t k = 0; k < 300; k += k < 6 ? 1 : kEvery)
    expect_replicate(file.at("resamples")[k], file.at("J")[k],
                     k < file.at("z_m_first").size() ? file.at("z_m_first")[k].get<std::vector<double>>()
                                                     : std::vector<double>());
}

TEST(Bootstrap, GivenResamplesHaveTheOptimaOfTheSecondReference) {
  ODOBENCH_NEEDS_SHARED();
  const nlohmann::json file = reference("trust_vitko2024.json").at("bootstrap").at("replicates");
  ASSERT_EQ(file.size(), 400u);
  for (std::size_t k = 0; k < 400; k += kEvery) {
    std::vector<double> z = file[k].at("p_mm");
    for (double& value : z) value /= 1000;
    expect_replicate(file[k].at("resample"), file[k].at("J"), z);
  }
}

struct SmallSet {
  explicit SmallSet(const char* robot) : set(make_robot_demo(robot, 1)) {
    options.rule = set.robot.rule;
    costs = std::make_shared<const RecordingCosts>(set.robot, set.recordings, options);
    drives = drive_names(*costs);
  }
  Validation validated(int threads) const {
    ValidationOptions how;
    how.start = how.second_start = nominal_of(costs->parameters());
    how.threads = threads;
    Watcher nobody;
    std::vector<FoldPlan> plans = both_questions(drives);
    plans.push_back(stratified_k_fold(drives, 4, 7));
    return validate(costs, plans, how, nobody);
  }
  Dataset set;
  CalibrationOptions options;
  std::shared_ptr<const RecordingCosts> costs;
  std::vector<DriveName> drives;
};

class ValidationOf : public ::testing::TestWithParam<const char*> {};

// A fold's fit against a calibration problem that was given the other recordings only.
TEST_P(ValidationOf, FoldsAreFitsToTheOtherRecordings) {
  const SmallSet small(GetParam());
  const Validation validation = small.validated(0);
  ASSERT_EQ(validation.schemes.size(), 3u);
  const FoldPlan plan = leave_one_repetition_out(small.drives);
  const FoldFigures& fold = validation.schemes[0].folds[1];
  std::vector<Recording> others, left_out;
  for (std::size_t n = 0; n < small.drives.size(); ++n)
    (small.drives[n].repetition == 2 ? left_out : others).push_back(small.set.recordings[n]);
  EXPECT_EQ(fold.recordings, left_out.size());
  EXPECT_EQ(fold.name, "2");
  const Problem problem(CalibrationProblem(small.set.robot, others, small.options));
  SolveOptions how;
  how.budget.max_evaluations = 10000;
  const Result result = solve(problem, {"lm", {}}, problem.start(), how);
  EXPECT_NEAR(fold.cost_fitted, result.cost, 1e-9 * result.cost);
  const CalibrationProblem judge(small.set.robot, left_out, small.options);
  const double held_out = judge.cost(result.x);
  EXPECT_NEAR(fold.held_out.cost_held_out, held_out, 1e-5 * held_out);
  EXPECT_NEAR(fold.held_out.cost_nominal, judge.cost(nominal_of(judge.parameters())),
              1e-9 * fold.held_out.cost_nominal);
  // What is learnt here holds for the same drives again.
  EXPECT_EQ(against_nominal(validation.schemes[0].all), AgainstNominal::Better);
  EXPECT_GT(validation.schemes[0].all.cost_held_out, validation.schemes[0].all.cost_full);
}

TEST_P(ValidationOf, NoBitDependsOnTheThreads) {
  const SmallSet small(GetParam());
  RunRecord one, four;
  for (const SchemeFigures& scheme : small.validated(1).schemes) put_validation(scheme, one);
  for (const SchemeFigures& scheme : small.validated(4).schemes) put_validation(scheme, four);
  EXPECT_EQ(one.series, four.series);
  EXPECT_GT(one.series.size(), 20u);
  BootstrapPlan plan;
  plan.replicates = 6;
  plan.refit.start = nominal_of(small.costs->parameters());
  Watcher nobody;
  plan.threads = 1;
  const std::vector<Replicate> a = bootstrap(small.costs, plan, nullptr, nobody);
  plan.threads = 3;
  const std::vector<Replicate> b = bootstrap(small.costs, plan, nullptr, nobody);
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_EQ(a[k].resample, b[k].resample);
    EXPECT_EQ(a[k].cost, b[k].cost);
    EXPECT_EQ(a[k].z, b[k].z);
  }
  EXPECT_NE(a[0].resample, a[1].resample);
}

INSTANTIATE_TEST_SUITE_P(Robots, ValidationOf, ::testing::Values("differential", "mecanum"));

TEST(Validation, IsReadBackFromARecord) {
  const SmallSet small("differential");
  const Validation validation = small.validated(0);
  RunRecord record;
  for (const DriveName& d : small.drives)
    record.errors.push_back({"", d.trajectory, d.repetition, {1, 2, 3}});
  record.parameters.resize(static_cast<std::size_t>(validation.full.z.size()));
  EXPECT_TRUE(validations_of(record).empty());
  for (const SchemeFigures& scheme : validation.schemes) put_validation(scheme, record);
  const std::vector<SchemeFigures> read = validations_of(record);
  ASSERT_EQ(read.size(), 3u);
  for (std::size_t s = 0; s < 3; ++s) {
    const SchemeFigures& written = validation.schemes[s];
    EXPECT_EQ(read[s].scheme, written.scheme);
    EXPECT_EQ(read[s].all.total_held_out, written.all.total_held_out);
    EXPECT_EQ(read[s].cost_predicted, written.cost_predicted);
    ASSERT_EQ(read[s].folds.size(), written.folds.size());
    for (std::size_t k = 0; k < written.folds.size(); ++k) {
      EXPECT_EQ(read[s].folds[k].name, written.folds[k].name);
      EXPECT_EQ(read[s].folds[k].recordings, written.folds[k].recordings);
      EXPECT_EQ(read[s].folds[k].parameters, written.folds[k].parameters);
      EXPECT_EQ(read[s].folds[k].held_out.cost_nominal, written.folds[k].held_out.cost_nominal);
    }
  }
  record.errors.pop_back();  // no longer the recordings that were judged
  EXPECT_TRUE(validations_of(record).empty());
}

using Names = std::vector<DriveName>;

TEST(FoldPlan, LeavesOutRepetitionsOfKindsThatHaveOthers) {
  const FoldPlan plan = leave_one_repetition_out(Names{{"a", 1}, {"a", 3}, {"b", 1}, {"c", 1}, {"c", 2}});
  ASSERT_EQ(plan.folds.size(), 3u);
  EXPECT_EQ(plan.folds[0].left_out, (std::vector<std::size_t>{0, 3}));
  EXPECT_EQ(plan.folds[1].left_out, (std::vector<std::size_t>{4}));
  EXPECT_EQ(plan.folds[2].left_out, (std::vector<std::size_t>{1}));
  EXPECT_EQ(plan.folds[2].name, "3");
  EXPECT_EQ(plan.never_left_out, 1u);
}

TEST(FoldPlan, SaysWhyThereAreNoFolds) {
  EXPECT_THAT(leave_one_repetition_out(Names{{"a", 1}}).why_not, ::testing::HasSubstr("one recording"));
  EXPECT_THAT(leave_one_trajectory_out(Names{{"a", 1}}).why_not, ::testing::HasSubstr("one recording"));
  EXPECT_THAT(leave_one_repetition_out(Names{{"a", 1}, {"b", 1}}).why_not, ::testing::HasSubstr("twice"));
  EXPECT_THAT(leave_one_trajectory_out(Names{{"a", 1}, {"a", 2}}).why_not, ::testing::HasSubstr("one kind"));
  EXPECT_EQ(leave_one_trajectory_out(Names{{"a", 1}, {"b", 1}}).why_not, "");
  EXPECT_THROW(stratified_k_fold(Names{{"a", 1}, {"a", 2}}, 3, 1), std::invalid_argument);
  EXPECT_THROW(stratified_k_fold(Names{{"a", 1}, {"a", 2}}, 1, 1), std::invalid_argument);
  EXPECT_NE(why_no_bootstrap(Names{{"a", 1}, {"b", 1}}, ResampleScheme::Stratified), "");
  EXPECT_EQ(why_no_bootstrap(Names{{"a", 1}, {"b", 1}}, ResampleScheme::Plain), "");
  EXPECT_NE(why_no_bootstrap(Names{{"a", 1}}, ResampleScheme::Plain), "");
}

TEST(FoldPlan, KFoldsAreStratifiedAndSeeded) {
  Names names;
  for (const char* kind : {"a", "b", "c"})
    for (int k = 1; k <= 5; ++k) names.push_back({kind, k});
  const FoldPlan plan = stratified_k_fold(names, 5, 3);
  std::vector<std::size_t> all;
  for (const Fold& fold : plan.folds) {
    EXPECT_EQ(kinds_of([&] {
                Names left_out;
                for (const std::size_t n : fold.left_out) left_out.push_back(names[n]);
                return left_out;
              }())
                  .size(),
              3u);  // one of each kind
    all.insert(all.end(), fold.left_out.begin(), fold.left_out.end());
  }
  std::sort(all.begin(), all.end());
  for (std::size_t n = 0; n < 15; ++n) EXPECT_EQ(all[n], n);
  EXPECT_EQ(stratified_k_fold(names, 5, 3).folds[0].left_out, plan.folds[0].left_out);
  EXPECT_NE(stratified_k_fold(names, 5, 4).folds[0].left_out, plan.folds[0].left_out);
}

TEST(Bootstrap, StratifiedResamplesKeepTheKinds) {
  const Names names{{"a", 1}, {"a", 2}, {"a", 3}, {"b", 1}};
  bool other = false;
  for (std::size_t k = 0; k < 50; ++k) {
    const Resample drawn = draw_resample(names, ResampleScheme::Stratified, 5, k);
    ASSERT_EQ(drawn.size(), 4u);
    EXPECT_LT(drawn[2], 3u);
    EXPECT_EQ(drawn[3], 3u);
    other = other || draw_resample(names, ResampleScheme::Plain, 5, k)[3] != 3;
  }
  EXPECT_TRUE(other);
  EXPECT_THROW(resample_scheme("strat"), std::invalid_argument);
}

// Damaged files cost time, never a wrong replicate.
TEST(ReplicateFile, TakesWholeLinesOfTheSameBootstrap) {
  const testing::TemporaryFolder folder;
  const auto file = folder / "bootstrap/one.jsonl";
  const nlohmann::json header{{"bootstrap", 1}, {"seed", 3}};
  const Vector z = Vector::LinSpaced(3, 0.1, 0.7);
  {
    ReplicateFile written(file, header);
    EXPECT_EQ(written.size(), 0u);
    written.add(1, {{0, 0, 2}, z, 1.0 / 3, "converged"});
    written.add(0, {{1, 1, 2}, 2 * z, 0.1, "settled"});
    written.finish();
  }
  const std::string whole = testing::content(file);
  ReplicateFile read(file, header);
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read.find(1)->cost, 1.0 / 3);
  EXPECT_EQ(read.find(1)->z, z);
  EXPECT_EQ(read.find(0)->resample, (Resample{1, 1, 2}));
  EXPECT_EQ(read.find(0)->termination, "settled");
  EXPECT_EQ(read.find(2), nullptr);
  const auto kept = [&](const std::string& text, const nlohmann::json& of) {
    folder.file("bootstrap/one.jsonl", text);
    return ReplicateFile(file, of).size();
  };
  EXPECT_EQ(kept(whole, {{"bootstrap", 1}, {"seed", 4}}), 0u);
  EXPECT_EQ(kept(whole.substr(0, whole.size() - 5), header), 1u);
  EXPECT_EQ(kept(whole.substr(0, 10), header), 0u);
  const std::size_t second = whole.find('\n', whole.find('\n') + 1) + 1;
  folder.file("bootstrap/one.jsonl",
              whole.substr(0, second) + "{\"replicate\": -1}\n" + whole.substr(second));
  const ReplicateFile damaged(file, header);
  EXPECT_EQ(damaged.size(), 1u);
  EXPECT_THAT(damaged.damage(), ::testing::HasSubstr("one.jsonl:3: "));
}

TEST(Bootstrap, PercentilesAndShareOnABound) {
  EXPECT_DOUBLE_EQ(percentile({4, 1, 3, 2}, 50), 2.5);
  EXPECT_DOUBLE_EQ(percentile({4, 1, 3, 2}, 2.5), 1.075);  // numpy.percentile
  EXPECT_THROW(percentile({}, 50), std::invalid_argument);
  RunRecord record;
  record.errors.resize(2);
  record.parameters.push_back({"a", "m", 1, 1, 0.5, 1.5, ""});
  const BootstrapFigures figures{"plain", {0, 0, 0, 1, 1, 1, 0, 1}, {1, 2, 3, 4}, {1.5, 1.4999999, 1, 1.49}};
  put_bootstrap(figures, record);
  const std::optional<BootstrapFigures> read = bootstrap_of(record);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->scheme, "plain");
  EXPECT_DOUBLE_EQ(parameter_spread(*read, record, 0).share_at_bound, 0.5);
  EXPECT_DOUBLE_EQ(*record.measures.value("bootstrap.cost.p50"), 2.5);
  record.errors.resize(3);
  EXPECT_FALSE(bootstrap_of(record));
}

HeldOut totals(double held_out, double full, double nominal) {
  return {0, 0, 0, held_out, full, nominal};
}

TEST(ValidationSentences, SayWhatTheFiguresSay) {
  SchemeFigures repetitions{kRepetitions, {}, {}, totals(0.384, 0.378, 1.274), {}};
  EXPECT_EQ(repeats(repetitions), "Repeats: error on repetitions left out 0.384 (+1.6 % against fitted).");
  EXPECT_EQ(fits_more_than_it_learns(repetitions) + worse_on_repetitions(repetitions), "");
  repetitions.all = totals(0.5, 0.4, 1.274);
  EXPECT_EQ(repeats(repetitions), "");
  EXPECT_EQ(fits_more_than_it_learns(repetitions),
            "Fits more than it learns: error on repetitions left out is 25.0 % larger than on fitted ones.");
  repetitions.all = totals(1.5, 0.4, 1.274);
  EXPECT_EQ(worse_on_repetitions(repetitions),
            "Worse than nominal on repetitions left out (1.500 against 1.274): do not use these parameters.");
  SchemeFigures kinds{kTrajectories, {}, {}, totals(4.094, 0.378, 1.274), {}};
  kinds.folds = {{"line_y", 5, 0, 0, totals(3.5463, 0, 0.3925), {}},
                 {"circle", 5, 0, 0, totals(0.2, 0, 0.1), {}},
                 {"spin", 5, 0, 0, totals(0.1, 0, 0.2), {}}};
  EXPECT_EQ(worse_on_new_kinds(kinds),
            "Worse than nominal on kinds of drives that it was not fitted to (4.094 against 1.274).");
  EXPECT_EQ(kinds_that_are_needed(kinds),
            "Without line_y in the fit its error would be 3.546, nominal has 0.393 (the same of circle): the "
            "parameters hold for the kinds of drives they were fitted to.");
  EXPECT_EQ(better_on_every_kind(kinds), "");
  kinds.folds.erase(kinds.folds.begin(), kinds.folds.begin() + 2);
  kinds.all = totals(0.1, 0.05, 0.2);
  EXPECT_EQ(better_on_every_kind(kinds),
            "Better than nominal on every kind of drive left out (-50.0 % in all).");
  EXPECT_EQ(kinds_that_are_needed(kinds) + worse_on_new_kinds(kinds), "");
}

TEST(ValidationSentences, RoundingIsNoErrorAndNoiseNoHarm) {
  EXPECT_EQ(against_nominal(totals(1e-12, 1e-13, 1e-15)), AgainstNominal::Better);
  EXPECT_EQ(against_nominal(totals(2e-9, 1e-13, 1e-15)), AgainstNominal::Worse);
  EXPECT_EQ(against_nominal(totals(std::nan(""), 1, 1)), AgainstNominal::Worse);
  EXPECT_EQ(against_nominal(totals(1.0999, 1, 1)), AgainstNominal::NoBetter);
  EXPECT_EQ(against_nominal(totals(1.1001, 1, 1)), AgainstNominal::Worse);
  const SchemeFigures repetitions{kRepetitions, {}, {}, totals(0.0252, 0.025, 0.02496), {}};
  EXPECT_EQ(
      worse_on_repetitions(repetitions),
      "No better than nominal on repetitions left out (0.0252 against 0.0250): nominal parameters do as "
      "well.");
}

TEST(HeldOutPrediction, NeedsRepetitionsOfEveryKind) {
  const SmallSet small("differential");
  const Vector z = small.validated(0).full.z;
  EXPECT_TRUE(predicted_held_out_cost(*small.costs, z));
  const std::vector<Recording> some(small.set.recordings.begin(), small.set.recordings.begin() + 4);
  EXPECT_FALSE(predicted_held_out_cost(RecordingCosts(small.set.robot, some, small.options), z));
}

}  // namespace
}  // namespace odobench
