// Measures of records, and records of schema 1: tests/reports/records_schema_1.jsonl was written by the last
// version with that schema (fuse, filter, windows, run, plan, verify, tune; long lists cut short).
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/json_node.hpp"
#include "reports/kinds/entropy/entropy_tables.hpp"
#include "reports/kinds/entropy/window_tables.hpp"
#include "reports/kinds/fusion/fusion_record.hpp"
#include "reports/kinds/verification/verification_tables.hpp"
#include "reports/regression/metrics.hpp"
#include "tests/support/data_error.hpp"
#include "tests/support/measures.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench {
namespace {

using testing::data_error;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<RunRecord> schema_1_records(const std::string& problem) {
  std::vector<RunRecord> list;
  for (RunRecord& r : read_records((source_dir() / "tests/reports/records_schema_1.jsonl").string()))
    if (r.problem == problem) list.push_back(std::move(r));
  return list;
}

RunRecord written_again(const RunRecord& record) {
  return record_from(JsonNode::parse(to_json_line(record), "f"));
}

Measure measure_of(const RunRecord& record, const std::string& name) {
  const Measure* measure = record.measures.find(name);
  EXPECT_NE(measure, nullptr) << name;
  return measure == nullptr ? Measure{} : *measure;
}

void expect_measure(const RunRecord& record, const Measure& expected) {
  Measure found = measure_of(record, expected.name);
  EXPECT_TRUE(std::isfinite(found.value)) << expected.name;
  found.value = expected.value;
  testing::expect_same_measure(found, expected);
}

TEST(Measures, ByNameAndInItsOrder) {
  Measures m{{"b", 2, "m"}, {"a", 1, "", Better::Lower, "y"}};
  m.put({"c", 3, "s", Better::None, "x", true});
  m.put({"b", 4, "rad", Better::Higher, "y"});
  std::string names;
  for (const Measure& one : m) names += one.name;
  EXPECT_EQ(names, "abc");
  EXPECT_EQ(m.size(), 3u);
  EXPECT_EQ(m.value("b"), 4);
  EXPECT_EQ(m.find("b")->unit, "rad");
  EXPECT_FALSE(m.value("d"));
  EXPECT_EQ(m.find("d"), nullptr);
  EXPECT_THAT(m.subjects(), ElementsAre("x", "y"));
  EXPECT_THAT(Measures({{"a", 1, ""}}).subjects(), IsEmpty());
}

TEST(Measures, SayAllOfThemselvesInTheFile) {
  const double inf = std::numeric_limits<double>::infinity();
  RunRecord record;
  record.kind = "run";
  record.measures = {{"a", 0.1, "m/s^2", Better::Lower, "gyro.z"},
                     {"b", inf, "1/s", Better::Higher, "", true},
                     {"c", 3, ""}};
  EXPECT_EQ(to_json(record).at("schema_version"), 2);
  EXPECT_FALSE(to_json(record).contains("statistics"));
  EXPECT_EQ(to_json(record).at("measures").dump(),
            R"([{"better":"lower","name":"a","of":"gyro.z","unit":"m/s^2","value":0.1},)"
            R"({"better":"higher","name":"b","timing":true,"unit":"1/s","value":null},)"
            R"({"better":"none","name":"c","unit":"","value":3.0}])");
  const RunRecord back = written_again(record);
  ASSERT_EQ(back.measures.size(), 3u);
  testing::expect_same_measure(measure_of(back, "a"), measure_of(record, "a"));
  testing::expect_same_measure(measure_of(back, "c"), measure_of(record, "c"));
  EXPECT_TRUE(std::isnan(*back.measures.value("b")));
  EXPECT_TRUE(measure_of(back, "b").timing);
}

TEST(Measures, BadOnesAreRefusedWithTheirPlace) {
  const auto refused = [](const std::string& list) {
    return data_error([&] { measures_from(JsonNode::parse(list, "f")); });
  };
  const auto with = [&](const std::string& fields) {
    return refused(R"([{"name": "a", "value": 1, "unit": "", "better": "none"}, {)" + fields + "}]");
  };
  EXPECT_EQ(with(R"("name": "b", "value": 1, "unit": "", "better": "none", "unheard": 1)"), "");
  EXPECT_EQ(with(R"("name": "a", "value": 1, "unit": "", "better": "none")"),
            "f: /1/name: found \"a\" a second time, expected every name once");
  EXPECT_EQ(with(R"("name": "", "value": 1, "unit": "", "better": "none")"),
            "f: /1/name: found \"\", expected a name");
  EXPECT_EQ(with(R"("name": "b", "value": "1", "unit": "", "better": "none")"),
            "f: /1/value: found \"1\", expected a number");
  EXPECT_EQ(with(R"("name": "b", "value": 1, "unit": 1, "better": "none")"),
            "f: /1/unit: found 1, expected a text");
  EXPECT_EQ(with(R"("name": "b", "value": 1, "unit": "", "better": "more")"),
            "f: /1/better: found \"more\", expected \"lower\", \"higher\" or \"none\"");
  EXPECT_EQ(with(R"("name": "b", "value": 1, "unit": "")"), "f: /1: found no key \"better\", expected it");
  EXPECT_EQ(with(R"("name": "b", "value": 1, "unit": "", "better": "none", "of": 1)"),
            "f: /1/of: found 1, expected a text");
  EXPECT_EQ(with(R"("name": "b", "value": 1, "unit": "", "better": "none", "timing": 1)"),
            "f: /1/timing: found 1, expected true or false");
  EXPECT_EQ(refused("{}"), "f: /: found an object, expected an array");
  EXPECT_EQ(refused("[1]"), "f: /0: found 1, expected an object");
}

TEST(SchemaOne, NamesGetUnitDirectionAndWhatTheyAreOf) {
  const auto same = [](const Measure& expected) {
    testing::expect_same_measure(schema_1_measure(expected.name, expected.value), expected);
  };
  same({"windows_per_second", 1, "1/s", Better::Higher, "", true});
  same({"hamiltonian_mean", 1, "", Better::Higher});
  same({"hamiltonian_max", 1, ""});
  same({"noise.encoder.rms.after", 1, "m", Better::Lower, "encoder"});
  same({"noise.encoder_component.rms.after", 1, "m", Better::Lower, "encoder_component"});
  same({"noise.theta.ratio.after", 1, "", Better::Lower, "theta"});
  same({"noise.theta.max.before", 1, "deg", Better::None, "theta"});
  same({"track.end.after", 1, "m", Better::Lower});
  same({"track.end.zero", 1, "m"});
  same({"sensor.gyro.z.nis", 1, "", Better::None, "gyro.z"});  // a dot in the sensor's name
  same({"deviation.a1", 1, "", Better::None, "a1"});
  same({"arrival_heading.line_x", 1, "rad", Better::None, "line_x"});
  same({"r1", 1, "m"});
  same({"r12", 1, ""});  // no name of ours
  same({"of nobody", 1, ""});
  same({"", 1, ""});
}

TEST(SchemaOne, RecordsOfEveryVerbAreRead) {
  const std::vector<RunRecord> fused = schema_1_records("fusion");
  ASSERT_EQ(fused.size(), 2u);
  EXPECT_EQ(fused[0].measures.size(), 2u);
  expect_measure(fused[0], {"rmse_position", 0, "m"});
  const FusionRow row = fusion_row(fused[1]);
  EXPECT_TRUE(row.filtered);
  ASSERT_EQ(row.sensors.size(), 2u);
  EXPECT_EQ(row.sensors[0].name, "camera");
  EXPECT_EQ(row.sensors[0].used, 60867);
  EXPECT_EQ(row.sensors[0].dof, 3);
  EXPECT_EQ(row.sensors[1].name, "gyro");
  EXPECT_EQ(row.sensors[1].dof, 1);
  const std::vector<RunRecord> filtered = schema_1_records(kFilterProblem);
  ASSERT_EQ(filtered.size(), 1u);
  expect_measure(filtered[0], {"windows_per_second", 0, "1/s", Better::Higher, "", true});
  expect_measure(filtered[0], {"noise.ay.max.after", 0, "m/s^2", Better::Lower, "ay"});
  EXPECT_EQ(filter_tables(filtered).size(), 3u);
  const std::vector<RunRecord> windows = schema_1_records(kWindowProblem);
  ASSERT_EQ(windows.size(), 4u);
  expect_measure(windows[0], {"ax12", 0, "m/s^2"});
  EXPECT_EQ(window_tables(windows, false)[1].rows.size(), 4u);
  const std::vector<RunRecord> verified = schema_1_records(kVerificationProblem);
  ASSERT_EQ(verified.size(), 1u);
  EXPECT_EQ(arrival_tables(verified)[0].columns.size(), 1 + 2 * verified[0].measures.subjects().size());
  EXPECT_EQ(verified[0].measures.subjects().size(), 6u);
  ASSERT_EQ(schema_1_records("planning").size(), 1u);
  expect_measure(schema_1_records("planning")[0], {"deviation.b4", 0, "", Better::None, "b4"});
  ASSERT_EQ(schema_1_records("tuning:likelihood").size(), 1u);
  ASSERT_EQ(schema_1_records("calibration").size(), 1u);
  EXPECT_TRUE(schema_1_records("calibration")[0].measures.empty());
}

// Measures, too, survive being written as schema 2: what is compared with old files stays comparable.
TEST(SchemaOne, RecordsComeBackAsSchemaTwo) {
  std::size_t count = 0;
  for (const RunRecord& r : read_records((source_dir() / "tests/reports/records_schema_1.jsonl").string())) {
    const RunRecord back = written_again(r);
    EXPECT_EQ(to_json(back), to_json(r));
    ASSERT_EQ(back.measures.size(), r.measures.size());
    for (const Measure& m : r.measures) testing::expect_same_measure(measure_of(back, m.name), m);
    count += r.measures.size();
  }
  EXPECT_GT(count, 150u);
}

// Each schema has its own place for figures, what stands in the other's is a field that is not known.
TEST(SchemaOne, HasNoMeasuresAndSchemaTwoNoStatistics) {
  nlohmann::json json = to_json(RunRecord{});
  json["kind"] = "run";
  json["statistics"] = {{"gain_mean", 1}};
  json["measures"] = {{{"name", "gain_max"}, {"value", 2}, {"unit", "m"}, {"better", "lower"}}};
  const auto names = [&](int schema) {
    json["schema_version"] = schema;
    std::string list;
    for (const Measure& m : record_from(JsonNode::parse(json.dump(), "f")).measures) list += m.name + ' ';
    return list;
  };
  EXPECT_EQ(names(1), "gain_mean ");
  EXPECT_EQ(names(2), "gain_max ");
  for (const int schema : {0, 3})
    EXPECT_NE(data_error([&] { names(schema); }).find("expected 1 to 2"), std::string::npos);
}

TEST(Metrics, TakeWhatTheMeasureSays) {
  RunRecord first, second;
  first.kind = second.kind = "evaluation";
  first.measures = {{"drift", 0.5, "m", Better::Lower}, {"speed", 7, "1/s", Better::Higher, "", true}};
  second.measures = {{"drift", 0.6, "m", Better::Lower}};
  ComparisonRow row;
  row.kind = "evaluation";
  row.runs = {&first, &second};
  const std::vector<Metric> metrics = metrics_of(row);
  const Metric* drift = find_metric(metrics, "drift");
  const Metric* speed = find_metric(metrics, "speed");
  ASSERT_TRUE(drift != nullptr && speed != nullptr);
  EXPECT_EQ(drift->unit, "m");
  EXPECT_EQ(drift->better, Better::Lower);
  EXPECT_FALSE(drift->timing);
  EXPECT_EQ(drift->family, "statistics");
  EXPECT_THAT(drift->values, ElementsAre(0.5, 0.6));
  EXPECT_EQ(speed->better, Better::Higher);
  EXPECT_TRUE(speed->timing);
  EXPECT_EQ(speed->values[1], -std::numeric_limits<double>::infinity());  // the worst
}

}  // namespace
}  // namespace odobench
