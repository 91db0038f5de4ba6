// Data sets on disk: what is written is read back to the last bit, what is wrong is refused with its place,
// and a set that cannot be written leaves nothing behind.
#include "datasets/dataset.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>

#include "datasets/columns.hpp"
#include "datasets/file_io.hpp"
#include "datasets/json_node.hpp"
#include "datasets/robot_4wis4wid.hpp"
#include "datasets/sha256.hpp"
#include "tests/support/data_error.hpp"
#include "tests/support/run_process.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;
using testing::data_error;
using testing::replaced;
using testing::says;
using testing::TemporaryFolder;

// Values whose last bits a careless format would lose.
Recording awkward_recording(const std::string& trajectory, int repetition, std::size_t samples) {
  Recording r;
  r.id = trajectory + "_" + std::to_string(repetition);
  r.trajectory = trajectory;
  r.repetition = repetition;
  const double values[] = {0.1, -0.0, 1.0 / 3.0, 5e-324, -1.7976931348623157e308, 2.2250738585072014e-308,
                           3,   1e22};
  std::size_t next = static_cast<std::size_t>(repetition);
  for (std::size_t k = 0; k < samples; ++k)
    r.time_us.push_back(static_cast<std::int64_t>(k * k) * 9'007'199'254'740'993);
  for_each_value_column(r, [&](const std::string&, const char*, std::vector<double>& column) {
    for (std::size_t k = 0; k < samples; ++k) column.push_back(values[next++ % 8]);
  });
  return r;
}

Dataset small_dataset() {
  Dataset d;
  d.name = "small";
  d.description = "two \"quoted\" drives, \u010d";
  d.robot = robot_4wis4wid();
  d.trajectories = {{"ahead", "ahead"}, {"back", ""}};
  d.recordings = {awkward_recording("ahead", 1, 5), awkward_recording("back", 2, 2)};
  d.known_parameters = {{"truth", "known", std::vector<double>(12, 1.0 / 3.0)}};
  d.provenance = {"somewhere", "MIT", "by hand", {{"raw.csv", sha256("raw")}}};
  d.notes = {"1 stamp moved"};
  return d;
}

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
        r, [&](const std::string&, const char*, const std::vector<double>& c) { columns.push_back(c); });
    std::size_t next = 0;
    for_each_value_column(s, [&](const std::string& name, const char*, const std::vector<double>& c) {
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

std::vector<std::string> everything_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
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
  EXPECT_EQ(theta, r.theta[0]);
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
  Recording names;
  for_each_value_column(
      names, [&](const std::string& n, const char*, auto&) { columns += ", \"" + n + "\": [0, 1.5, 2]"; });
  const std::string set = R"({"schema": "odobench-dataset", "schema_version": 1, "name": "mine",
    "robot": {"name": "r", "kinematics": "4wis4wid", "parameters": [)" +
                          parameters + R"(]},
    "trajectories": [{"name": "t"}],
    "recordings": [{"id": "t1", "trajectory": "t", "repetition": 1, "columns": {"time_us": [0, 10, 25])" +
                          columns + "}}]}";
  const Dataset d = load_dataset(folder.file("set.json", set));
  ASSERT_EQ(d.recordings.size(), 1u);
  EXPECT_EQ(d.recordings[0].time_us, (std::vector<std::int64_t>{0, 10, 25}));
  EXPECT_EQ(d.recordings[0].wheel_speed[3], (std::vector<double>{0, 1.5, 2}));
  EXPECT_TRUE(d.known_parameters.empty());
}

// One edit of a good set.json each, and what the refusal must say beside the file's name.
struct BadSet {
  const char *name, *from, *to;
  std::vector<std::string> says;
};

void expect_refused(const std::vector<BadSet>& cases, bool inline_recordings) {
  const TemporaryFolder folder;
  save_dataset(small_dataset(), folder / "set.json", inline_recordings);
  const std::string good = read_file(folder / "set.json");
  for (const BadSet& bad : cases) {
    const std::string file = folder.file("set.json", replaced(good, bad.from, bad.to));
    std::vector<std::string> parts = bad.says;
    parts.push_back(file);
    EXPECT_TRUE(says(data_error([&] { load_dataset(file); }), parts)) << bad.name;
  }
}

TEST(Dataset, RefusesABadSetJson) {
  const char* robot = R"("name": "a1", "unit": "m", "nominal": 0.1125, "lower": 0.106875)";
  expect_refused(
      {
          {"broken", "\"robot\": {", "\"robot\" {", {":6: broken JSON", "expected ':'"}},
          {"cut off", "\"recordings\": [", "\"recordings\": [\x01", {"broken JSON"}},
          {"overflow", "\"nominal\": 0.1125", "\"nominal\": 1e999", {"broken JSON", "1e999"}},
          {"schema",
           "\"odobench-dataset\"",
           "\"other\"",
           {"/schema: found \"other\", expected \"odobench-dataset\""}},
          {"version",
           "\"schema_version\": 1",
           "\"schema_version\": 2",
           {"/schema_version", "version 2", "expected version 1"}},
          {"unknown key", "\"notes\": [", "\"noets\": [", {"unknown key \"noets\"", "notes"}},
          {"missing key", "\"name\": \"small\",", "", {"no key \"name\""}},
          {"double key", "\"notes\": [", "\"name\": \"x\", \"notes\": [", {"\"name\" twice"}},
          {"type", "\"name\": \"small\"", "\"name\": 7", {"/name: found 7, expected a text"}},
          {"empty name", "\"name\": \"small\"", "\"name\": \"\"", {"/name: found an empty text"}},
          {"array",
           "\"notes\": [\"1 stamp moved\"]",
           "\"notes\": \"none\"",
           {"/notes: found \"none\", expected an array"}},
          {"number",
           "\"nominal\": 0.1125",
           "\"nominal\": \"0.1125\"",
           {"/robot/parameters/0/nominal", "expected a number"}},
          {"kinematics",
           "\"kinematics\": \"4wis4wid\"",
           "\"kinematics\": \"ackermann\"",
           {"/robot/kinematics", "\"4wis4wid\""}},
          {"bounds",
           robot,
           R"("name": "a1", "unit": "m", "nominal": 0.1125, "lower": 0.2)",
           {"/robot/parameters/0", "lower 0.2 > upper"}},
          {"nominal",
           robot,
           R"("name": "a1", "unit": "m", "nominal": 0.5, "lower": 0.106875)",
           {"nominal 0.5 of a1 outside"}},
          {"parameter",
           robot,
           R"("name": "a9", "unit": "m", "nominal": 0.1125, "lower": 0.106875)",
           {"found \"a9\", expected \"a1\""}},
          {"unit",
           robot,
           R"("name": "a1", "unit": "mm", "nominal": 0.1125, "lower": 0.106875)",
           {"found \"mm\", expected \"m\""}},
          {"trajectory",
           "\"trajectory\": \"back\"",
           "\"trajectory\": \"up\"",
           {"/recordings/1/trajectory: found \"up\""}},
          {"trajectory twice",
           "{\"name\": \"back\"",
           "{\"name\": \"ahead\"",
           {"/trajectories/1/name", "second time"}},
          {"id twice", "\"id\": \"back_2\"", "\"id\": \"ahead_1\"", {"/recordings/1/id", "second time"}},
          {"id", "\"id\": \"back_2\"", "\"id\": \"../back\"", {"/recordings/1/id: found \"../back\""}},
          {"repetition", "\"repetition\": 2", "\"repetition\": 0", {"/recordings/1/repetition: found 0"}},
          {"repetition type",
           "\"repetition\": 2",
           "\"repetition\": 2.0",
           {"/recordings/1/repetition: found 2.0, expected an integer"}},
          {"repetition twice",
           "\"trajectory\": \"back\", \"repetition\": 2",
           "\"trajectory\": \"ahead\", \"repetition\": 1",
           {"/recordings/1/repetition", "second time"}},
          {"known value",
           "\"a1\": 0.333",
           "\"c1\": 0.333",
           {"/known_parameters/0/values: found unknown key \"c1\""}},
          {"sum", "\"sha256\": \"", "\"sha256\": \"X", {"/provenance/files/0/sha256", "64"}},
          {"samples",
           "\"samples\": 5",
           "\"samples\": 1",
           {"/recordings/0/samples: found 1 samples, expected at least 2"}},
          {"file outside",
           "\"file\": \"set_recordings",
           "\"file\": \"../set_recordings",
           {"/recordings/0/file", "below the folder"}},
          {"no data",
           "\"file\": \"set_recordings/ahead_1.rec\", ",
           "",
           {"/recordings/0", "neither \"file\" nor \"columns\""}},
      },
      false);
}

TEST(Dataset, RefusesBadInlineColumns) {
  expect_refused(
      {
          {"no start at 0",
           "\"time_us\": [0",
           "\"time_us\": [1",
           {"/recordings/0/columns/time_us/0", "expected 0"}},
          {"backwards",
           "\"time_us\": [0, 9007199254740993",
           "\"time_us\": [0, -7",
           {"/recordings/0/columns/time_us/1", "-7 us"}},
          {"duplicate",
           "\"time_us\": [0, 9007199254740993",
           "\"time_us\": [0, 0",
           {"time_us/1", "later stamp"}},
          {"one sample",
           "\"time_us\": [0, 9007199254740993]",
           "\"time_us\": [0]",
           {"/recordings/1/columns/time_us", "1 samples"}},
          {"fraction",
           "\"time_us\": [0, ",
           "\"time_us\": [0, 1.5, ",
           {"time_us/1: found 1.5, expected an integer"}},
          {"above 64 bits",
           "\"time_us\": [0, ",
           "\"time_us\": [0, 18446744073709551615, ",
           {"time_us/1", "expected an integer"}},
          {"NaN", "\"theta\": [", "\"theta\": [NaN, ", {"broken JSON"}},
          {"null",
           "\"theta\": [",
           "\"theta\": [null, ",
           {"/recordings/0/columns/theta/0: found null, expected a number"}},
          {"length",
           "\"theta\": [",
           "\"theta\": [1, ",
           {"/recordings/0/columns/theta", "found 6 values, expected 5"}},
          {"column", "\"theta\": [", "\"phi\": [", {"/recordings/0/columns: found no key \"theta\""}},
          {"extra column", "\"theta\": [", "\"phi\": [], \"theta\": [", {"unknown key \"phi\""}},
          {"samples", "\"samples\": 5", "\"samples\": 4", {"/recordings/0/samples: found 4, expected 5"}},
          {"no array",
           "\"theta\": [",
           "\"theta\": 3, \"z\": [",
           {"theta: found 3, expected an array of numbers"}},
      },
      true);
}

TEST(Dataset, RefusesAMissingOrUnreadableFile) {
  const TemporaryFolder folder;
  EXPECT_TRUE(says(data_error([&] { load_dataset(folder / "set.json"); }),
                   {"set.json: cannot be read", "No such file"}));
  EXPECT_TRUE(
      says(data_error([&] { load_dataset(folder.path()); }), {folder.path().string(), "cannot be read"}));
  save_dataset(small_dataset(), folder / "set.json");
  fs::remove(folder / "set_recordings/back_2.rec");
  EXPECT_TRUE(says(data_error([&] { load_dataset(folder / "set.json"); }),
                   {"back_2.rec: cannot be read", "No such file"}));
}

TEST(Dataset, RefusesEmptySets) {
  const TemporaryFolder folder;
  EXPECT_TRUE(
      says(data_error([&] { load_dataset(folder.file("set.json", "")); }), {"set.json:1: broken JSON"}));
  EXPECT_TRUE(says(data_error([&] { load_dataset(folder.file("set.json", "[]")); }),
                   {"set.json: /", "expected an object"}));
  Dataset d = small_dataset();
  d.recordings.clear();
  EXPECT_TRUE(says(data_error([&] { save_dataset(d, folder / "new.json"); }), {"/recordings: found none"}));
}

// The first recording with other bytes; with a right sum where the bytes themselves are to be looked at.
std::string error_of_bytes(const std::function<std::string(std::string)>& edit, bool right_sum = true) {
  const TemporaryFolder folder;
  save_dataset(small_dataset(), folder / "set.json");
  const fs::path file = folder / "set_recordings/ahead_1.rec";
  const std::string good = read_file(file), bad = edit(good);
  write_file(file, bad);
  if (right_sum)
    write_file(folder / "set.json", replaced(read_file(folder / "set.json"), sha256(good), sha256(bad)));
  return data_error([&] { load_dataset(folder / "set.json"); });
}

// Overwrites eight bytes: entry `sample` of column `column`.
template <class T>
auto with_entry(std::size_t column, std::size_t sample, T value) {
  return [=](std::string bytes) {
    const std::size_t at = bytes.find('\n') + 1 + 8 * (5 * column + sample);
    std::memcpy(bytes.data() + at, &value, 8);
    return bytes;
  };
}

TEST(Dataset, RefusesABadRecordingFile) {
  const auto header = [](const char* from, const char* to) {
    return [=](const std::string& bytes) { return replaced(bytes, from, to); };
  };
  const auto cut = [](std::size_t n) {
    return [=](const std::string& bytes) { return bytes.substr(0, bytes.size() - n); };
  };
  EXPECT_TRUE(says(error_of_bytes(cut(1), false),
                   {"ahead_1.rec: byte ", "end of the file", "expected 5 samples of 96 bytes"}));
  EXPECT_TRUE(says(error_of_bytes(cut(96), false), {"end of the file after 384 bytes"}));
  EXPECT_TRUE(says(error_of_bytes([](const std::string&) { return std::string(); }, false),
                   {"byte 0", "header line"}));
  EXPECT_TRUE(says(error_of_bytes([](const std::string& b) { return b + "x"; }),
                   {"end of the file after 481 bytes"}));
  EXPECT_TRUE(
      says(error_of_bytes(with_entry(1, 0, 1.0), false), {"ahead_1.rec: found SHA-256", "as in the set"}));
  EXPECT_TRUE(says(error_of_bytes(header("\"version\": 1", "\"version\": 9")),
                   {"/version: found version 9, expected version 1"}));
  EXPECT_TRUE(says(error_of_bytes(header("odobench-recording", "odobench-recordinx")), {"/format"}));
  EXPECT_TRUE(
      says(error_of_bytes(header("ahead_1", "ahead_2")), {"/id: found \"ahead_2\", expected \"ahead_1\""}));
  EXPECT_TRUE(says(error_of_bytes(header("\"samples\": 5", "\"samples\": 6")),
                   {"found 6 samples, expected 5 as in the set"}));
  EXPECT_TRUE(says(error_of_bytes(header("theta", "delta")),
                   {"/columns/3/name: found \"delta\", expected \"theta\""}));
  EXPECT_TRUE(says(error_of_bytes(header("rad/s", "deg/s")), {"/columns/8/unit", "\"deg/s\""}));
  EXPECT_TRUE(says(error_of_bytes(header("{\"format\"", "xxxxxxxxx")), {"ahead_1.rec:1: broken JSON"}));
}

TEST(Dataset, RefusesBadValuesInARecordingFile) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(says(error_of_bytes(with_entry(3, 2, nan)), {"(theta, sample 2): found nan", "finite"}));
  EXPECT_TRUE(says(error_of_bytes(with_entry(11, 4, -inf)), {"(wheel_speed_4, sample 4): found -inf"}));
  EXPECT_TRUE(says(error_of_bytes(with_entry(0, 0, std::int64_t{5})),
                   {"(time_us, sample 0)", "first stamp of 5 us"}));
  EXPECT_TRUE(says(error_of_bytes(with_entry(0, 1, std::int64_t{0})),
                   {"(time_us, sample 1): found 0 us after 0 us"}));
  EXPECT_TRUE(says(error_of_bytes(with_entry(0, 3, std::int64_t{-1})), {"(time_us, sample 3): found -1 us"}));
  // The byte named is the byte changed.
  const TemporaryFolder folder;
  save_dataset(small_dataset(), folder / "set.json");
  const std::size_t start = read_file(folder / "set_recordings/ahead_1.rec").find('\n') + 1;
  EXPECT_TRUE(
      says(error_of_bytes(with_entry(3, 2, nan)), {"byte " + std::to_string(start + 8 * (5 * 3 + 2)) + " "}));
}

TEST(Dataset, SaveRefusesWhatLoadWouldRefuse) {
  const TemporaryFolder folder;
  const auto error = [&](const std::function<void(Dataset&)>& spoil) {
    Dataset d = small_dataset();
    spoil(d);
    return data_error([&] { save_dataset(d, folder / "set.json"); });
  };
  EXPECT_TRUE(says(error([](Dataset& d) { d.recordings[1].x[1] = NAN; }),
                   {"/recordings/1 (back_2): x, sample 1: found nan"}));
  EXPECT_TRUE(says(error([](Dataset& d) { d.recordings[0].steering[2].pop_back(); }),
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
  changed.recordings[0].x[0] = 17;
  changed.recordings[1].id = "third";
  fs::create_directory(folder / "set_recordings/third.rec");
  EXPECT_NE(data_error([&] { save_dataset(changed, folder / "set.json"); }), "");
  expect_same(small_dataset(), load_dataset(folder / "set.json"));
  fs::remove(folder / "set_recordings/third.rec");
  save_dataset(changed, folder / "set.json");
  expect_same(changed, load_dataset(folder / "set.json"));
}

TEST(FileIo, WritesWholeFilesAndCreatesFolders) {
  const TemporaryFolder folder;
  const std::string bytes("a\0b\r\n", 5);
  write_file(folder / "deep/er/file", bytes);
  EXPECT_EQ(read_file(folder / "deep/er/file"), bytes);
  write_file(folder / "deep/er/file", "");
  EXPECT_EQ(read_file(folder / "deep/er/file"), "");
  EXPECT_EQ(everything_in(folder.path()), (std::vector<std::string>{"deep", "er", "file"}));
  EXPECT_GT(read_file("/proc/self/status").size(), 100u);  // states a size of 0
}

TEST(FileIo, AnAbandonedTransactionLeavesNothing) {
  const TemporaryFolder folder;
  {
    FileTransaction files;
    files.add(folder / "a/one", "1");
    files.add(folder / "two", "2");
    EXPECT_FALSE(fs::exists(folder / "a/one"));
  }
  EXPECT_TRUE(everything_in(folder.path()).empty());
}

TEST(Sha256, StandardVectors) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  const TemporaryFolder folder;
  EXPECT_EQ(sha256_of_file(folder.file("abc", "abc")), sha256("abc"));
  EXPECT_FALSE(is_sha256(std::string(63, 'a')));
  EXPECT_FALSE(is_sha256(std::string(64, 'A')));
  EXPECT_TRUE(is_sha256(std::string(64, 'a')));
}

TEST(DataErrorMatchers, CanFail) {
  EXPECT_FALSE(says("", {}));
  EXPECT_FALSE(says("two\nlines", {}));
  EXPECT_FALSE(says("one line", {"two"}));
  EXPECT_TRUE(says("one line", {"one", "line"}));
}

}  // namespace
}  // namespace odobench
