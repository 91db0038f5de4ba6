// Data sets from a user's own CSV files: units, stamps, what is repaired and counted, what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/files.hpp"
#include "base/sha256.hpp"
#include "datasets/csv/column_name.hpp"
#include "datasets/csv/decimal_time.hpp"
#include "datasets/import/csv/csv_files.hpp"
#include "datasets/import/csv/csv_import.hpp"
#include "datasets/import/csv/csv_proposal.hpp"
#include "tests/support/data_error.hpp"
#include "tests/support/run_process.hpp"

namespace odobench {
namespace {

using testing::data_error;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::replaced;
using testing::says;
using testing::TemporaryFolder;

const double kPi = std::acos(-1.0);

const std::string kMap =
    R"({"schema": "odobench-import", "schema_version": 1, "name": "mine", "licence": "CC0",
 "robot": {"name": "r", "kinematics": "differential", "parameters": [{"name": "b", "nominal": 0.3}]},
 "time": {"column": "t", "unit": "s"},
 "reference": {"x": {"column": "x", "unit": "m"}, "y": {"column": "y", "unit": "m"},
               "theta": {"column": "yaw", "unit": "rad"}},
 "signals": {"wheel.left": {"column": "left", "unit": "rad/s"}, "wheel.right": {"column": "right", "unit": "rad/s"}}})";
const std::string kCsv = "t,x,y,yaw,left,right\n0.00,1,2,3,10,20\n0.05,2,4,3.1,11,21\n0.10,3,6,3.2,12,22\n";

CsvImport import_text(const std::string& map, const std::string& csv) {
  const TemporaryFolder folder;
  return import_csv({folder.file("drive.csv", csv)}, folder.file("map.json", map));
}
Recording recording_of(const std::string& map, const std::string& csv) {
  return import_text(map, csv).dataset.recordings.at(0);
}
std::string refusal(const std::string& map, const std::string& csv) {
  return data_error([&] { import_text(map, csv); });
}

TEST(ImportCsv, TakesATable) {
  const TemporaryFolder folder;
  const CsvImport i = import_csv({folder.file("line_x-2.csv", kCsv)}, folder.file("map.json", kMap));
  const Dataset& d = i.dataset;
  EXPECT_EQ(d.name, "mine");
  EXPECT_EQ(d.provenance.licence, "CC0");
  ASSERT_EQ(d.provenance.files.size(), 2u);
  EXPECT_EQ(d.provenance.files[0].sha256, sha256(kMap));
  EXPECT_EQ(d.provenance.files[1].path, "line_x-2.csv");
  EXPECT_EQ(d.provenance.files[1].sha256, sha256(kCsv));
  EXPECT_TRUE(d.notes.empty());
  ASSERT_EQ(d.recordings.size(), 1u);
  const Recording& r = d.recordings[0];
  EXPECT_EQ(r.id, "line_x_2");
  EXPECT_EQ(r.trajectory, "line_x");
  EXPECT_EQ(r.repetition, 2);
  EXPECT_THAT(r.time_us, ElementsAre(0, 50000, 100000));
  EXPECT_THAT(r.reference.x, ElementsAre(1, 2, 3));
  EXPECT_THAT(r.reference.theta, ElementsAre(3, 3.1, 3.2));
  ASSERT_EQ(r.signals.size(), 2u);
  EXPECT_EQ(r.signals[0], (Signal{"wheel.right", SignalKind::Speed, {20, 21, 22}}));
  EXPECT_EQ(r.signals[1], (Signal{"wheel.left", SignalKind::Speed, {10, 11, 12}}));
  ASSERT_EQ(i.report.size(), 1u);
  EXPECT_THAT(i.report[0],
              HasSubstr("3 samples, 0.10 s, 4.47 m, 11.5 deg to the left, 0.0 deg to the right"));
  // What was imported can be stored and read.
  save_dataset(d, folder / "set.json");
  EXPECT_EQ(load_dataset(folder / "set.json").recordings.at(0).signals, r.signals);
}

TEST(ImportCsv, KnowsEveryUnit) {
  const auto left = [](const std::string& format, double expected) {
    SCOPED_TRACE(format);
    const std::string both = replaced(kMap, R"("left", "unit": "rad/s")", R"("left", )" + format);
    const Recording r =
        recording_of(replaced(both, R"("right", "unit": "rad/s")", R"("right", )" + format), kCsv);
    EXPECT_NEAR(r.signals.at(1).values.at(2), expected, 1e-12);
    return r.signals[1].kind;
  };
  EXPECT_EQ(left(R"("unit": "rad/s")", 12), SignalKind::Speed);
  EXPECT_EQ(left(R"("unit": "deg/s")", 12 * kPi / 180), SignalKind::Speed);
  EXPECT_EQ(left(R"("unit": "rpm", "sign": -1)", -12 * kPi / 30), SignalKind::Speed);
  EXPECT_EQ(left(R"("unit": "turn/s")", 24 * kPi), SignalKind::Speed);
  EXPECT_EQ(left(R"("unit": "rad")", 1), SignalKind::Increment);
  EXPECT_EQ(left(R"("kind": "position", "unit": "deg")", kPi / 180), SignalKind::Increment);
  EXPECT_EQ(left(R"("unit": "turn")", 2 * kPi), SignalKind::Increment);
  EXPECT_EQ(left(R"("unit": "count", "per_turn": 100)", kPi / 50), SignalKind::Increment);
  EXPECT_EQ(left(R"("kind": "increment", "unit": "count", "per_turn": 100)", 12 * kPi / 50),
            SignalKind::Increment);
  EXPECT_EQ(left(R"("unit": "m", "radius": 0.05)", 20), SignalKind::Increment);
  EXPECT_EQ(left(R"("unit": "cm", "radius": 0.05)", 0.2), SignalKind::Increment);
  EXPECT_EQ(left(R"("unit": "mm", "radius": 0.05)", 0.02), SignalKind::Increment);
  const auto x = [](const std::string& unit) {
    return recording_of(replaced(kMap, R"("x", "unit": "m")", R"("x", "unit": ")" + unit + '"'), kCsv)
        .reference.x[2];
  };
  EXPECT_NEAR(x("cm"), 0.03, 1e-15);
  EXPECT_NEAR(x("mm"), 0.003, 1e-15);
  const auto last_stamp = [](const std::string& unit, const std::string& csv) {
    return recording_of(replaced(kMap, R"("t", "unit": "s")", R"("t", "unit": ")" + unit + '"'), csv)
        .time_us.at(2);
  };
  EXPECT_EQ(last_stamp("s", kCsv), 100000);
  EXPECT_EQ(last_stamp("ms", replaced(replaced(kCsv, "0.05", "50"), "0.10", "100.25")), 100250);
  EXPECT_EQ(last_stamp("us", replaced(replaced(kCsv, "0.05", "50"), "0.10", "100")), 100);
  EXPECT_EQ(last_stamp("ns", replaced(replaced(kCsv, "0.05", "5000"), "0.10", "1e4")), 10);
}

TEST(ImportCsv, SteeringIsAnAngle) {
  const std::string map = R"({"schema": "odobench-import", "schema_version": 1, "name": "mine",
 "robot": {"name": "r", "kinematics": "tricycle", "parameters": []}, "time": {"column": "t", "unit": "s"},
 "reference": {"x": {"column": "x", "unit": "m"}, "y": {"column": "y", "unit": "m"}, "theta": {"column": "yaw", "unit": "deg"}},
 "signals": {"wheel": {"column": "left", "unit": "rad"}, "steering": {"column": "right", "unit": "deg"}}})";
  const Recording r = recording_of(map, kCsv);
  EXPECT_EQ(r.signals.at(0).kind, SignalKind::Increment);
  EXPECT_EQ(r.signals.at(1).kind, SignalKind::Angle);
  EXPECT_NEAR(r.signals[1].values.at(0), 20 * kPi / 180, 1e-15);
  EXPECT_NEAR(r.reference.theta.at(0), 3 * kPi / 180, 1e-15);
  EXPECT_TRUE(says(refusal(replaced(map, R"("right", "unit": "deg")", R"("right", "unit": "deg/s")"), kCsv),
                   {"map.json: /signals/steering: found a signal that becomes a speed, expected an angle"}));
  EXPECT_TRUE(says(refusal(replaced(map, R"("left", "unit")", R"("left", "kind": "angle", "unit")"), kCsv),
                   {"/signals/wheel: found a signal that becomes an angle, expected a speed"}));
}

// 1760000000.123456789 s in a double is off by up to 120 ns, 2^53 ns are 104 days.
TEST(ImportCsv, StampsKeepTheirDigits) {
  using odobench::decimal_nanoseconds;
  EXPECT_EQ(decimal_nanoseconds("1760000000.123456789", 9), 1760000000123456789);
  EXPECT_EQ(decimal_nanoseconds("1760000000123456789", 0), 1760000000123456789);
  EXPECT_EQ(decimal_nanoseconds("1.760000000123456789E+09", 9), 1760000000123456789);
  EXPECT_EQ(decimal_nanoseconds("-0,5", 6), -500000);
  EXPECT_EQ(decimal_nanoseconds("+2.", 3), 2000);
  EXPECT_EQ(decimal_nanoseconds(".0005", 3), 1);
  EXPECT_EQ(decimal_nanoseconds("0.00049999", 3), 0);
  EXPECT_EQ(decimal_nanoseconds("5e-40", 9), 0);
  EXPECT_EQ(decimal_nanoseconds("4000000000", 9), 4'000'000'000'000'000'000);
  for (const char* bad : {"", ".", "-", "1e", "1e41", "1.2.3", "0x10", "nan", "inf", "12:30", "1 2",
                          "4000000000.1", "99999999999999999999999"})
    EXPECT_FALSE(decimal_nanoseconds(bad, 9)) << bad;
  const auto at = [](const char* second) {
    return replaced(replaced(replaced(kCsv, "0.00", "1760000000.123456"), "0.05", second), "0.10",
                    "1760000001");
  };
  EXPECT_EQ(recording_of(kMap, at("1760000000.123457")).time_us[1], 1);
  EXPECT_TRUE(says(refusal(kMap, at("1760000000.123456")),
                   {"drive.csv:3: found the stamp \"1760000000.123456\" 0 us after that of line 2"}));
  EXPECT_TRUE(says(refusal(kMap, at("1760000000.023456")),
                   {"drive.csv:3: time goes back by 0.1 s, expected a later stamp than in line 2"}));
  EXPECT_TRUE(
      says(refusal(kMap, at("12:30")), {"drive.csv:3: found \"12:30\" in column \"t\", expected a time"}));
}

TEST(ImportCsv, CountsWhatItRepairs) {
  const std::string map = replaced(
      replaced(kMap, R"("left", "unit": "rad/s")", R"("left", "unit": "count", "per_turn": 1000, "bits": 8)"),
      R"("right", "unit": "rad/s")", R"("right", "kind": "increment", "unit": "rad")");
  const CsvImport i = import_text(map,
                                  "t,x,y,yaw,left,right\n0,,,,1,9\n0.1,1,1,3.1,250,1\n0.2,nan,NaN,nan,3,1\n"
                                  "0.3,2,2,-3.1,5,1\n0.4,2,2,-3.0,5,1\n0.5,2,2,3.1,5,1\n9,3,3,3.2,5,1");
  const Recording& r = i.dataset.recordings.at(0);
  EXPECT_THAT(r.time_us, ElementsAre(0, 100000, 200000, 300000, 400000, 8900000));
  EXPECT_THAT(r.reference.sample, ElementsAre(0, 2, 3, 4, 5));
  // Over the row without a reference the turn is not known, between neighbours it is.
  EXPECT_NEAR(r.reference.theta.at(1), -3.1, 1e-12);
  EXPECT_NEAR(r.reference.theta.at(2), -3.0, 1e-12);
  EXPECT_NEAR(r.reference.theta.at(3), 3.1 - 2 * kPi, 1e-12);
  EXPECT_NEAR(r.reference.theta.at(4), 3.2 - 2 * kPi, 1e-12);
  EXPECT_NEAR(r.signals.at(1).values.at(1), 9 * 2 * kPi / 1000, 1e-12) << "250 to 3 runs over";
  std::string notes;
  for (const std::string& note : i.dataset.notes) notes += note + "\n";
  EXPECT_THAT(notes, HasSubstr("drive.csv: 1 rows before the first with a reference left out"));
  EXPECT_THAT(notes, HasSubstr("drive.csv: 1 rows have no reference"));
  EXPECT_THAT(notes, HasSubstr("drive.csv: 1 jumps of the heading by full turns removed"));
  EXPECT_THAT(notes, HasSubstr("drive.csv: 1 headings more than half a turn"));
  EXPECT_THAT(notes, HasSubstr("ends without a line break"));
  EXPECT_THAT(notes,
              HasSubstr("1 steps longer than 10 usual ones of 0.1 s, the longest of 8.5 s before line 8"));
  EXPECT_THAT(import_text(map, kCsv).dataset.notes,
              ElementsAre(HasSubstr("begins with an increment from before the drive, of up to 20 rad")));
  EXPECT_THAT(import_text(replaced(kMap, R"("t", "unit": "s")", R"("t", "unit": "us")"),
                          replaced(replaced(kCsv, "0.05", "50"), "0.10", "100"))
                  .dataset.notes,
              ElementsAre(HasSubstr("rows are 5e-05 s apart: is the unit of \"t\" right?")));
}

TEST(ImportCsv, NamesDrivesAfterTheirFiles) {
  const TemporaryFolder folder;
  for (const char* name :
       {"run_10.csv", "run_2.csv", "bend.csv", "square_20261120.csv", "a b-3.csv", "notes.txt"})
    folder.file(name, kCsv);
  const auto ids = [&](const std::vector<std::string>& items, const std::string& map) {
    std::string text;
    for (const Recording& r : import_csv(items, folder.file("map.json", map)).dataset.recordings)
      text += r.id + " " + r.trajectory + " " + std::to_string(r.repetition) + "\n";
    return text;
  };
  EXPECT_EQ(ids({folder.path().string()}, kMap),
            "a_b_3 a b 3\nbend_1 bend 1\nrun_2 run 2\nrun_10 run 10\nsquare_20261120_1 square_20261120 1\n");
  EXPECT_EQ(ids({(folder / "run_*.csv").string(), (folder / "bend.csv").string()}, kMap),
            "run_2 run 2\nrun_10 run 10\nbend_1 bend 1\n");
  const auto named = [](const std::string& names) {
    return replaced(kMap, "\"signals\"", "\"trajectories\": {" + names + "}, \"signals\"");
  };
  EXPECT_EQ(ids({(folder / "run_*.csv").string()},
                named(R"("run_2.csv": "ring", "run_10": {"trajectory": "ring", "repetition": 1})")),
            "ring_2 ring 2\nring_1 ring 1\n");
  const auto refused = [&](const std::string& names) {
    return data_error([&] { ids({(folder / "run_*.csv").string()}, named(names)); });
  };
  EXPECT_TRUE(says(refused(R"("run_3.csv": "ring")"),
                   {"/trajectories: found \"run_3.csv\", did you mean 'run_2.csv'?"}));
  EXPECT_TRUE(says(refused(R"("run_2": {"trajectory": "run", "repetition": 10})"),
                   {"run_10.csv: found repetition 10 of \"run\" a second time"}));
  EXPECT_TRUE(says(refused(R"("run_2": {"trajectory": "run", "repetition": 0})"),
                   {"/trajectories/run_2/repetition", "1 or more"}));
  EXPECT_TRUE(
      says(data_error([&] { ids({(folder / "walk_*.csv").string()}, kMap); }), {"found no file walk_*.csv"}));
  const std::string bend = (folder / "bend.csv").string();
  EXPECT_THROW(ids({bend, (folder / "./bend.csv").string()}, kMap), std::invalid_argument);
  EXPECT_THROW(ids({bend, ""}, kMap), std::invalid_argument);
  EXPECT_THROW(ids({}, kMap), std::invalid_argument);
}

TEST(ImportCsv, TakesFilesWithoutAHeader) {
  const std::string map = replaced(
      kMap, "\"signals\"",
      R"("csv": {"columns": ["t", "x", "y", "yaw", "left", "", "right", ""], "separator": ";"}, "signals")");
  const Recording r = recording_of(map,
                                   "\xEF\xBB\xBF"
                                   "0;1,5;2;3;4;;5;\n0,5;2,5;2;3;4;x;6;\n");
  EXPECT_THAT(r.time_us, ElementsAre(0, 500000));
  EXPECT_THAT(r.reference.x, ElementsAre(1.5, 2.5));
  EXPECT_THAT(r.signals.at(0).values, ElementsAre(5, 6));
  EXPECT_TRUE(says(refusal(map, "0;1;2\n"), {"drive.csv:1: found 3 fields, expected 8"}));
  EXPECT_TRUE(
      says(refusal(kMap, "0,1,2,3,4,5\n1,1,2,3,4,5\n"),
           {"drive.csv:1: found numbers, expected the names of the columns", "\"csv\": {\"columns\""}));
  EXPECT_TRUE(says(refusal(replaced(map, "\";\"", "\"|\""), "0;1\n"), {"/csv/separator: found \"|\""}));
  EXPECT_TRUE(says(refusal(replaced(map, "\"yaw\", \"left\"", "\"yaw\", \"yaw\""), "0;1\n"),
                   {"/csv/columns/4: found \"yaw\""}));
}

TEST(ImportCsv, RefusesWithThePlace) {
  struct Bad {
    const char *from, *to;
    std::vector<std::string> says;
  };
  const std::vector<Bad> maps = {
      {"odobench-import",
       "odobench-dataset",
       {"map.json: /schema: found \"odobench-dataset\", expected \"odobench-import\""}},
      {"\"schema_version\": 1", "\"schema_version\": 2", {"/schema_version: found version 2, expected 1"}},
      {"\"licence\"", "\"license\"", {"unknown key \"license\", did you mean 'licence'?"}},
      {"\"name\": \"mine\"", "\"name\": \"\"", {"/name: found an empty text"}},
      {"\"nominal\": 0.3",
       "\"nominal\": null",
       {"map.json: /robot/parameters/0/nominal: found null, expected a number"}},
      {"\"differential\"", "null", {"/robot/kinematics: found null, expected a text"}},
      {"\"unit\": \"s\"", "\"unit\": null", {"/time/unit: found null, expected a text"}},
      {"\"unit\": \"s\"",
       "\"unit\": \"h\"",
       {"/time/unit: found \"h\", expected \"s\", \"ms\", \"us\" or \"ns\""}},
      {"\"x\", \"unit\": \"m\"",
       "\"x\", \"unit\": \"ft\"",
       {"/reference/x/unit: found \"ft\", expected \"m\", \"cm\" or \"mm\""}},
      {"\"yaw\", \"unit\": \"rad\"",
       "\"yaw\", \"unit\": \"m\"",
       {"/reference/theta/unit: found \"m\", expected \"rad\" or \"deg\""}},
      {"\"column\": \"x\"",
       "\"colum\": \"x\"",
       {"/reference/x: found unknown key \"colum\", did you mean 'column'?"}},
      {"\"column\": \"x\"", "\"column\": null", {"/reference/x/column: found null, expected a text"}},
      {"\"left\", \"unit\": \"rad/s\"",
       "\"left\", \"unit\": \"km/h\"",
       {"/signals/wheel.left/unit: found \"km/h\""}},
      {"\"left\", \"unit\": \"rad/s\"", "\"left\", \"unit\": null", {"/signals/wheel.left/unit: found null"}},
      {"\"left\", \"unit\": \"rad/s\"", "\"left\", \"unit\": \"count\"", {"/signals/wheel.left", "per_turn"}},
      {"\"left\", \"unit\": \"rad/s\"",
       "\"left\", \"unit\": \"rad\"",
       {"/signals/wheel.left: found increments beside the speeds of wheel.right"}},
      {"\"wheel.left\"",
       "\"wheel.lft\"",
       {"/signals: found a signal \"wheel.lft\" that the robot has not, did you mean 'wheel.left'?"}},
      {"\"wheel.left\": {\"column\": \"left\", \"unit\": \"rad/s\"}, ",
       "",
       {"/signals: found no signal \"wheel.left\", expected all of the robot: wheel.right, wheel.left"}},
      {"\"column\": \"left\"",
       "\"column\": \"lefft\"",
       {"drive.csv:1: found no column \"lefft\"", "/signals/wheel.left/column",
        "did you mean 'left'?; there are t, x, y, yaw, left, right"}},
      {"\"column\": \"t\"", "\"column\": \"clock\"", {"drive.csv:1: found no column \"clock\""}},
      {"{\"schema\"", "\"schema\"", {"map.json:1: broken JSON"}},
  };
  for (const Bad& bad : maps)
    EXPECT_TRUE(says(refusal(replaced(kMap, bad.from, bad.to), kCsv), bad.says)) << bad.to;
  const std::vector<Bad> files = {
      {"2,4,3.1", "2,,3.1", {"drive.csv:3: found 1 of x, y and theta empty, expected all three or none"}},
      {",11,", ",,", {"drive.csv:3: found \"\" in column \"left\", expected a finite number"}},
      {",11,", ",inf,", {"drive.csv:3: found \"inf\" in column \"left\""}},
      {",11,", ",1e60,", {"drive.csv:3: found \"1e60\" in column \"left\""}},
      {",11,", ",", {"drive.csv:3: found 5 fields, expected 6"}},
      {"left,right", "left,left", {"drive.csv:1: found no column \"right\""}},
      {"yaw,left,", "left,left,", {"drive.csv:1: found no column \"yaw\""}},
      {"x,y,yaw,left", "x,x,yaw,left", {"drive.csv:1:", "two columns \"x\""}},
      {"0.05,2,4,3.1,11,21\n0.10,3,6,3.2,12,22\n", "", {"drive.csv:2: found 1 rows, expected at least 2"}},
  };
  for (const Bad& bad : files)
    EXPECT_TRUE(says(refusal(kMap, replaced(kCsv, bad.from, bad.to)), bad.says)) << bad.to;
  EXPECT_TRUE(says(refusal(kMap, ""), {"drive.csv:1: found an empty file"}));
  EXPECT_TRUE(says(refusal(kMap, std::string("\x7f"
                                             "ELF\0\1\2\n",
                                             8)),
                   {"drive.csv:1: found a byte of zero"}));
  EXPECT_TRUE(says(refusal(kMap, "t,x,y,yaw,left,right\n0,,,,1,2\n1,,,,1,2\n"),
                   {"drive.csv:3: found no row with x, y and yaw"}));
  EXPECT_TRUE(says(refusal(kMap, "t,x,y,yaw,left,right\n0,1,1,1,1,2\n1,,,,1,2\n"),
                   {"drive.csv:2: found one row with a reference"}));
  EXPECT_TRUE(says(refusal(kMap, "t,x,y,yaw,left,right\n0,,,,1,2\n1,1,1,1,1,2\n"),
                   {"found 1 rows from the first with a reference on"}));
  const std::string counts =
      replaced(replaced(kMap, R"("left", "unit": "rad/s")", R"("left", "unit": "count", "per_turn": 9)"),
               R"("right", "unit": "rad/s")", R"("right", "unit": "rad")");
  EXPECT_TRUE(says(refusal(counts, replaced(kCsv, ",11,", ",9007199254740994,")),
                   {"drive.csv:3: found \"9007199254740994\"", "at most 2^53"}));
  EXPECT_EQ(refusal(counts, replaced(kCsv, ",11,", ",9007199254740992,")), "");
}

TEST(ImportCsv, NamesOfColumnsSayMeaningAndUnit) {
  using odobench::column_name;
  using odobench::Meaning;
  const auto is = [](const char* name, Meaning meaning, const std::string& unit,
                     const std::string& which = "") {
    const ColumnName column = column_name(name);
    EXPECT_EQ(column.meaning, meaning) << name;
    EXPECT_EQ(column.unit, unit) << name;
    EXPECT_EQ(column.which, which) << name;
  };
  is("time_s", Meaning::Time, "s");
  is("Time (ms)", Meaning::Time, "ms");
  is("stamp_ns", Meaning::Time, "ns");
  is("t", Meaning::Time, "");
  is("x_m", Meaning::X, "m");
  is("gt_y [mm]", Meaning::Y, "mm");
  is("yaw (deg)", Meaning::Heading, "deg");
  is("theta_rad", Meaning::Heading, "rad");
  is("left_rad_s", Meaning::Wheel, "rad/s", "left");
  is("wheel_speed.right [rpm]", Meaning::Wheel, "rpm", "right");
  is("enc_l", Meaning::Wheel, "count", "left");
  is("wheel3_ticks", Meaning::Wheel, "count", "3");
  is("v_left [m/s]", Meaning::Wheel, "", "left");
  is("steer_deg", Meaning::Steering, "deg");
  is("battery_V", Meaning::Unknown, "");
  EXPECT_TRUE(column_name("odom_x").odometry);
  EXPECT_FALSE(column_name("mocap_x").odometry);
}

TEST(ImportCsv, ProposesWhatNamesSayAndNoMore) {
  const TemporaryFolder folder;
  const auto proposal = [&](const std::string& csv) {
    return nlohmann::json::parse(propose_csv_map({folder.file("drive.csv", csv)}).map);
  };
  const nlohmann::json two =
      proposal("stamp,odom_x_m,x_m,y_m,yaw,left_ticks,right_ticks\n1000,0,0,0,0,0,0\n1050,0,0,0,0,0,0\n");
  EXPECT_EQ(two["robot"]["kinematics"], "differential");
  EXPECT_EQ(two["robot"]["parameters"][0]["name"], "b");
  EXPECT_TRUE(two["robot"]["parameters"][0]["nominal"].is_null());
  EXPECT_EQ(two["time"]["unit"], "ms") << "50 of what?";
  EXPECT_EQ(two["reference"]["x"]["column"], "x_m") << "odometry is no reference";
  EXPECT_TRUE(two["reference"]["theta"]["unit"].is_null());
  EXPECT_EQ(two["signals"]["wheel.left"]["unit"], "count");
  EXPECT_TRUE(two["signals"]["wheel.left"]["per_turn"].is_null());
  const nlohmann::json tricycle = proposal("t_s,x_m,y_m,yaw_deg,wheel_rad_s,steering_deg\n");
  EXPECT_EQ(tricycle["robot"]["kinematics"], "tricycle");
  EXPECT_EQ(tricycle["signals"]["steering"]["kind"], "angle");
  const nlohmann::json none = proposal("a,b,c\n1,2,3\n");
  for (const char* path : {"/time/column", "/reference/x/column", "/robot/kinematics"})
    EXPECT_TRUE(none.at(nlohmann::json::json_pointer(path)).is_null()) << path;
  EXPECT_TRUE(says(data_error([&] {
                     propose_csv_map({folder.file("a.csv", "t,x\n"), folder.file("b.csv", "t,y\n")});
                   }),
                   {"b.csv:1: found other columns than in the first file, expected t, x"}));
  // Once the nulls are replaced the import takes it.
  const std::string csv =
      replaced(kCsv, "t,x,y,yaw,left,right", "t_s,x_m,y_m,yaw_rad,left_rad_s,right_rad_s");
  nlohmann::json map = proposal(csv);
  EXPECT_TRUE(says(refusal(map.dump(), csv), {"map.json: /robot/parameters/0/nominal: found null"}));
  for (auto& p : map["robot"]["parameters"]) p["nominal"] = 0.1;
  EXPECT_EQ(recording_of(map.dump(), csv).signals, recording_of(kMap, kCsv).signals);
}

}  // namespace
}  // namespace odobench
