// Records -> tables.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <set>

#include "reports/kinds/calibration/calibration_tables.hpp"
#include "tests/support/data/report_records.hpp"

namespace odobench {
namespace {

using testing::calibration_record;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::run_record;

std::vector<std::string> ids(const std::vector<Table>& tables) {
  std::vector<std::string> out;
  for (const Table& table : tables) out.push_back(table.id);
  return out;
}

const Table& table(const std::vector<Table>& tables, const std::string& id) {
  for (const Table& t : tables)
    if (t.id == id) return t;
  throw std::runtime_error("no table " + id);
}

std::vector<std::string> labels(const Table& t) {
  std::vector<std::string> out;
  for (const auto& row : t.rows) out.push_back(row.at(0).text);
  return out;
}

const Cell& cell(const Table& t, const std::string& label, const std::string& column) {
  for (const auto& row : t.rows)
    for (std::size_t c = 0; c < row.size(); ++c)
      if (row[0].text == label && t.columns[c].id == column) return row[c];
  throw std::runtime_error("no cell " + label + "/" + column);
}

RunRecord skipped(const std::string& label) {
  RunRecord r = run_record(label, 0);
  r.problem = "calibration";
  r.dataset = "demo";
  r.kind = "skipped";
  r.cost.reset();
  r.message = "needs bounds on every parameter";
  return r;
}

// Given in another order than they are shown.
std::vector<RunRecord> calibration_records() {
  return {calibration_record("lm", "run", 100, 0.1), skipped("x"),
          calibration_record("published", "evaluation", 300, 0.3),
          calibration_record("nominal", "evaluation", 1000, 0.4), calibration_record("ga", "run", 110, 0.2)};
}

TEST(ComparisonTables, OrderOfTablesAndRowsIsStable) {
  const auto tables = comparison_tables(calibration_records());
  EXPECT_THAT(ids(tables), ElementsAre("verdict", "overview", "found", "errors.line_x", "errors.circle",
                                       "parameters", "totals", "solvers"));
  EXPECT_THAT(labels(tables[0]), ElementsAre("use", "bounds"));
  EXPECT_THAT(labels(tables[1]), ElementsAre("nominal", "published", "lm", "x", "ga"));
  EXPECT_THAT(labels(tables[3]), ElementsAre("nominal", "published", "lm", "ga"));
  EXPECT_THAT(labels(tables[5]),
              ElementsAre("lower bound", "nominal", "upper bound", "published", "lm", "ga"));
  EXPECT_THAT(labels(tables[6]), ElementsAre("nominal", "published", "lm", "ga"));
  EXPECT_THAT(labels(tables[7]), ElementsAre("nominal", "published", "lm", "x", "ga"));
  EXPECT_TRUE(comparison_tables({}).empty());
  for (Format format : {Format::Console, Format::Markdown, Format::Csv, Format::Json, Format::Latex})
    EXPECT_FALSE(render(tables, format).empty());
}

TEST(ComparisonTables, ErrorsWithDifferenceToNominal) {
  const auto tables = comparison_tables(calibration_records());
  const Table& t = table(tables, "errors.line_x");
  // lm: maxima 0.1, 0.3; nominal: 0.4, 1.2; y twice, theta three times that.
  const Cell& e_max = cell(t, "lm", "e_max_x");
  EXPECT_DOUBLE_EQ(*e_max.value, 0.3);
  EXPECT_NEAR(*e_max.difference, 0.3 - 1.2, 1e-15);
  EXPECT_DOUBLE_EQ(*cell(t, "lm", "e_sr_y").value, 0.4);
  EXPECT_NEAR(*cell(t, "lm", "sigma_theta").value, 3 * std::sqrt(0.02), 1e-15);
  EXPECT_FALSE(cell(t, "nominal", "e_max_x").difference.has_value());
  EXPECT_THAT(render({t}, Format::Markdown),
              HasSubstr("| lm | **0.300000** (-0.900000) | **0.200000** (-0.600000) |"));
  EXPECT_EQ(t.columns.size(), 10u);
  EXPECT_EQ(t.columns[1].unit, "m");
  EXPECT_EQ(t.columns[7].unit, "rad");
}

TEST(ComparisonTables, WithoutNominalThereAreNoBrackets) {
  auto records = calibration_records();
  records.erase(records.begin() + 3);
  const auto tables = comparison_tables(records);
  for (const Table& t : tables) {
    for (const auto& row : t.rows)
      for (const Cell& c : row) EXPECT_FALSE(c.difference.has_value()) << t.id;
    for (const std::string& note : t.notes) EXPECT_THAT(note, Not(HasSubstr("In brackets")));
  }
  EXPECT_TRUE(cell(table(tables, "totals"), "lm", "change").empty());
  EXPECT_TRUE(cell(table(tables, "solvers"), "lm", "cost_ratio").empty());
  // A run that happens to be called nominal is no reference.
  records.push_back(calibration_record("nominal", "run", 1000, 0.4));
  EXPECT_TRUE(cell(table(comparison_tables(records), "totals"), "lm", "change").empty());
}

TEST(ComparisonTables, Totals) {
  const auto tables = comparison_tables(calibration_records());
  const Table& t = table(tables, "totals");
  // Means 0.2 and 0.2 over two trajectories: x 0.4, y 0.8, theta 1.2; nominal four times that.
  EXPECT_NEAR(*cell(t, "lm", "sum_e_sr_x").value, 0.4, 1e-15);
  EXPECT_NEAR(*cell(t, "lm", "sum_e_sr_theta").value, 1.2, 1e-15);
  EXPECT_NEAR(*cell(t, "lm", "total").value, 2.4, 1e-15);
  EXPECT_NEAR(*cell(t, "lm", "change").value, 2.4 - 9.6, 1e-14);
  EXPECT_NEAR(*cell(t, "lm", "change_percent").value, -75, 1e-12);
  EXPECT_TRUE(cell(t, "nominal", "change").empty());
}

TEST(ComparisonTables, SumsOverOtherTrajectoriesAreNotCompared) {
  auto records = calibration_records();
  records[0].errors.resize(2);  // lm without the circle
  const auto tables = comparison_tables(records);
  EXPECT_TRUE(cell(table(tables, "totals"), "lm", "total").empty());
  EXPECT_TRUE(cell(table(tables, "errors.circle"), "lm", "e_max_x").empty());
  EXPECT_FALSE(cell(table(tables, "totals"), "ga", "total").empty());
}

TEST(ComparisonTables, OneRepetitionShowsNoSigmaAndBrokenOnesShowNan) {
  RunRecord one = calibration_record("lm", "run", 1, 0.1);
  one.errors.resize(1);
  const auto single = comparison_tables({one});
  EXPECT_TRUE(cell(table(single, "errors.line_x"), "lm", "sigma_x").empty());
  EXPECT_FALSE(cell(table(single, "errors.line_x"), "lm", "e_max_x").empty());
  RunRecord broken = calibration_record("lm", "run", 1, std::numeric_limits<double>::quiet_NaN());
  EXPECT_THAT(render(comparison_tables({broken}), Format::Markdown), HasSubstr("| lm | nan | nan | nan |"));
}

TEST(ComparisonTables, ParametersInMillimetresWithMarks) {
  const auto tables = comparison_tables(calibration_records());
  const Table& t = table(tables, "parameters");
  EXPECT_THAT(render({t}, Format::Markdown), HasSubstr("| lm | 118.125 U | 25.400 |"));
  EXPECT_EQ(t.columns[1].unit, "mm");
  EXPECT_EQ(cell(t, "lower bound", "a1").value, 106.875);
  EXPECT_EQ(cell(t, "lm", "r1").mark, "");
  EXPECT_THAT(t.notes, Contains("U, L: on its upper, lower bound."));
  RunRecord other = calibration_record("lm", "run", 1, 0.1);
  other.parameters = {{"k", "", 0.123456789, 1, 0, 2, "lower"}, {"a", "rad", 1e-7, 1, 0, 2, ""}};
  const Table plain = table(comparison_tables({other}), "parameters");
  EXPECT_THAT(render({plain}, Format::Markdown), HasSubstr("| lm | 0.123457 L | 1e-07 |"));
  EXPECT_THAT(render({plain}, Format::Markdown), HasSubstr("| k | a [rad] |"));
}

TEST(ComparisonTables, DifferentBoxesAreSaid) {
  auto records = calibration_records();
  const auto mentions = [&] {
    return ::testing::PrintToString(table(comparison_tables(records), "parameters").notes);
  };
  EXPECT_THAT(mentions(), Not(HasSubstr("differ between the records")));
  records[4].parameters[0].upper = 0.2;
  EXPECT_THAT(mentions(), HasSubstr("differ between the records"));
}

TEST(ComparisonTables, NotesGoToTheParametersElseToTheSolvers) {
  const auto with = comparison_tables(calibration_records(), {"barely determined"});
  EXPECT_THAT(table(with, "found").notes, Contains("barely determined"));
  EXPECT_THAT(table(with, "parameters").notes, Not(Contains("barely determined")));
  EXPECT_THAT(table(with, "solvers").notes, Not(Contains("barely determined")));
  const auto without = comparison_tables({run_record("lm", 1)}, {"barely determined"});
  EXPECT_THAT(table(without, "solvers").notes, Contains("barely determined"));
}

TEST(ComparisonTables, Solvers) {
  const auto tables = comparison_tables(calibration_records());
  const Table& t = table(tables, "solvers");
  EXPECT_EQ(cell(t, "lm", "cost").value, 100);
  EXPECT_DOUBLE_EQ(*cell(t, "lm", "cost_ratio").value, 0.1);
  EXPECT_EQ(cell(t, "lm", "gap").value, 0);
  EXPECT_DOUBLE_EQ(*cell(t, "ga", "gap").value, 0.1);
  EXPECT_EQ(cell(t, "lm", "evaluations").value, 10);
  EXPECT_EQ(cell(t, "lm", "termination").text, "converged");
  EXPECT_EQ(cell(t, "lm", "message").text, "gradient 1e-11 <= 1e-10");
  EXPECT_EQ(cell(t, "lm", "active_bounds").text, "upper a1");
  EXPECT_EQ(cell(t, "nominal", "termination").text, "evaluated");
  EXPECT_TRUE(cell(t, "nominal", "evaluations").empty());
  EXPECT_EQ(cell(t, "x", "termination").text, "skipped");
  EXPECT_EQ(cell(t, "x", "message").text, "needs bounds on every parameter");
  EXPECT_TRUE(cell(t, "x", "cost").empty());
  EXPECT_THROW(cell(t, "lm", "cost_before_polish"), std::runtime_error);
}

TEST(ComparisonTables, PolishedRunsShowTheirCostBefore) {
  auto records = calibration_records();
  records[4].cost_before_polish = 120;
  const auto tables = comparison_tables(records);
  const Table& t = table(tables, "solvers");
  EXPECT_EQ(cell(t, "ga", "cost_before_polish").value, 120);
  EXPECT_TRUE(cell(t, "lm", "cost_before_polish").empty());
}

TEST(ComparisonTables, ActiveBoundsOnBothSides) {
  RunRecord r = calibration_record("lm", "run", 1, 0.1);
  r.parameters.push_back({"b1", "m", 0, 0, 0, 0, "lower"});
  r.parameters.push_back({"b2", "m", 0, 0, 0, 0, "upper"});
  const auto shown = [&] {
    return cell(table(comparison_tables({r}), "solvers"), "lm", "active_bounds").text;
  };
  EXPECT_EQ(shown(), "upper a1 b2; lower b1");
  r.parameters = {r.parameters[2]};
  EXPECT_EQ(shown(), "lower b1");
}

TEST(ComparisonTables, TestFunctionsHaveSolversAndRepeatsOnly) {
  RunRecord a = run_record("lm", 1e-30), b = run_record("pso", 2e-5, 1), c = run_record("pso", 1e-5, 2);
  a.parameters = {{"x1", "", 0.3, 0, -1, 1, ""}};
  EXPECT_THAT(ids(comparison_tables({a, b, c})), ElementsAre("solvers", "repeats"));
  EXPECT_THAT(ids(comparison_tables({a})), ElementsAre("solvers"));
}

TEST(ComparisonTables, GroupsPerProblemAndDataSet) {
  RunRecord other = calibration_record("lm", "run", 5, 0.1);
  other.dataset = "vitko2024";
  const auto tables =
      comparison_tables({calibration_record("lm", "run", 100, 0.1), other, run_record("lm", 1)});
  EXPECT_THAT(
      ids(tables),
      ElementsAre("calibration.demo.overview", "calibration.demo.found", "calibration.demo.errors.line_x",
                  "calibration.demo.errors.circle", "calibration.demo.parameters", "calibration.demo.totals",
                  "calibration.demo.solvers", "calibration.vitko2024.overview", "calibration.vitko2024.found",
                  "calibration.vitko2024.errors.line_x", "calibration.vitko2024.errors.circle",
                  "calibration.vitko2024.parameters", "calibration.vitko2024.totals",
                  "calibration.vitko2024.solvers", "sphere.solvers"));
  EXPECT_EQ(tables[2].title, "Errors on trajectory line_x (calibration, demo)");
  EXPECT_EQ(tables.back().title, "Solvers (sphere)");
  EXPECT_EQ(cell(tables[6], "lm", "gap").value, 0) << "the best J of another set does not count";
}

TEST(ComparisonTables, SetsOfOneNameAreKeptApartByTheirCheckSum) {
  RunRecord a = run_record("lm", 1), b = run_record("lm", 2);
  a.dataset = b.dataset = "mine";
  a.dataset_sha256 = "0123456789abcdef";
  b.dataset_sha256 = "fedcba9876543210";
  EXPECT_THAT(ids(comparison_tables({a, b})),
              ElementsAre("sphere.mine@01234567.solvers", "sphere.mine@fedcba98.solvers"));
}

std::vector<RunRecord> repeats() {
  std::vector<RunRecord> records{run_record("lm", 100)};
  const double costs[] = {100.00005, 130, 100.5, 101.5};
  for (int k = 0; k < 4; ++k) {
    records.push_back(run_record("pso", costs[k], k + 1));
    records.back().seconds = 0.1 * (k + 1);
  }
  RunRecord failed = run_record("pso", 0, 5);
  failed.cost.reset();
  failed.evaluations = 3;
  failed.termination = "failed";
  records.push_back(failed);
  return records;
}

TEST(Repeats, MedianSpreadAndSuccesses) {
  const auto tables = comparison_tables(repeats());
  const Table& t = table(tables, "repeats");
  EXPECT_THAT(labels(t), ElementsAre("pso"));
  EXPECT_EQ(cell(t, "pso", "runs").value, 5);
  EXPECT_EQ(cell(t, "pso", "failed").value, 1);
  EXPECT_EQ(cell(t, "pso", "within_1e-6").value, 1);
  EXPECT_EQ(cell(t, "pso", "within_1_percent").value, 2);
  // Of 100.00005, 100.5, 101.5, 130.
  EXPECT_DOUBLE_EQ(*cell(t, "pso", "cost_median").value, 101);
  EXPECT_DOUBLE_EQ(*cell(t, "pso", "cost_min").value, 100.00005);
  EXPECT_DOUBLE_EQ(*cell(t, "pso", "cost_max").value, 130);
  EXPECT_NEAR(*cell(t, "pso", "cost_iqr").value, 108.625 - 100.3750125, 1e-9);
  // Of 10, 20, 30, 40, 3.
  EXPECT_EQ(cell(t, "pso", "evaluations_median").value, 20);
  EXPECT_EQ(cell(t, "pso", "evaluations_min").value, 3);
  EXPECT_NEAR(*cell(t, "pso", "seconds_max").value, 0.4, 1e-15);
}

TEST(Repeats, OtherTablesShowTheMedianRunAndSaySo) {
  const auto tables = comparison_tables(repeats());
  const Table& t = table(tables, "solvers");
  // The third of five by J, the failed one last.
  EXPECT_EQ(cell(t, "pso", "cost").value, 101.5);
  EXPECT_EQ(cell(t, "pso", "evaluations").value, 40);
  EXPECT_THAT(t.notes, Contains("Of several runs of one label the median by J is shown: pso run 4 (of 5)."));
  auto records = repeats();
  records.pop_back();
  EXPECT_EQ(cell(table(comparison_tables(records), "solvers"), "pso", "cost").value, 100.5)
      << "lower of an even number";
}

TEST(Repeats, SuccessDoesNotDependOnTheScaleOfJ) {
  for (double scale : {1e-8, 1.0, 1e8}) {
    auto records = repeats();
    for (RunRecord& r : records)
      if (r.cost) *r.cost *= scale;
    const Table t = table(comparison_tables(records), "repeats");
    EXPECT_EQ(cell(t, "pso", "within_1e-6").value, 1) << scale;
    EXPECT_EQ(cell(t, "pso", "within_1_percent").value, 2) << scale;
  }
}

TEST(Repeats, AnOptimumOfZeroCanBeReached) {
  std::vector<RunRecord> records{run_record("lm", 0), run_record("pso", 1e-15, 1),
                                 run_record("pso", 1e-3, 2)};
  for (RunRecord& r : records) r.trace = {{1, 0, 10}};
  const auto tables = comparison_tables(records);
  EXPECT_EQ(cell(table(tables, "repeats"), "pso", "within_1e-6").value, 1);
  EXPECT_TRUE(cell(table(tables, "solvers"), "pso", "gap").empty()) << "a relative gap to zero means nothing";
}

TEST(Repeats, OneRunOrManyEvaluationsAreNoRepeats) {
  auto records = calibration_records();
  records.push_back(records[3]);
  records.push_back(records[1]);
  EXPECT_THAT(ids(comparison_tables(records)), Not(Contains("repeats")));
}

TEST(Repeats, SkippedRecordsDoNotCountAsRuns) {
  RunRecord no = skipped("pso");
  no.problem = "sphere";
  no.dataset = "";
  const auto tables = comparison_tables({no, run_record("pso", 3, 1), no, run_record("pso", 2, 2)});
  EXPECT_EQ(cell(table(tables, "repeats"), "pso", "runs").value, 2);
  EXPECT_EQ(cell(table(tables, "solvers"), "pso", "cost").value, 2);
  EXPECT_THAT(ids(comparison_tables({no, no})), ElementsAre("solvers"));
}

TEST(Repeats, AllFailedIsShown) {
  RunRecord r = run_record("pso", 0);
  r.cost.reset();
  const auto tables = comparison_tables({r, r});
  const Table& t = table(tables, "repeats");
  EXPECT_EQ(cell(t, "pso", "failed").value, 2);
  EXPECT_TRUE(cell(t, "pso", "cost_median").empty());
  EXPECT_TRUE(cell(t, "pso", "within_1e-6").empty());
}

TEST(EvaluationTables, OneSetHasTrajectoriesAsRows) {
  const auto tables = evaluation_tables({calibration_record("nominal", "evaluation", 1000, 0.4)}, {"a note"});
  EXPECT_THAT(ids(tables), ElementsAre("cost", "errors", "parameters", "totals"));
  EXPECT_THAT(labels(tables[1]), ElementsAre("line_x", "circle"));
  EXPECT_DOUBLE_EQ(*cell(tables[1], "line_x", "e_max_x").value, 1.2);
  EXPECT_EQ(cell(tables[0], "nominal", "cost").value, 1000);
  EXPECT_THAT(tables[2].notes, Contains("a note"));
}

TEST(EvaluationTables, SeveralSetsAreCompared) {
  const auto tables = evaluation_tables({calibration_record("mine", "evaluation", 100, 0.1),
                                         calibration_record("nominal", "evaluation", 1000, 0.4)});
  EXPECT_THAT(ids(tables), ElementsAre("cost", "errors.line_x", "errors.circle", "parameters", "totals"));
  EXPECT_THAT(labels(tables[0]), ElementsAre("nominal", "mine"));
  EXPECT_DOUBLE_EQ(*cell(tables[0], "mine", "cost_ratio").value, 0.1);
  EXPECT_TRUE(cell(tables[1], "mine", "e_max_x").difference.has_value());
}

// Without zeros at the end, which the thesis drops or adds at will: "0,02536", "0,0032080".
std::string digits(std::string text) {
  std::replace(text.begin(), text.end(), ',', '.');
  text.erase(text.find_last_not_of('0') + 1);
  return text;
}

TEST(EvaluationTables, PublishedNominalTables) {
  ODOBENCH_NEEDS_SHARED();
  const auto reference = testing::reference_json("calibration_vitko2024.json");
  std::vector<RunRecord> nominal;
  for (const RunRecord& r : testing::reference_records(reference))
    if (r.label == "nominal") nominal.push_back(r);
  const auto tables = evaluation_tables(nominal);
  const Table& t = table(tables, "errors");
  const auto published = testing::reference_json("published_tables_vitko2024.json");
  // Cells that differ and why: table 3 subtracts y_ref[0] in recording 10; tables 2 and 5 lost a last digit.
  const std::set<std::string> explained{"line_y/e_sr_y", "line_y/sigma_y", "line_x/e_max_x",
                                        "circle_cw/e_sr_theta"};
  int compared = 0;
  std::set<std::string> different;
  for (const auto& c : published.at("cells")) {
    if (c.at("kind") != "own" || c.at("method") != "NOM" || c.at("table").get<int>() > 7) continue;
    const std::string trajectory = c.at("trajectory_name"),
                      column = c.at("stat").get<std::string>() + "_" + c.at("variable").get<std::string>();
    const Cell& found = cell(t, trajectory, column);
    char text[32];
    std::snprintf(text, sizeof text, "%.*f", found.precision, *found.value);
    if (digits(c.at("raw")) != digits(text)) different.insert(trajectory + "/" + column);
    ++compared;
  }
  EXPECT_EQ(compared, 54);
  EXPECT_EQ(different, explained);
  EXPECT_NEAR(*cell(table(tables, "totals"), "nominal", "total").value, 1.273980, 5e-7);
}

TEST(ComparisonTables, PublishedSetsOnThePublishedRecordings) {
  ODOBENCH_NEEDS_SHARED();
  const auto tables =
      comparison_tables(testing::reference_records(testing::reference_json("calibration_vitko2024.json")));
  const Table& t = table(tables, "totals");
  const auto change = [&](const std::string& label) { return *cell(t, label, "change_percent").value; };
  EXPECT_NEAR(change("published:fmincon"), -70.1, 0.05);
  EXPECT_NEAR(change("published:lm"), -43.9, 0.05);
  EXPECT_NEAR(change("published:ga"), -42.4, 0.05);
  EXPECT_NEAR(change("published:pso"), -48.4, 0.05);
  EXPECT_NEAR(change("published:optimum"), -70.3, 0.05);
}

// Table 42's own arithmetic: sums as printed give the printed totals and percentages.
TEST(ComparisonTables, ArithmeticOfThePublishedTotals) {
  ODOBENCH_NEEDS_SHARED();
  const auto published = testing::reference_json("published_tables_vitko2024.json");
  std::vector<RunRecord> records;
  for (const auto& row : published.at("totals")) {
    if (row.at("table") != 42) continue;
    RunRecord r = run_record(row.at("method"), 1);
    if (r.label == "NOM") r.label = "nominal", r.kind = "evaluation";
    r.errors = {{"all", "all", 1, {row.at("sum_e_x_sr"), row.at("sum_e_y_sr"), row.at("sum_e_theta_sr")}}};
    records.push_back(r);
  }
  ASSERT_EQ(records.size(), 5u);
  const auto tables = comparison_tables(records);
  const Table& t = table(tables, "totals");
  for (const auto& row : published.at("totals")) {
    if (row.at("table") != 42) continue;
    const std::string label = row.at("method") == "NOM" ? "nominal" : row.at("method").get<std::string>();
    EXPECT_NEAR(*cell(t, label, "total").value, row.at("total").get<double>(), 1.01e-6);
    if (label == "nominal") continue;
    EXPECT_NEAR(*cell(t, label, "change").value, row.at("change").get<double>(), 1.01e-6);
    EXPECT_NEAR(*cell(t, label, "change_percent").value, row.at("change_percent").get<double>(), 0.0051);
  }
}

}  // namespace
}  // namespace odobench
