// Run records and statistics.
#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "base/json_node.hpp"
#include "reports/statistics/statistics.hpp"
#include "tests/support/data/report_records.hpp"

namespace odobench {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

std::uint64_t bits(double value) {
  return std::bit_cast<std::uint64_t>(value);
}

// A record in which no field has its default value.
RunRecord full_record() {
  RunRecord r = testing::calibration_record("pso[swarm=60]", "run", 98.11878293011678, 0.1);
  r.dataset_sha256 = "ab12";
  r.solver = "pso";
  r.options = {{"swarm", "60"}, {"variant", "thesis \"quoted\"\n"}};
  r.polish = "lm";
  r.seed = std::numeric_limits<std::uint64_t>::max();
  r.base_seed = 0x8000000000000001u;
  r.repetition = 7;
  r.start = "random";
  r.cost_before_polish = 98.2;
  r.evaluations = std::numeric_limits<std::int64_t>::max();
  r.cost_evaluations = 11;
  r.derivative_evaluations = 12;
  r.non_finite = 13;
  r.iterations = 14;
  r.trace = {{1, 0.001, 1135.3322706653605}, {50, 0.1, 1.0 / 3}};
  r.budget = {{"evaluations", 50000}};
  r.group = "steered";
  r.box = "0123456789abcdef";
  r.random = true;
  r.known = KnownAnswer{98.1, 7.5, true, 1e-17};
  r.check = OptimalityRecord{"a bounded Gauss-Newton step", 1.0 / 3, 1e-8, 1};
  r.measures = {{"gap_exact_mean", 1.0 / 3, "", Better::Lower, "a", true}, {"windows", 189, ""}};
  r.series = {{"nees", {1.0 / 3, 2}}};
  r.notes = {"a1 and b1 are barely determined", ""};
  r.context = {"some cpu", "g++ 12.2",      "Release",     "deadbeef", "0.1.0",
               2,          "bench --out=a", "Ceres 2.1.0", "avx2"};
  r.time_utc = "2026-11-22T10:00:00Z";
  return r;
}

// Compares every field through the one thing that holds them all; the JSON of the original is checked by hand
// below.
void expect_same(const RunRecord& a, const RunRecord& b) {
  EXPECT_EQ(to_json(a), to_json(b));
}

RunRecord read_back(const std::string& text) {
  return record_from(JsonNode::parse(text, "f"));
}

class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& content) {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() /
            (std::string("odobench_") + test->test_suite_name() + "_" + test->name() + ".jsonl");
    std::ofstream(path_, std::ios::binary) << content;
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

std::string reading_error(const std::string& content) {
  const TemporaryFile file(content);
  try {
    read_records(file.path());
  } catch (const std::runtime_error& error) {
    const std::string text = error.what();
    EXPECT_EQ(text.rfind(file.path(), 0), 0u) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    return text.substr(std::min(text.size(), file.path().size()));
  }
  return "read without complaint";
}

TEST(Record, EveryFieldSurvivesTheRoundTrip) {
  const RunRecord r = full_record();
  const RunRecord back = read_back(to_json_line(r));
  expect_same(r, back);
  EXPECT_EQ(back.label, "pso[swarm=60]");
  EXPECT_EQ(back.options, r.options);
  EXPECT_EQ(back.seed, r.seed);
  EXPECT_EQ(back.base_seed, r.base_seed);
  EXPECT_EQ(back.evaluations, r.evaluations);
  EXPECT_EQ(back.context.threads, 2);
  EXPECT_EQ(back.errors.at(1).trajectory, "line_x");
  EXPECT_EQ(back.errors.at(1).repetition, 2);
  EXPECT_EQ(back.parameters.at(0).at_bound, "upper");
  EXPECT_EQ(back.trace.at(1).evaluations, 50);
  EXPECT_EQ(back.notes, r.notes);
  EXPECT_EQ(back.group, r.group);
  EXPECT_EQ(back.measures.value("gap_exact_mean"), 1.0 / 3);
  EXPECT_EQ(back.series, r.series);
  EXPECT_EQ(back.budget, r.budget);
  EXPECT_EQ(back.context.command, r.context.command);
  EXPECT_EQ(back.context.libraries, r.context.libraries);
  EXPECT_EQ(back.box, r.box);
  EXPECT_EQ(back.random, true);
  ASSERT_TRUE(back.known && back.check);
  EXPECT_EQ(back.known->digits, 7.5);
  EXPECT_EQ(back.known->promise, 1e-17);
  EXPECT_TRUE(back.known->solved);
  EXPECT_EQ(back.check->value, 1.0 / 3);
  EXPECT_EQ(to_json(r).size(), 37u) << "a new field needs a place in both directions and in this test";
}

TEST(Record, DoublesKeepEveryBit) {
  const double values[] = {0.1,
                           1.0 / 3,
                           -0.0,
                           5e-324,
                           std::numeric_limits<double>::min(),
                           std::numeric_limits<double>::max(),
                           1135.3322706653605,
                           98.11878293011678,
                           -0.11639550755182906,
                           1e23,
                           9007199254740993.0,
                           std::nextafter(1.0, 2.0)};
  for (double value : values) {
    RunRecord r = full_record();
    r.cost = r.cost_before_polish = r.seconds = r.parameters[0].value = r.parameters[0].nominal =
        r.parameters[0].lower = r.parameters[0].upper = r.trace[0].cost = r.trace[0].seconds = value;
    r.errors[0].max_error = {value, value, value};
    const RunRecord back = read_back(to_json_line(r));
    for (double found : {*back.cost, *back.cost_before_polish, back.seconds, back.parameters[0].value,
                         back.parameters[0].nominal, back.parameters[0].lower, back.parameters[0].upper,
                         back.trace[0].cost, back.trace[0].seconds, back.errors[0].max_error[0],
                         back.errors[0].max_error[1], back.errors[0].max_error[2]})
      EXPECT_EQ(bits(found), bits(value)) << value;
  }
}

TEST(Record, NonFiniteBecomesNullAndReadsAsNotANumber) {
  RunRecord r = full_record();
  r.cost = kInf;
  r.cost_before_polish = std::nullopt;
  r.errors[0].max_error[2] = kNaN;
  r.trace[0].cost = -kInf;
  const auto json = nlohmann::json::parse(to_json_line(r));
  EXPECT_TRUE(json.at("cost").is_null());
  EXPECT_TRUE(json.at("errors").at(0).at("theta").is_null());
  const RunRecord back = read_back(json.dump());
  EXPECT_FALSE(back.cost.has_value());
  EXPECT_FALSE(back.cost_before_polish.has_value());
  EXPECT_TRUE(std::isnan(back.errors[0].max_error[2]));
  EXPECT_TRUE(std::isnan(back.trace[0].cost));
}

TEST(Record, LineIsOneLineOfValidUtf8) {
  RunRecord r = full_record();
  r.label = "line\nbreak \xff";
  const std::string line = to_json_line(r);
  EXPECT_EQ(line.find('\n'), std::string::npos);
  EXPECT_EQ(read_back(line).label, "line\nbreak \xEF\xBF\xBD");
}

TEST(Record, EveryMissingFieldIsNamed) {
  const auto complete = to_json(full_record());
  for (const auto& field : complete.items()) {
    auto broken = complete;
    broken.erase(field.key());
    if (field.key() == "notes" || field.key() == "group" || field.key() == "measures" ||
        field.key() == "series" || field.key() == "budget" || field.key() == "box" ||
        field.key() == "random" || field.key() == "known" || field.key() == "check") {
      const RunRecord without = read_back(broken.dump());
      EXPECT_EQ(without.notes.empty(), field.key() == "notes");
      EXPECT_EQ(without.group.empty(), field.key() == "group");
      EXPECT_EQ(without.measures.empty(), field.key() == "measures");
      EXPECT_EQ(without.series.empty(), field.key() == "series");
      EXPECT_EQ(without.budget.empty(), field.key() == "budget");
      EXPECT_EQ(without.box.empty(), field.key() == "box");
      EXPECT_EQ(!without.random, field.key() == "random");
      EXPECT_EQ(!without.known, field.key() == "known");
      EXPECT_EQ(!without.check, field.key() == "check");
      continue;
    }
    EXPECT_THAT([&] { read_back(broken.dump()); },
                ThrowsMessage<std::runtime_error>(
                    HasSubstr("f: /: found no key \"" + field.key() + "\", expected it")));
  }
}

TEST(Record, WrongTypesNameThePathAndBothTypes) {
  const auto with = [](const char* pointer, const nlohmann::json& value) {
    auto json = to_json(full_record());
    json[nlohmann::json::json_pointer(pointer)] = value;
    try {
      read_back(json.dump());
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(with("/parameters/1/lower", "0.1"), "f: /parameters/1/lower: found \"0.1\", expected a number");
  EXPECT_EQ(with("/label", 3), "f: /label: found 3, expected a text");
  EXPECT_EQ(with("/evaluations", 1.5), "f: /evaluations: found 1.5, expected an integer");
  EXPECT_EQ(with("/seed", -1), "f: /seed: found -1, expected an integer >= 0 of 64 bits");
  EXPECT_EQ(with("/iterations", std::numeric_limits<std::uint64_t>::max()),
            "f: /iterations: found 18446744073709551615, expected an integer");
  EXPECT_EQ(with("/repetition", 5'000'000'000),
            "f: /repetition: found 5000000000, expected an integer of 32 bits");
  EXPECT_EQ(with("/errors", nlohmann::json::object()), "f: /errors: found an object, expected an array");
  EXPECT_EQ(with("/context", nullptr), "f: /context: found null, expected an object");
  EXPECT_EQ(with("/options/swarm", true), "f: /options/swarm: found true, expected a text");
  EXPECT_EQ(with("/kind", "guess"),
            "f: /kind: found \"guess\", expected \"run\", \"evaluation\" or \"skipped\"");
  EXPECT_EQ(with("/parameters/0/at_bound", "left"),
            "f: /parameters/0/at_bound: found \"left\", expected \"\", \"lower\" or \"upper\"");
  EXPECT_THAT(with("/schema_version", 3), HasSubstr("f: /schema_version: found 3, expected 1 to 2"));
  EXPECT_EQ(with("/unheard_of", 1), "accepted");
}

TEST(Record, FilesAreReadLineByLine) {
  const std::string line = to_json_line(full_record());
  const TemporaryFile file(line + "\n\n" + line + "\r\n" + line);
  const auto records = read_records(file.path());
  ASSERT_EQ(records.size(), 3u);
  for (const RunRecord& record : records) expect_same(record, full_record());
}

TEST(Record, FileErrorsNameFileAndLine) {
  const std::string line = to_json_line(full_record());
  EXPECT_THAT(reading_error(line + "\n" + line.substr(0, line.size() / 2)),
              HasSubstr(":2: truncated record"));
  EXPECT_THAT(reading_error(line + "\n" + line.substr(0, line.size() / 2) + "\n"),
              HasSubstr(":2: broken JSON: syntax error"));
  EXPECT_THAT(reading_error(line + "\n{\"label\": nan}\n" + line),
              HasSubstr(":2: /label: found nan, expected a finite number"));
  EXPECT_THAT(reading_error("\n[]\n"), HasSubstr(":2: /: found an array of 0, expected an object"));
  EXPECT_THAT(reading_error("{\"schema_version\": 99}"),
              HasSubstr(":1: /schema_version: found 99, expected 1 to 2"));
  EXPECT_THAT(reading_error("{}"), HasSubstr(":1: /: found no key \"schema_version\""));
  EXPECT_THAT(reading_error("{\"cost\": 1e999}"), HasSubstr(":1: /cost: found 1e999"));
  EXPECT_EQ(reading_error("\n{\"cost\": 1, \"cost\": 2}\n"),
            ":2: /cost: found the key \"cost\" twice in one object, expected once");
  EXPECT_EQ(reading_error(""), "read without complaint");
  EXPECT_THAT(
      [] { read_records("/no/such/file.jsonl"); },
      ThrowsMessage<std::runtime_error>("/no/such/file.jsonl: cannot be read: No such file or directory"));
  EXPECT_THAT([] { read_records("/tmp"); },
              ThrowsMessage<std::runtime_error>(HasSubstr("/tmp: cannot be read")));
}

TEST(Statistics, FiniteNumbersGiveFiniteStatistics) {
  const ErrorStatistics e = error_statistics_of({1.6e308, 1.2e308, 0.8e308});
  EXPECT_NEAR(e.mean / 1.2e308, 1, 1e-15);
  EXPECT_NEAR(e.sigma / 0.4e308, 1, 1e-15);
  const Spread s = spread({-1.6e308, 1.6e308});
  EXPECT_EQ(s.median, 0);
  EXPECT_NEAR(s.lower_quartile / -0.8e308, 1, 1e-15);
}

TEST(Statistics, HandComputedErrors) {
  // Maximum 7, mean 4, squared deviations 4 + 1 + 0 + 9 + 0 = 14 over n - 1 = 4.
  const ErrorStatistics e = error_statistics_of({2, 3, 4, 7, 4});
  EXPECT_DOUBLE_EQ(e.max, 7);
  EXPECT_DOUBLE_EQ(e.mean, 4);
  EXPECT_DOUBLE_EQ(e.sigma, std::sqrt(14.0 / 4));
  EXPECT_THROW(error_statistics_of({}), std::invalid_argument);
}

TEST(Statistics, LargeNumbersOfASmallSpread) {
  const ErrorStatistics e = error_statistics_of({1e9, 1e9, 1e9 + 1});
  EXPECT_DOUBLE_EQ(e.mean, 1e9 + 1.0 / 3);
  EXPECT_NEAR(e.sigma, std::sqrt(1.0 / 3),
              1e-6);  // of deviations from the mean, not of squares of the numbers
  const ErrorStatistics zero = error_statistics_of({0, 0, 0});
  EXPECT_EQ(zero.mean, 0);
  EXPECT_EQ(zero.sigma, 0);
  EXPECT_EQ(error_statistics_of({1, kInf}).mean, kInf);
  EXPECT_EQ(error_statistics_of({0.1, 0.2, 0.4}).mean, (0.1 + 0.2 + 0.4) / 3);
}

TEST(Statistics, OneRepetitionHasNoStandardDeviation) {
  const ErrorStatistics e = error_statistics_of({2});
  EXPECT_EQ(e.max, 2);
  EXPECT_EQ(e.mean, 2);
  EXPECT_TRUE(std::isnan(e.sigma));
  EXPECT_DOUBLE_EQ(error_statistics_of({2, 4}).sigma, std::sqrt(2.0));
}

TEST(Statistics, NotANumberIsNotSwallowed) {
  for (const auto& values : {std::vector<double>{kNaN, 1, 2}, {1, kNaN, 2}, {1, 2, kNaN}}) {
    EXPECT_TRUE(std::isnan(error_statistics_of(values).max));
    EXPECT_TRUE(std::isnan(error_statistics_of(values).mean));
    EXPECT_TRUE(std::isnan(spread(values).median));
    EXPECT_TRUE(std::isnan(spread(values).max));
  }
}

TEST(Statistics, TrajectoriesKeepTheirOrderAndTheirRecordings) {
  RunRecord r;
  testing::add_errors(r, "z", {1, 3});
  testing::add_errors(r, "a", {5});
  testing::add_errors(r, "z", {8});
  const auto all = error_statistics(r.errors);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].trajectory, "z");
  EXPECT_DOUBLE_EQ(all[0].variables[0].mean, 4);
  EXPECT_DOUBLE_EQ(all[0].variables[1].max, 16);
  EXPECT_DOUBLE_EQ(all[1].variables[2].max, 15);
  const Totals totals = error_totals(all);
  EXPECT_DOUBLE_EQ(totals.sums[0], 9);
  EXPECT_DOUBLE_EQ(totals.sums[2], 27);
  EXPECT_DOUBLE_EQ(totals.total, 54);
}

TEST(Statistics, QuartilesFollowDefinitionSeven) {
  // numpy.percentile([1, 2, 4, 8], [25, 50, 75]) = 1.75, 3, 5.
  const Spread s = spread({8, 1, 4, 2});
  EXPECT_DOUBLE_EQ(s.lower_quartile, 1.75);
  EXPECT_DOUBLE_EQ(s.median, 3);
  EXPECT_DOUBLE_EQ(s.upper_quartile, 5);
  EXPECT_DOUBLE_EQ(s.interquartile_range(), 3.25);
  EXPECT_EQ(s.min, 1);
  EXPECT_EQ(s.max, 8);
  EXPECT_EQ(s.count, 4u);
  EXPECT_EQ(spread({5}).interquartile_range(), 0);
  EXPECT_EQ(spread({5}).median, 5);
  EXPECT_EQ(spread({1, 2, 3}).median, 2);
  EXPECT_EQ(spread({1, 2, kInf}).median, 2);
  EXPECT_EQ(spread({1, kInf, kInf, kInf}).median, kInf);
  EXPECT_THROW(spread({}), std::invalid_argument);
}

TEST(Statistics, ReproduceTheReferenceCells) {
  ODOBENCH_NEEDS_SHARED();
  const auto reference = testing::reference_json("calibration_vitko2024.json");
  int cells = 0;
  for (const RunRecord& record : testing::reference_records(reference)) {
    const std::string name = record.label == "nominal" ? record.label : record.label.substr(10);
    const auto& expected = reference.at("sets").at(name).at("errors");
    const auto found = error_statistics(record.errors);
    ASSERT_EQ(found.size(), 6u);
    for (const TrajectoryErrors& trajectory : found)
      for (std::size_t v = 0; v < 3; ++v, cells += 3) {
        const auto& cell = expected.at(trajectory.trajectory).at(kPoseVariables[v]);
        const ErrorStatistics& e = trajectory.variables[v];
        EXPECT_EQ(e.max, cell.at("e_max").get<double>());
        EXPECT_NEAR(e.mean, cell.at("e_mean_max").get<double>(), 1e-15);
        EXPECT_NEAR(e.sigma, cell.at("sigma").get<double>(), 1e-15);
      }
    const Totals totals = error_totals(found);
    for (std::size_t v = 0; v < 3; ++v)
      EXPECT_NEAR(totals.sums[v], expected.at("totals").at(kPoseVariables[v]).get<double>(), 1e-14);
    EXPECT_NEAR(totals.total, expected.at("totals").at("sum").get<double>(), 1e-14);
  }
  EXPECT_EQ(cells, 6 * 6 * 9);
}

}  // namespace
}  // namespace odobench
