// `bench filter` as users see it: what it computes from their files, the options, the refusals, interruption.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "reports/records/record.hpp"
#include "tests/support/data/filter_run_files.hpp"
#include "tests/support/data/small_dataset.hpp"
#include "tests/support/data_error.hpp"
#include "tests/support/measures.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/shared_data.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;
using testing::CircleRun;
using testing::content;
using testing::everything_in;
using testing::expect_refusal;
using ::testing::HasSubstr;
using testing::kData;
using testing::kUsage;
using testing::lines;
using testing::plain_run;
using testing::Process;
using testing::ProcessResult;
using testing::replaced;
using testing::run_bench;
using testing::TemporaryFolder;

using Row = std::vector<std::string>;

Row split(const std::string& line) {
  Row fields;
  std::istringstream in(line.substr(0, line.find('\r')) + ",");
  for (std::string field; std::getline(in, field, ',');) fields.push_back(field);
  return fields;
}

std::vector<Row> csv(const fs::path& file) {
  std::vector<Row> rows;
  for (const std::string& line : lines(content(file))) rows.push_back(split(line));
  return rows;
}

// The rows of a JSON table by its id.
nlohmann::json table(const std::string& out, const std::string& id) {
  const nlohmann::json document = nlohmann::json::parse(out);
  for (const auto& t : document.at("tables"))
    if (t.at("id") == id) return t.at("rows");
  throw std::runtime_error("no table " + id + " in " + out);
}

// Runs with --format=json; the run must succeed.
std::string filter(std::vector<std::string> words) {
  words.insert(words.begin(), "filter");
  words.push_back("--format=json");
  const ProcessResult result = run_bench(words);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return result.out;
}

// The largest RMS error after the filter over all channels but the accelerations, and over those.
struct Worst {
  double motion = 0, acceleration = 0;
};
Worst worst_error(const std::string& out, const std::string& solver) {
  Worst worst;
  for (const auto& row : table(out, "noise." + solver)) {
    const bool acceleration = row.at("channel") == "ax" || row.at("channel") == "ay";
    const std::string measure = row.at("measure");
    if (measure.rfind("RMS", 0) != 0) continue;
    double& value = acceleration ? worst.acceleration : worst.motion;
    value = std::max(value, row.at("after").get<double>());
  }
  return worst;
}

// A robot on a circle: with the right frames, units and signs the model holds exactly.
TEST(CliFilter, ACircleComesOutExactly) {
  for (const bool right_first : {true, false}) {
    const TemporaryFolder folder;
    CircleRun run;
    run.right_first = right_first;
    const std::vector<std::string> words = {
        "--data=" + folder.file("run.csv", run.data()), "--truth=" + folder.file("truth.csv", run.truth()),
        fmt::format("--wheel-distance={}", run.wheel_distance()), "--solver=zero",
        right_first ? "--wheel-order=right-first" : "--wheel-order=left-first"};
    const Worst right = worst_error(filter(words), "zero");
    EXPECT_LT(right.motion, 1e-10) << right_first;
    EXPECT_LT(right.acceleration, 1e-9) << right_first;

    // Each choice, taken wrongly, shows.
    const auto with = [&](const char* option) {
      std::vector<std::string> changed = words;
      if (std::string(option).rfind("--wheel-order", 0) == 0) changed.pop_back();
      changed.push_back(option);
      return worst_error(filter(changed), "zero");
    };
    EXPECT_GT(with("--accelerometer-frame=filter").acceleration, 0.01);
    EXPECT_GT(with("--omega-cross-v=off").acceleration, 0.01);
    EXPECT_GT(with(right_first ? "--wheel-order=left-first" : "--wheel-order=right-first").motion, 5e-4);
  }
}

TEST(CliFilter, TheRotationComesOutInTheSenseItWentIn) {
  const TemporaryFolder folder;
  CircleRun run;
  run.right_first = false;
  filter({"--data=" + folder.file("run.csv", run.data()), "--wheel-order=left-first", "--solver=zero",
          "--out=" + (folder / "out.csv").string()});
  const std::vector<Row> rows = csv(folder / "out.csv");
  EXPECT_EQ(rows[0][9], "theta_po");
  EXPECT_NEAR(std::stod(rows[1][9]), run.omega * run.dt * 180 / std::numbers::pi, 0.01);
}

TEST(CliFilter, WindowsColumnsAndTimes) {
  const TemporaryFolder folder;
  const std::string out = (folder / "deep/out.csv").string();
  const std::string data = folder.file("run.csv", plain_run(20));
  const std::string text = filter({"--data=" + data, "--out=" + out, "--samples=5"});
  const std::vector<Row> rows = csv(out);
  ASSERT_EQ(rows.size(), 1u + 20 - 5 + 1);
  EXPECT_EQ(rows[0], split("Laikas,enc1_po,enc2_po,enc3_po,enc4_po,,ax_po,ay_po,,theta_po,,enc1x_po,enc1y_po,"
                           "enc2x_po,enc2y_po,enc3x_po,enc3y_po,enc4x_po,enc4y_po,H,iterations,r1,sx1,sy1,"
                           "t0,t1,t2,t3,t4,t5,t6,t7,t8,t9,time_s"));
  for (std::size_t k = 1; k < rows.size(); ++k) {
    ASSERT_EQ(rows[k].size(), rows[0].size());
    EXPECT_EQ(rows[k][0], std::to_string(k - 1));
    EXPECT_NEAR(std::stod(rows[k].back()), 0.1 * static_cast<double>(k - 1), 1e-12);
    for (const std::size_t empty : {5u, 8u, 10u}) EXPECT_EQ(rows[k][empty], "");
  }
  EXPECT_EQ(table(text, "filter")[0].at("windows"), 16);
  EXPECT_THAT(everything_in(folder.path()), ::testing::ElementsAre("deep", "out.csv", "run.csv"));

  // As published the last two windows are dropped.
  filter({"--data=" + data, "--out=" + out, "--samples=5", "--as-published", "--overwrite"});
  EXPECT_EQ(csv(out).size(), 1u + 14);
}

TEST(CliFilter, ThePublishedConstantsAndTheCorrectedOnes) {
  const TemporaryFolder folder;
  const std::string data = "--data=" + folder.file("run.csv", plain_run(15));
  const auto notes = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"filter", data};
    words.insert(words.end(), more.begin(), more.end());
    return run_bench(words).out;
  };
  EXPECT_THAT(notes({}), HasSubstr("0.490189"));
  EXPECT_THAT(notes({"--as-published"}), HasSubstr("0.0085554224 deg/s^2"));
  EXPECT_THAT(notes({"--step-rotation=2"}), HasSubstr(" 2 deg/s^2"));
}

// H only grows from one method to the next, and gaps are measured against the right ones.
TEST(CliFilter, MethodsInOrder) {
  const TemporaryFolder folder;
  const std::string data = "--data=" + folder.file("run.csv", plain_run(40));
  std::map<std::string, nlohmann::json> rows;
  for (const std::string solver : {"zero", "coordinate", "exact", "relaxed", "lm"})
    rows[solver] = table(filter({data, "--gap", "--solver=" + solver}), "filter")[0];
  const auto mean = [&](const char* solver) { return rows[solver].at("hamiltonian_mean").get<double>(); };
  EXPECT_LT(mean("zero"), mean("coordinate"));
  EXPECT_LE(mean("coordinate"), mean("exact") + 1e-12 * std::abs(mean("exact")));
  EXPECT_LT(mean("exact"), mean("relaxed"));
  EXPECT_NEAR(mean("lm"), mean("relaxed"), 1e-6 * std::abs(mean("relaxed")));
  EXPECT_EQ(rows["exact"].at("at_optimum"), 100);
  EXPECT_EQ(rows["zero"].at("gain_mean"), 0);
  EXPECT_NEAR(rows["coordinate"].at("gap_exact_mean").get<double>(), mean("exact") - mean("coordinate"),
              1e-8 * std::abs(mean("exact")));
  EXPECT_NEAR(rows["exact"].at("gap_relaxed_mean").get<double>(), mean("relaxed") - mean("exact"),
              1e-8 * std::abs(mean("exact")));
}

TEST(CliFilter, APipeGivesTheSameBits) {
  const TemporaryFolder folder;
  const std::string data = folder.file("run.csv", plain_run(3000));
  const std::string a = (folder / "a.csv").string(), b = (folder / "b.csv").string();
  filter({"--data=" + data, "--out=" + a});
  const std::string bench = testing::bench_words({}).front();
  Process piped({"/bin/sh", "-c", "cat " + data + " | " + bench + " filter --data=- --out=" + b});
  const ProcessResult result = piped.wait();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(content(a), content(b));
  EXPECT_EQ(lines(content(b)).size(), 1u + 3000 - 9);
}

// Largest resident memory of bench with these words [KiB].
long peak_memory(const std::vector<std::string>& words) {
  const pid_t child = fork();
  if (child == 0) {
    std::vector<std::string> copy = testing::bench_words(words);
    std::vector<char*> argv;
    for (std::string& word : copy) argv.push_back(word.data());
    argv.push_back(nullptr);
    if (freopen("/dev/null", "w", stdout) != nullptr) execv(argv[0], argv.data());
    _exit(127);
  }
  int status = 0;
  rusage usage = {};
  EXPECT_EQ(wait4(child, &status, 0, &usage), child);
  EXPECT_EQ(status, 0);
  return usage.ru_maxrss;
}

TEST(CliFilter, MemoryDoesNotGrowWithTheRun) {
  if (testing::bench_is_sanitized()) GTEST_SKIP() << "the sanitizer keeps freed memory";
  const TemporaryFolder folder;
  const std::string data = (folder / "run.csv").string();
  const auto peak = [&](int rows) {
    {
      std::ofstream file(data);  // not through a string: a forked process begins with the memory of this one
      testing::write_plain_run(file, rows);
    }
    return peak_memory(
        {"filter", "--data=" + data, "--gap", "--out=" + (folder / "out.csv").string(), "--overwrite"});
  };
  const long small = peak(1000), large = peak(50000);  // 0.1 and 5 MB in, 0.5 and 25 MB out
  EXPECT_LT(large - small, 4096);
}

TEST(CliFilter, RecordsAndReport) {
  const TemporaryFolder folder;
  CircleRun run;
  const std::string records = (folder / "records").string();
  const std::string out =
      filter({"--data=" + folder.file("run.csv", run.data()), "--gap",
              "--truth=" + folder.file("truth.csv", run.truth()), "--records=" + records});
  EXPECT_EQ(everything_in(records), (std::vector<std::string>{"runs.jsonl", "tables.csv", "tables.json",
                                                              "tables.md", "tables.tex", "tables.txt"}));
  const std::vector<RunRecord> list = read_records(records + "/runs.jsonl");
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0].problem, "entropy_filter");
  EXPECT_EQ(list[0].dataset, "run");
  EXPECT_EQ(list[0].dataset_sha256.size(), 64u);
  EXPECT_EQ(list[0].label, "coordinate");
  EXPECT_EQ(list[0].measures.value("windows"), run.rows - 9);
  EXPECT_GE(list[0].measures.value("gap_exact_mean").value_or(-1), 0);
  testing::expect_as_in_schema_1(list[0]);
  EXPECT_GT(list[0].iterations, 0);
  EXPECT_GT(list[0].evaluations, 0);
  const ProcessResult report = run_bench({"report", records, "--format=json"});
  EXPECT_EQ(report.out, out);
  expect_refusal({"filter", "--data=x.csv", "--records=" + records}, kUsage,
                 {"--records=", "holds runs.jsonl already"});
}

struct Refusal {
  const char* from;
  const char* to;
  std::vector<std::string> parts;
};

TEST(CliFilter, BadDataLeavesNothing) {
  const std::vector<Refusal> cases = {
      {"enc3_m", "enc3", {"run.csv:1: found no column \"enc3_m\"; the nearest is \"enc3\""}},
      {"yaw_step_deg", "turn", {"run.csv:1: found no rotation column"}},
      {"enc3_m,enc4_m", "enc3_m,enc3_m", {"run.csv:1: found two columns \"enc3_m\""}},
      {"\n1.00,", "\n1.00,x", {"run.csv:12: found \"x", "expected a finite number"}},
      {"\n1.00,", "\nnan,", {"run.csv:12: found \"nan\" in column \"time_s\""}},
      {"\n1.00,", "\n1.05,", {"run.csv:12: found a time step of 0.15 s, expected 0.1 s within 40 %"}},
      {"\n1.00,", "\n0.80,", {"run.csv:12: found the time 0.8 s after 0.9 s"}},
      {"\n1.00,", "\n1.00,1,", {"run.csv:12: found 9 fields, expected 8"}},
  };
  for (const Refusal& c : cases) {
    const TemporaryFolder folder;
    const std::string data = folder.file("run.csv", replaced(plain_run(30), c.from, c.to));
    expect_refusal({"filter", "--data=" + data, "--out=" + (folder / "new/out.csv").string()}, kData,
                   c.parts);
    EXPECT_EQ(everything_in(folder.path()), std::vector<std::string>{"run.csv"});
  }
}

TEST(CliFilter, TooFewRowsOrHalfALine) {
  const TemporaryFolder folder;
  const std::string out = "--out=" + (folder / "out.csv").string();
  const std::string text = plain_run(30);
  const auto refused = [&](const std::string& data, std::vector<std::string> more, const std::string& part) {
    std::vector<std::string> words = {"filter", "--data=" + folder.file("run.csv", data), out};
    words.insert(words.end(), more.begin(), more.end());
    expect_refusal(words, kData, {part});
    EXPECT_EQ(everything_in(folder.path()), std::vector<std::string>{"run.csv"});
  };
  refused(plain_run(9), {}, "run.csv:10: found the end of the file after 9 rows, expected at least 10");
  refused(plain_run(11), {"--as-published"}, "after 11 rows, expected at least 12");
  refused(text.substr(0, text.rfind(',')), {}, "run.csv:31: found the end of the file inside the line");
  refused("", {}, "run.csv:1: found an empty file");
  refused(text.substr(0, text.find('\n') + 1), {}, "found the end of the file after 0 rows");
}

TEST(CliFilter, SteeringAndTruthThatDoNotFit) {
  const TemporaryFolder folder;
  CircleRun run;
  const std::string out = "--out=" + (folder / "out.csv").string();
  const std::string half = folder.file("half.csv", replaced(run.data(), "psi2_rad", "psi_rad"));
  expect_refusal({"filter", "--data=" + half, out}, kData,
                 {"half.csv:1:", "no column \"psi2_rad\"", "all four"});
  const std::string data = folder.file("run.csv", run.data());
  const auto truth_of = [&](int rows) {
    run.rows = rows;
    return "--truth=" + folder.file("truth.csv", run.truth());
  };
  expect_refusal(
      {"filter", "--data=" + data, truth_of(29), out}, kData,
      {"truth.csv:30: found the end of the file after 29 rows, expected as many as in", "run.csv"});
  expect_refusal({"filter", "--data=" + data, truth_of(31), out}, kData,
                 {"truth.csv:32: found more than 30 rows"});
  expect_refusal({"filter", "--data=" + data, truth_of(31), out, "--as-published"}, kData,
                 {"truth.csv:32: found more than 30 rows"});
  expect_refusal({"filter", "--data=" + data, truth_of(30), out, "--truth-columns=sx=x"}, kData,
                 {"truth.csv:1: found no column \"x\" (for sx_m)"});
  EXPECT_EQ(everything_in(folder.path()), (std::vector<std::string>{"half.csv", "run.csv", "truth.csv"}));
}

TEST(CliFilter, WrongUsage) {
  const TemporaryFolder folder;
  const std::string data = "--data=" + folder.file("run.csv", plain_run(30));
  const auto refused = [&](const std::string& option, const std::vector<std::string>& parts) {
    expect_refusal({"filter", data, option}, kUsage, parts);
  };
  expect_refusal({"filter"}, kUsage, {"--data"});
  refused("--sigma-encoder=0", {"--sigma-encoder=0: expected a finite number > 0"});
  refused("--sigma-rotation=-1", {"--sigma-rotation=-1"});
  refused("--dt=0", {"--dt=0: expected a finite number > 0"});
  refused("--samples=2", {"--samples=2: expected a whole number in 3..1000"});
  refused("--solver=exakt", {"unknown solver 'exakt', did you mean 'exact'?"});
  refused("--solver=exact,lm", {"--solver=exact,lm: expected one solver"});
  refused("--solver=zero[a=1]", {"--solver=zero: takes no options"});
  refused("--theta=step-deg", {"--theta=step-deg", "thesis' layout"});
  refused("--theta=step", {"--theta=step: expected absolute-deg"});
  refused("--wheel-order=front", {"--wheel-order=front: expected right-first or left-first"});
  refused("--accelerometer-frame=world", {"expected robot or filter"});
  refused("--omega-cross-v=1", {"--omega-cross-v=1: expected on or off"});
  refused("--columns=enc5=x", {"--columns: unknown name 'enc5'"});
  refused("--columns=enc1", {"expected name=column, found 'enc1'"});
  refused("--columns=yaw=x", {"'yaw' needs its unit"});
  refused("--columns=enc1=a,enc1_m=b", {"'enc1_m' is given twice"});
  refused("--out=" + (folder / "run.csv").string(), {"it exists; choose another name or give --overwrite"});
  expect_refusal({"filter", "--data=" + (folder / "none.csv").string()}, kData,
                 {"none.csv", "cannot be read"});
}

// The series that an independent transcription of the thesis' program gives, cell by cell.
void expect_series(const std::string& solver, const std::string& expected, bool compare_iterations) {
  const TemporaryFolder folder;
  const fs::path reference = testing::shared_folder() / "reference";
  const fs::path out = folder / "out.csv";
  filter({"--data=" + (reference / "entropy_series_csharp.csv").string(), "--as-published",
          "--solver=" + solver, "--out=" + out.string()});
  const std::vector<Row> got = csv(out), want = csv(reference / expected);
  ASSERT_EQ(got.size(), want.size());
  ASSERT_EQ(got.size(), 190u);
  ASSERT_EQ(got[0], want[0]);
  for (std::size_t k = 1; k < want.size(); ++k) {
    ASSERT_EQ(got[k].size(), want[k].size());
    for (std::size_t c = 0; c < want[k].size(); ++c) {
      const std::string& name = want[0][c];
      const std::string where = fmt::format("window {}, {}", want[k][0], name);
      if (name == "iterations" && !compare_iterations) continue;
      if (name.empty() || name[0] == 't' || name == "Laikas" || name == "iterations") {
        if (name != "theta_po") {
          EXPECT_EQ(got[k][c], want[k][c]) << where;
          continue;
        }
      }
      const double a = std::stod(got[k][c]), b = std::stod(want[k][c]);
      EXPECT_NEAR(a, b, 1e-9 * std::abs(b) + 1e-12) << where;
    }
  }
}

TEST(CliFilter, ThePublishedProgramsSeriesGreedy) {
  ODOBENCH_NEEDS_SHARED();
  expect_series("coordinate", "entropy_series_csharp_greedy.csv", true);
}
TEST(CliFilter, ThePublishedProgramsSeriesExact) {
  ODOBENCH_NEEDS_SHARED();
  expect_series("exact", "entropy_series_csharp_exact.csv", false);
}

// Columns of another maker's file by mapping: noise-free encoders, noisy everything else of the thesis'
// simulated robot.
TEST(CliFilter, OtherColumnNames) {
  ODOBENCH_NEEDS_SHARED();
  const fs::path data = testing::shared_folder() / "reference" / "dynamics_filter_run.csv";
  const std::string out = filter({"--data=" + data.string(), "--wheel-order=left-first",
                                  "--columns=time=t,enc1=enc1_n,enc2=enc2_n,enc3=enc3_n,enc4=enc4_n,ax=ax_"
                                  "body,ay=ay_body,yaw_rad=theta_ccw_n"});
  EXPECT_EQ(table(out, "filter")[0].at("windows"), 200 - 9);
}

}  // namespace
}  // namespace odobench
