// set.json of schema 2: robots of every kind, signals in the units that people have, references here and
// there; and what is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/files.hpp"
#include "datasets/dataset.hpp"
#include "tests/support/data_error.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench {
namespace {

using testing::data_error;
using testing::replaced;
using testing::says;
using testing::TemporaryFolder;

const std::string kTwoWheels = R"({"schema": "odobench-dataset", "schema_version": 2, "name": "mine",
 "robot": {"name": "r", "kinematics": "differential",
           "parameters": [{"name": "b", "nominal": 0.3}, {"name": "r_right", "nominal": 0.05, "lower": 0.04, "upper": 0.06},
                          {"name": "r_left", "equals": "r_right"}]},
 "signals": [{"name": "wheel.right", "kind": "position", "unit": "count", "per_turn": 1000, "bits": 8, "sign": -1},
             {"name": "wheel.left", "kind": "speed", "unit": "rpm"}],
 "trajectories": [{"name": "t"}],
 "recordings": [{"id": "t1", "trajectory": "t", "repetition": 1, "columns": {
   "time_us": [0, 10, 25, 40], "x": [0, null, null, 1], "y": [0, null, null, 2], "theta": [0.5, null, null, 3],
   "wheel.right": [250, 254, 3, 1], "wheel.left": [0, 30, 60, 0]}}]})";

TEST(DatasetRobots, TakesSignalsInTheUnitsThatPeopleHave) {
  const TemporaryFolder folder;
  const Dataset d = load_dataset(folder.file("set.json", kTwoWheels));
  ASSERT_EQ(d.robot.parameters.size(), 2u);
  EXPECT_EQ(d.robot.parameters[0].name, "b");
  EXPECT_NEAR(d.robot.parameters[0].lower, 0.255, 1e-15);
  EXPECT_NEAR(d.robot.parameters[0].upper, 0.345, 1e-15);
  EXPECT_EQ(d.robot.parameters[0].unit, "m");
  EXPECT_EQ(d.robot.table.parameters[1].bindings.size(), 2u) << "two radii are one parameter";
  const Recording& r = d.recordings.at(0);
  EXPECT_EQ(r.reference.sample, (std::vector<std::size_t>{0, 3}));
  EXPECT_EQ(r.reference.theta, (std::vector<double>{0.5, 3}));
  const double count = -2 * std::acos(-1.0) / 1000;
  ASSERT_EQ(r.signals[0].kind, SignalKind::Increment);
  const double counts[] = {0, 4, 5, -2};  // 254 to 3 runs over
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(r.signals[0].values[k], counts[k] * count, 1e-15);
  EXPECT_EQ(r.signals[1].kind, SignalKind::Speed);
  EXPECT_NEAR(r.signals[1].values[1], std::acos(-1.0), 1e-15);
  // What is written is SI and comes back.
  save_dataset(d, folder / "again.json", true);
  const Dataset again = load_dataset(folder / "again.json");
  EXPECT_EQ(again.recordings[0].signals, r.signals);
  EXPECT_EQ(again.recordings[0].reference, r.reference);
  ASSERT_EQ(again.robot.ties.size(), 1u);
  save_dataset(d, folder / "files.json", false);
  EXPECT_EQ(load_dataset(folder / "files.json").recordings[0].reference, r.reference);
}

TEST(DatasetRobots, TakesWheelsOfTheUsersOwn) {
  const std::string own = replaced(kTwoWheels,
                                   R"("kinematics": "differential",
           "parameters": [{"name": "b", "nominal": 0.3}, {"name": "r_right", "nominal": 0.05, "lower": 0.04, "upper": 0.06},
                          {"name": "r_left", "equals": "r_right"}]})",
                                   R"("kinematics": "wheels", "integration": "midpoint",
           "wheels": [{"x": 0.1, "drive": "wheel.right"}, {"x": 0.1, "drive": {"wheel.left": 1}, "radius": 0.05}],
           "parameters": [{"name": "b", "unit": "m", "nominal": 0.3, "sets": {"wheels/0/y": -0.5, "wheels/1/y": 0.5}},
                          {"name": "r", "unit": "m", "nominal": 0.05, "sets": "wheels/0/radius"}]})");
  const TemporaryFolder folder;
  const Dataset d = load_dataset(folder.file("set.json", own));
  EXPECT_EQ(d.robot.kinematics, "wheels");
  EXPECT_EQ(d.robot.rule, robots::IntegrationRule::Midpoint);
  ASSERT_EQ(d.robot.table.wheels.size(), 2u);
  EXPECT_EQ(d.robot.table.wheels[0].radius, 0);
  EXPECT_EQ(d.robot.table.wheels[1].radius, 0.05);
  EXPECT_EQ(d.robot.table.parameters[0].bindings[0].factor, -0.5);
  save_dataset(d, folder / "again.json", true);
  const Dataset again = load_dataset(folder / "again.json");
  EXPECT_EQ(again.robot.table.wheels[0].x, 0.1);
  EXPECT_EQ(again.robot.parameters[1].upper, d.robot.parameters[1].upper);
  const auto refused = [&](const std::string& from, const std::string& to) {
    return data_error([&] { load_dataset(folder.file("bad.json", replaced(own, from, to))); });
  };
  EXPECT_TRUE(says(refused("wheels/0/radius", "wheels/2/radius"),
                   {"/robot/parameters/1/sets", "wheels/2/radius", "N below 2"}));
  EXPECT_TRUE(says(refused("wheels/0/radius", "wheels/0/diameter"), {"/robot/parameters/1/sets"}));
  EXPECT_TRUE(
      says(refused("wheels/0/radius", "wheels/1/radius"), {"radius of wheel 1, which the wheel states too"}));
  EXPECT_TRUE(says(refused("\"unit\": \"m\", \"nominal\": 0.05, ", "\"nominal\": 0.05, "),
                   {"/robot/parameters/1", "unit"}));
}

TEST(DatasetRobots, TheDocumentedExampleLoads) {
  const std::string text = read_file(testing::source_dir() / "docs/data_format.md");
  const std::size_t section = text.find("## set.json, schema version 2");
  const std::size_t from = text.find("```json\n", section) + 8;
  const TemporaryFolder folder;
  const Dataset d = load_dataset(folder.file("set.json", text.substr(from, text.find("```", from) - from)));
  EXPECT_EQ(d.robot.kinematics, "differential");
  const double count = 2 * std::acos(-1.0) / 4096;
  EXPECT_NEAR(d.recordings.at(0).signals[0].values[1], 76 * count, 1e-12) << "the counter ran over";
  EXPECT_NEAR(d.recordings.at(0).signals[1].values[1], 98 * count, 1e-12) << "and this one backwards";
}

TEST(DatasetRobots, NamesWhatIsWrong) {
  struct Bad {
    const char *from, *to;
    std::vector<std::string> says;
  };
  const std::vector<Bad> cases = {
      {"\"differential\"", "\"diferential\"", {"/robot", "diferential", "did you mean 'differential'"}},
      {"\"name\": \"b\",", "\"name\": \"track\",", {"/robot", "differential has no parameter 'track'"}},
      {"\"equals\": \"r_right\"", "\"equals\": \"b2\"", {"/robot", "no parameter 'b2'"}},
      {"\"equals\": \"r_right\"", "\"equals\": \"r_left\"", {"/robot", "'r_left' (m) cannot equal 'r_left'"}},
      {"\"nominal\": 0.3}", "\"nominal\": 0.3, \"unit\": \"mm\"}", {"/robot", "'b' is in mm, expected m"}},
      {"\"nominal\": 0.3}",
       "\"nominal\": 0.3, \"lower\": 0.4, \"upper\": 0.5}",
       {"/robot/parameters/0", "0.4"}},
      {"\"kind\": \"position\"", "\"kind\": \"ticks\"", {"/signals/0/kind", "ticks"}},
      {"\"per_turn\": 1000", "\"per_turn\": 0", {"/signals/0/per_turn", "above 0"}},
      {"\"per_turn\": 1000, ", "", {"/signals/0", "per_turn"}},
      {"\"bits\": 8", "\"bits\": 80", {"/signals/0/bits", "4 to 52"}},
      {"\"sign\": -1", "\"sign\": 2", {"/signals/0/sign", "1 or -1"}},
      {"\"rpm\"", "\"km/h\"", {"/signals/1/unit", "km/h"}},
      {"\"name\": \"wheel.left\", \"kind\"",
       "\"name\": \"x\", \"kind\"",
       {"/signals/1/name", "no other column"}},
      {"\"wheel.left\": [0", "\"wheel.lft\": [0", {"/recordings/0/columns", "wheel.left"}},
      {"\"x\": [0, null, null, 1]", "\"x\": [0, 1, null, 1]", {"/columns/y/1", "found nan"}},
      {"\"x\": [0, null, null, 1], \"y\": [0, null, null, 2], \"theta\": [0.5, null, null, 3]",
       "\"x\": [null, null, null, null], \"y\": [null, null, null, null], \"theta\": [null, null, null, "
       "null]",
       {"no reference at any stamp"}},
      {"[250, 254, 3, 1]", "[250, null, 3, 1]", {"/columns/wheel.right/1"}},
      {"\"schema_version\": 2", "\"schema_version\": 3", {"/schema_version", "version 1 or 2"}},
  };
  const TemporaryFolder folder;
  for (const Bad& bad : cases) {
    const std::string file = folder.file("set.json", replaced(kTwoWheels, bad.from, bad.to));
    std::vector<std::string> parts = bad.says;
    parts.push_back(file);
    EXPECT_TRUE(says(data_error([&] { load_dataset(file); }), parts)) << bad.to;
  }
}

}  // namespace
}  // namespace odobench
