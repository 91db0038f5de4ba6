// Import of OptiOdom's folders: on small made-up ones for the layout and everything broken, and on real ones
// against what their files hold.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "base/angle.hpp"
#include "base/files.hpp"
#include "base/sha256.hpp"
#include "datasets/import/optiodom/optiodom.hpp"
#include "datasets/native/columns.hpp"
#include "tests/support/data_error.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/shared_data.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;
using testing::data_error;
using testing::replaced;
using testing::says;
using testing::TemporaryFolder;

const std::string kMetadata =
    "type,diff,,\nngear,10,,\nencRes,36,,\nLi,0.2,,\nDi,0.08,0.09,\nThi,,,\nN,2,,\nL,1.5,,\nimarkers,2,5,\n"
    "gt_ti,0.5,1,\n";
const std::string kClockwise = "0,0,0,0,99,-0\n0.05,0.1,0.2,-1,90,-180\n0.1000001,0.2,0.3,-2,-0,360\n";
const std::string kCounterClockwise = "0,0,0,0,0,0\n0.05,0.1,0.2,3.5,9,18\n";

// TYPE/PATH/STAMP with two runs; gone with the test.
class DriveFolders {
 public:
  explicit DriveFolders(const std::string& path = "square", const std::string& stamp = "0102") {
    add(path, stamp);
  }
  fs::path add(const std::string& path, const std::string& stamp) {
    path_ = folder_.path() / "diff" / path / stamp;
    stamp_ = stamp;
    fs::create_directories(path_);
    write("_metadata.csv", kMetadata);
    write("_run-01.csv", kClockwise);
    write("_run-02.csv", kCounterClockwise);
    return path_;
  }
  void write(const std::string& end, const std::string& text) const { write_file(file(end), text); }
  void remove(const std::string& end) const { fs::remove(file(end)); }
  fs::path file(const std::string& end) const { return path_ / (stamp_ + end); }
  const fs::path& path() const { return path_; }
  const fs::path& root() const { return folder_.path(); }
  // The error of an import after one file was changed; the file is put back.
  std::string error_of(const std::string& end, const std::string& from, const std::string& to) const {
    const std::string good = read_file(file(end));
    write(end, replaced(good, from, to));
    const std::string message = data_error([&] { import_optiodom({path_}); });
    write(end, good);
    return message;
  }

 private:
  TemporaryFolder folder_;
  fs::path path_;
  std::string stamp_;
};

std::vector<std::string> trajectory_names(const Dataset& d) {
  std::vector<std::string> names;
  for (const Trajectory& t : d.trajectories) names.push_back(t.name);
  return names;
}
std::string usage_error(const std::vector<fs::path>& folders, const OptiodomOptions& options = {}) {
  try {
    import_optiodom(folders, options);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

TEST(ImportOptiodom, ReadsAFolder) {
  const DriveFolders raw;
  const Dataset d = import_optiodom({raw.path()});
  EXPECT_EQ(d.robot.kinematics, "differential");
  ASSERT_EQ(d.robot.parameters.size(), 3u);
  EXPECT_EQ(d.robot.parameters[0].nominal, 0.2);
  EXPECT_EQ(d.robot.parameters[1].nominal, 0.04);
  EXPECT_EQ(d.robot.parameters[2].nominal, 0.045);
  EXPECT_NEAR(d.robot.parameters[0].upper, 0.23, 1e-15);
  EXPECT_EQ(trajectory_names(d), (std::vector<std::string>{"square_cw", "square_ccw"}));
  EXPECT_EQ(d.trajectories[0].description, "square, clockwise, side 1.5 m");
  ASSERT_EQ(d.recordings.size(), 2u);
  const Recording& r = d.recordings[0];
  EXPECT_EQ(r.id, "0102_run-01");
  EXPECT_EQ(r.trajectory, "square_cw");
  EXPECT_EQ(d.recordings[1].repetition, 2);
  EXPECT_EQ(r.time_us, (std::vector<std::int64_t>{0, 50'000, 100'000}));
  EXPECT_EQ(r.reference.theta, (std::vector<double>{0, -1, -2}));
  EXPECT_TRUE(r.reference.sample.empty());
  ASSERT_EQ(r.signals.size(), 2u);
  EXPECT_EQ(r.signals[0].name, "wheel.right");
  EXPECT_EQ(r.signals[0].kind, SignalKind::Increment);
  EXPECT_NEAR(r.signals[0].values[1], kPi / 2, 1e-15);
  EXPECT_NEAR(r.signals[1].values[1], -kPi, 1e-15);
  EXPECT_FALSE(std::signbit(r.signals[0].values[2])) << "-0 becomes 0";
  EXPECT_FALSE(find_fault(r, 2));
  EXPECT_THAT(d.notes, ::testing::Contains(::testing::HasSubstr("up to 1.73 rad")));
  EXPECT_THAT(d.provenance.licence, ::testing::StartsWith("not stated"));
  ASSERT_EQ(d.provenance.files.size(), 3u);
  EXPECT_EQ(d.provenance.files[1].path, "diff/square/0102/0102_run-01.csv");
  EXPECT_EQ(d.provenance.files[1].sha256, sha256(kClockwise));
}

TEST(ImportOptiodom, SeveralFoldersAndExcludedRuns) {
  DriveFolders raw;
  const fs::path first = raw.path();
  write_file(raw.root() / "LICENSE", "MIT License\n");
  const fs::path second = raw.add("square", "0103"), third = raw.add("ivanjko", "0104");
  write_file(raw.file("_metadata.csv"), replaced(kMetadata, "N,2", "N,9"));
  const Dataset d = import_optiodom({first, second / "", third}, {{2}});
  EXPECT_EQ(trajectory_names(d), (std::vector<std::string>{"square_cw_0102", "square_cw_0103", "turn_cw"}));
  EXPECT_EQ(d.recordings.size(), 3u);
  EXPECT_EQ(d.provenance.licence, "MIT");
  EXPECT_THAT(d.notes, ::testing::Contains("run 2 of diff/square/0103 left out, as asked for"));
  EXPECT_THAT(d.notes, ::testing::Contains("metadata of diff/ivanjko/0104 state 9 runs, the folder has 2"));

  raw.write("_metadata.csv", replaced(kMetadata, "Li,0.2", "Li,0.25"));
  EXPECT_THAT(
      import_optiodom({first, third}).notes,
      ::testing::Contains(::testing::HasSubstr("ivanjko/0104 state other nominal values, which are not "
                                               "used: distances 0.25 m")));
  EXPECT_THAT(usage_error({first, first}), ::testing::HasSubstr("given twice"));
  EXPECT_THAT(usage_error({first}, {{3}}), ::testing::HasSubstr("run 3 is to be excluded, but no folder"));
  EXPECT_THAT(usage_error({first}, {{1, 2}}), ::testing::HasSubstr("all runs are excluded"));
  EXPECT_THAT(usage_error({first, ""}), ::testing::HasSubstr("found an empty name"));
  EXPECT_THAT(usage_error({}), ::testing::HasSubstr("no folder"));
}

TEST(ImportOptiodom, RefusesBrokenMetadata) {
  const DriveFolders raw;
  const auto error = [&](const std::string& from, const std::string& to) {
    return raw.error_of("_metadata.csv", from, to);
  };
  EXPECT_TRUE(says(error("diff", "dif"), {"0102_metadata.csv:1: found type \"dif\", did you mean 'diff'?"}));
  EXPECT_TRUE(says(error("type,diff,,\n", ""), {"metadata.csv:3: found this row before the row \"type\""}));
  EXPECT_TRUE(
      says(error("ngear,10", "ngear,x"), {"metadata.csv:2: found \"x\"", "expected a finite number"}));
  EXPECT_TRUE(
      says(error("ngear,10", "ngear,0"), {"metadata.csv:2: found 0 as \"ngear\", expected a number > 0"}));
  EXPECT_TRUE(says(error("encRes,36,,\n", ""), {"metadata.csv:10: found no row \"encRes\""}));
  EXPECT_TRUE(says(error("0.08,0.09", "0.08,"), {"metadata.csv:5: found 1 values of \"Di\", expected 2"}));
  EXPECT_TRUE(says(error("Thi,,,", "N,3,,"), {"metadata.csv:7: found a second row \"N\""}));
  EXPECT_TRUE(says(error("N,2", "N,2.5"), {"metadata.csv:7: found 2.5 as \"N\", expected a whole number"}));
  EXPECT_TRUE(says(error("L,1.5,,", "L,1.5"), {"metadata.csv:8: found 2 fields, expected 4"}));
  EXPECT_TRUE(says(error(kMetadata, ""), {"metadata.csv:1: found no row \"type\""}));
  EXPECT_TRUE(says(error(kMetadata, "type"), {"metadata.csv:1: found"}));
}

TEST(ImportOptiodom, RefusesBrokenRuns) {
  const DriveFolders raw;
  const auto error = [&](const std::string& from, const std::string& to) {
    return raw.error_of("_run-02.csv", from, to);
  };
  EXPECT_TRUE(
      says(error("0.05,", "0.063,"), {"0102_run-02.csv:2: found t = 0.063 s in row 2, expected 0.05 s"}));
  EXPECT_EQ(error("0.05,", "0.062,"), "") << "a quarter of the step is allowed";
  EXPECT_TRUE(says(error("3.5", "nan"), {"run-02.csv:2: found \"nan\" in column \"theta\""}));
  EXPECT_TRUE(says(error(",9,", ","), {"run-02.csv:2: found 5 fields, expected 6: t, x, y, theta, n1, n2"}));
  EXPECT_TRUE(says(error(",18", ",18,1"), {"run-02.csv:2: found 7 fields"}));
  EXPECT_TRUE(
      says(error(kCounterClockwise, "0,0,0,0,0,0\n"), {"run-02.csv:2: found the end", "after 1 rows"}));
  EXPECT_TRUE(says(error(kCounterClockwise, ""), {"run-02.csv:1: found the end of the file after 0 rows"}));
  EXPECT_TRUE(says(error("18\n", ""), {"run-02.csv:2: found the end of the file inside the line"}));

  raw.write("_run-02.csv", kCounterClockwise.substr(0, kCounterClockwise.size() - 1));
  EXPECT_THAT(
      import_optiodom({raw.path()}).notes,
      ::testing::Contains("diff/square/0102/0102_run-02.csv ends without a line break: its last row may "
                          "be cut"));
}

TEST(ImportOptiodom, RefusesOtherFolders) {
  DriveFolders raw;
  const fs::path first = raw.path();
  const auto error = [](const std::vector<fs::path>& folders) {
    return data_error([&] { import_optiodom(folders); });
  };
  EXPECT_TRUE(says(error({raw.root() / "absent"}), {"absent: found no folder that can be read"}));
  EXPECT_TRUE(says(error({raw.root()}), {"found 0 files *_metadata.csv, expected one"}));
  raw.write("x_metadata.csv", kMetadata);
  EXPECT_TRUE(says(error({first}), {"found 2 files *_metadata.csv"}));
  raw.remove("x_metadata.csv");
  raw.write("_run-1.csv", kClockwise);
  EXPECT_TRUE(says(error({first}), {"0102_run-1.csv", "expected one file of run 1"}));
  raw.remove("_run-1.csv");
  const fs::path second = raw.add("circular", "0102");
  EXPECT_TRUE(says(error({first, second}), {"found the stamp 0102 a second time"}));
  raw.write("_metadata.csv", "type,tricyc\nngear,1\nencRes,1600\nLi,0.15\nDi,0.065\nThi,0\nN,1\n");
  EXPECT_TRUE(
      says(error({first, second}), {"circular/0102: found a robot of type tricyc, expected diff as in"}));
  raw.remove("_run-01.csv");
  raw.remove("_run-02.csv");
  EXPECT_TRUE(says(error({second}), {"found no 0102_run-*.csv"}));
}

// The numbers of a row of a file, the slow way.
std::vector<double> row_of(const fs::path& file, std::size_t row) {
  std::ifstream in(file);
  std::string line, field;
  for (std::size_t k = 0; k <= row; ++k) std::getline(in, line);
  std::vector<double> values;
  for (std::istringstream fields(line); std::getline(fields, field, ',');) values.push_back(std::stod(field));
  return values;
}

struct RealSet {
  std::string folder, kinematics;
  std::vector<double> nominal, scale;  // parameters; rad per unit of a sensor's column
  std::size_t recordings;
  std::vector<std::string> trajectories;
};

TEST(ImportOptiodom, RealFolders) {
  ODOBENCH_NEEDS_SHARED();
  const fs::path data = testing::shared_folder() / "datasets" / "optiodom";
  if (!fs::exists(data)) GTEST_SKIP() << "needs " << data;
  const double d = 2 * kPi / (43.7 * 64), o = 2 * kPi / (12 * 1024), t = 2 * kPi;
  const std::vector<RealSet> sets = {
      {"diff/ivanjko/231220200057",
       "differential",
       {0.2, 0.042, 0.042},
       {d, d},
       9,
       {"line", "turn_cw", "turn_ccw"}},
      {"tricyc/square/140120211430",
       "tricycle",
       {0.15, 0.0325, 0},
       {2 * kPi / 1600, 1},
       2,
       {"square_cw", "square_ccw"}},
      {"omni3/joystick/221220202228", "omni3", {0.195, 0.051, 0.051, 0.051}, {o, o, o}, 4, {"joystick"}},
      {"omni4/circular/231220200510",
       "mecanum",
       {0.1, 0.1, kPi / 4, 0.03, 0.03, 0.03, 0.03},
       {t, -t, t, -t},
       4,
       {"circular_cw", "circular_ccw"}}};
  for (const RealSet& set : sets) {
    const Dataset imported = import_optiodom({data / set.folder});
    EXPECT_EQ(imported.robot.kinematics, set.kinematics);
    ASSERT_EQ(imported.robot.parameters.size(), set.nominal.size());
    for (std::size_t i = 0; i < set.nominal.size(); ++i)
      EXPECT_NEAR(imported.robot.parameters[i].nominal, set.nominal[i], 1e-15) << set.folder;
    EXPECT_EQ(trajectory_names(imported), set.trajectories);
    ASSERT_EQ(imported.recordings.size(), set.recordings);
    EXPECT_EQ(imported.provenance.licence, "MIT");
    for (const SourceFile& file : imported.provenance.files)
      EXPECT_EQ(file.sha256, sha256(read_file(data / file.path))) << file.path;
    for (const Recording& r : imported.recordings) {
      EXPECT_FALSE(find_fault(r, 2)) << r.id;
      const fs::path file = data / set.folder / (r.id + ".csv");
      for (const std::size_t k : {std::size_t{1}, r.size() / 2, r.size() - 1}) {
        const std::vector<double> row = row_of(file, k);
        ASSERT_EQ(row.size(), 4 + set.scale.size());
        EXPECT_NEAR(static_cast<double>(r.time_us[k]) * 1e-6, row[0], 1e-6) << r.id;
        EXPECT_EQ(r.reference.x[k], row[1]);
        EXPECT_EQ(r.reference.y[k], row[2]);
        EXPECT_EQ(r.reference.theta[k], row[3]);
        for (std::size_t i = 0; i < set.scale.size(); ++i)
          EXPECT_NEAR(r.signals[i].values[k], set.scale[i] * row[4 + i], 1e-12) << r.id;
      }
    }
  }
}

// What a set.json keeps of it.
TEST(ImportOptiodom, SurvivesItsSet) {
  const DriveFolders raw;
  raw.write("_metadata.csv", "type,omni4\nngear,1\nencRes,1\nLi,0.2,0.3\nDi,0.06,0.06,0.07,0.06\nN,2\n");
  const std::string rows =
      "0,0,0,0,-0,-0,-0,-0\n0.01,0.1,0.2,0.1,0.25,0.5,-0.125,1\n0.02,0.3,0.2,0.1,1,2,3,4\n";
  raw.write("_run-01.csv", rows);
  raw.write("_run-02.csv", rows);
  EXPECT_THAT(data_error([&] { import_optiodom({raw.path()}); }),
              ::testing::HasSubstr("found 3 fields, expected 2"));
  raw.write("_metadata.csv",
            "type,omni4,,,\nngear,1,,,\nencRes,1,,,\nLi,0.2,0.3,,\nDi,0.06,0.06,0.07,0.06\nN,2,,,\n");
  const Dataset d = import_optiodom({raw.path()});
  EXPECT_EQ(d.recordings[0].signals[1].values[1], -kPi) << "the right wheels count backwards";
  save_dataset(d, raw.root() / "set.json");
  const Dataset again = load_dataset(raw.root() / "set.json");
  EXPECT_EQ(again.recordings.size(), 2u);
  EXPECT_EQ(again.recordings[1].signals, d.recordings[1].signals);
  EXPECT_EQ(again.recordings[1].reference, d.recordings[1].reference);
  EXPECT_EQ(again.recordings[1].time_us, (std::vector<std::int64_t>{0, 10'000, 20'000}));
  ASSERT_EQ(again.robot.parameters.size(), 7u);
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_EQ(again.robot.parameters[i].name, d.robot.parameters[i].name);
    EXPECT_EQ(again.robot.parameters[i].nominal, d.robot.parameters[i].nominal);
    EXPECT_EQ(again.robot.parameters[i].lower, d.robot.parameters[i].lower);
  }
  EXPECT_EQ(again.robot.parameters[1].nominal, 0.15);
  EXPECT_EQ(again.robot.parameters[2].lower, again.robot.parameters[2].upper) << "the rollers' angle is held";
  EXPECT_EQ(again.notes, d.notes);
}

}  // namespace
}  // namespace odobench
