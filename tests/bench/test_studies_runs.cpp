// The studies called as functions, without a terminal: what they give, what they tell, what a stop leaves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <functional>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/files.hpp"
#include "bench/studies/calibration/evaluation_study.hpp"
#include "bench/studies/calibration/solver_study.hpp"
#include "bench/studies/entropy/filter_study.hpp"
#include "bench/studies/entropy/window_study.hpp"
#include "bench/studies/fusion/fusion_study.hpp"
#include "bench/studies/fusion/tuning_study.hpp"
#include "bench/studies/planning/drive_plan.hpp"
#include "bench/studies/planning/verification.hpp"
#include "bench/studies/simulation/discretisation_study.hpp"
#include "bench/studies/simulation/scenario_study.hpp"
#include "reports/records/record.hpp"
#include "tests/support/data/entropy_windows.hpp"
#include "tests/support/data/filter_run_files.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
namespace fs = std::filesystem;

// Counts what it is told and asks for a stop after `stop_after` runs or counted pieces (0: never).
class Counting final : public Watcher {
 public:
  explicit Counting(std::int64_t stop_after = 0) : stop_after_(stop_after) {}

  Stop stop() const { return Stop(flag_); }
  void note(const std::string& text) override { notes.push_back(text); }
  void warn(const std::string& text) override { warnings.push_back(text); }
  void results_begin() override { order.push_back("results"); }
  void runs_begin(std::size_t runs, const std::function<std::string(std::size_t)>& label) override {
    order.push_back("runs");
    for (std::size_t i = 0; i < runs; ++i) labels.push_back(label(i));
  }
  void started(std::size_t run) override {
    const std::lock_guard lock(mutex_);
    begun.insert(run);
  }
  void finished(std::size_t run) override {
    const std::lock_guard lock(mutex_);
    ended.insert(run);
    told(static_cast<std::int64_t>(ended.size()));
  }
  void runs_end() override { order.push_back("end"); }
  void count_begins(const std::string& unit, std::int64_t all) override {
    order.push_back(unit);
    total = all;
  }
  void count_is(std::int64_t count) override { told(pieces = count); }
  void count_one() override {
    const std::lock_guard lock(mutex_);
    told(++pieces);
  }

  std::vector<std::string> notes, warnings, order, labels;
  std::set<std::size_t> begun, ended;
  std::int64_t total = 0, pieces = 0;

 private:
  void told(std::int64_t count) {
    if (stop_after_ > 0 && count >= stop_after_) flag_.store(true);
  }
  const std::int64_t stop_after_;
  std::atomic<bool> flag_{false};
  std::mutex mutex_;
};

// What comes with the program.
const Catalogue& known() {
  static Catalogue catalogue;
  if (catalogue.problems().empty()) add_known(catalogue);
  return catalogue;
}

RunFolder nowhere() {
  return RunFolder("", false);
}

Stop stopped() {
  static const std::atomic<bool> flag{true};
  return Stop(flag);
}

std::vector<std::string> labels_of(const std::vector<RunRecord>& records) {
  std::vector<std::string> labels;
  for (const RunRecord& r : records) labels.push_back(r.label);
  return labels;
}

std::string sensors_file(const char* name) {
  return (source_dir() / "datasets" / "sensors" / name).string();
}

SolverStudy two_solvers() {
  SolverStudy study;
  study.solvers = {"pso[swarm=8],lm"};
  study.problems = {"sphere,rosenbrock"};
  study.repeat = 3;
  study.budget.max_evaluations = 200;
  study.threads = 1;
  return study;
}

TEST(SolverStudy, GivesRecordsInTheirOrderForAnyThreads) {
  SolverStudy study = two_solvers();
  Counting watcher;
  RunFolder none = nowhere();
  const SolverRuns one = run_solvers(study, known(), none, watcher, Stop());
  EXPECT_EQ(labels_of(one.records),
            (std::vector<std::string>{"pso[swarm=8]", "pso[swarm=8]", "pso[swarm=8]", "lm", "pso[swarm=8]",
                                      "pso[swarm=8]", "pso[swarm=8]", "lm"}));
  EXPECT_EQ(one.planned, 8u);
  EXPECT_FALSE(one.interrupted);
  EXPECT_FALSE(one.derivatives);
  EXPECT_THAT(watcher.order, ElementsAre("results", "runs", "end"));
  EXPECT_EQ(watcher.labels.front(), "sphere pso[swarm=8]");
  EXPECT_THAT(watcher.ended, SizeIs(8));
  EXPECT_EQ(watcher.begun, watcher.ended);
  ASSERT_THAT(watcher.notes, SizeIs(1));
  EXPECT_THAT(watcher.notes.front(), HasSubstr("lm: deterministic, so run once"));

  study.threads = 2;
  const SolverRuns two = run_solvers(study, known(), none, watcher, Stop());
  ASSERT_EQ(two.records.size(), one.records.size());
  for (std::size_t i = 0; i < one.records.size(); ++i) {
    EXPECT_EQ(two.records[i].seed, one.records[i].seed);
    EXPECT_EQ(two.records[i].cost, one.records[i].cost);
  }
}

TEST(SolverStudy, AStopAfterTheSecondRunLeavesTwo) {
  const TemporaryFolder folder;
  Counting watcher(2);
  RunFolder kept(folder / "out", false);
  const SolverRuns runs = run_solvers(two_solvers(), known(), kept, watcher, watcher.stop());
  EXPECT_TRUE(runs.interrupted);
  EXPECT_EQ(runs.planned, 8u);
  ASSERT_THAT(runs.records, SizeIs(2));
  EXPECT_EQ(runs.records[1].repetition, 2);
  for (const RunRecord& r : runs.records) EXPECT_EQ(r.termination, "max_evaluations");
  EXPECT_EQ(read_records((folder / "out" / "runs.jsonl").string()).size(), 2u);
}

TEST(SolverStudy, TheFolderHasRecordsAndTracks) {
  const TemporaryFolder folder;
  SolverStudy study;
  study.solvers = {"lm,pso[swarm=8]"};
  study.repeat = 2;
  study.budget.max_evaluations = 60;
  study.threads = 2;
  Counting watcher;
  SolverRuns runs;
  {
    RunFolder kept(folder / "out", false);
    runs = run_solvers(study, known(), kept, watcher, Stop());
    EXPECT_THAT(labels_of(runs.records), ElementsAre("nominal", "lm", "pso[swarm=8]", "pso[swarm=8]"));
    RunFolder second(folder / "out", false);
    Counting other;
    EXPECT_THROW(run_solvers(study, known(), second, other, Stop()), std::invalid_argument);
    EXPECT_THAT(other.order, IsEmpty());  // refused before anything began
  }
  const std::vector<RunRecord> stored = read_records((folder / "out" / "runs.jsonl").string());
  EXPECT_EQ(labels_of(stored), labels_of(runs.records));
  const std::optional<TrackSet> tracks = read_tracks(folder / "out");
  ASSERT_TRUE(tracks);
  EXPECT_THAT(tracks->tracks, SizeIs(3));  // one per label
}

TEST(SolverStudy, DerivativesThatAgreeComeBeforeTheRuns) {
  SolverStudy study = two_solvers();
  study.check_derivatives = true;
  Counting watcher;
  RunFolder none = nowhere();
  const SolverRuns runs = run_solvers(study, known(), none, watcher, Stop());
  ASSERT_TRUE(runs.derivatives);
  EXPECT_TRUE(runs.derivatives->agrees);
  EXPECT_THAT(watcher.order, ElementsAre("points", "results", "runs", "end"));
  EXPECT_EQ(watcher.pieces, watcher.total);
  EXPECT_THROW(run_solvers(study, known(), none, watcher, stopped()), Interruption);
}

// (a - 1)^2 + (b + 2)^2 with a gradient that is wrong in b where `fault` is not 0.
struct TwoSquares {
  double fault = 0;
  std::vector<ParameterInfo> list{{"a", "", 0, -4, 4}, {"b", "", 0, -4, 4}};
  std::string name() const { return "two_squares"; }
  const std::vector<ParameterInfo>& parameters() const { return list; }
  double cost(const ConstVectorRef& x) const { return std::pow(x[0] - 1, 2) + std::pow(x[1] + 2, 2); }
  double cost_and_gradient(const ConstVectorRef& x, VectorRef g) const {
    g[0] = 2 * (x[0] - 1);
    g[1] = 2 * (x[1] + 2) + fault;
    return cost(x);
  }
};

// What comes with the program, and one of each of ours.
void fill(Catalogue& catalogue, double fault) {
  add_known(catalogue);
  SolverEntry mine = catalogue.solver("nlopt:bobyqa");
  mine.name = "mine";
  catalogue.add(std::move(mine));
  ClassicEntry about;
  about.name = "two_squares";
  about.family = "own";
  about.dimension = 2;
  catalogue.add(problem_entry(about, [fault](int) { return Problem(TwoSquares{fault}); }));
}

TEST(Catalogue, HasNoNameTwiceAndRefusesUnknownOnes) {
  Catalogue catalogue;
  fill(catalogue, 0);
  const std::size_t problems = catalogue.problems().size(), solvers = catalogue.solvers().entries().size();
  EXPECT_THROW(catalogue.add(SolverEntry(catalogue.solver("lm"))), std::logic_error);
  EXPECT_THROW(catalogue.add(ProblemEntry(catalogue.problem("two_squares"))), std::logic_error);
  EXPECT_THROW(add_known(catalogue), std::logic_error);
  EXPECT_EQ(catalogue.problems().size(), problems);
  EXPECT_EQ(catalogue.solvers().entries().size(), solvers);
  EXPECT_EQ(catalogue.problems().front().about.name, "calibration");
  EXPECT_EQ(catalogue.problems().back().about.name, "two_squares");
  EXPECT_THROW(known().solver("mine"), std::invalid_argument);
  EXPECT_THROW(catalogue.problem("two_sqares"), std::invalid_argument);
}

TEST(Catalogue, WhatIsAddedRunsLikeWhatWasThere) {
  Catalogue catalogue;
  fill(catalogue, 0);
  SolverStudy study;
  study.solvers = {"mine,multistart[solver=mine,starts=2]"};
  study.polish = "mine";
  study.problems = {"two_*"};
  study.threads = 1;
  Counting watcher;
  RunFolder none = nowhere();
  const SolverRuns runs = run_solvers(study, catalogue, none, watcher, Stop());
  ASSERT_THAT(runs.records, SizeIs(2));
  for (const RunRecord& r : runs.records) {
    EXPECT_EQ(r.problem, "two_squares");
    EXPECT_NEAR(r.cost.value_or(1), 0, 1e-9) << r.message;
  }
  EXPECT_THROW(run_solvers(study, known(), none, watcher, Stop()), std::invalid_argument);
}

TEST(SolverStudy, NothingRunsWhereDerivativesDisagree) {
  const TemporaryFolder folder;
  Catalogue catalogue;
  fill(catalogue, 0.5);
  SolverStudy study;
  study.solvers = {"lm"};
  study.problems = {"two_squares"};
  study.check_derivatives = true;
  Counting watcher;
  RunFolder kept(folder / "out", false);
  const SolverRuns runs = run_solvers(study, catalogue, kept, watcher, Stop());
  ASSERT_TRUE(runs.derivatives);
  EXPECT_FALSE(runs.derivatives->agrees);
  EXPECT_THAT(runs.records, IsEmpty());
  EXPECT_THAT(watcher.order, ElementsAre("points"));
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(EvaluationStudy, EvaluatesEachSetAndWarnsOutsideTheBox) {
  const TemporaryFolder folder;
  EvaluationStudy study;
  study.parameters = {"nominal,truth"};
  Counting watcher;
  const Evaluation known = evaluate_parameters(study, watcher, Stop());
  ASSERT_THAT(labels_of(known.records), ElementsAre("nominal", "truth"));
  EXPECT_LT(*known.records[1].cost, *known.records[0].cost);
  EXPECT_THAT(watcher.warnings, IsEmpty());

  std::string text;
  for (const ParameterInfo& p : known.loaded.problem.parameters())
    text += (text.empty() ? "{\"" : ", \"") + p.name + "\": " + std::to_string(p.upper + 0.01);
  study.parameters = {folder.file("outside.json", text + "}")};
  evaluate_parameters(study, watcher, Stop());
  ASSERT_THAT(watcher.warnings, SizeIs(1));
  EXPECT_THAT(watcher.warnings.front(), HasSubstr("'outside' lie outside the box"));
  EXPECT_THROW(evaluate_parameters(study, watcher, stopped()), Interruption);
}

TEST(WindowStudy, AStopAfterTheSecondRunLeavesTwo) {
  const TemporaryFolder folder;
  WindowStudy study;
  study.file = folder.file("w.json", windows_json());
  study.threads = 1;
  RunFolder none = nowhere();
  Counting all;
  const WindowRuns whole = run_on_windows(study, known(), none, all, Stop());
  EXPECT_EQ(whole.planned, 18u);  // six windows, three methods
  EXPECT_THAT(whole.records, SizeIs(18));
  EXPECT_EQ(all.labels.back(), "random5 relaxed");
  EXPECT_THAT(all.ended, SizeIs(18));

  Counting watcher(2);
  const WindowRuns part = run_on_windows(study, known(), none, watcher, watcher.stop());
  EXPECT_TRUE(part.interrupted);
  EXPECT_THAT(labels_of(part.records), ElementsAre("coordinate", "exact"));
  EXPECT_EQ(part.records[1].cost, whole.records[1].cost);
  EXPECT_THROW(run_on_windows(study, known(), none, watcher, stopped()), Interruption);
}

TEST(FilterStudy, AStopLeavesTheWindowsSoFar) {
  const TemporaryFolder folder;
  EntropyOptions options;
  options.data = folder.file("run.csv", plain_run(60));
  options.solver = "lm";  // one of the registry: every window is told
  options.constants.samples = 5;
  options.out = (folder / "out.csv").string();
  const TextSink never = [](const std::string&) { FAIL(); };
  Counting watcher(7);
  const FilteredRun run = filter_run(options, known(), never, watcher, watcher.stop());
  EXPECT_TRUE(run.interrupted);
  EXPECT_EQ(run.windows, 7);
  EXPECT_EQ(run.record.termination, "interrupted");
  EXPECT_EQ(lines(read_file(folder / "out.csv")).size(), 8u);  // and the names of the columns
  EXPECT_TRUE(run.record.dataset_sha256.empty());

  options.out = "-";
  options.checksum = true;
  std::string text;
  Counting all;
  const FilteredRun whole = filter_run(
      options, known(), [&text](const std::string& part) { text += part; }, all, Stop());
  EXPECT_FALSE(whole.interrupted);
  EXPECT_EQ(whole.windows, 56);
  EXPECT_EQ(lines(text).size(), 57u);
  EXPECT_EQ(whole.record.dataset_sha256.size(), 64u);
  EXPECT_THAT(all.order, ElementsAre("results", "windows"));
}

TEST(FusionStudy, HasARecordATrackAndARowEach) {
  FusionStudy study;
  study.parameters = {"nominal,truth"};
  study.filters = {"none"};
  study.sensors = sensors_file("heading_only.json");
  study.keep_tracks = true;
  Counting watcher;
  const FusionRuns runs = fuse_recordings(study, watcher, Stop());
  EXPECT_THAT(labels_of(runs.records), ElementsAre("nominal", "truth"));
  EXPECT_THAT(runs.rows, SizeIs(2));
  ASSERT_THAT(runs.tracks.tracks, SizeIs(2));
  EXPECT_EQ(runs.tracks.tracks[1].pose.x.size(), runs.tracks.time_s.size());
  EXPECT_LT(runs.rows[1].rmse_position, runs.rows[0].rmse_position);
  study.keep_tracks = false;
  study.parameters = {"nominal"};
  EXPECT_THAT(fuse_recordings(study, watcher, Stop()).tracks.tracks, IsEmpty());
  EXPECT_THROW(fuse_recordings(study, watcher, stopped()), Interruption);
}

TEST(PlanStudy, IsOneRecordAndCountsSimulations) {
  DrivePlan study;
  study.robot = "nominal";
  study.drives = {"line_x,circle_ccw"};
  study.replicas = 3;
  Counting watcher;
  const std::vector<RunRecord> records = plan_drives(study, watcher, Stop());
  ASSERT_THAT(records, SizeIs(1));
  EXPECT_EQ(watcher.total, 6);
  EXPECT_EQ(watcher.pieces, 6);
  ASSERT_FALSE(records[0].notes.empty());
  EXPECT_THAT(records[0].notes.back(), HasSubstr("--replicas=3: the noise of 2 drives"));
  EXPECT_THROW(plan_drives(study, watcher, stopped()), Interruption);
}

TEST(VerificationStudy, DrivesEverySetAndNominal) {
  VerificationStudy study;
  study.scenario = "nominal";
  study.parameters = {"truth"};
  study.repeat = 1;
  Counting watcher(1);
  EXPECT_THROW(verify_parameters(study, watcher, watcher.stop()), Interruption);
  EXPECT_EQ(watcher.total, 2);
  EXPECT_EQ(watcher.pieces, 1);
  study.parameters = {"nominal"};
  const Verification v = verify_parameters(study, watcher, Stop());
  EXPECT_THAT(labels_of(v.records), ElementsAre("nominal"));
  EXPECT_THAT(v.rounds.outcomes.at(0).at(0).arrival, SizeIs(v.rounds.drives.size()));
}

TEST(TuningStudy, RefusesAndStopsBeforeItFits) {
  TuningStudy study;
  study.sensors = sensors_file("heading_only.json");
  study.filter = "ekf-smoothed";
  Counting watcher;
  EXPECT_THROW(tune_filter(study, known(), watcher, Stop()), std::invalid_argument);
  study.filter = "ekf";
  EXPECT_THROW(tune_filter(study, known(), watcher, stopped()), Interruption);
  EXPECT_THAT(watcher.order, IsEmpty());
}

TEST(DiscretisationStudy, HasTheMatricesInEveryForm) {
  DiscretisationStudy study;
  study.system = source_dir() / "datasets" / "systems" / "turn3d.json";
  study.period = 0.5;
  const DiscreteSystem exact = discretise_system(study);
  ASSERT_FALSE(exact.tables.empty());
  EXPECT_EQ(exact.tables.front().id, "F");
  EXPECT_THAT(exact.latex, HasSubstr("\\begin{bmatrix}"));
  study.order = 1;
  const DiscreteSystem series = discretise_system(study);
  EXPECT_EQ(series.tables.back().id, "series_error");
  EXPECT_THAT(series.json, HasSubstr("\"series_error\""));
  study.period = 1e200;
  EXPECT_THROW(discretise_system(study), DataError);
}

TEST(ScenarioStudy, WritesOnceAndNothingWhereItRefuses) {
  const TemporaryFolder place;
  const fs::path folder = place.path() / "scenario";
  ScenarioStudy study;
  study.scenario = "off_nominal";
  study.out = folder;
  study.as_published = true;
  Counting watcher;
  EXPECT_THROW(simulate_scenario(study, watcher, Stop()), std::invalid_argument);
  EXPECT_THAT(watcher.order, IsEmpty());
  EXPECT_FALSE(fs::exists(folder / "truth.json"));
  study.as_published = false;
  const WrittenScenario written = simulate_scenario(study, watcher, Stop());
  ASSERT_TRUE(written.dataset);
  EXPECT_THAT(written.files, ::testing::Contains(folder / "set.json"));
  EXPECT_THAT(watcher.order, ElementsAre("results"));
  EXPECT_THROW(simulate_scenario(study, watcher, Stop()), std::invalid_argument);
}

}  // namespace
}  // namespace odobench::testing
