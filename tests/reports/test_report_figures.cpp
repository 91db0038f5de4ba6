// Figures and the pieces they are made of: decimation, stored tracks, the report as a document.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <set>
#include <sstream>

#include "base/json_node.hpp"
#include "reports/figures/decimate.hpp"
#include "reports/kinds/calibration/run_figures.hpp"
#include "reports/kinds/calibration/track_figures.hpp"
#include "reports/kinds/entropy/entropy_figures.hpp"
#include "reports/kinds/entropy/entropy_tables.hpp"
#include "reports/kinds/fusion/fusion_record.hpp"
#include "reports/page/report_document.hpp"
#include "reports/records/tracks.hpp"
#include "tests/support/data/report_records.hpp"

namespace odobench {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Largest distance of a curve from the straight lines between its kept samples.
double interpolation_error(const std::vector<double>& t, const std::vector<double>& v,
                           const std::vector<std::size_t>& kept) {
  double worst = 0;
  for (std::size_t i = 0; i + 1 < kept.size(); ++i)
    for (std::size_t k = kept[i]; k <= kept[i + 1]; ++k) {
      const double part = (t[k] - t[kept[i]]) / (t[kept[i + 1]] - t[kept[i]]);
      worst = std::max(worst, std::abs(v[k] - (v[kept[i]] + part * (v[kept[i + 1]] - v[kept[i]]))));
    }
  return worst;
}

struct Curves {
  std::vector<double> t, smooth, noisy;
  explicit Curves(std::size_t n) {
    std::mt19937 engine(5);
    for (std::size_t k = 0; k < n; ++k) {
      t.push_back(0.01 * static_cast<double>(k) + 1e-4 * static_cast<double>(engine() % 50));
      smooth.push_back(std::sin(t.back()));
      noisy.push_back(std::cos(3 * t.back()) + 1e-3 * static_cast<double>(engine() % 100));
    }
  }
};

TEST(Decimation, StaysWithinTheToleranceOfEveryChannel) {
  const Curves c(4000);
  const auto kept = decimate(c.t, {{c.smooth, 0.01}, {c.noisy, 0.08}});
  EXPECT_LT(kept.size(), 1500U);
  EXPECT_LE(interpolation_error(c.t, c.smooth, kept), 0.01 * (1 + 1e-12));
  EXPECT_LE(interpolation_error(c.t, c.noisy, kept), 0.08 * (1 + 1e-12));
  EXPECT_LT(decimate(c.t, {{c.smooth, 0.01}}).size(), 150U);
}

TEST(Decimation, KeepsTheEndsAndASingleSpike) {
  Curves c(4000);
  c.smooth[1234] = 1.4;  // alone above the rest
  c.smooth[2345] = -1.4;
  const auto kept = decimate(c.t, {{c.smooth, 10.0}});
  EXPECT_THAT(kept, ElementsAre(0U, 1234U, 2345U, 3999U));
}

TEST(Decimation, KeepsWhatIsNotFinite) {
  const std::vector<double> t{0, 1, 2, 3, 4}, v{0, 0, NAN, 0, 0};
  EXPECT_THAT(decimate(t, {{v, 1.0}}), Contains(2U));
}

TEST(Decimation, OfNothingAndOfOneSample) {
  EXPECT_TRUE(decimate(std::vector<double>{}, {}).empty());
  const std::vector<double> one{1.0};
  EXPECT_THAT(decimate(one, {{one, 0.0}}), ElementsAre(0U));
  EXPECT_THROW(decimate(one, {{std::span<const double>{}, 0.0}}), std::invalid_argument);
}

TEST(Extremes, OfEveryStretchAndTheEnds) {
  const std::vector<double> v{5, 1, 9, NAN, 4, 4, 3, 8, 7, 6};
  EXPECT_THAT(extremes(v, 2), ElementsAre(0U, 1U, 2U, 6U, 7U, 9U));
  EXPECT_THAT(extremes(v, 1), ElementsAre(0U, 1U, 2U, 9U));
  EXPECT_TRUE(extremes({}, 3).empty());
  EXPECT_THROW(extremes(v, 0), std::invalid_argument);
}

TrackSet small_tracks(std::size_t samples = 50) {
  TrackSet set{"calibration", "demo", "abc", {}, {}, {}, {}};
  set.tracks = {{"nominal", 1, {}}, {"lm", 1, {}}};
  std::size_t begin = 0;
  for (const char* trajectory : {"line x", "circle"})
    for (int drive = 1; drive <= 2; ++drive) {
      set.recordings.push_back(
          {std::string(trajectory) + std::to_string(drive), trajectory, drive, begin, samples});
      begin += samples;
      for (std::size_t k = 0; k < samples; ++k) {
        const double t = 0.1 * static_cast<double>(k);
        set.time_s.push_back(t);
        const auto add = [&](PoseTrack& pose, double off) {
          pose.x.push_back(t + off * t);
          pose.y.push_back(std::sin(t) - off);
          pose.theta.push_back(0.3 * t * drive + off * t * t);
        };
        add(set.reference, 0);
        add(set.tracks[0].pose, 0.1);
        add(set.tracks[1].pose, 0.01);
      }
    }
  return set;
}

class StoredTracks : public ::testing::Test {
 protected:
  StoredTracks()
      : folder_(std::filesystem::temp_directory_path() /
                ("odobench_tracks_" +
                 std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()))) {
    std::filesystem::remove_all(folder_);
    for (const auto& [file, bytes] : track_files(small_tracks())) {
      std::filesystem::create_directories((folder_ / file).parent_path());
      std::ofstream(folder_ / file, std::ios::binary) << bytes;
    }
  }
  ~StoredTracks() override { std::filesystem::remove_all(folder_); }

  std::string complaint() const {
    try {
      read_tracks(folder_);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "nothing was thrown";
  }
  void write(const std::string& file, const std::string& bytes) const {
    std::ofstream(folder_ / "tracks" / file, std::ios::binary) << bytes;
  }

  std::filesystem::path folder_;
};

TEST_F(StoredTracks, ComeBackToTheLastBit) {
  const TrackSet expected = small_tracks();
  const std::optional<TrackSet> read = read_tracks(folder_);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->dataset_sha256, "abc");
  EXPECT_EQ(read->time_s, expected.time_s);
  EXPECT_EQ(read->reference.theta, expected.reference.theta);
  ASSERT_EQ(read->tracks.size(), 2U);
  EXPECT_EQ(read->tracks[1].label, "lm");
  EXPECT_EQ(read->tracks[1].pose.x, expected.tracks[1].pose.x);
  EXPECT_EQ(read->tracks[1].pose.y, expected.tracks[1].pose.y);
  ASSERT_EQ(read->recordings.size(), 4U);
  EXPECT_EQ(read->recordings[3].begin, 150U);
  EXPECT_EQ(read->recordings[3].trajectory, "circle");
}

TEST_F(StoredTracks, AreInTheFormatOfNumPy) {
  std::ifstream file(folder_ / "tracks" / "reference.npy", std::ios::binary);
  std::string bytes(std::istreambuf_iterator<char>(file), {});
  EXPECT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  const auto length = static_cast<unsigned char>(bytes[8]) + 256U * static_cast<unsigned char>(bytes[9]);
  EXPECT_EQ((10 + length) % 64, 0U);
  EXPECT_THAT(bytes.substr(10, length),
              HasSubstr("{'descr': '<f8', 'fortran_order': False, 'shape': (200, 3), }"));
  EXPECT_EQ(bytes[10 + length - 1], '\n');
  EXPECT_EQ(bytes.size(), 10 + length + 200 * 3 * 8);
}

TEST_F(StoredTracks, OfAnotherFolderThereAreNone) {
  EXPECT_FALSE(read_tracks(folder_ / "nowhere"));
}

TEST_F(StoredTracks, ComplaintsNameTheFileAndWhatWasExpected) {
  write("1.npy", "not an array");
  EXPECT_THAT(complaint(), HasSubstr("1.npy: expected a NumPy array of float64 with shape (200, 3)"));
  const std::string whole = track_files(small_tracks())[2].second;
  write("1.npy", whole.substr(0, whole.size() - 8));
  EXPECT_THAT(complaint(), HasSubstr("1.npy: 4792 bytes of data, expected 4800"));
  write("tracks.json", "{\"schema_version\": 2}");
  EXPECT_THAT(complaint(), HasSubstr("tracks.json: /schema_version: found 2, expected 1"));
  write("tracks.json", "{");
  EXPECT_THAT(complaint(), HasSubstr("tracks.json:1: broken JSON"));
}

TEST_F(StoredTracks, AnIndexCannotReachOtherFolders) {
  std::string index = track_files(small_tracks()).back().second;
  const std::size_t at = index.find("\"2.npy\"");
  ASSERT_NE(at, std::string::npos);
  index.replace(at, 7, "\"../2.npy\"");
  write("tracks.json", index);
  EXPECT_THAT(complaint(), HasSubstr("expected the name of a file in the same folder"));
}

TEST(StoredTracksOf, DifferentLengthsAreRefused) {
  TrackSet set = small_tracks();
  set.tracks[0].pose.y.pop_back();
  EXPECT_THROW(track_files(set), std::invalid_argument);
  set = small_tracks();
  set.recordings.pop_back();
  EXPECT_THROW(track_files(set), std::invalid_argument);
}

std::vector<std::vector<std::string>> rows_of(const std::string& csv) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

TEST(TrackFigures, TheLargestErrorOfEveryDriveIsInTheData) {
  const TrackSet set = small_tracks(400);
  Section section;
  Document document;
  add_track_figures(set, "", section, document, 300);  // so few that curves are thinned strongly
  ASSERT_EQ(section.blocks.size(), 6U);
  for (const TrackRecording& r : set.recordings)
    for (std::size_t s = 0; s < set.tracks.size(); ++s) {
      double expected = 0, found = 0;
      for (std::size_t k = r.begin; k < r.begin + r.samples; ++k)
        expected = std::max(expected, std::abs(set.tracks[s].pose.theta[k] - set.reference.theta[k]));
      for (const auto& row : rows_of(
               document.datasets.at("errors." + std::string(r.trajectory == "circle" ? "circle" : "line-x"))))
        if (row[0] == "2" && row[2] == std::to_string(r.repetition) && row[3] == std::to_string(s + 1))
          found = std::max(found, std::stod(row[4]));
      EXPECT_NEAR(found, expected, 1e-5 * expected) << r.id << " " << set.tracks[s].label;
    }
}

TEST(TrackFigures, FewerRowsAreTakenWhenThereWouldBeTooMany) {
  const TrackSet set = small_tracks(2000);
  const auto rows = [&](std::size_t most) {
    Section section;
    Document document;
    add_track_figures(set, "", section, document, most);
    std::size_t count = 0;
    for (const auto& [name, csv] : document.datasets)
      if (name.rfind("tracks.", 0) == 0) count += rows_of(csv).size() - 1;
    return count;
  };
  EXPECT_LE(rows(3000), 3000U);
  EXPECT_GT(rows(40000), 3000U);
}

// Two solvers with repeats, a trace each, and what identifiability needs.
std::vector<RunRecord> report_records() {
  std::vector<RunRecord> records{testing::calibration_record("nominal", "evaluation", 90, 0.1)};
  for (int repetition = 1; repetition <= 3; ++repetition)
    for (const char* label : {"lm", "pso"}) {
      RunRecord r =
          testing::calibration_record(label, "run", label[0] == 'l' ? 10 : 10 + 0.5 * repetition, 0.01);
      r.repetition = repetition;
      r.trace = {{1, 0.01, 90}, {5 * repetition, 0.1, 30}, {100, 0.4 * repetition, *r.cost}};
      r.series = {{"singular_values", {100, 0.1}},
                  {"directions", {1, 0, 0, -1}},
                  {"sd_if_samples_were_independent", {0.001, 0.5}},
                  {"correlation", {1, 0.25, 0.25, 1}},
                  {"residual_deviation", {0.05}}};
      records.push_back(r);
    }
  return records;
}

TEST(Report, HasItsSectionsInOrder) {
  ReportInput input;
  input.records = report_records();
  input.tracks = {small_tracks()};
  const Document document = make_report(input);
  std::vector<std::string> ids;
  for (const Section& section : document.sections) ids.push_back(section.id);
  EXPECT_THAT(ids, ElementsAre("summary", "errors", "trajectories", "convergence", "parameters",
                               "identifiability", "provenance"));
  EXPECT_EQ(document.title, "6 runs of lm, pso on demo");
}

TEST(Report, EveryFigureFindsItsDataAndHasAnIdOfItsOwn) {
  ReportInput input;
  input.records = report_records();
  input.tracks = {small_tracks(), small_tracks()};
  const Document document = make_report(input);
  std::set<std::string> ids;
  for (const Figure* figure : figures(document)) {
    EXPECT_TRUE(ids.insert(figure->id).second) << figure->id;
    const nlohmann::json spec = standalone(*figure, document.datasets);
    EXPECT_EQ(spec.dump().find("\"name\":\"tracks"), std::string::npos);
    EXPECT_FALSE(figure->caption.empty());
    EXPECT_GT(spec.at("data").at("values").get<std::string>().size(), 10U) << figure->id;
  }
  EXPECT_GT(ids.size(), 15U);
}

TEST(Report, ConvergenceIsTheMedianOfTheRepeatsUntilAllHaveBegun) {
  const std::vector<RunRecord> records = report_records();
  Section section;
  Document document;
  add_convergence_figures(compare(records).front(), "", section, document);
  ASSERT_EQ(section.blocks.size(), 2U);
  // pso is series 1; its repeats have 30 from 5, 10 and 15 evaluations on, and end at 10.5, 11, 11.5.
  double median_at_10 = 0, last_gap = 0;
  for (const auto& row : rows_of(document.datasets.at("convergence.evaluations"))) {
    if (row[1] != "1") continue;
    if (row[0] == "cost" && row[2] == "10") median_at_10 = std::stod(row[5]);
    if (row[0] == "gap" && row[2] == "100") last_gap = std::stod(row[5]);
  }
  EXPECT_DOUBLE_EQ(median_at_10, 30);
  EXPECT_DOUBLE_EQ(last_gap, 1);
}

TEST(Report, WeakDirectionsInWords) {
  const std::optional<Table> table = weak_directions(report_records().at(1));
  ASSERT_TRUE(table);
  ASSERT_EQ(table->rows.size(), 2U);
  EXPECT_EQ(table->rows[0][3].text, "yes");  // 0.05 / 100 = 0.05 % of a box of 5 %
  EXPECT_DOUBLE_EQ(*table->rows[0][2].value, 0.05);
  EXPECT_EQ(table->rows[1][3].text, "no");
  EXPECT_DOUBLE_EQ(*table->rows[1][2].value, 50);
  EXPECT_EQ(table->rows[1][4].text, "up: r1 (1.00)");
}

TEST(Report, SeriesOfTheWrongLengthAreNotUsed) {
  RunRecord record = report_records().at(1);
  record.series["directions"].pop_back();
  EXPECT_FALSE(weak_directions(record));
}

TEST(Report, ARecordWithoutTracksSaysSo) {
  ReportInput input;
  input.records = report_records();
  input.absent = {"no tracks here"};
  const Document document = make_report(input);
  const auto* paragraph = std::get_if<Paragraph>(&document.sections.front().blocks.back());
  ASSERT_NE(paragraph, nullptr);
  EXPECT_EQ(paragraph->text, "no tracks here");
}

TEST(FusionRecord, RowsComeBack) {
  FusionRow row{"lm+ekf", true, 0.1, 0.2, 3.1, 0.9, 2.4, 3.6, {1, 2, 3}, {}, "consistent"};
  row.sensors = {{"camera", 10, 1, 2, 2.9, 3, 2.5, 3.5}, {"gyro.z", 20, 0, 0, 1.1, 1, 0.9, 1.1}};
  RunRecord record;
  put_fusion_row(row, record);
  const FusionRow back = fusion_row(record_from(JsonNode::parse(to_json_line(record), "f")));
  EXPECT_TRUE(back.filtered);
  EXPECT_EQ(back.label, row.label);
  EXPECT_EQ(back.verdict, row.verdict);
  EXPECT_EQ(back.nees, row.nees);
  EXPECT_EQ(back.inside, row.inside);
  ASSERT_EQ(back.sensors.size(), 2U);
  EXPECT_EQ(back.sensors[1].name, "gyro.z");
  EXPECT_EQ(back.sensors[0].dof, 3);
  EXPECT_EQ(back.sensors[0].upper, 3.5);
  row.filtered = false;
  RunRecord odometry;
  put_fusion_row(row, odometry);
  EXPECT_FALSE(fusion_row(odometry).filtered);
  EXPECT_TRUE(fusion_row(odometry).sensors.empty());
}

TEST(GapBins, OptimumFirstThenHalfDecades) {
  EXPECT_EQ(gap_bin(0, -5), 0U);
  EXPECT_EQ(gap_bin(4e-9, -5), 0U);  // within rounding of |H|
  EXPECT_EQ(gap_bin(1e-8, -5), 1U);
  EXPECT_EQ(gap_bin(2e-6, -5), 1U);
  EXPECT_EQ(gap_bin(5e-6, -5), 2U);
  EXPECT_EQ(gap_bin(1.5, -5), 13U);
  EXPECT_EQ(gap_bin(1e99, -5), kGapBins - 1);
  EXPECT_EQ(gap_bin_name(13), "1 .. 3.2");
}

}  // namespace
}  // namespace odobench
