// Where the program writes: descriptors that are closed, outputs that exist or are no files, two processes on
// one place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <csignal>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "base/text.hpp"
#include "reports/records/record.hpp"
#include "tests/support/data/example_runs.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;
using testing::bench_words;
using testing::content;
using testing::demo_file;
using testing::expect_refusal;
using testing::files_below;
using testing::filter_folder;
using ::testing::HasSubstr;
using testing::kData;
using testing::kUsage;
using testing::lines;
using testing::Process;
using testing::ProcessResult;
using testing::run_bench;
using testing::run_bench_in_shell;
using testing::run_folder;
using testing::TemporaryFolder;
using testing::with;

const std::vector<std::string> kShortRun{"--solver=lm,pso", "--repeat=10", "--problem=sphere",
                                         "--max-evals=500"};

TEST(CliDescriptors, ClosedOnesAreNotGivenToFiles) {
  const TemporaryFolder folder;
  std::size_t runs = 0;
  int number = 0;
  for (const std::string suffix : {"", "<&-", ">&-", "2>&-", "<&- >&- 2>&-"}) {
    SCOPED_TRACE(suffix);
    const std::string out = (folder / ("o" + std::to_string(number++))).string();
    const ProcessResult result = run_bench_in_shell(with(kShortRun, "--out=" + out), suffix);
    const bool no_output = suffix.find(">&-") != std::string::npos && suffix != "2>&-";
    EXPECT_EQ(result.exit_code, no_output ? kData : 0) << result.err;
    const std::vector<RunRecord> records = read_records(out + "/runs.jsonl");
    if (runs == 0) runs = records.size();
    EXPECT_EQ(records.size(), runs);
    EXPECT_EQ(lines(content(out + "/runs.jsonl")).size(), runs);
    EXPECT_THAT(content(out + "/tables.txt"), HasSubstr("pso"));
  }
  EXPECT_EQ(runs, 11u);
  expect_refusal({"filter", "--data=-", "--quiet"}, kData, {"standard input"});
  const ProcessResult closed = run_bench_in_shell({"filter", "--data=-"}, "<&-");
  EXPECT_EQ(closed.exit_code, kData);
  EXPECT_EQ(lines(closed.err).size(), 1u) << closed.err;
}

TEST(CliDescriptors, OutputThatCannotBeWrittenIsSaid) {
  const ProcessResult full = run_bench_in_shell({"list", "solvers"}, ">/dev/full");
  EXPECT_EQ(full.exit_code, kData);
  EXPECT_THAT(full.err, HasSubstr("standard output: No space left on device"));
  const TemporaryFolder folder;
  const ProcessResult limited = run_bench_in_shell({"demo", "--out=" + (folder / "demo").string()}, "");
  ASSERT_EQ(limited.exit_code, 0) << limited.err;
  // A limit of the file size is an error, not a signal.
  const ProcessResult small = Process({"/bin/sh", "-c",
                                       "ulimit -f 8; exec '" + bench_words({}).front() + "' demo --out='" +
                                           (folder / "small").string() + "'"})
                                  .wait();
  EXPECT_EQ(small.exit_code, kData) << small.signal;
  EXPECT_EQ(lines(small.err).size(), 1u) << small.err;
  EXPECT_FALSE(fs::exists(folder / "small"));
}

// A verb with the file or folder that it writes.
struct Writer {
  std::string name;
  std::function<std::vector<std::string>(const std::string& out)> words;
  std::string file;  // below `out`; "": `out` is it
};

void PrintTo(const Writer& writer, std::ostream* out) {
  *out << writer.name;
}

std::vector<std::string> filter_words(const std::string& option, const std::string& out) {
  return {"filter", "--data=" + filter_folder() + "/sensors.csv", "--wheel-order=left-first", option + out};
}

const std::vector<Writer> kWriters = {
    {"run", [](const std::string& out) { return with(kShortRun, "--out=" + out); }, "runs.jsonl"},
    {"run_tables", [](const std::string& out) { return with(kShortRun, "--out=" + out); }, "tables.csv"},
    {"evaluate",
     [](const std::string& out) -> std::vector<std::string> {
       return {"evaluate", "--data=" + demo_file("set.json"), "--out=" + out};
     },
     "runs.jsonl"},
    {"tracks",
     [](const std::string& out) -> std::vector<std::string> {
       return {"evaluate", "--data=" + demo_file("set.json"), "--tracks=" + out};
     },
     ""},
    {"report",
     [](const std::string& out) -> std::vector<std::string> {
       return {"report", run_folder(), "--out=" + out};
     },
     ""},
    {"filter", [](const std::string& out) { return filter_words("--out=", out); }, ""},
    {"filter_records", [](const std::string& out) { return filter_words("--records=", out); }, "runs.jsonl"},
    {"fuse",
     [](const std::string& out) -> std::vector<std::string> {
       return {"fuse", "--data=" + demo_file("set.json"),
               "--sensors=" + (source_dir() / "datasets/sensors/heading_only.json").string(), "--filter=ekf",
               "--out=" + out};
     },
     "runs.jsonl"},
    {"demo",
     [](const std::string& out) -> std::vector<std::string> {
       return {"demo", "--out=" + out};
     },
     "set.json"},
    {"simulate",
     [](const std::string& out) -> std::vector<std::string> {
       return {"simulate", "--scenario=exact", "--out=" + out};
     },
     "truth.csv"},
    {"simulate_dynamics",
     [](const std::string& out) -> std::vector<std::string> {
       return {"simulate", "--scenario=filter_run", "--out=" + out};
     },
     "state.csv"},
};

class CliWriters : public ::testing::TestWithParam<Writer> {
 protected:
  // What is to be written, and the words for it.
  fs::path target() const {
    return GetParam().file.empty() ? folder_ / "out" : folder_ / "out" / GetParam().file;
  }
  std::vector<std::string> words(bool overwrite) const {
    std::vector<std::string> words = GetParam().words((folder_ / "out").string());
    if (overwrite) words.push_back("--overwrite");
    return words;
  }
  void make_parent() const { fs::create_directories(target().parent_path()); }

  TemporaryFolder folder_;
};

TEST_P(CliWriters, AnExistingFileNeedsOverwrite) {
  make_parent();
  std::ofstream(target()) << "mine";
  expect_refusal(words(false), kUsage, {"--overwrite"});
  EXPECT_EQ(content(target()), "mine");
  EXPECT_EQ(files_below(folder_ / "out").size(), GetParam().file.empty() ? 0u : 1u);
  const ProcessResult result = run_bench(words(true));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(content(target()), "mine");
}

TEST_P(CliWriters, PipesDevicesAndLinksAreNotReplaced) {
  const auto refused = [&](const char* what) {
    for (const bool overwrite : {false, true}) expect_refusal(words(overwrite), kUsage, {what, "out"});
  };
  make_parent();
  ASSERT_EQ(::mkfifo(target().c_str(), 0600), 0);
  refused("found a pipe");
  EXPECT_TRUE(fs::is_fifo(target()));
  fs::remove(target());
  const std::string victim = folder_.file("victim", "mine");
  fs::create_symlink(victim, target());
  refused("found a link");
  EXPECT_EQ(content(victim), "mine");
  fs::remove(target());
  fs::create_symlink(folder_ / "nowhere", target());
  refused("found a link");
  EXPECT_FALSE(fs::exists(folder_ / "nowhere"));
  fs::remove(target());
  if (::mknod(target().c_str(), S_IFCHR | 0600, makedev(1, 3)) != 0)
    GTEST_SKIP() << "no right to make a device";
  refused("found a device");
  EXPECT_TRUE(fs::is_character_file(target()));
}

INSTANTIATE_TEST_SUITE_P(Every, CliWriters, ::testing::ValuesIn(kWriters),
                         [](const auto& parameter) { return parameter.param.name; });

TEST(CliOutputs, FoldersInsideAPlaceAreNotReachedThroughLinks) {
  const TemporaryFolder folder;
  fs::create_directories(folder / "elsewhere");
  const std::string out = (folder / "out").string();
  fs::create_directories(out);
  fs::create_directory_symlink(folder / "elsewhere", out + "/tracks");
  fs::create_directory_symlink(folder / "elsewhere", out + "/set_recordings");
  fs::create_directory_symlink(folder / "elsewhere", out + "/reference");
  expect_refusal({"evaluate", "--out=" + out, "--overwrite"}, kUsage, {"tracks: found a link"});
  expect_refusal({"demo", "--out=" + out, "--overwrite"}, kUsage, {"set_recordings: found a link"});
  expect_refusal({"export", run_folder(), "--tum", "--out=" + out, "--overwrite"}, kUsage,
                 {"reference: found a link"});
  EXPECT_TRUE(files_below(folder / "elsewhere").empty());
}

TEST(CliStandardOutput, ADashTakesTheFile) {
  const TemporaryFolder folder;
  const std::string page = (folder / "page.html").string();
  ASSERT_EQ(run_bench({"report", run_folder(), "--out=" + page}).exit_code, 0);
  EXPECT_EQ(run_bench({"report", run_folder(), "--out=-"}).out, content(page));
  expect_refusal({"report", run_folder(), "--out=-", "--json"}, kUsage, {"--out=-"});
  const std::string tracks = (folder / "tracks.csv").string();
  ASSERT_EQ(run_bench({"evaluate", "--tracks=" + tracks}).exit_code, 0);
  EXPECT_EQ(run_bench({"evaluate", "--tracks=-"}).out, content(tracks));
  const std::string filtered = (folder / "filtered.csv").string();
  ASSERT_EQ(run_bench(filter_words("--out=", filtered)).exit_code, 0);
  EXPECT_EQ(run_bench(filter_words("--out=", "-")).out, content(filtered));
  EXPECT_FALSE(fs::exists("-"));
}

TEST(CliLocks, TheSecondRunIsToldWhoHoldsTheFolder) {
  const TemporaryFolder folder;
  const std::string out = (folder / "out").string();
  Process first(bench_words({"--solver=cmaes", "--problem=rastrigin", "--dimension=10", "--repeat=10000",
                             "--max-evals=20000", "--out=" + out}));
  ASSERT_TRUE(testing::wait_for_lines(out + "/runs.jsonl", 2));
  expect_refusal({"--solver=lm", "--problem=sphere", "--overwrite", "--out=" + out}, kUsage,
                 {"process ", " is writing there"});
  // A report on what is there so far may be written beside it.
  const ProcessResult report = run_bench({"report", out, "--out=" + out + "/report.html"});
  EXPECT_EQ(report.exit_code, 0) << report.err;
  first.send(SIGTERM);
  EXPECT_EQ(first.wait().exit_code, testing::kInterrupted);
  for (const RunRecord& r : read_records(out + "/runs.jsonl")) EXPECT_EQ(r.solver, "cmaes");
  EXPECT_EQ(run_bench({"--solver=lm", "--problem=sphere", "--overwrite", "--out=" + out}).exit_code, 0);
  EXPECT_EQ(read_records(out + "/runs.jsonl").size(), 1u);
}

TEST(CliLocks, TwoThatMakeTheSameSetLeaveOneThatCanBeRead) {
  const TemporaryFolder folder;
  const std::string out = (folder / "demo").string();
  for (int round = 0; round < 5; ++round) {
    Process first(bench_words({"demo", "--overwrite", "--seed=1", "--out=" + out}));
    Process second(bench_words({"demo", "--overwrite", "--seed=2", "--out=" + out}));
    EXPECT_EQ(first.wait().exit_code, 0);
    EXPECT_EQ(second.wait().exit_code, 0);
    const ProcessResult read = run_bench({"list", "data", out + "/set.json"});
    EXPECT_EQ(read.exit_code, 0) << read.err;
  }
  // Without --overwrite one of them wins.
  const std::string once = (folder / "once").string();
  Process first(bench_words({"demo", "--seed=1", "--out=" + once}));
  Process second(bench_words({"demo", "--seed=2", "--out=" + once}));
  EXPECT_EQ(first.wait().exit_code + second.wait().exit_code, kUsage);
  EXPECT_EQ(run_bench({"list", "data", once + "/set.json"}).exit_code, 0);
}

}  // namespace
}  // namespace odobench
