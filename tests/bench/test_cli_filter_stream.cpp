// `bench filter --data=-`: a stream that is interrupted. And the comparison with a Kalman filter.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>
#include <sys/stat.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "tests/support/data/filter_run_files.hpp"
#include "tests/support/data/small_dataset.hpp"
#include "tests/support/refusal.hpp"

namespace odobench {
namespace {

using testing::CircleRun;
using testing::content;
using testing::everything_in;
using testing::expect_refusal;
using ::testing::HasSubstr;
using testing::kInterrupted;
using testing::kUsage;
using testing::lines;
using testing::plain_run;
using testing::Process;
using testing::ProcessResult;
using testing::run_bench;
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

// Constant motion without noise: the linear smoother knows it exactly, as the filter does.
TEST(FilterComparison, ALinearFilterAndSmootherStandInTheSameTable) {
  const TemporaryFolder folder;
  CircleRun run;
  const std::vector<std::string> words{"filter", "--data=" + folder.file("run.csv", run.data()),
                                       fmt::format("--wheel-distance={}", run.wheel_distance()), "--quiet",
                                       "--format=json"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), words.begin(), words.end());
    return run_bench(more);
  };
  const std::string truth = "--truth=" + folder.file("truth.csv", run.truth());
  const ProcessResult result = with({truth, "--compare=kalman"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json tables = nlohmann::json::parse(result.out).at("tables");
  const nlohmann::json& noise = tables.at(0).at("rows");
  ASSERT_EQ(noise.size(), 14u);  // no ratios of accelerations that are 0, and the time
  for (std::size_t row = 0; row < 13; ++row) {
    if (!noise[row].contains("kalman") || noise[row]["kalman"].is_null()) continue;
    EXPECT_LT(noise[row].at("kalman").get<double>(), 1e-12) << row;
    EXPECT_LT(noise[row].at("smoother").get<double>(), 1e-12) << row;
  }
  EXPECT_GT(noise[13].at("smoother").get<double>(), noise[13].at("kalman").get<double>());
  EXPECT_EQ(tables.at(1).at("rows").size(), 5u);
  // Nothing else changes: the same tables without it have neither columns nor rows of it.
  const nlohmann::json plain = nlohmann::json::parse(with({truth}).out).at("tables");
  EXPECT_EQ(plain.at(0).at("rows").size(), 13u);
  EXPECT_FALSE(plain.at(0).at("rows").at(0).contains("kalman"));
  expect_refusal({"filter", words[1], "--compare=kalman"}, kUsage, {"give --truth, too"});
  expect_refusal({"filter", words[1], truth, "--compare=ekf"}, kUsage, {"expected kalman"});
}

}  // namespace
}  // namespace odobench
