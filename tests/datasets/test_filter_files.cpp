// Readers of the relative-entropy filter's files: what they accept, what each number becomes, what they
// refuse.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <numbers>
#include <thread>

#include "datasets/entropy/entropy_window_file.hpp"
#include "datasets/entropy/filter_run.hpp"
#include "datasets/entropy/filter_truth.hpp"
#include "tests/support/data/filter_run_files.hpp"
#include "tests/support/data_error.hpp"
#include "tests/support/run_process.hpp"

namespace odobench {
namespace {

using testing::data_error;
using testing::plain_run;
using testing::replaced;
using testing::says;
using testing::TemporaryFolder;

constexpr double kDegrees = 180 / std::numbers::pi;

TEST(CsvStream, ReadsAcrossPieces) {
  const TemporaryFolder folder;
  std::string text = "\xEF\xBB\xBFindex,filling\r\n";
  const int rows = 30000;  // several pieces of 64 KiB, cut at every place of a row
  for (int i = 0; i < rows; ++i)
    text += fmt::format("{},{}\r\n", i, std::string(static_cast<std::size_t>(i % 23), 'x'));
  CsvStream stream(folder.file("a.csv", text + "\n\r\n"), ',');
  const std::size_t index = stream.column("index"), filling = stream.column("filling");
  int i = 0;
  for (; stream.next(); ++i) {
    ASSERT_EQ(stream.number(index), i);
    ASSERT_EQ(stream.field(filling).size(), static_cast<std::size_t>(i % 23));
    ASSERT_EQ(stream.line(), static_cast<std::size_t>(i) + 2);
  }
  EXPECT_EQ(i, rows);
  EXPECT_FALSE(stream.interrupted());
}

TEST(CsvStream, Refuses) {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& text) {
    return data_error([&] {
      CsvStream stream(folder.file("a.csv", text), ',');
      while (stream.next()) stream.number(0);
    });
  };
  EXPECT_TRUE(says(error(""), {"a.csv:1: found an empty file, expected a header line"}));
  EXPECT_TRUE(says(error("\n\n"), {"a.csv:1: found an empty file"}));
  EXPECT_TRUE(says(error("a,b\n1,2\n3"), {"a.csv:3: found the end of the file inside the line"}));
  EXPECT_TRUE(says(error("a,b\n1,2\n3\n"), {"a.csv:3: found 1 fields, expected 2"}));
  EXPECT_TRUE(says(error("a,b\n1,2\n\n3,4\n"), {"a.csv:3: found 1 fields, expected 2"}));
  EXPECT_TRUE(says(error("a\n1\n" + std::string(3 << 20, '7')), {"a.csv:3: found a line longer than"}));
  EXPECT_TRUE(says(data_error([&] { CsvStream((folder / "none.csv").string(), ','); }),
                   {"none.csv", "cannot be read"}));
  EXPECT_TRUE(says(data_error([&] { CsvStream(folder.path(), ','); }), {"cannot be read"}));
}

TEST(CsvStream, AnInterruptionEndsIt) {
  const TemporaryFolder folder;
  std::atomic<bool> interrupt{false};
  CsvStream stream(folder.file("a.csv", "a\n1\n2\n"), ',', &interrupt);
  EXPECT_TRUE(stream.next());
  interrupt = true;
  EXPECT_FALSE(stream.next());
  EXPECT_TRUE(stream.interrupted());
}

// Standard input replaced by a pipe, until the end of the object.
class PipedInput {
 public:
  PipedInput() : before_(::dup(0)) {
    int ends[2];
    if (::pipe(ends) != 0) ADD_FAILURE() << "no pipe";
    ::dup2(ends[0], 0);
    ::close(ends[0]);
    write_end_ = ends[1];
  }
  ~PipedInput() {
    close();
    ::dup2(before_, 0);
    ::close(before_);
  }
  void write(const std::string& text) const {
    EXPECT_EQ(::write(write_end_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  void close() {
    if (write_end_ >= 0) ::close(write_end_);
    write_end_ = -1;
  }

 private:
  int before_, write_end_ = -1;
};

TEST(CsvStream, ReadsStandardInputAsItComes) {
  PipedInput input;
  input.write("a,b\n1,2\n3");
  std::atomic<bool> interrupt{false};
  CsvStream stream("-", ',', &interrupt);
  ASSERT_TRUE(stream.next());
  EXPECT_EQ(stream.number(1), 2);
  std::thread more([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    input.write(",4\n5\n");
  });
  ASSERT_TRUE(stream.next());
  more.join();
  EXPECT_EQ(stream.number(0), 3);
  EXPECT_EQ(stream.number(1), 4);
  EXPECT_EQ(data_error([&] { stream.next(); }),
            "standard input:4: found 1 fields, expected 2 as in the header");
  input.close();
  EXPECT_FALSE(stream.next());
  EXPECT_FALSE(stream.interrupted());
}

TEST(CsvStream, AnInterruptionEndsTheWaitForStandardInput) {
  PipedInput input;
  input.write("a\n1\n");
  std::atomic<bool> interrupt{false};
  CsvStream stream("-", ',', &interrupt);
  ASSERT_TRUE(stream.next());
  std::thread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    interrupt = true;
  });
  EXPECT_FALSE(stream.next());
  EXPECT_TRUE(stream.interrupted());
  later.join();
  const CsvStream without_header("-", ',', &interrupt);
  EXPECT_TRUE(without_header.interrupted());
  EXPECT_TRUE(without_header.names().empty());
}

TEST(CsvStream, LinesUpToTheLongest) {
  const TemporaryFolder folder;
  const auto field_of = [&](std::size_t length) {
    CsvStream stream(folder.file("a.csv", "a\n1\n" + std::string(length, 'x') + "\ny\n"), ',');
    std::size_t longest = 0;
    while (stream.next()) longest = std::max(longest, stream.field(0).size());
    EXPECT_EQ(stream.line(), 4u);
    EXPECT_EQ(stream.field(0), "y");
    return longest;
  };
  for (const std::size_t length : {std::size_t{65535}, std::size_t{65536}, TextLines::kLongestLine})
    EXPECT_EQ(field_of(length), length);
  EXPECT_EQ(
      data_error([&] { field_of(TextLines::kLongestLine + (1 << 17)); }),
      (folder / "a.csv").string() + ":3: found a line longer than 1048576 bytes, expected rows of numbers");
}

TEST(CsvStream, LinesBehindBlankOnes) {
  const TemporaryFolder folder;
  const std::string blank = std::string(200000, '\n');  // more than a piece
  CsvStream at_the_end(folder.file("a.csv", "a\r\n1\r\n" + blank + "\r\n"), ',');
  EXPECT_TRUE(at_the_end.next());
  EXPECT_FALSE(at_the_end.next());
  // One column: the blank line is a row with one empty field.
  CsvStream between(folder.file("b.csv", "a\n1\n\n2"), ',');
  EXPECT_TRUE(between.next());
  EXPECT_TRUE(between.next());
  EXPECT_EQ(between.line(), 3u);
  EXPECT_EQ(between.field(0), "");
  EXPECT_TRUE(between.next());
  EXPECT_EQ(between.line(), 4u);
  EXPECT_EQ(between.number(0), 2);
  EXPECT_TRUE(between.unfinished());
  EXPECT_FALSE(between.next());
}

std::vector<FilterRow> read_all(FilterRunReader& reader) {
  std::vector<FilterRow> rows;
  for (FilterRow row; reader.next(row);) rows.push_back(row);
  return rows;
}

std::vector<FilterRow> read_run(const std::string& text, const FilterRunOptions& options = {}) {
  const TemporaryFolder folder;
  FilterRunReader reader(folder.file("run.csv", text), options);
  return read_all(reader);
}

TEST(FilterRun, NamedColumnsInAnyOrderWithOthersBetween) {
  const std::vector<FilterRow> rows = read_run(
      "comment,enc4_m,enc3_m,enc2_m,enc1_m,yaw_step_deg,ay_m_s2,ax_m_s2,time_s,psi4_deg,psi3_deg,psi2_deg,"
      "psi1_deg\n"
      "x,4,3,2,1,0.5,20,+1e1,7.5,90,45,-30,0\n"
      "y,4,3,2,1,0.6,20,10,8.0,90,45,-30,0\n");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].wheel, (std::array<double, 4>{1, 2, 3, 4}));
  EXPECT_EQ(rows[0].ax, 10);
  EXPECT_EQ(rows[0].ay, 20);
  EXPECT_EQ(rows[0].rotation_deg, 0.5);
  EXPECT_EQ(rows[1].time_s, 8.0);
  EXPECT_DOUBLE_EQ(rows[0].steering[3], std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ(rows[0].steering[1], -std::numbers::pi / 6);
}

struct RotationCase {
  const char* column;
  double factor;  // degrees per step of dt = 0.5 s for a 1 in the file
};

TEST(FilterRun, EveryRotationUnit) {
  for (const RotationCase c :
       {RotationCase{"yaw_step_deg", 1}, RotationCase{"yaw_step_rad", kDegrees},
        RotationCase{"yaw_rate_deg_s", 0.5}, RotationCase{"yaw_rate_rad_s", 0.5 * kDegrees}}) {
    const std::string head = fmt::format("time_s,enc1_m,enc2_m,enc3_m,enc4_m,ax_m_s2,ay_m_s2,{}\n", c.column);
    const std::vector<FilterRow> rows =
        read_run(head + "0,0,0,0,0,0,0,1\n0.5,0,0,0,0,0,0,-2\n1,0,0,0,0,0,0,0\n");
    ASSERT_EQ(rows.size(), 3u) << c.column;
    EXPECT_DOUBLE_EQ(rows[0].rotation_deg, c.factor) << c.column;
    EXPECT_DOUBLE_EQ(rows[1].rotation_deg, -2 * c.factor) << c.column;
  }
}

TEST(FilterRun, HeadingsAreDifferencedAcrossTheJump) {
  const TemporaryFolder folder;
  const std::string head = "enc1_m,enc2_m,enc3_m,enc4_m,ax_m_s2,ay_m_s2,";
  FilterRunOptions options;
  options.dt = 0.1;
  FilterRunReader degrees(
      folder.file("a.csv", head + "yaw_deg\n1,1,1,1,0,0,170\n2,2,2,2,0,0,-175\n3,3,3,3,0,0,-185\n"), options);
  EXPECT_EQ(degrees.passed_over(), 1);
  std::vector<FilterRow> rows = read_all(degrees);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].wheel[0], 2);
  EXPECT_NEAR(rows[0].rotation_deg, 15, 1e-12);
  EXPECT_NEAR(rows[1].rotation_deg, -10, 1e-12);
  EXPECT_FALSE(degrees.has_time());

  FilterRunReader radians(folder.file("b.csv", head + "yaw_rad\n1,1,1,1,0,0,3.1\n2,2,2,2,0,0,-3.1\n"),
                          options);
  rows = read_all(radians);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_NEAR(rows[0].rotation_deg, (2 * std::numbers::pi - 6.2) * kDegrees, 1e-12);

  options.rotation_as_it_stands = true;
  FilterRunReader raw(folder.path() / "b.csv", options);
  rows = read_all(raw);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[1].rotation_deg, -3.1);
}

TEST(FilterRun, TheThesisLayout) {
  const std::string text =
      "Laikas,enc1,enc2,enc3,enc4,ax,ay,,theta\n0.0,1,2,3,4,5,6,,0.5\n0.2,1,2,3,4,5,6,,0.25\n";
  std::vector<FilterRow> rows = read_run(text);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[1].time_s, 0.2);
  EXPECT_EQ(rows[1].rotation_deg, 0.25);
  FilterRunOptions options;
  options.theta = "yaw_rate_rad_s";
  EXPECT_DOUBLE_EQ(read_run(text, options)[0].rotation_deg, 0.5 * 0.2 * kDegrees);
  options.theta = "yaw_deg";
  rows = read_run(text, options);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].rotation_deg, -0.25);
  options = {};
  options.use_laikas = false;
  options.dt = 0.1;
  EXPECT_EQ(read_run(text, options).size(), 2u);  // what Laikas says is not looked at
}

TEST(FilterRun, MappedColumnsWin) {
  FilterRunOptions options;
  options.columns = {{"time_s", "t"}, {"enc1_m", "other"}, {"yaw_rad", "psi"}, {"ax_m_s2", "a b"}};
  const std::string text =
      "t,enc1_m,other,enc2_m,enc3_m,enc4_m,a b,ay_m_s2,psi,yaw_step_deg\n"
      "0,1,9,2,3,4,5,6,0.1,7\n1,1,9,2,3,4,5,6,0.3,7\n";
  const std::vector<FilterRow> rows = read_run(text, options);
  ASSERT_EQ(rows.size(), 1u);  // a heading, although a rotation per step is there too
  EXPECT_EQ(rows[0].wheel[0], 9);
  EXPECT_EQ(rows[0].ax, 5);
  EXPECT_NEAR(rows[0].rotation_deg, 0.2 * kDegrees, 1e-12);
}

TEST(FilterRun, Refuses) {
  FilterRunOptions options;
  options.least_rows = 10;
  const std::string run = plain_run(12);
  const auto error = [&](const std::string& from, const std::string& to) {
    return data_error([&] { read_run(replaced(run, from, to), options); });
  };
  EXPECT_EQ(data_error([&] { read_run(run, options); }), "");
  EXPECT_TRUE(
      says(error("enc1_m", "enc1"), {"run.csv:1: found no column \"enc1_m\"; the nearest is \"enc1\""}));
  EXPECT_TRUE(says(error("yaw_step_deg", "yaw"),
                   {"run.csv:1: found no rotation column, expected exactly one of yaw_step_deg"}));
  EXPECT_TRUE(says(error("ay_m_s2", "yaw_deg"), {"no column \"ay_m_s2\""}));
  EXPECT_TRUE(says(error("enc2_m", "enc1_m"), {"run.csv:1: found two columns \"enc1_m\", expected one"}));
  EXPECT_TRUE(says(error("time_s", "t"), {"run.csv:1: found no column \"time_s\" and no sampling period"}));
  EXPECT_TRUE(says(error("\n0.20,", "\n0.20,abc"),
                   {"run.csv:4: found \"abc", "in column \"enc1_m\", expected a finite number"}));
  EXPECT_TRUE(says(error(",0.051,", ",nan,"), {"run.csv:2: found \"nan\" in column \"enc4_m\""}));
  EXPECT_TRUE(says(error(",0.051,", ",inf,"), {"run.csv:2: found \"inf\""}));
  EXPECT_TRUE(says(error(",0.051,", ",,"), {"run.csv:2: found \"\" in column \"enc4_m\""}));
  EXPECT_TRUE(says(error("\n0.30,", "\n0.36,"),
                   {"run.csv:5: found a time step of 0.16 s, expected 0.1 s within 40 %"}));
  EXPECT_TRUE(says(error("\n0.30,", "\n0.20,"),
                   {"run.csv:5: found the time 0.2 s after 0.2 s, expected it to increase"}));
  EXPECT_TRUE(says(error("\n0.10,", "\n0.00,"), {"run.csv:3: found the time 0 s after 0 s"}));
  EXPECT_TRUE(says(data_error([&] { read_run(plain_run(9), options); }),
                   {"run.csv:10: found the end of the file after 9 rows, expected at least 10"}));
  EXPECT_TRUE(
      says(data_error([&] { read_run(plain_run(1), options); }), {"after 1 rows, expected at least 10"}));
  EXPECT_TRUE(says(data_error([&] { read_run(run.substr(0, run.rfind(',')), options); }),
                   {"run.csv:13: found the end of the file inside the line"}));
  options.columns = {{"enc1_m", "wheel"}};
  EXPECT_TRUE(says(data_error([&] { read_run(run, options); }), {"found no column \"wheel\" (for enc1_m)"}));
}

TEST(FilterRun, ThePeriodIsTheMedianStepWhereStampsJitter) {
  FilterRunOptions options;
  options.least_rows = 10;
  EXPECT_EQ(read_run(replaced(plain_run(12), "\n0.10,", "\n0.12,"), options).size(), 12u);
  options.time_tolerance = 0.01;
  EXPECT_TRUE(says(data_error([&] { read_run(replaced(plain_run(12), "\n0.10,", "\n0.12,"), options); }),
                   {"found a time step of 0.08 s, expected 0.12 s within 1 %"}));
}

TEST(FilterRun, MissingRowsAreFilledInOnRequest) {
  std::string run = plain_run(12);
  const std::size_t at = run.find("\n0.50,");
  run.erase(at, run.find('\n', at + 1) - at);
  EXPECT_TRUE(
      says(data_error([&] { read_run(run); }), {"found a time step of 0.2 s", "--resample fills them in"}));
  FilterRunOptions options;
  options.resample = true;
  const std::vector<FilterRow> rows = read_run(run, options);
  ASSERT_EQ(rows.size(), 12u);
  EXPECT_NEAR(rows[5].time_s, 0.5, 1e-12);
  for (std::size_t w = 0; w < 4; ++w)
    EXPECT_NEAR(rows[5].wheel[w], (rows[4].wheel[w] + rows[6].wheel[w]) / 2, 1e-15);
}

TEST(FilterRun, TimeStepsWithinTheTolerance) {
  FilterRunOptions options;
  EXPECT_EQ(read_run(replaced(plain_run(12), "\n0.30,", "\n0.3009,"), options).size(), 12u);
  options.time_tolerance = 0.03;
  EXPECT_EQ(read_run(replaced(plain_run(12), "\n0.30,", "\n0.302,"), options).size(), 12u);
  options.dt = 0.2;
  EXPECT_TRUE(says(data_error([&] { read_run(plain_run(12), options); }),
                   {"found a time step of 0.1 s, expected 0.2 s"}));
}

TEST(FilterRun, HalfOfTheSteeringAngles) {
  const std::string head =
      "time_s,enc1_m,enc2_m,enc3_m,enc4_m,ax_m_s2,ay_m_s2,yaw_step_deg,psi1_deg,psi2_deg,";
  EXPECT_TRUE(says(data_error([&] { read_run(head + "psi3_deg\n"); }),
                   {"run.csv:1: found \"psi1_deg\" but no column \"psi4_deg\", expected all four"}));
  EXPECT_TRUE(
      says(data_error([&] { read_run(head + "psi3_deg,psi4_deg,psi1_rad,psi2_rad,psi3_rad,psi4_rad\n"); }),
           {"in degrees and in radians"}));
}

TEST(FilterTruth, UnitsInTheNamesOrNot) {
  const TemporaryFolder folder;
  FilterTruthReader with(folder.file("a.csv", "sx_m,sy_m,dtheta_rad,ax_m_s2,ay_m_s2\n1,2,3,4,5\n"), {},
                         nullptr);
  FilterTruth truth;
  ASSERT_TRUE(with.next(truth));
  EXPECT_DOUBLE_EQ(truth.rotation_deg, 3 * kDegrees);
  EXPECT_FALSE(truth.wheel);
  FilterTruthReader without(
      folder.file("b.csv",
                  "sx,sy,dtheta_deg,ax,ay,enc1x,enc1y,enc2x,enc2y,enc3x,enc3y,enc4x,enc4y\n"
                  "1,2,3,4,5,11,12,21,22,31,32,41,42\n"),
      {}, nullptr);
  ASSERT_TRUE(without.next(truth));
  EXPECT_EQ(truth.rotation_deg, 3);
  ASSERT_TRUE(truth.wheel);
  EXPECT_EQ((*truth.wheel)[2][1], 32);
  EXPECT_FALSE(without.next(truth));
  EXPECT_TRUE(
      says(data_error([&] { without.too_short("run.csv"); }), {"b.csv:2: ", "after 1 rows", "run.csv"}));
}

TEST(FilterTruth, Refuses) {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& header) {
    return data_error([&] { FilterTruthReader(folder.file("t.csv", header + "\n"), {}); });
  };
  EXPECT_TRUE(says(error("sx,sy,dtheta_deg,ax"), {"t.csv:1: found no column \"ay_m_s2\""}));
  EXPECT_TRUE(says(error("sx,sy,dtheta,ax,ay"), {"found no column \"dtheta_deg\""}));
  EXPECT_TRUE(says(error("sx,sy,dtheta_deg,ax,ay,enc1x"), {"found \"enc1x_m\" but no column \"enc1y_m\""}));
}

constexpr const char* kWindow =
    R"({"format":"entropy-window-1","note":"n","windows":[{"id":"w","group":"g","N":3,
 "params":{"sigma_e":0.01,"sigma_a":0.02,"sigma_theta":0.03,"L":0.5,"dt":0.1,"ilgis":80,"plotis":60,"step_a":0.1,"step_z":0.2},
 "psi":[0,0.1,0.2,0.3],"ce":[[1,2,3],[4,5,6],[7,8,9],[10,11,12]],"ax":[1,2,3],"ay":[4,5,6],"ctheta":[7,8,9],"zero":{}}]})";

TEST(EntropyWindowFile, EveryNumberInItsPlace) {
  const TemporaryFolder folder;
  const std::vector<EntropyWindow> windows = load_entropy_windows(folder.file("w.json", kWindow));
  ASSERT_EQ(windows.size(), 1u);
  const EntropyWindow& w = windows[0];
  EXPECT_EQ(w.id, "w");
  EXPECT_EQ(w.group, "g");
  EXPECT_EQ(w.constants.samples, 3);
  EXPECT_EQ(w.constants.sigma_acceleration, 0.02);
  EXPECT_EQ(w.constants.sigma_rotation, 0.03);
  EXPECT_DOUBLE_EQ(w.constants.width / w.constants.length, 0.75);
  EXPECT_EQ(w.constants.step_rotation, 0.2);
  ASSERT_EQ(w.samples.size(), 3u);
  EXPECT_EQ(w.samples[1].wheel, (std::array<double, 4>{2, 5, 8, 11}));
  EXPECT_EQ(w.samples[2].steering, (std::array<double, 4>{0, 0.1, 0.2, 0.3}));
  EXPECT_EQ(w.samples[2].ax, 3);
  EXPECT_EQ(w.samples[0].ay, 4);
  EXPECT_EQ(w.samples[1].rotation, 8);
}

TEST(EntropyWindowFile, Refuses) {
  const TemporaryFolder folder;
  const auto error = [&](const std::string& from, const std::string& to) {
    return data_error([&] { load_entropy_windows(folder.file("w.json", replaced(kWindow, from, to))); });
  };
  EXPECT_TRUE(
      says(error("entropy-window-1", "entropy-window-2"), {"w.json: /format: found \"entropy-window-2\""}));
  EXPECT_TRUE(says(error("\"sigma_e\":0.01", "\"sigma_e\":0"),
                   {"/windows/0/params/sigma_e: found 0, expected a number > 0"}));
  EXPECT_TRUE(says(error("\"dt\":0.1", "\"dt\":-0.1"), {"/windows/0/params/dt: found -0.1"}));
  EXPECT_TRUE(
      says(error("\"dt\":0.1", "\"dt\":null"), {"/windows/0/params/dt: found null, expected a number"}));
  EXPECT_TRUE(
      says(error("\"dt\":0.1", "\"dt\":NaN"), {"w.json:2: ", "/dt: found NaN, expected a finite number"}));
  EXPECT_TRUE(says(error("\"step_a\":0.1,", ""), {"/windows/0/params: found no key \"step_a\""}));
  EXPECT_TRUE(says(error("\"N\":3", "\"N\":2"), {"/windows/0/N: found 2, expected 3 .."}));
  EXPECT_TRUE(says(error("\"N\":3", "\"N\":4"), {"/windows/0/ax: found 3 numbers, expected 4"}));
  EXPECT_TRUE(says(error("[0,0.1,0.2,0.3]", "[0,0.1,0.2]"), {"/windows/0/psi: found 3 numbers, expected 4"}));
  EXPECT_TRUE(says(error(",[10,11,12]", ""), {"/windows/0/ce: found 3 arrays"}));
  EXPECT_TRUE(says(error("[10,11,12]", "[10,11]"), {"/windows/0/ce/3: found 2 numbers, expected 3"}));
  EXPECT_TRUE(says(error("[7,8,9],\"zero\"", "[7,\"8\",9],\"zero\""), {"/windows/0/ctheta/1: found \"8\""}));
  EXPECT_TRUE(says(error("\"id\":\"w\"", "\"id\":\"\""), {"/windows/0/id"}));
  const std::string twice = replaced(kWindow, "}]}", "},");
  const std::string body = std::string(kWindow).substr(std::string(kWindow).find("[{") + 1);
  EXPECT_TRUE(says(data_error([&] { load_entropy_windows(folder.file("w.json", twice + body)); }),
                   {"/windows/1/id: found \"w\" a second time"}));
}

}  // namespace
}  // namespace odobench
