// What users get wrong, and interruptions: one clear line, the right exit code, nothing partial on disk.
#include <gmock/gmock.h>
#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "reports/records/record.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;
using testing::bench_words;
using testing::content;
using testing::expect_refusal;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::kData;
using testing::kInterrupted;
using testing::kUsage;
using testing::lines;
using testing::Process;
using testing::ProcessResult;
using testing::run_bench;
using ::testing::StartsWith;
using testing::TemporaryFolder;
using testing::wait_for_lines;

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  return names;
}

fs::path demo_folder() {
  return source_dir() / "datasets" / "demo";
}

// The demo set with one piece of its set.json replaced; its recordings are copied along.
std::string changed_demo(const TemporaryFolder& folder, const std::string& from, const std::string& to) {
  fs::copy(demo_folder(), folder.path(), fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  std::string text = content(folder / "set.json");
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  if (at != std::string::npos) text.replace(at, from.size(), to);
  return folder.file("set.json", text);
}

TEST(CliErrors, TheHelperSeesSuccessAndWrongMessages) {
  EXPECT_NONFATAL_FAILURE(expect_refusal({"rnu"}, kData, {"unknown verb"}), "exit_code");
  EXPECT_NONFATAL_FAILURE(expect_refusal({"rnu"}, kUsage, {"another text"}), "another text");
}

TEST(CliErrors, Verbs) {
  expect_refusal({"rnu"}, kUsage, {"unknown verb 'rnu', did you mean 'run'?"});
  expect_refusal({"set.json"}, kUsage, {"unknown verb 'set.json'"});
  expect_refusal({"list", "solver"}, kUsage, {"did you mean 'solvers'?"});
  expect_refusal({"list"}, kUsage, {"what"});
  expect_refusal({"list", "solvers", "set.json"}, kUsage, {"'set.json' is not expected here"});
  expect_refusal({"import", "vitko2023", "--from=x", "--out=y"}, kUsage, {"did you mean 'vitko2024'?"});
  expect_refusal({"import", "vitko2024", "--out=y"}, kUsage, {"--from"});
  expect_refusal({"import", "optiodom", "--from=x", "--out=y", "--exclude=2,x"}, kUsage,
                 {"--exclude: found 'x', expected numbers of runs, from 1"});
  expect_refusal({"import", "optiodom", "--from=x", "--out=y", "--exclude=0"}, kUsage, {"found '0'"});
  expect_refusal({"import", "optiodom", "--from=x", "--out=y", "--drop-lost"}, kUsage, {"of vitko2024 only"});
  expect_refusal({"import", "vitko2024", "--from=x", "--out=y", "--exclude=2"}, kUsage, {"of optiodom only"});
  expect_refusal({"import", "optiodom", "--from=absent,absent", "--out=y"}, kData,
                 {"absent: found no folder that can be read"});
  expect_refusal({"check", "x"}, kUsage, {"--baseline"});
  expect_refusal({"report"}, kUsage, {"runs"});
}

TEST(CliErrors, Options) {
  expect_refusal({"--sovler=lm"}, kUsage, {"unknown option '--sovler=lm', did you mean '--solver'?"});
  expect_refusal({"check", "--basline=x", "y"}, kUsage,
                 {"unknown option '--basline=x', did you mean '--baseline'?"});
  expect_refusal({"--solver=lm", "set.json"}, kUsage, {"unexpected argument 'set.json'"});
  expect_refusal({"--repeat=0"}, kUsage, {"--repeat=0: expected a whole number in 1..100000"});
  expect_refusal({"--repeat=-3"}, kUsage, {"--repeat=-3"});
  expect_refusal({"--repeat=2.5"}, kUsage, {"--repeat=2.5", "whole number"});
  expect_refusal({"--threads=0"}, kUsage, {"--threads=0"});
  expect_refusal({"--seed=-1"}, kUsage, {"--seed=-1"});
  expect_refusal({"--seed=1", "--seed=2"}, kUsage, {"--seed"});
  expect_refusal({"--seed"}, kUsage, {"--seed"});
  expect_refusal({"--data=", "--solver=lm"}, kUsage, {"--data=: a value is missing"});
  expect_refusal({"--target=nan"}, kUsage, {"--target=nan: expected a finite number"});
  expect_refusal({"--start=middle"}, kUsage, {"--start=middle: expected nominal or random"});
  expect_refusal({"--format=xml"}, kUsage, {"xml", "latex"});
  expect_refusal({"--solver=lm", "--problem=spheer"}, kUsage, {"did you mean 'sphere'?"});
  expect_refusal({"--solver=lm", "--problem=sphere", "--dimension=1"}, kUsage, {"dimension"});
  expect_refusal({"--solver=lm", "--problem=sphere", "--data=set.json"}, kUsage, {"takes no data set"});
  expect_refusal({"--solver=lm", "--dimension=3"}, kUsage, {"--dimension"});
}

TEST(CliErrors, ABudgetOfNothing) {
  expect_refusal({"--max-evals=0"}, kUsage, {"--max-evals=0: expected a whole number >= 1"});
  expect_refusal({"--max-evals=-5"}, kUsage, {"--max-evals=-5"});
  expect_refusal({"--time-limit=0"}, kUsage, {"--time-limit=0: expected a finite number > 0"});
  expect_refusal({"--time-limit=-1"}, kUsage, {"--time-limit=-1"});
  expect_refusal({"--time-limit=inf"}, kUsage, {"--time-limit=inf"});
}

TEST(CliErrors, Solvers) {
  expect_refusal({"--solver=cmeas"}, kUsage, {"unknown solver 'cmeas', did you mean 'cmaes'?"});
  expect_refusal({"--solver=lm[lamda=1]"}, kUsage, {"unknown option 'lamda', did you mean 'lambda'?"});
  expect_refusal({"--solver=lm[lambda=-1]"}, kUsage, {"lambda=-1"});
  expect_refusal({"--solver=lm[lambda=x]"}, kUsage, {"expected a number"});
  expect_refusal({"--solver=lm[lambda"}, kUsage, {"unbalanced brackets"});
  expect_refusal({"--solver=lm,,cmaes"}, kUsage, {"an empty solver name"});
  expect_refusal({"--solver=lm", "--polish=ml"}, kUsage, {"did you mean 'lm'?"});
  expect_refusal({"--solver=lm", "--polish=lm,cmaes"}, kUsage, {"--polish=lm,cmaes: expected one solver"});
}

TEST(CliErrors, DataSets) {
  const TemporaryFolder folder;
  expect_refusal({"--solver=lm", "--data=" + (folder / "absent.json").string()}, kData, {"absent.json"});
  expect_refusal({"--solver=lm", "--data=" + folder.file("broken.json", "{\"schema\": ")}, kData,
                 {"broken.json"});
  const TemporaryFolder version, bounds;
  expect_refusal(
      {"--solver=lm", "--data=" + changed_demo(version, "\"schema_version\": 1", "\"schema_version\": 99")},
      kData, {"schema_version", "99"});
  expect_refusal({"--solver=lm", "--data=" + changed_demo(bounds, "\"lower\": 0.106875", "\"lower\": 0.2")},
                 kData, {"a1", "0.2"});
  expect_refusal({"list", "data", (folder / "absent.json").string()}, kData, {"absent.json"});
}

TEST(CliErrors, OutputPlaces) {
  const TemporaryFolder folder;
  const std::string file = folder.file("file", "");
  // Root may write everywhere, so the place is one that cannot exist: below a regular file.
  expect_refusal({"--solver=lm", "--out=" + file + "/below"}, kUsage, {"--out=", "below"});
  expect_refusal({"--solver=lm", "--out=" + file}, kUsage, {"--out="});
  expect_refusal({"demo", "--out=" + file + "/below"}, kData, {"below"});
  const std::string out = (folder / "out").string();
  ASSERT_EQ(run_bench({"--solver=lm", "--problem=sphere", "--out=" + out}).exit_code, 0);
  const std::string before = content(out + "/runs.jsonl");
  expect_refusal({"--solver=lm", "--problem=sphere", "--out=" + out}, kUsage,
                 {"runs.jsonl already", "--overwrite"});
  EXPECT_EQ(content(out + "/runs.jsonl"), before);
}

TEST(CliErrors, NothingIsWrittenWhenTheDataAreWrong) {
  const TemporaryFolder folder;
  run_bench(
      {"--solver=lm", "--data=" + (folder / "absent.json").string(), "--out=" + (folder / "out").string()});
  run_bench({"--solver=nobody", "--out=" + (folder / "out").string()});
  EXPECT_THAT(names_in(folder.path()), IsEmpty());
}

TEST(CliErrors, ConfigFiles) {
  const TemporaryFolder folder;
  const auto refuse = [&](const std::string& name, const std::string& text,
                          const std::vector<std::string>& parts) {
    expect_refusal({"--solver=lm", "--problem=sphere", "--config=" + folder.file(name, text)}, kUsage, parts);
  };
  refuse("a.json", R"({"solver": "lm", "max-eval": 3})",
         {"a.json", "unknown key 'max-eval', did you mean 'max-evals'?"});
  refuse("b.ini", "solver = lm\n\nrepaet = 3\n", {"b.ini:3", "unknown key 'repaet', did you mean 'repeat'?"});
  refuse("c.ini", "[runs]\nsolver = lm\n", {"c.ini:1", "[runs]"});
  refuse("d.ini", "solver\n", {"d.ini:1", "expected key = value"});
  refuse("e.ini", "seed = 1\nseed = 2\n", {"e.ini:2", "'seed' is given twice"});
  refuse("f.json", R"({"seed": 1, "seed": 2})", {"found the key \"seed\" twice"});
  refuse("g.json", "{\n\"seed\": 1,\n}", {"g.json:3: broken JSON"});
  refuse("m.json", "{\"seed\": 1,\n\"target\": -1e400}",
         {"m.json:2: /target: found -1e400, expected a number within the range of a double"});
  refuse("h.json", R"({"max-evals": 0})", {"h.json", "--max-evals=0"});
  refuse("i.json", R"({"solver": {"name": "lm"}})", {"'solver' is object"});
  refuse("j.json", R"({"config": "a.json"})", {"unknown key 'config'"});
  refuse("k.ini", "solver = [lm, \n", {"k.ini:1"});
  refuse("l.ini", "quiet = maybe\n", {"l.ini:1"});
  expect_refusal({"--config=" + (folder / "absent.ini").string()}, kUsage, {"absent.ini"});
}

TEST(CliErrors, ParameterFiles) {
  const TemporaryFolder folder;
  nlohmann::json good;
  for (const char* letter : {"a", "b", "r"})
    for (const char* number : {"1", "2", "3", "4"}) good[std::string(letter) + number] = 0.1;
  const auto refuse = [&](const std::string& name, const std::string& text,
                          const std::vector<std::string>& parts) {
    expect_refusal({"evaluate", "--parameters=" + folder.file(name, text)}, kData, parts);
  };
  const auto with = [&](const char* key, const nlohmann::json& value) {
    nlohmann::json changed = good;
    changed[key] = value;
    return changed.dump();
  };
  nlohmann::json missing = good;
  missing.erase("b3");
  refuse("a.json", missing.dump(), {"a.json", "'b3' is missing"});
  refuse("b.json", with("r5", 0.1), {"b.json", "unknown key 'r5'"});
  refuse("c.json", with("a1", "0.1"), {"c.json", "'a1' is \"0.1\", expected a number"});
  refuse("d.json", with("a1", nullptr), {"'a1' is null"});
  refuse("e.json", "{\"a1\": NaN}", {"e.json:1: /a1: found NaN, expected a finite number"});
  refuse("f.json", "{\n\"name\": \"1e999\",\n\"a1\": 1e999}",
         {"f.json:3: /a1: found 1e999, expected a number within the range of a double"});
  refuse("j.json", with("b2", 1e308),
         {"j.json", "'b2' is 1e+308, expected a number of at most 1e+50 in size"});
  refuse("g.json", "[]", {"empty array"});
  refuse("h.json", "[" + good.dump() + ", 3]", {"entry 2", "number"});
  refuse("i.json", "{\"a1\": 0.1, \"a1\": 0.2}", {"found the key \"a1\" twice"});
  expect_refusal({"evaluate", "--parameters=published:ml"}, kUsage,
                 {"neither a file nor a name", "known: nominal, truth"});
  expect_refusal({"evaluate", "--parameters=nominal,nominal"}, kUsage, {"two sets are called 'nominal'"});
}

TEST(CliErrors, RecordsAndBaselines) {
  const TemporaryFolder folder;
  expect_refusal({"report", (folder / "absent").string()}, kData, {"absent"});
  expect_refusal({"report", folder.file("bad.jsonl", "{}\n")}, kData, {"bad.jsonl:1"});
  expect_refusal({"report", folder.file("large.jsonl", "\n{\"cost\": 1e309}\n")}, kData,
                 {"large.jsonl:2: /cost: found 1e309, expected a number within the range of a double"});
  expect_refusal({"report", folder.file("empty.jsonl", "")}, kData, {"no run record"});
  const std::string out = (folder / "out").string();
  ASSERT_EQ(run_bench({"--solver=lm", "--problem=sphere", "--out=" + out}).exit_code, 0);
  expect_refusal({"check", "--baseline=" + (folder / "absent.json").string(), out}, kData, {"absent.json"});
  expect_refusal({"check", "--baseline=" + folder.file("bad.json", "{}"), out}, kData, {"bad.json"});
  expect_refusal(
      {"check", "--baseline=" + folder.file("large.json", "{\"entries\":\n[{\"cost\": 1e309}]}"), out}, kData,
      {"large.json:2: /entries/0/cost: found 1e309, expected a number within the range of a double"});
}

TEST(CliErrors, RawFiles) {
  const TemporaryFolder folder;
  const std::string set = (folder / "set.json").string();
  expect_refusal({"import", "vitko2024", "--from=" + (folder / "absent").string(), "--out=" + set}, kData,
                 {"absent"});
  folder.file("abs_1.csv", "time;.pose.position.x\n2024/05/03/12:34:34.823195;0.1;");
  expect_refusal({"import", "vitko2024", "--from=" + folder.path().string(), "--out=" + set}, kData,
                 {".csv"});
  EXPECT_FALSE(fs::exists(set));
}

// Runs that would take minutes: ten thousand repetitions, one after the other.
std::vector<std::string> long_run(const fs::path& out) {
  return bench_words({"--solver=cmaes", "--problem=rastrigin", "--dimension=10", "--repeat=10000",
                      "--threads=2", "--max-evals=20000", "--out=" + out.string()});
}

void interrupt_with(int signal) {
  const TemporaryFolder folder;
  Process bench(long_run(folder / "out"));
  ASSERT_TRUE(wait_for_lines(folder / "out/runs.jsonl", 3));
  bench.send(signal);
  const ProcessResult result = bench.wait();
  EXPECT_EQ(result.exit_code, kInterrupted);
  EXPECT_EQ(lines(result.err).size(), 1u) << result.err;
  EXPECT_THAT(result.err, HasSubstr("interrupted: "));
  EXPECT_THAT(result.out, HasSubstr("cmaes"));  // tables of what is there
  const std::vector<RunRecord> records = read_records((folder / "out/runs.jsonl").string());
  EXPECT_GE(records.size(), 3u);
  EXPECT_LT(records.size(), 10000u);
  std::size_t stopped = 0;
  for (const RunRecord& r : records) {
    EXPECT_TRUE(r.cost) << r.repetition;  // best so far
    if (r.termination == "interrupted") ++stopped;
  }
  EXPECT_LE(stopped, 2u);
  for (const std::string& name : names_in(folder.path()))
    EXPECT_EQ(name.find("tmp"), std::string::npos) << name;
  EXPECT_TRUE(fs::exists(folder / "out/tables.json"));
}

TEST(CliErrors, CtrlCKeepsWhatIsThere) {
  interrupt_with(SIGINT);
}
TEST(CliErrors, TerminationKeepsWhatIsThere) {
  interrupt_with(SIGTERM);
}

TEST(CliErrors, AKilledProcessLosesNoCompletedRun) {
  const TemporaryFolder folder;
  Process bench(long_run(folder / "out"));
  ASSERT_TRUE(wait_for_lines(folder / "out/runs.jsonl", 4));
  bench.send(SIGKILL);
  const ProcessResult result = bench.wait();
  EXPECT_EQ(result.signal, SIGKILL);
  EXPECT_GE(read_records((folder / "out/runs.jsonl").string()).size(), 4u);
  EXPECT_EQ(run_bench({"report", (folder / "out").string()}).exit_code, 0);
}

// A fault of the program is not called wrong data.
TEST(CliErrors, TooLittleMemoryIsAnInternalFault) {
  if (testing::bench_is_sanitized()) GTEST_SKIP() << "sanitizers reserve more address space than any limit";
  const TemporaryFolder folder;
  std::string text = "{\"a\": [";
  for (int i = 0; i < 3000000; ++i) text += "[1],";
  const std::string data = folder.file("big.json", text + "1]}");
  for (const char* kilobytes :
       {"150000", "200000", "250000"}) {  // where memory ends: in a parser, a container, a destructor
    const std::string command = std::string("ulimit -v ") + kilobytes + "; exec '" + bench_words({}).front() +
                                "' evaluate --data='" + data + "'";
    const ProcessResult result = Process({"/bin/sh", "-c", command}).wait();
    EXPECT_EQ(result.exit_code, 70) << kilobytes << ": signal " << result.signal;
    EXPECT_EQ(lines(result.err).size(), 1u) << result.err;
    EXPECT_THAT(result.err, StartsWith("bench: error: internal fault: no memory is left"));
    EXPECT_THAT(result.err, HasSubstr("please report it"));
  }
}

TEST(CliErrors, ACrashSaysWhatToDoAndKeepsItsSignal) {
  if (testing::bench_is_sanitized()) GTEST_SKIP() << "sanitizers have handlers of their own";
  for (const int signal : {SIGSEGV, SIGABRT, SIGFPE}) {
    const TemporaryFolder folder;
    Process bench(long_run(folder / "out"));
    ASSERT_TRUE(wait_for_lines(folder / "out/runs.jsonl", 2));
    bench.send(signal);
    const ProcessResult result = bench.wait();
    EXPECT_EQ(result.signal, signal);
    EXPECT_THAT(result.err, AllOf(HasSubstr("bench: error: internal fault: the program was ended by SIG"),
                                  HasSubstr("please report it")));
  }
}

}  // namespace
}  // namespace odobench
