// `bench export --to`: golden texts of every class, what is lost, and what is refused.
// ODOBENCH_RECORD_EXPORT=1 writes the golden texts anew.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>

#include "bench/studies/exporting/robot_export.hpp"
#include "bench/studies/parameter_files.hpp"
#include "datasets/robots/layouts.hpp"
#include "datasets/robots/robot.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench {
namespace {

namespace fs = std::filesystem;
using testing::content;
using testing::expect_refusal;
using ::testing::HasSubstr;
using testing::kData;
using testing::kUsage;
using testing::lines;
using ::testing::Not;
using testing::ProcessResult;
using testing::run_bench;
using testing::TemporaryFolder;

// A result that no optimiser has to find: parameter k is its nominal value and (k + 1) tenths of its box.
ParameterFile result_of(const std::string& kinematics) {
  const Robot robot = robot_of_class(kinematics, {});
  ParameterFile file;
  file.label = "lm";
  file.robot = "courier";
  file.kinematics = kinematics;
  std::vector<double> values, nominal;
  for (const RobotParameter& p : robot.parameters) {
    const double share = 0.05 * static_cast<double>(1 + values.size() % 7);
    nominal.push_back(p.nominal);
    values.push_back(p.nominal + share * (p.upper - p.nominal));
    FoundParameter found{{p.name, p.unit, values.back(), p.nominal, p.lower, p.upper, ""}, 1.25e-5};
    if (p.lower == p.upper) found.half_width.reset();
    file.parameters.push_back(found);
  }
  file.wheels = wheels_with(robot.table, values);
  file.nominal_wheels = wheels_with(robot.table, nominal);
  file.run_id = "0123456789ab";
  file.problem = "calibration[every_sample,arc]";
  file.dataset = "drives";
  file.dataset_sha256 = std::string(64, 'c');
  file.solver = "lm";
  file.time_utc = "2026-01-02T03:04:05Z";
  file.cost = 0.0125;
  return file;
}

class CliExport : public ::testing::Test {
 protected:
  std::string keep(const ParameterFile& file, const std::string& name = "lm") {
    fs::create_directories(folder_ / "run/parameters");
    folder_.file("run/parameters/" + name + ".json", to_json_text(file));
    return (folder_ / "run").string();
  }
  TemporaryFolder folder_;
};

// The scalars of a YAML document of nested objects, by path. Fails where a line is none of it.
std::map<std::string, std::string> scalars(const std::string& text) {
  static const std::regex line_of("( *)([A-Za-z_/][A-Za-z0-9_/]*):( ([^#]*[^# ]))?(  # .*)?");
  std::map<std::string, std::string> all;
  std::vector<std::string> open;
  for (const std::string& line : lines(text)) {
    if (line.starts_with("#")) continue;
    std::smatch m;
    if (!std::regex_match(line, m, line_of)) {
      ADD_FAILURE() << "no YAML: " << line;
      continue;
    }
    const std::size_t depth = static_cast<std::size_t>(m[1].length()) / 2;
    EXPECT_LE(depth, open.size()) << line;
    open.resize(std::min(depth, open.size()));
    std::string path;
    for (const std::string& key : open) path += key + ".";
    if (m[3].matched)
      EXPECT_TRUE(all.emplace(path + m[2].str(), m[4].str()).second) << line;
    else
      open.push_back(m[2]);
  }
  return all;
}

std::vector<std::string> classes() {
  std::vector<std::string> names;
  for (const robots::Layout& layout : robots::layouts()) names.push_back(layout.name);
  return names;
}

class ExportGolden : public CliExport, public ::testing::WithParamInterface<std::string> {
 protected:
  void expect_golden(const std::string& target, const std::string& extension) {
    const std::string run = keep(result_of(GetParam()));
    const std::string text = export_robot({run, target, "", "", false}).text;
    const fs::path golden = testing::source_dir() / "tests/golden/export" / (GetParam() + extension);
    if (std::getenv("ODOBENCH_RECORD_EXPORT") != nullptr) std::ofstream(golden) << text;
    EXPECT_EQ(text, content(golden)) << golden;
  }
};

TEST_P(ExportGolden, ControllersGetTheirKeys) {
  expect_golden("ros2", ".yaml");
  const std::string run = keep(result_of(GetParam()));
  for (const char* target : {"ros2", "yaml"})
    for (const auto& [path, value] : scalars(export_robot({run, target, "", "", false}).text)) {
      EXPECT_THAT(path, HasSubstr(".ros__parameters."));
      EXPECT_TRUE(value.front() == '"' || value.front() == '[' ||
                  std::regex_match(value, std::regex("-?[0-9]+\\.[0-9]+")))
          << path << ": " << value;
    }
}

TEST_P(ExportGolden, YamlIsReadByPython) {
  const std::string run = keep(result_of(GetParam()));
  std::string script = "import sys\ntry:\n import yaml\nexcept ImportError:\n sys.exit(77)\n";
  for (const char* target : {"ros2", "yaml"}) {
    const std::string file = (folder_ / (std::string(target) + ".yaml")).string();
    ASSERT_EQ(run_bench({"export", run, "--to=" + std::string(target), "--out=" + file}).exit_code, 0);
    script += "(node, inner), = yaml.safe_load(open('" + file +
              "')).items()\nassert list(inner) == ['ros__parameters']\n"
              "def see(x):\n for v in x.values():\n  see(v) if isinstance(v, dict) else None\n"
              "  assert isinstance(v, (dict, list, str, float)), v\nsee(inner)\n";
  }
  const int status = std::system(("python3 " + folder_.file("see.py", script) + " 2>&1").c_str());
  if (WEXITSTATUS(status) == 77 || WEXITSTATUS(status) == 127) GTEST_SKIP() << "needs python3 with yaml";
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST_P(ExportGolden, UrdfAndHeader) {
  expect_golden("urdf", ".urdf.xacro");
  expect_golden("c", ".h");
}

TEST_P(ExportGolden, JsonIsTheParameterFile) {
  const ParameterFile file = result_of(GetParam());
  const std::string run = keep(file);
  EXPECT_EQ(export_robot({run, "json", "", "", false}).text, to_json_text(file));
}

INSTANTIATE_TEST_SUITE_P(Classes, ExportGolden, ::testing::ValuesIn(classes()),
                         [](const auto& robot) { return "robot_" + robot.param; });

TEST_F(CliExport, MultipliersAreRelativeToNominalValuesUnlessAbsolute) {
  const std::string run = keep(result_of("differential"));
  const auto by = scalars(export_robot({run, "ros2", "", "", false}).text);
  const auto absolute = scalars(export_robot({run, "ros2", "", "base", true}).text);
  const std::string own = "diff_drive_controller.ros__parameters.", other = "base.ros__parameters.";
  EXPECT_EQ(by.at(own + "wheel_separation"), "0.300000");
  EXPECT_NEAR(std::stod(by.at(own + "wheel_separation_multiplier")), 1 + 0.05 * 0.15, 1e-9);
  EXPECT_EQ(absolute.at(other + "wheel_separation"), "0.302250");
  EXPECT_EQ(absolute.at(other + "wheel_separation_multiplier"), "1.000000000");
  for (const char* side : {"left", "right"}) {
    const std::string key = std::string(side) + "_wheel_radius_multiplier";
    EXPECT_NEAR(std::stod(by.at(own + key)) * std::stod(by.at(own + "wheel_radius")),
                std::stod(absolute.at(other + key)) * std::stod(absolute.at(other + "wheel_radius")), 1e-6);
  }
}

TEST_F(CliExport, SwerveModulesComeInTheOrderOfWpilib) {
  const std::string run = keep(result_of("4wis4wid"));
  const std::string text = export_robot({run, "wpilib", "", "", false}).text;
  EXPECT_THAT(text, ::testing::ContainsRegex("Translation2d\\(0[^-]*, 0[^-]*\\),  // front_left(.|\n)*"
                                             "Translation2d\\(0[^-]*, -(.|\n)*front_right(.|\n)*"
                                             "Translation2d\\(-[^-]*, 0(.|\n)*rear_left(.|\n)*"
                                             "Translation2d\\(-[^-]*, -[^-]*\\)\\);  // rear_right"));
}

TEST_F(CliExport, WhatIsLostIsSaidInTheFileAndOnStandardError) {
  const std::string run = keep(result_of("mecanum"));
  const std::string file = (folder_ / "c.yaml").string();
  const ProcessResult result = run_bench({"export", run, "--to=ros2", "--out=" + file, "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("half the difference"));
  EXPECT_THAT(content(file), HasSubstr("# lost: kinematics.wheels_radius"));
  EXPECT_EQ(nlohmann::json::parse(result.out)["tables"][0]["id"], "written");
  expect_refusal({"export", run, "--to=ros2", "--out=" + file}, kUsage, {"it exists", "--overwrite"});
  EXPECT_EQ(run_bench({"export", run, "--to=c", "--out=" + file, "--overwrite"}).exit_code, 0);
  EXPECT_THAT(content(file), HasSubstr("#define ODOMETRY_LX (0."));
}

TEST_F(CliExport, AMountAndABoundAreSaid) {
  ParameterFile file = result_of("tricycle");
  for (const char* name : {"mount_x", "mount_y"})
    file.parameters.push_back({{name, "m", 0.03, 0, -0.25, 0.25, ""}, 1e-4});
  file.parameters.push_back({{"mount_yaw", "rad", -0.02, 0, -0.5, 0.5, "lower"}, std::nullopt});
  const std::string run = keep(file);
  const ExportedRobot exported = export_robot({run, "ros2", "", "", false});
  EXPECT_THAT(exported.text, HasSubstr("static_transform_publisher --x 0.030000 --y 0.030000 --z 0.0 --yaw "
                                       "-0.020000 --frame-id base_link --child-frame-id tracker"));
  EXPECT_THAT(exported.warnings, ::testing::ElementsAre(HasSubstr("mount_yaw lies on its lower bound")));
  EXPECT_THAT(export_robot({run, "urdf", "", "", false}).text,
              HasSubstr("<origin xyz=\"0.030000 0.030000 0.0\" rpy=\"0 0 -0.020000\"/>"));
}

TEST_F(CliExport, NamesOutOfFilesDoNoHarm) {
  ParameterFile file = result_of("differential");
  file.kinematics = kOwnWheels;
  file.robot = "evil\x1b[2J\n# --> */";
  file.parameters[0].parameter.name = "on\": [x";
  file.parameters[1].parameter.name = "yes";
  file.wheels[0].drive[0].name = "9 \"wheel\"";
  const std::string run = keep(file);
  for (const char* target : {"yaml", "c", "urdf"}) {
    const std::string text = export_robot({run, target, "", "", false}).text;
    EXPECT_THAT(text, Not(HasSubstr("\x1b")));
    EXPECT_THAT(text, Not(HasSubstr("\n# --")));
  }
  EXPECT_THAT(export_robot({run, "urdf", "", "", false}).text, Not(HasSubstr("---")));
  EXPECT_THAT(export_robot({run, "yaml", "", "", false}).text, HasSubstr("\"on\\\": [x\": "));
  EXPECT_THAT(export_robot({run, "yaml", "", "", false}).text, HasSubstr("\"yes\": "));
  expect_refusal({"export", run, "--to=ros2"}, kUsage, {"no controller", "'wheels'", "--to=yaml"});
}

TEST_F(CliExport, RefusesWithTheNearestName) {
  const std::string run = keep(result_of("omni3"));
  ParameterFile second = result_of("omni3");
  second.label = "pso[swarm=9]";
  second.cost = 0.5;
  keep(second, "pso");
  EXPECT_EQ(export_robot({run, "json", "", "", false}).row, "lm");
  EXPECT_EQ(export_robot({run, "json", "pso[swarm=9]", "", false}).row, "pso[swarm=9]");
  expect_refusal({"export", run, "--to=rso2"}, kUsage, {"did you mean 'ros2'?", "wpilib"});
  expect_refusal({"export", run, "--to=ros2", "--row=lma"}, kUsage, {"did you mean 'lm'?", "pso[swarm=9]"});
  expect_refusal({"export", run, "--to=wpilib"}, kUsage, {"no kinematics", "omni3"});
  expect_refusal({"export", run, "--to=urdf", "--node=a"}, kUsage, {"--node"});
  expect_refusal({"export", run, "--to=yaml", "--node=a b"}, kUsage, {"--node=a b"});
  expect_refusal({"export", run, "--to=yaml", "--absolute"}, kUsage, {"--absolute"});
  expect_refusal({"export", run, "--to=yaml", "--tum", "--out=x"}, kUsage, {"one of"});
  expect_refusal({"export", run, "--to=yaml", "--json"}, kUsage, {"--out=FILE"});
  expect_refusal({"export", run, "--tum", "--row=lm", "--out=x"}, kUsage, {"--row"});
  expect_refusal({"export", run}, kUsage, {"--to", "--tum", "--csv"});
  expect_refusal({"export", folder_.path().string(), "--to=yaml"}, kData, {"no parameters", "bench run"});
  folder_.file("run/parameters/lm.json", "{\"schema\": \"odobench-parameters\", \"schema_version\": 2}");
  expect_refusal({"export", run, "--to=yaml"}, kData, {"lm.json: /schema_version: found 2, expected 1"});
}

TEST_F(CliExport, ARunKeepsTheBestRunOfEachLabelForEvaluateAndExport) {
  const std::string set = (folder_ / "demo/set.json").string(), out = (folder_ / "out").string();
  ASSERT_EQ(run_bench({"demo", "--robot=differential", "--out=" + (folder_ / "demo").string()}).exit_code, 0);
  ASSERT_EQ(run_bench({"--data=" + set, "--solver=lm,pso[swarm=8]", "--repeat=2", "--max-evals=200",
                       "--quiet", "--out=" + out})
                .exit_code,
            0);
  const ParameterFile kept = read_parameter_file(fs::path(out) / "parameters/pso-swarm-8-.json");
  EXPECT_EQ(kept.label, "pso[swarm=8]");
  double best = 1e300;
  for (const RunRecord& r : read_records(out + "/runs.jsonl"))
    if (r.label == kept.label) best = std::min(best, *r.cost);
  EXPECT_EQ(kept.cost, best);
  EXPECT_EQ(kept.robot, "differential");
  EXPECT_TRUE(kept.parameters[0].sd_if_samples_were_independent.has_value());
  EXPECT_TRUE(kept.parameters[0].half_width.has_value() != !kept.parameters[0].decided_by.empty());
  const ProcessResult both = run_bench(
      {"evaluate", "--data=" + set, "--json", "--parameters=" + out + "/parameters/lm.json," + out + ":lm"});
  ASSERT_EQ(both.exit_code, 0) << both.err;
  const nlohmann::json rows = nlohmann::json::parse(both.out)["tables"][0]["rows"];
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[1]["cost"], rows[2]["cost"]);
  const ProcessResult yaml = run_bench({"export", out, "--to=ros2", "--row=lm", "--out=-"});
  ASSERT_EQ(yaml.exit_code, 0) << yaml.err;
  EXPECT_THAT(yaml.out, HasSubstr("left_wheel_radius_multiplier: 0.9"));
  // A second run takes the files of the first away.
  ASSERT_EQ(
      run_bench({"--data=" + set, "--solver=lm", "--max-evals=20", "--quiet", "--overwrite", "--out=" + out})
          .exit_code,
      0);
  EXPECT_THAT(testing::files_below(fs::path(out) / "parameters"), ::testing::ElementsAre("lm.json"));
}

TEST_F(CliExport, RunsWithoutACalibrationHaveNoRobot) {
  const std::string out = (folder_ / "out").string();
  ASSERT_EQ(run_bench({"--problem=sphere,rosenbrock", "--solver=lm,pso", "--quiet", "--max-evals=50",
                       "--out=" + out})
                .exit_code,
            0);
  EXPECT_TRUE(fs::exists(fs::path(out) / "parameters/rosenbrock/lm.json"));
  expect_refusal({"export", out, "--to=yaml"}, kData, {"parameters of other problems alone"});
  // Labels may be longer than names of files.
  const std::string more = (folder_ / "more").string();
  ASSERT_EQ(run_bench({"--problem=sphere", "--solver=pso[swarm=8,inertia=0.7" + std::string(300, '0') + "]",
                       "--quiet", "--max-evals=50", "--out=" + more})
                .exit_code,
            0);
  EXPECT_EQ(testing::files_below(fs::path(more) / "parameters").size(), 1U);
}

TEST_F(CliExport, TracksAsCsv) {
  const std::string out = (folder_ / "out").string(), csv = (folder_ / "csv").string();
  ASSERT_EQ(run_bench({"--solver=lm", "--max-evals=20", "--quiet", "--out=" + out}).exit_code, 0);
  ASSERT_EQ(run_bench({"export", out, "--csv", "--out=" + csv}).exit_code, 0);
  const std::vector<std::string> rows = lines(content(fs::path(csv) / "lm/line_x_1.csv"));
  EXPECT_EQ(rows.at(0), "time_s,x,y,theta");
  EXPECT_THAT(rows.at(1), ::testing::StartsWith("0,0,0,"));
  EXPECT_TRUE(fs::exists(fs::path(csv) / "reference/line_x_1.csv"));
}

}  // namespace
}  // namespace odobench
