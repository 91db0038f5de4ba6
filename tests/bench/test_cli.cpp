// The program as its users meet it: what each verb does when all is well.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "datasets/dataset.hpp"
#include "reports/records/record.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench {
namespace {

using testing::content;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::lines;
using ::testing::Not;
using testing::ProcessResult;
using testing::run_bench;
using testing::source_dir;
using testing::TemporaryFolder;

// Files of a folder by name, sorted.
std::vector<std::string> names_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> labels_of(const std::vector<RunRecord>& records) {
  std::vector<std::string> labels;
  for (const RunRecord& r : records) labels.push_back(r.label);
  return labels;
}

TEST(Cli, HelpAndVersionGoToStandardOutput) {
  for (const std::string verb : {"run", "evaluate", "list", "import", "demo", "check", "report", "compare",
                                 "simulate", "plan", "verify"}) {
    const ProcessResult help = run_bench({verb, "--help"});
    EXPECT_EQ(help.exit_code, 0) << verb;
    EXPECT_THAT(help.out, HasSubstr("--help")) << verb;
    EXPECT_THAT(help.err, IsEmpty()) << verb;
  }
  const ProcessResult top = run_bench({"--help"});
  EXPECT_THAT(top.out, HasSubstr("Examples:"));
  EXPECT_THAT(top.out, HasSubstr("Exit codes: 0"));
  const ProcessResult run = run_bench({"--solver=lm", "--help"});  // the default verb's help
  EXPECT_THAT(run.out, HasSubstr("--max-evals"));
  EXPECT_THAT(run.out, HasSubstr("[50000]"));
  const ProcessResult version = run_bench({"--version"});
  EXPECT_EQ(version.exit_code, 0);
  // A build without charts says so in a second line.
  EXPECT_THAT(version.out, ::testing::MatchesRegex("bench [0-9.]+ \\(revision .+, .+, .+\\)\n"
                                                   "(HTML reports without charts: .+\n)?"));
}

TEST(Cli, CalibratesTheDemoSetAndKeepsRecordsAndTables) {
  const TemporaryFolder folder;
  const std::string out = (folder / "a/b").string();
  const ProcessResult run = run_bench({"--solver=lm", "--out=" + out, "--seed=3"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, IsEmpty());  // no terminal: no progress
  EXPECT_THAT(names_in(out), ElementsAre("parameters", "runs.jsonl", "tables.csv", "tables.json", "tables.md",
                                         "tables.tex", "tables.txt", "tracks"));
  EXPECT_THAT(names_in(out + "/parameters"), ElementsAre("lm.json"));
  EXPECT_THAT(names_in(out + "/tracks"),
              ElementsAre("1.npy", "2.npy", "reference.npy", "time.npy", "tracks.json"));

  const std::vector<RunRecord> records = read_records(out + "/runs.jsonl");
  ASSERT_THAT(labels_of(records), ElementsAre("nominal", "lm"));
  EXPECT_EQ(records[0].kind, "evaluation");
  const RunRecord& lm = records[1];
  EXPECT_EQ(lm.kind, "run");
  EXPECT_EQ(lm.termination, "converged");
  EXPECT_EQ(lm.dataset, "demo");
  EXPECT_EQ(lm.dataset_sha256.size(), 64u);
  EXPECT_EQ(lm.base_seed, 3u);
  EXPECT_LT(*lm.cost, 0.01 * *records[0].cost);
  EXPECT_EQ(lm.errors.size(), 30u);
  EXPECT_EQ(lm.parameters.size(), 12u);
  EXPECT_GT(lm.derivative_evaluations, 0);
  EXPECT_EQ(lm.evaluations, lm.cost_evaluations + lm.derivative_evaluations);
  EXPECT_FALSE(lm.trace.empty());
  EXPECT_EQ(lm.trace.back().cost, *lm.cost);
  EXPECT_THAT(lm.context.cpu, Not(IsEmpty()));
  EXPECT_THAT(lm.context.git_revision, Not(IsEmpty()));
  EXPECT_THAT(lm.time_utc, ::testing::MatchesRegex("20..-..-..T..:..:..Z"));

  // `bench report` makes the same tables of the file.
  for (const std::string format : {"csv", "json"}) {
    const ProcessResult report = run_bench({"report", out, "--format=" + format});
    EXPECT_EQ(report.exit_code, 0) << report.err;
    EXPECT_EQ(report.out, content(out + "/tables." + format));
  }
}

TEST(Cli, RunsFourSolversOnTheDemoSetByDefault) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_bench({"--max-evals=100", "--out=" + (folder / "out").string()}).exit_code, 0);
  EXPECT_THAT(labels_of(read_records((folder / "out" / "runs.jsonl").string())),
              ElementsAre("nominal", "lm", "ip", "ga", "pso"));
}

TEST(Cli, FindsTheTrueParametersOfTheDemoSet) {
  const TemporaryFolder folder;
  const std::string out = (folder / "out").string();
  ASSERT_EQ(run_bench({"--solver=lm", "--out=" + out}).exit_code, 0);
  const Dataset demo = load_dataset(source_dir() / "datasets/demo/set.json");
  const auto truth = std::find_if(demo.known_parameters.begin(), demo.known_parameters.end(),
                                  [](const NamedParameters& p) { return p.name == "truth"; });
  ASSERT_NE(truth, demo.known_parameters.end());
  const RunRecord lm = read_records(out + "/runs.jsonl").at(1);
  for (std::size_t i = 0; i < 12; ++i)
    EXPECT_NEAR(lm.parameters[i].value, truth->values[i], 0.01 * std::abs(truth->values[i]))
        << lm.parameters[i].name;
}

// Everything that is a result, bit by bit; times are not.
std::string fingerprint(const std::vector<RunRecord>& records) {
  std::string text;
  const auto bits = [&](double value) {
    char buffer[40];
    std::snprintf(buffer, sizeof buffer, " %a", value);
    text += buffer;
  };
  for (const RunRecord& r : records) {
    text += "\n" + r.label + " " + std::to_string(r.repetition) + " " + r.termination + " " +
            std::to_string(r.evaluations) + " " + std::to_string(r.seed);
    if (r.cost) bits(*r.cost);
    for (const ParameterValue& p : r.parameters) bits(p.value);
    for (const TracePoint& t : r.trace) bits(t.cost);
  }
  return text;
}

TEST(Cli, TheSameSeedGivesTheSameBitsForAnyThreads) {
  const TemporaryFolder folder;
  const auto run = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> words = {"--solver=pso,cmaes,lm", "--repeat=3",
                                      "--max-evals=1500",      "--quiet",
                                      "--start=random",        "--out=" + (folder / name).string()};
    words.insert(words.end(), more.begin(), more.end());
    const ProcessResult result = run_bench(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return fingerprint(read_records((folder / name / "runs.jsonl").string()));
  };
  const std::string one = run("one", {"--threads=1"});
  EXPECT_EQ(lines(one).size(), 1u + 1 + 9);
  EXPECT_EQ(one, run("two", {"--threads=2"}));
  EXPECT_EQ(one, run("five", {"--threads=5"}));
  EXPECT_NE(one, run("seed", {"--threads=1", "--seed=2"}));
}

TEST(Cli, ACellGivesTheSameAloneAsInACompany) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_bench({"--solver=lm,cmaes", "--repeat=2", "--max-evals=300", "--quiet",
                       "--out=" + (folder / "both").string()})
                .exit_code,
            0);
  ASSERT_EQ(run_bench({"--solver=cmaes", "--repeat=2", "--max-evals=300", "--quiet",
                       "--out=" + (folder / "alone").string()})
                .exit_code,
            0);
  std::vector<RunRecord> both = read_records((folder / "both" / "runs.jsonl").string());
  const std::vector<RunRecord> alone = read_records((folder / "alone" / "runs.jsonl").string());
  ASSERT_THAT(labels_of(both), ElementsAre("nominal", "lm", "cmaes", "cmaes"));  // lm: deterministic, once
  both.erase(both.begin() + 1);
  EXPECT_EQ(fingerprint(both), fingerprint(alone));
}

TEST(Cli, SolversShareRandomStarts) {
  const TemporaryFolder folder;
  const ProcessResult run =
      run_bench({"--solver=lm,lm[lambda=0.1]", "--start=random", "--repeat=2", "--max-evals=1",
                 "--problem=ellipsoid", "--dimension=3", "--out=" + (folder / "out").string()});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::vector<RunRecord> r = read_records((folder / "out" / "runs.jsonl").string());
  ASSERT_EQ(r.size(), 4u);
  EXPECT_EQ(*r[0].cost, *r[2].cost);  // one evaluation: the start itself
  EXPECT_EQ(*r[1].cost, *r[3].cost);
  EXPECT_NE(*r[0].cost, *r[1].cost);
  EXPECT_NE(r[0].seed, r[2].seed);
  EXPECT_EQ(r[0].dataset, "");
}

TEST(Cli, SaysWhenRepetitionsWouldBeTheSame) {
  const ProcessResult run = run_bench({"--solver=lm,lm", "--repeat=5", "--problem=sphere"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.err, HasSubstr("lm: deterministic, so run once from the nominal start instead of 5 times"));
  EXPECT_THAT(run.err, HasSubstr("'lm' is listed more than once"));
}

TEST(Cli, ASolverThatCannotRunIsARowWithItsReason) {
  const TemporaryFolder folder;
  const ProcessResult run = run_bench({"--solver=lm,cmaes", "--problem=step", "--dimension=2",
                                       "--max-evals=200", "--out=" + (folder / "o").string()});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const std::vector<RunRecord> records = read_records((folder / "o" / "runs.jsonl").string());
  ASSERT_EQ(records.size(), 2u);
  EXPECT_EQ(records[0].kind, "skipped");
  EXPECT_FALSE(records[0].cost);
  EXPECT_THAT(records[0].message, HasSubstr("needs residuals"));
  EXPECT_THAT(run.out, HasSubstr("needs residuals"));
  EXPECT_EQ(run_bench({"--solver=lm", "--problem=step"}).exit_code, 1);  // nothing at all
}

TEST(Cli, PolishesAnySolverButItself) {
  const TemporaryFolder folder;
  const ProcessResult run =
      run_bench({"--solver=lm,cmaes", "--polish=lm", "--max-evals=600", "--out=" + (folder / "o").string()});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::vector<RunRecord> records = read_records((folder / "o" / "runs.jsonl").string());
  ASSERT_THAT(labels_of(records), ElementsAre("nominal", "lm", "cmaes+lm"));
  EXPECT_NEAR(*records[2].cost, *records[1].cost, 1e-6 * *records[1].cost);
  EXPECT_GT(*records[2].cost_before_polish, *records[2].cost);
  EXPECT_LE(records[2].evaluations, 600);
}

TEST(Cli, EveryFormatParses) {
  const std::vector<std::string> run = {"--solver=lm", "--problem=sphere", "--dimension=2"};
  const auto with = [&](const std::string& format) {
    std::vector<std::string> words = run;
    words.push_back("--format=" + format);
    const ProcessResult result = run_bench(words);
    EXPECT_EQ(result.exit_code, 0) << format << result.err;
    return result.out;
  };
  const nlohmann::json json = nlohmann::json::parse(with("json"));
  EXPECT_FALSE(json.at("tables").empty());
  EXPECT_THAT(with("csv"), HasSubstr("#table,"));
  EXPECT_THAT(with("md"), HasSubstr("| lm "));
  EXPECT_THAT(with("latex"), HasSubstr("\\begin{tabular}"));
  EXPECT_THAT(with("console"), HasSubstr("lm"));
}

TEST(Cli, TakesOptionsFromConfigFiles) {
  const TemporaryFolder folder;
  const std::string json = folder.file(
      "c.json",
      R"({"solver": ["lm", "lm[lambda=0.1]"], "problem": "sphere", "max-evals": 30, "quiet": true})");
  const std::string ini =
      folder.file("c.toml",
                  "# experiment\n[run]\nsolver = [\"lm\", \"lm[lambda=0.1]\"]  # two\nproblem = \"sphere\"\n"
                  "max-evals = 30 ; few\nquiet = true\n");
  for (const std::string& file : {json, ini}) {
    const std::string out = file + "_out";
    const ProcessResult run = run_bench(
        {"--config=" + file, "--problem=rosenbrock", "--dimension=2", "--out=" + out});  // overrides
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const std::vector<RunRecord> records = read_records(out + "/runs.jsonl");
    ASSERT_THAT(labels_of(records), ElementsAre("lm", "lm[lambda=0.1]")) << file;
    EXPECT_EQ(records[0].problem, "rosenbrock[n=2]");  // not its usual dimension
    EXPECT_LE(records[0].evaluations, 30);
  }
}

TEST(Cli, EvaluatesFilesAndKnownNames) {
  const TemporaryFolder folder;
  nlohmann::json nominal;
  const Dataset demo = load_dataset(source_dir() / "datasets/demo/set.json");
  for (const RobotParameter& p : demo.robot.parameters) nominal[p.name] = p.nominal;
  nlohmann::json outside = nominal;
  outside["name"] = "too wide";
  outside["a1"] = 0.2;
  const std::string file = folder.file("sets.json", nlohmann::json::array({nominal, outside}).dump(1));
  const ProcessResult run = run_bench({"evaluate", "--parameters=nominal,truth," + file, "--format=json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("'too wide' lie outside the box of the set: a1=0.2"));
  EXPECT_EQ(lines(run.err).size(), 1u);
  EXPECT_THAT(run.out, HasSubstr("sets 1"));
  EXPECT_THAT(run.out, HasSubstr("too wide"));
  EXPECT_TRUE(nlohmann::json::accept(run.out));
}

TEST(Cli, ListsWhatThereIs) {
  const ProcessResult solvers = run_bench({"list", "solvers", "--format=csv"});
  EXPECT_EQ(solvers.exit_code, 0);
  EXPECT_THAT(solvers.out, HasSubstr("lm,lambda,0.001"));
  EXPECT_THAT(run_bench({"list", "problems"}).out, HasSubstr("rosenbrock"));
  EXPECT_THAT(run_bench({"list", "data"}).out, HasSubstr("datasets/demo/set.json"));
  const ProcessResult set =
      run_bench({"list", "data", source_dir().string() + "/datasets/demo/set.json", "--format=md"});
  EXPECT_EQ(set.exit_code, 0) << set.err;
  EXPECT_THAT(set.out, HasSubstr("30 of 6 trajectories"));
  EXPECT_THAT(set.out, HasSubstr("rotation_cw"));
}

TEST(Cli, DemoMakesTheSetOfTheRepository) {
  const TemporaryFolder folder;
  const ProcessResult demo = run_bench({"demo", "--out=" + (folder / "demo").string()});
  ASSERT_EQ(demo.exit_code, 0) << demo.err;
  const std::filesystem::path committed = source_dir() / "datasets/demo/set.json";
  EXPECT_EQ(content(folder / "demo/set.json"), content(committed));
  EXPECT_EQ(run_bench({"demo", "--out=" + (folder / "demo").string()}).exit_code,
            2);  // not replaced silently
  EXPECT_EQ(run_bench({"demo", "--out=" + (folder / "demo").string(), "--seed=5", "--overwrite"}).exit_code,
            0);
  EXPECT_NE(content(folder / "demo/set.json"), content(committed));
}

TEST(Cli, CheckPassesOnTheSameAndFailsOnWhatMoved) {
  const TemporaryFolder folder;
  const std::string out = (folder / "out").string(), golden = (folder / "golden.json").string();
  ASSERT_EQ(run_bench({"--solver=lm", "--out=" + out}).exit_code, 0);
  ASSERT_EQ(run_bench({"check", "--update", "--baseline=" + golden, out}).exit_code, 0);
  const ProcessResult same = run_bench({"check", "--baseline=" + golden, out});
  EXPECT_EQ(same.exit_code, 0) << same.out << same.err;

  ASSERT_EQ(run_bench({"--solver=lm", "--max-evals=5", "--out=" + out, "--overwrite"}).exit_code, 0);
  const ProcessResult moved = run_bench({"check", "--baseline=" + golden, out + "/runs.jsonl"});
  EXPECT_EQ(moved.exit_code, 1);
  EXPECT_THAT(moved.out, HasSubstr("lm"));
}

TEST(Cli, CalibratesTheRealRobot) {
  ODOBENCH_NEEDS_SHARED();
  const TemporaryFolder folder;
  const std::string set = (folder / "set.json").string(), out = (folder / "out").string();
  const ProcessResult import =
      run_bench({"import", "vitko2024",
                 "--from=" + (testing::shared_folder() / "datasets/vitko2024").string(), "--out=" + set});
  ASSERT_EQ(import.exit_code, 0) << import.err;
  const ProcessResult run = run_bench({"--solver=lm", "--data=" + set, "--out=" + out});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::vector<RunRecord> records = read_records(out + "/runs.jsonl");
  EXPECT_NEAR(*records.at(0).cost, 1135.3322706653605, 1e-8 * 1135.33);
  EXPECT_LE(*records.at(1).cost, 98.11878293 * (1 + 1e-6));
  std::vector<std::string> bound;
  for (const ParameterValue& p : records[1].parameters)
    if (!p.at_bound.empty()) bound.push_back(p.name);
  EXPECT_THAT(bound, ElementsAre("a1", "a2", "b1", "b2", "b4", "r2"));
  // shared/reference/identifiability.json: singular values 2903.05 .. 0.0609.
  std::string flat = run.out;
  std::replace(flat.begin(), flat.end(), '\n', ' ');
  EXPECT_THAT(flat, HasSubstr("2.9e+03"));
  EXPECT_THAT(flat, HasSubstr("0.061"));
  const ProcessResult published =
      run_bench({"evaluate", "--data=" + set, "--parameters=published:lm", "--format=csv"});
  EXPECT_EQ(published.exit_code, 0) << published.err;
  EXPECT_THAT(published.out, HasSubstr("published:lm,318.859"));
}

}  // namespace
}  // namespace odobench
