// Validation and bootstrap as a user of the command line sees them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/files.hpp"
#include "datasets/dataset.hpp"
#include "problems/simulation/robot_demo.hpp"
#include "reports/kinds/trust/bootstrap_record.hpp"
#include "reports/kinds/trust/profile_record.hpp"
#include "reports/kinds/trust/validation_record.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/shared_data.hpp"

namespace odobench {
namespace {
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ProcessResult;
using testing::run_bench;
using testing::TemporaryFolder;

// A small robot's set of the recordings for which `keep` says so.
template <class Keep>
std::string set_of(const TemporaryFolder& folder, const Keep& keep) {
  Dataset set = make_robot_demo("differential", 1);
  std::erase_if(set.recordings, [&](const Recording& r) { return !keep(r); });
  save_dataset(set, folder / "set.json", true);
  return "--data=" + (folder / "set.json").string();
}
std::string whole_set(const TemporaryFolder& folder) {
  return set_of(folder, [](const Recording&) { return true; });
}

const RunRecord& lowest(const std::vector<RunRecord>& records) {
  for (const RunRecord& r : records)
    if (r.kind == "run") return r;
  throw std::runtime_error("no run among the records");
}

TEST(CliValidation, BothQuestionsAreAnsweredByDefault) {
  const TemporaryFolder folder;
  const std::string data = whole_set(folder), out = (folder / "out").string();
  const ProcessResult run =
      run_bench({"--solver=lm,ga", data, "--max-evals=300", "--tables=all", "--out=" + out});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("same drives again"), HasSubstr("kind never seen"),
                             HasSubstr("Not validated, since J is not that of the fits: ga"),
                             HasSubstr("lm: Repeats: error on repetitions left out")));
  const std::vector<RunRecord> records = read_records(out + "/runs.jsonl");
  const std::vector<SchemeFigures> schemes = validations_of(lowest(records));
  ASSERT_EQ(schemes.size(), 2u);
  EXPECT_EQ(schemes[0].folds.size(), 3u);
  EXPECT_TRUE(validations_of(records.back()).empty());  // ga
  const ProcessResult report = run_bench({"report", out, "--format=json"});
  bool validation = false, folds = false;
  const nlohmann::json tables = nlohmann::json::parse(report.out);
  for (const nlohmann::json& table : tables.at("tables")) {
    validation = validation || table.at("id") == "validation";
    if (table.at("id") != "folds") continue;
    folds = true;
    EXPECT_EQ(table.at("rows").size(), 3 + schemes[1].folds.size());
    EXPECT_EQ(table.at("rows")[0].at("cost_held_out"), schemes[0].folds[0].held_out.cost_held_out);
  }
  EXPECT_TRUE(validation && folds);
  for (const char* format : {"md", "csv", "latex"})
    EXPECT_THAT(run_bench({"report", out, std::string("--format=") + format}).out,
                HasSubstr("recordings that the fit has not seen"))
        << format;
}

TEST(CliValidation, OwnSolversOnRequestAndNothingOnRequest) {
  const TemporaryFolder folder;
  const std::string data = whole_set(folder);
  const ProcessResult all =
      run_bench({"--solver=lm,nlopt:bobyqa", data, "--validate=all,kfold:3", "--format=csv", "--quiet"});
  EXPECT_EQ(all.exit_code, 0) << all.err;
  EXPECT_THAT(all.out, AllOf(HasSubstr("fold 3"), HasSubstr("repetition 2,lm"),
                             HasSubstr("repetition 2,nlopt:bobyqa"), Not(HasSubstr("Not validated"))));
  const ProcessResult none = run_bench({"--solver=lm", data, "--validate=none"});
  EXPECT_THAT(none.out, Not(HasSubstr("Validation")));
}

TEST(CliValidation, SaysWhyThereIsNone) {
  const TemporaryFolder folder;
  const std::string first = make_robot_demo("differential", 1).recordings.front().trajectory;
  const std::string one =
      set_of(folder, [&](const Recording& r) { return r.trajectory == first && r.repetition == 1; });
  ProcessResult run = run_bench({"--solver=lm", one});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("not validated: there is one recording only"));
  EXPECT_THAT(run.out, Not(HasSubstr("Validation")));
  run = run_bench({"--solver=lm", one, "--bootstrap=5"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("--bootstrap=5: there is one recording only"));

  const TemporaryFolder kind;
  const std::string one_kind = set_of(kind, [&](const Recording& r) { return r.trajectory == first; });
  run = run_bench({"--solver=lm", one_kind, "--tables=all"});
  EXPECT_THAT(run.err,
              HasSubstr("not validated on kinds of drives never seen: all recordings are of one kind"));
  EXPECT_THAT(run.out, AllOf(HasSubstr("same drives again"), Not(HasSubstr("kind never seen  "))));

  const TemporaryFolder repetition;
  const std::string once = set_of(repetition, [](const Recording& r) { return r.repetition == 1; });
  run = run_bench({"--solver=lm", once, "--quiet", "--validate=repetitions"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.err,
              HasSubstr("warning: not validated on the same drives again: no kind of drive was driven"));
  run = run_bench({"--solver=lm", once, "--bootstrap=5"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("every stratified resample would be the set itself"));
  run = run_bench({"--solver=lm", once, "--bootstrap=5", "--bootstrap-scheme=plain"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("Bootstrap of lm: 5 plain resamples"));
}

TEST(CliValidation, RefusesWhatMakesNoSense) {
  const auto refused = [](const std::vector<std::string>& arguments, const std::string& message) {
    const ProcessResult run = run_bench(arguments);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.err, HasSubstr(message));
  };
  refused({"--validate=repetition"}, "found 'repetition', expected repetitions, trajectories, kfold:K, all");
  refused({"--validate=none,all"}, "found 'none'");
  refused({"--validate=kfold:1"}, "--validate=kfold");
  refused({"--bootstrap=-1"}, "--bootstrap");
  refused({"--bootstrap=5", "--bootstrap-scheme=strat"},
          "--bootstrap-scheme='strat': expected stratified or plain");
  refused({"--problem=rosenbrock", "--solver=lm", "--validate=trajectories"},
          "'rosenbrock' is no calibration");
  refused({"--problem=rosenbrock", "--solver=lm", "--bootstrap=3"}, "'rosenbrock' is no calibration");
}

constexpr const char* kReplicates = "calibration-every_sample-arc-.jsonl";

TEST(CliValidation, ABootstrapThatWasKilledGoesOn) {
  const TemporaryFolder folder;
  const std::string data = whole_set(folder);
  const auto call = [&](const std::string& out) {
    return std::vector<std::string>{"--solver=lm",
                                    data,
                                    "--bootstrap=400",
                                    "--validate=none",
                                    "--threads=2",
                                    "--overwrite",
                                    "--out=" + (folder / out).string()};
  };
  const auto replicates = [&](const std::string& out) {
    return *bootstrap_of(lowest(read_records((folder / out / "runs.jsonl").string())));
  };
  const std::filesystem::path file = folder / "killed" / "bootstrap" / kReplicates;
  std::size_t kept = 0;
  {
    testing::Process bench(testing::bench_words(call("killed")));
    ASSERT_TRUE(testing::wait_for_lines(file, 10));
    bench.send(SIGKILL);
    if (bench.wait().signal != SIGKILL) GTEST_SKIP() << "400 replicates were faster than the signal";
    kept = testing::lines(testing::content(file)).size() - 1;
    EXPECT_LT(kept, 400u);
  }
  const ProcessResult again = run_bench(call("killed"));
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("replicates of an earlier call with this seed are there"));
  EXPECT_EQ(run_bench(call("whole")).exit_code, 0);
  const BootstrapFigures a = replicates("killed"), b = replicates("whole");
  EXPECT_EQ(a.recordings, b.recordings);
  EXPECT_EQ(a.costs, b.costs);
  EXPECT_EQ(a.parameters, b.parameters);
  EXPECT_EQ(testing::content(file), testing::content(folder / "whole" / "bootstrap" / kReplicates));
}

TEST(CliValidation, ReplicatesOfAnotherSeedAreReplaced) {
  const TemporaryFolder folder;
  const std::string data = whole_set(folder), out = "--out=" + (folder / "out").string();
  const auto call = [&](const std::string& seed) {
    return run_bench({"--solver=lm", data, "--bootstrap=20", "--overwrite", out, seed}).err;
  };
  EXPECT_THAT(call("--seed=3"), Not(HasSubstr("earlier call")));
  EXPECT_THAT(call("--seed=3"), HasSubstr("20 replicates of an earlier call"));
  EXPECT_THAT(call("--seed=4"), Not(HasSubstr("earlier call")));
}

TEST(CliValidation, CalibrateAnswersToo) {
  const TemporaryFolder folder;
  whole_set(folder);
  const ProcessResult run = run_bench({"calibrate", (folder / "set.json").string(),
                                       "--tables=validation,folds", "--out=" + (folder / "out").string()});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("same drives again"), HasSubstr("Folds of the validation")));
  EXPECT_THAT(testing::content(folder / "out/report.html"), HasSubstr("Folds of the validation"));
}

TEST(CliValidation, AModelThatIsWorseThanNominalOnNewKindsIsSaidToBeSo) {
  ODOBENCH_NEEDS_SHARED();
  const TemporaryFolder folder;
  const std::string set = (folder / "set.json").string();
  ASSERT_EQ(run_bench({"import", "vitko2024", "--quiet", "--out=" + set,
                       "--from=" + (testing::shared_folder() / "datasets/vitko2024").string()})
                .exit_code,
            0);
  const ProcessResult run =
      run_bench({"calibrate", set, "--quiet", "--accept=all", "--out=" + (folder / "out").string()});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const char* const warning =
      "Worse than nominal on kinds of drives that it was not fitted to (4.094 against 1.274). Without "
      "line_y in "
      "the fit its error would be 3.546, nominal has 0.393";
  EXPECT_THAT(run.err, HasSubstr(std::string("lm: ") + warning));
  EXPECT_THAT(testing::content(folder / "out/report.html"), HasSubstr(warning));
}

TEST(CliProfile, IsInTablesRecordsAndOnThePage) {
  const TemporaryFolder folder;
  const std::string data = whole_set(folder), out = (folder / "out").string();
  const ProcessResult run =
      run_bench({"--solver=lm", data, "--validate=none", "--profile=b,r_left", "--profile-steps=3",
                 "--combination=mean radius=(r_left+r_right)/2", "--out=" + out});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("J along single parameters"), HasSubstr("Numbers asked for"),
                             HasSubstr("mean radius")));
  const RunRecord record = lowest(read_records(out + "/runs.jsonl"));
  const std::vector<ProfileFigures> profiles = profiles_of(record);
  ASSERT_EQ(profiles.size(), 2u);
  EXPECT_GE(profiles[0].values.size(), 7u);
  EXPECT_LT(profiles[0].lower, profiles[0].upper);
  ASSERT_EQ(record.trust->combinations.size(), 1u);
  EXPECT_EQ(record.trust->combinations[0].unit, "m");
  const std::string page = (folder / "page.html").string();
  EXPECT_EQ(run_bench({"report", out, "--out=" + page}).exit_code, 0);
  // A build without charts has tables only.
  if (run_bench({"--version"}).out.find("without charts") != std::string::npos) return;
  EXPECT_THAT(read_file(page), HasSubstr("J above its minimum"));
}

TEST(CliProfile, NamesThatAreNoneAreRefusedBeforeAnythingRuns) {
  const TemporaryFolder folder;
  const std::string data = whole_set(folder), out = (folder / "out").string();
  for (const auto& [option, message] :
       {std::pair{"--profile=r9", "--profile: found 'r9', expected one of"},
        std::pair{"--combination=(r_left+r9)/2", "at character 9: found 'r9)/2', expected one of"},
        std::pair{"--combination=r_left/0", "not a finite number"},
        std::pair{"--profile-steps=1", "--profile-steps"}}) {
    const ProcessResult run = run_bench({"--solver=lm", data, option, "--out=" + out});
    EXPECT_EQ(run.exit_code, 2) << option;
    EXPECT_THAT(run.err, HasSubstr(message));
    EXPECT_FALSE(std::filesystem::exists(out + "/runs.jsonl"));
  }
  const ProcessResult other = run_bench({"--solver=lm", "--problem=rosenbrock", "--profile=all"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, HasSubstr("is no calibration"));
}

// What a gate in CI watches of trust: measures with a direction, in `compare` as every other figure.
TEST(CliTrustMeasures, AreSeenByComparisons) {
  const TemporaryFolder folder;
  const std::string data = whole_set(folder);
  const std::string whole = (folder / "whole").string(), worse = (folder / "worse").string();
  ASSERT_EQ(run_bench({"--solver=lm", data, "--out=" + whole}).exit_code, 0);
  const RunRecord record = lowest(read_records(whole + "/runs.jsonl"));
  const Measure* half = record.measures.find("trust.m33.half_width");
  ASSERT_NE(half, nullptr);
  EXPECT_EQ(half->better, Better::Lower);
  EXPECT_EQ(half->of, "m33");
  EXPECT_EQ(record.measures.value("trust.share_on_bounds"), 0.0);
  EXPECT_EQ(record.measures.value("trust.intervals"), 4.0);
  EXPECT_EQ(record.measures.find("validation.repetitions.total_held_out")->better, Better::Lower);
  std::filesystem::create_directories(worse);
  std::ofstream lines(worse + "/runs.jsonl");
  for (RunRecord r : read_records(whole + "/runs.jsonl")) {
    const Measures before = r.measures;
    for (Measure m : before)
      if (m.name == "validation.repetitions.total_held_out" || m.name == "trust.m33.half_width") {
        m.value *= 1.2;
        r.measures.put(m);
      }
    lines << to_json_line(r) << "\n";
  }
  lines.close();
  for (const char* name : {"validation.repetitions.total_held_out", "trust.m33.half_width"}) {
    EXPECT_EQ(run_bench({"compare", whole, worse, "--fail-on=" + std::string(name) + ":+10%"}).exit_code, 1)
        << name;
    EXPECT_EQ(run_bench({"compare", whole, worse, "--fail-on=" + std::string(name) + ":+30%"}).exit_code, 0)
        << name;
  }
}

}  // namespace
}  // namespace odobench
