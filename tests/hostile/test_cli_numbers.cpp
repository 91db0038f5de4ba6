// Finite numbers that overflow on the way: refused with their place, and nothing is left behind.
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/data/filter_run_files.hpp"
#include "tests/support/data/small_dataset.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;
using testing::content;
using testing::expect_refusal;
using testing::kData;
using testing::lines;
using testing::plain_run;
using testing::TemporaryFolder;

using Row = std::vector<std::string>;

Row split(const std::string& line) {
  Row fields;
  std::istringstream in(line);
  for (std::string field; std::getline(in, field, ',');) fields.push_back(field);
  return fields;
}

// Finite input that no double can square: refused with the row, and no cell of any output is nan or inf.
TEST(CliNumbers, AFilterRunIsRefusedWithTheRow) {
  const TemporaryFolder folder;
  const std::string good = plain_run(30), out = (folder / "out.csv").string();
  const std::vector<std::string> rows = lines(good);
  const std::size_t columns = split(rows.front()).size();
  for (std::size_t c = 1; c < columns; ++c)
    for (const char* huge : {"1e308", "-1e200"}) {
      std::string text;
      for (std::size_t r = 0; r < rows.size(); ++r) {
        Row fields = split(rows[r]);
        if (r == 12) fields[c] = huge;
        for (std::size_t k = 0; k < fields.size(); ++k) text += (k > 0 ? "," : "") + fields[k];
        text += "\n";
      }
      expect_refusal({"filter", "--data=" + folder.file("huge.csv", text), "--out=" + out}, kData,
                     {"huge.csv:13: found \"" + std::string(huge) + "\" in column \"" +
                      split(rows.front())[c] + "\", expected a number of at most 1e+50 in size"});
      EXPECT_FALSE(fs::exists(out));
    }
  std::string large = good;  // each number is fine, their quotient squared is not
  large.replace(large.rfind('\n', large.size() - 2) + 1, std::string::npos, "");
  Row last = split(rows.back());
  last[1] = "1e49";
  for (std::size_t k = 0; k < last.size(); ++k) large += (k > 0 ? "," : "") + last[k];
  expect_refusal({"filter", "--data=" + folder.file("large.csv", large + "\n"), "--sigma-encoder=1e-130",
                  "--out=" + out},
                 kData, {"large.csv:", ": the window of ", "overflows"});
  EXPECT_FALSE(fs::exists(out));
}

TEST(CliNumbers, ACalibrationIsRefusedWithTheSample) {
  const TemporaryFolder folder;
  const std::string set = (folder / "set.json").string(), out = (folder / "out").string();
  save_dataset(testing::small_dataset(), set);
  expect_refusal({"run", "--solver=lm", "--data=" + set, "--out=" + out}, kData,
                 {"set.json: recording 'ahead_1': x, sample 3: found -1.79",
                  "expected a number of at most 1e+50 in size"});
  EXPECT_FALSE(fs::exists(out));
}

TEST(CliNumbers, ParametersThatOverflowAreRefused) {
  const TemporaryFolder folder;
  std::string text = "{";
  for (int i = 1; i <= 4; ++i)
    text += "\"a" + std::to_string(i) + "\": 1e-200, \"b" + std::to_string(i) + "\": 1e-200, \"r" +
            std::to_string(i) + "\": 0.02" + (i < 4 ? ", " : "}");
  const std::string parameters = folder.file("p.json", text), out = (folder / "out").string();
  const std::string sensors = (source_dir() / "datasets" / "sensors" / "heading_only.json").string();
  const auto refused = [&](std::vector<std::string> words, const std::string& message) {
    words.insert(words.end(), {"--parameters=" + parameters, "--out=" + out});
    const testing::ProcessResult result = testing::run_bench(words);
    EXPECT_EQ(result.exit_code, kData) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_NE(result.err.find("bench: error: " + message), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("overflows"), std::string::npos) << result.err;
  };
  refused({"fuse", "--sensors=" + sensors, "--filter=none"}, "recording '");
  refused({"evaluate"}, "parameters 'p' on data set 'demo'");
  EXPECT_FALSE(fs::exists(out));
  const auto filtered =
      testing::run_bench({"fuse", "--sensors=" + sensors, "--filter=ekf", "--parameters=" + parameters});
  EXPECT_EQ(filtered.exit_code, kData);
  EXPECT_NE(filtered.err.find("bench: error: recording 'line_x_1': --filter=ekf: "), std::string::npos)
      << filtered.err;
}

TEST(CliNumbers, ConstantsThatDoNotGoTogetherNameTheOptions) {
  const TemporaryFolder folder;
  const std::string data = folder.file("run.csv", testing::CircleRun().data());
  expect_refusal({"filter", "--data=" + data, "--sigma-encoder=1e-200"}, testing::kUsage,
                 {"--sigma-encoder=1e-200"});
}

}  // namespace
}  // namespace odobench
