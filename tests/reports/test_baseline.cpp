// The regression check.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "reports/regression/baseline.hpp"
#include "tests/support/data/report_records.hpp"

namespace odobench {
namespace {

using testing::calibration_record;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::run_record;
using ::testing::ThrowsMessage;

std::vector<RunRecord> records() {
  RunRecord skipped = run_record("x", 0);
  skipped.problem = "calibration";
  skipped.dataset = "demo";
  skipped.kind = "skipped";
  skipped.cost.reset();
  return {calibration_record("nominal", "evaluation", 1000, 0.4), calibration_record("lm", "run", 100, 0.1),
          skipped, run_record("lm", 1e-3)};
}

Tolerances tolerances() {
  Tolerances t{1e-6, 1e-6, 1e-5, 1e-4, 2.0};
  return t;
}

class BaselineFile {
 public:
  explicit BaselineFile(const std::string& content) {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = (std::filesystem::temp_directory_path() /
             (std::string("odobench_baseline_") + test->name() + ".json"));
    std::ofstream(path_, std::ios::binary) << content;
  }
  ~BaselineFile() { std::filesystem::remove(path_); }
  BaselineFile(const BaselineFile&) = delete;
  BaselineFile& operator=(const BaselineFile&) = delete;
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

// What the report lists: "finding label cell".
std::vector<std::string> findings(const BaselineReport& report) {
  std::vector<std::string> out;
  for (const auto& row : report.table.rows)
    out.push_back(row[0].text + " " + row[2].text + " " + row[3].text);
  return out;
}

BaselineReport check(const std::vector<RunRecord>& found) {
  return check_baseline(make_baseline(records(), tolerances()), found);
}

std::string reading_error(const std::string& content) {
  const BaselineFile file(content);
  try {
    read_baseline(file.path());
  } catch (const std::runtime_error& error) {
    const std::string text = error.what();
    EXPECT_EQ(text.rfind(file.path(), 0), 0u) << text;
    return text.substr(std::min(text.size(), file.path().size()));
  }
  return "accepted";
}

TEST(Baseline, PassesOnWhatItWasMadeFrom) {
  const BaselineReport report = check(records());
  EXPECT_TRUE(report.passed);
  EXPECT_THAT(report.table.rows, IsEmpty());
  // Four costs and kinds (8), evaluations of two runs (2), two tables of 18 cells and 4 sums (44).
  EXPECT_THAT(report.table.notes, ElementsAre("54 values compared: all within tolerance."));
  EXPECT_THAT(render({report.table}, Format::Console), HasSubstr("all within tolerance"));
}

TEST(Baseline, FileRoundTripIsExact) {
  auto found = records();
  found[1].cost = 1.0 / 3;
  found[1].errors[0].max_error[0] = 0.1 + 0.2;
  Baseline baseline = make_baseline(found, tolerances());
  baseline.entries[1].tolerances.cost_relative = 0.01;
  baseline.entries[1].tolerances.evaluations_factor.reset();
  const std::string text = to_json_text(baseline);
  const BaselineFile file(text);
  const Baseline back = read_baseline(file.path());
  EXPECT_EQ(to_json_text(back), text);
  EXPECT_EQ(back.source, file.path());
  EXPECT_EQ(back.entries.at(1).cost, 1.0 / 3);
  EXPECT_EQ(back.entries.at(1).tolerances.cost_relative, 0.01);
  EXPECT_FALSE(back.entries.at(1).tolerances.evaluations_factor.has_value());
  EXPECT_EQ(back.entries.at(0).tolerances.cost_relative, 1e-6);
  EXPECT_EQ(back.entries.at(0).tolerances.evaluations_factor, 2.0);
  Baseline exact = back;
  for (BaselineEntry& entry : exact.entries) entry.tolerances = {0, 0, 0, 0, 1.0};
  const BaselineReport report = check_baseline(exact, found);
  EXPECT_TRUE(report.passed) << render({report.table}, Format::Console);
}

TEST(Baseline, OneChangedCellChangesFewLines) {
  auto found = records();
  const std::string before = to_json_text(make_baseline(found, tolerances()));
  found[1].errors[0].max_error[0] += 1e-3;
  const std::string after = to_json_text(make_baseline(found, tolerances()));
  std::istringstream a(before), b(after);
  std::string line_a, line_b;
  int changed = 0;
  while (std::getline(a, line_a) && std::getline(b, line_b)) changed += line_a != line_b;
  EXPECT_EQ(changed, 2) << "the cells of the variable and the sums";
}

TEST(Baseline, CostIsRelative) {
  for (double scale : {1e-8, 1.0, 1e8}) {
    auto made = records();
    made[1].cost = 100 * scale;
    const Baseline baseline = make_baseline(made, tolerances());
    auto found = made;
    for (double sign : {-1.0, 1.0}) {
      found[1].cost = 100 * scale * (1 + sign * 0.9e-6);
      EXPECT_TRUE(check_baseline(baseline, found).passed) << scale;
      found[1].cost = 100 * scale * (1 + sign * 1.1e-6);
      EXPECT_FALSE(check_baseline(baseline, found).passed) << scale;
    }
  }
}

TEST(Baseline, MovedCostIsListedWithAllNumbers) {
  auto found = records();
  found[1].cost = 101;
  const BaselineReport report = check(found);
  EXPECT_FALSE(report.passed);
  ASSERT_THAT(findings(report), ElementsAre("moved lm J"));
  const auto& row = report.table.rows[0];
  EXPECT_EQ(row[1].text, "calibration, demo");
  EXPECT_EQ(row[4].value, 100);
  EXPECT_EQ(row[5].value, 101);
  EXPECT_EQ(row[6].value, 1);
  EXPECT_DOUBLE_EQ(*row[7].value, 1e-4);
  EXPECT_THAT(report.table.notes, ElementsAre("54 values compared: failed."));
}

TEST(Baseline, ErrorCellsHaveAbsoluteTolerancesInMetresAndRadians) {
  // The second recording is the larger one: its change moves the maximum as it is, the mean by half of it.
  const auto moved_by = [](std::size_t variable, double change) {
    auto found = records();
    found[1].errors[1].max_error[variable] += change;
    return findings(check(found));
  };
  EXPECT_THAT(moved_by(0, 0.9e-6), IsEmpty());
  EXPECT_THAT(moved_by(0, 1.1e-6), ElementsAre("moved lm line_x x e_max"));
  EXPECT_THAT(moved_by(1, -2.1e-6),
              ElementsAre("moved lm line_x y e_max", "moved lm line_x y e_sr", "moved lm line_x y sigma"));
  EXPECT_THAT(moved_by(2, 0.9e-5), IsEmpty());
  EXPECT_THAT(moved_by(2, 1.1e-5), ElementsAre("moved lm line_x theta e_max"));
  EXPECT_THAT(moved_by(2, 1e-3),
              ElementsAre("moved lm totals theta", "moved lm totals total", "moved lm line_x theta e_max",
                          "moved lm line_x theta e_sr", "moved lm line_x theta sigma"));
}

TEST(Baseline, EvaluationsMayGrowByTheFactorOnly) {
  auto found = records();
  found[1].evaluations = 20;
  EXPECT_TRUE(check(found).passed);
  found[1].evaluations = 1;
  EXPECT_TRUE(check(found).passed);
  found[1].evaluations = 21;
  const BaselineReport report = check(found);
  EXPECT_THAT(findings(report), ElementsAre("moved lm evaluations"));
  EXPECT_FALSE(report.passed);
  const auto& row = report.table.rows[0];
  EXPECT_EQ(row[4].value, 10);
  EXPECT_EQ(row[5].value, 21);
  EXPECT_EQ(row[6].value, 11);
  EXPECT_EQ(row[7].value, 10);
  Tolerances without = tolerances();
  without.evaluations_factor.reset();
  EXPECT_TRUE(check_baseline(make_baseline(records(), without), found).passed);
}

TEST(Baseline, MissingAndAdditionalLabels) {
  auto found = records();
  found.erase(found.begin() + 1);
  EXPECT_THAT(findings(check(found)), ElementsAre("missing lm label"));
  EXPECT_FALSE(check(found).passed);
  EXPECT_FALSE(check({}).passed);

  found = records();
  found.push_back(calibration_record("ga", "run", 100, 0.1));
  const BaselineReport report = check(found);
  EXPECT_THAT(findings(report), ElementsAre("additional ga label"));
  EXPECT_TRUE(report.passed) << "a new solver must not break the check of the old ones";
  EXPECT_THAT(report.table.notes, ElementsAre("54 values compared: passed."));
}

// A gate that looks at nothing holds nothing.
TEST(Baseline, NothingToCompareFails) {
  const std::vector<RunRecord> records{run_record("lm", 1)};
  Baseline baseline = make_baseline(records);
  baseline.entries.clear();
  const BaselineReport report = check_baseline(baseline, records);
  EXPECT_FALSE(report.passed);
  EXPECT_EQ(report.compared, 0u);
  EXPECT_THAT(report.table.notes.back(), HasSubstr("nothing to compare, which fails"));
}

TEST(Baseline, AnotherBoxIsAnotherProblem) {
  std::vector<RunRecord> records{run_record("lm", 1)};
  records[0].box = "0123456789abcdef";
  const Baseline baseline = make_baseline(records);
  EXPECT_THAT(to_json_text(baseline), HasSubstr("\"box\": \"0123456789abcdef\""));
  EXPECT_TRUE(check_baseline(baseline, records).passed);
  records[0].box.clear();  // an older record does not say
  EXPECT_TRUE(check_baseline(baseline, records).passed);
  records[0].box = "fedcba9876543210";
  EXPECT_FALSE(check_baseline(baseline, records).passed);
}

TEST(Baseline, LabelsOfOtherProblemsAreOthers) {
  auto found = records();
  found[3].problem = "rosenbrock";
  EXPECT_THAT(findings(check(found)), ElementsAre("missing lm label", "additional lm label"));
  found = records();
  found[1].dataset = "other";
  EXPECT_THAT(findings(check(found)), ElementsAre("missing lm label", "additional lm label"));
}

TEST(Baseline, MissingAndAdditionalTrajectories) {
  auto found = records();
  found[1].errors.resize(2);
  BaselineReport report = check(found);
  EXPECT_FALSE(report.passed);
  EXPECT_THAT(findings(report), ::testing::Contains("missing lm circle"));
  found = records();
  testing::add_errors(found[1], "new", {0});
  report = check(found);
  EXPECT_FALSE(report.passed);
  EXPECT_THAT(findings(report), ElementsAre("additional lm new"));
}

// Of no error, so that no sum shows that it is gone.
TEST(Baseline, AMissingTrajectoryFailsByItself) {
  auto made = records();
  testing::add_errors(made[1], "still", {0, 0});
  const BaselineReport report = check_baseline(make_baseline(made, tolerances()), records());
  EXPECT_THAT(findings(report), ElementsAre("missing lm still"));
  EXPECT_FALSE(report.passed);
}

TEST(Baseline, RunsWithoutAResult) {
  auto found = records();
  found[1].cost.reset();
  BaselineReport report = check(found);
  EXPECT_THAT(findings(report), ElementsAre("moved lm J"));
  EXPECT_FALSE(report.passed);
  EXPECT_EQ(report.table.rows[0][4].value, 100);
  EXPECT_EQ(report.table.rows[0][5].text, "none");
  found = records();
  found[1].cost.reset();
  found[1].errors.clear();
  EXPECT_THAT(findings(check(found)), ElementsAre("moved lm J", "missing lm circle", "missing lm line_x"));
  found = records();
  found[2].kind = "run";
  found[2].cost = 5;
  EXPECT_THAT(findings(check(found)), ElementsAre("moved x kind", "moved x J"));
  found = records();
  found[1].kind = "skipped";
  EXPECT_FALSE(check(found).passed);
}

TEST(Baseline, NotANumberOnlyMeetsNotANumber) {
  auto made = records();
  made[1].errors = {made[1].errors[0]};  // one repetition: no standard deviation
  const Baseline baseline = make_baseline(made, tolerances());
  EXPECT_TRUE(check_baseline(baseline, made).passed);
  auto found = made;
  found[1].errors[0].max_error[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(check_baseline(baseline, found).passed);
  found = made;
  found[1].cost = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(check_baseline(baseline, found).passed);
  found = made;
  found[1].errors.push_back(found[1].errors[0]);
  EXPECT_FALSE(check_baseline(baseline, found).passed) << "sigma is 0 now";
}

TEST(Baseline, RepeatsAreRepresentedByTheirMedianRun) {
  const Baseline baseline =
      make_baseline({run_record("pso", 3, 1), run_record("pso", 1, 2), run_record("pso", 2, 3)});
  ASSERT_EQ(baseline.entries.size(), 1u);
  EXPECT_EQ(baseline.entries[0].cost, 2);
  EXPECT_EQ(baseline.entries[0].evaluations, 30);
}

TEST(Baseline, RefusesWhatCannotBeABaseline) {
  EXPECT_THAT([] { make_baseline({}); },
              ThrowsMessage<std::invalid_argument>("a baseline needs at least one run record, got 0"));
  Tolerances bad = tolerances();
  bad.error_m = -1;
  EXPECT_THAT(
      [&] { make_baseline(records(), bad); },
      ThrowsMessage<std::invalid_argument>("tolerance error_m: found -1, expected a finite number >= 0"));
  bad = tolerances();
  bad.evaluations_factor = 0.5;
  EXPECT_THROW(make_baseline(records(), bad), std::invalid_argument);
  bad.evaluations_factor = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(make_baseline(records(), bad), std::invalid_argument);
  auto mixed = records();
  mixed.push_back(mixed[1]);
  mixed.back().dataset_sha256 = "other";
  EXPECT_THAT([&] { make_baseline(mixed, tolerances()); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("two different results are called 'lm'")));
  EXPECT_THROW(check(mixed), std::invalid_argument);
}

TEST(BaselineFileErrors, NameFileAndPath) {
  const std::string text = to_json_text(make_baseline(records(), tolerances()));
  const auto with = [&](const char* pointer, const nlohmann::json& value) {
    auto json = nlohmann::json::parse(text);
    json[nlohmann::json::json_pointer(pointer)] = value;
    return reading_error(json.dump());
  };
  EXPECT_EQ(with("/entries/1/errors/line_x/x/e_max", "big"),
            ": /entries/1/errors/line_x/x/e_max: found \"big\", expected a number");
  EXPECT_EQ(with("/schema_version", 7), ": /schema_version: found 7, expected 1");
  EXPECT_EQ(with("/tolerances/error_m", -1), ": /tolerances/error_m: found -1, expected a tolerance >= 0");
  EXPECT_EQ(with("/tolerances/error_m", nullptr),
            ": /tolerances/error_m: found null, expected a tolerance >= 0");
  EXPECT_EQ(with("/tolerances/evaluations_factor", 0.5),
            ": /tolerances/evaluations_factor: found 0.5, expected null or a factor >= 1");
  EXPECT_THAT(with("/tolerances/cost", 1),
              HasSubstr(": /tolerances: found unknown key \"cost\", expected one of cost_rel"));
  EXPECT_THAT(with("/entries/0/tolerances/x", 1),
              HasSubstr(": /entries/0/tolerances: found unknown key \"x\""));
  EXPECT_THAT(with("/entries/0/costs", 1), HasSubstr(": /entries/0: found unknown key \"costs\""));
  EXPECT_THAT(with("/entries/0/errors/line_x/z", 1),
              HasSubstr(": /entries/0/errors/line_x: found unknown key \"z\""));
  EXPECT_THAT(with("/entries/0/kind", "guess"),
              HasSubstr(": /entries/0/kind: found \"guess\", expected \"run\", \"eval"));
  EXPECT_EQ(with("/entries", nlohmann::json::array()),
            ": /entries: found an array of 0, expected at least one entry");
  EXPECT_EQ(with("/entries/3/problem", 4), ": /entries/3/problem: found 4, expected a text");
  EXPECT_EQ(with("/entries/1/label", "nominal"),
            ": /entries/1: found a second entry with the label \"nominal\", expected one");
  EXPECT_EQ(with("/entries/1/tolerances", {{"cost_relative", 0.5}}), "accepted");
}

TEST(BaselineFileErrors, BrokenFiles) {
  EXPECT_THAT(reading_error("{\n\"schema_version\": 1,\n oops}"), HasSubstr(":3: broken JSON: syntax error"));
  EXPECT_THAT(reading_error(""), HasSubstr(":1: broken JSON: syntax error"));
  EXPECT_EQ(reading_error("[]"), ": /: found an array of 0, expected an object");
  EXPECT_EQ(reading_error("{\"schema_version\": 1}"), ": /: found no key \"tolerances\", expected it");
  EXPECT_THAT(reading_error(R"({"schema_version": 1, "tolerances": {"cost_relative": 0}, "entries": []})"),
              HasSubstr(": /tolerances: found no key \"error_m\""));
  EXPECT_THAT([] { read_baseline("/no/such.json"); },
              ThrowsMessage<std::runtime_error>(HasSubstr("/no/such.json: cannot be read")));
}

// Ten runs of a random solver; evaluations are 10, 20, ..
std::vector<RunRecord> noisy(double first, int count = 10) {
  std::vector<RunRecord> list;
  for (int i = 0; i < count; ++i) list.push_back(run_record("pso", first + 0.01 * i, i + 1));
  return list;
}

TEST(BaselineSamples, AMedianMustMoveForSure) {
  const Baseline baseline = make_baseline(noisy(1), tolerances());
  ASSERT_EQ(baseline.entries.at(0).samples.at("cost").size(), 10u);
  EXPECT_TRUE(check_baseline(baseline, noisy(1)).passed);
  const BaselineReport chance = check_baseline(baseline, noisy(1.02));
  EXPECT_TRUE(chance.passed) << "beyond 1e-6, but not significant";
  EXPECT_THAT(chance.table.notes, ::testing::Contains(HasSubstr("without being significant: 1.")));
  const BaselineReport moved = check_baseline(baseline, noisy(1.5));
  EXPECT_FALSE(moved.passed);
  ASSERT_EQ(moved.table.rows.size(), 1u);
  EXPECT_THAT(moved.table.rows[0][3].text, HasSubstr("J, median (p = "));
  EXPECT_EQ(*moved.table.rows[0][6].value, 0.5);
  Baseline wide = baseline;
  wide.entries[0].tolerances.cost_relative = 0.6;
  EXPECT_TRUE(check_baseline(wide, noisy(1.5)).passed) << "significant, but within the tolerance";
}

TEST(BaselineSamples, FailedRunsAndEffortCountToo) {
  const Baseline baseline = make_baseline(noisy(1), tolerances());
  auto found = noisy(1);
  for (RunRecord& r : found) r.cost.reset();
  EXPECT_FALSE(check_baseline(baseline, found).passed);
  found = noisy(1);
  for (RunRecord& r : found) r.evaluations += 200;
  EXPECT_FALSE(check_baseline(baseline, found).passed);
  for (RunRecord& r : found) r.evaluations = 1;
  EXPECT_TRUE(check_baseline(baseline, found).passed) << "fewer evaluations";
}

// All moves here are significant: it is the tolerance that decides.
TEST(BaselineSamples, TolerancesAreOfTheMedian) {
  Tolerances wide = tolerances();
  wide.cost_relative = 0.01;  // of 100.045
  const Baseline cost = make_baseline(noisy(100), wide);
  EXPECT_TRUE(check_baseline(cost, noisy(100.99)).passed);
  EXPECT_TRUE(check_baseline(cost, noisy(99.01)).passed);
  EXPECT_FALSE(check_baseline(cost, noisy(101.01)).passed);
  EXPECT_FALSE(check_baseline(cost, noisy(98.99)).passed);
  const auto longer_by = [](std::int64_t evaluations) {
    auto list = noisy(1);
    for (RunRecord& r : list) r.evaluations += evaluations;
    return list;
  };
  const Baseline twice = make_baseline(longer_by(45), tolerances());  // 55 to 145, the median is 100
  EXPECT_TRUE(check_baseline(twice, longer_by(145)).passed);
  const BaselineReport report = check_baseline(twice, longer_by(146));
  EXPECT_FALSE(report.passed);
  ASSERT_EQ(report.table.rows.size(), 1u);
  EXPECT_THAT(report.table.rows[0][3].text, HasSubstr("evaluations, median (p = "));
  EXPECT_EQ(report.table.rows[0][6].value, 101);
  EXPECT_EQ(report.table.rows[0][7].value, 100);
}

TEST(BaselineSamples, RoundTripAndSingleRuns) {
  auto records = noisy(1);
  records[3].cost.reset();
  const std::string text = to_json_text(make_baseline(records, tolerances()));
  const BaselineFile file(text);
  EXPECT_EQ(to_json_text(read_baseline(file.path())), text);
  EXPECT_THAT(text, HasSubstr("\"cost\": [1.0,1.01,1.02,null,1.04"));
  // One run on the other side: value by value.
  EXPECT_FALSE(check_baseline(read_baseline(file.path()), {run_record("pso", 1.5)}).passed);
  EXPECT_TRUE(make_baseline({run_record("lm", 1)}).entries[0].samples.empty());
}

}  // namespace
}  // namespace odobench
