// The simulation verbs as users meet them: simulate, plan, verify, list scenarios.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "datasets/dataset.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;
using testing::content;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::lines;
using testing::ProcessResult;
using testing::run_bench;
using ::testing::SizeIs;
using ::testing::StartsWith;
using testing::TemporaryFolder;

constexpr int kUsage = 2;
constexpr int kData = 3;

void expect_refusal(const std::vector<std::string>& words, int code, const std::vector<std::string>& parts) {
  const ProcessResult result = run_bench(words);
  std::string command;
  for (const std::string& word : words) command += " " + word;
  SCOPED_TRACE(command);
  EXPECT_EQ(result.exit_code, code) << result.err;
  EXPECT_THAT(result.out, IsEmpty());
  EXPECT_THAT(lines(result.err), SizeIs(1)) << result.err;
  EXPECT_THAT(result.err, StartsWith("bench: error: "));
  for (const std::string& part : parts) EXPECT_THAT(result.err, HasSubstr(part));
}

std::string small_scenario(const std::string& more = "") {
  return R"({"schema": "odobench-scenario", "schema_version": 1, "kind": "recordings", "name": "small",
             "drives": ["rotation_ccw", "rotation_cw"], "repetitions": 2)" +
         more + "}";
}
std::string motor_scenario(const std::string& more) {
  return R"({"schema": "odobench-scenario", "schema_version": 1, "kind": "dynamics", "name": "motor")" +
         more + "}";
}
constexpr const char* kSegments = R"(, "segments": [{"until_s": 1, "voltage_V": [6, 6, 6, 6]}])";

nlohmann::json tables_of(const ProcessResult& result) {
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return nlohmann::json::parse(result.out).at("tables");
}

TEST(CliSimulate, MakesADataSetThatSolversTake) {
  const TemporaryFolder folder;
  const std::string scenario = folder.file("s.json", small_scenario());
  const ProcessResult made =
      run_bench({"simulate", "--scenario=" + scenario, "--seed=5", "--out=" + (folder / "set").string()});
  EXPECT_EQ(made.exit_code, 0) << made.err;
  EXPECT_THAT(made.err, HasSubstr("4 recordings"));
  const Dataset set = load_dataset(folder / "set" / "set.json");
  EXPECT_EQ(set.recordings.size(), 4u);
  EXPECT_EQ(set.known_parameters.at(0).name, "truth");
  EXPECT_EQ(set.provenance.made_by, "bench simulate --scenario=small --seed=5");
  const nlohmann::json truth = nlohmann::json::parse(content(folder / "set" / "truth.json"));
  EXPECT_EQ(truth.at("seed"), 5);
  EXPECT_EQ(truth.at("parameters").at("r1"), 0.0254);
  EXPECT_EQ(truth.at("drives").size(), 4u);
  EXPECT_NEAR(
      truth.at("drives")[0].at("end_s").get<double>() - truth.at("drives")[0].at("begin_s").get<double>(),
      39.7, 0.1);
  EXPECT_THAT(content(folder / "set" / "truth.csv"),
              StartsWith("recording,time_s,x,y,theta\nrotation_ccw_1,"));
  const std::string data = "--data=" + (folder / "set" / "set.json").string();
  EXPECT_EQ(run_bench({"run", data, "--solver=lm"}).exit_code, 0);
  EXPECT_EQ(run_bench({"evaluate", data, "--parameters=truth,believed"}).exit_code, 0);
}

TEST(CliSimulate, RepeatsToTheLastByteForAnyThreads) {
  const TemporaryFolder folder;
  const std::string scenario = "--scenario=" + folder.file("s.json", small_scenario());
  for (const std::string threads : {"1", "3"})
    ASSERT_EQ(run_bench({"simulate", scenario, "--seed=9", "--threads=" + threads, "--quiet",
                         "--out=" + (folder / threads).string()})
                  .exit_code,
              0);
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder / "1")) {
    if (!entry.is_regular_file()) continue;
    ++files;
    EXPECT_EQ(content(entry.path()),
              content(folder / "3" / fs::relative(entry.path(), folder / "1").string()));
  }
  EXPECT_EQ(files, 7u);
}

// The import reads the raw files of a simulation to the very recordings that the data set has.
TEST(CliSimulate, RawFilesImportToTheSameRecordings) {
  const TemporaryFolder folder;
  const std::vector<std::string> common = {"simulate", "--scenario=vitko2024", "--seed=3", "--quiet"};
  const auto simulate = [&](const std::string& more, const std::string& out) {
    std::vector<std::string> words = common;
    if (!more.empty()) words.push_back(more);
    words.push_back("--out=" + (folder / out).string());
    return run_bench(words).exit_code;
  };
  ASSERT_EQ(simulate("--raw", "raw"), 0);
  ASSERT_EQ(simulate("", "set"), 0);
  EXPECT_THAT(lines(content(folder / "raw" / "SHA256SUMS")), SizeIs(60));
  const ProcessResult imported = run_bench({"import", "vitko2024", "--from=" + (folder / "raw").string(),
                                            "--out=" + (folder / "again.json").string(), "--quiet"});
  ASSERT_EQ(imported.exit_code, 0) << imported.err;
  const Dataset a = load_dataset(folder / "set" / "set.json"), b = load_dataset(folder / "again.json");
  ASSERT_EQ(a.recordings.size(), b.recordings.size());
  for (std::size_t i = 0; i < a.recordings.size(); ++i) {
    EXPECT_EQ(a.recordings[i].id, b.recordings[i].id);
    EXPECT_EQ(a.recordings[i].time_us, b.recordings[i].time_us);
    EXPECT_EQ(a.recordings[i].reference.x, b.recordings[i].reference.x);
    EXPECT_EQ(a.recordings[i].signals, b.recordings[i].signals);
    for (std::size_t k = 0; k < a.recordings[i].size(); ++k)
      ASSERT_NEAR(a.recordings[i].reference.theta[k], b.recordings[i].reference.theta[k], 1e-12);
  }
}

TEST(CliSimulate, MakesSensorLogsOfTheMotorRobot) {
  const TemporaryFolder folder;
  const std::string out = "--out=" + (folder / "run").string();
  ASSERT_EQ(run_bench({"simulate", "--scenario=filter_turns", "--seed=2", out}).exit_code, 0);
  const std::vector<std::string> sensors = lines(content(folder / "run" / "sensors.csv"));
  ASSERT_THAT(sensors, SizeIs(202));
  EXPECT_EQ(
      sensors[0],
      "time_s,enc1_m,enc2_m,enc3_m,enc4_m,ax_m_s2,ay_m_s2,yaw_step_deg,psi1_rad,psi2_rad,psi3_rad,psi4_rad");
  const std::vector<std::string> truth = lines(content(folder / "run" / "truth.csv"));
  ASSERT_THAT(truth, SizeIs(202));
  EXPECT_EQ(truth[0], "sx,sy,dtheta_deg,ax,ay,enc1x,enc1y,enc2x,enc2y,enc3x,enc3y,enc4x,enc4y");
  EXPECT_THAT(lines(content(folder / "run" / "state.csv")), SizeIs(202));
  const nlohmann::json robot = nlohmann::json::parse(content(folder / "run" / "robot.json"));
  EXPECT_EQ(robot.at("mass").at("origin"), "given");
  EXPECT_EQ(robot.at("resistance").at("origin"), "chosen");
  // What the program writes about its robot a scenario may state.
  const std::string stated = folder.file(
      "stated.json",
      motor_scenario(std::string(kSegments) + ", \"robot\": " + content(folder / "run" / "robot.json")));
  EXPECT_EQ(
      run_bench({"simulate", "--scenario=" + stated, "--out=" + (folder / "stated").string()}).exit_code, 0);
}

TEST(CliSimulate, AsPublishedBringsTheErrorsBack) {
  const TemporaryFolder folder;
  const auto end_of = [&](const std::string& option, const std::string& out) {
    std::vector<std::string> words = {"simulate", "--scenario=exp1_steered",
                                      "--out=" + (folder / out).string()};
    if (!option.empty()) words.push_back(option);
    EXPECT_EQ(run_bench(words).exit_code, 0);
    const std::string last = lines(content(folder / out / "state.csv")).back();
    std::size_t at = 0;
    for (int k = 0; k < 21; ++k) at = last.find(',', at) + 1;
    return std::stod(last.substr(at));
  };
  EXPECT_NEAR(end_of("--as-published", "old"), 277.917397, 1e-4);  // 44 turns in 50 s
  EXPECT_LT(end_of("", "new"), 30);
}

TEST(CliSimulate, ListsScenarios) {
  const nlohmann::json list = tables_of(run_bench({"list", "scenarios", "--format=json"})).at(0).at("rows");
  std::vector<std::string> names;
  for (const auto& row : list) names.push_back(row.at("scenario"));
  for (const std::string name : {"exp1_steered", "filter_run", "nominal", "vitko2024"})
    EXPECT_THAT(names, ::testing::Contains(name));
  EXPECT_THAT(run_bench({"list", "scenarios", "exp2_circle"}).out, HasSubstr("given"));
  EXPECT_THAT(run_bench({"list", "scenarios", "vitko2024"}).out, HasSubstr("circle_ccw"));
}

TEST(CliPlan, SaysWhatIsDeterminedAndWhatNot) {
  const nlohmann::json tables = tables_of(run_bench({"plan", "--robot=exact", "--format=json"}));
  EXPECT_EQ(tables.at(0).at("rows").size(), 12u);
  EXPECT_EQ(tables.at(0).at("rows")[0].at("deviation"), "not at all");
  EXPECT_EQ(tables.at(2).at("id"), "plan.undetermined");
  EXPECT_EQ(tables.at(2).at("rows").size(), 6u);
  const nlohmann::json proposed = tables_of(run_bench(
      {"plan", "--robot=off_nominal", "--candidates=all", "--wanted=1", "--replicas=6", "--format=json"}));
  const auto& rows = proposed.back().at("rows");
  ASSERT_GE(rows.size(), 1u);
  EXPECT_LE(rows.back().at("largest_deviation").get<double>(), 1);
  // The proposals keep their promise.
  std::string drives;
  for (const std::string name :
       {"line_x", "line_y", "circle_ccw", "circle_cw", "rotation_ccw", "rotation_cw"})
    for (int k = 0; k < 5; ++k) drives += name + ",";
  for (const auto& row : rows) drives += row.at("drive").get<std::string>() + ",";
  drives.pop_back();
  const nlohmann::json after = tables_of(run_bench(
      {"plan", "--robot=off_nominal", "--drives=" + drives, "--wanted=1", "--replicas=6", "--format=json"}));
  for (const auto& row : after.at(0).at("rows")) EXPECT_LE(row.at("deviation").get<double>(), 1.2);
}

TEST(CliPlan, LeavesARecordThatGivesTheTablesAgain) {
  const TemporaryFolder folder;
  const std::string out = (folder / "plan").string();
  const std::vector<std::string> words = {"plan",         "--robot=off_nominal", "--drives=line_x",
                                          "--replicas=4", "--candidates=all",    "--out=" + out};
  const ProcessResult planned = run_bench(words);
  ASSERT_EQ(planned.exit_code, 0) << planned.err;
  EXPECT_THAT(planned.out, HasSubstr("--replicas=4: the noise of 1 drive shows in 3 of 12 combinations"));
  EXPECT_THAT(planned.out, HasSubstr("--replicas=13."));
  EXPECT_EQ(run_bench({"report", out}).out, planned.out);
  EXPECT_EQ(content(folder / "plan/tables.txt"), planned.out);
  EXPECT_EQ(run_bench({"report", out, "--out=" + out + "/page.html"}).exit_code, 0);
  EXPECT_THAT(content(folder / "plan/page.html"), HasSubstr("Planned drives"));
  const ProcessResult again = run_bench(words);
  EXPECT_EQ(again.exit_code, 2);
  EXPECT_THAT(again.err, HasSubstr("it holds runs.jsonl already; choose another folder or give --overwrite"));
  const nlohmann::json same = tables_of(run_bench({"compare", out, out, "--format=json"}));
  EXPECT_GE(same.at(0).at("rows")[0].at("compared").get<int>(), 10);
  EXPECT_EQ(same.at(0).at("rows")[0].at("changed").get<int>(), 0);
}

TEST(CliVerify, LeavesRecordsThatReportAndCompareRead) {
  const TemporaryFolder folder;
  const std::string scenario = folder.file("s.json", small_scenario("")), out = (folder / "new").string();
  const ProcessResult judged = run_bench({"verify", "--scenario=" + scenario, "--parameters=truth",
                                          "--repeat=3", "--format=json", "--out=" + out});
  ASSERT_EQ(judged.exit_code, 0) << judged.err;
  const nlohmann::json tables = tables_of(judged),
                       report = tables_of(run_bench({"report", out, "--format=json"}));
  const auto table = [&](const nlohmann::json& list, const std::string& id) {
    for (const nlohmann::json& one : list)
      if (one.at("id") == id) return one.at("rows");
    ADD_FAILURE() << "no table " << id;
    return nlohmann::json::array();
  };
  const auto number = [](const nlohmann::json& cell) {
    return (cell.is_object() ? cell.at("value") : cell).get<double>();
  };
  // Means of means over the repeats are those over all drives, up to the order of summation.
  const nlohmann::json sums = table(tables, "verify.totals"), reported = table(report, "totals");
  ASSERT_EQ(reported.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_NEAR(number(reported[i].at("total")), number(sums[i].at("total")), 1e-12);
  const nlohmann::json ends = table(tables, "verify.arrival"), told = table(report, "verify.arrival");
  ASSERT_EQ(told.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i)
    for (const auto& [name, cell] : told[i].items()) {
      if (name == "parameters") continue;
      EXPECT_NEAR(number(cell), number(ends[i].at(name)), 1e-15) << name;
    }
  for (const nlohmann::json& one : report) EXPECT_NE(one.at("id"), "solvers");
  EXPECT_EQ(run_bench({"compare", out, out, "--fail-on=e_sr:+1%"}).exit_code, 0);
}

TEST(CliVerify, RanksTheTruthBeforeNominal) {
  const TemporaryFolder folder;
  const std::string scenario = folder.file(
      "s.json",
      small_scenario(R"(, "robot": {"truth": {"r1": 0.026, "r2": 0.026, "r3": 0.026, "r4": 0.026}})"));
  const std::vector<std::string> words = {"verify",     "--scenario=" + scenario, "--parameters=truth",
                                          "--repeat=3", "--format=json",          "--seed=4"};
  const ProcessResult one = run_bench(words);
  const nlohmann::json tables = tables_of(one);
  ASSERT_EQ(tables.size(), 4u);  // two trajectories, totals, arrival
  const auto& totals = tables.at(2).at("rows");
  EXPECT_EQ(totals[0].at("parameters"), "nominal");
  EXPECT_EQ(totals[1].at("parameters"), "truth");
  EXPECT_LT(totals[1].at("total").at("value").get<double>(), 0.5 * totals[0].at("total").get<double>());
  EXPECT_LT(totals[1].at("change_percent").get<double>(), -50);
  EXPECT_GT(totals[0].at("total_ci95").get<double>(), 0);
  std::vector<std::string> threads = words;
  threads.push_back("--threads=3");
  EXPECT_EQ(run_bench(threads).out, one.out);
}

TEST(CliSimulateErrors, BadUsage) {
  const TemporaryFolder folder;
  const std::string out = "--out=" + (folder / "out").string(),
                    small = folder.file("s.json", small_scenario());
  const std::string open = folder.file("o.json", small_scenario(R"(, "control": {"mode": "open_loop"})"));
  expect_refusal({"simulate", "--scenario=vitko", out}, kUsage, {"--scenario=vitko", "known:", "vitko2024"});
  expect_refusal({"simulate", "--scenario=nominal"}, kUsage, {"--out"});
  expect_refusal({"simulate", "--scenario=nominal", out, "--as-published"}, kUsage, {"--as-published"});
  expect_refusal({"simulate", "--scenario=exact", out, "--raw"}, kUsage, {"contradictory options", "exact"});
  expect_refusal({"simulate", "--scenario=" + small, out, "--raw"}, kUsage,
                 {"--raw", "2 drives, 2 repetitions"});
  expect_refusal({"simulate", "--scenario=filter_run", out, "--raw"}, kUsage, {"--raw", "kind recordings"});
  expect_refusal({"simulate", "--scenario=nominal", out, "--threads=0"}, kUsage, {"--threads=0"});
  expect_refusal({"simulate", "--scenario=nominal", out, "--seed=x"}, kUsage, {"--seed=x"});
  expect_refusal({"plan", "--robot=filter_run"}, kUsage, {"kind is dynamics"});
  expect_refusal({"plan", "--robot=nominal", "--drives=line_z"}, kUsage, {"--drives", "line_z", "line_x"});
  expect_refusal({"plan", "--robot=nominal", "--drives=none"}, kUsage, {"--candidates"});
  expect_refusal({"plan", "--robot=nominal", "--wanted=0"}, kUsage, {"--wanted=0"});
  expect_refusal({"verify", "--scenario=" + open, "--parameters=truth"}, kUsage, {"open loop"});
  expect_refusal({"verify", "--scenario=" + small, "--parameters=trut"}, kUsage, {"trut", "truth"});
  expect_refusal({"verify", "--scenario=" + small, "--parameters=truth,truth"}, kUsage,
                 {"two sets are called"});
  expect_refusal({"list", "scenarios", "nominl"}, kUsage, {"did you mean 'nominal'"});
  ASSERT_EQ(run_bench({"simulate", "--scenario=" + small, out}).exit_code, 0);
  expect_refusal({"simulate", "--scenario=" + small, out}, kUsage, {"it exists", "--overwrite"});
  EXPECT_EQ(run_bench({"simulate", "--scenario=" + small, out, "--overwrite"}).exit_code, 0);
}

TEST(CliSimulateErrors, BadScenarios) {
  const TemporaryFolder folder;
  const std::string out = "--out=" + (folder / "out").string();
  const auto refused = [&](const std::string& text, const std::vector<std::string>& parts) {
    const std::string file = folder.file("bad.json", text);
    expect_refusal({"simulate", "--scenario=" + file, out}, kData, parts);
    EXPECT_FALSE(fs::exists(folder / "out"));
  };
  refused(small_scenario(R"(, "drivs": [])"), {"bad.json", "drivs"});
  refused(small_scenario(R"(, "robot": {"steering_limit_deg": 30})"), {"unreachable steering"});
  refused(small_scenario(R"(, "capture": {"rate_hz": 0})"), {"capture/rate_hz"});
  refused("{", {"bad.json:1"});
  refused(motor_scenario(""), {"segments"});
  refused(motor_scenario(std::string(kSegments) + R"(, "robot": {"mass": -5})"),
          {"mass is -5 kg", "positive"});
  refused(motor_scenario(std::string(kSegments) + R"(, "robot": {"mas": 5})"), {"/robot", "mas", "mass"});
  refused(motor_scenario(std::string(kSegments) + R"(, "robot": {"mass": {"value": 5, "unit": "g"}})"),
          {"/robot/mass/unit", "\"g\"", "\"kg\""});
  refused(motor_scenario(std::string(kSegments) + R"(, "robot": {"mass": {"value": 5, "origin": "guess"}})"),
          {"/robot/mass/origin", "given or chosen"});
  refused(motor_scenario(R"(, "segments": [{"until_s": 0, "voltage_V": [6, 6, 6, 6]}])"),
          {"until_s is 0", "duration"});
  refused(motor_scenario(
              R"(, "segments": [{"until_s": 1, "voltage_V": [6, 6, 6, 6], "steering_deg": [95, 0, 0, 0]}])"),
          {"steering of wheel 1 is 95 deg"});
  refused(motor_scenario(R"(, "segments": [{"until_s": 1, "voltage_V": [6, 6, 6]}])"), {"3 numbers", "four"});
  refused(motor_scenario(std::string(kSegments) + R"(, "output_step_s": 0)"), {"output_step_s is 0"});
  refused(motor_scenario(std::string(kSegments) + R"(, "model": {"torque_with_radius": false})"),
          {"contradictory options"});
  refused(motor_scenario(std::string(kSegments) +
                         R"(, "integration": {"method": "rk4", "relative_tolerance": 1e-9})"),
          {"contradictory options", "rk4"});
  refused(motor_scenario(std::string(kSegments) + R"(, "noise": {"yaw_deg2": -1})"), {"yaw_deg2 is -1"});
}

// Every key that the schema lists is known to the program, and every key the program knows is in the schema.
TEST(CliSimulateErrors, TheSchemaListsTheKeysTheProgramKnows) {
  const TemporaryFolder folder;
  const nlohmann::json schema =
      nlohmann::json::parse(content(source_dir() / "datasets" / "scenarios" / "schema.json"));
  std::size_t blocks = 0;
  const auto compare = [&](const std::string& scenario, const nlohmann::json& properties) {
    const std::string file = folder.file("unknown.json", scenario);
    const std::string error =
        run_bench({"simulate", "--scenario=" + file, "--out=" + (folder / "out").string()}).err;
    const std::string mark = "expected one of ";
    ASSERT_THAT(error, HasSubstr(mark));
    std::vector<std::string> known, listed;
    std::string rest = error.substr(error.find(mark) + mark.size());
    rest.erase(rest.find_last_not_of('\n') + 1);
    for (std::size_t at = 0; at <= rest.size();) {
      const std::size_t end = std::min(rest.find(", ", at), rest.size());
      known.push_back(rest.substr(at, end - at));
      at = end + 2;
    }
    for (const auto& [key, value] : properties.items()) listed.push_back(key);
    EXPECT_THAT(known, ::testing::UnorderedElementsAreArray(listed)) << scenario;
    ++blocks;
  };
  const nlohmann::json& recordings = schema.at("$defs").at("recordings").at("properties");
  const nlohmann::json& dynamics = schema.at("$defs").at("dynamics").at("properties");
  compare(small_scenario(R"(, "no": 1)"), recordings);
  compare(motor_scenario(std::string(kSegments) + R"(, "no": 1)"), dynamics);
  for (const std::string block : {"robot", "control", "odometry", "capture", "idle", "start", "slip"})
    compare(small_scenario(", \"" + block + R"(": {"no": 1})"), recordings.at(block).at("properties"));
  for (const std::string block : {"robot", "model", "integration", "noise"})
    compare(motor_scenario(std::string(kSegments) + ", \"" + block + R"(": {"no": 1})"),
            dynamics.at(block).at("properties"));
  EXPECT_EQ(blocks, 13u);
}

}  // namespace
}  // namespace odobench
