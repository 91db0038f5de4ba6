// Classical calibrations beside solvers, as starts of them, and calibrations of one set judged on another.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "reports/records/record.hpp"
#include "tests/support/refusal.hpp"

namespace odobench {
namespace {

using nlohmann::json;
using testing::content;
using testing::expect_refusal;
using ::testing::HasSubstr;
using testing::kData;
using testing::kUsage;
using ::testing::Not;
using testing::ProcessResult;
using testing::run_bench;
using testing::TemporaryFolder;

// Small sets of robots with known truth, and a run on that of the differential one.
struct Sets {
  TemporaryFolder folder;
  std::string data(const std::string& robot) const { return (folder / robot / "set.json").string(); }
  std::string runs() const { return (folder / "runs").string(); }
  Sets() {
    for (const std::string robot : {"diff", "omni3", "tricycle"})
      EXPECT_EQ(run_bench({"demo", "--robot=" + robot, "--out=" + (folder / robot).string()}).exit_code, 0);
    EXPECT_EQ(run_bench({"--solver=lm,pso[inertia=0.7,swarm=9]", "--repeat=2", "--max-evals=200",
                         "--data=" + data("diff"), "--classical=censi,kallasi", "--start=censi", "--quiet",
                         "--out=" + runs()})
                  .exit_code,
              0);
  }
};
const Sets& sets() {
  static const Sets made;
  return made;
}

json table_of(const ProcessResult& result, const std::string& id) {
  const json all = json::parse(result.out).at("tables");
  for (const json& table : all)
    if (table.at("id") == id) return table;
  ADD_FAILURE() << "no table " << id << " in " << result.out << result.err;
  return {{"rows", json::array()}};
}

std::vector<std::string> column(const json& table, const std::string& id) {
  std::vector<std::string> values;
  for (const json& row : table.at("rows")) values.push_back(row.at(id).get<std::string>());
  return values;
}

const RunRecord& labelled(const std::vector<RunRecord>& records, const std::string& label) {
  for (const RunRecord& r : records)
    if (r.label == label) return r;
  ADD_FAILURE() << "no record " << label;
  return records.front();
}

TEST(CliClassical, RowsBesideSolvers) {
  const ProcessResult run = run_bench({"--solver=lm", "--data=" + sets().data("diff"), "--cost=segments",
                                       "--classical", "--quiet", "--format=json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json solvers = table_of(run, "solvers");
  const std::vector<std::string> labels = column(solvers, "solver");
  for (const char* name : {"umbmark", "jung_chung", "circles", "ivanjko", "antonelli", "censi"})
    EXPECT_THAT(labels, ::testing::Contains(std::string("classical:") + name));
  EXPECT_THAT(labels, Not(::testing::Contains("classical:lin")));
  bool skipped = false, compared = false;
  double lm = 0, censi = 0;
  for (const json& row : solvers.at("rows")) {
    if (row.at("solver") == "classical:umbmark") {  // circles and lines are among the drives
      skipped = row.at("termination") == "skipped";
      EXPECT_THAT(row.at("message").get<std::string>(), HasSubstr("square"));
      EXPECT_TRUE(row.at("cost").is_null());
    }
    if (row.at("solver") == "classical:censi") censi = row.at("cost").get<double>();
    if (row.at("solver") == "lm")
      lm = row.at("cost").is_object() ? row.at("cost").at("value").get<double>()
                                      : row.at("cost").get<double>();
    compared = lm > 0 && censi > 0;
  }
  EXPECT_TRUE(skipped);
  ASSERT_TRUE(compared);
  EXPECT_LE(lm, censi);
  EXPECT_LT(censi, 1.5 * lm);  // its closed form ends near the minimum of segments
}

TEST(CliClassical, EvaluateSaysWhyARowIsSkipped) {
  const ProcessResult run = run_bench(
      {"evaluate", "--data=" + sets().data("tricycle"), "--classical=kallasi,censi", "--format=json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json cost = table_of(run, "cost");
  EXPECT_EQ(column(cost, "parameters"),
            (std::vector<std::string>{"nominal", "classical:kallasi", "classical:censi"}));
  EXPECT_THAT(cost.at("rows").at(2).at("message").get<std::string>(),
              HasSubstr("class tricycle, expected differential"));
  EXPECT_FALSE(cost.at("rows").at(1).at("cost").is_null());
  expect_refusal({"evaluate", "--data=" + sets().data("diff"), "--classical=umbmrk"}, kUsage,
                 {"--classical=umbmrk", "did you mean 'umbmark'?"});
  expect_refusal({"evaluate", "--data=" + sets().data("diff"), "--classical", "--side=-1"}, kUsage,
                 {"--side"});
  expect_refusal({"--problem=rosenbrock", "--classical", "--solver=lm"}, kUsage,
                 {"--classical", "no calibration"});
}

TEST(CliClassical, RecordsHoldFiguresAndDrives) {
  const std::vector<RunRecord> records = read_records(sets().runs() + "/runs.jsonl");
  const RunRecord& censi = labelled(records, "classical:censi");
  EXPECT_EQ(censi.kind, "evaluation");
  ASSERT_EQ(censi.parameters.size(), 3u);
  const RunRecord& kallasi = labelled(records, "classical:kallasi");
  EXPECT_EQ(kallasi.kind, "skipped");
  EXPECT_THAT(kallasi.message, HasSubstr("tricycle"));
  EXPECT_FALSE(kallasi.cost);
  const RunRecord& lm = labelled(records, "lm");
  EXPECT_EQ(lm.start, "censi");
  for (const char* name : {"drive.max_position", "drive.end_heading", "drive.sense"})
    EXPECT_EQ(lm.series.at(name).size(), lm.errors.size()) << name;
  // The trace of a run begins at its start: J there is that of the classical row.
  ASSERT_FALSE(lm.trace.empty());
  EXPECT_NEAR(lm.trace.front().cost, *censi.cost, 1e-9 * *censi.cost);
  EXPECT_GT(*labelled(records, "nominal").cost, 2 * *censi.cost);
}

TEST(CliClassical, MatrixHasNoParameters) {
  const ProcessResult run =
      run_bench({"evaluate", "--data=" + sets().data("omni3"), "--classical", "--format=json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(column(table_of(run, "maxima"), "parameters"),
            (std::vector<std::string>{"nominal", "classical:lin"}));
  for (const std::string& name : column(table_of(run, "parameters"), "parameters"))
    EXPECT_NE(name, "classical:lin");
  expect_refusal({"--solver=lm", "--data=" + sets().data("omni3"), "--start=lin"}, kData,
                 {"--start=lin", "a matrix, no parameters"});
}

TEST(CliClassical, StartsThatDoNotApply) {
  expect_refusal({"--solver=lm", "--data=" + sets().data("omni3"), "--start=censi"}, kData,
                 {"--start=censi", "class omni3, expected differential"});
  expect_refusal({"--solver=lm", "--data=" + sets().data("diff"), "--start=censl"}, kUsage,
                 {"--start=censl", "did you mean 'censi'?"});
  expect_refusal({"--solver=lm", "--problem=rosenbrock", "--start=censi"}, kUsage,
                 {"--start=censi", "rosenbrock", "no calibration"});
}

TEST(CliClassical, StartIsMovedIntoTheBox) {
  json set = json::parse(content(sets().data("diff")));
  bool changed = false;
  for (json& p : set.at("robot").at("parameters"))
    if (p.at("name") == "b") {
      p["lower"] = p.at("nominal").get<double>() * 0.9999;
      p["upper"] = p.at("nominal").get<double>() * 1.0001;
      changed = true;
    }
  ASSERT_TRUE(changed);
  const std::string file = (sets().folder / "diff" / "narrow.json").string();
  sets().folder.file("diff/narrow.json", set.dump());
  const ProcessResult run = run_bench({"--solver=lm", "--data=" + file, "--start=censi", "--format=json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("--start=censi: moved into the box: b from"));
}

TEST(CliClassical, CalibratedHereJudgedThere) {
  const std::string other = (sets().folder / "other").string();
  if (!std::filesystem::exists(other)) run_bench({"demo", "--robot=diff", "--seed=77", "--out=" + other});
  const std::string data = "--data=" + other + "/set.json";
  const ProcessResult all = run_bench({"evaluate", data, "--parameters=" + sets().runs(), "--format=json"});
  ASSERT_EQ(all.exit_code, 0) << all.err;
  EXPECT_EQ(column(table_of(all, "cost"), "parameters"),
            (std::vector<std::string>{"nominal", "classical:censi@runs", "lm@runs",
                                      "pso[inertia=0.7,swarm=9]@runs"}));
  EXPECT_THAT(all.err, HasSubstr("other data"));
  const ProcessResult one =
      run_bench({"evaluate", data, "--parameters=nominal," + sets().runs() + ":pso[inertia=0.7,swarm=9]",
                 "--format=json"});
  ASSERT_EQ(one.exit_code, 0) << one.err;
  EXPECT_EQ(column(table_of(one, "cost"), "parameters"),
            (std::vector<std::string>{"nominal", "pso[inertia=0.7,swarm=9]@runs"}));
  // The best of both runs.
  double best = 1e9, value = 0;
  for (const RunRecord& r : read_records(sets().runs() + "/runs.jsonl"))
    if (r.solver == "pso" && *r.cost < best) best = *r.cost, value = r.parameters.at(0).value;
  const json parameters = table_of(one, "parameters");
  const json& cell =
      parameters.at("rows").back().at(parameters.at("columns").at(1).at("id").get<std::string>());
  EXPECT_NEAR((cell.is_object() ? cell.at("value") : cell).get<double>(), 1000 * value, 1e-9);
  expect_refusal({"evaluate", data, "--parameters=" + sets().runs() + ":lmm"}, kUsage,
                 {"no such row", "did you mean 'lm'?"});
}

TEST(CliClassical, OtherRobotsAreRefusedOrTold) {
  expect_refusal({"evaluate", "--data=" + sets().data("omni3"), "--parameters=" + sets().runs()}, kData,
                 {"another robot", "omni3", "only there b [m], r_left [m], r_right [m]", "only here R [m]"});
  const ProcessResult mount = run_bench({"--solver=lm", "--data=" + sets().data("diff"), "--mount", "--quiet",
                                         "--out=" + (sets().folder / "mounted").string()});
  ASSERT_EQ(mount.exit_code, 0) << mount.err;
  expect_refusal(
      {"evaluate", "--data=" + sets().data("diff"), "--parameters=" + (sets().folder / "mounted").string()},
      kData, {"only there mount_x [m]", "--mount"});
  json set = json::parse(content(sets().data("diff")));
  for (json& p : set.at("robot").at("parameters"))
    if (p.at("name") == "b") p["nominal"] = p.at("nominal").get<double>() * 1.01;
  const std::string file = sets().folder.file("diff/longer.json", set.dump());
  const ProcessResult told =
      run_bench({"evaluate", "--data=" + file, "--parameters=" + sets().runs() + ":lm"});
  EXPECT_EQ(told.exit_code, 0) << told.err;
  EXPECT_THAT(told.err, HasSubstr("nominal values differ: b "));
  const ProcessResult same =
      run_bench({"evaluate", "--data=" + sets().data("diff"), "--parameters=" + sets().runs() + ":lm"});
  EXPECT_THAT(same.err, Not(HasSubstr("nominal values differ")));
  EXPECT_THAT(same.err, Not(HasSubstr("other data")));
}

TEST(CliClassical, PageShowsEndsOfBothSenses) {
  const std::string page = (sets().folder / "page.html").string();
  const ProcessResult report = run_bench({"report", sets().runs(), "--out=" + page, "--overwrite"});
  ASSERT_EQ(report.exit_code, 0) << report.err;
  const std::string text = content(page);
  EXPECT_THAT(text, HasSubstr("Ends of drives in both senses"));
  EXPECT_THAT(text, HasSubstr("E_max,syst"));
  // A build without charts has tables only.
  if (run_bench({"--version"}).out.find("without charts") != std::string::npos) return;
  EXPECT_THAT(text, HasSubstr("s,sense,kind,x,y"));
  EXPECT_THAT(text, HasSubstr("0,clockwise,centre,"));
  EXPECT_THAT(text, HasSubstr("0,counter-clockwise,centre,"));
}

}  // namespace
}  // namespace odobench
