// Work that nobody would wait for is refused before it begins, and what takes long ends when it is told to.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "tests/support/run_process.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;
using testing::bench_words;
using testing::content;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::lines;
using testing::Process;
using testing::ProcessResult;
using testing::run_bench;
using ::testing::SizeIs;
using ::testing::StartsWith;
using testing::TemporaryFolder;
using testing::wait_for_lines;

constexpr int kUsage = 2, kData = 3, kInterrupted = 130;
// Each of these ran for hours.
constexpr double kSoon_s = 60;

void expect_refusal(const std::vector<std::string>& words, int code, const std::vector<std::string>& parts) {
  const ProcessResult result = run_bench(words, kSoon_s);
  EXPECT_EQ(result.exit_code, code) << result.err;
  EXPECT_THAT(result.out, IsEmpty());
  EXPECT_THAT(lines(result.err), SizeIs(1)) << result.err;
  for (const std::string& part : parts) EXPECT_THAT(result.err, HasSubstr(part));
}

std::string scenario(const std::string& kind, const std::string& more) {
  return R"({"schema": "odobench-scenario", "schema_version": 1, "name": "s", "kind": ")" + kind + "\"" +
         more + "}";
}
std::string recordings(const std::string& more) {
  return scenario("recordings", more);
}
std::string drive(const std::string& more) {
  return R"("drives": [{"name": "d", "vx_m_s": 0.04, )" + more + "}]";
}
std::string dynamics(const std::string& until, const std::string& voltage, const std::string& more) {
  return scenario("dynamics", R"(, "segments": [{"until_s": )" + until + R"(, "voltage_V": [)" + voltage +
                                  ", " + voltage + ", 6, 6]}]" + more);
}

TEST(CliLimits, QuantitiesOfAScenarioHaveLimits) {
  struct Case {
    std::string text;
    std::vector<std::string> parts;
  };
  const std::vector<Case> cases = {
      {recordings(", " + drive(R"("duration_s": 1e9)")), {"the duration is 1000000000 s", "up to 86400 s"}},
      {recordings(", " + drive(R"("duration_s": 10, "vy_m_s": 1e9)")), {"a velocity is", "at most 1000"}},
      {recordings(R"(, "idle": {"before_s": [0, 1e12]})"),
       {"idle/before_s: found 0 to 1000000000000", "3600 s"}},
      {recordings(R"(, "odometry": {"stall_s": [0, 1e9]})"), {"odometry/stall_s", "60 s"}},
      {recordings(R"(, "odometry": {"delay_s": 1e40})"), {"odometry/delay_s: found 1e+40", "60 s"}},
      {recordings(R"(, "capture": {"poll_s": 1e9})"), {"capture/poll_s: found 1000000000", "60 s"}},
      {recordings(R"(, "control": {"delay_s": 1e9})"), {"control/delay_s: found 1000000000", "60 s"}},
      {recordings(R"(, "control": {"steering_rate_rad_s": 1e40})"), {"control/steering_rate_rad_s"}},
      {recordings(R"(, "start": {"position_m": 1e9})"), {"start/position_m: found 1000000000", "1000 m"}},
      {recordings(R"(, "robot": {"truth": {"r1": 1e-300}})"), {"robot/truth: r1 is 1e-300"}},
      {recordings(R"(, "robot": {"truth": {"a1": 1e40}})"), {"robot/truth: wheel 1 stands at (1e+40"}},
      {dynamics("1e9", "6", ""), {"segment 1: until_s is 1000000000, expected at most 86400 s"}},
      {dynamics("10", "1e9", ""), {"segment 1: the voltage of wheel 1 is 1000000000", "-1000 to 1000 V"}},
      {dynamics("10", "6", R"(, "output_step_s": 1e-9)"),
       {"output_step_s is 1e-09", "expected at most 2000000"}},
      {dynamics("10", "6", R"(, "integration": {"method": "rk4", "step_s": 1e-9})"),
       {"integration: step_s is 1e-09", "takes 1e+10 steps", "at most 100000000"}},
      {dynamics("10", "6", R"(, "integration": {"relative_tolerance": 1e-300})"),
       {"relative_tolerance is 1e-300"}},
      {dynamics("50", "6", R"(, "robot": {"inductance": 1e-8})"), {"inductance is 1e-08 H", "steps"}},
      {dynamics("10", "6", R"(, "robot": {"mass": 1e40})"),
       {"mass is 1e+40 kg, expected at most 1000000 kg"}},
      {dynamics("10", "6", R"(, "noise": {"yaw_deg2": 1e40})"), {"yaw_deg2 is 1e+40"}},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.text);
    const TemporaryFolder folder;
    std::vector<std::string> parts = c.parts;
    const std::string file = folder.file("s.json", c.text);
    parts.push_back(file);
    expect_refusal({"simulate", "--scenario=" + file, "--out=" + (folder / "out").string()}, kData, parts);
    EXPECT_FALSE(fs::exists(folder / "out"));
  }
}

// Every quantity is one that exists; together they are too much.
TEST(CliLimits, TheProductOfQuantitiesHasALimit) {
  const TemporaryFolder folder;
  const std::string file =
      folder.file("s.json", recordings(R"(, "repetitions": 10000, )" + drive(R"("duration_s": 80000)")));
  expect_refusal({"simulate", "--scenario=" + file, "--out=" + (folder / "out").string()}, kUsage,
                 {"--scenario=" + file, "1 drives 10000 times", "about 1.01e+11 samples", "at most 2e+07"});
  expect_refusal({"verify", "--scenario=" + file, "--parameters=nominal"}, kUsage,
                 {"--repeat=10", "at most 2e+07"});
  expect_refusal({"plan", "--robot=" + file, "--replicas=10000"}, kUsage,
                 {"--replicas=10000", "at most 2e+07"});
  EXPECT_FALSE(fs::exists(folder / "out"));
  const std::string motors = folder.file("m.json", dynamics("86400", "6", R"(, "output_step_s": 0.01)"));
  expect_refusal({"simulate", "--scenario=" + motors, "--out=" + (folder / "out").string()}, kData,
                 {"output_step_s is 0.01, a drive of 86400 s makes 8.64e+06 samples"});
}

TEST(CliLimits, SensorsHaveLimits) {
  const std::string source = content(testing::source_dir() / "datasets/sensors/heading_only.json");
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& from, const std::string& to,
                           const std::vector<std::string>& parts) {
    SCOPED_TRACE(to);
    std::string text = source;
    const auto at = text.find(from);
    ASSERT_NE(at, std::string::npos) << source;
    text.replace(at, text.find_first_of(",}\n", at) - at, to);
    expect_refusal({"fuse", "--sensors=" + folder.file("s.json", text)}, kData, parts);
  };
  refused("\"rate_hz\":", "\"rate_hz\": 1e-300", {"/sensors/0/rate_hz: found 1e-300", "up to 100000 Hz"});
  refused("\"rate_hz\":", "\"rate_hz\": 1e40", {"/sensors/0/rate_hz: found 1e+40", "up to 100000 Hz"});
  refused("\"rate_hz\":", "\"rate_hz\": 1e5", {"measurements, expected at most 2e+07"});
  refused("\"sigma_heading\":", "\"sigma_heading\": 1e-300", {"sigma_heading: found 1e-300"});
}

TEST(CliLimits, RepetitionsHaveALimitAndBeginAtOnce) {
  expect_refusal({"--repeat=1000000", "--solver=pso"}, kUsage, {"--repeat=1000000", "1..100000"});
  expect_refusal({"--repeat=100000", "--solver=pso,ga,cmaes", "--problem=rosenbrock"}, kUsage,
                 {"--repeat=100000", "more than 200000 runs"});
  const TemporaryFolder folder;
  Process bench(bench_words({"--repeat=100000", "--solver=pso", "--max-evals=10", "--problem=rosenbrock",
                             "--out=" + (folder / "out").string()}));
  EXPECT_TRUE(wait_for_lines(folder / "out/runs.jsonl", 1, kSoon_s));
  bench.send(SIGTERM);
  EXPECT_EQ(bench.wait().exit_code, kInterrupted);
}

// Elements of an array were looked through once for every other one.
TEST(CliLimits, AMillionElementsAreReadInOnePass) {
  const TemporaryFolder folder;
  std::string text = R"({"schema": "odobench-dataset", "recordings": [)";
  for (int i = 0; i < 1'000'000; ++i) text += "{},";
  expect_refusal({"evaluate", "--data=" + folder.file("set.json", text + "{}]}")}, kData,
                 {"no key \"schema_version\""});
}

TEST(CliLimits, MatricesHaveALimit) {
  const TemporaryFolder folder;
  std::string row = "[0";
  for (int i = 0; i < 2000; ++i) row += ",0";
  std::string text = R"({"A": [)" + row + "]";
  for (int i = 0; i < 2000; ++i) text += "," + row + "]";
  expect_refusal({"discretise", "--period=1", "--system=" + folder.file("s.json", text + "]}")}, kData,
                 {"/A: found 2001 rows, expected at most 200"});
}

// ---------------------------------------------------------------- interruptions

// Starts the verb, which takes minutes and writes below `folder` only, and ends it in the middle.
void expect_end_without_a_trace(const std::vector<std::string>& words, const TemporaryFolder& folder,
                                int signal) {
  SCOPED_TRACE(words.front() + " and signal " + std::to_string(signal));
  Process bench(bench_words(words));
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  bench.send(signal);
  const ProcessResult result = bench.wait(kSoon_s);
  EXPECT_EQ(result.exit_code, kInterrupted) << result.err;
  ASSERT_FALSE(lines(result.err).empty());
  EXPECT_EQ(lines(result.err).back(), "bench: error: interrupted; nothing was written");
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST(CliLimits, LongVerbsEndAtOnceAndLeaveNothing) {
  const TemporaryFolder folder;
  const std::string long_one =
      "--scenario=" +
      folder.file("s.json", recordings(", \"repetitions\": 20, " + drive(R"("duration_s": 7000)")));
  const std::string out = "--out=" + (folder / "out").string();
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    expect_end_without_a_trace({"simulate", long_one, out, "--threads=1"}, folder, signal);
  expect_end_without_a_trace({"verify", long_one, "--parameters=nominal", "--repeat=100", "--threads=1"},
                             folder, SIGHUP);
  expect_end_without_a_trace(
      {"plan", "--robot=" + (folder / "s.json").string(), "--replicas=20", "--threads=1"}, folder, SIGTERM);
  const std::string motors = folder.file(
      "m.json",
      dynamics("86400", "6", R"(, "output_step_s": 10, "integration": {"method": "rk4", "step_s": 1e-3})"));
  expect_end_without_a_trace({"simulate", "--scenario=" + motors, out}, folder, SIGTERM);
}

TEST(CliLimits, ARunEndsAtOnceWhileItReads) {
  const TemporaryFolder folder;
  std::string text = R"({"schema": "odobench-dataset", "recordings": [)";
  for (int i = 0; i < 4'000'000; ++i) text += "[0,1],";
  const std::string data = "--data=" + folder.file("set.json", text + "{}]}");
  expect_end_without_a_trace({"run", data, "--out=" + (folder / "out").string()}, folder, SIGTERM);
  expect_end_without_a_trace({"evaluate", data}, folder, SIGHUP);
}

std::vector<std::string> long_run(const fs::path& out) {
  return bench_words({"--solver=cmaes", "--problem=rastrigin", "--dimension=10", "--repeat=10000",
                      "--threads=2", "--max-evals=20000", "--out=" + out.string()});
}

// `timeout` signals the process and then its group; a closed terminal comes twice, too.
TEST(CliLimits, ASignalThatComesTwiceInAMomentKeepsTheTables) {
  for (const int signal : {SIGTERM, SIGHUP}) {
    const TemporaryFolder folder;
    Process bench(long_run(folder / "out"));
    ASSERT_TRUE(wait_for_lines(folder / "out/runs.jsonl", 3));
    bench.send(signal);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    bench.send(signal);
    const ProcessResult result = bench.wait();
    EXPECT_EQ(result.exit_code, kInterrupted) << "signal " << result.signal;
    EXPECT_THAT(result.err, HasSubstr("interrupted: "));
    EXPECT_TRUE(fs::exists(folder / "out/tables.json"));
  }
}

TEST(CliLimits, NohupIsHeeded) {
  const TemporaryFolder folder;
  const std::string program = bench_words({}).front();
  Process bench({"/bin/sh", "-c",
                 "trap '' HUP; exec '" + program +
                     "' --solver=cmaes --problem=rastrigin --repeat=30 --out='" + (folder / "out").string() +
                     "'"});
  ASSERT_TRUE(wait_for_lines(folder / "out/runs.jsonl", 3));
  bench.send(SIGHUP);
  EXPECT_EQ(bench.wait().exit_code, 0);
}

}  // namespace
}  // namespace odobench
