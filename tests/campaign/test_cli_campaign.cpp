// `bench campaign`, `bench store` and `bench run --resume` as users call them: kills, two processes, a full
// disc, and what they get wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/refusal.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;
using testing::bench_program;
using testing::bench_words;
using testing::content;
using testing::expect_refusal;
using ::testing::HasSubstr;
using testing::kData;
using testing::kInterrupted;
using testing::kUsage;
using testing::lines;
using testing::Process;
using testing::ProcessResult;
using testing::run_bench;
using testing::TemporaryFolder;

const std::string kSmoke = (source_dir() / "campaigns" / "smoke.json").string();
constexpr const char* kResults = "SELECT key, result FROM cells ORDER BY key";

// Hundreds of cells of a few milliseconds each.
std::string many_cells(const TemporaryFolder& folder, int repeat = 40) {
  return folder.file("many.json", R"({"schema_version": 1, "name": "many", "solvers": ["pso", "ga"],
    "problems": ["rosenbrock", "rastrigin"], "budgets": {"evaluations": 2000}, "repeat": )" +
                                      std::to_string(repeat) + "}");
}

ProcessResult succeed(const std::vector<std::string>& words, double timeout_s = 120) {
  ProcessResult result = run_bench(words, timeout_s);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return result;
}

std::string results_of(const std::string& store) {
  return succeed({"store", "query", store, kResults, "--format=csv"}).out;
}

std::size_t count_of(const std::string& store) {
  const auto answer = nlohmann::json::parse(
      succeed({"store", "query", store, "SELECT count(*) AS n FROM cells", "--json"}).out);
  return answer["tables"][0]["rows"][0]["n"].get<std::size_t>();
}

bool wait_for_records(const std::string& store, std::size_t count) {
  for (int i = 0; i < 3000; ++i) {
    if (fs::exists(store) && fs::file_size(store) > 0) {
      const ProcessResult r =
          run_bench({"store", "query", store, "SELECT count(*) AS n FROM cells", "--json"});
      if (r.exit_code == 0 &&
          nlohmann::json::parse(r.out)["tables"][0]["rows"][0]["n"].get<std::size_t>() >= count)
        return true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

TEST(CliCampaign, SmokeFromPlanToReport) {
  const TemporaryFolder folder;
  const std::string store = (folder / "smoke.db").string();
  const ProcessResult plan = succeed({"campaign", kSmoke, "--dry-run", "--out=" + store});
  EXPECT_THAT(plan.out, HasSubstr("Campaign smoke: 55 cells on 5 problems, 0 there, 55 to run"));
  EXPECT_FALSE(fs::exists(store));
  const ProcessResult run = succeed({"campaign", kSmoke, "--out=" + store});
  EXPECT_THAT(run.out, HasSubstr("55 cells, 0 kept, 55 run in "));
  const std::string results = results_of(store);
  const ProcessResult again = succeed({"campaign", kSmoke, "--out=" + store, "--threads=1"});
  EXPECT_THAT(again.err, HasSubstr("55 of 55 cells are in "));
  EXPECT_THAT(again.out, HasSubstr("55 kept, 0 run in "));
  EXPECT_EQ(results_of(store), results);

  const ProcessResult csv = succeed({"campaign", kSmoke, "--dry-run", "--out=" + store, "--format=csv"});
  EXPECT_THAT(csv.out, HasSubstr("nist:Misra1a/1/lm/1,"));
  EXPECT_THAT(csv.out, HasSubstr(",yes"));
  EXPECT_THAT(succeed({"store", "info", store}).out, HasSubstr("Campaigns in "));
  const ProcessResult tables = succeed({"report", store});
  EXPECT_THAT(tables.out, HasSubstr("nlopt:bobyqa+lm"));
  EXPECT_THAT(tables.out, HasSubstr("nominal"));
  succeed({"report", store, "--out=" + (folder / "page.html").string()});
  EXPECT_THAT(content(folder / "page.html"), HasSubstr("nlopt:bobyqa+lm"));
  EXPECT_EQ(run_bench({"compare", store, store, "--fail-on=J:+0.1%"}).exit_code, 0);

  // Out as lines, and in again.
  const std::string file = (folder / "runs.jsonl").string(), copy = (folder / "copy.db").string();
  succeed({"store", "export", store, "--out=" + file});
  EXPECT_EQ(lines(content(file)).size(), 56u);  // with the nominal parameters
  EXPECT_EQ(succeed({"store", "export", store}).out, content(file));
  succeed({"store", "import", copy, file, store});
  EXPECT_EQ(results_of(copy), results);
  expect_refusal({"store", "export", store, "--out=" + file}, kUsage, {"it exists"});
}

TEST(CliCampaign, KilledAtAnyMomentItGoesOnToTheSameResults) {
  const TemporaryFolder folder;
  const std::string file = many_cells(folder), whole = (folder / "whole.db").string();
  const auto begin = std::chrono::steady_clock::now();
  succeed({"campaign", file, "--out=" + whole, "--threads=2"});
  const auto duration = std::chrono::steady_clock::now() - begin;
  const std::string expected = results_of(whole);
  const std::string store = (folder / "killed.db").string();
  for (const double part : {0.05, 0.41, 0.3, 0.5, 0.2}) {  // of the time that all of it takes
    Process process(bench_words({"campaign", file, "--out=" + store, "--threads=2"}));
    std::this_thread::sleep_for(duration * part);
    process.send(SIGKILL);
    process.wait();
    if (fs::exists(store) && fs::file_size(store) > 0) {
      const ProcessResult check = run_bench({"store", "query", store, "SELECT count(*) FROM cells"});
      if (check.exit_code != 0) EXPECT_THAT(check.err, HasSubstr("found an empty store"));
    }
  }
  succeed({"campaign", file, "--out=" + store, "--threads=1"});
  EXPECT_EQ(results_of(store), expected);
}

TEST(CliCampaign, CtrlCDropsWhatRuns) {
  const TemporaryFolder folder;
  const std::string file = many_cells(folder, 1000), store = (folder / "a.db").string();
  for (const char* isolate : {"", "--isolate"}) {
    std::vector<std::string> words{"campaign", file, "--out=" + store, "--threads=2"};
    if (*isolate != 0) words.emplace_back(isolate);
    const std::size_t before = fs::exists(store) ? count_of(store) : 0;
    Process process(bench_words(words));
    ASSERT_TRUE(wait_for_records(store, before + 5));
    process.send(SIGINT);
    const ProcessResult result = process.wait();
    EXPECT_EQ(result.exit_code, kInterrupted) << result.err;
    EXPECT_THAT(result.err, HasSubstr("the same command goes on"));
    EXPECT_THAT(succeed({"store", "query", store,
                         "SELECT count(*) AS n FROM cells WHERE termination='interrupted'", "--format=csv"})
                    .out,
                HasSubstr("\n0\r"));
  }
}

TEST(CliCampaign, TwoProcessesOnOneStore) {
  const TemporaryFolder folder;
  const std::string file = many_cells(folder, 2000), store = (folder / "a.db").string();
  Process first(bench_words({"campaign", file, "--out=" + store, "--threads=1"}));
  ASSERT_TRUE(wait_for_records(store, 1));
  const ProcessResult second = run_bench({"campaign", file, "--out=" + store});
  EXPECT_EQ(second.exit_code, kUsage);
  EXPECT_THAT(second.err, HasSubstr("a.db: process "));
  EXPECT_THAT(second.err, HasSubstr("is writing there"));
  EXPECT_EQ(lines(second.err).size(), 1u);
  Process third(bench_words({"campaign", kSmoke, "--out=" + store, "--wait=60"}));
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  first.send(SIGINT);
  EXPECT_EQ(first.wait().exit_code, kInterrupted);
  const ProcessResult waited = third.wait();  // and then sees that the store is another campaign's
  EXPECT_EQ(waited.exit_code, kUsage);
  EXPECT_THAT(waited.err, HasSubstr("found campaign 'many', expected campaign 'smoke'"));
}

TEST(CliCampaign, AFullDiscLeavesAWholeStore) {
  const TemporaryFolder folder;
  const std::string file = many_cells(folder, 10), store = (folder / "a.db").string();
  Process full({"/bin/sh", "-c", "ulimit -f 120; exec \"$0\" campaign \"$1\" --out=\"$2\" --threads=1",
                bench_program(), file, store});
  const ProcessResult result = full.wait();
  EXPECT_EQ(result.exit_code, kData) << result.err;
  EXPECT_THAT(result.err, HasSubstr("a.db: "));
  EXPECT_EQ(lines(result.err).size(), 1u) << result.err;
  EXPECT_GT(count_of(store), 0u);
  succeed({"campaign", file, "--out=" + store});
  const std::string other = (folder / "b.db").string();
  succeed({"campaign", file, "--out=" + other});
  EXPECT_EQ(results_of(store), results_of(other));
}

TEST(CliCampaign, BadInput) {
  const TemporaryFolder folder;
  const auto campaign = [&](const std::string& name, const std::string& solvers,
                            const std::string& more = "") {
    return folder.file(name, "{\"schema_version\": 1, \"name\": \"x\",\n \"solvers\": " + solvers +
                                 ",\n \"problems\": [\"sphere\"]" + more + "}");
  };
  const std::string out = "--out=" + (folder / "new.db").string();
  const std::string good = campaign("good.json", "[\"lm\"]");
  expect_refusal({"campaign", campaign("k.json", "[\"lm\"]", ",\n \"repeets\": 2"), out}, kData,
                 {"k.json:4: /repeets: found unknown key \"repeets\", did you mean 'repeat'?"});
  expect_refusal({"campaign", campaign("e.json", "[]"), out}, kData,
                 {"e.json:2: /solvers: found an empty list, expected at least one solver"});
  expect_refusal(
      {"campaign", campaign("u.json", "[{\"name\": \"psoo\", \"options\": {\"swarm\": [1, 2]}}]"), out},
      kData, {"u.json:2: /solvers/0: unknown solver 'psoo', did you mean 'pso'?"});
  expect_refusal({"campaign", (folder / "absent.json").string(), out}, kData,
                 {"absent.json: cannot be read"});
  expect_refusal({"campaign", good}, kUsage, {"--out is missing"});
  expect_refusal({"campaign", good, out, "--shard=3/2"}, kUsage, {"--shard=3/2: expected i/n"});
  expect_refusal({"campaign", good, out, "--isolate=cpu=3"}, kUsage, {"--isolate: found 'cpu=3'"});
  expect_refusal({"campaign", good, out, "--only=sphere/pso*"}, kUsage, {"no cell is called so"});
  expect_refusal({"campaign", good, "--out=" + folder.path().string()}, kData, {"cannot be written"});
  expect_refusal({"campaign", good, "--out=/proc/new.db"}, kUsage, {"/proc/new.db: cannot be written"});
  expect_refusal({"campaign", good, "--out=" + good}, kUsage, {"is no store of records"});
  expect_refusal({"store", "infos", "x"}, kUsage, {"did you mean 'info'?"});
  expect_refusal({"store", "info", good}, kData, {"found no store of records"});
  expect_refusal({"store", "query", good}, kUsage, {"a statement of SQL is missing"});
  EXPECT_FALSE(fs::exists(folder / "new.db"));

  const std::string shard = (folder / "shard.db").string();
  succeed({"campaign", kSmoke, "--out=" + shard, "--shard=1/20", "--quiet"});
  expect_refusal({"campaign", kSmoke, "--out=" + shard, "--shard=2/20", "--quiet"}, kUsage,
                 {"found shard 1/20 of campaign 'smoke', expected shard 2/20"});
  succeed({"campaign", good, out, "--quiet"});
  expect_refusal({"store", "import", (folder / "new.db").string(), shard, "--same-campaign"}, kUsage,
                 {"found campaign 'smoke' of plan", "expected 'x' of plan"});
  expect_refusal({"store", "import", shard, shard}, kUsage, {"found the store itself"});
  expect_refusal({"store", "query", shard, "DROP TABLE cells"}, kUsage, {"SQL: not authorized"});
}

TEST(CliResume, ARunGoesOnToTheSameRecords) {
  const TemporaryFolder folder;
  const std::vector<std::string> words{"--solver=pso,lm", "--problem=calibration,rosenbrock",
                                       "--repeat=12",     "--max-evals=1000",
                                       "--threads=2",     "--quiet"};
  const auto with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all = words;
    all.insert(all.end(), more.begin(), more.end());
    return all;
  };
  const std::string whole = (folder / "whole").string(), part = (folder / "part").string();
  succeed(with({"--out=" + whole}));
  Process process(bench_words(with({"--out=" + part, "--resume"})));
  ASSERT_TRUE(testing::wait_for_lines(folder / "part" / "runs.jsonl", 5));
  process.send(SIGKILL);
  process.wait();
  const std::string cut = content(folder / "part" / "runs.jsonl");
  folder.file("part/runs.jsonl", cut + "{\"schema_version\": 2, \"pro");  // a write that was cut
  const ProcessResult resumed = run_bench({"--solver=pso,lm", "--problem=calibration,rosenbrock",
                                           "--repeat=12", "--max-evals=1000", "--out=" + part, "--resume"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_THAT(resumed.err, HasSubstr("the last record is cut off and left out"));
  EXPECT_THAT(resumed.err, HasSubstr(" of 26 runs are there already and are kept; "));
  for (const std::string& one : {whole, part}) succeed({"store", "import", one + ".db", one});
  EXPECT_EQ(results_of(whole + ".db"), results_of(part + ".db"));
  EXPECT_EQ(lines(content(folder / "part" / "runs.jsonl")).size(),
            lines(content(folder / "whole" / "runs.jsonl")).size());

  expect_refusal(with({"--resume"}), kUsage, {"--resume: --out is missing"});
  expect_refusal(with({"--resume", "--overwrite", "--out=" + part}), kUsage, {"contradicts --overwrite"});
  expect_refusal({"--solver=lm", "--problem=rosenbrock", "--out=" + part, "--resume", "--quiet"}, kUsage,
                 {"--resume: found ", " runs that this command does not make, such as "});
  EXPECT_EQ(lines(content(folder / "part" / "runs.jsonl")).size(), 27u);
}

}  // namespace
}  // namespace odobench
