// Tables of filter runs and of windows, from records made by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reports/kinds/entropy/entropy_tables.hpp"
#include "reports/kinds/entropy/window_tables.hpp"

namespace odobench {
namespace {

using ::testing::HasSubstr;

RunRecord window_record(const std::string& window, const std::string& method, double h, double rounded) {
  RunRecord r;
  r.problem = kWindowProblem;
  r.dataset = "file/" + window;
  r.group = "g";
  r.label = r.solver = method;
  r.kind = "run";
  r.termination = "converged";
  r.cost = -h;
  r.iterations = 4;
  r.evaluations = 100;
  r.seconds = 2e-6;
  r.parameters = {{"eps", "", -0.123456, 0, -1, 1, ""}, {"eps2", "", -0.0, 0, -1, 1, ""}};
  r.measures = {{"samples", 10, ""},
                {"hamiltonian", h, ""},
                {"hamiltonian_rounded", rounded, ""},
                {"hamiltonian_zero", -200, ""},
                {"hamiltonian_exact", -100, ""},
                {"hamiltonian_relaxed", -90, ""},
                {"r1", 0.5, "m"}};
  return r;
}

const Cell& cell(const Table& table, std::size_t row, const std::string& id) {
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (table.columns[c].id == id) return table.rows.at(row).at(c);
  throw std::runtime_error("no column " + id);
}

TEST(WindowTables, GapsSharesAndMeans) {
  std::vector<RunRecord> records = {
      window_record("a", "greedy", -100, -100), window_record("a", "lm", -90, -104),
      window_record("b", "greedy", -103, -103), window_record("b", "lm", -92, -101)};
  records[2].iterations = 8;
  RunRecord skipped = window_record("b", "qp", 0, 0);
  skipped.kind = "skipped";
  skipped.message = "needs what is not there";
  skipped.measures = {{"samples", 10, ""}};
  records.push_back(skipped);
  const std::vector<Table> tables = window_tables(records, false);
  ASSERT_EQ(tables.size(), 2u);
  EXPECT_EQ(cell(tables[0], 0, "window").text, "a");
  EXPECT_EQ(cell(tables[0], 0, "t").text, "-0.123 0");
  EXPECT_EQ(cell(window_tables(records, true)[0], 0, "t").text, "-0.123456 0");
  EXPECT_EQ(cell(tables[0], 1, "gap_exact").value, -10);
  EXPECT_EQ(cell(tables[0], 4, "t").text, "needs what is not there");
  EXPECT_FALSE(cell(tables[0], 4, "hamiltonian").value);

  const Table& methods = tables[1];
  ASSERT_EQ(methods.rows.size(), 3u);
  EXPECT_EQ(cell(methods, 0, "gap_mean").value, 1.5);
  EXPECT_EQ(cell(methods, 0, "gap_max").value, 3);
  EXPECT_EQ(cell(methods, 0, "at_optimum").value, 50);
  EXPECT_EQ(cell(methods, 0, "iterations_mean").value, 6);
  EXPECT_EQ(cell(methods, 0, "iterations_max").value, 8);
  EXPECT_EQ(cell(methods, 1, "gap_mean").value, 2.5);  // of the rounded t
  EXPECT_EQ(cell(methods, 1, "gap_relaxed_mean").value, 1);
  EXPECT_EQ(cell(methods, 1, "gap_relaxed_max").value, 2);
  EXPECT_DOUBLE_EQ(*cell(methods, 1, "time").value, 2);
  EXPECT_EQ(cell(methods, 2, "runs").value, 0);
  EXPECT_THAT(methods.notes.back(), HasSubstr("qp: no result for 1 windows: needs what is not there"));
}

// A file may lack what the program always writes together.
TEST(WindowTables, WithoutAnOptimumThereIsNoGap) {
  RunRecord r = window_record("a", "greedy", -100, -100);
  r.measures = {{"hamiltonian", -100, ""}, {"hamiltonian_rounded", -100, ""}};
  const std::vector<Table> tables = window_tables({r}, false);
  EXPECT_EQ(cell(tables[0], 0, "hamiltonian").value, -100);
  EXPECT_FALSE(cell(tables[0], 0, "gap_exact").value);
  EXPECT_EQ(cell(tables[1], 0, "runs").value, 0);
}

// At the optimum means within 1e-9 |H|.
TEST(WindowTables, TheToleranceOfTheOptimumIsRelative) {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    for (const auto& [gap, share] : {std::pair(0.9e-9, 100.0), std::pair(1.1e-9, 0.0)}) {
      RunRecord r = window_record("a", "m", 0, 0);
      r.measures.put({"hamiltonian_exact", -scale, ""});
      r.measures.put({"hamiltonian_rounded", -scale * (1 + gap), ""});
      EXPECT_EQ(cell(window_tables({r}, false)[1], 0, "at_optimum").value, share) << scale << " " << gap;
    }
  }
}

TEST(FilterTables, OnlyWhatWasMeasured) {
  RunRecord r;
  r.problem = kFilterProblem;
  r.label = "exact";
  r.dataset = "run";
  r.seconds = 0.5;
  r.notes = {"corrected: N 10"};
  r.measures = {{"rows", 200, ""}, {"windows", 191, ""}, {"hamiltonian_mean", -5, ""}};
  std::vector<Table> tables = filter_tables({r});
  ASSERT_EQ(tables.size(), 1u);
  EXPECT_EQ(cell(tables[0], 0, "windows").value, 191);
  EXPECT_FALSE(cell(tables[0], 0, "gap_exact_mean").value);
  EXPECT_EQ(tables[0].notes, std::vector<std::string>{"exact: corrected: N 10"});

  for (const char* measure : kNoiseMeasures) {
    r.measures.put({std::string("noise.ax.") + measure + ".before", 0.3, ""});
    r.measures.put({std::string("noise.ax.") + measure + ".after", 0.1, ""});
    r.measures.put({std::string("noise.ax.") + measure + ".zero", 0.2, ""});
  }
  r.measures.put({"track.end.before", 1, ""});
  r.measures.put({"track.max.before", 2, ""});
  tables = filter_tables({r});
  ASSERT_EQ(tables.size(), 3u);
  EXPECT_EQ(tables[0].id, "noise.exact");
  ASSERT_EQ(tables[0].rows.size(), 3u);
  EXPECT_NEAR(*cell(tables[0], 0, "factor").value, 3, 1e-12);
  EXPECT_NEAR(*cell(tables[0], 0, "zero_factor").value, 1.5, 1e-12);
  ASSERT_EQ(tables[1].rows.size(), 1u);
  EXPECT_EQ(cell(tables[1], 0, "max").value, 2);
  EXPECT_TRUE(filter_tables({}).empty());
}

}  // namespace
}  // namespace odobench
