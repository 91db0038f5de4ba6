// --loss, --weights, --piece and --screen on the command line: what is refused, named, kept and shown.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/files.hpp"
#include "datasets/dataset.hpp"
#include "problems/simulation/robot_demo.hpp"
#include "reports/records/tracks.hpp"
#include "tests/support/run_process.hpp"

namespace odobench {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using testing::ProcessResult;
using testing::run_bench;
using testing::TemporaryFolder;

// Five repetitions of one drive of a differential robot, in the third of which a wheel slips, and three of
// another.
std::string repeated_set(const TemporaryFolder& folder, bool slips) {
  Dataset set = make_robot_demo("differential", 1);
  std::vector<Recording> drives;
  for (int i = 0; i < 8; ++i) {
    Recording r = set.recordings[i < 5 ? 0 : 5];
    r.trajectory = i < 5 ? "there" : "back";
    r.repetition = (i < 5 ? i : i - 5) + 1;
    r.id = r.trajectory + "_" + std::to_string(r.repetition);
    for (std::size_t k = 0; k < r.reference.x.size(); ++k)
      r.reference.x[k] += 1e-3 * std::sin(0.01 * static_cast<double>(k) + i);
    if (slips && i == 2) {
      std::vector<double>& wheel = r.signals.front().values;
      for (std::size_t k = wheel.size() / 3; k < wheel.size() / 2; ++k) wheel[k] *= 2.5;
    }
    drives.push_back(std::move(r));
  }
  set.recordings = std::move(drives);
  set.trajectories = {{"there", ""}, {"back", ""}};
  save_dataset(set, folder / "set.json");
  return (folder / "set.json").string();
}

nlohmann::json tables(const ProcessResult& result) {
  return nlohmann::json::parse(result.out).at("tables");
}

const nlohmann::json* table(const nlohmann::json& all, const std::string& id) {
  for (const auto& t : all)
    if (t.at("id") == id) return &t;
  return nullptr;
}

TEST(CliLosses, LeavesOutWhatDiffersFromItsSiblingsAndSaysSo) {
  const TemporaryFolder folder;
  const std::string set = repeated_set(folder, true);
  const ProcessResult run = run_bench({"--data=" + set, "--solver=lm", "--accept=all", "--format=json",
                                       "--out=" + (folder / "runs").string()});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("_3 differs from its siblings ("));
  EXPECT_THAT(run.err, HasSubstr(" times the usual): left out"));
  const auto all = tables(run);
  const auto* out = table(all, "set_aside");
  ASSERT_NE(out, nullptr) << run.out;
  ASSERT_EQ(out->at("rows").size(), 2U);  // nominal, lm
  const std::string record = testing::lines(testing::content(folder / "runs" / "runs.jsonl")).back();
  EXPECT_THAT(record, HasSubstr("[without:"));
  EXPECT_THAT(record, HasSubstr("set_aside."));

  const ProcessResult whole =
      run_bench({"--data=" + set, "--solver=lm", "--accept=all", "--screen=off", "--format=json"});
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  EXPECT_THAT(whole.err, Not(HasSubstr("siblings")));
  EXPECT_EQ(table(tables(whole), "set_aside"), nullptr);

  const ProcessResult judged = run_bench({"evaluate", "--data=" + set});
  ASSERT_EQ(judged.exit_code, 0) << judged.err;
  EXPECT_THAT(judged.err, HasSubstr("_3 differs from its siblings"));
  EXPECT_THAT(judged.err, Not(HasSubstr("left out")));
}

// Per sample the rows of the stretches that count for less are those of the model's own form.
TEST(CliLosses, GoWithRicherModels) {
  const TemporaryFolder folder;
  const std::string set = repeated_set(folder, true);
  for (const char* loss : {"huber", "cauchy:recording"})
    for (const char* model : {"time_offset", "lever_arm"}) {
      const ProcessResult run = run_bench({"--data=" + set, "--solver=lm", "--accept=all", "--screen=off",
                                           std::string("--loss=") + loss, std::string("--model=") + model,
                                           "--validate=none", "--format=json", "--max-evals=20"});
      ASSERT_EQ(run.exit_code, 0) << loss << " " << model << ": " << run.err;
      EXPECT_NE(table(tables(run), "weighted_down"), nullptr) << loss << " " << model;
    }
}

// Its path is drawn apart, with its name.
TEST(CliLosses, PathsOfWhatWasLeftOutAreKeptAndDrawn) {
  const TemporaryFolder folder;
  const std::string set = repeated_set(folder, true), out = (folder / "runs").string();
  ASSERT_EQ(run_bench({"--data=" + set, "--solver=lm", "--accept=all", "--out=" + out}).exit_code, 0);
  const std::optional<TrackSet> tracks = read_tracks(out);
  ASSERT_TRUE(tracks);
  ASSERT_EQ(tracks->recordings.size(), 8u);
  for (const TrackRecording& r : tracks->recordings) EXPECT_EQ(r.left_out, r.id == "there_3");
  const std::string page = (folder / "page.html").string();
  ASSERT_EQ(run_bench({"report", out, "--out=" + page}).exit_code, 0);
  const std::string text = read_file(page);
  // A build without charts has tables only.
  if (run_bench({"--version"}).out.find("without charts") != std::string::npos) return;
  EXPECT_THAT(text, HasSubstr("Dotted: there_3, left out of the calibration."));
  EXPECT_THAT(text, HasSubstr("3 (left out)"));
  EXPECT_THAT(text, Not(HasSubstr("1 (left out)")));
}

TEST(CliLosses, CleanSetsStayToTheBit) {
  const TemporaryFolder folder;
  const std::string set = repeated_set(folder, false);
  const auto parameters = [](const ProcessResult& result) {
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const auto all = tables(result);
    return table(all, "parameters")->dump() + table(all, "totals")->dump();
  };
  const ProcessResult screened = run_bench({"--data=" + set, "--solver=lm", "--format=json"});
  EXPECT_THAT(screened.err, Not(HasSubstr("differs")));
  EXPECT_EQ(parameters(screened),
            parameters(run_bench({"--data=" + set, "--solver=lm", "--format=json", "--screen=off"})));
}

TEST(CliLosses, NameLossScaleAndWhatCountsForLess) {
  const TemporaryFolder folder;
  const std::string set = repeated_set(folder, true);
  const std::vector<std::string> call{"--data=" + set, "--solver=lm",       "--accept=all",
                                      "--screen=off",  "--loss=cauchy=2.4", "--loss-scale=0.002,0.001",
                                      "--format=json"};
  const ProcessResult run = run_bench(call);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto all = tables(run);
  const auto* down = table(all, "weighted_down");
  ASSERT_NE(down, nullptr);
  EXPECT_THAT(down->at("title").get<std::string>(), HasSubstr("cauchy=2.4,scale=0.002:0.001"));
  EXPECT_THAT(down->at("rows").at(0).at("recording").get<std::string>(), HasSubstr("_3"));
  bool stretch = false;
  for (const auto& row : down->at("rows")) stretch = stretch || row.at("part") == "stretch";
  EXPECT_TRUE(stretch);

  // The scales that are estimated may be typed, and threads decide nothing.
  const auto cost = [&](std::vector<std::string> options) {
    for (const char* option : {"--solver=lm", "--accept=all", "--screen=off", "--format=json"})
      options.emplace_back(option);
    options.push_back("--data=" + set);
    const ProcessResult result = run_bench(options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const auto list = tables(result);
    return std::pair(table(list, "solvers")->at("rows").at(1).at("cost").dump(),
                     table(list, "solvers")->at("title").get<std::string>());
  };
  const auto estimated = cost({"--loss=huber"});
  const std::size_t at = estimated.second.find("scale=") + 6, end = estimated.second.find(')', at);
  std::string scale = estimated.second.substr(at, end - at);
  scale.replace(scale.find(':'), 1, ",");
  EXPECT_EQ(cost({"--loss=huber", "--loss-scale=" + scale}), estimated);
  EXPECT_EQ(cost({"--loss=huber", "--threads=1"}), cost({"--loss=huber", "--threads=3"}));
  EXPECT_NE(cost({"--weights=auto"}).first, cost({}).first);
}

TEST(CliLosses, RefuseWhatContradictsItself) {
  struct Refusal {
    std::vector<std::string> options;
    const char* message;
  };
  for (const Refusal& refusal : std::vector<Refusal>{
           {{"--loss=gauss"}, "unknown loss 'gauss'"},
           {{"--loss=cauchy=-1"}, "tuning constant '-1'"},
           {{"--loss=cauchy:drive"}, "'drive' is neither sample nor recording"},
           {{"--loss-scale=1,2"}, "the squared loss has no scale"},
           {{"--loss=cauchy", "--loss-scale=1"}, "found 1 number, expected two"},
           {{"--loss=cauchy:recording", "--loss-scale=1,2"}, "found 2 numbers, expected one"},
           {{"--loss=cauchy", "--loss-scale=0,1"}, "--loss-scale=0"},
           {{"--loss=cauchy", "--weights=1,2"}, "a loss per sample weighs by --loss-scale"},
           {{"--weights=car"}, "or auto"},
           {{"--piece=5s"}, "only --cost=segments and optiodom have pieces"},
           {{"--cost=segments", "--piece=5"}, "expected seconds or metres"},
           {{"--screen=-1"}, "--screen=-1"}}) {
    std::vector<std::string> call{"--solver=lm"};
    call.insert(call.end(), refusal.options.begin(), refusal.options.end());
    const ProcessResult result = run_bench(call);
    EXPECT_EQ(result.exit_code, 2) << refusal.message << result.err;
    EXPECT_THAT(result.err, HasSubstr(refusal.message));
    EXPECT_EQ(testing::lines(result.err).size(), 1U) << result.err;
  }
  const ProcessResult short_drives = run_bench({"--solver=lm", "--cost=segments", "--piece=9000s"});
  EXPECT_EQ(short_drives.exit_code, 3) << short_drives.err;
  EXPECT_THAT(short_drives.err, HasSubstr("--piece"));
}

}  // namespace
}  // namespace odobench
