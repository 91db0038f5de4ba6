// Campaigns as a library: files, plans, keys, the store, shards, isolation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "base/sqlite.hpp"
#include "bench/studies/campaign/campaign.hpp"
#include "bench/studies/campaign/store_study.hpp"
#include "bench/studies/context.hpp"
#include "bench/studies/records.hpp"
#include "reports/records/record_key.hpp"
#include "reports/records/record_store.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
namespace fs = std::filesystem;

// A campaign of 2 problems, 3 solvers (a grid of two), 2 repetitions of those that are random.
const std::string kSmall = R"({
  "schema_version": 1, "name": "small",
  "solvers": ["lm", {"name": "pso", "options": {"swarm": [10, 20]}}],
  "problems": ["rosenbrock", "nist:Misra1a/1"],
  "budgets": {"evaluations": 200},
  "repeat": 2
})";

template <class Call>
std::string message_of(const Call& call) {
  try {
    call();
  } catch (const std::exception& e) {
    return e.what();
  }
  return "nothing was thrown";
}

class Notes final : public Watcher {
 public:
  explicit Notes(std::size_t stop_after = 0) : stop_after_(stop_after) {}
  Stop stop() const { return Stop(flag_); }
  void note(const std::string& text) override { notes += text + "\n"; }
  void warn(const std::string& text) override { warnings += text + "\n"; }
  void started(std::size_t) override {
    if (started_++ == stop_after_ && stop_after_ > 0) flag_ = true;
  }
  std::string notes, warnings;

 private:
  const std::size_t stop_after_;
  std::atomic<std::size_t> started_{0};
  std::atomic<bool> flag_{false};
};

// {key: check sum of the result} of all records of a store.
std::map<std::string, std::string> results_of(const fs::path& store) {
  RecordStore records(store);
  std::map<std::string, std::string> results;
  SqliteStatement select(records.database(), "SELECT key,result FROM cells WHERE current=1");
  while (select.step()) results.emplace(select.text(0), select.text(1));
  return results;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

class Campaigns : public ::testing::Test {
 protected:
  Campaigns() { add_known(catalogue_); }

  CampaignStudy study(const std::string& text, const std::string& store, int threads = 1) {
    CampaignStudy study;
    study.file = folder_.file(store + ".json", text);
    study.store = (folder_ / store).string();
    study.threads = threads;
    return study;
  }
  CampaignSummary run(const CampaignStudy& study) {
    Notes watcher;
    return run_campaign(study, catalogue_, watcher, {});
  }
  CampaignSummary run(const std::string& text, const std::string& store, int threads = 1) {
    return run(study(text, store, threads));
  }
  std::string refusal(const std::string& text) {
    const std::string file = folder_.file("bad.json", text);
    std::vector<std::string> notes;
    const std::string message =
        message_of([&] { read_campaign(file, catalogue_, InstructionSet::Baseline, notes); });
    return message.rfind(file, 0) == 0 ? message.substr(file.size()) : message;
  }

  TemporaryFolder folder_;
  Catalogue catalogue_;
};

TEST_F(Campaigns, BadFilesAreRefusedWithTheirLine) {
  const auto with = [](const std::string& from, const std::string& to) { return replaced(kSmall, from, to); };
  EXPECT_THAT(refusal(with("\"repeat\"", "\"repeet\"")),
              HasSubstr(":6: /repeet: found unknown key \"repeet\", did you mean 'repeat'?"));
  EXPECT_THAT(refusal(with("\"options\"", "\"option\"")),
              HasSubstr(":3: /solvers/1/option: found unknown key"));
  EXPECT_THAT(refusal(with("\"lm\"", "\"lmm\"")), HasSubstr(":3: /solvers/0: unknown solver 'lmm', did you"));
  EXPECT_THAT(refusal(with("\"pso\"", "\"psoo\"")),
              HasSubstr(":3: /solvers/1: unknown solver 'psoo', did you mean 'pso'?"));
  EXPECT_THAT(refusal(with("swarm", "swarn")), HasSubstr("did you mean 'swarm'?"));
  EXPECT_THAT(refusal(with("[10, 20]", "[10, -20]")), HasSubstr(":3: /solvers/1: "));
  EXPECT_THAT(refusal(with("[10, 20]", "[]")),
              HasSubstr(":3: /solvers/1/options/swarm: found an empty list, expected at least one value"));
  EXPECT_THAT(refusal(with("[\"rosenbrock\", \"nist:Misra1a/1\"]", "[]")),
              HasSubstr(":4: /problems: found an empty list, expected at least one problem"));
  EXPECT_THAT(refusal(with("rosenbrock", "rosenbrok")),
              HasSubstr(":4: /problems/0: unknown problem 'rosenbrok', did you mean 'rosenbrock'?"));
  EXPECT_THAT(refusal(with("rosenbrock", "nits:*")), HasSubstr(":4: /problems/0: "));
  EXPECT_THAT(refusal(with("200", "0")), HasSubstr(":5: /budgets/evaluations: found 0, expected 1 to 1e12"));
  EXPECT_THAT(refusal(with("\"repeat\": 2", "\"repeat\": 0")), HasSubstr(":6: /repeat: found 0"));
  EXPECT_THAT(refusal(with("\"schema_version\": 1", "\"schema_version\": 2")), HasSubstr("/schema_version"));
  EXPECT_THAT(refusal(with("\"name\": \"small\",", "")), HasSubstr("found no key \"name\""));
  EXPECT_THAT(refusal(with("\"repeat\": 2", "\"start\": \"here\"")), HasSubstr(":6: /start: found \"here\""));
  EXPECT_THAT(refusal(with("\"repeat\": 2", "\"targets\": [1, 0]")), HasSubstr(":6: /targets/1: found 0"));
  EXPECT_THAT(refusal(with("\"repeat\": 2", "\"polish\": [\"none\", \"ml\"]")), HasSubstr(":6: /polish/1: "));
  EXPECT_THAT(refusal(with("\"rosenbrock\"", "{\"data\": \"no*.json\"}")),
              HasSubstr(":4: /problems/0/data: "));
  EXPECT_THAT(refusal("{"), HasSubstr(":1: broken JSON"));
}

TEST_F(Campaigns, TooLargeAMatrixIsRefusedBeforeAnythingIsMade) {
  EXPECT_THAT(
      message_of([&] { run(replaced(kSmall, "\"repeat\": 2", "\"repeat\": 100000"), "large.db"); }),
      HasSubstr("found 600000 cells (3 solvers, 1 polishes, 2 problems, 1 budgets, 100000 repetitions)"));
  EXPECT_FALSE(fs::exists(folder_ / "large.db"));
}

TEST_F(Campaigns, ThePlanIsTheMatrix) {
  std::vector<std::string> notes;
  const std::string text = R"({"schema_version": 1, "name": "matrix",
    "solvers": [{"name": "pso", "options": {"swarm": [10, 20], "variant": ["thesis", "modern"]}}, "lm"],
    "problems": [{"name": "rosenbrock", "dimension": [2, 5]}, {"name": "sphere", "target": 0.5}],
    "polish": ["none", "lm"], "budgets": [{"evaluations": 100}, {"evaluations_per_parameter": 10}],
    "targets": [1e-8, 0.1], "repeat": 3})";
  const Campaign campaign =
      read_campaign(folder_.file("m.json", text), catalogue_, InstructionSet::Baseline, notes);
  EXPECT_THAT(campaign.targets, ElementsAre(0.1, 1e-8));
  const CampaignPlan plan(campaign, catalogue_, run_context(1, InstructionSet::Baseline), notes);
  // Four swarms three times, with and without polish, and lm once (it is deterministic and no polish of
  // itself), each with two budgets on three problems.
  EXPECT_EQ(plan.size(), (4 * 3 * 2 + 1) * 2 * 3u);
  EXPECT_THAT(std::set<std::string>(plan.keys().begin(), plan.keys().end()), SizeIs(plan.size()));
  std::set<std::string> names;
  for (std::size_t i = 0; i < plan.size(); ++i) {
    names.insert(plan.name(i));
    const Budget budget = plan.budget(i);
    const bool sphere = plan.problem(i).name() == "sphere";
    EXPECT_EQ(budget.target_cost, sphere ? 0.5 : 1e-8);
    const bool fixed = plan.label(i).find("(100 evaluations)") != std::string::npos;
    const auto n = static_cast<std::int64_t>(plan.problem(i).problem.parameters().size());
    EXPECT_EQ(budget.max_evaluations, fixed ? 100 : 10 * n);
  }
  EXPECT_THAT(names, SizeIs(plan.size()));
  EXPECT_TRUE(names.contains("rosenbrock[n=5]/pso[swarm=20,variant=modern]+lm (100 evaluations)/3"));
}

TEST_F(Campaigns, ResultsAreTheSameAtAnyThreadCountAndInChildren) {
  const CampaignSummary one = run(kSmall, "one.db");
  EXPECT_EQ(one.planned, 2 * (1 + 2 * 2u));
  EXPECT_EQ(one.run, one.planned);
  run(kSmall, "three.db", 3);
  CampaignStudy isolated = study(kSmall, "isolated.db", 2);
  isolated.isolate.emplace();
  run(isolated);
  const auto expected = results_of(folder_ / "one.db");
  EXPECT_THAT(expected, SizeIs(one.planned));
  EXPECT_EQ(results_of(folder_ / "three.db"), expected);
  EXPECT_EQ(results_of(folder_ / "isolated.db"), expected);
  Notes watcher;
  const std::vector<RunRecord> records = read_all_records({(folder_ / "one.db").string()}, watcher);
  ASSERT_THAT(records, SizeIs(one.planned));
  EXPECT_EQ(records.front().problem, "rosenbrock");
  EXPECT_EQ(records.front().label, "lm");
  EXPECT_TRUE(expected.contains(record_key(records.front())));
}

TEST_F(Campaigns, ARerunDoesOnlyWhatIsMissing) {
  run(kSmall, "a.db");
  const auto before = results_of(folder_ / "a.db");
  Notes again;
  CampaignSummary summary = run_campaign(study(kSmall, "a.db"), catalogue_, again, {});
  EXPECT_EQ(summary.run, 0u);
  EXPECT_THAT(again.notes, HasSubstr("10 of 10 cells are in "));
  EXPECT_THAT(again.notes, HasSubstr("are kept; 0 to run"));
  // Another solver: its cells only. One less: its records are no longer shown, and come back.
  summary = run(replaced(kSmall, "\"lm\"", "\"lm\", \"nlopt:bobyqa\""), "a.db");
  EXPECT_EQ(summary.run, 2u);
  EXPECT_THAT(results_of(folder_ / "a.db"), SizeIs(12));
  summary = run(replaced(kSmall, "\"lm\", ", ""), "a.db");
  EXPECT_EQ(summary.run, 0u);
  EXPECT_THAT(results_of(folder_ / "a.db"), SizeIs(8));
  summary = run(kSmall, "a.db");
  EXPECT_EQ(summary.run, 0u);
  EXPECT_EQ(results_of(folder_ / "a.db"), before);
  CampaignStudy some = study(kSmall, "a.db");
  some.only = "rosenbrock/pso*/2";
  EXPECT_EQ(run(some).run, 2u);
  EXPECT_EQ(results_of(folder_ / "a.db"), before);
  some.only = before.begin()->first.substr(0, 16);
  EXPECT_EQ(run(some).run, 1u);
  some.only = "nothing*";
  EXPECT_THAT(message_of([&] { run(some); }), HasSubstr("--only=nothing*: no cell is called so"));
}

TEST_F(Campaigns, AStopDropsWhatRunsAndKeepsTheRest) {
  run(kSmall, "whole.db");
  Notes stopping(3);
  const CampaignSummary stopped =
      run_campaign(study(kSmall, "part.db"), catalogue_, stopping, stopping.stop());
  EXPECT_TRUE(stopped.interrupted);
  EXPECT_EQ(stopped.run, 3u);
  EXPECT_EQ(stopped.left(), 7u);
  EXPECT_EQ(run(kSmall, "part.db", 2).run, 7u);
  EXPECT_EQ(results_of(folder_ / "part.db"), results_of(folder_ / "whole.db"));
}

TEST_F(Campaigns, ShardsTogetherAreTheWhole) {
  run(kSmall, "whole.db");
  std::vector<std::string> shards;
  for (int i = 1; i <= 3; ++i) {
    CampaignStudy part = study(kSmall, "shard_" + std::to_string(i) + ".db");
    part.shard = {i, 3};
    shards.push_back(part.store);
    run(part);
  }
  Notes watcher;
  const std::string target = (folder_ / "together.db").string();
  std::int64_t taken = 0;
  for (const StoreImport& one : import_records(target, shards, true, {}, watcher, {}))
    taken += one.count.taken;
  EXPECT_EQ(taken, 10);
  EXPECT_EQ(results_of(target), results_of(folder_ / "whole.db"));
  for (const StoreImport& one : import_records(target, shards, true, {}, watcher, {})) {
    EXPECT_EQ(one.count.taken, 0);
    EXPECT_EQ(one.count.differing, 0);
  }
  EXPECT_EQ(run(kSmall, "together.db").run, 0u);

  CampaignStudy wrong = study(kSmall, "shard_1.db");
  wrong.shard = {2, 3};
  EXPECT_THAT(message_of([&] { run(wrong); }),
              HasSubstr("found shard 1/3 of campaign 'small', expected shard 2/3 of campaign 'small'"));
  CampaignStudy other = study(replaced(kSmall, "small", "other"), "other.db");
  other.shard = {1, 3};
  run(other);
  EXPECT_THAT(message_of([&] { import_records(target, {other.store}, true, {}, watcher, {}); }),
              HasSubstr("found campaign 'other' of plan "));
  CampaignStudy edited = study(replaced(kSmall, "200", "300"), "edited.db");
  run(edited);
  EXPECT_THAT(message_of([&] { import_records(target, {edited.store}, true, {}, watcher, {}); }),
              HasSubstr("found campaign 'small' of plan "));
  EXPECT_EQ(results_of(target), results_of(folder_ / "whole.db"));
}

TEST_F(Campaigns, RecordsGoOutAndInAsLines) {
  run(kSmall, "a.db");
  std::string text;
  EXPECT_EQ(
      export_lines((folder_ / "a.db").string(), "", false, [&](std::string_view line) { text += line; }), 10);
  const std::string file = folder_.file("runs.jsonl", text);
  Notes watcher;
  const std::string target = (folder_ / "b.db").string();
  EXPECT_EQ(import_records(target, {file}, false, {}, watcher, {}).front().count.taken, 10);
  EXPECT_EQ(import_records(target, {file}, false, {}, watcher, {}).front().count.known, 10);
  EXPECT_EQ(results_of(target), results_of(folder_ / "a.db"));
  std::string back;
  export_lines((folder_ / "a.db").string(), "nist:*", false, [&](std::string_view line) { back += line; });
  EXPECT_THAT(lines(back), SizeIs(5));
}

TEST_F(Campaigns, WrongRecordsAndStoresAreRefused) {
  run(kSmall, "a.db");
  Notes watcher;
  const std::string a = (folder_ / "a.db").string(), target = (folder_ / "target.db").string();
  const auto damaged = [&](const std::string& sql) {
    fs::copy_file(a, folder_ / "damaged.db", fs::copy_options::overwrite_existing);
    SqliteDatabase(folder_ / "damaged.db", SqliteDatabase::Access::Write).run(sql);
    return message_of(
        [&] { import_records(target, {(folder_ / "damaged.db").string()}, false, {}, watcher, {}); });
  };
  EXPECT_THAT(damaged("UPDATE cells SET record=replace(record,'\"lm\"','\"ml\"') WHERE solver='lm'"),
              HasSubstr("that is not what its check sum says"));
  EXPECT_THAT(damaged("UPDATE cells SET key='0000' WHERE place=3"),
              HasSubstr("found a record under the key 0000"));
  EXPECT_THAT(damaged("PRAGMA user_version=2"),
              HasSubstr("found a store of schema 2, expected at most 1: it was written by a newer version"));
  EXPECT_THAT(damaged("PRAGMA application_id=1"), HasSubstr("found an SQLite file of another program"));
  EXPECT_THAT(results_of(target), IsEmpty());

  const std::string text = folder_.file("text.db", "not a store, a text of some length\n");
  EXPECT_THAT(message_of([&] { RecordStore store(text); }), HasSubstr("found no store of records"));
  EXPECT_THAT(message_of([&] { RecordStore store(text, RecordStore::Access::Write); }),
              HasSubstr("it exists and is no store of records"));
  EXPECT_THAT(message_of([&] { RecordStore store(folder_.path(), RecordStore::Access::Write); }),
              HasSubstr("cannot be written"));
  EXPECT_THAT(content(text), HasSubstr("not a store"));
}

TEST_F(Campaigns, OneWriterAtATime) {
  const fs::path file = folder_ / "a.db";
  auto first = std::make_unique<RecordStore>(file, RecordStore::Access::Write);
  EXPECT_THAT(message_of([&] { RecordStore second(file, RecordStore::Access::Write); }),
              HasSubstr("is writing there"));
  EXPECT_EQ(RecordStore(file).count(), 0);  // reading goes on
  std::thread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    first.reset();
  });
  EXPECT_NO_THROW(open_to_write(file, std::chrono::seconds(20), {}));
  later.join();
}

TEST_F(Campaigns, OnlyStatementsThatReadAreTaken) {
  run(kSmall, "a.db");
  const std::string a = (folder_ / "a.db").string();
  const Table table = query_table(a, "SELECT label, count(*) AS n, min(cost) FROM cells GROUP BY label");
  ASSERT_THAT(table.rows, SizeIs(3));
  EXPECT_EQ(table.rows[0][0].text, "lm");
  EXPECT_EQ(table.rows[0][1].value, 2);
  for (const char* bad : {"DELETE FROM cells", "ATTACH 'x.db' AS x", "PRAGMA user_version=7",
                          "CREATE TABLE t(a)", "SELECT 1; SELECT 2", "", "SELECT nothing FROM cells"})
    EXPECT_THAT(message_of([&] { query_table(a, bad); }), HasSubstr("SQL: ")) << bad;
  EXPECT_EQ(RecordStore(a).count(), 10);
  EXPECT_THAT(files_below(folder_.path()),
              ElementsAre("a.db", "a.db.json"));  // reading leaves nothing behind
}

// Methods that do what no method should.
class Evil final : public Solver {
 public:
  explicit Evil(int kind) : kind_(kind) {}
  std::string why_not(const Problem&) const override { return ""; }
  Outcome minimise(Run& run) const override {
    run.cost(run.start());
    if (kind_ == 0) std::abort();
    if (kind_ == 1)
      for (;;) std::this_thread::sleep_for(std::chrono::seconds(1));
    if (kind_ == 2) ::_exit(3);
    throw std::bad_alloc();
  }

 private:
  const int kind_;
};

TEST_F(Campaigns, ACellThatCrashesOrHangsCostsItselfOnly) {
  const std::vector<std::string> names{"evil:crash", "evil:hang", "evil:exit", "evil:memory"};
  for (int kind = 0; kind < 4; ++kind)
    catalogue_.add(SolverEntry{
        names[static_cast<std::size_t>(kind)], "", false, [] { return std::vector<OptionDescription>(); },
        [kind](const OptionValues&, OptionValues*) { return std::make_unique<Evil>(kind); }});
  const std::string text =
      replaced(kSmall, "\"lm\"", R"("lm","evil:crash","evil:hang","evil:exit","evil:memory")");
  run(kSmall, "good.db");
  CampaignStudy isolated = study(text, "evil.db", 2);
  isolated.isolate = IsolationLimits{0.5, 0};
  const CampaignSummary summary = run(isolated);
  EXPECT_EQ(summary.run, 18u);
  EXPECT_EQ(summary.failed, 8u);
  const Table failed = query_table(isolated.store,
                                   "SELECT label,json_extract(record,'$.message') FROM cells WHERE "
                                   "termination='failed' AND problem='rosenbrock' ORDER BY place");
  ASSERT_THAT(failed.rows, SizeIs(4));
  EXPECT_THAT(failed.rows[0][1].text, HasSubstr("ended by signal 6 (Aborted)"));
  EXPECT_THAT(failed.rows[1][1].text, HasSubstr("took longer than 0.5 s"));
  EXPECT_THAT(failed.rows[2][1].text, HasSubstr("ended with exit code 3"));
  auto left = results_of(isolated.store);
  for (const auto& [key, result] : results_of(folder_ / "good.db")) EXPECT_EQ(left[key], result);
  // They are there, so they do not run again unless they are named.
  EXPECT_EQ(run(isolated).run, 0u);
  isolated.only = "*/evil:crash/*";
  EXPECT_EQ(run(isolated).failed, 2u);
}

TEST_F(Campaigns, CalibrationsBringTheirNominalParameters) {
  const std::string set = (source_dir() / "datasets" / "demo" / "set.json").string();
  const std::string text = R"({"schema_version": 1, "name": "sets", "solvers": "lm", "problems": [
    {"data": ")" + set + R"("}, {"data": ")" +
                           set + R"(", "cost": "final_pose"}], "budgets": {"evaluations": 50}})";
  EXPECT_EQ(run(text, "sets.db").run, 2u);
  EXPECT_EQ(run(text, "sets.db").run, 0u);
  Notes watcher;
  const std::vector<RunRecord> records = read_all_records({(folder_ / "sets.db").string()}, watcher);
  ASSERT_THAT(records, SizeIs(4));
  EXPECT_EQ(records[0].label, "nominal");
  EXPECT_EQ(records[2].label, "lm");
  EXPECT_EQ(records[2].dataset, "demo");
  EXPECT_NE(records[2].problem, records[3].problem);
  EXPECT_LT(*records[2].cost, *records[0].cost);
}

}  // namespace
}  // namespace odobench::testing
