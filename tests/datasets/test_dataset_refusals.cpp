// What load_dataset() refuses, one edit of a good set each, and that it names the place.
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <limits>

#include "base/files.hpp"
#include "base/sha256.hpp"
#include "datasets/dataset.hpp"
#include "tests/support/data/small_dataset.hpp"
#include "tests/support/data_error.hpp"
#include "tests/support/run_process.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;
using testing::data_error;
using testing::replaced;
using testing::says;
using testing::small_dataset;
using testing::TemporaryFolder;

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
          {"overflow",
           "\"nominal\": 0.1125",
           "\"nominal\": 1e999",
           {"/nominal: found 1e999, expected a number within the range of a double"}},
          {"too large",
           "\"nominal\": 0.1125",
           "\"nominal\": 1e60",
           {"/nominal: found 1e+60, expected a number of at most 1e+50 in size"}},
          {"schema",
           "\"odobench-dataset\"",
           "\"other\"",
           {"/schema: found \"other\", expected \"odobench-dataset\""}},
          {"version",
           "\"schema_version\": 1",
           "\"schema_version\": 3",
           {"/schema_version", "version 3", "expected version 1 or 2"}},
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

TEST(Dataset, IdsNameFiles) {
  const auto error = [](const std::string& id) {
    const TemporaryFolder folder;
    Dataset d = small_dataset();
    d.recordings[0].id = id;
    return data_error([&] { save_dataset(d, folder / "set.json"); });
  };
  for (const char* id : {"a", "azAZ09", "_", "-", "a.", "a-b_c.d"}) EXPECT_EQ(error(id), "") << id;
  for (const char* id : {".a", "a/b", "a:b", "a@", "a[", "a`", "a{", "a b", "\u010d", "a,b", "a^b"})
    EXPECT_TRUE(
        says(error(id), {"set.json: /recordings/0/id: found \"" + std::string(id) + "\", expected letters"}))
        << id;
  EXPECT_TRUE(says(error(""), {"/recordings/0/id: found an empty text"}));
}

TEST(Dataset, BoundsMayMeetTheNominalValue) {
  const auto error = [](double lower, double nominal, double upper) {
    const TemporaryFolder folder;
    Dataset d = small_dataset();
    RobotParameter& p = d.robot.parameters[11];
    p.lower = lower, p.nominal = nominal, p.upper = upper;
    return data_error([&] { save_dataset(d, folder / "set.json"); });
  };
  EXPECT_EQ(error(1, 1, 1), "");
  EXPECT_EQ(error(1, 1, 2), "");
  EXPECT_EQ(error(1, 2, 2), "");
  EXPECT_TRUE(says(error(1, 2.5, 2), {"/robot/parameters/11: found nominal 2.5 of r4 outside [1, 2]"}));
  EXPECT_TRUE(says(error(1, 0.5, 2), {"/robot/parameters/11: found nominal 0.5 of r4 outside [1, 2]"}));
  EXPECT_TRUE(says(error(2, 2, 1), {"/robot/parameters/11: found lower 2 > upper 1 of r4"}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::array<double, 3>& p : {std::array{nan, 1.0, 2.0}, {1.0, nan, 2.0}, {1.0, 1.0, nan}})
    EXPECT_TRUE(
        says(error(p[0], p[1], p[2]), {"/robot/parameters/11: found lower ", "expected finite numbers"}));
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
          {"NaN",
           "\"theta\": [",
           "\"theta\": [NaN, ",
           {"/columns/theta/0: found NaN, expected a finite number"}},
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

}  // namespace
}  // namespace odobench
