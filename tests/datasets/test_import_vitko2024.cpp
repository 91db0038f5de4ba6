// Import of the raw files: on sixty small made-up files for what the published ones do not show (other column
// orders, ties of stamps, everything broken), and on the published ones against an independent evaluation.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/files.hpp"
#include "base/sha256.hpp"
#include "datasets/import/vitko2024/synchronise.hpp"
#include "datasets/import/vitko2024/vitko2024.hpp"
#include "datasets/import/vitko2024/vitko2024_csv.hpp"
#include "datasets/import/vitko2024/vitko2024_join.hpp"
#include "datasets/native/columns.hpp"
#include "datasets/robot_4wis4wid.hpp"
#include "tests/support/data_error.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;
using testing::data_error;
using testing::replaced;
using testing::says;
using testing::TemporaryFolder;

constexpr int kRows = 35;  // 29 are dropped
constexpr int kOdomRows = 30;
constexpr double kTurn = 0.5;  // rad per capture row: six rows and a bit to pi

std::string stamp(std::int64_t us_of_minute) {
  return fmt::format("2024/02/29/23:59:{:02}.{:06}", us_of_minute / 1'000'000, us_of_minute % 1'000'000);
}

// x = row / 8, y = -row / 4, yaw = kTurn * row; one row each 20 ms.
std::string capture_file() {
  std::string text =
      "time;.pose.position.y;.pose.position.x;ignored;.pose.orientation.w;.pose.orientation.z;"
      ".pose.orientation.y;.pose.orientation.x\n";
  for (int k = 0; k < kRows; ++k)
    text += fmt::format("{};{};{:e};text;{};{};0;-0.0\n", stamp(20'000 * k), -k / 4.0, k / 8.0,
                        std::cos(kTurn * k / 2), std::sin(kTurn * k / 2));
  return text;
}

// Steering of wheel i: i + row / 16 (i = 1 to 4), speed 10 i - row / 16; one row each 20 ms, 10 ms after the
// capture's; five rows less than the capture has: 85 ms and more are extrapolated at the end.
std::string wheel_file() {
  std::string text = ".velocity;time;.effort;.position;.name\n";
  for (int k = 0; k < kOdomRows; ++k) {
    const double p = k / 16.0;
    text += fmt::format("[{}, 0, {}, 0, {}, 0, {}, 0];{};;({}, {}, {}, {}, {}, {}, {}, {});", 30 - p, 10 - p,
                        20 - p, 40 - p, stamp(10'000 + 20'000 * k), 0, 3 + p, 0, 1 + p, 0, 2 + p, 0, 4 + p);
    text +=
        "['BR_Wheel', 'BR_Position', 'FL_Wheel', 'FL_Position', \"BL_Wheel\", 'BL_Position', 'FR_Wheel', "
        "'FR_Position']\n";
  }
  return text;
}

// Sixty such files; gone with the test.
class RawFolder {
 public:
  RawFolder() {
    for (int i = 1; i <= 30; ++i) {
      folder_.file(fmt::format("abs_{}.csv", i), capture_file());
      folder_.file(fmt::format("odom_{}.csv", i), wheel_file());
    }
  }
  const fs::path& path() const { return folder_.path(); }
  std::string file(const std::string& name, const std::string& text) const {
    return folder_.file(name, text);
  }
  // The error of an import after one file's text was edited; the file is put back.
  template <class Edit>
  std::string error_of(const std::string& name, Edit edit) const {
    const std::string good = read_file(path() / name);
    file(name, edit(good));
    const std::string message = data_error([&] { import_vitko2024(path(), {}, 1); });
    file(name, good);
    return message;
  }
  std::string error_of(const std::string& name, const std::string& from, const std::string& to) const {
    return error_of(name, [&](const std::string& text) { return replaced(text, from, to); });
  }

 private:
  TemporaryFolder folder_;
};

// The text without what follows its first n lines.
std::string first_lines(const std::string& text, int n) {
  std::size_t at = 0;
  for (int i = 0; i < n; ++i) at = text.find('\n', at) + 1;
  return text.substr(0, at);
}

TEST(ImportVitko2024, MapsByNameAndSynchronises) {
  const RawFolder raw;
  const Dataset d = import_vitko2024(raw.path());
  ASSERT_EQ(d.recordings.size(), 30u);
  EXPECT_TRUE(d.notes.empty());
  for (const Recording& r : d.recordings) {
    EXPECT_FALSE(find_fault(r, 1)) << r.id;
    ASSERT_EQ(r.size(), static_cast<std::size_t>(kRows - 29));
    for (int j = 0; j < kRows - 29; ++j) {
      const auto k = static_cast<std::size_t>(j);
      const int row = j + 29;
      EXPECT_EQ(r.time_us[k], 20'000 * j);
      EXPECT_EQ(r.reference.x[k], row / 8.0);
      EXPECT_EQ(r.reference.y[k], -row / 4.0);
      EXPECT_NEAR(r.reference.theta[k], kTurn * row, 1e-13) << "unwrapped over two turns";
      const double p =
          (row - 0.5) / 16;  // the wheel signals are linear in time, so extrapolation goes on alike
      for (std::size_t i = 0; i < kWheelCount; ++i) {
        EXPECT_NEAR(steering_of(r, i)[k], static_cast<double>(i) + 1 + p, 1e-12);
        EXPECT_NEAR(wheel_speed_of(r, i)[k], 10 * (static_cast<double>(i) + 1) - p, 1e-12);
      }
    }
  }
}

TEST(ImportVitko2024, SteeringIsInterpolatedAlongTheShorterArc) {
  vitko2024::CaptureLog capture;
  vitko2024::WheelLog wheels;
  for (int k = 0; k < 60; ++k) {
    capture.time_us.push_back(1000 * k + 500);
    for (auto* values : {&capture.x, &capture.y, &capture.yaw}) values->push_back(0);
    wheels.time_us.push_back(1000 * k);
    for (std::size_t i = 0; i < kWheelCount;
         ++i) {  // to and fro across +-pi, as a sensor with that range reports it
      wheels.steering[i].push_back(k % 2 == 0 ? 3.13 : -3.13);
      wheels.wheel_speed[i].push_back(1);
    }
  }
  const Recording r = vitko2024::join(capture, wheels);
  for (std::size_t i = 0; i < kWheelCount; ++i)
    for (const double angle : steering_of(r, i)) EXPECT_NEAR(std::cos(angle), -1, 1e-3) << angle;
}

TEST(ImportVitko2024, NamesTrajectoriesRobotAndSources) {
  const RawFolder raw;
  const Dataset d = import_vitko2024(raw.path());
  const char* trajectories[] = {"line_x", "line_y", "circle_ccw", "circle_cw", "rotation_ccw", "rotation_cw"};
  ASSERT_EQ(d.trajectories.size(), 6u);
  for (std::size_t i = 0; i < 30; ++i) {
    EXPECT_EQ(d.trajectories[i / 5].name, trajectories[i / 5]);
    EXPECT_EQ(d.recordings[i].trajectory, trajectories[i / 5]);
    EXPECT_EQ(d.recordings[i].repetition, static_cast<int>(i % 5) + 1);
    EXPECT_EQ(d.recordings[i].id, fmt::format("{}_{}", trajectories[i / 5], i % 5 + 1));
  }
  const double nominal[] = {.1125,  -.1125, -.1125, .1125, .1125, .1125,
                            -.1125, -.1125, .0254,  .0254, .0254, .0254};
  ASSERT_EQ(d.robot.parameters.size(), 12u);
  for (std::size_t i = 0; i < 12; ++i) {
    const RobotParameter& p = d.robot.parameters[i];
    EXPECT_EQ(p.name, fmt::format("{}{}", "abr"[i / 4], i % 4 + 1));
    EXPECT_EQ(p.nominal, nominal[i]);
    EXPECT_EQ(p.lower, std::min(nominal[i] * 0.95, nominal[i] * 1.05));
    EXPECT_EQ(p.upper, std::max(nominal[i] * 0.95, nominal[i] * 1.05));
  }
  // Files in the published layout that are not the published ones claim nothing of them.
  EXPECT_EQ(d.provenance.licence, "unknown");
  EXPECT_EQ(d.provenance.source.find("Vitko"), std::string::npos);
  EXPECT_TRUE(d.known_parameters.empty());
  ASSERT_EQ(d.provenance.files.size(), 60u);
  EXPECT_EQ(d.provenance.files[3].path, "dataset/odom_2.csv");
  EXPECT_EQ(d.provenance.files[3].sha256, sha256(wheel_file()));
}

TEST(ImportVitko2024, TakesACloneAndWindowsLineEnds) {
  const RawFolder raw;
  const Dataset plain = import_vitko2024(raw.path());
  const TemporaryFolder clone;
  fs::copy(raw.path(), clone / "dataset", fs::copy_options::recursive);
  std::string text = read_file(clone / "dataset/abs_1.csv");
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.insert(at, "\r");
  write_file(clone / "dataset/abs_1.csv", text + "\r\n\n");
  EXPECT_EQ(import_vitko2024(clone.path()).recordings[0].reference.theta,
            plain.recordings[0].reference.theta);
}

TEST(ImportVitko2024, OtherNumbersOfPairsAreDrivesOfOneTrajectory) {
  const RawFolder raw;
  for (int i = 6; i <= 30; ++i) {
    fs::remove(raw.path() / fmt::format("abs_{}.csv", i));
    fs::remove(raw.path() / fmt::format("odom_{}.csv", i));
  }
  const Dataset set = import_vitko2024(raw.path());
  ASSERT_EQ(set.recordings.size(), 5u);
  ASSERT_EQ(set.trajectories.size(), 1u);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(set.recordings[i].trajectory, "drive");
    EXPECT_EQ(set.recordings[i].repetition, static_cast<int>(i) + 1);
    EXPECT_EQ(set.recordings[i].id, fmt::format("drive_{}", i + 1));
  }
  EXPECT_THAT(set.notes, ::testing::Contains(::testing::HasSubstr("5 pairs of files, not 30")));
  EXPECT_EQ(set.provenance.source.find("Vitko"), std::string::npos) << set.provenance.source;
  EXPECT_TRUE(set.known_parameters.empty());
  EXPECT_NE(set.description.find("5 drives"), std::string::npos);
  // A gap is no smaller number.
  fs::remove(raw.path() / "odom_3.csv");
  EXPECT_TRUE(says(data_error([&] { import_vitko2024(raw.path()); }), {"odom_3.csv", "cannot be read"}));
}

TEST(ImportVitko2024, DropsLostSamplesWhereAsked) {
  const RawFolder raw;
  const std::string good = read_file(raw.path() / "abs_2.csv");
  // Its line 34 with these four last fields, the quaternion.
  const auto with = [&](const std::string& quaternion) {
    const std::size_t begin = first_lines(good, 33).size(), end = good.find('\n', begin);
    std::size_t cut = end;
    for (int i = 0; i < 4; ++i) cut = good.rfind(';', cut - 1);
    raw.file("abs_2.csv", good.substr(0, cut) + quaternion + good.substr(end));
  };
  with(";0;0;0;0");
  EXPECT_TRUE(says(data_error([&] { import_vitko2024(raw.path()); }),
                   {"abs_2.csv:34: found an orientation quaternion of norm 0", "--drop-lost"}));
  for (const char* quaternion : {";0;0;0;0", ";nan;nan;nan;NaN"}) {
    with(quaternion);
    const Dataset set = import_vitko2024(raw.path(), {}, 0, true);
    EXPECT_EQ(set.recordings[1].size() + 1, set.recordings[0].size());
    EXPECT_THAT(set.notes, ::testing::Contains(::testing::HasSubstr(
                               "1 samples whose tracking was lost left out of recording line_x_2")));
  }
}

TEST(ImportVitko2024, MendsTiesOfStampsAndCountsThem) {
  const RawFolder raw;
  // Rows 31 and 32 with the stamp of row 30, row 33 a little before it.
  std::string text = capture_file();
  for (int row : {31, 32}) text = replaced(text, stamp(20'000 * row), stamp(600'000));
  text = replaced(text, stamp(660'000), stamp(599'990));
  raw.file("abs_7.csv", text);
  raw.file("odom_9.csv", replaced(wheel_file(), stamp(50'000), stamp(30'000)));
  const Dataset d = import_vitko2024(raw.path());
  EXPECT_EQ(d.recordings[6].time_us, (std::vector<std::int64_t>{0, 20'000, 20'001, 20'002, 20'003, 100'000}));
  EXPECT_EQ(
      d.notes,
      (std::vector<std::string>{
          "3 stamps moved to 1 us after their predecessor in recording line_y_2 (dataset/abs_7.csv)",
          "1 stamps moved to 1 us after their predecessor in recording line_y_4 (dataset/odom_9.csv)"}));
}

TEST(ImportVitko2024, ChecksSumsWhereThereAreAny) {
  const RawFolder raw;
  std::string sums;
  for (int i = 1; i <= 30; ++i)
    sums +=
        fmt::format("{}  abs_{}.csv\n{} *odom_{}.csv\n", sha256(capture_file()), i, sha256(wheel_file()), i);
  raw.file("SHA256SUMS", sums);
  EXPECT_EQ(import_vitko2024(raw.path()).recordings.size(), 30u);
  EXPECT_TRUE(says(raw.error_of("odom_4.csv", "0;", "0 ;"), {"odom_4.csv: found SHA-256 ", "SHA256SUMS:8)"}));
  EXPECT_TRUE(
      says(raw.error_of("SHA256SUMS", "abs_5.csv", "abs_55.csv"), {"SHA256SUMS: found no sum of abs_5.csv"}));
  EXPECT_TRUE(says(raw.error_of("SHA256SUMS", [](const std::string& s) { return "zz" + s; }),
                   {"SHA256SUMS:1: found \"zz"}));
}

TEST(ImportVitko2024, RefusesBrokenCaptureFiles) {
  const RawFolder raw;
  const std::string row5 = stamp(60'000) + ";-0.75;3.750000e-01;";  // on line 5
  const auto is_refused = [&](const std::string& from, const std::string& to,
                              const std::vector<std::string>& parts) {
    EXPECT_TRUE(says(raw.error_of("abs_2.csv", from, to), parts));
  };
  is_refused(row5, stamp(60'000) + ";-0.75;", {"abs_2.csv:5: found 7 fields, expected 8"});
  is_refused(row5, row5 + ";", {"abs_2.csv:5: found 9 fields, expected 8"});
  is_refused(row5, stamp(60'000) + ";nan;0;",
             {"abs_2.csv:5: found \"nan\" in column \".pose.position.y\"", "finite number"});
  is_refused(row5, stamp(60'000) + ";0.1;0.1x;",
             {"abs_2.csv:5: found \"0.1x\" in column \".pose.position.x\""});
  is_refused(row5, stamp(60'000) + ";;0;", {"abs_2.csv:5: found \"\" in column"});
  is_refused(row5, stamp(60'000) + ";1e999;0;", {"abs_2.csv:5: found \"1e999\""});
  is_refused(row5, "2024/02/30/23:59:00.060000;0;0;",
             {"abs_2.csv:5: found \"2024/02/30/23:59:00.060000\" in column \"time\""});
  is_refused(row5, "2024-02-29/23:59:00.060000;0;0;", {"abs_2.csv:5", "expected a time like"});
  is_refused("text;1;0;0;-0.0", "text;0;0;0;0",
             {"abs_2.csv:2: found an orientation quaternion of norm 0, expected 1"});
  is_refused(".pose.orientation.w", "w", {"abs_2.csv:1: found no column \".pose.orientation.w\""});
  is_refused("ignored", "time", {"abs_2.csv:1: found two columns \"time\""});
  is_refused(stamp(620'000), stamp(580'000),
             {"abs_2.csv:33: found a stamp 20000 us before the one above it"});
}

TEST(ImportVitko2024, RefusesBrokenWheelFiles) {
  const RawFolder raw;
  const auto is_refused = [&](const std::string& from, const std::string& to,
                              const std::vector<std::string>& parts) {
    EXPECT_TRUE(says(raw.error_of("odom_30.csv", from, to), parts));
  };
  is_refused("(0, 3.0625, ", "(0, 3.0625, 0, ",
             {"odom_30.csv:3: found 9 entries in column \".position\", expected 8"});
  is_refused("(0, 3.0625, ", "(3.0625, ",
             {"odom_30.csv:3: found 7 entries in column \".position\", expected 8"});
  is_refused("[29.9375, 0,", "[29.9375,",
             {"odom_30.csv:3: found 7 entries in column \".velocity\", expected 8"});
  is_refused("(0, 3.0625, ", "(0, nan, ", {"odom_30.csv:3: found \"nan\" in column \".position\""});
  is_refused("(0, 3.0625, ", "0, 3.0625, ", {"odom_30.csv:3: found \"0, 3.0625", "expected a list"});
  is_refused("(0, 3.0625, ", "(, 3.0625, ", {"odom_30.csv:3: found \"\" in column \".position\""});
  is_refused("'FL_Wheel'", "'XL_Wheel'", {"odom_30.csv:2: found the unknown wheel name \"XL_Wheel\""});
  is_refused("'FL_Wheel'", "'FR_Wheel'", {"odom_30.csv:2: found the wheel name \"FR_Wheel\" twice"});
  is_refused("'FL_Wheel', ", "", {"odom_30.csv:2: found no name \"FL_Wheel\""});
  is_refused(stamp(50'000), stamp(30'000 - 10'001), {"odom_30.csv:4: found a stamp 10001 us before"});
  is_refused(stamp(10'000), "2024/02/29/23:58:50.000000", {"odom_30.csv:3: found a stamp 10030000 us after"});
}

TEST(ImportVitko2024, RefusesFilesThatDoNotBelongTogether) {
  const RawFolder raw;
  const auto shifted = [](const char* day) {
    return [day](std::string text) {
      for (std::size_t at = 0; (at = text.find("2024/02/29", at)) != std::string::npos;)
        text.replace(at, 10, day);
      return text;
    };
  };
  EXPECT_TRUE(says(raw.error_of("odom_1.csv", shifted("2024/03/01")),
                   {"odom_1.csv:2: found a first stamp 86400010000 us after"}));
  EXPECT_TRUE(says(raw.error_of("odom_1.csv", shifted("2024/02/28")),
                   {"odom_1.csv:31: found a last stamp 86400090000 us before"}));
}

TEST(ImportVitko2024, RefusesMissingAndShortFiles) {
  const RawFolder raw;
  const auto lines = [](int n) { return [n](const std::string& text) { return first_lines(text, n); }; };
  EXPECT_TRUE(says(raw.error_of("abs_3.csv", lines(31)),
                   {"abs_3.csv:32: found the end of the file after 30 rows, expected at least 31"}));
  EXPECT_EQ(raw.error_of("abs_3.csv", lines(32)), "");
  EXPECT_TRUE(
      says(raw.error_of("abs_3.csv", lines(1)), {"abs_3.csv:2: found the end of the file after 0 rows"}));
  EXPECT_TRUE(says(raw.error_of("abs_3.csv", lines(0)),
                   {"abs_3.csv:1: found an empty file, expected a header line"}));
  EXPECT_TRUE(
      says(raw.error_of("odom_3.csv", lines(2)), {"odom_3.csv:3: found the end of the file after 1 rows"}));
  const auto cut = [](const std::string& text) { return text.substr(0, text.rfind(';')); };
  EXPECT_TRUE(
      says(raw.error_of("abs_3.csv", cut), {"abs_3.csv:36: found the end of the file inside the line"}));
  EXPECT_TRUE(
      says(raw.error_of("odom_3.csv", cut), {"odom_3.csv:31: found the end of the file inside the line"}));
  const auto unbroken = [](const std::string& text) { return text.substr(0, text.size() - 1); };
  EXPECT_EQ(raw.error_of("abs_3.csv", unbroken), "");
  fs::remove(raw.path() / "odom_12.csv");
  EXPECT_TRUE(says(data_error([&] { import_vitko2024(raw.path()); }),
                   {"odom_12.csv: cannot be read", "No such file"}));
  EXPECT_TRUE(
      says(data_error([&] { import_vitko2024(raw.path() / "nowhere"); }), {"nowhere: found no such folder"}));
}

TEST(ImportVitko2024, ReportsTheFirstOfSeveralErrorsForAnyThreadCount) {
  const RawFolder raw;
  for (int i : {3, 4, 8}) raw.file(fmt::format("abs_{}.csv", i), "time\n");
  for (int threads : {1, 2, 7})
    EXPECT_TRUE(says(data_error([&] { import_vitko2024(raw.path(), {}, threads); }), {"abs_3.csv:1"}))
        << threads;
}

TEST(ImportVitko2024, ReportsProgressAndCanBeInterrupted) {
  const RawFolder raw;
  std::vector<int> done;
  import_vitko2024(raw.path(), [&](int n, int total) {
    done.push_back(n);
    EXPECT_EQ(total, 30);
  });
  ASSERT_EQ(done.size(), 30u);
  for (int i = 0; i < 30; ++i) EXPECT_EQ(done[static_cast<std::size_t>(i)], i + 1);
  struct Interrupt {};
  int calls = 0;
  const auto interrupt = [&](int, int) {
    if (++calls == 3) throw Interrupt();
  };
  EXPECT_THROW(import_vitko2024(raw.path(), interrupt), Interrupt);
  EXPECT_EQ(calls, 3);
}

TEST(ImportVitko2024, ReproducesThePublishedRecordings) {
  ODOBENCH_NEEDS_SHARED();
  const fs::path folder = testing::shared_folder() / "datasets/vitko2024";
  const nlohmann::json reference =
      nlohmann::json::parse(read_file(testing::shared_folder() / "reference/calibration_vitko2024.json"));
  const Dataset d = import_vitko2024(folder, {}, 1);
  std::size_t total = 0;
  for (std::size_t i = 0; i < d.recordings.size(); ++i) {
    const Recording& r = d.recordings[i];
    const std::string number = std::to_string(i + 1);
    EXPECT_EQ(r.size(), reference["samples"][number].get<std::size_t>()) << r.id;
    EXPECT_EQ(r.time_us.back(), std::llround(reference["duration_s"][number].get<double>() * 1e6)) << r.id;
    EXPECT_FALSE(find_fault(r, 1)) << r.id;
    total += r.size();
  }
  EXPECT_EQ(total, reference["total_samples"].get<std::size_t>());
  EXPECT_TRUE(d.notes.empty());
  EXPECT_EQ(d.provenance.licence, "none stated");
  EXPECT_NE(d.provenance.source.find("Vitko"), std::string::npos);
  const std::map<std::string, std::string> sets = {
      {"published:ip", "fmincon"}, {"published:lm", "lm"}, {"published:ga", "ga"}, {"published:pso", "pso"}};
  ASSERT_EQ(d.known_parameters.size(), sets.size());
  for (const NamedParameters& known : d.known_parameters) {
    const auto expected = reference["sets"][sets.at(known.name)]["parameters"].get<std::vector<double>>();
    ASSERT_EQ(known.values.size(), expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k)
      EXPECT_DOUBLE_EQ(known.values[k], expected[k]) << known.name;
  }
  const Dataset parallel = import_vitko2024(folder, {}, 2);
  for (std::size_t i = 0; i < d.recordings.size(); ++i)
    EXPECT_EQ(parallel.recordings[i].signals, d.recordings[i].signals) << i;
}

TEST(ImportVitko2024, TheCheckedInSumsAreThoseOfTheFiles) {
  ODOBENCH_NEEDS_SHARED();
  EXPECT_EQ(read_file(source_dir() / "scripts/vitko2024.sha256"),
            read_file(testing::shared_folder() / "datasets/vitko2024/SHA256SUMS"));
}

}  // namespace
}  // namespace odobench
