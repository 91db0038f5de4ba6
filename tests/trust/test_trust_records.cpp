// Trust in records, tables, parameter files, and the profile of J.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/json_node.hpp"
#include "bench/studies/parameter_files.hpp"
#include "bench/studies/trust/profile_likelihood.hpp"
#include "bench/studies/trust_figures.hpp"
#include "problems/simulation/robot_demo.hpp"
#include "reports/kinds/calibration/calibration_tables.hpp"
#include "reports/kinds/trust/next_steps_tables.hpp"
#include "solvers/solve.hpp"
#include "tests/support/data/report_records.hpp"
#include "tests/support/data/vitko_problem.hpp"

namespace odobench {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// A calibration of a demo robot as load_calibration() makes it, without files.
LoadedProblem loaded_demo(const char* kinematics, std::size_t recordings = 100) {
  Dataset set = make_robot_demo(kinematics, 1);
  if (set.recordings.size() > recordings) set.recordings.resize(recordings);
  CalibrationOptions options;
  options.rule = set.robot.rule;
  const auto model = std::make_shared<const CalibrationProblem>(set.robot, set.recordings, options);
  LoadedProblem loaded{Problem(model), model, set, "set.json", "abc", ""};
  loaded.apart = std::make_shared<const RecordingsApart>(set.robot, model);
  return loaded;
}

RunRecord record_of(const LoadedProblem& loaded, const std::string& label) {
  const Result result = solve(loaded.problem, {"lm", {}}, loaded.problem.start(), {});
  RunRecord record = odobench::testing::calibration_record(label, "run", result.cost, 0.01);
  record.problem = loaded.name();
  record.dataset = loaded.dataset_name();
  record.parameters.clear();
  for (std::size_t i = 0; i < loaded.problem.parameters().size(); ++i) {
    const ParameterInfo& p = loaded.problem.parameters()[i];
    record.parameters.push_back(
        {p.name, p.unit, result.x[static_cast<Eigen::Index>(i)], p.nominal, p.lower, p.upper, ""});
  }
  describe_trust(loaded, result.x, record);
  return record;
}

const Table* find(const std::vector<Table>& tables, const std::string& id) {
  for (const Table& table : tables)
    if (table.id == id) return &table;
  return nullptr;
}
const Cell& cell(const Table& table, std::size_t row, const std::string& column) {
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (table.columns[c].id == column) return table.rows.at(row).at(c);
  throw std::out_of_range(column);
}

void expect_same(double a, double b) {
  EXPECT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << a << " " << b;
}

TEST(TrustRecords, ComeBackToTheBit) {
  for (const std::size_t recordings : {100U, 3U}) {
    const RunRecord record = record_of(loaded_demo("differential", recordings), "lm");
    ASSERT_TRUE(record.trust);
    const RunRecord again = record_from(JsonNode::parse(to_json_line(record), "f"));
    ASSERT_TRUE(again.trust);
    EXPECT_EQ(to_json_line(again), to_json_line(record));
    ASSERT_EQ(again.trust->determined.size(), 4U);
    for (std::size_t k = 0; k < 4; ++k) {
      const DeterminedRecord &a = record.trust->determined[k], &b = again.trust->determined[k];
      EXPECT_EQ(a.words, b.words);
      EXPECT_EQ(a.interval.reason, b.interval.reason);
      expect_same(a.interval.half_width, b.interval.half_width);
      expect_same(a.interval.same_half_width, b.interval.same_half_width);
      EXPECT_EQ(std::isfinite(a.interval.half_width), recordings == 100);
    }
  }
}

// What calibrate adds: explanations, the wide box, what to drive next; to the bit, and in the sentences.
TEST(TrustRecords, WhatIsLeftOpenComesBackAndIsSaid) {
  RunRecord record = record_of(loaded_demo("differential"), "lm");
  ASSERT_TRUE(record.trust);
  EXPECT_EQ(to_json_line(record).find("explanations"),
            std::string::npos);  // records without are as they were
  TrustRecord& trust = *record.trust;
  trust.twice_box = *record.cost * 0.75;
  trust.explanations = {
      {"contact_offset", "a contact offset", *record.cost * 0.2, 0.8, true, false, "offset", "m", 7e-3},
      {"speed_factor:turn", "slip", *record.cost * 0.5, 0.5, false, false, "", "", 0},
      {"steering_zeros", "zeros", *record.cost * 0.1, 0.9, true, true, "", "", 0}};
  NextStepsRecord& next = trust.next.emplace();
  next.first_words = "a contact offset";
  next.second_words = "the model as it is";
  next.drives = {
      {"decide", "contact_offset", "plain", "circle_0.2m_cw", "a small circle", false, 2, 3.1, 0.97, 14},
      {"decide", "contact_offset", "plain", "circle_0.2m_ccw", "a small circle", false, 2, 3, 0.97, 14}};
  const RunRecord again = record_from(JsonNode::parse(to_json_line(record), "f"));
  EXPECT_EQ(to_json_line(again), to_json_line(record));
  ASSERT_TRUE(again.trust->next);
  EXPECT_EQ(explanation_clause(again).sentence,
            "A contact offset explains 80 % of what is left ('bench models' compares more).");
  EXPECT_NEAR(explanation_clause(again).against, 50, 1e-12);
  EXPECT_NEAR(twice_box_clause(again).value, 25, 1e-12);
  EXPECT_NE(twice_box_clause(again).sentence.find("lowers J by 25.0 %"), std::string::npos);
  // The mirror image of a drive is no second one.
  EXPECT_EQ(
      next_drives_clause(again).sentence,
      "Next: circle_0.2m_cw (a small circle) twice decides between a contact offset and the model as it is "
      "('bench plan --data=SET.JSON --between=contact_offset,plain').");
  EXPECT_EQ(next_drives_clause(again).value, 2);
  trust.next.emplace().open = {"a1", "b1"};
  trust.next->largest_after = 0.8;
  EXPECT_NE(next_drives_clause(record).sentence.find("No drive known here settles a1 and b1"),
            std::string::npos);
  trust.next->settled = {"a1"};
  trust.next->drives = {{"settle", "", "", "line", "", true, 3, 0, 0, 10}};
  EXPECT_EQ(next_drives_clause(record).sentence, "Next: line again 3 times settles a1; 1 of 2 stay open.");
  trust.next.emplace().skipped = "it takes long";
  EXPECT_EQ(next_drives_clause(record).sentence, "What to drive next was not looked for: it takes long.");
  EXPECT_EQ(to_json_line(record_from(JsonNode::parse(to_json_line(record), "f"))), to_json_line(record));
  // Half widths of single parameters, from the record's own.
  double best = 1e9;
  for (const ParameterIntervalRecord& p : trust.parameters)
    for (const ParameterValue& v : record.parameters)
      if (v.name == p.name) best = std::min(best, 100 * p.interval.half_width / std::abs(v.nominal));
  EXPECT_NEAR(single_parameters_clause(record).value, best, 1e-12);
  for (ParameterIntervalRecord& p : trust.parameters) p.interval.half_width = 0.08;
  EXPECT_NE(single_parameters_clause(record).sentence.find("No single parameter is known better than"),
            std::string::npos);
}

TEST(TrustRecords, OldDeviationsGetTheNameThatSaysWhatTheyAre) {
  RunRecord record = odobench::testing::calibration_record("lm", "run", 1, 0.01);
  record.series = {{"standard_deviations", {0.1, 0.2}}, {"residual_deviation", {0.05}}};
  const RunRecord again = record_from(JsonNode::parse(to_json_line(record), "f"));
  EXPECT_EQ(again.series.count("standard_deviations"), 0U);
  EXPECT_EQ(again.series.at("sd_if_samples_were_independent").size(), 2U);
  EXPECT_FALSE(again.trust);
  record.series.erase("residual_deviation");  // those of a plan are what they are called
  EXPECT_EQ(record_from(JsonNode::parse(to_json_line(record), "f")).series.count("standard_deviations"), 1U);
}

TEST(TrustTables, SayWhatDrivesDetermine) {
  const std::vector<RunRecord> records = {record_of(loaded_demo("differential"), "lm")};
  const std::vector<Table> tables = comparison_tables(records);
  const Table* determined = find(tables, "determined");
  ASSERT_NE(determined, nullptr);
  ASSERT_EQ(determined->rows.size(), 4U);
  EXPECT_EQ(cell(*determined, 0, "words").text, "path factor along x");
  EXPECT_EQ(cell(*determined, 1, "unit").text, "deg/m");
  EXPECT_NEAR(*cell(*determined, 1, "estimate").value,
              records[0].trust->determined[1].value * 180 / 3.14159265358979, 1e-9);
  EXPECT_GT(*cell(*determined, 0, "half_width").value, 0);
  EXPECT_EQ(
      determined->notes.back(),
      "Intervals come from the spread between recordings; an error common to all of them is not in them.");
  const Table* intervals = find(tables, "intervals");
  ASSERT_NE(intervals, nullptr);
  EXPECT_EQ(intervals->rows.size(), 3U);
  ASSERT_NE(find(tables, "new_drives"), nullptr);
  for (const Format format : {Format::Console, Format::Markdown, Format::Csv, Format::Json, Format::Latex})
    EXPECT_THAT(render(tables, format), HasSubstr("turn factor"));
}

TEST(TrustTables, SayWhyThereIsNoInterval) {
  const std::vector<RunRecord> few = {record_of(loaded_demo("differential", 3), "lm")};
  const std::string text = render(comparison_tables(few), Format::Markdown);
  EXPECT_THAT(text, HasSubstr("3 recordings are too few for intervals"));
  EXPECT_THAT(text, Not(HasSubstr("an error common to all of them")));
  RunRecord plain = odobench::testing::calibration_record("lm", "run", 1, 0.01);
  EXPECT_EQ(find(comparison_tables({plain}), "determined"), nullptr);
}

TEST(ParameterFiles, HoldIntervalsOrTheReason) {
  const LoadedProblem loaded = loaded_demo("differential");
  RunRecord record = record_of(loaded, "lm");
  record.series["sd_if_samples_were_independent"] = {1e-6, 1e-6, 1e-6};
  const ParameterFile file = parameter_file(loaded, record);
  ASSERT_EQ(file.parameters.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_TRUE(file.parameters[i].half_width);
    EXPECT_EQ(*file.parameters[i].half_width, record.trust->parameters[i].interval.half_width);
    EXPECT_GT(*file.parameters[i].half_width, 1.96 * *file.parameters[i].sd_if_samples_were_independent);
  }
  const nlohmann::json out = nlohmann::json::parse(to_json_text(file));
  EXPECT_EQ(out["parameters"][0]["interval"]["half_width"], *file.parameters[0].half_width);
  EXPECT_FALSE(out["parameters"][0].contains("standard_deviation"));

  record.trust->parameters[0].interval.half_width = std::nan("");
  record.trust->parameters[0].interval.reason = "decided by the box: b on a bound";
  const ParameterFile held = parameter_file(loaded, record);
  EXPECT_FALSE(held.parameters[0].half_width);
  EXPECT_THAT(to_json_text(held), HasSubstr("\"decided_by\": \"decided by the box: b on a bound\""));
}

TEST(Profile, OfTheRealDrives) {
  ODOBENCH_NEEDS_SHARED();
  const nlohmann::json reference = odobench::testing::reference_json("trust_vitko2024.json");
  const auto model = odobench::testing::vitko_model();
  Vector start(12);
  for (Eigen::Index i = 0; i < 12; ++i)
    start[i] = reference["uncertainty"]["p_mm"][static_cast<std::size_t>(i)].get<double>() / 1000;
  for (const char* name : {"b3", "r4"}) {
    const nlohmann::json& wanted = reference["profile"][name];
    const ParameterInfo* info = nullptr;
    for (const ParameterInfo& p : model->parameters())
      if (p.name == name) info = &p;
    std::vector<double> values;  // the same to rounding, inside the box
    for (const auto& shift : wanted["relative_shift"])
      values.push_back(std::clamp(info->nominal + shift.get<double>() * std::abs(info->nominal), info->lower,
                                  info->upper));
    const std::vector<ProfilePoint> points = profile_likelihood(model, name, values, start);
    for (std::size_t k = 0; k < points.size(); ++k)
      EXPECT_NEAR(points[k].cost, wanted["J"][k].get<double>(), 1e-9 * points[k].cost) << name << " " << k;
  }
  EXPECT_THROW(profile_likelihood(model, "b9", {0.1}, start), std::invalid_argument);
  EXPECT_THROW(profile_likelihood(model, "b3", {0.1}, start), std::invalid_argument);
}

TEST(Profile, EndsWhereItCrossesTheLimit) {
  const std::vector<ProfilePoint> points = {{0, 5, {}}, {1, 3, {}}, {2, 1, {}}, {3, 2, {}}};
  EXPECT_DOUBLE_EQ(profile_ends(points, 2).lower, 1.5);
  EXPECT_DOUBLE_EQ(profile_ends(points, 1.5).upper, 2.5);
  EXPECT_TRUE(std::isinf(profile_ends(points, 2).upper)) << "below the limit at its end";
}

}  // namespace
}  // namespace odobench
