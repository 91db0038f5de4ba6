// `bench filter --data=-`: a stream that is interrupted.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <sstream>
#include <thread>

#include "tests/support/data/filter_run_files.hpp"
#include "tests/support/data/small_dataset.hpp"
#include "tests/support/refusal.hpp"

namespace odobench {
namespace {

using testing::content;
using testing::everything_in;
using ::testing::HasSubstr;
using testing::kInterrupted;
using testing::lines;
using testing::plain_run;
using testing::Process;
using testing::ProcessResult;
using testing::TemporaryFolder;

using Row = std::vector<std::string>;

// Rows of a CSV file without quotes.
std::vector<Row> csv(const std::filesystem::path& file) {
  std::vector<Row> rows;
  for (const std::string& line : lines(content(file))) {
    std::istringstream in(line + ",");
    rows.emplace_back();
    for (std::string field; std::getline(in, field, ',');) rows.back().push_back(field);
  }
  return rows;
}

// A shell that gives the filter a pipe as standard input.
std::vector<std::string> from_pipe(const std::string& pipe, const std::string& out) {
  const std::string bench = testing::bench_words({}).front();
  return {"/bin/sh", "-c", "exec '" + bench + "' filter --data=- --out='" + out + "' <'" + pipe + "'"};
}

TEST(CliFilterStream, CtrlCKeepsTheWindowsSoFar) {
  const TemporaryFolder folder;
  const std::string fifo = (folder / "fifo").string(), out = (folder / "out.csv").string();
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  Process process(from_pipe(fifo, out));
  std::ofstream writer(fifo);  // waits for the reader
  writer << plain_run(2000) << std::flush;
  // The temporary file shows that windows were written.
  bool begun = false;
  for (int i = 0; i < 3000 && !begun; ++i) {
    for (const std::string& name : everything_in(folder.path()))
      begun = begun || (name.rfind("out.csv.tmp", 0) == 0 && content(folder / name).size() > 100000);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ASSERT_TRUE(begun);
  process.send(SIGINT);
  const ProcessResult result = process.wait();
  EXPECT_EQ(result.exit_code, kInterrupted) << result.err;
  EXPECT_THAT(result.err, HasSubstr("interrupted after"));
  EXPECT_THAT(result.out, HasSubstr("windows"));
  const std::vector<Row> rows = csv(out);
  EXPECT_GT(rows.size(), 100u);
  EXPECT_EQ(rows.back().size(), rows.front().size());
  EXPECT_EQ(rows.back()[0], std::to_string(rows.size() - 2));
  EXPECT_EQ(everything_in(folder.path()), (std::vector<std::string>{"fifo", "out.csv"}));
}

TEST(CliFilterStream, CtrlCBeforeTheFirstWindow) {
  const TemporaryFolder folder;
  const std::string fifo = (folder / "fifo").string(), out = (folder / "out.csv").string();
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  Process process(from_pipe(fifo, out));
  std::ofstream writer(fifo);
  writer << plain_run(5) << std::flush;
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  process.send(SIGTERM);
  EXPECT_EQ(process.wait().exit_code, kInterrupted);
  EXPECT_EQ(everything_in(folder.path()), std::vector<std::string>{"fifo"});
}

}  // namespace
}  // namespace odobench
