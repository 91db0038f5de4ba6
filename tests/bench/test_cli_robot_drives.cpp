// Robots of any class and wheels of a user's own in simulate, plan and verify.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/run_process.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench {
namespace {

using testing::content;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::lines;
using testing::ProcessResult;
using testing::run_bench;
using testing::TemporaryFolder;

// Two wheels 0.1 m behind the origin, under names of their own.
constexpr const char* kOwnRobot = R"({"name": "twin", "kinematics": "wheels",
  "wheels": [{"x": -0.1, "drive": "wheel.right"}, {"x": -0.1, "drive": "wheel.left"}],
  "parameters": [
    {"name": "track", "unit": "m", "nominal": 0.4, "sets": {"wheels/0/y": -0.5, "wheels/1/y": 0.5}},
    {"name": "right", "unit": "m", "nominal": 0.06, "sets": "wheels/0/radius"},
    {"name": "left", "unit": "m", "nominal": 0.06, "sets": "wheels/1/radius"}]})";

struct Case {
  std::string name, robot;  // robot: "" for kOwnRobot
  std::string truth;        // as a parameters file
  double within;            // of calibrated parameters; 0: some combinations are free
};

nlohmann::json tables_of(const ProcessResult& result) {
  EXPECT_EQ(result.exit_code, 0) << result.err;
  nlohmann::json by_id;
  const auto all = nlohmann::json::parse(result.exit_code == 0 ? result.out : R"({"tables": []})");
  for (const auto& t : all.at("tables")) by_id[t.at("id").get<std::string>()] = t;
  return by_id;
}

class CliRobotDrives : public ::testing::TestWithParam<Case> {
 protected:
  std::string robot() const {
    return GetParam().robot.empty() ? folder_.file("robot.json", kOwnRobot) : GetParam().robot;
  }
  std::string truth() const { return folder_.file("mine.json", GetParam().truth); }
  TemporaryFolder folder_;
};

TEST_P(CliRobotDrives, SimulatedDrivesCalibrateBackToTheirTruth) {
  const auto simulated = [&](const std::string& out, const std::string& threads) {
    const ProcessResult made =
        run_bench({"simulate", "--robot=" + robot(), "--parameters=" + truth(), "--drives=all", "--repeat=2",
                   "--seed=3", "--threads=" + threads, "--out=" + (folder_ / out).string(), "--quiet"});
    EXPECT_EQ(made.exit_code, 0) << made.err;
    return (folder_ / out / "set.json").string();
  };
  const std::string set = simulated("one", "1");
  EXPECT_EQ(content(set), content(simulated("two", "2"))) << "whatever the number of threads";
  const auto json = nlohmann::json::parse(content(set));
  const auto wanted = nlohmann::json::parse(GetParam().truth);
  EXPECT_EQ(json.at("known_parameters").at(0).at("name"), "truth");
  const std::string out = (folder_ / "run").string();
  const ProcessResult run = run_bench({"--solver=lm", "--data=" + set, "--out=" + out, "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::vector<std::string> written = lines(content(folder_ / "run" / "runs.jsonl"));
  ASSERT_EQ(written.size(), 2u);
  const auto record = nlohmann::json::parse(written[1]);
  EXPECT_LT(record["cost"].get<double>(), 1e-3 * nlohmann::json::parse(written[0])["cost"].get<double>());
  EXPECT_EQ(record["termination"], "converged");
  for (const auto& p : record["parameters"]) {
    const std::string name = p["name"];
    EXPECT_EQ(json.at("known_parameters").at(0).at("values").at(name), wanted.at(name));
    if (GetParam().within == 0) continue;
    EXPECT_NEAR(p["value"].get<double>(), wanted.at(name).get<double>(), GetParam().within) << name;
    EXPECT_GT(std::abs(p["nominal"].get<double>() - wanted.at(name).get<double>()), 2 * GetParam().within)
        << name;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Every, CliRobotDrives,
    ::testing::Values(
        Case{"differential", "diff", R"({"b": 0.31, "r_right": 0.0505, "r_left": 0.0495})", 2e-4},
        Case{"tricycle", "tricycle", R"({"wheelbase": 1.02, "r": 0.1015, "steering_zero": 0.02})", 3e-4},
        Case{
            "mecanum", "mecanum",
            R"({"lx": 0.205, "ly": 0.197, "roller": 0.8, "r1": 0.051, "r2": 0.049, "r3": 0.0505, "r4": 0.05})",
            0},
        Case{"own_wheels", "", R"({"track": 0.41, "right": 0.061, "left": 0.0595})", 2e-4}),
    [](const auto& c) { return c.param.name; });

// Increments of the thesis' robot are no speeds: at the truth only noise is left.
TEST(CliRobotSets, TheThesisRobotMayReportIncrements) {
  const TemporaryFolder folder;
  const std::string set = (folder / "set.json").string(), out = (folder / "run").string();
  ASSERT_EQ(run_bench({"simulate", "--robot=4wis4wid", "--out=" + (folder / ".").string()}).exit_code, 0);
  ASSERT_EQ(run_bench({"evaluate", "--data=" + set, "--parameters=truth", "--out=" + out}).exit_code, 0);
  const auto record = nlohmann::json::parse(lines(content(folder / "run" / "runs.jsonl")).at(0));
  EXPECT_LT(record["cost"].get<double>(), 0.1);
  EXPECT_GT(record["cost"].get<double>(), 1e-4);
}

TEST(CliRobotPlans, StraightLinesDoNotTellATrackAndASquareIsProposed) {
  const std::vector<std::string> words = {
      "plan",          "--robot=diff",  "--drives=line", "--candidates=all",
      "--wanted=0.05", "--format=json", "--replicas=8",  "--threads=1"};
  const ProcessResult planned = run_bench(words);
  auto tables = tables_of(planned);
  const auto& rows = tables["plan.parameters"]["rows"];
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0]["parameter"], "b");
  EXPECT_EQ(rows[0]["determined"], "no");
  EXPECT_EQ(rows[1]["determined"], "yes");
  EXPECT_EQ(tables["plan.undetermined"]["rows"][0]["combination"], "b alone");
  const auto proposed = tables["plan.proposals"]["rows"];
  ASSERT_GE(proposed.size(), 1u);
  EXPECT_LE(proposed.back()["largest_deviation"].get<double>(), 0.05);
  // With what is proposed everything is determined; threads change nothing.
  std::vector<std::string> then = words;
  for (const auto& p : proposed) then[2] += "," + p["drive"].get<std::string>();
  tables = tables_of(run_bench(then));
  for (const auto& row : tables["plan.parameters"]["rows"]) EXPECT_EQ(row["determined"], "yes") << row;
  then = words;
  then.back() = "--threads=2";
  EXPECT_EQ(run_bench(then).out, planned.out);
}

TEST(CliRobotPlans, ASetIsPlannedByItsRecordings) {
  const TemporaryFolder folder;
  const std::string set = (folder / "set.json").string(), out = (folder / "plan").string();
  ASSERT_EQ(run_bench({"demo", "--robot=mecanum", "--out=" + (folder / ".").string()}).exit_code, 0);
  const ProcessResult planned = run_bench(
      {"plan", "--robot=" + set, "--candidates=all", "--wanted=0.2", "--replicas=2", "--out=" + out});
  ASSERT_EQ(planned.exit_code, 0) << planned.err;
  EXPECT_THAT(planned.out, HasSubstr("lx against ly"));
  EXPECT_THAT(planned.out, HasSubstr("as their recordings scatter"));
  EXPECT_THAT(planned.out, HasSubstr("No candidate tells lx against ly: hold one of them"));
  EXPECT_THAT(planned.out, HasSubstr("Nothing is proposed"));
  const ProcessResult report = run_bench({"report", out});
  EXPECT_EQ(report.out, planned.out);
  // What is held fixed is not planned, and then drives are proposed.
  auto json = nlohmann::json::parse(content(set));
  for (auto& p : json["robot"]["parameters"])
    if (p["name"] == "lx") p["lower"] = p["upper"] = p["nominal"];
  const std::string held = folder.file("robot.json", json["robot"].dump());
  auto tables =
      tables_of(run_bench({"plan", "--robot=" + held, "--candidates=all", "--replicas=4", "--format=json"}));
  EXPECT_EQ(tables["plan.parameters"]["rows"].size(), 6u);
  for (const auto& row : tables["plan.parameters"]["rows"]) EXPECT_EQ(row["determined"], "yes") << row;
  EXPECT_THAT(tables["plan.proposals"]["notes"].dump(), HasSubstr("Nothing to add"));
}

TEST(CliRobotPlans, FewRecordingsAreToldAndATableOfOwnWheelsIsPlanned) {
  const TemporaryFolder folder;
  const std::string robot = folder.file("robot.json", kOwnRobot);
  const std::string set = (folder / "set.json").string();
  ASSERT_EQ(
      run_bench({"simulate", "--robot=" + robot, "--drives=square_cw", "--out=" + (folder / ".").string()})
          .exit_code,
      0);
  EXPECT_THAT(run_bench({"plan", "--robot=" + set}).out, HasSubstr("too few recordings"));
  auto tables = tables_of(run_bench({"plan", "--robot=" + robot, "--format=json"}));
  EXPECT_EQ(tables["plan.parameters"]["rows"].size(), 3u);
  for (const auto& row : tables["plan.parameters"]["rows"]) EXPECT_EQ(row["determined"], "yes") << row;
}

TEST_P(CliRobotDrives, TheTruthIsRankedBeforeNominal) {
  const std::string out = (folder_ / "new").string();
  const std::vector<std::string> words = {"verify",     "--robot=" + robot(), "--parameters=" + truth(),
                                          "--repeat=2", "--format=json",      "--threads=1"};
  std::vector<std::string> kept = words;
  kept.back() = "--threads=2";
  kept.push_back("--out=" + out);
  const ProcessResult judged = run_bench(words);
  EXPECT_EQ(judged.out, run_bench(kept).out) << "whatever the number of threads";
  auto tables = tables_of(judged);
  const auto& totals = tables["verify.totals"]["rows"];
  ASSERT_EQ(totals.size(), 2u);
  EXPECT_EQ(totals[0]["parameters"], "nominal");
  EXPECT_EQ(totals[1]["parameters"], "mine");
  EXPECT_LT(totals[1]["change_percent"].get<double>(), -90);
  EXPECT_THAT(tables["verify.totals"]["notes"].dump(), HasSubstr("simulated with 'mine' as the truth"));
  // The robot steers by what it believes: with the truth it stops where it should.
  const auto& ends = tables["verify.arrival"]["rows"];
  EXPECT_LT(ends[1]["position_square_ccw"]["value"].get<double>(), 0.01);
  EXPECT_GT(ends[0]["position_square_ccw"].get<double>(), 0.03);
  const ProcessResult report = run_bench({"report", out});
  EXPECT_THAT(report.out, HasSubstr("How far from the reference's end"));
  // With the nominal values as the truth it is the other way round.
  std::vector<std::string> other = words;
  other.push_back("--truth=nominal");
  EXPECT_GT(tables_of(run_bench(other))["verify.totals"]["rows"][1]["change_percent"].get<double>(), 100);
}

TEST(CliRobotDrivesErrors, SayInOneLineWhatDoesNotFit) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::vector<std::string>& words, int code,
                           const std::vector<std::string>& parts) {
    const ProcessResult result = run_bench(words);
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_THAT(result.out, IsEmpty());
    EXPECT_EQ(lines(result.err).size(), 1u) << result.err;
    for (const std::string& part : parts) EXPECT_THAT(result.err, HasSubstr(part));
  };
  const std::string out = "--out=" + (folder / "out").string();
  const std::string mine = folder.file("mine.json", R"({"track": 0.41, "right": 0.061, "left": 0.0595})");
  const std::string far = folder.file("far.json", R"({"b": 0.9, "r_right": 0.05, "r_left": 0.05})");
  const std::string few = folder.file("few.json", R"({"b": 0.3, "r_right": 0.05})");
  const std::string two = folder.file("two.json", "[" + content(far) + ", " + content(far) + "]");
  const std::string scenario = (source_dir() / "datasets/scenarios/exact.json").string();
  refused({"simulate", out}, 2, {"--scenario or --robot is required"});
  refused({"simulate", "--robot=tricicle", out}, 2, {"--robot=tricicle", "did you mean 'tricycle'"});
  refused({"simulate", "--robot=diff", "--scenario=exact", out}, 2, {"contradictory options"});
  refused({"simulate", "--robot=diff", "--raw", out}, 2, {"--raw: it belongs to scenarios"});
  refused({"simulate", "--scenario=exact", "--repeat=2", out}, 2, {"--repeat: it belongs to --robot"});
  refused({"simulate", "--robot=" + scenario, out}, 3, {"a scenario is given as --scenario"});
  refused({"simulate", "--robot=" + mine, out}, 3, {"neither \"schema\" nor \"kinematics\""});
  refused({"verify", "--parameters=truth"}, 2, {"--scenario or --robot is required"});
  refused({"verify", "--robot=diff", "--parameters=truth"}, 2, {"--parameters=truth", "known: nominal"});
  refused({"verify", "--robot=diff", "--truth=truth", "--parameters=nominal"}, 2, {"--truth=truth"});
  refused({"verify", "--robot=diff", "--parameters=" + mine}, 3, {"mine.json", "another robot"});
  refused({"verify", "--robot=diff", "--parameters=nominal," + mine}, 3, {"mine.json", "another robot"});
  refused({"verify", "--robot=diff", "--truth=" + far, "--parameters=nominal"}, 2, {"outside the box"});
  refused({"verify", "--scenario=exact", "--truth=nominal", "--parameters=nominal"}, 2,
          {"it belongs to --robot"});
  const ProcessResult told =
      run_bench({"verify", "--robot=diff", "--truth=nominal", "--parameters=" + far, "--repeat=1"});
  EXPECT_EQ(told.exit_code, 0);
  EXPECT_THAT(told.err, HasSubstr("'far' lie outside the box of differential: b=0.9 (0.255..0.345)"));
  refused({"plan", "--robot=triccle"}, 2, {"--robot=triccle", "did you mean 'tricycle'", "off_nominal"});
  refused({"plan", "--robot=" + mine}, 3, {"mine.json"});
  refused({"plan", "--robot=diff", "--drives=sideways"}, 2, {"unknown drive 'sideways'", "turn_cw"});
  refused({"simulate", "--robot=diff", "--drives=sideways", out}, 2, {"unknown drive 'sideways'", "turn_cw"});
  refused({"simulate", "--robot=diff", "--drives=line,line", out}, 2, {"'line' stands there twice"});
  refused({"simulate", "--robot=diff", "--repeat=0", out}, 2, {"--repeat=0"});
  refused({"simulate", "--robot=diff", "--parameters=" + mine, out}, 3,
          {"mine.json", "differential has b, r_right, r_left", "another robot"});
  refused({"simulate", "--robot=diff", "--parameters=" + few, out}, 3,
          {"'r_left' is missing", "another robot"});
  refused({"simulate", "--robot=diff", "--parameters=" + far, out}, 2, {"outside the box", "b=0.9"});
  refused({"simulate", "--robot=diff", "--parameters=" + two, out}, 2, {"it holds 2 sets"});
  refused({"simulate", "--robot=diff", "--parameters=truth", out}, 2, {"known: nominal"});
  const std::string rails = folder.file("rails.json", R"({"name": "rails", "kinematics": "wheels",
    "wheels": [{"x": 0, "y": 0, "radius": 0.1, "drive": "wheel.1"}, {"x": 1, "y": 0, "radius": 0.1, "drive": "wheel.2"}],
    "parameters": [{"name": "turned", "unit": "rad", "nominal": 0, "sets": "wheels/0/mount"}]})");
  refused({"simulate", "--robot=" + rails, out}, 3, {"rails.json"});
}

}  // namespace
}  // namespace odobench
