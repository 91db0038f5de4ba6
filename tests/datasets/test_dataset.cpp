// Data sets on disk: what is written is read back to the last bit, what is wrong is refused with its place,
// and a set that cannot be written leaves nothing behind.
#include "datasets/dataset.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <nlohmann/json.hpp>

#include "base/files.hpp"
#include "datasets/native/columns.hpp"
#include "datasets/robot_4wis4wid.hpp"
#include "tests/support/data/small_dataset.hpp"
#include "tests/support/data_error.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;
using testing::awkward_recording;
using testing::data_error;
using testing::everything_in;
using testing::says;
using testing::small_dataset;
using testing::TemporaryFolder;

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

void expect_same(const Dataset& a, const Dataset& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.description, b.description);
  EXPECT_EQ(a.robot.name, b.robot.name);
  EXPECT_EQ(a.robot.kinematics, b.robot.kinematics);
  ASSERT_EQ(a.robot.parameters.size(), b.robot.parameters.size());
  for (std::size_t i = 0; i < a.robot.parameters.size(); ++i) {
    const RobotParameter &p = a.robot.parameters[i], &q = b.robot.parameters[i];
    EXPECT_EQ(p.name + p.unit, q.name + q.unit);
    EXPECT_TRUE(same_bits({p.nominal, p.lower, p.upper}, {q.nominal, q.lower, q.upper})) << p.name;
  }
  ASSERT_EQ(a.trajectories.size(), b.trajectories.size());
  for (std::size_t i = 0; i < a.trajectories.size(); ++i) {
    EXPECT_EQ(a.trajectories[i].name, b.trajectories[i].name);
    EXPECT_EQ(a.trajectories[i].description, b.trajectories[i].description);
  }
  ASSERT_EQ(a.recordings.size(), b.recordings.size());
  for (std::size_t i = 0; i < a.recordings.size(); ++i) {
    const Recording &r = a.recordings[i], &s = b.recordings[i];
    EXPECT_EQ(r.id, s.id);
    EXPECT_EQ(r.trajectory, s.trajectory);
    EXPECT_EQ(r.repetition, s.repetition);
    EXPECT_EQ(r.time_us, s.time_us);
    std::vector<std::vector<double>> columns;
    for_each_value_column(
        r, 1, [&](const std::string&, const char*, const std::vector<double>& c) { columns.push_back(c); });
    std::size_t next = 0;
    for_each_value_column(s, 1, [&](const std::string& name, const char*, const std::vector<double>& c) {
      EXPECT_TRUE(same_bits(columns[next++], c)) << s.id << " " << name;
    });
  }
  ASSERT_EQ(a.known_parameters.size(), b.known_parameters.size());
  for (std::size_t i = 0; i < a.known_parameters.size(); ++i) {
    EXPECT_EQ(a.known_parameters[i].name, b.known_parameters[i].name);
    EXPECT_EQ(a.known_parameters[i].description, b.known_parameters[i].description);
    EXPECT_TRUE(same_bits(a.known_parameters[i].values, b.known_parameters[i].values));
  }
  EXPECT_EQ(a.provenance.source, b.provenance.source);
  EXPECT_EQ(a.provenance.licence, b.provenance.licence);
  EXPECT_EQ(a.provenance.made_by, b.provenance.made_by);
  ASSERT_EQ(a.provenance.files.size(), b.provenance.files.size());
  for (std::size_t i = 0; i < a.provenance.files.size(); ++i) {
    EXPECT_EQ(a.provenance.files[i].path, b.provenance.files[i].path);
    EXPECT_EQ(a.provenance.files[i].sha256, b.provenance.files[i].sha256);
  }
  EXPECT_EQ(a.notes, b.notes);
}

TEST(Dataset, FilesRoundTripBitForBit) {
  const TemporaryFolder folder;
  save_dataset(small_dataset(), folder / "set.json");
  expect_same(small_dataset(), load_dataset(folder / "set.json"));
  EXPECT_EQ(everything_in(folder.path()),
            (std::vector<std::string>{"ahead_1.rec", "back_2.rec", "set.json", "set_recordings"}));
}

TEST(Dataset, InlineRoundTripsBitForBit) {
  const TemporaryFolder folder;
  save_dataset(small_dataset(), folder / "set.json", true);
  expect_same(small_dataset(), load_dataset(folder / "set.json"));
  EXPECT_EQ(everything_in(folder.path()), (std::vector<std::string>{"set.json"}));
}

TEST(Dataset, LoadsAfterItsFolderMoved) {
  const TemporaryFolder folder;
  save_dataset(small_dataset(), folder / "here/set.json");
  fs::rename(folder / "here", folder / "there");
  expect_same(small_dataset(), load_dataset(folder / "there/set.json"));
}

TEST(Dataset, SameSetSameBytes) {
  const TemporaryFolder folder;
  save_dataset(small_dataset(), folder / "a/set.json");
  save_dataset(load_dataset(folder / "a/set.json"), folder / "b/set.json");
  for (const char* name : {"set.json", "set_recordings/ahead_1.rec", "set_recordings/back_2.rec"})
    EXPECT_EQ(read_file(folder / (std::string("a/") + name)), read_file(folder / (std::string("b/") + name)))
        << name;
}

TEST(Dataset, RecordingFileIsTheDocumentedOne) {
  const TemporaryFolder folder;
  save_dataset(small_dataset(), folder / "set.json");
  const std::string bytes = read_file(folder / "set_recordings/ahead_1.rec");
  const std::size_t header = bytes.find('\n') + 1;
  EXPECT_EQ(header % 64, 0u);
  const nlohmann::json parsed = nlohmann::json::parse(bytes.substr(0, header));
  EXPECT_EQ(parsed["format"], "odobench-recording");
  EXPECT_EQ(parsed["samples"], 5);
  ASSERT_EQ(parsed["columns"].size(), 12u);
  EXPECT_EQ(parsed["columns"][4]["name"], "steering_1");
  EXPECT_EQ(parsed["columns"][11]["unit"], "rad/s");
  EXPECT_EQ(bytes.size(), header + 12 * 5 * 8);
  // 9007199254740993 = 0x20000000000001, little-endian, is the second stamp.
  EXPECT_EQ(bytes.substr(header + 8, 8), std::string("\x01\x00\x00\x00\x00\x00\x20\x00", 8));
  // theta is the fourth column; its first value, 1.7976931348623157e308 = 0x7fefffffffffffff, ...
  const Recording r = small_dataset().recordings[0];
  double theta = 0;
  std::memcpy(&theta, bytes.data() + header + 3 * 5 * 8, 8);
  EXPECT_EQ(theta, r.reference.theta[0]);
}

TEST(Dataset, ASetWrittenByHandNeedsLittle) {
  const TemporaryFolder folder;
  std::string parameters, columns;
  for (const RobotParameter& p : robot_4wis4wid().parameters)
    parameters += (parameters.empty() ? "" : ",") + nlohmann::json{{"name", p.name},
                                                                   {"unit", p.unit},
                                                                   {"nominal", p.nominal},
                                                                   {"lower", p.lower},
                                                                   {"upper", p.upper}}
                                                        .dump();
  Recording names = recording_4wis4wid();
  for_each_value_column(
      names, 1, [&](const std::string& n, const char*, auto&) { columns += ", \"" + n + "\": [0, 1.5, 2]"; });
  const std::string set = R"({"schema": "odobench-dataset", "schema_version": 1, "name": "mine",
    "robot": {"name": "r", "kinematics": "4wis4wid", "parameters": [)" +
                          parameters + R"(]},
    "trajectories": [{"name": "t"}],
    "recordings": [{"id": "t1", "trajectory": "t", "repetition": 1, "columns": {"time_us": [0, 10, 25])" +
                          columns + "}}]}";
  const Dataset d = load_dataset(folder.file("set.json", set));
  ASSERT_EQ(d.recordings.size(), 1u);
  EXPECT_EQ(d.recordings[0].time_us, (std::vector<std::int64_t>{0, 10, 25}));
  EXPECT_EQ(wheel_speed_of(d.recordings[0], 3), (std::vector<double>{0, 1.5, 2}));
  EXPECT_TRUE(d.known_parameters.empty());
}

TEST(Dataset, TheDocumentedExampleLoads) {
  const std::string text = read_file(source_dir() / "docs/data_format.md");
  const std::size_t from = text.find("```json\n") + 8;
  const TemporaryFolder folder;
  const Dataset d = load_dataset(folder.file("set.json", text.substr(from, text.find("```", from) - from)));
  EXPECT_EQ(d.name, "garage");
  ASSERT_EQ(d.recordings.size(), 1u);
  EXPECT_EQ(d.recordings[0].reference.x[2], 0.02);
  EXPECT_EQ(d.known_parameters.at(0).values[9], 0.0502);
}

TEST(Dataset, SaveRefusesWhatLoadWouldRefuse) {
  const TemporaryFolder folder;
  const auto error = [&](const std::function<void(Dataset&)>& spoil) {
    Dataset d = small_dataset();
    spoil(d);
    return data_error([&] { save_dataset(d, folder / "set.json"); });
  };
  EXPECT_TRUE(says(error([](Dataset& d) { d.recordings[1].reference.x[1] = NAN; }),
                   {"/recordings/1 (back_2): x, sample 1: found nan"}));
  EXPECT_TRUE(says(error([](Dataset& d) { steering_of(d.recordings[0], 2).pop_back(); }),
                   {"steering_3", "found 4 values, expected 5"}));
  EXPECT_TRUE(says(error([](Dataset& d) { d.recordings[0] = awkward_recording("ahead", 1, 1); }),
                   {"found 1 samples"}));
  EXPECT_TRUE(says(error([](Dataset& d) { d.robot.parameters[4].upper = INFINITY; }),
                   {"/robot/parameters/4", "inf"}));
  EXPECT_TRUE(says(error([](Dataset& d) { d.known_parameters[0].values[3] = NAN; }),
                   {"/known_parameters/0/values/a4"}));
  EXPECT_TRUE(says(error([](Dataset& d) { d.known_parameters[0].values.pop_back(); }),
                   {"found 11 values, expected 12"}));
  EXPECT_TRUE(says(error([](Dataset& d) { d.name = "\xff"; }), {"set.json: cannot be written"}));
  EXPECT_TRUE(everything_in(folder.path()).empty());
}

TEST(Dataset, UnwritableTargetsLeaveNothingBehind) {
  const TemporaryFolder folder;
  folder.file("plain", "a file, not a folder");
  EXPECT_TRUE(says(data_error([&] { save_dataset(small_dataset(), folder / "plain/set.json"); }), {"plain"}));
  EXPECT_TRUE(says(data_error([&] { save_dataset(small_dataset(), "/proc/odobench/set.json"); }),
                   {"/proc/odobench", "cannot be"}));
  fs::create_directory(folder /
                       "set.json");  // in the way of the last rename, after all recordings were written
  EXPECT_TRUE(says(data_error([&] { save_dataset(small_dataset(), folder / "set.json"); }),
                   {"set.json: cannot be written"}));
  folder.file("other_recordings", "in the way of the folder");
  EXPECT_TRUE(
      says(data_error([&] { save_dataset(small_dataset(), folder / "other.json"); }), {"other_recordings"}));
  EXPECT_EQ(everything_in(folder.path()),
            (std::vector<std::string>{"other_recordings", "plain", "set.json"}));
}

TEST(Dataset, AFailedSaveKeepsTheOldSet) {
  const TemporaryFolder folder;
  save_dataset(small_dataset(), folder / "set.json");
  Dataset changed = small_dataset();
  changed.recordings[0].reference.x[0] = 17;
  changed.recordings[1].id = "third";
  fs::create_directory(folder / "set_recordings/third.rec");
  EXPECT_NE(data_error([&] { save_dataset(changed, folder / "set.json"); }), "");
  expect_same(small_dataset(), load_dataset(folder / "set.json"));
  fs::remove(folder / "set_recordings/third.rec");
  save_dataset(changed, folder / "set.json");
  expect_same(changed, load_dataset(folder / "set.json"));
}

}  // namespace
}  // namespace odobench
