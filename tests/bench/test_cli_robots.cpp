// Robots of any class on the command line: from a demo set to parameters, tables and a page, and what is said
// of sets that do not fit their robot.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/run_process.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench {
namespace {

using testing::content;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::lines;
using ::testing::Not;
using testing::ProcessResult;
using testing::run_bench;
using testing::TemporaryFolder;

// The words of a text with single blanks between them: notes are wrapped.
std::string unwrapped(const std::string& text) {
  std::string all;
  for (const std::string& line : lines(text)) all += (all.empty() ? "" : " ") + line;
  return all;
}

class CliRobots : public ::testing::Test {
 protected:
  std::string demo(const std::string& robot) const {
    const std::string folder = (folder_ / robot).string();
    const ProcessResult made = run_bench({"demo", "--robot=" + robot, "--out=" + folder});
    EXPECT_EQ(made.exit_code, 0) << made.err;
    return folder + "/set.json";
  }
  std::vector<nlohmann::json> records(const std::string& run) const {
    std::vector<nlohmann::json> list;
    for (const std::string& line : lines(content(folder_ / run / "runs.jsonl")))
      list.push_back(nlohmann::json::parse(line));
    return list;
  }
  TemporaryFolder folder_;
};

TEST_F(CliRobots, ATwoWheeledRobotGoesFromItsSetToAPage) {
  const std::string set = demo("diff");
  const std::string out = (folder_ / "run").string();
  const ProcessResult run = run_bench({"--solver=lm", "--data=" + set, "--out=" + out, "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("r_right"));
  const auto list = records("run");
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[1]["problem"], "calibration[every_sample,arc]");
  EXPECT_EQ(list[1]["termination"], "converged");
  EXPECT_LT(list[1]["cost"].get<double>(), 1e-3 * list[0]["cost"].get<double>());
  const auto truth = nlohmann::json::parse(content(set)).at("known_parameters").at(0).at("values");
  for (const auto& p : list[1]["parameters"])
    EXPECT_NEAR(p["value"].get<double>(), truth.at(p["name"].get<std::string>()).get<double>(), 5e-5);
  const std::string page = (folder_ / "page.html").string();
  const ProcessResult report = run_bench({"report", out, "--out=" + page});
  ASSERT_EQ(report.exit_code, 0) << report.err;
  EXPECT_THAT(content(page), HasSubstr("r_left"));
}

TEST_F(CliRobots, JOfDifferentCostsNeverMeets) {
  const std::string set = demo("mecanum");
  std::vector<std::string> problems;
  for (const std::string option :
       {"--cost=segments", "--cost=final_pose", "--integration=midpoint", "--weights=1,4", "--mount"}) {
    const ProcessResult run = run_bench({"--solver=lm", "--data=" + set, option, "--quiet", "--overwrite",
                                         "--out=" + (folder_ / "run").string()});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    problems.push_back(records("run").back()["problem"]);
  }
  EXPECT_THAT(problems, ::testing::ElementsAre("calibration[segments,arc]", "calibration[final_pose,arc]",
                                               "calibration[every_sample,midpoint]",
                                               "calibration[every_sample,arc,weights1:4]",
                                               "calibration[every_sample,arc,mount]"));
}

TEST_F(CliRobots, EvaluateWritesTracksOfAnyRobot) {
  const std::string set = demo("tricycle");
  const ProcessResult result =
      run_bench({"evaluate", "--data=" + set, "--parameters=nominal,truth", "--tracks=-"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(lines(result.out)[0], "recording,parameters,time_s,x,y,theta,x_ref,y_ref,theta_ref");
}

TEST_F(CliRobots, AReferenceHereAndThereIsEnoughForRecordsTablesAndPage) {
  // The demo with a tape measure: start and end only.
  auto set = nlohmann::json::parse(content(demo("differential")));
  const ProcessResult inline_set =
      run_bench({"demo", "--robot=differential", "--out=" + (folder_ / "again").string()});
  ASSERT_EQ(inline_set.exit_code, 0);
  nlohmann::json recordings = nlohmann::json::array();
  for (int k = 0; k < 2; ++k) {
    nlohmann::json columns = {{"time_us", {0, 50000, 100000}},
                              {"x", {0, nullptr, 0.02}},
                              {"y", {0, nullptr, k == 0 ? 0.001 : -0.001}},
                              {"theta", {0, nullptr, k == 0 ? 0.1 : -0.1}},
                              {"wheel.right", {0, 0.2, k == 0 ? 0.4 : 0.2}},
                              {"wheel.left", {0, 0.2, k == 0 ? 0.2 : 0.4}}};
    recordings.push_back({{"id", k == 0 ? "a" : "b"},
                          {"trajectory", set["trajectories"][0]["name"]},
                          {"repetition", k + 1},
                          {"columns", columns}});
  }
  set["recordings"] = recordings;
  const std::string file = folder_.file("tape.json", set.dump());
  const std::string out = (folder_ / "run").string();
  const ProcessResult run =
      run_bench({"--solver=lm", "--data=" + file, "--cost=final_pose", "--out=" + out, "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const ProcessResult report = run_bench({"report", out, "--out=" + (folder_ / "page.html").string()});
  EXPECT_EQ(report.exit_code, 0) << report.err;
  const ProcessResult tracks = run_bench({"evaluate", "--data=" + file, "--tracks=-"});
  ASSERT_EQ(tracks.exit_code, 0) << tracks.err;
  EXPECT_THAT(lines(tracks.out)[2], ::testing::EndsWith(",,,")) << "no number where there is no reference";
}

TEST_F(CliRobots, SaysInOneLineWhatDoesNotFit) {
  const std::string set = demo("differential");
  const std::string sensors = (testing::source_dir() / "datasets/sensors/heading_only.json").string();
  const auto refused = [&](const std::vector<std::string>& words, int code, const std::string& part) {
    const ProcessResult result = run_bench(words);
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_THAT(result.out, IsEmpty());
    EXPECT_EQ(lines(result.err).size(), 1u) << result.err;
    EXPECT_THAT(result.err, HasSubstr(part));
  };
  refused({"fuse", "--sensors=" + sensors, "--data=" + set}, 3, "expected \"4wis4wid\"");
  refused({"--data=" + set, "--cost=segment"}, 2, "did you mean 'segments'");
  refused({"--data=" + set, "--integration=arcs"}, 2, "did you mean 'arc'");
  refused({"--data=" + set, "--weights=1"}, 2, "expected two numbers");
  refused({"--data=" + set, "--weights=1,-1"}, 2, "--weights");
  refused({"--data=" + set, "--twist=mean"}, 3, "the mean is for wheels that are steered and driven");
  refused({"demo", "--robot=tricicle", "--out=" + (folder_ / "x").string()}, 2, "did you mean 'tricycle'");
}

TEST_F(CliRobots, ListsClassesWithParametersAndWhatNoDataTell) {
  const ProcessResult list = run_bench({"list", "robots", "--format=json"});
  ASSERT_EQ(list.exit_code, 0) << list.err;
  for (const char* word : {"differential", "wheel.right", "steering_zero", "lx + ly", "omni3_full"})
    EXPECT_THAT(list.out, HasSubstr(word));
}

TEST_F(CliRobots, AnOriginOnTheRearAxleIsSaidAndServed) {
  ODOBENCH_NEEDS_SHARED();
  const std::string set = (testing::shared_folder() / "cases/origin_on_rear_axle/set.json").string();
  const ProcessResult mean = run_bench({"evaluate", "--data=" + set});
  EXPECT_THAT(mean.err, HasSubstr("do not stand evenly round the robot's origin"));
  const std::string out = (folder_ / "run").string();
  const ProcessResult own = run_bench({"evaluate", "--data=" + set, "--twist=least_squares", "--out=" + out});
  ASSERT_EQ(own.exit_code, 0) << own.err;
  EXPECT_THAT(own.err, Not(HasSubstr("evenly")));
  const auto record = records("run").at(0);
  double samples = 0;
  const auto parsed = nlohmann::json::parse(content(set));
  for (const auto& r : parsed.at("recordings"))
    samples += static_cast<double>(r.at("columns").at("time_us").size());
  ASSERT_GT(samples, 0);
  EXPECT_LT(std::sqrt(record["cost"].get<double>() / samples), 1e-3) << "root mean square, m and rad";
}

TEST_F(CliRobots, ATrackEnteredTwiceAsWideIsNamed) {
  ODOBENCH_NEEDS_SHARED();
  const std::string cases = (testing::shared_folder() / "cases").string();
  const std::string said =
      unwrapped(run_bench({"--solver=lm", "--data=" + cases + "/track_as_half_track/set.json"}).out);
  EXPECT_THAT(said, HasSubstr("a common factor of all turns"));
  EXPECT_THAT(said, HasSubstr("b1, b2, b3, b4 times 0.50"));
  EXPECT_THAT(unwrapped(run_bench({"--solver=lm", "--accept=common_factor",
                                   "--data=" + cases + "/diameter_as_radius/set.json"})
                            .out),
              HasSubstr("r1, r2, r3, r4 times 0.5, which their box does not allow"));
  EXPECT_THAT(unwrapped(run_bench({"--solver=lm", "--data=" + cases + "/control_clean/set.json"}).out),
              Not(HasSubstr("common factor")));
}

TEST_F(CliRobots, WhatDrivesDoNotTellIsSaidBeforeAndAfterCalibration) {
  for (const auto& [robot, words] : std::vector<std::pair<std::string, std::string>>{
           {"mecanum", "Changing lx against ly"}, {"diff", ""}}) {
    const std::string set = (folder_ / robot / "set.json").string();
    ASSERT_EQ(run_bench({"demo", "--robot=" + robot, "--out=" + (folder_ / robot).string()}).exit_code, 0);
    for (const std::vector<std::string>& call : {std::vector<std::string>{"evaluate", "--data=" + set},
                                                 std::vector<std::string>{"--solver=lm", "--data=" + set}}) {
      const std::string said = unwrapped(run_bench(call).out);
      EXPECT_THAT(said, HasSubstr(words));
      EXPECT_EQ(said.find("Barely determined") == std::string::npos, words.empty());
    }
  }
}

TEST_F(CliRobots, AnotherRuleThatExplainsTheDrivesIsNamed) {
  const std::string set = (folder_ / "demo/set.json").string();
  ASSERT_EQ(run_bench({"demo", "--robot=diff", "--out=" + (folder_ / "demo").string()}).exit_code, 0);
  EXPECT_THAT(unwrapped(run_bench({"--solver=lm", "--data=" + set}).out), Not(HasSubstr("look as if")));
  EXPECT_THAT(unwrapped(run_bench({"--solver=lm", "--data=" + set, "--integration=euler"}).out),
              HasSubstr("look as if poses were summed up by the rule arc"));
}

TEST_F(CliRobots, AScenarioStatesTheGeometryOfItsRobot) {
  const std::string head =
      R"({"schema": "odobench-scenario", "schema_version": 1, "kind": "recordings", "name": "mine",
    "robot": {)";
  const std::string size =
      R"({"a1": 0.2, "a2": -0.2, "a3": -0.2, "a4": 0.2, "b1": 0.15, "b2": 0.15, "b3": -0.15,
    "b4": -0.15, "r1": 0.05, "r2": 0.05, "r3": 0.05, "r4": 0.05})";
  const std::string tail = R"(}, "drives": ["rotation_ccw"], "repetitions": 1})";
  const std::string without = folder_.file("without.json", head + "\"truth\": " + size + tail);
  const ProcessResult refused = run_bench({"plan", "--robot=" + without});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_THAT(refused.err, HasSubstr("/robot/truth: found a1 = 0.2"));
  EXPECT_THAT(refused.err, HasSubstr("/robot/nominal"));
  const std::string own = folder_.file(
      "own.json", head + "\"nominal\": " + size + ", \"box\": 0.1, \"truth\": {\"r1\": 0.054}" + tail);
  const ProcessResult made =
      run_bench({"simulate", "--scenario=" + own, "--out=" + (folder_ / "new").string(), "--quiet"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const auto parameters =
      nlohmann::json::parse(content(folder_ / "new" / "set.json")).at("robot").at("parameters");
  EXPECT_EQ(parameters.at(0).at("nominal"), 0.2);
  EXPECT_NEAR(parameters.at(8).at("upper").get<double>(), 0.055, 1e-12);
  const std::string narrow =
      folder_.file("narrow.json", head + "\"nominal\": " + size + ", \"truth\": {\"r1\": 0.054}" + tail);
  EXPECT_EQ(run_bench({"plan", "--robot=" + narrow}).exit_code, 3);
  const std::string no_box = folder_.file("no_box.json", head + "\"box\": 1.5" + tail);
  EXPECT_THAT(run_bench({"plan", "--robot=" + no_box}).err, HasSubstr("/robot/box: found 1.5"));
}

}  // namespace
}  // namespace odobench
