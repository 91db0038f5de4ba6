// `bench discretise`, `bench fuse` and `bench tune` as their users meet them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "datasets/dataset.hpp"
#include "reports/records/record.hpp"
#include "tests/support/measures.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench {
namespace {

using nlohmann::json;
using testing::content;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::lines;
using testing::ProcessResult;
using testing::run_bench;
using testing::TemporaryFolder;

const std::string kSource = source_dir().string();
const std::string kTurn = kSource + "/datasets/systems/turn3d.json";
const std::string kHeading = kSource + "/datasets/sensors/heading_only.json";

void expect_refusal(const std::vector<std::string>& words, int code, const std::string& part) {
  const ProcessResult result = run_bench(words);
  EXPECT_EQ(result.exit_code, code) << result.err;
  EXPECT_THAT(result.out, IsEmpty());
  EXPECT_EQ(lines(result.err).size(), 1u) << result.err;
  EXPECT_THAT(result.err, HasSubstr(part));
}

TEST(CliDiscretise, PrintsTheMatrices) {
  const ProcessResult console = run_bench({"discretise", "--system=" + kTurn, "--period=1", "--order=3"});
  ASSERT_EQ(console.exit_code, 0) << console.err;
  EXPECT_THAT(console.out, HasSubstr("F, state transition (turn3d, T = 1 s, series of order 3)"));
  EXPECT_THAT(console.out, HasSubstr("v_x [m/s]"));
  EXPECT_THAT(console.out, HasSubstr("Error of the series of order 3"));
  const ProcessResult text = run_bench({"discretise", "--system=" + kTurn, "--period=1", "--format=json"});
  ASSERT_EQ(text.exit_code, 0) << text.err;
  const json root = json::parse(text.out);
  // Rodrigues: the velocity's turn about (0, c, c) by 2 pi / 100.
  EXPECT_NEAR(root.at("F").at(3).at(3).get<double>(), std::cos(2 * std::acos(-1.0) / 100), 1e-14);
  EXPECT_EQ(root.at("Q").size(), 6u);
  EXPECT_TRUE(root.at("order").is_null());
  const ProcessResult latex =
      run_bench({"discretise", "--system=" + kSource + "/datasets/systems/constant_acceleration.json",
                 "--period=0.01", "--format=latex"});
  ASSERT_EQ(latex.exit_code, 0) << latex.err;
  EXPECT_THAT(latex.out, HasSubstr("F = \\begin{bmatrix}\n    1 & 0.01 & 5 \\cdot 10^{-5} \\\\\n"));
  EXPECT_THAT(latex.out, HasSubstr("\\Psi = \\begin{bmatrix}"));
}

TEST(CliDiscretise, RefusesBadSystems) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& text, const std::string& part) {
    expect_refusal({"discretise", "--system=" + folder.file("s.json", text), "--period=1"}, 3, part);
  };
  refused(R"({"A": [[1, 2]]})", "A is 1 x 2, expected a square matrix");
  refused(R"({"A": [[1, 2], [3]]})", "/A/1: found a row of 1, expected 2");
  refused(R"({"A": [[1]], "B": [[1], [2]]})", "B is 2 x 1, expected 1 rows");
  refused(R"({"A": [[1]], "G": [[1]]})", "G without Qc");
  refused(R"({"A": [[1]], "G": [[1]], "Qc": [[-1]]})", "Qc has the eigenvalue -1");
  refused(R"({"A": [[0, 1], [0, 0]], "G": [[1, 0], [0, 1]], "Qc": [[1, 2], [2, 1]]})", "eigenvalue -1");
  refused(R"({"A": [["x"]]})", "/A/0/0");
  refused(R"({"A": [[1]], "states": ["a", "b"]})", "2 names, expected 1");
  refused(R"({"A": [[1]], "C": [[1]]})", "unknown key \"C\"");
  refused(R"({"A": [[1]]]})", "broken JSON");
  refused(R"({"A": [[1e309]]})", ":1: /A/0/0: found 1e309, expected a number within the range of a double");
  expect_refusal({"discretise", "--system=" + kTurn, "--period=0"}, 2, "--period=0");
  expect_refusal({"discretise", "--system=" + kTurn, "--period=1", "--order=0"}, 2, "--order=0");
  expect_refusal({"discretise", "--period=1"}, 2, "--system");
  expect_refusal({"discretise", "--system=nowhere.json", "--period=1"}, 3, "nowhere.json");
}

json table(const json& root, const std::string& id) {
  for (const json& t : root.at("tables"))
    if (t.at("id") == id) return t;
  ADD_FAILURE() << "no table " << id;
  return {};
}

json row(const json& table, const std::string& key, const std::string& label) {
  for (const json& r : table.at("rows"))
    if (r.at(key) == label) return r;
  ADD_FAILURE() << "no row " << label;
  return {};
}

// The demo robot with parameters a part of the way from nominal to true.
std::string calibrated(const TemporaryFolder& folder, const std::string& name, double part) {
  const Dataset set = load_dataset(kSource + "/datasets/demo/set.json");
  json parameters{{"name", name}};
  for (std::size_t i = 0; i < set.robot.parameters.size(); ++i) {
    const RobotParameter& p = set.robot.parameters[i];
    parameters[p.name] = p.nominal + part * (set.known_parameters.at(0).values[i] - p.nominal);
  }
  return folder.file(name + ".json", parameters.dump());
}

TEST(CliFuse, SaysFirstThatTheSensorsAreSynthetic) {
  for (const std::string format : {"console", "md", "csv", "latex"}) {
    const ProcessResult run =
        run_bench({"fuse", "--sensors=" + kHeading, "--filter=ekf", "--format=" + format});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out.substr(0, 400), HasSubstr("SYNTHETIC SENSORS")) << format;
  }
}

TEST(CliFuse, MakesTheTablesOfTheThesis) {
  const TemporaryFolder folder;
  const std::string parameters = "--parameters=nominal," + calibrated(folder, "good", 0.9);
  const ProcessResult run = run_bench({"fuse", "--sensors=" + kHeading, parameters, "--format=json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json root = json::parse(run.out);
  EXPECT_EQ(root.at("tables").at(0).at("id"), "sensors");
  for (const char* label : {"nominal+ekf", "nominal+ukf", "good+ekf", "good+ukf"}) {
    EXPECT_EQ(table(root, std::string("errors.") + label).at("rows").size(), 6u);
    EXPECT_FALSE(row(table(root, "consistency"), "label", label).at("verdict").get<std::string>().empty());
  }
  EXPECT_EQ(table(root, "errors.line_x").at("rows").size(), 6u);
  const json totals = table(root, "totals");
  const auto total = [&](const char* label) {
    return row(totals, "parameters", label).at("total").get<double>();
  };
  EXPECT_LT(total("nominal+ekf"), total("nominal"));
  EXPECT_LT(total("good+ekf"), total("nominal+ekf"));
  // Odometry alone is what `bench evaluate` says.
  const ProcessResult evaluate = run_bench({"evaluate", parameters, "--format=json"});
  EXPECT_EQ(row(table(json::parse(evaluate.out), "totals"), "parameters", "good").at("total").get<double>(),
            total("good"));
  EXPECT_EQ(row(table(root, "consistency"), "label", "nominal").at("verdict"), nullptr);
  // Same seed, same bits, whatever the threads; another seed, other bits.
  EXPECT_EQ(run_bench({"fuse", "--sensors=" + kHeading, parameters, "--format=json", "--threads=1"}).out,
            run.out);
  EXPECT_NE(run_bench({"fuse", "--sensors=" + kHeading, parameters, "--format=json", "--seed=2"}).out,
            run.out);
}

// Totals of nominal, poor and good parameters without and with the filter.
struct Totals {
  double nominal, poor, good, nominal_ekf, poor_ekf, good_ekf;
};
Totals totals_of(const TemporaryFolder& folder, const std::string& sensors, int seed) {
  const ProcessResult run = run_bench(
      {"fuse", "--sensors=" + kSource + "/datasets/sensors/" + sensors + ".json", "--filter=none,ekf",
       "--parameters=nominal," + calibrated(folder, "poor", 0.5) + "," + calibrated(folder, "good", 0.72),
       "--format=json", "--seed=" + std::to_string(seed)});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const json totals = table(json::parse(run.out), "totals");
  const auto total = [&](const char* label) {
    return row(totals, "parameters", label).at("total").get<double>();
  };
  return {total("nominal"),     total("poor"),     total("good"),
          total("nominal+ekf"), total("poor+ekf"), total("good+ekf")};
}

// Table 67: NOM > PS > NOM+EKF > GA > PS+EKF > GA+EKF, with PS the poor and GA the better calibration.
TEST(CliFuse, OrdersAsTheThesisWhereTheCameraGivesTheHeading) {
  const TemporaryFolder folder;
  for (int seed = 1; seed <= 3; ++seed) {
    const Totals t = totals_of(folder, "heading_only", seed);
    EXPECT_GT(t.nominal, t.poor) << seed;
    EXPECT_GT(t.poor, t.nominal_ekf) << seed;
    EXPECT_GT(t.nominal_ekf, t.good) << seed;
    EXPECT_GT(t.good, t.poor_ekf) << seed;
    EXPECT_GT(t.poor_ekf, t.good_ekf) << seed;
  }
}

TEST(CliFuse, DoesNotOrderSoWhereTheCameraGivesThePosition) {
  const TemporaryFolder folder;
  const Totals t = totals_of(folder, "trusted_camera", 1);
  EXPECT_NEAR(t.nominal_ekf, t.good_ekf, 0.01 * t.good_ekf);  // the calibration does not matter any more
  EXPECT_NEAR(t.poor_ekf, t.good_ekf, 0.01 * t.good_ekf);
  EXPECT_GT(t.good_ekf, t.good);  // and the filter makes a good calibration worse
}

TEST(CliFuse, KnowsEveryFilterAndSensor) {
  const ProcessResult all =
      run_bench({"fuse", "--sensors=" + kSource + "/datasets/sensors/trusted_camera.json",
                 "--filter=none,ekf,ukf,ekf-smoothed,ukf-smoothed,ekf-literal"});
  EXPECT_EQ(all.exit_code, 0) << all.err;
  EXPECT_THAT(all.out, HasSubstr("nominal+ukf-smoothed"));
  const ProcessResult relative = run_bench(
      {"fuse", "--sensors=" + kSource + "/datasets/sensors/relative_camera.json", "--filter=ekf,ukf"});
  EXPECT_EQ(relative.exit_code, 0) << relative.err;
  EXPECT_THAT(relative.out, HasSubstr("relative pose"));
}

// heading_only.json with one piece replaced.
std::string changed(const TemporaryFolder& folder, const std::string& from, const std::string& to) {
  std::string text = content(kHeading);
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return folder.file("sensors.json", text.replace(at, from.size(), to));
}

TEST(CliFuse, RefusesBadInput) {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& from, const std::string& to, const std::string& part) {
    expect_refusal({"fuse", "--sensors=" + changed(folder, from, to)}, 3, part);
  };
  refused("\"type\": \"heading\"", "\"type\": \"lidar\"", "the unknown sensor type \"lidar\"");
  refused("\"sigma_heading\": 0.02", "\"sigma_heading\": -0.02", "sigma of the heading is -0.02");
  refused("\"rate_hz\": 30", "\"rate_hz\": 0", "rate_hz is 0");
  refused("\"rate_hz\": 30", "\"rate_hz\": 1e-9", "sensor 'camera' has no data in recording");
  refused("\"missing\": 0.02", "\"missing\": 1", "missing is 1");
  refused("\"name\": \"gyro\"", "\"name\": \"camera\"", "two sensors are called 'camera'");
  refused("\"sigma_yaw_rate\": 0.02", "\"sigma_yawrate\": 0.02", "unknown key \"sigma_yawrate\"");
  refused("\"seed\": 1", "\"seed\": -1", "/seed");
  refused("\"gate_probability\": 0.9999", "\"gate_probability\": 1", "gate probability is 1");
  refused("\"gate_probability\": 0.9999", "\"unscented\": {\"alpha\": 0}", "sigma points");
  expect_refusal({"fuse"}, 2, "--sensors");
  expect_refusal({"fuse", "--sensors=" + kHeading, "--filter=efk"}, 2, "did you mean 'ekf'?");
  expect_refusal({"fuse", "--sensors=" + kHeading, "--filter=ekf,ekf"}, 2, "given twice");
  expect_refusal({"fuse", "--sensors=" + kHeading, "--parameters=trut"}, 2, "did you mean 'truth'?");
  expect_refusal(
      {"fuse", "--sensors=" + kSource + "/datasets/sensors/relative_camera.json", "--filter=ekf-smoothed"}, 2,
      "relative poses");
}

TEST(CliTune, LowersTheCostWithSolversOfEveryKind) {
  const TemporaryFolder folder;
  const std::string out = folder / "tuned.json";
  const ProcessResult run = run_bench({"tune", "--sensors=" + kHeading, "--solver=lm,pso,ga,nlopt:bobyqa",
                                       "--max-evals=12", "--out=" + out, "--format=json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json root = json::parse(run.out);
  const json results = table(root, "tuning");
  const double before = row(results, "setting", "given").at("cost").get<double>();
  EXPECT_EQ(results.at("rows").size(), 5u);
  for (const char* solver : {"lm", "pso", "ga", "nlopt:bobyqa"})
    EXPECT_LE(row(results, "setting", solver).at("cost").get<double>(), before) << solver;
  EXPECT_LT(row(results, "setting", "lm").at("cost").get<double>(), before);
  // Headings say nothing about the wheels' velocity: it stays.
  EXPECT_EQ(row(table(root, "sigmas"), "parameter", "wheels.velocity").at("lm").get<double>(), 0.01);
  // The file it wrote is a sensors file, with other sigmas.
  EXPECT_NE(json::parse(content(out)).at("wheels"), json::parse(content(kHeading)).at("wheels"));
  EXPECT_EQ(run_bench({"fuse", "--sensors=" + out, "--filter=ekf"}).exit_code, 0);
  expect_refusal({"tune", "--sensors=" + kHeading, "--out=" + out}, 2, "--overwrite");
}

TEST(CliTune, LeavesRecordsOfEverySetting) {
  const TemporaryFolder folder;
  const std::string out = (folder / "records").string();
  const ProcessResult tuned =
      run_bench({"tune", "--sensors=" + (source_dir() / "datasets/sensors/heading_only.json").string(),
                 "--max-evals=8", "--format=json", "--records=" + out});
  ASSERT_EQ(tuned.exit_code, 0) << tuned.err;
  const nlohmann::json tables = nlohmann::json::parse(tuned.out).at("tables");
  const std::vector<RunRecord> records = read_records((folder / "records/runs.jsonl").string());
  const nlohmann::json& rows = tables.at(2).at("rows");
  ASSERT_EQ(records.size(), rows.size());
  for (std::size_t i = 0; i < records.size(); ++i) {
    EXPECT_EQ(records[i].problem, "tuning:likelihood");
    EXPECT_EQ(records[i].label, rows[i].at("setting"));
    EXPECT_EQ(records[i].cost, rows[i].at("cost").get<double>());
    EXPECT_EQ(records[i].measures.value("rmse_heading"), rows[i].at("rmse_heading").get<double>());
    testing::expect_as_in_schema_1(records[i]);
  }
  EXPECT_THAT(run_bench({"report", out}).out, ::testing::HasSubstr("nlopt:bobyqa"));
}

TEST(CliTune, RefusesBadInput) {
  expect_refusal({"tune", "--sensors=" + kHeading, "--filter=none"}, 2, "expected ekf or ukf");
  expect_refusal({"tune", "--sensors=" + kHeading, "--objective=best"}, 2, "expected likelihood or error");
  expect_refusal({"tune", "--sensors=" + kHeading, "--solver=lmm"}, 2, "lm");
  expect_refusal({"tune", "--sensors=" + kHeading, "--parameters=nominal,truth"}, 2, "expected one");
}

}  // namespace
}  // namespace odobench
