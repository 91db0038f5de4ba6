#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "tests/support/logs.hpp"

namespace odobench {
namespace {

using testing::data_error;
using ::testing::ElementsAre;
using testing::open_log;
using testing::read_log;
using testing::request;
using testing::says;
using testing::sum_of;
using testing::TemporaryFolder;
using testing::usage_error;

constexpr double kPi = std::numbers::pi;

// Three poses on the ground: (1, 2) heading 0.1, (3, 4) heading 0.5, (5, 6) heading -2; z 0.25.
struct Pose {
  double x, y, heading;
};
const std::vector<Pose> kPoses{{1, 2, 0.1}, {3, 4, 0.5}, {5, 6, -2}};

std::string lines(const std::function<std::string(std::size_t, const Pose&)>& line) {
  std::string text;
  for (std::size_t k = 0; k < kPoses.size(); ++k) text += line(k, kPoses[k]) + "\n";
  return text;
}

std::string tum() {
  return "# timestamp tx ty tz qx qy qz qw\n" + lines([](std::size_t k, const Pose& p) {
           return fmt::format("1760000000.1{}3456789 {} {} 0.25 0 0 {:.12f} {:.12f}", k, p.x, p.y,
                              std::sin(p.heading / 2), std::cos(p.heading / 2));
         });
}

std::string euroc() {
  return "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z "
         "[],v_x\r\n" +
         lines([](std::size_t k, const Pose& p) {
           return fmt::format("17600000001{}3456789,{},{},0.25,{:.12f},0,0,{:.12f},7\r", k, p.x, p.y,
                              std::cos(p.heading / 2), std::sin(p.heading / 2));
         });
}

// Rows of [R|t]: about z, or as a camera sees it (x right, y down, z forward).
std::string kitti(bool camera) {
  return lines([&](std::size_t, const Pose& p) {
    const double c = std::cos(p.heading), s = std::sin(p.heading);
    if (camera)
      return fmt::format("{:.12f} 0 {:.12f} {} 0 1 0 -0.25 {:.12f} 0 {:.12f} {}", c, -s, -p.y, s, c, p.x);
    return fmt::format("{:.12f} {:.12f} 0 {} {:.12f} {:.12f} 0 {} 0 0 1 0.25", c, -s, p.x, s, c, p.y);
  });
}

void expect_poses(const LogTable& table) {
  ASSERT_EQ(table.values[0].size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(table.values[0][k], kPoses[k].x, 1e-9);
    EXPECT_NEAR(table.values[1][k], kPoses[k].y, 1e-9);
    EXPECT_NEAR(table.values[2][k], 0.25, 1e-9);
    EXPECT_NEAR(table.values[3][k], kPoses[k].heading, 1e-9);
  }
}

const LogRequest kPose = request("", {"x", "y", "z", "heading"});

TEST(Trajectories, Tum) {
  const TemporaryFolder folder;
  const std::string file = folder.file("a.txt", tum());
  const LogSource source = open_log(file)->sources(Stop())[0];
  EXPECT_EQ(source.type, "trajectory (TUM, plane xy)");
  EXPECT_EQ(source.rows, 3);
  EXPECT_EQ(source.fields.back().path, "heading");
  const LogTable table = read_log(file, kPose);
  EXPECT_THAT(table.time_ns, ElementsAre(1760000000103456789, 1760000000113456789, 1760000000123456789));
  expect_poses(table);
  EXPECT_NEAR(read_log(file, request("", {"qz"})).values[0][0], std::sin(0.05), 1e-9);
}

TEST(Trajectories, Euroc) {
  const TemporaryFolder folder;
  const std::string file = folder.file("a.csv", euroc());
  EXPECT_EQ(open_log(file)->sources(Stop())[0].type, "trajectory (EuRoC, plane xy)");
  const LogTable table = read_log(file, kPose);
  EXPECT_EQ(table.time_ns[0], 1760000000103456789);
  expect_poses(table);
  EXPECT_THAT(read_log(file, request("", {"v_x"})).values[0], ElementsAre(7, 7, 7));
}

TEST(Trajectories, KittiInBothPlanes) {
  const TemporaryFolder folder;
  folder.file("times.txt", "0.0\n1e-01\n0.2\n");
  for (const bool camera : {false, true}) {
    const std::string file = folder.file("00.txt", kitti(camera));
    EXPECT_EQ(open_log(file)->sources(Stop())[0].type,
              camera ? "trajectory (KITTI, plane xz)" : "trajectory (KITTI, plane xy)");
    const LogTable table = read_log(file, kPose);
    EXPECT_THAT(table.time_ns, ElementsAre(0, 100000000, 200000000));
    expect_poses(table);
  }
  LogOptions given;
  given.plane = "xz";
  expect_poses(read_log(folder.file("00.txt", kitti(true)), kPose, given));
  given.plane = "yx";
  EXPECT_TRUE(says(usage_error([&] { open_log(folder.path() / "00.txt", given); }), {"plane", "yx"}));
}

TEST(Trajectories, KittiNeedsTimes) {
  const TemporaryFolder folder;
  const std::string file = folder.file("poses.txt", kitti(false));
  EXPECT_TRUE(
      says(data_error([&] { open_log(file); }), {"poses.txt: found poses without times", "poses_times.txt"}));
  folder.file("poses_times.txt", "0.0\n0.1\n");
  EXPECT_TRUE(says(data_error([&] { read_log(file, kPose); }), {"poses.txt:3: found no time for this row"}));
  folder.file("poses_times.txt", "0.0\n0.1\n0.2\n0.3\n");
  EXPECT_TRUE(says(data_error([&] { read_log(file, kPose); }), {"found 3 rows, expected 4"}));
  folder.file("poses_times.txt", "0.0\nx\n0.2\n");
  EXPECT_TRUE(says(data_error([&] { read_log(file, kPose); }),
                   {"poses_times.txt:2: field 1 'time': 'x' is no time"}));
}

// y up: world x, y of the ground are z, x of the file.
std::string motive(const std::string& rotation, int bodies = 1) {
  const bool quaternion = rotation == "Quaternion";
  const std::vector<std::string> axes =
      quaternion ? std::vector<std::string>{"X", "Y", "Z", "W"} : std::vector<std::string>{"X", "Y", "Z"};
  std::string head =
      "Format Version,1.23,Take Name,a,Capture Frame Rate,100,Capture Start Time,2025-10-09 10.53.20 "
      "AM,Rotation Type," +
      rotation + ",Length Units,Millimeters\n\n";
  std::string type = ",Type", name = ",Name", id = ",ID", quantity = ",", axis = "Frame,Time (Seconds)";
  for (int b = 0; b < bodies; ++b) {
    for (std::size_t c = 0; c < axes.size() + 3; ++c) {
      type += ",Rigid Body";
      name += fmt::format(",robot{}", b);
      id += fmt::format(",{}", b);
      quantity += c < axes.size() ? ",Rotation" : ",Position";
      axis += "," + (c < axes.size() ? axes[c] : std::string(1, "XYZ"[c - axes.size()]));
    }
    type += ",Marker";
    name += ",m";
    id += ",9";
    quantity += ",Position";
    axis += ",X";
  }
  std::string text = head + type + "\n" + name + "\n" + id + "\n" + quantity + "\n" + axis + "\n";
  return text + lines([&](std::size_t k, const Pose& p) {
           std::string row = fmt::format("{},{:.6f}", k, 0.01 * static_cast<double>(k));
           for (int b = 0; b < bodies; ++b) {
             row += quaternion ? fmt::format(",0,{:.12f},0,{:.12f}", std::sin(p.heading / 2),
                                             std::cos(p.heading / 2))
                               : fmt::format(",0,{:.10f},0", p.heading * 180 / kPi);
             row += fmt::format(",{},250,{},", 1000 * p.y, 1000 * p.x);
           }
           return row;
         });
}

TEST(Trajectories, Motive) {
  const TemporaryFolder folder;
  for (const std::string rotation : {"Quaternion", "XYZ"}) {
    const std::string file = folder.file("take.csv", motive(rotation));
    EXPECT_EQ(open_log(file)->sources(Stop())[0].type, "trajectory (Motive, plane zx)");
    const LogTable table = read_log(file, kPose);
    EXPECT_THAT(table.time_ns, ElementsAre(0, 10000000, 20000000));
    EXPECT_THAT(table.notes, ElementsAre(::testing::HasSubstr("2025-10-09 10.53.20 AM")));
    // Beyond 90 degrees two angles of XYZ would change too: a pure turn about y keeps the others zero.
    expect_poses(table);
  }
  const std::vector<LogSource> sources =
      open_log(folder.file("two.csv", motive("Quaternion", 2)))->sources(Stop());
  ASSERT_EQ(sources.size(), 2u);
  EXPECT_EQ(sources[1].name, "robot1");
  EXPECT_TRUE(
      says(data_error([&] { open_log(folder.file("bad.csv", "Format Version,1.23\n\n,Type,Marker\n")); }),
           {"bad.csv: found no header of five lines"}));
}

TEST(Trajectories, OthersAreTables) {
  const TemporaryFolder folder;
  // Eight numbers, but no quaternion among them.
  EXPECT_EQ(
      open_log(folder.file("a.txt", "0.1 1 2 3 4 5 6 7\n0.2 1 2 3 4 5 6 7\n0.3 1 2 3 4 5 6 8\n"))->format(),
      "CSV");
  EXPECT_EQ(
      open_log(folder.file("b.txt", "1 2 3 4 5 6 7 8 9 10 11 12\n2 2 3 4 5 6 7 8 9 10 11 12\n"))->format(),
      "CSV");
}

TEST(Trajectories, DamagedCopies) {
  testing::expect_robust(tum(), "a.tum", 2000);
  testing::expect_robust(euroc(), "a.csv", 2000);
  testing::expect_robust(kitti(false), "a.txt", 500);
  testing::expect_robust(motive("XYZ"), "a.csv", 2000);
}

TEST(Trajectories, Samples) {
  ODOBENCH_NEEDS_LOGS();
  for (const char* name : {"mocap.tum", "mocap_euroc.csv", "mocap_kitti.txt"}) {
    const LogTable table = read_log(testing::log_samples() / name, request("", {"x", "y", "z", "heading"}));
    EXPECT_EQ(table.time_ns.size(), 1200u);
    EXPECT_NEAR(sum_of(table.values[0]), 2664.19922457505, 2664e-9);
    EXPECT_NEAR(sum_of(table.values[1]), 1117.6104194118107, 1117e-9);
    EXPECT_NEAR(sum_of(table.values[2]), 277.1999999999953, 277e-9);
    const bool kitti = std::string(name) == "mocap_kitti.txt";  // times since the first
    EXPECT_EQ(table.time_ns.front(), kitti ? 0 : 1760000000137171397);
    EXPECT_EQ(table.time_ns.back(), kitti ? 11989875580 : 1760000012127046980);
  }
  const LogTable tum = read_log(testing::log_samples() / "mocap.tum", request("", {"qz", "qw"}));
  EXPECT_NEAR(sum_of(tum.values[0]), 699.7939649461298, 700e-9);
  EXPECT_NEAR(sum_of(tum.values[1]), 894.3717483570341, 894e-9);
}

}  // namespace
}  // namespace odobench
