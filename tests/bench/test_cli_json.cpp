// --json of every verb.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "base/sha256.hpp"
#include "tests/support/run_process.hpp"
#include "tests/support/shared_data.hpp"
#include "tests/support/source_dir.hpp"

namespace odobench {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::ProcessResult;
using testing::run_bench;
using testing::TemporaryFolder;
using Words = std::vector<std::string>;

// The verbs of `bench --help`: the first word of every line below "Subcommands:" that is indented by two.
std::set<std::string> verbs_of_help() {
  std::set<std::string> verbs;
  bool inside = false;
  for (const std::string& line : testing::lines(run_bench({"--help"}).out)) {
    if (line.rfind("Subcommands:", 0) == 0 || line.rfind("SUBCOMMANDS:", 0) == 0) {
      inside = true;
      continue;
    }
    if (inside && (line.empty() || line[0] != ' ')) break;
    if (inside && line.size() > 2 && line[2] != ' ') {
      std::istringstream words(line);
      std::string verb;
      words >> verb;
      verbs.insert(verb);
    }
  }
  return verbs;
}

std::string source(const std::string& path) {
  return (source_dir() / path).string();
}

// Nine windows' worth of rows of a robot that stands still.
std::string filter_rows() {
  std::string text = "time_s,enc1_m,enc2_m,enc3_m,enc4_m,ax_m_s2,ay_m_s2,yaw_step_deg\n";
  for (int i = 0; i < 20; ++i) text += std::to_string(i) + "e-1,0.01,0.01,0.01,0.01,0,0,0\n";
  return text;
}

class CliJson : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  // Something that each verb can do here in little time.
  std::map<std::string, Words> examples() {
    const std::string runs = path("runs"), raw = path("raw"),
                      sensors = "--sensors=" + source("datasets/sensors/heading_only.json");
    EXPECT_EQ(run_bench({"--solver=lm", "--quiet", "--out=" + runs}).exit_code, 0);
    EXPECT_EQ(run_bench({"check", runs, "--baseline=" + path("base.json"), "--update"}).exit_code, 0);
    EXPECT_EQ(run_bench({"store", "import", path("stored.db"), runs}).exit_code, 0);
    return {
        {"run", {"run", "--problem=rosenbrock", "--solver=lm", "--quiet"}},
        {"calibrate",
         {"calibrate", source("datasets/samples/courier.bag"), "--nominal=b=0.4,r=0.05", "--quiet",
          "--out=" + path("calibrated")}},
        {"filter", {"filter", "--data=" + folder_.file("f.csv", filter_rows())}},
        {"evaluate", {"evaluate"}},
        {"inspect", {"inspect"}},
        {"campaign", {"campaign", source("campaigns/smoke.json"), "--out=" + path("campaign.db"), "--quiet"}},
        {"store", {"store", "info", path("stored.db")}},
        {"models", {"models", "--models=plain,least_squares", "--quiet"}},
        {"list", {"list", "problems"}},
        {"report", {"report", runs}},
        {"export", {"export", runs, "--tum", "--out=" + path("tum")}},
        {"check", {"check", runs, "--baseline=" + path("base.json")}},
        {"compare", {"compare", runs, runs}},
        {"demo", {"demo", "--out=" + path("demo")}},
        {"simulate", {"simulate", "--scenario=exact", "--out=" + path("simulated"), "--quiet"}},
        {"discretise", {"discretise", "--system=" + source("datasets/systems/turn3d.json"), "--period=1"}},
        {"fuse", {"fuse", sensors, "--filter=none,ekf"}},
        {"tune", {"tune", sensors, "--max-evals=3"}},
        {"plan", {"plan", "--robot=vitko2024", "--replicas=2"}},
        {"verify", {"verify", "--scenario=vitko2024", "--parameters=truth", "--repeat=1"}}};
  }

  json parsed(const Words& words, int exit_code = 0) {
    const ProcessResult run = run_bench(words, 300);
    EXPECT_EQ(run.exit_code, exit_code) << words[0] << ": " << run.err;
    json document = json::parse(run.out, nullptr, false);
    EXPECT_FALSE(document.is_discarded()) << words[0] << ": " << run.out.substr(0, 300);
    return document;
  }

  TemporaryFolder folder_;
};

void expect_shape(const json& document, const std::string& verb) {
  ASSERT_TRUE(document.is_object()) << verb;
  EXPECT_EQ(document.at("schema_version"), 1) << verb;
  ASSERT_TRUE(document.at("tables").is_array()) << verb;
  EXPECT_FALSE(document.at("tables").empty()) << verb;
  for (const json& table : document.at("tables")) {
    for (const char* key : {"id", "title", "columns", "rows", "notes"})
      EXPECT_TRUE(table.contains(key)) << verb;
    std::set<std::string> ids;
    for (const json& column : table.at("columns")) ids.insert(column.at("id").get<std::string>());
    for (const json& row : table.at("rows"))
      for (const auto& cell : row.items()) EXPECT_EQ(ids.count(cell.key()), 1u) << verb << " " << cell.key();
  }
}

TEST_F(CliJson, EveryVerbOfTheHelpSpeaksIt) {
  const std::set<std::string> verbs = verbs_of_help();
  EXPECT_GE(verbs.size(), 16u);
  const std::map<std::string, Words> known = examples();
  for (const std::string& verb : verbs) {
    EXPECT_THAT(run_bench({verb, "--help"}).out, HasSubstr("--json")) << verb;
    if (verb == "import" || verb == "windows") continue;  // need files of their own, see below
    const auto example = known.find(verb);
    ASSERT_NE(example, known.end()) << "a new verb: give this test an example of it: " << verb;
    Words words = example->second;
    words.push_back("--json");
    expect_shape(parsed(words), verb);
  }
}

TEST_F(CliJson, ImportOfSimulatedRawFiles) {
  const std::string raw = path("raw"), set = path("set.json");
  const json simulated =
      parsed({"simulate", "--scenario=vitko2024", "--raw", "--quiet", "--json", "--out=" + raw});
  expect_shape(simulated, "simulate");
  EXPECT_EQ(simulated.at("tables").at(1).at("rows").size(), 63u)
      << "60 raw files, their sums, two of the truth";
  // Its sums are not those that were published, which the importer says.
  const ProcessResult run =
      run_bench({"import", "vitko2024", "--from=" + raw, "--out=" + set, "--json", "--quiet"});
  if (run.exit_code == 0) {
    expect_shape(json::parse(run.out), "import");
    return;
  }
  EXPECT_THAT(run.out, IsEmpty());
  ADD_FAILURE() << run.err;
}

TEST_F(CliJson, WindowsOfAFile) {
  const auto file = testing::shared_folder() / "reference" / "entropy_windows.json";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no shared/reference/entropy_windows.json";
  expect_shape(parsed({"windows", file.string(), "--only=csharp", "--quiet", "--json"}), "windows");
}

TEST_F(CliJson, SaysWhatWasWritten) {
  const json document = parsed({"demo", "--out=" + path("demo"), "--json"});
  const json &set = document.at("tables").at(0), &written = document.at("tables").at(1);
  EXPECT_EQ(set.at("rows").at(0).at("name"), "demo");
  EXPECT_EQ(set.at("rows").at(0).at("recordings"), 30);
  EXPECT_EQ(written.at("id"), "written");
  EXPECT_EQ(written.at("rows").size(), 31u);
  const json& last = written.at("rows").back();
  EXPECT_EQ(last.at("file"), path("demo/set.json"));
  EXPECT_EQ(last.at("bytes"), std::filesystem::file_size(path("demo/set.json")));
  EXPECT_EQ(last.at("sha256"), sha256_of_file(path("demo/set.json")));
  EXPECT_THAT(run_bench({"demo", "--out=" + path("other")}).out, IsEmpty()) << "only when asked";

  const std::string runs = path("runs"), base = path("base.json");
  ASSERT_EQ(run_bench({"--problem=sphere", "--solver=lm", "--quiet", "--out=" + runs}).exit_code, 0);
  const json update = parsed({"check", runs, "--baseline=" + base, "--update", "--json"});
  EXPECT_EQ(update.at("tables").at(0).at("rows").at(0).at("sha256"), sha256_of_file(base));
}

TEST_F(CliJson, IsTheFormatJson) {
  const Words words{"list", "problems"};
  Words with_json = words, with_format = words, both = words, contradiction = words;
  with_json.push_back("--json");
  with_format.push_back("--format=json");
  both.insert(both.end(), {"--json", "--format=json"});
  contradiction.insert(contradiction.end(), {"--format=csv", "--json"});
  EXPECT_EQ(run_bench(with_json).out, run_bench(with_format).out);
  EXPECT_EQ(run_bench(both).out, run_bench(with_format).out);
  const ProcessResult refused = run_bench(contradiction);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("--json: it contradicts --format=csv"));
  EXPECT_THAT(refused.out, IsEmpty());
  // The command line wins over a configuration file, which has no key of that name.
  const std::string config = folder_.file("c.ini", "format = md\n"),
                    wrong = folder_.file("w.ini", "json = true\n");
  const Words run{"--problem=sphere", "--solver=lm", "--quiet", "--json", "--config="};
  Words good = run, bad = run;
  good.back() += config;
  bad.back() += wrong;
  expect_shape(parsed(good), "run");
  EXPECT_EQ(run_bench(bad).exit_code, 2);
  EXPECT_THAT(run_bench(bad).err, HasSubstr("format = \"json\""));
}

}  // namespace
}  // namespace odobench
