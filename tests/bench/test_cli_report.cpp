// `bench report --out`, `bench report --figures`, `bench export` and what run directories hold for them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "reports/page/web_assets.hpp"
#include "reports/records/record.hpp"
#include "reports/records/tracks.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench {
namespace {

using testing::content;
using testing::expect_refusal;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::ProcessResult;
using testing::run_bench;
using testing::TemporaryFolder;

const std::string kSource = source_dir().string();

void expect_success(const std::vector<std::string>& words) {
  const ProcessResult result = run_bench(words);
  ASSERT_EQ(result.exit_code, 0) << result.err;
}

// One run of two solvers on the demo set for all tests of this file.
class CliReport : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    run_ = (*folder_ / "run").string();
    expect_success({"--solver=lm,pso", "--repeat=2", "--max-evals=600", "--quiet", "--out=" + run_});
  }
  static void TearDownTestSuite() { delete folder_; }

  static inline TemporaryFolder* folder_ = nullptr;
  static inline std::string run_;
  const TemporaryFolder out_;
};

// What of an element's text is between `begin` and the next `end`.
std::string between(const std::string& text, const std::string& begin, const std::string& end,
                    std::size_t from = 0) {
  const std::size_t at = text.find(begin, from);
  if (at == std::string::npos) return "";
  const std::size_t start = at + begin.size();
  return text.substr(start, text.find(end, start) - start);
}

// A number of a table that is not finite, or nothing.
std::string not_finite(const std::string& text) {
  static const std::regex word("(^|[^A-Za-z])-?(nan|inf|infty)([^A-Za-z]|$)");
  std::smatch found;
  if (!std::regex_search(text, found, word)) return "";
  return text.substr(static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, found.position() - 60)), 120);
}

TEST(NotFinite, IsFound) {
  EXPECT_NE(not_finite("lm,1,inf,2"), "");
  EXPECT_NE(not_finite("| 1.7 (nan) |"), "");
  EXPECT_EQ(not_finite("information about infinite nano things"), "");
}

// Sums, differences and ratios of numbers near the ends of the range of a double.
TEST_F(CliReport, FiniteRecordsGiveFiniteTables) {
  const std::vector<RunRecord> good = read_records(run_ + "/runs.jsonl");
  for (const double value : {1.7e308, -1.7e308, 1e-320})
    for (const bool of_nominal : {false, true}) {
      std::string text;
      for (RunRecord r : good) {
        if ((r.label == "nominal") == of_nominal) {
          r.cost = value;
          for (RecordingError& e : r.errors)
            e.max_error = {std::abs(value), std::abs(value), std::abs(value)};
        }
        text += to_json_line(r) + "\n";
      }
      const std::string changed = out_.file("changed.jsonl", text);
      for (const char* format : {"console", "md", "csv", "json", "latex"})
        for (const std::vector<std::string>& words : {std::vector<std::string>{"report", changed},
                                                      {"compare", changed, run_},
                                                      {"compare", run_, changed}}) {
          std::vector<std::string> all = words;
          all.push_back(std::string("--format=") + format);
          const ProcessResult result = run_bench(all);
          EXPECT_LE(result.exit_code, 1) << result.err;
          EXPECT_EQ(not_finite(result.out), "") << value << " " << words.front() << " " << format;
        }
    }
}

TEST_F(CliReport, ThePageHoldsTheNumbersOfTheRecords) {
  const std::string page_file = (out_ / "report.html").string();
  const ProcessResult result = run_bench({"report", run_, "--out=" + page_file});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, IsEmpty());
  const std::string page = content(page_file);
  const std::vector<RunRecord> records = read_records(run_ + "/runs.jsonl");
  for (const RunRecord& r : records)
    EXPECT_THAT(page, HasSubstr("data-value=\"" + nlohmann::json(*r.cost).dump() + "\"")) << r.label;
  EXPECT_THAT(page, HasSubstr(std::to_string(records.back().seed)));
  EXPECT_THAT(page, HasSubstr(records.back().dataset_sha256));
  EXPECT_THAT(page, HasSubstr("--max-evals=600"));  // the command line
  for (const char* section :
       {"summary", "errors", "trajectories", "convergence", "parameters", "identifiability", "provenance"})
    EXPECT_THAT(page, HasSubstr("id=\"" + std::string(section) + "\""));
  EXPECT_LT(page.size(), 6u << 20);
}

TEST_F(CliReport, TheSameRecordsGiveTheSamePage) {
  expect_success({"report", run_, "--out=" + (out_ / "a.html").string()});
  expect_success({"report", run_, "--out=" + (out_ / "b.html").string()});
  EXPECT_EQ(content(out_ / "a.html"), content(out_ / "b.html"));
}

TEST_F(CliReport, ATitleIsEscaped) {
  const std::string page_file = (out_ / "report.html").string();
  expect_success({"report", run_, "--title=a < b & </script>", "--out=" + page_file});
  EXPECT_EQ(between(content(page_file), "<title>", "</title>"), "a &lt; b &amp; &lt;/script&gt;");
}

TEST_F(CliReport, WithoutTracksItSaysSo) {
  expect_success({"report", run_ + "/runs.jsonl", "--out=" + (out_ / "with.html").string()});
  EXPECT_THAT(content(out_ / "with.html"), HasSubstr("data-figure=\"path."));
  const std::string lone = out_.file("lone.jsonl", content(run_ + "/runs.jsonl"));
  expect_success({"report", lone, "--out=" + (out_ / "lone.html").string()});
  EXPECT_THAT(content(out_ / "lone.html"), HasSubstr("The run directory holds no tracks"));
  EXPECT_THAT(content(out_ / "lone.html"), Not(HasSubstr("data-figure=\"path.")));
}

TEST_F(CliReport, TracksOfAnotherRunAreNotShown) {
  std::filesystem::copy(run_, out_ / "mixed", std::filesystem::copy_options::recursive);
  expect_success({"--solver=lm", "--problem=rosenbrock", "--quiet", "--out=" + (out_ / "other").string()});
  std::filesystem::copy(out_ / "other" / "runs.jsonl", out_ / "mixed" / "other.jsonl");
  expect_success(
      {"report", (out_ / "mixed" / "other.jsonl").string(), "--out=" + (out_ / "r.html").string()});
  EXPECT_THAT(content(out_ / "r.html"), Not(HasSubstr("data-figure=\"path.")));
}

TEST_F(CliReport, FiguresAreSvgFiles) {
  if (!has_chart_library()) GTEST_SKIP() << "built without the chart library";
  if (std::system("node --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "node is not installed";
  const std::filesystem::path figures = out_ / "figures";
  expect_success({"report", run_, "--figures=" + figures.string()});
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(figures)) {
    const std::string svg = content(entry.path());
    EXPECT_EQ(entry.path().extension(), ".svg");
    EXPECT_EQ(svg.rfind("<svg", 0), 0u) << entry.path();
    EXPECT_THAT(svg, HasSubstr("<path")) << entry.path();
    EXPECT_THAT(svg, Not(HasSubstr("NaN"))) << entry.path();
    ++count;
  }
  EXPECT_EQ(
      count,
      18u + 7u);  // three per trajectory; card, convergence (2), repeats, parameters, identifiability (2)
}

TEST_F(CliReport, WithoutNodeFiguresAreRefusedInOneLine) {
  if (!has_chart_library()) GTEST_SKIP() << "built without the chart library";
  ::setenv("PATH", (out_ / "nothing").c_str(), 1);
  expect_refusal({"report", run_, "--figures=" + (out_ / "figures").string()}, testing::kData, {"node"});
  EXPECT_FALSE(std::filesystem::exists(out_ / "figures"));
}

TEST_F(CliReport, RefusesWhatItCannotRead) {
  expect_refusal({"report", (out_ / "nowhere").string(), "--out=" + (out_ / "r.html").string()},
                 testing::kData, {"nowhere", "no such file"});
  std::filesystem::copy(run_, out_ / "broken", std::filesystem::copy_options::recursive);
  std::ofstream(out_ / "broken" / "tracks" / "1.npy") << "x";
  expect_refusal({"report", (out_ / "broken").string(), "--out=" + (out_ / "r.html").string()},
                 testing::kData, {"1.npy", "expected a NumPy array"});
  EXPECT_FALSE(std::filesystem::exists(out_ / "r.html"));
}

TEST_F(CliReport, TracksAreThoseOfTheRunsThatTheTablesShow) {
  const std::optional<TrackSet> set = read_tracks(run_);
  ASSERT_TRUE(set);
  ASSERT_EQ(set->tracks.size(), 3u);
  EXPECT_EQ(set->tracks[0].label, "nominal");
  const std::vector<RunRecord> records = read_records(run_ + "/runs.jsonl");
  for (const StoredTrack& track : set->tracks) {
    const auto record = std::find_if(records.begin(), records.end(), [&](const RunRecord& r) {
      return r.label == track.label && r.repetition == track.repetition;
    });
    ASSERT_NE(record, records.end());
    for (std::size_t i = 0; i < set->recordings.size(); ++i) {
      const TrackRecording& r = set->recordings[i];
      double largest = 0;
      for (std::size_t k = r.begin; k < r.begin + r.samples; ++k)
        largest = std::max(largest, std::abs(track.pose.x[k] - set->reference.x[k]));
      EXPECT_DOUBLE_EQ(largest, record->errors[i].max_error[0]) << track.label << " " << r.id;
    }
  }
}

TEST_F(CliReport, TumFilesComeBack) {
  const std::filesystem::path tum = out_ / "tum";
  expect_success({"export", run_, "--tum", "--out=" + tum.string()});
  const std::optional<TrackSet> set = read_tracks(run_);
  ASSERT_TRUE(set);
  const TrackRecording& r = set->recordings.at(3);
  for (const auto& [folder, pose] : {std::pair{"reference", &set->reference}, {"lm", &set->tracks[1].pose}}) {
    std::istringstream file(content(tum / folder / (r.id + ".tum")));
    std::size_t k = r.begin;
    for (std::string line; std::getline(file, line); ++k) {
      std::istringstream words(line);
      double time, x, y, z, qx, qy, qz, qw;
      ASSERT_TRUE(words >> time >> x >> y >> z >> qx >> qy >> qz >> qw) << line;
      ASSERT_LT(k, r.begin + r.samples);
      EXPECT_EQ(time, set->time_s[k]);
      EXPECT_EQ(x, pose->x[k]);
      EXPECT_EQ(y, pose->y[k]);
      EXPECT_EQ(z, 0);
      EXPECT_NEAR(2 * std::atan2(qz, qw), std::remainder(pose->theta[k], 4 * M_PI), 1e-12);
      EXPECT_EQ(qx, 0);
      EXPECT_EQ(qy, 0);
    }
    EXPECT_EQ(k, r.begin + r.samples);
  }
  expect_refusal({"export", run_, "--tum", "--out=" + tum.string()}, testing::kUsage, {"it exists"});
  expect_success({"export", run_, "--tum", "--out=" + tum.string(), "--overwrite"});
}

TEST_F(CliReport, ExportNeedsAFormatAndTracks) {
  expect_refusal({"export", run_, "--out=" + (out_ / "t").string()}, testing::kUsage, {"--tum"});
  expect_refusal({"export", out_.path().string(), "--tum", "--out=" + (out_ / "t").string()}, testing::kData,
                 {"no tracks/tracks.json"});
}

TEST_F(CliReport, EvaluationsAreStoredToo) {
  const std::string dir = (out_ / "evaluation").string();
  expect_success({"evaluate", "--parameters=nominal,truth", "--out=" + dir});
  EXPECT_EQ(read_records(dir + "/runs.jsonl").size(), 2u);
  EXPECT_EQ(read_tracks(dir)->tracks.size(), 2u);
  expect_refusal({"evaluate", "--out=" + dir}, testing::kUsage, {"holds runs.jsonl already"});
  expect_success({"report", dir, "--out=" + (out_ / "e.html").string()});
  EXPECT_THAT(content(out_ / "e.html"), HasSubstr("data-figure=\"error."));
}

TEST_F(CliReport, AFusionComesBackFromItsRecords) {
  const std::string dir = (out_ / "fusion").string();
  const ProcessResult fused = run_bench({"fuse", "--parameters=nominal,truth", "--filter=none,ekf",
                                         "--sensors=" + kSource + "/datasets/sensors/heading_only.json",
                                         "--out=" + dir, "--format=csv"});
  ASSERT_EQ(fused.exit_code, 0) << fused.err;
  const ProcessResult again = run_bench({"report", dir, "--format=csv"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  // All but the table of the sensors, whose words are in the notes of the records.
  EXPECT_EQ(again.out, fused.out.substr(fused.out.find("#table,errors.")));
  expect_success({"report", dir, "--out=" + (out_ / "f.html").string()});
  const std::string page = content(out_ / "f.html");
  EXPECT_THAT(page, HasSubstr("SYNTHETIC SENSORS"));
  EXPECT_THAT(page, HasSubstr("data-figure=\"nees\""));
  EXPECT_THAT(page, HasSubstr("data-figure=\"nis\""));
}

TEST_F(CliReport, AFilterRunShowsItsSignals) {
  const std::string drive = (out_ / "drive").string(), dir = (out_ / "filter").string();
  expect_success({"simulate", "--scenario=filter_turns", "--out=" + drive, "--quiet"});
  expect_success({"filter", "--data=" + drive + "/sensors.csv", "--truth=" + drive + "/truth.csv",
                  "--wheel-order=left-first", "--gap", "--records=" + dir, "--quiet"});
  const RunRecord record = read_records(dir + "/runs.jsonl").front();
  const std::vector<double>& low = record.series.at("signal.theta.before.min");
  const std::vector<double>& high = record.series.at("signal.theta.before.max");
  const std::vector<double>& detail = record.series.at("detail.theta.before");
  EXPECT_EQ(low, high);  // as short as this run is, every row has a place of its own
  EXPECT_EQ(low, detail);
  EXPECT_EQ(record.measures.value("windows").value_or(-1), static_cast<double>(low.size()));
  double counted = 0;
  for (const double count : record.series.at("gap_counts")) counted += count;
  EXPECT_EQ(counted, record.measures.value("windows").value_or(-1));
  EXPECT_NEAR(record.series.at("gap_counts")[0] / counted, record.measures.value("at_optimum").value_or(-1),
              1e-12);
  expect_success({"report", dir, "--out=" + (out_ / "f.html").string()});
  EXPECT_THAT(content(out_ / "f.html"), HasSubstr("data-figure=\"signals\""));
  EXPECT_THAT(content(out_ / "f.html"), HasSubstr("data-figure=\"gaps\""));
}

TEST_F(CliReport, OverwritingARunTakesItsTracksAway) {
  const std::string dir = (out_ / "run").string();
  expect_success({"--solver=lm", "--quiet", "--out=" + dir});
  ASSERT_TRUE(read_tracks(dir));
  expect_success({"--solver=lm", "--problem=rosenbrock", "--quiet", "--overwrite", "--out=" + dir});
  EXPECT_FALSE(read_tracks(dir));
}

}  // namespace
}  // namespace odobench
